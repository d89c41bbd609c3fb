//! Directions and places chosen by numbers from 0 to 1, in any number.

use crate::number::Number;
use glam::DVec2;
use tabray_exact::scalar::{cross, dot, per_axis};

/// Returns the point of the unit disc that two numbers from 0 to 1 choose, uniformly by area.
#[inline]
pub fn on_disc<N: Number>(numbers: DVec2) -> [N; 2] {
    let (sin, cos) = (N::constant(2.0) * N::pi() * N::constant(numbers.y)).sin_cos();
    let radius = N::constant(numbers.x).sqrt();
    [radius * cos, radius * sin]
}

/// Maps two numbers from 0 to 1 to the unit disc, with areas in proportion (Shirley and Chiu, "A Low Distortion Map
/// Between Disk and Square", 1997).
#[inline]
pub fn from_square<N: Number>(numbers: DVec2) -> [N; 2] {
    let centred = |number: f64| N::constant(2.0) * N::constant(number) - N::constant(1.0);
    let (DVec2 { x, y }, quarter) = (2.0 * numbers - 1.0, N::constant(0.25) * N::pi());
    let [across, up] = [centred(numbers.x), centred(numbers.y)];
    let (radius, angle) = match x.abs() > y.abs() {
        true => (across, quarter * (up / across)),
        false if y == 0.0 => return [N::constant(0.0); 2],
        false => (up, N::constant(2.0) * quarter - quarter * (across / up)),
    };
    let (sin, cos) = angle.sin_cos();
    [radius * cos, radius * sin]
}

/// Returns two vectors perpendicular to a unit vector, those of `glam`; `None` where they are open.
#[inline]
pub fn orthonormal_pair<N: Number>([x, y, z]: [N; 3]) -> Option<[[N; 3]; 2]> {
    let (n, sign) = (N::constant, z.sign()?);
    let a = n(-1.0) / (sign + z);
    let b = x * y * a;
    Some([[n(1.0) + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]])
}

/// Chooses a direction in the half-space of a unit normal by two numbers from 0 to 1, with a density of the cosine
/// over pi; `None` where it is open.
#[inline]
pub fn by_cosine<N: Number>(normal: [N; 3], numbers: DVec2) -> Option<[N; 3]> {
    let [x, y] = from_square(numbers);
    around(normal, [x, y], (N::constant(1.0) - x * x - y * y).sqrt())
}

/// Chooses a direction around a unit axis by two numbers from 0 to 1, with the same density everywhere within an
/// angle whose cosine is `1 - height`; `None` where it is open.
#[inline]
pub fn in_cone<N: Number>(axis: [N; 3], height: N, numbers: DVec2) -> Option<[N; 3]> {
    let [x, y] = from_square(numbers);
    // Equal areas of a disc are equal heights of the cap.
    let drop = height * (x * x + y * y);
    let part = (height * (N::constant(2.0) - drop)).sqrt();
    around(axis, [part * x, part * y], N::constant(1.0) - drop)
}

/// Returns the unit vector with these coordinates across an axis, and along it; `None` where it is open.
#[inline]
fn around<N: Number>(axis: [N; 3], [x, y]: [N; 2], along: N) -> Option<[N; 3]> {
    if along.plain().is_none() && x.is_zero() && y.is_zero() {
        return Some(axis.map(|of| along * of));
    }
    let [across, up] = orthonormal_pair(axis)?;
    Some(N::lengthened(per_axis(|at| x * across[at] + y * up[at] + along * axis[at])))
}

/// Chooses the normal of a facet of a rough surface by two numbers from 0 to 1, among those that are seen along a unit
/// vector toward the viewer, in proportion to their visible area (Heitz, "Sampling the GGX Distribution of Visible
/// Normals", 2018). `width` is the parameter alpha of the distribution. `None` where the normal is open.
#[inline]
pub fn facet<N: Number>(normal: [N; 3], toward: [N; 3], width: f64, numbers: DVec2) -> Option<[N; 3]> {
    let (half, zero, one, width) = (N::constant(0.5), N::constant(0.0), N::constant(1.0), N::constant(width));
    let [across, up] = orthonormal_pair(normal)?;
    let seen = [width * dot(toward, across), width * dot(toward, up), dot(toward, normal).max(zero)];
    let seen = N::along(seen, [zero, zero, one])?;
    let right = N::along([-seen[1], seen[0], zero], [one, zero, zero])?;
    let above = cross(seen, right);
    // The half of the disc that is turned away is squeezed into the part of it that can be seen.
    let [x, y] = on_disc::<N>(numbers);
    let part = half * (one + seen[2]);
    let y = (one - part) * (one - x * x).sqrt() + part * y;
    let z = (one - x * x - y * y).sqrt();
    let [x, y, z] = per_axis(|axis| x * right[axis] + y * above[axis] + z * seen[axis]);
    let z = z.max(zero);
    N::along(per_axis(|axis| width * x * across[axis] + width * y * up[axis] + z * normal[axis]), normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use tabray_exact::interval::Interval;
    use tabray_exact::scalar::Scalar;

    /// Enclosing numbers know one 0, and proofs are about the samples of pictures.
    #[test]
    fn directions_around_a_negative_zero_are_those_around_zero() {
        let chosen = |axis: [f64; 3]| in_cone(axis, 0.5, DVec2::new(0.3, 0.9)).expect("a direction");
        let enclosed = |axis: [f64; 3]| {
            let axis = axis.map(Interval::<f64>::constant);
            in_cone(axis, Interval::constant(0.5), DVec2::new(0.3, 0.9)).expect("a direction")
        };
        for axis in [[0.6, -0.8, -0.0], [0.6, -0.8, 0.0], [-0.0, 1.0, -0.0], [0.0, -0.6, -0.8]] {
            for (one, within) in chosen(axis).into_iter().zip(enclosed(axis)) {
                assert!((one - within.middle()).abs() < 1e-15, "{axis:?}: {one} is not in {within:?}");
            }
        }
    }

    #[test]
    fn directions_are_even_within_a_cone_and_go_by_the_cosine() {
        let (axis, count) = (DVec3::new(1.0, -2.0, 0.5).normalize(), 100);
        let (mut cone, mut cosine) = (0.0, 0.0);
        for index in 0..count * count {
            let place = |part: i32| (f64::from(part) + 0.5) / f64::from(count);
            let numbers = DVec2::new(place(index % count), place(index / count));
            let toward = DVec3::from(in_cone(axis.to_array(), 0.5, numbers).expect("a direction"));
            assert!(toward.is_normalized() && toward.dot(axis) >= 0.5 - 1e-12);
            cone += toward.dot(axis);
            cosine += DVec3::from(by_cosine(axis.to_array(), numbers).expect("a direction")).dot(axis);
        }
        let mean = |sum: f64| sum / f64::from(count * count);
        assert!((mean(cone) - 0.75).abs() < 1e-4, "{}", mean(cone));
        assert!((mean(cosine) - 2.0 / 3.0).abs() < 1e-3, "{}", mean(cosine));
    }
}
