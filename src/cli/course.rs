//! Says where the default differs from the course's own methods, after an image was rendered with these.

use crate::cli::files::input::Source;
use crate::cli::process::messages;
use crate::geometry::ray::Side;
use crate::scene::model::{Model, Object};
use crate::scene::registry::Registry;
use crate::text;
use crate::world::accuracy::Accuracy;

/// The maximum number of objects of a scene that is compared: the course's scenes have few, and none of them from a
/// file; each is made twice.
const MOST: usize = 1000;

/// The maximum number of objects that are named.
const NAMED: usize = 4;

/// The parts of a scene where the default may differ from an image of the course's methods.
#[derive(Default)]
pub struct Differences {
    /// The objects of which the default finds hits that the course's methods lose.
    lost: Vec<String>,
    /// The closed objects whose far walls only the default hits.
    walls: Vec<String>,
}

impl Differences {
    /// Compares the objects of a scene that is rendered with the course's methods to those of the default.
    pub fn of(registry: &Registry, source: &Source, model: &Model) -> Self {
        let mut differences = Self::default();
        let is_large = || {
            model.objects.len() > MOST
                || model.objects.iter().any(|object| object.args.entity().reads_files())
        };
        if model.camera.value.accuracy != Accuracy::Classic || messages::is_quiet() || is_large() {
            return differences;
        }
        let Ok(exact) = source.load(registry, Some(Accuracy::Exact)) else { return differences };
        for (classic, exact) in model.objects.iter().zip(&exact.model.objects) {
            let differs = |side: Side| classic.shape.can_hit_itself(side) != exact.shape.can_hit_itself(side);
            let name = format!("{} `{}`", classic.args.entity().name, classic.args.name());
            if differs(Side::Outside) {
                differences.lost.push(name);
            } else if differs(Side::Inside) && shows_inside(classic, model) {
                differences.walls.push(name);
            }
        }
        differences
    }

    /// Prints where the default may differ, if it may.
    pub fn print(&self) {
        let part = |names: &[String], what: &str| {
            let more = names.len().saturating_sub(NAMED);
            let mut named: Vec<_> = names.iter().take(NAMED).map(String::as_str).collect();
            let more = format!("{more} more");
            if names.len() > NAMED {
                named.push(&more);
            }
            (!names.is_empty()).then(|| format!("{} ({what})", text::and(&named)))
        };
        let lost = part(
            &self.lost,
            "silhouettes that the course's method loses, and places where rays that leave the surface hit it again",
        );
        let walls = part(&self.walls, "far walls, which the course's method never hits");
        let parts: Vec<_> = lost.into_iter().chain(walls).collect();
        if !parts.is_empty() {
            let parts = parts.join(", and at ");
            messages::note(&format!(
                "this is the course's own method; the default, exact, differs at {parts}: see docs/differences.md"
            ));
        }
    }
}

/// Tells whether rays start inside of a closed object: light passes through it, or the viewer is within its bounds.
fn shows_inside(object: &Object, model: &Model) -> bool {
    let viewer = model.camera.value.origins().middle;
    let is_around = object
        .shape
        .bounds()
        .is_some_and(|bounds| bounds.low.cmple(viewer).all() && viewer.cmple(bounds.high).all());
    object.material.transparency != 0.0 || is_around
}
