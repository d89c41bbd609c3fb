//! The colours that rays return: first hits, lights, shadows, mirrors and glass (the notes' `ray_trace`).
//!
//! Rays are traced in packets. The first hits of a packet are found for all its rays at once (`closest_hit`). The
//! rays that hit the same object continue together, as a smaller packet (`shade`), and so do their shadow rays
//! (`occlusion`, `transmittance`) and the rays that are transmitted and reflected there. A single ray is a packet of
//! one. A ray's colour does not depend on the other rays of its packet.

mod adaptive;
mod aim;
mod alpha;
mod arrays;
mod budget;
mod certain;
mod closest_hit;
mod context;
mod direct_light;
mod draws;
mod estimate;
mod exact;
mod facets;
mod grow;
mod light;
mod light_points;
mod media;
mod mixed;
mod occlusion;
mod path_hash;
mod ray_group;
mod sampled;
mod scatter;
mod shade;
mod surface;
mod transmittance;
mod tree;
mod wave;

pub use context::{Scratch, Tracer};
pub use exact::primary_distance;

use crate::flaws::Flaws;
use crate::observer::{Count, Event, Hit, RayKind, RayPurpose, TraceObserver};
use crate::plan::Plan;
use arrays::{VectorList, gather};
use context::{HitScratch, PrimaryScratch};
use draws::RIM_POINTS;
use glam::DVec2;
use ray_group::RayGroup;
use std::slice;
use tabray_world::display::Display;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::geometry::sight::Sight;
use tabray_world::material::Rgb;
use tabray_world::rules::Rules;
use tabray_world::sample::{self, Sample, Samples};
use tabray_world::sensor;
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::View;

/// Tells whether the noise of a pixel is measured. One in eight tells that of the image.
fn is_measured([x, y]: [usize; 2]) -> bool {
    (x + 3 * y).is_multiple_of(8)
}

/// Computes the colour of a pixel, before it is clamped to what an image can show. `x` counts pixels from the left and
/// `y` from the bottom.
pub fn pixel(plan: &Plan, x: usize, y: usize) -> Rgb {
    observe_pixel(plan, x, y, &mut ())
}

/// Computes the colours of rays through the centres of up to [`PACKET_SIZE`] pixels, each with its ray budget.
/// Returns with each colour a bound on the light that the budget cut off.
#[doc(hidden)]
pub fn within_budgets(
    plan: &Plan,
    pixels: &[[usize; 2]],
    budgets: &[u32],
    observer: &mut dyn TraceObserver,
) -> Vec<(Rgb, f64)> {
    let (mut scratch, mut group, mut colours) =
        (Scratch::default(), RayGroup::default(), VectorList::default());
    let [x, y] = [0, 1].map(|axis| pixels.iter().map(move |pixel| pixel[axis] as f64));
    scratch.places = [x.collect(), y.collect()];
    scratch.places.iter_mut().for_each(|places| places.resize(PACKET_SIZE, 0.0));
    let Scratch { places, lens, .. } = &mut scratch;
    group.fill_primary(Cpu::best(), (&plan.camera, false), plan.depth.as_ref(), places, lens, pixels.len());
    group.ray_budget[..budgets.len()].copy_from_slice(budgets);
    let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, observer);
    tracer.colours(&mut group, &mut colours);
    (0..pixels.len()).map(|lane| (colours.get(lane), tracer.missing(lane))).collect()
}

/// Computes the colour of a pixel as [`pixel`] does, and reports each step to `observer`.
pub fn observe_pixel(plan: &Plan, x: usize, y: usize, observer: &mut dyn TraceObserver) -> Rgb {
    let proof = certain::proof(plan, x, y);
    if let Some(proof) = &proof
        && certain::is_certified(plan, proof)
    {
        return proof.middle(&plan.camera.display());
    }
    let (camera, count) = (&plan.camera, samples(plan, x, y).0);
    let (mut sum, mut budget, mut rays) = (Rgb::ZERO, None, SingleRays::default());
    for (place, sample) in camera.places(x, y, count) {
        let sight = camera.sight_of(place, sample.as_ref());
        let (colour, missing) = rays.observed(plan, &sight, (sample, budget), observer);
        sum += colour;
        if missing == f64::INFINITY && sampled::is_unbounded(plan) {
            budget = Some(sampled::REST);
        }
    }
    let colour = sum / f64::from(count);
    proof.map_or(colour, |proof| proof.nearest(colour))
}

