//! Rays that leave surfaces: into closed shapes, and from points that lie on several surfaces.

use super::Random;
use crate::common::{Onlooker, model, render};
use glam::{DVec3, dvec3};
use image::RgbImage;
use tabray::geometry::{Ray, RayRange, Side};
use tabray::render::{Plan, to_byte, trace};

const BLUE: [u8; 3] = [0, 0, 255];

/// Returns the materials of the objects; `brightness` makes up for what the viewer's distance takes away.
fn materials(brightness: f64) -> String {
    let grey = |value: f64| format!("{0} {0} {0}", value * brightness);
    format!(
        "material matt {{ ambient {} diffuse {} }}
         material mirror {{ ambient {} diffuse {} specular 0.6 }}
         material glass {{ ambient {} diffuse {} transparency 0.6 }}
         material both {{ ambient {} diffuse {} transparency 0.5 specular 0.4 shininess 20 }}
         material blue {{ ambient 0 0 {} diffuse {} }}\n",
        grey(2.0),
        grey(18.0),
        grey(1.0),
        grey(8.0),
        grey(1.0),
        grey(8.0),
        grey(1.0),
        grey(8.0),
        8.0 * brightness,
        grey(6.0),
    )
}

fn words(v: DVec3) -> String {
    format!("{:?} {:?} {:?}", v.x, v.y, v.z)
}

fn camera(viewpoint: DVec3) -> String {
    format!("camera eye {{ pixeldim 40 30 worlddim 8 6 viewpoint {} }}\n", words(viewpoint))
}

fn picture(text: &str) -> RgbImage {
    render(&model(text))
}

/// Counts the pixels in which two images differ by more than one level, which rounding can cause.
fn differing(one: &RgbImage, other: &RgbImage) -> usize {
    let apart = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|i| a[i].abs_diff(b[i]) > 1);
    one.pixels().zip(other.pixels()).filter(|pair| apart(*pair)).count()
}

