//! Extended lights, over a surface or over the sky: the trait that a plugin implements besides
//! [`Light`](crate::light::Light).
//!
//! A light of radiance L adds `diffuse / pi` times the integral of `L cos(theta) V` over the directions in which it is
//! seen. V is 0 where anything is in the way, and 1 elsewhere. Each sample of a pixel sees one point of the light, and
//! the mean of the samples tends to the integral.

use crate::background::EnclosedBackground;
use crate::ball::Ball;
pub use crate::directions::{by_cosine, in_cone};
use crate::material::Rgb;
use crate::panel::Panel;
use crate::sky_map::SkyMap;
use glam::{DVec2, DVec3};

/// An extended light.
pub trait Emitter: Send + Sync {
    /// Chooses a point of the light by two numbers from 0 to 1, as seen from a point `at` with a unit normal; `None`
    /// where the numbers stand for no point of the light.
    fn sample(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<LightSample>;

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point of the light
    /// that is seen from a point `at` along the unit vector `toward`, at a distance in world units. Rough surfaces then
    /// look for the light in mirrored directions and by its samples, and count either by its density. The radiance is then
    /// at most [`brightest`](crate::light::Light::brightest). `None` where mirrored directions alone are to count, which
    /// is always correct.
    fn density(&self, _at: DVec3, _toward: DVec3, _distance: f64) -> Option<f64> {
        None
    }

    /// Describes all points of the light, for proofs, and how samples choose among them. The default is always correct.
    fn extent(&self) -> Extent<'_> {
        Extent::Unknown
    }

    /// Tells whether surfaces with a shininess show highlights of the light. A light that is seen in mirrors has none.
    fn has_highlights(&self) -> bool {
        true
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
pub enum Extent<'e> {
    /// The points of a flat panel, chosen by [`Panel::sample`].
    Panel(Panel),
    /// The points of a ball's surface, chosen by [`Ball::sample`].
    Ball(Ball),
    /// The directions around a unit vector, chosen by [`in_cone`]. A surface that faces this vector gets the light that
    /// is [sent](crate::light::Light::sent).
    Cone {
        /// The middle.
        axis: DVec3,
        /// 1 minus the cosine of the largest angle to it.
        height: f64,
    },
    /// The directions of a sky, chosen by the cosine. Where there is a map, it chooses half of them.
    Sky {
        /// The radiance.
        background: &'e dyn EnclosedBackground,
        /// Where it is bright.
        map: Option<&'e SkyMap>,
    },
    /// Any points.
    Unknown,
}
