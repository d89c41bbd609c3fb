//! Surfaces by formulas that a closed object clips look as what they are said to be.

use crate::common::{model, render};
use image::RgbImage;

const ROOM: &str = "look_at eye { pixeldim 64 48 position 0.6 1.7 5 target 0 0 0 angle 40 }
    light lamp { location 1.7 3.1 4.3 emissivity 1 1 1 }
    material white { ambient 0.2 0.2 0.2 diffuse 0.8 0.8 0.8 }
    material red { ambient 0.2 0 0 diffuse 0.8 0.1 0.1 } ";

/// What clips, by its name. It is seen where nothing refers to it.
const CLIPS: [(&str, &str); 3] = [
    ("ball", "sphere ball { material red center 0.1 0 0 radius 1.2 } "),
    ("cube", "box cube { material red center 0.1 0 0 size 2 1.7 1.6 } "),
    (
        "turned",
        "box within { material red center 0.1 0 0 size 2 1.7 1.6 } place turned { object within rotation 20 30 0 } ",
    ),
];

fn picture(object: &str) -> RgbImage {
    let is_used = |name: &str| object.split_whitespace().any(|word| word == name);
    let clips: String = CLIPS.iter().filter(|(name, _)| is_used(name)).map(|(_, text)| *text).collect();
    render(&model(&format!("{ROOM}{clips}{object}")))
}

/// Asserts that two scenes look alike, but for pixels at which rays meet two surfaces at once.
#[track_caller]
fn are_alike(one: &str, other: &str) {
    let [one, other] = [one, other].map(picture);
    assert!(one.pixels().any(|pixel| pixel.0 != [0; 3]));
    let differing = one.pixels().zip(other.pixels()).filter(|(one, other)| one != other).count();
    assert!(differing <= 2, "{differing}");
}

#[test]
fn a_ball_cuts_a_surface_open_as_a_formula_does() {
    let cubic = "x^2 + y^2 + z^2 + 2*x*y*z - 1";
    are_alike(
        &format!("implicit own {{ material white formula \"{cubic}\" clip ball }}"),
        &format!(
            "implicit own {{ material white formula \"if((x - 0.1)^2 + y^2 + z^2 < 1.44, {cubic}, 1)\" box -1.3 -1.3 -1.3 1.4 1.3 1.3 }}"
        ),
    );
}

#[test]
fn where_a_second_formula_is_below_0_there_is_no_surface() {
    // Half a ball: its roots as a polynomial, beside the formula whose root ends it.
    are_alike(
        "implicit own { material white formula \"x^2 + y^2 + z^2 - 1\" where \"z\" box -2 -2 -2 2 2 2 }",
        "implicit own { material white formula \"z - sqrt(1 - x^2 - y^2)\" box -2 -2 -2 2 2 2 }",
    );
    // By the difference of two coordinates, and where the surface has two parts.
    are_alike(
        "implicit own { material white formula \"x^4 + y^4 + z^4 - 1\" where \"x^2 - y*z - 0.1\" box -2 -2 -2 2 2 2 }",
        "implicit own { material white formula \"if(x^2 - y*z - 0.1 > 0, x^4 + y^4 + z^4 - 1, 1 + z^2)\" box -2 -2 -2 2 2 2 }",
    );
}

#[test]
fn an_if_or_a_max_that_is_a_condition_is_where() {
    let quartic = |given: &str| format!("implicit own {{ material white {given} box -2 -2 -2 2 2 2 }}");
    let own = quartic("formula \"x^4 + y^4 + z^4 - 1\" where \"x^2 - y*z - 0.1\"");
    for formula in [
        "if(x^2 - y*z - 0.1 > 0, x^4 + y^4 + z^4 - 1, 1)",
        "if(x^2 - y*z < 0.1, 1, x^4 + y^4 + z^4 - 1)",
        "max(abs(x^4 + y^4 + z^4 - 1), 0.1 + y*z - x^2)",
    ] {
        are_alike(&own, &quartic(&format!("formula \"{formula}\"")));
    }
}

#[test]
fn a_capped_surface_is_an_intersection() {
    let egg = "(x/1.5)^2 + y^2 + z^2 - 0.9";
    for clip in ["ball", "cube", "turned"] {
        are_alike(
            &format!("implicit own {{ material white formula \"{egg}\" clip {clip} capped yes }}"),
            &format!(
                "implicit egg {{ material white formula \"{egg}\" box -2 -2 -2 2 2 2 }}
                intersection own {{ objects egg {clip} }}"
            ),
        );
    }
}

#[test]
fn a_formula_without_an_end_is_capped() {
    // Half of space, and rays that begin in it.
    for formula in ["y - 0.2 - 0.1*x", "x - y/2"] {
        let plane = format!("implicit own {{ material white formula \"{formula}\"");
        for clip in ["ball", "turned"] {
            are_alike(
                &format!("{plane} clip {clip} capped yes }}"),
                &format!(
                    "{} box -9 -9 -9 9 9 9 }} intersection near {{ objects own {clip} }}",
                    plane.replace(formula, &format!("max({formula}, x^2 + y^2 + z^2 - 70)"))
                ),
            );
        }
    }
}

/// It is told to be closed, for all that its formula takes thousands of operations.
#[test]
fn a_union_of_hundreds_of_balls_is_capped() {
    let place = |index: usize| 0.17 * index as f64 - 0.5;
    let ball = |index: usize| {
        let [x, y, z] = [index % 7, index / 7 % 7, index / 49].map(place);
        format!("sqrt((x - {x})^2 + (y - {y})^2 + (z - {z})^2) - 0.1")
    };
    let balls = (0..343).map(ball).collect::<Vec<_>>().join(", ");
    let union = |capped: &str| {
        format!("implicit own {{ material white formula \"min({balls})\" clip ball capped {capped} }}")
    };
    are_alike(&union("yes"), &union("no"));
}

#[test]
fn a_clipped_surface_can_be_placed() {
    for capped in ["no", "yes"] {
        let own = |center: &str, ball: &str| {
            format!(
                "sphere near {{ material red center {ball} radius 1 }}
                implicit own {{ material white formula \"x*y*z + x^2 - 0.3\" center {center} clip near capped {capped} }}"
            )
        };
        are_alike(
            &own("0.25 0 0", "0.25 0 0"),
            &(own("0 0 0", "0 0 0") + " place there { object own translation 0.25 0 0 }"),
        );
    }
}
