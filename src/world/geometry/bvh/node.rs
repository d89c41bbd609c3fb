//! The nodes of a hierarchy: eight boxes in 88 bytes, tested together.

use crate::geometry::aabb::{Aabb, SLACK, larger, smaller};
use crate::geometry::bvh::beam::{Beam, HIGH, LOW};
use glam::DVec3;

/// The maximum number of children of a node.
pub const WIDTH: usize = 8;

/// The number of steps, along each axis, of the grid for the planes of a node's boxes.
const STEPS: f64 = 255.0;

/// The maximum magnitude of a coordinate, which limits infinite boxes. Differences and sums of such numbers are finite.
const FARTHEST: f64 = 1e300;

/// Up to eight children, each a node or an object, with their boxes.
///
/// A box is given by the numbers of its planes on a grid that begins at `corner`. The steps of the grid are powers of
/// two, and so a plane's coordinate is exact except for the last sum. The planes are the nearest ones on the box's
/// outer sides.
#[derive(PartialEq)]
pub struct Node {
    corner: DVec3,
    /// The index of the first child that is a node. The others follow it.
    pub first_node: u32,
    /// The position of the first child that is an object, in the hierarchy's list of objects. The others follow it.
    pub first_object: u32,
    /// The numbers of the low and the high planes, for each axis.
    planes: [[[u8; WIDTH]; 2]; 3],
    /// The binary logarithms of the steps, in world units.
    exponents: [i16; 3],
    /// The number of children that are nodes. They come first.
    pub nodes: u8,
    /// The number of children.
    children: u8,
}

/// The distances at which a beam enters the boxes of a node's children, in world units, and a byte for each child, the
/// lowest one for the first: 1 if the beam enters the box, and otherwise 0.
pub type Entered = ([f64; WIDTH], u64);

/// The near and the far planes of a node's boxes along a beam, for each axis.
struct Planes<'n> {
    numbers: [[&'n [u8; WIDTH]; 3]; 2],
    /// The distances to the planes of number 0, in world units along the beam.
    starts: [[f64; 4]; 2],
    /// The distances between consecutive planes.
    paces: [[f64; 4]; 2],
}

impl Planes<'_> {
    /// Returns the distance to a plane of a child, in world units along the beam, or NaN if nothing is known of it.
    #[inline(always)]
    fn distance(&self, side: usize, axis: usize, child: usize) -> f64 {
        self.starts[side][axis] + f64::from(self.numbers[side][axis][child]) * self.paces[side][axis]
    }
}

/// The planes where a beam enters boxes, unless it is mixed.
const NEAR: usize = 0;
/// The planes where the beam leaves them.
const FAR: usize = 1;

impl Node {
    /// A node before its construction.
    pub const EMPTY: Self = Self {
        corner: DVec3::ZERO,
        first_node: 0,
        first_object: 0,
        planes: [[[0; WIDTH]; 2]; 3],
        exponents: [0; 3],
        nodes: 0,
        children: 1,
    };

    /// Makes a node of one to eight children with these boxes.
    ///
    /// Each box grows by [`SLACK`] times the largest coordinate of all of them. This exceeds the rounding of the planes
    /// and of the distances to them, and of the coordinates of hits.
    pub fn new(boxes: &[Aabb]) -> Self {
        let whole = boxes.iter().fold(Aabb::EMPTY, |all, one| all.and(one));
        let slack = SLACK * larger(whole.low.abs().max_element(), whole.high.abs().max_element());
        let mut node = Self { corner: whole.low - slack, ..Self::EMPTY };
        for axis in 0..3 {
            let corner = node.corner[axis];
            let size = whole.high[axis] + slack - corner;
            // The smallest power of two with `STEPS` times it at least the size, or the next one if the rounding of the
            // last plane requires it.
            let mut exponent = (exponent(size / STEPS) + 1).clamp(-1022, 1015);
            while corner + STEPS * exp2(exponent) < whole.high[axis] + slack {
                exponent += 1;
            }
            node.exponents[axis] = exponent;
            let (step, inverse) = (exp2(exponent), exp2(-exponent));
            for (child, bounds) in boxes.iter().enumerate() {
                let (low, high) = (bounds.low[axis] - slack, bounds.high[axis] + slack);
                // The numbers are rounded down. If rounding leaves a plane on the wrong side of the box, the next one
                // is on the right side: a step is at least 2 / 255 of the slack, more than 30 units in the last place
                // of the corner.
                let number = |plane: f64| f64::from(((plane - corner) * inverse) as u8);
                let (below, above) = (number(low), number(high));
                let below = below - f64::from(u8::from(corner + below * step > low));
                let above = above + f64::from(u8::from(corner + above * step < high));
                (node.planes[axis][LOW][child], node.planes[axis][HIGH][child]) = (below as u8, above as u8);
            }
        }
        node.children = boxes.len() as u8;
        node
    }

    /// Tests the children's boxes against a beam that ends at `t_max`, in world units. If a child is excluded, no ray
    /// of the beam enters its box before that.
    #[inline(always)]
    pub fn entered(&self, beam: &Beam, t_max: f64) -> Entered {
        if beam.is_mixed != [false; 3] {
            return self.entered_by_mixed(beam, t_max);
        }
        let planes = self.planes(beam);
        let (mut enters, mut is_entered) = ([0.0; WIDTH], [0; WIDTH]);
        // A single loop covers all planes of a child. The compiler vectorizes it over eight children.
        for child in 0..WIDTH {
            let mut enter = larger(planes.distance(NEAR, 0, child), 0.0);
            enter = larger(planes.distance(NEAR, 1, child), enter);
            enter = larger(planes.distance(NEAR, 2, child), enter);
            let mut leave = smaller(planes.distance(FAR, 0, child), t_max);
            leave = smaller(planes.distance(FAR, 1, child), leave);
            leave = smaller(planes.distance(FAR, 2, child), leave);
            enters[child] = enter;
            is_entered[child] = u8::from(enter <= leave * (1.0 + SLACK));
        }
        self.listed(enters, is_entered)
    }

