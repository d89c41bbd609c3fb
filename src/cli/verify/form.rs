//! What `tabray verify` reports beside its verdicts: the assumptions of the proofs, and the first pixels of each kind.

use crate::files::output::{self, Output};
use crate::process::failure::Failure;
use serde::Serialize;
use std::path::PathBuf;
use tabray_core::output::picture::Format;
use tabray_core::render::plan::Plan;
use tabray_core::text;
use tabray_tools::assumptions::{self, Assumed};

/// The number of pixels of each kind that are named.
const NAMED: usize = 5;

/// What is reported of the image beside the verdicts, and how.
pub struct Form {
    /// The width and height of the image in pixels.
    pub size: [usize; 2],
    pub premises: Premises,
    /// Whether it is reported as JSON.
    pub is_json: bool,
}

/// The image of the verdicts.
pub struct PictureFile {
    pub path: PathBuf,
    pub format: Format,
    pub output: Output,
}

impl PictureFile {
    /// Writes the bytes of an image of this size.
    pub fn write(self, size: [usize; 2], bytes: Vec<u8>) -> Result<(), Failure> {
        let Self { path, format, output } = self;
        output::write_image(&path, output, |out| format.write(out, size, [Ok(bytes)]))
    }
}

/// What proofs start from.
#[derive(Serialize)]
pub struct Premises {
    /// The types of shapes that have no equation.
    uncertified: Vec<&'static str>,
    assumptions: Vec<Assumed>,
}

impl Premises {
    pub fn of(plan: &Plan, for_colours: bool) -> Self {
        let assumptions = assumptions::of(plan, for_colours);
        Self { uncertified: assumptions::uncertified(plan.model), assumptions }
    }

    /// Returns the count of pixels or bytes that are not certified, to stand between others; nothing where all shapes have
    /// an equation.
    pub fn counted(&self, uncertified: usize) -> String {
        match &self.uncertified[..] {
            [] => String::new(),
            types => format!("{uncertified} not certified: {}, ", text::list(types.iter().copied())),
        }
    }

    /// Returns a line for each assumption.
    pub fn lines(&self) -> String {
        self.assumptions.iter().map(|assumed| format!("assumed: {assumed}\n")).collect()
    }
}

impl Form {
    /// Returns the first pixels with a verdict, by column from the left and row from the bottom.
    pub fn first<V: PartialEq>(&self, verdicts: &[V], wanted: &V) -> Vec<[usize; 2]> {
        let [width, height] = self.size;
        let found = verdicts.iter().enumerate().filter(|(_, verdict)| *verdict == wanted);
        found.map(|(index, _)| [index % width, height - 1 - index / width]).take(NAMED).collect()
    }
}
