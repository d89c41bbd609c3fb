//! What is left out of a look, and what the limit on rays cuts off.

use crate::common::model as loaded;
use tabray::render::limits::MAX_RAYS;
use tabray::render::plan::Plan;
use tabray::render::plan::depth::{Depth, FAINT};
use tabray::render::ray_stats::RayStats;
use tabray::render::trace;
use tabray::scene::model::Model;
use tabray::tools::threads::renderer_with;
use tabray::world::material::Rgb;

const SIDES: [usize; 2] = [5, 4];

fn model(entities: &str) -> Model {
    let text = format!("camera eye {{ pixeldim 5 4 worlddim 8 6 viewpoint 4 3 6 }}\n{entities}");
    loaded(&text)
}

/// Makes a plan without cuts.
fn whole(model: &Model) -> Plan<'_> {
    let mut plan = Plan::new(model);
    plan.depth = Depth::new(model).map(Depth::uncut);
    plan
}

/// Renders all pixels with a ray budget: returns their colours, bounds on what these lack, and the rays that were
/// cast.
fn seen(plan: &Plan, rays: u32) -> (Vec<(Rgb, f64)>, RayStats) {
    let mut stats = RayStats::default();
    let pixels = (0..SIDES[1]).flat_map(|y| (0..SIDES[0]).map(move |x| [x, y]));
    let pixels = pixels.map(|pixel| trace::within_budgets(plan, &[pixel], &[rays], &mut stats)[0]).collect();
    (pixels, stats)
}

/// Runs work on a thread whose stack is large enough for deep reflections.
fn deep<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    renderer_with(1).expect("a thread").run(work)
}

fn error(one: Rgb, other: Rgb) -> f64 {
    (one - other).abs().max_element()
}

const PANES: &str = "material g { ambient 0.5 0.6 0.7 diffuse 1 1 1 specular 0.1 transparency 0.5 }
    plane p0 { material g normal 0 0 1 point 0 0 -1 }
    plane p1 { material g normal 0 0 1 point 0 0 -1.5 }
    plane p2 { material g normal 0 0 1 point 0 0 -2 }";

/// Renders three panes of this specular reflectivity with and without cuts: returns the largest difference, and how
/// many times as many rays are cast without cuts.
fn panes(specular: &str) -> (f64, f64) {
    let panes = PANES.replace("0.1", specular);
    let (cut, few) = seen(&Plan::new(&model(&panes)), MAX_RAYS as u32);
    let (all, many) = deep(|| seen(&whole(&model(&panes)), u32::MAX));
    assert!(cut.iter().all(|(_, missing)| *missing == 0.0));
    let error = cut.iter().zip(&all).map(|((cut, _), (all, _))| error(*cut, *all)).fold(0.0, f64::max);
    (error, many.all_rays() as f64 / few.all_rays() as f64)
}

#[test]
fn panes_look_the_same_for_a_part_of_the_rays() {
    let (error, times) = panes("0.1");
    assert!(error < FAINT && times > 50.0, "{error} off, {times} times as many");
    // These panes pass on all or nearly all light that they receive: many branches are cut, each of which by itself adds less than
    // is seen. The error is far below a level.
    for specular in ["0.4", "0.5"] {
        let (error, times) = panes(specular);
        assert!(error < 128.0 * FAINT && times > 2.0, "{error} off, {times} times as many");
    }
}

#[test]
fn what_is_transmitted_leaves_rays_for_the_first_reflections() {
    let panes = PANES.replace("specular 0.1", "specular 0.5");
    let ball = "material b { ambient 9 9 9 } sphere ball { material b center 4 6.4 13 radius 3 }";
    let (with, without) = (model(&format!("{panes} {ball}")), model(&panes));
    let middle = 2 * SIDES[0] + 2;
    let of_ball = |budget: u32| {
        let [with, without] = [&with, &without].map(|model| {
            let (pixels, stats) = seen(&whole(model), budget);
            // Those that end at once are counted, too.
            assert!(stats.all_rays() < 20 * u64::from(budget) * 11 / 10, "{} rays", stats.all_rays());
            pixels[middle]
        });
        assert!(without.1 > 0.0, "the budget is used up");
        (with.0 - without.0).max_element()
    };
    // Half of what the ball shows at the end of a path of 18 units.
    let whole = 0.5 * 9.0 / 18.0;
    for budget in [256, 2000] {
        let seen = of_ball(budget);
        assert!(seen > 0.9 * whole, "{budget}: {seen} of {whole}");
    }
}

/// Glass that transmits and reflects more than it receives, where no ray returns to it.
#[test]
fn what_gives_on_more_than_it_gets_has_a_bound_where_rays_do_not_come_back() {
    let pane = "material g { ambient 1 1 1 specular 0.9 transparency 0.9 } material m { ambient 3 3 3 }
        plane back { material m normal 0 0 1 point 0 0 -9 }
        plane pane { material g normal 0 0 1 point 0 0 -3 }";
    let pair = format!("{pane} plane floor {{ material g normal 0 1 0 point 0 0 0 }}");
    for (scene, is_bounded) in [(pane, true), (&pair, false)] {
        let depth = Depth::new(&model(scene)).expect("a pane");
        assert_eq!(depth.most.is_finite(), is_bounded, "{scene}");
    }
}

