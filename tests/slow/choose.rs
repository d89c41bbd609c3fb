//! What `choose --max-error` promises, measured on scenes made at random.
//!
//! `TABRAY_SCENES=200 cargo test --release --test slow choose -- --nocapture` measures 200 scenes in place of 15, and
//! prints a table; `TABRAY` names a program other than the one that is built.

mod made;

use crate::common::model_in;
use made::{Made, made};
use rayon::prelude::*;
use std::env;
use std::fs;
use std::process::Command;
use tabray::render::trace::{Scratch, Tracer};
use tabray::render::{Flaws, Plan, Renderer};
use tabray::scene::Model;
use tabray::simd::cpu::Cpu;
use tabray::tools::threads::renderer_with;
use tabray::world::Rgb;
use tabray::world::sample::{SCRAMBLE, Sampler};
use tabray::world::sensor::Adaptive;
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

/// Runs `choose` for an error; returns what it says where it promises nothing.
fn choose(folder: &TempDir, error: &str) -> Result<Promise, String> {
    let program = env::var_os("TABRAY").unwrap_or_else(|| env!("CARGO_BIN_EXE_tabray").into());
    let output = Command::new(program)
        .current_dir(folder.path())
        // A busy machine measures the same, but takes longer.
        .args(["choose", "made.ray", "--max-error", error, "--time-limit", "1h"])
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
    let pixels: Vec<_> = (0..SIZE[0] * SIZE[1]).map(|index| [index % SIZE[0], index / SIZE[0]]).collect();
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
        match choose(&folder, asked) {
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
