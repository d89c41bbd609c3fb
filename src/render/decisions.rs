//! A plan's decisions as text, each with its reason.

use crate::features::{FEATURE_SAMPLES, Features};
use crate::footprint::{MAX_CUTS, MAX_FOOTPRINTS};
use crate::limits::{MAX_DIST, MAX_RAYS, of_pixel};
use crate::plan::depth::Depth;
use crate::plan::needs::{self, Needs};
use crate::plan::{Plan, TREE};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;
use tabray_world::accuracy::Accuracy;
use tabray_world::material::{Material, Rgb};
use tabray_world::rules::Rules;
use tabray_world::sample::Sampler;
use tabray_world::scene::model::{Item, Model, Object};
use tabray_world::scene::store::Record;
use tabray_world::sensor::{Adaptive, Sensor};
use tabray_world::text::{count, list, short};
use tabray_world::texture::Texture;

/// The maximum number of names that are listed.
const NAMED: usize = 4;

/// The effect of a light, in levels, up to which a decision calls attention to it.
const FAINT: f64 = 2.0;

/// A decision, and the reason for it.
pub struct Decision {
    /// The subject of the decision, in a word.
    pub subject: &'static str,
    /// The decision and its reason.
    pub text: String,
}

/// One row of a table, without the newline.
impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<12} {}", self.subject, self.text)
    }
}

/// Lists all decisions of a plan.
pub fn of(plan: &Plan) -> Vec<Decision> {
    let model = plan.model;
    let decision = |subject, text| Decision { subject, text };
    let mut all = vec![
        decision("image", picture(&plan.camera)),
        decision("accuracy", model.camera.value.accuracy.to_string()),
        decision("lights", lights(plan)),
    ];
    if model.camera.value.rules == Rules::Free {
        all.insert(2, decision("rules", "free: no light is divided by the length of its path".to_owned()));
    }
    if !plan.needs.lights.is_empty() {
        all.push(decision("shadows", shadows(plan)));
    }
    all.extend(bounces(&plan.camera).map(|text| decision("bounces", text)));
    all.push(decision("glass", glass(plan)));
    all.push(decision("mirrors", mirrors(plan)));
    all.extend(plan.depth.as_ref().map(|depth| decision("depth", self::depth(model, depth))));
    all.extend(textures(plan).into_iter().map(|text| decision("texture", text)));
    all.extend(unreached(plan).map(|text| decision("unmet", text)));
    all.push(decision("search", search(model, plan)));
    all.extend(plan.features.as_ref().map(|features| decision("small", small(features))));
    all.extend(plan.prover.is_some().then(|| decision("certain", certain())));
    all.extend(objects(plan));
    all
}

fn picture(camera: &Sensor) -> String {
    let Sensor { pixels: [width, height], samples, sampler, .. } = *camera;
    let size = format!("{width} x {height} pixels");
    if let Some(Adaptive { most, error }) = camera.adaptive {
        let kind = match sampler {
            Sampler::Sobol => "evenly spread",
            Sampler::Random => "random",
        };
        let until = match error {
            Some(error) => {
                format!("until its error is estimated to be at most {} of 255 levels", short(255.0 * error))
            }
            None => "where its colour is less certain".to_owned(),
        };
        let each =
            if camera.certain { "each pixel whose error is not proven to be within that" } else { "each" };
        return format!("{size}, {samples} to {most} {kind} samples in {each}: more {until}");
    }
    let rays = (width * height) as u64 * u64::from(samples);
    match (samples, sampler) {
        (1, _) => {
            format!("{size}, one sample at the centre of each and no random numbers: {rays} primary rays")
        }
        (_, Sampler::Sobol) => {
            format!("{size}, {samples} evenly spread samples in each: {rays} primary rays")
        }
        (_, Sampler::Random) => {
            format!("{size}, {samples} random samples in each: {rays} primary rays")
        }
    }
}

fn certain() -> String {
    format!(
        "all rays through a pixel are enclosed at once, in up to {MAX_FOOTPRINTS} footprints, each cut into quarters up to \
         {MAX_CUTS} times: where that proves the error, the pixel takes no samples"
    )
}

fn bounces(camera: &Sensor) -> Option<String> {
    let surfaces = match camera.bounces {
        0 => return None,
        1 => "one surface".to_owned(),
        bounces => format!("up to {bounces} surfaces"),
    };
    Some(format!(
        "light reaches matt surfaces by {surfaces}, each sample along one path; nothing is left out"
    ))
}

