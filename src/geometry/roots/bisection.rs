//! Halving between two places where the signs differ.
//!
//! One digit in binary for each evaluation, whatever the function. The sign at the first place is remembered, not
//! computed from a product, which underflows; and where no number lies between, it ends.

/// The root between two places, where the function is positive at the first if `falls`.
pub fn root(f: impl Fn(f64) -> f64, (mut low, mut high): (f64, f64), falls: bool, tolerance: f64) -> f64 {
    while high - low > tolerance {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if (f(middle) >= 0.0) == falls {
            low = middle;
        } else {
            high = middle;
        }
    }
    low + 0.5 * (high - low)
}
