//! Signals that end a program, in each command, while it reads, makes a model, works and writes.

use crate::common::program::{folder, names_in};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The longest that a command may take after the signal: far more than a second on an idle machine, and far less than
/// the work.
const PATIENCE: Duration = Duration::from_secs(20);

/// How much of the processor a command uses before the signal, while it loads and while it works: on a busy machine, time
/// alone says little about how far it is.
const BEGUN: Duration = Duration::from_millis(150);
const AT_WORK: Duration = Duration::from_millis(400);

/// A pixel between mirrors takes minutes.
const MIRRORS: &str = "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 samples 65536 }
material m { specular 0.99 0.99 0.99 diffuse 0.1 0.1 0.1 } sphere ball { material m center 4 3 -3 radius 2 }
light lamp { emissivity 1 1 1 location 0 9 9 }
plane front { material m normal 0 0 1 point 0 0 -9 } plane back { material m normal 0 0 -1 point 0 0 9 }\n";

/// As many spheres as a scene may repeat, each at a place that is computed.
const BALLS: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
repeat i 490000 { sphere s { material m center \"sin(i) + cos(i)\" \"exp(sin(i))\" 3 radius 1 } }\n";

/// A surface with as many folds as a mesh may have triangles for.
const FOLDS: &str = "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 samples 4096 } material m { ambient 1 1 1 }
implicit folds { material m box -9 -9 -9 9 9 9 formula \"sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x) + exp(sin(3*x))/9\" }\n";

/// An image as wide as it takes for its compression to be work.
const WIDE: &str =
    "camera eye { pixeldim 4000 4000 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
sphere s { material m center 4 3 0 radius 2 }\n";

/// Where a command is when the signal comes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// It waits for more of its input, a pipe without an end.
    Reading,
    /// It makes the model of a scene that takes seconds.
    Loading,
    /// It does its work, which takes longer than a test may.
    Working,
    /// It waits until somebody reads its output, a pipe that is full.
    Writing,
}

/// The commands in each stage. A file after `<` is the standard input.
const STAGES: [(Stage, &[&str]); 4] = [
    (
        Stage::Reading,
        &[
            "",
            "check -",
            "dump -",
            "plan -",
            "probe - 1 1",
            "verify -",
            "render - -o x.png",
            "chart -",
            "choose - --max-error 9",
            "bench -",
            "convert - x.toml",
            "fmt -",
            "mesh - folds -o x.stl",
            "hits - rays.txt",
            "hits mirrors.ray",
            "hits mirrors.ray -o x.csv --all",
            "judge mirrors.ray",
            "hard - -o x.csv",
            "grade - black.ppm",
            "lsp",
        ],
    ),
    (
        Stage::Loading,
        &[
            "< balls.ray",
            "check balls.ray",
            "dump balls.ray",
            "plan balls.ray",
            "probe balls.ray 1 1",
            "verify balls.ray",
            "verify balls.ray --colours",
            "render balls.ray -o x.png",
            "render balls.ray -o x.exr --part 1/2",
            "chart balls.ray",
            "choose balls.ray --max-error 9",
            "bench balls.ray",
            "convert balls.ray x.toml",
            "mesh balls.ray s0 -o x.stl",
            "hits balls.ray rays.txt -o x.csv",
            "judge balls.ray answers.csv",
            "hard balls.ray -o x.csv",
            "grade balls.ray black.ppm",
            "diff black.ppm black.ppm --scene balls.ray -o x.html",
            "farm commands balls.ray -o x.png --parts 2",
            "list big.obj",
            "new scene x.ray --mesh big.obj",
            "hits big.obj rays.txt -o x.csv",
            "watch balls.ray --port 0",
        ],
    ),
    (
        Stage::Working,
        &[
            "< mirrors.ray",
            "render mirrors.ray -o x.png",
            "render mirrors.ray -o x.exr",
            "render mirrors.ray -o x.ppm --part 1/2",
            "render mirrors.ray -o x.png --frames 1..9 --sweep ball.radius=1..2",
            "render mirrors.ray -o x.png --aov depth",
            "render folds.ray -o x.png",
            "render wide.ray -o x.png --samples 16",
            "verify mirrors.ray",
            "verify mirrors.ray --colours",
            "verify folds.ray",
            "chart mirrors.ray",
            "chart folds.ray",
            "choose mirrors.ray --max-error 1e-7%",
            "bench mirrors.ray",
            "mesh folds.ray folds -o x.stl --error 0.02",
            "hits folds.ray --from-camera -o x.csv",
            "hits mirrors.ray many.txt -o x.csv --all",
            "judge mirrors.ray many.csv",
            "hard folds.ray -n 1000000 -o x.csv",
            "grade mirrors.ray black.ppm",
            "fmt big.ray",
            "film film.ppm --animation x.apng",
            "film film.ppm --sheet x.png",
            "watch mirrors.ray --port 0",
        ],
    ),
    (
        Stage::Writing,
        &[
            "< wide.ray",
            "dump many.ray",
            "convert many.ray - --to toml",
            "fmt - < many.ray",
            "render wide.ray -o -",
            "mesh folds.ray folds -o - --format obj --error 0.5",
            "hits mirrors.ray many.txt",
            "hits mirrors.ray many.txt --fast --to csv",
            "hard mirrors.ray -n 9000",
            "farm commands mirrors.ray -o x.png --parts 2000",
            "schema",
            "list --markdown",
        ],
    ),
];

/// Writes the files that the commands name.
fn write_files(folder: &Path) {
    let write = |name: &str, text: String| fs::write(folder.join(name), text).expect("a file");
    for (name, text) in
        [("balls.ray", BALLS), ("mirrors.ray", MIRRORS), ("folds.ray", FOLDS), ("wide.ray", WIDE)]
    {
        write(name, text.to_owned());
    }
    write("rays.txt", "0 0 9 0 0 -1\n".to_owned());
    write("many.txt", "0 0 8 0.1 0.2 -1\n".repeat(1_000_000));
    let columns = "ox,oy,oz,dx,dy,dz,t\n";
    write("answers.csv", format!("{columns}0,0,9,0,0,-1,3\n"));
    write("many.csv", columns.to_owned() + &"0,0,8,0.1,0.2,-1,3\n".repeat(1_000_000));
    let spheres = |count: usize| {
        (0..count).map(|i| format!("sphere s{i} {{ material m  center {i} 2 3  radius 1 }}\n"))
    };
    let head = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }\n";
    write("many.ray", head.to_owned() + &spheres(4000).collect::<String>());
    write("big.ray", head.to_owned() + &spheres(250_000).collect::<String>());
    // A grid of quadrilaterals, as a text.
    let side = 700;
    let points = (0..side * side).map(|i| format!("v {} {} {}\n", i % side, i / side, i % 7));
    let faces = (0..side * (side - 1)).filter(|i| i % side < side - 1).map(|i| {
        let i = i + 1;
        format!("f {} {} {} {}\n", i, i + 1, i + 1 + side, i + side)
    });
    write("big.obj", points.chain(faces).collect());
    // Black pixels, which take no room on a disk.
    for (name, [width, height]) in [("black.ppm", [640, 480]), ("film-1.ppm", [3000, 3000])] {
        let head = format!("P6 {width} {height} 255\n");
        let mut file = File::create(folder.join(name)).expect("a file");
        file.write_all(head.as_bytes()).expect("a file");
        file.set_len(head.len() as u64 + 3 * width * height).expect("a file");
    }
    for frame in 2..100 {
        fs::hard_link(folder.join("film-1.ppm"), folder.join(format!("film-{frame}.ppm"))).expect("a link");
    }
}

/// Returns how much of the processor a child has used, if it still runs and the system tells.
fn used(child: &Child) -> Option<Duration> {
    let stat = fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
    // The name of the program may have blanks; after it come the state, 10 numbers, and the times in hundredths.
    let mut numbers = stat.rsplit(')').next()?.split_whitespace().skip(11).map(str::parse::<u64>);
    Some(Duration::from_millis(10 * (numbers.next()?.ok()? + numbers.next()?.ok()?)))
}

/// Waits until a command is in a stage; where the system does not tell, for a moment.
fn wait(child: &mut Child, stage: Stage) {
    let start = Instant::now();
    let (mut last, mut since) = (Duration::MAX, Instant::now());
    while child.try_wait().expect("a state").is_none() && start.elapsed() < PATIENCE {
        let Some(now) = used(child) else { return thread::sleep(BEGUN) };
        if now != last {
            (last, since) = (now, Instant::now());
        }
        let is_there = match stage {
            Stage::Loading => now >= BEGUN,
            Stage::Working => now >= AT_WORK,
            // It waits, and so uses nothing.
            Stage::Reading => since.elapsed() >= BEGUN,
            Stage::Writing => now >= BEGUN / 5 && since.elapsed() >= 2 * BEGUN,
        };
        if is_there {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
}

/// Tells whether a signal is ignored, as an interruption is by what a shell starts in the background: programs that this
/// starts ignore it, too.
fn is_ignored(signal: Signal) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored =
        status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    ignored.is_some_and(|signals| signals >> (signal as u32 - 1) & 1 == 1)
}

/// Sends a signal; returns how the command ended, and how long it took.
fn stop(child: &mut Child, signal: Signal, what: &str) -> (ExitStatus, Duration) {
    kill(Pid::from_raw(child.id() as i32), signal).expect("a signal");
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a state") {
            return (status, start.elapsed());
        }
        assert!(start.elapsed() < PATIENCE, "{what}");
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn every_command_ends_soon_at_every_signal_in_every_stage() {
    let folder = folder();
    write_files(folder.path());
    let names = || BTreeSet::from_iter(names_in(folder.path()));
    let before = names();
    let mut longest = (Duration::ZERO, String::new());
    let mut by_themselves = Vec::new();
    let signals =
        [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    let signals: Vec<_> = signals.collect();
    for (stage, commands) in STAGES {
        // Signals alternate, so that each comes to each stage, and the test stays short.
        for (index, command) in commands.iter().enumerate() {
            let signal = signals[index % signals.len()];
            let (words, input) = command.split_once('<').unwrap_or((command, ""));
            let mut program = Command::new(env!("CARGO_BIN_EXE_tabray"));
            program.args(words.split_whitespace()).current_dir(folder.path()).stderr(Stdio::null());
            program.stdout(if stage == Stage::Writing { Stdio::piped() } else { Stdio::null() });
            program.stdin(match input.trim() {
                "" => Stdio::piped(),
                file => File::open(folder.path().join(file)).expect("a file").into(),
            });
            let mut child = program.spawn().expect("the program runs");
            wait(&mut child, stage);
            let what = format!("{stage:?}, {signal}: {command}");
            if child.try_wait().expect("a state").is_some() {
                by_themselves.push(what);
                continue;
            }
            let (status, time) = stop(&mut child, signal, &what);
            let ended = (status.code(), status.signal());
            let is_sound = match words.split(' ').next() {
                Some("watch") => ended == (Some(0), None),
                _ => [(Some(130), None), (None, Some(signal as i32))].contains(&ended),
            };
            assert!(is_sound, "{what}: {status}");
            // A render and a chart keep what they have done, and nobody leaves anything else.
            for name in names().difference(&before) {
                let is_kept = match words.split(' ').next() {
                    Some("render") => name.starts_with("x."),
                    Some("chart") => name.contains("-chart."),
                    _ => false,
                };
                assert!(is_kept && stage == Stage::Working, "{what} leaves {name}");
                fs::remove_file(folder.path().join(name)).expect("a file");
            }
            println!("{:.2} s  {what}", time.as_secs_f64());
            if time > longest.0 {
                longest = (time, what);
            }
        }
    }
    println!("the longest: {:.2} s: {}", longest.0.as_secs_f64(), longest.1);
    assert!(by_themselves.is_empty(), "these ended before the signal: {by_themselves:#?}");
}