    /// Tests the children's boxes against a beam with rays that rise along an axis and others that fall.
    #[inline(always)]
    fn entered_by_mixed(&self, beam: &Beam, t_max: f64) -> Entered {
        let (mut enters, mut leaves, mut is_entered) = ([0.0; WIDTH], [t_max; WIDTH], [0; WIDTH]);
        let planes = self.planes(beam);
        for axis in 0..3 {
            let is_mixed = beam.is_mixed[axis];
            for child in 0..WIDTH {
                let distance = planes.distance(FAR, axis, child);
                enters[child] = larger(planes.distance(NEAR, axis, child), enters[child]);
                enters[child] = larger(if is_mixed { distance } else { 0.0 }, enters[child]);
                leaves[child] = smaller(if is_mixed { t_max } else { distance }, leaves[child]);
            }
        }
        for child in 0..WIDTH {
            is_entered[child] = u8::from(enters[child] <= leaves[child] * (1.0 + SLACK));
        }
        self.listed(enters, is_entered)
    }

    /// Returns the distances, and the bytes of existing children.
    #[inline(always)]
    fn listed(&self, enters: [f64; WIDTH], is_entered: [u8; WIDTH]) -> Entered {
        (enters, u64::from_le_bytes(is_entered) & (u64::MAX >> (u64::BITS - 8 * u32::from(self.children))))
    }

    /// Returns the planes of all children along a beam.
    #[inline(always)]
    fn planes(&self, beam: &Beam) -> Planes<'_> {
        let DVec3 { x, y, z } = self.corner;
        let [a, b, c] = self.exponents;
        let (corner, steps) = ([x, y, z, 0.0], [exp2(a), exp2(b), exp2(c), 0.0]);
        let (mut starts, mut paces) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
        for side in [NEAR, FAR] {
            for axis in 0..4 {
                let inverse = beam.inverse[side][axis];
                starts[side][axis] = (corner[axis] - beam.from[side][axis]) * inverse;
                paces[side][axis] = steps[axis] * inverse;
            }
        }
        let [x, y, z] = &self.planes;
        let [a, b, c] = beam.near;
        let numbers = [[&x[a], &y[b], &z[c]], [&x[a ^ 1], &y[b ^ 1], &z[c ^ 1]]];
        Planes { numbers, starts, paces }
    }

    /// Returns whether a child is a node, and its place among all nodes or all objects.
    #[inline(always)]
    pub fn child(&self, child: u32) -> (bool, u32) {
        let nodes = u32::from(self.nodes);
        if child < nodes {
            (true, self.first_node + child)
        } else {
            (false, self.first_object + child - nodes)
        }
    }

    /// Returns the number of children.
    pub fn len(&self) -> usize {
        self.children.into()
    }

    /// Returns the box of a child.
    #[inline(always)]
    pub fn bounds(&self, child: usize) -> Aabb {
        let at = |side: usize| {
            let offset = |axis: usize| f64::from(self.planes[axis][side][child]) * exp2(self.exponents[axis]);
            self.corner + DVec3::new(offset(0), offset(1), offset(2))
        };
        Aabb { low: at(LOW), high: at(HIGH) }
    }

    /// Returns the coordinates of the low or the high planes of all children along an axis.
    #[inline(always)]
    pub fn planes_of(&self, axis: usize, side: usize) -> [f64; WIDTH] {
        let (corner, step) = (self.corner[axis], exp2(self.exponents[axis]));
        self.planes[axis][side].map(|number| corner + f64::from(number) * step)
    }

    /// Returns the maximum size of the node along an axis, in world units, up to a factor of 2.
    #[inline(always)]
    pub fn size(&self) -> f64 {
        let [x, y, z] = self.exponents;
        STEPS * exp2(x.max(y).max(z))
    }
}

/// Returns a box with finite coordinates in order, which has planes on a grid.
pub fn finite(bounds: &Aabb) -> Aabb {
    // A NaN coordinate may be anywhere.
    let low = bounds.low.map(|low| if low > -FARTHEST { low.min(FARTHEST) } else { -FARTHEST });
    let high = bounds.high.map(|high| if high < FARTHEST { high.max(-FARTHEST) } else { FARTHEST });
    Aabb { low: low.min(high), high: low.max(high) }
}

/// Returns the binary logarithm of a nonnegative number, rounded down, or -1023 for 0.
fn exponent(number: f64) -> i16 {
    (number.to_bits() >> 52) as i16 - 1023
}

/// Returns 2 to the power of an integer from -1022 to 1023.
#[inline(always)]
fn exp2(exponent: i16) -> f64 {
    f64::from_bits(((i64::from(exponent) + 1023) as u64) << 52)
}

/// The order of visits to the children of a node: by the distance at which a ray enters their boxes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Nearest first, for the nearest hit. Nothing behind it is visited.
    Nearest,
    /// Farthest first, for any hit of a ray that leaves a surface. The many boxes around its origin contain that
    /// surface, and seldom the hit.
    Farthest,
}

impl Order {
    /// Tells whether a child entered at the distance `one` is visited after a child entered at `other`.
    #[inline(always)]
    pub(super) fn is_later(self, one: f64, other: f64) -> bool {
        match self {
            Self::Nearest => other < one,
            Self::Farthest => one < other,
        }
    }
}
