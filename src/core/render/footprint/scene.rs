//! A scene as proofs of footprints look at it: what the lines through a footprint may hit.

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::sight::Line;
use crate::render::plan::depth::Depth;
use crate::scene::model::Model;
use crate::world::certify::{FootprintHit, coarse};
use tabray_exact::affine::Affine;

/// A colour over a footprint. Where nothing is known, it is unbounded.
pub(super) type Colour = [Affine; 3];

/// A place on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// The object's index.
    pub object: usize,
    /// The part of the object, as proofs count them.
    pub part: usize,
}

/// The lines of a footprint, and the place that they leave.
#[derive(Clone, Copy)]
pub(super) struct Path {
    pub line: Line<Affine>,
    /// The place on which the lines' true starts lie, if they lie on an object.
    pub leaves: Option<Place>,
}

/// A model, and a box around each object that has bounds.
pub(super) struct Scene<'a> {
    pub model: &'a Model,
    pub depth: Option<&'a Depth>,
    pub boxes: &'a [Option<Aabb>],
    /// A bound on any channel of what a primary ray returns, times the path length; infinite where there is none.
    pub most: f64,
    /// Whether what glass lets pass of a channel is known to lie between none of it and all.
    pub passes_fractions: bool,
}

/// Returns the boxes around a model's objects.
pub(super) fn boxes(model: &Model) -> Vec<Option<Aabb>> {
    let around = |bounds: Aabb| {
        let slack = SLACK * bounds.low.abs().max(bounds.high.abs()).max_element();
        Aabb { low: bounds.low - slack, high: bounds.high + slack }
    };
    model.objects.iter().map(|object| object.shape.bounds().map(around)).collect()
}

impl Scene<'_> {
    /// Calls `met` with the possible hits of all lines with each object that `is_wanted`, until it returns false.
    pub fn hits(
        &self,
        path: &Path,
        is_wanted: impl Fn(usize) -> bool,
        mut met: impl FnMut(FootprintHit, Place) -> bool,
    ) {
        let coarse = coarse(&path.line);
        for (object, bounds) in self.boxes.iter().enumerate().filter(|(object, _)| is_wanted(*object)) {
            if bounds.is_some_and(|Aabb { low, high }| coarse.clip(low, high).is_none()) {
                continue;
            }
            let leaves = path.leaves.filter(|place| place.object == object).map(|place| place.part);
            let mut goes_on = true;
            match self.model.objects[object].shape.proven() {
                Some(proven) => proven.hits(&path.line, leaves, &mut |hit, part| {
                    goes_on &= met(hit, Place { object, part });
                }),
                None => goes_on = met(FootprintHit::Doubtful(0.0), Place { object, part: 0 }),
            }
            if !goes_on {
                return;
            }
        }
    }

    /// Returns a t beyond which the lines have no hit with an object.
    pub fn leaves(&self, path: &Path, object: usize) -> f64 {
        let around = self.boxes[object].and_then(|Aabb { low, high }| coarse(&path.line).clip(low, high));
        around.map_or(f64::INFINITY, |(_, to)| to)
    }

    /// Returns the first hits that the lines may have, and whether each line certainly has one.
    pub fn first(&self, path: &Path) -> (Vec<(FootprintHit, Place)>, bool) {
        let (mut all, mut end) = (Vec::new(), f64::INFINITY);
        self.hits(
            path,
            |_| true,
            |hit, place| {
                if let FootprintHit::Hits(at) = hit {
                    end = end.min(at.range().high);
                }
                all.push((hit, place));
                true
            },
        );
        all.retain(|(hit, _)| hit.low() <= end);
        (all, end < f64::INFINITY)
    }
}
