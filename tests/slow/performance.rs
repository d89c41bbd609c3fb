//! Measurements that take minutes: tables of `docs/performance.md`, printed in Markdown.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture NAME`, where NAME is a function of this file
#![cfg(target_os = "linux")]

use crate::common;
use nix::sys::resource::{UsageWho, getrusage};
use std::env;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tabray::render::Plan;
use tabray::scene::{self, Parsed, Syntax, dump};
use tabray::simd::Cpu;
use tabray::tools::bench::{Speed, scenes};
use tabray::tools::threads::renderer_with;

/// The number of times that each of two compared commands is run. The commands alternate.
const ROUNDS: usize = 15;

/// Returns the CPU time of this thread, or of all child processes that have ended, and the largest amount of memory that
/// any of them had, in KiB.
fn of(who: UsageWho) -> (Duration, i64) {
    let usage = getrusage(who).expect("the system keeps accounts");
    let [user, system] = [usage.user_time(), usage.system_time()]
        .map(|time| Duration::new(time.tv_sec() as u64, 1000 * time.tv_usec() as u32));
    (user + system, usage.max_rss())
}

/// Returns the same of all child processes that have ended.
pub fn of_children() -> (Duration, i64) {
    of(UsageWho::RUSAGE_CHILDREN)
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

/// Returns the milliseconds that Embree takes for a frame of a scene of many objects, for building its hierarchy on one
/// thread and for building it on all, if the variable `EMBREE` names the compiled `docs/embree.cpp`.
fn embree(name: &str, exponent: u32) -> Option<[f64; 3]> {
    let program = std::env::var_os("EMBREE")?;
    let output =
        Command::new(program).args([name, &exponent.to_string()]).output().expect("the program runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let told = String::from_utf8(output.stdout).expect("numbers");
    let mut numbers = told.split_whitespace().map(|number| number.parse().expect("a number"));
    Some([(); 3].map(|()| numbers.next().expect("three numbers")))
}

/// Prints the cost of scenes with many objects, beside Embree.
#[test]
#[ignore = "it measures"]
fn many_objects() {
    type Scene = fn(usize) -> Vec<Parsed<'static>>;
    println!(
        "\n| objects | frame, ms | Embree, ms | ratio | tests per ray | plan on one thread, ms | Embree builds, ms | plan on all, ms | Embree builds, ms |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (name, scene) in [("spheres", scenes::spheres as Scene), ("triangles", scenes::triangles)] {
        for exponent in 3..=6 {
            let built = scene::build(common::registry(), scene(10_usize.pow(exponent)));
            let model = built.map(|built| built.model).unwrap_or_else(|report| panic!("{report}"));
            let planned = [1, 0].map(|threads| {
                // The CPU time of one thread, and what all take on the wall.
                let begin = Instant::now();
                let now = || match threads {
                    1 => of(UsageWho::RUSAGE_THREAD).0.as_secs_f64(),
                    _ => begin.elapsed().as_secs_f64(),
                };
                let plan = || {
                    let start = now();
                    drop(Plan::new(&model));
                    1e3 * (now() - start)
                };
                let renderer = renderer_with(threads).expect("threads");
                (0..5).map(|_| renderer.run(plan)).fold(f64::INFINITY, f64::min)
            });
            let rival = embree(name, exponent);
            let speed = Speed::measure(model, Cpu::best(), Duration::from_millis(200)).expect("a thread");
            let milliseconds = 1e3 * speed.frame.seconds;
            let tests: u64 = speed.tests.iter().map(|tests| tests.number).sum();
            let tests = tests as f64 / speed.frame.rays as f64;
            let [frame, one, all] = match rival {
                Some(rival) => rival.map(|number| format!("{number:.1}")),
                None => [(); 3].map(|()| String::new()),
            };
            let ratio = rival.map_or_else(String::new, |rival| format!("{:.2}", rival[0] / milliseconds));
            let [plan, plan_on_all] = planned;
            println!(
                "| 10^{exponent} {name} | {milliseconds:.1} | {frame} | {ratio} | {tests:.1} | {plan:.1} | {one} | {plan_on_all:.1} | {all} |"
            );
        }
    }
}

/// Prints the cost of reading many objects, for `check` of scenes that are written first. `TABRAY` may name another
/// program to measure.
#[test]
#[ignore = "it measures"]
fn reading() {
    let program = env::var_os("TABRAY").unwrap_or_else(|| env!("CARGO_BIN_EXE_tabray").into());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("many.ray");
    // The time in seconds, and the most memory in KiB. The system's own account of the latter would include this program.
    let check = || {
        let before = of_children().0;
        let mut child = Command::new(&program).arg("check").arg(&path).stderr(Stdio::null()).spawn();
        let child = child.as_mut().expect("the program runs");
        let (status, mut peak) = (format!("/proc/{}/status", child.id()), 0);
        while child.try_wait().expect("its status").is_none() {
            let status = fs::read_to_string(&status).unwrap_or_default();
            let most =
                status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
            peak = peak.max(most.and_then(|most| most.parse().ok()).unwrap_or(0));
            thread::sleep(Duration::from_millis(1));
        }
        assert!(child.wait().expect("its status").success());
        ((of_children().0 - before).as_secs_f64(), peak)
    };
    let write = |scene| {
        let built = scene::build(common::registry(), scene);
        let model = built.map(|built| built.model).unwrap_or_else(|report| panic!("{report}"));
        let text = dump::scene(&model, Syntax::Notes);
        fs::write(&path, &text).expect("a file");
        (text.len(), model.objects.len())
    };
    write(scenes::spheres(1000));
    let empty: u64 = check().1;
    println!("\n| objects | text, MB | CPU, s | MB/s | most memory, MiB | bytes per object | of them text |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for (name, scene) in [
        ("10^5 spheres", scenes::spheres(100_000)),
        ("10^5 triangles", scenes::triangles(100_000)),
        ("10^6 spheres", scenes::spheres(1_000_000)),
        ("10^6 triangles", scenes::triangles(1_000_000)),
    ] {
        let (bytes, count) = write(scene);
        let runs: Vec<_> = (0..3).map(|_| check()).collect();
        let seconds = runs.iter().fold(f64::INFINITY, |least, run| least.min(run.0));
        let (megabytes, memory) = (1e-6 * bytes as f64, runs.iter().fold(0, |most, run| most.max(run.1)));
        let [each, text] = [1024.0 * (memory - empty) as f64, bytes as f64].map(|all| all / count as f64);
        println!(
            "| {name} | {megabytes:.1} | {seconds:.2} | {:.0} | {:.0} | {each:.0} | {text:.0} |",
            megabytes / seconds,
            memory as f64 / 1024.0
        );
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
