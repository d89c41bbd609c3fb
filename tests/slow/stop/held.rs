//! Limits and interruptions at any moment: while a scene is read, within a tile, within the proof of a pixel.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use crate::stop::{Running, bytes, render, rgba, tabray_path, workplace};
use nix::sys::signal::Signal;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The time within which a command must end that is told to end at once, on a machine that is busy with other tests.
/// Commands that are not told to end take minutes here, or never end.
const SOON: Duration = Duration::from_secs(8);

/// A scene between mirrors, where one packet of rays takes long, and a tile with all its samples takes hours.
pub const MIRRORS: &str =
    "camera eye { pixeldim 64 48 samples 65536 worlddim 8e-9 6e-9 viewpoint 4e-9 3e-9 6e-9 }
    material m { ambient 1 1 1 specular 1 1 1 transparency 0.9 diffuse 1 1 1 }
    plane a { material m normal 0 0 1 point 0 0 -1e-9 }
    plane b { material m normal 0 0 -1 point 0 0 7e-9 }
    plane c { material m normal 0 1 0 point 0 -1e-9 0 }
    plane d { material m normal 0 -1 0 point 0 9e-9 0 }
    light l { location 4e-9 4e-9 2e-9 emissivity 20 20 20 }";

fn between_mirrors() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("mirrors.ray"), MIRRORS).expect("a file");
    fs::write(folder.path().join("large.ray"), MIRRORS.replace("64 48", "6400 4800")).expect("a file");
    folder
}

#[test]
fn a_time_limit_holds_within_a_tile() {
    let folder = between_mirrors();
    // Of the second one, a PNG has two pieces, which are compressed on several threads.
    fs::write(folder.path().join("medium.ray"), MIRRORS.replace("64 48", "800 600")).expect("a file");
    for name in ["mirrors.ray", "medium.ray"] {
        let start = Instant::now();
        let (status, _, err) = render(&folder, &[name, "--time-limit", "300ms"]);
        assert!(start.elapsed() < SOON, "{:?}", start.elapsed());
        let said = "the time limit of 300ms has been reached\nnothing has been rendered yet, and nothing is written\n";
        assert_eq!((status, err.as_str()), (130, said));
    }
    assert_eq!(names_in(folder.path()), ["large.ray", "medium.ray", "mirrors.ray"]);
}

#[test]
fn a_time_limit_holds_within_a_tile_of_an_image_that_is_written_whole() {
    let folder = between_mirrors();
    for name in ["a.exr", "a.pfm"] {
        let start = Instant::now();
        let (status, _, err) = render(&folder, &["mirrors.ray", "-o", name, "--time-limit", "300ms"]);
        assert!(start.elapsed() < SOON, "{:?}", start.elapsed());
        let said = "the time limit of 300ms has been reached\n\
            an EXR or a PFM is written only when it is complete: nothing is written\n";
        assert_eq!((status, err.as_str()), (130, said));
    }
    assert_eq!(names_in(folder.path()), ["large.ray", "mirrors.ray"]);
}

/// The tiles around a sphere are soon finished; those that show it, lit by many lights, take far longer.
#[test]
fn a_time_limit_within_a_tile_keeps_those_that_are_done() {
    let mut text = String::from(
        "camera eye { pixeldim 64 48 samples 65536 worlddim 8 6 viewpoint 4 3 6 }
        material m { ambient 1 1 1 diffuse 1 1 1 }
        sphere ball { material m center 4 3 0 radius 0.5 }\n",
    );
    for index in 0..200 {
        text += &format!("light l{index} {{ location {index} 4 9 emissivity 1 1 1 }}\n");
    }
    let folder = folder();
    fs::write(folder.path().join("a.ray"), text).expect("a file");
    let mut limit = Duration::from_millis(500);
    loop {
        let start = Instant::now();
        let limited = format!("{}ms", limit.as_millis());
        let (status, _, err) = render(&folder, &["a.ray", "-o", "a.png", "--time-limit", &limited]);
        assert!(start.elapsed() < limit + SOON, "{:?}", start.elapsed());
        assert_eq!(status, 130, "{err}");
        if err.contains(" from which `--resume` renders the rest") {
            break;
        }
        limit *= 2;
    }
    let left = rgba(&folder, "a.png");
    assert!(left.pixels().any(|pixel| pixel.0[3] == 255) && left.get_pixel(31, 24).0[3] == 0);
}

#[test]
fn a_time_limit_holds_while_a_scene_is_read() {
    let folder = folder();
    let mut command = Command::new(tabray_path());
    command.args(["render", "-", "-o", "a.png", "--time-limit", "100ms"]).current_dir(folder.path());
    // Standard input neither delivers anything nor ends.
    command.stdin(Stdio::piped()).stderr(Stdio::piped());
    let start = Instant::now();
    let mut child = command.spawn().expect("the program runs");
    let held = child.stdin.take();
    let ended = Running(child).end();
    drop(held);
    assert!(start.elapsed() < SOON, "{:?}", start.elapsed());
    let said =
        "the time limit of 100ms has been reached\nnothing has been rendered yet, and nothing is written\n";
    assert_eq!(ended, (130, said.to_owned()));
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn a_time_limit_holds_for_pictures_beside() {
    let folder = workplace();
    let mut limit = 200;
    // The image of errors takes far longer than the main image.
    let args = ["hall.ray", "-o", "a.png", "--aov", "error"];
    loop {
        let limited = format!("{limit}ms");
        let (status, _, err) = render(&folder, &[&args[..], &["--time-limit", &limited]].concat());
        assert_eq!(status, 130, "{err}");
        if err.contains("wrote a.png (") {
            assert!(err.ends_with(" has been reached\nthe image was not finished\n"), "{err}");
            return;
        }
        limit *= 2;
    }
}

/// Returns the signal of Ctrl-C. If a shell has started the tests in the background, so that programs ignore that
/// signal, returns the one that terminates them instead.
pub fn interruption() -> Signal {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).expect("a mask"));
    if ignored >> (Signal::SIGINT as i32 - 1) & 1 == 1 { Signal::SIGTERM } else { Signal::SIGINT }
}

