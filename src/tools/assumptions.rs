//! The assumptions of proofs about a scene, and the shapes about which proofs say nothing.

use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;
use tabray_core::geometry::sight::Rounded;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::{Model, Object};
use tabray_core::text;
use tabray_core::world::certify::{Assumption, Premise};

/// An assumption of the proofs about a scene.
#[derive(Debug, PartialEq, Serialize)]
pub struct Assumed {
    /// The numbers that are taken as exact.
    #[serde(serialize_with = "displayed")]
    pub assumed: Assumption,
    /// The types of the entities whose numbers these are, in the order of the scene.
    pub of: Vec<&'static str>,
}

/// Displays the assumption, and the entity types that it is about.
impl fmt::Display for Assumed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.assumed, text::list(self.of.iter().copied()))
    }
}

/// Lists what proofs about a scene assume. Proofs of colours may assume more than those of objects.
pub fn of(plan: &Plan, for_colours: bool) -> Vec<Assumed> {
    let model = plan.model;
    let mut all: BTreeMap<Assumption, Vec<&'static str>> = BTreeMap::new();
    let mut add = |assumption, of| {
        let types = all.entry(assumption).or_default();
        if !types.contains(&of) {
            types.push(of);
        }
    };
    let camera = model.camera.args.entity().name;
    match plan.camera.sight(0.0, 0.0).rounded() {
        Rounded::Nothing => {}
        Rounded::Start => add(Assumption::Starts, camera),
        Rounded::Ray => add(Assumption::Rays, camera),
    }
    each_premise(model, &mut |of, premise| match premise {
        Premise::Assumed(Assumption::Normals) if !for_colours => {}
        Premise::Assumed(assumption) => add(assumption, of),
        Premise::NoEquation => {}
    });
    all.into_iter().map(|(assumed, of)| Assumed { assumed, of }).collect()
}

/// Lists the types of shapes without an equation, in the order of the scene. Of their hits, only the bounds are
/// proven.
pub fn uncertified(model: &Model) -> Vec<&'static str> {
    let mut types = Vec::new();
    each_premise(model, &mut |of, premise| {
        if premise == Premise::NoEquation && !types.contains(&of) {
            types.push(of);
        }
    });
    types
}

/// Passes on the premises of proofs about each object of a scene, each with its entity type.
fn each_premise(model: &Model, each: &mut dyn FnMut(&'static str, Premise)) {
    for Object { shape, args, .. } in &model.objects {
        shape.premises(args.entity().name, each);
    }
}

fn displayed<S: Serializer>(assumption: &Assumption, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(assumption)
}
