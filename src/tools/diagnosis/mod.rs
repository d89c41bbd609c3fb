//! The reasons why an image is black, burnt or empty, in numbers, and the cures.

mod survey;

use crate::clock;
use crate::threads::renderer_with;
use glam::DVec3;
use std::ops::Range;
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::Duration;
use survey::Survey;
use tabray_core::exact::interval::Interval;
use tabray_core::geometry::aabb::Aabb;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace::{self, Scratch, Tracer};
use tabray_core::render::{DARK, Levels};
use tabray_core::scene::attribute::Pose;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::{Model, Object};
use tabray_core::simd::cpu::Cpu;
use tabray_core::text::{self, short};
use tabray_core::world::camera::Projected;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_core::world::rules::{Falloff, Rules};
use tabray_core::world::sensor::Sensor;

/// The maximum number of columns and rows of pixels that are looked at.
const GRID: [usize; 2] = [40, 30];

/// The same, where none of these shows an object although objects may fill the image.
const FINE_GRID: [usize; 2] = [80, 60];

/// The level that a cure aims at.
const GOOD: f64 = 128.0;

/// The share of pixels beyond which an image is burnt, and the light beyond which a pixel is.
const BURNT: f64 = 0.25;
const TOO_BRIGHT: f64 = 1.02;

/// The share of pixels beyond which an image is dark because surfaces do not light each other.
const UNLIT: f64 = 0.5;

/// The largest exposure of a camera, in stops, upward and downward.
const MAX_STOPS: f64 = 32.0;

/// The maximum number of lights that are named.
const NAMED: usize = 3;

/// The number of reflections and transmissions of the rays with which an image is tried.
const MAX_DEPTH: usize = 4;

/// The maximum number of pixels that are tried with all reflections and transmissions, if the image is black with fewer.
/// Between mirrors, such a pixel may take thousands of rays.
const MAX_DEEP: usize = 80;

/// The number of pixels that are tried at once.
const AT_ONCE: usize = 8;

/// The CPU time after which no further pixels are tried, and the time after which they are not waited for.
const PATIENCE: Duration = Duration::from_millis(1500);
const LAST: Duration = Duration::from_secs(6);

/// Something about an image that its author hardly meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// The fault and its reason, in lower case.
    pub message: String,
    /// The cure.
    pub help: String,
}

/// Returns the remark on a part of an image with these levels, at most one. Columns count from the left and
/// rows from the top.
pub fn remark(plan: &Plan, part: [&Range<usize>; 2], levels: &Levels) -> Option<Remark> {
    remark_on("the image is", plan, part, levels)
}

/// Returns the remark on a part of an image. A remark on black begins with these words.
fn remark_on(image: &str, plan: &Plan, part: [&Range<usize>; 2], levels: &Levels) -> Option<Remark> {
    if levels.pixels == 0 || plan.model.objects.is_empty() {
        return None;
    }
    let places = places(&plan.camera, part, GRID);
    let is_black = levels.brightest < DARK;
    empty(plan, &places, is_black).or_else(|| {
        if !is_black && !is_burnt(levels) {
            return flat(plan.model).or_else(|| unlit(plan.model, &places, levels));
        }
        // The plan of a picture leaves out lights.
        let mut plan = Plan::new(plan.model);
        plan.max_depth = MAX_DEPTH;
        let survey = Survey::of(&plan, &places);
        if is_black {
            Some(black(image, &plan, &survey, levels.brightest))
        } else {
            burnt(&plan, &survey, levels)
        }
    })
}

fn is_burnt(levels: &Levels) -> bool {
    levels.white as f64 > BURNT * levels.pixels as f64
}

/// Remarks that with one sample for each pixel, a background lights the scene from one direction, or rough surfaces
/// look smooth.
fn flat(model: &Model) -> Option<Remark> {
    let Sensor { samples, adaptive, .. } = &model.camera.value;
    if *samples != 1 || adaptive.is_some() {
        return None;
    }
    let said = |name: &str, what: &str| Remark {
        message: format!("`{name}` {what}"),
        help: "take more: `samples 64` in the camera, `--samples 64` or `--max-error 2`".to_owned(),
    };
    let sky = model.lights.iter().find(|light| light.args.entity().kind() == Kind::Background);
    let is_rough =
        |object: &&Object| object.material.interface.as_ref().is_some_and(|of| of.roughness() > 0.0);
    let lights = "lights the scene, but each pixel has one sample, which sees a single direction";
    let rough = "has a rough material, but each pixel has one sample, which shows it smooth";
    let of_sky = sky.map(|sky| said(sky.args.name(), lights));
    of_sky.or_else(|| model.objects.iter().find(is_rough).map(|object| said(object.args.name(), rough)))
}

