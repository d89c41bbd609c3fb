//! Errors of sampled pixels, and what they say about the whole image.

use super::pictures::shown_colours;
use super::places::Pixels;
use super::progress::Progress;
use std::io;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::material::Rgb;

/// The number of standard deviations by which the mean of the squared errors may be off: a normal distribution stays
/// below 2.33 with a confidence of 99 %.
const DEVIATIONS: f64 = 3.0;

/// The factor of the skewness that is added to the deviations, divided by the root of the number of pixels. Few pixels
/// have most of the error, and if too few of these are measured, the deviation is too small as well (N. Johnson,
/// "Modified t tests and confidence intervals for asymmetrical populations", 1978).
const SKEWNESS: f64 = (1.0 + 2.0 * DEVIATIONS * DEVIATIONS) / 6.0;

/// The part of the pixels that may be worse than the error of the worst pixels.
const WORST: f64 = 0.001;

/// The probability with which a bound on the worst pixels may be wrong.
const DOUBT: f64 = 0.01;

/// The colours of some pixels, computed on all threads.
pub(super) struct Colours<'c> {
    pub threads: &'c Renderer,
    pub pixels: &'c Pixels,
    pub progress: &'c mut dyn Progress,
}

impl Colours<'_> {
    /// Computes the pixels with a number of samples.
    pub fn of(&mut self, plan: &mut Plan, samples: u32) -> io::Result<Vec<Rgb>> {
        plan.camera.samples = samples;
        let colours = shown_colours(self.threads, plan, self.pixels);
        match self.progress.done(self.pixels.len() * samples as usize / 10) {
            std::ops::ControlFlow::Continue(()) => Ok(colours),
            std::ops::ControlFlow::Break(()) => Err(io::ErrorKind::Interrupted.into()),
        }
    }
}

/// The errors of pixels, for several choices.
#[derive(Clone)]
pub(super) struct Errors {
    /// For each choice, the mean of the squared errors of each pixel's channels, and the largest error.
    choices: Vec<Vec<[f64; 2]>>,
}

impl Errors {
    pub fn new(choices: usize) -> Self {
        Self { choices: vec![Vec::new(); choices] }
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> usize {
        self.choices[0].len()
    }

    /// Returns the largest error of a choice in any channel.
    pub fn worst(&self, choice: usize) -> f64 {
        self.choices[choice].iter().map(|error| error[1]).fold(0.0, f64::max)
    }

    /// Adds pixels: for each choice their colours, and the true ones.
    pub fn add(&mut self, choices: &[Vec<Rgb>], right: &[Rgb]) {
        for (errors, colours) in self.choices.iter_mut().zip(choices) {
            errors.extend(colours.iter().zip(right).map(|(colour, right)| {
                let apart = (*colour - *right).abs();
                [apart.length_squared() / 3.0, apart.max_element()]
            }));
        }
    }

    /// Returns the error of a choice and an upper bound for the image, whose number of pixels is `all`: the root of the
    /// mean square, or with `worst` the 99.9th percentile.
    pub fn bounds(&self, choice: usize, samples: u32, against: u32, all: usize, worst: bool) -> [f64; 2] {
        let errors = &self.choices[choice];
        // The samples are among those that count as true. If they were independent, the mean square difference would be
        // too small by this factor; for even ones, it is nearer to 1. The centre of a pixel is no such sample.
        let known = if samples == 1 { 1.0 } else { 1.0 - f64::from(samples) / f64::from(against) };
        if worst {
            return self.percentile(choice, all).map(|error| error / known.sqrt());
        }
        let count = errors.len() as f64;
        let mean = errors.iter().map(|error| error[0]).sum::<f64>() / count;
        let moment =
            |power: i32| errors.iter().map(|error| (error[0] - mean).powi(power)).sum::<f64>() / count;
        let deviation = moment(2).sqrt();
        let skewness = if deviation > 0.0 { moment(3) / deviation.powi(3) } else { 0.0 };
        let rest = 1.0 - count / all.max(errors.len()) as f64;
        let deviations = DEVIATIONS + SKEWNESS * (skewness / count.sqrt()).max(0.0);
        let bound = mean + deviations * deviation * (rest / count).sqrt();
        [mean, bound].map(|square| (square / known).sqrt())
    }

    /// Returns the error that one of a thousand pixels exceeds, and an upper bound for the image: an error that so many
    /// of the pixels exceed that it is no accident.
    fn percentile(&self, choice: usize, all: usize) -> [f64; 2] {
        let mut errors: Vec<_> = self.choices[choice].iter().map(|error| error[1]).collect();
        errors.sort_unstable_by(|one, other| other.total_cmp(one));
        let place = (WORST * errors.len() as f64) as usize;
        if errors.len() >= all {
            return [errors[place]; 2];
        }
        // The probability that at most `above` of the pixels exceed the true percentile.
        let count = errors.len() as f64;
        let (mut term, mut sum, mut above) = (libm::exp(-WORST * count), 0.0, 0);
        loop {
            sum += term;
            if sum > DOUBT {
                break;
            }
            above += 1;
            term *= WORST * count / f64::from(above);
        }
        // Where even the largest error may well be below the percentile, nothing is known.
        let bound = (above as usize).checked_sub(1).map_or(f64::INFINITY, |place| errors[place]);
        [errors[place], bound]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(of: impl Iterator<Item = f64>) -> Errors {
        let mut errors = Errors::new(1);
        let colours: Vec<_> = of.map(Rgb::splat).collect();
        let right = vec![Rgb::ZERO; colours.len()];
        errors.add(&[colours], &right);
        errors
    }

    #[test]
    fn bounds_are_the_errors_where_all_pixels_are_known() {
        let errors = errors((0..1000).map(|pixel| f64::from(u8::from(pixel % 10 == 0))));
        let [error, bound] = errors.bounds(0, 1, 256, 1000, false);
        assert!((error - 0.1_f64.sqrt()).abs() < 1e-12 && (bound - error).abs() < 1e-12, "{error} {bound}");
        let [error, bound] = errors.bounds(0, 1, 256, 100_000, false);
        assert!(bound > 1.1 * error && bound < 1.3 * error, "{error} {bound}");
        assert_eq!(errors.bounds(0, 1, 256, 1000, true), [1.0; 2]);
    }

    #[test]
    fn the_worst_pixels_are_bounded_by_those_that_are_known_if_these_are_many() {
        let known = |count: u32| errors((0..count).map(|pixel| f64::from(pixel) / f64::from(count)));
        assert_eq!(known(4000).bounds(0, 1, 256, 1 << 20, true)[1], f64::INFINITY);
        let [error, bound] = known(8000).bounds(0, 1, 256, 1 << 20, true);
        assert!(error < 0.9991 && bound > error && bound < 1.0, "{error} {bound}");
    }
}
