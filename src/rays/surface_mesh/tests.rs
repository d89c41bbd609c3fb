//! Tests of meshes of objects.

use super::triangles::Vertex;
use super::*;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray_core::scene::Model;
use tabray_lang::{Registry, read};

fn model(objects: &str) -> Model {
    let text = format!(
        "orthographic eye {{ pixeldim 4 4  position 0 0 9  target 0 0 0  width 4 }} material m {{ diffuse 1 1 1 }} {objects}"
    );
    let registry = Registry::get().expect("the entity types of tabray");
    match read(registry, "a.ray", Path::new(""), text.as_bytes(), None) {
        Ok(loaded) => loaded.model,
        Err(report) => panic!("{report}"),
    }
}

fn implicit(formula: &str, half: f64) -> String {
    format!(
        "implicit a {{ material m  formula \"{formula}\"  box -{half} -{half} -{half}  {half} {half} {half} }}"
    )
}

const BALL: &str = "sphere a { material m  center 0 0 0  radius 1 }";

const SOLID: &str = "box cube { material m  center 0 0 0  size 2 2 2 }
    sphere ball { material m  center 1 1 1  radius 1 }
    difference a { objects cube ball }";

/// Makes the mesh of the object `a`, and counts its edges.
fn meshed(objects: &str, error: f64) -> SurfaceMesh {
    let model = model(objects);
    let body = Body::of(&model, "a").expect("a closed object");
    closed(mesh(&body, error, None, &|_| ()).expect("a mesh"))
}

/// Makes the mesh of the surface of the object `a` with a thickness; half of the error is for either step.
fn thickened(objects: &str, thickness: f64, error: f64) -> SurfaceMesh {
    let model = model(objects);
    let sheet = Sheet::of(&model, "a").expect("an object with an equation");
    let body = sheet.thickened(thickness, error / 2.0, None, &|_| ()).expect("a body");
    closed(mesh(&body, error / 2.0, None, &|_| ()).expect("a mesh"))
}

/// Returns a mesh, after its edges are counted.
fn closed(made: SurfaceMesh) -> SurfaceMesh {
    let mut edges = std::collections::BTreeMap::new();
    for [a, b, c] in &made.faces {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert_ne!(from, to);
            assert!(edges.insert((*from, *to), ()).is_none(), "an edge has two triangles on one side");
        }
    }
    assert!(edges.keys().all(|(from, to)| edges.contains_key(&(*to, *from))), "an edge has one triangle");
    made
}

/// The triangles between corners of cells of at most this side.
fn before_merging(body: &Body<'_>, side: f64) -> Triangles {
    let mut cells = Cells::enclosing(&body.bounds);
    while cells.side() > side {
        cells
            .halve(&|middle, half| body.contains(middle, half).is_none(), usize::MAX, &|_| ())
            .expect("any number of cells");
    }
    Triangles::of(&cells, body, &|_| ())
}

/// Returns the number of vertices and faces minus that of edges: 2 for a ball, 0 for a ring.
fn characteristic(mesh: &SurfaceMesh) -> i64 {
    mesh.vertices.len() as i64 - mesh.faces.len() as i64 / 2
}

/// Points of the mesh: corners and middles of triangles.
fn samples(mesh: &SurfaceMesh) -> Vec<DVec3> {
    let corners = |face: &[u32; 3]| face.map(|corner| mesh.vertices[corner as usize]);
    mesh.faces.iter().map(corners).flat_map(|[a, b, c]| [a, (a + b) / 2.0, (a + b + c) / 3.0]).collect()
}

#[test]
fn a_sphere_is_within_its_error_of_its_mesh() {
    let error = 0.01;
    let made = meshed("sphere a { material m  center 1 2 3  radius 1 }", error);
    assert!(made.far.is_empty() && made.tangled.as_ref().is_some_and(Vec::is_empty), "{:?}", made.tangled);
    assert_eq!(characteristic(&made), 2);
    let (center, points) = (DVec3::new(1.0, 2.0, 3.0), samples(&made));
    assert!(points.iter().all(|at| (at.distance(center) - 1.0).abs() <= error));
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    assert!((made.volume() - ball).abs() < 4.0 * std::f64::consts::PI * error, "{}", made.volume());
    // And each point of the sphere has a point of the mesh nearby.
    for at in 0..200 {
        let (height, angle) = (-0.99 + 0.0099 * f64::from(at), 2.4 * f64::from(at));
        let side = (1.0 - height * height).sqrt();
        let on = center + DVec3::new(side * libm::cos(angle), height, side * libm::sin(angle));
        let nearest = points.iter().map(|point| point.distance(on)).fold(f64::MAX, f64::min);
        assert!(nearest <= error + made.cell, "{on}: {nearest}");
    }
}