/// Remarks that most of an image is in the shadow of lamps, where only other surfaces could light it.
fn unlit(model: &Model, places: &[[usize; 2]], levels: &Levels) -> Option<Remark> {
    let camera = &model.camera.value;
    let share = levels.dark as f64 / levels.pixels as f64;
    if camera.rules == Rules::Notes || camera.bounces != 0 || share <= UNLIT || model.lights.is_empty() {
        return None;
    }
    let mut plan = Plan::new(model);
    plan.set_adaptive(None);
    plan.camera.samples = 1;
    plan.max_depth = MAX_DEPTH;
    let survey = Survey::of(&plan, places);
    let unlit = survey.lamps.iter().map(|lamp| lamp.blocked + lamp.behind).max()?;
    (unlit as f64 > UNLIT * places.len() as f64).then(|| Remark {
        message: format!(
            "{:.0} % of the image is almost black: it lies in shadow, and matt surfaces do not light each other",
            100.0 * share
        ),
        help: "`bounces 4` and `samples 64` in the camera let them".to_owned(),
    })
}

/// Returns the remark on a model's image, from a few of its pixels, or on the time that these take.
pub fn tried(model: Arc<Model>) -> Option<Remark> {
    // The deepest reflections need more of a stack than the program's own thread has.
    let renderer = renderer_with(1).ok()?;
    let (sender, remark) = mpsc::channel();
    // A single pixel of a very long formula may take minutes. It is not waited for, and ends with the program.
    thread::Builder::new().spawn(move || sender.send(renderer.run(|| tried_here(&model)))).ok()?;
    remark.recv_timeout(LAST).unwrap_or_else(|_| Some(slow()))
}

/// Remarks that an image takes too long to be tried.
fn slow() -> Remark {
    Remark {
        message: "the image takes long, and could not be tried: it may be black or empty".to_owned(),
        help: "`tabray render --size 64` shows it sooner, and `--time-limit 1m` ends in time".to_owned(),
    }
}

fn tried_here(model: &Model) -> Option<Remark> {
    let [width, height] = model.camera.value.pixels;
    let part = [&(0..width), &(0..height)];
    let mut plan = Plan::new(model);
    plan.set_adaptive(None);
    plan.camera.samples = 1;
    let places = places(&plan.camera, part, GRID);
    let start = clock::now();
    let levels = |plan: &Plan, places: &[[usize; 2]]| {
        let (mut scratch, mut nobody, mut levels) = (Scratch::default(), Flaws::default(), Levels::default());
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        let (display, mut traced) = (plan.camera.display(), 0);
        while traced < places.len() {
            // Few enough that the time is checked in time.
            let some = &places[traced..places.len().min(traced + AT_ONCE)];
            let colours = tracer.pixels(some);
            (0..some.len()).for_each(|index| levels.add(&display.bytes(colours.get(index))));
            traced += some.len();
            if clock::now() - start > PATIENCE {
                return None;
            }
        }
        Some(levels)
    };
    plan.max_depth = MAX_DEPTH;
    let Some(mut found) = levels(&plan, &places) else { return Some(slow()) };
    plan.max_depth = usize::MAX;
    if found.brightest < DARK && plan.depth.is_some() {
        let step = places.len().div_ceil(MAX_DEEP).max(1);
        let few: Vec<_> = places.iter().skip(step / 2).step_by(step).copied().collect();
        let Some(deep) = levels(&plan, &few) else { return Some(slow()) };
        found = deep;
    }
    remark_on("the image seems to be", &plan, part, &found)
}

/// Returns pixels spread over a part of an image, by column and row from the bottom.
fn places(camera: &Sensor, [columns, rows]: [&Range<usize>; 2], grid: [usize; 2]) -> Vec<[usize; 2]> {
    let spread = |range: &Range<usize>, most: usize| -> Vec<usize> {
        let count = range.len().min(most);
        (0..count).map(|index| range.start + index * (range.len() - 1) / (count - 1).max(1)).collect()
    };
    let columns = spread(columns, grid[0]);
    let rows = spread(rows, grid[1]).into_iter().map(|row| camera.pixels[1] - 1 - row);
    rows.flat_map(|row| columns.iter().map(move |column| [*column, row])).collect()
}

