//! `bench --sampling`: the cost and the error of numbers of samples per pixel.

use crate::chart::{self, Chart, Family, Machine, Panel, Point, Subject, Times, WrongHits};
use crate::sampling::{self, LEVELS, Measured};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tabray_cli::files::output;
use tabray_cli::process::failure::{Failure, print};
use tabray_core::scene::model::Model;
use tabray_core::text::{self, short};
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::Adaptive;
use tabray_tools::sampling::Samples;
use tabray_tools::threads::renderer_with;

/// The number of samples per pixel of the images that count as true.
const TRUTH: u32 = 1024;
const TRUTH_OF_LIMITS: u32 = 4096;

/// The number of times that each choice is timed.
const ROUNDS: usize = 2;

/// The part of the pixels for which `--max-error` is meant to hold.
const PROMISED: f64 = 0.99;

/// The number of the levels that `--max-error` is asked for, the first ones of [`LEVELS`].
const ASKED: usize = 3;

/// A question that a comparison answers.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Question {
    /// Time against the RMS error of the image, against 1024 samples
    Rms,
    /// What --max-error promises, for 1, 2 and 4 levels, against 4096 samples
    Limits,
    /// What --max-error --certain proves, for 1, 2 and 4 levels, against 4096 samples
    Certain,
}

impl Question {
    /// Returns the head of the table.
    fn head(self) -> &'static str {
        match self {
            Self::Rms => {
                "| scene | samples | CPU seconds | rays per pixel | RMS error | worst pixel | fixed samples of that RMS | their time |\n\
                 |---|---|---:|---:|---:|---:|---:|---:|\n"
            }
            Self::Limits | Self::Certain => {
                "| scene | levels | CPU seconds | rays per pixel | pixels within | worst pixel | kept | fixed samples that keep it | their time |\n\
                 |---|---:|---:|---:|---:|---:|---|---:|---:|\n"
            }
        }
    }
}

/// Measures the scenes, prints a table in Markdown, and writes a chart, if a file is named for it.
pub fn run(
    question: Question,
    models: Vec<(String, Model)>,
    size: Option<[usize; 2]>,
    file: Option<&Path>,
    keep: Option<&Path>,
) -> Result<(), Failure> {
    let (threads, thread) = (renderer_with(0)?, renderer_with(1)?);
    let mut chart = Chart {
        scene: "samples per pixel".to_owned(),
        machine: Machine::here(),
        panels: Vec::new(),
        unchecked: Vec::new(),
        is_whole: true,
    };
    print(question.head())?;
    for (path, mut model) in models {
        let camera = &mut model.camera.value;
        camera.pixels = size.unwrap_or(camera.pixels);
        let pixels = camera.pixels[0] * camera.pixels[1];
        let stem = Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let all = choices(question);
        let truth = if question == Question::Rms { TRUTH } else { TRUTH_OF_LIMITS };
        let [width, height] = model.camera.value.pixels;
        let kept = keep.map(|folder| folder.join(format!("{stem}-{width}x{height}-{truth}.json")));
        let measured = match kept.as_deref().and_then(|path| read(path, all.len())) {
            Some(measured) => measured,
            None => {
                let right = sampling::truth(&threads, &model, truth);
                let rounds = if question == Question::Rms { ROUNDS } else { 1 };
                let measured = sampling::measure(&thread, &model, &all, &right, rounds);
                if let Some(path) = kept {
                    output::replace(&path, text::json_in_lines(&measured).as_bytes())?;
                }
                measured
            }
        };
        let all: Vec<_> = all.into_iter().zip(measured).collect();
        print(&match question {
            Question::Rms => errors(&stem, &all),
            Question::Limits | Question::Certain => limits(&stem, &all),
        })?;
        chart.panels.push(Panel {
            title: stem,
            note: format!("{pixels} pixels, against {truth} samples"),
            subject: Subject::Samples,
            points: all.iter().map(|one| point(one, pixels)).collect(),
        });
    }
    let Some(file) = file else { return Ok(()) };
    let is_png = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    output::replace(file, &if is_png { chart::png(&chart)? } else { chart::svg(&chart)?.into_bytes() })
}

/// Reads what an earlier run has measured of so many choices.
fn read(path: &Path, count: usize) -> Option<Vec<Measured>> {
    let measured: Vec<_> = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    (measured.len() == count).then_some(measured)
}

