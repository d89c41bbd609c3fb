//! Polygons of a file, and their division into triangles.

use super::model::{Model, Remark};
use earcut::Earcut;
use glam::{DVec2, DVec3};
use tabray_world::parallel;
use tabray_world::text;

/// The distance of a polygon's corners from its plane, as a fraction of its size, above which a warning is given.
/// Polygons of round shapes are hardly ever flat.
const FLAT: f64 = 0.1;

/// The tolerance for an edge that turns to the wrong side, as a fraction of the product of two edges.
const STRAIGHT: f64 = 1e-9;

/// The maximum number of pairs of corners of concave polygons in a file. Cutting these takes up to five seconds.
const MAX_PAIRS: u64 = 1 << 30;

/// The faces of a file that are not triangles.
#[derive(Default)]
pub(super) struct Polygons {
    /// For each polygon, the index of its first triangle, and the number of triangles in the fan from its first corner.
    fans: Vec<[u32; 2]>,
    /// The number of skipped faces with fewer than three corners.
    short: usize,
}

/// The properties of an unusual polygon.
struct Found {
    polygon: usize,
    is_bent: bool,
    /// The corners of a concave polygon in its plane.
    dented: Option<Vec<[f64; 2]>>,
}

impl Polygons {
    /// Adds a face with any number of corners to triangles.
    pub fn add(&mut self, corners: &[u32], faces: &mut Vec<[u32; 3]>) {
        let [first, rest @ ..] = corners else {
            self.short += 1;
            return;
        };
        match rest.len() {
            0 | 1 => self.short += 1,
            2 => {}
            count => self.fans.push([faces.len() as u32, count as u32 - 1]),
        }
        faces.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }

    /// Adds the values of a face's corners to a list for triangles.
    pub fn add_values(values: &[u32], list: &mut Vec<[u32; 3]>) {
        if let [first, rest @ ..] = values {
            list.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        }
    }

    /// Appends the polygons of further triangles, which follow `before` others.
    pub fn append(&mut self, other: Self, before: usize) {
        self.fans.extend(other.fans.into_iter().map(|[first, count]| [first + before as u32, count]));
        self.short += other.short;
    }

    /// Cuts the concave polygons of a whole file again, and reports anomalies of others.
    pub fn cut(self, model: &mut Model) {
        let find = |polygon: usize| {
            let corners = corners(model, self.fans[polygon]);
            let (dented, is_bent) = examine(&corners);
            (dented.is_some() || is_bent).then_some(Found { polygon, is_bent, dented })
        };
        let found = parallel::map_ranges(self.fans.len(), 2, &|range| range.filter_map(find).collect());
        let bent = found.iter().filter(|found| found.is_bent).count();
        let (mut left, mut uncut) = (MAX_PAIRS, 0);
        let dented: Vec<_> = found
            .into_iter()
            .filter_map(|found| Some((found.polygon, found.dented?)))
            .filter(|(_, flat)| {
                let after = left.checked_sub((flat.len() as u64).pow(2));
                match after {
                    Some(after) => left = after,
                    None => uncut += 1,
                }
                after.is_some()
            })
            .collect();
        let anew = parallel::map(dented.len(), |index| cut(&dented[index].1));
        if !anew.is_empty() {
            let cuts: Vec<_> =
                dented.iter().zip(anew).map(|((polygon, _), anew)| (self.fans[*polygon], anew)).collect();
            let recut = |list: &[[u32; 3]]| {
                pieced(&cuts, list, |fan, anew, all| {
                    let corners: Vec<_> = indices(list, fan).collect();
                    all.extend(anew.iter().map(|face| face.map(|corner| corners[corner as usize])));
                })
            };
            model.attributes.lists().for_each(|list| *list = recut(list));
            model.faces = recut(&model.faces);
            if !model.slots.is_empty() {
                model.slots = pieced(&cuts, &model.slots, |[first, _], anew, all| {
                    all.extend(anew.iter().map(|_| model.slots[first as usize]));
                });
            }
        }
        if self.short > 0 {
            model.remarks.push(Remark {
                message: format!(
                    "leaves out {} of fewer than three corners",
                    text::count(self.short, "face")
                ),
                help: "such a face is a point or a line: no ray hits it",
            });
        }
        if uncut > 0 {
            model.remarks.push(Remark {
                message: format!(
                    "has {} with too many corners to be cut",
                    text::count(uncut, "concave polygon")
                ),
                help: "such a face is shown as if it were convex; cut it into smaller ones",
            });
        }
        if bent > 0 {
            model.remarks.push(Remark {
                message: format!("has polygons that are not flat: {bent}"),
                help: "they are cut into triangles, which another program may do in another way; triangles are always flat",
            });
        }
    }
}

