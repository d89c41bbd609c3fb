//! The course's own scenes: their images, pixel by pixel, and their dumps, byte by byte.
//!
//! They are not part of this project. Where `../shared/conformance` is absent these tests say so and pass.

mod common;

use assert_cmd::cargo::cargo_bin_cmd;
use common::{course, model, model_in, render};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::Path;
use tabray::geometry::{MISS, Ray, Sight};
use tabray::render::{Event, Plan, TraceObserver, trace};
use tabray::scene::{Model, Profile};
use tabray::world::certify::{Enclosure, Precision};

/// A scene, and the percentage of its pixels that must be right to 1 of 255 levels in every channel. Below 100, the
/// difference is due to the instructor's program: hit points overwritten by shadow rays, 80-bit arithmetic at edges, an
/// older shadow, and a cone's slope that is twice too steep.
const SCENES: [(&str, f64); 19] = [
    ("fplane/fplane1", 100.0),
    ("fplane/fplane3", 100.0),
    ("fplane/fplane4", 99.98),
    ("glint/shiny", 100.0),
    ("glint/shiny2", 100.0),
    ("proj/proj3", 100.0),
    ("revsurf/revsurfa", 70.0),
    ("revsurf/revsurff", 100.0),
    ("spec/spec0", 100.0),
    ("spec/spec1", 99.98),
    ("spec/spec3", 99.97),
    ("spec/spec5", 99.97),
    ("spec/spec8", 99.61),
    ("spotlight/spotlight", 100.0),
    ("texplane/texplane2", 99.96),
    ("tplane/tplane4", 100.0),
    ("trans/translucent", 62.19),
    ("trans/translucent3", 100.0),
    ("trans/translucent5", 100.0),
];

/// The scenes that were rendered with 16 random samples per pixel.
const SMOOTHED: [&str; 2] = ["aa/aademo", "aa/aademo2"];

// The instructor's cone: its slope is twice the right one, which makes the flank too dark.
inventory::submit! {
    Profile::new("doubled_cone", "the course's cone, mistake and all", "-4/6 * (y - 6)").slope("-8/6")
}

/// Renders a scene with the program.
fn rendered(scene: &Path, options: &[&str]) -> RgbImage {
    let run =
        cargo_bin_cmd!("tabray").arg("render").arg(scene).args(["-o", "-"]).args(options).assert().success();
    image::load_from_memory(&run.get_output().stdout).expect("a PPM").into_rgb8()
}

/// Returns the course's own image of a scene.
fn expected(scene: &Path) -> RgbImage {
    image::open(scene.with_extension("png")).expect("the course's picture").into_rgb8()
}

/// Returns the greatest difference of a channel of two pixels, in levels.
fn difference(a: &Rgb<u8>, b: &Rgb<u8>) -> u8 {
    (0..3).map(|channel| a[channel].abs_diff(b[channel])).max().unwrap_or(0)
}

/// Returns the percentage of pixels that are right to 1 of 255 levels in every channel.
fn percent_near(actual: &RgbImage, expected: &RgbImage) -> f64 {
    assert_eq!(actual.dimensions(), expected.dimensions());
    let near = actual.pixels().zip(expected.pixels()).filter(|(a, b)| difference(a, b) <= 1).count();
    100.0 * near as f64 / expected.pixels().len() as f64
}

#[test]
fn the_courses_pictures_come_out_the_same() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    let mut short = Vec::new();
    for (scene, percent) in SCENES {
        let path = folder.join(scene);
        let got =
            percent_near(&rendered(&path.with_extension("txt"), &["--method", "classic"]), &expected(&path));
        eprintln!("{scene:20} {got:8.4} % of its pixels within 1, {percent} wanted");
        if got < percent {
            short.push(scene);
        }
    }
    assert!(short.is_empty(), "too many pixels differ in {short:?}");
}

