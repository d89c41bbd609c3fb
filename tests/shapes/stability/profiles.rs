//! The profiles of the rows, as formulas in a scene and as functions, and references that are correct by construction.

use super::{Random, shape_of, words};
use glam::{DVec3, dvec3};
use tabray::world::AnyShape;

/// A profile that a row of the table is about.
pub struct Line {
    pub formula: &'static str,
    pub height: f64,
    pub radius: fn(f64) -> f64,
    pub slope: fn(f64) -> f64,
    /// An upper bound of the radius.
    pub widest: f64,
}

pub const VASE: Line =
    Line { formula: "2 + sin(y)", height: 6.28, radius: |y| 2.0 + y.sin(), slope: f64::cos, widest: 3.0 };

pub const NASTY: Line = Line {
    formula: "1 + 0.3*sin(20*y)",
    height: 6.28,
    radius: |y| 1.0 + 0.3 * (20.0 * y).sin(),
    slope: |y| 6.0 * (20.0 * y).cos(),
    widest: 1.3,
};

pub const FLANGE: Line = Line {
    formula: "0.3 + 2*exp(-(20*(y-3))^2)",
    height: 6.28,
    radius: |y| 0.3 + 2.0 * (-(20.0 * (y - 3.0)).powi(2)).exp(),
    slope: |y| -1600.0 * (y - 3.0) * (-(20.0 * (y - 3.0)).powi(2)).exp(),
    widest: 2.3,
};

pub const KINK: Line = Line {
    formula: "0.6 + 0.5*abs(y-3)",
    height: 6.28,
    radius: |y| 0.6 + 0.5 * (y - 3.0).abs(),
    slope: |y| 0.5 * (y - 3.0).signum(),
    widest: 2.24,
};

pub const STAIR: Line = Line {
    formula: "0.5 + 0.25*floor(y)",
    height: 6.28,
    radius: |y| 0.5 + 0.25 * y.floor(),
    slope: |_| 0.0,
    widest: 2.0,
};

impl Line {
    /// Returns the surface about the y axis, from the origin upward.
    pub fn shape(&self) -> AnyShape {
        self.shape_of("")
    }

    /// Returns the same surface, with attributes of the camera.
    pub fn shape_of(&self, camera: &str) -> AnyShape {
        revsurf(camera, &format!("profile \"{}\"", self.formula), self.height)
    }

    /// Returns `x^2 - g(y)^2 + z^2`: positive outside.
    pub fn outside(&self, at: DVec3) -> f64 {
        let radius = (self.radius)(at.y);
        at.x * at.x - radius * radius + at.z * at.z
    }

    /// Returns the outward unit normal at a point of the surface.
    pub fn normal(&self, at: DVec3) -> DVec3 {
        let radius = (self.radius)(at.y);
        dvec3(at.x, -radius * (self.slope)(at.y), at.z).normalize()
    }

    /// Returns the distance of a point from the surface, to first order.
    pub fn off(&self, at: DVec3) -> f64 {
        let (radius, slope) = ((self.radius)(at.y), (self.slope)(at.y));
        (self.outside(at) / (2.0 * radius * (1.0 + slope * slope).sqrt())).abs()
    }

    /// Returns the part of a ray that lies between the ends and within the greatest radius of the axis.
    pub fn bounds(&self, origin: DVec3, dir: DVec3) -> Option<[f64; 2]> {
        let (low, high) = (-origin.y / dir.y, (self.height - origin.y) / dir.y);
        let (mut near, mut far) = (low.min(high), low.max(high));
        if dir.y == 0.0 {
            (near, far) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        let a = dir.x * dir.x + dir.z * dir.z;
        let closest = -(origin.x * dir.x + origin.z * dir.z) / a;
        let off = origin + closest * dir;
        let left = self.widest * self.widest - off.x * off.x - off.z * off.z;
        let half = (left / a).sqrt();
        (near, far) = (near.max(closest - half), far.min(closest + half));
        (left >= 0.0 && near.max(0.0) < far).then_some([near.max(0.0), far])
    }

    /// Finds a root in the usual way: this many samples within the bounds, and bisection where two of them differ in
    /// sign.
    pub fn scan(&self, origin: DVec3, dir: DVec3, samples: usize) -> Option<f64> {
        let [near, far] = self.bounds(origin, dir)?;
        let at = |sample: usize| near + (far - near) * sample as f64 / samples as f64;
        let outside = |distance: f64| self.outside(origin + distance * dir) >= 0.0;
        let step = (0..samples).find(|sample| outside(at(*sample)) != outside(at(sample + 1)))?;
        let (mut low, mut high) = (at(step), at(step + 1));
        for _ in 0..100 {
            let middle = (low + high) / 2.0;
            if outside(middle) == outside(at(step)) { low = middle } else { high = middle }
        }
        Some(high)
    }

    /// Returns a ray that enters the surface at a random point, `distance` from its origin and at this angle to the
    /// surface. The ray may have hit the surface before.
    pub fn entry(&self, random: &mut Random, distance: f64, angle: f64) -> [DVec3; 2] {
        let y = random.between(0.02, 0.98) * self.height;
        let turn = random.between(0.0, std::f64::consts::TAU);
        let radius = (self.radius)(y);
        let at = dvec3(radius * turn.cos(), y, radius * turn.sin());
        let dir = random.around(-self.normal(at), angle.sin());
        [at - distance * dir, dir]
    }
}

/// Returns a surface of revolution about the y axis, from the origin upward.
pub fn revsurf(camera: &str, line: &str, height: f64) -> AnyShape {
    let (base, up) = (words(DVec3::ZERO), words(DVec3::Y));
    shape_of(camera, &format!("revsurf r {{ material m {line} base {base} direction {up} height {height} }}"))
}
