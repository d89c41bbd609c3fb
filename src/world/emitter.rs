//! Extended lights, over a surface or over the sky: the trait that a plugin implements besides
//! [`Light`](crate::light::Light).
//!
//! A light of radiance L adds `diffuse / pi` times the integral of `L cos(theta) V` over the directions in which it is
//! seen. V is 0 where anything is in the way, and 1 elsewhere. Each sample of a pixel sees one point of the light, and
//! the mean of the samples tends to the integral.

use crate::ball::Ball;
pub use crate::directions::{by_cosine, in_cone};
use crate::material::Rgb;
use crate::number::Number;
use crate::panel::Panel;
use glam::{DVec2, DVec3};
use tabray_exact::affine::Affine;
use tabray_exact::interval::{Interval, Wide};

/// How much of the way to a point of a light can be blocked: its own surface does not block it.
pub const FREE: f64 = 1.0 - 1e-9;

/// An extended light.
pub trait Emitter: Send + Sync {
    /// Chooses a point of the light by two numbers from 0 to 1, as seen from a point `at` with a unit normal. Its light is 0
    /// where the numbers stand for no point of the light. `None` where the point is open. Pictures ask in plain numbers,
    /// and proofs of colours in numbers that enclose others.
    fn sample<N: Number>(&self, at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>>
    where
        Self: Sized;

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point of the light
    /// that is seen from a point `at` along the unit vector `toward`, at a distance in world units. Rough surfaces then
    /// look for the light in mirrored directions and by its samples, and count either by its density. The radiance is then
    /// at most [`brightest`](crate::light::Light::brightest). `None` where mirrored directions alone are to count, which
    /// is always correct.
    fn density(&self, _at: DVec3, _toward: DVec3, _distance: f64) -> Option<f64> {
        None
    }

    /// Describes all points of the light, for proofs of its mean. The default is always correct.
    fn extent(&self) -> Extent {
        Extent::Unknown
    }

    /// Tells whether surfaces with a shininess show highlights of the light. A light that is seen in mirrors has none.
    fn has_highlights(&self) -> bool {
        true
    }
}

/// A point that is chosen on a light, as another point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterPoint<N> {
    /// The vector to it, in world units; if it is infinitely far away, a unit vector.
    pub toward: [N; 3],
    /// Whether it is infinitely far away.
    pub is_far: bool,
    /// The radiance, divided by pi and by the density of such points per unit of solid angle, without the cosine of the
    /// angle at which the light arrives.
    pub light: [N; 3],
}

/// An extended light of any type. Every [`Emitter`] is one.
pub trait EnclosedEmitter:
    Emitter + Chooses<f64> + Chooses<Interval> + Chooses<Affine> + Chooses<Wide>
{
    /// Chooses a point by [`Emitter::sample`]; `None` where there is none that gives light.
    fn sample_at(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<LightSample>;
}

/// An extended light of any type, asked in one number. Every [`Emitter`] is one.
pub trait Chooses<N> {
    /// Calls [`Emitter::sample`].
    fn choose(&self, at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>>;
}

impl<T: Emitter, N: Number> Chooses<N> for T {
    fn choose(&self, at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>> {
        self.sample(at, normal, numbers)
    }
}

impl<T: Emitter> EnclosedEmitter for T {
    fn sample_at(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<LightSample> {
        let EmitterPoint { toward, is_far, light } =
            self.sample(at.to_array(), normal.to_array(), numbers)?;
        let (toward, light) = (DVec3::from(toward), Rgb::from(light));
        if light == Rgb::ZERO {
            return None;
        }
        if is_far {
            return Some(LightSample { toward, distance: f64::INFINITY, light });
        }
        Some(LightSample { toward: toward.try_normalize()?, distance: FREE * toward.length(), light })
    }
}

/// A point of a light, as it is seen from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// The unit vector toward it.
    pub toward: DVec3,
    /// The distance up to which objects can be in the light's way, in world units; infinite for light from the sky.
    pub distance: f64,
    /// The radiance of the sample, divided by pi and by the density of such samples per unit of solid angle, without
    /// the cosine of the angle at which the light arrives.
    pub light: Rgb,
}

/// The points of a light, for proofs of its contribution. Its radiance at them is what it has
/// [sent](crate::light::Light::sent).
#[derive(Clone, Copy)]
pub enum Extent {
    /// The points of a flat panel.
    Panel(Panel),
    /// The points of a ball's surface.
    Ball(Ball),
    /// The directions around a unit vector. A surface that faces this vector gets the light that is
    /// [sent](crate::light::Light::sent).
    Cone {
        /// The middle.
        axis: DVec3,
        /// 1 minus the cosine of the largest angle to it.
        height: f64,
    },
    /// Any points.
    Unknown,
}
