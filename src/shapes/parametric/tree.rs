//! The bounds of the parts of a parametric surface.

use super::krawczyk::widened;
use super::patch::{Patches, PatchesIn, Rectangle};
use glam::DVec3;
use std::sync::OnceLock;
use tabray_exact::interval::Interval;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::geometry::sight::Line;

/// The number of halvings of the rectangle, and of those parts where slopes vary much.
const HALVINGS: u32 = 12;
const CUTS: u32 = 4;

/// The bounding boxes of the parts from repeated halving of the rectangle of u and v.
pub(super) struct Tree {
    ends: Rectangle<f64>,
    /// A box around the surface.
    whole: Aabb,
    /// The parts of the last halving, in order.
    leaves: Vec<Rectangle<f64>>,
    /// The box of each leaf, and a hierarchy of them.
    boxes: Vec<Aabb>,
    hierarchy: Bvh,
    /// The bounds of each leaf.
    flats: Vec<Flat>,
    /// Each leaf with its slopes, once a line comes near it.
    pieces: Vec<OnceLock<Piece>>,
}

/// The bounds of a leaf: a parallelogram, widened by an error along each axis. For a nearly flat leaf, a box would be
/// much larger.
pub(super) struct Flat {
    pub middle: [f64; 3],
    /// Half of each side.
    pub sides: [[f64; 3]; 2],
    pub error: [f64; 3],
}

/// A leaf or a part of one, with bounds of its points by the mean value form.
pub(super) struct Piece {
    pub part: Rectangle<f64>,
    /// The part with its margin.
    pub wide: Rectangle<f64>,
    /// Encloses the point in the middle.
    pub centre: [Interval; 3],
    /// Encloses the derivatives with respect to u and to v in the part with its margin.
    pub along: [[Interval; 3]; 2],
    /// How often it can be halved.
    cuts: u32,
    /// Its halves, once a line needs them.
    halves: OnceLock<Box<[Self; 2]>>,
}

impl Tree {
    pub fn new(patches: &dyn Patches, ends: [[f64; 2]; 2]) -> Self {
        let ends = ends.map(|[low, high]| Interval { low, high });
        let mut leaves = vec![ends];
        for _ in 0..HALVINGS {
            leaves = leaves.into_iter().flat_map(|part| halves(patches, part)).collect();
        }
        let (boxes, flats): (Vec<_>, Vec<_>) = leaves.iter().map(|part| around(patches, part)).unzip();
        let (hierarchy, pieces) = (Bvh::new(&boxes), leaves.iter().map(|_| OnceLock::new()).collect());
        let whole = boxes.iter().fold(Aabb::EMPTY, |whole, leaf| whole.and(leaf));
        Self { ends, whole, leaves, boxes, hierarchy, flats, pieces }
    }

    pub fn ends(&self) -> &Rectangle<f64> {
        &self.ends
    }

    /// Returns a box around the surface, if it is bounded.
    pub fn bounds(&self) -> Option<Aabb> {
        (self.whole.low.is_finite() && self.whole.high.is_finite()).then_some(self.whole)
    }

    /// Tells whether the boxes of the leaves are smaller than a quarter of the whole box, by the mean of their longest
    /// sides. If halving locates the surface well, the ratio is near 1/64.
    pub fn tells_apart(&self, whole: &Aabb) -> bool {
        let side = |of: &Aabb| (of.high - of.low).max_element();
        let sum: f64 = self.boxes.iter().map(|leaf| side(leaf) / self.boxes.len() as f64).sum();
        // The comparison is false for infinity and NaN.
        sum < 0.25 * side(whole)
    }

    /// Calls a function with the leaves that a line may meet, roughly nearest first. It returns the t beyond which leaves no
    /// longer matter.
    pub fn along(&self, line: &Line<Interval>, each: &mut dyn FnMut(usize) -> f64) {
        self.hierarchy.along(line, each);
    }

    /// Calls a function with the leaves whose boxes are within a distance of a point.
    pub fn near(&self, at: DVec3, distance: f64, mut each: impl FnMut(usize)) {
        self.hierarchy.around(at, distance, &mut |leaf| {
            each(leaf);
            distance
        });
    }

    /// Returns the box of the leaf with an index.
    pub fn around(&self, index: usize) -> &Aabb {
        &self.boxes[index]
    }

    /// Returns the number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaves.len()
    }

    /// Returns the leaf with an index.
    pub fn leaf(&self, index: usize) -> &Rectangle<f64> {
        &self.leaves[index]
    }

    /// Returns the leaf with an index, as a piece that can be cut.
    pub fn piece(&self, patches: &dyn Patches, index: usize) -> &Piece {
        self.pieces[index].get_or_init(|| Piece::new(patches, self.leaves[index], CUTS))
    }

    /// Returns the bounds of the leaf with an index.
    pub fn flat(&self, index: usize) -> &Flat {
        &self.flats[index]
    }
}

impl Piece {
    fn new(patches: &dyn Patches, part: Rectangle<f64>, cuts: u32) -> Self {
        let (wide, middle) = (widened(&part), part.map(|side| Interval::point(side.middle())));
        let centre = PatchesIn::<f64>::points(patches, &middle);
        let along = PatchesIn::<f64>::patch(patches, &wide).along;
        Self { part, wide, centre, along, cuts, halves: OnceLock::new() }
    }

    /// Returns the halves of the piece, unless it was cut often enough.
    pub fn halves(&self, patches: &dyn Patches) -> Option<&[Self; 2]> {
        let cuts = self.cuts.checked_sub(1)?;
        let halves = || Box::new(halves(patches, self.part).map(|part| Self::new(patches, part, cuts)));
        Some(self.halves.get_or_init(halves))
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
    let middle = part.map(|side| side.middle());
    let at_middle = patches.at(middle);
    let length = |axis: usize| {
        let along = match at_middle[1 + axis] {
            // The surface may stand still in the middle alone, as at an edge from which it comes back.
            DVec3::ZERO => {
                let mut beside = middle;
                beside[axis] = 0.5 * (part[axis].low + middle[axis]);
                patches.at(beside)[1 + axis]
            }
            along => along,
        };
        along.length() * part[axis].width()
    };
    let axis = usize::from(length(1) > length(0));
    let (mut one, mut other) = (part, part);
    (one[axis].high, other[axis].low) = (middle[axis], middle[axis]);
    [one, other]
}
