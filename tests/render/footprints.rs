//! Bounds on the colour of a pixel, from its footprint.

use crate::common::model;
use tabray::render::footprint::{PixelProver, Proof};
use tabray::render::plan::depth::Depth;
use tabray::scene::model::Model;
use tabray::world::display::{Display, Tone, Transfer};
use tabray::world::material::Rgb;
use tabray::world::rules::Rules;

/// Images under the notes' rules, with an exposure in stops.
fn display(stops: f64) -> Display {
    Display::new(Rules::Notes, stops, Tone::Clip, Transfer::Linear)
}

fn proof(model: &Model, pixel: [usize; 2], error: f64) -> Proof {
    let depth = Depth::new(model);
    PixelProver::new(model).pixel((model, depth.as_ref()), &model.camera.value, pixel, error)
}

/// A pixel is a thousandth of a unit wide on the image plane, and that of the image's middle looks along -z.
const CAMERA: &str = "camera eye { pixeldim 8001 6001 worlddim 8 6 viewpoint 4 3 8 }
    material m { ambient 0.5 0.5 0.5 diffuse 2 2 2 }";

const MIDDLE: [usize; 2] = [4000, 3000];

/// More than how much the colour at the middle of such a pixel differs from the mean.
const CURVED: f64 = 1e-6;

#[track_caller]
fn holds(proof: &Proof, fraction: f64) {
    let (low, high) = (proof.low.min_element() - CURVED, proof.high.max_element() + CURVED);
    assert!(low <= fraction && fraction <= high, "{proof:?}, {fraction}");
}

#[test]
fn a_plane_half_in_shadow_has_the_mean_of_both_halves() {
    // The wall is 16 units from the viewer. The light is 10 units from the middle, at a cosine of 4/5: it adds
    // 25 * 2 * 4/5 / 10 = 4 to the ambient 1/2. What is to the right of x = 4 is in the shadow of the screen.
    let model = model(&format!(
        "{CAMERA}
         light lamp {{ location 4 9 0 emissivity 25 25 25 }}
         plane wall {{ material m normal 0 0 1 point 0 0 -8 }}
         fplane screen {{ material m normal 0 0 1 point 4 5 -4 xdir 1 0 0 dimensions 2 2 }}"
    ));
    let [lit, dark] = [9.0 / 2.0 / 16.0, 1.0 / 2.0 / 16.0];
    let [left, middle, right] = [3999, 4000, 4001].map(|x| proof(&model, [x, 3000], 1.0 / 255.0));
    assert!([left, middle, right].iter().all(|proof| proof.is_within(1.0 / 255.0, &display(0.0))));
    holds(&left, lit);
    holds(&middle, 0.5 * (lit + dark));
    holds(&right, dark);
    assert!(middle.footprints > 1 && middle.high.max_element() < lit && middle.low.min_element() > dark);
}

#[test]
fn light_behind_undecided_panes_may_be_below_0_where_a_tint_is() {
    // Panes in one place are not decided. The green that they let pass is below 0, and darkens the wall.
    let model = model(&format!(
        "{CAMERA}
         material glass {{ diffuse 1 -1 1 transparency 1 }}
         light lamp {{ location 4 9 0 emissivity 25 25 25 }}
         plane one {{ material glass normal 0 1 0 point 0 5 0 }}
         plane other {{ material glass normal 0 1 0 point 0 5 0 }}
         plane wall {{ material m normal 0 0 1 point 0 0 -8 }}"
    ));
    // The light adds 4 to the ambient 1/2, and what passes of green is -1 of it.
    let proof = proof(&model, MIDDLE, 1.0 / 255.0);
    assert!(proof.low[1] <= (0.5 - 4.0) / 16.0, "{proof:?}");
}

#[test]
fn a_background_is_bounded_by_itself_and_beside_an_edge() {
    // The right half of the pixel sees the screen, 12 units from the viewer.
    let scene = |background: &str| {
        model(&format!(
            "{CAMERA} {background}
             fplane screen {{ material m normal 0 0 1 point 4 1 -4 xdir 1 0 0 dimensions 4 4 }}"
        ))
    };
    let even = scene("background even { colour 0.75 0.75 0.75 }");
    let [left, middle] = [3999, 4000].map(|x| proof(&even, [x, 3000], 1.0 / 255.0));
    assert_eq!(left.footprints, 1);
    holds(&left, 0.75);
    holds(&middle, 0.5 * (0.75 + 0.5 / 12.0));
    // The middle of the image looks along -z, halfway up to this zenith.
    let sky = scene("sky s { horizon 0 0 0 zenith 1 1 1 up 1.7320508075688772 0 -1 }");
    let aside = proof(&sky, [3999, 3000], 1.0 / 255.0);
    holds(&aside, 0.5 - 0.000125 * 0.866);
    assert!(aside.is_within(1.0 / 255.0, &display(0.0)), "{aside:?}");
}