/// A proven bound on the error of a pixel's colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelBound {
    /// A bound on the error of the colour as it is shown, the largest of its channels, where 1 is white.
    pub error: f64,
    /// Whether the bound is within the limit, so that the pixel takes no samples.
    pub is_certified: bool,
    /// The number of footprints that were examined.
    pub footprints: u32,
}

/// Returns the proven bounds of a pixel's colour, if the render asks for them.
pub fn bounded(plan: &Plan, x: usize, y: usize) -> Option<PixelBound> {
    let (proof, display) = (certain::proof(plan, x, y)?, &plan.camera.display());
    let is_certified = certain::is_certified(plan, &proof);
    let colour = if is_certified { proof.middle(display) } else { pixel(plan, x, y) };
    Some(PixelBound { error: proof.error(colour, display), is_certified, footprints: proof.footprints })
}

/// Returns the number of samples of a pixel and, where pixels differ in that, the estimated error of its colour,
/// where 1 is white.
pub fn samples(plan: &Plan, x: usize, y: usize) -> (u32, Option<f64>) {
    if plan.camera.adaptive.is_none() {
        return (plan.camera.samples, None);
    }
    let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
    Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody).pixels(&[[x, y]]);
    let (count, error) =
        scratch.primary.map_or((0, 0.0), |primary| primary.adaptive.first(&plan.camera.display()));
    (count, Some(error))
}

/// Tells whether any of a pixel's camera rays has a first hit that could not be decided.
pub(crate) fn is_undecided(plan: &Plan, x: usize, y: usize) -> bool {
    let (mut scratch, mut flaws) = (Scratch::default(), Flaws::default());
    Tracer::new(plan, Cpu::best(), &mut scratch, &mut flaws).pixels(&[[x, y]]);
    flaws.undecided.pixels() > 0
}

/// Computes the colour that a primary ray returns, before it is clamped. Lights with a size are sampled at the point
/// that `sample` chooses, or at their centre.
pub fn colour(plan: &Plan, sight: &Sight, sample: Option<Sample>) -> Rgb {
    observe_colour(plan, sight, sample, &mut ())
}

/// Computes the colour that a primary ray returns as [`colour`] does, and reports each step to `observer`.
pub fn observe_colour(
    plan: &Plan,
    sight: &Sight,
    sample: Option<Sample>,
    observer: &mut dyn TraceObserver,
) -> Rgb {
    SingleRays::default().observed(plan, sight, (sample, None), observer).0
}

/// Computes the colours that primary rays without samples return as [`colour`] does, one after the other, and reports
/// each step to `observer`.
pub fn observe_colours(
    plan: &Plan,
    sights: impl Iterator<Item = Sight>,
    observer: &mut dyn TraceObserver,
) -> Vec<Rgb> {
    let mut rays = SingleRays::default();
    sights.map(|sight| rays.observed(plan, &sight, (None, None), observer).0).collect()
}

/// The scratch space of primary rays that are traced one by one.
#[derive(Default)]
struct SingleRays {
    scratch: Scratch,
    group: RayGroup,
    colours: VectorList,
}

