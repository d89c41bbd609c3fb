//! The page that shows changes: one self-contained file, which works without a network.

use super::explain::Explanation;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use image::codecs::png::PngEncoder;
use serde::Serialize;
use similar::algorithms::{Capture, Compact, Replace, myers};
use similar::{Change as LineChange, ChangeTag, DiffableStr};
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tabray_cli::files::output::Output;
use tabray_cli::process::failure::Failure;
use tabray_cli::process::messages;
use tabray_core::output::compare::{Comparison, Pixel};
use tabray_core::text;

const PAGE: &str = include_str!("report.html");

/// The placeholder for the page's data: its only occurrence, in an element that is not executed as a script.
const DATA: &str = "\"the data\"";

/// Something that has changed, or may have changed.
pub struct Item {
    /// The name.
    pub name: String,
    /// The old and the new content.
    pub change: Change,
    /// Explanations of the pixel that differs most.
    pub explanations: Vec<Explanation>,
    /// The commands that accept or reject the change, if the user is to decide.
    pub decision: Option<Decision>,
}

/// The old and the new content of an item.
pub enum Change {
    /// An image, with the old one if there is one, the names of both, and their comparison.
    Picture { old: Option<RgbImage>, new: RgbImage, names: [String; 2], comparison: Option<Comparison> },
    /// A text.
    Text { old: Option<String>, new: String },
}

impl Change {
    /// Summarizes the change in a few words.
    pub fn summary(&self) -> String {
        match self {
            Self::Picture { comparison: Some(comparison), .. } => comparison.to_string(),
            Self::Picture { old: None, new, .. } => format!("new, {}", size(new)),
            Self::Picture { old: Some(old), new, .. } => {
                format!("the size differs: {} became {}", size(old), size(new))
            }
            Self::Text { old: None, .. } => "new".to_owned(),
            Self::Text { old: Some(old), new } => {
                let lines = diff(old, new);
                let count = |sign| lines.iter().filter(|line| line.0 == sign).count();
                format!("lines: {} removed, {} added", count('-'), count('+'))
            }
        }
    }
}

fn size(picture: &RgbImage) -> String {
    format!("{} x {} pixels", picture.width(), picture.height())
}

/// The ways to accept or reject a pending snapshot.
#[derive(Serialize)]
pub struct Decision {
    /// The command that accepts it.
    pub accept: String,
    /// The command that rejects it.
    pub reject: String,
    /// A hash that tells this content from other contents of the snapshot.
    pub version: String,
}

/// The file of a page, opened before any work is done.
pub struct Page {
    path: PathBuf,
    output: Output,
}

impl Page {
    /// Opens the file. It must have the extension of a page, so that an image named by mistake is not overwritten.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html")) {
            return Err(Failure::usage(format!("`{}` is not the name of an HTML file", text::shown(path)))
                .help("end it in .html"));
        }
        Ok(Self { path: path.to_owned(), output: Output::open(path)? })
    }

    /// Writes the page.
    pub fn write(mut self, title: &str, items: &[Item]) -> Result<(), Failure> {
        let written = html(title, items, false)
            .and_then(|html| self.output.write_all(html.as_bytes()))
            .and_then(|()| self.output.finish());
        written.map_err(|error| Failure::cannot_write(&self.path, &error))?;
        messages::note(&format!("wrote {}", text::shown(&self.path)));
        Ok(())
    }
}

/// Returns the page as HTML. A page that is `served` can accept and reject.
pub fn html(title: &str, items: &[Item], served: bool) -> io::Result<String> {
    let items = items.iter().map(Shown::of).collect::<io::Result<_>>()?;
    let data = text::json(&Data { items, served, title });
    // Nothing in the data may end the element; in JSON a `<` can be escaped.
    Ok(PAGE.replacen(DATA, &data.replace('<', "\\u003c"), 1))
}

/// The data of the page.
#[derive(Serialize)]
struct Data<'d> {
    /// The items that have changed.
    items: Vec<Shown<'d>>,
    /// Whether the page can accept and reject.
    served: bool,
    title: &'d str,
}

