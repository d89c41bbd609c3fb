//! Gradient noise: smooth random waves in space, about one unit long, the same on every machine.
//!
//! Space is divided into cubes of side 1. The gradient at each of their corners, chosen by a permutation of its
//! coordinates, gives a linear function that is 0 there. Within a cube, the functions of its eight corners are blended.
//! The noise repeats after 256 units.
//!
//! Source: K. Perlin, "Improving Noise" (SIGGRAPH 2002), with the permutation of its reference implementation.

/// The permutation.
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99,
    37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27,
    166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244,
    102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130,
    116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147,
    118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119,
    248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110,
    79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179,
    162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176,
    115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78,
    66, 215, 61, 156, 180,
];

/// A polynomial of one coordinate, by its coefficients.
pub(crate) type Curve = [f64; 7];

/// The weights of the two corners along an axis, by the coordinate in the cell, and their products with the coordinate
/// from the corner.
const WEIGHTS: [Curve; 2] = [[1.0, 0.0, 0.0, -10.0, 15.0, -6.0, 0.0], [0.0, 0.0, 0.0, 10.0, -15.0, 6.0, 0.0]];
const RISES: [Curve; 2] = [[0.0, 1.0, 0.0, 0.0, -10.0, 15.0, -6.0], [0.0, 0.0, 0.0, -10.0, 25.0, -21.0, 6.0]];

/// Bounds of the sums of the magnitudes of the two weights, and of the two rises, and of their derivatives of orders up
/// to 3. Let f be the weight of the second corner, which rises from 0 to 1. The weights are 1 - f and f, and the
/// magnitudes of the rises are (1 - f) t and f (1 - t), together at most 1/2. Further, |f'| <= 15/8, |f''| < 5.8 and
/// |f'''| <= 60. The derivatives of t f are f + t f', 2 f' + t f'' and 3 f'' + t f''', and those of the other rise are
/// the same with 1 - t for t.
const MAX_WEIGHT: [f64; 4] = [1.0, 3.75, 11.6, 120.0];
const MAX_RISE: [f64; 4] = [0.5, 2.875, 13.3, 94.8];

/// Returns the gradient at a corner: two of its coordinates are 1 or -1, and one is 0.
pub(crate) fn gradient(corner: [f64; 3]) -> [f64; 3] {
    let hash = |before: u8, along: f64| {
        // The remainder is exact at any distance.
        let place = along.rem_euclid(256.0) as u8;
        PERMUTATION[usize::from(before.wrapping_add(place))]
    };
    // The reference permutes x, y and z in turn, and then takes 4 bits.
    let choice = hash(hash(hash(0, corner[0]), corner[1]), corner[2]) & 15;
    let first = if choice < 8 { 0 } else { 1 };
    let second = match choice {
        0..4 => 1,
        12 | 14 => 0,
        _ => 2,
    };
    let mut gradient = [0.0; 3];
    gradient[first] = if choice & 1 == 0 { 1.0 } else { -1.0 };
    gradient[second] = if choice & 2 == 0 { 1.0 } else { -1.0 };
    gradient
}

/// Returns the derivatives, of an order, of the weights of the two corners along an axis, and of their rises.
pub(crate) fn curves(order: u8) -> [[Curve; 2]; 2] {
    let mut all = [WEIGHTS, RISES];
    for curve in all.as_flattened_mut() {
        for _ in 0..order {
            for power in 1..curve.len() {
                curve[power - 1] = power as f64 * curve[power];
            }
            curve[curve.len() - 1] = 0.0;
        }
    }
    all
}

