//! The report of `tabray verify`: which pixels show the object that is certainly hit first.

use super::form::{Form, PictureFile, Premises};
use crate::process::failure::{Failure, print};
use serde::Serialize;
use tabray_core::text;
use tabray_tools::verify::Verdict;

/// The numbers of pixels.
#[derive(Serialize)]
struct Counts {
    all: usize,
    proven: usize,
    ties: usize,
    not_certified: usize,
    contradicted: usize,
}

/// The first pixels of each kind, by column from the left and row from the bottom.
#[derive(Serialize)]
struct FirstPixels {
    ties: Vec<[usize; 2]>,
    not_certified: Vec<[usize; 2]>,
    contradicted: Vec<[usize; 2]>,
}

/// The numbers that are printed as JSON.
#[derive(Serialize)]
struct Numbers<'a> {
    pixels: Counts,
    first: FirstPixels,
    #[serde(flatten)]
    premises: &'a Premises,
}

/// Reports the verdicts on all pixels, in rows from the top, and writes the image of them.
pub fn report(verdicts: &[Verdict], form: &Form, picture: Option<PictureFile>) -> Result<(), Failure> {
    let counts = Counts::of(verdicts);
    let contradicted = counts.contradicted;
    let first = |verdict| form.first(verdicts, &verdict);
    print(&if form.is_json {
        let first = FirstPixels {
            ties: first(Verdict::Tie),
            not_certified: first(Verdict::Uncertified),
            contradicted: first(Verdict::Contradicted),
        };
        text::json_in_lines(&Numbers { pixels: counts, first, premises: &form.premises })
    } else {
        counts.message(form)
    })?;
    if let Some(picture) = picture {
        let colour = |verdict: &Verdict| match verdict {
            Verdict::Proven => [0; 3],
            Verdict::Tie => [255; 3],
            Verdict::Uncertified => [0, 0, 255],
            Verdict::Contradicted => [255, 0, 0],
        };
        picture.write(form.size, verdicts.iter().flat_map(colour).collect())?;
    }
    if contradicted > 0 {
        return Err(Failure::Failed(format!(
            "the tracer finds another object at {}",
            text::count(contradicted, "pixel")
        )));
    }
    Ok(())
}

impl Counts {
    fn of(verdicts: &[Verdict]) -> Self {
        let count = |wanted| verdicts.iter().filter(|verdict| **verdict == wanted).count();
        Self {
            all: verdicts.len(),
            proven: count(Verdict::Proven),
            ties: count(Verdict::Tie),
            not_certified: count(Verdict::Uncertified),
            contradicted: count(Verdict::Contradicted),
        }
    }

    fn message(&self, Form { premises, .. }: &Form) -> String {
        let Self { all, proven, ties, not_certified, contradicted } = self;
        let percent = 100.0 * *proven as f64 / *all as f64;
        format!(
            "{proven} of {all} pixels proven ({percent:.4} %), {}, {}{contradicted} contradicted\n{}",
            text::count(*ties, "tie"),
            premises.counted(*not_certified),
            premises.lines(),
        )
    }
}
