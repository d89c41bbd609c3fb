//! The effect of each choice on the image: its colours against the true ones, and its time.
//!
//! Errors are those of some of the image's own pixels, spread evenly; times are those of some of its tiles, each traced
//! on one thread as in a render.

use super::clock;
use super::colours::{Difference, difference};
use super::data::{Family, Panel, Point, Subject, WrongHits};
use super::progress::Progress;
use super::study::Study;
use super::times::Times;
use glam::DVec2;
use std::ops::ControlFlow;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::parallel;
use tabray_core::render::observer::{Event, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::{Sample, Sampler};
use tabray_core::world::sensor::Adaptive;
use tabray_tools::sampling::Samples;
use tabray_tools::sampling::places::{Pixels, spread, tiles};
use tabray_tools::sampling::traced;

/// The number of samples per pixel of an image that counts as true. It serves as a reference for up to a quarter as
/// many samples.
const TRUE_SAMPLES: u32 = 1024;

/// The numbers of samples that are compared, besides the scene's own.
const SAMPLES: [u32; 8] = [1, 2, 4, 8, 16, 24, 32, 64];

/// The least and the greatest numbers of samples that are compared where pixels take different ones.
pub(super) const ADAPTIVE: [[u32; 2]; 3] = [[4, 16], [4, 64], [4, 256]];

/// The numbers of reflections and transmissions on a path that are compared, besides all.
const DEPTHS: [usize; 8] = [0, 1, 2, 3, 4, 6, 8, 12];

/// The minimum number of pixels of which the true colours must be known.
const FEWEST: usize = 256;

/// The least number of pixels of which the true colours are computed if there is time, and an eighth of the greatest.
const LEAST: usize = 1024;

/// The maximum number of object tests for the true colours of one panel of samples: about 0.1 µs each, so 5 s.
const TRUE_TESTS: usize = 50_000_000;

/// The approximate number of tests in a timed piece of work with one sample per pixel, and the minimum number of tiles.
const TIMED_TESTS: usize = 25_000;
const TIMED_TILES: usize = 16;
const FEWEST_TILES: usize = 4;

/// The maximum number of tests for an image by another method.
const METHOD_TESTS: usize = 500_000;

/// The parts of an image that more samples make smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SampledEffect {
    /// Edges, and shadows where they are soft.
    Picture,
    /// Soft shadows alone: every sample of a pixel goes through its centre.
    Shadows,
}

/// Returns the approximate work of measuring all images, in units of [`Progress`].
pub fn work(study: &Study) -> usize {
    let kinds = 1 + usize::from(has_size(&study.candidates[study.default].model));
    let of_images = |count: usize| count * study.part(METHOD_TESTS) / 10 + clock::work(count);
    let model = &study.candidates[study.default].model;
    let depths = if goes_on(model) { of_images(DEPTHS.len() + 1) } else { 0 };
    of_images(study.candidates.len())
        + depths
        + kinds * (study.part(TRUE_TESTS) / 8 + clock::work(2 * SAMPLES.len() + ADAPTIVE.len()))
}

/// Tells whether any light of a model has a size.
pub fn has_size(model: &Model) -> bool {
    model.lights.iter().any(|light| light.value.size() > 0.0 || light.value.emitter().is_some())
}

/// Plans an image with one ray through the centre of each pixel.
fn one_ray(model: &Model) -> Plan<'_> {
    let mut plan = Plan::new(model);
    plan.camera.samples = 1;
    plan
}

/// Images of the same pixels, with one ray through the centre of each, that are compared with one of them.
struct Compared<'s> {
    study: &'s Study,
    plans: Vec<Plan<'s>>,
    right: usize,
    pixels: Pixels,
}

impl<'s> Compared<'s> {
    fn new(study: &'s Study, plans: Vec<Plan<'s>>, right: usize) -> Self {
        let model = &study.candidates[study.default].model;
        let pixels = (study.effort * METHOD_TESTS as f64 / study.tests) as usize;
        let pixels = spread(model.camera.value.pixels, pixels.max(FEWEST));
        Self { study, plans, right, pixels }
    }

