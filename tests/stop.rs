//! Renders that stop before their picture is finished: what they leave, how they are gone on with, and that nothing is
//! ever damaged.
#![cfg(target_os = "linux")]

mod common;

use common::program::{folder, names_in, outcome, scene, tabray};
use image::{RgbImage, RgbaImage};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A scene whose picture takes some seconds.
const SLOW: &str = "gallery/hall-of-mirrors.ray";

/// A program under way.
struct Running(Child);

impl Running {
    fn start(program: &Path, folder: &TempDir, args: &[&str]) -> Self {
        let mut command = Command::new(program);
        command.args(args).current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(command.spawn().expect("the program runs"))
    }

    /// `tabray render` with these arguments.
    fn render(folder: &TempDir, args: &[&str]) -> Self {
        Self::start(&tabray_path(), folder, &[&["render"], args].concat())
    }

    /// Waits until it catches interruptions, or has ended.
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

    /// Waits until it has computed for a while: a tile is under way, or is done.
    fn until_it_renders(&mut self) {
        let stat = format!("/proc/{}/stat", self.0.id());
        // After the name, which stands in brackets, the twelfth number is CPU time in hundredths of a second.
        let ticks = || {
            let stat = fs::read_to_string(&stat).ok()?;
            stat.rsplit_once(") ")?.1.split(' ').nth(11)?.parse::<u32>().ok()
        };
        while ticks().expect("it runs") < 20 {
            thread::yield_now();
        }
    }

    fn send(&self, signal: Signal) {
        kill(Pid::from_raw(self.0.id() as i32), signal).expect("it is not waited for yet");
    }

