//! The random numbers of a pixel's samples: the same for any number of threads.

use clap::ValueEnum;
use glam::DVec2;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;

/// Where a pixel's samples lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Sampler {
    /// Evenly spread (a Sobol sequence).
    ///
    /// With Owen scrambling (Burley, "Practical Hash-based Owen Scrambling", 2020), scrambled anew for
    /// each pixel.
    #[default]
    Sobol,
    /// Random, as in the course notes.
    ///
    /// Each sample is drawn for itself.
    Random,
}

impl Sampler {
    /// The most samples that a pixel can have: as far as the sequence of `sobol_burley` goes.
    pub const MOST: u32 = 1 << 16;
}

/// One of several samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// How it is drawn.
    pub sampler: Sampler,
    /// Which of the pixel's samples it is, from 0.
    pub index: u32,
    /// Which pixel, as a number of its own.
    pub pixel: u32,
}

impl Sample {
    /// Its place in the pixel, from -0.5 to 0.5 each way.
    pub fn jitter(&self) -> DVec2 {
        self.draw(0) - 0.5
    }

    /// A place on the light of this index, from 0 to 1 each way.
    pub fn on_light(&self, light: usize) -> DVec2 {
        self.draw(1 + light as u32)
    }

    /// Two numbers from 0 to 1 for each purpose.
    fn draw(&self, purpose: u32) -> DVec2 {
        match self.sampler {
            Sampler::Random => {
                let state = u64::from(self.pixel) << 32 | u64::from(self.index);
                let mut random = Pcg32::new(state, purpose.into());
                let mut draw = || f64::from(random.next_u32()) / f64::from(u32::MAX);
                DVec2::new(draw(), draw())
            }
            Sampler::Sobol => {
                // Purposes differ in their scrambling, so that any number of lights has a sequence.
                let seed = self.pixel ^ purpose.wrapping_mul(0x9e37_79b9);
                let draw = |dimension| sobol_burley::sample(self.index, dimension, seed).into();
                DVec2::new(draw(0), draw(1))
            }
        }
    }
}
