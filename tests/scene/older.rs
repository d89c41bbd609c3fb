//! Older scenes of the course, which consist of numbers: which texts are taken for one, and what becomes of them.

use crate::common::program::{folder, outcome, tabray};
use crate::common::{course, model, registry, render};
use image::RgbImage;
use std::fs;
use std::path::Path;
use tabray::scene::{self, Loaded, Report, Severity, dump};
use tabray::world::Accuracy;

const BALL: &str = "8 6\n0 0 3\n13 ball\n1 0 0\n2 1 1\n.2 .2 .3\n.5 -1 -4\n1.5\n10 lamp\n6 6 6\n0 5 0\n";

fn read(text: &str) -> Result<Loaded, Report> {
    scene::read(registry(), "old.txt", Path::new(""), text.as_bytes(), None)
}

/// Returns the messages about a text, one on each line.
fn told(text: &str) -> String {
    read(text).map_or_else(|report| report.short(), |loaded| loaded.warnings.short())
}

#[test]
fn an_older_scene_is_the_same_as_one_in_words() {
    let words = "camera c { pixeldim 400 300 worlddim 8 6 viewpoint 4 3 3 }
        material m0 { ambient 1 0 0 diffuse 2 1 1 specular .2 .2 .3 }
        sphere o1 { material m0 center 4.5 2 -4 radius 1.5 }
        light o2 { emissivity 6 6 6 location 4 8 0 }";
    let older = read(BALL).map_err(|report| report.to_string()).expect("a scene");
    assert_eq!(told(BALL), "");
    assert_eq!(
        dump::scene(&older.model, tabray::scene::Syntax::Notes),
        dump::scene(&model(words), tabray::scene::Syntax::Notes)
    );
}

#[test]
fn comments_blank_lines_and_line_ends_change_nothing() {
    let plain = read(BALL).map_err(|report| report.to_string()).expect("a scene").model;
    let commented = BALL.replace('\n', "\t 1 2 { comment } include x\r\n\r\n \t");
    // A number right after a code would be an index.
    let commented = commented.replace("13 ball\t 1 2", "13 ball");
    for text in
        [&commented, &BALL.replace('\n', "\r"), &format!("A title.\n{BALL}"), &format!("\u{feff}{BALL}")]
    {
        let other = read(text).map_err(|report| report.to_string()).expect("a scene").model;
        assert_eq!(dump::notes(&other), dump::notes(&plain), "{text}");
    }
}

#[test]
fn no_other_text_is_taken_for_one() {
    for text in [
        "10 eye\n160 120\n8 6\n4 3 6\n11 grey\n2 2 2\n13 ball\n4 3 -4 1\n",
        "1 2 3\n4 5 6\n7 8 9\n",
        "8 6\n0 0 3\n",
        "8 6\n0 0 3\n13\n1 1 1\n1 1 1\n0 0 0\n0 0 -3\n1\nsphere b { radius 2 }\n",
        "13\n",
        "",
    ] {
        let told = told(text);
        assert!(!told.contains("of this") && !told.contains("fragment"), "{text}: {told}");
        assert!(read(text).is_err(), "{text}");
    }
}

#[test]
fn messages_count_lines_and_numbers() {
    let of = |from: &str, to: &str| told(&BALL.replace(from, to));
    let begins = |told: String, expected: &str| {
        assert!(told.lines().any(|line| line.starts_with(expected)), "{told}");
    };
    begins(
        of(".5 -1 -4", ".5 -1"),
        "old.txt:7:1: error: the centre of this sphere has 3 numbers, not 2: the third",
    );
    begins(of("1.5\n", "-1.5\n"), "old.txt:8:1: error: the radius of this sphere must be positive, not -1.5");
    begins(of("0 0 3", "0 0 0"), "old.txt:2:5: error: the viewpoint of this scene must be off the screen");
    begins(of("8 6", "8 0"), "old.txt:1:3: error: the second number of the world size of this scene must be");
    begins(of("1.5\n", "1,5\n"), "old.txt:8:1: error: this is not one number");
    begins(
        of(".5 -1 -4\n1.5\n", ""),
        "old.txt:7:1: error: the centre of this sphere is missing: another object",
    );
    begins(
        of("0 5 0\n", ""),
        "old.txt:11:1: error: the location of this light is missing: the text ends here",
    );
    begins(
        of("13 ball", "43 ball"),
        "old.txt:3:1: warning: this line begins with no known code, and is skipped",
    );
    begins(
        of("13 ball", "13 ball\nred"),
        "old.txt:4:1: warning: this line begins with no number, and is skipped",
    );
    begins(of("13 ball", "18 ball"), "old.txt:3:1: error: 18 stands in the headers");
    begins(of("8 6\n0 0 3\n", ""), "old.txt:1:1: warning: this scene is a fragment");
}