    /// Its exit status, -1 where a signal ended it, and what it said.
    fn end(self) -> (i32, String) {
        let output = self.0.wait_with_output().expect("it ends");
        (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

fn tabray_path() -> PathBuf {
    assert_cmd::cargo::cargo_bin!("tabray").to_owned()
}

/// A working directory with a slow scene, `hall.ray`.
fn workplace() -> TempDir {
    let folder = folder();
    fs::copy(scene(SLOW), folder.path().join("hall.ray")).expect("a copy");
    folder
}

fn render(folder: &TempDir, args: &[&str]) -> (i32, Vec<u8>, String) {
    outcome(tabray(folder).arg("render").args(args))
}

/// Renders with a time limit under which some of the picture is finished, but not all; what was said.
fn stop_midway(folder: &TempDir, args: &[&str]) -> String {
    let mut limit = 40;
    loop {
        let time = format!("{limit}ms");
        let (status, _, err) = render(folder, &[args, &["--time-limit", &time]].concat());
        assert_eq!(status, 130, "a picture that takes longer than {time}: {err}");
        if err.contains(" from which `--resume` makes the rest") {
            return err;
        }
        limit *= 2;
    }
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn rgba(folder: &TempDir, name: &str) -> RgbaImage {
    image::load_from_memory(&bytes(folder, name)).expect("a picture").into_rgba8()
}

fn rgb(folder: &TempDir, name: &str) -> RgbImage {
    image::load_from_memory(&bytes(folder, name)).expect("a picture").into_rgb8()
}

/// Interrupts a render at ten random moments and goes on each time, with any number of threads; the picture is that of
/// a render that was left alone.
fn interrupted_ten_times(seed: u64, name: &str, scene: &str, options: &[&str], last: &[&str]) {
    let folder = folder();
    let scene = common::root().join("scenes").join(scene);
    let args = [&[scene.to_str().expect("UTF-8")], options].concat();
    let whole = format!("whole-{name}");
    let start = Instant::now();
    let (status, _, err) = render(&folder, &[&args[..], &["-o", &whole]].concat());
    assert_eq!(status, 0, "{err}");
    // It has ten times to be interrupted in, and is not to be finished before.
    let longest = start.elapsed().as_micros() as u32 / 12;

    let mut random = Pcg32::new(seed, 0);
    let mut interruptions = 0;
    while interruptions < 10 {
        let threads = (1 + random.next_u32() % 4).to_string();
        let args = [&args[..], &["-o", name, "--resume", "--threads", &threads]].concat();
        let mut running = Running::render(&folder, &args);
        running.until_it_catches();
        thread::sleep(Duration::from_micros((random.next_u32() % longest).into()));
        running.send(Signal::SIGINT);
        let (status, err) = running.end();
        assert!(status == 130 || status == 0, "{status}: {err}");
        interruptions += usize::from(status == 130);
    }
    let (status, _, err) = render(&folder, &[&args[..], &["-o", name, "--resume"], last].concat());
    assert_eq!(status, 0, "{err}");
    assert!(bytes(&folder, name) == bytes(&folder, &whole), "{name} is the same picture");
    let mut left = [name.to_owned(), whole];
    left.sort();
    assert_eq!(names_in(folder.path()), left);
}

#[test]
fn a_png_interrupted_at_random_and_resumed_is_the_same() {
    interrupted_ten_times(1, "a.png", SLOW, &["--size", "420"], &[]);
}

#[test]
fn a_ppm_interrupted_at_random_and_resumed_is_the_same() {
    interrupted_ten_times(2, "a.ppm", SLOW, &["--size", "420", "--samples", "3"], &["--cpu", "baseline"]);
}

#[test]
fn a_part_interrupted_at_random_and_resumed_is_the_same() {
    interrupted_ten_times(3, "a.png", SLOW, &["--crop", "101,53,203,307", "--samples", "9"], &[]);
}

/// Its bands have 40 rows, and with little memory 8.
#[test]
fn a_picture_of_many_bands_interrupted_at_random_and_resumed_is_the_same() {
    let size = ["--size", "100000x90"];
    interrupted_ten_times(4, "a.png", "sphere/in-front.ray", &size, &["--max-memory", "40MiB"]);
}

#[test]
fn what_is_done_is_in_the_picture_and_the_rest_is_transparent() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "501", "--samples", "4"];
    let err = stop_midway(&folder, &[&args[..], &["-o", "a.png"]].concat());
    assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray"]);
    let (partial, checkpoint) = (rgba(&folder, "a.png"), rgba(&folder, "a.png.checkpoint"));
    assert!(partial == checkpoint);
    assert_eq!(render(&folder, &[&args[..], &["-o", "whole.png"]].concat()).0, 0);
    let whole = rgb(&folder, "whole.png");
    assert_eq!(partial.dimensions(), whole.dimensions());
    let mut done = 0;
    for (x, y, pixel) in partial.enumerate_pixels() {
        let [red, green, blue, alpha] = pixel.0;
        // A tile is rendered as a whole.
        assert_eq!(alpha, partial.get_pixel(x / 8 * 8, y / 8 * 8)[3]);
        let expected = if alpha == 0 { [0; 3] } else { whole.get_pixel(x, y).0 };
        assert_eq!([red, green, blue], expected, "at {x} {y}");
        done += usize::from(alpha == 255);
    }
    let tenths = 1000 * done / partial.pixels().len();
    assert!(0 < tenths && tenths < 1000);
    let share = format!("{}.{}", tenths / 10, tenths % 10);
    let said =
        format!("wrote {share} % of a.png, and a.png.checkpoint, from which `--resume` makes the rest\n");
    assert!(err.ends_with(&said), "{err} {said}");
}

#[test]
fn the_rest_of_a_ppm_is_black() {
    let folder = workplace();
    let args = ["hall.ray", "--samples", "4"];
    stop_midway(&folder, &[&args[..], &["-o", "a.ppm"]].concat());
    assert_eq!(names_in(folder.path()), ["a.ppm", "a.ppm.checkpoint", "hall.ray"]);
    let (partial, checkpoint) = (rgb(&folder, "a.ppm"), rgba(&folder, "a.ppm.checkpoint"));
    for (pixel, kept) in partial.pixels().zip(checkpoint.pixels()) {
        let [red, green, blue, _] = kept.0;
        assert_eq!(pixel.0, [red, green, blue]);
    }
    assert!(checkpoint.pixels().any(|pixel| pixel.0 == [0; 4]));
}

#[test]
fn how_it_is_written_may_differ() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "320", "--samples", "9"];
    stop_midway(&folder, &[&args[..], &["-o", "a.png"]].concat());
    fs::rename(folder.path().join("a.png.checkpoint"), folder.path().join("b.ppm.checkpoint"))
        .expect("a move");
    let commented = format!("# a comment\n{}", fs::read_to_string(scene(SLOW)).expect("a scene"));
    fs::write(folder.path().join("hall.ray"), commented).expect("a file");
    assert_eq!(render(&folder, &[&args[..], &["-o", "whole.ppm"]].concat()).0, 0);
    let other = ["-o", "b.ppm", "--resume", "--threads", "3", "--cpu", "baseline", "--compress", "best"];
    let (status, _, err) = render(&folder, &[&args[..], &other].concat());
    assert!(status == 0 && err.starts_with("wrote b.ppm (320 x 240 pixels, "), "{err}");
    assert!(bytes(&folder, "b.ppm") == bytes(&folder, "whole.ppm"));
}

