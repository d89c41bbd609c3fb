//! The report of `tabray verify`: which pixels show the object that is certainly hit first.

use super::form::{Form, PictureFile, Premises};
use crate::process::failure::{Failure, print};
use serde::Serialize;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_tools::verify::{Pixel, Verdict};

/// The numbers of pixels.
#[derive(Serialize)]
struct Counts {
    all: usize,
    proven: usize,
    /// Ties and pixels that are not certified.
    undecided: usize,
    ties: usize,
    not_certified: usize,
    contradicted: usize,
}

/// The pixels in which the tracer finds an object.
#[derive(Serialize)]
struct ObjectCounts<'a> {
    /// Its name and its index; neither for pixels in which nothing is found.
    object: Option<&'a str>,
    number: Option<usize>,
    #[serde(flatten)]
    pixels: Counts,
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
    /// The width and the height of the image in pixels.
    size: [usize; 2],
    pixels: Counts,
    /// The part of the pixels that is proven, from 0 to 1.
    share: f64,
    /// The objects that are found, in the order of the scene, and then nothing.
    objects: Vec<ObjectCounts<'a>>,
    first: FirstPixels,
    #[serde(flatten)]
    premises: &'a Premises,
}

/// Reports the verdicts on all pixels, in rows from the top, and writes the image of verdicts.
pub fn report(
    model: &Model,
    pixels: &[Pixel],
    form: &Form,
    picture: Option<PictureFile>,
) -> Result<(), Failure> {
    let verdicts: Vec<_> = pixels.iter().map(|pixel| pixel.verdict).collect();
    let counts = Counts::of(&verdicts);
    let contradicted = counts.contradicted;
    let first = |verdict| form.first(&verdicts, &verdict);
    print(&if form.is_json {
        let first = FirstPixels {
            ties: first(Verdict::Tie),
            not_certified: first(Verdict::Uncertified),
            contradicted: first(Verdict::Contradicted),
        };
        text::json_in_lines(&Numbers {
            size: form.size,
            share: counts.proven as f64 / counts.all as f64,
            pixels: counts,
            objects: of_objects(model, pixels),
            first,
            premises: &form.premises,
        })
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

/// Counts the pixels of each object that any pixel shows, and then the pixels that show nothing.
fn of_objects<'m>(model: &'m Model, pixels: &[Pixel]) -> Vec<ObjectCounts<'m>> {
    let objects = &model.objects;
    let mut verdicts = vec![Vec::new(); objects.len() + 1];
    for pixel in pixels {
        verdicts[pixel.object.unwrap_or(objects.len())].push(pixel.verdict);
    }
    let found = verdicts.iter().enumerate().filter(|(_, verdicts)| !verdicts.is_empty());
    let counted = found.map(|(index, verdicts)| {
        let object = objects.get(index);
        let name = object.map(|object| object.args.name());
        ObjectCounts { object: name, number: object.map(|_| index), pixels: Counts::of(verdicts) }
    });
    counted.collect()
}

impl Counts {
    fn of(verdicts: &[Verdict]) -> Self {
        let count = |wanted| verdicts.iter().filter(|verdict| **verdict == wanted).count();
        let (ties, not_certified) = (count(Verdict::Tie), count(Verdict::Uncertified));
        Self {
            all: verdicts.len(),
            proven: count(Verdict::Proven),
            undecided: ties + not_certified,
            ties,
            not_certified,
            contradicted: count(Verdict::Contradicted),
        }
    }

    fn message(&self, Form { premises, .. }: &Form) -> String {
        let Self { all, proven, ties, not_certified, contradicted, .. } = self;
        let percent = 100.0 * *proven as f64 / *all as f64;
        format!(
            "{proven} of {all} pixels proven ({percent:.4} %), {}, {}{contradicted} contradicted\n{}",
            text::count(*ties, "tie"),
            premises.counted(*not_certified),
            premises.lines(),
        )
    }
}
