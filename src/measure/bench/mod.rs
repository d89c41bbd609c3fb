//! Measures how fast a scene is traced on one core, and how fast the bare arithmetic alone would be.
//!
//! Times are CPU times of the thread that traces (`clock`), the minimum of several rounds.

mod ceiling;
mod packets;
pub mod scenes;

pub use packets::Times;

use ceiling::TextbookTest;
use glam::DVec2;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::observer::RayKind;
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::render::tiles::{BAND, Band};
use tabray_core::scene::model::{Model, Object};
use tabray_core::simd::cpu::Cpu;
use tabray_core::world::body::AnyShader;
use tabray_core::world::material::{Look, Material, Reflectivity, Rgb};
use tabray_core::world::number::Number;
use tabray_core::world::shader::Shader;
use tabray_core::world::surface_point::{Point, ShaderInputs, SurfacePoint};
use tabray_tools::clock;
use tabray_tools::threads::renderer_with;

/// The speed at which a scene is traced.
#[derive(Clone, Debug)]
pub struct Speed {
    /// The primary rays, and their cost in the scene without lights, mirrors and glass.
    pub primary: Cost,
    /// The shadow rays of primary hits, and what lights add to the cost, shading included.
    pub shadow: Cost,
    /// The reflected and transmitted rays, with the shadow rays from their hits, and what they add to the cost.
    pub secondary: Cost,
    /// All rays, and the cost of the whole frame, without writing a file.
    pub frame: Cost,
    /// The tests by entity type, sorted.
    pub tests: Vec<TestTimes>,
    /// The time that the frame's tests take as bare arithmetic (`ceiling`), in seconds, if there is a textbook formula
    /// for each.
    pub bare: Option<f64>,
}

/// The number and the cost of rays of one sort.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// The number of rays in a frame.
    pub rays: u64,
    /// The time for all rays, in seconds.
    pub seconds: f64,
}

impl Cost {
    /// Returns the rays per second, or `None` where there are none or their share of the time is too small to measure.
    pub fn rate(&self) -> Option<f64> {
        (self.rays > 0 && self.seconds > 0.0).then(|| self.rays as f64 / self.seconds)
    }

    /// Returns the difference of this cost and another.
    fn beyond(&self, other: &Self) -> Self {
        Self { rays: self.rays.saturating_sub(other.rays), seconds: self.seconds - other.seconds }
    }
}

/// The tests of rays against objects of one type.
#[derive(Clone, Debug)]
pub struct TestTimes {
    /// The entity type.
    pub entity: &'static str,
    /// The number of tests in a frame, one for each ray and object.
    pub number: u64,
    /// The cost of a test on the scene's own rays.
    pub times: Times,
    /// The cost of the textbook formula, in nanoseconds per ray.
    pub bare: Option<f64>,
}

impl Speed {
    /// Returns the fraction of the frame's time, from 0 to 1, that its tests take as bare arithmetic.
    pub fn share(&self) -> Option<f64> {
        self.bare.map(|bare| bare / self.frame.seconds)
    }

    /// Measures a model at this level of CPU instructions. Each of a handful of numbers is measured for about as long
    /// as `patience`, or three times where that takes longer.
    ///
    /// # Errors
    /// If the system cannot start a thread.
    pub fn measure(model: Model, cpu: Cpu, patience: Duration) -> io::Result<Self> {
        let renderer = renderer_with(1)?.on(cpu);
        Ok(renderer.run(|| Self::measure_with(&renderer, model, cpu, patience)))
    }

    fn measure_with(renderer: &Renderer, mut model: Model, cpu: Cpu, patience: Duration) -> Self {
        let plan = Plan::new(&model);
        let tally = counted(renderer, &plan);
        let tests = tests(&plan, &tally, cpu, patience);
        let bare: Option<Vec<_>> =
            tests.iter().map(|tests| Some((TextbookTest::of(tests.entity)?, tests.number))).collect();
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
        Self { primary, shadow: lit.beyond(&primary), secondary: frame.beyond(&lit), frame, tests, bare }
    }
}

/// Renders a frame into a buffer that is reused, so memory allocation is not measured.
fn render(renderer: &Renderer, plan: &Plan, room: &mut Option<Band>) {
    let [width, height] = plan.camera.pixels;
    for rows in Band::split(&(0..width), &(0..height), BAND) {
        let mut band = match room.take() {
            Some(band) if band.rows.len() == rows.len() => band,
            _ => Band::blank(0..width, rows.clone(), false),
        };
        band.rows = rows;
        (0..band.strips.len()).for_each(|index| band.strip(index).tiles.fill(false));
        renderer.fill(plan, &band, RenderCallbacks { stops: &|| false, row: &|| () }, &|_: Flaws| {});
        *room = Some(band);
    }
}

/// Counts the rays and tests of a frame.
fn counted(renderer: &Renderer, plan: &Plan) -> RayStats {
    let [width, height] = plan.camera.pixels;
    let sum = Mutex::new(RayStats::default());
    let add = |part: RayStats| sum.lock().unwrap_or_else(PoisonError::into_inner).add(&part);
    renderer.bands(plan, 0..width, 0..height, &add).for_each(drop);
    sum.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn tests(plan: &Plan, tally: &RayStats, cpu: Cpu, patience: Duration) -> Vec<TestTimes> {
    /// The number of textbook tests in a round.
    const ROUND: u64 = 1 << 16;
    let (packets, model) = (packets::of(plan, cpu), plan.model);
    let tests = tally.tests(model).into_iter().filter(|(_, tests)| tests.tested > 0);
    let tests = tests.map(|(entity, tests)| TestTimes {
        entity,
        number: tests.tested,
        times: packets::times(&packets, model, cpu, patience, |object| {
            model.objects[object].args.entity().name == entity
        }),
        bare: TextbookTest::of(entity).map(|bare| {
            let [seconds] = clock::least(patience, [&mut || bare.run(cpu, ROUND)]);
            1e9 * seconds / ROUND as f64
        }),
    });
    tests.collect()
}

/// Removes mirrors and glass from a model.
fn matt(model: Model) -> Model {
    let matt = |object: Object| {
        let material = Material { specular: Rgb::ZERO, transparency: 0.0, ..(*object.material).clone() };
        // Nearly all shaders use the material's reflectivity, and keep their speed.
        let is_matt = !object.shader.covers_in_part()
            && object.shader.brightest(&material).is_some_and(|look| look.specular == Rgb::ZERO);
        let shader = if is_matt { object.shader } else { Arc::new(WithoutReflections(object.shader)) };
        Object { material: Arc::new(material), shader, ..object }
    };
    let objects = model.objects.into_iter().map(matt).collect();
    Model { objects, ..model }
}

/// Wraps a shader and removes its reflections.
struct WithoutReflections(AnyShader);

impl Shader for WithoutReflections {
    fn sees(&self) -> ShaderInputs {
        self.0.sees()
    }

    fn bends(&self) -> bool {
        self.0.bends()
    }

    fn bend<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        N::looks(&*self.0).leans(at, normal)
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        match of {
            Reflectivity::Specular => Some([N::constant(0.0); 3]),
            _ => N::looks(&*self.0).reflects(of, material, at),
        }
    }

    fn emission(&self, at: &SurfacePoint) -> Rgb {
        self.0.emission(at)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.0.tile(at)
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.uniform(material).map(|look| Look { specular: Rgb::ZERO, ..look })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.brightest(material).map(|look| Look { specular: Rgb::ZERO, ..look })
    }
}
