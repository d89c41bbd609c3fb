//! Inverse quadratic interpolation through the last three places where it is reliable, and bisection elsewhere.
//!
//! T. R. Chandrupatla, "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without
//! using derivatives" (1997). It takes few evaluations among methods without derivatives. With derivatives, Newton's
//! method takes half as many.

/// Returns the root between two places with different signs of the function, to within the tolerance.
pub fn root(f: impl Fn(f64) -> f64, (low, high): (f64, f64), tolerance: f64) -> f64 {
    const MAX_STEPS: usize = 200;
    // `a` is the last place, `b` the one on the other side of the root, and `c` the one before.
    let (mut a, mut b) = (low, high);
    let (mut at_a, mut at_b) = (f(a), f(b));
    let mut part = 0.5;
    for _ in 0..MAX_STEPS {
        let t = a + part * (b - a);
        let at_t = f(t);
        let (c, at_c);
        if (at_t >= 0.0) == (at_a >= 0.0) {
            (c, at_c) = (a, at_a);
        } else {
            (c, at_c) = (b, at_b);
            (b, at_b) = (a, at_a);
        }
        (a, at_a) = (t, at_t);
        let best = if at_a.abs() < at_b.abs() { a } else { b };
        let min_part = 0.5 * tolerance / (b - a).abs();
        if min_part > 0.5 || at_a == 0.0 || !min_part.is_finite() {
            return best;
        }
        let (across, up) = ((a - b) / (c - b), (at_a - at_b) / (at_c - at_b));
        part = if up * up < across && (1.0 - up) * (1.0 - up) < 1.0 - across {
            at_a / (at_b - at_a) * at_c / (at_b - at_c)
                + (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        } else {
            0.5
        };
        part = part.clamp(min_part, 1.0 - min_part);
    }
    a
}