#[test]
fn a_ring_has_a_hole_and_faces_outward() {
    let made = meshed(&implicit("(x^2 + y^2 + z^2 + 0.84)^2 - 4*(x^2 + y^2)", 1.5), 0.1);
    assert!(made.far.is_empty());
    assert_eq!(characteristic(&made), 0);
    let ring = 2.0 * std::f64::consts::PI * std::f64::consts::PI * 0.16;
    assert!((made.volume() - ring).abs() < 0.5, "{} of {ring}", made.volume());
    let distance = |at: DVec3| (libm::hypot(libm::hypot(at.x, at.y) - 1.0, at.z) - 0.4).abs();
    assert!(samples(&made).into_iter().map(distance).all(|distance| distance <= 0.1));
}

#[test]
fn what_a_box_cuts_is_closed_by_its_faces() {
    let gyroid = "sin(3*x)*cos(3*y) + sin(3*y)*cos(3*z) + sin(3*z)*cos(3*x)";
    let made = meshed(&implicit(gyroid, 1.0), 0.2);
    assert!(made.far.is_empty() && made.tangled.is_none());
    // Half of the box is inside, nearly.
    assert!((3.0..5.0).contains(&made.volume()), "{}", made.volume());
    let model = model(&implicit("z", 1.0));
    let body = Body::of(&model, "a").expect("a closed object");
    assert_eq!(body.closed_by, Some("the faces of its box"));
    let half = mesh(&body, 0.2, None, &|_| ()).expect("a mesh");
    assert!(half.far.is_empty() && (half.volume() - 4.0).abs() < 3.0, "{}", half.volume());
    assert!(samples(&half).iter().all(|at| at.z < 0.2 && at.abs().max_element() < 1.2));
}

#[test]
fn a_solid_with_edges_is_within_its_error() {
    let made = meshed(SOLID, 0.15);
    assert!(made.far.is_empty(), "{:?}", made.far);
    assert_eq!(characteristic(&made), 2);
    let volume = 8.0 - std::f64::consts::PI / 6.0;
    assert!((made.volume() - volume).abs() < 24.0 * 0.15, "{}", made.volume());
}

#[test]
fn nodes_are_named_where_parts_meet() {
    // Two cones that meet in a point, within a ball.
    let made = meshed(&implicit("max(x^2 + y^2 - z^2, x^2 + y^2 + z^2 - 1)", 1.5), 0.1);
    let tangled = made.tangled.expect("it was examined");
    assert!(
        tangled.iter().any(|[low, high]| low.max_element() <= 0.0 && high.min_element() >= 0.0),
        "{tangled:?}"
    );
    assert!(made.far.is_empty());
}

#[test]
fn what_is_moved_off_the_surface_is_found() {
    let (model, error) = (model(BALL), 0.01);
    let body = Body::of(&model, "a").expect("a closed object");
    let mut cells = Cells::enclosing(&body.bounds);
    (0..4).for_each(|_| {
        cells
            .halve(&|middle, half| body.contains(middle, half).is_none(), usize::MAX, &|_| ())
            .expect("any number of cells")
    });
    let mut triangles = Triangles::of(&cells, &body, &|_| ());
    let far = |triangles: &Triangles| proof::far(&cells, triangles, &body, (error, true), &|_| ());
    assert!(far(&triangles).is_empty());
    for by in [-1.5, 1.5] {
        for vertex in (0..triangles.vertices.len()).step_by(101) {
            let Vertex { at: before, slack } = triangles.vertices[vertex];
            triangles.vertices[vertex] = Vertex { at: before * (1.0 + by * error), slack: f64::INFINITY };
            let places: Vec<_> = far(&triangles).into_iter().map(|cell| cells.cube(cell)).collect();
            // A vertex is on the edge of its cell, rounded.
            let distance = |[low, high]: &[DVec3; 2]| before.distance(before.clamp(*low, *high));
            assert!(places.iter().any(|cell| distance(cell) < 1e-6), "{before} {by}: {places:?}");
            triangles.vertices[vertex] = Vertex { at: before, slack };
        }
    }
}