fn lights(plan: &Plan) -> String {
    let model = plan.model;
    let name = |index: usize| model.lights[index].args.name();
    let names = some(plan.needs.lights.iter().map(|index| name(*index)));
    let cast = match plan.needs.lights.len() {
        0 => "none: surfaces show their ambient colour, and no shadow rays are cast".to_owned(),
        1 => format!("{names}: a shadow ray from each point that faces it and reflects its light"),
        _ => {
            format!("{names}: from each point that reflects light, a shadow ray to each light that it faces")
        }
    };
    let dark = plan.needs.dark.iter().take(NAMED);
    let dark = dark.map(|(index, why)| format!("; `{}` is left out, as {}", name(*index), why.reason()));
    let more = plan.needs.dark.len().saturating_sub(NAMED);
    let more = (more > 0).then(|| format!("; {more} more are left out"));
    let levels = needs::most_levels(model);
    let faint = plan.needs.lights.iter().filter(|index| levels[**index] <= FAINT).take(NAMED);
    let faint = faint.map(|index| {
        format!("; `{}` changes no pixel by more than {} of 255 levels", name(*index), short(levels[*index]))
    });
    cast + &dark.chain(more).chain(faint).collect::<String>()
}

fn shadows(plan: &Plan) -> String {
    if plan.has_glass {
        "tinted: light may pass through glass, so shadow rays look for the first object on their way, and then the next"
    } else {
        "opaque: nothing transmits light, so any object on the way ends the search"
    }
    .to_owned()
}

fn glass(plan: &Plan) -> String {
    let glass = some(kept(plan).filter(|(_, object)| object.material.transparency != 0.0).map(named));
    let thin = some(kept(plan).filter(|(_, object)| object.shader.covers_in_part()).map(named));
    let glass = (!glass.is_empty()).then(|| format!("{glass}: each ray that hits one is transmitted"));
    let thin = (!thin.is_empty()).then(|| format!("{thin}: rays pass through what it does not cover"));
    match (glass, thin) {
        (None, None) => "none: no object is transparent, and no rays are transmitted".to_owned(),
        (Some(glass), Some(thin)) => format!("{glass}; {thin}"),
        (one, other) => one.or(other).unwrap_or_default(),
    }
}

fn mirrors(plan: &Plan) -> String {
    let is_mirror = |material: &Material| material.specular != Rgb::ZERO || material.interface.is_some();
    let mirrors = || kept(plan).filter(|(_, object)| is_mirror(&object.material));
    // As long as there is a bound on all light, rays that return none are not followed.
    let is_blind = |index: usize| {
        plan.depth
            .as_ref()
            .is_some_and(|depth| depth.most.is_finite() && plan.continuation(index).mirrored.faint == 0.0)
    };
    let names = some(mirrors().filter(|(index, _)| !is_blind(*index)).map(named));
    let blind = some(mirrors().filter(|(index, _)| is_blind(*index)).map(named));
    let blind =
        (!blind.is_empty()).then(|| format!("{blind}: no light comes from where rays would be reflected to"));
    match (names.is_empty(), blind) {
        (true, None) => "none: no object has a specular material, and no rays are reflected".to_owned(),
        (true, Some(blind)) => format!("none: no rays are reflected by {blind}"),
        (false, None) => format!("{names}: each ray that hits one is reflected"),
        (false, Some(blind)) => format!("{names}: each ray that hits one is reflected; none by {blind}"),
    }
}

/// Describes the objects that are left out, if there are any.
fn unreached(plan: &Plan) -> Option<String> {
    let Needs { unreached, clearance, .. } = &plan.needs;
    let names = some(unreached.iter().map(|index| plan.model.objects[*index].args.name()));
    let apart = short(*clearance);
    (!unreached.is_empty()).then(|| {
        format!("{names}: left out, as no ray from the viewer, off a mirror or to a light comes within {apart} of them")
    })
}

/// Returns the objects that are not left out, with their indices.
fn kept<'p>(plan: &'p Plan) -> impl Iterator<Item = (usize, &'p Object)> {
    let mut unreached = plan.needs.unreached.iter().peekable();
    plan.model.objects.iter().enumerate().filter(move |(index, _)| unreached.next_if_eq(&index).is_none())
}

fn named((_, object): (usize, &Object)) -> &str {
    object.args.name()
}

fn depth(model: &Model, depth: &Depth) -> String {
    if model.camera.value.rules == Rules::Free {
        return free_depth(model, depth);
    }
    let ends = format!(
        "when its path is {MAX_DIST} units long, or when all rays that follow from one of the viewer's have taken the work \
         of {MAX_RAYS} simple ones (a lower `specular` or `transparency` ends them sooner)"
    );
    let bound = || {
        let rest = if model.background.is_some() { ", except that of the background" } else { "" };
        format!("no light is brighter than {} divided by the length of its path{rest}", short(depth.most))
    };
    match (model.camera.value.accuracy, depth.most.is_finite()) {
        (Accuracy::Classic, true) => format!("as in the notes, a branch ends {ends}; {}", bound()),
        (_, true) => {
            format!("a branch ends when it can add less than 1/1024 of a level, {ends}; {}", bound())
        }
        (_, false) => {
            format!("a branch ends {ends}: nothing bounds what it adds, as {}", no_bound(model, depth))
        }
    }
}

/// Describes how rays end under the free rules.
fn free_depth(model: &Model, depth: &Depth) -> String {
    let [rays, work] = of_pixel(model.camera.value.bounces);
    let order = format!(
        "the heaviest rays are followed first, in each pixel at most {rays} rays, or the work of {work} simple ones"
    );
    if !depth.most.is_finite() {
        return format!("{order}: nothing bounds what they add, as {}", no_bound(model, depth));
    }
    let most = short(depth.most);
    format!(
        "{order}; a pixel is finished when the rays that are left change it by less than 1/16 of a level; no light is \
         brighter than {most}"
    )
}

