//! How much light passes between a point and a lamp.

use super::media;
use super::number::{Enclosing, Hit, coarse, ranges};
use super::scene::{Colour, EnclosedScene, Path, Place};
use super::surface::tint;
use std::ptr;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{dot, per_axis};
use tabray_world::certify::Precise;
use tabray_world::geometry::sight::Line;
use tabray_world::material::Reflectivity;
use tabray_world::surface_point::Point;

/// The maximum number of walls of one transparent object on a shadow ray. Beyond it, the fraction of light that passes
/// is open.
const MAX_PANES: usize = 100;

/// The fraction of a light that reaches points.
pub(super) enum Passes<N> {
    /// All of it.
    All,
    /// This fraction.
    Part(Colour<N>),
    Nothing,
    /// An unknown fraction: anything from nothing to all, if tints are fractions.
    Open,
}

impl<N: Enclosing> Passes<N> {
    /// Encloses the part of a light that reaches points, given the full light. The light comes from above the surface
    /// for those points whose cosines are above 0. `None` where that is open.
    pub fn lit(
        &self,
        scene: &EnclosedScene,
        full: &Colour<N>,
        cosines: Interval<N::End>,
    ) -> Option<Colour<N>> {
        if matches!(self, Self::Open) && !scene.bounds.passes_fractions {
            return None;
        }
        let (zero, black) = (N::of(0.0), N::constant(0.0));
        Some(per_axis(|channel| {
            let full = full[channel];
            let lit = match self {
                Self::Nothing => black,
                Self::All => full,
                Self::Part(fraction) => full * fraction[channel],
                Self::Open => full.hull(black),
            };
            if cosines.low > zero { lit } else { lit.hull(black) }
        }))
    }
}

/// The range of t in which lines end on a light.
#[derive(Clone, Copy)]
pub(super) struct Ends<F> {
    pub first: F,
    pub last: F,
}

impl<F: Float> Ends<F> {
    /// Returns the range of a single t.
    pub fn at(t: F) -> Self {
        Self { first: t, last: t }
    }
}

/// Tells how much of the light of this index passes along lines from t = 0 to where they end on it.
pub(super) fn passed<N: Enclosing>(
    scene: &EnclosedScene,
    path: &Path<N>,
    light: usize,
    ends: Ends<N::End>,
) -> Passes<N> {
    let objects = &scene.model.objects;
    let coarse = coarse(&path.line);
    let is_glass = |object: &usize| !objects[*object].is_opaque();
    let mut panes = Panes { at: Vec::new(), ways: Vec::new(), passed: None };
    let (mut open, mut is_blocked) = (Vec::new(), false);
    let mut met = Vec::new();
    scene.along(&coarse, &mut |object| {
        met.push(object);
        Interval::point(ends.last).coarse().high
    });
    met.sort_unstable();
    for object in met.iter().copied().filter(is_glass) {
        if let Err(low) = panes.add(scene, path, object, ends) {
            panes.at.push((object, Interval { low, high: N::of(scene.leaves(&coarse, object)) }));
            open.push(object);
        }
    }
    open.extend(panes.interrupted());
    // The object that shows a light is convex, and does not hide the light's points.
    let source = &scene.model.lights[light].args;
    let is_source = |object: &usize| {
        let body = &objects[*object].args;
        ptr::eq(body.entity(), source.entity()) && body.order() == source.order()
    };
    for object in met.into_iter().filter(|object| !is_glass(object) && !is_source(object)) {
        scene.hits(path, &coarse, object, &mut |hit, _| {
            match hit {
                Hit::Certain(at) if at.range().high < ends.first && !panes.are_at(at.range()) => {
                    is_blocked = true
                }
                hit if hit.low() < ends.last => open.push(object),
                _ => {}
            }
            !is_blocked
        });
        if is_blocked {
            return Passes::Nothing;
        }
    }
    open.iter().for_each(|object| scene.note_open(*object));
    match panes.passed {
        _ if !open.is_empty() => Passes::Open,
        None => Passes::All,
        Some(fraction) => Passes::Part(fraction),
    }
}

/// The panes of glass on lines.
struct Panes<N: Enclosing> {
    /// For each pane, its object and the range of t in which it is or may be.
    at: Vec<(usize, Interval<N::End>)>,
    /// For each stretch in an absorbing medium, its object and its range of t.
    ways: Vec<(usize, Interval<N::End>)>,
    /// The fraction of light that passes, if there is any pane.
    passed: Option<Colour<N>>,
}

impl<N: Enclosing> Panes<N> {
    /// Tells whether any pane may be in a range of t.
    fn are_at(&self, t: Interval<N::End>) -> bool {
        self.at.iter().any(|(_, pane)| meet(*pane, t))
    }

    /// Returns the objects whose media may contain panes of others, between which light passes freely.
    fn interrupted(&self) -> impl Iterator<Item = usize> {
        let is_interrupted = |(object, way): &&(usize, Interval<N::End>)| {
            self.at.iter().any(|(other, pane)| other != object && meet(*pane, *way))
        };
        self.ways.iter().filter(is_interrupted).map(|(object, _)| *object)
    }

