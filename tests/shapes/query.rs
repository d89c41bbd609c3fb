//! What rays hit, asked without an image.

use crate::common::program::folder;
use crate::common::{model, model_in};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::fmt::Write;
use std::fs;
use std::time::Instant;
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

/// A ray that starts inside or outside enters and leaves each ball in turns, at the roots of its equation.
#[test]
fn all_crossings_of_balls_are_the_roots_in_their_order() {
    let mut random = Random(Pcg64::new(2, 5));
    let mut scene =
        "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }\n".to_owned();
    let balls: Vec<_> = (0..30).map(|_| (3.0 * random.vector(), 0.2 + 2.0 * random.part().abs())).collect();
    for (index, (DVec3 { x, y, z }, radius)) in balls.iter().enumerate() {
        writeln!(scene, "sphere s{index} {{ material m center {x} {y} {z} radius {radius} }}").expect("text");
    }
    let model = model(&scene);
    let query = Query::new(&model);
    let mut crossed = 0;
    for _ in 0..200 {
        let (origin, dir) = (5.0 * random.vector(), random.vector());
        let mut roots: Vec<(f64, usize, bool)> = Vec::new();
        for (index, (center, radius)) in balls.iter().enumerate() {
            let (a, b) = (dir.length_squared(), dir.dot(origin - center));
            let c = (origin - center).length_squared() - radius * radius;
            let root = (b * b - a * c).sqrt();
            let both = [((-b - root) / a, index, true), ((-b + root) / a, index, false)];
            roots.extend(both.into_iter().filter(|(t, ..)| *t > 0.0));
        }
        roots.sort_by(|one, other| one.0.total_cmp(&other.0));
        let ray = ExactRay::new(origin, dir).expect("a ray");
        let mut crossings = query.crossings(&ray, f64::INFINITY, false);
        let last = crossings.pop().expect("what is behind").answer;
        assert_eq!((last.verdict, last.object), (Verdict::Miss, None));
        assert_eq!(crossings.len(), roots.len(), "{ray:?}");
        for (crossing, (t, object, enters)) in crossings.iter().zip(&roots) {
            assert_eq!((crossing.answer.object, crossing.enters), (Some(*object), Some(*enters)));
            assert!((crossing.answer.t - t).abs() < 1e-9 * (1.0 + t), "{t}");
        }
        if let [.., (end, ..), _] = roots[..] {
            let before = query.crossings(&ray, end, false);
            assert!(
                before.len() < roots.len()
                    && before.last().is_some_and(|last| last.answer.verdict != Verdict::Hit)
            );
        }
        crossed += crossings.len();
    }
    assert!(crossed > 300, "{crossed}");
}

/// The sides of a box are cut into triangles, which an answer must not depend on.
#[test]
fn a_ray_through_the_middle_of_a_box_enters_and_leaves_it() {
    let model = model(
        "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }
         box b { material m center 0 0 0 size 2 3 4 }",
    );
    let query = Query::new(&model);
    for (dir, half) in [(DVec3::NEG_X, 1.0), (DVec3::NEG_Y, 1.5), (DVec3::NEG_Z, 2.0)] {
        let ray = ExactRay::new(-10.0 * dir, dir).expect("a ray");
        let [answer] = query.proven(std::slice::from_ref(&ray), false)[..] else { panic!("one answer") };
        assert_eq!((answer.verdict, answer.t), (Verdict::Hit, 10.0 - half), "{dir}");
        let crossings = query.crossings(&ray, f64::INFINITY, false);
        let found: Vec<_> = crossings.iter().map(|of| (of.answer.verdict, of.enters)).collect();
        let right = [(Verdict::Hit, Some(true)), (Verdict::Hit, Some(false)), (Verdict::Miss, None)];
        assert_eq!(found, right, "{dir}");
        assert_eq!(crossings[1].answer.t, 10.0 + half);
    }
    // Along an edge, which belongs to the box, the ray meets it at a corner.
    let ray = ExactRay::new(DVec3::new(1.0, 9.0, 2.0), DVec3::NEG_Y).expect("a ray");
    let answer = query.proven(&[ray], false)[0];
    assert_eq!((answer.verdict, answer.t), (Verdict::Hit, 7.5));
}

/// Beside an edge by less than what the tracer's point is rounded by, the face is that of the real ray.
#[test]
fn the_face_of_a_proven_hit_is_that_of_the_real_ray() {
    let folder = folder();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("square.obj"), square).expect("a file");
    let scene = "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }
        mesh square { material m file square.obj }";
    let model = model_in(folder.path(), scene);
    let query = Query::new(&model);
    for x in [0.5, 0.3, 0.7, 1.0 / 3.0] {
        for (y, right) in [(f64::next_down(x), 0), (f64::next_up(x), 1)] {
            let ray = ExactRay::new(DVec3::new(x, y, 2.0), DVec3::NEG_Z).expect("a ray");
            let [answer] = query.proven(std::slice::from_ref(&ray), false)[..] else { panic!("one answer") };
            let face = query.surroundings(&ray, &answer).and_then(|surface| surface.face);
            assert_eq!((answer.verdict, face), (Verdict::Hit, Some(right)), "{x} {y}");
        }
    }
}

/// A ray along an axis, through the line between faces, is compared with the faces that it may meet alone: in a hundred
/// times as many faces, it takes no more than a few times as long.
#[test]
fn a_ray_through_an_edge_takes_about_as_long_in_a_large_mesh() {
    let time = |side: u32| {
        let mut grid = String::new();
        for (x, y) in (0..=side).flat_map(|x| (0..=side).map(move |y| (x, y))) {
            writeln!(grid, "v {x} {y} 0").expect("text");
        }
        for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
            let [a, b] = [x, x + 1].map(|x| x * (side + 1) + y + 1);
            writeln!(grid, "f {a} {b} {} {}", b + 1, a + 1).expect("text");
        }
        let folder = folder();
        fs::write(folder.path().join("grid.obj"), grid).expect("a file");
        let scene = "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }
            mesh grid { material m file grid.obj }";
        let model = model_in(folder.path(), scene);
        let query = Query::new(&model);
        let rays: Vec<_> = (0..9)
            .map(|at| DVec3::new(2.0, 2.0 + 0.25 * f64::from(at), 9.0))
            .map(|at| ExactRay::new(at, DVec3::NEG_Z).expect("a ray"))
            .collect();
        let once = || {
            let start = Instant::now();
            let answers = query.proven(&rays, false);
            assert!(
                answers.iter().all(|answer| answer.verdict == Verdict::Hit && answer.t == 9.0),
                "{answers:?}"
            );
            start.elapsed()
        };
        (0..3).map(|_| once()).min().expect("three times")
    };
    let [few, many] = [time(6), time(60)];
    println!("{few:?} in 72 faces, {many:?} in 7,200");
    assert!(many < 10 * few, "{few:?}, {many:?}");
}
