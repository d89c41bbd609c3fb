//! Tries to prove the program wrong: random scenes of several classes, rays aimed where the arithmetic is hard, and an
//! oracle that starts from the scenes' text and shares no code with the program. See CONTRIBUTING.md.
//!
//! `cargo test --release --test slow -- --ignored --nocapture many_scenes`

mod classes;
mod looks;
mod program;
pub mod random;
pub mod scenes;
mod tally;

use crate::oracle::text::Scene;
use classes::{CLASSES, Class};
use random::Random;
use std::env;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;
use tabray::tools::threads::renderer_with;
use tally::Tally;

/// Returns the number that an environment variable is set to, or the default if it is not set.
pub fn setting(name: &str, default: f64) -> f64 {
    env::var(name).map_or(default, |value| value.parse().unwrap_or_else(|_| panic!("{name} is a number")))
}

/// Judges random scenes of a class, on all cores, until at least `rays` rays have been asked for. One ray in `proofs`
/// is also asked for its proof.
fn run(class: &Class, rays: usize, seed: u64, proofs: u64) -> Tally {
    let (next, asked, total) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(Tally::default()));
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let renderer = renderer_with(1).expect("a thread");
                let mut tally = Tally::default();
                while asked.load(Ordering::Relaxed) < rays {
                    let number = next.fetch_add(1, Ordering::Relaxed) as u64;
                    let question = (class.ask)(&mut Random::new(class.name, seed << 40 | number));
                    asked.fetch_add(question.pixels.len(), Ordering::Relaxed);
                    tally.judge(class, &question, number, &renderer, proofs);
                }
                total.lock().expect("no panic").merge(tally);
            });
        }
    });
    total.into_inner().expect("no panic")
}

/// Runs every class that FALSIFY_CLASS selects, in its long run if `size` is 0 and in its short run if `size` is 1.
/// Returns a message for each class in which something is wrong.
fn all(size: usize) -> Vec<String> {
    let (times, seed) = (setting("FALSIFY_RAYS", 1.0), setting("FALSIFY_SEED", 0.0) as u64);
    let only = env::var("FALSIFY_CLASS").unwrap_or_default();
    // One ray in this many is also asked for its proof. Proofs take most of the time.
    let proofs = setting("FALSIFY_PROOFS", [4.0, 1.0][size]) as u64;
    println!("{}", tally::HEADING);
    let mut wrong = Vec::new();
    for class in CLASSES.iter().filter(|class| class.name.starts_with(&only)) {
        let start = Instant::now();
        let rays = (class.rays[size] as f64 * times).ceil() as usize;
        let tally = run(class, rays, seed, proofs);
        println!("{}", tally.row(class.name, start.elapsed()));
        if !tally.is_sound() {
            wrong.push(format!("{}: {}", class.name, tally.worst()));
        }
    }
    wrong
}

#[test]
fn hits_and_proofs_of_a_few_scenes_of_each_class_are_right() {
    let wrong = all(1);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn surfaces_meet_their_own_rays_as_they_should() {
    let wrong = looks::all(6);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "takes minutes"]
fn hits_and_proofs_of_many_scenes_of_each_class_are_right() {
    let wrong = all(0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "takes minutes"]
fn surfaces_meet_their_own_rays_in_many_scenes() {
    let wrong = looks::all((500.0 * setting("FALSIFY_RAYS", 1.0)).ceil() as u64);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Judges every pixel of the scenes whose paths FALSIFY_SCENES lists, separated by white space.
#[test]
#[ignore = "takes scenes from the environment"]
fn hits_and_proofs_of_given_scenes_are_right() {
    let Ok(scenes) = env::var("FALSIFY_SCENES") else { return };
    println!("{}", tally::HEADING);
    let renderer = renderer_with(0).expect("threads");
    let mut wrong = Vec::new();
    for path in scenes.split_whitespace() {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mesh = Path::new(path).with_file_name("mesh.obj");
        let mesh = fs::read_to_string(mesh).unwrap_or_default();
        let [width, height] = Scene::read(&text, &mesh).pixels.map(|side| side as usize);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
        let question = scenes::Question { text, mesh, pixels, is_picture: true };
        let (start, mut tally) = (Instant::now(), Tally::default());
        tally.judge(&CLASSES[0], &question, 0, &renderer, 1);
        println!("{}", tally.row(path, start.elapsed()));
        if !tally.is_sound() {
            wrong.push(format!("{path}: {}", tally.worst()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
