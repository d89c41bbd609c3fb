//! Properties of meshes: they have the hits of their triangles, and no ray escapes from a closed mesh.

use super::face::{Leaving, distance_to};
use super::hits::NOTHING;
use super::known::Known;
use super::search::Aims;
use super::{Look, Mesh, Openness, Surface, ToWorld, read::Model};
use crate::triangle::Triangle;
use glam::DVec3;
use proptest::prelude::*;
use std::sync::Arc;
use tabray_exact::interval::{Fraction, Interval};
use tabray_exact::scalar::Scalar;
use tabray_world::accuracy::{Accuracy, Exact};
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{Enclosure, HitEnclosure, HitProofs, Precision};
use tabray_world::coincidence;
use tabray_world::geometry::placement::Rotation;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use tabray_world::geometry::ray_packet::{PACKET_SIZE, RayPacket, SurfaceInteraction};
use tabray_world::geometry::sight::{Line, Sight};
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::{LANES, Vectors};

pub(super) const PLAIN: DVec3 = DVec3::ONE;

/// Returns a closed surface around the origin: a sphere of latitudes and longitudes with bumps.
pub(super) fn closed(bumps: &[f64], rows: u32) -> Model {
    let columns = 2 * rows;
    let mut vertices = vec![DVec3::Y, -DVec3::Y];
    for row in 1..rows {
        for column in 0..columns {
            let up = std::f64::consts::PI * f64::from(row) / f64::from(rows);
            let around = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let at = DVec3::new(up.sin() * around.cos(), up.cos(), up.sin() * around.sin());
            vertices.push(at * bumps[vertices.len() % bumps.len()]);
        }
    }
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut faces = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] =
                [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            faces.extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && a != c));
        }
    }
    Model { vertices, faces, ..Model::default() }
}

pub(super) fn surface(model: Model, placement: &ToWorld) -> Surface {
    Surface::new(model, placement, Look::default()).unwrap_or_else(|_| panic!("a surface"))
}

fn shape(surface: &Arc<Surface>) -> AnyShape {
    AnyShape::of_packets(Mesh::<Exact>::new(surface.clone(), Accuracy::Exact))
}

/// Returns the distance of a ray's first hit of any triangle.
fn among(surface: &Surface, ray: &Ray) -> f64 {
    (0..surface.face_count()).fold(MISS, |first, face| {
        let triangle: Triangle<Exact> = surface.triangle(face);
        let distance = RayRange::ALL.keep(triangle.plane.crossing(ray));
        if triangle.is_passed_by(ray) { distance.min(first) } else { first }
    })
}

