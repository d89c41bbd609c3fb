//! What is left out is met by no ray, and what is lit stays.

use crate::common::{model_in, root};
use std::collections::BTreeSet;
use tabray::render::observer::{Event, LightOutcome, TraceObserver};
use tabray::render::plan::Plan;
use tabray::render::plan::needs::Needs;
use tabray::render::trace;
use tabray::scene::model::Model;
use tabray::world::material::Rgb;

/// The objects that rays meet, and the lights that shine.
#[derive(Default)]
struct ReachedEntities {
    objects: BTreeSet<usize>,
    lights: BTreeSet<usize>,
    /// The lights, each with an object that blocks it somewhere.
    blocked: BTreeSet<(usize, usize)>,
}

impl TraceObserver for ReachedEntities {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::FirstHit(Some(hit)) => drop(self.objects.insert(hit.index)),
            Event::Light(light, LightOutcome::Blocked(index)) => drop(self.blocked.insert((light, index))),
            Event::Light(light, LightOutcome::Shines { colour, .. }) if colour != Rgb::ZERO => {
                self.lights.insert(light);
            }
            _ => {}
        }
    }
}

fn model(text: &str) -> Model {
    model_in(root(), text)
}

/// Checks that no ray meets what is left out, and returns the numbers of objects and lights that are.
fn left_out(text: &str) -> [usize; 2] {
    let model = model(text);
    let [whole, plan] = [Plan::new(&model), Plan::for_picture(&model)];
    let mut met = ReachedEntities::default();
    let [width, height] = model.camera.value.pixels;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let all = trace::observe_pixel(&whole, x, y, &mut met);
        let colour = trace::pixel(&plan, x, y);
        assert_eq!(colour.to_array().map(f64::to_bits), all.to_array().map(f64::to_bits), "{x} {y}\n{text}");
    }
    let Needs { unreached, dark, .. } = &plan.needs;
    // A light that is left out, as nothing reflects it, may be blocked by anything.
    let is_dark = |light: usize| dark.iter().any(|(index, _)| *index == light);
    met.objects.extend(met.blocked.iter().filter(|(light, _)| !is_dark(*light)).map(|(_, object)| object));
    let wrong: Vec<_> = unreached.iter().filter(|index| met.objects.contains(index)).collect();
    assert!(wrong.is_empty(), "objects {wrong:?} are met\n{text}");
    let wrong: Vec<_> = dark.iter().filter(|(index, _)| met.lights.contains(index)).collect();
    assert!(wrong.is_empty(), "lights {wrong:?} shine\n{text}");
    [unreached.len(), dark.len()]
}

const CAMERA: &str = "camera eye { pixeldim 12 9 worlddim 8 6 viewpoint 4 3 7 }
    material matt { ambient 1 1 1 diffuse 2 2 2 } material mirror { specular 0.5 }
    material glass { diffuse 1 2 1 transparency 0.5 }";
/// A viewer elsewhere, who looks elsewhere.
const FREE: &str = "look_at eye { pixeldim 12 9 position -6 12 -9 target 3 1 2 up 0.2 1 0 angle 70 }";
const FLOOR: &str = "plane floor { material matt normal 0 1 0 point 0 0 0 }";
const LAMP: &str = "light lamp { location 4 9 2 emissivity 5 5 5 }";

#[test]
fn what_lies_behind_the_viewer_is_left_out_unless_it_is_mirrored_or_casts_a_shadow() {
    let behind = "sphere behind { material matt center 4 3 30 radius 1 }";
    assert_eq!(left_out(&format!("{CAMERA} {FLOOR} {LAMP} {behind}")), [1, 0]);
    let wall = "plane wall { material mirror normal 0 0 1 point 0 0 -4 }";
    assert_eq!(left_out(&format!("{CAMERA} {wall} {behind}")), [0, 0]);
    let turned = "plane wall { material mirror normal 1 0 1 point 0 0 -9 }";
    assert_eq!(left_out(&format!("{CAMERA} {turned} {behind}")), [1, 0], "it shows what is to the right");
    let ball = "sphere ball { material mirror center 4 3 -4 radius 1 }";
    assert_eq!(left_out(&format!("{CAMERA} {ball} {behind}")), [0, 0]);
    let lamp = "light lamp { location 4 3 40 emissivity 5 5 5 }";
    assert_eq!(left_out(&format!("{CAMERA} {FLOOR} {lamp} {behind}")), [0, 0]);
    assert_eq!(
        left_out(&format!(
            "{CAMERA} {FLOOR} {behind} plane back {{ material matt normal 0 0 -1 point 0 0 50 }}"
        )),
        [2, 0]
    );
}

#[test]
fn lights_that_reach_nothing_are_left_out() {
    let scene = |light: &str| left_out(&format!("{CAMERA} {FLOOR} {LAMP} light other {{ {light} }}"))[1];
    assert_eq!(scene("location 4 -1 2 emissivity 5 5 5"), 1, "below the floor");
    assert_eq!(scene("location 4 1 2 emissivity 5 5 5"), 0);
    assert_eq!(scene("location 4 1 2 emissivity 0 0 0"), 1);
    assert_eq!(scene("location 4 -1 2 emissivity 5 5 5 size 1.5"), 0, "a part of it is above");
    let ball = format!("{CAMERA} sphere ball {{ material matt center 4 3 -4 radius 1 }}");
    let spot = |point: &str| {
        left_out(&format!("{ball} spotlight s {{ location 4 9 -4 emissivity 5 5 5 point {point} theta 5 }}"))
            [1]
    };
    assert_eq!([spot("4 3 -4"), spot("9 3 -4")], [0, 1]);
    let projector = |location: &str, point: &str| {
        left_out(&format!(
            "{ball} texture t {{ filename scenes/textures/bricks.png }}
            projector p {{ location {location} emissivity 5 5 5 normal 0 1 0 point {point} xdir 1 0 0 dimensions 1 1 texname t mode 0 }}"
        ))[1]
    };
    assert_eq!(projector("4 9 -4", "3.5 7 -3.5"), 0, "onto the ball");
    assert_eq!(projector("4 9 -4", "8 7 -3.5"), 1, "beside it");
    assert_eq!(projector("4 9 -4", "3.5 1 -3.5"), 1, "the ball lies before the rectangle");
    assert_eq!(
        projector("4 9 -4", "3.5 11 -3.5"),
        0,
        "a path to the light may end in the rectangle behind it"
    );
}

