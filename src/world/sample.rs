//! The random numbers of a pixel's samples: the same for any number of threads.

use clap::ValueEnum;
use glam::DVec2;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;

/// How a pixel's samples are distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
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

impl Sampler {
    /// The maximum number of samples per pixel: the length of the sequence of `sobol_burley`.
    pub const MOST: u32 = 1 << 16;
}

/// One of several samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// How the sample is drawn.
    pub sampler: Sampler,
    /// The sample's index among the pixel's samples, from 0.
    pub index: u32,
    /// The pixel's index in the image.
    pub pixel: u32,
}

impl Sample {
    /// Returns the sample's offset from the pixel's centre, in pixels from -0.5 to 0.5 along each axis.
    pub fn jitter(&self) -> DVec2 {
        self.draw(0) - 0.5
    }

    /// Returns two random numbers from 0 to 1 that choose a point on the light of this index.
    pub fn on_light(&self, light: usize) -> DVec2 {
        self.draw(1 + light as u32)
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
                // Purposes differ in their scrambling, not in their dimension, so that any number of lights has a
                // sequence.
                let seed = self.pixel ^ purpose.wrapping_mul(0x9e37_79b9);
                let draw = |dimension| sobol_burley::sample(self.index, dimension, seed).into();
                DVec2::new(draw(0), draw(1))
            }
        }
    }
}
