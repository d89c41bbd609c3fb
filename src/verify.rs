//! Which object a pixel's ray meets first, proven, and compared with what the tracer finds.

use crate::certify::Enclosure;
use crate::model::Model;
use crate::render::Renderer;
use crate::trace;
use std::io;
use std::ops::ControlFlow;

/// What is proven of a pixel, of the ray through its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// The tracer finds the object that is certainly met first, or nothing where nothing is.
    Proven,
    /// Rounding hides which object that is.
    #[default]
    Undecided,
    /// The tracer finds another one.
    Contradicted,
}

/// The verdict on a pixel, counted from the left and from the bottom.
pub fn pixel(model: &Model, x: usize, y: usize) -> Verdict {
    let ray = model.camera.value.ray(x as f64, y as f64);
    let found = trace::first_hit(model, &ray).map(|hit| hit.index);
    let enclosures = model.objects.iter().map(|object| object.shape.certify(&ray));
    match first(enclosures) {
        Some(first) if first == found => Verdict::Proven,
        Some(_) => Verdict::Contradicted,
        None => Verdict::Undecided,
    }
}

/// The object that is certainly met first, by its index, or that none is met; nothing where that is not certain.
fn first(enclosures: impl Iterator<Item = Enclosure>) -> Option<Option<usize>> {
    // The surest hit, and the nearest that anything else may be.
    let mut nearest: Option<(usize, f64, f64)> = None;
    let mut others = f64::INFINITY;
    for (index, enclosure) in enclosures.enumerate() {
        match enclosure {
            Enclosure::Misses => {}
            Enclosure::Doubtful(low) => others = others.min(low),
            Enclosure::Hits(at, _) => match nearest {
                Some((_, _, high)) if high <= at.high => others = others.min(at.low),
                _ => {
                    others = others.min(nearest.map_or(f64::INFINITY, |(_, low, _)| low));
                    nearest = Some((index, at.low, at.high));
                }
            },
        }
    }
    match nearest {
        Some((index, _, high)) => (high < others).then_some(Some(index)),
        None => (others == f64::INFINITY).then_some(None),
    }
}

/// The verdicts on all pixels, from the top and from the left. `done` is told of each row, and may break off.
///
/// # Errors
/// `Interrupted` where `done` broke off.
pub fn picture(
    renderer: &Renderer,
    model: &Model,
    done: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> io::Result<Vec<Verdict>> {
    let [_, height] = model.camera.value.pixels;
    let verdict = |x, y| pixel(model, x, y);
    renderer.pixels(model, 0..height, done, verdict).ok_or_else(|| io::ErrorKind::Interrupted.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;
    use crate::twofold::Twofold;

    const NEAR: Enclosure = hits(1.0, 2.0);
    const FAR: Enclosure = hits(3.0, 4.0);
    const BETWEEN: Enclosure = hits(1.5, 3.5);

    const fn hits(low: f64, high: f64) -> Enclosure {
        Enclosure::Hits(Interval { low, high }, Twofold { high: 0.5 * (low + high), low: 0.0 })
    }

    #[test]
    fn the_first_is_certain_only_where_nothing_may_lie_before() {
        for (enclosures, certain) in [
            (&[][..], Some(None)),
            (&[Enclosure::Misses], Some(None)),
            (&[FAR, Enclosure::Misses, NEAR], Some(Some(2))),
            (&[NEAR, FAR], Some(Some(0))),
            (&[NEAR, BETWEEN], None),
            (&[BETWEEN, NEAR], None),
            (&[FAR, BETWEEN, NEAR], None),
            (&[NEAR, Enclosure::Doubtful(2.5)], Some(Some(0))),
            (&[Enclosure::Doubtful(1.5), NEAR], None),
            (&[Enclosure::Doubtful(1.5)], None),
        ] {
            assert_eq!(first(enclosures.iter().copied()), certain, "{enclosures:?}");
        }
    }
}
