//! The orientation of a mesh's faces. Faces connected by edges of two faces are made consistent, and the outer sides of
//! closed parts are turned outside.

use super::edges::Edges;
use glam::DVec3;
use std::cmp::Ordering;
use tabray_exact::double_double::{exponent_to_one, times_power_of_two};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::geometry::orientation::side_of_plane;

/// Directions of the rays that decide whether a point lies inside. They are irregular, unlike the edges of artificial
/// shapes.
pub(super) const DIRECTIONS: [DVec3; 4] = [
    DVec3::new(0.615_947, 0.359_214, 0.701_135),
    DVec3::new(-0.271_803, 0.857_241, -0.437_365),
    DVec3::new(0.480_163, -0.692_127, -0.538_843),
    DVec3::new(-0.733_019, -0.226_591, 0.641_357),
];

/// The volume of a part that is undecided because of rounding, as a fraction of the sum of the products of three edges
/// each.
const FLAT: f64 = 1e-12;

/// The maximum number of faces that are tested to find which parts lie in others, which takes about a second.
const MAX_TESTED: usize = 1 << 27;

/// The edges that keep a mesh from being closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Openness {
    /// The number of edges that do not join faces in pairs.
    pub open: usize,
    /// The number of other edges between faces of inconsistent orientation.
    pub clashing: usize,
}

/// A part: faces connected by edges of two faces.
struct Part {
    /// The first face in the file.
    first: usize,
    /// The number of faces oriented like the first one, and that of the others.
    counts: [usize; 2],
    /// Which of the two are reversed, or `None` if the faces cannot be made consistent.
    turned: Option<usize>,
    is_closed: bool,
    /// The enclosed volume after faces are reversed, and a number in the same unit that bounds its rounding error.
    volume: [f64; 2],
    bounds: Aabb,
}

impl Part {
    fn is_inside_out(&self) -> bool {
        self.volume[0] < -FLAT * self.volume[1]
    }
}

/// Counts the edges that keep a mesh from being closed.
pub(super) fn why_not_closed(edges: &Edges) -> Openness {
    let mut found = Openness::default();
    for sides in edges.iter() {
        let back = sides.iter().filter(|side| side.is_back()).count();
        found.open += sides.len() % 2;
        found.clashing += usize::from(sides.len() % 2 == 0 && 2 * back != sides.len());
    }
    found
}

/// Counts the parts: faces of a part are connected by edges of two faces.
pub(super) fn count_parts(faces: &[[u32; 3]], vertices: usize) -> usize {
    parts(faces.len(), &Edges::of(faces, vertices)).0.len()
}

/// Orients the faces of each part consistently, as most of them are. If a part is closed and lies in no other part, its
/// outer side is turned outside. A body that is inside out as a whole is reversed with its cavities. Returns the number
/// of reversed faces.
pub(super) fn turn(vertices: &[DVec3], faces: &mut [[u32; 3]], edges: &Edges) -> usize {
    let (mut parts, part_of) = parts(faces.len(), edges);
    measure(&mut parts, &part_of, vertices, faces);
    if parts.iter().any(Part::is_inside_out) {
        turn_out(&mut parts, &part_of, vertices, faces);
    }
    let mut count = 0;
    for (face, of) in faces.iter_mut().zip(&part_of) {
        if parts[(of >> 1) as usize].turned == Some((of & 1) as usize) {
            face.swap(1, 2);
            count += 1;
        }
    }
    count
}

