//! The page that shows what changed: one file with everything in it, which works without a network.

use super::explain::Explanation;
use super::failure::Failure;
use super::messages;
use super::output::Output;
use crate::output::compare::Comparison;
use crate::words;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, RgbImage};
use serde::Serialize;
use similar::{ChangeTag, TextDiff};
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

const PAGE: &str = include_str!("report.html");

/// Where the page wants its data: one place, in an element that no script is.
const DATA: &str = "\"the data\"";

/// Something that changed, or may have.
pub struct Item {
    /// What it is called.
    pub name: String,
    /// What it was and is.
    pub change: Change,
    /// How its first differing pixel came about.
    pub explanations: Vec<Explanation>,
    /// How to decide about it, where that is to be done.
    pub decision: Option<Decision>,
}

/// What is shown.
pub enum Change {
    /// A picture, as it was if it was, and as it is; and what one picture and the other are called.
    Picture { old: Option<RgbImage>, new: RgbImage, names: [String; 2], comparison: Option<Comparison> },
    /// A text.
    Text { old: Option<String>, new: String },
}

impl Change {
    /// A few words on what changed.
    pub fn summary(&self) -> String {
        match self {
            Self::Picture { comparison: Some(comparison), .. } => comparison.to_string(),
            Self::Picture { old: None, new, .. } => format!("new, {}", size(new)),
            Self::Picture { old: Some(old), new, .. } => {
                format!("the size differs: {} became {}", size(old), size(new))
            }
            Self::Text { old: None, .. } => "new".to_owned(),
            Self::Text { old: Some(old), new } => {
                let diff = TextDiff::from_lines(old, new);
                let count = |tag| diff.iter_all_changes().filter(|line| line.tag() == tag).count();
                format!("lines: {} removed, {} added", count(ChangeTag::Delete), count(ChangeTag::Insert))
            }
        }
    }
}

fn size(picture: &RgbImage) -> String {
    format!("{} x {} pixels", picture.width(), picture.height())
}

/// How to accept or reject a pending snapshot.
#[derive(Serialize)]
pub struct Decision {
    /// The command that accepts it.
    pub accept: String,
    /// The command that rejects it.
    pub reject: String,
    /// What tells this content from any other that the snapshot may have later.
    pub version: String,
}

/// The file of a page, found fit before any work is done.
pub struct Page {
    path: PathBuf,
    output: Output,
}

impl Page {
    /// Opens the file; it must be named as a page, so that no picture is taken for one and written over.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html")) {
            return Err(Failure::Usage(
                format!("`{}` is not the name of an HTML file", path.display()),
                Some("end it in .html".to_owned()),
            ));
        }
        Ok(Self { path: path.to_owned(), output: Output::open(path)? })
    }

    /// Writes it.
    pub fn write(mut self, title: &str, items: &[Item]) -> Result<(), Failure> {
        let written = html(title, items, false)
            .and_then(|html| self.output.write_all(html.as_bytes()))
            .and_then(|()| self.output.finish());
        written.map_err(|error| Failure::cannot_write(&self.path, &error))?;
        messages::note(&format!("wrote {}", self.path.display()));
        Ok(())
    }
}

/// The page, as HTML. One that is `served` can accept and reject.
pub fn html(title: &str, items: &[Item], served: bool) -> io::Result<String> {
    let items = items.iter().map(Shown::of).collect::<io::Result<_>>()?;
    let data = words::json(&Data { items, served, title });
    // Nothing in the data can end its element: in JSON a `<` can be written otherwise.
    Ok(PAGE.replacen(DATA, &data.replace('<', "\\u003c"), 1))
}

/// What the page shows.
#[derive(Serialize)]
struct Data<'d> {
    /// What changed.
    items: Vec<Shown<'d>>,
    /// Whether it can accept and reject.
    served: bool,
    /// The title of the page.
    title: &'d str,
}

/// An item as the page has it.
#[derive(Serialize)]
struct Shown<'d> {
    /// How to decide about it; left out where that is not to be done.
    #[serde(skip_serializing_if = "Option::is_none")]
    decision: Option<&'d Decision>,
    /// How its first differing pixel came about: titles and texts.
    explanations: Vec<(&'d str, &'d str)>,
    /// What it is called.
    name: &'d str,
    /// A few words on what changed.
    summary: String,
    /// What it was and is, among the other fields.
    #[serde(flatten)]
    sides: Sides<'d>,
}

/// What an item was and is. The field `kind` has the variant's name.
#[derive(Serialize)]
#[serde(rename_all = "lowercase", tag = "kind")]
enum Sides<'d> {
    /// A picture.
    Picture {
        /// The first pixel that differs, or null.
        first: Option<First>,
        /// What the old and the new picture are called.
        names: &'d [String; 2],
        /// The new picture, as the address of an image.
        new: String,
        /// The old one, or null.
        old: Option<String>,
        /// How many levels of a channel may differ; null where the pictures cannot be compared.
        tolerance: Option<u8>,
    },
    /// A text.
    Text {
        /// Its lines, with those that go.
        lines: Vec<Line>,
    },
}

/// Whether a line of a text stays (a blank), goes (`-`) or comes (`+`), its numbers in the old and the new text, from 1,
/// or null, and the line.
type Line = (char, Option<usize>, Option<usize>, String);

/// The first pixel that differs.
#[derive(Serialize)]
struct First {
    /// What became of it, in words.
    text: String,
    /// Its column, from 0 at the left.
    x: u32,
    /// Its row, from 0 at the bottom.
    y: u32,
}

impl<'d> Shown<'d> {
    fn of(item: &'d Item) -> io::Result<Self> {
        let sides = match &item.change {
            Change::Picture { old, new, names, comparison } => {
                let first = comparison.as_ref().and_then(|comparison| comparison.first);
                Sides::Picture {
                    first: first.map(|pixel| First { text: pixel.to_string(), x: pixel.x, y: pixel.y }),
                    names,
                    new: data_uri(new)?,
                    old: old.as_ref().map(data_uri).transpose()?,
                    tolerance: comparison.as_ref().map(|comparison| comparison.tolerance),
                }
            }
            Change::Text { old, new } => {
                let diff = TextDiff::from_lines(old.as_deref().unwrap_or_default(), new);
                Sides::Text { lines: diff.iter_all_changes().map(|line| line_of(&line)).collect() }
            }
        };
        let explanation = |Explanation { title, text }: &'d Explanation| (title.as_str(), text.as_str());
        Ok(Self {
            decision: item.decision.as_ref(),
            explanations: item.explanations.iter().map(explanation).collect(),
            name: &item.name,
            summary: item.change.summary(),
            sides,
        })
    }
}

/// The picture within the page, written anew: no colour profile that its file may have changes what is seen.
fn data_uri(picture: &RgbImage) -> io::Result<String> {
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(png.into_inner())))
}

fn line_of(line: &similar::Change<&str>) -> Line {
    let sign = match line.tag() {
        ChangeTag::Equal => ' ',
        ChangeTag::Delete => '-',
        ChangeTag::Insert => '+',
    };
    let number = |index: usize| index + 1;
    let text = line.value().trim_end_matches('\n').to_owned();
    (sign, line.old_index().map(number), line.new_index().map(number), text)
}
