//! Draws a chart: a panel for each question, with time to the right and errors upward, both logarithmic.

use super::axis::Axis;
use super::canvas::{Align, BLUE, Canvas, GREEN, GREY, LIGHT, Letters, Marker, ORANGE, PURPLE, VERMILION};
use super::data::{Chart, Family, Panel, Point, Subject};
use super::labels::{self, PlotArea, Segment};
use plotters::prelude::{BLACK, BitMapBackend, DrawingBackend, IntoDrawingArea, RGBColor, SVGBackend};
use std::io;
use std::iter;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::output::deflate::Compression;
use tabray_core::output::picture::Format;

/// The width and height of a panel, and the sizes of its letters, in pixels: a phone that shows one panel 360 pixels wide
/// shows letters of about 9 pixels.
const PANEL: (f64, f64) = (520.0, 560.0);
const TITLE: f64 = 17.0;
const TEXT: f64 = 16.0;

/// The height of a line of text, and the free space on either side of a chart, in pixels.
const LINE: f64 = 22.0;
const MARGIN: f64 = 20.0;

/// The height above the panels, in pixels: that of the title and of a caption of up to three lines.
const HEAD: f64 = 110.0;

/// The height of the strip below an error axis for errors that do not matter, in pixels.
const NOTHING: f64 = 34.0;

/// Draws the chart as an SVG file.
///
/// # Errors
/// If the chart cannot be drawn.
pub fn svg(chart: &Chart) -> io::Result<String> {
    let (width, height) = size(chart);
    let mut text = String::new();
    draw(chart, SVGBackend::with_string(&mut text, (width as u32, height as u32)), 1.0)?;
    Ok(text)
}

/// Draws the chart as a PNG file.
///
/// # Errors
/// If the chart cannot be drawn.
pub fn png(chart: &Chart) -> io::Result<Vec<u8>> {
    // Each pixel is the mean of four, for antialiasing.
    let (width, height) = size(chart);
    let (width, height) = (width as usize, height as usize);
    let mut fine = vec![0; 4 * 3 * width * height];
    draw(chart, BitMapBackend::with_buffer(&mut fine, (2 * width as u32, 2 * height as u32)), 2.0)?;
    let mut bytes = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let at = |row: usize, column: usize| {
                    u32::from(fine[3 * ((2 * y + row) * 2 * width + 2 * x + column) + channel])
                };
                bytes.push(((at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1) + 2) / 4) as u8);
            }
        }
    }
    let mut file = Vec::new();
    Format::Png(Compression::High).write(&mut file, [width, height], iter::once(Ok(bytes)))?;
    Ok(file)
}

fn columns(chart: &Chart) -> usize {
    chart.panels.len().clamp(1, 2)
}

/// Returns the width of a chart, and the height at which its legend begins, in pixels.
fn size_without_legend(chart: &Chart) -> (f64, f64) {
    let columns = columns(chart);
    let rows = chart.panels.len().div_ceil(columns).max(1);
    (columns as f64 * PANEL.0, HEAD + rows as f64 * PANEL.1)
}

fn size(chart: &Chart) -> (f64, f64) {
    let (width, top) = size_without_legend(chart);
    let notes: usize =
        notes().iter().map(|note| Letters::new(TEXT).wrap(note, width - 2.0 * MARGIN).len()).sum();
    let rows = legend(chart, width).last().map_or(0.0, |entry| entry.at.1) + LINE;
    (width, top + rows + LINE * (notes as f64 + 1.0))
}

