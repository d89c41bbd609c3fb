//! What a render that stops leaves behind, and renders that resume from it.

use crate::common::program::{folder, names_in, scene};
use crate::common::root;
use crate::stop::{Running, SLOW, bytes, is_checkpoint, render, rgb, rgba, stop_midway, workplace};
use image::imageops;
use nix::sys::signal::Signal;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fs;
use std::os::unix::fs::symlink;
use std::thread;
use std::time::{Duration, Instant};

#[test]
fn a_checkpoint_that_cannot_be_removed_is_told_and_the_picture_is_whole() {
    let folder = workplace();
    let args = ["hall.ray", "--samples", "16", "-o", "a.png"];
    stop_midway(&folder, &args);
    let mut running = Running::render(&folder, &[&args[..], &["--resume"]].concat());
    running.until_it_renders();
    // By the time the checkpoint is to be removed, a folder is in its place.
    let path = folder.path().join("a.png.checkpoint");
    fs::remove_file(&path).and_then(|()| fs::create_dir(&path)).expect("a folder");
    let said = "error: cannot remove `a.png.checkpoint`: is a directory; the image is finished, so remove the file by hand\n";
    assert_eq!(running.end(), (1, said.to_owned()));
    assert_eq!(render(&folder, &[&args[..3], &["-o", "whole.png"]].concat()).0, 0);
    assert!(bytes(&folder, "a.png") == bytes(&folder, "whole.png"));
}

/// Interrupts a render at ten random moments and resumes it each time, with one to four threads. The image is the same
/// as that of a render without interruptions.
fn interrupted_ten_times(seed: u64, name: &str, scene: &str, options: &[&str], last: &[&str]) {
    let folder = folder();
    let scene = root().join("scenes").join(scene);
    let args = [&[scene.to_str().expect("UTF-8")], options].concat();
    let whole = format!("whole-{name}");
    let start = Instant::now();
    let (status, _, err) = render(&folder, &[&args[..], &["-o", &whole]].concat());
    assert_eq!(status, 0, "{err}");
    // Each part lasts less than a twelfth of the whole render, so that ten interruptions come before its end.
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

#[test]
fn a_png_of_adaptive_samples_interrupted_at_random_and_resumed_is_the_same() {
    interrupted_ten_times(5, "a.png", SLOW, &["--size", "420", "--samples", "2..16"], &["--cpu", "baseline"]);
}

#[test]
fn a_transparent_png_interrupted_at_random_and_resumed_is_the_same() {
    interrupted_ten_times(6, "a.png", "gallery/leaf.ray", &["--size", "160", "--alpha"], &["--threads", "1"]);
}

/// The image's bands have 40 rows, or 8 where memory is limited.
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
    let partial = rgba(&folder, "a.png");
    is_checkpoint(&folder, "a.png.checkpoint");
    assert_eq!(render(&folder, &[&args[..], &["-o", "whole.png"]].concat()).0, 0);
    let whole = rgb(&folder, "whole.png");
    assert_eq!(partial.dimensions(), whole.dimensions());
    let mut done = 0;
    for (x, y, pixel) in partial.enumerate_pixels() {
        let [red, green, blue, alpha] = pixel.0;
        // A tile is finished as a whole or not at all.
        assert_eq!(alpha, partial.get_pixel(x / 8 * 8, y / 8 * 8)[3]);
        let expected = if alpha == 0 { [0; 3] } else { whole.get_pixel(x, y).0 };
        assert_eq!([red, green, blue], expected, "at {x} {y}");
        done += usize::from(alpha == 255);
    }
    let tenths = 1000 * done / partial.pixels().len();
    assert!(0 < tenths && tenths < 1000);
    let share = format!("{}.{}", tenths / 10, tenths % 10);
    let said =
        format!("wrote {share} % of a.png, and a.png.checkpoint, from which `--resume` renders the rest\n");
    assert!(err.ends_with(&said), "{err} {said}");
}

#[test]
fn the_rest_of_a_ppm_is_black() {
    let folder = workplace();
    let args = ["hall.ray", "--samples", "4"];
    stop_midway(&folder, &[&args[..], &["-o", "a.ppm"]].concat());
    assert_eq!(names_in(folder.path()), ["a.ppm", "a.ppm.checkpoint", "hall.ray"]);
    assert_eq!(render(&folder, &[&args[..], &["-o", "whole.ppm"]].concat()).0, 0);
    let (partial, whole) = (rgb(&folder, "a.ppm"), rgb(&folder, "whole.ppm"));
    let mut done = [0; 2];
    for (y, x) in (0..480).step_by(16).flat_map(|y| (0..640).step_by(16).map(move |x| (y, x))) {
        let tile = |picture| imageops::crop_imm(picture, x, y, 16, 16).to_image();
        let is_done = tile(&partial) == tile(&whole);
        assert!(is_done || tile(&partial).pixels().all(|pixel| pixel.0 == [0; 3]), "the tile at {x} {y}");
        done[usize::from(is_done)] += 1;
    }
    assert!(done[0] > 0 && done[1] > 0, "{done:?}");
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
fn a_resumed_render_without_a_checkpoint_begins_anew_and_says_so() {
    let folder = workplace();
    let (status, _, err) = render(&folder, &["hall.ray", "--quick", "-o", "a.png", "--resume"]);
    assert_eq!(status, 0);
    let said =
        "there is no a.png.checkpoint to continue from: the render starts from the beginning\nwrote a.png (";
    assert!(err.starts_with(said), "{err}");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

/// A checkpoint may hold hours of work, which a look at a smaller image must not discard.
#[test]
fn a_checkpoint_stays_where_it_is_not_asked_for() {
    let folder = workplace();
    stop_midway(&folder, &["hall.ray", "-o", "a.png"]);
    let checkpoint = bytes(&folder, "a.png.checkpoint");
    let (status, _, err) = render(&folder, &["hall.ray", "--quick", "-o", "a.png"]);
    assert_eq!(status, 0);
    let said = "a.png.checkpoint exists: with `--resume` the render would continue from it\nwrote a.png (";
    assert!(err.starts_with(said), "{err}");
    assert!(bytes(&folder, "a.png.checkpoint") == checkpoint);
}

#[test]
fn a_link_stays_a_link_when_a_render_stops() {
    let folder = workplace();
    let link = folder.path().join("a.png");
    fs::create_dir(folder.path().join("pictures")).expect("a folder");
    symlink("pictures/b.png", &link).expect("a link");
    fs::write(folder.path().join("pictures/b.png"), "old").expect("a file");
    stop_midway(&folder, &["hall.ray", "--samples", "16", "-o", "a.png"]);
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray", "pictures"]);
    assert!(rgba(&folder, "pictures/b.png").pixels().any(|pixel| pixel.0[3] == 255));
    is_checkpoint(&folder, "a.png.checkpoint");
}
