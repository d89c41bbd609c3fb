//! Says in words what a chart shows.

use super::data::{Chart, Family, Panel, Point, Subject};
use super::front::{self, SAME_TIME};
use std::fmt::Write;

/// The distance in Oklab from which the eye can tell colours apart, in hundredths of that from black to white.
const VISIBLE: f64 = 2.0;

/// Another accuracy than the default is worth taking if it takes at most this part of its time.
const GAIN: f64 = 0.8;

/// Returns the advice, and the verdict on each panel: the front, the position of the default, and the recommended
/// choice.
pub fn words(chart: &Chart) -> String {
    let mut text = String::new();
    let todo = advice(chart);
    if !todo.is_empty() {
        let _ = writeln!(text, "What to do:\n  {}\n", todo.join("\n  "));
    }
    for panel in &chart.panels {
        let _ = writeln!(text, "{} ({})", panel.title, panel.note);
        let lines = match panel.subject {
            Subject::Distances => distances(chart, panel),
            Subject::Methods => methods(chart, panel),
            Subject::Samples => samples(chart, panel),
            Subject::Depth => depths(panel),
            Subject::Whole => front(chart, panel).into_iter().chain(default_position(chart, panel)).collect(),
        };
        for line in lines.into_iter().chain(barred(chart, panel)) {
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
        text += "Not everything was measured: these are the results by then.\n";
    }
    text
}

/// Gives advice in the order of importance: first by errors and counts, then by times.
fn advice(chart: &Chart) -> Vec<String> {
    let of = |subject: Subject| chart.panels.iter().find(|panel| panel.subject == subject);
    let again = chart
        .is_doubtful()
        .then(|| "measure the times again on a machine with nothing else to do: see below".to_owned());
    let accuracy = of(Subject::Methods).and_then(|panel| accuracy(chart, panel));
    let unchecked = chart.unchecked.iter().map(ToString::to_string);
    // Pixels that are right by hits that may be wrong are no reason.
    let samples = of(Subject::Samples).filter(|_| chart.unchecked.is_empty()).map(sampling);
    accuracy.into_iter().chain(unchecked).chain(samples).chain(again).collect()
}

/// Says which accuracy to choose: the default, unless it has wrong hits, or another one that may be advised is clearly
/// faster and changes no pixel. `None` where hits cannot be proven, and methods may share their mistakes.
fn accuracy(chart: &Chart, panel: &Panel) -> Option<String> {
    let default = panel.points.iter().find(|point| point.is_default)?;
    let name = &default.name;
    if chart.has_faults(name) {
        return Some(format!("take `--accuracy exact`: {name}, the scene's own, has hits that are wrong"));
    }
    if !chart.unchecked.is_empty() {
        return None;
    }
    let is_same = |point: &&Point| is_advisable(chart, point) && matches!(point.changed, Some([0, _]));
    let fastest = panel.points.iter().filter(is_same).min_by(|a, b| a.times.least.total_cmp(&b.times.least));
    Some(match fastest {
        Some(fastest) if !chart.is_doubtful() && fastest.times.least <= GAIN * default.times.least => {
            let (own, other) = (time(panel, default), time(panel, fastest));
            format!(
                "take `--accuracy {}`: it shows the same image in {other} per pixel instead of {own}",
                fastest.name
            )
        }
        _ => {
            let is_proven = chart.panels.iter().any(|panel| panel.subject == Subject::Distances);
            let hits = if is_proven { "no measured hit is wrong, and " } else { "" };
            let pixels = match default.changed {
                Some([changed, of]) if changed > 0 => {
                    percent(changed as f64 / of as f64) + " of the pixels differ"
                }
                _ => "no measured pixel differs".to_owned(),
            };
            let faster =
                if chart.is_doubtful() { "" } else { "; none that is clearly faster shows the same image" };
            format!("keep the accuracy, {name}: {hits}{pixels} from those of strict{faster}")
        }
    })
}

/// Says how many samples to choose: the fewest with which nearly all pixels look right.
fn sampling(panel: &Panel) -> String {
    let Some(point) = panel.points.iter().find(|point| looks_right(point)) else {
        return "take more samples per pixel than were measured: with none do 99 % of the pixels look right"
            .to_owned();
    };
    if point.is_default {
        return format!("keep the samples per pixel, {}: 99 % of the pixels look right", point.samples);
    }
    let (count, sampler) = match point.family {
        Family::Random => (point.samples.to_string(), " --sampler random"),
        Family::Adaptive => (point.name.clone(), ""),
        _ => (point.samples.to_string(), ""),
    };
    let own = panel.points.iter().find(|point| point.is_default);
    let own = own.map_or(String::new(), |own| format!(", instead of {}", own.samples));
    format!("take `--samples {count}{sampler}`{own}, with which 99 % of the pixels look right")
}

/// Tells whether a choice may be advised: it has no wrong hits in any panel, and bounds the errors of its hits.
/// Methods without bounds lose some of the hard rays of each kind of shape, as `docs/accuracy.md` counts, even where
/// they lose none in this scene, and most of them cannot be chosen.
fn is_advisable(chart: &Chart, point: &Point) -> bool {
    matches!(point.family, Family::Own | Family::Sobol | Family::Random | Family::Adaptive)
        && !chart.has_faults(&point.name)
}

/// Tells whether the eye can tell at most one in a hundred pixels from the right ones.
fn looks_right(point: &Point) -> bool {
    point.visible.is_some_and(|part| part <= VISIBLE)
}

fn distances(chart: &Chart, panel: &Panel) -> Vec<String> {
    let shares = |what: &str, count: &dyn Fn(&Point) -> usize| {
        let some = panel.points.iter().filter(|point| count(point) > 0);
        let each: Vec<_> = some
            .map(|point| format!("{} {}", point.name, percent(count(point) as f64 / point.wrong.of as f64)))
            .collect();
        (!each.is_empty()).then(|| format!("{what} hits: {}", each.join("; ")))
    };
    let wrong = shares("wrong", &|point| point.wrong.count());
    let mut lines = vec![wrong.unwrap_or_else(|| "no method has a wrong hit".to_owned())];
    lines.extend(shares("inaccurate", &|point| point.wrong.inaccurate));
    lines.extend(front(chart, panel));
    lines.extend(panel.points.iter().find(|point| point.is_default).map(|default| {
        let hits = match (default.wrong.count(), default.wrong.inaccurate) {
            (0, 0) => "has no wrong hits",
            (0, _) => "has inaccurate hits",
            _ => "has wrong hits",
        };
        format!("the default, {}, {hits}: {}, {:.0e}", default.name, time(panel, default), default.error)
    }));
    let right: Vec<_> = panel.points.iter().filter(|point| is_advisable(chart, point)).collect();
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

fn methods(chart: &Chart, panel: &Panel) -> Vec<String> {
    let mut lines: Vec<_> = front(chart, panel).into_iter().collect();
    lines.extend(default_position(chart, panel));
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
        lines.push("no choice changes a pixel".to_owned());
    } else {
        lines.push(format!("change no pixel: {}", same.join("; ")));
        lines.push(format!("change pixels: {}", others.join("; ")));
    }
    lines
}

fn depths(panel: &Panel) -> Vec<String> {
    let all = panel.points.iter().find(|point| point.is_default);
    let fits = |point: &&Point| point.worst <= 0.5 / 255.0;
    let line = |what: &str, point: &Point| format!("{what}: {}, {}", point.name, time(panel, point));
    let first =
        panel.points.iter().find(fits).map(|point| line("no pixel is off by more than half a level", point));
    all.map(|point| line("the default", point)).into_iter().chain(first).collect()
}

fn samples(chart: &Chart, panel: &Panel) -> Vec<String> {
    let mut lines: Vec<_> = default_position(chart, panel).into_iter().collect();
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

/// Names the choices on the front, the fastest first; `None` where each one has wrong hits.
fn front(chart: &Chart, panel: &Panel) -> Option<String> {
    let points = panel.points.iter().zip(chart.front(panel));
    let mut best: Vec<&Point> =
        points.filter(|(_, is_on_front)| *is_on_front).map(|(point, _)| point).collect();
    best.sort_by(|a, b| b.error.total_cmp(&a.error).then_with(|| a.name.cmp(&b.name)));
    let each = |point: &&Point| format!("{} ({}, {:.0e})", point.name, time(panel, point), point.error);
    let each: Vec<_> = best.iter().map(each).collect();
    (!each.is_empty()).then(|| format!("Pareto front: {}", each.join("; ")))
}

/// Names the choices that only hits in another panel keep from the front.
fn barred(chart: &Chart, panel: &Panel) -> Option<String> {
    let names: Vec<_> =
        panel.points.iter().filter(|point| chart.is_barred(point)).map(|point| &*point.name).collect();
    (!names.is_empty())
        .then(|| format!("wrong in another panel, and so not on the front: {}", names.join("; ")))
}

/// Describes the position of the default in the time and the colours of images; `None` where the times are in doubt.
/// Only a choice that may be advised, and is clearly faster or more exact, beats it.
fn default_position(chart: &Chart, panel: &Panel) -> Option<String> {
    let default = panel.points.iter().find(|point| point.is_default).filter(|_| !chart.is_doubtful())?;
    let name = &default.name;
    let error = |point: &Point| point.error.max(panel.negligible());
    let counts = |point: &Point| {
        is_advisable(chart, point)
            && (point.times.least <= GAIN * default.times.least || error(point) < error(default))
    };
    let own = time(panel, default);
    Some(match front::fastest_dominating(&panel.points, counts, default, panel.negligible()) {
        None => format!("the default, {name}, is not clearly beaten: {own}"),
        Some(best) => {
            format!("the default, {name}, {own}, is beaten by {}, {}", best.name, time(panel, best))
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
    // Two digits, since times vary from run to run.
    let digits = (1 - time.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{time:.digits$} {unit}")
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent < 0.1 { format!("{percent:.3} %") } else { format!("{percent:.1} %") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Times, WrongHits};
    use tabray_tools::unchecked::Unchecked;

    /// The numbers of a choice: its time in microseconds, its error, its wrong hits of 100, and its changed pixels of
    /// 100.
    fn point(name: &str, family: Family, (time, error): (f64, f64), missed: usize, changed: usize) -> Point {
        Point {
            name: name.to_owned(),
            family,
            is_default: name == "exact",
            times: Times { least: 1e-6 * time, median: 1e-6 * time, rounds: 3, waited: 0.0 },
            error,
            worst: error,
            wrong: WrongHits { of: 100, missed, ..WrongHits::default() },
            visible: Some(1.0),
            changed: Some([changed, 100]),
            samples: 1,
        }
    }

    fn panel(title: &str, subject: Subject, points: Vec<Point>) -> Panel {
        Panel { title: title.to_owned(), note: String::new(), subject, points }
    }

    /// A plane, of which no method loses a hit, and a vase, of which `classic` loses a tenth.
    fn chart(draft: f64) -> Chart {
        let plane = vec![
            point("classic", Family::Notes, (2.0, 1e-12), 0, 0),
            point("exact", Family::Own, (4.0, 1e-12), 0, 0),
        ];
        let vase = vec![
            point("classic", Family::Notes, (1.0, 1e-12), 10, 0),
            point("16 + turning points", Family::Sampling, (2.0, 1e-12), 0, 0),
            point("exact", Family::Own, (9.0, 1e-12), 0, 0),
        ];
        let image = vec![
            point("classic", Family::Notes, (1.0, 0.0), 0, 0),
            point("draft", Family::Own, (draft, 1e-12), 0, 0),
            point("exact", Family::Own, (4.0, 0.0), 0, 0),
        ];
        Chart {
            panels: vec![
                panel("plane", Subject::Distances, plane),
                panel("vase", Subject::Distances, vase),
                panel("the image", Subject::Methods, image),
            ],
            is_whole: true,
            ..Chart::empty("scene")
        }
    }

    #[test]
    fn a_method_that_may_lose_hits_is_not_advised_and_not_said_to_beat_the_default() {
        let text = words(&chart(3.9));
        let advice = "What to do:\n  keep the accuracy, exact: no measured hit is wrong, and no measured pixel differs from \
                      those of strict; none that is clearly faster shows the same image\n";
        assert!(text.starts_with(advice), "{text}");
        assert!(!text.contains("beaten by"), "{text}");
        assert!(text.contains("the default, exact, has no wrong hits: 9000 ns, 1e-12"), "{text}");
        assert!(text.contains("for an error of at most 1e-2: exact, 4000 ns"), "{text}");
        // It loses no hit of the plane, but is a choice for the whole scene.
        assert!(text.contains("wrong in another panel, and so not on the front: classic"), "{text}");
        assert!(!text.contains("Pareto front: classic"), "{text}");
        let text = words(&chart(2.0));
        assert!(text.starts_with("What to do:\n  take `--accuracy draft`: "), "{text}");
        assert!(text.contains("the default, exact, 4.0 µs, is beaten by draft, 2.0 µs"), "{text}");
    }

    #[test]
    fn hits_that_are_not_checked_are_not_praised() {
        let unchecked = vec![Unchecked { of: "ring", has_equation: false, hits: 9, differ: 2, most: 0.5 }];
        let mut chart = Chart { unchecked, ..chart(2.0) };
        let right =
            Point { visible: Some(0.0), samples: 4, ..point("sobol 4", Family::Sobol, (4.0, 1e-3), 0, 0) };
        chart.panels.push(panel("samples", Subject::Samples, vec![right]));
        let text = words(&chart);
        let advice = "What to do:\n  not checked: `ring` has no equation; 2 of 9 hits differ from those of rays beside them, that \
                      start nearer or come back, by up to 0.5 world units\n\n";
        assert!(text.starts_with(advice), "{text}");
    }

    #[test]
    fn a_scene_whose_own_method_loses_hits_is_told_so_first() {
        let mut chart = chart(2.0);
        for point in chart.panels.iter_mut().flat_map(|panel| &mut panel.points) {
            point.is_default = point.name == "classic";
        }
        let text = words(&chart);
        let advice =
            "What to do:\n  take `--accuracy exact`: classic, the scene's own, has hits that are wrong\n";
        assert!(text.starts_with(advice), "{text}");
    }

    #[test]
    fn a_busy_machine_leaves_the_errors_and_is_told_last() {
        let mut chart = chart(2.0);
        for point in chart.panels.iter_mut().flat_map(|panel| &mut panel.points) {
            point.times.waited = 0.5;
        }
        let text = words(&chart);
        let advice = "What to do:\n  keep the accuracy, exact: no measured hit is wrong, and no measured pixel differs from \
                      those of strict\n  measure the times again on a machine with nothing else to do: see below\n\n";
        assert!(text.starts_with(advice), "{text}");
        assert!(!text.contains("beaten by"), "{text}");
    }
}
