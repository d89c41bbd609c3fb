//! Writes answers.

use super::columns::{self, Answered};
use std::io::{self, Write};
use tabray_core::output::npy;
use tabray_core::text;

/// How answers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "commands", derive(clap::ValueEnum))]
pub enum AnswerFormat {
    /// A JSON object per line
    ///
    /// What there is not is left out.
    #[cfg_attr(feature = "commands", value(name = "jsonl"))]
    JsonLines,
    /// A line of names, and then of values
    ///
    /// What there is not is empty.
    Csv,
    /// A NumPy array
    ///
    /// It is structured; what there is not is -1 or NaN.
    Npy,
}

impl AnswerFormat {
    /// Writes the text before the answers. An array needs the number of answers. `are_all` says whether a ray may
    /// have several answers.
    ///
    /// # Errors
    /// Returns the errors of `out`, and for an array, an error where the number is not known.
    pub fn begin(self, count: Option<u64>, are_all: bool, out: &mut dyn Write) -> io::Result<()> {
        match (self, count) {
            (Self::JsonLines, _) => Ok(()),
            (Self::Csv, _) => writeln!(out, "{}", columns::csv_names(are_all).join(",")),
            (Self::Npy, Some(count)) => npy::begin(&columns::record(), &format!("({count},)"), out),
            (Self::Npy, None) => {
                Err(io::Error::new(io::ErrorKind::InvalidInput, "an array needs its length first"))
            }
        }
    }

    /// Returns the text or the bytes of some answers.
    pub(super) fn written(self, answers: &[Answered]) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self {
            Self::JsonLines => {
                for answer in answers {
                    bytes.extend_from_slice(text::json(answer).as_bytes());
                    bytes.push(b'\n');
                }
            }
            Self::Csv => {
                let mut out = csv::WriterBuilder::new().has_headers(false).from_writer(&mut bytes);
                for answer in answers {
                    out.write_record(answer.fields())?;
                }
                out.flush()?;
                drop(out);
            }
            Self::Npy => {
                answers.iter().for_each(|answer| answer.cells().for_each(|cell| cell.write(&mut bytes)));
            }
        }
        Ok(bytes)
    }
}
