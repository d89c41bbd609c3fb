//! The error of a pixel, and of an image of which some pixels are measured.

use super::right::Right;
use super::strata::Drawn;
use tabray_core::world::material::Rgb;

/// The part of the pixels that may be worse than the error of the worst pixels.
pub const WORST: f64 = 0.001;

/// The number of standard deviations that a normally distributed number exceeds with a probability of 5 %.
const DEVIATIONS: f64 = 1.644_853_626_951_472_7;

/// The error of a pixel.
#[derive(Clone, Copy)]
pub struct PixelError {
    /// The mean square of the channels' errors, estimated by the two right colours: its expectation is the true one,
    /// since their errors are independent. It may be below 0.
    pub square: f64,
    /// What `square` is on average over images of other samples, as far as that is known better: where a few pixels of an
    /// image meet a highlight, others would in another image.
    pub expected: f64,
    /// An estimate of the mean square that is larger than `square` where a channel is white: clamping to white darkens
    /// the mean of samples, in all images alike.
    pub careful: f64,
    /// A bound on the mean square of the right colours' own errors, in expectation.
    pub spread: f64,
    /// The variance that the right colours' noise gives `square`.
    pub noise: f64,
    /// The largest channel's error.
    pub worst: f64,
}

impl PixelError {
    /// Compares a colour with the right ones, all as they are shown.
    pub fn new(colour: Rgb, [one, other]: Right) -> Self {
        let (off, apart) = (colour - 0.5 * (one + other), one - other);
        let spread = 0.25 * apart * apart;
        let is_white = |channel: &usize| colour[*channel].max(one[*channel]).max(other[*channel]) >= 1.0;
        let of_white = (0..3).filter(is_white).map(|channel| spread[channel]).sum::<f64>() / 3.0;
        let [of_colours, spread] = [off * off, spread].map(|squares| squares.element_sum() / 3.0);
        let square = of_colours - spread;
        Self {
            square,
            expected: square,
            careful: square + of_white,
            spread,
            noise: 4.0 * (of_colours + spread) * spread,
            worst: off.abs().max_element(),
        }
    }
}

/// A measured number, and one that the true number exceeds with a probability of 5 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The number.
    pub mean: f64,
    /// The upper limit.
    pub most: f64,
}

impl Drawn<'_> {
    /// Measures the root mean square error of the image's channels, by the errors of the pixels.
    pub fn rms(&self, errors: &[PixelError]) -> Measured {
        let mut counts = vec![0.0; self.strata.sizes.len()];
        self.of[..errors.len()].iter().for_each(|stratum| counts[*stratum] += 1.0);
        // Of a stratum that is measured as a whole, the errors of the image itself are known.
        let is_whole = |stratum: &usize| counts[*stratum] >= self.strata.sizes[*stratum];
        let of = |(error, stratum): (&PixelError, &usize)| {
            [if is_whole(stratum) { error.square } else { error.expected }, error.noise]
        };
        let [mean, variance] = self.mean_of(errors.iter().zip(&self.of).map(of));
        let (mean, off) = (mean.max(0.0), DEVIATIONS * variance.sqrt());
        // Squares are often small and seldom large, and their mean is spread as the exponential of a normal number.
        let most = if off < mean { mean * libm::exp(off / mean) } else { mean + libm::exp(1.0) * off };
        Measured { mean: mean.sqrt(), most: most.min(1.0).sqrt() }
    }

    /// Measures the error that one of a thousand pixels exceeds, by the errors of the pixels.
    pub fn percentile(&self, errors: &[PixelError]) -> Measured {
        let mut sorted: Vec<_> = errors.iter().map(|error| error.worst).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let above = |limit: f64| {
            self.mean_of(errors.iter().map(|error| [f64::from(u8::from(error.worst > limit)), 0.0]))
        };
        let least = |is_below: &dyn Fn([f64; 2]) -> bool| {
            let place = sorted.partition_point(|limit| !is_below(above(*limit)));
            sorted.get(place).copied().unwrap_or(0.0)
        };
        Measured {
            mean: least(&|[part, _]| part <= WORST),
            most: least(&|[part, variance]| part + DEVIATIONS * variance.sqrt() <= WORST),
        }
    }

    /// Returns the mean over the image of a number of each pixel.
    pub fn mean(&self, numbers: impl Iterator<Item = f64>) -> f64 {
        self.mean_of(numbers.map(|number| [number, 0.0]))[0]
    }

    /// Returns the mean over the image of a number of each pixel, and the variance of this mean: that of the drawing, and
    /// where all pixels of a stratum are measured, that of the noise, given with the number.
    fn mean_of(&self, numbers: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
        let mut sums = vec![[0.0; 4]; self.strata.sizes.len()];
        for (stratum, [number, noise]) in self.of.iter().zip(numbers) {
            let [count, sum, squares, noises] = &mut sums[*stratum];
            (*count, *sum) = (*count + 1.0, *sum + number);
            (*squares, *noises) = (*squares + number * number, *noises + noise);
        }
        let (mut mean, mut variance) = (0.0, 0.0);
        for (size, [count, sum, squares, noise]) in self.strata.sizes.iter().zip(sums) {
            if count > 0.0 {
                let [own, noise] = [sum, noise].map(|sum| sum / count);
                let spread = (squares / count - own * own).max(0.0) * count / (count - 1.0).max(1.0);
                let of_drawing = if count < *size { (1.0 - count / size) * spread } else { 0.0 };
                mean += size * own;
                variance += size * size * (of_drawing + noise * (count / size).min(1.0)) / count;
            }
        }
        let all: f64 = self.strata.sizes.iter().sum();
        [mean / all, variance / (all * all)]
    }
}
