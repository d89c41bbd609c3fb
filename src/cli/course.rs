//! Says where the default, and the course's own image, differ from an image that was rendered with the course's methods.

mod edges;

use crate::files::input::Source;
use crate::process::messages;
use tabray_core::geometry::ray::Side;
use tabray_core::scene::model::{Model, Object};
use tabray_core::scene::value::Datum;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::material::Rgb;
use tabray_lang::registry::Registry;

/// The maximum number of objects of a scene that is compared: the course's scenes have few, and none of them from a
/// file; each is made twice.
const MAX_OBJECTS: usize = 1000;

/// The maximum number of objects times pixels of an image whose rays are searched for edges.
const MAX_RAYS: usize = 1 << 24;

/// The maximum number of objects that are named for each reason.
const NAMED: usize = 4;

/// Objects at which images may differ, and the reason.
struct Difference {
    objects: Vec<String>,
    reason: &'static str,
}

/// Where images of a scene may differ from one of the course's methods.
#[derive(Default)]
pub struct Differences {
    /// Where that of the default may.
    default: Vec<Difference>,
    /// Where the course's own may.
    course: Vec<Difference>,
}

impl Differences {
    /// Examines the objects of a scene that is rendered with the course's methods.
    pub fn of(registry: &Registry, source: &Source, model: &Model) -> Self {
        let is_large = || {
            model.objects.len() > MAX_OBJECTS
                || model.objects.iter().any(|object| object.args.entity().reads_files())
        };
        if model.camera.value.accuracy != Accuracy::Classic || messages::is_quiet() || is_large() {
            return Self::default();
        }
        let Ok(exact) = source.load(registry, Some(Accuracy::Exact)) else { return Self::default() };
        Self { default: of_default(model, &exact.model), course: of_course(model) }
    }

    /// Prints where the images may differ, if they may.
    pub fn print(&self) {
        for (differences, beginning) in [
            (&self.default, "this is the course's own method; the default, exact, differs at"),
            (&self.course, "the course's own image may differ at"),
        ] {
            let parts: Vec<_> = differences.iter().map(Difference::describe).collect();
            if !parts.is_empty() {
                messages::note(&format!("{beginning} {}: see docs/course.md", parts.join(", and at ")));
            }
        }
    }
}

impl Difference {
    fn describe(&self) -> String {
        let mut named: Vec<_> = self.objects.iter().take(NAMED).map(String::as_str).collect();
        let more = format!("{} more", self.objects.len().saturating_sub(NAMED));
        if self.objects.len() > NAMED {
            named.push(&more);
        }
        format!("{} ({})", text::and(&named), self.reason)
    }
}

/// The reason of a difference, and whether it applies to an object.
type Reason<'a> = (&'static str, &'a dyn Fn(&Object) -> bool);

/// Returns the differences at the objects of a scene for which there is a reason.
fn differences<'o>(objects: impl Iterator<Item = &'o Object>, reasons: &[Reason]) -> Vec<Difference> {
    let objects: Vec<_> = objects.collect();
    let differences = reasons.iter().map(|(reason, applies)| {
        let named = objects.iter().filter(|object| applies(object));
        let name = |object: &&Object| format!("{} `{}`", object.args.entity().name, object.args.name());
        Difference { objects: named.map(name).collect(), reason }
    });
    differences.filter(|difference| !difference.objects.is_empty()).collect()
}

/// Returns where the default's image may differ from that of the course's methods.
fn of_default(classic: &Model, exact: &Model) -> Vec<Difference> {
    let pairs = || classic.objects.iter().zip(&exact.objects);
    let differing = |side: Side| {
        let differs = move |(classic, exact): &(&Object, &Object)| {
            classic.shape.can_hit_itself(side) != exact.shape.can_hit_itself(side)
        };
        pairs().filter(differs).map(|(classic, _)| classic)
    };
    let is_lost = |object: &Object| differing(Side::Outside).any(|lost| std::ptr::eq(lost, object));
    let goes_on = |object: &Object| !classic.lights.is_empty() || object.material.specular != Rgb::ZERO;
    let viewer = classic.camera.value.origins().middle;
    let is_around_viewer = |object: &Object| {
        let bounds = object.shape.facts().bounds;
        bounds.is_some_and(|bounds| bounds.low.cmple(viewer).all() && viewer.cmple(bounds.high).all())
    };
    let is_glass = |object: &Object| object.material.transparency != 0.0;
    let mut all = differences(
        differing(Side::Outside),
        &[
            (
                "silhouettes that the course's method loses, and where the surface is not convex, its shadow on itself",
                &goes_on,
            ),
            ("silhouettes that the course's method loses", &|object| !goes_on(object)),
        ],
    );
    all.extend(differences(
        differing(Side::Inside).filter(|object| !is_lost(object)),
        &[
            ("light through the glass, which its far wall tints once more", &is_glass),
            ("far walls around the viewer, which the course's method never hits", &|object| {
                !is_glass(object) && is_around_viewer(object)
            }),
        ],
    ));
    all
}

/// Returns where the course's own image may differ from that of its methods, by the mistakes of its programs.
fn of_course(model: &Model) -> Vec<Difference> {
    let Model { objects, lights, .. } = model;
    let is_lit = |object: &Object| {
        let is_bright = object.material.diffuse != Rgb::ZERO || object.material.shininess != 0.0;
        !lights.is_empty() && is_bright
    };
    let is_glass = |object: &Object| object.material.transparency != 0.0;
    let is_patterned = |object: &Object| object.shader.uniform(&object.material).is_none();
    let is_mirror = |object: &Object| object.material.specular != Rgb::ZERO;
    let is_mirrored =
        |object: &Object| objects.iter().any(|mirror| is_mirror(mirror) && !std::ptr::eq(mirror, object));
    let is_cone = |object: &Object| matches!(object.args.args().find("surfer"), Some(Datum::Choice(profile)) if profile.name == "cone");
    let mut all = differences(
        objects.iter(),
        &[
            ("the slope of the cone, which is -4/6, and -8/6 in the course's program", &|object| {
                is_cone(object) && is_lit(object)
            }),
            (
                "light through the glass, which an older program of the course divided by the light's distance from the glass",
                &|object| is_glass(object) && !lights.is_empty() && objects.len() > 1,
            ),
            (
                "the pattern of the glass, for which the course's program takes the point of a shadow ray",
                &|object| is_glass(object) && is_patterned(object) && !lights.is_empty(),
            ),
            ("highlights in mirrors, which the course's program shifts", &|object| {
                is_lit(object) && is_mirror(object) && object.material.shininess != 0.0 && is_mirrored(object)
            }),
        ],
    );
    let sensor = &model.camera.value;
    if objects.len() * sensor.pixels[0] * sensor.pixels[1] <= MAX_RAYS {
        let reason = "rays exactly through an edge or between two texels, which the course's program rounds differently";
        all.extend(differences(objects.iter(), &[(reason, &|object| edges::are_met(sensor, object))]));
    }
    all
}