#[test]
fn what_cannot_see_refracting_glass_is_certified_as_without_it() {
    // The glass is to the right of what the left half of the image shows, in the mirror as well. Without a bound on what
    // it shows itself, as its own light is reflected in it again and again, nothing bounds what other surfaces show.
    let scene = |glass: &str| {
        model(&format!(
            "camera eye {{ pixeldim 16 12 worlddim 8 6 viewpoint 4 3 8 }}
             material m {{ ambient 0.5 0.5 0.5 diffuse 2 2 2 }}
             material mirror {{ ambient 0.1 0.1 0.1 diffuse 1 1 1 specular 0.5 }}
             light lamp {{ location 1 7 1 emissivity 9 9 9 }}
             plane floor {{ material m normal 0 1 0 point 0 0 0 }}
             plane wall {{ material mirror normal 0 0 1 point 0 0 -8 }}
             sphere ball {{ material m center 2 1.5 -4 radius 1 }}
             {glass}"
        ))
    };
    let without = scene("");
    for glass in ["glass g { index 1.5 }", "glass g { transparency 0.8 }", "metal g { shininess 0 }"] {
        let with = scene(&format!("{glass} sphere bowl {{ material g center 7 1.2 -3 radius 1 }}"));
        for (x, y) in (0..8).flat_map(|x| (0..12).map(move |y| (x, y))) {
            let [with, without] = [&with, &without].map(|model| proof(model, [x, y], 2.0 / 255.0));
            let [is_certain, was_certain] =
                [&with, &without].map(|proof| proof.is_within(2.0 / 255.0, &display(0.0)));
            assert!(is_certain || !was_certain, "{glass} {x} {y}: {with:?}, {without:?}");
        }
        assert!(!proof(&with, [12, 4], 2.0 / 255.0).is_within(2.0 / 255.0, &display(0.0)), "{glass}");
    }
}

#[test]
fn a_sphere_is_known_from_one_footprint() {
    // The sphere is 14 units from the viewer, and lit like the wall above.
    let model = model(&format!(
        "{CAMERA}
         light lamp {{ location 4 9 2 emissivity 25 25 25 }}
         sphere ball {{ material m center 4 3 -8 radius 2 }}"
    ));
    let proof = proof(&model, MIDDLE, 1e-3 / 255.0);
    assert_eq!(proof.footprints, 1);
    assert!(proof.is_within(1e-3 / 255.0, &display(0.0)), "{proof:?}");
    holds(&proof, 9.0 / 2.0 / 14.0);
}

#[test]
fn a_light_with_a_size_is_its_mean_where_all_of_it_is_seen() {
    let model = model(&format!(
        "{CAMERA}
         light lamp {{ location 4 9 0 emissivity 25 25 25 size 0.01 }}
         plane wall {{ material m normal 0 0 1 point 0 0 -8 }}"
    ));
    let proof = proof(&model, MIDDLE, 0.1 / 255.0);
    assert_eq!(proof.footprints, 1);
    holds(&proof, 9.0 / 2.0 / 16.0);
}

#[test]
fn the_middle_of_the_bounds_is_shown_within_half_their_width() {
    let proof = |low: f64, high: f64| Proof { low: Rgb::splat(low), high: Rgb::splat(high), footprints: 1 };
    for (low, high) in [(0.2, 0.4), (0.9, 3.0), (-1.0, 0.1), (1.5, 4.0), (2.0, f64::INFINITY), (-3.0, -1.0)] {
        for stops in [-1.0, 0.0, 2.0] {
            let free = Display::new(Rules::Free, stops, Tone::Clip, Transfer::Srgb);
            for display in [display(stops), free] {
                let proof = proof(low, high);
                let error = proof.error(proof.middle(&display), &display);
                let half = 0.5 * (display.shown(proof.high) - display.shown(proof.low)).max_element();
                assert!((error - half).abs() < 1e-12, "{proof:?} {display:?}");
                assert!((error - proof.half_width(&display)).abs() < 1e-12, "{proof:?} {display:?}");
            }
        }
    }
    assert!(!proof(-1.0, f64::INFINITY).is_within(0.4, &display(0.0)));
}
