//! The hierarchy, and searches along one ray.

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::bvh::beam::{Beam, Eight};
use crate::geometry::bvh::build;
use crate::geometry::bvh::node::{Entered, Node, Order, WIDTH};
use crate::geometry::ray::{Ray, RayError};
use crate::simd::cpu::{Cpu, kernels};
use std::mem::take;

/// A hierarchy of bounding boxes, with up to eight children in each node.
///
/// Searches visit each object whose box a ray enters before its end, roughly in an `Order`. Boxes need no slack for
/// rounding, because the search adds one, which also covers the rounding of the ray.
pub struct Bvh {
    pub(super) nodes: Vec<Node>,
    /// The objects' indices, node by node, or none if each index is the object's place.
    objects: Vec<u32>,
}

/// A child of a node that waits for its visit.
#[derive(Clone, Copy)]
pub(super) struct Ahead {
    /// The distance at which the ray enters the child's box, in world units.
    pub enters: f64,
    /// The index of a node, or the position of an object with [`OBJECT`] set.
    pub child: u32,
    /// For objects, eight times the index of the parent, plus the child's place in the parent.
    pub place: u32,
}

/// The bit that marks an object.
pub(super) const OBJECT: u32 = 1 << 31;

/// The number of objects must be below this, because of the range of [`Ahead::place`].
const MAX_OBJECTS: usize = 1 << 29;

/// The scratch space of searches, reused between them.
#[derive(Default)]
pub struct Stack {
    /// The children that wait for their visits, the next one last. Nested searches for a packet, for eight rays and for
    /// one ray each add up to seven children per level of the tree.
    pub(super) ahead: Vec<Ahead>,
    /// The current rays of a packet.
    pub(super) eights: Vec<Eight>,
    /// Bounds of eight rays each, and single rays.
    pub(super) beams: Vec<Option<Beam>>,
}

impl Bvh {
    /// Builds the hierarchy of objects, given by their boxes, on all threads.
    ///
    /// The result does not depend on the number of threads.
    ///
    /// # Panics
    ///
    /// Panics for 2^29 boxes or more.
    pub fn new(boxes: &[Aabb]) -> Self {
        Self::of(boxes.len(), |index| boxes[index])
    }

    /// Builds the hierarchy of `count` objects, like [`new`](Self::new). `bounds` returns an object's box.
    ///
    /// # Panics
    ///
    /// Panics for 2^29 boxes or more.
    pub fn of(count: usize, bounds: impl Fn(usize) -> Aabb + Sync) -> Self {
        assert!(count < MAX_OBJECTS, "{count} boxes are too many");
        let build::Parts { mut nodes, mut objects } = build::build(count, bounds);
        nodes.shrink_to_fit();
        objects.shrink_to_fit();
        Self { nodes, objects }
    }

    /// Replaces each object's index, which is initially its position in the list of boxes.
    pub fn rename(&mut self, name: impl Fn(u32) -> u32) {
        self.objects.iter_mut().for_each(|object| *object = name(*object));
    }

    /// Returns the objects' indices node by node. From here on, an object's index is its place in that list.
    pub fn take_order(&mut self) -> Vec<u32> {
        take(&mut self.objects)
    }

    /// Returns the index of the object at a place.
    #[inline(always)]
    pub(super) fn object(&self, place: u32) -> usize {
        if self.objects.is_empty() { place as usize } else { self.objects[place as usize] as usize }
    }

    /// Returns the memory of the hierarchy, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.objects[..])
    }

    /// Returns the number of nodes.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Visits the objects whose boxes a ray enters before `t_max`, in world units, nearest boxes first. `visit` takes
    /// an object's index and the current `t_max`, and returns the new one, which may be smaller. Objects whose boxes
    /// the ray enters at `t_max` itself are also visited, which lets the caller decide between equal distances.
    pub fn closest(
        &self,
        cpu: Cpu,
        stack: &mut Stack,
        ray: &Ray,
        t_max: f64,
        visit: impl FnMut(usize, f64) -> f64,
    ) {
        self.closest_within(cpu, stack, ray, RayError::NONE, t_max, visit);
    }

    /// Visits the objects whose boxes some ray within a drift of `ray` enters, like [`closest`](Self::closest).
    pub fn closest_within(
        &self,
        cpu: Cpu,
        stack: &mut Stack,
        ray: &Ray,
        drift: RayError,
        t_max: f64,
        mut visit: impl FnMut(usize, f64) -> f64,
    ) {
        search(cpu, self, stack, ray, drift, t_max, &mut visit);
    }

    /// Tells whether `visit` returns true for any object whose box a ray enters before `t_max`, in world units.
    pub fn any(
        &self,
        cpu: Cpu,
        stack: &mut Stack,
        ray: &Ray,
        t_max: f64,
        mut visit: impl FnMut(usize) -> bool,
    ) -> bool {
        let mut found = false;
        self.closest(cpu, stack, ray, t_max, |object, t_max| {
            found = visit(object);
            if found { -1.0 } else { t_max }
        });
        found
    }
}

