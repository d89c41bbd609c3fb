//! The numbers by which the samples of primary rays choose the points of lights that surfaces see.
//!
//! All rays that descend from a primary ray use the same numbers, so these are computed once for each light and each packet
//! of primary rays.

use super::arrays::{VectorList, resized};
use super::context::Tracer;
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::observer::TraceObserver;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{LANES, View};
use crate::world::packets::light::PacketLight;
use crate::world::sample::{self, Samples};
use glam::{DVec2, DVec3};

/// The number of points on the rim of a light, or of a lens, that probes go through.
pub(super) const RIM_POINTS: f64 = 16.0;

/// The number of lights whose numbers are kept, so that many lights take little memory.
const KEPT: usize = 16;

/// The part of the primary rays, 1 in this many, from which on numbers are drawn for all of them.
const WORTH: usize = 4;

/// Numbers for each ray: two from 0 to 1 for an area of light; for a ball of light, a distance from the middle of the unit
/// disc, and the cosine and the sine of an angle.
type Numbers<'n> = [&'n mut [f64]; 3];

/// The numbers of a packet of primary rays, and those of the rays that are being shaded.
#[derive(Default)]
pub(super) struct LightDraws {
    /// The index of a light, and the numbers of all primary rays for it.
    kept: Vec<(usize, Box<[[f64; PACKET_SIZE]; 3]>)>,
    /// The number of those that hold for the current primary rays.
    used: usize,
    /// The samples of few rays.
    few: Samples,
    numbers: [Vec<f64>; 3],
    /// The point of a ball of light that each shading point sees.
    lights: VectorList,
}

/// A light that primary rays choose points of.
#[derive(Clone, Copy)]
pub(super) struct DrawnLight {
    pub index: usize,
    pub is_ball: bool,
}

impl LightDraws {
    /// Starts with new primary rays.
    pub fn begin(&mut self) {
        self.used = 0;
    }

    /// Returns the numbers of rays that descend from the primary rays in these lanes. Their number is a multiple of
    /// [`LANES`].
    fn of(
        &mut self,
        cpu: Cpu,
        (samples, are_probes): (&Samples, bool),
        light: DrawnLight,
        lanes: &[u8],
    ) -> Numbers<'_> {
        let Self { kept, used, few, numbers, .. } = self;
        let [x, y, sin] = numbers;
        let count = lanes.len();
        let (x, y, sin) = (resized(x, count), resized(y, count), resized(sin, count));
        let mut place = kept[..*used].iter().position(|(index, _)| *index == light.index);
        if place.is_none() && *used < KEPT && WORTH * count >= samples.len() {
            if *used == kept.len() {
                kept.push((light.index, Box::new([[0.0; PACKET_SIZE]; 3])));
            }
            let (index, numbers) = &mut kept[*used];
            *index = light.index;
            let [x, y, sin] = &mut **numbers;
            write(cpu, (samples, are_probes), light, [x, y, sin]);
            place = Some(*used);
            *used += 1;
        }
        match place {
            Some(place) => {
                let [from_x, from_y, from_sin] = &*kept[place].1;
                for (lane, primary) in lanes.iter().enumerate() {
                    x[lane] = from_x[usize::from(*primary)];
                    y[lane] = from_y[usize::from(*primary)];
                }
                if light.is_ball {
                    for (lane, primary) in lanes.iter().enumerate() {
                        sin[lane] = from_sin[usize::from(*primary)];
                    }
                }
            }
            None => {
                few.gather(samples, lanes);
                write(cpu, (few, are_probes), light, [&mut *x, &mut *y, &mut *sin]);
            }
        }
        [x, y, sin]
    }
}

