//! Searches of a hierarchy for packets of rays.
//!
//! While rays are close together, a test of a beam that contains them all excludes boxes for all of them, eight boxes
//! at once. A packet starts as beams of [`PART`] rays. A beam that is wider than the boxes is split into beams of eight
//! rays, and these into single rays.

use crate::geometry::aabb::{Aabb, SLACK, larger, smaller};
use crate::geometry::bvh::beam::{Beam, Eight};
use crate::geometry::bvh::node::{Order, WIDTH};
use crate::geometry::bvh::tree::{Ahead, Bvh, OBJECT, Stack, descend, push};
use crate::geometry::ray::RayError;
use crate::geometry::ray_packet::{RayPacket, split};
use crate::simd::cpu::kernels;
use crate::simd::soa::LANES;
use std::ops::Range;

/// The number of rays of the beams that a packet starts with.
const PART: usize = 64;

/// The width of a beam, as a multiple of a node's size, from which on the beam is split. Between 0.5 and 2, the times
/// of frames with 10^3 to 10^6 objects vary by less than a tenth.
const WIDE: f64 = 1.0;

/// A byte of 1 for each of eight rays.
const ALL: u64 = u64::from_le_bytes([1; LANES]);

/// A visitor of the objects that a packet's rays may hit.
///
/// `t_max` has the end of each ray of the packet, as a distance in world units. A test may reduce it. It is a
/// parameter, and the visitor is behind `dyn`, to compile the search only once for all visitors.
pub trait PacketVisitor {
    /// Tests the rays in a range of lanes against the object with this index. The length of the range is a multiple of
    /// [`LANES`], and no ray is tested against one object twice, here or alone.
    fn test(&mut self, object: usize, lanes: Range<usize>, t_max: &mut [f64]);

    /// Tests the ray in one lane against the object with this index.
    fn test_one(&mut self, object: usize, lane: usize, t_max: &mut [f64]);

    /// Returns the maximum number of rays for which single tests are faster than tests of eight.
    fn few(&self) -> u32 {
        0
    }

    /// Returns the order of visits.
    fn order(&self) -> Order {
        Order::Nearest
    }
}

kernels! {
    /// Visits the objects whose boxes the rays of a packet enter before their ends, roughly in the visitor's order.
    /// Rays that end at 0 or less are ignored. With a drift, objects that rays within the drift may hit are visited as
    /// well.
    pub fn visit(
        tree: &Bvh, stack: &mut Stack, rays: RayPacket, drift: RayError, t_max: &mut [f64], visitor: &mut dyn PacketVisitor
    ) {
        if tree.nodes.is_empty() {
            return;
        }
        let order = visitor.order();
        for part in split(rays.len(), PART) {
            let Stack { ahead, eights, beams } = stack;
            Search { tree, stack: ahead, rays, drift, order, t_max, visitor, eights, beams, start: part.start, count: part.len(), is_set: 0 }.part(part.len());
        }
    }
}

/// The search for the objects that the rays of a part of a packet may hit.
struct Search<'s, 'v> {
    tree: &'s Bvh,
    stack: &'s mut Vec<Ahead>,
    rays: RayPacket<'s>,
    drift: RayError,
    order: Order,
    /// The ends of the rays, as distances in world units.
    t_max: &'s mut [f64],
    visitor: &'s mut (dyn PacketVisitor + 'v),
    /// The part's rays in groups of eight, set on first use.
    eights: &'s mut Vec<Eight>,
    /// A bit for each group that is set.
    is_set: u64,
    /// The bounds of each group of eight rays, followed by those of each single ray. They are computed on first use.
    beams: &'s mut Vec<Option<Beam>>,
    /// The first lane of the part, and the number of its lanes.
    start: usize,
    count: usize,
}

