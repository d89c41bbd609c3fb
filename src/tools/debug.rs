//! The notes' debug lines (`DBG_PIX` and so on), in their order and their format.

use std::fmt;
use std::io::{self, Write};
use tabray_core::geometry::ray::{Ray, RayRange};
use tabray_core::named;
use tabray_core::render::observer::{Event, RayPurpose, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;

/// A kind of the notes' debug lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogLine {
    /// The pixel: its row and its column.
    Pix,
    /// What a ray hits, and where.
    ///
    /// A ray from the viewer, a mirror or glass.
    Hit,
    /// The colour of what it hits.
    ///
    /// By ambient light and lights.
    Drgb,
    /// The pixel's bytes.
    Irgb,
    /// The pixel's offset in the image file.
    ///
    /// In pixels.
    Offset,
    /// Each object that a ray finds, and its distance.
    Find,
}

named!(LogLine {
    Pix => "pix",
    Hit => "hit",
    Drgb => "drgb",
    Irgb => "irgb",
    Offset => "offset",
    Find => "find",
});

/// Traces one pixel and prints these lines about it, in the order in which the notes' program prints them.
///
/// # Errors
/// Returns the errors of `out`.
pub fn pixel(plan: &Plan, x: usize, y: usize, lines: &[LogLine], out: &mut impl Write) -> io::Result<()> {
    if lines.contains(&LogLine::Pix) {
        write!(out, "\nPIX {y:>4} {x:>4} - ")?;
    }
    let mut printer = Printer { model: plan.model, lines, out, ray: None, shadow: false, outcome: Ok(()) };
    let colour = trace::observe_pixel(plan, x, y, &mut printer);
    printer.outcome?;
    if lines.contains(&LogLine::Irgb) {
        // Printed as the file gets it, so a channel of 127.6 is printed as 127.
        let [r, g, b] = plan.camera.display().bytes(colour);
        write!(out, " IRGB:({r:>5}, {g:>5}, {b:>5})")?;
    }
    if lines.contains(&LogLine::Offset) {
        let [width, height] = plan.camera.pixels;
        write!(out, "OFF: {:>7}", (height - 1 - y) * width + x)?;
    }
    Ok(())
}

struct Printer<'p, W> {
    model: &'p Model,
    lines: &'p [LogLine],
    out: &'p mut W,
    /// The current ray, and whether it is a shadow ray.
    ray: Option<Ray>,
    shadow: bool,
    outcome: io::Result<()>,
}

impl<W: Write> Printer<'_, W> {
    fn print(&mut self, line: LogLine, text: fmt::Arguments) {
        if self.outcome.is_ok() && self.lines.contains(&line) {
            self.outcome = self.out.write_fmt(text);
        }
    }

    /// The notes' program asks each object for its distance along the whole ray, whatever was found before.
    fn find(&mut self, index: usize) {
        let Some(ray) = &self.ray else { return };
        let object = &self.model.objects[index];
        let distance = object.shape.distance(ray, &RayRange::ALL);
        if distance < f64::INFINITY {
            self.print(LogLine::Find, format_args!("FND {:>12}: {distance:5.1} - \n ", object.args.name()));
        }
    }
}

impl<W: Write> TraceObserver for Printer<'_, W> {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::Begin(purpose) => self.shadow = matches!(purpose, RayPurpose::Shadow { .. }),
            Event::Search(ray) => self.ray = Some(*ray),
            Event::Tested(index, Some(_)) => self.find(index),
            Event::FirstHit(Some(hit)) if !self.shadow => {
                let (name, at) = (&hit.object.args.name(), hit.point);
                let text = format_args!("{name:<12} HIT:({:5.1}, {:5.1}, {:5.1})", at.x, at.y, at.z);
                self.print(LogLine::Hit, text);
            }
            Event::Shaded { hit, colour, .. } => {
                let (name, c) = (&hit.object.args.name(), colour);
                let text = format_args!("{name:<12} DRGB:({:5.2}, {:5.2}, {:5.2})", c.x, c.y, c.z);
                self.print(LogLine::Drgb, text);
            }
            _ => {}
        }
    }
}