#[test]
fn the_classic_method_says_why_the_default_and_the_courses_picture_differ() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    let default = "this is the course's own method; the default, exact, differs at ";
    let course = "the course's own image may differ at ";
    let lost = "silhouettes that the course's method loses";
    let (wall, older) = ("its far wall tints once more", "an older program of the course divided");
    let (edge, shifted) = ("rays exactly through an edge or between two texels", "highlights in mirrors");
    let told: [(&str, &[&str], &[&str]); 10] = [
        ("fplane/fplane4", &[], &[edge]),
        ("spec/spec1", &[], &[edge]),
        ("spec/spec3", &[], &[shifted, edge]),
        ("spec/spec5", &[], &[shifted, edge]),
        ("spec/spec8", &[], &[shifted, edge]),
        ("texplane/texplane2", &[], &[edge]),
        ("revsurf/revsurfa", &[lost], &["the slope of the cone"]),
        ("revsurf/revsurff", &[lost], &[]),
        ("trans/translucent", &[wall], &[older]),
        // Nothing in a scene tells which program made its picture.
        ("trans/translucent3", &[], &[older]),
    ];
    let target = tempfile::TempDir::new().expect("a folder");
    let image = target.path().join("course.png");
    for scene in SCENES.map(|(scene, _)| scene).into_iter().filter(|scene| *scene != "trans/translucent5") {
        let path = folder.join(scene).with_extension("txt");
        let run = ["render", "--method", "classic", "-o"];
        let run = cargo_bin_cmd!("tabray").args(run).arg(&image).arg(path).assert().success();
        let said = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        let reasons =
            |beginning: &str| said.lines().find_map(|line| line.strip_prefix(beginning)).unwrap_or("");
        let known = told.iter().find(|(name, ..)| *name == scene);
        let (of_default, of_course) = known.map_or((&[][..], &[][..]), |(_, one, other)| (*one, *other));
        for (reasons, expected) in [(reasons(default), of_default), (reasons(course), of_course)] {
            assert_eq!(reasons.matches(" (").count(), expected.len(), "{scene}: {said}");
            assert!(expected.iter().all(|reason| reasons.contains(reason)), "{scene}: {said}");
        }
    }
}

#[test]
fn the_courses_cone_is_all_explained_by_its_wrong_slope() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    let path = folder.join("revsurf/revsurfa");
    let text = fs::read_to_string(path.with_extension("txt")).expect("a scene");
    let actual = render(&model(
        &text.replace("surfer 1", "surfer doubled_cone").replace("pixeldim", "accuracy classic pixeldim"),
    ));
    assert_eq!(percent_near(&actual, &expected(&path)), 100.0);
}

/// An object that a ray was tested against, and its distance.
type Test = (usize, Option<f64>);

/// The searches of a pixel: each ray with its tests.
#[derive(Default)]
struct Searches(Vec<(Ray, Vec<Test>)>);

impl TraceObserver for Searches {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match (event, self.0.last_mut()) {
            (Event::Search(ray), _) => self.0.push((*ray, Vec::new())),
            (Event::Tested(index, distance), Some((_, tests))) => tests.push((index, distance)),
            _ => {}
        }
    }
}

fn searches(model: &Model, x: usize, y: usize) -> Searches {
    let mut searches = Searches::default();
    trace::observe_pixel(&Plan::new(model), x, y, &mut searches);
    searches
}

/// Tells whether two methods differ at a surface of revolution, at an edge that rounding hides, or where a ray leaves a
/// surface: there it hits the far wall of a sphere that it enters, and leaves what lies at its origin.
fn is_explained(classic: &Model, exact: &Model, x: usize, y: usize) -> bool {
    let (a, b) = (searches(classic, x, y), searches(exact, x, y));
    for ((ray, old), (_, new)) in a.0.iter().zip(&b.0) {
        for ((index, old), (_, new)) in old.iter().zip(new) {
            let object = &exact.objects[*index];
            let is_same = match (old, new) {
                (Some(MISS), None) | (None, Some(MISS)) => true,
                (Some(_), None) => return true,
                (None, Some(_)) if object.args.entity().name == "sphere" => return true,
                (Some(old), Some(new)) => old == new || (old - new).abs() <= 1e-12 * old.abs().min(new.abs()),
                (old, new) => old == new,
            };
            if !is_same {
                let proven = object.shape.certify(&Sight::along(ray), Precision::Double);
                let is_doubtful = matches!(proven, Enclosure::Edge(_) | Enclosure::Doubtful(_));
                return object.args.entity().name == "revsurf" || is_doubtful;
            }
        }
    }
    false
}