/// A polygon that was cut into a fan, and its new triangles, as indices of its corners.
type Cut = ([u32; 2], Vec<[u32; 3]>);

/// Returns a list for triangles in which `add` replaces the entries of polygons.
fn pieced<T: Copy>(cuts: &[Cut], list: &[T], add: impl Fn([u32; 2], &[[u32; 3]], &mut Vec<T>)) -> Vec<T> {
    let (mut all, mut next) = (Vec::with_capacity(list.len()), 0);
    for (fan, anew) in cuts {
        all.extend_from_slice(&list[next..fan[0] as usize]);
        add(*fan, anew, &mut all);
        next = (fan[0] + fan[1]) as usize;
    }
    all.extend_from_slice(&list[next..]);
    all
}

/// Returns the corners of a polygon that was cut into a fan.
fn indices(faces: &[[u32; 3]], [first, count]: [u32; 2]) -> impl Iterator<Item = u32> {
    let fan = &faces[first as usize..][..count as usize];
    fan.iter().take(1).flat_map(|face| [face[0], face[1]]).chain(fan.iter().map(|face| face[2]))
}

/// Returns the corners of a polygon relative to the first one.
fn corners(model: &Model, fan: [u32; 2]) -> Vec<DVec3> {
    let at = |corner: u32| model.vertices[corner as usize];
    let origin = at(model.faces[fan[0] as usize][0]);
    indices(&model.faces, fan).map(|corner| at(corner) - origin).collect()
}

/// Returns the corners of a polygon in its plane if it is concave, and tells whether the polygon is bent.
fn examine(corners: &[DVec3]) -> (Option<Vec<[f64; 2]>>, bool) {
    let count = corners.len();
    let normal: DVec3 = corners.windows(2).map(|pair| pair[0].cross(pair[1])).sum();
    let Some(upright) = normal.try_normalize() else { return (None, false) };
    let size = corners.iter().map(|at| at.length()).fold(0.0, f64::max);
    let heights = corners.iter().map(|at| at.dot(upright));
    let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
    // This is the view along an axis, from the side on which the corners run counterclockwise.
    let axis = normal.abs().max_position();
    let (mut across, mut up) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (across, up) = (up, across);
    }
    let flat: Vec<_> = corners.iter().map(|at| DVec2::new(at[across], at[up])).collect();
    let edges = (0..count).map(|at| flat[(at + 1) % count] - flat[at]).filter(|edge| *edge != DVec2::ZERO);
    let edges: Vec<_> = edges.collect();
    let pairs = || (0..edges.len()).map(|at| [edges[at], edges[(at + 1) % edges.len()]]);
    let turns_right =
        |[one, other]: [DVec2; 2]| one.perp_dot(other) < -STRAIGHT * one.length() * other.length();
    // The edges of a convex polygon go back and forth once.
    let forth = || edges.iter().map(|edge| edge.x).filter(|x| *x != 0.0).map(|x| x > 0.0);
    let reversals = forth().zip(forth().skip(1).chain(forth().take(1))).filter(|(one, other)| one != other);
    let is_dented = pairs().any(turns_right) || reversals.count() > 2;
    (is_dented.then(|| flat.iter().map(DVec2::to_array).collect()), high - low > FLAT * size)
}

/// Cuts a polygon with counterclockwise corners into counterclockwise triangles.
fn cut(flat: &[[f64; 2]]) -> Vec<[u32; 3]> {
    let mut triangles: Vec<u32> = Vec::new();
    Earcut::new().earcut(flat.iter().copied(), &[], &mut triangles);
    let counterclockwise = |[a, b, c]: [u32; 3]| {
        let at = |corner: u32| DVec2::from(flat[corner as usize]);
        if (at(b) - at(a)).perp_dot(at(c) - at(a)) < 0.0 { [a, c, b] } else { [a, b, c] }
    };
    triangles.chunks_exact(3).map(|face| counterclockwise([face[0], face[1], face[2]])).collect()
}
