//! A tree of bounding boxes of the parts of a parametric surface.

use super::patch::{Patches, PatchesIn, Rectangle};
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_world::geometry::aabb::Aabb;

/// The number of halvings of the rectangle.
const HALVINGS: u32 = 12;

/// The bounding boxes of the parts from repeated halving of the rectangle of u and v.
pub(super) struct Tree {
    ends: Rectangle<f64>,
    /// The boxes of all parts, beginning with the whole surface. The halves of the part with the index i have the
    /// indices 2 i + 1 and 2 i + 2.
    boxes: Vec<Aabb>,
    /// The parts of the last halving, in order.
    leaves: Vec<Rectangle<f64>>,
    /// The bounds of each leaf.
    flats: Vec<Flat>,
}

/// The bounds of a leaf: a parallelogram, widened by an error along each axis. For a nearly flat leaf, a box would be
/// much larger.
pub(super) struct Flat {
    pub middle: [f64; 3],
    /// Half of each side.
    pub sides: [[f64; 3]; 2],
    pub error: [f64; 3],
}

impl Tree {
    pub fn new(patches: &dyn Patches, ends: [[f64; 2]; 2]) -> Self {
        let ends = ends.map(|[low, high]| Interval { low, high });
        let (inner, mut leaves) = ((1_usize << HALVINGS) - 1, vec![ends]);
        for _ in 0..HALVINGS {
            leaves = leaves.into_iter().flat_map(|part| halves(patches, part)).collect();
        }
        let mut boxes = vec![Aabb::EMPTY; inner];
        let (around, flats): (Vec<_>, Vec<_>) = leaves.iter().map(|part| around(patches, part)).unzip();
        boxes.extend(around);
        for index in (0..inner).rev() {
            boxes[index] = boxes[2 * index + 1].and(&boxes[2 * index + 2]);
        }
        Self { ends, boxes, leaves, flats }
    }

    pub fn ends(&self) -> &Rectangle<f64> {
        &self.ends
    }

    /// Returns a box around the surface, if it is bounded.
    pub fn bounds(&self) -> Option<Aabb> {
        let Aabb { low, high } = self.boxes[0];
        (low.is_finite() && high.is_finite()).then_some(self.boxes[0])
    }

    /// Tells whether the boxes of the leaves are smaller than a quarter of the whole box, by the mean of their longest
    /// sides. If halving locates the surface well, the ratio is near 1/64.
    pub fn tells_apart(&self, whole: &Aabb) -> bool {
        let leaves = &self.boxes[self.boxes.len() - self.leaves.len()..];
        let side = |of: &Aabb| (of.high - of.low).max_element();
        let sum: f64 = leaves.iter().map(|leaf| side(leaf) / leaves.len() as f64).sum();
        // The comparison is false for infinity and NaN.
        sum < 0.25 * side(whole)
    }

    /// Calls a function with the leaves, in order, and their boxes, if these and all boxes above them meet a condition.
    pub fn visit(&self, meets: &dyn Fn(&Aabb) -> bool, each: &mut dyn FnMut(usize, &Rectangle<f64>, &Aabb)) {
        let mut waiting = vec![0];
        let inner = self.boxes.len() - self.leaves.len();
        while let Some(index) = waiting.pop() {
            if !meets(&self.boxes[index]) {
                continue;
            }
            match index.checked_sub(inner) {
                Some(leaf) => each(leaf, &self.leaves[leaf], &self.boxes[index]),
                None => waiting.extend([2 * index + 2, 2 * index + 1]),
            }
        }
    }

    /// Returns the number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaves.len()
    }

    /// Returns the leaf with an index.
    pub fn leaf(&self, index: usize) -> &Rectangle<f64> {
        &self.leaves[index]
    }

    /// Returns the bounds of the leaf with an index.
    pub fn flat(&self, index: usize) -> &Flat {
        &self.flats[index]
    }
}

/// Returns the box around a part, by the values of the formula and by the mean value form, and the part's
/// parallelogram.
fn around(patches: &dyn Patches, part: &Rectangle<f64>) -> (Aabb, Flat) {
    let whole = PatchesIn::<f64>::patch(patches, part);
    let middle = part.map(|side| Interval::point(side.middle()));
    let centre = PatchesIn::<f64>::points(patches, &middle);
    let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
    let mut flat = Flat { middle: [0.0; 3], sides: [[0.0; 3]; 2], error: [0.0; 3] };
    for axis in 0..3 {
        let by_slopes = centre[axis]
            + whole.along[0][axis] * (part[0] - middle[0])
            + whole.along[1][axis] * (part[1] - middle[1]);
        // An unknown slope leaves the bounds from the values.
        low[axis] = whole.at[axis].low.max(by_slopes.low);
        high[axis] = whole.at[axis].high.min(by_slopes.high);
        flat.middle[axis] = centre[axis].middle();
        let mut off = centre[axis] - Interval::point(flat.middle[axis]);
        for side in 0..2 {
            let (half, slope) = (part[side] - middle[side], whole.along[side][axis]);
            let mean = slope.middle();
            flat.sides[side][axis] = mean * half.magnitude();
            let lost = Interval::point(mean) * Interval::point(half.magnitude())
                - Interval::point(flat.sides[side][axis]);
            off = off
                + (slope - Interval::point(mean)) * half
                + Interval { low: -lost.magnitude(), high: lost.magnitude() };
        }
        flat.error[axis] = off.magnitude();
    }
    (Aabb { low, high }, flat)
}

/// Returns the halves of a part, cut across its longer side on the surface.
pub(super) fn halves(patches: &dyn Patches, part: Rectangle<f64>) -> [Rectangle<f64>; 2] {
    let [_, along_u, along_v] = patches.at(part.map(|side| side.middle()));
    let axis = usize::from(along_v.length() * part[1].width() > along_u.length() * part[0].width());
    let (mut one, mut other, middle) = (part, part, part[axis].middle());
    (one[axis].high, other[axis].low) = (middle, middle);
    [one, other]
}
