//! Newton's method safeguarded by a bracket, for one function or for several at once.

use crate::dual::Dual;
use std::array::from_fn;

/// The maximum number of steps. By then, mere bisection has shrunk a bracket by 2^-100.
const MAX_STEPS: usize = 100;

/// `N` functions that are evaluated together. This is a trait because closures are not reliably inlined into kernels.
pub trait Functions<const N: usize> {
    /// Returns the value and the slope of each function, each at its own place.
    fn at(&self, places: [f64; N]) -> ([f64; N], [f64; N]);
}

impl<F: Fn(f64) -> Dual> Functions<1> for F {
    #[inline(always)]
    fn at(&self, [place]: [f64; 1]) -> ([f64; 1], [f64; 1]) {
        let Dual { value, slope } = self(place);
        ([value], [slope])
    }
}

/// The brackets and initial guesses of the roots of `N` functions.
#[derive(Clone, Copy)]
pub struct Start<const N: usize> {
    /// The lower ends of the brackets.
    pub low: [f64; N],
    /// The upper ends of the brackets, with signs that differ from those at the lower ends. For an upper end that is
    /// not above the lower end, the guess is returned.
    pub high: [f64; N],
    /// 1 for a function that falls across the bracket, -1 for one that rises, and 0 to take the sign from the slope at
    /// the guess.
    pub falls: [f64; N],
    /// The initial guesses.
    pub guess: [f64; N],
    /// The tolerance of the roots, in the unit of the places.
    pub tolerance: f64,
}

/// Returns the root of one function between `low` and `high`, where it falls or rises.
#[inline(always)]
pub fn root(
    f: impl Fn(f64) -> Dual,
    (low, high): (f64, f64),
    falls: bool,
    guess: f64,
    tolerance: f64,
) -> f64 {
    let falls = if falls { 1.0 } else { -1.0 };
    roots(&f, Start { low: [low], high: [high], falls: [falls], guess: [guess], tolerance })[0]
}

/// Returns the root of each function in its bracket. Bisects the bracket if a step would leave it. Stops if a step is
/// below the tolerance, or if quadratic convergence predicts that for the next one.
#[inline(always)]
pub fn roots<const N: usize>(functions: &impl Functions<N>, start: Start<N>) -> [f64; N] {
    let Start { mut low, mut high, mut falls, guess: mut at, tolerance } = start;
    let mut last_step = [f64::INFINITY; N];
    let mut goes_on: [f64; N] = from_fn(|lane| flag(low[lane] < high[lane]));
    for _ in 0..MAX_STEPS {
        let (value, slope) = functions.at(at);
        let mut any = 0;
        for lane in 0..N {
            let (here, value, slope) = (at[lane], value[lane], slope[lane]);
            let falling = if falls[lane] == 0.0 { -1.0_f64.copysign(slope) } else { falls[lane] };
            let is_before = value * falling > 0.0;
            let (below, above) = if is_before { (here, high[lane]) } else { (low[lane], here) };
            let (next, middle) = (here - value / slope, 0.5 * (below + above));
            // The comparisons are false for NaN.
            let is_inside = (next > below) & (next < above);
            let is_stuck = (middle == below) | (middle == above);
            let step = (next - here).abs();
            let shrinks = step / last_step[lane];
            let next_step = step * shrinks * shrinks;
            let is_last =
                (step <= tolerance) | ((next_step <= 0.25 * tolerance) & (last_step[lane] < f64::INFINITY));
            let stays = (goes_on[lane] == 0.0) | (value == 0.0) | (!is_inside & is_stuck);
            (low[lane], high[lane], falls[lane]) = (below, above, falling);
            at[lane] = if stays {
                here
            } else if is_inside {
                next
            } else {
                middle
            };
            last_step[lane] = if is_inside { step } else { f64::INFINITY };
            goes_on[lane] = flag(!stays & !(is_inside & is_last));
            any |= goes_on[lane].to_bits();
        }
        if any == 0 {
            break;
        }
    }
    at
}

/// Returns 1 or 0. Numbers as flags are vectorized with the other numbers.
#[inline(always)]
fn flag(is_so: bool) -> f64 {
    if is_so { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_the_last_place() {
        let cube = |x: f64| Dual { value: x * x * x - 2.0, slope: 3.0 * x * x };
        assert_eq!(root(cube, (0.0, 2.0), false, 1.9, 1e-16), 2.0_f64.cbrt());
    }

    #[test]
    fn a_step_out_of_the_bracket_halves_it() {
        // Newton's method alone diverges on this function.
        let flat = |x: f64| Dual { value: x.atan(), slope: 1.0 / (1.0 + x * x) };
        assert!(root(flat, (-30.0, 40.0), false, 40.0, 1e-16).abs() < 1e-15);
        let kink = |x: f64| Dual { value: if x < 1.0 { -1.0 } else { 1.0 }, slope: 0.0 };
        assert!((root(kink, (0.0, 3.0), false, 2.0, 1e-16) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn several_roots_are_those_that_are_found_one_by_one() {
        struct Powers;
        impl Functions<4> for Powers {
            fn at(&self, x: [f64; 4]) -> ([f64; 4], [f64; 4]) {
                let all: [Dual; 4] = from_fn(|lane| power(lane, x[lane]));
                (all.map(|one| one.value), all.map(|one| one.slope))
            }
        }
        fn power(lane: usize, x: f64) -> Dual {
            let sign = if lane.is_multiple_of(2) { 1.0 } else { -1.0 };
            let exponent = lane as i32 + 2;
            Dual {
                value: sign * (x.powi(exponent) - 3.0),
                slope: sign * f64::from(exponent) * x.powi(exponent - 1),
            }
        }
        let [low, high, guess] = [[0.0; 4], [2.0, 3.0, 2.0, 0.0], [1.0, 1e-3, 2.0, 7.0]];
        let together = roots(&Powers, Start { low, high, falls: [0.0; 4], guess, tolerance: 1e-16 });
        for lane in 0..3 {
            let alone = root(|x| power(lane, x), (low[lane], high[lane]), lane % 2 == 1, guess[lane], 1e-16);
            assert_eq!(together[lane], alone, "{lane}");
            assert!((alone.powi(lane as i32 + 2) - 3.0).abs() < 1e-14, "{lane}: {alone}");
        }
        assert_eq!(together[3], 7.0, "what has no bracket stays as it is guessed");
    }
}
