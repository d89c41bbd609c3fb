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
use tabray::query::{Query, QueryRay, Verdict};

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
            QueryRay::new(origin, 4.0 * random.vector() - origin)
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
    let ray = QueryRay::new(DVec3::new(0.0, 0.25, 4.0), DVec3::new(0.0, 0.0, -1.0)).expect("a ray");
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
        let ray = QueryRay::new(origin, dir).expect("a ray");
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
        let ray = QueryRay::new(-10.0 * dir, dir).expect("a ray");
        let [answer] = query.proven(std::slice::from_ref(&ray), false)[..] else { panic!("one answer") };
        assert_eq!((answer.verdict, answer.t), (Verdict::Hit, 10.0 - half), "{dir}");
        let crossings = query.crossings(&ray, f64::INFINITY, false);
        let found: Vec<_> = crossings.iter().map(|of| (of.answer.verdict, of.enters)).collect();
        let right = [(Verdict::Hit, Some(true)), (Verdict::Hit, Some(false)), (Verdict::Miss, None)];
        assert_eq!(found, right, "{dir}");
        assert_eq!(crossings[1].answer.t, 10.0 + half);
    }
    // Along an edge, which belongs to the box, the ray meets it at a corner.
    let ray = QueryRay::new(DVec3::new(1.0, 9.0, 2.0), DVec3::NEG_Y).expect("a ray");
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
            let ray = QueryRay::new(DVec3::new(x, y, 2.0), DVec3::NEG_Z).expect("a ray");
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
            .map(|at| QueryRay::new(at, DVec3::NEG_Z).expect("a ray"))
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

const EYE: &str = "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 } material m { }\n";

/// Beside the edge of two faces by less than rounding, the normal and u and v are those of the face that is named: in
/// the mesh, in a copy of it, and with and without a proof.
#[test]
fn an_answer_is_a_record_of_one_face() {
    let folder = folder();
    let pair = "v 0 0 0\nv 1 0.25 0.125\nv 0.25 1 1\nv 0.5 -1 0.75\nf 1 2 3\nf 2 1 4\n";
    fs::write(folder.path().join("pair.obj"), pair).expect("a file");
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.25, 0.125], [0.25, 1.0, 1.0], [0.5, -1.0, 0.75]].map(DVec3::from);
    let faces = [[0, 1, 2], [1, 0, 3]];
    let mut random = Random(Pcg64::new(3, 5));
    for (shown, scale) in
        [("", DVec3::ONE), ("place p { object pair scale 1 2 3 }", DVec3::new(1.0, 2.0, 3.0))]
    {
        let model =
            model_in(folder.path(), &format!("{EYE} mesh pair {{ material m file pair.obj }} {shown}"));
        let query = Query::new(&model);
        let mut named = [0; 2];
        for _ in 0..300 {
            let along = 0.1 + 0.4 * (1.0 + random.part());
            let edge = (1.0 - along) * corners[0] + along * corners[1];
            let origin = DVec3::new(random.part(), 2.0 * random.part(), 5.0);
            let ray = QueryRay::new(origin, scale * edge - origin).expect("a ray");
            let rays = std::slice::from_ref(&ray);
            for answer in [query.proven(rays, false)[0], query.traced(rays)[0]] {
                let Some(surface) = query.surroundings(&ray, &answer) else { continue };
                let face = surface.face.expect("a face") as usize;
                let [a, b, c] = faces[face].map(|corner| scale * corners[corner]);
                let normal = (b - a).cross(c - a).normalize();
                assert!(surface.normal.dot(normal) > 1.0 - 1e-9, "{answer:?} {surface:?} {normal}");
                let uv = surface.uv.expect("u and v");
                let at = a + uv.x * (b - a) + uv.y * (c - a);
                assert!((at - surface.point).length() < 1e-9, "{answer:?} {surface:?} {at}");
                named[face] += 1;
            }
        }
        assert!(named.iter().all(|count| *count > 50), "{named:?}");
    }
}