/// Says that no object is in view, if none is.
fn empty(plan: &Plan, places: &[[usize; 2]], is_black: bool) -> Option<Remark> {
    let (model, camera) = (plan.model, &plan.camera);
    let is_hit = |[x, y]: &[usize; 2]| trace::first_hit(plan, &camera.sight(*x as f64, *y as f64)).is_some();
    // From the middle on, where objects usually are.
    let middle = places.len() / 2;
    if places[middle..].iter().chain(&places[..middle]).any(is_hit) {
        return None;
    }
    let bounds: Vec<Aabb> = model.objects.iter().filter_map(|object| object.shape.facts().bounds).collect();
    let is_shown = |bounds: &Aabb| {
        let point = bounds.middle();
        let Projected::At(at) = camera.project(point) else { return false };
        (0..2).all(|side| (-0.5..camera.pixels[side] as f64 - 0.5).contains(&at[side]))
    };
    let all = bounds.iter().copied().reduce(|one, other| one.and(&other));
    if bounds.iter().any(is_shown) {
        let all = all?;
        // What is smaller than the distance of the pixels may be missed, but not what fills the image.
        let is_before = |[x, y]: &&[usize; 2]| {
            camera.sight(*x as f64, *y as f64).line::<Interval>().clip(all.low, all.high).is_some()
        };
        let fills = !is_black && 2 * places.iter().filter(is_before).count() > places.len();
        let many = self::places(camera, [&(0..camera.pixels[0]), &(0..camera.pixels[1])], FINE_GRID);
        if !fills || many.iter().any(is_hit) {
            return None;
        }
        let help = format!(
            "no ray to {} pixels hits what may lie between {} and {}: a formula may be 0 nowhere there",
            many.len(),
            place(all.low),
            place(all.high)
        );
        return Some(Remark { message: "no object is in view".to_owned(), help });
    }
    let viewer = camera.origins().middle;
    let help = match all {
        None => format!("the viewer at {} looks past them", place(viewer)),
        Some(Aabb { low, high }) => {
            let target = model.camera.args.args();
            let target = target.values().find(|(attribute, _)| attribute.pose() == Some(Pose::Target));
            let cure = match target {
                Some((attribute, _)) => {
                    format!(": `{} {}` looks at their middle", attribute.name(), place(0.5 * (low + high)))
                }
                None => String::new(),
            };
            format!(
                "the viewer is at {}, and the objects lie between {} and {}{cure}",
                place(viewer),
                place(low),
                place(high)
            )
        }
    };
    Some(Remark { message: "no object is in view".to_owned(), help })
}

fn place(at: DVec3) -> String {
    at.to_array().map(rounded).join(" ")
}

/// Says why an image is black.
fn black(image: &str, plan: &Plan, survey: &Survey, brightest: u8) -> Remark {
    let (camera, display) = (&plan.camera, plan.camera.display());
    let by_notes = camera.rules == Rules::Notes;
    let rules = if by_notes { "under the notes' rules " } else { "" };
    let level = |light: f64| short(255.0 * display.shown(Rgb::splat(light)).x);
    let mut reasons = Vec::new();
    let lamps = survey.brightest();
    if survey.hits == 0 {
        reasons.push(format!(
            "none of {} that were looked at shows an object",
            text::count(survey.seen.len(), "pixel")
        ));
    }
    for light in lamps.iter().take(NAMED).filter(|_| survey.hits > 0) {
        let (lamp, name) = (&survey.lamps[*light], survey.name(*light));
        reasons.push(if lamp.shines == 0 {
            let clear = survey.hits - (lamp.blocked + lamp.behind + lamp.aside).min(survey.hits);
            let why = [
                (lamp.blocked, "in shadow"),
                (lamp.behind, "turned away"),
                (lamp.aside, "beside its beam"),
                (clear, "that scatter no light"),
            ];
            let why = why.iter().filter(|(places, _)| *places > 0);
            let why: Vec<_> = why.map(|(places, why)| format!("{places} {why}")).collect();
            format!(
                "{name} lights none of {} that were looked at ({})",
                text::count(survey.hits, "place"),
                why.join(", ")
            )
        } else {
            let away = if lamp.near.is_finite() {
                format!("is {} away, and ", units(lamp.near))
            } else {
                String::new()
            };
            format!("{name} {away}{rules}adds up to {} levels", level(lamp.most))
        });
    }
    let more = lamps.len().saturating_sub(NAMED);
    if more > 0 && survey.hits > 0 {
        reasons.push(format!("{} more add less", text::count(more, "light")));
    }
    if survey.ambient > 0.0 {
        let distance = if by_notes { format!(", seen from {}", units(survey.near)) } else { String::new() };
        reasons.push(format!("`ambient` adds up to {} levels{distance}", level(survey.ambient)));
    }
    let message = match brightest {
        0 => &format!("{image} black"),
        _ => &format!("{image} almost black, up to level {brightest} of 255"),
    };
    let message = if reasons.is_empty() {
        format!("{message}: there is no light, and no `ambient` that is seen")
    } else {
        format!("{message}: {}", reasons.join("; "))
    };
    Remark { message, help: brighter(survey, &lamps) }
}

