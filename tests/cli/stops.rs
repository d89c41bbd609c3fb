//! Signals that end a program, in each command, while it reads, makes a model, works and writes.

use crate::common::program::folder;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How long a command is left alone before the signal, and the longest that it may take after it: far more than a second
/// on an idle machine, and far less than the work.
const BEFORE: Duration = Duration::from_millis(150);
const PATIENCE: Duration = Duration::from_secs(20);

/// A pixel between mirrors takes minutes.
const MIRRORS: &str = "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 samples 65536 }
material m { specular 0.99 0.99 0.99 diffuse 0.1 0.1 0.1 } sphere ball { material m center 4 3 -3 radius 2 }
light lamp { emissivity 1 1 1 location 0 9 9 }
plane front { material m normal 0 0 1 point 0 0 -9 } plane back { material m normal 0 0 -1 point 0 0 9 }\n";

/// The commands, with the stage in which the signal comes: a pipe without an end, a scene whose model takes minutes, or
/// work that does.
const STAGES: [(&str, &[&str]); 3] = [
    ("reading", &["check -", "dump -", "plan -", "probe - 1 1", "verify -", "render - -o x.png", "chart -"]),
    (
        "loading",
        &[
            "check balls.ray",
            "dump balls.ray",
            "plan balls.ray",
            "probe balls.ray 1 1",
            "verify balls.ray",
            "render balls.ray -o x.png",
            "chart balls.ray",
            "choose balls.ray --max-error 9",
            "bench balls.ray",
            "convert balls.ray x.toml",
            "hits balls.ray rays.txt",
            "hard balls.ray",
            "farm commands balls.ray -o x.png --parts 2",
            "watch balls.ray --port 0",
        ],
    ),
    (
        "working",
        &[
            "render mirrors.ray -o x.png",
            "render mirrors.ray -o x.exr",
            "verify mirrors.ray",
            "chart mirrors.ray",
            "choose mirrors.ray --max-error 1e-7%",
            "bench mirrors.ray",
            "watch mirrors.ray --port 0",
        ],
    ),
];

#[test]
fn every_command_ends_soon_at_every_signal_in_every_stage() {
    let folder = folder();
    // As many spheres as a scene may repeat.
    let balls = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
repeat i 490000 { sphere s { material m center i 2 3 radius 1 } }\n";
    fs::write(folder.path().join("balls.ray"), balls).expect("a scene");
    fs::write(folder.path().join("mirrors.ray"), MIRRORS).expect("a scene");
    fs::write(folder.path().join("rays.txt"), "0 0 9 0 0 -1\n").expect("a file");
    let mut longest = (Duration::ZERO, String::new());
    for (stage, commands) in STAGES {
        // Signals alternate, so that each comes to each stage, and the test stays short.
        for (index, command) in commands.iter().enumerate() {
            let signal = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP][index % 3];
            let mut program = Command::new(env!("CARGO_BIN_EXE_tabray"));
            program.args(command.split(' ')).current_dir(folder.path());
            program.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
            let mut child = program.spawn().expect("the program runs");
            thread::sleep(BEFORE);
            if child.try_wait().expect("a state").is_some() {
                println!("{stage:<8} {command}: it ended by itself");
                continue;
            }
            kill(Pid::from_raw(child.id() as i32), signal).expect("a signal");
            let start = Instant::now();
            let status = loop {
                if let Some(status) = child.try_wait().expect("a state") {
                    break status;
                }
                assert!(start.elapsed() < PATIENCE, "{stage}, {command}, {signal}");
                thread::sleep(Duration::from_millis(5));
            };
            let ended = (status.code(), status.signal());
            let is_sound = match command.split(' ').next() {
                Some("watch") => ended == (Some(0), None),
                _ => [(Some(130), None), (None, Some(signal as i32))].contains(&ended),
            };
            assert!(is_sound, "{stage}, {command}, {signal}: {status}");
            println!("{stage:<8} {signal:<8} {:.2} s  {command}", start.elapsed().as_secs_f64());
            if start.elapsed() > longest.0 {
                longest = (start.elapsed(), format!("{stage}, {command}, {signal}"));
            }
        }
    }
    println!("the longest: {:.2} s: {}", longest.0.as_secs_f64(), longest.1);
}
