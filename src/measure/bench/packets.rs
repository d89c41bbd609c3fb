//! Packets of a scene's own rays, to time the functions of its shapes with.

use std::hint::black_box;
use std::time::Duration;
use tabray_core::geometry::ray::{MISS, Side};
use tabray_core::geometry::ray_packet::{HitRecordMut, PACKET_SIZE, RayPacket};
use tabray_core::render::observer::{Count, RayKind, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::tiles::{self, TILE};
use tabray_core::render::trace::{self, Scratch, Tracer};
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::simd::soa::Vectors;
use tabray_tools::clock;

/// The maximum number of tiles that are used, spread over the image.
const TILES: usize = 256;

/// The primary rays of a tile, and the objects they are tested against.
pub(super) struct Packet {
    view: RayBundle,
    tested: TestedObjects,
    /// The object that most of the rays hit, and their hits on it.
    met: Option<ObjectHits>,
}

/// The hits of rays on an object, and the shadow rays from there to a light.
struct ObjectHits {
    object: usize,
    /// The rays that hit the object.
    view: RayBundle,
    /// The shadow rays, the side of the object on which each starts, and the distance of the light in world units; 0
    /// where the light is behind the surface.
    toward: RayBundle,
    sides: [Side; PACKET_SIZE],
    t_max: [f64; PACKET_SIZE],
}

struct RayBundle {
    origin: Vectors<PACKET_SIZE>,
    dir: Vectors<PACKET_SIZE>,
}

impl RayBundle {
    const NONE: Self = Self { origin: Vectors::ZERO, dir: Vectors::ZERO };

    fn rays(&self) -> RayPacket<'_> {
        RayPacket::new(self.origin.view(PACKET_SIZE), self.dir.view(PACKET_SIZE), 0.0)
    }
}

/// The nearest hits of a packet's rays.
struct Hits {
    near: [f64; PACKET_SIZE],
    far: [f64; PACKET_SIZE],
    hit_ids: [u64; PACKET_SIZE],
    doubt: [u64; PACKET_SIZE],
}

impl Hits {
    const NONE: Self = Self {
        near: [MISS; PACKET_SIZE],
        far: [MISS; PACKET_SIZE],
        hit_ids: [0; PACKET_SIZE],
        doubt: [0; PACKET_SIZE],
    };

    fn nearest(&mut self) -> HitRecordMut<'_> {
        let Self { near, far, hit_ids, doubt } = self;
        HitRecordMut { near, far, hit_ids, doubt }
    }
}

/// The time of a test, in nanoseconds per ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// The closest-hit test of primary rays.
    pub closest: Option<f64>,
    /// The occlusion test of shadow rays.
    pub occluded: Option<f64>,
    /// The refinement of the hit's distance.
    pub refine: Option<f64>,
}

/// Collects packets of a model's rays.
pub(super) fn of(plan: &Plan, cpu: Cpu) -> Vec<Packet> {
    let tiles: Vec<_> = split(plan.camera.pixels).collect();
    let step = tiles.len().div_ceil(TILES);
    tiles.iter().step_by(step).map(|tile| Packet::new(plan, cpu, tile)).collect()
}

impl Packet {
    fn new(plan: &Plan, cpu: Cpu, tile: &[[usize; 2]]) -> Self {
        let camera = &plan.camera;
        let (mut view, mut hits) = (RayBundle::NONE, Vec::new());
        for lane in 0..PACKET_SIZE {
            let [x, y] = tile[lane.min(tile.len() - 1)];
            let ray = camera.ray(x as f64, y as f64);
            view.origin.set(lane, ray.origin);
            view.dir.set(lane, ray.dir);
            hits.extend(trace::first_hit(plan, &camera.sight(x as f64, y as f64)).map(|hit| (ray, hit)));
        }
        let count = |object| hits.iter().filter(|(_, hit)| hit.index == object).count();
        let most = hits.iter().map(|(_, hit)| hit.index).max_by_key(|object| (count(*object), *object));
        let met = most.map(|object| {
            hits.retain(|(_, hit)| hit.index == object);
            let (mut view, mut toward) = (RayBundle::NONE, RayBundle::NONE);
            let (mut sides, mut t_max) = ([Side::Outside; PACKET_SIZE], [0.0; PACKET_SIZE]);
            for (lane, (ray, hit)) in (0..PACKET_SIZE).zip(hits.iter().cycle()) {
                let mut normal = hit.object.shape.normal(hit.point);
                sides[lane] = Side::seen_along(ray.dir, normal);
                if hit.object.shape.is_two_sided() && sides[lane] == Side::Inside {
                    normal = -normal;
                }
                view.origin.set(lane, ray.origin);
                view.dir.set(lane, ray.dir);
                toward.origin.set(lane, hit.point);
                toward.dir.set(lane, ray.dir);
                if let Some(light) = plan.model.lights.iter().find(|light| !light.value.is_far()) {
                    let between = light.value.location() - hit.point;
                    toward.dir.set(lane, between.normalize());
                    t_max[lane] = if between.dot(normal) > 0.0 { between.length() } else { 0.0 };
                }
            }
            ObjectHits { object, view, toward, sides, t_max }
        });
        Self { view, tested: TestedObjects::of(plan, cpu, tile), met }
    }
}