#[test]
fn without_a_checkpoint_it_begins_anew_and_says_so() {
    let folder = workplace();
    let (status, _, err) = render(&folder, &["hall.ray", "--quick", "-o", "a.png", "--resume"]);
    assert_eq!(status, 0);
    let said = "there is no a.png.checkpoint to go on from: the picture begins anew\nwrote a.png (";
    assert!(err.starts_with(said), "{err}");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

/// Hours may be in it, and a look at a smaller picture must not cost them.
#[test]
fn a_checkpoint_stays_where_it_is_not_asked_for() {
    let folder = workplace();
    stop_midway(&folder, &["hall.ray", "-o", "a.png"]);
    let checkpoint = bytes(&folder, "a.png.checkpoint");
    let (status, _, err) = render(&folder, &["hall.ray", "--quick", "-o", "a.png"]);
    assert_eq!(status, 0);
    let said =
        "a.png.checkpoint is there, and with `--resume` the picture would go on from it\nwrote a.png (";
    assert!(err.starts_with(said), "{err}");
    assert!(bytes(&folder, "a.png.checkpoint") == checkpoint);
}

const HELP: &str = " |\n = help: leave out `--resume` to begin anew\n";

/// A scene with a texture, slow to render.
const TEXTURED: &str = "camera eye { pixeldim 640 480  worlddim 8 6  viewpoint 4 3 6 }
material white { ambient 2 2 2 }
texture bricks { filename bricks.png }
texplane wall { material white  normal 0 0 1  point 0 0 -8  xdir 1 0 0  dimensions 8 6  texname bricks  mode 0 }";

#[test]
fn what_differs_is_named() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let copy = |from: &str, to: &str| fs::copy(scene(from), at(to)).expect("a copy");
    copy("textures/bricks.png", "bricks.png");
    fs::write(at("wall.ray"), TEXTURED).expect("a file");
    let args = ["wall.ray", "--samples", "144", "-o", "a.png"];
    stop_midway(&folder, &args);
    let checkpoint = bytes(&folder, "a.png.checkpoint");
    let picture = bytes(&folder, "a.png");
    let refused = |args: &[&str], differs: &str| {
        let (status, _, err) = render(&folder, &[args, &["--resume"]].concat());
        let said = format!("error: `a.png.checkpoint` is of another picture: {differs}\n{HELP}");
        assert_eq!((status, err), (2, said), "{args:?}");
        let kept = bytes(&folder, "a.png") == picture && bytes(&folder, "a.png.checkpoint") == checkpoint;
        assert!(kept, "{args:?} changes no file");
    };
    refused(&["wall.ray", "-o", "a.png"], "the number of samples was 144 and is 1");
    refused(
        &[&args[..], &["--size", "320", "--sampler", "random"]].concat(),
        "the size was 640 x 480 and is 320 x 240, the sampler was sobol and is random",
    );
    refused(&[&args[..], &["--crop", "1,2,3,4"]].concat(), "the crop was none and is 1,2,3,4");
    refused(&[&args[..], &["--method", "classic"]].concat(), "the accuracy was exact and is classic");
    fs::write(at("wall.ray"), TEXTURED.replace("ambient 2 2 2", "ambient 2 2 2.0000000000000004"))
        .expect("a file");
    refused(&args, "the scene has changed");
    fs::write(at("wall.ray"), TEXTURED).expect("a file");
    let mut bricks = rgb(&folder, "bricks.png");
    bricks.put_pixel(3, 2, image::Rgb([1, 2, 3]));
    bricks.save(at("bricks.png")).expect("a picture");
    refused(&args, "the picture of texture `bricks` has changed");
    copy("textures/bricks.png", "bricks.png");

    // The end of the file is no part of what the system loads.
    let mut program = fs::read(tabray_path()).expect("the program's file");
    program.push(0);
    let other = at("other");
    fs::write(&other, program).expect("a file");
    fs::set_permissions(&other, fs::metadata(tabray_path()).expect("there").permissions())
        .expect("permissions");
    let (status, err) =
        Running::start(&other, &folder, &[&["render"], &args[..], &["--resume"]].concat()).end();
    let said = format!("error: `a.png.checkpoint` is of another picture: the program was built anew\n{HELP}");
    assert_eq!((status, err), (2, said));

    let version = format!("\"the version of tabray\":\"{}\"", env!("CARGO_PKG_VERSION"));
    rewrite(&at("a.png.checkpoint"), |text| text.replace(&version, "\"the version of tabray\":\"0.0.9\""));
    let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    let now = env!("CARGO_PKG_VERSION");
    let said = format!(
        "error: `a.png.checkpoint` is of another picture: the version of tabray was 0.0.9 and is {now}\n{HELP}"
    );
    assert_eq!((status, err), (2, said));
}

