//! Proves which object a pixel's ray hits first, and compares it with what the tracer finds.

use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::io;
use std::ops::{ControlFlow, Range};
use tabray_core::query::first::{FirstHits, first_of};
use tabray_core::query::is_contradicted;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::shapes::by_method::is_searched;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::certify::Precise;

/// The number of an image's pixels that are tried.
const TRIED: usize = 64;

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
        FirstHits::OneOf { any, .. } if any.iter().all(|(index, _)| shape(*index).is_certified()) => {
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

/// How many pixels of an image were tried, and at how many of them the tracer certainly finds another object than the
/// first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trial {
    /// The pixels that were tried.
    pub pixels: usize,
    /// Those of them where the tracer finds another object.
    pub contradicted: usize,
}

/// Tells whether hits of a scene are searched for: whether it has a solid, or a formula that is no mere quadric.
pub fn is_searched_for(model: &Model) -> bool {
    let has_faces =
        |shape: &AnyShape| shape.proven().is_some_and(|proven| f64::proofs(proven).face_of(0).is_some());
    model.objects.iter().map(|object| &object.shape).any(|shape| {
        shape.is_of_solid() || is_searched(shape) || shape.facts().may_be_costly && !has_faces(shape)
    })
}

/// Tries a few pixels of a part of an image, with proofs of 53 bits, until `is_over`. Columns count from the left and
/// rows from the top. `name` alone decides which pixels are tried, and in which order.
pub fn trial(
    plan: &Plan,
    [columns, rows]: [&Range<usize>; 2],
    name: &str,
    is_over: &dyn Fn() -> bool,
) -> Trial {
    let mut trial = Trial::default();
    for place in chosen(name, columns.len() * rows.len()) {
        if is_over() {
            break;
        }
        let (column, row) = (columns.start + place % columns.len(), rows.start + place / columns.len());
        let sight = plan.camera.sight(column as f64, (plan.camera.pixels[1] - 1 - row) as f64);
        trial.pixels += 1;
        trial.contradicted += usize::from(is_contradicted(plan, &sight));
    }
    trial
}

/// Returns up to [`TRIED`] different pixels of `count`, as a name chooses them.
fn chosen(name: &str, count: usize) -> impl Iterator<Item = usize> {
    let place = move |index: u64| {
        let hash = Sha256::new_with_prefix(name).chain_update(index.to_le_bytes()).finalize();
        let number = hash[..8].iter().fold(0u64, |all, byte| (all << 8) | u64::from(*byte));
        (number % count as u64) as usize
    };
    let mut known = BTreeSet::new();
    (0..).map(place).filter(move |place| known.insert(*place)).take(TRIED.min(count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::path::Path;
    use tabray_lang::reader;
    use tabray_lang::registry::Registry;

    fn model(objects: &str) -> Model {
        let text = format!(
            "camera eye {{ pixeldim 32 24 worlddim 8 6 viewpoint 4 3 8 }} material m {{ ambient 1 1 1 }} {objects}"
        );
        let registry = Registry::get().expect("no two plugins claim one name");
        let loaded = reader::read(registry, "scene", Path::new(""), text.as_bytes(), None);
        loaded.expect("a scene without faults").model
    }

    const BALL: &str = "sphere s { material m center 4 3 -3 radius 2 }";
    const IMPLICIT: &str =
        "implicit i { material m box 2 1 -5 6 5 -1 formula \"(x-4)^4 + (y-3)^4 + (z+3)^4 - 4\" }";

    #[test]
    fn hits_of_formulas_and_solids_are_searched_for() {
        let copy = format!("{IMPLICIT} place p {{ object i translation 1 0 0 }}");
        let solid =
            format!("{BALL} sphere t {{ material m center 5 3 -3 radius 2 }} union u {{ objects s t }}");
        let vase = "revsurf v { material m profile \"1 + y/4\" base 4 1 -3 direction 0 1 0 height 3 }";
        let patch = "parametric p { material m u 0 1 v 0 1 x \"3 + u\" y \"2 + v\" z \"-u*v\" }";
        for objects in [IMPLICIT, &copy, &solid, vase, patch] {
            assert!(is_searched_for(&model(objects)), "{objects}");
        }
        let plain =
            "plane f { material m normal 0 1 0 point 0 0 0 } box b { material m center 1 1 -2 size 1 1 1 }";
        assert!(!is_searched_for(&model(&format!("{BALL} {plain}"))));
    }

    #[test]
    fn a_name_chooses_the_pixels() {
        let of = |name: &str, count: usize| chosen(name, count).collect::<Vec<_>>();
        assert_eq!(of("a", 640 * 480).len(), 64);
        assert_eq!(of("a", 640 * 480), of("a", 640 * 480));
        assert_ne!(of("a", 640 * 480), of("b", 640 * 480));
        let mut few = of("a", 6);
        few.sort_unstable();
        assert_eq!(few, [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_trial_ends_when_its_time_is_over() {
        let model = model(IMPLICIT);
        let plan = Plan::for_picture(&model);
        let tried = Cell::new(0);
        let ten = trial(&plan, [&(4..28), &(2..20)], "a", &|| tried.replace(tried.get() + 1) == 10);
        assert_eq!(ten, Trial { pixels: 10, contradicted: 0 });
    }
}
