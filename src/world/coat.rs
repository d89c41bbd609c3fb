//! Clear coats: what a coat over a matt body lets through.
//!
//! The coat reflects a part of the light as a mirror or, if it is rough, by its facets. The body scatters the rest, and
//! the coat throws a part of that back to the body, again and again. The sum, for light that arrives at an angle i and
//! leaves at an angle o, is `(1 - E(i)) (1 - E(o)) / n^2 * d / (pi (1 - d F))` for a body of colour d. E is the fraction
//! that the coat reflects at an angle, and F the fraction of the body's light that it throws back: `1 - (1 - E) / n^2`
//! with the mean of E over all directions, by their cosines. So a white body under any coat reflects all light. This is
//! `plastic` and `roughplastic` of Mitsuba 3 with `nonlinear` (Jakob, 2022).

use crate::number::Number;
use std::f64::consts::TAU;
use tabray_exact::scalar::per_axis;

/// The number of parts of the cosine's range between whose ends the reflected fraction is interpolated.
const PARTS: usize = 64;

/// The number of facets along each of two axes over which it is summed.
const FACETS: usize = 48;

/// A clear coat over a matt body.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearCoat {
    /// The fractions that the coat reflects, by the cosine of the angle to the normal in parts of `1 / PARTS`.
    reflected: [f64; PARTS + 1],
    /// The square of the refractive index.
    square: f64,
    /// The fraction of the body's light that the coat throws back to it.
    inner: f64,
}

impl ClearCoat {
    /// Makes a coat of a refractive index of at least 1, with a roughness from 0 to 1.
    pub fn new(index: f64, roughness: f64) -> Self {
        let reflected = std::array::from_fn(|part| {
            let cosine = part as f64 / PARTS as f64;
            if roughness == 0.0 {
                fresnel(index, cosine)
            } else {
                by_facets(index, roughness * roughness, cosine)
            }
        });
        // Twice the integral of the interpolated fraction times the cosine.
        let mean = (0..PARTS).map(|part| {
            let [low, high] = [part, part + 1].map(|part| part as f64 / PARTS as f64);
            (high - low) * (reflected[part] * (2.0 * low + high) + reflected[part + 1] * (low + 2.0 * high))
                / 3.0
        });
        let square = index * index;
        Self { inner: 1.0 - (1.0 - mean.sum::<f64>()) / square, reflected, square }
    }

    /// Returns the fraction of light that passes through the coat at an angle to the normal, given its cosine.
    pub fn passed(&self, cosine: f64) -> f64 {
        let at = cosine.clamp(0.0, 1.0) * PARTS as f64;
        let part = (at as usize).min(PARTS - 1);
        let [low, high] = [self.reflected[part], self.reflected[part + 1]];
        1.0 - (low + (at - part as f64) * (high - low))
    }

    /// Returns the diffuse reflectivity of a body of this colour under the coat, for light that has passed through it
    /// and before it passes again.
    pub fn body<N: Number>(&self, colour: [N; 3]) -> [N; 3] {
        let [square, inner, one] = [self.square, self.inner, 1.0].map(N::constant);
        per_axis(|channel| colour[channel] / (square * (one - inner * colour[channel])))
    }
}

/// Returns the fraction of light that is reflected where it enters a medium of a refractive index of at least 1, given
/// the cosine of its angle to the normal. Follows Fresnel's equations for light that is not polarised.
pub fn fresnel(index: f64, cosine: f64) -> f64 {
    let cosine = cosine.clamp(0.0, 1.0);
    let onward = (1.0 - (1.0 - cosine * cosine) / (index * index)).max(0.0).sqrt();
    if onward == 0.0 {
        // The index is 1, and the light grazes the surface.
        return 0.0;
    }
    let across = (cosine - index * onward) / (cosine + index * onward);
    let along = (index * cosine - onward) / (index * cosine + onward);
    0.5 * (across * across + along * along)
}

/// Returns the mean fraction that the facets reflect that are seen at an angle, in proportion to the areas that are
/// seen of them. `width` is the parameter alpha of the distribution of Trowbridge and Reitz.
fn by_facets(index: f64, width: f64, cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (mut seen, mut reflected) = (0.0, 0.0);
    for ring in 0..FACETS {
        let part = (ring as f64 + 0.5) / FACETS as f64;
        // The slope up to which this part of the distribution lies.
        let slope = width * (part / (1.0 - part)).sqrt();
        for turn in 0..FACETS {
            let turn = TAU * (turn as f64 + 0.5) / FACETS as f64;
            // The visible area of a facet, and the cosine of its angle to the viewer.
            let area = (cosine + sine * slope * libm::cos(turn)).max(0.0);
            seen += area;
            reflected += area * fresnel(index, area / (1.0 + slope * slope).sqrt());
        }
    }
    if seen == 0.0 { fresnel(index, 0.0) } else { reflected / seen }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_white_body_under_any_coat_reflects_all_light() {
        for (index, roughness) in [(1.5, 0.0), (1.33, 0.3), (2.4, 0.0), (1.5, 0.8), (1.0, 0.0)] {
            let coat = ClearCoat::new(index, roughness);
            let count = 10_000;
            let cosines = (0..count).map(|part| (f64::from(part) + 0.5) / f64::from(count));
            let received: f64 =
                cosines.map(|cosine| 2.0 * cosine * coat.passed(cosine)).sum::<f64>() / f64::from(count);
            for cosine in [0.05, 0.3, 0.77, 1.0] {
                let passed = coat.passed(cosine);
                let whole = 1.0 - passed + passed * received * coat.body([1.0; 3])[0];
                assert!((whole - 1.0).abs() < 1e-6, "{index}, {roughness}, {cosine}: {whole}");
            }
        }
    }

    #[test]
    fn a_smooth_coat_reflects_as_fresnel_says() {
        // At right angles, the fraction is that of the indices; at Brewster's angle, one polarisation is not reflected.
        let brewster = (1.0 + 1.5_f64 * 1.5).sqrt().recip();
        let across = (1.5_f64 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
        for (cosine, right) in [(1.0, 0.04), (brewster, 0.5 * across * across), (0.0, 1.0)] {
            assert!((fresnel(1.5, cosine) - right).abs() < 1e-12);
        }
        let almost_smooth = by_facets(1.5, 1e-6, 0.6);
        assert!((almost_smooth - fresnel(1.5, 0.6)).abs() < 1e-5, "{almost_smooth}");
    }
}