    /// Adds each wall of a transparent object that the lines pass through before they end.
    ///
    /// # Errors
    /// Returns the t before which all walls are added, where the walls after it are open.
    fn add(
        &mut self,
        scene: &EnclosedScene,
        path: &Path<N>,
        object: usize,
        ends: Ends<N::End>,
    ) -> Result<(), N::End> {
        let medium = scene.model.objects[object].material.medium();
        let length = dot(path.line.dir, path.line.dir).sqrt();
        let (mut onward, mut start) = (*path, N::constant(0.0));
        for _ in 0..MAX_PANES {
            let mut all = Vec::new();
            scene.hits(&onward, &coarse(&onward.line), object, &mut |hit, place| {
                let low = match hit {
                    Hit::Certain(at) | Hit::Perhaps(at) => (start + at).range().low,
                    Hit::Doubtful(low) => (start.range() + Interval::point(low)).low,
                };
                if low < ends.last {
                    all.push((low, hit, place));
                }
                true
            });
            let wall = match all[..] {
                [] => None,
                [(_, Hit::Certain(at), place)] => Some((start + at, place)),
                [(first, ..), ..] => {
                    return Err(all.iter().fold(
                        first,
                        |nearest, (low, ..)| {
                            if *low < nearest { *low } else { nearest }
                        },
                    ));
                }
            };
            // A medium absorbs light that leaves the object on its inside, or hits it there.
            let from_inside = onward.is_inside && onward.leaves.is_some_and(|place| place.object == object);
            let to_inside = match (&medium, wall) {
                (Some(_), Some((at, place))) => {
                    Some(is_inside(scene, place, path.line.at(at), path.line.dir).ok_or(at.range().low)?)
                }
                _ => None,
            };
            if let Some(medium) = &medium
                && (from_inside || to_inside == Some(true))
            {
                let to = wall.map_or(Interval { low: ends.first, high: ends.last }, |(at, _)| at.range());
                let way = wall.map_or(N::enclosing(to), |(at, _)| at) - start;
                self.ways.push((object, start.range().hull(to)));
                let is_endless = wall.is_none() && ends.first == N::End::INFINITY;
                self.pass(media::passed(medium, (!is_endless).then_some(way * length)));
            }
            let Some((at, place)) = wall else { return Ok(()) };
            let range = at.range();
            // Panes in one place count as one. That is not decided here.
            if range.high >= ends.first || self.are_at(range) {
                return Err(range.low);
            }
            let point = path.line.at(at);
            self.pass(pane_tint(scene, place, point).ok_or(range.low)?);
            self.at.push((object, range));
            start = at;
            let line = Line { origin: point, dir: path.line.dir };
            onward = Path { line, leaves: Some(place), is_inside: to_inside == Some(false) };
        }
        Err(start.range().low)
    }

    /// Lets only these fractions of the light pass.
    fn pass(&mut self, fractions: Colour<N>) {
        let before = self.passed.unwrap_or([N::constant(1.0); 3]);
        self.passed = Some(per_axis(|channel| before[channel] * fractions[channel]));
    }
}

/// Tells whether two stretches of lines have a place in common.
fn meet<F: Float>(one: Interval<F>, other: Interval<F>) -> bool {
    one.low <= other.high && other.low <= one.high
}

/// Tells whether lines along `dir` hit a place on the inside at points; `None` where it is open.
fn is_inside<N: Enclosing>(scene: &EnclosedScene, place: Place, at: [N; 3], dir: [N; 3]) -> Option<bool> {
    let shape = scene.model.objects[place.object].shape.proven()?;
    let along = dot(N::gradient(shape, at, place.part), dir).range();
    let zero = N::of(0.0);
    if along.low > zero { Some(true) } else { (along.high < zero).then_some(false) }
}

/// Encloses the fraction of light that passes through a place at points; `None` where it is open.
fn pane_tint<N: Enclosing>(scene: &EnclosedScene, place: Place, at: [N; 3]) -> Option<Colour<N>> {
    let pane = &scene.model.objects[place.object];
    let seen = Point::seen(pane.shape.proven()?, pane.shader.sees(), place.part, ranges(at), None);
    let tint = match pane.material.transparency {
        0.0 => [N::constant(0.0); 3],
        transparency => {
            let diffuse =
                N::End::looks(&*pane.shader).reflects(Reflectivity::Diffuse, &pane.material, &seen)?;
            tint(transparency, per_axis(|channel| N::enclosing(diffuse[channel])))?
        }
    };
    if !pane.shader.covers_in_part() {
        return Some(tint);
    }
    let covered = N::enclosing(N::End::looks(&*pane.shader).covers(&seen));
    Some(per_axis(|channel| covered * tint[channel] + (N::constant(1.0) - covered)))
}
