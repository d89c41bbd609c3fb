//! Newton's method that cannot leave its bracket.

/// The root between `a` and `b`, where `f` has opposite signs and gives its value and its slope; it is positive at
/// `a` where `sign` is. Starts at `x`, halves the bracket where a step would leave it, and stops where a step is
/// below `tolerance` or predicts that the next one will be: steps shrink with their square.
#[inline(always)]
pub fn root(
    f: impl Fn(f64) -> (f64, f64),
    (mut a, mut b): (f64, f64),
    sign: f64,
    mut x: f64,
    tolerance: f64,
) -> f64 {
    const MOST: usize = 100;
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == (sign > 0.0) {
            a = x;
        } else {
            b = x;
        }
        let next = x - value / slope;
        // Written so that what is not a number is outside.
        if !(next > a.min(b) && next < a.max(b)) {
            let middle = 0.5 * (a + b);
            if middle == a || middle == b {
                return x;
            }
            (x, last_step) = (middle, f64::INFINITY);
            continue;
        }
        let step = (next - x).abs();
        x = next;
        let predicted = step * (step / last_step) * (step / last_step);
        if step <= tolerance || predicted <= 0.25 * tolerance && last_step.is_finite() {
            return x;
        }
        last_step = step;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_the_last_place() {
        let cube = |x: f64| (x * x * x - 2.0, 3.0 * x * x);
        assert_eq!(root(cube, (0.0, 2.0), -1.0, 1.9, 1e-16), 2.0_f64.cbrt());
    }

    #[test]
    fn a_step_out_of_the_bracket_halves_it() {
        // Newton alone swings ever wider around the root of this one.
        let flat = |x: f64| (x.atan(), 1.0 / (1.0 + x * x));
        assert!(root(flat, (-30.0, 40.0), -1.0, 40.0, 1e-16).abs() < 1e-15);
        let kink = |x: f64| if x < 1.0 { (-1.0, 0.0) } else { (1.0, 0.0) };
        assert!((root(kink, (0.0, 3.0), -1.0, 2.0, 1e-16) - 1.0).abs() < 1e-15);
    }
}
