//! The events and counts that the tracer reports to an observer.

use glam::DVec3;
use std::fmt;
use tabray_world::certify::Doubt;
use tabray_world::geometry::ray::Ray;
use tabray_world::material::Rgb;
use tabray_world::scene::model::Object;

/// An observer of rays being traced.
pub trait TraceObserver {
    /// Tells whether the observer sees each event. If so, rays are traced one by one, and no test is culled.
    fn sees_events(&self) -> bool {
        false
    }

    /// Receives an event, unless [`sees_events`](Self::sees_events) is false.
    fn see(&mut self, _event: Event) {}

    /// Receives a count of work done or saved.
    fn count(&mut self, _count: Count) {}
}

impl TraceObserver for () {}

/// Work that was done or saved. Counts are of single rays, not of packets.
#[derive(Clone, Debug, PartialEq)]
pub enum Count {
    /// A number of rays of a kind were cast.
    Rays(RayKind, usize),
    /// The object of this index was tested against a number of rays.
    Tested(usize, usize),
    /// The object of this index was not tested against a number of rays, because they miss its bounds.
    Culled(usize, usize),
    /// A pixel took a number of samples, where pixels differ in that.
    Sampled(u32),
    /// The mean square error of a pixel's channels as they are shown, where 1 is white, estimated by the two halves of
    /// its samples; of one pixel in eight.
    Noise(f64),
    /// The error of a pixel's colour is bounded.
    Bounded {
        /// The bound, where 1 is white.
        error: f64,
        /// Whether it is within the limit.
        is_certified: bool,
        /// The number of footprints that were examined.
        footprints: u32,
    },
    /// A pixel has used up its ray budget; it lacks at most this much light in any channel.
    Cut(f64),
    /// This number of rays from the viewer lack light from mirrors or through glass, because the notes' rules end
    /// their paths.
    Far(usize),
    /// A pixel has a camera ray for which it is undecided whether it hits the object of this index first, at this point.
    Undecided(usize, Doubt, DVec3),
}

/// The kinds of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RayKind {
    /// A ray from the viewer.
    Primary,
    /// A ray from a surface to a light; in a scene with glass, one more from each pane on its way.
    Shadow,
    /// A ray reflected by a mirror.
    Reflected,
    /// A ray transmitted through glass.
    Transmitted,
    /// A ray from a matt surface to what else lights it.
    Scattered,
}

impl RayKind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Self; 5] =
        [Self::Primary, Self::Shadow, Self::Reflected, Self::Transmitted, Self::Scattered];
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Reflected => "reflected",
            Self::Transmitted => "transmitted",
            Self::Scattered => "scattered",
        })
    }
}

/// An event of a ray.
///
/// A ray begins (`Begin`). Its search starts (`Search`), tests objects (`Tested`) and ends (`FirstHit`), or the ray
/// is not followed (`Dropped`). Unless it is a shadow ray, its hit is followed by the surface (`Surface`), for each
/// light by its shadow rays and then its outcome (`Light`), by the shaded colour (`Shaded`), and by the reflected and
/// transmitted rays. With or without a hit, the ray's colour comes last (`Colour`).
#[derive(Clone, Copy)]
pub enum Event<'e> {
    /// A ray begins.
    Begin(RayPurpose),
    /// The search for the first hit of this ray starts.
    Search(&'e Ray),
    /// The ray is not followed.
    Dropped(DropReason),
    /// The object of this index was tested. The number is the distance of its hit in world units, or
    /// [`MISS`](tabray_world::geometry::ray::MISS) where there is none nearer than the nearest so far; `None` where the object
    /// was skipped because the ray leaves it.
    Tested(usize, Option<f64>),
    /// A search ended with this first hit, if any.
    FirstHit(Option<&'e Hit<'e>>),
    /// The surface at the first hit.
    Surface {
        /// The unit normal at the hit point.
        normal: DVec3,
        /// The ambient reflectivity at the hit point.
        ambient: Rgb,
    },
    /// The outcome of the light of this index.
    Light(usize, LightOutcome),
    /// The surface's own colour, by ambient light and by all lights, as seen by the viewer.
    Shaded {
        /// The first hit.
        hit: &'e Hit<'e>,
        /// The path length from the viewer in world units, by which the colour was divided.
        travelled: f64,
        /// The colour, without transmitted and reflected light.
        colour: Rgb,
    },
    /// The colour that a ray returns.
    Colour(Rgb),
}

/// The purpose of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayPurpose {
    /// A ray from the viewer through a pixel.
    Primary,
    /// A ray that continues through a transparent surface.
    Transmitted {
        /// The factor by which the ray's colour is multiplied.
        tint: Rgb,
        /// The fraction of the surface's own colour that is kept, from 0 to 1.
        kept: f64,
    },
    /// A ray reflected by a surface.
    Reflected {
        /// The factor by which the ray's colour is multiplied.
        specular: Rgb,
    },
    /// A ray from a matt surface to what else lights it.
    Scattered {
        /// The factor by which the ray's colour is multiplied.
        diffuse: Rgb,
    },
    /// A ray toward a light, to find what blocks it.
    Shadow {
        /// The distance at which the ray ends, in world units.
        distance: f64,
    },
}

/// The reason why a ray is not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropReason {
    /// The path from the viewer is too long.
    TooFar,
    /// The light that the ray can add to the pixel is too faint to be seen.
    TooFaint,
    /// The ray budget is used up.
    TooMany,
}

/// The effect of a light at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightOutcome {
    /// The light is behind the surface.
    Behind,
    /// The light does not point at the hit.
    Aside,
    /// The opaque object of this index blocks the light.
    Blocked(usize),
    /// The light shines on the hit.
    Shines {
        /// The fraction of each channel that passes through glass on the way.
        passed: Rgb,
        /// The colour that the light adds, before the division by the path length.
        colour: Rgb,
    },
}

/// A ray's first hit.
pub struct Hit<'m> {
    /// The index of the object in the model.
    pub index: usize,
    /// The object.
    pub object: &'m Object,
    /// The distance from the ray's origin, in world units.
    pub distance: f64,
    /// The hit point, in world coordinates.
    pub point: DVec3,
}
