//! Films: frames with values that change.

use super::parts::{damage, run, succeeds};
use crate::common::program::{folder, names_in, scene};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

#[test]
fn frames_have_values_that_change_and_names_by_their_numbers() {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    let text = fs::read_to_string(folder.path().join("a.ray")).expect("a scene");
    let ball =
        text.split("\nsphere ").nth(1).and_then(|rest| rest.split_whitespace().next()).expect("a sphere");
    let sweep = format!("{ball}.radius=0.5..1.5");
    let film = ["render", "a.ray", "-o", "film.png", "--size", "40", "--frames", "8..12", "--sweep", &sweep];
    succeeds(&folder, &[&film[..], &["--part", "2/2"]].concat());
    let frames = |numbers: &[u32]| numbers.iter().map(|n| format!("film-{n:04}.png")).collect::<Vec<_>>();
    assert_eq!(names_in(folder.path())[1..], frames(&[9, 11]));
    succeeds(&folder, &[&film[..], &["--part", "1/2"]].concat());
    let read = |name: &str| fs::read(folder.path().join(name)).expect(name);
    for (number, t) in [(8, 0.0), (9, 0.25), (12, 1.0)] {
        let radius = format!("{ball}.radius={}", 0.5 + t);
        succeeds(&folder, &["render", "a.ray", "-o", "one.png", "--size", "40", "--set", &radius]);
        assert!(read("one.png") == read(&format!("film-{number:04}.png")), "frame {number}");
    }
    let formula = format!("{ball}.radius=\"1.5 - t\"");
    let back = [&film[..8], &["--sweep", &formula, "--frame", "11"]].concat();
    for part in ["1/2", "2/2"] {
        succeeds(&folder, &[&back[..], &["--part", part]].concat());
    }
    succeeds(&folder, &["merge", "film-0011.png", "--remove-parts"]);
    // The files say with which options they were made, which differ.
    let pixels = |name: &str| image::open(folder.path().join(name)).expect("an image").into_rgb8();
    assert!(pixels("film-0009.png") == pixels("film-0011.png"), "the way back is the same");
    succeeds(&folder, &["film", "film.png", "--sheet", "sheet.png", "--animation", "film.apng"]);
    let sheet = image::open(folder.path().join("sheet.png")).expect("an image");
    assert_eq!((sheet.width(), sheet.height()), (3 * 192, 2 * 144));
    let decoder = png::Decoder::new(
        fs::File::open(folder.path().join("film.apng")).map(std::io::BufReader::new).expect("a file"),
    );
    assert_eq!(
        decoder.read_info().expect("a PNG").info().animation_control.map(|all| all.num_frames),
        Some(5)
    );
    let frame = fs::read(folder.path().join("film-0008.png")).expect("a frame");
    for option in ["--sheet", "--animation"] {
        let (status, said) = run(&folder, &["film", "film.png", option, "./film-0008.png"]);
        assert!(
            status == 2 && said.contains("`film-0008.png` is a frame, which would be replaced"),
            "{said}"
        );
    }
    assert_eq!(fs::read(folder.path().join("film-0008.png")).expect("still there"), frame);
    for args in [&["--animation", "a.ray"][..], &["--animation", "b.ppm"], &["--sheet", "a.ray"]] {
        let scene = fs::read(folder.path().join("a.ray")).expect("the scene");
        let (status, said) = run(&folder, &[&["film", "film.png"], args].concat());
        assert!(status == 2 && said.contains(" = help: end "), "{said}");
        assert_eq!(fs::read(folder.path().join("a.ray")).expect("still there"), scene);
    }
    let (status, said) = run(&folder, &["film", "film.png"]);
    assert!(status == 2 && said.contains("--sheet <FILE>|--animation <FILE>"), "{said}");
    let (status, said) = run(&folder, &["film", "film.png", "--sheet", "a.png", "--animation", "a.png"]);
    assert!(status == 2 && said.contains("cannot both be `a.png`"), "{said}");
    // With its range, a film is known to be without its ends.
    for (range, missing) in [("8..13", Some(13)), ("6..12", Some(6)), ("8..12", None), ("9..11", None)] {
        let (status, said) = run(&folder, &["film", "film.png", "--sheet", "sheet.png", "--frames", range]);
        match missing {
            Some(missing) => assert!(
                status == 2 && said.contains(&format!("frame {missing} of `film.png` is missing")),
                "{said}"
            ),
            None => assert_eq!(status, 0, "{range}: {said}"),
        }
    }
    fs::remove_file(folder.path().join("film-0010.png")).expect("a frame");
    let (status, said) = run(&folder, &["film", "film.png", "--sheet", "sheet.png"]);
    assert!(status == 2 && said.contains("frame 10 of `film.png` is missing"), "{said}");
    for (options, says) in [
        (&["--frames", "9..2"][..], "give the first and the last frame as `1..240`"),
        (&["--frames", "1..9", "--frame", "10"], "there is no frame 10"),
        (&["--frames", "1..9", "-o", "-"], "and writes files"),
        (&["--sweep", "a.b=1"], "--frames"),
    ] {
        let (status, said) = run(&folder, &[&["render", "a.ray"], options].concat());
        assert!(status == 2 && said.contains(says), "{options:?}: {said}");
    }
}