/// Returns the times of the objects for which `is_wanted` is true, by their indices.
pub(super) fn times(
    packets: &[Packet],
    model: &Model,
    cpu: Cpu,
    patience: Duration,
    is_wanted: impl Fn(usize) -> bool,
) -> Times {
    let shape = |object: usize| &model.objects[object].shape;
    let wanted = |objects: &[usize]| objects.iter().copied().filter(|object| is_wanted(*object)).collect();
    let viewed: Vec<(&Packet, Vec<usize>)> =
        packets.iter().map(|packet| (packet, wanted(&packet.tested.primary))).collect();
    let lit: Vec<(&ObjectHits, Vec<usize>)> = packets
        .iter()
        .filter_map(|packet| Some((packet.met.as_ref()?, wanted(&packet.tested.shadow))))
        .filter(|(met, _)| met.t_max.iter().any(|end| *end > 0.0))
        .map(|(met, mut tested)| {
            let may_meet_itself = met.sides.iter().any(|side| shape(met.object).can_hit_itself(*side));
            tested.retain(|object| *object != met.object || may_meet_itself);
            (met, tested)
        })
        .collect();
    let met: Vec<&ObjectHits> =
        packets.iter().filter_map(|packet| packet.met.as_ref()).filter(|met| is_wanted(met.object)).collect();

    let mut closest = || {
        for (packet, objects) in &viewed {
            let mut hits = Hits::NONE;
            for object in objects {
                shape(*object).closest_hits(cpu, packet.view.rays(), *object as u64 + 1, hits.nearest());
            }
            black_box(&hits);
        }
    };
    let mut occluded = || {
        for (met, objects) in &lit {
            let (mut blocked, mut doubt) = ([0; PACKET_SIZE], [0; PACKET_SIZE]);
            for object in objects {
                let sides = (*object == met.object).then_some(&met.sides[..]);
                let rays = met.toward.rays().leaving(sides);
                shape(*object).packets().occluded(cpu, rays, &met.t_max, &mut blocked, &mut doubt);
            }
            black_box(&blocked);
        }
    };
    let brackets: Vec<_> = met
        .iter()
        .map(|view| {
            let mut hits = Hits::NONE;
            shape(view.object).closest_hits(cpu, view.view.rays(), 1, hits.nearest());
            hits
        })
        .collect();
    let mut refine = || {
        for (met, Hits { near, far, .. }) in met.iter().zip(&brackets) {
            let mut distances = [0.0; PACKET_SIZE];
            shape(met.object).packets().refine(cpu, met.view.rays(), (near, far), &mut distances);
            black_box(&distances);
        }
    };
    let [closests, occludes, refines] = clock::least(patience, [&mut closest, &mut occluded, &mut refine]);
    let per_ray =
        |seconds: f64, tests: usize| (tests > 0).then(|| 1e9 * seconds / (tests * PACKET_SIZE) as f64);
    Times {
        closest: per_ray(closests, viewed.iter().map(|(_, objects)| objects.len()).sum()),
        occluded: per_ray(occludes, lit.iter().map(|(_, objects)| objects.len()).sum()),
        refine: per_ray(refines, met.len()),
    }
}

/// Returns the pixels of a frame, tile by tile in the renderer's order: column from the left and row from the bottom.
fn split([width, height]: [usize; 2]) -> impl Iterator<Item = Vec<[usize; 2]>> {
    (0..height).step_by(TILE).flat_map(move |top| {
        (0..width).step_by(TILE).map(move |left| {
            let mut pixels = Vec::new();
            tiles::list(
                left..width.min(left + TILE),
                height.saturating_sub(top + TILE)..height - top,
                &mut pixels,
            );
            pixels
        })
    })
}

/// The objects that the primary rays and the first shadow rays are tested against.
#[derive(Default)]
struct TestedObjects {
    primary: Vec<usize>,
    shadow: Vec<usize>,
    kind: Option<RayKind>,
}

impl TraceObserver for TestedObjects {
    fn count(&mut self, count: Count) {
        match (count, self.kind) {
            (Count::Rays(kind, _), _) => self.kind = Some(kind),
            (Count::Tested(object, _), Some(RayKind::Primary)) => self.primary.push(object),
            (Count::Tested(object, _), Some(RayKind::Shadow)) => self.shadow.push(object),
            _ => (),
        }
    }
}

impl TestedObjects {
    /// Collects the objects of a tile, each once.
    fn of(plan: &Plan, cpu: Cpu, tile: &[[usize; 2]]) -> Self {
        let mut tested = Self::default();
        Tracer::new(plan, cpu, &mut Scratch::default(), &mut tested).pixels(tile);
        for objects in [&mut tested.primary, &mut tested.shadow] {
            objects.sort_unstable();
            objects.dedup();
        }
        tested
    }
}
