//! How much light passes between a point and a lamp.

use super::number::{Endpoint, Hit, Number, coarse, ranges};
use super::scene::{Colour, EnclosedScene, Path, Place};
use super::surface::tint;
use crate::geometry::sight::Line;
use crate::world::shader::PointBounds;
use std::ptr;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::per_axis;

/// The number of walls of one transparent object on a shadow ray after which what passes is open.
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

impl<N: Number> Passes<N> {
    /// Encloses what reaches points of the light that they would get, and which comes from above the surface for the part of
    /// them whose cosines are above 0; `None` where that is open.
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

/// Where lines end on a light: at no t before the first and none after the last.
#[derive(Clone, Copy)]
pub(super) struct Ends<F> {
    pub first: F,
    pub last: F,
}

impl<F: Float> Ends<F> {
    /// At one t.
    pub fn at(t: F) -> Self {
        Self { first: t, last: t }
    }
}

/// Tells how much of the light of this index passes along lines from t = 0 to where they end on it.
pub(super) fn passed<N: Number>(
    scene: &EnclosedScene,
    path: &Path<N>,
    light: usize,
    ends: Ends<N::End>,
) -> Passes<N> {
    let objects = &scene.model.objects;
    let coarse = coarse(&path.line);
    let is_glass = |object: &usize| objects[*object].material.transparency != 0.0;
    let mut panes = Panes { at: Vec::new(), passed: None };
    let (mut open, mut is_blocked) = (Vec::new(), false);
    for object in (0..objects.len()).filter(is_glass) {
        if let Err(low) = panes.add(scene, path, object, ends) {
            panes.at.push(Interval { low, high: N::of(scene.leaves(&coarse, object)) });
            open.push(object);
        }
    }
    // The object as which a light is seen is convex, and not in the way of its points.
    let source = &scene.model.lights[light].args;
    let is_source = |object: &usize| {
        let body = &objects[*object].args;
        ptr::eq(body.entity(), source.entity()) && body.order() == source.order()
    };
    for object in (0..objects.len()).filter(|object| !is_glass(object) && !is_source(object)) {
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
struct Panes<N: Number> {
    /// Where they are or may be.
    at: Vec<Interval<N::End>>,
    /// The fraction of light that passes, if there is any pane.
    passed: Option<Colour<N>>,
}

impl<N: Number> Panes<N> {
    /// Tells whether any pane may be at a t.
    fn are_at(&self, t: Interval<N::End>) -> bool {
        self.at.iter().any(|pane| pane.low <= t.high && t.low <= pane.high)
    }

    /// Adds each wall of a transparent object that the lines pass through before they end.
    ///
    /// # Errors
    /// The t before which all are added, where it is open which follow.
    fn add(
        &mut self,
        scene: &EnclosedScene,
        path: &Path<N>,
        object: usize,
        ends: Ends<N::End>,
    ) -> Result<(), N::End> {
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
            // What a medium behind the walls absorbs is not enclosed.
            let absorbs = scene.model.objects[object].material.medium().is_some();
            let (at, place) = match all[..] {
                [] => return Ok(()),
                [(_, Hit::Certain(at), place)] if !absorbs => (start + at, place),
                [(first, ..), ..] => {
                    return Err(all.iter().fold(
                        first,
                        |nearest, (low, ..)| {
                            if *low < nearest { *low } else { nearest }
                        },
                    ));
                }
            };
            let range = at.range();
            // Of panes in one place, one stands for all: that is not decided here.
            if range.high >= ends.first || self.are_at(range) {
                return Err(range.low);
            }
            let point = path.line.at(at);
            let tint = pane_tint(scene, place, point).ok_or(range.low)?;
            let before = self.passed.unwrap_or([N::constant(1.0); 3]);
            self.passed = Some(per_axis(|channel| before[channel] * tint[channel]));
            self.at.push(range);
            start = at;
            onward = Path { line: Line { origin: point, dir: path.line.dir }, leaves: Some(place) };
        }
        Err(start.range().low)
    }
}

/// Encloses the fraction of light that passes through a place at points; `None` where it is open.
fn pane_tint<N: Number>(scene: &EnclosedScene, place: Place, at: [N; 3]) -> Option<Colour<N>> {
    let pane = &scene.model.objects[place.object];
    let seen = PointBounds::seen(pane.shape.proven()?, pane.shader.sees(), place.part, ranges(at), None);
    let diffuse = N::End::look(pane, &seen)?.diffuse;
    tint(pane.material.transparency, per_axis(|channel| N::enclosing(diffuse[channel])))
}
