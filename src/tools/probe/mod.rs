//! Explains one pixel: its rays as an indented tree, with all tests, hits and sums on the way.

mod json;

use glam::DVec3;
pub use json::{PixelExplained, explained};
use std::io::{self, Write};
use tabray_core::geometry::ray::{MISS, Ray, RayRange};
use tabray_core::render::limits::{MAX_DIST, MAX_RAYS, MAX_TREE};
use tabray_core::render::observer::{DropReason, Event, Hit, LightOutcome, RayPurpose, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace::{self};
use tabray_core::scene::model::Model;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_core::world::rules::Rules;

/// The greatest depth of a ray up to which indentation grows: between parallel mirrors it would otherwise fill the
/// line.
const MAX_INDENT: usize = 20;

/// Explains a pixel: `x` counts from the left and `y` from the bottom. If it has several samples, explains the ray
/// through the centre of the pixel, and then gives the colour of all samples.
///
/// # Errors
/// Returns the errors of `out`.
pub fn pixel(plan: &Plan, x: usize, y: usize, out: &mut impl Write) -> io::Result<()> {
    let camera = &plan.camera;
    let [width, height] = camera.pixels;
    writeln!(out, "pixel {x} from the left and {y} from the bottom, of {width} x {height}\n")?;
    if camera.samples > 1 {
        writeln!(out, "of its {} samples, the one that would be at its centre:\n", camera.samples)?;
    }
    let mut probe = Probe {
        model: plan.model,
        is_free: camera.rules == Rules::Free,
        followed: 0,
        out,
        outcome: Ok(()),
        depth: 0,
        search: None,
        light: None,
        held: String::new(),
    };
    let colour = trace::observe_colour(plan, &camera.sight(x as f64, y as f64), None, &mut probe);
    probe.outcome?;
    writeln!(out)?;
    conclude(colour, &camera.display(), out)?;
    // Where light bounces, even the only sample is not the ray through the middle.
    if !camera.is_single() {
        match camera.samples {
            1 => writeln!(out, "\nthe sample of the image:\n")?,
            samples => writeln!(out, "\nall {samples} samples together:\n")?,
        }
        conclude(trace::pixel(plan, x, y), &camera.display(), out)?;
    }
    Ok(())
}

/// Writes the steps from a colour to the bytes of the image.
fn conclude(light: Rgb, display: &Display, out: &mut impl Write) -> io::Result<()> {
    let [r, g, b] = display.bytes(light);
    let [before, after] = match display.truncates() {
        Some(_) => ["before clamping ", "after clamping  "],
        None => ["light           ", "as it is shown  "],
    };
    writeln!(out, "{before} {}", triple(display.full_range(light)))?;
    writeln!(out, "{after} {}", triple(display.shown(light)))?;
    writeln!(out, "bytes            ({r}, {g}, {b})")
}

struct Probe<'p, W> {
    model: &'p Model,
    /// Whether the rules are the free ones. Then rays are not nested, but follow each other by weight.
    is_free: bool,
    /// The number of rays before the current one.
    followed: usize,
    out: &'p mut W,
    outcome: io::Result<()>,
    /// The number of rays that led to the current one.
    depth: usize,
    search: Option<Search>,
    /// The distance to the light, in world units, while shadow rays are traced.
    light: Option<f64>,
    /// Lines about shadow rays, kept until the outcome for their light is known and printed before them.
    held: String,
}

/// A ray and the tests for its first hit.
struct Search {
    ray: Ray,
    /// The objects tested so far, by index, and the distance that each returned.
    tests: Vec<(usize, Option<f64>)>,
}