#[test]
fn the_warnings_of_a_film_are_told_once_and_where_they_change() {
    let folder = folder();
    let text = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }
sphere s { material m center 4 3 -2 radius 1.9 }\n";
    fs::write(folder.path().join("a.ray"), text).expect("a scene");
    // From the third frame on the ball is behind the viewer.
    let film = ["render", "a.ray", "-o", "film.png", "--frames", "1..5", "--sweep", "s.center=4 3 -2..18"];
    let said = succeeds(&folder, &[&film[..], &["--resume"]].concat());
    assert_eq!(said.matches("warning").count(), 1, "{said}");
    assert!(!said.contains("checkpoint"), "{said}");
    let third = said.find("film-0003.png").expect("a frame");
    assert!(
        said.find("film-0002.png") < said.find("warning") && said.find("warning") < Some(third),
        "{said}"
    );
}

#[test]
fn a_film_that_ends_beyond_what_a_scene_allows_is_not_begun() {
    let folder = folder();
    let text = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }
sphere s { material m center 4 3 -2 radius 1 }\n";
    fs::write(folder.path().join("a.ray"), text).expect("a scene");
    let film = ["render", "a.ray", "-o", "film.png", "--frames", "1..5", "--sweep", "s.radius=1..-1"];
    let (status, said) = run(&folder, &film);
    assert!(status == 2 && said.contains("`radius` of sphere `s` must be positive, not -1"), "{said}");
    assert!(said.contains("--> --sweep s.radius=1..-1:1:10\n"), "{said}");
    for (range, says) in [("1e-400..1", "`1e-400` is too small"), ("1..2e400", "`2e400` is too large")] {
        let sweep = format!("s.radius={range}");
        let (status, said) = run(&folder, &[&film[..6], &["--sweep", &sweep]].concat());
        assert!(
            status == 2 && said.contains(says) && said.contains(&format!("--> --sweep {sweep}:1:10")),
            "{said}"
        );
    }
    assert_eq!(names_in(folder.path()), ["a.ray"]);
    let film = [
        "render",
        "a.ray",
        "-o",
        "film.png",
        "--frames",
        "1..5",
        "--set",
        "s.radius=2",
        "--set",
        "s.center=4 3 -2",
    ];
    let sweeps = ["--sweep", "s.radius=1..2", "--sweep", "s.center=\"9*t\" 3 \"2*u\""];
    let (status, said) = run(&folder, &[&film[..], &sweeps].concat());
    assert!(status == 2 && said.contains("--> --sweep s.center=\"9*t\" 3 \"2*u\":1:"), "{said}");
    let (status, said) = run(&folder, &[&film[..8], &["--set", "s.center=4 3 x"], &sweeps[..2]].concat());
    assert!(status == 2 && said.contains("--> --set:2:14\n"), "{said}");
}

#[test]
fn a_film_of_which_a_file_would_replace_a_texture_is_not_begun() {
    let folder = folder();
    let text = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }
texture t { filename film-0003.ppm }
texplane p { material m normal 0 0 1 point 0 0 -1 dimensions 3 3 texname t xdir 1 0 0 mode 0 }\n";
    fs::write(folder.path().join("a.ray"), text).expect("a scene");
    fs::write(folder.path().join("film-0003.ppm"), b"P6 1 1 255\n\xff\x80\x40").expect("a picture");
    let (status, said) = run(&folder, &["render", "a.ray", "-o", "film.ppm", "--frames", "1..5"]);
    assert!(status == 2 && said.contains("`film-0003.ppm` is the image of texture `t`"), "{said}");
    assert_eq!(names_in(folder.path()), ["a.ray", "film-0003.ppm"]);
    for (name, options) in [
        ("film-0004-depth.ppm", &["--aov", "depth"][..]),
        ("film-0002.ppm.checkpoint", &[]),
        ("film-0004.ppm.checkpoint", &["--part", "1/3"]),
    ] {
        let folder = self::folder();
        fs::write(folder.path().join("a.ray"), text.replace("film-0003.ppm", name)).expect("a scene");
        fs::write(folder.path().join(name), b"P6 1 1 255\n\xff\x80\x40").expect("a picture");
        let film = ["render", "a.ray", "-o", "film.ppm", "--frames", "1..5"];
        let (status, said) = run(&folder, &[&film[..], options].concat());
        assert!(status == 2 && said.contains(&format!("`{name}` is the image of texture `t`")), "{said}");
        assert_eq!(names_in(folder.path()), ["a.ray", name]);
    }
}

/// Changes when a file was changed last.
fn date(path: &Path, seconds_ago: u64) {
    let file = fs::File::options().write(true).open(path).expect("a file");
    file.set_modified(SystemTime::now() - Duration::from_secs(seconds_ago)).expect("a time");
}

#[test]
fn a_frame_that_is_there_is_not_rendered_again() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    let text = "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
include materials.ray
texture t { filename picture }
texplane p { material m normal 0 0 1 point 0 0 -1 dimensions 3 3 texname t xdir 1 0 0 mode 0 }
";
    fs::write(place("a.ray"), text).expect("a scene");
    let materials =
        |green: &str| fs::write(place("materials.ray"), format!("material m {{ ambient 1 {green} 1 }}\n"));
    materials("1").expect("a scene");
    fs::write(place("picture"), b"P6 1 1 255\n\xff\x80\x40").expect("a picture");
    ["materials.ray", "picture"].iter().for_each(|name| date(&place(name), 60));
    let film = ["render", "a.ray", "-o", "film.png", "--frames", "1..5", "--sweep", "m.ambient=0..1 1 1"];
    let names: Vec<_> = (1..=5).map(|number| format!("film-{number:04}.png")).collect();
    let resumes = |options: &[&str]| {
        let said = succeeds(&folder, &[&film[..], &["--resume"], options].concat());
        let is_there = |name: &&String| said.contains(&format!("{name} exists already"));
        names.iter().filter(is_there).cloned().collect::<Vec<_>>()
    };
    let read = || names.iter().map(|name| fs::read(place(name)).expect("a frame")).collect::<Vec<_>>();
    succeeds(&folder, &film);
    let first = read();
    assert_eq!(resumes(&[]), names);
    damage(&place(&names[1]), |len| len - 30);
    fs::write(place(&names[2]), &first[2][..first[2].len() - 8]).expect("a frame");
    fs::write(place(&names[3]), &first[4]).expect("a frame");
    fs::remove_file(place(&names[4])).expect("a frame");
    assert_eq!(resumes(&[]), names[..1]);
    assert!(read() == first, "the frames are as before");
    assert_eq!(resumes(&[]), names);
    // Images beside a frame are not known to be of it.
    assert!(resumes(&["--aov", "depth"]).is_empty());
    assert!(resumes(&["--size", "20", "--force"]).is_empty());
    assert!(resumes(&[]).is_empty());
    assert!(read() == first, "the frames are as before");
    fs::write(place("picture"), b"P6 1 1 255\n\x10\x80\x40").expect("a picture");
    date(&place("picture"), 0);
    assert!(resumes(&[]).is_empty());
    assert!(read() != first, "the texture has changed");
    fs::write(place("picture"), b"P6 1 1 255\n\xff\x80\x40").expect("a picture");
    assert!(resumes(&[]).is_empty());
    materials("0.5").expect("a scene");
    assert!(resumes(&[]).is_empty());
}