fn choices(question: Question) -> Vec<Samples> {
    let fixed = |sampler| move |samples| Samples { sampler, samples, adaptive: None };
    let adaptive = |samples, most, levels: Option<f64>| {
        let error = levels.map(|levels| levels / 255.0);
        Samples { sampler: Sampler::Sobol, samples, adaptive: Some(Adaptive { most, error }) }
    };
    let mut all: Vec<_> = match question {
        Question::Rms => [1, 2, 4, 8, 16, 32, 64, 128, 256].map(fixed(Sampler::Sobol)).into(),
        Question::Limits | Question::Certain => {
            [1, 4, 16, 32, 64, 128, 256, 512, 1024].map(fixed(Sampler::Sobol)).into()
        }
    };
    match question {
        Question::Rms => {
            all.extend([4, 16, 64].map(fixed(Sampler::Random)));
            all.extend(
                [(1, 16), (2, 16), (2, 64), (4, 16), (4, 64), (4, 256), (4, 1024)]
                    .map(|(least, most)| adaptive(least, most, None)),
            );
        }
        Question::Limits | Question::Certain => {
            all.extend(LEVELS[..ASKED].iter().map(|levels| adaptive(4, 4096, Some(*levels))))
        }
    }
    all
}

/// Returns the rows of a scene: each choice, and which fixed number of samples has the same error.
fn errors(scene: &str, all: &[(Samples, Measured)]) -> String {
    let fixed: Vec<_> = all
        .iter()
        .filter(|(choice, _)| choice.adaptive.is_none() && choice.sampler == Sampler::Sobol)
        .collect();
    let mut text = String::new();
    for (choice, measured) in all {
        let Measured { seconds, rays, rms, .. } = measured;
        let name = match (choice.adaptive, choice.sampler) {
            (Some(Adaptive { most, .. }), _) => format!("{}..{most}", choice.samples),
            (None, Sampler::Sobol) => choice.samples.to_string(),
            (None, Sampler::Random) => format!("{} random", choice.samples),
        };
        let equal = if choice.adaptive.is_none() { None } else { equal(&fixed, *rms) };
        let (samples, time) = equal.map_or(("-".to_owned(), "-".to_owned()), |(samples, time)| {
            (format!("{samples:.0}"), format!("{:.1} x", time / seconds))
        });
        let _ = writeln!(
            text,
            "| {scene} | {name} | {seconds:.3} | {rays:.2} | {rms:.3} | {:.1} | {samples} | {time} |",
            measured.worst
        );
    }
    text
}

/// Returns the fixed number of samples that has this RMS error, and its time, between those that were measured.
fn equal(fixed: &[&(Samples, Measured)], rms: f64) -> Option<(f64, f64)> {
    fixed.windows(2).find_map(|pair| {
        let [(less, coarse), (more, fine)] = pair else { return None };
        let part = libm::log(coarse.rms / rms) / libm::log(coarse.rms / fine.rms);
        let between = |from: f64, to: f64| from * libm::pow(to / from, part);
        (0.0..=1.0).contains(&part).then(|| {
            (between(less.samples.into(), more.samples.into()), between(coarse.seconds, fine.seconds))
        })
    })
}

/// Returns the rows of a scene: each limit, whether it was kept, and the least fixed number of samples that keeps it.
fn limits(scene: &str, all: &[(Samples, Measured)]) -> String {
    let mut text = String::new();
    let limited = all.iter().filter(|(choice, _)| choice.adaptive.is_some());
    for ((index, levels), (_, measured)) in LEVELS.iter().enumerate().zip(limited) {
        let Measured { seconds, rays, worst, .. } = measured;
        let within = measured.within[index];
        let kept = if within >= PROMISED { "yes" } else { "no" };
        let fixed = all
            .iter()
            .find(|(choice, fixed)| choice.adaptive.is_none() && fixed.within[index] >= within.max(PROMISED));
        let (samples, time) = fixed.map_or(("more".to_owned(), "-".to_owned()), |(choice, fixed)| {
            (choice.samples.to_string(), format!("{:.1} x", fixed.seconds / seconds))
        });
        let _ = writeln!(
            text,
            "| {scene} | {} | {seconds:.3} | {rays:.1} | {:.2} % | {worst:.1} | {kept} | {samples} | {time} |",
            short(*levels),
            (1e4 * within).floor() / 100.0,
        );
    }
    text
}

fn point((choice, measured): &(Samples, Measured), pixels: usize) -> Point {
    let seconds = measured.seconds / pixels as f64;
    Point {
        name: String::new(),
        family: match (choice.adaptive, choice.sampler) {
            (Some(_), _) => Family::Adaptive,
            (None, Sampler::Sobol) => Family::Sobol,
            (None, Sampler::Random) => Family::Random,
        },
        is_default: false,
        times: Times { least: seconds, median: seconds, rounds: ROUNDS, waited: 0.0 },
        error: measured.rms / 255.0,
        worst: measured.worst / 255.0,
        wrong: WrongHits::default(),
        visible: None,
        changed: None,
        samples: choice.adaptive.map_or(choice.samples, |adaptive| adaptive.most),
    }
}
