//! The times of renders of a scene, by accuracy and number of samples.

use super::cost::{Counted, Estimated, Timing};
use super::progress::Progress;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io;
use tabray_core::output::deflate::Compression;
use tabray_core::output::picture::Format;
use tabray_core::render::bytes::to_byte;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sampler;
use tabray_tools::clock;
use tabray_tools::sampling::places::spread;
use tabray_tools::sampling::traced;

/// The numbers of samples with which the times of accuracies are compared, and the number of groups of packets.
const COMPARED: [u32; 2] = [1, 4];
const GROUPS: usize = 5;

/// The maximum part of the time of the scene's own accuracy that another accuracy takes, in each group, to be a
/// choice.
const GAIN: f64 = 0.8;

/// The cost of the render of an image.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// The number of rays of all kinds.
    pub rays: f64,
    /// The CPU time for tracing them, in seconds.
    pub tracing: Estimated,
    /// The CPU time of the render, in seconds.
    pub cpu: Estimated,
    /// The time of the render on all cores, in seconds, if the cores have nothing else to do.
    pub time: Estimated,
}

/// The times measured so far of the images of a scene. Each accuracy has an index; the scene's own has 0.
pub(super) struct Timings {
    packets: BTreeMap<(usize, u32), Timing>,
    counted: BTreeMap<usize, Option<Counted>>,
    overhead: Overhead,
    /// The number of pixels of the image.
    pixels: f64,
}

impl Timings {
    /// Begins with the work that is not tracing. A render begins with work of this CPU time, in seconds.
    pub fn new(model: &Model, threads: &Renderer, beginning: f64) -> Self {
        let (size, mut plan) = (model.camera.value.pixels, plan(model));
        plan.camera.samples = 1;
        let writing = writing(&traced::shown(threads, &plan, &spread(size, 256)), size);
        let cores = threads.run(rayon::current_num_threads);
        let overhead = Overhead { beginning, writing, cores };
        let pixels = (size[0] * size[1]) as f64;
        Self { packets: BTreeMap::new(), counted: BTreeMap::new(), overhead, pixels }
    }

    /// Counts rays and times some packets of images of these numbers of samples.
    pub fn measure(
        &mut self,
        index: usize,
        samples: &[u32],
        (plan, threads): (&mut Plan, &Renderer),
        progress: &mut dyn Progress,
    ) -> io::Result<()> {
        let counted = self.counted.entry(index).or_insert_with(|| {
            plan.camera.samples = 1;
            Counted::new(plan, threads)
        });
        for samples in samples {
            if let Entry::Vacant(place) = self.packets.entry((index, *samples)) {
                plan.camera.samples = *samples;
                place.insert(Timing::begun(plan, threads, counted.as_ref()));
                if progress.done(0).is_break() {
                    return Err(io::ErrorKind::Interrupted.into());
                }
            }
        }
        Ok(())
    }

    /// Makes the times of an image more exact as long as that is useful and `goes_on`.
    pub fn refine(
        &mut self,
        (index, samples): (usize, u32),
        (plan, threads): (&mut Plan, &Renderer),
        goes_on: impl Fn(&Cost) -> bool,
    ) {
        plan.camera.samples = samples;
        while goes_on(&self.cost(index, samples)) {
            let (Some(timing), Some(counted)) =
                (self.packets.get_mut(&(index, samples)), self.counted.get(&index))
            else {
                return;
            };
            if !timing.refine(plan, threads, counted.as_ref()) {
                return;
            }
        }
    }

    /// Returns the cost of an image of a number of samples that has been measured.
    pub fn cost(&self, index: usize, samples: u32) -> Cost {
        let primary = f64::from(samples) * self.pixels;
        self.overhead.with(primary, &self.packets[&(index, samples)], self.counted[&index].as_ref())
    }

    /// Returns the cost of an image with this mean number of rays from the viewer per pixel.
    pub fn cost_of(&self, rays: f64, timing: &Timing) -> Cost {
        self.overhead.with(rays * self.pixels, timing, None)
    }
}

/// Tells for each of several accuracies whether it is clearly faster than the scene's own, by packets at the same
/// places.
pub(super) fn gains(own: &Model, others: &[&Model], threads: &Renderer) -> Vec<bool> {
    let compared = |model: &&Model| {
        let mut plan = plan(model);
        COMPARED.map(|samples| {
            plan.camera.samples = samples;
            Timing::begun(&plan, threads, None)
        })
    };
    let own = compared(&own);
    let is_faster =
        |other: [Timing; 2]| other.iter().zip(&own).all(|(one, own)| one.is_faster(own, GAIN, GROUPS));
    others.iter().map(compared).map(is_faster).collect()
}

/// The cost of a render in addition to tracing.
struct Overhead {
    /// The CPU time to begin, in seconds: the work of one thread.
    beginning: f64,
    /// The CPU time to compress the image on all threads, in seconds.
    writing: f64,
    cores: usize,
}

impl Overhead {
    /// Returns the cost of an image of this number of rays from the viewer.
    fn with(&self, primary: f64, timing: &Timing, counted: Option<&Counted>) -> Cost {
        let Self { beginning, writing, cores } = *self;
        let tracing = timing.of_all(primary, counted);
        Cost {
            rays: primary * timing.all_rays(counted),
            tracing,
            cpu: tracing.map(|tracing| beginning + writing + tracing),
            time: tracing.map(|tracing| beginning + (writing + tracing) / cores as f64),
        }
    }
}

/// Plans an image whose samples are spread evenly.
pub(super) fn plan(model: &Model) -> Plan<'_> {
    let mut plan = Plan::for_picture(model);
    plan.camera.sampler = Sampler::Sobol;
    plan
}

/// Returns the CPU time for writing an image of this size as a PNG, in seconds, measured on the colours of some of its
/// pixels.
fn writing(colours: &[Rgb], [width, height]: [usize; 2]) -> f64 {
    const SIDE: usize = 256;
    let pixels = colours.iter().cycle().take(SIDE * SIDE);
    let bytes: Vec<u8> = pixels.flat_map(|colour| colour.to_array().map(to_byte)).collect();
    let start = clock::now();
    // Writing to nowhere does not fail.
    let _ = Format::Png(Compression::Fast).write(io::sink(), [SIDE; 2], [Ok(bytes)]);
    (clock::now() - start).as_secs_f64() * (width * height) as f64 / (SIDE * SIDE) as f64
}
