//! What the tracer tells whoever watches it: each ray, each test, each light, as it happens.

use crate::geometry::ray::Ray;
use crate::scene::model::Object;
use crate::world::material::Rgb;
use glam::DVec3;
use std::fmt;

/// Someone who watches rays being traced.
///
/// Nobody, `()`, watches plain rendering; there all of this compiles to nothing.
pub trait TraceObserver {
    /// Whether it sees each event. Then rays go one by one, and none is spared a test.
    const SEES: bool;

    /// Something happened.
    fn see(&mut self, _event: Event) {}

    /// So much was done.
    fn count(&mut self, _count: Count) {}
}

impl TraceObserver for () {
    const SEES: bool = false;
}

/// Work that was done, or spared. Rays go in packets; it is their rays that are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Count {
    /// So many rays of a kind were cast.
    Rays(RayKind, usize),
    /// So many rays were tested against the object of this index.
    Tested(usize, usize),
    /// So many rays were not, as the object's bounds are not in their way.
    Culled(usize, usize),
    /// A pixel has cost as many rays as it may, and lacks so much light at most, in any channel.
    Cut(f64),
}

/// The kinds of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RayKind {
    /// From the viewer.
    Primary,
    /// From a surface to a light; in a scene with glass, anew from behind each pane on its way.
    Shadow,
    /// From a mirror.
    Reflected,
    /// Through glass.
    Transmitted,
}

impl RayKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Primary, Self::Shadow, Self::Reflected, Self::Transmitted];
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Reflected => "reflected",
            Self::Transmitted => "transmitted",
        })
    }
}

/// What happens to rays.
///
/// A ray begins (`Begin`). Its search starts (`Search`), tests objects (`Tested`) and ends (`Met`), or it is not
/// worth one (`Dropped`). Unless it is a shadow ray there follow, where it met something, the surface there
/// (`Surface`), for each light its shadow rays and then its outcome (`Light`), what they make together (`Shaded`)
/// and the rays that go on from there; and always the colour that it brings back (`Colour`).
#[derive(Clone, Copy)]
pub enum Event<'e> {
    /// A ray begins.
    Begin(Purpose),
    /// It goes this way, and looks for what it meets first.
    Search(&'e Ray),
    /// It is not followed.
    Dropped(Reason),
    /// An object, by its index, was asked for its distance, within what was the nearest so far; nothing where
    /// it was passed over because the ray leaves it.
    Tested(usize, Option<f64>),
    /// A search ended: what the ray meets first.
    Met(Option<&'e Hit<'e>>),
    /// The surface where it was met.
    Surface {
        /// The unit normal there.
        normal: DVec3,
        /// What it reflects of the light from nowhere in particular.
        ambient: Rgb,
    },
    /// What became of one light, by its index.
    Light(usize, Outcome),
    /// Ambient light and lights together, as they look from the viewer.
    Shaded {
        /// What was met.
        hit: &'e Hit<'e>,
        /// How far the light has come, and what it was divided by.
        travelled: f64,
        /// The colour, without what shines through or is mirrored.
        colour: Rgb,
    },
    /// The colour that a ray brings back.
    Colour(Rgb),
}

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Purpose {
    /// From the viewer through a pixel.
    Primary,
    /// Onward through a transparent surface.
    Transmitted {
        /// What its colour is multiplied by.
        tint: Rgb,
        /// The part of the surface's own colour that stays beside it.
        kept: f64,
    },
    /// Mirrored by a surface.
    Reflected {
        /// What its colour is multiplied by.
        specular: Rgb,
    },
    /// Toward a light, to see what stands between.
    Shadow {
        /// How far away that is.
        distance: f64,
    },
}

/// Why a ray is not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Its light has travelled too far to be seen.
    TooFar,
    /// What it can add to the pixel is too little to be seen.
    TooFaint,
    /// The pixel has cost as many rays as it may.
    TooMany,
}

/// What becomes of a light at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It is behind the surface.
    Behind,
    /// It does not point there.
    Aside,
    /// An opaque object, by its index, stands between.
    Blocked(usize),
    /// It shines.
    Shines {
        /// The part of each channel that gets there.
        passed: Rgb,
        /// What it adds to the colour, before that is divided by the distance travelled.
        colour: Rgb,
    },
}

/// What a ray meets first.
pub struct Hit<'m> {
    /// Which of the model's objects.
    pub index: usize,
    /// The object.
    pub object: &'m Object,
    /// How far from the ray's origin.
    pub distance: f64,
    /// Where.
    pub point: DVec3,
}
