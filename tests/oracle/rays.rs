//! Rays to test shapes with, the same in every run.

use super::revolution::Revolution;
use glam::DVec3;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;
use tabray::geometry::Ray;

/// The viewpoint of the notes' scene.
pub const VIEWPOINT: DVec3 = DVec3::new(4.0, 3.0, 7.0);

/// The base of the surface of revolution in the notes' scene.
pub const BASE: DVec3 = DVec3::new(4.0, 0.0, -4.0);

/// A generator of random numbers.
pub struct Random(Pcg32);

impl Random {
    /// Starts the sequence of this number.
    pub fn new(sequence: u64) -> Self {
        Self(Pcg32::new(0, sequence))
    }

    /// Returns a number between two others, uniformly distributed.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * part
    }

    /// Returns an integer from 0 to `count - 1`.
    pub fn below(&mut self, count: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(count)) >> 32) as u32
    }

    /// Returns a unit vector, uniformly distributed.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z).normalize()
    }

    /// Returns a point of a solid sphere.
    pub fn in_ball(&mut self, center: DVec3, radius: f64) -> DVec3 {
        let part = self.between(0.0, 1.0).cbrt();
        center + part * radius * self.direction()
    }
}

/// Returns the ray from one point toward another.
pub fn toward(origin: DVec3, target: DVec3) -> Ray {
    Ray { origin, dir: (target - origin).normalize() }
}

/// Returns rays from the notes' viewpoint through the image plane [0,8] x [0,6] at z = 0, like those of an image.
/// `scale` makes the scene larger or smaller.
pub fn camera(count: usize, scale: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(1);
    (0..count).map(move |_| {
        let (x, y) = (random.below(640), random.below(480));
        let on_screen = DVec3::new(8.0 * f64::from(x) / 639.0, 6.0 * f64::from(y) / 479.0, 0.0);
        toward(scale * VIEWPOINT, scale * on_screen)
    })
}

/// Returns rays from a distance to points of a solid sphere.
pub fn aimed(count: usize, center: DVec3, radius: f64, distance: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(2);
    (0..count).map(move |_| {
        let origin = center + distance * random.direction();
        toward(origin, random.in_ball(center, radius))
    })
}

/// Returns rays that start in a solid sphere.
pub fn inside(count: usize, center: DVec3, radius: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(3);
    (0..count).map(move |_| Ray { origin: random.in_ball(center, radius), dir: random.direction() })
}

/// Returns rays that are tangent to a surface at random points, each given with its normal, but shifted by 10^-2 to
/// 10^-12 of `scale` outward or inward.
pub fn grazing(
    count: usize,
    scale: f64,
    mut place: impl FnMut(&mut Random) -> (DVec3, DVec3),
) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(4);
    (0..count).map(move |_| {
        let (at, normal) = place(&mut random);
        let (along, across) = normal.any_orthonormal_pair();
        let angle = random.between(0.0, TAU);
        let dir = (angle.cos() * along + angle.sin() * across).normalize();
        let apart = scale * 0.1_f64.powi(2 + random.below(11) as i32);
        let apart = if random.below(2) == 0 { apart } else { -apart };
        let origin = at + apart * normal - scale * random.between(5.0, 20.0) * dir;
        Ray { origin, dir }
    })
}

/// Returns a random point of a surface of revolution with its normal. Where the radius is 0 there is none.
pub fn place_on(surface: &Revolution, random: &mut Random) -> (DVec3, DVec3) {
    loop {
        let (y, angle) = (random.between(0.02, 0.98) * surface.height(), random.between(0.0, TAU));
        let line = surface.line(y);
        if line.value > 1e-4 * surface.radius() {
            let (sin, cos) = angle.sin_cos();
            let at = DVec3::new(line.value * cos, y, line.value * sin);
            return (surface.base() + at, DVec3::new(cos, -line.slope, sin).normalize());
        }
    }
}
