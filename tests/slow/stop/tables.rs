//! The tables of docs/farms.md.

use crate::common::program::{folder, names_in, scene};
use crate::stop::held::{MIRRORS, interruption};
use crate::stop::{Running, bytes, render, tabray_path, workplace};
use std::fmt::Write as _;
use std::fs;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Returns the text of a scene of `count` small spheres.
fn spheres(count: usize) -> String {
    let mut text = String::from(
        "camera c { pixeldim 1600 1200 samples 256 worlddim 8 6 viewpoint 4 3 6 }
        material m { ambient 1 1 1 diffuse 3 3 3 }
        light l { location 4 8 4 emissivity 20 20 20 }\n",
    );
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for index in 0..count {
        let [x, y, z] = [8.0 * random(), 6.0 * random(), -1.0 - 19.0 * random()];
        let _ = writeln!(text, "sphere s{index} {{ material m center {x:.15} {y:.15} {z:.15} radius 0.01 }}");
    }
    text
}

/// Runs a command, and interrupts it after a time if one is given. Returns how long it took, from the interruption on
/// if there was one; the most memory that it was seen to use, in MiB; and the last line of its standard error.
fn measured(folder: &TempDir, args: &[&str], interrupt: Option<Duration>) -> (Duration, u64, String) {
    let mut command = Command::new(tabray_path());
    command.args(args).current_dir(folder.path());
    let endless = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut start = Instant::now();
    let mut child = endless.spawn().expect("the program runs");
    let held = child.stdin.take();
    let (path, mut peak, mut running) = (format!("/proc/{}/status", child.id()), 0, Running(child));
    let mut interrupt = interrupt;
    while running.0.try_wait().expect("its status").is_none() {
        let status = fs::read_to_string(&path).unwrap_or_default();
        let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        peak = peak.max(most.and_then(|most| most.parse::<u64>().ok()).unwrap_or(0));
        if interrupt.is_some_and(|time| start.elapsed() > time) {
            interrupt = None;
            start = Instant::now();
            running.send(interruption());
        }
        thread::sleep(Duration::from_millis(5));
    }
    let time = start.elapsed();
    drop(held);
    let (status, err) = running.end();
    (time, peak >> 10, err.lines().last().map_or(format!("status {status}"), str::to_owned))
}

#[test]
#[ignore = "takes minutes, and prints a table of docs/farms.md"]
fn limits_table() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("mirrors.ray", MIRRORS);
    write("large.ray", &MIRRORS.replace("64 48", "6400 4800"));
    write("1e5.ray", &spheres(100_000));
    write("1e6.ray", &spheres(1_000_000));
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("ball.ray")).expect("a copy");
    println!("| input | limit | took | memory | last line |\n|---|---|---|---|---|");
    let line = |what: &str, limit: &str, args: &[&str], interrupt: Option<Duration>| {
        let (time, memory, said) = measured(&folder, args, interrupt);
        println!("| {what} | {limit} | {:.2} s | {memory} MiB | {said} |", time.as_secs_f64());
        for left in ["a.png", "a.png.checkpoint", "a.ppm", "a.ppm.checkpoint"] {
            let _ = fs::remove_file(folder.path().join(left));
        }
    };
    let large = ["render", "ball.ray", "--size", "100000x100000"];
    for (what, limit, args) in [
        ("65,536 samples between mirrors", "2s", &["render", "mirrors.ray", "-o", "a.png"][..]),
        ("standard input that does not end", "1s", &["render", "-", "-o", "a.png"]),
        ("100,000 spheres, 12 MB", "5s", &["render", "1e5.ray", "-o", "a.png"]),
        ("1,000,000 spheres, 117 MB", "2s", &["render", "1e6.ray", "-o", "a.png"]),
        ("1,000,000 spheres, 117 MB", "40s", &["render", "1e6.ray", "-o", "a.png"]),
        ("100,000 x 100,000 pixels, PNG", "10s", &[&large[..], &["-o", "a.png"]].concat()),
        ("100,000 x 100,000 pixels, PPM", "10s", &[&large[..], &["-o", "a.ppm"]].concat()),
    ] {
        line(what, limit, &[args, &["--time-limit", limit]].concat(), None);
    }
    for args in [
        &["render", "mirrors.ray", "-o", "a.png"][..],
        &["render", "1e6.ray", "-o", "a.png"],
        &["verify", "large.ray"],
        &["choose", "mirrors.ray", "--max-error", "1e-7%"],
        &["chart", "mirrors.ray"],
        &["bench", "mirrors.ray"],
    ] {
        line(&format!("`{}`", args.join(" ")), "Ctrl-C after 3 s", args, Some(Duration::from_secs(3)));
    }
}

