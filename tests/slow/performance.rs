//! Measurements that take minutes: tables of `docs/performance.md`, printed in Markdown.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture NAME`, where NAME is a function of this file
#![cfg(target_os = "linux")]

use crate::common;
use nix::sys::resource::{UsageWho, getrusage};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tabray::render::Plan;
use tabray::scene::{self, Parsed};
use tabray::simd::Cpu;
use tabray::tools::bench::{Speed, scenes};

/// The number of times that each of two compared commands is run. The commands alternate.
const ROUNDS: usize = 15;

/// Returns the CPU time of all child processes that have ended, and the largest amount of memory that any of them had,
/// in KiB.
fn of_children() -> (Duration, i64) {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).expect("the system keeps accounts");
    let [user, system] = [usage.user_time(), usage.system_time()]
        .map(|time| Duration::new(time.tv_sec() as u64, 1000 * time.tv_usec() as u32));
    (user + system, usage.max_rss())
}

/// Renders a scene and discards the image. Returns the wall-clock time and the CPU time.
fn render(scene: &Path, args: &[&str]) -> [Duration; 2] {
    let (start, before) = (Instant::now(), of_children().0);
    let status = Command::new(env!("CARGO_BIN_EXE_tabray"))
        .arg("render")
        .arg(scene)
        .args(["-o", "-"])
        .args(args)
        .stdout(Stdio::null())
        .status()
        .expect("the program runs");
    assert!(status.success(), "{}", scene.display());
    [start.elapsed(), of_children().0 - before]
}

/// Prints the cost of scenes with many objects.
#[test]
#[ignore = "it measures"]
fn many_objects() {
    type Scene = fn(usize) -> Vec<Parsed<'static>>;
    println!("\n| objects | frame, ms | times the row above | tests per ray | to build, s |");
    println!("|---|---:|---:|---:|---:|");
    for (name, scene) in [("spheres", scenes::spheres as Scene), ("triangles", scenes::triangles)] {
        let mut above = None;
        for exponent in 1..=6 {
            let start = Instant::now();
            let built = scene::build(common::registry(), scene(10_usize.pow(exponent)));
            let model = built.map(|built| built.model).unwrap_or_else(|report| panic!("{report}"));
            drop(Plan::new(&model));
            let building = start.elapsed().as_secs_f64();
            let speed = Speed::measure(model, Cpu::best(), Duration::from_millis(200)).expect("a thread");
            let milliseconds = 1e3 * speed.frame.seconds;
            let times = above.map_or_else(String::new, |above: f64| format!("{:.2}", milliseconds / above));
            let tests: u64 = speed.tests.iter().map(|tests| tests.number).sum();
            let tests = tests as f64 / speed.frame.rays as f64;
            println!("| 10^{exponent} {name} | {milliseconds:.1} | {times} | {tests:.1} | {building:.2} |");
            above = Some(milliseconds);
        }
    }
}

/// Prints the cost of an image far larger than memory.
#[test]
#[ignore = "it measures"]
fn large_pictures() {
    let scene = common::root().join("scenes/sphere/in-front.ray");
    println!("\n| 40000 x 30000 | CPU, s | most memory so far, MiB |");
    println!("|---|---:|---:|");
    for format in ["ppm", "png"] {
        let [_, cpu] = render(&scene, &["--size", "40000x30000", "--format", format]);
        println!("| {format} | {:.1} | {:.0} |", cpu.as_secs_f64(), of_children().1 as f64 / 1024.0);
    }
}

/// Prints the gain from a second thread.
#[test]
#[ignore = "it measures"]
fn two_threads() {
    println!(
        "\n| 1920 x 1440, the whole program | one thread, s | two, s | gain | CPU, s | CPU with two, s | more |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let scene = common::root().join("../shared/conformance/spec/spec8.txt");
    if !scene.exists() {
        println!("SKIPPED: ../shared/conformance is not here");
        return;
    }
    for format in ["ppm", "png"] {
        let mut least = [[Duration::MAX; 2]; 2];
        for _ in 0..ROUNDS {
            for (threads, least) in ["1", "2"].into_iter().zip(&mut least) {
                let times =
                    render(&scene, &["--size", "1920x1440", "--format", format, "--threads", threads]);
                *least = [times[0].min(least[0]), times[1].min(least[1])];
            }
        }
        let [[one, one_cpu], [two, two_cpu]] = least.map(|times| times.map(|time| time.as_secs_f64()));
        println!(
            "| spec8, {format} | {one:.3} | {two:.3} | {:.2} | {one_cpu:.3} | {two_cpu:.3} | {:.1} % |",
            one / two,
            100.0 * (two_cpu / one_cpu - 1.0)
        );
    }
}
