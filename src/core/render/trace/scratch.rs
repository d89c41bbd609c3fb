//! Scratch space for packets, which is reused from one packet to the next.

use super::arrays::VectorList;
use super::estimate::AdaptiveScratch;
use super::hit_record::HitRecord;
use super::ray_group::{HitGroups, RayGroup};
use super::round::TreeScratch;
use super::surface::Surface;
use super::trail::PathHashes;
use crate::geometry::bvh::Stack;
use crate::geometry::ray::Side;
use crate::world::certify::Doubt;
use crate::world::sample::Sample;
use f256::f256;

/// The scratch space of one thread.
#[derive(Default)]
pub struct Scratch {
    pub(super) primary: Option<Box<PrimaryScratch>>,
    /// The image positions of the current primary rays, x and y in pixels.
    pub(super) places: [Vec<f64>; 2],
    /// The points of the camera's lens through which the current primary rays go, x and y in its radius; empty where all
    /// go through its centre.
    pub(super) lens: [Vec<f64>; 2],
    /// The samples of the current primary rays, where pixels have more than one.
    pub(super) samples: Vec<Sample>,
    /// Whether the current primary rays are probes, whose rays go to the rims of lights and come through the rim of
    /// the lens: the point whose number is the pixel of their sample.
    pub(super) are_probes: bool,
    /// What the current primary rays meet on their paths.
    pub(super) trails: PathHashes,
    /// The trees that grow by the free rules, unless they are being looked at.
    pub(super) trees: Option<Box<TreeScratch>>,
    /// The unused scratch space of packets, one for each level of recursion, the outermost one last.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) levels: Vec<Box<HitScratch>>,
    /// The unused scratch space of shadow rays through glass, one for each pane on their way.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) transmittances: Vec<Box<Transmittance>>,
    /// For direct light, which is finished before any rays continue.
    pub(super) lighting: Option<Box<LightScratch>>,
    /// Not 0 for shadow rays whose occlusion is in doubt.
    pub(super) doubt: Vec<u64>,
    /// For each object of the list with bounds, a bit for each sub-packet that may hit the object.
    pub(super) parts: Vec<u32>,
    /// The stack for the traversal of the BVH.
    pub(super) stack: Stack,
    /// The distances at which rays end that the BVH is searched for, in world units; 0 for shadow rays that are blocked.
    pub(super) ends: Vec<f64>,
    /// For each current primary ray, a bound on the light that it lacks because its ray budget is used up. Valid only
    /// if `any_missing` is set.
    pub(super) missing: Vec<f64>,
    /// For each primary ray, the budget that is kept for each of its first reflections.
    pub(super) kept: Vec<u32>,
    /// Whether any primary ray may lack light.
    pub(super) any_missing: bool,
    /// Whether a path of each primary ray was too long by the notes' rules; empty while none was.
    pub(super) far: Vec<bool>,
    /// The primary rays whose first hit could not be decided.
    pub(super) undecided: UndecidedScratch,
}

/// What is undecided. Nearly always there is nothing.
#[derive(Default)]
pub(super) struct UndecidedScratch {
    /// The lanes of the current packet of primary rays that may hit an object, which is given by its index, and from which
    /// distance on, in lengths of the direction of the ray before anything is rounded.
    pub lanes: Vec<(usize, usize, f256)>,
    /// The pixels, each by its number, with the index of the object and the reason.
    pub pixels: Vec<(u32, usize, Doubt)>,
}

/// The scratch space of primary rays.
#[derive(Default)]
pub(super) struct PrimaryScratch {
    pub group: RayGroup,
    /// The colours that the rays return.
    pub seen: VectorList,
    /// The colours of the pixels.
    pub colours: VectorList,
    pub adaptive: AdaptiveScratch,
}

/// The scratch space of a packet whose rays are sorted by the objects that they hit.
#[derive(Default)]
pub(super) struct HitScratch {
    pub hits: HitRecord,
    pub parts: HitGroups,
    /// The rays that hit the same object.
    pub part: RayGroup,
    /// The lower bounds of the distances of their hits, in world units.
    pub near: Vec<f64>,
    /// The upper bounds of the distances of their hits, in world units.
    pub far: Vec<f64>,
    pub shading: ShadingScratch,
    /// The colours that they return.
    pub seen: VectorList,
}

/// The scratch space of a packet while other rays continue from its hits.
#[derive(Default)]
pub(super) struct ShadingScratch {
    /// The distances of the hits, in world units.
    pub distances: Vec<f64>,
    pub surface: Surface,
    /// The directions in which rays continue.
    pub dir: VectorList,
    /// 1 for each ray that continues, and 0 for the others.
    pub goes: Vec<u64>,
    /// The lanes of the rays that continue.
    pub lanes: Vec<u8>,
    /// The rays that continue.
    pub secondary: RayGroup,
    /// The colours that the rays that continue return.
    pub seen: VectorList,
    /// The colours that come back to all lanes, black for rays that do not continue.
    pub behind: VectorList,
}

/// The scratch space of one light after the other.
#[derive(Default)]
pub(super) struct LightScratch {
    /// The diffuse reflectivities at the shading points.
    pub diffuse: VectorList,
    /// The point of the light that each shading point sees, if the light has a size.
    pub lights: VectorList,
    pub draws: LightDraws,
    /// The unit vectors toward the light.
    pub toward: VectorList,
    /// The factors of the light, from the angles at which it arrives and by the notes' rules the distances.
    pub strengths: Vec<f64>,
    /// The distances at which the shadow rays end, in world units; 0 where none is needed.
    pub t_max: Vec<f64>,
    /// The colours that the light sends.
    pub emissivity: VectorList,
    /// 0 where the light does not shine.
    pub shines: Vec<u64>,
    /// 1 where the light is blocked.
    pub blocked: Vec<u64>,
    pub shadows: ShadowScratch,
}

/// The random numbers that choose the points of a light that shading points see.
#[derive(Default)]
pub(super) struct LightDraws {
    /// The sample of each point's primary ray.
    pub samples: Vec<Sample>,
    /// Its two numbers from 0 to 1.
    pub places: [Vec<f64>; 2],
}

/// The scratch space of the shadow rays of a packet.
#[derive(Default)]
pub(super) struct ShadowScratch {
    /// The lanes of the shadow rays that are cast.
    pub lanes: Vec<u8>,
    pub origin: VectorList,
    pub dir: VectorList,
    /// The distances at which the cast rays end, in world units.
    pub their_t_max: Vec<f64>,
    /// 1 for the cast rays that are blocked.
    pub their_blocked: Vec<u64>,
    /// The side of the surface that each cast ray leaves.
    pub sides: Vec<Side>,
}

/// The scratch space of shadow rays that pass through glass.
#[derive(Default)]
pub(super) struct Transmittance {
    pub group: RayGroup,
    /// The distances at which the rays end, in world units.
    pub t_max: Vec<f64>,
    /// The fraction of each channel that is transmitted.
    pub tint: VectorList,
    /// The index of the opaque object that blocks the ray, plus 1; 0 where there is none.
    pub blocker: Vec<u64>,
    pub hits: HitRecord,
    pub parts: HitGroups,
    /// The lower bounds of the distances to the pane that these rays hit, in world units.
    pub near: Vec<f64>,
    /// The upper bounds of the distances to the pane that these rays hit, in world units.
    pub far: Vec<f64>,
    /// The distances to the pane that these rays hit, in world units.
    pub distances: Vec<f64>,
}