/// Returns the parts of `count` faces. For each face, also returns twice the index of its part, plus 1 if its
/// orientation differs from that of the part's first face.
fn parts(count: usize, edges: &Edges) -> (Vec<Part>, Vec<u32>) {
    // Twice an earlier face of the same part, or the face itself, plus 1 if the orientations differ.
    let mut above: Vec<u32> = (0..count as u32).map(|face| face << 1).collect();
    let mut torn = Vec::new();
    for sides in edges.iter() {
        if let [one, other] = sides {
            let clash = u32::from(one.is_back() == other.is_back());
            let [one, other] = [one.face(), other.face()].map(|face| top(&mut above, face));
            let (low, high) = (one.min(other), one.max(other));
            if low >> 1 != high >> 1 {
                above[(high >> 1) as usize] = low ^ (high & 1) ^ clash;
            } else if low ^ high != clash {
                torn.push((low >> 1) as usize);
            }
        }
    }
    let mut parts = Vec::new();
    for face in 0..count {
        let up = above[face];
        if (up >> 1) as usize == face {
            above[face] = (parts.len() as u32) << 1;
            parts.push(Part {
                first: face,
                counts: [0; 2],
                turned: None,
                is_closed: true,
                volume: [0.0; 2],
                bounds: Aabb::EMPTY,
            });
        } else {
            above[face] = above[(up >> 1) as usize] ^ (up & 1);
        }
        parts[(above[face] >> 1) as usize].counts[(above[face] & 1) as usize] += 1;
    }
    for part in &mut parts {
        part.turned = Some(usize::from(part.counts[1] <= part.counts[0]));
    }
    for face in torn {
        let part = &mut parts[(above[face] >> 1) as usize];
        (part.turned, part.is_closed) = (None, false);
    }
    let mut around = Vec::new();
    for sides in edges.iter().filter(|sides| sides.len() != 2) {
        around.clear();
        around.extend(sides.iter().map(|side| {
            let of = above[side.face()];
            (of >> 1, side.is_back() != (of & 1 == 1))
        }));
        around.sort_unstable();
        for same in around.chunk_by(|one, other| one.0 == other.0) {
            parts[same[0].0 as usize].is_closed &=
                2 * same.iter().filter(|(_, is_back)| *is_back).count() == same.len();
        }
    }
    (parts, above)
}

/// Returns twice the first face of a face's part, as far as known, plus 1 if the orientations differ. Halves the path
/// to it.
fn top(above: &mut [u32], face: usize) -> u32 {
    let (mut face, mut against) = (face, 0);
    loop {
        let up = above[face];
        if (up >> 1) as usize == face {
            return up ^ against;
        }
        let shortcut = above[(up >> 1) as usize] ^ (up & 1);
        above[face] = shortcut;
        against ^= shortcut & 1;
        face = (shortcut >> 1) as usize;
    }
}

/// Computes the volumes and the boxes of closed parts.
fn measure(parts: &mut [Part], part_of: &[u32], vertices: &[DVec3], faces: &[[u32; 3]]) {
    let bounds = Aabb::around(vertices);
    // Scaling by a power of two keeps products from overflow and underflow.
    let scale = times_power_of_two(1.0, exponent_to_one((bounds.high - bounds.low).max_element()));
    let origins: Vec<_> = parts.iter().map(|part| vertices[faces[part.first][0] as usize]).collect();
    for (face, of) in faces.iter().zip(part_of) {
        let (index, side) = ((of >> 1) as usize, (of & 1) as usize);
        let part = &mut parts[index];
        if !part.is_closed {
            continue;
        }
        let corners = face.map(|corner| vertices[corner as usize]);
        let [a, b, c] = corners.map(|at| (at - origins[index]) * scale);
        let volume = a.cross(b).dot(c);
        part.volume[0] += if part.turned == Some(side) { -volume } else { volume };
        part.volume[1] += a.length() * b.length() * c.length();
        part.bounds = part.bounds.and(&Aabb::around(&corners));
    }
}

/// Reverses the parts that are inside out as a whole.
fn turn_out(parts: &mut [Part], part_of: &[u32], vertices: &[DVec3], faces: &[[u32; 3]]) {
    let closed: Vec<_> = (0..parts.len()).filter(|part| parts[*part].is_closed).collect();
    let size = |part: &usize| parts[*part].volume[0].abs();
    let (mut largest_first, tree) = (closed.clone(), Bvh::of(closed.len(), |at| parts[closed[at]].bounds));
    largest_first.sort_by(|one, other| size(other).total_cmp(&size(one)));
    let mut faces_of: Vec<_> = (0..faces.len() as u32).collect();
    faces_of.sort_by_key(|face| part_of[*face as usize] >> 1);
    let of = |part: usize| {
        let end = |part: usize| faces_of.partition_point(|face| (part_of[*face as usize] >> 1) < part as u32);
        &faces_of[end(part)..end(part + 1)]
    };
    let corners = |face: usize| faces[face].map(|corner| vertices[corner as usize]);
    let (mut is_turned, mut left) = (vec![false; parts.len()], MAX_TESTED);
    for part in largest_first {
        let own = &parts[part];
        let [a, b, c] = corners(own.first);
        let at = (a + b + c) / 3.0;
        let mut around: Option<usize> = None;
        tree.within(
            |bounds| bounds.low.cmple(own.bounds.low).all() && own.bounds.high.cmple(bounds.high).all(),
            |other| {
                let other = closed[other];
                let is_nearer = around.is_none_or(|around| size(&other) < size(&around));
                if other != part && size(&other) > size(&part) && is_nearer {
                    let faces = of(other);
                    left = left.saturating_sub(faces.len());
                    if left > 0
                        && holds(faces.iter().map(|face| corners(*face as usize)), at, &parts[other].bounds)
                    {
                        around = Some(other);
                    }
                }
            },
        );
        is_turned[part] = match around {
            None => own.is_inside_out(),
            Some(around) => is_turned[around] && own.is_inside_out() != parts[around].is_inside_out(),
        };
    }
    for part in (0..parts.len()).filter(|part| is_turned[*part]) {
        parts[part].turned = parts[part].turned.map(|side| 1 - side);
    }
}

