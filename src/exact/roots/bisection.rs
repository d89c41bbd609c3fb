//! Bisection between two places with different values of a predicate.
//!
//! Each evaluation gives one binary digit, whatever the function. Signs are compared directly, because products may
//! underflow. Bisection ends if there is no number between the places.

/// Returns the last place where the predicate is false and the first where it is true. It is false at `low` and true at
/// `high`. The two places are at most `tolerance` apart, or neighbouring numbers.
pub fn bisect(is_true: impl Fn(f64) -> bool, (mut low, mut high): (f64, f64), tolerance: f64) -> (f64, f64) {
    while high - low > tolerance {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if is_true(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    (low, high)
}

/// Returns the root between two places, to within the tolerance. If `falls`, the function is positive at the first.
pub fn root(f: impl Fn(f64) -> f64, ends: (f64, f64), falls: bool, tolerance: f64) -> f64 {
    let has_crossed = |t: f64| (f(t) >= 0.0) != falls;
    let (low, high) = bisect(has_crossed, ends, tolerance);
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_ends_where_it_is_near_enough_or_no_number_lies_between() {
        let (low, high) = bisect(|t| t * t >= 2.0, (1.0, 2.0), 0.0);
        assert_eq!((low.next_up(), high), (high, 2.0_f64.sqrt()));
        assert_eq!(bisect(|t| t >= 0.3, (0.0, 1.0), 0.25), (0.25, 0.5));
        assert_eq!(bisect(|t| t >= 3e17, (1e17, 1e17_f64.next_up()), 1.0), (1e17, 1e17_f64.next_up()));
    }
}
