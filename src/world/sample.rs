//! The random numbers of a pixel's samples: the same for any number of threads.

use crate::directions::on_disc;
use crate::named;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::LANES;
use glam::DVec2;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use sobol_burley::parts;
use std::f64::consts::TAU;
use std::ops::Range;
use tabray_exact::f64x8::F64x8;
use tabray_exact::scalar::Scalar;

/// The distribution of a pixel's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampler {
    /// Evenly spread (a Sobol sequence).
    ///
    /// With Owen scrambling (Burley, "Practical Hash-based Owen Scrambling", 2020), different for each pixel.
    #[default]
    Sobol,
    /// Random, as in the course notes.
    ///
    /// Samples are independent of each other.
    Random,
}

named!(Sampler { Sobol => "sobol", Random => "random" });

impl Sampler {
    /// The maximum number of samples per pixel: the length of the sequence of `sobol_burley`.
    pub const MAX_SAMPLES: u32 = 1 << 16;
}

/// The number that scrambles the sequences of an image whose samples must differ from those of a render.
pub const SCRAMBLE: u32 = 0x5bd1_e995;

/// A sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The distribution from which the sample is drawn.
    pub sampler: Sampler,
    /// The sample's index among the pixel's samples, from 0.
    pub index: u32,
    /// A number that tells the pixel's samples from those of others: its index in the image, scrambled; for probes, the
    /// number of a point on the rim of a light.
    pub pixel: u32,
}

impl Sample {
    /// Returns the sample's offset from the pixel's centre, in pixels from -0.5 to 0.5 along each axis.
    pub fn jitter(&self) -> DVec2 {
        self.draw(JITTER) - 0.5
    }

    /// Returns two random numbers from 0 to 1, which choose a point on the light of this index.
    pub fn on_light(&self, light: usize) -> DVec2 {
        self.draw(on_light(light))
    }

    /// Returns the point of the unit disc that chooses a point of the camera's lens.
    pub(crate) fn on_lens(&self) -> DVec2 {
        on_disc(self.draw(ON_LENS)).into()
    }

    /// Returns two numbers from 0 to 1, which choose a facet of a rough surface after this many rays of a path.
    pub fn on_facet(&self, depth: u32) -> DVec2 {
        self.draw(ON_FACETS - depth)
    }

    /// Returns two numbers from 0 to 1, which choose where light goes on from a matt surface after this many rays of a
    /// path.
    pub fn on_scattering(&self, depth: u32) -> DVec2 {
        self.draw(ON_SCATTERING + depth)
    }

    /// Returns two numbers from 0 to 1, which choose how a path goes on after this many rays, and whether it does.
    pub fn on_branching(&self, depth: u32) -> DVec2 {
        self.draw(ON_BRANCHING + depth)
    }

    /// Returns two numbers from 0 to 1, different for each purpose.
    fn draw(&self, purpose: u32) -> DVec2 {
        match self.sampler {
            Sampler::Random => {
                let state = u64::from(self.pixel) << 32 | u64::from(self.index);
                let mut random = Pcg32::new(state, purpose.into());
                let mut draw = || f64::from(random.next_u32()) / f64::from(u32::MAX);
                DVec2::new(draw(), draw())
            }
            Sampler::Sobol => {
                let draw = |dimension| sobol_burley::sample(self.index, dimension, self.seed(purpose)).into();
                DVec2::new(draw(0), draw(1))
            }
        }
    }

    /// Returns the seed that scrambles the pixel's sequence.
    fn seed(&self, purpose: u32) -> u32 {
        self.pixel ^ salt(purpose)
    }
}

/// Returns the number by which the seeds of a purpose differ from those of others. Purposes differ in their seed, not
/// in their dimension, so there are sequences for any number of lights.
fn salt(purpose: u32) -> u32 {
    purpose.wrapping_mul(0x9e37_79b9)
}

/// Samples of one sampler, as an array for each number of a [`Sample`].
#[derive(Clone, Debug, Default)]
pub struct Samples {
    sampler: Sampler,
    index: Vec<u32>,
    pixel: Vec<u32>,
}

impl Samples {
    /// Starts a list of samples of this sampler.
    pub fn begin(&mut self, sampler: Sampler) {
        self.sampler = sampler;
        self.index.clear();
        self.pixel.clear();
    }

    /// Adds a sample, which has the sampler of the list.
    pub fn push(&mut self, Sample { index, pixel, .. }: Sample) {
        self.index.push(index);
        self.pixel.push(pixel);
    }

