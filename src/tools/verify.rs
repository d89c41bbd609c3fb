//! Proves which object a pixel's ray hits first, and compares it with what the tracer finds.

use std::io;
use std::ops::ControlFlow;
use tabray_core::query::first::{FirstHits, first_of};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace;

/// The verdict on a pixel, for the exact ray through its centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// The tracer finds the object that is certainly hit first, or nothing where nothing is hit.
    Proven,
    /// 237 bits do not decide which of several objects is hit first, or whether an object is touched: a tie, as where
    /// two surfaces coincide. The tracer finds one of the objects in question.
    #[default]
    Tie,
    /// A shape without an equation may be hit first, since the ray meets its bounds before any proven hit. The tracer
    /// finds one of the objects in question.
    Uncertified,
    /// The tracer finds another object.
    Contradicted,
}

/// A pixel, and the verdict on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// The verdict.
    pub verdict: Verdict,
    /// The index of the object that the tracer finds, where it finds one.
    pub object: Option<usize>,
}

/// Returns the verdict on a pixel: `x` counts from the left, `y` from the bottom.
pub fn pixel(plan: &Plan, x: usize, y: usize) -> Pixel {
    let sight = plan.camera.sight(x as f64, y as f64);
    let found = trace::first_hit(plan, &sight).map(|hit| hit.index);
    let shape = |index: usize| &plan.model.objects[index].shape;
    let (first, _) = first_of((0..plan.model.objects.len()).map(|index| (index, shape(index))), &sight);
    let verdict = match first {
        _ if !first.may_be(found) => Verdict::Contradicted,
        FirstHits::Certain(_) => Verdict::Proven,
        FirstHits::OneOf { any, .. } if any.iter().all(|one| shape(one.object).is_certified()) => {
            Verdict::Tie
        }
        FirstHits::OneOf { .. } => Verdict::Uncertified,
    };
    Pixel { verdict, object: found }
}

/// Returns the verdicts on all pixels, row by row from the top. `done` is called after each row, and may break off.
///
/// # Errors
/// `Interrupted` if `done` broke off.
pub fn picture(
    renderer: &Renderer,
    plan: &Plan,
    done: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> io::Result<Vec<Pixel>> {
    let [_, height] = plan.camera.pixels;
    renderer
        .pixels(plan, 0..height, done, |x, y| pixel(plan, x, y))
        .ok_or_else(|| io::ErrorKind::Interrupted.into())
}