kernels! {
    /// Visits objects along a ray, like [`Bvh::closest_within`].
    fn search(
        tree: &Bvh, stack: &mut Stack, ray: &Ray, drift: RayError, t_max: f64, visit: &mut dyn FnMut(usize, f64) -> f64
    ) {
        if tree.nodes.is_empty() {
            return;
        }
        let stack = &mut stack.ahead;
        let start = stack.len();
        descend(tree, stack, &Beam::of(ray, drift), 0, Order::Nearest, t_max, visit);
        stack.truncate(start);
    }
}

/// Visits objects of the subtree of a node along one ray. Returns the last `t_max`.
#[inline(always)]
pub(super) fn descend(
    tree: &Bvh,
    stack: &mut Vec<Ahead>,
    beam: &Beam,
    root: u32,
    order: Order,
    mut t_max: f64,
    visit: &mut (impl FnMut(usize, f64) -> f64 + ?Sized),
) -> f64 {
    let start = stack.len();
    let mut node = &tree.nodes[root as usize];
    loop {
        push(stack, node, 0, order, node.entered(beam, t_max));
        node = loop {
            if stack.len() == start {
                return t_max;
            }
            let Some(Ahead { enters, child, .. }) = stack.pop() else { return t_max };
            if enters > t_max * (1.0 + SLACK) {
                continue;
            }
            if child & OBJECT == 0 {
                break &tree.nodes[child as usize];
            }
            t_max = visit(tree.object(child ^ OBJECT), t_max);
        };
    }
}