/// Changes the text of a checkpoint.
fn rewrite(path: &Path, change: impl FnOnce(String) -> String) {
    let file = BufReader::new(fs::File::open(path).expect("a checkpoint"));
    let mut png = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; png.output_buffer_size().expect("a small picture")];
    png.next_frame(&mut pixels).expect("its pixels");
    let info = png.info();
    let text = &info.utf8_text[0];
    let changed = change(text.get_text().expect("a text"));
    let mut encoder = png::Encoder::new(fs::File::create(path).expect("a file"), info.width, info.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.add_itxt_chunk(text.keyword.clone(), changed).expect("a text");
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).expect("room");
}

#[test]
fn what_is_no_checkpoint_is_refused_and_harms_nothing() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "300", "--samples", "4", "-o", "a.png"];
    stop_midway(&folder, &args);
    let (checkpoint, path) = (bytes(&folder, "a.png.checkpoint"), folder.path().join("a.png.checkpoint"));
    let plain = fs::read(scene("textures/bricks.png")).expect("a picture");
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let cut = |at: usize| checkpoint[..at].to_vec();
    for broken in [Vec::new(), b"no picture".to_vec(), plain, cut(100), cut(checkpoint.len() / 2)] {
        fs::write(&path, &broken).expect("a file");
        let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
        let said =
            format!("error: cannot read `a.png.checkpoint`: it is no checkpoint, or a broken one\n{HELP}");
        assert_eq!((status, err), (2, said), "of {} bytes", broken.len());
        assert!(bytes(&folder, "a.png") == b"precious" && fs::read(&path).expect("there") == broken);
        assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray"]);
    }
    fs::remove_file(&path).and_then(|()| fs::create_dir(&path)).expect("a folder");
    let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    assert_eq!((status, err), (2, format!("error: cannot read `a.png.checkpoint`: is a directory\n{HELP}")));
}

