//! Hits near the ends of ranges: a hit is the same in each range that contains it.

use crate::common::model;
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use tabray::geometry::{MISS, Ray, RayRange};

/// Shapes whose hits are roots of polynomials along the ray, about as large as a world unit.
const SHAPES: [&str; 13] = [
    "heart o { material m center 0 0 0 size 1 }",
    "heart o { material m center 40.3 -7 0.1 size 0.3 }",
    "torus o { material m center 0.1 0.2 0.3 direction 1 2 3 radius 1 tube 0.3 }",
    "torus o { material m center 0 0 0 radius 0.5 tube 0.499 }",
    "capsule o { material m base 0 -0.5 0 direction 0 1 0.1 height 1 radius 0.5 }",
    "cylinder o { material m base 0 -0.5 0 direction 0.2 1 0 height 1 radius 0.5 }",
    "disc o { material m center 0 0.1 0 normal 1 3 2 radius 1 }",
    "implicit o { material m formula \"x^3 - y^2 + z^2 - 0.2\" box -1 -1 -1 1 1 1 }",
    "implicit o { material m formula \"(x^2 + y^2 + z^2 - 0.7)^3 - x^2*y^3 - z^3\" box -1 -1 -1 1 1 1 }",
    "implicit o { material m formula \"x^9 + y^9 + z^9 - 0.01\" box -1 -1 -1 1 1 1 }",
    "implicit o { material m formula \"(x^2 + y^2 - 0.3)*(y^2 + z^2 - 0.3)*(z^2 + x^2 - 0.3)\" box -1 -1 -1 1 1 1 }",
    "implicit o { material m formula \"(x*y*z)^4 + (x^2 + y^2 + z^2 - 0.7)^5\" box -1 -1 -1 1 1 1 }",
    "heart h { material m center 0 0 0 size 1 } place o { object h scale 1 2 0.7 rotation 10 20 30 }",
];

/// Rays at the first shape, where its polynomial nearly has a triple root.
const FLAT: [[[f64; 3]; 2]; 2] = [
    [
        [-5.555200346206327, -4.583806762569476, -5.925839560559522],
        [0.6016009797414656, 0.5232439907093128, 0.6035660588209886],
    ],
    [
        [-3.6596868377707574, 4.533651328819944, 5.023078790174926],
        [0.3965674498313466, -0.6394362579498599, -0.658677105836648],
    ],
];

/// Returns a number from -1 to 1.
fn part(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[test]
fn a_range_that_ends_just_behind_a_hit_keeps_it() {
    let (mut random, mut hits, mut lost) = (Pcg64::new(1, 3), 0, Vec::new());
    for (index, text) in SHAPES.into_iter().enumerate() {
        let model = model(&format!(
            "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 }} material m {{ }}\n{text}"
        ));
        let shape = &model.objects.last().expect("an object").shape;
        let middle = shape.bounds().expect("a box").middle();
        let mut rays: Vec<_> =
            FLAT.into_iter().filter(|_| index == 0).map(|ray| ray.map(DVec3::from)).collect();
        rays.extend((0..2000).map(|_| {
            let [from, to] = [6.0, 1.0].map(|size| size * DVec3::from([0; 3].map(|_| part(&mut random))));
            [middle + from, (to - from).normalize()]
        }));
        for [origin, dir] in rays {
            let ray = Ray { origin, dir };
            let distance = shape.distance(&ray, &RayRange::ALL);
            if distance == MISS {
                continue;
            }
            hits += 1;
            let until = RayRange { far: distance.next_up(), ..RayRange::ALL };
            let from = RayRange { near: distance.next_down(), ..RayRange::ALL };
            for range in [until, from] {
                let found = shape.distance(&ray, &range);
                if found != distance {
                    lost.push(format!("{found} in place of {distance} in {range:?}: {ray:?}\n{text}"));
                }
            }
        }
    }
    assert!(hits > 10_000 && lost.is_empty(), "{} of {hits}, such as {:?}", lost.len(), lost.first());
}
