//! Balls that shine, and the points of them that are seen.

use crate::directions::in_cone;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A ball that shines at its surface, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The middle, in world coordinates.
    pub middle: DVec3,
    /// The radius, in world units.
    pub radius: f64,
}

/// A point of a ball, as it is seen from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSample {
    /// The unit vector toward it.
    pub toward: DVec3,
    /// The distance to it, in world units.
    pub distance: f64,
    /// The solid angle over which it was chosen evenly, divided by pi; at most 2.
    pub solid_angle_over_pi: f64,
}

impl Ball {
    /// Chooses a point as seen from a place by two numbers from 0 to 1, evenly by solid angle: in the cone that
    /// touches the ball, or, from inside the ball, in the half-space of the normal. `None` where the ball is too far
    /// away for a direction.
    pub fn sample(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<BallSample> {
        let between = self.middle - at;
        let (distance, radius) = (between.length(), self.radius);
        let is_outside = distance > radius;
        let (axis, height) = match self.height(distance) {
            Some(height) => (between.try_normalize()?, height),
            None => (normal, 1.0),
        };
        let toward = DVec3::from(in_cone(axis.to_array(), height, numbers)?);
        let along = between.dot(toward);
        let half_chord = (radius * radius - between.cross(toward).length_squared()).max(0.0).sqrt();
        let distance = match is_outside {
            true => (distance - radius) * ((distance + radius) / (along + half_chord)),
            false => along + half_chord,
        };
        Some(BallSample { toward, distance, solid_angle_over_pi: 2.0 * height })
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses each point that is seen
    /// from a place; `None` inside the ball.
    pub fn density(&self, at: DVec3) -> Option<f64> {
        let height = self.height((self.middle - at).length())?;
        (height > 0.0).then(|| 1.0 / (2.0 * PI * height))
    }

    /// Returns 1 minus the cosine of the ball's angular radius at a distance from its middle; `None` inside the ball.
    fn height(&self, distance: f64) -> Option<f64> {
        let sine = self.radius / distance;
        let square = (distance - self.radius) / distance * (1.0 + sine);
        (distance > self.radius).then(|| sine * sine / (1.0 + square.sqrt()))
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
                let BallSample { toward, distance, solid_angle_over_pi } =
                    ball.sample(DVec3::ZERO, DVec3::Y, numbers).expect("a direction");
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