    fn differences(&self, progress: &mut dyn Progress) -> ControlFlow<(), Vec<Difference>> {
        let mut colours = Vec::new();
        for plan in &self.plans {
            colours.push(traced::apart(&self.study.threads, plan, &self.pixels).0);
            progress.done(self.study.part(METHOD_TESTS) / 10)?;
        }
        let (right, display) = (&colours[self.right], self.plans[self.right].camera.display());
        ControlFlow::Continue(colours.iter().map(|colours| difference(&display, colours, right)).collect())
    }

    fn times(&self, progress: &mut dyn Progress) -> ControlFlow<(), Vec<Times>> {
        let timed = timed(self.study, self.plans[self.right].camera.pixels);
        let (study, count_of) = (self.study, (self.plans.len(), count(&timed)));
        let work = |choice: usize| traced::tiles(&self.plans[choice], &timed);
        study.thread.run(|| clock::rounds(count_of, study.effort, work, progress))
    }

    /// Says how many pixels were compared.
    fn note(&self) -> String {
        let [width, height] = self.plans[self.right].camera.pixels;
        format!("{} of {} pixels", self.pixels.len(), width * height)
    }
}

/// Compares the methods of finding hits on an image with one ray through the centre of each pixel.
pub fn methods(study: &Study, progress: &mut dyn Progress) -> ControlFlow<(), Panel> {
    let plans = study.candidates.iter().map(|candidate| one_ray(&candidate.model)).collect();
    let compared = Compared::new(study, plans, study.strict);
    let measured = compared.differences(progress)?.into_iter().zip(compared.times(progress)?);
    let points = study.candidates.iter().zip(measured).map(|(candidate, (off, times))| Point {
        is_default: candidate.is_default,
        ..point(candidate.name.clone(), candidate.family, times, off, (compared.pixels.len(), 1))
    });
    ControlFlow::Continue(Panel {
        title: "the image, by method".to_owned(),
        note: format!("{}, against strict", compared.note()),
        subject: Subject::Methods,
        points: points.collect(),
    })
}

/// Tells whether rays of a model are reflected or transmitted.
pub fn goes_on(model: &Model) -> bool {
    Plan::new(model).depth.is_some()
}

/// Compares how often rays are reflected and transmitted, on an image with one ray through the centre of each pixel;
/// returns `None` where that makes no difference.
pub fn depths(study: &Study, progress: &mut dyn Progress) -> ControlFlow<(), Option<Panel>> {
    let plan = |depth: usize| {
        let mut plan = one_ray(&study.candidates[study.default].model);
        plan.max_depth = depth;
        plan
    };
    let plans = DEPTHS.into_iter().chain([usize::MAX]).map(plan).collect();
    let compared = Compared::new(study, plans, DEPTHS.len());
    let differences = compared.differences(progress)?;
    if differences.iter().all(|off| off.rmse == 0.0) {
        return ControlFlow::Continue(None);
    }
    let measured = differences.into_iter().zip(compared.times(progress)?);
    let points = compared.plans.iter().zip(measured).map(|(plan, (off, times))| {
        let is_default = plan.max_depth == usize::MAX;
        let name = if is_default { "all".to_owned() } else { plan.max_depth.to_string() };
        Point { is_default, ..point(name, Family::Own, times, off, (compared.pixels.len(), 1)) }
    });
    ControlFlow::Continue(Some(Panel {
        title: "reflections and transmissions, at most".to_owned(),
        note: format!("{}, against all that can be seen", compared.note()),
        subject: Subject::Depth,
        points: points.collect(),
    }))
}

