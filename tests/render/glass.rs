//! Glass and metal: materials that bend light, and divide it into a reflected and a transmitted or absorbed part.

use crate::common::{model, render};
use glam::DVec3;
use image::RgbImage;
use proptest::prelude::*;
use tabray::geometry::Side;
use tabray::world::{AnyInterface, Crossing};

const EYE: &str = "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 }
    light lamp { location 1 9 4 emissivity 9 8 7 }
    material matt { ambient 1 2 3 diffuse 4 3 2 }
    plane floor { material matt normal 0 1 0 point 0 0 0 shader tiles }
    sphere ball { material matt center 5 2 -7 radius 2 }
    sky s { horizon 0.25 0.5 0.75 }\n";

fn picture(text: &str) -> RgbImage {
    render(&model(&format!("{EYE}{text}")))
}

/// Returns the interface of a material.
fn of(material: &str) -> AnyInterface {
    let model = model(&format!("{EYE} {material}"));
    let interface = model.materials.iter().find_map(|item| item.value.interface.clone());
    interface.expect("an interface")
}

fn interface(index: f64) -> AnyInterface {
    of(&format!("glass g {{ index {index} }}"))
}

fn unit() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
        .prop_map(DVec3::from)
        .prop_filter_map("a direction", |vector| vector.try_normalize())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_refracted_ray_obeys_snells_law_and_goes_back_the_way_it_came(index in 1.0..4.0_f64, dir in unit(), normal in unit()) {
        let glass = interface(index);
        let normal = if dir.dot(normal) > 0.0 { -normal } else { normal };
        prop_assume!(dir.dot(normal) < -1e-3);
        let Crossing { reflected, onward } = glass.cross(dir, normal, Side::Outside);
        let onward = onward.expect("from outside, some light passes");
        prop_assert!((0.0..1.0).contains(&reflected.x) && reflected == DVec3::splat(reflected.x));
        let sines = [dir.cross(normal), index * onward.cross(normal)];
        prop_assert!((sines[0] - sines[1]).length() < 1e-12, "{sines:?}");
        let back = glass.cross(-onward, -normal, Side::Inside);
        prop_assert!(back.onward.is_some_and(|back| (back + dir).length() < 1e-6), "{back:?}");
        prop_assert!((back.reflected - reflected).length() < 1e-6);
    }

    #[test]
    fn all_light_is_reflected_beyond_the_critical_angle(index in 1.05..4.0_f64, off in -1.0..1.0_f64) {
        prop_assume!(off.abs() > 1e-6);
        let sine: f64 = (1.0 / index + 0.02 * off).clamp(0.0, 1.0);
        let dir = DVec3::new(sine, -(1.0 - sine * sine).sqrt(), 0.0);
        let crossing = interface(index).cross(dir, DVec3::Y, Side::Inside);
        if sine * index > 1.0 {
            prop_assert_eq!(crossing, Crossing { reflected: DVec3::ONE, onward: None });
        } else {
            prop_assert!(crossing.onward.is_some());
        }
    }

    #[test]
    fn a_bubble_is_entered_as_its_surroundings_are_left(index in 1.05..4.0_f64, dir in unit(), normal in unit()) {
        let normal = if dir.dot(normal) > 0.0 { -normal } else { normal };
        let cosine = -dir.dot(normal);
        // At the critical angle, rounding decides.
        prop_assume!((index * index * (1.0 - cosine * cosine) - 1.0).abs() > 1e-3);
        let enters = interface(1.0 / index).cross(dir, normal, Side::Outside);
        let leaves = interface(index).cross(dir, normal, Side::Inside);
        prop_assert!((enters.reflected - leaves.reflected).length() < 1e-9, "{enters:?} {leaves:?}");
        prop_assert_eq!(enters.onward.is_some(), leaves.onward.is_some());
        if let (Some(enters), Some(leaves)) = (enters.onward, leaves.onward) {
            prop_assert!((enters - leaves).length() < 1e-9, "{enters} {leaves}");
        }
    }
}

#[test]
fn four_percent_are_reflected_by_glass_that_is_looked_at_straight() {
    let Crossing { reflected, onward } = interface(1.5).cross(DVec3::NEG_Z, DVec3::Z, Side::Outside);
    assert!((reflected - 0.04).length() < 1e-15 && onward == Some(DVec3::NEG_Z), "{reflected} {onward:?}");
}

#[test]
fn metal_reflects_its_colour_straight_on_and_all_light_at_the_rim() {
    let gold = of("metal gold { colour 1 0.75 0.25 }");
    let at = |dir: DVec3| gold.cross(dir, DVec3::Z, Side::Outside);
    assert_eq!(at(DVec3::NEG_Z), Crossing { reflected: DVec3::new(1.0, 0.75, 0.25), onward: None });
    assert_eq!(at(DVec3::X).reflected, DVec3::ONE);
    let half = at(DVec3::new(0.75_f64.sqrt(), 0.0, -0.5)).reflected;
    assert!((half.z - (0.25 + 0.75 / 32.0)).abs() < 1e-15, "{half}");
}

#[test]
fn metal_mirrors_a_background_of_one_colour_in_its_own() {
    // Straight on, in the middle of the image.
    let scene =
        "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 } background b { colour 0.5 0.5 0.5 }
        metal gold { colour 1 0.75 0.25 } sphere ball { material gold center 4 3 -2 radius 2 }";
    let pixel = render(&model(scene)).get_pixel(32, 24).0;
    assert!(
        [127, 95, 31].iter().zip(pixel).all(|(expected, byte)| byte.abs_diff(*expected) <= 1),
        "{pixel:?}"
    );
}

#[test]
fn interfaces_are_equal_if_their_numbers_are() {
    assert!(interface(1.5) == interface(1.5) && interface(1.5) != interface(1.25));
    assert!(of("metal m { colour 1 1 1 }") != interface(1.5));
}

#[test]
fn an_index_of_one_is_the_clear_glass_of_the_notes() {
    for colour in ["1 1 1", "0.25 1 0.5"] {
        let balls = "sphere one { material g center 3 2 -2 radius 1.5 } sphere other { material g center 4 1 -4 radius 1 }";
        let notes = format!("material g {{ diffuse {colour} transparency 1 }} {balls}");
        let bent = format!("glass g {{ index 1 colour {colour} }} {balls}");
        assert!(picture(&bent) == picture(&notes), "{colour}");
    }
}

#[test]
fn what_is_reflected_and_what_is_transmitted_add_up_to_what_comes() {
    // Whatever rays do, they end in a background that is the same everywhere.
    let scene =
        "camera eye { pixeldim 32 24 worlddim 8 6 viewpoint 4 3 7 } background b { colour 0.5 0.5 0.5 }
        glass g { index 1.5 } sphere one { material g center 4 3 0.5 radius 0.5 }";
    for (x, y, pixel) in render(&model(scene)).enumerate_pixels() {
        // Up to the length to which light is followed, and truncated. The ball is small, so that this is many chords.
        assert!(pixel.0.iter().all(|byte| (125..=127).contains(byte)), "{x} {y} {pixel:?}");
    }
}