/// An item, as the page receives it.
#[derive(Serialize)]
struct Shown<'d> {
    /// The commands that decide about the item; left out if there is nothing to decide.
    #[serde(skip_serializing_if = "Option::is_none")]
    decision: Option<&'d Decision>,
    /// Explanations of the pixel that differs most: titles and texts.
    explanations: Vec<(&'d str, Cow<'d, str>)>,
    name: &'d str,
    /// A summary of the change in a few words.
    summary: String,
    /// The old and the new content, as fields of the item.
    #[serde(flatten)]
    sides: Sides<'d>,
}

/// The old and the new content of an item. The field `kind` has the variant's name.
#[derive(Serialize)]
#[serde(rename_all = "lowercase", tag = "kind")]
enum Sides<'d> {
    /// An image.
    Picture {
        /// The first pixel that differs, or null.
        first: Option<DifferingPixel>,
        /// The pixel that differs most, or null.
        worst: Option<DifferingPixel>,
        /// The names of the old and the new image.
        names: &'d [String; 2],
        /// The new image, as a data URI.
        new: String,
        /// The old image, or null.
        old: Option<String>,
        /// The tolerance in levels of a channel; null where the images cannot be compared.
        tolerance: Option<u8>,
    },
    /// A text.
    Text {
        /// The lines of both texts, as a diff.
        lines: Vec<Line>,
    },
}

/// A line of a diff: a blank if the line stays, `-` if it is removed, `+` if it is added; its numbers in the old and
/// the new text, from 1, or null; and the line itself.
type Line = (char, Option<usize>, Option<usize>, String);

/// A pixel that differs.
#[derive(Serialize)]
struct DifferingPixel {
    /// The pixel's colours before and after, in words.
    text: String,
    /// The column, from 0 at the left.
    x: u32,
    /// The row, from 0 at the bottom.
    y: u32,
}

impl<'d> Shown<'d> {
    fn of(item: &'d Item) -> io::Result<Self> {
        let sides = match &item.change {
            Change::Picture { old, new, names, comparison } => {
                let found = |pixel: Option<Pixel>| {
                    pixel.map(|pixel| DifferingPixel { text: pixel.to_string(), x: pixel.x, y: pixel.y })
                };
                Sides::Picture {
                    first: found(comparison.as_ref().and_then(|comparison| comparison.first)),
                    worst: found(comparison.as_ref().and_then(|comparison| comparison.worst)),
                    names,
                    new: data_uri(new)?,
                    old: old.as_ref().map(data_uri).transpose()?,
                    tolerance: comparison.as_ref().map(|comparison| comparison.tolerance),
                }
            }
            Change::Text { old, new } => Sides::Text { lines: diff(old.as_deref().unwrap_or_default(), new) },
        };
        let explanation =
            |Explanation { title, text }: &'d Explanation| (title.as_str(), text::visible_lines(text));
        Ok(Self {
            decision: item.decision.as_ref(),
            explanations: item.explanations.iter().map(explanation).collect(),
            name: &item.name,
            summary: item.change.summary(),
            sides,
        })
    }
}

/// Encodes an image as a data URI. It is encoded anew, so that no colour profile in its file changes its look.
fn data_uri(picture: &RgbImage) -> io::Result<String> {
    let mut png = Vec::new();
    let out: &mut dyn Write = &mut png;
    picture.write_with_encoder(PngEncoder::new(out)).map_err(io::Error::other)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(png)))
}

/// Compares two texts line by line.
fn diff(old: &str, new: &str) -> Vec<Line> {
    let (old, new) = (old.tokenize_lines(), new.tokenize_lines());
    // As `TextDiff` does it, which is made to be compiled with each of its algorithms for several types.
    let mut found = Compact::new(Replace::new(Capture::new()), &old, &new);
    let Ok(()) = myers::diff(&mut found, &old, 0..old.len(), &new, 0..new.len());
    let found = found.into_inner().into_inner();
    found.ops().iter().flat_map(|op| op.iter_changes(&old, &new)).map(|line| line_of(&line)).collect()
}

fn line_of(line: &LineChange<&str>) -> Line {
    let sign = match line.tag() {
        ChangeTag::Equal => ' ',
        ChangeTag::Delete => '-',
        ChangeTag::Insert => '+',
    };
    let number = |index: usize| index + 1;
    let text = text::visible_lines(line.value().trim_end_matches('\n')).into_owned();
    (sign, line.old_index().map(number), line.new_index().map(number), text)
}