/// Tells whether closed faces contain a point: whether a path out of their box crosses an odd number of them.
fn holds(faces: impl Iterator<Item = [DVec3; 3]>, at: DVec3, bounds: &Aabb) -> bool {
    let out = at + 2.0 * (bounds.high - bounds.low).length() * DIRECTIONS[0];
    let is_passed = |[a, b, c]: &[DVec3; 3]| {
        side_of_plane([*a, *b, *c], at) != side_of_plane([*a, *b, *c], out) && {
            let left = |from: &DVec3, to: &DVec3| side_of_plane([at, out, *from], *to) == Ordering::Less;
            left(a, b) == left(b, c) && left(b, c) == left(c, a)
        }
    };
    faces.filter(is_passed).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::read::Model;
    use crate::mesh::tests::closed;
    use crate::mesh::{Look, Surface, ToWorld};
    use tabray_world::geometry::placement::Rotation;

    /// Makes a surface of models, each scaled and moved. `is_turned` selects the faces to reverse.
    fn surface(of: &[(f64, DVec3)], rows: u32, is_turned: impl Fn(usize, usize) -> bool) -> Surface {
        let mut all = Model::default();
        for (number, (scale, at)) in of.iter().enumerate() {
            let Model { vertices, faces, .. } = closed(&[1.0], rows);
            let before = all.vertices.len() as u32;
            all.vertices.extend(vertices.iter().map(|vertex| *scale * *vertex + *at));
            all.faces.extend(faces.iter().enumerate().map(|(face, [a, b, c])| {
                let [b, c] = if is_turned(number, face) { [c, b] } else { [b, c] };
                [before + a, before + b, before + c]
            }));
        }
        made(all)
    }

    fn made(model: Model) -> Surface {
        let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
        Surface::new(model, &placement, Look { crease: Some(180.0), is_two_sided: true })
            .unwrap_or_else(|_| panic!("a surface"))
    }

    fn told(surface: &Surface) -> Vec<&str> {
        surface.remarks.iter().map(|remark| &remark.message[..]).collect()
    }

    /// Tells for each body of a surface whether the outer sides of all of its faces are outside.
    fn is_outward(surface: &Surface, of: &[(f64, DVec3)]) -> Vec<bool> {
        let is_of =
            |at: DVec3, (scale, middle): &(f64, DVec3)| ((at - *middle).length() - scale).abs() < 0.2 * scale;
        let outward = |body: &(f64, DVec3)| {
            let faces = (0..surface.face_count()).map(|face| surface.corners(face));
            let own: Vec<_> = faces.filter(|corners| corners.iter().all(|at| is_of(*at, body))).collect();
            assert!(!own.is_empty());
            let out = own.iter().filter(|[a, b, c]| (*b - *a).cross(*c - *a).dot(*a - body.1) > 0.0).count();
            assert!(out == 0 || out == own.len(), "{out} of {}", own.len());
            out > 0
        };
        of.iter().map(outward).collect()
    }

    #[test]
    fn faces_of_a_closed_mesh_are_turned_outside() {
        let body = [(2.0, DVec3::new(5.0, 1.0, -3.0))];
        let all = surface(&body, 8, |_, _| false).face_count();
        for (which, count) in [
            (&(|_, _| false) as &dyn Fn(usize, usize) -> bool, 0),
            (&|_, face| face == 7, 1),
            (&|_, face| face % 3 == 0, all.div_ceil(3)),
            (&|_, face| face % 3 != 0, all - all.div_ceil(3)),
            (&|_, _| true, all),
        ] {
            let surface = surface(&body, 8, which);
            assert!(surface.is_closed());
            assert_eq!(is_outward(&surface, &body), [true]);
            let message = format!("turns {count} of {all} faces");
            assert_eq!(told(&surface), Vec::from_iter((count > 0).then_some(&message[..])));
            // Smooth normals follow the reversed faces.
            let is_outward = |face: usize| {
                let corners = surface.corners(face).into_iter().zip(surface.corner_normals(face));
                corners.map(|(at, normal)| DVec3::from(normal).dot(at - body[0].1)).all(|out| out > 0.0)
            };
            assert!((0..surface.face_count()).all(is_outward));
        }
    }

    #[test]
    fn cavities_keep_their_winding() {
        let shell = [(3.0, DVec3::ZERO), (1.0, DVec3::X), (3.0, DVec3::new(9.0, 0.0, 0.0))];
        let all = surface(&shell, 6, |_, _| false).face_count();
        for (turned, outward, count) in [
            ([false, true, false], [true, false, true], 0),
            ([false, false, false], [true, true, true], 0),
            // The body and its cavity are inside out.
            ([true, false, false], [true, false, true], 2),
            ([true, true, false], [true, false, true], 1),
            ([false, true, true], [true, false, true], 1),
        ] {
            let surface = surface(&shell, 6, |body, _| turned[body]);
            assert_eq!(is_outward(&surface, &shell), outward, "{turned:?}");
            let message = format!("turns {} of {all} faces", count * all / 3);
            assert_eq!(told(&surface), Vec::from_iter((count > 0).then_some(&message[..])), "{turned:?}");
        }
    }

    /// Returns a grid of faces around a ring. If `is_twisted`, it closes upside down.
    fn ring(columns: u32, rows: u32, is_closed: bool, is_twisted: bool) -> Model {
        let at = |column: u32, row: u32| {
            let row = if column == columns && is_twisted { rows - row } else { row };
            (column % columns) * (rows + 1) + if is_closed { row % rows } else { row }
        };
        // Positions do not matter, as long as faces have areas.
        let place = |index: u32| {
            DVec3::new(
                libm::sin(f64::from(index)),
                libm::cos(f64::from(index)),
                libm::sin(0.37 * f64::from(index)),
            )
        };
        let vertices = (0..columns * (rows + 1)).map(place).collect();
        let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row)));
        let faces = cells.flat_map(|(column, row)| {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column + 1, row + 1), at(column, row + 1)];
            [[a, b, c], [a, c, d]]
        });
        Model { vertices, faces: faces.collect(), ..Model::default() }
    }

    #[test]
    fn faces_that_cannot_agree_are_left_as_they_are() {
        let [columns, rows] = [9, 4];
        let plain = made(ring(columns, rows, false, false));
        assert_eq!(plain.why_not_closed, Openness { open: 2 * columns as usize, clashing: 0 });
        assert_eq!(told(&plain), [""; 0]);
        let strip = made(ring(columns, rows, false, true));
        assert_eq!(strip.why_not_closed, Openness { open: 2 * columns as usize, clashing: rows as usize });
        assert_eq!(told(&strip), [""; 0]);
        let bottle = made(ring(columns, rows, true, true));
        assert_eq!(bottle.why_not_closed, Openness { open: 0, clashing: rows as usize });
        let torus = made(ring(columns, rows, true, false));
        assert!(torus.is_closed());
    }

    #[test]
    fn faces_of_an_open_mesh_are_turned_as_most_are() {
        let mut model = ring(12, 3, false, false);
        let right = model.faces.clone();
        [3, 4, 40].into_iter().for_each(|face| model.faces[face].swap(1, 2));
        let surface = made(model);
        assert_eq!(told(&surface), ["turns 3 of 72 faces"]);
        let sorted = |face: [DVec3; 3]| {
            let least = (0..3).min_by(|one, other| face[*one].x.total_cmp(&face[*other].x)).expect("three");
            [0, 1, 2].map(|corner| face[(least + corner) % 3])
        };
        let vertices = ring(12, 3, false, false).vertices;
        for face in 0..surface.face_count() {
            let of = right[surface.order[face] as usize].map(|corner| vertices[corner as usize]);
            assert_eq!(sorted(surface.corners(face)), sorted(of));
        }
    }
}