/// Pushes the entered children of the node with this index. The first one to visit comes last.
#[inline(always)]
pub(super) fn push(
    stack: &mut Vec<Ahead>,
    node: &Node,
    index: u32,
    order: Order,
    (enters, mut bits): Entered,
) {
    let start = stack.len();
    while bits != 0 {
        let child = bits.trailing_zeros() / u8::BITS;
        bits &= bits - 1;
        let (is_node, place) = node.child(child);
        let next = Ahead {
            enters: enters[child as usize % WIDTH],
            child: if is_node { place } else { place | OBJECT },
            place: WIDTH as u32 * index + child,
        };
        // Few children are entered, and insertion sort is fastest.
        let mut place = stack.len();
        stack.push(next);
        while place > start && order.is_later(next.enters, stack[place - 1].enters) {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::bvh::packet::{PacketVisitor, visit};
    use crate::geometry::ray_packet::{PACKET_SIZE, RayPacket};
    use crate::simd::soa::{LANES, Vectors};
    use glam::DVec3;
    use proptest::prelude::*;
    use std::ops::Range;

    /// Generates coordinates like those of scenes, including 0. `prop_oneof` would seed a random number generator for
    /// each alternative, which takes far longer.
    fn number() -> impl Strategy<Value = f64> {
        (0..17, -1.0..1.0).prop_map(|(kind, part)| match kind {
            0..4 => 0.0,
            4 => -0.0,
            5..13 => 10.0 * part,
            _ => 1e6 * part,
        })
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    /// Generates a range of coordinates, some of them infinite.
    fn extent() -> impl Strategy<Value = (f64, f64)> {
        (0..24, number(), 0.0..1.0).prop_map(|(kind, at, part)| match kind {
            0 => (at, f64::INFINITY),
            1 => (f64::NEG_INFINITY, at),
            2 => (f64::NEG_INFINITY, f64::INFINITY),
            3 => (-1e300, 1e200),
            4..10 => (at, at),
            10..17 => (at, at + part),
            _ => (at, at + 1e3 * part),
        })
    }

    fn bounds() -> impl Strategy<Value = Aabb> {
        (extent(), extent(), extent())
            .prop_map(|(x, y, z)| Aabb { low: DVec3::new(x.0, y.0, z.0), high: DVec3::new(x.1, y.1, z.1) })
    }

    /// Returns the objects that a search visits, in order.
    fn visited(tree: &Bvh, cpu: Cpu, ray: &Ray, t_max: f64) -> Vec<usize> {
        let mut visited = Vec::new();
        tree.closest(cpu, &mut Stack::default(), ray, t_max, |object, t_max| {
            visited.push(object);
            t_max
        });
        visited
    }

    /// Tells whether a ray enters a box before `t_max`, by more than rounding.
    fn enters(ray: &Ray, t_max: f64, bounds: &Aabb) -> bool {
        let inverse = ray.dir.recip();
        let (mut enter, mut leave) = (0.0_f64, t_max);
        for axis in 0..3 {
            let [low, high] =
                [bounds.low, bounds.high].map(|at| (at[axis] - ray.origin[axis]) * inverse[axis]);
            if ray.dir[axis] == 0.0 {
                let from = ray.origin[axis];
                leave = if bounds.low[axis] <= from && from <= bounds.high[axis] { leave } else { -1.0 };
            } else {
                (enter, leave) = (enter.max(low.min(high)), leave.min(low.max(high)));
            }
        }
        enter <= leave
    }

    /// Counts the tests of each ray against each object.
    struct Counter {
        tests: Vec<Vec<u32>>,
    }

    impl PacketVisitor for Counter {
        fn test(&mut self, object: usize, lanes: Range<usize>, t_max: &mut [f64]) {
            assert_eq!((lanes.start % LANES, lanes.end % LANES), (0, 0));
            lanes.for_each(|lane| self.test_one(object, lane, t_max));
        }

        fn test_one(&mut self, object: usize, lane: usize, _: &mut [f64]) {
            self.tests[object][lane] += 1;
        }
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn an_object_is_visited_once_where_a_ray_enters_its_box(
            boxes in prop::collection::vec(bounds(), 0..200),
            (from, to) in (point(), point()),
            t_max in prop_oneof![Just(f64::INFINITY), 0.0..100.0],
        ) {
            prop_assume!((to - from).try_normalize().is_some());
            let (ray, tree) = (Ray { origin: from, dir: (to - from).normalize() }, Bvh::new(&boxes));
            for cpu in Cpu::all() {
                let visited = visited(&tree, cpu, &ray, t_max);
                for (index, bounds) in boxes.iter().enumerate() {
                    let times = visited.iter().filter(|visited| **visited == index).count();
                    prop_assert!(times == 1 || times == 0 && !enters(&ray, t_max, bounds), "{index}: {times} times");
                }
            }
        }

        #[test]
        fn a_packet_visits_what_its_rays_visit(
            boxes in prop::collection::vec(bounds(), 1..60),
            (from, to, spread) in (point(), point(), prop_oneof![Just(0.0), 0.0..0.1, 0.0..1e3]),
            ways in prop::collection::vec((point(), point(), any::<bool>()), 1..PACKET_SIZE),
        ) {
            let count = ways.len().next_multiple_of(LANES);
            let (mut origin, mut dir) = (Vectors::<PACKET_SIZE>::ZERO, Vectors::<PACKET_SIZE>::ZERO);
            let mut t_max = vec![0.0; count];
            for lane in 0..count {
                let (one, other, ends) = ways[lane.min(ways.len() - 1)];
                // The rays are close together, or arbitrary.
                let (from, to) = (from + spread * 1e-6 * one, to + spread * 1e-6 * other);
                origin.set(lane, from);
                dir.set(lane, (to - from).try_normalize().unwrap_or(DVec3::X));
                t_max[lane] = if ends { 0.0 } else { (to - from).length() };
            }
            let rays = RayPacket::new(origin.view(count), dir.view(count), 0.0);
            let tree = Bvh::new(&boxes);
            for cpu in Cpu::all() {
                let mut counter = Counter { tests: vec![vec![0; count]; boxes.len()] };
                visit(cpu, &tree, &mut Stack::default(), rays, RayError::NONE, &mut t_max.clone(), &mut counter);
                for (index, bounds) in boxes.iter().enumerate() {
                    for lane in 0..count {
                        let times = counter.tests[index][lane];
                        let is_entered = t_max[lane] > 0.0 && enters(&rays.get(lane), t_max[lane], bounds);
                        prop_assert!(times == 1 || times == 0 && !is_entered, "{index}, {lane}: {times} times");
                    }
                }
            }
        }
    }

    #[test]
    fn nearer_boxes_are_visited_first_until_the_end_is_nearer() {
        let at = |x: f64| Aabb { low: DVec3::new(x, -1.0, -1.0), high: DVec3::new(x + 0.5, 1.0, 1.0) };
        let boxes: Vec<_> = (0..1000).map(|index| at(f64::from(index * 7919 % 1000))).collect();
        let (tree, ray) = (Bvh::new(&boxes), Ray { origin: DVec3::NEG_X, dir: DVec3::X });
        for cpu in Cpu::all() {
            let inside: Vec<_> =
                visited(&tree, cpu, &ray, 11.25).into_iter().map(|index| boxes[index].low.x).collect();
            assert_eq!(inside, (0..=10).map(f64::from).collect::<Vec<_>>());
            let mut number = 0;
            let found = tree.any(cpu, &mut Stack::default(), &ray, 1e9, |index| {
                number += 1;
                boxes[index].low.x == 3.0
            });
            assert!(found && number == 4, "{number}");
            assert!(!tree.any(cpu, &mut Stack::default(), &ray, 3.5, |index| boxes[index].low.x == 3.0));
        }
    }

    #[test]
    fn a_tree_does_not_depend_on_the_number_of_threads() {
        let boxes: Vec<_> = (0..30_000_u32)
            .map(|index| {
                let part = |step: f64| (f64::from(index) * step).fract();
                let low = DVec3::new(part(0.819), part(0.671), part(0.5497));
                Aabb { low, high: low + 0.01 * part(0.3) }
            })
            .collect();
        let built = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| Bvh::new(&boxes))
        };
        let (one, three) = (built(1), built(3));
        assert_eq!(one.objects, three.objects);
        assert!(one.nodes == three.nodes);
        assert!(one.size() < boxes.len() / 4, "{} nodes", one.size());
    }
}