/// Returns why nothing bounds what rays add.
fn no_bound(model: &Model, depth: &Depth) -> String {
    let mut all = model.objects.iter().zip(&depth.objects);
    match all.find(|(_, continuation)| !continuation.own.is_finite()) {
        Some((object, _)) => format!("`{}` may have any brightness", object.args.name()),
        None => "mirrors and glass pass on as much light as they receive".to_owned(),
    }
}

fn textures<'m>(plan: &Plan<'m>) -> Vec<String> {
    let model = plan.model;
    if model.textures.is_empty() {
        return Vec::new();
    }
    // For each texture, the names of the entities that use it, and whether any of them is needed.
    let mut users: HashMap<String, (Vec<&str>, bool)> = HashMap::new();
    let mut memory = None;
    let mut add = |record: &'m Record, is_needed: bool| {
        for texture in record.args_in(&mut memory).textures() {
            let (names, is_any_needed) = users.entry(texture.to_owned()).or_default();
            names.push(record.name());
            *is_any_needed |= is_needed;
        }
    };
    let mut unreached = plan.needs.unreached.iter().peekable();
    for (index, object) in model.objects.iter().enumerate() {
        add(&object.args, unreached.next_if_eq(&&index).is_none());
    }
    let mut lit = plan.needs.lights.iter().peekable();
    for (index, light) in model.lights.iter().enumerate() {
        add(&light.args, lit.next_if_eq(&&index).is_some());
    }
    model.background.iter().for_each(|background| add(&background.args, true));
    let text = |item: &Item<Arc<Texture>>| {
        let name = item.args.name();
        let Some((its, is_needed)) = users.get(name) else {
            return format!("`{name}` is not read: nothing uses it");
        };
        let [width, height] = item.value.size();
        let rest = if *is_needed { "" } else { ", which is left out" };
        let its = some(its.iter().copied());
        format!("`{name}` of {width} x {height} texels, read once: used by {its}{rest}")
    };
    model.textures.iter().map(text).collect()
}

fn search(model: &Model, plan: &Plan) -> String {
    let bounded = model.objects.len() - plan.needs.unreached.len() - plan.unbounded.len();
    let listed = plan.unbounded.len() + plan.bounded.len();
    let by_one = match model.camera.value.accuracy {
        Accuracy::Classic => "every ray is tested against each object",
        _ => "a packet of rays skips those that are not in its way",
    };
    match (&plan.tree, bounded) {
        (Some(tree), _) => {
            let rest =
                if listed > 0 { format!(", and a list of the {listed} without") } else { String::new() };
            format!(
                "a BVH of {} for the {bounded} objects with bounds, as it pays off from {TREE} on{rest}",
                count(tree.size(), "node")
            )
        }
        (None, 0) => format!("a list of {}: none has bounds; {by_one}", count(listed, "object")),
        (None, _) => format!(
            "a list of {}, {bounded} with bounds: a BVH pays off from {TREE} on; {by_one}",
            count(listed, "object")
        ),
    }
}

fn small(features: &Features) -> String {
    match features.count() {
        None => format!(
            "unknown: the camera does not say where objects are seen, so each pixel takes {FEATURE_SAMPLES} samples"
        ),
        Some(0) => "none: no bounds of an object are projected on less than 2 pixels".to_owned(),
        Some(small) => format!(
            "{} with bounds on less than 2 pixels across or down: a pixel with one takes {FEATURE_SAMPLES} samples",
            count(small, "object")
        ),
    }
}

/// Describes the objects; consecutive objects of the same kind and method share a line.
fn objects(plan: &Plan) -> Vec<Decision> {
    let mut groups: Vec<(&'static str, String, Vec<&str>)> = Vec::new();
    for (_, object) in kept(plan) {
        let place = match (&plan.tree, object.shape.culling_bounds()) {
            (Some(_), Some(_)) => "in the BVH",
            (None, Some(_)) => "with bounds",
            (_, None) => "without bounds",
        };
        let (kind, text) = (object.args.entity().name, format!("{place}: {}", object.shape.method()));
        match groups.last_mut() {
            Some((last, same, names)) if *last == kind && *same == text => names.push(object.args.name()),
            _ => groups.push((kind, text, vec![object.args.name()])),
        }
    }
    let line = |(subject, text, names): (_, String, Vec<&str>)| Decision {
        subject,
        text: format!("{} {text}", some(names)),
    };
    groups.into_iter().map(line).collect()
}

/// Lists the first [`NAMED`] names, and how many more there are.
fn some<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    let mut names: Vec<_> = names.into_iter().collect();
    // A solid, and a mesh of several materials, consists of objects of one name.
    names.dedup();
    match names.len().checked_sub(NAMED) {
        Some(more) if more > 1 => format!("{} and {more} more", list(names[..NAMED].iter().copied())),
        _ => list(names),
    }
}
