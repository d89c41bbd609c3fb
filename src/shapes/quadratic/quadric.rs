//! A quadric in a box: its equation in the numbers of the scene, for the course notes' formula and for proofs, and the
//! same surface scaled for the solver.

use super::quick::QuickHit;
use super::surface::{OwnRay, Quadratic};
use glam::{DMat3, DVec3};
use std::marker::PhantomData;
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::accuracy::{Accuracy, AccuracyTag};
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::geometry::clearance;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};

/// A bound of the error of a camera ray: 3 units of 2^-53 in each component of the direction.
const CAMERA: RayError = RayError { origin: 0.0, dir: 1.5 * f64::EPSILON };

/// A quadric `p·Sp + l·p + c = 0`, for points `p` relative to the center, in a box.
#[derive(Clone, Debug)]
pub struct Quadric<A> {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    /// The origin of the equation's coordinates, in world coordinates.
    pub center: DVec3,
    /// The low corner of the clipping box, relative to the center.
    pub low: DVec3,
    /// The high corner of the clipping box, relative to the center.
    pub high: DVec3,
    /// The quadric's coefficients, scaled for the solver.
    own: Quadratic,
    accuracy: PhantomData<A>,
}

impl<A> Quadric<A> {
    /// Returns the quadric `Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J`, clipped by a box. The coordinates of
    /// both are relative to the center.
    pub fn new(coefficients: [f64; 10], center: DVec3, [low, high]: [DVec3; 2]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j] = coefficients;
        let square = DMat3::from_cols(
            DVec3::new(a, d / 2.0, e / 2.0),
            DVec3::new(d / 2.0, b, f / 2.0),
            DVec3::new(e / 2.0, f / 2.0, c),
        );
        let own = Quadratic::new(coefficients, low, high);
        Self {
            square,
            linear: DVec3::new(g, h, i),
            constant: -j,
            center,
            low,
            high,
            own,
            accuracy: PhantomData,
        }
    }

    /// Returns the clipping box in world coordinates.
    pub fn around(&self) -> Aabb {
        Aabb { low: self.center + self.low, high: self.center + self.high }
    }

    /// Returns a lower bound of the distance from a point to the quadric, in world units, by the equation: at a
    /// distance `r` from the point, its value differs by at most `|gradient| r + |square| r^2`.
    pub fn clearance_by_value(&self, from: DVec3) -> f64 {
        let at = from - self.center;
        let abs = DMat3::from_cols_array(&self.square.to_cols_array().map(f64::abs));
        let terms = at.abs().dot(abs * at.abs()) + self.linear.abs().dot(at.abs()) + self.constant.abs();
        let value = at.dot(self.square * at) + self.linear.dot(at) + self.constant;
        let value = value.abs() - SLACK * terms;
        let rounding = SLACK * (abs * at.abs() + self.linear.abs()).length();
        let gradient = (2.0 * (self.square * at) + self.linear).length() + rounding;
        let square = (abs * DVec3::ONE).length();
        let radius = 2.0 * value / (gradient + (gradient * gradient + 4.0 * square * value).sqrt());
        // The factor covers the rounding above, and keeps the radius a lower bound.
        if value > 0.0 && radius.is_finite() { radius * (1.0 - 1e-6) } else { 0.0 }
    }

    /// Returns a lower bound of the distance from a point to the quadric, in world units, by its box.
    pub fn clearance_by_box(&self, from: DVec3) -> f64 {
        let around = self.around();
        clearance(from, Some(around), |region| !around.overlaps(region))
    }

    /// Tells whether the quadric is an ellipsoid in its box, with negative values inside.
    pub fn is_closed(&self) -> bool {
        let Self { square, linear, constant, low, high, .. } = self;
        let minors = [square.x_axis.x, square.x_axis.x * square.y_axis.y - square.x_axis.y * square.x_axis.y];
        if minors.into_iter().chain([square.determinant()]).any(|minor| minor <= 0.0) {
            return false;
        }
        let inverse = square.inverse();
        let middle = -0.5 * (inverse * *linear);
        let level = middle.dot(*square * middle) - constant;
        let half = (level * DVec3::new(inverse.x_axis.x, inverse.y_axis.y, inverse.z_axis.z)).map(f64::sqrt);
        let half = half + SLACK * (half + middle.abs());
        level > 0.0 && low.cmplt(middle - half).all() && (middle + half).cmplt(*high).all()
    }

    /// Returns the left side of the equation at a point in world space, which is 0 on the quadric.
    pub fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let from_center = per_axis(|axis| at[axis] - N::constant(self.center[axis]));
        let sum = |part: &dyn Fn(usize) -> N| part(0) + part(1) + part(2);
        let row = |row: usize| {
            let square = sum(&|column| from_center[column] * N::constant(self.square.col(column)[row]));
            from_center[row] * (square + N::constant(self.linear[row]))
        };
        sum(&row) + N::constant(self.constant)
    }

    /// Returns a number that is positive at points in the box, in world space, and negative outside.
    pub fn inside_box<N: Scalar>(&self, at: [N; 3]) -> N {
        let inside = |axis: usize| {
            let from_center = at[axis] - N::constant(self.center[axis]);
            let (low, high) = (N::constant(self.low[axis]), N::constant(self.high[axis]));
            (from_center - low).min(high - from_center)
        };
        inside(0).min(inside(1)).min(inside(2))
    }
}

