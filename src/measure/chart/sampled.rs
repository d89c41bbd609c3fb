//! Errors of sampled pixels, and what they say about the whole image.

use super::betting::Drawn;
use super::small::Missed;
use tabray_core::world::material::Rgb;
use tabray_tools::sampling::error::{PixelError, WORST};
use tabray_tools::sampling::right::Right;

/// The probability with which a promise may be wrong.
const DOUBT: f64 = 0.01;

/// Returns the allowed probability that one part of one of `bounds` bounds is wrong. There are two parts: the pixels
/// that are not measured, and the noise of the right colours.
pub(super) fn doubt_of_each(bounds: usize) -> f64 {
    0.5 * DOUBT / bounds as f64
}

/// Returns the number of standard deviations that a normal distribution exceeds with a probability of at most
/// `doubt`. Bounds allow this many for the noise of the right colours.
fn deviations(doubt: f64) -> f64 {
    (-2.0 * libm::log(doubt)).sqrt()
}

/// The maximum number of choices whose bounds are compared where all pixels are measured.
const COMPARED: usize = 128;

/// Bounds the error of an image of which all pixels are measured, first those that may show small things.
pub(super) fn bound_of_all(errors: &[PixelError], missed: &Missed, worst: bool) -> f64 {
    let (small, rest) = errors.split_at(missed.pixels.len());
    let [small, rest] = [small, rest].map(|errors| Errors { choices: vec![errors.to_vec()] });
    let image = Image { all: errors.len(), small: &small, missed };
    rest.bounds(0, image, worst, doubt_of_each(COMPARED))[1]
}

/// The errors of pixels, for several choices.
#[derive(Clone)]
pub(super) struct Errors {
    choices: Vec<Vec<PixelError>>,
}

/// The pixels of an image, of which some are measured.
#[derive(Clone, Copy)]
pub(super) struct Image<'i> {
    /// The number of its pixels.
    pub all: usize,
    /// The errors of all pixels that may show things smaller than a sample, for the same choices.
    pub small: &'i Errors,
    /// Bounds on things missed in the pixels that may show something small.
    pub missed: &'i Missed,
}

