//! How far hits are off a surface that has an equation: the equation's value at the hit, divided by the length of its
//! gradient there. Rounding to `f64` alone would be as large as the errors of good hits, so what 53 bits leave open is
//! computed in 237.

use glam::DVec3;
use tabray_core::geometry::sight::Sight;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::certify::{Enclosure, Precise, Precision, ProofMethods, gradient};
use tabray_exact::dual::Dual;
use tabray_exact::interval::{Float, Fraction, Interval};
use tabray_exact::scalar::Scalar;

/// Returns the distance of a hit from the surface, to first order and in world units, where it is more than what is
/// allowed. `None` where it is not, and for a shape without an equation.
pub fn beyond(shape: &AnyShape, sight: &Sight, at: DVec3, allowed: f64) -> Option<f64> {
    let proven = shape.proven()?;
    // Most shapes have a single part.
    if of_part(proven, at, 0, allowed)? <= allowed {
        return None;
    }
    match shape.certify_part(sight, Precision::Double) {
        (Enclosure::Hits(_), part) => of_part(proven, at, part, allowed).filter(|off| *off > allowed),
        _ => None,
    }
}

/// Returns a bound on the distance of a point from a part's surface if that is at most what is allowed, else the
/// distance.
fn of_part(proven: &dyn ProofMethods, at: DVec3, part: usize, allowed: f64) -> Option<f64> {
    let coarse = enclosed::<f64>(proven, at, part)?;
    if coarse.high <= allowed {
        return Some(coarse.high);
    }
    let fine = enclosed::<Fraction>(proven, at, part)?.middle().to_f64();
    fine.is_finite().then_some(fine)
}

/// Encloses the first-order distance of a point from a part's surface.
fn enclosed<F: Precise>(proven: &dyn ProofMethods, at: DVec3, part: usize) -> Option<Interval<F>> {
    let proofs = F::proofs(proven);
    if !proofs.has_equation(part) {
        return None;
    }
    let at = at.to_array().map(|along| Interval::<F>::point(F::of(along)));
    let value = proofs.slope(at.map(Dual::fixed), part).value;
    let [x, y, z] = gradient(proofs, at, part);
    Some(value.abs() / (x.powi(2) + y.powi(2) + z.powi(2)).sqrt())
}