/// Bounds the magnitude of the noise, or of its derivative of these orders. The bound is infinite for orders above 3.
pub(crate) fn most(orders: [u8; 3]) -> f64 {
    let most =
        |of: &[f64; 4], axis: usize| of.get(usize::from(orders[axis])).copied().unwrap_or(f64::INFINITY);
    let term = |rises: usize| -> f64 {
        (0..3).map(|axis| most(if axis == rises { &MAX_RISE } else { &MAX_WEIGHT }, axis)).product()
    };
    (0..3).map(term).sum::<f64>() * (1.0 + 1e-15)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::affine::Affine;
    use crate::dual::Dual;
    use crate::interval::Interval;
    use crate::jet::Jet;
    use crate::scalar::Scalar;
    use proptest::prelude::*;

    fn noise(at: [f64; 3]) -> f64 {
        f64::noise(at, [0; 3])
    }

    #[test]
    fn each_number_is_permuted_to_another() {
        let mut seen = PERMUTATION;
        seen.sort_unstable();
        assert!((0..=255).eq(seen));
    }

    #[test]
    fn noise_is_that_of_the_reference() {
        // This is Perlin's reference as written, with the permutation twice in a row.
        let p = |index: usize| usize::from(PERMUTATION[index & 255]);
        let grad = |hash: usize, x: f64, y: f64, z: f64| {
            let h = hash & 15;
            let u = if h < 8 { x } else { y };
            let v = if h < 4 {
                y
            } else if h == 12 || h == 14 {
                x
            } else {
                z
            };
            (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
        };
        let lerp = |t: f64, a: f64, b: f64| a + t * (b - a);
        let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let reference = |[x, y, z]: [f64; 3]| {
            let [i, j, k] = [x, y, z].map(|of| (of.floor() as i64 & 255) as usize);
            let [x, y, z] = [x, y, z].map(|of| of - of.floor());
            let [u, v, w] = [x, y, z].map(fade);
            let (a, b) = (p(i) + j, p(i + 1) + j);
            let (aa, ab, ba, bb) = (p(a) + k, p(a + 1) + k, p(b) + k, p(b + 1) + k);
            lerp(
                w,
                lerp(
                    v,
                    lerp(u, grad(p(aa), x, y, z), grad(p(ba), x - 1.0, y, z)),
                    lerp(u, grad(p(ab), x, y - 1.0, z), grad(p(bb), x - 1.0, y - 1.0, z)),
                ),
                lerp(
                    v,
                    lerp(u, grad(p(aa + 1), x, y, z - 1.0), grad(p(ba + 1), x - 1.0, y, z - 1.0)),
                    lerp(u, grad(p(ab + 1), x, y - 1.0, z - 1.0), grad(p(bb + 1), x - 1.0, y - 1.0, z - 1.0)),
                ),
            )
        };
        for step in 0..20_000 {
            let at = [0.37, 1.71, 5.13].map(|factor| (f64::from(step) * factor).rem_euclid(613.0) - 306.0);
            assert!((noise(at) - reference(at)).abs() < 1e-13, "{at:?}");
        }
        // A published value.
        assert!((noise([314.0 / 100.0, 42.0, 7.0]) - 0.136_919_958_784).abs() < 1e-10);
    }

    fn point() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(prop_oneof![-4.0..4.0_f64, (-3..3_i32).prop_map(f64::from), -1e6..1e6_f64])
    }

    proptest! {
        #[test]
        fn intervals_enclose_noise_and_its_derivatives(
            at in point(), size in prop::array::uniform3(prop_oneof![0.0..1e-6_f64, 0.0..0.3_f64, 0.0..3.0_f64]),
            part in prop::array::uniform3(0.0..=1.0_f64), orders in prop::array::uniform3(0..2_u8),
        ) {
            let place = [0, 1, 2].map(|axis| Interval { low: at[axis], high: at[axis] + size[axis] });
            let inside = [0, 1, 2].map(|axis| (at[axis] + part[axis] * size[axis]).min(place[axis].high));
            let (bounds, value) = (Interval::noise(place, orders), f64::noise(inside, orders));
            prop_assert!(bounds.low - 1e-12 <= value && value <= bounds.high + 1e-12, "{bounds:?} {value}");
            prop_assert!(value.abs() <= most(orders));
        }

        #[test]
        fn affine_numbers_enclose_noise(at in point(), size in 0.0..0.4_f64, part in prop::array::uniform2(-1.0..=1.0_f64)) {
            let of = [Affine::variable(0, at[0], size), Affine::variable(1, at[1], size), Affine::constant(at[2])];
            let inside = [at[0] + part[0] * size, at[1] + part[1] * size, at[2]];
            let (bounds, value) = (Affine::noise(of, [0; 3]).range(), noise(inside));
            prop_assert!(bounds.low - 1e-9 <= value && value <= bounds.high + 1e-9, "{bounds:?} {value}");
        }

        #[test]
        fn slopes_are_those_of_small_differences(at in prop::array::uniform3(-4.0..4.0_f64), dir in prop::array::uniform3(-1.0..1.0_f64)) {
            let along = |t: f64| [0, 1, 2].map(|axis| at[axis] + t * dir[axis]);
            let dual = Dual::noise([0, 1, 2].map(|axis| Dual { value: at[axis], slope: dir[axis] }), [0; 3]);
            let jet = Jet::noise([0, 1, 2].map(|axis| Jet::variable(0.0).scaled(dir[axis]).shifted(at[axis])), [0; 3]);
            let step = 1e-5;
            let slope = (noise(along(step)) - noise(along(-step))) / (2.0 * step);
            let bend = (noise(along(step)) - 2.0 * noise(at) + noise(along(-step))) / (step * step);
            prop_assert!((dual.slope - slope).abs() < 1e-6, "{} {slope}", dual.slope);
            prop_assert!(jet.value == dual.value && (jet.first - dual.slope).abs() < 1e-12);
            prop_assert!((jet.second - bend).abs() < 1e-3, "{} {bend}", jet.second);
        }
    }
}