#[test]
fn each_reason_to_stop_is_told() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "2000", "--samples", "16", "-o", "a.png"];
    let err = stop_midway(&folder, &args);
    assert!(err.starts_with("the time limit of ") && err.contains("ms is reached\nwrote "), "{err}");

    let mut running = Running::render(&folder, &[&args[..], &["--resume"]].concat());
    running.until_it_renders();
    running.send(Signal::SIGTERM);
    let (status, err) = running.end();
    assert_eq!(status, 130);
    assert!(err.starts_with("interrupted; another Ctrl-C ends at once\nwrote "), "{err}");
}

#[test]
fn too_little_memory_is_refused_and_reached_memory_stops() {
    let folder = folder();
    let path = scene("material/touching-mirrors.ray");
    let args = [path.to_str().expect("UTF-8"), "-o", "a.png"];
    let (status, _, err) = render(&folder, &[&args[..], &["--max-memory", "5KiB"]].concat());
    let said = "error: 5.0 KiB of memory are not enough for this picture\n |\n = help: it takes about ";
    assert!(status == 2 && err.starts_with(said) && err.ends_with(" MiB at least\n"), "{err}");
    assert!(names_in(folder.path()).is_empty());

    // Far more rays are reflected here than have room in that much more.
    let least: f64 = err[said.len()..].split(' ').next().expect("a number").parse().expect("a number");
    let limit = format!("{}MiB", least.ceil() + 16.0);
    let (status, _, err) = render(&folder, &[&args[..], &["--max-memory", &limit]].concat());
    assert_eq!(status, 130, "{err}");
    let said = format!("the memory limit of {}.0 MiB is reached\n", limit.trim_end_matches("MiB"));
    assert!(err.starts_with(&said), "{err}");
    assert_eq!(render(&folder, &[&args[..], &["--resume"]].concat()).0, 0);
    assert_eq!(render(&folder, &[&args[..1], &["-o", "whole.png"]].concat()).0, 0);
    assert!(bytes(&folder, "a.png") == bytes(&folder, "whole.png"));
}

#[test]
fn limits_that_make_no_sense_are_refused() {
    let folder = workplace();
    for (option, values, says) in [
        ("--time-limit", ["90", "0s", "soon"], "give a time as `90s`, `5m` or `1.5h`"),
        ("--max-memory", ["much", "-5", "5 apples"], "give a size as `200MiB` or `1.5GiB`"),
    ] {
        for value in values {
            let (status, _, err) = render(&folder, &["hall.ray", &format!("{option}={value}")]);
            let first = format!("error: invalid value '{value}' for '{option} <");
            assert!(status == 2 && err.starts_with(&first) && err.contains(says), "{err}");
        }
    }
}

