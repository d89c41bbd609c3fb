//! Rays to ask shapes for: the same ones on every run.

use super::revolution::Revolution;
use glam::DVec3;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;
use tabray::geometry::Ray;

/// Where the notes' scene has the viewer.
pub const VIEWPOINT: DVec3 = DVec3::new(4.0, 3.0, 7.0);

/// Where the notes' scene has the base of its surface of revolution.
pub const BASE: DVec3 = DVec3::new(4.0, 0.0, -4.0);

/// Random numbers.
pub struct Random(Pcg32);

impl Random {
    /// A sequence of its own for each number.
    pub fn new(sequence: u64) -> Self {
        Self(Pcg32::new(0, sequence))
    }

    /// One of all numbers between two.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * part
    }

    /// One of this many, from 0.
    pub fn below(&mut self, count: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(count)) >> 32) as u32
    }

    /// A direction, none more likely than another.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z).normalize()
    }

    /// A point of a ball.
    pub fn in_ball(&mut self, center: DVec3, radius: f64) -> DVec3 {
        let part = self.between(0.0, 1.0).cbrt();
        center + part * radius * self.direction()
    }
}

/// A ray from one point to another.
pub fn toward(origin: DVec3, target: DVec3) -> Ray {
    Ray { origin, dir: (target - origin).normalize() }
}

/// Rays from the notes' viewer through the screen [0,8] x [0,6] in the plane z = 0, like those of a picture. A scene
/// that is larger or smaller has them, too.
pub fn camera(count: usize, scale: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(1);
    (0..count).map(move |_| {
        let (x, y) = (random.below(640), random.below(480));
        let on_screen = DVec3::new(8.0 * f64::from(x) / 639.0, 6.0 * f64::from(y) / 479.0, 0.0);
        toward(scale * VIEWPOINT, scale * on_screen)
    })
}

/// Rays from a distance to points of a ball.
pub fn aimed(count: usize, center: DVec3, radius: f64, distance: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(2);
    (0..count).map(move |_| {
        let origin = center + distance * random.direction();
        toward(origin, random.in_ball(center, radius))
    })
}

/// Rays that start in a ball.
pub fn inside(count: usize, center: DVec3, radius: f64) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(3);
    (0..count).map(move |_| Ray { origin: random.in_ball(center, radius), dir: random.direction() })
}

/// Rays that touch a surface at random points of it, each with its normal, but for 10^-2 to 10^-12 of `scale`
/// outward or inward.
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

/// A random point of a surface of revolution with its normal. Where it has no width there is none.
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
