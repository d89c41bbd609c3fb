//! Full disks, places that cannot be written to, and programs that are killed: no image is ever lost or damaged.

use crate::common::program::names_in;
use crate::stop::{Running, bytes, is_checkpoint, render, rgba, tabray_path, workplace};
use nix::sys::signal::Signal;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fs;
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Stops a render that may write no file of more than `blocks` blocks of 512 bytes. Returns its exit status and its
/// standard error.
fn with_little_room(folder: &TempDir, blocks: usize, picture: &str) -> (i32, String) {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let output = Command::new("sh")
        .args(["-c", &script])
        .arg(tabray_path())
        .args(["render", "hall.ray", "--samples", "16", "--time-limit", "400ms", "-o", picture])
        .current_dir(folder.path())
        .output()
        .expect("sh runs");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_disk_that_is_full_when_it_stops_leaves_what_was_there() {
    for (name, blocks, cannot) in [("a.ppm", 100, "a.ppm"), ("a.png", 1, "a.png")] {
        let folder = workplace();
        fs::write(folder.path().join(name), "precious").expect("a file");
        let (status, err) = with_little_room(&folder, blocks, name);
        let said = format!(
            "the time limit of 400ms has been reached\nerror: cannot write `{cannot}`: file too large\n"
        );
        assert_eq!((status, err), (1, said));
        assert_eq!(bytes(&folder, name), b"precious");
        assert_eq!(names_in(folder.path()), [name, "hall.ray"]);
    }
}

#[test]
fn a_checkpoint_that_cannot_be_written_leaves_what_was_there() {
    let folder = workplace();
    fs::create_dir(folder.path().join("a.png.checkpoint")).expect("a folder");
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let (status, err) = with_little_room(&folder, 100_000, "a.png");
    let last = err.lines().last().expect("a line");
    assert_eq!((status, last), (1, "error: cannot write `a.png.checkpoint`: is a directory"));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray"]);
}

/// Kills a render `times` times at random moments, and checks the folder each time.
fn killed(times: usize, args: &[&str], sound: impl Fn(&TempDir)) {
    let mut random = Pcg32::new(9, 0);
    let folder = workplace();
    let start = Instant::now();
    render(&folder, args);
    let mut longest = 5 * start.elapsed().as_micros() as u32 / 4;
    let mut ended = 0;
    for _ in 0..times {
        for name in names_in(folder.path()).iter().filter(|name| *name != "hall.ray") {
            fs::remove_file(folder.path().join(name)).expect("a file");
        }
        fs::write(folder.path().join("a.png"), "precious").expect("a file");
        let running = Running::render(&folder, args);
        thread::sleep(Duration::from_micros((random.next_u32() % longest).into()));
        running.send(Signal::SIGKILL);
        ended += usize::from(running.end().0 != -1);
        // The machine may have become slower.
        longest += if ended == 0 { longest / 16 } else { 0 };
        sound(&folder);
    }
    assert!(0 < ended && ended < times, "some ended before they were killed, and some did not: {ended}");
}

/// Returns the names in the folder other than those of the scene, the image and its checkpoint. A complete file has a
/// hidden name for a moment, which stays if the render is killed right then.
fn hidden(folder: &TempDir) -> Vec<String> {
    let mut names = names_in(folder.path());
    names.retain(|name| !["hall.ray", "a.png", "a.png.checkpoint"].contains(&name.as_str()));
    names
}

#[test]
fn a_render_killed_at_any_moment_leaves_the_old_picture_or_the_new_one() {
    let args = ["hall.ray", "--size", "40", "-o", "a.png"];
    let folder = workplace();
    render(&folder, &args);
    let whole = bytes(&folder, "a.png");
    killed(100, &args, |folder| {
        let picture = bytes(folder, "a.png");
        assert!(picture == b"precious" || picture == whole);
        for name in hidden(folder) {
            assert!(bytes(folder, &name) == whole, "{name}");
            fs::remove_file(folder.path().join(name)).expect("a file");
        }
        assert!(names_in(folder.path()).len() == 2);
    });
}

#[test]
fn a_render_killed_while_it_stops_leaves_nothing_by_halves() {
    let args = ["hall.ray", "--size", "640", "--samples", "16", "-o", "a.png", "--time-limit", "30ms"];
    killed(40, &args, |folder| {
        let checkpoint = names_in(folder.path()).contains(&"a.png.checkpoint".to_owned());
        if bytes(folder, "a.png") != b"precious" {
            assert!(checkpoint && rgba(folder, "a.png").pixels().any(|pixel| pixel.0[3] == 255));
        }
        if checkpoint {
            is_checkpoint(folder, "a.png.checkpoint");
        }
        for name in hidden(folder) {
            match bytes(folder, &name).starts_with(b"\x89PNG") {
                true => drop(rgba(folder, &name)),
                false => is_checkpoint(folder, &name),
            }
        }
    });
}
