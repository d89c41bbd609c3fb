//! Views: the rays of an image, from the viewer and after their reflection by plane mirrors.

use super::hull::Hull;
use glam::DVec3;
use tabray_exact::scalar::per_axis;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::scene::model::Object;
use tabray_world::sensor::Sensor;

/// Rays that all lead away from one point, between four directions.
pub(super) struct View {
    /// The viewer, or its mirror image.
    pub apex: DVec3,
    /// The unit vectors along the edges of the image.
    dirs: [DVec3; 4],
    /// The region that the rays reach.
    hull: Hull,
    margin: f64,
}

impl View {
    /// Returns the primary rays of an image, with all samples of its pixels; `None` where they do not start at one
    /// point, or are not known to lie in a half-space.
    pub fn of(camera: &Sensor, margin: f64) -> Option<Self> {
        let apex = camera.origins().middle;
        let dirs = camera.camera.corners(camera.pixels, margin)?;
        let is_sound = apex.is_finite() && dirs.iter().all(|dir| dir.is_finite());
        is_sound.then(|| Self { apex, dirs, hull: Hull::new(vec![apex], dirs.to_vec(), margin), margin })
    }

    /// Returns the rays after their reflection by a plane mirror, given by a point and the unit normal.
    pub fn mirrored(&self, at: DVec3, normal: DVec3) -> Self {
        let turned = |dir: DVec3| dir - 2.0 * dir.dot(normal) * normal;
        let height = (self.apex - at).dot(normal);
        let apex = self.apex - 2.0 * height * normal;
        let dirs = self.dirs.map(turned);
        let mut hull = Hull::new(vec![apex], dirs.to_vec(), self.margin);
        // The rays stay on the viewer's side of the mirror.
        hull.cut(at, if height > 0.0 { -normal } else { normal });
        Self { apex, dirs, hull, margin: self.margin }
    }

    /// Returns a lower bound on the distance of an object from the rays, in world units; 0 where they may meet.
    pub fn clearance(&self, object: &Object, bounds: Option<&Aabb>) -> f64 {
        clearance(&self.hull, object, bounds)
    }

    /// Returns the region in which an object may be seen.
    pub fn seen(&self, object: &Object, bounds: Option<&Aabb>) -> VisibleRegion {
        if bounds.is_some() {
            return VisibleRegion::of(bounds);
        }
        let crossing = |dir: &DVec3| {
            let [at, normal] = object.shape.facts().plane?;
            let distance = normal.dot(at - self.apex) / normal.dot(*dir);
            (normal.dot(*dir).abs() > 1e-6 && distance > 0.0).then(|| self.apex + distance * *dir)
        };
        let corners: Vec<_> = self.dirs.iter().filter_map(crossing).collect();
        match <[DVec3; 4]>::try_from(corners) {
            Ok(corners) => VisibleRegion { bounds: Aabb::around(&corners), corners: Some(corners) },
            Err(_) => VisibleRegion::of(None),
        }
    }

    /// Returns how far along the middle of the rays an object may be seen, in world units; infinite where nothing ends
    /// it.
    pub fn depth(&self, seen: &VisibleRegion) -> f64 {
        let middle = self.middle();
        let depth = |at: DVec3| middle.dot(at - self.apex);
        let far = match &seen.corners {
            Some(corners) => corners.iter().map(|corner| depth(*corner)).fold(0.0, f64::max),
            None => depth(seen.bounds.middle()) + middle.abs().dot(seen.bounds.half_size()),
        };
        if far.is_nan() { f64::INFINITY } else { far.max(0.0) }
    }

    fn middle(&self) -> DVec3 {
        self.dirs.iter().sum::<DVec3>().normalize()
    }

    /// Returns the region of the paths from what is seen, up to a depth along the middle of the rays, to a light.
    pub fn paths(&self, far: f64, location: DVec3, size: f64) -> Hull {
        let middle = self.middle();
        let mut points = if size > 0.0 {
            let corner =
                |index: i32| DVec3::from(per_axis(|axis| if index >> axis & 1 == 0 { size } else { -size }));
            (0..8).map(|index| location + corner(index)).collect()
        } else {
            vec![location]
        };
        points.push(self.apex);
        // At greater depths, directions serve as well as points.
        let is_near = far < 1e6 * (1.0 + self.apex.abs().max_element());
        if is_near && self.dirs.iter().all(|dir| dir.dot(middle) > 0.1) {
            points.extend(self.dirs.map(|dir| self.apex + (1.0 + self.margin) * far / dir.dot(middle) * dir));
            return Hull::new(points, Vec::new(), self.margin);
        }
        Hull::new(points, self.dirs.to_vec(), self.margin)
    }
}

/// The region in which an object may be seen.
pub(super) struct VisibleRegion {
    /// A box around the points, which may be unbounded.
    pub bounds: Aabb,
    /// The points of a plane at the corners of the image, if they all show it.
    corners: Option<[DVec3; 4]>,
}

impl VisibleRegion {
    /// Returns the region in which an object with this bounding box may be seen from anywhere.
    pub fn of(bounds: Option<&Aabb>) -> Self {
        let everywhere = Aabb { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };
        Self { bounds: bounds.copied().unwrap_or(everywhere), corners: None }
    }
}

/// Returns a lower bound on the distance of an object from a region, in world units; 0 where they may meet.
pub(super) fn clearance(region: &Hull, object: &Object, bounds: Option<&Aabb>) -> f64 {
    let by_box = bounds.map_or(0.0, |bounds| region.clearance(bounds));
    if by_box > 0.0 {
        return by_box;
    }
    let of_plane = |[at, normal]: [DVec3; 2]| region.clearance_of_plane(at, normal);
    object.shape.facts().plane.map_or(0.0, of_plane)
}