    /// Adds samples of one pixel.
    #[inline]
    pub fn extend(&mut self, pixel: u32, indices: Range<u32>) {
        self.pixel.resize(self.pixel.len() + indices.len(), pixel);
        self.index.extend(indices);
    }

    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Tells whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// Returns the sample of this place in the list, if there is one.
    pub fn get(&self, place: usize) -> Option<Sample> {
        let (index, pixel) = (*self.index.get(place)?, *self.pixel.get(place)?);
        Some(Sample { sampler: self.sampler, index, pixel })
    }

    /// Returns the numbers of the samples' pixels.
    pub fn pixels(&self) -> &[u32] {
        &self.pixel
    }

    /// Becomes the samples of some places of another list.
    pub fn gather(&mut self, from: &Self, places: &[u8]) {
        self.begin(from.sampler);
        self.index.extend(places.iter().map(|place| from.index[usize::from(*place)]));
        self.pixel.extend(places.iter().map(|place| from.pixel[usize::from(*place)]));
    }
}

/// The purpose of the numbers that choose a place in the pixel.
const JITTER: u32 = 0;

/// Returns the purpose of the numbers that choose a point on the light of this index.
fn on_light(light: usize) -> u32 {
    1 + light as u32
}

/// The purpose of the numbers that choose a point on the camera's lens.
const ON_LENS: u32 = u32::MAX;

/// The purpose of the numbers that choose a facet of the first surface on a path; those after it count downward.
const ON_FACETS: u32 = u32::MAX - 1;

/// The purpose of the numbers that choose where light goes on from the first surface on a path; those after it count
/// upward. There are fewer lights.
const ON_SCATTERING: u32 = 1 << 31;

/// The purpose of the numbers that choose how the first ray of a path goes on; those after it count upward.
const ON_BRANCHING: u32 = 3 << 30;

/// Writes the [`jitter`](Sample::jitter) of each sample, in pixels, to `x` and `y`.
pub fn jitters(cpu: Cpu, samples: &Samples, x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, JITTER, x, y);
    for (x, y) in x.iter_mut().zip(y) {
        *x -= 0.5;
        *y -= 0.5;
    }
}

/// Writes the result of [`on_light`](Sample::on_light) for each sample to `x` and `y`.
pub fn on_lights(cpu: Cpu, samples: &Samples, light: usize, x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, on_light(light), x, y);
}

/// Writes the result of `Sample::on_lens` for each sample to `x` and `y`.
pub fn on_lenses(cpu: Cpu, samples: &Samples, x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, ON_LENS, x, y);
    on_discs(cpu, x, y);
}

/// Writes a point of the lens's rim for each fraction of a turn.
pub fn on_rim(turns: impl Iterator<Item = f64>, x: &mut [f64], y: &mut [f64]) {
    for ((turn, x), y) in turns.zip(x).zip(y) {
        [*x, *y] = on_disc(DVec2::new(1.0, turn));
    }
}

/// Writes the numbers that [`Sample::draw`] returns for each sample.
// Not inlined, so it stays off the stacks of deep reflections.
#[inline(never)]
fn draw(cpu: Cpu, samples: &Samples, purpose: u32, x: &mut [f64], y: &mut [f64]) {
    let Samples { sampler, index, pixel } = samples;
    if *sampler == Sampler::Sobol {
        sobol(cpu, index, pixel, salt(purpose), x, y);
        return;
    }
    for ((index, pixel), (x, y)) in index.iter().zip(pixel).zip(x.iter_mut().zip(y)) {
        let sample = Sample { sampler: *sampler, index: *index, pixel: *pixel };
        DVec2 { x: *x, y: *y } = sample.draw(purpose);
    }
}