/// Returns the sphere around a centre as each shape that can be one.
fn balls(material: &str, center: DVec3, radius: f64) -> [(&'static str, String); 5] {
    let (at, r) = (words(center), radius);
    let foot = words(center - radius * DVec3::Y);
    let cut = r + 1.0;
    [
        ("sphere", format!("sphere ball {{ material {material} center {at} radius {r} }}\n")),
        (
            "ellipsoid",
            format!("ellipsoid ball {{ material {material} center {at} radius {r} scale 1 1 1 }}\n"),
        ),
        (
            "stretched ellipsoid",
            format!("ellipsoid ball {{ material {material} center {at} radius {} scale 2 2 2 }}\n", r / 2.0),
        ),
        (
            "quadric",
            format!(
                "quadric ball {{ material {material} coefficients 1 1 1 0 0 0 0 0 0 {} center {at} box -{cut} -{cut} -{cut} {cut} {cut} {cut} }}\n",
                r * r
            ),
        ),
        (
            "revsurf",
            format!(
                "revsurf ball {{ material {material} profile \"sqrt({} - (y - {r})^2)\" base {foot} direction 0 1 0 height {} }}\n",
                r * r,
                2.0 * r
            ),
        ),
    ]
}

#[test]
fn a_ball_looks_the_same_as_every_shape_that_can_be_one() {
    let mut random = Random(14);
    let (mut seen, mut pictures) = (0, 0);
    for viewer in ["inside", "before", "1e2", "1e4", "1e6"] {
        for material in ["matt", "mirror", "glass", "both"] {
            let radius = [1.0, 1.5, 2.0][random.whole(0, 2) as usize];
            let aside = random.between(-0.4, 0.4);
            let (center, radius, eye) = match viewer.parse::<f64>() {
                Ok(far) => {
                    (dvec3(4.0 + aside, radius, -4.0), radius, dvec3(4.0 + far / 8.0, 3.0 + far / 3.0, far))
                }
                _ if viewer == "inside" => (dvec3(4.0 + aside, 3.0, 0.0), radius + 1.0, dvec3(4.0, 3.0, 1.0)),
                _ => (dvec3(4.0 + aside, radius, -4.0), radius, dvec3(4.0, 3.0, 6.0)),
            };
            let brightness = (eye.distance(center) / 10.0).max(1.0);
            let rest = format!(
                "plane floor {{ material matt normal 0 1 0 point 0 0 0 }}
                 plane back {{ material blue normal 0 0 1 point 0 0 -9 }}
                 light lamp {{ location {} emissivity 2 2 2 }}
                 light inner {{ location {} emissivity 1 1 1 }}",
                words(dvec3(random.between(0.0, 8.0), random.between(4.0, 8.0), random.between(-7.0, -1.0))),
                words(center + radius * dvec3(0.3, 0.2, -0.4)),
            );
            let scene = |ball: &str| camera(eye) + &materials(brightness) + ball + &rest;
            let balls = balls(material, center, radius);
            let sphere = picture(&scene(&balls[0].1));
            seen +=
                sphere.pixels().filter(|pixel| pixel.0.iter().any(|level| (1..255).contains(level))).count();
            pictures += 1;
            for (name, ball) in &balls[1..] {
                let off = differing(&sphere, &picture(&scene(ball)));
                assert!(
                    off == 0,
                    "{off} pixels of a {material} {name} from {viewer} differ:\n{}",
                    scene(ball)
                );
            }
        }
    }
    assert!(seen > 500 * pictures, "there is something to see: {seen} pixels of {pictures} pictures");
}

#[test]
fn a_lamp_outside_of_a_closed_ball_does_not_light_its_inside() {
    for (name, ball) in balls("matt", dvec3(4.0, 3.0, 0.0), 4.0) {
        let scene = camera(dvec3(4.0, 3.0, 1.0))
            + "material matt { diffuse 1 1 1 }"
            + &ball
            + "light lamp { location 4 3 -6 emissivity 50 50 50 }";
        assert!(picture(&scene).pixels().all(|pixel| pixel.0 == [0; 3]), "light comes into the {name}");
    }
}

#[test]
fn the_first_of_two_balls_in_one_place_is_seen_and_stands_for_both() {
    let rest = "plane back { material blue normal 0 0 1 point 0 0 -9 }
        light lamp { location 2 6 -1 emissivity 2 2 2 }
        light inner { location 4 3 -4.2 emissivity 1 1 1 }";
    let (center, radius) = (dvec3(4.0, 3.0, -4.0), 1.5);
    let others = balls("blue", center, radius);
    for material in ["matt", "mirror", "glass", "both"] {
        for (name, ball) in balls(material, center, radius) {
            let scene = |ball: &str| camera(dvec3(4.0, 3.0, 6.0)) + &materials(1.0) + ball + rest;
            let alone = picture(&scene(&ball));
            for (other_name, other) in &others {
                let other = other.replace(" ball ", " other ");
                let off = differing(&alone, &picture(&scene(&(ball.clone() + &other))));
                assert!(off == 0, "a {material} {name} with a {other_name} in its place: {off} pixels");
            }
        }
    }
}

/// Returns a part of a floor, given by one of its points and two directions along it.
fn rug(kind: i64, material: &str, normal: DVec3, [point, along, across]: [DVec3; 3], size: f64) -> String {
    match kind {
        0 => {
            let corners = [point, point + size * along, point + 0.5 * along + size * across].map(words);
            let [a, b, c] = corners;
            format!("triangle rug {{ material {material} vertex1 {a} vertex2 {b} vertex3 {c} }}\n")
        }
        _ => format!(
            "fplane rug {{ material {material} normal {} point {} xdir {} dimensions {size} {size} }}\n",
            words(normal / 2.0),
            words(point),
            words(along)
        ),
    }
}

/// A rug of the floor's own material makes no difference: it has no acne, casts no shadow on the floor, and reflects
/// and tints nothing twice. The floor's coordinates are binary fractions, so that the rug lies exactly in it.
#[test]
fn a_rug_on_a_floor_of_any_tilt_looks_as_the_floor_does() {
    let mut random = Random(15);
    let mut seen = 0;
    const SCENES: usize = 120;
    for _ in 0..SCENES {
        let mut whole = |low, high| random.whole(low, high) as f64;
        let normal = dvec3(whole(-3, 3), whole(1, 4), whole(-1, 4));
        let along = dvec3(normal.y, -normal.x, 0.0);
        let across = normal.cross(along);
        let point = dvec3(whole(0, 8), whole(-1, 1), -whole(4, 8));
        let start = point + whole(0, 2) / 8.0 * along + whole(-1, 1) / 16.0 * across;
        let (kind, material) = (whole(0, 1), ["matt", "mirror", "glass", "both"][whole(0, 3) as usize]);
        let far = [0.0, 0.0, 1e2, 1e4, 1e6][whole(0, 4) as usize];
        let eye = match far {
            0.0 => dvec3(4.0, 3.0, 6.0),
            _ => dvec3(4.0 + whole(-3, 3) * far / 10.0, 3.0 + whole(1, 9) * far / 10.0, far),
        };
        let rug = rug(kind as i64, material, normal, [start, along, across], whole(1, 6));
        let lamp = dvec3(whole(1, 7), whole(4, 9), -whole(0, 5));
        let floor = format!(
            "plane floor {{ material {material} normal {} point {} }}\n",
            words(normal),
            words(point)
        );
        let rest = format!(
            "sphere ball {{ material blue center 4 3 -5 radius 1 }}
             plane back {{ material blue normal 0 0 1 point 0 0 -12 }}
             light lamp {{ location {} emissivity 2 2 2 }}
             light below {{ location 7 -9 -5 emissivity 2 2 2 }}",
            words(lamp)
        );
        let brightness = (eye.distance(dvec3(4.0, 3.0, -4.0)) / 10.0).max(1.0);
        let before = camera(eye) + &materials(brightness);
        let bare = picture(&(before.clone() + &floor + &rest));
        seen += bare.pixels().filter(|pixel| pixel.0.iter().any(|level| (1..255).contains(level))).count();
        let orders = [rug.clone() + &floor, floor + &rug];
        for objects in &orders {
            let scene = before.clone() + objects + &rest;
            let off = differing(&bare, &picture(&scene));
            assert!(off == 0, "{off} pixels differ with a rug:\n{scene}");
        }
    }
    assert!(seen > 500 * SCENES, "there is something to see: {seen} pixels of {SCENES} scenes");
}

/// A triangle that stands on a floor with one edge looks like one that continues below the floor.
#[test]
fn a_triangle_with_an_edge_on_the_floor_has_no_seam_there() {
    let mut random = Random(16);
    for _ in 0..40 {
        let mut whole = |low, high| random.whole(low, high) as f64;
        let a = dvec3(whole(4, 9) / 2.0, 0.0, -whole(2, 4));
        let b = a + dvec3(whole(1, 4) / 2.0, 0.0, whole(-2, 2) / 2.0);
        let top = a + dvec3(whole(0, 2) / 2.0, whole(1, 2), whole(-4, 0) / 4.0);
        let material = ["matt", "mirror"][whole(0, 1) as usize];
        let lamp = dvec3(whole(0, 8), whole(4, 8), -whole(0, 7));
        let scene = |a: DVec3, b: DVec3| {
            format!(
                "triangle flag {{ material {material} vertex1 {} vertex2 {} vertex3 {} }}
                 plane floor {{ material {material} normal 0 1 0 point 0 0 0 }}
                 plane back {{ material blue normal 0 0 1 point 0 0 -9 }}
                 light lamp {{ location {} emissivity 2 2 2 }}",
                words(a),
                words(b),
                words(top),
                words(lamp)
            )
        };
        let before = camera(dvec3(4.0, 3.0, 6.0)) + &materials(1.0);
        let standing = picture(&(before.clone() + &scene(a, b)));
        let sunk = picture(&(before + &scene(a + (a - top), b + (b - top))));
        assert_eq!(differing(&standing, &sunk), 0, "{}", scene(a, b));
    }
}

/// The row of pixels exactly at the line where floor and wall meet shows the one that comes first in the scene.
#[test]
fn the_first_of_floor_and_wall_is_seen_without_dots_where_they_meet() {
    let floor = "plane floor { material matt normal 0 1 0 point 0 0 0 }\n";
    let wall = "plane wall { material blue normal 0 0 1 point 0 0 -4 }\n";
    for (objects, wants_blue) in [(floor.to_owned() + wall, false), (wall.to_owned() + floor, true)] {
        let scene = "camera eye { pixeldim 161 121 worlddim 8 6 viewpoint 4 3 6 }
            material matt { ambient 2 2 2 diffuse 9 9 9 }
            material blue { ambient 0 0 99 diffuse 0 0 1 }\n"
            .to_owned()
            + &objects
            + "light lamp { location 4 5 -1 emissivity 3 3 3 }";
        let picture = picture(&scene);
        let row: Vec<_> = (0..161).map(|x| picture.get_pixel(x, 120 - 24).0).collect();
        assert!(row.iter().all(|pixel| (*pixel == BLUE) == wants_blue), "{row:?}");
        let is_smooth = |pair: &[[u8; 3]]| pair[0][0].abs_diff(pair[1][0]) < 8;
        assert!(row.windows(2).all(is_smooth), "{row:?}");
    }
}

/// Where surfaces coincide, single rays decide, and the other rays of the packet must not matter.
#[test]
fn the_first_of_two_grazed_planes_is_seen_where_they_cross() {
    // The ray's angle with one of the planes is about 1e-8, so that the rounding of the ray moves the hit by 1e-8 of the
    // distance, but as the scene has it, it meets both planes in one point.
    for [position, target, one, two] in [
        [
            "-4.3005632986037785 -1.3628415427153087 -1.338645179688677",
            "-0.3125 0.0625 -1.375",
            "0.3080192564870387 -0.8389184514399903 0.8970645219725393",
            "0.21936359759589366 -0.6136409447180333 0.005169588236545902",
        ],
        [
            "1.163462817490709 -8.930119844943308 6.388704298731028",
            "0.3125 -0.25 -3.6875",
            "0.28811985556844605 0.17522832987433565 0.12661615972003262",
            "-0.8474302214765466 0.3702838564230871 0.39054783025033907",
        ],
        [
            "-5.006068818235802 5.714317090894845 8.750167047497992",
            "3.6875 -1.1875 -2.1875",
            "-0.6010904879718251 -0.5556148000010593 -0.12716331100258052",
            "0.40400530042041183 0.950880699643271 0.18576857898753873",
        ],
    ] {
        for accuracy in ["exact", "strict"] {
            let scene = format!(
                "look_at eye {{ pixeldim 1 1 position {position} target {target} up 0.1 1 0.3 accuracy {accuracy} }}
                 material red {{ ambient 1e9 0 0 }} material green {{ ambient 0 1e9 0 }}
                 plane one {{ material red normal {one} point {target} }}
                 plane two {{ material green normal {two} point {target} }}"
            );
            assert_eq!(picture(&scene).get_pixel(0, 0).0, [255, 0, 0], "{scene}");
        }
    }
}

#[test]
fn the_colour_of_a_ray_that_starts_on_several_surfaces_is_its_own() {
    let scene = "camera eye { pixeldim 60 45 worlddim 8 6 viewpoint 4 3 6 }".to_owned()
        + &materials(1.0)
        + "fplane rug { material both normal 0 2 1 point 2 0 -3 xdir 1 0 0 dimensions 4 4 }
           plane floor { material mirror normal 0 2 1 point 0 0 -3 }
           sphere ball { material glass center 4 3 -5 radius 1 }
           quadric same { material mirror coefficients 3 3 3 0 0 0 0 0 0 3 center 4 3 -5 box -2 -2 -2 2 2 2 }
           revsurf vase { material both profile \"1 + 0.5 * sin(y)\" base 7 1 -4 direction 0 1 0 height 3 }
           torus ring { material glass center 1.5 3 -4 radius 1 tube 0.3 }
           triangle flag { material mirror vertex1 2 0 -3 vertex2 3 0 -3 vertex3 2.5 2 -3 }
           light lamp { location 4 5 -4 emissivity 6 6 6 }
           light low { location 1 1 2 emissivity 2 2 2 }";
    let model = model(&scene);
    let (picture, plan) = (render(&model), Plan::new(&model));
    for (x, row, pixel) in picture.enumerate_pixels() {
        let (x, y) = (x as usize, (picture.height() - 1 - row) as usize);
        let alone = trace::pixel(&plan, x, y);
        assert_eq!(alone.to_array().map(to_byte), pixel.0, "{x} {y}");
        assert_eq!(trace::observe_pixel(&plan, x, y, &mut Onlooker), alone, "{x} {y}");
    }
}

/// If a ray that may start on a shape had a certain bracket, the bracket would be that of a false hit, or miss one.
#[test]
fn what_may_start_on_a_shape_is_in_doubt() {
    let mut random = Random(17);
    let shapes = [
        "plane p { material m normal 1 2 3 point 1 0 0 }",
        "sphere s { material m center 1 2 3 radius 2 }",
        "ellipsoid e { material m center 1 2 3 radius 2 scale 1 0.25 3 }",
        "quadric q { material m coefficients 1 2 3 0 0 0 0 0 0 4 center 1 2 3 box -3 -3 -3 3 3 3 }",
        "torus t { material m center 1 2 3 radius 2 tube 0.5 }",
        "triangle t { material m vertex1 0 0 -9 vertex2 9 0 0 vertex3 0 9 -3 }",
    ];
    for text in shapes {
        let shape = super::shape(text);
        let mut starts = 0;
        for _ in 0..20_000 {
            let far = 10_f64.powf(random.between(0.0, 7.0));
            let axis = random.around(DVec3::Z, 0.0);
            let from = far * random.around(axis, 0.5);
            let aim = dvec3(1.0, 2.0, 3.0) + 2.0 * random.around(axis, 0.3);
            let ray = Ray { origin: from, dir: (aim - from).normalize() };
            let distance = shape.distance(&ray, &RayRange::ALL);
            if !distance.is_finite() {
                continue;
            }
            let (point, normal) = (ray.at(distance), shape.normal(ray.at(distance)));
            let origin_error =
                tabray::world::coincidence::error(&ray, distance, normal, shape.facts().max_coordinate);
            assert!(shape.is_on_surface(point, origin_error), "{text} is not where it is hit: {ray:?}");
            let cosine = random.between(-1.0, 1.0);
            let dir = random.around(normal, cosine);
            let bracket =
                shape.t_bounds(&Ray { origin: point, dir }, &RayRange { origin_error, ..RayRange::ALL });
            let side = Side::seen_along(dir, normal).opposite();
            let next = match shape.can_hit_itself(side) {
                true => shape.distance(
                    &Ray { origin: point, dir },
                    &RayRange { origin_side: Some(side), ..RayRange::ALL },
                ),
                false => f64::INFINITY,
            };
            assert!(bracket.near <= next && next <= bracket.far, "{text}: {bracket:?} {next} {ray:?} {dir}");
            starts += 1;
        }
        assert!(starts > 1_000, "{text} is hit by {starts}");
    }
}
