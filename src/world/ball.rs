//! Balls that shine, and the points of them that are seen.

use crate::directions::in_cone;
use crate::number::Number;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use tabray_exact::scalar::{cross, dot, per_axis};

/// A ball that shines at its surface, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The middle, in world coordinates.
    pub middle: DVec3,
    /// The radius, in world units.
    pub radius: f64,
}

impl Ball {
    /// Chooses a point as seen from a place by two numbers from 0 to 1, evenly by solid angle: in the cone that
    /// touches the ball, or, from inside the ball, in the half-space of the normal.
    ///
    /// Returns the unit vector to the point, its distance in world units, and the solid angle over which it was chosen,
    /// divided by pi; at most 2. `None` where the point is open.
    pub fn sample<N: Number>(&self, at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<([N; 3], N, N)> {
        let n = N::constant;
        let between = per_axis(|axis| n(self.middle[axis]) - at[axis]);
        let (distance, radius) = (dot(between, between).sqrt(), n(self.radius));
        let is_inside = (radius - distance).sign()? == n(1.0);
        let (axis, height) = match is_inside {
            true => (normal, n(1.0)),
            false => (N::along(between, normal)?, self.height(distance)),
        };
        let toward = in_cone(axis, height, numbers)?;
        let (along, aside) = (dot(between, toward), cross(between, toward));
        let half_chord = (radius * radius - dot(aside, aside)).sqrt();
        let distance = match is_inside {
            true => along + half_chord,
            false => (distance - radius) * ((distance + radius) / (along + half_chord)),
        };
        Some((toward, distance, n(2.0) * height))
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses each point that is seen
    /// from a place; `None` inside the ball.
    pub fn density(&self, at: DVec3) -> Option<f64> {
        let distance = (self.middle - at).length();
        let height = self.height(distance);
        (distance > self.radius && height > 0.0).then(|| 1.0 / (2.0 * PI * height))
    }

    /// Returns 1 minus the cosine of the ball's angular radius at a distance from its middle, outside the ball.
    pub fn height<N: Number>(&self, distance: N) -> N {
        let (one, radius) = (N::constant(1.0), N::constant(self.radius));
        let sine = radius / distance;
        let square = (distance - radius) / distance * (one + sine);
        sine * sine / (one + square.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_chosen_evenly_over_what_is_seen_of_it() {
        let count = 64;
        for (distance, radius) in [(2.0, 1.0), (1.001, 1.0), (1e6, 1.0), (0.5, 1.0), (3e-5, 2e-5)] {
            let ball = Ball { middle: DVec3::new(0.0, distance, 0.0), radius };
            let mut cosines = 0.0;
            for index in 0..count * count {
                let place = |part: i32| (f64::from(part) + 0.5) / f64::from(count);
                let numbers = DVec2::new(place(index % count), place(index / count));
                let (toward, distance, solid_angle_over_pi) =
                    ball.sample([0.0; 3], [0.0, 1.0, 0.0], numbers).expect("a direction");
                let toward = DVec3::from(toward);
                let off = (distance * toward - ball.middle).length() / radius - 1.0;
                assert!(off.abs() < 1e-8 && distance > 0.0, "{ball:?} {numbers}: {off}");
                cosines += PI * solid_angle_over_pi * toward.y;
            }
            // The integral of the cosine: pi times the square of the sine.
            let sine = (radius / distance).min(1.0);
            let off = cosines / f64::from(count * count) / (PI * sine * sine) - 1.0;
            assert!(off.abs() < 1e-3, "{ball:?}: {off}");
        }
    }
}
