//! Says in words what a chart shows.

use super::data::{Chart, Family, Panel, Point, Subject};
use super::front::{self, SAME_TIME};
use crate::scene::choice::Choice;
use crate::world::accuracy::Accuracy;
use std::fmt::Write;

/// The distance in Oklab from which the eye can tell colours apart, in hundredths of that from black to white.
const VISIBLE: f64 = 2.0;

/// The ratio of times from which on another accuracy than the default is worth taking.
const GAIN: f64 = 0.8;

/// Returns what to do, and the verdict on each panel: the front, the position of the default, and what to choose.
pub fn words(chart: &Chart) -> String {
    let mut text = String::new();
    let todo = advice(chart);
    if !todo.is_empty() {
        let _ = writeln!(text, "What to do:\n  {}\n", todo.join("\n  "));
    }
    for panel in &chart.panels {
        let _ = writeln!(text, "{} ({})", panel.title, panel.note);
        let lines = match panel.subject {
            Subject::Distances => distances(panel),
            Subject::Methods => methods(panel),
            Subject::Samples => samples(panel),
            Subject::Bounces => bounces(panel),
            Subject::Whole => [front(panel)].into_iter().chain(default_position(panel)).collect(),
        };
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
        text += "\n";
    }
    if chart.is_noisy() {
        let _ = writeln!(
            text,
            "Rounds of the same work differed by {:.0} %. Do not trust the times.",
            100.0 * chart.noise()
        );
    }
    if chart.is_busy() {
        let _ = writeln!(
            text,
            "The machine was busy: rounds waited {:.0} % of their time for other work. All times may be too long.",
            100.0 * chart.waited()
        );
    }
    if !chart.is_whole {
        text += "Not all was measured: this is what had been measured by then.\n";
    }
    text
}

/// Says what to do, in the order of importance.
fn advice(chart: &Chart) -> Vec<String> {
    let of = |subject: Subject| chart.panels.iter().find(|panel| panel.subject == subject);
    let is_doubtful = chart.is_noisy() || chart.is_busy();
    let again =
        is_doubtful.then(|| "measure again on a machine with nothing else to do: see below".to_owned());
    let accuracy = of(Subject::Methods).filter(|_| !is_doubtful).and_then(accuracy);
    let samples =
        of(Subject::Samples).map(|panel| match panel.points.iter().find(|point| looks_right(point)) {
            Some(point) if point.is_default => {
                format!("keep the samples per pixel, {}: 99 % of the pixels look right", point.samples)
            }
            Some(point) => {
                let sampler = if point.family == Family::Random { " --sampler random" } else { "" };
                let count = point.samples;
                format!("take `--samples {count}{sampler}`, with which 99 % of the pixels look right")
            }
            None => {
                "take more samples per pixel than were measured: with none do 99 % of the pixels look right"
                    .to_owned()
            }
        });
    again.into_iter().chain(accuracy).chain(samples).collect()
}

/// Says which accuracy to choose: the fastest that changes no pixel, or the default where that is as fast.
fn accuracy(panel: &Panel) -> Option<String> {
    let default = panel.points.iter().find(|point| point.is_default)?;
    let options: Vec<_> = Accuracy::all().iter().map(|accuracy| accuracy.option().name).collect();
    let is_same =
        |point: &&Point| options.contains(&point.name.as_str()) && matches!(point.changed, Some([0, _]));
    let fastest = panel.points.iter().filter(is_same).min_by(|a, b| a.times.least.total_cmp(&b.times.least));
    Some(match fastest {
        Some(fastest) if fastest.times.least <= GAIN * default.times.least => {
            let option = if fastest.name == "classic" { "--method" } else { "--accuracy" };
            let (own, other) = (time(panel, default), time(panel, fastest));
            format!(
                "take `{option} {}`: it shows the same image in {other} per pixel in place of {own}",
                fastest.name
            )
        }
        _ => format!("keep the accuracy, {}: none that is clearly faster shows the same image", default.name),
    })
}

/// Tells whether the eye can tell at most one in a hundred pixels from the right ones.
fn looks_right(point: &Point) -> bool {
    point.visible.is_some_and(|part| part <= VISIBLE)
}

fn distances(panel: &Panel) -> Vec<String> {
    let mut lines = vec![front(panel)];
    lines.extend(default_position(panel));
    let (wrong, right): (Vec<_>, Vec<_>) = panel.points.iter().partition(|point| point.wrong.count() > 0);
    if !wrong.is_empty() {
        let each = |point: &&Point| {
            format!("{} {}", point.name, percent(point.wrong.count() as f64 / point.wrong.of as f64))
        };
        lines.push(format!("wrong hits: {}", wrong.iter().map(each).collect::<Vec<_>>().join("; ")));
    }
    let mut last = None;
    for limit in [1e-2, 1e-4, 1e-8, 1e-12] {
        let fit = || right.iter().filter(|point| point.error <= limit);
        let Some(fastest) = fit().min_by(|a, b| a.times.least.total_cmp(&b.times.least)) else { continue };
        // A choice no faster than the default is no reason to leave the default.
        let as_fast =
            |point: &&&Point| point.is_default && point.times.least <= SAME_TIME * fastest.times.least;
        let best = fit().find(as_fast).unwrap_or(fastest);
        if last != Some(&best.name) {
            lines.push(format!("for an error of at most {limit:e}: {}, {}", best.name, time(panel, best)));
            last = Some(&best.name);
        }
    }
    lines
}

