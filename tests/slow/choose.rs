//! What `choose --max-error` promises, by bounds and by measurement, and the errors that it measures, on scenes made at
//! random.
//!
//! `TABRAY_SCENES=200 cargo test --release --test slow choose -- --nocapture` measures 200 scenes in place of few, and
//! prints tables; `TABRAY` names a program other than the one that is built.

pub mod free;
mod made;

use crate::common::{model_in, registry};
use made::{Made, made};
use rayon::prelude::*;
use std::env;
use std::fs;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use tabray::render::trace::{Scratch, Tracer};
use tabray::render::{Flaws, Plan, Renderer};
use tabray::scene::{self, Model};
use tabray::simd::cpu::Cpu;
use tabray::tools::chart::{self, Estimate, Goal, Progress};
use tabray::tools::threads::renderer_with;
use tabray::world::sample::{SCRAMBLE, Sampler};
use tabray::world::sensor::Adaptive;
use tabray::world::{Accuracy, Rgb};
use tempfile::TempDir;

const SIZE: [usize; 2] = [48, 36];

/// The errors that are asked for, in turn.
const ASKED: [&str; 3] = ["2", "1%", "1"];

/// The number of samples of the image that a choice is measured against.
const TRUE_SAMPLES: u32 = 4096;

/// A promise of `choose`.
struct Promise {
    /// The number of samples, and the greatest one where pixels take different ones.
    samples: u32,
    most: Option<u32>,
    words: String,
    /// The bound on the error, in levels.
    bound: f64,
}

/// Runs `choose` for an error, with options; returns what it says where it promises nothing.
fn choose(folder: &TempDir, error: &str, options: &[&str]) -> Result<Promise, String> {
    let program = env::var_os("TABRAY").unwrap_or_else(|| env!("CARGO_BIN_EXE_tabray").into());
    let output = Command::new(program)
        .current_dir(folder.path())
        // A busy machine measures the same, but takes longer.
        .args(["choose", "made.ray", "--max-error", error, "--time-limit", "1h"])
        .args(options)
        .output()
        .expect("it runs");
    let [said, failed] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
    if output.status.code() == Some(1) {
        let why = failed.lines().last().expect("a reason");
        return Err(why.trim_start_matches("error: ").to_owned());
    }
    assert!(output.status.success(), "{failed}");
    let marked = said.lines().find(|line| line.starts_with('>')).expect("a marked line");
    let cells: Vec<_> = marked.split_whitespace().collect();
    let words = cells[2].to_owned();
    let (samples, most) = match words.split_once("..") {
        Some((least, most)) => (least.parse().expect("a number"), Some(most.parse().expect("a number"))),
        None => (words.parse().expect("a number"), None),
    };
    Ok(Promise { samples, most, words, bound: cells[4].parse().expect("a bound") })
}

