//! Renders that stop before the image is finished: what they leave behind, how they are resumed, and that no file is
//! ever damaged.
#![cfg(target_os = "linux")]

mod damage;
mod faults;
mod held;
mod interrupted;
mod limits;
mod others;
mod refused;
mod resumed;
mod tables;

use crate::common::program::{folder, outcome, scene, tabray};
use image::{RgbImage, RgbaImage};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// A scene whose image takes some seconds.
const SLOW: &str = "gallery/hall-of-mirrors.ray";

/// A running program.
struct Running(Child);

impl Running {
    fn start(program: &Path, folder: &TempDir, args: &[&str]) -> Self {
        let mut command = Command::new(program);
        command.args(args).current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(command.spawn().expect("the program runs"))
    }

    /// Starts `tabray render` with these arguments.
    fn render(folder: &TempDir, args: &[&str]) -> Self {
        Self::start(&tabray_path(), folder, &[&["render"], args].concat())
    }

    /// Waits until the program catches interruptions, or has ended.
    fn until_it_catches(&mut self) {
        let status = format!("/proc/{}/status", self.0.id());
        while self.0.try_wait().expect("its status").is_none() {
            let status = fs::read_to_string(&status).unwrap_or_default();
            let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
            if caught >> (Signal::SIGINT as u64 - 1) & 1 == 1 {
                return;
            }
            thread::yield_now();
        }
    }

    /// Waits until the program has used 200 ms of CPU time: it has begun a tile by then, or has finished one.
    fn until_it_renders(&mut self) {
        self.until_it_has_computed(Duration::from_millis(200));
    }

    /// Waits until the program has used this much CPU time, or has ended.
    fn until_it_has_computed(&mut self, time: Duration) {
        let stat = format!("/proc/{}/stat", self.0.id());
        // After the name, which is in parentheses, the twelfth field is the user CPU time in hundredths of a second.
        let ticks = || {
            let stat = fs::read_to_string(&stat).ok()?;
            stat.rsplit_once(") ")?.1.split(' ').nth(11)?.parse::<u32>().ok()
        };
        while self.0.try_wait().expect("its status").is_none()
            && u128::from(ticks().unwrap_or(u32::MAX)) < time.as_millis() / 10
        {
            thread::sleep(Duration::from_millis(1));
        }
    }

    fn send(&self, signal: Signal) {
        kill(Pid::from_raw(self.0.id() as i32), signal).expect("it is not waited for yet");
    }

    /// Waits for the program to end. Returns its exit status, -1 if a signal ended it, and its standard error.
    fn end(self) -> (i32, String) {
        let output = self.0.wait_with_output().expect("it ends");
        (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

fn tabray_path() -> PathBuf {
    assert_cmd::cargo::cargo_bin!("tabray").to_owned()
}

/// Makes a working directory with a slow scene, `hall.ray`.
fn workplace() -> TempDir {
    let folder = folder();
    fs::copy(scene(SLOW), folder.path().join("hall.ray")).expect("a copy");
    folder
}

fn render(folder: &TempDir, args: &[&str]) -> (i32, Vec<u8>, String) {
    outcome(tabray(folder).arg("render").args(args))
}

/// Renders with a time limit within which part of the image is finished, but not all of it. Returns standard error.
fn stop_midway(folder: &TempDir, args: &[&str]) -> String {
    // So little that a fast machine has not finished, and a little more each time.
    let mut limit = 4;
    loop {
        let time = format!("{limit}ms");
        let (status, _, err) = render(folder, &[args, &["--time-limit", &time]].concat());
        assert_eq!(status, 130, "a picture that takes longer than {time}: {err}");
        if err.contains(" from which `--resume` renders the rest") {
            return err;
        }
        limit += limit / 2;
    }
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn rgba(folder: &TempDir, name: &str) -> RgbaImage {
    image::load_from_memory(&bytes(folder, name)).expect("a picture").into_rgba8()
}

/// Asserts that a file is a whole checkpoint: it ends with the SHA-256 of all before.
fn is_checkpoint(folder: &TempDir, name: &str) {
    let bytes = bytes(folder, name);
    let (text, checksum) = bytes.split_last_chunk::<32>().expect("a checksum");
    assert!(text.starts_with(b"tabray pixels") && *Sha256::digest(text) == *checksum, "{name}");
}

fn rgb(folder: &TempDir, name: &str) -> RgbImage {
    image::load_from_memory(&bytes(folder, name)).expect("a picture").into_rgb8()
}
