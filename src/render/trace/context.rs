//! The tracer: its plan, its observer, and its scratch space, which is reused from one packet to the next.

use super::aim::Aimed;
use super::arrays::{NARROW, VectorList};
use super::draws::LightDraws;
use super::estimate::AdaptiveScratch;
use super::path_hash::PathHashes;
use super::ray_group::{HitGroups, HitRecord, RayGroup};
use super::scatter::CountedLight;
use super::surface::{PointErrors, Surface};
use super::wave::TreeScratch;
use crate::observer::TraceObserver;
use crate::plan::Plan;
use crate::tiles::TOGETHER;
use glam::DVec3;
use tabray_exact::interval::Fraction;
use tabray_world::accuracy::Accuracy;
use tabray_world::certify::Doubt;
use tabray_world::geometry::bvh::Stack;
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::hittable::Hittable;
use tabray_world::sample::Samples;
use tabray_world::scene::model::Model;
use tabray_world::simd::cpu::Cpu;

/// The number of reflections and transmissions after which packets are narrow: with wide packets, facing mirrors would
/// use too much memory.
const DEEP: usize = 24;

/// Traces packets of rays through a plan.
pub struct Tracer<'m, 'w> {
    pub(super) model: &'m Model,
    pub(super) plan: &'m Plan<'m>,
    pub(super) cpu: Cpu,
    /// The largest magnitude of the viewer's coordinates, in world units.
    pub(super) viewer: f64,
    /// The number of reflections and transmissions on the path of the current packet.
    pub(super) depth: usize,
    /// The light that counts where the rays of the current packet end.
    pub(super) counted: CountedLight,
    pub(super) scratch: &'w mut Scratch,
    pub(super) observer: &'w mut dyn TraceObserver,
    /// Whether the observer sees each event.
    pub(super) sees_events: bool,
}

impl<'m, 'w> Tracer<'m, 'w> {
    /// Makes a tracer of a plan, which reports to an observer.
    pub fn new(
        plan: &'m Plan,
        cpu: Cpu,
        scratch: &'w mut Scratch,
        observer: &'w mut dyn TraceObserver,
    ) -> Self {
        Self {
            model: plan.model,
            plan,
            cpu,
            viewer: 0.0,
            depth: 0,
            counted: CountedLight::All,
            scratch,
            sees_events: observer.sees_events(),
            observer,
        }
    }

    /// Returns how many tiles are best traced together.
    pub fn tiles_together(&self) -> usize {
        if self.plan.camera.adaptive.is_some() && self.plan.prover.is_none() { TOGETHER } else { 1 }
    }

    /// Tells whether the scene is traced by the notes' own methods.
    pub(super) fn is_classic(&self) -> bool {
        self.plan.camera.accuracy == Accuracy::Classic
    }

    /// Returns the maximum number of rays of a packet that continues from the current one.
    pub(super) fn max_packet(&self) -> usize {
        if self.depth < DEEP { PACKET_SIZE } else { NARROW }
    }

    /// Bounds the errors of the points where rays have hit a shape.
    pub(super) fn bound_errors(
        &self,
        shape: &dyn Hittable,
        travelled: &[f64],
        cosines: &[f64],
        errors: &mut PointErrors,
    ) {
        if self.is_classic() {
            errors.clear();
        } else {
            errors.bound(self.cpu, travelled, shape.facts().max_coordinate + self.viewer, cosines);
        }
    }
}

/// The scratch space of one thread.
#[derive(Default)]
pub struct Scratch {
    pub(super) primary: Option<Box<PrimaryScratch>>,
    /// The image positions of the current primary rays, x and y in pixels.
    pub(super) places: [Vec<f64>; 2],
    /// The points of the camera's lens through which the current primary rays go, x and y in its radius; empty where
    /// all go through its centre.
    pub(super) lens: [Vec<f64>; 2],
    /// The samples of the current primary rays, where pixels have more than one.
    pub(super) samples: Samples,
    /// Whether the current primary rays are probes. Their rays go through the rim of the lens and to the rims of
    /// lights, at the rim point whose number is the pixel of their sample.
    pub(super) are_probes: bool,
    /// The hashes of the current primary rays' paths.
    pub(super) path_hashes: PathHashes,
    /// The trees that grow under the free rules, unless they are in use.
    pub(super) trees: Option<Box<TreeScratch>>,
    /// The unused scratch space of packets, one for each level of recursion, the outermost one last.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) levels: Vec<Box<HitScratch>>,
    /// The unused scratch space of shadow rays through glass, one for each pane on their way.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) transmittances: Vec<Box<Transmittance>>,
    /// The scratch space of direct light, which is finished before any rays continue.
    pub(super) lighting: Option<Box<LightScratch>>,
    /// Whether shadow rays pass only through what does not bend light.
    pub(super) unbent: bool,
    /// What a packet aims at.
    pub(super) aimed: Vec<Aimed>,
    /// Not 0 for shadow rays whose occlusion is in doubt.
    pub(super) doubt: Vec<u64>,
    /// For each object of the list with bounds, a bit for each sub-packet that may hit the object.
    pub(super) parts: Vec<u32>,
    /// The stack for the traversal of the BVH.
    pub(super) stack: Stack,
    /// The distances at which rays end in the search of the BVH, in world units; 0 for blocked shadow rays.
    pub(super) ends: Vec<f64>,
    /// For each current primary ray, a bound on the light that it lacks because its ray budget is used up. Valid only
    /// if `any_missing` is set.
    pub(super) missing: Vec<f64>,
    /// For each primary ray, the budget that is kept for each of its first reflections.
    pub(super) kept: Vec<u32>,
    /// Whether any primary ray may lack light.
    pub(super) any_missing: bool,
    /// For each primary ray, whether a path was too long under the notes' rules; empty while none was.
    pub(super) far: Vec<bool>,
    /// The fraction of each current primary ray that is clear; empty where the camera has no alpha.
    pub(super) clear: Vec<f64>,
    /// The primary rays whose first hit could not be decided.
    pub(super) undecided: UndecidedScratch,
}

