//! What a shape costs as a part of something else, in evaluations of the shape: nothing that its author leaves out may
//! make a copy of it, a part of a solid, or the shape behind glass far more expensive.

use crate::common::{registry, render, root};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use tabray::exact::double_double::DoubleDouble;
use tabray::geometry::ray_packet::SurfaceInteraction;
use tabray::geometry::{Aabb, Bracket, Facet, HitRecordMut, Ray, RayBall, RayPacket, RayRange, Side, Sight};
use tabray::glam::{DVec2, DVec3};
use tabray::prelude::{Entity, MISS, Pparm, Table};
use tabray::scene::model::Object;
use tabray::scene::{self, Kind, Model, Registry};
use tabray::simd::cpu::Cpu;
use tabray::world::certify::{Enclosure, Precision, Premise, ProofMethods};
use tabray::world::packets::shape::{HitQueries, PacketIntersect, PacketShape};
use tabray::world::{Accuracy, AnyShape, Body, Facts, Hittable, NamedBody, Shape};

/// The most that a shape may cost as a part of something else, as a multiple of what it costs alone.
const MAX_RATIO: f64 = 3.0;

/// What a ray by itself and a proof in 53 and in 237 bits count for, where a ray in a packet counts for 1. These are orders
/// of magnitude: what the test is to find is a proof for every ray.
const ALONE: u64 = 4;
const PROOF: [u64; 2] = [100, 2000];

/// A pane of glass in front of what a scene's image shows.
const PANE: &str = "glass clear_pane { index 1.1 }\n\
    fplane pane { material clear_pane normal 0 0 1 point -40 -40 -0.01 dimensions 90 90 xdir 1 0 0 }\n";

/// The evaluations of all shapes that are counted.
static WORK: AtomicU64 = AtomicU64::new(0);

static ALONE_AT_WORK: Mutex<()> = Mutex::new(());

fn count(evaluations: u64) {
    WORK.fetch_add(evaluations, Relaxed);
}

/// A shape whose evaluations are counted. Those of proofs about other rays than camera rays are not.
struct Counted(Arc<Body>);

static OBJECT: Pparm<NamedBody> = Pparm::required("object", "the object whose evaluations are counted");
const TABLE: Table = &[&OBJECT];

static COUNTED: Entity =
    Entity::of_objects("counted", "an object whose evaluations are counted", &[TABLE], |args| {
        let body = args.get(&OBJECT).get().cloned().expect("an object");
        let material = body.material.clone();
        Ok(Body { material, ..Body::plain(AnyShape::of_packets(Counted(body))) })
    });

impl Counted {
    fn packets(&self) -> &dyn PacketShape {
        self.0.shape.packets()
    }
}

impl Hittable for Counted {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        count(ALONE);
        self.0.shape.distance(ray, range)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        count(1);
        self.0.shape.normal(at)
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        count(1);
        self.0.shape.shading_normal(at, normal)
    }

    fn facts(&self) -> Facts {
        self.0.shape.facts()
    }

    fn why_not_closed(&self) -> Option<&str> {
        self.0.shape.why_not_closed()
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.0.shape.uv(at)
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.0.shape.is_clear_of(region)
    }

    fn search_cost(&self, ray: &Ray, origin_side: Option<Side>) -> u32 {
        self.0.shape.search_cost(ray, origin_side)
    }
}

impl PacketIntersect for Counted {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], brackets: (&mut [f64], &mut [f64])) {
        count(brackets.0.len() as u64);
        self.packets().brackets(cpu, rays, ends, brackets);
    }

    fn closest_hits(&self, cpu: Cpu, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        count(rays.len() as u64);
        self.packets().closest_hits(cpu, rays, id, nearest)
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        count(t_max.len() as u64);
        self.packets().occluded(cpu, rays, t_max, blocked, doubt)
    }

    fn refine(&self, cpu: Cpu, rays: RayPacket, brackets: (&[f64], &[f64]), out: &mut [f64]) {
        count(out.len() as u64);
        self.packets().refine(cpu, rays, brackets, out);
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        count(interaction.travelled.len() as u64);
        self.packets().interact(cpu, rays, distances, interaction);
    }

    fn finds_normals_by_rays(&self) -> bool {
        self.packets().finds_normals_by_rays()
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        count(ALONE);
        self.packets().t_bounds(ray, range)
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        count(ALONE);
        self.packets().refine_one(ray, origin_side)
    }
}

impl HitQueries for Counted {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        count(1);
        self.packets().is_on_surface(at, error)
    }

    fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        count(1);
        self.packets().contains(at, error)
    }

    fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        count(1);
        self.packets().facet(at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        count(ALONE);
        self.packets().fine_distance(ray, distance)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.packets().premises(of, each);
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        count(PROOF[usize::from(precision == Precision::Octuple)]);
        self.packets().certify(sight, precision)
    }

    fn proven(&self) -> Option<&dyn ProofMethods> {
        self.packets().proven()
    }

    fn is_of_the_notes(&self) -> bool {
        self.packets().is_of_the_notes()
    }
}

/// A ball whose author gives nothing but its distance, its normal and its bounds.
struct Bare;

impl Hittable for Bare {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let (half, square) = (ray.origin.dot(ray.dir), ray.origin.length_squared() - 1.0);
        let root = (half * half - square).sqrt();
        // NaN for a ray that misses.
        [-half - root, -half + root]
            .into_iter()
            .map(|at| range.keep(at))
            .find(|at| *at < MISS)
            .unwrap_or(MISS)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        at.normalize()
    }

    fn facts(&self) -> Facts {
        Facts::within(Aabb { low: DVec3::NEG_ONE, high: DVec3::ONE })
    }
}