/// Along a ray, crossings of a closed object enter and leave in turns, and between them the object tells the same of
/// points. Nothing is left open but for rays that touch, and all of an object has one number.
#[test]
fn crossings_of_closed_objects_enter_and_leave_in_turns() {
    let solids = [
        ("a", "sphere a { material m center 0 0 0 radius 1 }"),
        ("b", "box b { material m center 0.5 0 0 size 1 1 1 }"),
        ("r", "torus r { material m center 0 0 0 radius 0.9 tube 0.3 }"),
    ];
    let cases = [
        "sphere d { material m center 0.1 0 0 radius 1 }",
        "box d { material m center 0 0.1 0 size 1 2 1.5 }",
        "torus d { material m center 0 0 0 direction 0.3 0.1 1 radius 1 tube 0.4 }",
        "ellipsoid d { material m center 0 0 0 radius 1 scale 1 1.5 0.5 }",
        "cylinder d { material m base 0 -0.7 0 height 1.4 radius 0.8 }",
        "capsule d { material m base 0 -0.5 0 height 1 radius 0.7 }",
        "heart d { material m center 0 0 0 size 1 }",
        "lathe d { material m points 0 0 0.5 0.8 1.2 0.6 1.6 0 base 0 -0.7 0 }",
        "prism d { material m points 0 1.2 0.35 0.4 1.2 0.5 0.6 -0.6 -0.6 -0.8 -0.4 0.4 base 0 -0.5 0 height 0.9 }",
        "implicit d { material m formula \"(x^2 + z^2)*(1 + y/4) + y^2/2 - 1\" box -1.1 -1.5 -1.1 1.1 1.5 1.1 }",
        "sphere s { material m center 0 0 0 radius 1.2 }
         implicit d { material m formula \"x^2 + y^2 - z^2 - 0.1\" clip s capped yes }",
        "torus t { material m center 0 0 0 radius 0.8 tube 0.3 }
         place d { object t rotation 20 30 40 scale 1 0.5 1.5 translation 0.2 0 0 }",
        "mesh d { material m file box.obj }",
        "mesh d { material m file box.obj scale -1 1 1 }",
        "union d { material m objects a b }",
        "union d { material m objects a r }",
        "difference d { objects a b }",
        "difference d { objects a b r }",
        "intersection d { objects a b }",
        "difference c { objects a r } union d { objects c b }",
        "difference c { objects a b } place d { object c rotation 0 40 10 scale 1 2 1 }",
    ];
    let folder = folder();
    let box_of = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
        f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    fs::write(folder.path().join("box.obj"), box_of).expect("a file");
    let mut random = Random(Pcg64::new(4, 5));
    for case in cases {
        let is_used = |name: &str| case.contains("objects") && case.split(' ').any(|word| word == name);
        let used: String = solids.iter().filter(|(name, _)| is_used(name)).map(|(_, text)| *text).collect();
        let model = model_in(folder.path(), &format!("{EYE}{used}\n{case}"));
        let query = Query::new(&model);
        assert_eq!(query.number(model.objects.len() - 1), 0, "{case}");
        let (mut crossed, mut open) = (0, 0);
        for _ in 0..150 {
            let origin = 3.0 * random.vector();
            let ray = QueryRay::new(origin, random.vector() - origin).expect("a ray");
            let mut crossings = query.crossings(&ray, f64::INFINITY, false);
            let end = crossings.pop().expect("what is behind").answer;
            open += u32::from(end.verdict != Verdict::Miss);
            let shape = query.shape(0);
            let contains = |from: f64, to: f64| shape.contains(ray.at(0.5 * (from + to)), 1e-12);
            let mut from = 0.0;
            for crossing in &crossings {
                let enters = crossing.enters.expect("it is closed");
                let inside = contains(from, crossing.answer.distance);
                assert!(inside.is_none_or(|inside| inside != enters), "{case}: {ray:?} {crossing:?}");
                from = crossing.answer.distance;
            }
            let turns = crossings.windows(2).all(|pair| pair[0].enters != pair[1].enters);
            assert!(turns, "{case}: {ray:?} {crossings:?}");
            if end.verdict == Verdict::Miss {
                assert!(crossings.last().is_none_or(|last| last.enters == Some(false)), "{case}: {ray:?}");
            }
            crossed += crossings.len();
        }
        assert!(crossed > 15 && open <= 1, "{case}: {crossed} crossings, {open} open");
    }
}

/// Through vertices and along edges of a closed mesh, each ray is decided, and enters and leaves in turns. A ray that
/// only touches an edge hits it, and what lies behind is left open.
#[test]
fn rays_through_vertices_and_edges_are_decided() {
    let model = model(&format!("{EYE} box b {{ material m center 0 0 0 size 2 2 2 }}"));
    let query = Query::new(&model);
    for (origin, dir, hits) in [
        ([3.0, 3.0, 3.0], [-1.0, -1.0, -1.0], Some([2.0, 4.0])),
        ([3.0, 3.0, 0.25], [-1.0, -1.0, 0.0], Some([2.0, 4.0])),
        ([3.0, 0.5, 0.5], [-1.0, 0.0, 0.0], Some([2.0, 4.0])),
        ([3.0, 3.0, 0.5], [-0.5, -0.5, 0.0], Some([4.0, 8.0])),
        ([2.0, 0.0, 0.5], [-1.0, 1.0, 0.0], None),
        ([3.0, 1.0, 0.0], [-1.0, 0.0, 0.0], None),
    ] {
        let ray = QueryRay::new(origin.into(), dir.into()).expect("a ray");
        let first = query.proven(std::slice::from_ref(&ray), false)[0];
        assert_eq!(first.verdict, Verdict::Hit, "{origin:?}");
        let crossings = query.crossings(&ray, f64::INFINITY, false);
        let found: Vec<_> = crossings.iter().map(|of| (of.answer.verdict, of.answer.t, of.enters)).collect();
        if let Some([enters, leaves]) = hits {
            assert_eq!(first.t, enters);
            let right = [(Verdict::Hit, enters, Some(true)), (Verdict::Hit, leaves, Some(false))];
            assert_eq!(found[..2], right, "{origin:?} {found:?}");
            assert_eq!((found.len(), found[2].0), (3, Verdict::Miss));
        }
    }
}

/// A point is rounded to either side of its surface. Convex shapes tell what is right: a ray that leaves one outward hits
/// nothing, and one that goes inward hits it again.
#[test]
fn rays_that_start_on_a_surface_do_not_hit_it_there() {
    let mut random = Random(Pcg64::new(3, 7));
    let folder = folder();
    for scale in [1e-6, 1.0, 1e6] {
        let middle = scale * DVec3::new(3.1, -2.3, 5.7);
        let at = |DVec3 { x, y, z }: DVec3| format!("{x:e} {y:e} {z:e}");
        let corners =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [middle + scale * axis, middle - 0.7 * scale * axis]);
        let mut mesh: String =
            corners.iter().flatten().map(|corner| format!("v {}\n", at(*corner))).collect();
        for (x, y, z) in (0..8).map(|side| (side & 1, side >> 1 & 1, side >> 2 & 1)) {
            writeln!(mesh, "f {} {} {}", 1 + x, 3 + y, 5 + z).expect("text");
        }
        fs::write(folder.path().join("octahedron.obj"), mesh).expect("a file");
        let middle = at(middle);
        for shape in [
            "mesh m { material m file \"octahedron.obj\" }".to_owned(),
            format!("sphere m {{ material m center {middle} radius {scale:e} }}"),
            format!("ellipsoid m {{ material m center {middle} radius {scale:e} scale 1 0.5 0.8 }}"),
            format!("box m {{ material m center {middle} size {scale:e} {scale:e} {scale:e} }}"),
            format!(
                "cylinder m {{ material m base {middle} direction 1 2 3 height {scale:e} radius {scale:e} }}"
            ),
        ] {
            let model = model_in(
                folder.path(),
                &format!(
                    "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 }} material m {{ }} {shape}"
                ),
            );
            let query = Query::new(&model);
            let from = |origin: DVec3, to: DVec3| QueryRay::new(origin, to - origin);
            let centre = scale * DVec3::new(3.1, -2.3, 5.7);
            let rays: Vec<_> = (0..400)
                .filter_map(|_| {
                    let origin = centre + 9.0 * scale * random.vector();
                    from(origin, centre + 0.5 * scale * random.vector())
                })
                .collect();
            let (mut onward, mut goes_out) = (Vec::new(), Vec::new());
            for (ray, answer) in rays.iter().zip(query.proven(&rays, false)) {
                let Some(at) = query.surroundings(ray, &answer).filter(|_| answer.verdict == Verdict::Hit)
                else {
                    continue;
                };
                let dir = random.vector();
                let cosine = dir.normalize().dot(at.normal);
                if cosine.abs() < 0.01 {
                    continue;
                }
                let surface = query.surface(&answer).expect("the surface of a proven hit");
                let start = query.start(0, surface).expect("a start");
                onward.push(QueryRay::new(at.point, dir).expect("a ray").leaving(start));
                goes_out.push(cosine > 0.0);
            }
            assert!(onward.len() > 150, "{} hits: {shape}", onward.len());
            for ((ray, answer), goes_out) in onward.iter().zip(query.proven(&onward, false)).zip(goes_out) {
                let right = if goes_out { Verdict::Miss } else { Verdict::Hit };
                assert_eq!(answer.verdict, right, "{ray:?}: {shape}");
            }
        }
    }
}