impl SingleRays {
    /// Computes a colour, with the sample of its ray and with the usual ray budget or this one, and a bound on the
    /// light that it lacks.
    fn observed(
        &mut self,
        plan: &Plan,
        sight: &Sight,
        (sample, budget): (Option<Sample>, Option<u32>),
        observer: &mut dyn TraceObserver,
    ) -> (Rgb, f64) {
        let Self { scratch, group, colours } = self;
        match sample {
            Some(sample) => {
                scratch.samples.begin(sample.sampler);
                scratch.samples.push(sample);
            }
            None => scratch.samples = Samples::default(),
        }
        let mut tracer = Tracer::new(plan, Cpu::best(), scratch, observer);
        group.become_sights(slice::from_ref(sight), plan.depth.as_ref());
        if let Some(budget) = budget {
            group.ray_budget.fill(budget);
        }
        tracer.colours(group, colours);
        (colours.get(0), tracer.missing(0))
    }
}

/// Finds the first hit of a primary ray.
pub fn first_hit<'m>(plan: &Plan<'m>, sight: &Sight) -> Option<Hit<'m>> {
    first_hits(plan, slice::from_ref(sight), true).pop().flatten()
}

/// Finds the first hits of primary rays, up to [`PACKET_SIZE`] together. `decides` tells whether proofs decide what the
/// rounded rays leave open.
pub fn first_hits<'m>(plan: &Plan<'m>, sights: &[Sight], decides: bool) -> Vec<Option<Hit<'m>>> {
    let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
    let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
    let (mut group, mut part) = (RayGroup::default(), RayGroup::default());
    let HitScratch { mut hits, mut parts, mut near, mut far, .. } = HitScratch::default();
    let (mut distances, mut found) = (Vec::new(), Vec::new());
    for sights in sights.chunks(PACKET_SIZE) {
        group.become_sights(sights, None);
        if !decides {
            group.forget_sights();
        }
        tracer.closest(&mut group, None, &mut hits);
        let first = found.len();
        found.resize_with(first + sights.len(), || None);
        parts.begin(&hits.hit_ids[..group.len]);
        while let Some((id, lanes)) = parts.next() {
            let Some(index) = (id as usize).checked_sub(1) else { continue };
            part.gather(&group, lanes);
            gather(&mut near, &hits.near, lanes, part.padded());
            gather(&mut far, &hits.far, lanes, part.padded());
            if decides {
                part.sights.extend(lanes.iter().map(|lane| sights[usize::from(*lane)].clone()));
            }
            tracer.refine(&part, (&near, &far), index, &mut distances);
            for (lane, distance) in lanes.iter().zip(&distances) {
                let (lane, distance) = (usize::from(*lane), *distance);
                let point = group.rays().get(lane).at(distance);
                found[first + lane] =
                    Some(Hit { index, object: &plan.model.objects[index], distance, point });
            }
        }
    }
    found
}

