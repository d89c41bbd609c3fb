//! The numbers of a chart, for other programs.

use super::data::{Chart, Panel, Point, Subject};
use serde_json::{Value, json};

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
    let machine = &chart.machine;
    let document = json!({
        "scene": chart.scene,
        "processor": machine.processor,
        "build": machine.build,
        "date": machine.date,
        "whole": chart.is_whole,
        "noise": chart.noise(),
        "waited": chart.waited(),
        "panels": chart.panels.iter().map(panel).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

fn panel(panel: &Panel) -> Value {
    let points = panel.points.iter().zip(panel.front());
    json!({
        "title": panel.title,
        "note": panel.note,
        "error": panel.measure(),
        "points": points.map(|(point, is_on_front)| json!({
            "choice": point.name,
            "default": point.is_default,
            "front": is_on_front,
            "samples": point.samples,
            "seconds": point.times.least,
            "seconds_median": point.times.median,
            "rounds": point.times.rounds,
            "error": point.error,
            "worst": point.worst,
            "known": point.wrong.of,
            "missed": point.wrong.missed,
            "invented": point.wrong.invented,
            "later": point.wrong.later,
            "visible": point.visible,
            "changed": point.changed.map(|[changed, _]| changed),
            "pixels": point.changed.map(|[_, pixels]| pixels),
        })).collect::<Vec<_>>(),
    })
}

/// A cell of text: with quotes, and those in it doubled.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