fn draw<D: DrawingBackend>(chart: &Chart, backend: D, scale: f64) -> io::Result<()> {
    let canvas = Canvas::new(backend.into_drawing_area(), scale)?;
    let (width, bottom) = size_without_legend(chart);
    let head = Letters { is_bold: true, ..Letters::new(20.0) };
    let claim = ": cost and error of each choice";
    let title = head.fit(&chart.scene, width - 2.0 * MARGIN - head.width(claim)) + claim;
    canvas.text(&title, (MARGIN, 26.0), Align::Left, head)?;
    let machine = &chart.machine;
    let trust = match (chart.is_noisy(), chart.is_busy()) {
        (true, _) => ": do not trust the times",
        (false, true) => "; the machine was busy: all times may be too long",
        (false, false) => "",
    };
    let caption = format!(
        "{}; {}; measured on {} UTC; rounds differ by {:.1} %{trust}",
        machine.processor,
        machine.build,
        machine.date,
        100.0 * chart.noise()
    );
    let small = Letters { colour: GREY, ..Letters::new(TEXT) };
    canvas.paragraph(&caption, (MARGIN, 52.0), width - 2.0 * MARGIN, LINE, small)?;
    let columns = columns(chart);
    for (index, panel) in chart.panels.iter().enumerate() {
        let corner = ((index % columns) as f64 * PANEL.0, HEAD + (index / columns) as f64 * PANEL.1);
        draw_panel(&canvas, chart, panel, corner)?;
    }
    let mut y = bottom;
    for entry in legend(chart, width) {
        y = bottom + entry.at.1;
        canvas.marker((entry.at.0, y), entry.marker, entry.colour, false)?;
        canvas.text(entry.text, (entry.at.0 + 18.0, y), Align::Left, Letters::new(TEXT))?;
    }
    for note in notes() {
        y = canvas.paragraph(&note, (MARGIN, y + LINE), width - 2.0 * MARGIN, LINE, small)?;
    }
    canvas.finish()
}

/// A marker in the legend, with its meaning. `at` is its place below the panels.
struct LegendEntry {
    at: (f64, f64),
    marker: Marker,
    colour: RGBColor,
    text: &'static str,
}

/// Returns the legend of the markers that the chart contains, in rows of this width.
fn legend(chart: &Chart, width: f64) -> Vec<LegendEntry> {
    let points = || chart.panels.iter().flat_map(|panel| &panel.points);
    let families = [
        (Family::Own, "tabray's method"),
        (Family::Notes, "the notes' methods"),
        (Family::Sampling, "samples along the ray + a refiner"),
        (Family::Tracing, "sphere tracing"),
        (Family::Bounds, "bounds"),
        (Family::Sobol, "sobol"),
        (Family::Random, "random"),
        (Family::Adaptive, "adaptive, by the maximum number"),
    ];
    let (mut x, mut y) = (MARGIN + 6.0, 18.0);
    iter::once((Marker::Star, BLACK, "the default"))
        .chain(families.into_iter().filter_map(|(family, text)| {
            let (marker, colour) = look(family);
            points().any(|point| point.family == family).then_some((marker, colour, text))
        }))
        .map(|(marker, colour, text)| {
            let long = 40.0 + Letters::new(TEXT).width(text);
            if x + long > width {
                (x, y) = (MARGIN + 6.0, y + LINE);
            }
            let at = (x, y);
            x += long;
            LegendEntry { at, marker, colour, text }
        })
        .collect()
}

/// Returns the explanations below the legend.
fn notes() -> [String; 2] {
    [
        "hollow: some hits are missed, invented, not the first or inaccurate (percent of all rays); line: the Pareto front, \
         where no choice without them is both faster and more exact; *: such hits in another panel"
            .to_owned(),
        format!(
            "times: packets of up to {PACKET_SIZE} rays on one thread, as in a render; where a hit is searched for, all \
             methods but tabray's own take rays one by one"
        ),
    ]
}

/// Returns the marker and the colour of a family.
fn look(family: Family) -> (Marker, RGBColor) {
    match family {
        Family::Own => (Marker::Disc, BLACK),
        Family::Notes | Family::Random => (Marker::Diamond, VERMILION),
        Family::Sampling => (Marker::Square, ORANGE),
        Family::Tracing => (Marker::Down, PURPLE),
        Family::Bounds => (Marker::Up, BLUE),
        Family::Sobol => (Marker::Disc, GREEN),
        Family::Adaptive => (Marker::Up, BLUE),
    }
}