impl Search<'_, '_> {
    /// Searches for a part of this many rays. The search is inlined into the kernel, and each of its functions is
    /// called in one place, which gives a single copy.
    #[inline(always)]
    fn part(mut self, count: usize) {
        let lanes = self.start..self.start + count;
        self.eights.resize(PART / LANES, Eight::ZERO);
        self.beams.clear();
        self.beams.resize(count / LANES, None);
        let Some(beam) = self.beam(lanes.clone()) else { return };
        if count == LANES {
            self.beams[0] = Some(beam);
        }
        let (start, mut t_max) = (self.stack.len(), self.most(lanes.clone()));
        self.stack.push(Ahead { enters: 0.0, child: 0, place: 0 });
        while self.stack.len() > start {
            let Some(Ahead { enters, child, place }) = self.stack.pop() else { return };
            if enters > t_max * (1.0 + SLACK) {
                continue;
            }
            if child & OBJECT != 0 {
                let bounds = self.bounds(place, &beam);
                let (mut first, mut eight) = (lanes.start, lanes.start);
                while eight <= lanes.end {
                    if eight == lanes.end || self.entering(eight, &bounds) == 0 {
                        self.test(child, first..eight);
                        first = eight + LANES;
                    }
                    eight += LANES;
                }
                t_max = self.most(lanes.clone());
                continue;
            }
            let node = &self.tree.nodes[child as usize];
            if count == LANES || beam.width(enters) > WIDE * node.size() {
                let bounds = self.bounds(place, &beam);
                for first in lanes.clone().step_by(LANES) {
                    // The root's box is in no node.
                    let entering = if child == 0 { ALL } else { self.entering(first, &bounds) };
                    if entering != 0 {
                        self.eight(first, child, entering);
                    }
                }
                t_max = self.most(lanes.clone());
            } else {
                push(self.stack, node, child, self.order, node.entered(&beam, t_max));
            }
        }
    }

    /// Searches a subtree for the rays of a group of eight that enter its box, given a byte for each.
    #[inline(always)]
    fn eight(&mut self, first: usize, root: u32, entering: u64) {
        let few = self.visitor.few();
        let lanes = first..first + LANES;
        let eight = (first - self.start) / LANES;
        // Few rays are searched for one by one, and need no bounds.
        if entering.count_ones() > few && self.beams[eight].is_none() {
            self.beams[eight] = self.beam(lanes.clone());
        }
        // Some of its rays may have ended since then. It still bounds the others.
        let beam = self.beams[eight];
        let (start, mut t_max) = (self.stack.len(), self.most(lanes.clone()));
        let mut known = Some(entering);
        self.stack.push(Ahead { enters: 0.0, child: root, place: 0 });
        while self.stack.len() > start {
            let Some(Ahead { enters, child, place }) = self.stack.pop() else { return };
            if enters > t_max * (1.0 + SLACK) {
                continue;
            }
            let is_object = child & OBJECT != 0;
            let is_wide = !is_object
                && beam.is_none_or(|beam| beam.width(enters) > WIDE * self.tree.nodes[child as usize].size());
            let entering = match (known.take(), &beam) {
                // For the root, the entering rays are known.
                (Some(entering), _) => entering,
                (None, Some(beam)) if is_object || is_wide || few > 0 => {
                    self.entering(first, &self.bounds(place, beam))
                }
                _ => ALL,
            };
            if is_object {
                if entering != 0 {
                    self.test(child, lanes.clone());
                    t_max = self.most(lanes.clone());
                }
            } else if let (Some(beam), false) = (&beam, is_wide || entering.count_ones() <= few) {
                let node = &self.tree.nodes[child as usize];
                push(self.stack, node, child, self.order, node.entered(beam, t_max));
            } else {
                self.each(first, child, entering);
                t_max = self.most(lanes.clone());
            }
        }
    }

    /// Searches a subtree for each ray of a group of eight that enters its box, given a byte for each.
    #[inline(always)]
    fn each(&mut self, first: usize, root: u32, mut entering: u64) {
        while entering != 0 {
            self.one(first + (entering.trailing_zeros() / u8::BITS) as usize, root);
            entering &= entering - 1;
        }
    }

