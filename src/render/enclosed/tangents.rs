//! The directions in which u and v grow along a surface, as the tracer finds them: by comparing places near each other.

use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, cross, dot, per_axis};
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::Precise;
use tabray_world::directions::orthonormal_pair;
use tabray_world::surface_point::{NEAR, size_of};

/// An upper limit on the rounding errors of directions found by comparison.
const ROUNDING: f64 = 1e-8;

/// Encloses the unit directions in which u and v grow at points of a part of a shape with these unit normals; `None`
/// where they are open.
pub(super) fn tangents<F: Precise>(
    shape: &AnyShape,
    part: usize,
    position: [Interval<F>; 3],
    normal: [Interval<F>; 3],
) -> Option<[[Interval<F>; 3]; 2]> {
    let n = Interval::<F>::constant;
    let proofs = F::proofs(shape.proven()?);
    let size = size_of(&**shape, || dot(position, position).sqrt().coarse().middle());
    let [across, up] = orthonormal_pair(normal)?;
    let slopes = |dir: [Interval<F>; 3]| {
        let at = |part_of: f64| {
            proofs.uv_bounds(per_axis(|axis| position[axis] + n(part_of * NEAR * size) * dir[axis]), part)
        };
        let ([from_u, from_v], [to_u, to_v]) = (at(-1.0)?, at(1.0)?);
        // A coordinate that grows beyond 1 begins at 0 again.
        let wrapped = |difference: Interval| {
            let turns = (difference + Interval::constant(0.5)).certain_floor()?;
            Some(Interval::<F>::from_f64(difference - Interval::constant(turns)))
        };
        Some([wrapped(to_u - from_u)?, wrapped(to_v - from_v)?])
    };
    let (right, above) = (slopes(across)?, slopes(up)?);
    let [u, v] = [0, 1].map(|of| per_axis(|axis| right[of] * across[axis] + above[of] * up[axis]));
    // Along one direction, the other coordinate does not change.
    let turned = |along: [Interval<F>; 3], grows: [Interval<F>; 3]| {
        let (toward, length) = (dot(along, grows), dot(along, along).sqrt());
        let sign = match (toward.low > F::of(0.0), toward.high < F::of(0.0)) {
            (true, _) => n(1.0),
            (_, true) => n(-1.0),
            _ => return None,
        };
        let rounding = Interval { low: F::of(-ROUNDING), high: F::of(ROUNDING) };
        let along = per_axis(|axis| sign * along[axis] / length + rounding);
        along.iter().all(|axis| axis.is_bounded()).then_some(along)
    };
    Some([turned(cross(v, normal), u)?, turned(cross(normal, u), v)?])
}