#[test]
fn the_exact_method_differs_only_where_it_should() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    for (scene, _) in SCENES {
        let path = folder.join(scene).with_extension("txt");
        let text = fs::read_to_string(&path).expect("a scene");
        let read = |text: &str| model_in(path.parent().expect("a folder"), text);
        let (exact, classic) = (read(&text), read(&text.replace("pixeldim", "accuracy classic pixeldim")));
        let (a, b) = (render(&classic), render(&exact));
        let mut differing = 0;
        for (x, row, pixel) in a.enumerate_pixels() {
            if pixel != b.get_pixel(x, row) {
                differing += 1;
                let (x, y) = (x as usize, (a.height() - 1 - row) as usize);
                assert!(is_explained(&classic, &exact, x, y), "{scene} differs at {x} {y}");
            }
        }
        eprintln!("{scene:20} {differing} pixels differ from the notes' method, all of them explained");
        // A glass sphere has two walls.
        let may_differ = scene.contains("revsurf") || scene == "trans/translucent";
        assert!(differing == 0 || may_differ || differing < 100, "{scene}: {differing}");
    }
}

#[test]
fn the_courses_smoothed_pictures_agree_but_for_chance() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    for scene in SMOOTHED {
        let path = folder.join(scene);
        let actual = rendered(
            &path.with_extension("txt"),
            &["--method", "classic", "--sampler", "random", "--samples", "16"],
        );
        let sharp = rendered(&path.with_extension("txt"), &["--method", "classic"]);
        let expected = expected(&path);
        let mean = |picture: &RgbImage, channel: usize| {
            let sum: u64 = picture.pixels().map(|pixel| u64::from(pixel[channel])).sum();
            sum as f64 / picture.pixels().len() as f64
        };
        for channel in 0..3 {
            let apart = (mean(&actual, channel) - mean(&expected, channel)).abs();
            eprintln!("{scene:20} {apart:.4} of 255 apart in the mean of channel {channel}, 0.1 allowed");
            assert!(apart <= 0.1, "{scene}");
        }
        let (width, height) = sharp.dimensions();
        let is_edge = |x: u32, y: u32| {
            let around = |x: u32, size: u32| x.saturating_sub(1)..=(x + 1).min(size - 1);
            let here = sharp.get_pixel(x, y);
            around(x, width).any(|x| around(y, height).any(|y| difference(here, sharp.get_pixel(x, y)) > 20))
        };
        let off_edges = actual.enumerate_pixels().filter(|(x, y, _)| !is_edge(*x, *y));
        let worst = off_edges.map(|(x, y, pixel)| difference(pixel, expected.get_pixel(x, y))).max();
        eprintln!("{scene:20} {worst:?} of 255 apart away from edges, 12 allowed");
        assert!(worst <= Some(12), "{scene}");
    }
}

#[test]
fn the_courses_dumps_come_out_the_same() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    for scene in SCENES.map(|(scene, _)| scene).into_iter().chain(SMOOTHED) {
        let path = folder.join(scene);
        let run = cargo_bin_cmd!("tabray").arg("dump").arg(path.with_extension("txt")).assert().success();
        let actual = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
        let expected = fs::read_to_string(path.with_extension("log")).expect("the course's dump");
        assert!(actual == expected, "{scene} dumps\n{actual}\nnot\n{expected}");
    }
}

#[test]
fn the_notes_program_logs_the_dump_and_nothing_else() {
    let Some(folder) = course("conformance", "the course's scenes") else { return };
    for scene in SCENES.map(|(scene, _)| scene).into_iter().chain(SMOOTHED) {
        let path = folder.join(scene);
        let text = fs::read(path.with_extension("txt")).expect("a scene");
        let folder = path.parent().expect("a folder");
        let run = cargo_bin_cmd!("tabray").current_dir(folder).write_stdin(text).assert().success();
        let expected = fs::read(path.with_extension("log")).expect("the course's dump");
        let logged = String::from_utf8_lossy(&run.get_output().stderr);
        assert!(run.get_output().stderr == expected, "{scene} logs\n{logged}");
    }
}
