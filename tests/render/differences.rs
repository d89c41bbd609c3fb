//! Checks of the differences that `docs/course.md` lists: each has a scene in `docs/data/differences` that loads, and what
//! the page says about it is true.

use crate::common::program::{folder, outcome, tabray};
use crate::common::{registry, render, root};
use glam::{DVec3, dvec3};
use image::{Rgb, RgbImage};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tabray::geometry::{MISS, RayRange};
use tabray::render::{Plan, trace};
use tabray::scene::{self, Loaded, Model, Report, dump};
use tabray::tools::debug::{self, LogLine};
use tabray::world::Accuracy::{self, Classic, Exact};
use tabray::world::SurfacePoint;
use tabray::world::material::Reflectivity;

/// The scene of a difference.
#[derive(Clone)]
struct Scene(String);

impl Scene {
    fn read(&self, accuracy: Option<Accuracy>) -> Result<Loaded, Report> {
        scene::read(registry(), "scene", &root().join("docs/data/differences"), self.0.as_bytes(), accuracy)
    }

    fn model(&self, accuracy: Accuracy) -> Model {
        self.read(Some(accuracy)).unwrap_or_else(|report| panic!("{report}")).model
    }

    fn picture(&self, accuracy: Accuracy) -> RgbImage {
        render(&self.model(accuracy))
    }

    /// Returns the colour of the only pixel, before it becomes bytes.
    fn colour(&self, accuracy: Accuracy) -> DVec3 {
        trace::pixel(&Plan::new(&self.model(accuracy)), 0, 0)
    }

    /// Returns the distance of the first pixel's first hit.
    fn distance(&self, accuracy: Accuracy) -> f64 {
        let model = self.model(accuracy);
        let hit = trace::first_hit(&Plan::new(&model), &model.camera.value.sight(0.0, 0.0));
        hit.map_or(MISS, |hit| hit.distance)
    }

    /// Returns the number of pixels that are not black.
    fn lit(&self, accuracy: Accuracy) -> usize {
        self.picture(accuracy).pixels().filter(|pixel| is_lit(pixel)).count()
    }

    /// Replaces a part of the scene.
    fn with(&self, old: &str, new: &str) -> Self {
        assert!(self.0.contains(old), "{old} is not in {}", self.0);
        Self(self.0.replace(old, new))
    }

    /// Removes the line of an entity.
    fn without(&self, entity: &str) -> Self {
        let lines: Vec<_> = self.0.lines().filter(|line| !line.starts_with(entity)).collect();
        assert_eq!(lines.len() + 1, self.0.lines().count(), "{entity}");
        Self(lines.join("\n"))
    }

    #[track_caller]
    fn is_refused(&self, message: &str) {
        let Err(report) = self.read(None) else { panic!("it loads: {}", self.0) };
        assert!(report.to_string().contains(message), "{report}");
    }
}

fn is_lit(pixel: &Rgb<u8>) -> bool {
    pixel.0 != [0; 3]
}

/// Returns the heading, the text and the scene of each difference.
fn differences() -> Vec<(String, String, Scene)> {
    let page = fs::read_to_string(root().join("docs/course.md")).expect("the page");
    let items = page.split("\n- [").skip(1).filter(|item| item.contains("](data/differences/"));
    items
        .map(|item| {
            let (heading, rest) = item.split_once("](").expect("a link");
            let (file, reason) = rest.split_once("): ").expect("a reason after the link");
            let reason = reason.split("\n\n").next().expect("a paragraph");
            let scene = fs::read_to_string(root().join("docs").join(file)).expect("a scene");
            (heading.to_owned(), reason.trim().to_owned(), Scene(scene))
        })
        .collect()
}