fn draw_panel<D: DrawingBackend>(
    canvas: &Canvas<D>,
    chart: &Chart,
    panel: &Panel,
    corner: (f64, f64),
) -> io::Result<()> {
    let axes = Axes::of(panel, corner);
    let (plot, place) = (axes.plot, |point: &Point| axes.place(point));
    let middle = 0.5 * (plot.left + plot.right);
    let title = Letters { is_bold: true, ..Letters::new(TITLE) };
    let centre = corner.0 + 0.5 * PANEL.0;
    canvas.text(
        &title.fit(&panel.title, PANEL.0 - MARGIN),
        (centre, corner.1 + 18.0),
        Align::Middle,
        title,
    )?;
    let note = Letters { colour: GREY, ..Letters::new(TEXT) };
    canvas.text(&panel.note, (centre, corner.1 + 41.0), Align::Middle, note)?;
    axes.draw(canvas)?;
    let axis = Letters::new(TEXT);
    canvas.text(panel.unit().0, (middle, plot.bottom + 40.0), Align::Middle, axis)?;
    canvas.upward(panel.measure(), (corner.0 + 14.0, 0.5 * (plot.top + plot.bottom)), axis)?;

    if matches!(panel.subject, Subject::Samples | Subject::Depth) {
        for family in [Family::Sobol, Family::Random, Family::Own] {
            let series = panel.points.iter().filter(|point| point.family == family);
            canvas.line(&series.map(place).collect::<Vec<_>>(), look(family).1, 1.0)?;
        }
    }
    let is_on_front = chart.front(panel);
    let mut front: Vec<_> = panel
        .points
        .iter()
        .zip(&is_on_front)
        .filter(|(_, front)| **front)
        .map(|(point, _)| place(point))
        .collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    if front.len() > 1 {
        canvas.line(&front, GREY, 2.0)?;
    }
    // The lines that labels keep clear of.
    let mut lines: Vec<_> = front.windows(2).map(|ends| (ends[0], ends[1])).collect();
    lines.extend(axes.has_nothing.then_some(((plot.left, axes.floor), (plot.right, axes.floor))));
    // The most important labels are placed first.
    let mut order: Vec<usize> =
        (0..panel.points.len()).filter(|index| !panel.points[*index].error.is_nan()).collect();
    order.sort_by_key(|index| (!panel.points[*index].is_default, !is_on_front[*index]));
    let points: Vec<&Point> = order.iter().map(|index| &panel.points[*index]).collect();
    draw_points(canvas, (chart, panel), &points, &lines, &axes)
}

/// Draws points with their labels, which keep clear of lines; the most important ones come first.
fn draw_points<D: DrawingBackend>(
    canvas: &Canvas<D>,
    (chart, panel): (&Chart, &Panel),
    points: &[&Point],
    lines: &[Segment],
    axes: &Axes,
) -> io::Result<()> {
    let places: Vec<_> = points.iter().map(|point| axes.place(point)).collect();
    let letters = |point: &Point| Letters { is_bold: point.is_default, ..Letters::new(TEXT) };
    let barred = |point: &Point| if chart.is_barred(point) { "*" } else { "" };
    let names: Vec<String> = points.iter().map(|point| name(panel, point) + barred(point)).collect();
    // With a gap between neighbours, so that two numbers do not look like one.
    let size = |(name, point): (&String, &&Point)| (letters(point).width(name) + 6.0, 19.0);
    let sizes: Vec<_> = names.iter().zip(points).map(size).collect();
    let labels = labels::place(&places, &sizes, lines, axes.plot);
    for (label, place) in labels.iter().zip(&places) {
        if let Some(end) = label.and_then(|label| label.leader) {
            canvas.line(&[*place, end], GREY, 1.0)?;
        }
    }
    for (point, place) in points.iter().zip(&places).rev() {
        let (marker, colour) = look(point.family);
        let marker = if point.is_default { Marker::Star } else { marker };
        canvas.marker(*place, marker, colour, point.wrong.faults() > 0)?;
    }
    for ((label, name), point) in labels.iter().zip(&names).zip(points) {
        if let Some(label) = label {
            let middle =
                (0.5 * (label.area.left + label.area.right), 0.5 * (label.area.top + label.area.bottom));
            canvas.text(name, middle, Align::Middle, letters(point))?;
        }
    }
    Ok(())
}

