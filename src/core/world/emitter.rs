//! Lights that are spread out, over a surface or over the sky: the trait that a plugin implements beside
//! [`Light`](crate::world::light::Light).
//!
//! Of radiance L, such a light adds `diffuse / pi` times the integral of `L cos(theta) V` over the directions in which it is
//! seen, where V tells whether anything is in the way. Each sample of a pixel sees one of its points, and the mean of the
//! samples tends to the integral.

use crate::world::ball::Ball;
use crate::world::material::Rgb;
use crate::world::panel::{Panel, on_disc};
use crate::world::sky_light::SkyLight;
use glam::{DVec2, DVec3};

/// A light that is spread out.
pub trait Emitter: Send + Sync {
    /// Chooses a point of the light by two numbers from 0 to 1, as seen from a point `at` with a unit normal; `None` where
    /// the numbers stand for no point of it.
    fn sample(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<LightSample>;

    /// Describes all of its points, for proofs, and how they are chosen. The default is always correct.
    fn extent(&self) -> Extent<'_> {
        Extent::Unknown
    }

    /// Tells whether surfaces with a shininess show its highlights. What mirrors show themselves has none.
    fn has_highlights(&self) -> bool {
        true
    }
}

/// A point of a light, as it is seen from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// The unit vector toward it.
    pub toward: DVec3,
    /// The distance up to which objects are in its way, in world units; infinite for light from the sky.
    pub distance: f64,
    /// The radiance of the sample, divided by pi and by the density of such samples per unit of solid angle. The cosine of
    /// the angle at which the light arrives is not in it.
    pub light: Rgb,
}

/// The points of a light, for proofs of what it adds. Its radiance at them is what the light's
/// [`enclose`](crate::world::light::Light::enclose) returns.
#[derive(Clone, Copy)]
pub enum Extent<'e> {
    /// The points of a flat panel, chosen by [`Panel::sample`].
    Panel(Panel),
    /// The points of a ball's surface, chosen by [`Ball::sample`].
    Ball(Ball),
    /// The directions around a unit vector, chosen by [`in_cone`]. Their radiance is such that a surface that faces this vector
    /// gets what `enclose` returns.
    Cone {
        /// The middle.
        axis: DVec3,
        /// 1 minus the cosine of the largest angle to it.
        height: f64,
    },
    /// The directions of a sky, whose radiance is that of its background.
    Sky(&'e SkyLight),
    /// Any points.
    Unknown,
}

/// Chooses a direction in the half space of a unit normal by two numbers from 0 to 1, with a density of the cosine over pi.
pub fn by_cosine(normal: DVec3, numbers: DVec2) -> DVec3 {
    let DVec2 { x, y } = on_disc(numbers);
    let (across, up) = normal.any_orthonormal_pair();
    (x * across + y * up + (1.0 - x * x - y * y).max(0.0).sqrt() * normal).normalize()
}

/// Chooses a direction around a unit axis by two numbers from 0 to 1, with the same density everywhere within an angle whose
/// cosine is `1 - height`.
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