/// Compares numbers of samples with an image of so many samples that more make no difference. Returns `None` where one
/// sample is already right.
pub fn samples(
    study: &Study,
    seen: SampledEffect,
    progress: &mut dyn Progress,
) -> ControlFlow<(), Option<Panel>> {
    let Study { candidates, default, threads, thread, .. } = study;
    let model = &candidates[*default].model;
    let own = &model.camera.value;
    let mut plan = Plan::new(model);
    let max_pixels = (study.effort * TRUE_TESTS as f64 / (f64::from(TRUE_SAMPLES) * study.tests)) as usize;
    let least = study.part(LEAST).max(FEWEST);
    let mut pixels = spread(own.pixels, max_pixels.clamp(least, 8 * least));
    let right = truth(study, &plan, &pixels, seen, progress)?;
    pixels.truncate(right.len());
    let mut choices: Vec<_> = choices(own.samples, own.sampler);
    if seen == SampledEffect::Picture {
        choices.extend(ADAPTIVE.map(|[samples, most]| {
            let adaptive = Some(Adaptive { most, error: None });
            Samples { sampler: Sampler::Sobol, samples, adaptive }
        }));
    }
    let mut differences = Vec::new();
    for choice in &choices {
        choice.set(&mut plan);
        let colours = match seen {
            // A single sample is in the middle of its pixel.
            SampledEffect::Shadows if choice.samples > 1 => {
                means(threads, &plan, &pixels, (*choice, 0), seen)
            }
            _ => traced::apart(threads, &plan, &pixels).0,
        };
        differences.push(difference(&plan.camera.display(), &colours, &right));
        progress.done(study.part(TRUE_TESTS) / 40 / choices.len())?;
    }
    let timed = timed(study, own.pixels);
    let times = thread.run(|| {
        let work = |choice: usize| {
            choices[choice].set(&mut plan);
            traced::tiles(&plan, &timed);
        };
        clock::rounds((choices.len(), count(&timed)), study.effort, work, progress)
    });
    if differences.iter().all(|off| off.rmse == 0.0) {
        return ControlFlow::Continue(None);
    }
    let points = choices.iter().zip(differences).zip(times?).map(|((choice, off), times)| {
        let Samples { sampler, samples, adaptive } = *choice;
        let (name, family, most) = match adaptive {
            Some(Adaptive { most, .. }) => (format!("{samples}..{most}"), Family::Adaptive, most),
            None => (format!("{} {samples}", name(sampler)), family(sampler), samples),
        };
        let is_default = adaptive.is_none() && samples == own.samples && sampler == own.sampler;
        Point { is_default, ..point(name, family, times, off, (pixels.len(), most)) }
    });
    let title = match (seen, has_size(model)) {
        (SampledEffect::Picture, false) => "samples per pixel: edges",
        (SampledEffect::Picture, true) => "samples per pixel: edges and soft shadows",
        (SampledEffect::Shadows, _) => "samples per pixel: soft shadows alone",
    };
    ControlFlow::Continue(Some(Panel {
        title: title.to_owned(),
        note: format!("{} pixels, against {TRUE_SAMPLES} samples", pixels.len()),
        subject: Subject::Samples,
        points: points.collect(),
    }))
}

fn point(
    name: String,
    family: Family,
    times: Times,
    off: Difference,
    (pixels, samples): (usize, u32),
) -> Point {
    Point {
        name,
        family,
        is_default: false,
        times,
        error: off.rmse,
        worst: off.worst,
        wrong: WrongHits::default(),
        visible: Some(off.visible),
        changed: Some([off.changed, pixels]),
        samples,
    }
}

fn name(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::Random => "random",
        Sampler::Sobol => "sobol",
    }
}

/// Returns the numbers of samples and the samplers that are compared; a single sample is compared only once.
fn choices(own: u32, own_sampler: Sampler) -> Vec<Samples> {
    let mut counts = SAMPLES.to_vec();
    if !counts.contains(&own) && own <= TRUE_SAMPLES / 4 {
        counts.push(own);
        counts.sort_unstable();
    }
    let mut choices = Vec::new();
    for sampler in [Sampler::Sobol, Sampler::Random] {
        // A single sample lies at the centre, whatever the sampler.
        let counts = counts.iter().filter(|count| **count > 1 || sampler == own_sampler);
        choices.extend(counts.map(|samples| Samples { sampler, samples: *samples, adaptive: None }));
    }
    choices
}

