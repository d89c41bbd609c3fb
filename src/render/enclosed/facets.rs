//! The facet of a rough surface that a sample chooses, with the names of the tracer's own code.

use super::directions::{in_disc, orthonormal_pair};
use super::number::Enclosing;
use super::surface::HitPoints;
use glam::DVec2;
use tabray_exact::scalar::{cross, dot, per_axis, unit};

impl<N: Enclosing> HitPoints<N> {
    /// Returns the points with the normals of the facets that two numbers from 0 to 1 choose, among the facets that are
    /// seen along these unit vectors; `None` where the normals are open.
    pub fn with_facet(&self, dir: [N; 3], roughness: f64, numbers: DVec2) -> Option<Self> {
        let normal = self.normal;
        // Bent normals may face away from the rays, and are turned.
        if dot(normal, dir).range().high >= N::of(0.0) {
            return None;
        }
        let (zero, one, width) = (N::constant(0.0), N::constant(1.0), N::constant(roughness * roughness));
        let toward = dir.map(|along| -along);
        let [across, up] = orthonormal_pair(normal)?;
        let seen = [width * dot(toward, across), width * dot(toward, up), dot(toward, normal).max(zero)];
        let seen = unit(seen);
        let across_seen = (seen[0] * seen[0] + seen[1] * seen[1]).sqrt();
        let right = [-seen[1] / across_seen, seen[0] / across_seen, zero];
        let above = cross(seen, right);
        let [x, y] = in_disc::<N>(numbers);
        // The half of the disc that is turned away is squeezed into the part of it that can be seen.
        let part = N::constant(0.5) * (one + seen[2]);
        let y = (one - part) * (one - x * x).max(zero).sqrt() + part * y;
        let z = (one - x * x - y * y).max(zero).sqrt();
        let [x, y, z] = per_axis(|axis| x * right[axis] + y * above[axis] + z * seen[axis]);
        let z = z.max(zero);
        let facet = unit(per_axis(|axis| width * x * across[axis] + width * y * up[axis] + z * normal[axis]));
        let is_known = facet.iter().all(|along| along.range().is_bounded());
        is_known.then(|| Self {
            normal: facet,
            geometric_normal: Some(self.geometric_normal.unwrap_or(normal)),
            ..*self
        })
    }
}
