//! Convex regions, and tests of whether objects lie outside of them.

use glam::DVec3;
use tabray_world::geometry::aabb::Aabb;

/// The convex hull of some points and of the rays that leave them in some directions.
///
/// A hull is stored as half-spaces. Each half-space contains the hull, so a point outside of a half-space is outside
/// of the hull. Their planes are the hull's faces and, for boxes that lie askew to the faces, the planes through its
/// edges along the axes.
pub(super) struct Hull {
    points: Vec<DVec3>,
    dirs: Vec<DVec3>,
    /// The half-spaces' planes: their unit normals, and their distances along these from the world's origin.
    faces: Vec<(DVec3, f64)>,
    /// How far outside something must be to count as outside, in world units.
    margin: f64,
}

/// The cosine up to which a direction counts as along a plane.
const ALONG: f64 = 1e-12;

impl Hull {
    /// Makes the hull of points and of directions of length 1. `margin` is a fraction of the points' coordinates.
    pub fn new(points: Vec<DVec3>, dirs: Vec<DVec3>, margin: f64) -> Self {
        let scale = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
        let mut hull = Self { points, dirs, faces: Vec::new(), margin: margin * scale };
        for axis in DVec3::AXES {
            hull.add(axis, None);
            hull.add(-axis, None);
        }
        for from in 0..hull.points.len() {
            let at = hull.points[from];
            let others = hull.points[from + 1..].iter().map(|point| *point - at);
            let edges: Vec<_> = others.chain(hull.dirs.iter().copied()).collect();
            for (index, edge) in edges.iter().enumerate() {
                for other in edges[index + 1..].iter().chain(&DVec3::AXES) {
                    let Some(normal) = edge.cross(*other).try_normalize() else { continue };
                    hull.add(normal, Some(at));
                    hull.add(-normal, Some(at));
                }
            }
        }
        hull
    }

    /// Adds the half-space with this normal that contains the hull, if there is one and if the point lies on its plane.
    fn add(&mut self, normal: DVec3, on: Option<DVec3>) {
        if self.dirs.iter().any(|dir| normal.dot(*dir) > ALONG) {
            return;
        }
        let far = self.points.iter().map(|point| normal.dot(*point)).fold(f64::NEG_INFINITY, f64::max);
        if on.is_none_or(|on| normal.dot(on) >= far - self.margin) {
            self.faces.push((normal, far));
        }
    }

    /// Cuts off the part beyond a plane, given by a point and the unit normal that points beyond. The hull's points
    /// and directions do not change.
    pub fn cut(&mut self, at: DVec3, normal: DVec3) {
        self.faces.push((normal, normal.dot(at)));
    }

    /// Returns a lower bound on the distance of a box from the hull in world units; 0 where they may meet.
    pub fn clearance(&self, bounds: &Aabb) -> f64 {
        let (middle, half) = (bounds.middle(), bounds.half_size());
        let apart = |(normal, far): &(DVec3, f64)| normal.dot(middle) - normal.abs().dot(half) - far;
        let most = self.faces.iter().map(apart).fold(f64::NEG_INFINITY, f64::max);
        // The slack for the box, and for directions that lead away from a face by up to `ALONG`.
        let margin = self.margin + 1e-9 * (middle.abs() + half).max_element();
        // False for boxes that are not finite.
        if most > margin { most - margin } else { 0.0 }
    }

    /// Returns a lower bound on the distance of a plane from the hull in world units, given by a point and the unit
    /// normal; 0 where they may meet.
    pub fn clearance_of_plane(&self, at: DVec3, normal: DVec3) -> f64 {
        let on_side = |normal: DVec3| {
            let is_away = self.dirs.iter().all(|dir| normal.dot(*dir) > ALONG);
            let least = self.points.iter().map(|point| normal.dot(*point - at)).fold(f64::INFINITY, f64::min);
            if is_away { least - self.margin - 1e-9 * at.abs().max_element() } else { 0.0 }
        };
        on_side(normal).max(on_side(-normal)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        (-9.0..9.0, -9.0..9.0, -9.0..9.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn what_is_clear_of_a_hull_holds_none_of_its_points(
            points in prop::collection::vec(vector(), 1..7),
            dirs in prop::collection::vec(vector(), 0..5),
            weights in prop::collection::vec(0.0..1.0, 12),
            (middle, half) in (vector(), vector()),
            normal in vector(),
        ) {
            let dirs: Vec<_> = dirs.into_iter().filter_map(DVec3::try_normalize).collect();
            let sum: f64 = weights[..points.len()].iter().sum();
            prop_assume!(sum > 1e-3);
            let inner = points.iter().zip(&weights).map(|(point, weight)| *point * *weight / sum).sum::<DVec3>();
            let inner = inner + dirs.iter().zip(&weights[7..]).map(|(dir, weight)| *dir * *weight * 30.0).sum::<DVec3>();
            let hull = Hull::new(points, dirs, 1e-9);
            let half = half.abs();
            let bounds = Aabb { low: middle - half, high: middle + half };
            let apart = hull.clearance(&bounds);
            let gap = (bounds.low - inner).max(inner - bounds.high).max(DVec3::ZERO).length();
            prop_assert!(apart <= gap, "{apart} from the hull, {gap} from {inner}");
            prop_assert_eq!(hull.clearance(&Aabb { low: inner, high: inner }), 0.0);
            if let Some(normal) = normal.try_normalize() {
                let apart = hull.clearance_of_plane(middle, normal);
                prop_assert!(apart <= normal.dot(inner - middle).abs());
                prop_assert_eq!(hull.clearance_of_plane(inner, normal), 0.0);
            }
        }
    }

    #[test]
    fn a_box_askew_to_a_wedge_is_clear_of_it() {
        let dirs = [DVec3::new(1.0, 1.0, -2.0), DVec3::new(-1.0, 1.0, -2.0), DVec3::new(-1.0, -1.0, -2.0)];
        let dirs = dirs.into_iter().chain([DVec3::new(1.0, -1.0, -2.0)]).map(DVec3::normalize).collect();
        let hull = Hull::new(vec![DVec3::ZERO], dirs, 1e-9);
        let cube =
            |x: f64, z: f64| Aabb { low: DVec3::new(x, 0.0, z), high: DVec3::new(x + 1.0, 1.0, z + 1.0) };
        assert!(hull.clearance(&cube(1.0, -1.5)) > 0.0, "beside it");
        assert!(hull.clearance(&cube(0.0, 0.1)) > 0.0, "behind it");
        assert_eq!(hull.clearance(&cube(1.0, -2.5)), 0.0, "in it");
        let behind = hull.clearance_of_plane(DVec3::new(0.0, 0.0, 3.0), DVec3::Z);
        assert!((2.9..=3.0).contains(&behind), "{behind}");
        assert_eq!(hull.clearance_of_plane(DVec3::new(0.0, -3.0, 0.0), DVec3::Y), 0.0);
    }
}