/// The axes of a panel.
struct Axes {
    plot: PlotArea,
    /// The axis of the times, and the number of their units in a second.
    across: Axis,
    scale: f64,
    up: Axis,
    /// The largest error that does not matter, whether any point has such an error, and the lower end of the axis of
    /// the other errors. Errors that do not matter are drawn in a strip below it.
    nothing: f64,
    has_nothing: bool,
    floor: f64,
    /// Whether there are other errors.
    has_errors: bool,
}

impl Axes {
    fn of(panel: &Panel, corner: (f64, f64)) -> Self {
        let plot = PlotArea {
            left: corner.0 + 84.0,
            top: corner.1 + 60.0,
            right: corner.0 + PANEL.0 - 12.0,
            bottom: corner.1 + PANEL.1 - 62.0,
        };
        let ((_, scale), nothing) = (panel.unit(), panel.negligible());
        let has_nothing = panel.points.iter().any(|point| point.error <= nothing);
        let floor = plot.bottom - if has_nothing { NOTHING } else { 0.0 };
        let times = panel.points.iter().map(|point| scale * point.times.least);
        let across = Axis::new(times, (0.1, 0.12), (plot.left, plot.right));
        let errors = panel.points.iter().map(|point| point.error).filter(|error| *error > nothing);
        let has_errors = errors.clone().next().is_some();
        let up = Axis::new(errors, (0.2, 0.1), (floor, plot.top));
        Self { plot, across, scale, up, nothing, has_nothing, floor, has_errors }
    }

    /// Returns the place of a point.
    fn place(&self, point: &Point) -> (f64, f64) {
        let is_drawn = point.error > self.nothing;
        let y = if is_drawn { self.up.at(point.error) } else { self.plot.bottom - 0.5 * NOTHING };
        (self.across.at(self.scale * point.times.least), y)
    }

    /// Draws the ticks with their lines, and the frame.
    fn draw<D: DrawingBackend>(&self, canvas: &Canvas<D>) -> io::Result<()> {
        let Self { plot, across, up, nothing, has_nothing, floor, .. } = self;
        let ticks = Letters::new(TEXT);
        for (time, text) in across.ticks() {
            let x = across.at(time);
            canvas.line(&[(x, plot.top), (x, plot.bottom)], LIGHT, 1.0)?;
            canvas.text(&text, (x, plot.bottom + 16.0), Align::Middle, ticks)?;
        }
        for (error, text) in if self.has_errors { up.ticks() } else { Vec::new() } {
            let y = up.at(error);
            canvas.line(&[(plot.left, y), (plot.right, y)], LIGHT, 1.0)?;
            canvas.text(&text, (plot.left - 8.0, y), Align::Right, ticks)?;
        }
        if *has_nothing {
            canvas.line(&[(plot.left, *floor), (plot.right, *floor)], LIGHT, 2.0)?;
            let text = if *nothing == 0.0 { "0" } else { "none" };
            canvas.text(text, (plot.left - 8.0, plot.bottom - 0.5 * NOTHING), Align::Right, ticks)?;
        }
        canvas.frame(*plot, BLACK)
    }
}

/// Returns the label of a point.
fn name(panel: &Panel, point: &Point) -> String {
    if panel.subject == Subject::Samples {
        return point.samples.to_string();
    }
    if point.wrong.faults() == 0 {
        return point.name.clone();
    }
    let percent = 100.0 * point.wrong.faults() as f64 / point.wrong.of as f64;
    let digits = usize::from(percent < 10.0) + 2 * usize::from(percent < 0.1);
    format!("{}: {percent:.digits$} %", point.name)
}