/// Writes the numbers of samples. For a ball of light, there is room for a multiple of [`LANES`] of them.
fn write(cpu: Cpu, (samples, are_probes): (&Samples, bool), light: DrawnLight, [x, y, sin]: Numbers) {
    if are_probes {
        x.fill(1.0);
        let turns = samples.pixels().iter().map(|point| f64::from(*point) / RIM_POINTS);
        y.iter_mut().zip(turns).for_each(|(y, turn)| *y = turn);
    } else {
        sample::on_lights(cpu, samples, light.index, x, y);
    }
    if light.is_ball {
        let count = samples.len().next_multiple_of(LANES);
        sample::to_polar(cpu, &mut x[..count], &mut y[..count], &mut sin[..count]);
    }
}

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Returns two numbers from 0 to 1 for each ray of a packet, by which the primary ray's sample chooses a point of an area
    /// of light; `None` where pixels have one sample.
    pub(super) fn draw<'d>(
        &self,
        index: usize,
        group: &RayGroup,
        draws: &'d mut LightDraws,
    ) -> Option<impl Fn(usize) -> DVec2 + use<'d, W>> {
        let are_probes = self.scratch.are_probes;
        let [x, y, _] = self.drawn(DrawnLight { index, is_ball: false }, group, draws)?;
        Some(move |lane: usize| {
            let numbers = DVec2::new(x[lane], y[lane]);
            if are_probes { on_edge(numbers.y) } else { numbers }
        })
    }

    /// Returns the point of a ball of light that each point of a surface sees: on the disc around its centre that faces the
    /// point, where the primary ray's sample chooses; `None` where pixels have one sample, and see the centre.
    pub(super) fn draw_on_ball<'d>(
        &self,
        light: &dyn PacketLight,
        index: usize,
        group: &RayGroup,
        surface: &Surface,
        draws: &'d mut LightDraws,
    ) -> Option<View<'d>> {
        let count = group.padded();
        self.drawn(DrawnLight { index, is_ball: true }, group, draws)?;
        let LightDraws { numbers: [distance, cos, sin], lights, .. } = draws;
        let points = surface.points.view(count);
        on_ball(self.cpu, light.location(), light.size(), points, distance, cos, sin, lights.resized(count));
        Some(lights.view(count))
    }

    /// Returns the numbers of the rays of a packet, if pixels have several samples.
    fn drawn<'d>(
        &self,
        light: DrawnLight,
        group: &RayGroup,
        draws: &'d mut LightDraws,
    ) -> Option<Numbers<'d>> {
        let samples = (&self.scratch.samples, self.scratch.are_probes);
        let lanes = &group.camera[..group.camera.len().min(group.padded())];
        (!samples.0.is_empty()).then(|| draws.of(self.cpu, samples, light, lanes))
    }
}

kernels! {
    /// Writes points of a ball of light: for each point of a surface, that on the disc around the middle, facing it, at a
    /// distance from the middle, in radii, and an angle.
    fn on_ball(
        middle: DVec3, radius: f64, points: View, distance: &[f64], cos: &[f64], sin: &[f64]
    ) => lights {
        let (count, mut lights) = (points.len(), lights.first(points.len()));
        let (distance, cos, sin) = (&distance[..count], &cos[..count], &sin[..count]);
        for lane in 0..count {
            let between = middle - points.get(lane);
            let inverse = between.length_recip();
            let (across, up) = (between * inverse).any_orthonormal_pair();
            let at = middle + radius * distance[lane] * (cos[lane] * across + sin[lane] * up);
            // A point in the middle of the light sees the middle.
            let is_apart = (inverse > 0.0) & (inverse < f64::INFINITY);
            lights.set(lane, if is_apart { at } else { middle });
        }
    }
}

/// Returns a point on the edge of the unit square, by a part of a turn around it.
fn on_edge(turn: f64) -> DVec2 {
    let side = 4.0 * turn.rem_euclid(1.0);
    let along = side.fract();
    match side as u32 {
        0 => DVec2::new(along, 0.0),
        1 => DVec2::new(1.0, along),
        2 => DVec2::new(1.0 - along, 1.0),
        _ => DVec2::new(0.0, 1.0 - along),
    }
}