#[test]
fn an_interruption_ends_every_command_soon() {
    for args in [
        &["render", "mirrors.ray"][..],
        &["render", "mirrors.ray", "-o", "-"],
        &["render", "mirrors.ray", "-o", "a.exr"],
        &["render", "mirrors.ray", "-o", "a.pfm"],
        &["render", "mirrors.ray", "--debug", "find", "--at", "3,3"],
        &["verify", "large.ray"],
        &["choose", "mirrors.ray", "--max-error", "1e-7%"],
        &["chart", "mirrors.ray"],
        &["bench", "mirrors.ray"],
        &["check", "-"],
        &["dump", "-"],
        &["plan", "-"],
        &["convert", "-", "a.toml"],
        &["probe", "-", "1", "1"],
    ] {
        let folder = between_mirrors();
        let mut command = Command::new(tabray_path());
        command.args(args).current_dir(folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program runs");
        let held = child.stdin.take();
        let running = Running(child);
        // Commands that read from a pipe use no CPU time to wait for.
        std::thread::sleep(Duration::from_millis(500));
        let start = Instant::now();
        running.send(interruption());
        let (status, err) = running.end();
        assert!(start.elapsed() < SOON, "{args:?}: {:?}", start.elapsed());
        // A program that the signal itself ends has no exit status of its own.
        assert!(matches!(status, 130 | -1), "{args:?}: {status} {err}");
        drop(held);
    }
}

#[test]
fn an_interruption_ends_a_program_whose_messages_nobody_reads() {
    let folder = between_mirrors();
    let mut command = Command::new(tabray_path());
    command.args(["render", "mirrors.ray", "--debug", "find"]).current_dir(folder.path());
    let mut child = command.stderr(Stdio::piped()).spawn().expect("the program runs");
    let unread = child.stderr.take();
    let mut running = Running(child);
    // Long enough to fill the pipe.
    std::thread::sleep(Duration::from_secs(1));
    let start = Instant::now();
    running.send(interruption());
    let status = loop {
        if let Some(status) = running.0.try_wait().expect("a program that runs") {
            break status;
        }
        assert!(start.elapsed() < SOON, "it has not ended");
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(status.code(), Some(130));
    drop(unread);
}

/// When little of a large image is finished, the rest is not written, but the finished part is kept.
#[test]
fn a_large_picture_ends_where_it_was_stopped_and_is_resumed() {
    let path = scene("sphere/in-front.ray");
    for (name, compression) in [("a.png", "fast"), ("a.png", "default"), ("a.ppm", "fast")] {
        let folder = folder();
        let path = path.to_str().expect("UTF-8");
        let args = [path, "--size", "6000x8000", "--compress", compression, "-o", name];
        let mut limit = 50;
        let err = loop {
            let limited = format!("{limit}ms");
            let (status, _, err) = render(&folder, &[&args[..], &["--time-limit", &limited]].concat());
            assert!(status == 130 && err.starts_with("the time limit of "), "{err}");
            if err.contains(" from which `--resume` renders the rest") {
                break err;
            }
            limit *= 2;
        };
        if name == "a.png" {
            let partial = rgba(&folder, name);
            let (width, height) = partial.dimensions();
            assert!(width == 6000 && height < 8000 && height.is_multiple_of(16), "{height} rows: {err}");
            assert!(partial.pixels().any(|pixel| pixel.0[3] == 255));
        } else {
            // The rest of the image is a hole in the file.
            assert_eq!(bytes(&folder, name).len(), "P6 6000 8000 255\n".len() + 3 * 6000 * 8000);
        }
        let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
        assert_eq!(status, 0, "{err}");
        let whole = format!("whole-{name}");
        assert_eq!(render(&folder, &[&args[..6], &[&whole]].concat()).0, 0);
        assert!(bytes(&folder, name) == bytes(&folder, &whole), "{name}");
    }
}

#[test]
fn many_objects_leave_a_checkpoint_and_are_converted_soon() {
    let folder = folder();
    let mut text = String::from(
        "camera c { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 samples 4096 }\nmaterial m { ambient 1 1 1 }\n",
    );
    for index in 0..20_000 {
        let [x, y] = [index % 200, index / 200].map(|place| f64::from(place) / 40.0);
        text += &format!("sphere s{index} {{ material m center {x} {y} -5 radius 0.02 }}\n");
    }
    fs::write(folder.path().join("many.ray"), text).expect("a file");
    let start = Instant::now();
    let (status, _, err) = outcome(tabray(&folder).args(["convert", "many.ray", "many.toml"]));
    assert_eq!(status, 0, "{err}");
    assert!(start.elapsed() < 6 * SOON, "{:?}", start.elapsed());
    let (status, _, err) = render(&folder, &["many.ray", "-o", "a.png", "--time-limit", "2s"]);
    assert_eq!(status, 130, "{err}");
    assert!(start.elapsed() < 12 * SOON, "{:?}", start.elapsed());
}