impl Tracer<'_, '_> {
    /// Computes the colours of pixels, given by column and row from the bottom. Up to [`PACKET_SIZE`] rays are traced
    /// together.
    pub fn pixels(&mut self, pixels: &[[usize; 2]]) -> View<'_> {
        self.pixels_with_alpha(pixels).0
    }

    /// Computes the colours of pixels as [`pixels`](Self::pixels) does, and the alpha of each; none where the camera has no
    /// alpha. With alpha, a colour is the light of objects alone, and so premultiplied.
    pub fn pixels_with_alpha(&mut self, pixels: &[[usize; 2]]) -> (View<'_>, &[f64]) {
        let camera = &self.plan.camera;
        let mut primary = self.scratch.primary.take().unwrap_or_default();
        primary.alpha.clear();
        self.scratch.places.iter_mut().for_each(|places| places.resize(PACKET_SIZE, 0.0));
        match (camera.adaptive, &self.plan.prover) {
            // Proofs are about colours with the background.
            (Some(adaptive), Some(prover)) if !camera.alpha => {
                self.certain_pixels(pixels, adaptive, prover, &mut primary)
            }
            (Some(adaptive), _) => self.adaptive_pixels(pixels, adaptive, &mut primary),
            (None, _) if camera.is_single() => self.middles(pixels, &mut primary),
            (None, _) if sampled::is_unbounded(self.plan) => self.one_by_one(pixels, &mut primary),
            (None, _) => self.fixed_samples(pixels, &mut primary),
        }
        if !self.scratch.undecided.pixels.is_empty() {
            self.report_undecided();
        }
        let PrimaryScratch { colours, alpha, .. } = &**self.scratch.primary.insert(primary);
        (colours.view(pixels.len()), alpha)
    }

    /// Computes the colours of rays through places of the image, in pixels, each with its sample.
    pub fn places(&mut self, places: &[(DVec2, Sample)]) -> Vec<Rgb> {
        let mut primary = self.scratch.primary.take().unwrap_or_default();
        let PrimaryScratch { group, seen, .. } = &mut *primary;
        self.scratch.places.iter_mut().for_each(|places| places.resize(PACKET_SIZE, 0.0));
        let mut all = Vec::with_capacity(places.len());
        for part in places.chunks(PACKET_SIZE) {
            let Scratch { places: [x, y], samples, .. } = &mut *self.scratch;
            samples.begin(part[0].1.sampler);
            part.iter().for_each(|(_, sample)| samples.push(*sample));
            for ((place, _), (x, y)) in part.iter().zip(x.iter_mut().zip(y)) {
                (*x, *y) = (place.x, place.y);
            }
            self.fill_primary(group, part.len());
            self.colours(group, seen);
            all.extend((0..part.len()).map(|lane| seen.get(lane)));
        }
        self.scratch.primary = Some(primary);
        all
    }

    /// Computes the colours of pixels by one ray through the middle of each.
    fn middles(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) {
        let PrimaryScratch { group, seen, colours, alpha, .. } = primary;
        let mut colours = colours.resized(pixels.len());
        self.scratch.samples = Samples::default();
        for (pixels, first) in pixels.chunks(PACKET_SIZE).zip((0..).step_by(PACKET_SIZE)) {
            let [x, y] = &mut self.scratch.places;
            sensor::middles(self.cpu, pixels, x, y);
            self.fill_primary(group, pixels.len());
            self.colours(group, seen);
            colours.copy_at(first, seen.view(pixels.len()));
            alpha.extend(self.scratch.clear.iter().map(|clear| 1.0 - clear));
            if self.scratch.any_missing {
                (0..pixels.len()).for_each(|lane| self.cut(self.missing(lane)));
            }
        }
    }

    /// Computes the colours of pixels with the same number of samples each. As many pixels are traced together as fit
    /// into a packet.
    fn fixed_samples(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) {
        let camera = &self.plan.camera;
        let PrimaryScratch { group, seen, colours, alpha, .. } = primary;
        let mut colours = colours.resized(pixels.len());
        let (samples, half) = (camera.samples as usize, camera.samples as usize / 2);
        let display = camera.display();
        let (mut sum, mut clear, mut missing, mut count) = (Rgb::ZERO, 0.0, 0.0, 0);
        let (mut pixel, mut taken, mut sum_of_half) = (0, 0, Rgb::ZERO);
        while count < samples * pixels.len() {
            let len = PACKET_SIZE.min(samples * pixels.len() - count);
            let Scratch { places: [x, y], samples: drawn, .. } = &mut *self.scratch;
            camera.scatter(self.cpu, pixels, count..count + len, drawn, [&mut x[..len], &mut y[..len]]);
            self.fill_primary(group, len);
            self.colours(group, seen);
            let mut lanes = 0..len;
            while !lanes.is_empty() {
                // The samples of one pixel may go on in the next packet.
                let is_measured = half > 0 && is_measured(pixels[pixel]);
                let next = if is_measured && taken < half { half } else { samples };
                let end = len.min(lanes.start + next - taken);
                let of_one = lanes.start..end;
                sum = seen.view(len).part(of_one.clone()).added_to(sum);
                if camera.alpha {
                    clear = self.scratch.clear[of_one.clone()].iter().fold(clear, |clear, one| clear + one);
                }
                if self.scratch.any_missing {
                    missing = of_one.fold(missing, |missing, lane| missing + self.missing(lane));
                }
                taken += end - lanes.start;
                lanes.start = end;
                if taken == half {
                    sum_of_half = sum;
                }
                if taken == samples {
                    if is_measured {
                        let sums = [sum_of_half, sum - sum_of_half];
                        self.report_noise(&display, sums, [half, samples - half]);
                    }
                    colours.set(pixel, sum / f64::from(camera.samples));
                    self.cut(missing / f64::from(camera.samples));
                    if camera.alpha {
                        alpha.push(1.0 - clear / f64::from(camera.samples));
                    }
                    (pixel, taken) = (pixel + 1, 0);
                    (sum, clear, missing) = (Rgb::ZERO, 0.0, 0.0);
                }
            }
            count += len;
        }
    }

    /// Fills a group with the primary rays through the first `len` image positions, with their samples.
    fn fill_primary(&mut self, group: &mut RayGroup, len: usize) {
        let (cpu, plan) = (self.cpu, self.plan);
        let Scratch { places, lens, samples, are_probes, .. } = &mut *self.scratch;
        lens.iter_mut().for_each(Vec::clear);
        if plan.camera.camera.has_lens() && !samples.is_empty() {
            lens.iter_mut().for_each(|each| each.resize(PACKET_SIZE, 0.0));
            let [x, y] = lens.each_mut().map(|each| &mut each[..len]);
            if *are_probes {
                sample::on_rim(samples.pixels().iter().map(|point| f64::from(*point) / RIM_POINTS), x, y);
            } else {
                sample::on_lenses(cpu, samples, x, y);
            }
        }
        let is_sampled = !samples.is_empty();
        group.fill_primary(cpu, (&plan.camera, is_sampled), plan.depth.as_ref(), places, lens, len);
    }

    /// Reports the noise of a pixel, given the sums and the numbers of the two halves of its samples. The error of their
    /// mean is about half of the difference of the halves; evenly spread samples err less.
    fn report_noise(&mut self, display: &Display, sums: [Rgb; 2], counts: [usize; 2]) {
        let [one, other] = [0, 1].map(|half| sums[half] / counts[half] as f64);
        let off = if one == other { Rgb::ZERO } else { 0.5 * (display.shown(one) - display.shown(other)) };
        self.observer.count(Count::Noise((off * off).element_sum() / 3.0));
    }

    /// Reports a pixel that lacks light. `missing` bounds that light, in any channel; under the free rules, it is the
    /// distance of the pixel's bounds as shown.
    fn cut(&mut self, missing: f64) {
        let tolerable = match self.plan.camera.rules {
            Rules::Notes => 0.0,
            Rules::Free => tree::SHOWN / 255.0,
        };
        if missing > tolerable {
            self.observer.count(Count::Cut(missing));
        }
    }

    /// Computes the colours that primary rays return.
    fn colours(&mut self, group: &mut RayGroup, colours: &mut VectorList) {
        self.observer.count(Count::Rays(RayKind::Primary, group.len));
        self.viewer = self.plan.camera.max_coordinate();
        self.begin_missing(&group.ray_budget[..group.len]);
        if let Some(lighting) = &mut self.scratch.lighting {
            lighting.draws.begin();
        }
        if self.scratch.path_hashes.is_on {
            self.scratch.path_hashes.begin(group.len);
        }
        self.scratch.clear.clear();
        if self.plan.camera.alpha {
            self.scratch.clear.resize(group.len, 0.0);
        }
        if self.sees_events {
            self.observer.see(Event::Begin(RayPurpose::Primary));
        }
        let plan = self.plan;
        match (plan.camera.rules, &plan.depth) {
            (Rules::Free, Some(depth)) => self.grow(depth, group, colours),
            (Rules::Free, None) => self.trace(group, colours),
            (Rules::Notes, _) => {
                self.trace(group, colours);
                self.count_far();
            }
        }
    }
}
