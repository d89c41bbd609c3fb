//! The numbers by which the samples of primary rays choose the points of lights that surfaces see.
//!
//! All rays that descend from a primary ray use the same numbers, so these are computed once for each light and each
//! packet of primary rays.

use super::arrays::{VectorList, resized};
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::sample::{self, Samples};
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::LANES;

/// The number of points on the rim of a light, or of a lens, that probes go through.
pub(super) const RIM_POINTS: f64 = 16.0;

/// The maximum number of lights whose numbers are kept, so many lights take little memory.
const KEPT: usize = 16;

/// If at least 1 in this many primary rays needs a light's numbers, they are drawn for all primary rays.
const WORTH: usize = 4;

/// Numbers for each ray: two from 0 to 1 for an area of light; for a ball of light, a distance from the middle of the
/// unit disc, and the cosine and the sine of an angle.
pub(super) type Numbers<'n> = [&'n mut [f64]; 3];

/// The numbers of a packet of primary rays, and those of the rays that are being shaded.
#[derive(Default)]
pub(super) struct LightDraws {
    /// The index of a light, and the numbers of all primary rays for it.
    kept: Vec<(usize, Box<[[f64; PACKET_SIZE]; 3]>)>,
    /// The number of kept lights that hold for the current primary rays.
    used: usize,
    /// The samples of few rays.
    few: Samples,
    pub numbers: [Vec<f64>; 3],
    /// The point of a ball of light that each shading point sees.
    pub lights: VectorList,
}

/// A light whose points the samples choose.
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
    pub fn of(
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
