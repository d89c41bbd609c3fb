//! Patterns far away, of which a sample shows the mean over a part of its pixel.

use crate::common::{load, model, root};
use tabray::render::Plan;
use tabray::render::trace;
use tabray::scene::Model;
use tabray::tools::colours::{Prover, Verdict};
use tabray::world::sensor::Adaptive;

/// Returns a floor of tiles to the horizon.
fn floor(rules: &str, shape: &str) -> Model {
    model(&format!(
        "look_at eye {{ pixeldim 48 36 position 0 1 0 target 0.3 0.6 -2 angle 50 rules {rules} }}
         material light {{ ambient 0.9 0.9 0.9 }} material dark {{ ambient 0.1 0.1 0.1 }}
         checker squares {{ squares 300 300 altmaterial dark }} tiles t {{ width 0.4 }} {shape}"
    ))
}

const FLOORS: [&str; 3] = [
    "tiled_plane f { material light altmaterial dark normal 0 1 0 point 0 0 0 xdir 1 0 0.4 dimensions 0.4 0.4 }",
    "fplane f { material light normal 0 1 0 point -50 0 50 xdir 1 0 0 dimensions 100 100 shader squares }",
    "plane f { material light normal 0 1 0 point 0 0 0 shader t }",
];

/// Returns the root of the mean square difference of the images of two plans, where 1 is white.
fn difference(one: &Plan, other: &Plan) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    // Every other column and row is enough.
    for (x, y) in (0..24).flat_map(|x| (0..18).map(move |y| (2 * x, 2 * y))) {
        sum += (trace::pixel(one, x, y) - trace::pixel(other, x, y)).length_squared() / 3.0;
        count += 1.0;
    }
    f64::sqrt(sum / count)
}

#[test]
fn one_sample_of_a_floor_shows_what_many_do() {
    for shape in FLOORS {
        let free = floor("free", shape);
        let [one, mut many] = [Plan::new(&free), Plan::new(&free)];
        many.camera.samples = 256;
        let off = difference(&one, &many);
        assert!(off < 0.09, "{shape}: {off}");
    }
}

/// Objects through which, or in which, the floor is seen.
const WAYS: [&str; 2] = [
    "material mirror { specular 1 1 1 } plane m { material mirror normal 0 0 1 point 0 0 -1 }",
    "material pane { transparency 1 } plane p { material pane normal 0 0 1 point 0 0 -1 }",
];

#[test]
fn one_sample_of_a_floor_in_a_flat_mirror_or_behind_a_pane_shows_what_many_do() {
    for way in WAYS {
        let free = floor("free", &format!("{} {way}", FLOORS[0]));
        let [one, mut many] = [Plan::new(&free), Plan::new(&free)];
        many.camera.samples = 64;
        let off = difference(&one, &many);
        assert!(off < 0.09, "{way}: {off}");
    }
}

#[test]
fn a_pattern_that_is_near_shows_as_it_is() {
    let scene = floor(
        "free",
        "tiled_plane f { material light altmaterial dark normal 0 1 0 point 0 0 0 xdir 1 0 0 dimensions 40 40 origin 20 0 20 }",
    );
    let plan = Plan::new(&scene);
    // Looking down, all that is seen is within one tile.
    for x in 0..48 {
        let colour = trace::pixel(&plan, x, 0);
        assert!(colour.x == 0.1 || colour.x == 0.9, "{colour}");
    }
}

#[test]
fn means_are_never_proven_wrong() {
    let mut scenes: Vec<_> = FLOORS.iter().map(|shape| floor("free", shape)).collect();
    scenes.extend(WAYS.iter().map(|way| floor("free", &format!("{} {way}", FLOORS[0]))));
    scenes.push(load(&root().join("scenes/tiled_plane/far.ray")));
    for (index, scene) in scenes.iter().enumerate() {
        for samples in [1, 4] {
            let mut plan = Plan::new(scene);
            plan.camera.samples = samples;
            let prover = Prover::new(&plan);
            let [width, height] = plan.camera.pixels;
            let mut proven = 0;
            for (x, y) in (0..width).step_by(7).flat_map(|x| (0..height).step_by(7).map(move |y| (x, y))) {
                let verdict = prover.traced(x, y).verdict();
                assert_ne!(verdict, Verdict::Contradicted, "{index}, {samples}: {x} {y}");
                proven += u32::from(verdict == Verdict::Proven);
            }
            assert!(proven > 0, "{index}, {samples}");
        }
    }
}

#[test]
fn samples_show_points_by_the_notes_rules_and_where_their_number_is_not_fixed() {
    let free = floor("free", FLOORS[0]);
    let mut plan = Plan::new(&free);
    assert!(plan.camera.window().is_some());
    plan.camera.adaptive = Some(Adaptive { most: 64, error: None });
    assert_eq!(plan.camera.window(), None);
    assert_eq!(Plan::new(&floor("notes", FLOORS[0])).camera.window(), None);
}