fn scale() -> impl Strategy<Value = DVec3> {
    let factor = || prop_oneof![Just(1.0), Just(1e-6), Just(1e6), 0.5..2.0];
    (factor(), factor(), factor()).prop_map(DVec3::from)
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0)
        .prop_map(DVec3::from)
        .prop_filter_map("a direction", |dir| (dir.length() > 0.1).then(|| dir.normalize()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..crate::properties() })]

    #[test]
    fn no_ray_from_inside_escapes(
        bumps in prop::collection::vec(0.6..1.5, 1..9),
        (rows, scale, rotation) in (3..9_u32, scale(), -180.0..180.0),
        toward in prop::collection::vec((any::<prop::sample::Index>(), 0.0..1.0, direction()), 40),
    ) {
        let placement = ToWorld::new(scale, Rotation::Angles(DVec3::splat(rotation)), DVec3::new(3.0, 2.0, -1.0));
        let surface = Arc::new(surface(closed(&bumps, rows), &placement));
        prop_assert!(surface.is_closed());
        let (inside, shape) = (placement.place(DVec3::ZERO), shape(&surface));
        for (index, part, dir) in toward {
            let [a, b, c] = surface.corners(index.index(surface.face_count()));
            // The targets are a vertex, an edge, the middle of a face, and any point.
            for at in [a, a.lerp(b, part), b, (a + b + c) / 3.0, inside + dir] {
                let Some(dir) = (at - inside).try_normalize() else { continue };
                let ray = Ray { origin: inside, dir };
                let bracket = shape.t_bounds(&ray, &RayRange::ALL);
                prop_assert!(bracket.near < MISS, "{ray:?}");
                let distance = shape.distance(&ray, &RayRange::ALL);
                prop_assert!(distance < MISS, "{ray:?}");
                prop_assert!(bracket.near <= distance && distance <= bracket.far, "{bracket:?} {distance}");
                let enclosure = shape.certify(&Sight::along(&ray), Precision::Octuple);
                prop_assert!(enclosure != Enclosure::Misses, "{ray:?}");
                if let Some(fine) = shape.packets().fine_distance(&ray, distance) {
                    prop_assert!((fine.high - distance).abs() <= 2.0 * coincidence::CLOSE * (distance + inside.length()));
                }
                prop_assert!(shape.is_on_surface(ray.at(distance), coincidence::error(&ray, distance, shape.normal(ray.at(distance)), shape.facts().max_coordinate)));
            }
        }
    }

    /// The box around a face that is not parallel to two axes contains much of the plane around it.
    #[test]
    fn points_beside_a_face_in_its_plane_are_not_on_the_mesh(
        bumps in prop::collection::vec(0.6..1.5, 1..9),
        (rows, size, rotation) in (3..9_u32, prop_oneof![Just(1.0), Just(1e-6), Just(1e6)], -180.0..180.0),
        beside in prop::collection::vec((any::<prop::sample::Index>(), 0.0..1.0, 0.01..0.5), 40),
    ) {
        let placement = ToWorld::new(DVec3::splat(size), Rotation::Angles(DVec3::splat(rotation)), DVec3::ZERO);
        let surface = Arc::new(surface(closed(&bumps, rows), &placement));
        let shape = shape(&surface);
        for (index, part, out) in beside {
            let [a, b, c] = surface.corners(index.index(surface.face_count()));
            let at = a.lerp(b, part) + out * (a.lerp(b, part) - c);
            let (nearest, error) = (surface.nearest(at).0, 1e-12 * at.length());
            // Other faces may be as near as the error.
            if nearest > 100.0 * error {
                prop_assert!(!shape.is_on_surface(at, error), "{at} is {nearest} from the mesh");
            }
        }
    }

    #[test]
    fn hits_are_those_of_the_triangles(
        bumps in prop::collection::vec(0.3..2.0, 1..9),
        (rows, scale, rotation) in (3..7_u32, scale(), -180.0..180.0),
        rays in prop::collection::vec((direction(), direction(), any::<prop::sample::Index>(), 0.1..1e3), 40),
    ) {
        let placement = ToWorld::new(scale, Rotation::Angles(DVec3::splat(rotation)), DVec3::new(3.0, 2.0, -1.0));
        let surface = Arc::new(surface(closed(&bumps, rows), &placement));
        let shape = shape(&surface);
        for (from, dir, index, far) in rays {
            let [a, b, _] = surface.corners(index.index(surface.face_count()));
            let origin = placement.place(far * from);
            for dir in [Some(dir), (a - origin).try_normalize(), (a.lerp(b, 0.3) - origin).try_normalize()] {
                let Some(dir) = dir else { continue };
                let ray = Ray { origin, dir };
                let right = among(&surface, &ray);
                prop_assert_eq!(shape.distance(&ray, &RayRange::ALL), right, "{:?}", ray);
                let bracket = shape.t_bounds(&ray, &RayRange::ALL);
                prop_assert!(bracket.near <= right && right <= bracket.far, "{bracket:?} {right}");
                match shape.certify(&Sight::along(&ray), Precision::Octuple) {
                    Enclosure::Misses => prop_assert_eq!(right, MISS),
                    Enclosure::Hits(_) => prop_assert!(right < MISS),
                    _ => {}
                }
                if right < MISS {
                    // A ray that continues inside leaves a closed mesh.
                    let (at, normal) = (ray.at(right), shape.normal(ray.at(right)));
                    let origin_error = coincidence::error(&ray, right, normal, shape.facts().max_coordinate);
                    let side = Side::seen_along(dir, normal).opposite();
                    let range = RayRange { origin_side: Some(side), origin_error, ..RayRange::ALL };
                    let next = shape.distance(&Ray { origin: at, dir }, &range);
                    prop_assert!(next > 0.0);
                }
            }
        }
    }
}

