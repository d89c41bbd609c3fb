//! Rays of which every digit is known, so that something can be proven of them.

use crate::geometry::ray::Ray;
use crate::numeric::dual::Dual;
use crate::numeric::scalar::Scalar;
use glam::{DVec2, DVec3};

/// A ray as a scene gives it, before anything is rounded.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    origin: DVec3,
    toward: Toward,
}

#[derive(Clone, Copy, Debug)]
enum Toward {
    /// Along this vector.
    Direction(DVec3),
    /// Through the place of the screen, in the plane z = 0, whose x and y are each `at / last * size`.
    Screen { at: DVec2, last: DVec2, size: DVec2 },
}

/// A line with numbers of any type: the points `origin + t dir`.
#[derive(Clone, Copy, Debug)]
pub struct Line<N> {
    /// The point where t is 0.
    pub origin: [N; 3],
    /// Its direction, of any length.
    pub dir: [N; 3],
}

impl Sight {
    /// The ray from a viewpoint through a place of a screen, `at / last` of its width and height from its lower left
    /// corner.
    #[inline(always)]
    pub fn through(viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> Self {
        Self { origin: viewpoint, toward: Toward::Screen { at, last, size } }
    }

    /// A ray taken for exactly what its numbers are, the length of its direction included.
    pub fn along(ray: &Ray) -> Self {
        Self { origin: ray.origin, toward: Toward::Direction(ray.dir) }
    }

    /// The ray, rounded.
    #[inline(always)]
    pub fn ray(&self) -> Ray {
        let dir = match self.toward {
            Toward::Direction(dir) => dir,
            Toward::Screen { at, last, size } => direction(self.origin, at, last, size),
        };
        Ray { origin: self.origin, dir }
    }

    /// The line that it runs along, from t = 0 on.
    pub fn line<N: Scalar>(&self) -> Line<N> {
        let n = N::constant;
        let dir = match self.toward {
            Toward::Direction(dir) => dir.to_array().map(n),
            Toward::Screen { at, last, size } => {
                let part = |side: usize| n(at[side]) / n(last[side]) * n(size[side]) - n(self.origin[side]);
                [part(0), part(1), n(-self.origin.z)]
            }
        };
        Line { origin: self.origin.to_array().map(n), dir }
    }

    /// The square of how far it gets from t = 0 to 1, in world units.
    pub fn squared_length<N: Scalar>(&self) -> N {
        let [x, y, z] = self.line::<N>().dir.map(|part| part.powi(2));
        x + y + z
    }
}

/// The unit vector, rounded, from a viewpoint to a place of the screen.
#[inline(always)]
pub(crate) fn direction(viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> DVec3 {
    ((at / last * size).extend(0.0) - viewpoint).normalize()
}

impl<N: Scalar> Line<N> {
    /// The point at t.
    pub fn at(&self, t: N) -> [N; 3] {
        [0, 1, 2].map(|axis| self.origin[axis] + t * self.dir[axis])
    }

    /// The point at t, which depends on a variable.
    pub fn along(&self, t: Dual<N>) -> [Dual<N>; 3] {
        [0, 1, 2].map(|axis| Dual::fixed(self.origin[axis]) + t * Dual::fixed(self.dir[axis]))
    }
}
