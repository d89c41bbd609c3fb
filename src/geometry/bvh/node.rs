//! The nodes of a hierarchy: eight boxes in 88 bytes, tested at a time.

use crate::geometry::aabb::{Aabb, SLACK, larger, smaller};
use crate::geometry::bvh::beam::{Beam, HIGH, LOW};
use glam::DVec3;

/// The maximum number of children of a node.
pub const WIDTH: usize = 8;

/// The number of steps of the grid on which the planes of a node's boxes lie, along each axis.
const STEPS: f64 = 255.0;

/// The largest magnitude of a coordinate; infinite boxes end there. Differences and sums of such numbers are finite.
const FARTHEST: f64 = 1e300;

/// Up to eight children, each a node or an object, with their boxes.
///
/// A box is given by the numbers of its planes on a grid that begins at `corner` and whose steps are powers of two, so
/// that a plane's coordinate is exact but for the last sum. The planes are those next to the box on its outer sides.
#[derive(PartialEq)]
pub struct Node {
    corner: DVec3,
    /// The index of the first child that is a node. The others follow it.
    pub first_node: u32,
    /// The position of the first child that is an object, among the hierarchy's objects. The others follow it.
    pub first_object: u32,
    /// The numbers of the low and of the high planes, for each axis.
    planes: [[[u8; WIDTH]; 2]; 3],
    /// The binary logarithms of the steps, in world units.
    exponents: [i16; 3],
    /// A bit for each child that is a node.
    pub nodes: u8,
    /// A bit for each child.
    pub children: u8,
}

/// The distances at which a beam enters the boxes of a node's children, in world units, and a bit for each child whose
/// box it enters.
pub type Entered = ([f64; WIDTH], u32);

impl Node {
    /// A node without children.
    pub const EMPTY: Self = Self {
        corner: DVec3::ZERO,
        first_node: 0,
        first_object: 0,
        planes: [[[0; WIDTH]; 2]; 3],
        exponents: [0; 3],
        nodes: 0,
        children: 0,
    };

    /// Makes a node of up to eight children with these boxes.
    ///
    /// Each box grows by [`SLACK`] times the largest coordinate of all of them, which is more than the rounding of the
    /// planes and of the distances to them, and of the coordinates of hits.
    pub fn new(boxes: &[Aabb]) -> Self {
        let whole = boxes.iter().fold(Aabb::EMPTY, |all, one| all.and(one));
        let slack = SLACK * larger(whole.low.abs().max_element(), whole.high.abs().max_element());
        let mut node = Self { corner: whole.low - slack, ..Self::EMPTY };
        for axis in 0..3 {
            let corner = node.corner[axis];
            let size = whole.high[axis] + slack - corner;
            // The least power of two of which `STEPS` are at least the size; one more where rounding of the last plane
            // needs it.
            let mut exponent = (exponent(size / STEPS) + 1).clamp(-1022, 1015);
            while corner + STEPS * exp2(exponent) < whole.high[axis] + slack {
                exponent += 1;
            }
            node.exponents[axis] = exponent;
            let step = exp2(exponent);
            for (child, bounds) in boxes.iter().enumerate() {
                let (low, high) = (bounds.low[axis] - slack, bounds.high[axis] + slack);
                let mut below = ((low - corner) / step).floor().clamp(0.0, STEPS);
                while below > 0.0 && corner + below * step > low {
                    below -= 1.0;
                }
                let mut above = ((high - corner) / step).ceil().clamp(0.0, STEPS);
                while above < STEPS && corner + above * step < high {
                    above += 1.0;
                }
                (node.planes[axis][LOW][child], node.planes[axis][HIGH][child]) = (below as u8, above as u8);
            }
        }
        node.children = ((1_u32 << boxes.len()) - 1) as u8;
        node
    }

    /// Tests the children's boxes against a beam that ends at `t_max`, in world units. Where a bit is 0, no ray of the
    /// beam enters the box before that.
    #[inline(always)]
    pub fn entered(&self, beam: &Beam, t_max: f64) -> Entered {
        let (mut enters, mut leaves) = ([0.0; WIDTH], [t_max; WIDTH]);
        for axis in 0..3 {
            let near = beam.near[axis];
            let far = near ^ 1;
            let step = exp2(self.exponents[axis]);
            // Where a product is NaN, the plane is left out, which is always correct.
            let (start, pace) = self.to_planes(beam, axis, near, step);
            let planes = &self.planes[axis][near];
            for child in 0..WIDTH {
                enters[child] = larger(start + f64::from(planes[child]) * pace, enters[child]);
            }
            let (start, pace) = self.to_planes(beam, axis, far, step);
            let planes = &self.planes[axis][far];
            if beam.is_mixed[axis] {
                for child in 0..WIDTH {
                    enters[child] = larger(start + f64::from(planes[child]) * pace, enters[child]);
                }
            } else {
                for child in 0..WIDTH {
                    leaves[child] = smaller(start + f64::from(planes[child]) * pace, leaves[child]);
                }
            }
        }
        let mut bits = 0;
        for child in 0..WIDTH {
            bits |= u32::from(enters[child] <= leaves[child] * (1.0 + SLACK)) << child;
        }
        (enters, bits & u32::from(self.children))
    }

    /// Returns the distance to plane 0 on a side, and the distance between planes, in world units along the beam.
    #[inline(always)]
    fn to_planes(&self, beam: &Beam, axis: usize, side: usize, step: f64) -> (f64, f64) {
        let inverse = beam.inverse[side][axis];
        ((self.corner[axis] - beam.from[side][axis]) * inverse, step * inverse)
    }
}

/// Returns a box whose coordinates are finite and in order, so that it has planes on a grid.
pub fn finite(bounds: &Aabb) -> Aabb {
    // A coordinate that is not a number may lie anywhere.
    let low = bounds.low.map(|low| if low > -FARTHEST { low.min(FARTHEST) } else { -FARTHEST });
    let high = bounds.high.map(|high| if high < FARTHEST { high.max(-FARTHEST) } else { FARTHEST });
    Aabb { low: low.min(high), high: low.max(high) }
}

/// Returns the binary logarithm of a number that is not negative, rounded down; -1023 for 0.
fn exponent(number: f64) -> i16 {
    (number.to_bits() >> 52) as i16 - 1023
}

/// Returns 2 to the power of an integer from -1022 to 1023.
#[inline(always)]
fn exp2(exponent: i16) -> f64 {
    f64::from_bits(((i64::from(exponent) + 1023) as u64) << 52)
}