/// Describes what has become of `a.png`, which was there before, and which other files there are.
fn left(folder: &TempDir, whole: &[u8]) -> String {
    let picture = bytes(folder, "a.png");
    let picture = match picture.as_slice() {
        b"precious" => "the old image",
        _ if picture == whole => "the new image",
        _ if image::load_from_memory(&picture).is_ok() => "the finished part",
        _ => "DAMAGED",
    };
    let mut others = names_in(folder.path());
    others.retain(|name| !["hall.ray", "other.ray", "a.png"].contains(&name.as_str()));
    if others.is_empty() { picture.to_owned() } else { format!("{picture}, {}", others.join(", ")) }
}

#[test]
#[ignore = "takes a minute, and prints a table of docs/farms.md"]
fn faults_table() {
    const ARGS: &str = "render hall.ray --size 600 --samples 256 -o a.png";
    let whole = workplace();
    assert_eq!(render(&whole, &ARGS.split(' ').skip(1).collect::<Vec<_>>()).0, 0);
    let whole = bytes(&whole, "a.png");
    println!("| fault | status | left | last line |\n|---|---|---|---|");
    // Each script is run by a shell in which `$0` is the program.
    for (fault, script) in [
        ("a full disk (a file of at most 512 bytes)", format!("ulimit -f 1; exec \"$0\" {ARGS}")),
        ("a full disk while it stops", format!("ulimit -f 20; exec \"$0\" {ARGS} --time-limit 300ms")),
        ("killed (SIGKILL) after 0.3 s", format!("timeout -s KILL 0.3 \"$0\" {ARGS}")),
        ("killed (SIGKILL) while it stops", format!("timeout -s KILL 0.33 \"$0\" {ARGS} --time-limit 300ms")),
        ("told to end (SIGTERM) after 0.5 s", format!("timeout --preserve-status 0.5 \"$0\" {ARGS}")),
        ("a scene that is its own output", "exec \"$0\" render hall.ray --format png -o hall.ray".to_owned()),
        (
            "a reader that is gone",
            "{ \"$0\" render hall.ray -o - 2> said; echo $? > status; } | true
                cat said >&2; status=$(cat status); rm said status; exit $status"
                .to_owned(),
        ),
        ("little address space", format!("ulimit -v 200000; exec \"$0\" {ARGS}")),
        (
            "the checkpoint of another scene",
            format!(
                "\"$0\" {ARGS} --time-limit 400ms 2>/dev/null; echo precious | tr -d '\\n' > a.png
                sed 's/specular/ambient 1 1 1 specular/' hall.ray > other.ray
                exec \"$0\" render other.ray --size 600 --samples 256 -o a.png --resume"
            ),
        ),
    ] {
        let folder = workplace();
        fs::write(folder.path().join("a.png"), "precious").expect("a file");
        let mut command = Command::new("sh");
        command.args(["-c", &script]).arg(tabray_path()).current_dir(folder.path());
        let output = command.output().expect("sh runs");
        let err = String::from_utf8_lossy(&output.stderr);
        let said = err.lines().rfind(|line| !line.starts_with(" ")).unwrap_or("");
        let status = output.status.code().unwrap_or(-1);
        println!("| {fault} | {status} | {} | {said} |", left(&folder, &whole));
    }
}
