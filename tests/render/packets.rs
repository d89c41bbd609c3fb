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