#[test]
fn values_are_set_and_scenes_converted_as_others() {
    let folder = folder();
    fs::write(folder.path().join("old.txt"), BALL).expect("a file");
    for copy in ["new.ray", "new.toml"] {
        let (status, _, err) = outcome(tabray(&folder).args(["convert", "old.txt", copy]));
        assert_eq!(status, 0, "{err}");
        let of = |scene: &str| {
            let sets = ["--set", "o1.radius=2", "--size", "80", "--method", "classic", "-o", "-"];
            let run = tabray(&folder).args(["render", scene]).args(sets).output().expect("a run");
            assert!(run.status.success(), "{scene}");
            run.stdout
        };
        assert!(of("old.txt") == of(copy), "{copy}");
    }
    let (status, _, err) = outcome(tabray(&folder).args(["fmt", "old.txt"]));
    assert_eq!(status, 2);
    assert!(err.contains("this is an older scene of numbers"), "{err}");
    assert_eq!(fs::read_to_string(folder.path().join("old.txt")).expect("still there"), BALL);
}

/// How many columns to the right and how many rows down a program drew what it saw.
const AS_IS: [u32; 2] = [0, 0];
const RIGHT: [u32; 2] = [1, 0];
const DOWN: [u32; 2] = [0, 1];

/// The scenes that agree with the picture of a program, but for its shift. Left out are those with shaders of a program's
/// own.
const PICTURES: [(&str, [u32; 2]); 28] = [
    ("behind-3", DOWN),
    ("finite-1", DOWN),
    ("finite-3", DOWN),
    ("finite-6", DOWN),
    ("finite-9", DOWN),
    ("lights-1", RIGHT),
    ("lights-3", DOWN),
    ("lights-6", DOWN),
    ("lights-9", DOWN),
    ("mirror-1", AS_IS),
    ("mirror-3", RIGHT),
    ("mirror-tiled-1", DOWN),
    ("mirror-tiled-3", AS_IS),
    ("mirror-tiled-6", RIGHT),
    ("planes-1", DOWN),
    ("planes-12", DOWN),
    ("planes-15", DOWN),
    ("planes-18", DOWN),
    ("planes-21", DOWN),
    ("planes-3", AS_IS),
    ("planes-6", DOWN),
    ("planes-9", DOWN),
    ("procedural-12", DOWN),
    ("refraction-1", DOWN),
    ("refraction-3", DOWN),
    ("spheres-1", DOWN),
    ("spot-1", RIGHT),
    ("tiled-1", DOWN),
];

fn load(path: &Path) -> Result<Loaded, Report> {
    let bytes = fs::read(path).expect("a scene");
    let folder = path.parent().expect("a folder");
    scene::read(registry(), &path.display().to_string(), folder, &bytes, Some(Accuracy::Classic))
}

/// Returns the percentage of pixels that are right to 1 of 255 levels in every channel, of those that both images have.
fn percent_near(actual: &RgbImage, expected: &RgbImage, [columns, rows]: [u32; 2]) -> f64 {
    let (width, height) = actual.dimensions();
    assert_eq!(expected.dimensions(), (width, height));
    let near = |(x, y): &(u32, u32)| {
        let (one, other) = (actual.get_pixel(*x, *y), expected.get_pixel(x + columns, y + rows));
        (0..3).all(|channel| one[channel].abs_diff(other[channel]) <= 1)
    };
    let all: Vec<_> = (0..height - rows).flat_map(|y| (0..width - columns).map(move |x| (x, y))).collect();
    100.0 * all.iter().filter(|at| near(at)).count() as f64 / all.len() as f64
}

#[test]
fn the_courses_older_scenes_look_as_their_programs_drew_them() {
    let Some(folder) = course("dialect", "the course's older scenes") else { return };
    let mut wrong = Vec::new();
    for (name, shift) in PICTURES {
        let expected =
            image::open(folder.join("pictures").join(name).with_extension("png")).expect("a picture");
        let expected = expected.into_rgb8();
        let mut model = match load(&folder.join("scenes").join(name).with_extension("txt")) {
            Ok(loaded) => loaded.model,
            Err(report) => panic!("{report}"),
        };
        model.camera.value.pixels = [expected.width() as usize, expected.height() as usize];
        let percent = percent_near(&render(&model), &expected, shift);
        if percent < 99.0 {
            wrong.push(format!("{name}: {percent:.2} %"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn the_courses_older_scenes_load_but_for_another_numbering() {
    let Some(folder) = course("dialect", "the course's older scenes") else { return };
    let mut refused = Vec::new();
    for entry in fs::read_dir(folder.join("scenes")).expect("the scenes") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "txt")
            && let Err(report) = load(&path)
        {
            assert!(report.count(Severity::Error) > 0);
            refused.push(format!("{}: {}", path.file_stem().expect("a name").display(), report.short()));
        }
    }
    assert_eq!(refused.len(), 1, "{refused:?}");
    assert!(refused[0].starts_with("other-numbering-1: "), "{refused:?}");
    assert!(refused[0].contains("this scene has a different numbering, which is not read"), "{refused:?}");
}
