//! `tabray render --overlay`: the lines and the labels of an image as an SVG over it.

use crate::files::output::{self, Output};
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::Failure;
use crate::process::progress::Progress;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_tools::overlay::{Curve, Overlay};

#[derive(clap::Args)]
#[group(id = "drawing over it")]
#[command(next_help_heading = "Image")]
pub struct Args {
    /// Also draw the outlines, the level lines and the labels of what is seen into this SVG, which contains the image: `-o
    /// figure.png --overlay figure.svg`. The image itself is then without the numbers of `axes`
    #[arg(long, value_name = "FILE.svg", conflicts_with_all = ["part", "frames", "resume"])]
    overlay: Option<PathBuf>,
}

/// The SVG of an image, to be written.
pub struct Drawing {
    path: PathBuf,
    output: Output,
    image: PathBuf,
    dpi: Option<u32>,
}

impl Args {
    /// Tells whether an SVG is asked for.
    pub fn is_wanted(&self) -> bool {
        self.overlay.is_some()
    }

    /// Opens the SVG over an image, if it is asked for.
    pub fn open(
        &self,
        (image, format, full_range): (&Path, Format, Option<FullRange>),
        dpi: Option<u32>,
        (scene, model): (&Path, &Model),
    ) -> Result<Option<Drawing>, Failure> {
        let Some(path) = &self.overlay else { return Ok(None) };
        if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("svg")) {
            let message =
                format!("`--overlay` draws an SVG, and `{}` is the name of none", text::shown(path));
            let named = path.with_extension("svg");
            return Err(Failure::usage(message).help(format!("`--overlay {}`", text::shown(&named))));
        }
        let is_png = matches!(format, Format::Png(_)) && full_range.is_none() && image != Path::new("-");
        if !is_png {
            let message = format!("`{}` cannot contain `{}`", text::shown(path), text::shown(image));
            return Err(Failure::usage(message)
                .help("an SVG contains a PNG in a file: `-o figure.png --overlay figure.svg`"));
        }
        output::refuse_source_by(path, "the SVG", scene, model)?;
        let output = Output::open(path)?;
        Ok(Some(Drawing { path: path.clone(), output, image: image.to_owned(), dpi }))
    }
}

impl Drawing {
    /// Finds the lines of the image, and writes the SVG.
    pub fn write(
        self,
        plan: &Plan,
        region: &Region,
        renderer: &Renderer,
        stop: &Stop,
    ) -> Result<(), Failure> {
        let progress = Progress::new(region.rows.len());
        let proceed = || {
            progress.step();
            stop.exit_on_interrupt()
        };
        let find = || Overlay::of(plan, region.columns.clone(), region.rows.clone(), proceed);
        let overlay = renderer.run(find);
        progress.end();
        let overlay = overlay?;
        let image = fs::read(&self.image).map_err(|error| Failure::cannot_read(&self.image, &error))?;
        let svg = svg(&overlay, region, &BASE64_STANDARD.encode(image), self.dpi);
        output::write_image(&self.path, self.output, |out| out.write_all(svg.as_bytes()))
    }
}

/// The width of an outline, as a part of the longer side of the image.
const STROKE: f64 = 1.0 / 600.0;

/// The height of a digit, in sizes of its font.
const DIGIT: f64 = 0.68;

fn svg(overlay: &Overlay, region: &Region, image: &str, dpi: Option<u32>) -> String {
    let ([width, height], [left, top]) = (region.size(), [region.columns.start, region.rows.start]);
    let size = |side: usize| match dpi {
        Some(dpi) => format!("{}in", side as f64 / f64::from(dpi)),
        None => side.to_string(),
    };
    let stroke = STROKE * width.max(height) as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"{left} {top} {width} {height}\">\n\
         <image href=\"data:image/png;base64,{image}\" x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>\n",
        size(width),
        size(height),
    );
    for (class, curves, stroke) in
        [("levels", &overlay.levels, 0.5 * stroke), ("outlines", &overlay.outlines, stroke)]
    {
        let _ = writeln!(
            svg,
            "<g class=\"{class}\" fill=\"none\" stroke=\"black\" stroke-width=\"{stroke:.2}\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\">"
        );
        curves.iter().for_each(|curve| {
            let _ = writeln!(svg, "<path d=\"{}\"/>", path(curve));
        });
        svg += "</g>\n";
    }
    svg += "<g class=\"labels\" font-family=\"serif\" text-anchor=\"middle\">\n";
    for label in &overlay.labels {
        let is_name = label.text.starts_with(char::is_alphabetic);
        let _ = writeln!(
            svg,
            "<text x=\"{:.2}\" y=\"{:.2}\" font-size=\"{:.2}\"{}>{}</text>",
            label.at.x,
            label.at.y + 0.5 * label.height,
            label.height / DIGIT,
            if is_name { " font-style=\"italic\"" } else { "" },
            label.text.replace('-', "\u{2212}"),
        );
    }
    svg + "</g>\n</svg>\n"
}

/// Returns a curve through points as the data of a path, closed where it ends at its beginning.
fn path(curve: &Curve) -> String {
    let is_closed = curve.len() > 2 && curve.first() == curve.last();
    let points = &curve[..curve.len() - usize::from(is_closed)];
    let points: Vec<_> = points.iter().map(|at| format!("{:.2} {:.2}", at.x, at.y)).collect();
    format!("M{}{}", points.join(" "), if is_closed { "Z" } else { "" })
}
