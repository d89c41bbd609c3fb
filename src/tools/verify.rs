//! Proves which object a pixel's ray hits first, and compares it with what the tracer finds.

use f256::f256;
use std::io;
use std::ops::ControlFlow;
use tabray_core::geometry::sight::Sight;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::world::certify::{Enclosure, Precision};
use tabray_exact::interval::{Float, Wide};

/// The verdict on a pixel, for the exact ray through its centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// The tracer finds the object that is certainly hit first, or nothing where nothing is hit.
    Proven,
    /// 237 bits do not decide which of several objects is hit first, or whether an object is touched: a tie, as where
    /// two surfaces coincide. The tracer finds one of the objects in question.
    #[default]
    Tie,
    /// A shape without an equation may be hit first, since the ray meets its bounds before any proven hit. The tracer finds
    /// one of the objects in question.
    Uncertified,
    /// The tracer finds another object.
    Contradicted,
}

/// The objects that may be hit first.
#[derive(Debug, PartialEq)]
enum FirstHits {
    /// This object, by its index, or nothing: for certain.
    Certain(Option<usize>),
    /// One of these objects, by index, or nothing.
    OneOf(Vec<Option<usize>>),
}

/// Returns the verdict on a pixel: `x` counts from the left, `y` from the bottom.
pub fn pixel(plan: &Plan, x: usize, y: usize) -> Verdict {
    let sight = plan.camera.sight(x as f64, y as f64);
    let found = trace::first_hit(plan, &sight).map(|hit| hit.index);
    match first_of(plan.model, &sight) {
        FirstHits::Certain(first) if first == found => Verdict::Proven,
        FirstHits::OneOf(any) if any.contains(&found) => {
            let is_certified = |index: usize| plan.model.objects[index].shape.is_certified();
            if any.into_iter().flatten().all(is_certified) { Verdict::Tie } else { Verdict::Uncertified }
        }
        _ => Verdict::Contradicted,
    }
}

fn first_of(model: &Model, sight: &Sight) -> FirstHits {
    let certify = |index: usize, precision| (index, model.objects[index].shape.certify(sight, precision));
    let all: Vec<_> = (0..model.objects.len()).map(|index| certify(index, Precision::Double)).collect();
    match first(&all) {
        FirstHits::OneOf(any) => {
            let any: Vec<_> =
                any.into_iter().flatten().map(|index| certify(index, Precision::Octuple)).collect();
            first(&any)
        }
        certain => certain,
    }
}

/// Returns which of the objects may be hit first, given an enclosure of each object's distance.
fn first(enclosures: &[(usize, Enclosure)]) -> FirstHits {
    // Some object is certainly hit at this distance or nearer.
    let end = enclosures.iter().filter_map(|(_, enclosure)| match enclosure {
        Enclosure::Hits(at) => Some(at.high),
        _ => None,
    });
    let end = end.fold(f256::INFINITY, Float::min);
    let mut candidates = enclosures.iter().filter(|(_, enclosure)| match enclosure {
        Enclosure::Misses => false,
        Enclosure::Hits(Wide { low, .. }) | Enclosure::Edge(Wide { low, .. }) | Enclosure::Doubtful(low) => {
            *low <= end
        }
    });
    let is_something = end < f256::INFINITY;
    match (candidates.next(), candidates.next()) {
        (None, _) => FirstHits::Certain(None),
        (Some((index, Enclosure::Hits(_))), None) => FirstHits::Certain(Some(*index)),
        (Some((one, _)), other) => {
            let others = other.into_iter().chain(candidates).map(|(index, _)| *index);
            let any = [*one].into_iter().chain(others).map(Some);
            FirstHits::OneOf(any.chain((!is_something).then_some(None)).collect())
        }
    }
}

/// Returns the verdicts on all pixels, row by row from the top. `done` is called after each row, and may break off.
///
/// # Errors
/// `Interrupted` if `done` broke off.
pub fn picture(
    renderer: &Renderer,
    plan: &Plan,
    done: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> io::Result<Vec<Verdict>> {
    let [_, height] = plan.camera.pixels;
    let verdict = |x, y| pixel(plan, x, y);
    renderer.pixels(plan, 0..height, done, verdict).ok_or_else(|| io::ErrorKind::Interrupted.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_exact::interval::Interval;

    fn hits(low: f64, high: f64) -> Enclosure {
        Enclosure::Hits(Interval { low, high }.into())
    }

    fn doubtful(from: f64) -> Enclosure {
        Enclosure::Doubtful(from.into())
    }

    #[test]
    fn the_first_is_certain_only_where_nothing_may_lie_before() {
        let (near, far, between) = (hits(1.0, 2.0), hits(3.0, 4.0), hits(1.5, 3.5));
        let one_of = |any: &[Option<usize>]| FirstHits::OneOf(any.to_vec());
        for (enclosures, right) in [
            (&[][..], FirstHits::Certain(None)),
            (&[Enclosure::Misses], FirstHits::Certain(None)),
            (&[far, Enclosure::Misses, near], FirstHits::Certain(Some(2))),
            (&[near, far], FirstHits::Certain(Some(0))),
            (&[near, between], one_of(&[Some(0), Some(1)])),
            (&[between, near], one_of(&[Some(0), Some(1)])),
            (&[far, between, near], one_of(&[Some(1), Some(2)])),
            (&[near, doubtful(2.5)], FirstHits::Certain(Some(0))),
            (&[doubtful(1.5), near], one_of(&[Some(0), Some(1)])),
            (&[doubtful(1.5)], one_of(&[Some(0), None])),
        ] {
            let numbered: Vec<_> = enclosures.iter().copied().enumerate().collect();
            assert_eq!(first(&numbered), right, "{enclosures:?}");
        }
    }
}