#[test]
fn a_surface_with_nodes_is_proven_with_few_triangles() {
    // A. Cayley's cubic, with arms that begin at four nodes.
    let made = meshed(&implicit("x^2 + y^2 + z^2 + 2*x*y*z - 1", 1.2), 0.1);
    assert!(made.far.is_empty(), "{} places", made.far.len());
    assert!(made.faces.len() < 5_000, "{}", made.faces.len());
    let point = |place: &Singular| match place {
        Singular::Point(at) => *at,
        other => panic!("{other:?}"),
    };
    let found: Vec<_> = made.singular.iter().map(point).collect();
    assert!(found.len() == 4 && found.iter().all(|at| at.abs().max_element() < 1.01), "{found:?}");
    assert!(
        found.iter().all(|at| at.abs().min_element() > 0.99 && at.to_array().iter().product::<f64>() < 0.0)
    );
    let smooth = meshed(&implicit("x^2 + y^2 + z^2 + x*y*z - 1", 1.2), 0.1);
    assert!(smooth.singular.is_empty(), "{:?}", smooth.singular);
}

#[test]
fn singular_points_that_form_a_curve_are_one() {
    // H. Whitney's umbrella, whose handle is an axis.
    let made = meshed(&implicit("x^2 - y^2*z", 1.0), 0.1);
    let is_end = |at: DVec3, z: f64| at.distance(z * DVec3::Z) < 0.05;
    let [curve, ..] = made.singular[..] else { panic!("{:?}", made.singular) };
    let Singular::Curve([one, other], cells) = curve else { panic!("{curve:?}") };
    assert!(is_end(one, one.z.signum()) && is_end(other, -one.z.signum()), "{curve:?}");
    assert!((cells as f64 - 2.0 / made.cell).abs() < 4.0, "{cells} of {}", made.cell);
    // A circle has no ends, and J. Steiner's surface has three curves that meet.
    for (formula, size) in
        [("((x^2 + y^2) - 0.36)^2 - z^2", 0.6), ("x^2*y^2 + y^2*z^2 + z^2*x^2 - x*y*z", 1.0)]
    {
        let made = meshed(&implicit(formula, 1.0), 0.1);
        let [Singular::Part([low, high], _)] = made.singular[..] else { panic!("{:?}", made.singular) };
        let extents = (high - low).to_array();
        assert!(extents[..2].iter().all(|extent| (extent - 2.0 * size).abs() < 0.05), "{low} {high}");
    }
}

#[test]
fn merging_moves_no_point_farther_than_its_limit() {
    for (object, limit) in [(BALL, 0.05), (SOLID, 0.1), (&*implicit("x^4 + y^4 + z^4 - 1", 1.2), 0.02)] {
        let model = model(object);
        let body = Body::of(&model, "a").expect("a closed object");
        let old = before_merging(&body, 0.2);
        let new = merged(&old, vec![false; old.vertices.len()], limit, &|_| ());
        assert!(new.is_closed() && 2 * new.faces.len() < old.faces.len(), "{}", new.faces.len());
        let triangles = |of: &Triangles| (0..of.faces.len()).map(|face| of.corners(face)).collect::<Vec<_>>();
        for [from, to] in [[&old, &new], [&new, &old]].map(|both| both.map(triangles)) {
            for [a, b, c] in from {
                for at in [a, (a + b) / 2.0, (a + b + c) / 3.0] {
                    let nearest = to.iter().map(|triangle| proof::distance_squared(at, triangle));
                    assert!(nearest.fold(f64::MAX, f64::min) <= limit * limit, "{at}");
                }
            }
        }
        let same = merged(&old, vec![true; old.vertices.len()], limit, &|_| ());
        assert!(same.faces == old.faces);
    }
}

