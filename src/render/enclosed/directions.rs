//! Directions in numbers that enclose them, as they are chosen in the arithmetic of images.

use super::number::Enclosing;
use glam::DVec2;
use tabray_exact::interval::Interval;

/// Encloses the point of the unit disc that two numbers from 0 to 1 choose, as
/// [`sample::on_disc`](tabray_world::sample::on_disc) does.
pub(super) fn in_disc<N: Enclosing>(numbers: DVec2) -> [N; 2] {
    let n = N::constant;
    let (sin, cos) = (n(2.0) * N::enclosing(Interval::pi()) * n(numbers.y)).sin_cos();
    let radius = n(numbers.x).sqrt();
    [radius * cos, radius * sin]
}

/// Encloses the two vectors perpendicular to a unit vector that `glam` chooses; `None` where they are open.
pub(super) fn orthonormal_pair<N: Enclosing>([x, y, z]: [N; 3]) -> Option<[[N; 3]; 2]> {
    let (n, side) = (N::constant, z.range());
    let sign = if side.low >= N::of(0.0) {
        n(1.0)
    } else if side.high < N::of(0.0) {
        n(-1.0)
    } else {
        return None;
    };
    let a = n(-1.0) / (sign + z);
    let b = x * y * a;
    Some([[n(1.0) + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]])
}
