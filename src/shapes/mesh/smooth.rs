//! Normals of a smoothed mesh.

use super::surface::Surface;
use glam::DVec3;
use tabray_exact::double_double::{exponent_to_one, times_power_of_two};
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, cross, dot, per_axis};

impl Surface {
    /// Returns the normal at a point of a face: the face's own, or the interpolated normals of its corners. `flat` is
    /// the face's normal, turned to the ray if both sides are lit. The result is on the same side.
    #[inline(always)]
    pub(super) fn smoothed(&self, face: usize, at: DVec3, flat: DVec3) -> DVec3 {
        if self.is_smooth() { self.interpolated(face, at, flat) } else { flat }
    }

    /// Encloses [`smoothed`](Self::smoothed), or returns `None` if that is undecided.
    pub(super) fn enclosed_normal<F: Float>(
        &self,
        face: usize,
        at: [Interval<F>; 3],
        flat: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        if !self.is_smooth() {
            return Some(flat);
        }
        let n = Interval::<F>::constant;
        let zero = F::of(0.0);
        let minus = |one: [Interval<F>; 3], other: [Interval<F>; 3]| per_axis(|axis| one[axis] - other[axis]);
        let [a, b, c] = self.corners(face).map(|corner| corner.to_array().map(n));
        let across = cross(minus(b, a), minus(c, a));
        let part = |from: [Interval<F>; 3], to: [Interval<F>; 3]| {
            dot(cross(minus(to, from), minus(at, from)), across).max(n(0.0))
        };
        let weights = [part(b, c), part(c, a), part(a, b)];
        let mut sum = [n(0.0); 3];
        for (normal, weight) in self.corner_normals(face).into_iter().zip(weights) {
            sum = per_axis(|axis| sum[axis] + weight * n(normal[axis]));
        }
        let side = dot(flat, across);
        if side.has_zero() {
            return None;
        }
        let sum = if side.high < zero { per_axis(|axis| -sum[axis]) } else { sum };
        let length = dot(sum, sum).sqrt();
        if length.has_zero() || !length.is_bounded() {
            return None;
        }
        let normal = per_axis(|axis| sum[axis] / length);
        let cosine = dot(normal, flat);
        if cosine.has_zero() { None } else { Some(if cosine.low > zero { normal } else { flat }) }
    }

    /// Tells whether the mesh is smoothed.
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        !self.normals.is_empty()
    }

    /// Returns the normals at the corners of a face of a smoothed mesh.
    #[inline(always)]
    pub(super) fn corner_normals(&self, face: usize) -> [[f64; 3]; 3] {
        self.normals.faces[face].map(|normal| self.normals.values[normal as usize].map(f64::from))
    }

    fn interpolated(&self, face: usize, at: DVec3, flat: DVec3) -> DVec3 {
        let [a, b, c] = self.corners(face);
        let across = (b - a).cross(c - a);
        // Scaling by a power of two keeps products of tiny or huge areas from underflow and overflow.
        let scale = times_power_of_two(1.0, exponent_to_one(across.abs().max_element()));
        let across = across * scale;
        // The weights are the parts of the face's area opposite the corners.
        let part = |from: DVec3, to: DVec3| ((to - from).cross(at - from) * scale).dot(across).max(0.0);
        let weights = [part(b, c), part(c, a), part(a, b)];
        let normals = self.corner_normals(face).into_iter().zip(weights);
        let sum = normals.fold(DVec3::ZERO, |sum, (normal, weight)| sum + weight * DVec3::from(normal));
        // Corner normals are those of the faces' outer sides.
        let sum = if flat.dot(across) < 0.0 { -sum } else { sum };
        sum.try_normalize().filter(|normal| normal.dot(flat) > 0.0).unwrap_or(flat)
    }
}