fn methods(panel: &Panel) -> Vec<String> {
    let mut lines = vec![front(panel)];
    lines.extend(default_position(panel));
    let (mut same, mut others) = (Vec::new(), Vec::new());
    for point in &panel.points {
        match point.changed {
            Some([0, _]) => same.push(point.name.clone()),
            Some([changed, of]) => {
                others.push(format!("{} {}", point.name, percent(changed as f64 / of as f64)));
            }
            None => {}
        }
    }
    if others.is_empty() {
        let fastest = panel.points.iter().min_by(|a, b| a.times.least.total_cmp(&b.times.least));
        let fastest = fastest.map(|point| format!("; the fastest is {}, {}", point.name, time(panel, point)));
        lines.push(format!("no choice changes a pixel{}", fastest.unwrap_or_default()));
    } else {
        lines.push(format!("change no pixel: {}", same.join("; ")));
        lines.push(format!("change pixels: {}", others.join("; ")));
    }
    lines
}

fn bounces(panel: &Panel) -> Vec<String> {
    let all = panel.points.iter().find(|point| point.is_default);
    let fits = |point: &&Point| point.worst <= 0.5 / 255.0;
    let line = |what: &str, point: &Point| format!("{what}: {}, {}", point.name, time(panel, point));
    let first =
        panel.points.iter().find(fits).map(|point| line("no pixel is off by more than half a level", point));
    all.map(|point| line("the default", point)).into_iter().chain(first).collect()
}

fn samples(panel: &Panel) -> Vec<String> {
    let mut lines: Vec<_> = default_position(panel).into_iter().collect();
    let of = |family: Family| -> Vec<&Point> {
        panel.points.iter().filter(|point| point.family == family && point.samples > 1).collect()
    };
    let (sobol, random) = (of(Family::Sobol), of(Family::Random));
    for (name, points) in [("sobol", &sobol), ("random", &random)] {
        if let Some(slope) = slope(points) {
            lines.push(format!(
                "{name}: the error falls with the number of samples to the power of {slope:.2}"
            ));
        }
    }
    if let Some(last) = random.last() {
        match needed(&sobol, last.error) {
            Some(samples) => {
                lines.push(format!("sobol needs {samples} samples for the error of {}", last.name));
            }
            None => lines.push(format!("sobol does not reach the error of {}", last.name)),
        }
    }
    lines.push(match panel.points.iter().find(|point| looks_right(point)) {
        Some(first) => {
            format!(
                "99 % of the pixels look right (within {VISIBLE} of 100 in Oklab): {}, {}",
                first.name,
                time(panel, first)
            )
        }
        None => "no choice makes 99 % of the pixels look right".to_owned(),
    });
    lines
}

/// Names the choices on the front, the fastest first.
fn front(panel: &Panel) -> String {
    let mut best: Vec<&Point> = panel
        .points
        .iter()
        .zip(panel.front())
        .filter(|(_, is_on_front)| *is_on_front)
        .map(|(point, _)| point)
        .collect();
    best.sort_by(|a, b| b.error.total_cmp(&a.error).then_with(|| a.name.cmp(&b.name)));
    let each = |point: &&Point| format!("{} ({}, {:.0e})", point.name, time(panel, point), point.error);
    format!("Pareto front: {}", best.iter().map(each).collect::<Vec<_>>().join("; "))
}

/// Says where the default stands.
fn default_position(panel: &Panel) -> Option<String> {
    let default = panel.points.iter().find(|point| point.is_default)?;
    let name = &default.name;
    if default.wrong.count() > 0 {
        return Some(format!("the default, {name}, has wrong hits"));
    }
    Some(match front::fastest_dominating(&panel.points, default, panel.negligible()) {
        None => format!("the default, {name}, is on the front: {}", time(panel, default)),
        Some(best) => {
            let (own, other) = (time(panel, default), time(panel, best));
            format!("the default, {name}, {own}, is beaten by {}, {other}", best.name)
        }
    })
}

/// Returns the exponent with which errors fall in the number of samples: the slope of the line through their
/// logarithms, by least squares.
fn slope(points: &[&Point]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|point| point.error > 0.0)
        .map(|point| (libm::log(f64::from(point.samples)), libm::log(point.error)))
        .collect();
    let count = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), log| (x + log.0 / count, y + log.1 / count));
    let (up, across) = logs.iter().fold((0.0, 0.0), |(up, across), log| {
        (up + (log.0 - x) * (log.1 - y), across + (log.0 - x) * (log.0 - x))
    });
    (logs.len() > 2 && across > 0.0).then(|| up / across)
}

/// Returns the smallest measured number of samples that reaches an error.
fn needed(points: &[&Point], error: f64) -> Option<u32> {
    points.iter().find(|point| point.error <= error).map(|point| point.samples)
}

fn time(panel: &Panel, point: &Point) -> String {
    let (_, scale) = panel.unit();
    let unit = if panel.subject == Subject::Distances { "ns" } else { "µs" };
    let time = point.times.least * scale;
    // Two digits, as times vary from run to run.
    let digits = (1 - time.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{time:.digits$} {unit}")
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent < 0.1 { format!("{percent:.3} %") } else { format!("{percent:.1} %") }
}