    /// Searches a subtree for one ray.
    #[inline(always)]
    fn one(&mut self, lane: usize, root: u32) {
        let eights = self.count / LANES;
        // Most parts need no single rays.
        if self.beams.len() == eights {
            self.beams.resize(eights + self.count, None);
        }
        let place = eights + lane - self.start;
        if self.beams[place].is_none() {
            self.beams[place] = Some(Beam::of(&self.rays.get(lane), self.drift));
        }
        let Some(beam) = &self.beams[place] else { return };
        let (visitor, t_max) = (&mut *self.visitor, &mut *self.t_max);
        if t_max[lane] > 0.0 {
            descend(self.tree, self.stack, beam, root, self.order, t_max[lane], &mut |object, _| {
                visitor.test_one(object, lane, t_max);
                t_max[lane]
            });
        }
    }

    /// Returns the bounds of rays, unless all of them have ended.
    #[inline(always)]
    fn beam(&self, lanes: Range<usize>) -> Option<Beam> {
        Beam::around(self.rays.part(lanes.clone()), &self.t_max[lanes], self.drift)
    }

    /// Tests rays against the object at a position.
    #[inline(always)]
    fn test(&mut self, child: u32, lanes: Range<usize>) {
        if !lanes.is_empty() {
            self.visitor.test(self.tree.object(child ^ OBJECT), lanes, self.t_max);
        }
    }

    /// Returns the maximum distance of the ends of some rays.
    #[inline(always)]
    fn most(&self, lanes: Range<usize>) -> f64 {
        let mut most = [0.0; LANES];
        for first in lanes.step_by(LANES) {
            let t_max = &self.t_max[first..][..LANES];
            for lane in 0..LANES {
                most[lane] = larger(t_max[lane], most[lane]);
            }
        }
        let most = most.into_iter().fold(0.0, larger);
        // A ray that ends at 0 enters nothing.
        if most > 0.0 { most } else { -1.0 }
    }

    /// Returns the box of a child of a node, enlarged by the slack of the rays.
    #[inline(always)]
    fn bounds(&self, place: u32, beam: &Beam) -> Aabb {
        let (node, child) = (place as usize / WIDTH, place as usize % WIDTH);
        beam.grown(&self.tree.nodes[node].bounds(child))
    }

    /// Returns a byte for each of eight rays, the lowest one for the first: 1 if the ray enters a box before its end,
    /// and otherwise 0.
    #[inline(always)]
    fn entering(&mut self, first: usize, bounds: &Aabb) -> u64 {
        let eight = (first - self.start) / LANES;
        if self.is_set & (1 << eight) == 0 {
            self.is_set |= 1 << eight;
            self.eights[eight].set(self.rays.part(first..first + LANES));
        }
        let Eight { origin, inverse } = &self.eights[eight];
        let t_max = &self.t_max[first..first + LANES][..LANES];
        let (low, high) = (bounds.low, bounds.high);
        let mut is_entered = [0; LANES];
        for lane in 0..LANES {
            let (from, inverse) = (origin.get(lane), inverse.get(lane));
            let (a, b) = ((low - from) * inverse, (high - from) * inverse);
            // Only a ray without a direction gives NaN, because no ray starts on a plane with a slack. Such a ray
            // counts as entering.
            let mut enter = larger(smaller(a.x, b.x), 0.0);
            enter = larger(smaller(a.y, b.y), enter);
            enter = larger(smaller(a.z, b.z), enter);
            let mut leave = smaller(larger(a.x, b.x), t_max[lane]);
            leave = smaller(larger(a.y, b.y), leave);
            leave = smaller(larger(a.z, b.z), leave);
            is_entered[lane] = u8::from(enter <= leave * (1.0 + SLACK)) & u8::from(t_max[lane] > 0.0);
        }
        u64::from_le_bytes(is_entered)
    }
}
