//! Sines and cosines with the bits of the `libm` crate, but faster: of several angles at once, without branches for
//! most of them. The reduction and the polynomials are those of FreeBSD's msun, which that crate is ported from.

/// Returns the sines and the cosines of some angles in radians, with the same bits as `libm`, but faster.
#[inline(always)]
pub(crate) fn sines<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sin, mut cos) = ([0.0; N], [0.0; N]);
    let (mut fallback, mut any) = ([0; N], 0);
    for lane in 0..N {
        let of = sin_cos(angles[lane]);
        (sin[lane], cos[lane], fallback[lane]) = (of.sin, of.cos, of.needs_libm);
        any |= of.needs_libm;
    }
    if any != 0 {
        for lane in 0..N {
            if fallback[lane] != 0 {
                (sin[lane], cos[lane]) = libm::sincos(angles[lane]);
            }
        }
    }
    (sin, cos)
}

/// The sine and the cosine of a number, valid unless `needs_libm` is nonzero.
struct SinCos {
    sin: f64,
    cos: f64,
    needs_libm: u64,
}

/// Computes the sine and the cosine of an angle in radians without branches. `needs_libm` is nonzero for large angles,
/// for NaN, and for angles so close to a switch between msun's formulas that it might use another one.
#[inline(always)]
fn sin_cos(x: f64) -> SinCos {
    /// Adding this rounds to an integer, in the last bits of the sum.
    const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
    const INVERSE: f64 = std::f64::consts::FRAC_2_PI;
    /// The first 33 bits of π / 2, and the rest.
    const QUARTER: f64 = 1.570_796_326_734_125_6;
    const QUARTER_REST: f64 = 6.077_100_506_506_192e-11;
    /// Bounds in radians. Angles below the first are certainly below π / 4. The sine of an angle below the second is
    /// the angle itself.
    const REDUCED: f64 = 0.785;
    const TINY: f64 = 2e-8;

    let shifted = x * INVERSE + TO_WHOLE;
    let quarters = shifted - TO_WHOLE;
    let turned = x - quarters * QUARTER;
    let rest = quarters * QUARTER_REST;
    let high = turned - rest;
    let low = (turned - high) - rest;
    let size = high.abs();
    // If much of the angle cancels, more bits of π / 2 are needed.
    let is_fine = (x.abs() < 1e5) & (size < REDUCED) & (size > TINY) & (size * 1000.0 > x.abs());

    let square = high * high;
    let fourth = square * square;
    let tail = S[1] + square * (S[2] + square * S[3]) + square * fourth * (S[4] + square * S[5]);
    let cube = square * high;
    let unturned_sine = high + cube * (S[0] + square * tail);
    let turned_sine = high - ((square * (0.5 * low - cube * tail) - low) - cube * S[0]);
    let sine = if quarters == 0.0 { unturned_sine } else { turned_sine };

    let tail = square * (C[0] + square * (C[1] + square * C[2]))
        + fourth * fourth * (C[3] + square * (C[4] + square * C[5]));
    let half = 0.5 * square;
    let rough = 1.0 - half;
    let cosine = rough + (((1.0 - rough) - half) + (square * tail - high * low));

    let quadrant = shifted.to_bits() & 3;
    let is_crossed = quadrant & 1 != 0;
    let (sin, cos) = if is_crossed { (cosine, sine) } else { (sine, cosine) };
    // The sign bits of the sine and of the cosine in this quadrant.
    let (sin_sign, cos_sign) = ((quadrant & 2) << 62, ((quadrant + 1) & 2) << 62);
    SinCos {
        sin: f64::from_bits(sin.to_bits() ^ sin_sign),
        cos: f64::from_bits(cos.to_bits() ^ cos_sign),
        needs_libm: u64::from(!is_fine),
    }
}

/// The coefficients of the sine's polynomial after its first term, and of the cosine's after its second.
const S: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const C: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

#[cfg(test)]
mod tests {
    use super::*;

    const LANES: usize = 8;

    fn same(a: f64, b: f64) -> bool {
        a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
    }

    #[test]
    fn sines_have_the_bits_of_libm() {
        let mut fallback = 0;
        let numbers = (0..2_000_000_u64).map(|index| {
            // From 1e-9 to 1e6, both signs, and angles near multiples of π / 4.
            let spread = (index as f64 * 0.618_033_988_749_894_9).fract();
            let size = 10.0_f64.powf(15.0 * spread - 9.0);
            match index % 4 {
                0 => size,
                1 => -size,
                2 => 20.0 * spread - 10.0,
                _ => (index % 64) as f64 * std::f64::consts::FRAC_PI_4 * (1.0 + 1e-7 * (spread - 0.5)),
            }
        });
        let special = [0.0, -0.0, 1.0, f64::INFINITY, f64::NAN, f64::MIN_POSITIVE, 1e300, 0.785];
        let numbers: Vec<_> = numbers.chain(special).collect();
        for eight in numbers.chunks_exact(LANES) {
            let eight: [f64; LANES] = std::array::from_fn(|lane| eight[lane]);
            let (sin, cos) = sines(eight);
            for lane in 0..LANES {
                let expected = libm::sincos(eight[lane]);
                assert!(same(sin[lane], expected.0), "sin {:e}", eight[lane]);
                assert!(same(cos[lane], expected.1), "cos {:e}", eight[lane]);
                fallback += sin_cos(eight[lane]).needs_libm;
            }
        }
        assert!((fallback as usize) < numbers.len() / 2, "most are computed at once: {fallback} are not");
    }
}