/// Undecided hits. Nearly always there are none.
#[derive(Default)]
pub(super) struct UndecidedScratch {
    /// The primary rays of the current packet.
    pub rays: Vec<UndecidedRay>,
    pub pixels: Vec<UndecidedPixel>,
}

/// A ray that may hit an object.
pub(super) struct UndecidedRay {
    pub lane: usize,
    /// The object's index.
    pub object: usize,
    /// The least distance at which the ray may hit it, in lengths of the unrounded ray's direction.
    pub from: Fraction,
}

/// A pixel whose ray may hit an object.
pub(super) struct UndecidedPixel {
    pub number: u32,
    /// The object's index.
    pub object: usize,
    pub doubt: Doubt,
    /// Where the ray may hit it.
    pub at: DVec3,
}

/// The scratch space of primary rays.
#[derive(Default)]
pub(super) struct PrimaryScratch {
    pub group: RayGroup,
    /// The colours that the rays return.
    pub seen: VectorList,
    /// The colours of the pixels.
    pub colours: VectorList,
    /// The alpha of the pixels; empty where the camera has none.
    pub alpha: Vec<f64>,
    pub adaptive: AdaptiveScratch,
}

/// The scratch space of a packet whose rays are sorted by the objects that they hit.
#[derive(Default)]
pub(super) struct HitScratch {
    pub hits: HitRecord,
    pub parts: HitGroups,
    /// The rays that hit the same object.
    pub part: RayGroup,
    /// For each ray, the first object that looks like the one that it hits, by its index plus 1; 0 for a miss.
    pub looks: Vec<u64>,
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
    /// The highlights of lamps in glass.
    pub glints: VectorList,
    /// The diffuse reflectivities, where light goes on from the surface.
    pub diffuse: VectorList,
    /// The directions in which rays continue.
    pub dir: VectorList,
    /// 1 for each ray that continues, and 0 for the others.
    pub continue_mask: Vec<u64>,
    /// The lanes of the rays that continue.
    pub lanes: Vec<u8>,
    /// The rays that continue.
    pub secondary: RayGroup,
    /// The colours that the rays that continue return.
    pub seen: VectorList,
    /// The colours that come back to all lanes, black for rays that do not continue.
    pub incoming: VectorList,
}

/// The scratch space of lights, used for one after the other.
#[derive(Default)]
pub(super) struct LightScratch {
    /// The diffuse reflectivities at the shading points.
    pub diffuse: VectorList,
    pub draws: LightDraws,
    /// The unit vectors toward the light.
    pub toward: VectorList,
    /// The factors of the light, from the angles at which it arrives and under the notes' rules the distances.
    pub strengths: Vec<f64>,
    /// The distances at which the shadow rays end, in world units; 0 where none is needed.
    pub t_max: Vec<f64>,
    /// The colours that the light sends.
    pub emissivity: VectorList,
    /// The specular reflectivities for a lamp, where a surface has highlights of lamps alone.
    pub speculars: VectorList,
    /// 0 where the light does not shine.
    pub shines: Vec<u64>,
    /// 1 where the light is blocked.
    pub blocked: Vec<u64>,
    pub shadows: ShadowScratch,
}

/// The scratch space of the shadow rays of a packet.
#[derive(Default)]
pub(super) struct ShadowScratch {
    /// The lanes of the shadow rays that are cast.
    pub lanes: Vec<u8>,
    pub origin: VectorList,
    pub dir: VectorList,
    /// Bounds on the errors of the origins.
    pub errors: PointErrors,
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
