//! The coordinates u and v on a mesh: those of its file if they are read, and otherwise those of each face.

use super::surface::Surface;
use crate::uv;
use glam::{DVec2, DVec3};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;

impl Surface {
    /// Returns u and v at a point of a face. Coordinates of a file repeat outside of 0 to 1.
    pub(super) fn uv_of(&self, face: usize, at: DVec3) -> DVec2 {
        let weights = uv::on_triangle(self.corners(face), at);
        if self.uv.is_empty() {
            return weights;
        }
        let Some(corners) = self.uv.at(face) else { return DVec2::ZERO };
        let [a, b, c] = corners.map(|[u, v]| DVec2::new(u.into(), v.into()));
        (a + weights.x * (b - a) + weights.y * (c - a)).to_array().map(repeated).into()
    }

    /// Encloses the exact [`uv_of`](Self::uv_of) for the points of a face in a box, or returns `None` if that is
    /// undecided.
    pub(super) fn uv_bounds(&self, face: usize, at: [Interval; 3]) -> Option<[Interval; 2]> {
        let weights = uv::bounds_on_triangle(self.corners(face), at);
        if self.uv.is_empty() {
            return Some(weights);
        }
        let Some(corners) = self.uv.at(face) else { return Some([Interval::constant(0.0); 2]) };
        let [u, v] = [0, 1].map(|axis| {
            let [a, b, c] = corners.map(|uv| Interval::constant(f64::from(uv[axis])));
            let at = a + weights[0] * (b - a) + weights[1] * (c - a);
            if at.low >= 0.0 && at.high <= 1.0 {
                return Some(at);
            }
            at.certain_floor().filter(|floor| *floor != 0.0).map(|floor| at - Interval::constant(floor))
        });
        Some([u?, v?])
    }
}

/// Returns the position of a coordinate in a repeating pattern. From 0 to 1, both ends included, it is unchanged.
fn repeated(along: f64) -> f64 {
    if (0.0..=1.0).contains(&along) { along } else { along - along.floor() }
}