impl<W: Write> TraceObserver for Probe<'_, W> {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::Begin(purpose) => self.begin(purpose),
            Event::Search(ray) => self.search = Some(Search { ray: *ray, tests: Vec::new() }),
            Event::Dropped(reason) => self.line("dropped", &self.dropped(reason)),
            Event::Tested(index, distance) => {
                if let Some(search) = &mut self.search {
                    search.tests.push((index, distance));
                }
            }
            Event::FirstHit(hit) => {
                if let Some(search) = self.search.take() {
                    self.searched(&search, hit);
                }
            }
            Event::Surface { normal, ambient } => {
                self.line("normal", &triple(normal));
                self.line("ambient", &triple(ambient));
            }
            Event::Light(index, outcome) => {
                self.light = None;
                let name = self.model.lights[index].args.name();
                self.line("light", &format!("`{name}` {}", self.outcome_of(outcome)));
                let held = std::mem::take(&mut self.held);
                self.write(&held);
            }
            Event::Shaded { colour, .. } if self.is_free => self.line("surface", &triple(colour)),
            Event::Shaded { travelled, colour, .. } => {
                let text = format!("{}, the sum / {} travelled", triple(colour), number(travelled));
                self.line("surface", &text);
            }
            Event::Colour(colour) => {
                self.line("colour", &triple(colour));
                self.depth -= 1;
            }
        }
    }
}

