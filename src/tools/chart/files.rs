//! The numbers of a chart, for other programs.

use super::data::{Chart, Panel, Point, Subject};
use crate::words;
use serde::Serialize;

/// One line for each choice, below one with the names of the columns. Times are in seconds.
pub fn csv(chart: &Chart) -> String {
    let mut text =
        "panel,choice,default,front,samples,seconds,seconds_median,rounds,error,worst,known,missed,\
                    invented,later,visible,changed,pixels\n"
            .to_owned();
    for panel in &chart.panels {
        for (point, is_on_front) in panel.points.iter().zip(panel.front()) {
            let Point { times, wrong, .. } = point;
            let [changed, pixels] =
                point.changed.map_or_else(Default::default, |counts| counts.map(|count| count.to_string()));
            let known = if panel.subject == Subject::Distances {
                [wrong.of, wrong.missed, wrong.invented, wrong.later].map(|count| count.to_string())
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

/// All of it, as JSON.
pub fn json(chart: &Chart) -> String {
    words::json_in_lines(&Document {
        build: &chart.machine.build,
        date: &chart.machine.date,
        noise: chart.noise(),
        panels: chart.panels.iter().map(Compared::of).collect(),
        processor: &chart.machine.processor,
        scene: &chart.scene,
        waited: chart.waited(),
        whole: chart.is_whole,
    })
}

/// A chart, for programs. Its fields stand in the order in which they are written.
#[derive(Serialize)]
struct Document<'c> {
    /// The program's version, and how it was built.
    build: &'c str,
    /// When it was measured, in UTC, such as `2026-11-21 09:30`.
    date: &'c str,
    /// How far apart rounds of the same work were, as a part of their time: that of the choice in the middle.
    noise: f64,
    /// One for each question.
    panels: Vec<Compared<'c>>,
    /// The processor, those of its instructions that are used, and how many threads it runs.
    processor: &'c str,
    /// What the scene is called.
    scene: &'c str,
    /// How long rounds waited for other work of the machine, likewise.
    waited: f64,
    /// Whether all was measured that was to be.
    whole: bool,
}

/// Choices that answer one question.
#[derive(Serialize)]
struct Compared<'c> {
    /// What `error` and `worst` of its points are, and in which unit.
    error: &'static str,
    /// On what they are compared.
    note: &'c str,
    /// The choices.
    points: Vec<Measured<'c>>,
    /// What is compared.
    title: &'c str,
}

/// One choice. What rays are counted is 0 where colours are compared, and null what only colours have.
#[derive(Serialize)]
struct Measured<'c> {
    /// How many of `pixels` have other bytes in the picture.
    changed: Option<usize>,
    /// What it is called.
    choice: &'c str,
    /// Whether the scene is traced so.
    default: bool,
    /// How wrong it is: of distances the 99th percentile of their errors, of colours the root of the mean square of
    /// theirs.
    error: f64,
    /// Whether it is one of the best: no choice without wrong hits is faster and more exact.
    front: bool,
    /// How many hits were found where there are none.
    invented: usize,
    /// How many rays were looked at and have a known truth.
    known: usize,
    /// How many hits were found at another crossing than the first.
    later: usize,
    /// How many hits were not found.
    missed: usize,
    /// How many pixels were looked at.
    pixels: Option<usize>,
    /// How many rounds were run.
    rounds: usize,
    /// How many samples it has for each pixel.
    samples: u32,
    /// What it takes for one ray or one pixel, in the shortest round.
    seconds: f64,
    /// Likewise, in the middle round.
    seconds_median: f64,
    /// How different all but one in a hundred pixels look at most: distances in Oklab, in hundredths of that from black
    /// to white.
    visible: Option<f64>,
    /// The greatest error.
    worst: f64,
}

impl<'c> Compared<'c> {
    fn of(panel: &'c Panel) -> Self {
        let points = panel.points.iter().zip(panel.front());
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

/// A cell of text: with quotes, and those in it doubled.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