/// Computes the colours of pixels as they are shown.
fn colours(renderer: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> Vec<Rgb> {
    let part = |pixels: &[[usize; 2]]| {
        let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        let seen = tracer.pixels(pixels);
        (0..pixels.len()).map(|pixel| plan.camera.display().shown(seen.get(pixel))).collect::<Vec<_>>()
    };
    renderer.run(|| pixels.par_chunks(SIZE[0]).map(part).collect::<Vec<_>>()).concat()
}

/// Returns the root mean square error of a choice, in levels: against many samples, and against many more in the pixels
/// that by these would break the promise.
fn error(renderer: &Renderer, model: &Model, promise: &Promise) -> f64 {
    let [width, height] = model.camera.value.pixels;
    let pixels: Vec<_> = (0..width * height).map(|index| [index % width, index / width]).collect();
    let mut plan = Plan::new(model);
    (plan.camera.sampler, plan.camera.samples) = (Sampler::Sobol, promise.samples);
    plan.set_adaptive(promise.most.map(|most| Adaptive { most, error: None }));
    let chosen = colours(renderer, &plan, &pixels);
    plan.set_adaptive(None);
    // Samples that no choice takes.
    plan.camera.scramble = SCRAMBLE;
    plan.camera.samples = TRUE_SAMPLES;
    let mut right = colours(renderer, &plan, &pixels);
    let rms = |right: &[Rgb]| {
        let squares = chosen.iter().zip(right).map(|(one, right)| (*one - *right).length_squared() / 3.0);
        255.0 * (squares.sum::<f64>() / pixels.len() as f64).sqrt()
    };
    if rms(&right) > promise.bound {
        let is_off =
            |index: &usize| 255.0 * (chosen[*index] - right[*index]).abs().max_element() > promise.bound;
        let off: Vec<_> = (0..pixels.len()).filter(is_off).collect();
        plan.camera.samples = Sampler::MAX_SAMPLES;
        let again = colours(renderer, &plan, &off.iter().map(|index| pixels[*index]).collect::<Vec<_>>());
        off.iter().zip(again).for_each(|(index, colour)| right[*index] = colour);
    }
    rms(&right)
}

/// What was promised, and kept.
#[derive(Default)]
struct Tally {
    scenes: usize,
    promises: usize,
    kept: usize,
    /// The sum of the errors as parts of the bounds.
    part: f64,
}

#[test]
fn promises_are_kept_and_given() {
    let scenes = env::var("TABRAY_SCENES").map_or(15, |count| count.parse().expect("a number of scenes"));
    let renderer = renderer_with(0).expect("threads");
    let folder = TempDir::new().expect("a folder");
    let mut tallies = [Tally::default(), Tally::default()];
    println!("| scene | small things | asked | samples | promised | measured | kept |");
    println!("|---|---|---|---|---|---|---|");
    for seed in 0..scenes {
        let Made { text, mesh, small } = made(seed, SIZE);
        fs::write(folder.path().join("made.ray"), &text).expect("a file");
        fs::write(folder.path().join("ring.obj"), mesh).expect("a file");
        let model = model_in(folder.path(), &text);
        let asked = ASKED[seed as usize % ASKED.len()];
        let tally = &mut tallies[usize::from(!small.is_empty())];
        tally.scenes += 1;
        let things = small.join(", ");
        match choose(&folder, asked, &["--certain"]) {
            Ok(promise) => {
                let error = error(&renderer, &model, &promise);
                let is_kept = error <= promise.bound;
                tally.promises += 1;
                tally.kept += usize::from(is_kept);
                tally.part += error / promise.bound;
                let Promise { words, bound, .. } = &promise;
                let kept = if is_kept { "yes" } else { "no" };
                println!("| {seed} | {things} | {asked} | {words} | {bound} | {error:.3} | {kept} |");
                if !is_kept {
                    eprintln!("{text}");
                }
            }
            Err(why) => println!("| {seed} | {things} | {asked} | none: {why} | | | |"),
        }
    }
    let [plain, small] = &tallies;
    for (name, Tally { scenes, promises, kept, part }) in [("no", plain), ("some", small)] {
        let mean = part / (*promises).max(1) as f64;
        println!(
            "{scenes} scenes with {name} small things: {promises} promises, {kept} kept; mean error / bound {mean:.2}"
        );
    }
    let [promises, kept] =
        [|tally: &Tally| tally.promises, |tally: &Tally| tally.kept].map(|of| of(plain) + of(small));
    assert!(100 * (promises - kept) < promises, "{kept} of {promises} promises are kept");
    assert!(
        10 * plain.promises >= 9 * plain.scenes,
        "{} promises for {} scenes",
        plain.promises,
        plain.scenes
    );
    assert!(small.promises > 0, "a promise for a scene with small things");
}

/// The size of the images whose errors are measured: of each pixel, 4096 true samples are taken.
const SMALL: [usize; 2] = [32, 24];

/// Receives no progress.
struct Unlimited;

impl Progress for Unlimited {
    fn more(&mut self, _units: usize) {}

    fn done(&mut self, _units: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

#[test]
fn measured_errors_are_near_those_against_many_samples() {
    let scenes = env::var("TABRAY_SCENES").map_or(4, |count| count.parse().expect("a number of scenes"));
    let renderer = renderer_with(0).expect("threads");
    let (mut far, mut low, mut answers, mut kept) = (0, 0, 0_u64, 0);
    println!(
        "| scene | samples | measured | at most | against {TRUE_SAMPLES} | ratio | answer | its error | kept |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for seed in 0..scenes {
        let text = free::free(seed, SMALL);
        let model = model_in(Path::new(""), &text);
        let load = |accuracy: Option<Accuracy>| -> io::Result<Model> {
            let loaded = scene::read(registry(), "scene", Path::new(""), text.as_bytes(), accuracy);
            Ok(loaded.map_err(|report| io::Error::other(report.to_string()))?.model)
        };
        let measured = |goal: Goal| {
            let estimates = chart::estimates(&load, (goal, false), 0.0, &mut Unlimited).expect("estimates");
            estimates.all.into_iter().filter(move |one| one.accuracy == estimates.own)
        };
        let error = |one: &Estimate| {
            let Estimate { samples, most, bound, .. } = *one;
            error(&renderer, &model, &Promise { samples, most, words: one.numbers(), bound: 255.0 * bound })
        };
        let choice = ["4", "16", "64", "4..64"][seed as usize % 4];
        let one = measured(Goal::None).find(|one| one.numbers() == choice).expect("the choice");
        let [mean, most] = [one.error, one.bound].map(|error| 255.0 * error);
        let right = error(&one);
        far += u64::from(mean > 1.5 * right || right > 1.5 * mean);
        low += usize::from(right > 2.0 * mean);
        let asked = [2.0, 2.55, 1.0][seed as usize % 3];
        let answer = measured(Goal::Error { most: asked / 255.0, worst: false })
            .filter(|one| 255.0 * one.bound <= asked)
            .min_by(|one, other| one.rays.total_cmp(&other.rays));
        let told = answer.map_or_else(String::new, |answer| {
            let error = error(&answer);
            answers += 1;
            kept += u64::from(error <= asked);
            format!("{} | {error:.3} | {}", answer.numbers(), if error <= asked { "yes" } else { "no" })
        });
        println!("| {seed} | {choice} | {mean:.3} | {most:.3} | {right:.3} | {:.2} | {told} |", mean / right);
    }
    println!(
        "{scenes} scenes: {far} off by more than 1.5 times, {low} below half; {answers} answers, {kept} kept"
    );
    assert!(20 * far <= scenes.max(20), "{far} of {scenes} measured errors are off by more than 1.5 times");
    assert_eq!(low, 0, "measured errors below half");
    assert!(10 * answers >= 9 * scenes, "{answers} answers for {scenes} scenes");
    assert!(20 * (answers - kept) <= answers.max(20), "{kept} of {answers} answers are kept");
}
