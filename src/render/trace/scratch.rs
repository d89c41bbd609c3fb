//! Room for packets: what is kept from one to the next.

use super::arrays::Vectors;
use super::found::Found;
use super::group::{Group, Parts};
use super::surface::Surface;
use crate::geometry::ray::Side;
use crate::world::sample::Sample;

/// All that the packets of one thread need, one after the other.
#[derive(Default)]
pub(crate) struct Rooms {
    pub(super) primary: Option<Box<Primary>>,
    /// The x and y of the places of the picture that the camera rays under way look through, in pixels.
    pub(super) places: [Vec<f64>; 2],
    /// Of the camera rays under way, where pixels have more than one.
    pub(super) samples: Vec<Sample>,
    /// For packets that wait for those which have gone on from them, the foremost one last.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) levels: Vec<Box<Level>>,
    #[expect(clippy::vec_box, reason = "likewise")]
    pub(super) passages: Vec<Box<Passage>>,
    /// For what is over before any go on.
    pub(super) lighting: Option<Box<Lighting>>,
    pub(super) doubt: Vec<u64>,
    /// For each object that is listed with its bounds.
    pub(super) parts: Vec<u32>,
    /// For the way through a tree.
    pub(super) ahead: Vec<usize>,
    pub(super) inverse: Vectors,
    /// How much light each camera ray under way lacks at most, as it has cost as many rays as it may.
    pub(super) missing: Vec<f64>,
    /// Whether any lacks some.
    pub(super) any_missing: bool,
}

/// Rays from the viewer.
#[derive(Default)]
pub(super) struct Primary {
    pub group: Group,
    pub seen: Vectors,
    /// Of pixels.
    pub colours: Vectors,
}

/// The rays of a packet that meet the same object, while they are followed.
#[derive(Default)]
pub(super) struct Level {
    pub found: Found,
    pub parts: Parts,
    pub part: Group,
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    pub shading: Shading,
    pub seen: Vectors,
}

/// Room for what one packet needs while others go on from it.
#[derive(Default)]
pub(super) struct Shading {
    pub distances: Vec<f64>,
    pub surface: Surface,
    /// Where rays go on to.
    pub dir: Vectors,
    /// Which ones: 1 for those, and 0; and a list.
    pub goes: Vec<u64>,
    pub lanes: Vec<u8>,
    /// They themselves, and what they see.
    pub onward: Group,
    pub seen: Vectors,
    /// What all see, those that do not go on, too.
    pub behind: Vectors,
}

/// Room for what one light does after the other.
#[derive(Default)]
pub(super) struct Lighting {
    pub diffuse: Vectors,
    /// Where each place sees the light, if that is no point.
    pub lights: Vectors,
    pub toward: Vectors,
    pub falloffs: Vec<f64>,
    pub ends: Vec<f64>,
    pub emissivity: Vectors,
    pub shines: Vec<u64>,
    pub blocked: Vec<u64>,
    pub shadows: Shadows,
}

/// Room for the shadows of a packet.
#[derive(Default)]
pub(super) struct Shadows {
    /// Those that remain of a packet.
    pub lanes: Vec<u8>,
    pub origin: Vectors,
    pub dir: Vectors,
    pub their_ends: Vec<f64>,
    pub their_blocked: Vec<u64>,
    pub sides: Vec<Side>,
}

/// Rays on their way to a light.
#[derive(Default)]
pub(super) struct Passage {
    pub group: Group,
    pub ends: Vec<f64>,
    /// The part of each channel that has come through.
    pub tint: Vectors,
    /// The opaque object that stands in the way, by its index and 1; 0 where there is none.
    pub blocker: Vec<u64>,
    pub found: Found,
    pub parts: Parts,
    /// Of those that meet the same pane.
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    pub distances: Vec<f64>,
}