type Check = (&'static str, fn(Scene));

/// Runs all checks, so that one failure does not hide others.
fn hold(checks: &[Check]) {
    let mut wrong = Vec::new();
    for (heading, _, scene) in differences() {
        for (name, check) in checks.iter().filter(|(name, _)| *name == heading) {
            if catch_unwind(AssertUnwindSafe(|| check(scene.clone()))).is_err() {
                wrong.push(name);
            }
        }
    }
    assert!(wrong.is_empty(), "what docs/course.md says is not so: {wrong:?}");
}

#[test]
fn each_difference_has_a_reason_a_scene_and_a_check() {
    let mut headings = BTreeSet::new();
    for (heading, reason, scene) in differences() {
        assert!(reason.ends_with('.'), "{heading}: {reason}");
        for accuracy in [Classic, Exact] {
            scene.model(accuracy);
        }
        assert!(headings.insert(heading.clone()), "{heading} stands twice");
    }
    let scenes = fs::read_dir(root().join("docs/data/differences")).expect("the scenes");
    assert_eq!(scenes.count(), headings.len(), "each scene is linked");
    let checked = CHECKS.iter().chain(RAYS_THAT_GO_ON).map(|(heading, _)| (*heading).to_owned());
    assert_eq!(headings, checked.collect());
}

#[test]
fn what_the_page_says_is_so() {
    hold(CHECKS);
}

#[test]
fn what_the_page_says_of_rays_that_go_on_is_so() {
    hold(RAYS_THAT_GO_ON);
}

const CHECKS: &[Check] = &[
    ("Far walls", |scene| {
        let ellipsoid = scene.with("sphere", "ellipsoid").with("radius 9", "radius 9 scale 1 1 1");
        for scene in [scene, ellipsoid] {
            assert_eq!((scene.lit(Classic), scene.lit(Exact)), (0, 41 * 31));
        }
    }),
    ("Inner walls of surfaces of revolution", |scene| {
        assert_eq!((scene.lit(Classic), scene.lit(Exact)), (0, 41 * 31));
    }),
    ("Silhouettes of surfaces of revolution", |scene| {
        let (classic, exact) = (scene.picture(Classic), scene.picture(Exact));
        let lost = classic.pixels().zip(exact.pixels()).filter(|(old, new)| !is_lit(old) && is_lit(new));
        assert!(lost.count() > 10);
    }),
    ("Distances of surfaces of revolution", |scene| {
        assert!((scene.distance(Exact) - 8.0).abs() < 1e-14);
        let error = (scene.distance(Classic) - 8.0).abs();
        assert!((1e-7..=5e-5).contains(&error), "{error}");
    }),
    ("Beyond an apex", |scene| {
        let above = |accuracy| {
            let picture = scene.picture(accuracy);
            picture.enumerate_pixels().filter(|(_, row, pixel)| *row < 14 && is_lit(pixel)).count()
        };
        assert!(above(Classic) > 20);
        assert_eq!(above(Exact), 0);
    }),
    ("Distant spheres", |scene| {
        // The sphere is seen as a disc of radius 2 on an image plane of 8 by 6 units at the same distance.
        let disc = 40.0 * 30.0 * 4.0 * PI / 48.0;
        assert!((scene.lit(Exact) as f64 - disc).abs() < 0.05 * disc);
        assert!((scene.lit(Classic) as f64 - disc).abs() > 0.5 * disc);
    }),
    ("Planes far from the origin", |scene| {
        assert!((scene.distance(Exact) - 20.0).abs() < 1e-13);
        assert!((scene.distance(Classic) - 20.0).abs() > 1e-9);
    }),
    ("The side to which a normal points", |scene| {
        assert!(scene.lit(Exact) > 1000);
        assert_eq!(scene.lit(Classic), 0);
        let plane = "plane room { material grey normal 0 0 -1 point 0 0 -4 }\nlight";
        let plane = scene.without("sphere").with("light", plane);
        assert_eq!((plane.lit(Exact), plane.lit(Classic)), (0, 0));
    }),
    ("Shapes that shadow themselves", |scene| {
        let (classic, exact) = (scene.lit(Classic), scene.lit(Exact));
        assert!(exact + 100 < classic, "{exact} of {classic}");
    }),
    ("Where light ends", |scene| {
        for accuracy in [Classic, Exact] {
            let seen = scene.colour(accuracy);
            assert!(seen.abs_diff_eq(DVec3::splat(1.0 / 10.0 + 1.0 / 23.0), 1e-14), "{seen}");
        }
        let far = scene.with("point 0 0 -4", "point 0 0 -94");
        assert!(far.without("sphere").colour(Exact).abs_diff_eq(DVec3::splat(1.0 / 100.0), 1e-14));
    }),
    ("Highlights in mirrors", |scene| {
        // The lamps and the sphere are placed so that the image is its own mirror image, except for the sphere's
        // position.
        assert_eq!(scene.picture(Classic), scene.picture(Exact));
        let mirrored = scene.with("center 3", "center 5").picture(Exact);
        assert!(same(&image::imageops::flip_horizontal(&mirrored), &scene.picture(Exact)));
    }),
    ("The slope of the cone", |scene| {
        for accuracy in [Classic, Exact] {
            // The normal is (2x, -2 g g', 2z) at x = 0, y = 3 and z = 2 from the axis, where g = 2 and g' = -4/6.
            let normal = scene.model(accuracy).objects[0].shape.normal(dvec3(4.0, 3.0, -2.0));
            assert!(normal.abs_diff_eq(dvec3(0.0, 8.0 / 3.0, 4.0).normalize(), 1e-15), "{normal}");
        }
    }),
    ("Rays through edges", |scene| {
        for accuracy in [Classic, Exact] {
            let picture = scene.picture(accuracy);
            assert!((0..31).all(|row| is_lit(picture.get_pixel(0, row))));
            let beside = scene.with("point 0", "point 1e-9").picture(accuracy);
            assert!((0..31).all(|row| !is_lit(beside.get_pixel(0, row))));
        }
    }),
    ("Light through glass", |scene| {
        for accuracy in [Classic, Exact] {
            // The light is as far away with the pane as without it.
            let (behind, free) = (scene.colour(accuracy), scene.without("fplane").colour(accuracy));
            let cosine = 0.5_f64.sqrt();
            assert!(
                free.abs_diff_eq(DVec3::splat(5.0 * 20.0 * cosine / 32.0_f64.sqrt() / 14.0), 1e-14),
                "{free}"
            );
            assert!(behind.abs_diff_eq(0.5 * free, 1e-15), "{behind}");
        }
    }),
    ("Glass without a colour", |scene| {
        assert!(scene.colour(Exact).abs_diff_eq(DVec3::splat(0.5 * 9.0 / 12.0), 1e-14));
    }),
    ("A light on a surface", |scene| {
        assert_eq!(scene.colour(Exact), scene.without("light").colour(Exact));
    }),
    ("Distant tiles", |scene| {
        let model = scene.model(Exact);
        let ambient = |object: usize, at: DVec3| {
            let object = &model.objects[object];
            object.shader.colour_at(Reflectivity::Ambient, &object.material, &SurfacePoint::at(at))
        };
        // Both points are in tile 0 if numbers are truncated toward 0.
        for (object, left, right) in [(0, -500.25, -499.75), (1, -100_001.0, -99_999.0)] {
            assert_ne!(ambient(object, left * DVec3::X), ambient(object, right * DVec3::X));
        }
    }),
    ("The centre of a rainbow", |scene| {
        assert!(scene.colour(Exact).is_finite() && scene.lit(Exact) == 1);
    }),
    ("The far edge of a texture", |scene| {
        for accuracy in [Classic, Exact] {
            let picture = scene.picture(accuracy);
            assert!((0..31).all(|row| is_lit(picture.get_pixel(40, row))));
        }
    }),
    ("The third shader", |scene| {
        let colours: BTreeSet<_> = scene.picture(Exact).pixels().map(|pixel| pixel.0).collect();
        assert!(colours.len() > 100);
    }),
    ("Which vase", |scene| {
        assert!((scene.distance(Exact) - 8.5).abs() < 1e-14);
        let notes = scene.with("surfer 3", "surfer 0");
        assert!((notes.distance(Exact) - 7.0).abs() < 1e-14, "2 + sin(y)");
    }),
    ("Where the camera may be", |scene| {
        assert!(scene.lit(Exact) > 1000);
        assert!(scene.with("-3 9 0.5", "4 3 -6").lit(Exact) > 1000, "behind it, looking along +z");
        scene.with("-3 9 0.5", "4 3 0").is_refused("off the image plane (z other than 0)");
    }),
    ("In front of the image plane", |scene| {
        for accuracy in [Classic, Exact] {
            let picture = scene.picture(accuracy);
            let [_, green, _] = picture.get_pixel(20, 15).0;
            assert_eq!(green, 0, "the ball");
            assert_eq!(picture.get_pixel(0, 0).0[1], picture.get_pixel(0, 0).0[0], "the wall");
            let nearer = scene.with("0.005", "0.02").picture(accuracy);
            assert!(!is_lit(nearer.get_pixel(0, 0)) && is_lit(nearer.get_pixel(20, 15)));
        }
    }),
    ("Pixel positions", |scene| {
        assert_eq!(scene.lit(Exact), 1);
        let corners = scene.with("pixeldim 1 1", "pixeldim 2 2").model(Exact);
        let ray = corners.camera.value.ray(1.0, 1.0);
        assert!(ray.at(-ray.origin.z / ray.dir.z).abs_diff_eq(dvec3(8.0, 6.0, 0.0), 1e-14));
    }),
    ("Samples", |scene| {
        let picture = scene.picture(Exact);
        assert_eq!(picture, scene.picture(Exact));
        let levels: BTreeSet<_> = picture.pixels().map(|pixel| pixel.0).collect();
        assert!(levels.len() > 10, "edges are smooth");
    }),
    ("Names defined twice", |scene| {
        let loaded = scene.read(None).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(loaded.warnings.faults().len(), 2);
        assert!(loaded.warnings.faults().iter().all(|warning| warning.also.len() == 1));
        assert_eq!(loaded.model.objects.len(), 1);
        assert!(
            scene
                .picture(Exact)
                .enumerate_pixels()
                .all(|(x, _, pixel)| { !is_lit(pixel) || x < 20 && pixel.0[0] > pixel.0[2] })
        );
    }),
    ("Order, names and white space", |scene| {
        assert!(scene.lit(Exact) > 500);
        let (material, rest) = scene.0.split_once('\n').expect("a line");
        Scene(format!("{rest}{material}")).is_refused("is used before it is defined");
    }),
    ("Errors", |scene| {
        scene.with("normal 0 0 1", "normal 0 0 0").is_refused("must be a nonzero vector");
        scene.with("xdir 1 0 0", "xdir 0 0 2").is_refused("has an `xdir` parallel to its `normal`");
        let several = scene.with("normal 0 0 1", "normal 0 0").with("dimensions 8 6", "dimensions 8");
        several.is_refused("2 errors");
    }),
    ("One specular value or three", |scene| {
        for accuracy in [Classic, Exact] {
            let three = scene.with("specular 0.5", "specular 0.5 0.5 0.5");
            assert_eq!(scene.picture(accuracy), three.picture(accuracy));
            assert_ne!(
                scene.picture(accuracy),
                scene.with("specular 0.5", "specular 0.5 0 0.5").picture(accuracy)
            );
        }
    }),
    ("Texture files", |scene| {
        assert!(scene.lit(Exact) > 100);
        scene.with("letter.ppm", "nowhere.ppm").is_refused("cannot be read");
        assert!(scene.with("letter.ppm", "bricks.png").lit(Exact) > 100);
    }),
    ("Additions to the language", |scene| {
        let dump = dump::notes(&scene.model(Exact));
        assert!(["samples", "accuracy", "size"].iter().all(|word| !dump.contains(word)), "{dump}");
    }),
    ("Alternate tiles", |scene| {
        assert_eq!(scene.picture(Exact), scene.with("specular 1", "specular 0").picture(Exact));
        assert_ne!(scene.picture(Exact), scene.with("ambient 1 1 2", "ambient 5 5 5").picture(Exact));
    }),
    ("Projectors", |scene| {
        assert!(scene.lit(Exact) > 100);
        let behind = scene.with("point 3 2 -3", "point 3 2 -9");
        assert_eq!(behind.lit(Exact), 0, "behind the wall");
    }),
    ("Triangles", |scene| {
        let bare = scene.with("normal 1 0 0  point 9 9 9 ", "");
        assert_eq!(scene.picture(Exact), bare.picture(Exact));
        assert!(scene.lit(Exact) > 50);
    }),
    ("The debug listing", |scene| {
        let model = scene.model(Exact);
        let mut out = Vec::new();
        debug::pixel(&Plan::new(&model), 25, 15, &[LogLine::Pix, LogLine::Hit, LogLine::Irgb], &mut out)
            .expect("memory takes it");
        let listed = String::from_utf8(out).expect("a text");
        let start = "\nPIX   15   25 - wall         HIT:(  5.7,   3.0,  -4.0)";
        assert!(listed.starts_with(start), "{listed}");
        let level = 255.0 * trace::pixel(&Plan::new(&model), 25, 15).y;
        assert!(level.fract() > 0.5, "{level} is rounded up by the notes");
        let byte = level.floor();
        assert!(listed.contains(&format!("IRGB:(    0, {byte:>5}, ")), "{listed}");
    }),
    ("The dump", |scene| {
        let dump = dump::notes(&scene.model(Exact));
        assert!(dump.contains("\ndimensions     8.0   6.0\n"), "{dump}");
        assert!(dump.contains("\nrotation matrix\n"), "{dump}");
        let pfplane = scene.with("fplane wall {", "pfplane wall { shader 0 ");
        assert_eq!(dump::notes(&pfplane.model(Exact)).matches("\nnormal ").count(), 1);
    }),
    ("The file", |scene| {
        let folder = folder();
        fs::write(folder.path().join("scene.ray"), &scene.0).expect("room for a scene");
        let (status, ppm, err) = outcome(tabray(&folder).write_stdin(scene.0.as_str()));
        assert!(status == 0 && ppm.starts_with(b"P6 41 31 255\n"), "{err}");
        let (status, _, err) = outcome(tabray(&folder).args(["render", "scene.ray"]));
        assert_eq!(status, 0, "{err}");
        let png = image::open(folder.path().join("scene.png")).expect("a PNG").into_rgb8();
        assert_eq!(png.as_raw()[..], ppm[13..]);
    }),
];

/// Differences that concern rays that leave a surface, and the light along them.
const RAYS_THAT_GO_ON: &[Check] = &[
    ("Glass spheres", |scene| {
        let tint = 0.8 * dvec3(1.0, 0.5, 0.25);
        let wall = DVec3::splat(9.0 / 14.0);
        let once = scene.colour(Classic);
        assert!(once.abs_diff_eq(tint * wall, 1e-14), "{once}");
        let same = [
            scene.clone(),
            scene.with("sphere", "ellipsoid").with("radius 2", "radius 2 scale 1 1 1"),
            scene
                .with("sphere", "quadric")
                .with("radius 2", "coefficients 1 1 1 0 0 0 0 0 0 4 box -3 -3 -3 3 3 3"),
            scene.with("sphere", "revsurf").with(
                "center 4 3 -3  radius 2",
                "profile \"sqrt(max(0, 4 - (y - 2)^2))\" direction 0 1 0 base 4 1 -3 height 4",
            ),
        ];
        for scene in same {
            let twice = scene.colour(Exact);
            assert!(twice.abs_diff_eq(tint * tint * wall, 1e-14), "{twice}: {}", scene.0);
        }
    }),
    ("A mirror from inside", |scene| {
        assert_eq!(scene.colour(Classic), DVec3::ZERO);
        // The ray passes through the centre, so every segment but the first has a length of 4; the last one begins at
        // 18.
        let seen: f64 = (0..6).map(|bounce| 0.5_f64.powi(bounce) / (2.0 + 4.0 * f64::from(bounce))).sum();
        let exact = scene.colour(Exact);
        assert!(exact.abs_diff_eq(DVec3::splat(seen), 1e-14), "{exact} is not {seen}");
    }),
    ("A light outside a closed room", |scene| {
        assert_eq!((scene.lit(Classic), scene.lit(Exact)), (0, 0));
        assert!(scene.with("location 2 1.5 -5", "location 2 1.5 0").lit(Exact) > 1000);
        let model = scene.model(Exact);
        let ray = model.camera.value.ray(20.0, 15.0);
        assert!(model.objects[0].shape.distance(&ray, &RayRange::ALL) < MISS, "it is there");
    }),
    ("Several surfaces through one point", |scene| {
        let red =
            |picture: &RgbImage| picture.pixels().filter(|pixel| is_lit(pixel) && pixel.0[1] == 0).count();
        let rug = red(&scene.without("plane").picture(Exact));
        assert!(rug > 200, "{rug}");
        assert_eq!(red(&scene.picture(Exact)), rug);
        assert!(red(&scene.picture(Classic)) < rug);
    }),
    ("Highlights from the wrong side", |scene| {
        let matt = scene.with("shininess 12.5", "shininess 0").picture(Exact);
        for shininess in ["12.5", "12", "13", "0.5"] {
            let shiny = scene.with("shininess 12.5", &format!("shininess {shininess}")).picture(Exact);
            let darker = shiny
                .pixels()
                .zip(matt.pixels())
                .filter(|(shiny, matt)| (0..3).any(|channel| shiny[channel] < matt[channel]));
            assert_eq!(darker.count(), 0, "shininess {shininess}");
        }
    }),
    ("The depth of reflections and transmissions", |scene| {
        // The sum over all paths between the panes of up to 20 units, many of which share a pane, a direction and a
        // length.
        let all = 0.063_216_952_753;
        let seen = trace::pixel(&Plan::new(&scene.model(Exact)), 1, 1).x;
        assert!((seen - all).abs() < 5e-5, "{seen}");
    }),
];

/// Tells whether two images differ by one level at most.
fn same(a: &RgbImage, b: &RgbImage) -> bool {
    a.as_raw().iter().zip(b.as_raw()).all(|(a, b)| a.abs_diff(*b) <= 1)
}
