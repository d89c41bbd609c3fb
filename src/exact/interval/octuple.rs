//! Numbers in the format `binary256` of IEEE 754: 237 bits, and exponents up to 2^262143. Squares and fourth powers of a
//! scene's numbers do not overflow.

use ::f256::{consts, f256};

/// Returns one of the two neighbouring `f64`, or infinity if the number is too large.
pub(crate) fn to_f64(of: f256) -> f64 {
    if of.is_nan() || of.is_infinite() {
        return if of.is_nan() { f64::NAN } else { f64::INFINITY.copysign(sign(of)) };
    }
    let (_, exponent, (high, low)) = of.as_sign_exp_signif();
    // Both halves are rounded to nearest, and so is their sum. The lower half is below the upper half's last bit.
    let magnitude = libm::ldexp(high as f64, 128) + low as f64;
    libm::ldexp(magnitude, exponent).copysign(sign(of))
}

/// Widens by eight ulps: the errors of the crate's functions are assumed to be within seven.
/// `wide_intervals_hold_the_right_results` tests this.
pub(crate) fn around(low: f256, high: f256) -> (f256, f256) {
    let steps = |of: f256| f256::from(8.0) * of.abs() * f256::EPSILON;
    ((low - steps(low)).next_down(), (high + steps(high)).next_up())
}

/// Returns the sines and the cosines of two angles in radians.
pub(crate) fn sines([one, other]: [f256; 2]) -> ([f256; 2], [f256; 2]) {
    let sin = |of: f256| if is_small(of) { of } else { of.sin() };
    // The crate's combined function takes longer than two separate ones.
    let (sine, cosine) = (sin(one), one.cos());
    if one == other {
        return ([sine; 2], [cosine; 2]);
    }
    ([sine, sin(other)], [cosine, other.cos()])
}

/// Returns the tangent of an angle in radians.
pub(crate) fn tan(angle: f256) -> f256 {
    if is_small(angle) { angle } else { angle.tan() }
}

/// Returns the natural logarithm of a nonnegative number. The logarithm of 0 is negative infinity.
pub(crate) fn ln(of: f256) -> f256 {
    if of.eq_zero() { f256::NEG_INFINITY } else { of.ln() }
}

/// Of numbers that are near each other, the second power follows from the first: `e^d` is less than `1 + d + d^2` for
/// small d. Four ulps cover the rounding.
pub(crate) fn exps(low: f256, high: f256) -> (f256, f256) {
    let (below, apart) = (low.exp(), high - low);
    match apart {
        _ if apart.eq_zero() => (below, below),
        _ if apart <= f256::from(NEAR) => {
            let four = f256::from(4.0) * f256::EPSILON;
            (below, below * (f256::ONE + apart + apart * apart + four))
        }
        _ => (below, high.exp()),
    }
}

/// Of numbers that are near each other, the second logarithm follows from the first: that of `1 + d` is less than d.
/// Sixteen ulps cover the rounding.
pub(crate) fn lns(low: f256, high: f256) -> (f256, f256) {
    let (below, apart) = (ln(low), high - low);
    match apart {
        _ if apart.eq_zero() => (below, below),
        _ if apart <= f256::from(NEAR) * low => {
            let above = apart / low;
            let rounding = f256::from(16.0) * f256::EPSILON * (below.abs() + above);
            (below, below + above + rounding)
        }
        _ => (below, ln(high)),
    }
}

/// Returns the angle in radians, from -π to π, from the positive x axis to the point with this y.
pub(crate) fn atan2(y: f256, x: f256) -> f256 {
    // The crate's angles are wrong if an argument is infinite, if both are equally large, and for -0.
    let part = |of: f256| match of.is_infinite() {
        true => f256::ONE.copysign(of),
        false => f256::ZERO.copysign(of),
    };
    let is_far = y.is_infinite() || x.is_infinite();
    let (own, x) = if is_far { (part(y), part(x)) } else { (y, x) };
    let is_diagonal = own.abs() == x.abs() && !own.eq_zero();
    let angle = match is_diagonal {
        true if x.is_sign_negative() => f256::from(0.75) * consts::PI,
        true => consts::FRAC_PI_4,
        false if x > f256::ZERO && is_small(own / x) => own / x,
        false => own.atan2(&x),
    };
    angle.copysign(y)
}

/// How near two numbers are whose powers and logarithms follow from each other: their difference, or the ratio of that to
/// the numbers.
const NEAR: f64 = 1.0 / (1_u64 << 32) as f64;

/// Angles up to this are their own sines and tangents, to within an ulp.
const SMALL: f64 = 1.0 / (1_u128 << 119) as f64;

/// Tells whether an angle is its own sine and tangent. The crate computes them with fixed-point numbers, which know no
/// digits of an angle below 2^-492.
fn is_small(angle: f256) -> bool {
    angle.abs() <= f256::from(SMALL)
}

/// Returns 1 or -1, with the sign of a number.
fn sign(of: f256) -> f64 {
    if of.is_sign_negative() { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_angles_keep_their_digits() {
        let (one, few) = (f256::ONE, f256::from(8.0) * f256::EPSILON);
        let (mut power, three, six) = (f256::from(0.5), f256::from(3.0), f256::from(6.0));
        for _ in 0..16 {
            power = power * power;
            // The next terms of the series are below an ulp up to there.
            if power > f256::from(1e-18) {
                continue;
            }
            let angle = f256::from(1.1) * power;
            let square = angle * angle;
            for (of, series) in [
                (sines([angle; 2]).0[0], one - square / six),
                (tan(angle), one + square / three),
                (atan2(angle, one), one - square / three),
                (atan2(-angle * power, power), square / three - one),
            ] {
                assert!((of / angle - series).abs() <= few, "{angle:?}: {of:?}");
            }
        }
    }

    #[test]
    fn angles_of_237_bits_are_those_of_53_in_every_direction() {
        let numbers = [f64::NEG_INFINITY, -2.0, -1.0, -0.0, 0.0, 1.0, 2.0, f64::INFINITY];
        for (y, x) in numbers.into_iter().flat_map(|y| numbers.map(|x| (y, x))) {
            let (found, right) = (to_f64(atan2(f256::from(y), f256::from(x))), libm::atan2(y, x));
            // The sign of 0 as x does not matter beside a y of 0, whose angle may be any.
            let is_right = (found - right).abs() < 1e-15 || y == 0.0 && x == 0.0;
            assert!(is_right, "the angle to {x}, {y} is {found}, and not {right}");
        }
    }
}
