//! How fast a scene is traced on one core, and what the arithmetic alone would take there.
//!
//! Times are the core's own for the thread that traces (`clock`), the least of several rounds.

mod ceiling;
pub(crate) mod clock;
mod packets;
pub mod scenes;

pub use packets::Times;

use crate::render::observer::RayKind;
use crate::render::plan::Plan;
use crate::render::ray_stats::RayStats;
use crate::render::renderer::{Overseer, Renderer};
use crate::render::tiles::{BAND, Band};
use crate::scene::model::{Model, Object};
use crate::simd::cpu::Cpu;
use crate::world::body::AnyShader;
use crate::world::material::{Look, Material, Rgb};
use crate::world::shader::Shader;
use ceiling::Bare;
use glam::DVec3;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How fast a scene is traced.
#[derive(Clone, Debug)]
pub struct Speed {
    /// The rays from the viewer, and what they cost in the scene without lights, mirrors and glass.
    pub primary: Cost,
    /// The rays to lights, and what lights add to that, shading included.
    pub shadow: Cost,
    /// The rays mirrored and through glass, with those from there to lights, and what they add to that.
    pub onward: Cost,
    /// All rays, and what the whole frame costs, without a file being written.
    pub frame: Cost,
    /// The tests by the type of the entity, sorted.
    pub tests: Vec<TestTimes>,
    /// What the frame's tests take as bare arithmetic, in seconds, if each has a formula of textbooks
    /// (`ceiling`).
    pub bare: Option<f64>,
}

/// What some rays cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// How many there are in a frame.
    pub rays: u64,
    /// How long they take, in seconds.
    pub seconds: f64,
}

impl Cost {
    /// Rays for each second; nothing where there are none, or too few to be told from what they are added to.
    pub fn rate(&self) -> Option<f64> {
        (self.rays > 0 && self.seconds > 0.0).then(|| self.rays as f64 / self.seconds)
    }

    /// What this is more than another.
    fn beyond(&self, other: &Self) -> Self {
        Self { rays: self.rays.saturating_sub(other.rays), seconds: self.seconds - other.seconds }
    }
}

/// The tests of rays against the objects of a type.
#[derive(Clone, Debug)]
pub struct TestTimes {
    /// The type.
    pub entity: &'static str,
    /// How many a frame makes, one for each ray and object.
    pub number: u64,
    /// What they cost on the scene's own rays.
    pub times: Times,
    /// What the formula of textbooks costs, in nanoseconds for each ray.
    pub bare: Option<f64>,
}

impl Speed {
    /// The part of the frame's time that its tests take as bare arithmetic.
    pub fn share(&self) -> Option<f64> {
        self.bare.map(|bare| bare / self.frame.seconds)
    }

    /// Measures a model with these instructions. Each of a handful of numbers is measured for about as long as
    /// `patience`, or three times where that takes longer.
    ///
    /// # Errors
    /// Where the system does not give a thread.
    pub fn measure(model: Model, cpu: Cpu, patience: Duration) -> io::Result<Self> {
        let renderer = Renderer::new(1)?.on(cpu);
        Ok(renderer.run(|| Self::measure_with(&renderer, model, cpu, patience)))
    }

