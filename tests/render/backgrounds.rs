//! Backgrounds: what rays see that hit nothing, the rays of mirrors and glass included.

use crate::common::{model, model_in, render, root};
use glam::DVec3;
use image::Rgb;
use tabray::render::Plan;
use tabray::tools::verify::{self, Verdict};

const EYE: &str = "camera eye { pixeldim 41 31 worlddim 8 6 viewpoint 4 3 7 }\n";

/// Returns the middle pixel of a scene's image, which looks along -z.
fn middle(scene: &str) -> [u8; 3] {
    let Rgb(bytes) = *render(&model(&format!("{EYE}{scene}"))).get_pixel(20, 15);
    bytes
}

#[test]
fn a_background_is_seen_at_its_full_brightness_by_itself_in_mirrors_and_through_glass() {
    let background = "background pale { colour 0.5 0.25 1 }";
    assert_eq!(middle(background), [127, 63, 255]);
    assert_eq!(middle(""), [0; 3]);
    // The distance of the mirror and the glass, and whether the viewer is near, do not matter.
    for depth in [-1, -9] {
        let mirror =
            format!("material m {{ specular 0.5 }} plane p {{ material m normal 0 0 1 point 0 0 {depth} }}");
        assert_eq!(middle(&format!("{background} {mirror}")), [63, 31, 127]);
        let glass = format!(
            "material m {{ diffuse 1 2 2 transparency 0.5 }} plane p {{ material m normal 0 0 1 point 0 0 {depth} }}"
        );
        assert_eq!(middle(&format!("{background} {glass}")), [31, 31, 127]);
    }
    // Rays are followed for 20 units.
    let far = "material m { specular 0.5 } plane p { material m normal 0 0 1 point 0 0 -14 }";
    assert_eq!(middle(&format!("{background} {far}")), [0; 3]);
}

#[test]
fn a_background_lights_no_surface() {
    let wall =
        "material m { ambient 0.5 0.5 0.5 diffuse 9 9 9 } plane p { material m normal 0 0 1 point 0 0 -2 }
        light l { location 4 3 4 emissivity 1 1 1 }";
    assert_eq!(middle(&format!("background bright {{ colour 9 9 9 }} {wall}")), middle(wall));
}

#[test]
fn a_sky_goes_from_the_horizon_to_the_zenith() {
    let look = |up: &str| format!("sky s {{ horizon 0.5 0.5 0.5 zenith 1 0 0 ground 0 0 1 up {up} }}");
    assert_eq!(middle(&look("0 0 -3")), [255, 0, 0]);
    assert_eq!(middle(&look("0 0 1")), [0, 0, 255]);
    assert_eq!(middle(&look("1 0 0")), [127, 127, 127]);
    let half = DVec3::new(3.0_f64.sqrt(), 0.0, -1.0);
    let [red, green, blue] = middle(&look(&format!("{} 0 -1", half.x)));
    assert!(red.abs_diff(191) <= 1 && green.abs_diff(63) <= 1 && blue == green, "{red} {green} {blue}");
}

#[test]
fn an_environment_shows_the_middle_of_its_picture_ahead_and_its_edge_behind() {
    let folder = root().join("scenes/entities");
    let look = |viewpoint: &str, objects: &str| {
        let scene = format!(
            "camera eye {{ pixeldim 1 1 worlddim 8 6 viewpoint {viewpoint} }}
             texture dusk {{ filename ../textures/dusk.png }} environment e {{ texture dusk }} {objects}"
        );
        render(&model_in(&folder, &scene)).get_pixel(0, 0).0
    };
    let picture = image::open(root().join("scenes/textures/dusk.png")).expect("a picture").into_rgb8();
    let near = |seen: [u8; 3], x: u32| {
        let Rgb(texel) = *picture.get_pixel(x, 64);
        assert!(seen.iter().zip(texel).all(|(one, other)| one.abs_diff(other) <= 16), "{seen:?} {texel:?}");
    };
    near(look("4 3 7", ""), 128);
    let mirror = "material m { specular 1 } plane p { material m normal 0 0 1 point 0 0 -1 }";
    near(look("4 3 7", mirror), 0);
    let aside = "material m { specular 1 } plane p { material m normal 1 0 1 point 4 3 -1 }";
    near(look("4 3 7", aside), 192);
}

#[test]
fn first_hits_before_a_background_are_proven() {
    let model = model(&format!(
        "{EYE} sky s {{ horizon 1 1 1 }} material m {{ specular 1 }} sphere b {{ material m center 4 3 -3 radius 2 }}"
    ));
    let plan = Plan::new(&model);
    for x in 0..41 {
        assert_eq!(verify::pixel(&plan, x, 15).verdict, Verdict::Proven);
    }
}
