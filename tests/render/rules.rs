//! The rules of light, evaluated three times: for images, in intervals and in affine numbers.

use crate::common::model;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;
use tabray::exact::Interval;
use tabray::exact::affine::Affine;
use tabray::geometry::Line;
use tabray::render::enclosed::{EnclosedScene, Enclosing, EnclosingTracer, LightPoints, Limits, SceneBounds};
use tabray::render::plan::Plan;
use tabray::render::plan::depth::FAINT;
use tabray::render::trace;
use tabray::world::Rules;

/// Far more than is left out of what is compared here.
const LIMITS: Limits =
    Limits { hits: 4000, depth: 300, places: usize::MAX, negligible: 1e-11, tolerable: f64::INFINITY };

/// More than the roundings of a colour of a few hundred operations on numbers below 1e3.
const ROUNDING: f64 = 1e-9;

/// More than half of 1/16 of a level, where the curve of sRGB is the flattest: trees of the free rules end there.
const LEFT_OUT: f64 = 0.5 / 16.0 / 255.0 / 0.4;

/// The size of the images, in pixels.
const SIZE: [usize; 2] = [16, 12];

/// A material of each kind of light, and an object of it in front of the viewer.
fn object() -> impl Strategy<Value = String> {
    let colour = || [0.0..3.0, 0.0..3.0, 0.0..3.0];
    let place = [0.0..8.0, 0.0..6.0, -6.0..-1.0];
    let specular = prop_oneof![Just([0.0; 3]), [0.0..0.8, 0.0..0.8, 0.0..0.8]];
    let shininess = prop_oneof![Just(0.0), (1..200).prop_map(f64::from), 0.5..80.0];
    let transparency = prop_oneof![2 => Just(0.0), 1 => 0.1..0.9];
    let kind = (0..4, 0.3..1.5);
    (colour(), colour(), specular, shininess, transparency, place, kind).prop_map(
        |(ambient, diffuse, specular, shininess, transparency, place, (kind, size))| {
            let spelt = |[x, y, z]: [f64; 3]| format!("{x} {y} {z}");
            let name = format!("m{:x}", (place[0] * 1e12) as u64);
            let shape = match kind {
                0 => format!("sphere o {{ material {name} center {} radius {size} }}", spelt(place)),
                1 => format!("plane o {{ material {name} normal 0 1 0.1 point {} }}", spelt([place[0], 0.0, place[2]])),
                2 => format!(
                    "fplane o {{ material {name} normal 0.2 0.3 1 point {} xdir 1 0 0 dimensions {size} {size} }}",
                    spelt(place)
                ),
                _ => format!(
                    "torus o {{ material {name} center {} direction 0.3 1 0.5 radius {size} tube 0.2 }}",
                    spelt(place)
                ),
            };
            format!(
                "material {name} {{ ambient {} diffuse {} specular {} shininess {shininess} transparency {transparency} }}\n{shape}\n",
                spelt(ambient),
                spelt(diffuse),
                spelt(specular)
            )
        },
    )
}

/// A scene of a few objects and lights of each kind.
fn scene() -> impl Strategy<Value = String> {
    let falloff = prop_oneof![Just("none"), Just("distance"), Just("square")];
    let light = ([0.0..8.0, 4.0..9.0, -4.0..4.0], 1.0..12.0, 0..3, falloff);
    let light = light.prop_map(|([x, y, z], bright, kind, falloff)| {
        let place = format!("location {x} {y} {z} emissivity {bright} {bright} 2 falloff {falloff} at 3");
        match kind {
            0 => format!("light l {{ {place} }}\n"),
            1 => format!("light l {{ {place} size 0.3 }}\n"),
            _ => format!("spotlight l {{ {place} point 4 1 -3 theta 25 }}\n"),
        }
    });
    let background = prop_oneof![Just(""), Just("sky s { horizon 0.5 0.4 0.3 zenith 0.1 0.2 0.6 }\n")];
    let (objects, lights) = (prop::collection::vec(object(), 1..6), prop::collection::vec(light, 1..3));
    let rules = prop_oneof![Just("notes"), Just("free")];
    (objects, lights, background, rules).prop_map(|(objects, lights, background, rules)| {
        let numbered = |all: Vec<String>, name: &str| {
            let named = |(index, text): (usize, &String)| {
                text.replacen(name, &format!("{}{index} {{", &name[..2]), 1)
            };
            all.iter().enumerate().map(named).collect::<String>()
        };
        let [width, height] = SIZE;
        let camera = format!(
            "camera eye {{ pixeldim {width} {height} worlddim 8 6 viewpoint 4 3 7 rules {rules} }}\n"
        );
        camera + background + &numbered(lights, " l {") + &numbered(objects, " o {")
    })
}