/// Returns the changes that make an image brighter.
fn brighter(survey: &Survey, lamps: &[usize]) -> String {
    let (plan, display) = (survey.plan, survey.plan.camera.display());
    let mut cures = Vec::new();
    let lamp = lamps.first().map(|light| (*light, &survey.lamps[*light]));
    let lamp = lamp.filter(|(_, lamp)| lamp.most > 0.0);
    let good = light_of_level(&display, GOOD);
    let is_notes = plan.camera.rules == Rules::Notes;
    let free = survey.lamps.iter().map(|lamp| lamp.free).fold(survey.near * survey.ambient, f64::max);
    if is_notes && 255.0 * free >= f64::from(DARK) {
        cures.push("`rules free`, by which light does not depend on lengths".to_owned());
    }
    if let Some((light, lamp)) = lamp
        && let Some(sent) = plan.model.lights[light].value.brightest()
    {
        let (name, fading) = (survey.name(light), plan.model.lights[light].value.fading);
        if !is_notes && fading.falloff != Falloff::None {
            cures.push(format!("{name} with `at {}`", rounded(lamp.near)));
        }
        cures
            .push(format!("{name} with an emissivity of {}", rounded(sent.max_element() * good / lamp.most)));
    }
    let seen = survey.seen.iter().copied().fold(0.0, f64::max);
    if !is_notes && seen > 0.0 {
        let stops = libm::log2(good / seen) + plan.camera.exposure;
        if stops.abs() <= MAX_STOPS {
            cures.push(format!("`exposure {}`", rounded(stops)));
        }
    }
    if cures.is_empty() {
        return "`tabray probe` explains what the rays of a pixel meet, and which lights reach it".to_owned();
    }
    cures.join(", or ")
}

/// Says why an image is burnt, unless little of it is brighter than white.
fn burnt(plan: &Plan, survey: &Survey, levels: &Levels) -> Option<Remark> {
    let display = plan.camera.display();
    let mut seen: Vec<_> = survey.seen.iter().map(|light| light * display.gain()).collect();
    seen.sort_by(f64::total_cmp);
    let burnt = seen.iter().filter(|light| **light > TOO_BRIGHT).count();
    if burnt as f64 <= BURNT * seen.len() as f64 || survey.hits == 0 {
        return None;
    }
    let share = 100.0 * levels.white as f64 / levels.pixels as f64;
    let times = |light: f64| format!("{} times white", short(display.gain() * light));
    let lamps = survey.brightest().into_iter().take(NAMED).filter(|light| survey.lamps[*light].most > 0.0);
    let mut reasons: Vec<_> = lamps
        .map(|light| format!("{} adds up to {}", survey.name(light), times(survey.lamps[light].most)))
        .collect();
    if display.gain() * survey.ambient > TOO_BRIGHT {
        reasons.push(format!("`ambient` adds up to {}", times(survey.ambient)));
    }
    let reasons = if reasons.is_empty() { String::new() } else { format!(": {}", reasons.join("; ")) };
    let message = format!("{share:.0} % of the image is burnt to white{reasons}");
    // Only a tenth of the places is brighter than this light, which becomes white.
    let bright = seen[seen.len() * 9 / 10];
    let stops = plan.camera.exposure - (2.0 * libm::log2(bright)).ceil() / 2.0;
    let help = match plan.camera.rules {
        _ if stops.abs() > MAX_STOPS => format!("divide the emissivities by {}", rounded(bright)),
        Rules::Notes => format!(
            "divide the emissivities by {}, or render with `--exposure {}`",
            rounded(bright),
            rounded(stops)
        ),
        Rules::Free => {
            let camera = plan.model.camera.args.args();
            let meant = match camera.given().any(|(attribute, _)| attribute.name() == "rules") {
                true => "",
                false => {
                    "; if the lamps are meant for the notes' rules of light, give the camera `rules notes`"
                }
            };
            format!(
                "`exposure {}` shows it, and `tone neutral` keeps what is brighter{meant}",
                rounded(stops)
            )
        }
    };
    Some(Remark { message, help })
}

/// Returns the grey light of a level.
fn light_of_level(display: &Display, level: f64) -> f64 {
    display.light_of(level as u8) / display.gain()
}

/// Writes a number to two significant digits, as a scene has it.
fn rounded(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return short(number);
    }
    let digits = 1 - libm::log10(number.abs()).floor() as i32;
    let scale = libm::pow(10.0, f64::from(digits));
    text::shortest((number * scale).round() / scale)
}

fn units(length: f64) -> String {
    format!("{} units", short(length))
}