impl<W: Write> Probe<'_, W> {
    /// Writes the heading of a ray; later lines are indented below it.
    fn begin(&mut self, purpose: RayPurpose) {
        match purpose {
            RayPurpose::Primary => self.heading("primary ray"),
            RayPurpose::Transmitted { tint: weight, .. }
            | RayPurpose::Reflected { specular: weight }
            | RayPurpose::Scattered { diffuse: weight }
                if self.is_free =>
            {
                let kind = match purpose {
                    RayPurpose::Transmitted { .. } => "transmitted",
                    RayPurpose::Scattered { .. } => "scattered",
                    _ => "reflected",
                };
                self.followed += 1;
                self.heading(&format!("{kind} ray {}, of weight {}", self.followed, triple(weight)));
            }
            RayPurpose::Transmitted { tint, kept } => self.heading(&format!(
                "transmitted ray {}, times {}, with {} of the surface",
                self.depth,
                triple(tint),
                number(kept)
            )),
            RayPurpose::Reflected { specular: factor } | RayPurpose::Scattered { diffuse: factor } => {
                self.heading(&format!("reflected ray {}, times {}", self.depth, triple(factor)));
            }
            RayPurpose::Shadow { distance } => {
                self.light = Some(distance);
                let heading = match distance.is_finite() {
                    true => format!("shadow ray, {} to the light", number(distance)),
                    false => "shadow ray, toward the sky".to_owned(),
                };
                self.held += &format!("{}{heading}\n", indent(self.depth));
            }
        }
    }

    fn heading(&mut self, text: &str) {
        let line = format!("{}{text}\n", indent(self.depth));
        self.write(&line);
        self.depth += 1;
    }

    fn searched(&mut self, search: &Search, hit: Option<&Hit>) {
        self.line("from", &triple(search.ray.origin));
        self.line("along", &triple(search.ray.dir));
        let label = |index: usize| {
            let args = &self.model.objects[index].args;
            format!("{} `{}`", args.entity().name, args.name())
        };
        let rows: Vec<_> = search
            .tests
            .iter()
            .map(|&(index, given)| {
                let (distance, verdict) = self.verdict(search, hit, index, given);
                (label(index), distance, verdict)
            })
            .collect();
        let wide = |text: &String| text.chars().count();
        let names = rows.iter().map(|(name, ..)| wide(name)).max().unwrap_or(0);
        let numbers = rows.iter().map(|(_, distance, _)| wide(distance)).max().unwrap_or(0);
        for (row, (name, distance, verdict)) in rows.iter().enumerate() {
            let text = format!("{name:<names$}  {distance:>numbers$}  {verdict}");
            self.line(if row == 0 { "tested" } else { "" }, &text);
        }
        let met = hit.map_or("nothing".to_owned(), |hit| {
            let part = hit.object.shape.part(&search.ray, hit.distance);
            let part = part.map_or(String::new(), |part| format!(", {part},"));
            format!(
                "`{}`{part} at {}, {} away",
                hit.object.args.name(),
                triple(hit.point),
                number(hit.distance)
            )
        });
        self.line("hit", &met);
    }

    /// Returns the distance of a tested object, if it has one, and the reason why it is or is not the first hit.
    fn verdict(
        &self,
        search: &Search,
        hit: Option<&Hit>,
        index: usize,
        given: Option<f64>,
    ) -> (String, String) {
        let Some(given) = given else { return (String::new(), "skipped: the ray leaves it".to_owned()) };
        // The tracer asks only for hits nearer than the nearest so far. Here a hit farther away matters, too.
        let whole = || self.model.objects[index].shape.distance(&search.ray, &RayRange::ALL);
        let distance = if given == MISS { whole() } else { given };
        if distance == MISS {
            return (String::new(), "missed".to_owned());
        }
        let verdict = match (hit, self.light) {
            (Some(hit), _) if hit.index == index => "the nearest".to_owned(),
            (_, Some(light)) if distance >= light => "beyond the light".to_owned(),
            (Some(hit), _) if distance == hit.distance => {
                format!("as near as `{}`, but later in the scene", hit.object.args.name())
            }
            (Some(hit), _) => format!("behind `{}`", hit.object.args.name()),
            (None, _) => String::new(),
        };
        (format!("{distance:.6}"), verdict)
    }

    fn dropped(&self, reason: DropReason) -> String {
        match (reason, self.is_free) {
            (DropReason::TooFar, _) => format!("light that has travelled more than {MAX_DIST} is black"),
            (DropReason::TooFaint, false) => "it can add less than 1/1024 of a level to the pixel".to_owned(),
            (DropReason::TooFaint, true) => {
                "the rays that are left can change the pixel by less than 1/16 of a level, and count with their mean"
                    .to_owned()
            }
            (DropReason::TooMany, is_free) => {
                let count = if is_free { format!("are {MAX_TREE}, or ") } else { String::new() };
                format!(
                    "the rays of this pixel {count}have taken the work of {MAX_RAYS} simple ones, and no more are \
                     followed: a lower `specular` or `transparency` ends them sooner"
                )
            }
        }
    }

    fn outcome_of(&self, outcome: LightOutcome) -> String {
        match outcome {
            LightOutcome::Behind => "is behind the surface".to_owned(),
            LightOutcome::Aside => "does not shine there".to_owned(),
            LightOutcome::Blocked(index) => {
                format!("is blocked by `{}`", self.model.objects[index].args.name())
            }
            LightOutcome::Shines { passed: DVec3::ONE, colour } => format!("adds {}", triple(colour)),
            LightOutcome::Shines { passed, colour } => {
                format!("arrives tinted {}, adds {}", triple(passed), triple(colour))
            }
        }
    }

    /// Writes a line about the current ray, or about one of its shadow rays.
    fn line(&mut self, label: &str, text: &str) {
        if self.light.is_some() {
            self.held += &format!("{}{label:<9}{text}\n", indent(self.depth + 1));
        } else {
            let line = format!("{}{label:<9}{text}\n", indent(self.depth));
            self.write(&line);
        }
    }

    fn write(&mut self, text: &str) {
        if self.outcome.is_ok() {
            self.outcome = self.out.write_all(text.as_bytes());
        }
    }
}

fn indent(depth: usize) -> String {
    "    ".repeat(depth.min(MAX_INDENT))
}

fn triple(v: DVec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// Writes a number with about seven significant digits, without trailing zeros.
fn number(value: f64) -> String {
    let scientific = format!("{value:.6e}");
    let Some((digits, exponent)) = scientific.split_once('e') else { return scientific };
    match exponent.parse::<usize>() {
        _ if value == 0.0 => "0".to_owned(),
        Ok(exponent @ 0..=6) => trimmed(&format!("{value:.*}", 6 - exponent)).to_owned(),
        Err(_) if value.abs() >= 1e-4 => trimmed(&format!("{value:.9}")).to_owned(),
        _ => format!("{}e{exponent}", trimmed(digits)),
    }
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}