    fn measure_with(renderer: &Renderer, mut model: Model, cpu: Cpu, patience: Duration) -> Self {
        let plan = Plan::new(&model);
        let tally = counted(renderer, &plan);
        let tests = tests(&plan, &tally, cpu, patience);
        let bare: Option<Vec<_>> =
            tests.iter().map(|tests| Some((Bare::of(tests.entity)?, tests.number))).collect();
        let mut arithmetic = || {
            for (bare, tests) in bare.iter().flatten() {
                bare.run(cpu, *tests);
            }
        };
        let mut room = None;
        let [seconds, arithmetic] =
            clock::least(patience, [&mut || render(renderer, &plan, &mut room), &mut arithmetic]);
        let frame = Cost { rays: tally.all_rays(), seconds };
        let bare = bare.filter(|bare| !bare.is_empty()).map(|_| arithmetic);

        let mut measured = |model: &Model| {
            let plan = Plan::new(model);
            let rays = counted(renderer, &plan).all_rays();
            let [seconds] = clock::least(patience, [&mut || render(renderer, &plan, &mut room)]);
            Cost { rays, seconds }
        };
        let mut lit = frame;
        if tally.rays(RayKind::Reflected) + tally.rays(RayKind::Transmitted) > 0 {
            model = matt(model);
            lit = measured(&model);
        }
        let mut primary = lit;
        if tally.rays(RayKind::Shadow) > 0 {
            model.lights.clear();
            primary = measured(&model);
        }
        Self { primary, shadow: lit.beyond(&primary), onward: frame.beyond(&lit), frame, tests, bare }
    }
}

/// Makes a frame, in a room that is kept: what the system does to give memory is not measured.
fn render(renderer: &Renderer, plan: &Plan, room: &mut Option<Band>) {
    let [width, height] = plan.camera.pixels;
    for rows in Band::split(&(0..width), &(0..height), BAND) {
        let mut band = match room.take() {
            Some(band) if band.rows.len() == rows.len() => band,
            _ => Band::blank(0..width, rows.clone()),
        };
        band.rows = rows;
        (0..band.strips.len()).for_each(|index| band.strip(index).tiles.fill(false));
        renderer.fill(plan, &band, Overseer { stops: &|| false, row: &|| () }, &|()| {});
        *room = Some(band);
    }
}

/// What a frame takes.
fn counted(renderer: &Renderer, plan: &Plan) -> RayStats {
    let [width, height] = plan.camera.pixels;
    let sum = Mutex::new(RayStats::default());
    let add = |part: RayStats| sum.lock().unwrap_or_else(PoisonError::into_inner).add(&part);
    renderer.bands(plan, 0..width, 0..height, &add).for_each(drop);
    sum.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn tests(plan: &Plan, tally: &RayStats, cpu: Cpu, patience: Duration) -> Vec<TestTimes> {
    /// Textbooks' tests in a round.
    const ROUND: u64 = 1 << 16;
    let (packets, model) = (packets::of(plan, cpu), plan.model);
    let tests = tally.tests(model).into_iter().filter(|(_, tests)| tests.tested > 0);
    let tests = tests.map(|(entity, tests)| TestTimes {
        entity,
        number: tests.tested,
        times: packets::times(&packets, model, cpu, patience, |object| {
            model.objects[object].args.entity.name == entity
        }),
        bare: Bare::of(entity).map(|bare| {
            let [seconds] = clock::least(patience, [&mut || bare.run(cpu, ROUND)]);
            1e9 * seconds / ROUND as f64
        }),
    });
    tests.collect()
}

/// A model without mirrors and glass.
fn matt(model: Model) -> Model {
    let matt = |object: Object| {
        let material = Material { specular: Rgb::ZERO, transparency: 0.0, ..(*object.material).clone() };
        // Nearly all shaders mirror what the material does, and are as fast as they were.
        let is_matt = object.shader.brightest(&material).is_some_and(|look| look.specular == Rgb::ZERO);
        let shader = if is_matt { object.shader } else { Box::new(Matt(object.shader)) };
        Object { material: Arc::new(material), shader, ..object }
    };
    let objects = model.objects.into_iter().map(matt).collect();
    Model { objects, ..model }
}

/// A shader that mirrors nothing.
struct Matt(AnyShader);

impl Shader for Matt {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.ambient(material, at)
    }

    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.diffuse(material, at)
    }

    fn specular(&self, _material: &Material, _at: DVec3) -> Rgb {
        Rgb::ZERO
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.uniform(material).map(|look| Look { specular: Rgb::ZERO, ..look })
    }
}