#[test]
fn a_ray_through_a_vertex_hits_the_first_face_of_the_file() {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
    let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    for first in 0..4 {
        let mut faces = fan.to_vec();
        faces.rotate_left(first);
        let model =
            Model { vertices: vertices.map(DVec3::from).to_vec(), faces: faces.clone(), ..Model::default() };
        let surface = Arc::new(surface(model, &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO)));
        assert_eq!(surface.why_not_closed, Openness { open: 4, clashing: 0 });
        let ray = Ray { origin: DVec3::Z, dir: -DVec3::Z };
        assert_eq!(shape(&surface).distance(&ray, &RayRange::ALL), 1.0);
        assert_eq!(shape(&surface).part(&ray, 1.0).as_deref(), Some("face 1"));
        // The edge to vertex 2 belongs to the two faces beside it.
        let ray = Ray { origin: DVec3::new(0.0, 0.5, 1.0), dir: -DVec3::Z };
        let beside = faces.iter().position(|face| face.contains(&2)).expect("one");
        assert_eq!(shape(&surface).part(&ray, 1.0), Some(format!("face {}", beside + 1)));
    }
}

#[test]
fn equal_vertices_are_one_and_faces_without_an_area_are_left_out() {
    // Each face has its own vertices, as in an STL. One more face lies on a line, and one is a single point.
    let Model { vertices, faces, .. } = closed(&[1.0], 4);
    let corners = faces.iter().flatten().map(|corner| vertices[*corner as usize]);
    let extra = [DVec3::X, 2.0 * DVec3::X, 3.0 * DVec3::X, DVec3::Y, DVec3::Y, DVec3::Y];
    let vertices: Vec<_> = corners.chain(extra).collect();
    let alone = (0..vertices.len() as u32 / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let model = Model { vertices, faces: alone, ..Model::default() };
    let surface = surface(model, &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
    assert_eq!((surface.face_count(), surface.is_closed()), (faces.len(), true));
    assert_eq!(surface.remarks[0].message, "leaves out 2 faces without an area");
    assert!(surface.vertices.len() < faces.len());
}

proptest! {
    #![proptest_config(crate::properties())]

    #[test]
    fn a_face_that_the_search_knows_is_that_of_the_hit_point(
        bumps in prop::collection::vec(0.6..1.5, 1..9),
        (rows, scale) in (3..9_u32, scale()),
        ways in prop::collection::vec((direction(), any::<prop::sample::Index>(), 0.0..1.0), 40),
    ) {
        let surface = surface(closed(&bumps, rows), &ToWorld::new(scale, Rotation::NONE, DVec3::ZERO));
        let mut known = 0;
        for (from, to, along) in ways {
            // The targets are an edge, a vertex and the inside of a face.
            let [a, b, c] = surface.corners(to.index(surface.face_count()));
            let at = if along < 0.3 { a } else if along < 0.6 { a.lerp(b, along) } else { (a + b + c) / 3.0 };
            let origin = 3.0 * surface.max_coordinate() * from;
            let Some(dir) = (at - origin).try_normalize() else { continue };
            let ray = Ray { origin, dir };
            for cpu in Cpu::all() {
                let (bracket, face) =
                    surface.bracket::<Exact>(cpu, &ray, &RayRange::ALL, NOTHING);
                if let Some(face) = face {
                    prop_assert_eq!(face, surface.face_along(&ray, bracket.near));
                    known += 1;
                }
            }
        }
        // In a mesh so thin that its sides coincide up to rounding, no face may be known.
        prop_assert!(known > 0 || scale != DVec3::ONE);
    }

    #[test]
    fn the_rays_of_a_packet_find_what_each_finds_alone(
        bumps in prop::collection::vec(0.6..1.5, 1..9),
        (rows, scale) in (3..30_u32, scale()),
        (eye, spread) in (direction(), prop_oneof![Just(0.0), Just(1e-9), 0.0..1.0]),
        ways in prop::collection::vec((direction(), any::<prop::sample::Index>(), 0.0..1.0), 1..PACKET_SIZE),
        (leaves, drift) in (any::<bool>(), prop_oneof![Just(0.0), Just(1e-9)]),
    ) {
        let surface = surface(closed(&bumps, rows), &ToWorld::new(scale, Rotation::NONE, DVec3::ZERO));
        let reach = surface.max_coordinate();
        let count = ways.len().next_multiple_of(LANES);
        let (mut origin, mut dir) = (Vectors::<PACKET_SIZE>::ZERO, Vectors::<PACKET_SIZE>::ZERO);
        let mut ends = vec![0.0; count];
        for lane in 0..count {
            // The targets are an edge, a vertex and the inside of a face. The origins are almost the same, or
            // arbitrary, or the target.
            let (aside, to, along) = &ways[lane.min(ways.len() - 1)];
            let [a, b, c] = surface.corners(to.index(surface.face_count()));
            let at = if *along < 0.3 { a } else if *along < 0.6 { a.lerp(b, *along) } else { (a + b + c) / 3.0 };
            let from = reach * (3.0 * eye + spread * *aside);
            let toward = (at - from).try_normalize().unwrap_or(DVec3::X);
            let is_there = leaves && *along > 0.2;
            origin.set(lane, if is_there { at } else { from });
            dir.set(lane, if is_there { aside.normalize() } else { toward });
            ends[lane] = [0.0, reach, 4.0 * reach, MISS][lane % 4];
        }
        let rays = RayPacket::new(origin.view(count), dir.view(count), 0.0);
        let error = coincidence::ROUNDING * reach;
        let leaving = if leaves { Leaving { least: error, most: 2.0 * error } } else { NOTHING };
        let drift = RayError { origin: drift * reach, dir: drift };
        for (cpu, is_any) in Cpu::all().flat_map(|cpu| [(cpu, false), (cpu, true)]) {
            let mut lanes = Vec::new();
            surface.search(cpu, rays, &ends, Aims { leaving, drift, is_any }, |first, found| {
                for lane in (first..first + LANES).filter(|lane| ends[*lane] > 0.0) {
                    lanes.push(lane);
                    let (ray, range) = (rays.get(lane), RayRange { far: ends[lane], ..RayRange::ALL });
                    let alone = surface.first(cpu, &ray, &range, leaving, drift, is_any);
                    let (Known::Face { bracket: alone, .. } | Known::Bracket(alone)) = alone;
                    let known = found.get(lane - first).known(&ray, ends[lane], leaving, is_any);
                    let (Known::Face { bracket, .. } | Known::Bracket(bracket)) = known;
                    // A face that only its bounds cannot exclude may be visited or not.
                    let contradicts = |one: Bracket, other: Bracket| one.far < MISS && other.near == MISS;
                    assert!(!contradicts(bracket, alone) && !contradicts(alone, bracket), "{bracket:?} {alone:?}");
                    let overlap = bracket.near <= alone.far && alone.near <= bracket.far;
                    assert!(is_any || overlap, "{bracket:?} {alone:?}");
                }
            });
            prop_assert!(lanes.into_iter().eq((0..count).filter(|lane| ends[*lane] > 0.0)));
        }
    }
}

#[test]
fn a_face_that_only_another_ray_within_the_drift_hits_is_not_missed() {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let model = Model { vertices, faces: vec![[0, 1, 2]], ..Model::default() };
    let surface = surface(model, &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
    let ray = Ray { origin: DVec3::new(-1e-6, 0.5, 2.0), dir: DVec3::NEG_Z };
    for cpu in Cpu::all() {
        let (exactly, _) = surface.bracket::<Exact>(cpu, &ray, &RayRange::ALL, NOTHING);
        assert_eq!(exactly.near, MISS);
        for drift in [RayError { origin: 2e-6, dir: 0.0 }, RayError { origin: 0.0, dir: 1e-6 }] {
            let within = surface.bracket_within::<Exact>(cpu, &RayBall { ray, drift }, &RayRange::ALL);
            assert!(within.near <= 2.0 && within.far == MISS, "{drift:?}: {within:?}");
        }
    }
}

#[test]
fn fractions_know_exactly_where_a_line_crosses_a_mesh() {
    let surface = surface(closed(&[1.0], 6), &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
    let mesh = Mesh::<Exact>::new(Arc::new(surface), Accuracy::Exact);
    let exactly = |of: [f64; 3]| of.map(Interval::<Fraction>::constant);
    let line = Line { origin: exactly([0.25, 0.375, 3.0]), dir: exactly([-0.125, 0.1, -0.7]) };
    let all = HitProofs::all_hits(&mesh, &line, None).expect("all hits");
    let is_exact = |hit: &HitEnclosure<Fraction>| matches!(hit, HitEnclosure::Hits(at) if at.low == at.high);
    assert!(all.len() == 2 && all.iter().all(|(hit, _)| is_exact(hit)), "{all:?}");
}

#[test]
fn a_placement_scales_then_rotates_then_moves() {
    let placement = ToWorld::new(
        DVec3::new(2.0, 3.0, 4.0),
        Rotation::Angles(DVec3::new(0.0, 0.0, 90.0)),
        DVec3::new(10.0, 0.0, 0.0),
    );
    assert_eq!(placement.place(DVec3::new(1.0, 1.0, 1.0)), DVec3::new(7.0, 2.0, 4.0));
    assert!(!placement.is_mirrored());
    assert!(ToWorld::new(DVec3::new(1.0, 1.0, -1.0), Rotation::NONE, DVec3::ZERO).is_mirrored());
    let turned = ToWorld::new(PLAIN, Rotation::Angles(DVec3::new(90.0, 90.0, 0.0)), DVec3::ZERO);
    // The first rotation, around x, turns y into z. The second, around y, turns z into x.
    assert_eq!(turned.place(DVec3::Y), DVec3::X);
}

#[test]
fn the_memory_of_a_mesh_is_far_below_150_bytes_for_each_face() {
    let surface = surface(closed(&[1.0, 1.1, 0.9], 200), &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
    let each = surface.bytes() as f64 / surface.face_count() as f64;
    assert!(each < 75.0, "{each} bytes");
}

#[test]
fn no_doubled_face_at_an_outline_is_seen_from_behind() {
    let Model { vertices, faces, .. } = closed(&[1.0, 1.3, 0.8, 1.1], 7);
    let turned = faces.iter().map(|[a, b, c]| [*a, *c, *b]);
    for doubled in
        [turned.clone().chain(faces.clone()).collect(), faces.iter().copied().chain(turned).collect()]
    {
        let model = Model { vertices: vertices.clone(), faces: doubled, ..Model::default() };
        let surface = Arc::new(surface(model, &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO)));
        let (shape, mut seen) = (shape(&surface), 0);
        for view in 0..40 {
            let angle = f64::from(view);
            let origin = 4.0 * DVec3::new(angle.cos(), 0.7 * (1.7 * angle).sin(), angle.sin());
            for [a, b, _] in &faces {
                let [a, b] = [a, b].map(|corner| vertices[*corner as usize]);
                let dir = (0.5 * (a + b) - origin).normalize();
                let distance = shape.distance(&Ray { origin, dir }, &RayRange::ALL);
                if distance < (0.5 * (a + b) - origin).length() * (1.0 - 1e-9) || distance == MISS {
                    continue;
                }
                let (from, along) = (Vectors::<LANES>::of(origin), Vectors::<LANES>::of(dir));
                let rays = RayPacket::new(from.view(LANES), along.view(LANES), 0.0);
                let (mut points, mut normals) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO);
                let mut geometric_normals = Vectors::<LANES>::ZERO;
                let interaction = SurfaceInteraction {
                    points: points.view_mut(LANES),
                    normals: normals.view_mut(LANES),
                    geometric_normals: geometric_normals.view_mut(LANES),
                    sides: &mut [Side::Outside; LANES],
                    cosines: &mut [0.0; LANES],
                    travelled: &mut [0.0; LANES],
                };
                shape.packets().interact(Cpu::best(), rays, &[distance; LANES], interaction);
                // All outer sides face away from the middle.
                assert!(normals.get(0).dot(points.get(0)) > 0.0, "{origin} {a} {b}");
                seen += 1;
            }
        }
        assert!(seen > 1000, "{seen}");
    }
}

#[test]
fn faces_of_which_none_lies_beside_another_are_found() {
    const COUNT: usize = 100_000;
    let size = |index: usize| (400.0 * (index as f64 / COUNT as f64 - 0.5)).exp2();
    /// Returns the position and the size of a face.
    type Of<'o> = &'o dyn Fn(usize) -> (f64, f64);
    let all: [(&str, Of); 4] = [
        ("equal", &|_| (0.0, 1.0)),
        ("around one point", &|index| (0.0, 1.0 + index as f64 / COUNT as f64)),
        ("around one point, growing exponentially", &|index| (0.0, size(index))),
        ("in a row, growing exponentially", &|index| (size(index), 0.001 * size(index))),
    ];
    for (name, of) in all {
        let corners = [[-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]].map(DVec3::from);
        let vertices = (0..COUNT).flat_map(|index| {
            let (place, size) = of(index);
            corners.map(|corner| place * DVec3::ONE + size * corner)
        });
        let faces = (0..COUNT as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
        let model = Model { vertices: vertices.collect(), faces, ..Model::default() };
        let surface = surface(model, &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
        // The targets are the middles of some faces, each from a distance that equals the size of the face.
        let (mut origin, mut dir) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO);
        for lane in 0..LANES {
            let [a, b, c] = surface.corners((2 * lane + 1) * surface.face_count() / (2 * LANES));
            let (middle, way) = ((a + b + c) / 3.0, DVec3::new(0.3, 0.2, 1.0));
            origin.set(lane, middle + (a - b).length() * way);
            dir.set(lane, -way.normalize());
        }
        let rays = RayPacket::new(origin.view(LANES), dir.view(LANES), 0.0);
        let rights: Vec<_> = (0..LANES).map(|lane| among(&surface, &rays.get(lane))).collect();
        for cpu in Cpu::all() {
            let aims = Aims { leaving: NOTHING, drift: RayError::NONE, is_any: false };
            surface.search(cpu, rays, &[MISS; LANES], aims, |_, found| {
                for lane in 0..LANES {
                    let (ray, right) = (rays.get(lane), rights[lane]);
                    let alone = surface.first(cpu, &ray, &RayRange::ALL, NOTHING, RayError::NONE, false);
                    for known in [alone, found.get(lane).known(&ray, MISS, NOTHING, false)] {
                        let (Known::Face { bracket, .. } | Known::Bracket(bracket)) = known;
                        assert!(
                            right < MISS && bracket.near <= right && right <= bracket.far,
                            "{name}: {right} {bracket:?}"
                        );
                    }
                }
            });
        }
    }
}

#[test]
fn the_distance_of_a_sliver_keeps_its_digits() {
    let point = |x, z| DVec3::new(x, 6.0, z);
    let sliver = [point(0.0, -4e5), point(0.0, 1e5), point(2.0, 1e5)];
    let at = point(0.050847458, -0.101694915);
    assert!(distance_to(sliver, at) < 1e-9);
    assert!((distance_to(sliver, at + DVec3::Y) - 1.0).abs() < 1e-9);
    assert!((distance_to(sliver, at - DVec3::X) - 0.949152542).abs() < 1e-9);
}

proptest! {
    #![proptest_config(crate::properties())]

    #[test]
    fn the_distance_of_a_triangle_is_that_of_its_nearest_point(
        coordinates in prop::array::uniform9(-3.0..3.0_f64), at in prop::array::uniform3(-5.0..5.0_f64),
        weights in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 100), height in -2.0..2.0_f64
    ) {
        let corner = |first: usize| DVec3::from_slice(&coordinates[first..]);
        let [a, b, c] = [corner(0), corner(3), corner(6)];
        let normal = (b - a).cross(c - a);
        prop_assume!(normal.length() > 0.1);
        let at = DVec3::from(at);
        let distance = distance_to([a, b, c], at);
        for (one, other) in weights {
            let (one, other) = if one + other > 1.0 { (1.0 - one, 1.0 - other) } else { (one, other) };
            let inside = a + one * (b - a) + other * (c - a);
            prop_assert!(distance <= inside.distance(at) + 1e-13, "{inside} is nearer than {distance}");
            let above = inside + height * normal.normalize();
            prop_assert!((distance_to([a, b, c], above) - height.abs()).abs() < 1e-12);
        }
        // The distance is not too small either: the nearest point is on the plane or on an edge.
        let from_plane = (at - a).dot(normal.normalize()).abs();
        prop_assert!(distance >= from_plane - 1e-12);
    }
}
