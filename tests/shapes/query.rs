//! What rays hit, asked without an image.

use crate::common::model;
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::fmt::Write;
use tabray::query::first::first_of;
use tabray::query::{ExactRay, Query, Verdict};

struct Random(Pcg64);

impl Random {
    /// Returns a number from -1 to 1.
    fn part(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.part(), self.part(), self.part())
    }
}

/// In a scene with a tree, objects are left out by their boxes, which changes no answer.
#[test]
fn a_tree_leaves_out_what_no_ray_hits_first() {
    let mut random = Random(Pcg64::new(1, 5));
    let mut scene = "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }
        plane floor { material m normal 0 1 0 point 0 -2 0 }\n"
        .to_owned();
    for index in 0..60 {
        let DVec3 { x, y, z } = 4.0 * random.vector();
        let radius = 0.1 + 0.5 * random.part().abs();
        writeln!(scene, "sphere s{index} {{ material m center {x} {y} {z} radius {radius} }}").expect("text");
    }
    let model = model(&scene);
    let query = Query::new(&model);
    let rays: Vec<_> = (0..400)
        .filter_map(|_| {
            let origin = 7.0 * random.vector();
            ExactRay::new(origin, 4.0 * random.vector() - origin)
        })
        .collect();
    let found = query.first_hits(&rays);
    let mut hits = 0;
    for (ray, found) in rays.iter().zip(&found) {
        let all = first_of(model.objects.iter().map(|object| &object.shape).enumerate(), ray.sight());
        assert_eq!(query.first(ray, found.as_ref()), all, "{ray:?}");
        assert_eq!(query.first(ray, None), all, "{ray:?}");
        assert!(all.0.may_be(found.as_ref().map(|hit| hit.index)), "{ray:?}");
        hits += u32::from(found.is_some());
    }
    assert!(hits > 100, "{hits}");
}

/// Of two balls in one place, a ray certainly hits one.
#[test]
fn what_is_hit_is_certain_where_it_is_not_which() {
    let model = model(
        "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }
         sphere one { material m center 0 0 0 radius 1 } sphere two { material m center 0 0 0 radius 1 }",
    );
    let ray = ExactRay::new(DVec3::new(0.0, 0.25, 4.0), DVec3::new(0.0, 0.0, -1.0)).expect("a ray");
    let [answer] = Query::new(&model).proven(&[ray], false)[..] else { panic!("one answer") };
    assert_eq!((answer.verdict, answer.object), (Verdict::Tie, Some(0)));
    for (t_max, verdict) in [(5.0, Verdict::Hit), (2.0, Verdict::Miss), (answer.t, Verdict::Undecided)] {
        assert_eq!(answer.any_within(t_max).verdict, verdict, "{t_max}");
    }
}