impl Errors {
    pub fn new(choices: usize) -> Self {
        Self { choices: vec![Vec::new(); choices] }
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> usize {
        self.choices[0].len()
    }

    /// Returns the errors of a choice.
    pub fn of(&self, choice: usize) -> &[PixelError] {
        &self.choices[choice]
    }

    /// Returns the mean of the fourth powers of a choice's errors.
    pub fn fourth(&self, choice: usize) -> f64 {
        self.choices[choice].iter().map(|error| error.careful.powi(2)).sum::<f64>() / self.pixels() as f64
    }

    /// Adds pixels: for each choice their colours, and the right ones.
    pub fn add(&mut self, choices: &[Vec<Rgb>], right: &[Right]) {
        for (errors, colours) in self.choices.iter_mut().zip(choices) {
            errors.extend(colours.iter().zip(right).map(|(colour, right)| PixelError::new(*colour, *right)));
        }
    }

    /// Tells how large the errors of the last pixels are to be expected, of each for all choices: their mean squares over
    /// images of other samples. Those of a single sample, at the centre of its pixel, are what they are.
    pub fn expect(&mut self, samples: &[u32], pixels: &[Vec<f64>]) {
        for (index, (errors, samples)) in self.choices.iter_mut().zip(samples).enumerate() {
            let last = errors.len() - pixels.len();
            for (error, pixel) in errors[last..].iter_mut().zip(pixels).filter(|_| *samples > 1) {
                error.expected = pixel[index];
            }
        }
    }

    /// Returns the error of a choice and an upper bound for the image: the root of the mean square, or with `worst`
    /// the 99.9th percentile. The pixels have been drawn at random from those of the image that are not small ones.
    /// The conclusion about the others is wrong with a probability of at most `doubt`.
    pub fn bounds(&self, choice: usize, image: Image, worst: bool, doubt: f64) -> [f64; 2] {
        if worst {
            return self.percentile(choice, image, doubt);
        }
        let (errors, small) = (&self.choices[choice], &image.small.choices[choice]);
        let all = image.all as f64;
        let rest = image.all - image.missed.pixels.len();
        let squares: Vec<_> = errors.iter().map(|error| error.careful).collect();
        let [mean, most] = if squares.is_empty() {
            [0.0; 2]
        } else {
            let drawn = Drawn { numbers: &squares, all: rest };
            [squares.iter().sum::<f64>() / squares.len() as f64, drawn.bound(doubt)]
        };
        let of_small: f64 = small.iter().map(|error| error.careful).sum();
        let noise = errors.iter().chain(small).map(|error| error.noise).sum::<f64>().sqrt();
        // Where all pixels are known, this alone accounts for the noise of the right colours.
        let known = if errors.len() >= rest { &errors[..] } else { &[] };
        let spread: f64 = known.iter().chain(small).map(|error| error.spread).sum();
        let root = |square: f64| square.max(0.0).sqrt();
        let error = root((rest as f64 * mean + of_small) / all);
        let bound = root((rest as f64 * most + of_small + spread + deviations(doubt) * noise) / all)
            + image.missed.error(image.all);
        [error, bound.max(error)]
    }

    /// Returns the error that one of a thousand pixels exceeds, and an upper bound for the image: an error that more
    /// pixels exceed than chance explains.
    fn percentile(&self, choice: usize, image: Image, doubt: f64) -> [f64; 2] {
        let sorted = |errors: &mut dyn Iterator<Item = f64>| {
            let mut errors: Vec<_> = errors.collect();
            errors.sort_unstable_by(|one, other| other.total_cmp(one));
            errors
        };
        let errors = sorted(&mut self.choices[choice].iter().map(|error| error.worst));
        let small = &image.small.choices[choice];
        let known = sorted(&mut small.iter().map(|error| error.worst));
        let most = if small.is_empty() {
            vec![1.0; image.missed.pixels.len()]
        } else {
            sorted(&mut small.iter().zip(&image.missed.pixels).map(|(error, missed)| error.worst + missed))
        };
        let rest = image.all - image.missed.pixels.len();
        // If `above` of the small pixels exceed the percentile, this part of the others may exceed it.
        let allowed = (WORST * image.all as f64) as usize;
        let percentile = |small: &[f64], of_rest: &dyn Fn(f64) -> f64| {
            let least = |above: usize| {
                let part = (allowed - above) as f64 / rest.max(1) as f64;
                small.get(above).map_or(0.0, |error| *error).max(of_rest(part))
            };
            (0..=allowed.min(small.len())).map(least).fold(f64::INFINITY, f64::min)
        };
        let at = |place: usize| errors.get(place).copied().unwrap_or(0.0);
        let error = percentile(&known, &|part| at((part * errors.len() as f64) as usize));
        let count = errors.len() as f64;
        let bound = percentile(&most, &|part| {
            if errors.len() >= rest {
                return at((part * count) as usize);
            }
            // The probability that at most `above` of the pixels exceed the true percentile.
            let (mut term, mut sum, mut above) = (libm::exp(-part * count), 0.0, 0);
            loop {
                sum += term;
                if sum > doubt {
                    break;
                }
                above += 1;
                term *= part * count / f64::from(above);
            }
            // Where even the largest error may well be below the percentile, nothing is known.
            (above as usize).checked_sub(1).map_or(f64::INFINITY, at)
        });
        [error, bound]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(of: impl Iterator<Item = f64>) -> Errors {
        let mut errors = Errors::new(1);
        let colours: Vec<_> = of.map(Rgb::splat).collect();
        let right = vec![[Rgb::ZERO; 2]; colours.len()];
        errors.add(&[colours], &right);
        errors
    }

    fn bounds(errors: &Errors, all: usize, worst: bool) -> [f64; 2] {
        let image = Image { all, small: &Errors::new(1), missed: &Missed::default() };
        errors.bounds(0, image, worst, DOUBT)
    }

    #[test]
    fn bounds_are_the_errors_where_all_pixels_are_known() {
        let errors = errors((0..1000).map(|pixel| f64::from(u8::from(pixel % 10 == 0))));
        let [error, bound] = bounds(&errors, 1000, false);
        assert!((error - 0.1_f64.sqrt()).abs() < 1e-12 && (bound - error).abs() < 1e-12, "{error} {bound}");
        let [error, bound] = bounds(&errors, 100_000, false);
        assert!(bound > 1.1 * error && bound < 1.3 * error, "{error} {bound}");
        assert_eq!(bounds(&errors, 1000, true), [1.0; 2]);
    }

    #[test]
    fn what_small_things_may_hide_is_added_to_the_error_of_all() {
        let (rest, small) = (errors((0..900).map(|_| 0.0)), errors((0..100).map(|_| 0.1)));
        let missed = Missed { pixels: vec![0.05; 100], largest: 0.0 };
        let [error, bound] =
            rest.bounds(0, Image { all: 1000, small: &small, missed: &missed }, false, DOUBT);
        assert!((error - 0.1 * 0.1_f64.sqrt()).abs() < 1e-12, "{error}");
        assert!((bound - error - missed.error(1000)).abs() < 1e-12 && bound > 1.2 * error, "{bound}");
    }

    #[test]
    fn the_worst_pixels_are_bounded_by_those_that_are_known_if_these_are_many() {
        let known = |count: u32| errors((0..count).map(|pixel| f64::from(pixel) / f64::from(count)));
        assert_eq!(bounds(&known(4000), 1 << 20, true)[1], f64::INFINITY);
        let [error, bound] = bounds(&known(8000), 1 << 20, true);
        assert!(error < 0.9991 && bound > error && bound < 1.0, "{error} {bound}");
    }
}
