//! A scene for proofs of colours: the objects that lines may hit.

use super::number::{Enclosing, Hit, coarse};
use crate::plan::depth::{self, Depth};
use std::cell::Cell;
use tabray_exact::interval::{Float, Interval};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::geometry::sight::Line;
use tabray_world::patch::Window;
use tabray_world::scene::model::Model;

/// The number of places that a ray may hit from which on no others are looked for: far more than are followed.
const CROWD: usize = 48;

/// A colour.
pub type Colour<N> = [N; 3];

/// A place on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// The object's index.
    pub object: usize,
    /// The part of the object, as proofs count them.
    pub part: usize,
}

/// Lines, and the place that they leave.
#[derive(Clone, Copy)]
pub(super) struct Path<N> {
    pub line: Line<N>,
    /// The place on which the lines' true starts lie, if they lie on an object.
    pub leaves: Option<Place>,
    /// Whether the lines leave that object on its inside.
    pub is_inside: bool,
}

/// The first hits that lines may have, and whether each line certainly has one.
pub(super) type FirstHits<N> = (Vec<(Hit<N>, Place)>, bool);

/// What is known of a model's colours before any ray is followed.
pub struct SceneBounds {
    /// A box around each object that has bounds.
    boxes: Vec<Option<Aabb>>,
    /// The hierarchy of these boxes, and the other objects.
    tree: Bvh,
    unbounded: Vec<usize>,
    /// A bound on any channel of what a primary ray returns, times the path length; infinite where there is none.
    pub(super) most: f64,
    /// Whether the fraction of each channel that glass lets pass is known to lie between 0 and 1.
    pub(super) passes_fractions: bool,
}

impl SceneBounds {
    /// Returns the bounds of a model.
    pub fn of(model: &Model) -> Self {
        let boxes: Vec<_> = model.objects.iter().map(|object| object.shape.bounds()).collect();
        let (bounded, unbounded): (Vec<_>, Vec<_>) =
            (0..boxes.len()).partition(|object| boxes[*object].is_some());
        let mut tree = Bvh::new(&boxes.iter().flatten().copied().collect::<Vec<_>>());
        tree.rename(|place| bounded[place as usize] as u32);
        Self {
            boxes,
            tree,
            unbounded,
            most: depth::most(model),
            passes_fractions: model.tints_are_fractions(),
        }
    }
}

/// A scene whose colours are enclosed.
pub struct EnclosedScene<'a> {
    /// The model.
    pub model: &'a Model,
    /// The indices of the lights that count.
    pub lights: &'a [usize],
    /// How rays continue, where any do.
    pub depth: Option<&'a Depth>,
    /// The bounds of the model.
    pub bounds: &'a SceneBounds,
    /// The window through which samples look, if they show patches of surfaces.
    pub window: Option<Window>,
    /// Whether the first hit of a ray may be on a shape without an equation.
    pub meets_uncertified: Cell<bool>,
}

impl EnclosedScene<'_> {
    /// Notes that the hits of the object of this index are open. For a shape without an equation, they always are.
    pub(super) fn note_open(&self, object: usize) {
        if !self.model.objects[object].shape.is_certified() {
            self.meets_uncertified.set(true);
        }
    }

    /// Calls `visit` with the objects that lines may hit, those with bounds roughly by distance. It returns the t beyond
    /// which objects no longer matter.
    pub(super) fn along(&self, coarse: &Line<Interval>, visit: &mut dyn FnMut(usize) -> f64) {
        self.bounds.unbounded.iter().for_each(|object| _ = visit(*object));
        self.bounds.tree.along(coarse, visit);
    }

    /// Returns a t before which lines have no hit with an object; `None` if they have none.
    fn enters(&self, coarse: &Line<Interval>, object: usize) -> Option<f64> {
        let Some(Aabb { low, high }) = self.bounds.boxes[object] else { return Some(0.0) };
        coarse.clip(low, high).map(|(from, _)| from)
    }

    /// Calls `met` with the possible hits of all lines with an object, until `met` returns false. `coarse` encloses the
    /// lines. Returns whether `met` never returned false.
    pub(super) fn hits<N: Enclosing>(
        &self,
        path: &Path<N>,
        coarse: &Line<Interval>,
        object: usize,
        met: &mut dyn FnMut(Hit<N>, Place) -> bool,
    ) -> bool {
        let Some(from) = self.enters(coarse, object) else { return true };
        let leaves = path.leaves.filter(|place| place.object == object).map(|place| place.part);
        let Some(proven) = self.model.objects[object].shape.proven() else {
            return met(Hit::Doubtful(N::of(from)), Place { object, part: 0 });
        };
        let mut goes_on = true;
        N::hits(proven, &path.line, leaves, &mut |hit, part| {
            goes_on = met(hit, Place { object, part });
            goes_on
        });
        goes_on
    }

    /// Returns a t beyond which lines have no hit with an object.
    pub(super) fn leaves(&self, coarse: &Line<Interval>, object: usize) -> f64 {
        let around = self.bounds.boxes[object].and_then(|Aabb { low, high }| coarse.clip(low, high));
        around.map_or(f64::INFINITY, |(_, to)| to)
    }

    /// Returns the first hits of lines; `None` where they are a crowd.
    pub(super) fn first<N: Enclosing>(&self, path: &Path<N>) -> Option<FirstHits<N>> {
        let (mut all, mut end) = (Vec::new(), N::End::INFINITY);
        let coarse = coarse(&path.line);
        self.along(&coarse, &mut |object| {
            self.hits(path, &coarse, object, &mut |hit, place| {
                if let Hit::Certain(at) = hit {
                    end = end.min(at.range().high);
                }
                all.push((hit, place));
                true
            });
            if all.len() >= CROWD {
                all.retain(|(hit, _)| hit.low() <= end);
            }
            if all.len() < CROWD { Interval::point(end).coarse().high } else { f64::NEG_INFINITY }
        });
        if all.len() >= CROWD {
            return None;
        }
        // They were found by distance.
        all.sort_by_key(|(_, place)| place.object);
        all.retain(|(hit, _)| hit.low() <= end);
        // Of several hits at exactly the same distance, the one of the first object in the file is seen.
        if let Some((first @ Hit::Certain(at), _)) = all.first().copied()
            && at.is_exact()
            && all.iter().all(|(hit, _)| *hit == first)
        {
            all.truncate(1);
        }
        if !matches!(all[..], [(Hit::Certain(_), _)]) {
            all.iter().for_each(|(_, place)| self.note_open(place.object));
        }
        Some((all, end < N::End::INFINITY))
    }
}