kernels! {
    /// Computes dimensions 0 and 1 of `sobol_burley::sample` with the same results, in lanes. `salt` makes seeds of the
    /// numbers of pixels.
    fn sobol(index: &[u32], pixel: &[u32], salt: u32, x: &mut [f64], y: &mut [f64]) {
        let count = index.len();
        let (pixel, x, y) = (&pixel[..count], &mut x[..count], &mut y[..count]);
        for lane in 0..count {
            let seed = pixel[lane] ^ salt;
            let shuffled = parts::owen_scramble_rev(index[lane].reverse_bits(), parts::hash(seed ^ 0x79c6_8e4a));
            let first = (shuffled & 0xffff_0000).reverse_bits();
            let scramble = seed.wrapping_mul(0x9c8f_2d3b);
            let number = |sobol, salt: u32| {
                let scrambled = parts::owen_scramble_rev(sobol, parts::hash(scramble ^ salt));
                f64::from(parts::u32_to_f32_norm(scrambled.reverse_bits()))
            };
            (x[lane], y[lane]) = (number(first, 0x912f_69ba), number(second_dimension(first), 0x174f_18ab));
        }
    }

    /// Moves pairs of numbers from 0 to 1 to the points of the unit disc that they choose, as [`on_disc`] does.
    fn on_discs(x: &mut [f64], y: &mut [f64]) {
        let y = &mut y[..x.len()];
        for first in (0..x.len()).step_by(LANES) {
            let count = LANES.min(x.len() - first);
            let (x, y) = (&mut x[first..][..count], &mut y[first..][..count]);
            let mut turns = [0.0; LANES];
            turns[..count].copy_from_slice(y);
            let (sin, cos) = sin_cos_of_turns(turns);
            for lane in 0..count {
                let radius = x[lane].sqrt();
                (x[lane], y[lane]) = (radius * cos[lane], radius * sin[lane]);
            }
        }
    }

    /// Replaces pairs of numbers from 0 to 1, which choose points of the unit disc, by the points' distances from the
    /// middle and the cosines of their angles. Writes the sines to `sin`.
    pub fn to_polar(x: &mut [f64], y: &mut [f64], sin: &mut [f64]) {
        let count = x.len();
        let (y, sin) = (&mut y[..count], &mut sin[..count]);
        for first in (0..count / LANES * LANES).step_by(LANES) {
            let (x, y) = (&mut x[first..][..LANES], &mut y[first..][..LANES]);
            let mut turns = [0.0; LANES];
            turns.copy_from_slice(y);
            let (sines, cosines) = sin_cos_of_turns(turns);
            y.copy_from_slice(&cosines);
            sin[first..][..LANES].copy_from_slice(&sines);
            for lane in 0..LANES {
                x[lane] = x[lane].sqrt();
            }
        }
    }
}

/// Returns the sines and the cosines of angles, given in turns.
#[inline(always)]
fn sin_cos_of_turns(mut turns: [f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
    for lane in 0..LANES {
        turns[lane] *= TAU;
    }
    let (F64x8(sin), F64x8(cos)) = F64x8(turns).sin_cos();
    (sin, cos)
}

/// Returns the second dimension of a Sobol point, with reversed bits, given its index, which has 16 bits.
///
/// The direction numbers are the rows of Pascal's triangle modulo 2: bit `j` is the sum of the bits of the index whose
/// numbers have all bits of the number `j`. So four steps, one for each bit of these numbers, add them up.
#[inline(always)]
fn second_dimension(index: u32) -> u32 {
    let once = index ^ (index >> 1 & 0x5555);
    let twice = once ^ (once >> 2 & 0x3333);
    let thrice = twice ^ (twice >> 4 & 0x0f0f);
    thrice ^ (thrice >> 8 & 0x00ff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_many_lanes_are_those_of_single_ones() {
        let pixels = [0, 1, 639, 307_199, 0x7fff_ffff, u32::MAX];
        for sampler in [Sampler::Sobol, Sampler::Random] {
            let samples: Vec<_> = (0..Sampler::MAX_SAMPLES)
                .map(|index| Sample {
                    sampler,
                    index,
                    pixel: pixels[index as usize / 7 % pixels.len()] ^ index >> 9,
                })
                .collect();
            let single = |draw: &dyn Fn(&Sample) -> DVec2| samples.iter().map(draw).collect::<Vec<_>>();
            let (places, light) = (single(&Sample::jitter), single(&|sample| sample.on_light(3)));
            let lens = single(&Sample::on_lens);
            let mut list = Samples::default();
            for cpu in Cpu::all() {
                // Other counts than whole chunks, too.
                for count in [samples.len(), 1, 67] {
                    list.begin(sampler);
                    samples[..count].iter().for_each(|sample| list.push(*sample));
                    let [mut x, mut y] = [vec![2.0; count], vec![2.0; count]];
                    let pairs = |x: &[f64], y: &[f64]| -> Vec<_> {
                        x.iter().zip(y).map(|(x, y)| DVec2::new(*x, *y)).collect()
                    };
                    jitters(cpu, &list, &mut x, &mut y);
                    assert!(pairs(&x, &y) == places[..count], "{sampler:?}, {cpu}");
                    on_lights(cpu, &list, 3, &mut x, &mut y);
                    assert!(pairs(&x, &y) == light[..count], "{sampler:?}, {cpu}");
                    on_lenses(cpu, &list, &mut x, &mut y);
                    assert!(pairs(&x, &y) == lens[..count], "{sampler:?}, {cpu}");
                    let mut sin = vec![2.0; count];
                    on_lights(cpu, &list, 3, &mut x, &mut y);
                    to_polar(cpu, &mut x, &mut y, &mut sin);
                    for (lane, drawn) in light[..count / LANES * LANES].iter().enumerate() {
                        let (angle, found) = (TAU * drawn.y, [x[lane], y[lane], sin[lane]]);
                        assert_eq!(
                            found,
                            [drawn.x.sqrt(), libm::cos(angle), libm::sin(angle)],
                            "{drawn}, {cpu}"
                        );
                    }
                }
            }
        }
    }
}
