//! Writes the numbers of a chart, for other programs.

use super::data::{Chart, Panel, Point, Subject};
use serde::Serialize;
use tabray_core::text;

/// Writes a header with the names of the columns, and one line for each choice. Times are in seconds.
pub fn csv(chart: &Chart) -> String {
    let mut text =
        "panel,choice,default,front,samples,seconds,seconds_median,rounds,error,worst,known,missed,\
                    invented,later,inaccurate,visible,changed,pixels\n"
            .to_owned();
    for panel in &chart.panels {
        for (point, is_on_front) in panel.points.iter().zip(chart.front(panel)) {
            let Point { times, wrong, .. } = point;
            let [changed, pixels] =
                point.changed.map_or_else(Default::default, |counts| counts.map(|count| count.to_string()));
            let known = if panel.subject == Subject::Distances {
                [wrong.of, wrong.missed, wrong.invented, wrong.later, wrong.inaccurate]
                    .map(|count| count.to_string())
            } else {
                Default::default()
            };
            let cells = [
                quoted(&panel.title),
                quoted(&point.name),
                point.is_default.to_string(),
                is_on_front.to_string(),
                point.samples.to_string(),
                format!("{:e}", times.least),
                format!("{:e}", times.median),
                times.rounds.to_string(),
                format!("{:e}", point.error),
                format!("{:e}", point.worst),
                known.join(","),
                point.visible.map_or_else(String::new, |visible| format!("{visible:e}")),
                changed,
                pixels,
            ];
            text += &(cells.join(",") + "\n");
        }
    }
    text
}

/// Writes the whole chart as JSON.
pub fn json(chart: &Chart) -> String {
    text::json_in_lines(&Document {
        build: &chart.machine.build,
        date: &chart.machine.date,
        noise: chart.noise(),
        panels: chart.panels.iter().map(|panel| Compared::of(chart, panel)).collect(),
        processor: &chart.machine.processor,
        scene: &chart.scene,
        waited: chart.waited(),
        unchecked: chart.unchecked.iter().map(ToString::to_string).collect(),
        whole: chart.is_whole,
    })
}

/// A chart, for other programs. Fields are declared in the order in which they are written.
#[derive(Serialize)]
struct Document<'c> {
    /// The program's version and its build settings.
    build: &'c str,
    /// The time of the measurement in UTC, such as `2026-11-21 09:30`.
    date: &'c str,
    /// The relative excess of the median round over the shortest: the median over all choices.
    noise: f64,
    /// One panel for each question.
    panels: Vec<Compared<'c>>,
    /// The processor, the level of CPU instructions that is used, and the number of its threads.
    processor: &'c str,
    scene: &'c str,
    /// What is not checked of the hits, one sentence for each entity type without an equation.
    unchecked: Vec<String>,
    /// The time that rounds waited for other work of the machine, as a fraction of the time that they took: the median
    /// over all choices.
    waited: f64,
    /// Whether the measurement was completed.
    whole: bool,
}

/// Choices that answer one question.
#[derive(Serialize)]
struct Compared<'c> {
    /// The meaning and the unit of `error` and `worst` of the points.
    error: &'static str,
    /// A note on the rays or pixels that are compared.
    note: &'c str,
    /// The choices.
    points: Vec<Measured<'c>>,
    title: &'c str,
}

/// A choice. Counts of rays are 0 where colours are compared; fields that only colours have are null elsewhere.
#[derive(Serialize)]
struct Measured<'c> {
    /// The number of pixels, out of `pixels`, with other bytes in the image.
    changed: Option<usize>,
    /// The choice's name.
    choice: &'c str,
    /// Whether the scene is traced in this way by default.
    default: bool,
    /// The error: for distances the 99th percentile of their errors, for colours the root of the mean square of theirs.
    error: f64,
    /// Whether it is on the Pareto front: it has no wrong or inaccurate hits in any panel, and no such choice is
    /// faster and more accurate.
    front: bool,
    /// The number of hits that are farther from the first crossing than its conditioning explains.
    inaccurate: usize,
    /// The number of hits that were found where there are none.
    invented: usize,
    /// The number of rays that were compared and whose true hit is known.
    known: usize,
    /// The number of hits found at a later crossing than the first.
    later: usize,
    /// The number of hits that were not found.
    missed: usize,
    /// The number of pixels that were compared.
    pixels: Option<usize>,
    rounds: usize,
    /// The number of samples per pixel.
    samples: u32,
    /// The time for one ray or one pixel in the shortest round, in seconds.
    seconds: f64,
    /// The median time for one ray or one pixel, in seconds.
    seconds_median: f64,
    /// The 99th percentile of the visible differences: distances in Oklab, in hundredths of the distance from black to
    /// white.
    visible: Option<f64>,
    /// The greatest error.
    worst: f64,
}

impl<'c> Compared<'c> {
    fn of(chart: &'c Chart, panel: &'c Panel) -> Self {
        let points = panel.points.iter().zip(chart.front(panel));
        Self {
            error: panel.measure(),
            note: &panel.note,
            points: points.map(|(point, front)| Measured::of(point, front)).collect(),
            title: &panel.title,
        }
    }
}

impl<'c> Measured<'c> {
    fn of(point: &'c Point, front: bool) -> Self {
        let Point { times, wrong, .. } = point;
        Self {
            changed: point.changed.map(|[changed, _]| changed),
            choice: &point.name,
            default: point.is_default,
            error: point.error,
            front,
            inaccurate: wrong.inaccurate,
            invented: wrong.invented,
            known: wrong.of,
            later: wrong.later,
            missed: wrong.missed,
            pixels: point.changed.map(|[_, pixels]| pixels),
            rounds: times.rounds,
            samples: point.samples,
            seconds: times.least,
            seconds_median: times.median,
            visible: point.visible,
            worst: point.worst,
        }
    }
}

/// Writes a cell of text: in quotes, with quotes inside it doubled.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