/// Returns a pseudorandom number from 0 to 1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Makes scenes of reflecting and transparent planes and spheres, with a light; some colours are negative.
fn scenes(count: usize, gain: f64) -> Vec<String> {
    let mut state = 14;
    let mut from = |low: f64, high: f64| low + (high - low) * random(&mut state);
    let scene = |_| {
        let mut text = String::new();
        for index in 0..5 {
            let transparency = if from(0.0, 1.0) < 0.6 { from(0.0, gain) } else { 0.0 };
            let specular = if from(0.0, 1.0) < 0.7 { from(-0.2, gain - transparency) } else { 0.0 };
            let [a, b, c, d] = [from(-1.0, 4.0), from(0.0, 3.0), from(0.0, 3.0), from(-0.5, 3.0)];
            text += &format!(
                "material m{index} {{ ambient {a} {b} 1 diffuse {c} {d} 1 specular {specular} transparency {transparency} shininess {} }}\n",
                from(0.0, 30.0),
            );
        }
        text +=
            &format!("light l {{ location {} 5 2 emissivity {} 3 -2 }}\n", from(3.0, 5.0), from(1.0, 20.0));
        for (index, depth) in [-1.0, -2.5, -4.0].into_iter().enumerate() {
            let (x, y) = (from(-0.3, 0.3), from(-0.3, 0.3));
            text += &format!("plane p{index} {{ material m{index} normal {x} {y} 1 point 4 3 {depth} }}\n");
        }
        for index in 0..2 {
            let [x, y, z] = [from(2.0, 6.0), from(1.0, 5.0), from(-6.0, -1.0)];
            text += &format!(
                "sphere s{index} {{ material m{} center {x} {y} {z} radius {} }}\n",
                index + 3,
                from(0.3, 1.5)
            );
        }
        text
    };
    (0..count).map(scene).collect()
}

#[test]
fn what_is_left_out_of_a_look_is_below_a_1024th_of_a_level() {
    let mut saved = 0;
    for scene in scenes(60, 0.55).into_iter().chain(scenes(60, 0.8)) {
        let (cut, few) = seen(&Plan::new(&model(&scene)), 1 << 30);
        let (all, many) = deep(|| seen(&whole(&model(&scene)), 1 << 20));
        saved += many.all_rays() - few.all_rays();
        for ((cut, missing), (all, unseen)) in cut.into_iter().zip(all) {
            assert_eq!([missing, unseen], [0.0; 2], "{scene}");
            assert!(error(cut, all) < FAINT, "{cut} for {all}, {} off\n{scene}", error(cut, all));
        }
    }
    assert!(saved > 0);
}

#[test]
fn what_is_left_out_before_a_background_is_below_a_1024th_of_a_level() {
    let mut saved = 0;
    for scene in scenes(60, 0.6) {
        let scene = format!("{scene} sky s {{ horizon 2 3 4 zenith 9 0 1 ground 0 5 0 }}");
        let (cut, few) = seen(&Plan::new(&model(&scene)), 1 << 30);
        let (all, many) = deep(|| seen(&whole(&model(&scene)), 1 << 20));
        saved += many.all_rays() - few.all_rays();
        for ((cut, missing), (all, unseen)) in cut.into_iter().zip(all) {
            assert_eq!([missing, unseen], [0.0; 2], "{scene}");
            assert!(error(cut, all) < FAINT, "{cut} for {all}\n{scene}");
        }
    }
    assert!(saved > 0);
}

#[test]
fn what_a_cap_cuts_before_a_background_is_no_more_than_is_said() {
    for scene in scenes(20, 0.6) {
        let scene = format!("{scene} background b {{ colour 3 0.5 1 }}");
        let (all, _) = deep(|| seen(&whole(&model(&scene)), 1 << 20));
        let cut = model(&scene);
        for rays in [2, 5, 17, 100] {
            for ((cut, missing), (all, _)) in seen(&Plan::new(&cut), rays).0.into_iter().zip(&all) {
                let error = error(cut, *all);
                assert!(error <= missing + FAINT, "{error} off, of {missing} at {rays} rays\n{scene}");
            }
        }
    }
}

#[test]
fn many_mirrors_have_a_bound_too() {
    let ball = |index: usize| {
        let [x, y, z] = [index % 8, index / 8 % 6, index / 48].map(|place| place as f64);
        format!("sphere s{index} {{ material m center {x} {y} {} radius 0.1 }}\n", -4.0 - z)
    };
    let balls: String = (0..100).map(ball).collect();
    let scene = format!("{PANES} material m {{ ambient 1 0.5 2 specular 0.3 transparency 0.3 }} {balls}");
    let (cut, few) = seen(&Plan::new(&model(&scene)), 1 << 30);
    let (all, many) = deep(|| seen(&whole(&model(&scene)), 1 << 30));
    for ((cut, _), (all, _)) in cut.into_iter().zip(all) {
        assert!(error(cut, all) < FAINT, "{cut} for {all}");
    }
    assert!(10 * few.all_rays() < many.all_rays(), "{} of {}", few.all_rays(), many.all_rays());
}

#[test]
fn what_a_cap_cuts_is_no_more_than_is_said() {
    for scene in scenes(60, 0.6) {
        let (all, _) = deep(|| seen(&whole(&model(&scene)), 1 << 20));
        let cut = model(&scene);
        for rays in [2, 3, 5, 9, 17, 40, 100] {
            for ((cut, missing), (all, unseen)) in seen(&Plan::new(&cut), rays).0.into_iter().zip(&all) {
                assert_eq!(*unseen, 0.0, "{scene}");
                let error = error(cut, *all);
                assert!(error <= missing + FAINT, "{error} off, of {missing} at {rays} rays\n{scene}");
            }
        }
    }
}