#[test]
fn standard_output_is_filled_with_black_and_cannot_be_resumed() {
    let folder = workplace();
    let args = ["hall.ray", "--samples", "16", "-o", "-"];
    let (status, out, err) = render(&folder, &[&args[..], &["--time-limit", "100ms"]].concat());
    assert_eq!(status, 130);
    let (reason, rest) = err.split_once('\n').expect("two lines");
    assert_eq!(reason, "the time limit of 100ms is reached");
    assert!(
        rest.ends_with(" % of the picture is rendered, and the rest is black; only files can be resumed\n"),
        "{rest}"
    );
    let picture = image::load_from_memory(&out).expect("a whole picture").into_rgb8();
    assert_eq!((picture.dimensions(), picture.get_pixel(639, 479).0), ((640, 480), [0; 3]));
    let (status, out, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    assert_eq!((status, out.len()), (2, 0));
    let said = "error: there is no place for a checkpoint beside `-`\n |\n = help: name the picture's file with `-o \
                FILE`, or leave out `--resume`\n";
    assert_eq!(err, said);
}

/// One tile takes seconds.
const SLOWEST: [&str; 5] = ["hall.ray", "--samples", "65536", "-o", "a.png"];

#[test]
fn a_picture_that_was_not_begun_is_not_written() {
    let folder = workplace();
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let said = "the time limit of 1ns is reached\nnothing is rendered yet, and nothing is written\n";
    let mut tries = (0..20).map(|_| render(&folder, &[&SLOWEST[..], &["--time-limit", "1ns"]].concat()));
    assert!(tries.any(|(status, _, err)| status == 130 && err == said));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

#[test]
fn a_second_interruption_ends_at_once() {
    let folder = workplace();
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let mut running = Running::render(&folder, &SLOWEST);
    running.until_it_renders();
    while running.0.try_wait().expect("its status").is_none() {
        running.send(Signal::SIGINT);
        thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(running.end(), (130, String::new()));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

#[test]
fn a_second_interruption_ends_the_writing_too() {
    // Where nobody reads, it would go on for ever.
    let folder = workplace();
    let mut running = Running::render(&folder, &["hall.ray", "--size", "3000", "-o", "-"]);
    running.until_it_catches();
    running.send(Signal::SIGINT);
    let mut err = BufReader::new(running.0.stderr.take().expect("it is piped"));
    let mut line = String::new();
    err.read_line(&mut line).expect("a line");
    assert_eq!(line, "interrupted; another Ctrl-C ends at once\n");
    running.send(Signal::SIGINT);
    let mut rest = String::new();
    err.read_to_string(&mut rest).expect("text");
    assert_eq!((running.0.wait().expect("it ends").code(), rest.as_str()), (Some(130), ""));

    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let large = ["hall.ray", "--size", "30000x10000", "-o", "a.png"];
    let mut running = Running::render(&folder, &large);
    running.until_it_renders();
    running.send(Signal::SIGINT);
    let mut err = BufReader::new(running.0.stderr.take().expect("it is piped"));
    err.read_line(&mut line).expect("a line");
    running.send(Signal::SIGINT);
    assert_eq!(running.0.wait().expect("it ends").code(), Some(130));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

/// Stops a render that may write no file larger than so many blocks of 512 bytes.
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
        let said =
            format!("the time limit of 400ms is reached\nerror: cannot write `{cannot}`: file too large\n");
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

/// Kills a render so many times at random moments, and looks at what there is then.
fn killed(times: usize, args: &[&str], sound: impl Fn(&TempDir)) {
    let mut random = Pcg32::new(9, 0);
    let folder = workplace();
    let start = Instant::now();
    render(&folder, args);
    let longest = 5 * start.elapsed().as_micros() as u32 / 4;
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
        sound(&folder);
    }
    assert!(0 < ended && ended < times, "some ended before they were killed, and some did not: {ended}");
}

/// What is in the folder but a scene, a picture and its checkpoint: for a moment the whole file has a hidden name, and
/// the next render takes it away.
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
            assert_eq!(render(folder, &args).0, 0);
            assert!(hidden(folder).is_empty());
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
            assert!(checkpoint && rgba(folder, "a.png") == rgba(folder, "a.png.checkpoint"));
        } else if checkpoint {
            rgba(folder, "a.png.checkpoint");
        }
        hidden(folder).iter().for_each(|name| drop(rgba(folder, name)));
    });
}

#[test]
fn a_link_stays_a_link_when_a_render_stops() {
    let folder = workplace();
    let link = folder.path().join("a.png");
    fs::create_dir(folder.path().join("pictures")).expect("a folder");
    std::os::unix::fs::symlink("pictures/b.png", &link).expect("a link");
    fs::write(folder.path().join("pictures/b.png"), "old").expect("a file");
    stop_midway(&folder, &["hall.ray", "--samples", "16", "-o", "a.png"]);
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray", "pictures"]);
    assert!(rgba(&folder, "pictures/b.png") == rgba(&folder, "a.png.checkpoint"));
}