static BARE: Entity =
    Entity::shape("bare", "a ball by its distance alone", &[&[] as Table], |_| Ok(Body::plain(Bare)));

/// A ball with brackets that say nothing of copies, as if its author had forgotten them.
struct Forgetful;

impl Hittable for Forgetful {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        Bare.distance(ray, range)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        Bare.normal(at)
    }

    fn facts(&self) -> Facts {
        Bare.facts()
    }
}

impl tabray::world::Bracketed for Forgetful {
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if ray.is_single() { Bracket::exactly(self.distance(ray, range)) } else { Bracket::UNKNOWN }
    }

    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

static FORGETFUL: Entity =
    Entity::shape("forgetful", "a ball that forgets its copies", &[&[] as Table], |_| {
        Ok(Body::plain(Shape::new(Forgetful).bracketed()))
    });

/// Returns what the evaluations of the counted shapes of a scene come to.
fn work(registry: &Registry, folder: &Path, text: &str) -> f64 {
    let model = read(registry, folder, text);
    // Other tests count, too.
    let _alone = ALONE_AT_WORK.lock();
    let before = WORK.load(Relaxed);
    render(&model);
    (WORK.load(Relaxed) - before) as f64
}

fn read(registry: &Registry, folder: &Path, text: &str) -> Model {
    let loaded = scene::read(registry, "scene", folder, text.as_bytes(), Some(Accuracy::Exact));
    let mut model = loaded.unwrap_or_else(|report| panic!("{report}\n{text}")).model;
    model.camera.value.pixels = [36, 27];
    model.camera.value.samples = 1;
    model
}

/// Returns what the objects of these names cost in each place, as multiples of what they cost by themselves: as copies, as
/// parts of a union and of a difference if they are closed, and behind a pane of glass.
fn ratios(folder: &Path, text: &str, is_meant: &dyn Fn(&Object) -> bool) -> Vec<(&'static str, f64)> {
    let registry = Registry::of(registry().iter().chain([&COUNTED, &BARE, &FORGETFUL])).expect("new names");
    let model = read(&registry, folder, text);
    let names = |is_wanted: &dyn Fn(&Object) -> bool| -> Vec<String> {
        let objects = model.objects.iter().filter(|object| is_meant(object) && is_wanted(object));
        objects.map(|object| object.args.name().to_string()).collect()
    };
    let bounds = |name: &str| {
        let object = model.objects.iter().find(|object| object.args.name() == name);
        object.and_then(|object| object.shape.facts().bounds).expect("a closed shape")
    };
    let work = |text: &str| work(&registry, folder, text);
    let closed = names(&|object| object.shape.why_not_closed().is_none());
    let names = names(&|_| true);
    let with = |names: &[String], line: &dyn Fn(&str) -> String| {
        names.iter().fold(text.to_owned(), |mut text, name| {
            writeln!(text, "counted counted_{name} {{ object {name} }}\n{}", line(name)).expect("room");
            text
        })
    };
    let alone = |names: &[String]| {
        let work = work(&with(names, &|_| String::new()));
        assert!(work > 0.0, "what is not seen costs nothing");
        work
    };
    let base = alone(&names);
    let mut found = vec![
        (
            "placed",
            work(&with(&names, &|name| format!("place copy_{name} {{ object counted_{name} }}"))) / base,
        ),
        ("glass", work(&(with(&names, &|_| String::new()) + PANE)) / base),
    ];
    if !closed.is_empty() {
        let base = alone(&closed);
        for kind in ["union", "difference"] {
            // The ball cuts off a corner.
            let line = |name: &str| {
                let Aabb { low, high } = bounds(name);
                let ([x, y, z], radius) = (high.to_array(), 0.4 * (high - low).max_element());
                format!(
                    "material matt_{name} {{ ambient 1 1 1 }}\n\
                     sphere ball_{name} {{ material matt_{name} center {x} {y} {z} radius {radius} }}\n\
                     {kind} solid_{name} {{ objects counted_{name} ball_{name} }}"
                )
            };
            found.push((kind, work(&with(&closed, &line)) / base));
        }
    }
    found
}

#[test]
fn no_shape_costs_far_more_as_a_part_of_something_else() {
    let mut faults = Vec::new();
    let folder = root().join("scenes/entities");
    for entity in registry().iter().filter(|entity| entity.kind() == Kind::Object) {
        let Ok(text) = fs::read_to_string(folder.join(format!("{}.ray", entity.name))) else { continue };
        if ["place", "union", "intersection", "difference"].contains(&entity.name) {
            continue;
        }
        for (place, ratio) in ratios(&folder, &text, &|object| object.args.entity().name == entity.name) {
            println!("{:16} {place:12} {ratio:8.2}", entity.name);
            if ratio > MAX_RATIO {
                faults.push(format!("{} {place}: {ratio:.1} times", entity.name));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

const BALL: &str = "camera eye { pixeldim 36 27 worlddim 3 2.25 viewpoint 0 0 4 }\n\
    material matt { ambient 1 1 1 diffuse 2 2 2 }\nlight lamp { location 3 3 4 emissivity 9 9 9 }\n";

#[test]
fn a_shape_of_which_only_the_distance_is_known_costs_no_more_in_another_place() {
    let text = format!("{BALL}bare ball {{ material matt }}\n");
    let ratios = ratios(Path::new(""), &text, &|_| true);
    assert!(ratios.iter().all(|(_, ratio)| *ratio < MAX_RATIO), "{ratios:?}");
}

/// The measure sees what it is there to see.
#[test]
fn brackets_that_say_nothing_of_copies_cost_more() {
    let text = format!("{BALL}forgetful ball {{ material matt }}\n");
    let ratios = ratios(Path::new(""), &text, &|_| true);
    assert!(ratios[0].1 > MAX_RATIO, "{ratios:?}");
}
