//! Rays traced together see what they see alone.

use crate::common::model;
use tabray::render::plan::Plan;
use tabray::render::trace;
use tabray::world::material::Rgb;

const SCENE: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 7 }
    material matt { diffuse 3 2 1 }
    light lamp { location 4 5 -3 emissivity 2 2 2 }
    plane floor { material matt normal 0 1 0 point 0 0 0 }
    sphere ball { material matt center 4 1 -3 radius 1 }";

/// Traces rays through the lowest row of pixels, each with its own ray budget.
fn seen(plan: &Plan, columns: &[usize], budgets: &[u32]) -> Vec<Rgb> {
    let pixels: Vec<_> = columns.iter().map(|column| [*column, 0]).collect();
    let colours = trace::within_budgets(plan, &pixels, budgets, &mut ());
    colours.into_iter().map(|(colour, _)| colour).collect()
}

#[test]
fn what_a_ray_sees_does_not_depend_on_what_others_may_cost() {
    let model = model(SCENE);
    let plan = Plan::new(&model);
    let pixels: Vec<_> = (0..8).collect();
    for budgets in [[1; 8], [9; 8], [9, 1, 9, 9, 1, 9, 9, 9], [1, 9, 1, 1, 9, 1, 1, 0]] {
        let alone =
            pixels.iter().zip(budgets).map(|(pixel, ray_budget)| seen(&plan, &[*pixel], &[ray_budget])[0]);
        assert_eq!(seen(&plan, &pixels, &budgets), alone.collect::<Vec<_>>(), "{budgets:?}");
    }
    assert!(seen(&plan, &[0], &[1])[0] != Rgb::ZERO, "without a ray to the light it shines");
}

/// Writes small spheres and triangles, of which many touch or cross each other, of one look but for each tenth.
fn many_small_objects() -> String {
    let part = |index: usize, step: f64| (index as f64 * step).fract();
    let mut text = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 7 }
        material matt { ambient 0.1 0.1 0.1 diffuse 3 2 1 }
        material other { diffuse 1 2 3 shininess 9 }
        light left { location 1 5 2 emissivity 4 4 4 }
        light right { location 7 5 -3 emissivity 2 2 2 }
        plane floor { material matt normal 0 1 0 point 0 0 0 }\n"
        .to_owned();
    for index in 0..400 {
        let material = if index % 10 == 0 { "other" } else { "matt" };
        let [x, y, z] = [8.0 * part(index, 0.819), 6.0 * part(index, 0.671), -4.0 * part(index, 0.5497)];
        text += &match index % 4 {
            0 => format!("sphere s{index} {{ material {material} center {x} {y} {z} radius 0.4 }}\n"),
            // Two triangles with an edge in common.
            1 => format!(
                "triangle a{index} {{ material {material} vertex1 {x} {y} {z} vertex2 {} {y} {z} vertex3 {x} {} {z} }}
                triangle b{index} {{ material matt vertex1 {0} {y} {z} vertex2 {0} {1} {z} vertex3 {x} {1} {z} }}\n",
                x + 0.7,
                y + 0.6
            ),
            2 => format!("ellipsoid e{index} {{ material {material} center {x} 0 {z} radius 0.3 scale 1 0.7 1.3 }}\n"),
            _ => format!(
                "triangle t{index} {{ material {material} vertex1 {x} {y} {z} vertex2 {} 0 {z} vertex3 {x} {} {} }}\n",
                x + 0.5,
                y + 0.9,
                z - 0.5
            ),
        };
    }
    text
}

#[test]
fn objects_of_one_look_are_shaded_as_each_alone() {
    let model = model(&many_small_objects());
    let plan = Plan::for_picture(&model);
    let pixels: Vec<_> = (0..16 * 12).map(|index| [index % 16, index / 16]).collect();
    let together = trace::within_budgets(&plan, &pixels, &vec![u32::MAX; pixels.len()], &mut ());
    for ([x, y], (colour, _)) in pixels.into_iter().zip(together) {
        assert_eq!(colour, trace::pixel(&plan, x, y), "{x}, {y}");
    }
}
