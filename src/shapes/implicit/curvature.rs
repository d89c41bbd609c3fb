//! Curvatures of implicit surfaces.
//!
//! Source: R. Goldman, "Curvature formulas for implicit curves and surfaces", Computer Aided Geometric Design 22 (2005).

use super::formula::Implicit;
use glam::{DMat3, DVec3};
use tabray_exact::jet::Jet;
use tabray_exact::scalar::per_axis;
use tabray_world::hittable::Curvature;

/// Returns the curvature of a formula's surface at one of its points, with the length of the gradient.
pub fn at(formula: &impl Implicit, at: DVec3) -> Curvature {
    let along =
        |dir: DVec3| formula.value(per_axis(|axis| Jet { value: at[axis], first: dir[axis], second: 0.0 }));
    let [x, y, z] = DVec3::AXES.map(along);
    let gradient = DVec3::new(x.first, y.first, z.first);
    // The second derivative along a diagonal is the sum of those along both axes and twice the mixed one.
    let mixed = |one: usize, other: usize| {
        let own = [x.second, y.second, z.second];
        0.5 * (along(DVec3::AXES[one] + DVec3::AXES[other]).second - own[one] - own[other])
    };
    let [xy, xz, yz] = [mixed(0, 1), mixed(0, 2), mixed(1, 2)];
    let columns = [DVec3::new(x.second, xy, xz), DVec3::new(xy, y.second, yz), DVec3::new(xz, yz, z.second)];
    let [one, two, three] = columns;
    let adjugate = DMat3::from_cols(two.cross(three), three.cross(one), one.cross(two)).transpose();
    let (square, trace) = (gradient.length_squared(), x.second + y.second + z.second);
    let bent = gradient.dot(DMat3::from_cols(one, two, three) * gradient);
    Curvature {
        gradient: square.sqrt(),
        mean: (square * trace - bent) / (2.0 * square * square.sqrt()),
        gauss: gradient.dot(adjugate * gradient) / (square * square),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use tabray_exact::scalar::Scalar;

    /// A torus around the y axis: its radius, and the radius of its tube.
    struct Torus(f64, f64);

    impl Implicit for Torus {
        fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
            let off = (x.powi(2) + z.powi(2)).sqrt() - N::constant(self.0);
            off.powi(2) + y.powi(2) - N::constant(self.1).powi(2)
        }

        fn bounds(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE].map(|corner| (self.0 + self.1) * corner)
        }
    }

    #[test]
    fn a_torus_bends_as_geometry_says() {
        let (radius, tube) = (3.0, 0.75);
        for [along, around] in [[0.3, 0.0], [2.1, 1.3], [4.4, 2.6], [5.9, 3.1]] {
            let (out, up) = (tube * libm::cos(around), tube * libm::sin(around));
            let ring = DVec2::new(libm::cos(along), libm::sin(along)) * (radius + out);
            let found = at(&Torus(radius, tube), DVec3::new(ring.x, up, ring.y));
            let wide = libm::cos(around) / (radius + out);
            let expected = [2.0 * tube, 0.5 * (wide + 1.0 / tube), wide / tube];
            for (found, expected) in [found.gradient, found.mean, found.gauss].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{along} {around}: {found} {expected}");
            }
        }
    }
}
