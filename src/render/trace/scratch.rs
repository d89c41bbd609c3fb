//! Room for packets: what is kept from one to the next.

use super::arrays::VectorList;
use super::hit_record::HitRecord;
use super::ray_group::{HitGroups, RayGroup};
use super::surface::Surface;
use crate::geometry::ray::Side;
use crate::world::sample::Sample;

/// All that the packets of one thread need, one after the other.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(super) primary: Option<Box<PrimaryScratch>>,
    /// The x and y of the places of the picture that the camera rays under way look through, in pixels.
    pub(super) places: [Vec<f64>; 2],
    /// Of the camera rays under way, where pixels have more than one.
    pub(super) samples: Vec<Sample>,
    /// For packets that wait for those which have gone on from them, the foremost one last.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) levels: Vec<Box<HitScratch>>,
    #[expect(clippy::vec_box, reason = "likewise")]
    pub(super) transmittances: Vec<Box<Transmittance>>,
    /// For what is over before any go on.
    pub(super) lighting: Option<Box<LightScratch>>,
    pub(super) doubt: Vec<u64>,
    /// For each object that is listed with its bounds.
    pub(super) parts: Vec<u32>,
    /// For the way through a tree.
    pub(super) ahead: Vec<usize>,
    pub(super) inverse: VectorList,
    /// How much light each camera ray under way lacks at most, as it has cost as many rays as it may.
    pub(super) missing: Vec<f64>,
    /// Whether any lacks some.
    pub(super) any_missing: bool,
}

/// Rays from the viewer.
#[derive(Default)]
pub(super) struct PrimaryScratch {
    pub group: RayGroup,
    pub seen: VectorList,
    /// Of pixels.
    pub colours: VectorList,
}

/// The rays of a packet that meet the same object, while they are followed.
#[derive(Default)]
pub(super) struct HitScratch {
    pub hits: HitRecord,
    pub parts: HitGroups,
    pub part: RayGroup,
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    pub shading: ShadingScratch,
    pub seen: VectorList,
}

/// Room for what one packet needs while others go on from it.
#[derive(Default)]
pub(super) struct ShadingScratch {
    pub distances: Vec<f64>,
    pub surface: Surface,
    /// Where rays go on to.
    pub dir: VectorList,
    /// Which ones: 1 for those, and 0; and a list.
    pub goes: Vec<u64>,
    pub lanes: Vec<u8>,
    /// They themselves, and what they see.
    pub onward: RayGroup,
    pub seen: VectorList,
    /// What all see, those that do not go on, too.
    pub behind: VectorList,
}

/// Room for what one light does after the other.
#[derive(Default)]
pub(super) struct LightScratch {
    pub diffuse: VectorList,
    /// Where each place sees the light, if that is no point.
    pub lights: VectorList,
    pub toward: VectorList,
    pub cos_over_distance: Vec<f64>,
    pub t_max: Vec<f64>,
    pub emissivity: VectorList,
    pub shines: Vec<u64>,
    pub blocked: Vec<u64>,
    pub shadows: ShadowScratch,
}

/// Room for the shadows of a packet.
#[derive(Default)]
pub(super) struct ShadowScratch {
    /// Those that remain of a packet.
    pub lanes: Vec<u8>,
    pub origin: VectorList,
    pub dir: VectorList,
    pub their_t_max: Vec<f64>,
    pub their_blocked: Vec<u64>,
    pub sides: Vec<Side>,
}

/// Rays on their way to a light.
#[derive(Default)]
pub(super) struct Transmittance {
    pub group: RayGroup,
    pub t_max: Vec<f64>,
    /// The part of each channel that has come through.
    pub tint: VectorList,
    /// The opaque object that stands in the way, by its index and 1; 0 where there is none.
    pub blocker: Vec<u64>,
    pub hits: HitRecord,
    pub parts: HitGroups,
    /// Of those that meet the same pane.
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    pub distances: Vec<f64>,
}