/// Encloses the colour that a ray returns; `None` where more than roundings are open.
fn enclosed<N: Enclosing<End = f64>>(plan: &Plan, line: &Line<N>) -> Option<[Interval; 3]> {
    let (bounds, lights) = (SceneBounds::of(plan.model), &plan.needs.lights);
    let (depth, meets_uncertified) = (plan.depth.as_ref(), Cell::new(false));
    let scene = EnclosedScene {
        model: plan.model,
        lights,
        depth,
        bounds: &bounds,
        window: plan.camera.window(),
        meets_uncertified,
    };
    let colour = EnclosingTracer::new(&scene, LIMITS, LightPoints::Middle).primary(line)?;
    let colour = colour.map(|channel| channel.range());
    colour.iter().all(|channel| channel.width() < ROUNDING).then_some(colour)
}

/// Compares the evaluators at each pixel of a scene; gives for how many pixels intervals and affine numbers know the
/// colour.
fn compare(text: &str) -> Result<[usize; 2], TestCaseError> {
    let model = model(text);
    let plan = Plan::new(&model);
    let left_out = if plan.camera.rules == Rules::Free { LEFT_OUT } else { FAINT };
    let (mut compared, [width, height]) = ([0, 0], SIZE);
    for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
        let sight = plan.camera.sight(x as f64, y as f64);
        let traced = trace::colour(&plan, &sight, None);
        let (one, other) =
            (enclosed(&plan, &sight.line::<Interval>()), enclosed(&plan, &sight.line::<Affine>()));
        for (index, colour) in [one, other].into_iter().enumerate() {
            let Some(colour) = colour else { continue };
            compared[index] += 1;
            for channel in 0..3 {
                let Interval { low, high } = colour[channel];
                let most = ROUNDING * (1.0 + high.abs());
                // Under the free rules, all light above white is shown alike.
                if plan.camera.rules == Rules::Free && low >= 1.0 && traced[channel] >= 1.0 {
                    continue;
                }
                prop_assert!(
                    low - left_out - most <= traced[channel] && traced[channel] <= high + left_out + most,
                    "{x} {y}, channel {channel} of {traced}: {colour:?}"
                );
            }
        }
        if let (Some(one), Some(other)) = (one, other) {
            let agree = |channel: usize| {
                one[channel].low <= other[channel].high && other[channel].low <= one[channel].high
            };
            prop_assert!((0..3).all(agree), "{x} {y}: {one:?} {other:?}");
        }
    }
    Ok(compared)
}

#[test]
fn the_three_evaluators_of_the_rules_agree() {
    let config = ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() };
    let (known, pixels) = (Cell::new([0; 2]), Cell::new(0));
    let compared = TestRunner::new(config).run(&scene(), |text| {
        let [one, other] = compare(&text)?;
        known.set([known.get()[0] + one, known.get()[1] + other]);
        pixels.set(pixels.get() + SIZE[0] * SIZE[1]);
        Ok(())
    });
    compared.unwrap_or_else(|error| panic!("{error}"));
    // Of one scene, most may be open: where two planes are at one place, nothing says which of them is met.
    assert!(
        known.get().iter().all(|known| 2 * known > pixels.get()),
        "{known:?} of {pixels:?} pixels are known"
    );
}

/// Below three panes, one of them aside, a mirror shows the lit side of the lowest pane.
#[test]
fn what_a_mirror_below_panes_shows_is_not_left_out() {
    let text = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 7 rules free }
        light key { location 0 4 0 emissivity 1 1 2 falloff none at 3 }
        material dark { ambient 0 0 0 diffuse 0 0 0 transparency 0.1 }
        material mirror { ambient 0 0 0 diffuse 0 0 0 specular 0 0 0.9 }
        material upper { ambient 0 0 0 diffuse 0 0 0.94 transparency 0.1 }
        material lower { ambient 0 0 0 diffuse 0 0 2.43 transparency 0.287 }
        fplane aside { material dark normal 0.2 0.3 1 point 5.18 4.92 -1 xdir 1 0 0 dimensions 0.3 0.3 }
        plane bottom { material mirror normal 0 1 0.1 point 0 0 -4.9 }
        plane top { material upper normal 0 1 0.1 point 1.9 0 -1 }
        plane middle { material lower normal 0 1 0.1 point 5 0 -3.17 }";
    let known = compare(text).expect("the evaluators agree");
    assert!(known.iter().all(|known| *known > 50), "{known:?}");
}