impl<A: AccuracyTag> Quadric<A> {
    /// A short description of the method for hits.
    pub const METHOD: &str = match A::ACCURACY {
        Accuracy::Classic => "the notes' formula",
        Accuracy::Strict => "a closed form in twice the precision",
        Accuracy::Draft | Accuracy::Exact => {
            "a closed form and a step of Newton's method, in twice the precision where rounding could decide"
        }
    };

    /// Returns the distance of the first hit by the course notes' formula.
    pub fn classic_distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let origin = ray.origin - self.center;
        let turned = self.square * ray.dir;
        let [a, b, c] = [
            ray.dir.dot(turned),
            origin.dot(turned) + 0.5 * self.linear.dot(ray.dir),
            origin.dot(self.square * origin) + self.linear.dot(origin) + self.constant,
        ];
        let keeps = |at: DVec3| {
            let from_center = at - self.center;
            self.low.cmple(from_center).all() && from_center.cmple(self.high).all()
        };
        let crossings = classic_roots(a, b, c).map(|distance| range.keep(distance));
        crossings.into_iter().find(|distance| keeps(ray.at(*distance))).unwrap_or(MISS)
    }

    #[inline(always)]
    fn own_ray(&self, ray: &Ray) -> OwnRay {
        self.own.own(ray.origin, ray.dir, self.center)
    }

    /// Computes the distance of the first hit beyond `near` in double-double arithmetic, or exactly.
    pub fn exact_hit(&self, ray: &Ray, near: f64) -> f64 {
        self.own.exact_hit(&self.own_ray(ray), near)
    }

    /// Returns the distance of the first hit of a ray that leaves the quadric. The ray starts on one hit, and only the
    /// other one remains.
    #[inline(never)]
    fn other_distance(&self, ray: &Ray, side: Side, range: &RayRange) -> f64 {
        range.keep(self.own.other_hit(&self.own_ray(ray), side))
    }

    /// Returns the distance of the first hit in a range, or NaN if plain arithmetic is not enough.
    #[inline(always)]
    pub fn fast_distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if let Some(side) = range.origin_side {
            return self.other_distance(ray, side, range);
        }
        if A::ACCURACY == Accuracy::Strict {
            return f64::NAN;
        }
        let own = self.own_ray(ray);
        let quick = self.own.quick_hit(&own, range.near, RayError::NONE);
        let corrected = self.own.corrected(&own, quick.distance);
        let is_unknown = quick.is_unknown | corrected.is_nan();
        let hit = if is_unknown { f64::NAN } else { range.keep(corrected) };
        if quick.is_missed { MISS } else { hit }
    }

    /// Returns bounds of the distances of the first hits in a range, for all rays that `ray` stands for.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if let Some(side) = range.origin_side {
            return Bracket::exactly(self.other_distance(ray, side, range));
        }
        let drift = if ray.is_single() { CAMERA } else { ray.drift };
        let QuickHit { is_missed, is_unknown, distance, error } =
            self.own.quick_hit(&self.own_ray(ray), range.near, drift);
        let (near, far) = if is_unknown { (range.near, MISS) } else { (distance - error, distance + error) };
        if is_missed { Bracket::MISS } else { Bracket { near, far } }
    }

    /// Returns the unit normal at a point.
    pub fn unit_normal(&self, at: DVec3) -> DVec3 {
        if !A::IS_CLASSIC {
            return self.own.normal(at, self.center);
        }
        let normal = 2.0 * (self.square * (at - self.center)) + self.linear;
        // A cone's apex has no normal, and any unit vector will do.
        normal.try_normalize().unwrap_or(DVec3::Y)
    }
}

/// Returns the roots by the well-known formula of the course notes, which loses digits and double roots.
#[inline(always)]
fn classic_roots(a: f64, half_b: f64, c: f64) -> [f64; 2] {
    let b = 2.0 * half_b;
    if a == 0.0 {
        return [-c / b, f64::NAN];
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let (one, other) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
    [one.min(other), one.max(other)]
}
