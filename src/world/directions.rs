//! Directions chosen by numbers from 0 to 1.

use crate::panel::on_disc;
use glam::{DVec2, DVec3};

/// Chooses a direction in the half-space of a unit normal by two numbers from 0 to 1, with a density of the cosine
/// over pi.
pub fn by_cosine(normal: DVec3, numbers: DVec2) -> DVec3 {
    let DVec2 { x, y } = on_disc(numbers);
    let (across, up) = normal.any_orthonormal_pair();
    (x * across + y * up + (1.0 - x * x - y * y).max(0.0).sqrt() * normal).normalize()
}

/// Chooses a direction around a unit axis by two numbers from 0 to 1, with the same density everywhere within an
/// angle whose cosine is `1 - height`.
pub fn in_cone(axis: DVec3, height: f64, numbers: DVec2) -> DVec3 {
    let disc = on_disc(numbers);
    // Equal areas of a disc are equal heights of the cap.
    let drop = height * disc.length_squared();
    let DVec2 { x, y } = disc * (height * (2.0 - drop)).sqrt();
    let (across, up) = axis.any_orthonormal_pair();
    (x * across + y * up + (1.0 - drop) * axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_even_within_a_cone_and_go_by_the_cosine() {
        let (axis, count) = (DVec3::new(1.0, -2.0, 0.5).normalize(), 100);
        let (mut cone, mut cosine) = (0.0, 0.0);
        for index in 0..count * count {
            let place = |part: i32| (f64::from(part) + 0.5) / f64::from(count);
            let numbers = DVec2::new(place(index % count), place(index / count));
            let toward = in_cone(axis, 0.5, numbers);
            assert!(toward.is_normalized() && toward.dot(axis) >= 0.5 - 1e-12);
            cone += toward.dot(axis);
            cosine += by_cosine(axis, numbers).dot(axis);
        }
        let mean = |sum: f64| sum / f64::from(count * count);
        assert!((mean(cone) - 0.75).abs() < 1e-4, "{}", mean(cone));
        assert!((mean(cosine) - 2.0 / 3.0).abs() < 1e-3, "{}", mean(cosine));
    }
}
