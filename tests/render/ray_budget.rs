//! What rays cost whose hits take long to find.

use crate::common::{Onlooker, model};
use tabray::render::plan::Plan;
use tabray::render::ray_stats::RayStats;
use tabray::render::trace::{self, Scratch, Tracer};
use tabray::simd::cpu::Cpu;
use tabray::tools::threads::renderer_with;
use tabray::world::material::Rgb;

const SCENE: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }
    material glass { ambient 1 1 1 diffuse 3 3 3 specular 0.6 transparency 0.6 }
    light lamp { location 1 7 2 emissivity 20 20 20 }";

/// Bends ever more often toward its lower end, so that hits there take many pieces.
const WILD: &str = "revsurf wild { material glass profile \"0.3 + abs(cos(sqrt(0.4 / y)))\" \
    direction 0 1 0.3 base 4 1 -2 height 3 }";

/// Is cut into thousands of slabs.
const LONG: &str = "revsurf long { material glass profile \"cos(sin(y) + 1e-8 - exp(y))\" \
    direction 0 1 0.3 base 4 -2 -2 height 7.88 }";

/// A heart of glass, of which each search takes as long as 60 plain rays.
const HEART: &str = "heart heart { material glass center 4 3 -2 size 2 }";

/// Renders all pixels in packets and one by one, where every step is reported; returns how many rays were cast in
/// packets, and how many pixels were cut off.
fn rays(surface: &str) -> (usize, u64) {
    let model = model(&format!("{SCENE}\n{surface}"));
    let plan = Plan::new(&model);
    let pixels: Vec<_> = (0..6).flat_map(|row| (0..8).map(move |column| [column, row])).collect();
    let (mut scratch, mut stats) = (Scratch::default(), RayStats::default());
    let renderer = renderer_with(1).expect("a thread");
    let together: Vec<Rgb> = renderer.run(|| {
        let mut tracer = Tracer::new(&plan, Cpu::best(), &mut scratch, &mut stats);
        let seen = tracer.pixels(&pixels);
        (0..pixels.len()).map(|lane| seen.get(lane)).collect()
    });
    let alone: Vec<Rgb> = renderer.run(|| {
        let reported = |[x, y]: &[usize; 2]| trace::observe_pixel(&plan, *x, *y, &mut Onlooker);
        pixels.iter().map(reported).collect()
    });
    assert_eq!(together, alone, "{surface}");
    (stats.all_rays() as usize, stats.flaws.cuts.pixels)
}

#[test]
fn rays_whose_hits_take_long_to_find_count_as_many() {
    let (wild, cut) = rays(WILD);
    assert!(wild < 10_000 && cut == 2, "{wild} rays, {cut} pixels");
    let (long, cut) = rays(LONG);
    assert!(long < 20_000 && cut == 6, "{long} rays, {cut} pixels");
}

/// `rays` compares the two.
#[test]
fn copies_of_a_wild_profile_have_the_same_bits_in_packets_and_alone() {
    for step in 0..12 {
        let surface = WILD.replace("0.3 +", &format!("{} +", 0.2 + 0.05 * f64::from(step)));
        rays(&format!("{surface}\nplace copy {{ object wild material glass rotation 0 0.1 0 }}"));
    }
}

#[test]
fn rays_through_many_copies_count_as_many() {
    let copies = |name: &str, count: usize| -> String {
        let copy = |index| {
            let turned = 0.1 * index as f64;
            format!("\nplace p{index} {{ object {name} material glass rotation 0 {turned} 0 }}")
        };
        (0..count).map(copy).collect()
    };
    for (surface, name, most) in [(HEART, "heart", 2000), (WILD, "wild", 5000)] {
        let (few, _) = rays(&format!("{surface}{}", copies(name, 4)));
        let (many, cut) = rays(&format!("{surface}{}", copies(name, 40)));
        assert!(many < few && many < most && cut > 0, "{name}: {few} and {many} rays, {cut} pixels");
    }
}
