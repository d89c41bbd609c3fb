//! The random numbers of a pixel's samples: the same for any number of threads.

use crate::named;
use crate::simd::cpu::{Cpu, kernels};
use glam::DVec2;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use sobol_burley::parts;
use std::array;
use std::f64::consts::TAU;
use std::sync::LazyLock;

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
    pub const MOST: u32 = 1 << 16;
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
        on_disc(self.draw(ON_LENS))
    }

    /// Returns two numbers from 0 to 1, which choose a facet of a rough surface after this many rays of a path.
    pub(crate) fn on_facet(&self, depth: u32) -> DVec2 {
        self.draw(ON_FACETS - depth)
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

    /// Returns the seed that scrambles the pixel's sequence. Purposes differ in their seed, not in their dimension, so
    /// that any number of lights has a sequence.
    fn seed(&self, purpose: u32) -> u32 {
        self.pixel ^ purpose.wrapping_mul(0x9e37_79b9)
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

/// Returns the point of the unit disc that two numbers from 0 to 1 choose, uniformly by area.
pub(crate) fn on_disc(numbers: DVec2) -> DVec2 {
    let (sin, cos) = libm::sincos(TAU * numbers.y);
    numbers.x.sqrt() * DVec2::new(cos, sin)
}

/// Writes the [`jitter`](Sample::jitter) of each sample, in pixels, to `x` and `y`.
pub(crate) fn jitters(cpu: Cpu, samples: &[Sample], x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, JITTER, x, y);
    for (x, y) in x.iter_mut().zip(y) {
        *x -= 0.5;
        *y -= 0.5;
    }
}

/// Writes what [`on_light`](Sample::on_light) returns for each sample to `x` and `y`.
pub(crate) fn on_lights(cpu: Cpu, samples: &[Sample], light: usize, x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, on_light(light), x, y);
}

/// Writes what [`on_lens`](Sample::on_lens) returns for each sample to `x` and `y`.
pub(crate) fn on_lenses(cpu: Cpu, samples: &[Sample], x: &mut [f64], y: &mut [f64]) {
    draw(cpu, samples, ON_LENS, x, y);
    for (x, y) in x.iter_mut().zip(y) {
        DVec2 { x: *x, y: *y } = on_disc(DVec2::new(*x, *y));
    }
}

/// Writes the point of the lens's rim at a fraction of a turn, for each.
pub(crate) fn on_rim(turns: impl Iterator<Item = f64>, x: &mut [f64], y: &mut [f64]) {
    for ((turn, x), y) in turns.zip(x).zip(y) {
        DVec2 { x: *x, y: *y } = on_disc(DVec2::new(1.0, turn));
    }
}

/// Writes the numbers that [`Sample::draw`] returns for each sample. All samples have the sampler of the first.
// Its arrays stay off the stacks of deep reflections.
#[inline(never)]
fn draw(cpu: Cpu, samples: &[Sample], purpose: u32, x: &mut [f64], y: &mut [f64]) {
    const CHUNK: usize = 64;
    let (mut index, mut seed) = ([0; CHUNK], [0; CHUNK]);
    for ((samples, x), y) in samples.chunks(CHUNK).zip(x.chunks_mut(CHUNK)).zip(y.chunks_mut(CHUNK)) {
        if samples[0].sampler != Sampler::Sobol {
            for ((sample, x), y) in samples.iter().zip(x).zip(y) {
                DVec2 { x: *x, y: *y } = sample.draw(purpose);
            }
            continue;
        }
        for ((sample, index), seed) in samples.iter().zip(&mut index).zip(&mut seed) {
            (*index, *seed) = (sample.index, sample.seed(purpose));
        }
        let count = samples.len();
        sobol(cpu, &DIRECTIONS, &index[..count], &seed[..count], x, y);
    }
}

/// The direction numbers of dimension 1, with reversed bits, for the bits of an index from the highest of 16 down; those
/// of dimension 0 are the powers of 2.
static DIRECTIONS: LazyLock<[u32; 16]> =
    LazyLock::new(|| array::from_fn(|bit| parts::sobol_rev(1 << (31 - bit), 1)));

kernels! {
    /// Computes dimensions 0 and 1 of `sobol_burley::sample` with the same operations, in lanes.
    fn sobol(directions: &[u32; 16], index: &[u32], seed: &[u32], x: &mut [f64], y: &mut [f64]) {
        let count = index.len();
        let (seed, x, y) = (&seed[..count], &mut x[..count], &mut y[..count]);
        for lane in 0..count {
            let shuffled =
                parts::owen_scramble_rev(index[lane].reverse_bits(), parts::hash(seed[lane] ^ 0x79c6_8e4a));
            let mut second = 0;
            for (bit, direction) in directions.iter().enumerate() {
                second ^= direction & 0_u32.wrapping_sub(shuffled >> (31 - bit) & 1);
            }
            let first = (shuffled & 0xffff_0000).reverse_bits();
            let scramble = seed[lane].wrapping_mul(0x9c8f_2d3b);
            let number = |sobol, salt: u32| {
                let scrambled = parts::owen_scramble_rev(sobol, parts::hash(scramble ^ salt));
                f64::from(parts::u32_to_f32_norm(scrambled.reverse_bits()))
            };
            (x[lane], y[lane]) = (number(first, 0x912f_69ba), number(second, 0x174f_18ab));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_many_lanes_are_those_of_single_ones() {
        let pixels = [0, 1, 639, 307_199, 0x7fff_ffff, u32::MAX];
        for sampler in [Sampler::Sobol, Sampler::Random] {
            let samples: Vec<_> = (0..Sampler::MOST)
                .map(|index| Sample {
                    sampler,
                    index,
                    pixel: pixels[index as usize / 7 % pixels.len()] ^ index >> 9,
                })
                .collect();
            let single = |draw: &dyn Fn(&Sample) -> DVec2| samples.iter().map(draw).collect::<Vec<_>>();
            let (places, light) = (single(&Sample::jitter), single(&|sample| sample.on_light(3)));
            let lens = single(&Sample::on_lens);
            for cpu in Cpu::all() {
                // Other counts than whole chunks, too.
                for count in [samples.len(), 1, 67] {
                    let [mut x, mut y] = [vec![2.0; count], vec![2.0; count]];
                    let pairs = |x: &[f64], y: &[f64]| -> Vec<_> {
                        x.iter().zip(y).map(|(x, y)| DVec2::new(*x, *y)).collect()
                    };
                    jitters(cpu, &samples[..count], &mut x, &mut y);
                    assert!(pairs(&x, &y) == places[..count], "{sampler:?}, {cpu}");
                    on_lights(cpu, &samples[..count], 3, &mut x, &mut y);
                    assert!(pairs(&x, &y) == light[..count], "{sampler:?}, {cpu}");
                    on_lenses(cpu, &samples[..count], &mut x, &mut y);
                    assert!(pairs(&x, &y) == lens[..count], "{sampler:?}, {cpu}");
                }
            }
        }
    }
}
