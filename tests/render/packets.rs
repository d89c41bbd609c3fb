//! Rays traced together see what they see alone.

use crate::common::model;
use tabray::geometry::ray_packet::PACKET_SIZE;
use tabray::render::plan::Plan;
use tabray::render::trace::{BudgetCuts, RayGroup, Scratch, Tracer, VectorList};
use tabray::simd::cpu::Cpu;
use tabray::world::material::Rgb;

const SCENE: &[u8] = b"camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 7 }
    material matt { diffuse 3 2 1 }
    light lamp { location 4 5 -3 emissivity 2 2 2 }
    plane floor { material matt normal 0 1 0 point 0 0 0 }
    sphere ball { material matt center 4 1 -3 radius 1 }";

/// Traces rays through the lowest row of pixels, each with its own ray budget.
fn seen(plan: &Plan, pixels: &[usize], budgets: &[u32]) -> Vec<Rgb> {
    let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
    scratch.places = [vec![0.0; PACKET_SIZE], vec![0.0; PACKET_SIZE]];
    for (lane, column) in pixels.iter().enumerate() {
        scratch.places[0][lane] = *column as f64;
    }
    let (mut group, mut colours) = (RayGroup::default(), VectorList::default());
    let (depth, Scratch { places, lens, .. }) = (plan.depth.as_ref(), &mut scratch);
    group.look(Cpu::best(), &plan.camera, depth, places, lens, pixels.len());
    group.ray_budget[..budgets.len()].copy_from_slice(budgets);
    Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody).colours(&mut group, &mut colours);
    (0..pixels.len()).map(|lane| colours.get(lane)).collect()
}

#[test]
fn what_a_ray_sees_does_not_depend_on_what_others_may_cost() {
    let registry = Registry::get().expect("sound types");
    let model = reader::read(registry, "scene", Path::new(""), SCENE, None).expect("a sound scene").model;
    let plan = Plan::new(&model);
    let pixels: Vec<_> = (0..8).collect();
    for budgets in [[1; 8], [9; 8], [9, 1, 9, 9, 1, 9, 9, 9], [1, 9, 1, 1, 9, 1, 1, 0]] {
        let alone =
            pixels.iter().zip(budgets).map(|(pixel, ray_budget)| seen(&plan, &[*pixel], &[ray_budget])[0]);
        assert_eq!(seen(&plan, &pixels, &budgets), alone.collect::<Vec<_>>(), "{budgets:?}");
    }
    assert!(seen(&plan, &[0], &[1])[0] != Rgb::ZERO, "without a ray to the light it shines");
}
