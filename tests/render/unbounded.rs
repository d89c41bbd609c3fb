//! Pixels with several samples, where nothing bounds the light that rays may return.

use crate::common::model;
use tabray::render::plan::Plan;
use tabray::render::ray_stats::RayStats;
use tabray::render::trace::{self, Scratch, Tracer};
use tabray::scene::model::Model;
use tabray::simd::cpu::Cpu;
use tabray::tools::threads::renderer_with;
use tabray::world::material::Rgb;
use tabray::world::sensor::Adaptive;

/// Panes that pass on more light than they receive.
const SCENE: &str = "camera eye { pixeldim 5 4 worlddim 8 6 viewpoint 4 3 6 samples 5 }
    material g { ambient 0.5 0.6 0.7 diffuse 1 1 1 specular 0.9 transparency 0.9 }
    plane p0 { material g normal 0 0 1 point 0 0 -1 }
    plane p1 { material g normal 0.01 0 1 point 0 0 -1.5 }
    plane p2 { material g normal 0 0 1 point 0 0 -2 }
    plane p3 { material g normal 0 0 1 point 0 0 -2.5 }
    plane p4 { material g normal 0 0 1 point 0 0 -3 }";

fn loaded() -> Model {
    model(SCENE)
}

/// Renders all pixels in one packet, with what that took, and checks that their number is that of those cut short.
fn together(plan: &Plan) -> (Vec<Rgb>, u64) {
    let (mut scratch, mut stats) = (Scratch::default(), RayStats::default());
    let colours = renderer_with(1).expect("a thread").run(|| {
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut stats);
        let seen = tracer.pixels(&pixels());
        (0..20).map(|lane| seen.get(lane)).collect()
    });
    assert_eq!(stats.flaws.cuts.pixels, 20);
    (colours, stats.all_rays())
}

/// Renders one pixel after the other.
fn alone(plan: &Plan) -> Vec<Rgb> {
    let renderer = renderer_with(1).expect("a thread");
    renderer.run(|| pixels().iter().map(|[x, y]| trace::pixel(plan, *x, *y)).collect())
}

fn pixels() -> Vec<[usize; 2]> {
    (0..4).flat_map(|row| (0..5).map(move |column| [column, row])).collect()
}

#[test]
fn a_pixel_off_by_an_unknown_amount_costs_as_one_of_a_single_sample() {
    let model = loaded();
    let plan = Plan::new(&model);
    assert!(plan.depth.as_ref().is_some_and(|depth| !depth.most.is_finite()), "nothing bounds the light");
    let (colours, rays) = together(&plan);
    // Five samples of 20 pixels would cost 2,000,000. The first sample may be one that does not meet the limit.
    assert!((400_000..500_000).contains(&rays), "{rays} rays");
    assert_eq!(colours, alone(&plan));
}

#[test]
fn a_pixel_off_by_an_unknown_amount_takes_no_more_samples_than_the_first() {
    let mut model = loaded();
    model.camera.value.samples = 4;
    let fixed = Plan::new(&model).camera;
    model.camera.value.adaptive = Some(Adaptive { most: 64, error: Some(1e-9) });
    let mut plan = Plan::new(&model);
    let (colours, rays) = together(&plan);
    // One sample of each of 42 pixels, in the image and around it, may cost 20,000 rays.
    assert!((400_000..900_000).contains(&rays), "{rays} rays");
    assert_eq!(colours, alone(&plan));
    plan.camera = fixed;
    assert_eq!(colours, alone(&plan));
}