/// Makes scenes with objects and lights all around the viewer; some of the planes are mirrors.
fn scene(state: &mut u64) -> String {
    let mut random = || {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut text = CAMERA.to_owned();
    let mirrors = random() < 0.5;
    for index in 0..14 {
        let mut from = |low: f64, high: f64| low + (high - low) * random();
        let [x, y, z] = [from(-30.0, 38.0), from(-30.0, 36.0), from(-30.0, 40.0)];
        let [a, b, c] = [from(-1.0, 1.0), from(-1.0, 1.0), from(-1.0, 1.0)];
        let (size, kind) = (from(0.2, 6.0), from(0.0, 1.0));
        let matt = ["matt", "glass", "matt"][(3.0 * from(0.0, 1.0)) as usize];
        let flat = if mirrors && from(0.0, 1.0) < 0.3 { "mirror" } else { matt };
        text += &if kind < 0.5 {
            format!("sphere o{index} {{ material {matt} center {x} {y} {z} radius {size} }}\n")
        } else if kind < 0.8 {
            format!(
                "fplane o{index} {{ material {flat} normal {a} {b} {c} point {x} {y} {z} xdir {b} {c} {a} dimensions {size} 5 }}\n"
            )
        } else if kind < 0.9 {
            format!("plane o{index} {{ material {flat} normal {a} {b} {c} point {x} {y} {z} }}\n")
        } else {
            String::new()
        };
    }
    for index in 0..3 {
        let mut from = |low: f64, high: f64| low + (high - low) * random();
        let [x, y, z] = [from(-9.0, 17.0), from(-9.0, 15.0), from(-19.0, 17.0)];
        let kind = from(0.0, 1.0);
        text += &if kind < 0.5 {
            format!("light l{index} {{ location {x} {y} {z} emissivity 5 4 3 }}\n")
        } else if kind < 0.7 {
            format!("light l{index} {{ location {x} {y} {z} emissivity 5 4 3 size 2 }}\n")
        } else {
            format!(
                "spotlight l{index} {{ location {x} {y} {z} emissivity 5 4 3 point 4 3 0 theta {} }}\n",
                from(1.0, 40.0)
            )
        };
    }
    text
}

#[test]
fn no_projector_shines_that_is_left_out_of_scenes_made_at_random() {
    let (mut state, mut sum) = (7_u64, 0);
    for _ in 0..200 {
        let mut from = |low: f64, high: f64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut place = |size: f64| [0; 3].map(|_| from(-size, size));
        let ([x, y, z], [a, b, c], [d, e, f], [g, h, i]) = (place(6.0), place(1.0), place(3.0), place(2.0));
        let left_out = left_out(&format!(
            "{CAMERA} sphere ball {{ material matt center 4 3 -4 radius 1 }}
            fplane leaf {{ material matt normal {b} {c} 1 point {} 2 -3 xdir 1 {a} 0 dimensions 2 1 }}
            texture t {{ filename scenes/textures/bricks.png }}
            projector p {{ location {x} {y} {z} emissivity 5 4 3 normal {a} {b} {c} point {} {} {}
                xdir {b} {c} {a} dimensions {} {} texname t mode 0 }}",
            3.0 + g,
            x + d,
            y + e,
            z + f,
            2.5 + h,
            2.5 + i
        ));
        sum += left_out[1];
    }
    assert!((20..180).contains(&sum), "{sum} of 200 projectors");
}

#[test]
fn no_ray_meets_what_is_left_out_of_scenes_made_at_random() {
    let (mut state, mut sum) = (18, [0; 2]);
    for _ in 0..300 {
        let left_out = left_out(&scene(&mut state));
        sum = [sum[0] + left_out[0], sum[1] + left_out[1]];
    }
    assert!(sum[0] > 300 && sum[1] > 30, "{sum:?} of 300 scenes");
}

#[test]
fn no_ray_of_another_viewer_meets_what_is_left_out_of_scenes_made_at_random() {
    let (mut state, mut sum) = (19, [0; 2]);
    let notes = CAMERA.lines().next().expect("a camera");
    for _ in 0..100 {
        let left_out = left_out(&scene(&mut state).replace(notes, FREE));
        sum = [sum[0] + left_out[0], sum[1] + left_out[1]];
    }
    assert!(sum[0] > 100 && sum[1] > 10, "{sum:?} of 100 scenes");
}

#[test]
fn nothing_is_left_out_where_rays_do_not_start_at_one_point() {
    let notes = CAMERA.lines().next().expect("a camera");
    let behind = "sphere behind { material matt center 4 3 30 radius 1 }";
    for camera in ["orthographic eye { width 8", "thin_lens eye { aperture 1", "fisheye eye { angle 200"] {
        let camera = format!("{camera} pixeldim 12 9 position 4 3 7 target 4 3 0 }}");
        let scene = format!("{CAMERA} {FLOOR} {LAMP} {behind}").replace(notes, &camera);
        assert_eq!(left_out(&scene), [0, 0], "{camera}");
    }
}