/// Returns the tiles to time in an image of this size.
fn timed(study: &Study, size: [usize; 2]) -> Vec<Pixels> {
    let count = ((TIMED_TESTS as f64 / study.tests) as usize).div_ceil(PACKET_SIZE).max(TIMED_TILES);
    tiles(size, study.part(count).max(FEWEST_TILES))
}

/// Returns the number of pixels of the tiles.
fn count(tiles: &[Pixels]) -> usize {
    tiles.iter().map(Vec::len).sum()
}

/// Returns the true colours: with so many samples that more make no difference, and other ones than those that are
/// compared. Where time does not suffice, they are those of the first pixels only, which are spread as evenly.
fn truth(
    study: &Study,
    plan: &Plan,
    pixels: &Pixels,
    seen: SampledEffect,
    progress: &mut dyn Progress,
) -> ControlFlow<(), Vec<Rgb>> {
    let mut colours = Vec::new();
    let samples = Samples { sampler: Sampler::Sobol, samples: TRUE_SAMPLES, adaptive: None };
    for part in pixels.chunks(pixels.len().div_ceil(100)) {
        colours.extend(means(&study.threads, plan, part, (samples, !0), seen));
        progress.done(study.part(TRUE_TESTS) / 10 * part.len() / pixels.len())?;
        if progress.is_late() && colours.len() >= FEWEST {
            break;
        }
    }
    ControlFlow::Continue(colours)
}

/// Returns the mean colours of pixels with these samples, of sequences that the number tells from others.
fn means(
    threads: &Renderer,
    plan: &Plan,
    pixels: &[[usize; 2]],
    (Samples { sampler, samples, .. }, seed): (Samples, u32),
    seen: SampledEffect,
) -> Vec<Rgb> {
    let width = plan.camera.pixels[0];
    let of_pixel = |[x, y]: [usize; 2]| {
        let pixel = (y * width + x) as u32 ^ seed;
        let place = |index| {
            let sample = Sample { sampler, index, pixel };
            let jitter = match seen {
                SampledEffect::Picture => sample.jitter(),
                SampledEffect::Shadows => DVec2::ZERO,
            };
            (DVec2::new(x as f64, y as f64) + jitter, sample)
        };
        (0..samples).map(place).collect()
    };
    let mean = |colours: Vec<Rgb>| colours.iter().sum::<Rgb>() / f64::from(samples);
    traced::places(threads, plan, pixels, of_pixel).into_iter().map(mean).collect()
}

/// Returns the mean number of object tests for one ray through a pixel and all rays that follow from it.
pub(super) fn tests(plan: &Plan, threads: &Renderer) -> f64 {
    struct Tests(usize);
    impl TraceObserver for Tests {
        fn sees_events(&self) -> bool {
            true
        }

        fn see(&mut self, event: Event) {
            if let Event::Tested(..) = event {
                self.0 += 1;
            }
        }
    }
    const PIXELS: usize = 400;
    let pixels = spread(plan.camera.pixels, PIXELS);
    let count = |index: usize| {
        let [x, y] = pixels[index];
        let mut tests = Tests(0);
        trace::observe_colour(plan, &plan.camera.sight(x as f64, y as f64), None, &mut tests);
        tests.0
    };
    let all: usize = threads.run(|| parallel::map(pixels.len(), count)).into_iter().sum();
    (all as f64 / pixels.len() as f64).max(1.0)
}

fn family(sampler: Sampler) -> Family {
    match sampler {
        Sampler::Random => Family::Random,
        Sampler::Sobol => Family::Sobol,
    }
}