#[test]
fn thin_sheets_do_not_cross() {
    let sheet = "abs(sin(3*x)*cos(3*y) + sin(3*y)*cos(3*z) + sin(3*z)*cos(3*x)) - 0.1";
    let model = model(&implicit(sheet, 0.6));
    let body = Body::of(&model, "a").expect("a closed object");
    let old = before_merging(&body, 0.06);
    let (limit, fixed) = (0.1, vec![false; old.vertices.len()]);
    let crossed = |of: &Triangles| crossing::crossing(of, &vec![true; of.faces.len()]).len();
    let mut new = old.clone();
    merge::merge(&mut new, &fixed, limit, &|_| ());
    assert!(crossed(&old) == 0 && crossed(&new) > 0, "{}", crossed(&new));
    assert_eq!(crossed(&merged(&old, fixed, limit, &|_| ())), 0);
}

#[test]
fn a_disc_with_a_thickness_is_closed_and_has_it() {
    let (half, error) = (0.2, 0.08);
    let made = thickened("disc a { material m  center 1 2 3  normal 0 0 1  radius 1 }", 2.0 * half, error);
    assert!(made.far.is_empty(), "{:?}", made.far.first());
    assert_eq!(characteristic(&made), 2);
    for at in samples(&made) {
        let DVec3 { x, y, z } = at - DVec3::new(1.0, 2.0, 3.0);
        let distance = libm::hypot((libm::hypot(x, y) - 1.0).max(0.0), z);
        assert!((distance - half).abs() <= error, "{at} is {distance} from the disc");
    }
    // Pappus' theorem gives what lies beyond the rim.
    let pi = std::f64::consts::PI;
    let volume = pi * 2.0 * half + pi * pi * half * half + 4.0 / 3.0 * pi * half * half * half;
    assert!((made.volume() - volume).abs() < 0.03 * volume, "{} of {volume}", made.volume());
}

#[test]
fn open_surfaces_with_a_thickness_end_where_they_end() {
    let saddle = "x^3 - 3*x*y^2 - z";
    let ball = "sphere ball { material m  center 0 0 0  radius 0.8 }";
    let (half, error) = (0.15, 0.1);
    // Of a box, a ball that clips, and the ends of u and v: the least and the most of what no point may exceed.
    let boxed = implicit(saddle, 0.7);
    let clipped = format!("{ball} implicit a {{ material m  formula \"{saddle}\"  clip ball }}");
    let patch = "parametric a { material m  x \"u\"  y \"v\"  z \"u^3 - 3*u*v^2\"  u -0.7 0.7  v -0.5 0.5 }";
    type Size = fn(DVec3) -> f64;
    let cases: [(&str, Size, f64); 3] = [
        (&boxed, |at| at.abs().max_element(), 0.7),
        (&clipped, DVec3::length, 0.8),
        (patch, |at| at.y.abs(), 0.5),
    ];
    for (objects, size, end) in cases {
        let made = thickened(objects, 2.0 * half, error);
        assert!(made.far.is_empty(), "{objects}: {:?}", made.far.first());
        assert_eq!(characteristic(&made), 2, "{objects}");
        let farthest = samples(&made).into_iter().map(size).fold(0.0, f64::max);
        assert!((farthest - end - half).abs() <= error, "{objects}: {farthest}");
    }
}

#[test]
fn how_the_faces_of_a_box_are_joined_is_not_examined() {
    let made = meshed("box a { material m  center 0 0 0  size 2 2 2 }", 0.2);
    assert!(made.far.is_empty() && made.tangled.is_none());
}

#[test]
fn a_node_refines_no_cell_elsewhere() {
    // A heart has two points where no plane touches it.
    let heart = meshed("heart a { material m  center 0 0 0  size 1 }", 0.05);
    assert!(heart.far.is_empty() && heart.tangled.is_some_and(|places| !places.is_empty()));
    assert!(heart.faces.len() < 10_000, "{}", heart.faces.len());
}

