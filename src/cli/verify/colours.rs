//! `tabray verify --colours`: proves the bytes of an image.

use super::form::{Form, PictureFile, Premises};
use crate::options::number::whole;
use crate::process::failure::{Failure, print};
use crate::process::messages;
use crate::process::progress::Progress;
use crate::process::time_limit;
use serde::Serialize;
use std::time::Instant;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::sample::Sampler;
use tabray_tools::colours::{Pixel, Prover, Verdict};

#[derive(clap::Args)]
#[group(id = "proofs of colours")]
pub struct Args {
    /// With --colours, the number of samples per pixel; by default that of the scene's camera
    #[arg(
        long, value_name = "N", requires = "colours",
        value_parser = whole::<u32>(1..=Sampler::MAX_SAMPLES)
    )]
    samples: Option<u32>,
}

/// The verdicts on pixels in rows from the top; `None` where the time was up.
pub type Proof = Vec<Option<Pixel>>;

/// The numbers of pixels or bytes.
#[derive(Serialize)]
struct Counts {
    all: usize,
    proven: usize,
    rounded: usize,
    open: usize,
    not_certified: usize,
    contradicted: usize,
    not_reached: usize,
}

/// The first pixels of each kind, by column from the left and row from the bottom.
#[derive(Serialize)]
struct FirstPixels {
    rounded: Vec<[usize; 2]>,
    open: Vec<[usize; 2]>,
    not_certified: Vec<[usize; 2]>,
    contradicted: Vec<[usize; 2]>,
}

/// The numbers that are printed as JSON.
#[derive(Serialize)]
struct Numbers<'a> {
    pixels: Counts,
    bytes: Counts,
    first: FirstPixels,
    #[serde(flatten)]
    premises: &'a Premises,
}

/// Proves the colours of a plan's pixels.
pub fn prove(
    args: &Args,
    renderer: &Renderer,
    mut plan: Plan,
    progress: &Progress,
) -> Result<Proof, Failure> {
    if plan.camera.accuracy == Accuracy::Classic {
        let message = "the colours of the classic method cannot be proven: it renders what the notes' formulas \
                       round to";
        return Err(Failure::usage(message).help("add `--method exact`"));
    }
    plan.camera.samples = args.samples.unwrap_or(plan.camera.samples);
    let end = time_limit::keep().map(|limit| Instant::now() + limit);
    let stops = || end.is_some_and(|end| Instant::now() >= end);
    Ok(Prover::new(&plan).picture(renderer, &|| progress.step(), &stops))
}

/// Reports the findings, and writes the image of them.
pub fn report(pixels: Proof, form: &Form, picture: Option<PictureFile>) -> Result<(), Failure> {
    let verdicts: Vec<_> = pixels.iter().map(|pixel| pixel.map(|pixel| pixel.verdict())).collect();
    let bytes = pixels.iter().flat_map(|pixel| match pixel {
        Some(pixel) => pixel.channels.map(Some),
        None => [None; 3],
    });
    let first = |verdict| form.first(&verdicts, &Some(verdict));
    let numbers = Numbers {
        pixels: Counts::of(verdicts.iter().copied()),
        bytes: Counts::of(bytes),
        first: FirstPixels {
            rounded: first(Verdict::Rounded),
            open: first(Verdict::Open),
            not_certified: first(Verdict::Uncertified),
            contradicted: first(Verdict::Contradicted),
        },
        premises: &form.premises,
    };
    print(&if form.is_json { text::json_in_lines(&numbers) } else { numbers.message() })?;
    if let Some(picture) = picture {
        let colour = |verdict: &Option<Verdict>| match verdict {
            Some(Verdict::Proven) => [0; 3],
            Some(Verdict::Rounded) => [128; 3],
            Some(Verdict::Open) | None => [255; 3],
            Some(Verdict::Uncertified) => [0, 0, 255],
            Some(Verdict::Contradicted) => [255, 0, 0],
        };
        picture.write(form.size, verdicts.iter().flat_map(colour).collect())?;
    }
    let contradicted = numbers.pixels.contradicted;
    if contradicted > 0 {
        let pixels = text::count(contradicted, "pixel");
        return Err(Failure::Failed(format!("the image contradicts the true colours at {pixels}")));
    }
    if let (Some(limit), 1..) = (time_limit::keep(), numbers.pixels.not_reached) {
        messages::note(&format!("the time limit of {} has been reached", humantime::format_duration(limit)));
        return Err(Failure::Stopped);
    }
    Ok(())
}

impl Counts {
    fn of(verdicts: impl Iterator<Item = Option<Verdict>> + Clone) -> Self {
        let count = |wanted| verdicts.clone().filter(|verdict| *verdict == wanted).count();
        Self {
            all: verdicts.clone().count(),
            proven: count(Some(Verdict::Proven)),
            rounded: count(Some(Verdict::Rounded)),
            open: count(Some(Verdict::Open)),
            not_certified: count(Some(Verdict::Uncertified)),
            contradicted: count(Some(Verdict::Contradicted)),
            not_reached: count(None),
        }
    }

    fn message(&self, what: &str, premises: &Premises) -> String {
        let Self { all, proven, rounded, open, not_certified, contradicted, not_reached } = self;
        let not_certified = premises.counted(*not_certified);
        let percent = 100.0 * *proven as f64 / *all as f64;
        let rest = if *not_reached > 0 { format!(", {not_reached} not reached") } else { String::new() };
        format!(
            "{proven} of {all} {what} proven ({percent:.4} %), {rounded} off by rounding, {open} open, {not_certified}{contradicted} contradicted{rest}\n"
        )
    }
}

impl Numbers<'_> {
    fn message(&self) -> String {
        let named = |kind: &str, pixels: &[[usize; 2]]| match pixels {
            [] => String::new(),
            _ => {
                let places: Vec<_> = pixels.iter().map(|[x, y]| format!("{x} {y}")).collect();
                format!("first {kind}: {}\n", places.join(", "))
            }
        };
        let FirstPixels { rounded, open, not_certified, contradicted } = &self.first;
        self.pixels.message("pixels", self.premises)
            + &self.bytes.message("bytes", self.premises)
            + &named("off by rounding", rounded)
            + &named("open", open)
            + &named("not certified", not_certified)
            + &named("contradicted", contradicted)
            + &self.premises.lines()
    }
}