#[test]
fn cells_of_a_smooth_thickness_are_large() {
    let (thickness, error) = (0.4, 0.04);
    let ball = thickened("sphere a { material m  center 0 0 0  radius 0.5 }", thickness, error);
    // Surfaces that cross have a border with edges.
    let cross = thickened(&implicit("x*y", 0.3), thickness, error);
    assert!(ball.cell > 3.0 * cross.cell, "{} {}", ball.cell, cross.cell);
    assert!(ball.far.is_empty() && cross.far.is_empty());
    for at in samples(&ball) {
        let off = ((at.length() - 0.5).abs() - thickness / 2.0).abs();
        assert!(off <= error, "{at} is off by {off}");
    }
}

#[test]
fn the_work_is_estimated_before_most_of_it() {
    let model = model(BALL);
    let body = Body::of(&model, "a").expect("a closed object");
    let (expected, done) = (Mutex::new((0, 0)), AtomicUsize::new(0));
    let made = mesh(&body, 0.002, None, &|event| match event {
        Event::Expected { triangles, steps } => {
            *expected.lock().expect("no panic") = (triangles.unwrap_or(0), steps);
            done.store(0, Ordering::Relaxed);
        }
        Event::Done(steps) => drop(done.fetch_add(steps, Ordering::Relaxed)),
    });
    let (triangles, steps) = expected.into_inner().expect("no panic");
    let (side, done) = (made.expect("a mesh").cell, done.into_inner());
    let made = before_merging(&body, side).faces.len();
    assert!(triangles.abs_diff(made) < made / 10, "{triangles} of {made}");
    assert!(steps.abs_diff(done) < done / 5, "{steps} of {done}");
}

#[test]
fn threads_change_no_byte() {
    let model = model(&implicit("x^4 + y^4 + z^4 - 1", 1.2));
    let body = Body::of(&model, "a").expect("a closed object");
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let made = pool.install(|| mesh(&body, 0.05, None, &|_| ())).expect("a mesh");
        [Format::Stl, Format::Obj, Format::Ply].map(|format| {
            let mut bytes = Vec::new();
            format.write(&made, "a", &mut bytes).expect("memory");
            bytes
        })
    };
    assert!(bytes(1) == bytes(3));
}

#[test]
fn what_encloses_nothing_is_refused() {
    let refused = |objects: &str| Body::of(&model(objects), "a").map(|_| ()).expect_err("no body");
    assert_eq!(
        refused("sphere b { material m  center 0 0 0  radius 1 }"),
        NoBody::Unknown(vec!["b".to_owned()])
    );
    assert!(matches!(
        refused("disc a { material m  center 0 0 0  normal 0 1 0  radius 1 }"),
        NoBody::Open(_)
    ));
    assert!(matches!(refused(&implicit("1/x + y + z", 1.0)), NoBody::Open(_)));
    let tiny = model(BALL);
    let body = Body::of(&tiny, "a").expect("a sphere");
    assert!(matches!(mesh(&body, 1e-9, None, &|_| ()), Err(NoMesh::TooFine)));
}

#[test]
fn turned_copies_and_turned_pieces_are_closed() {
    let ring = "torus r { material m  center 0 0 0  direction 0 1 0  radius 0.6  tube 0.2 }";
    let copy = "place a { object r  rotation 30 20 10  translation 3 1 0 }";
    let made = meshed(&format!("{ring} {copy}"), 0.03);
    assert!(made.far.is_empty() && made.tangled.as_ref().is_some_and(Vec::is_empty));
    assert_eq!(characteristic(&made), 0);
    for piece in [
        "lathe a { material m  base 1 1 1  points 0 0  0.2 0.5  1 0.3  1.5 0  direction 1 2 3 }",
        "revsurf a { material m  profile \"0.5*sqrt(max(y*(2 - y), 0))\"  base 0 0 0  direction 1 1 0  height 2 }",
    ] {
        assert_eq!(characteristic(&meshed(piece, 0.05)), 2, "{piece}");
    }
}

#[test]
fn a_mesh_keeps_to_its_memory() {
    let model = model(BALL);
    let body = Body::of(&model, "a").expect("a closed object");
    let Err(NoMesh::TooMany(least)) = mesh(&body, 0.0001, Some(10_000_000), &|_| ()) else {
        panic!("it takes more")
    };
    assert!(mesh(&body, least, Some(10_000_000), &|_| ()).is_ok(), "{least}");
}
