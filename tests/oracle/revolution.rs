//! The first hit of a ray on a curve turned about the y axis: the first root of x^2 + z^2 - g(y)^2.
//!
//! All roots are isolated. A piece of the ray is bisected until bounds prove that it has no root, or that the function
//! is monotone on it, so that the signs at its ends decide. The bounds come from intervals, and on short pieces, where
//! these are too coarse, from [`DoubleDouble`].

use super::{Crossings, Hit, Truth};
use glam::DVec3;
use tabray::exact::{Dual, Formula, Interval, Scalar, double_double::DoubleDouble};
use tabray::geometry::Ray;

/// A curve x = g(y) turned about the y axis through a base. Where g is below 0 there is no surface.
pub struct Revolution {
    formula: Formula,
    base: DVec3,
    height: f64,
    /// An upper bound of the radius.
    radius: f64,
}

/// A ray in the coordinates of the solver: relative to the base of the surface, and to a point of the ray near it.
#[derive(Clone, Copy)]
struct Local {
    /// The distance of that point along the ray.
    start: f64,
    /// The point.
    at: [DoubleDouble; 3],
    dir: [f64; 3],
    /// The ends of the part of the ray that can meet the surface, as distances from that point.
    from: f64,
    to: f64,
}

/// Bounds of the surface's function and of its first derivative, at a point or on a whole piece.
struct Bounds {
    value: Interval,
    slope: Interval,
}

/// An upper bound of the error of [`DoubleDouble`] arithmetic, for numbers of magnitude 1.
const ERROR: f64 = 1e-28;

/// The maximum number of pieces for one ray.
const MOST_PIECES: usize = 100_000;

impl Revolution {
    /// Makes the surface of a formula's curve, from a base to a height above it.
    pub fn new(formula: &str, base: DVec3, height: f64) -> Self {
        const PIECES: i32 = 1024;
        let formula = Formula::parse(formula).expect("a formula");
        let end = |index: i32| height * f64::from(index) / f64::from(PIECES);
        let radius = (0..PIECES).map(|piece| {
            let heights = Interval { low: end(piece), high: end(piece + 1).next_up() };
            formula.at(heights).magnitude()
        });
        let radius = radius.fold(0.0, f64::max);
        Self { formula, base, height, radius }
    }

    /// Returns the radius at a height, and its derivative.
    pub fn line(&self, y: f64) -> Dual {
        self.formula.at(Dual::variable(y))
    }

    /// Returns the point of the axis at height 0.
    pub fn base(&self) -> DVec3 {
        self.base
    }

    /// Returns the length of the surface along its axis.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// Returns an upper bound of the radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the first hit of a ray beyond `near`.
    pub fn first_hit(&self, ray: &Ray, near: f64, crossings: Crossings) -> Truth {
        match self.clip(ray, near) {
            Some(local) => Search { surface: self, ray: local, near, crossings }.run(),
            None => Truth::Miss,
        }
    }

    /// Returns the distance from the surface of the point at a distance along a ray, to first order.
    pub fn off_surface(&self, ray: &Ray, distance: f64) -> f64 {
        let [x, y, z] = self.place_along(ray, distance);
        let Dual { value: radius, slope } = self.formula.at(Dual::variable(y));
        let value = (x * x + z * z - radius * radius).high;
        // The length of the gradient of x^2 + z^2 - g(y)^2 at a point of the surface.
        let gradient = 2.0 * radius.high * slope.high.hypot(1.0);
        (value / gradient).abs()
    }

    /// Returns the height above the base of the point at a distance along a ray.
    pub fn height_at(&self, ray: &Ray, distance: f64) -> f64 {
        self.place_along(ray, distance)[1].high
    }

    /// Returns the point at a distance along a ray, relative to the base.
    fn place_along(&self, ray: &Ray, distance: f64) -> [DoubleDouble; 3] {
        let (origin, base, dir) = (ray.origin.to_array(), self.base.to_array(), ray.dir.to_array());
        std::array::from_fn(|axis| {
            DoubleDouble::difference(origin[axis], base[axis])
                + DoubleDouble::from(distance) * DoubleDouble::from(dir[axis])
        })
    }

    /// Returns the part of a ray beyond `near` that lies between the surface's two ends and in a cylinder around it, or
    /// slightly more.
    fn clip(&self, ray: &Ray, near: f64) -> Option<Local> {
        let [x, y, z] = self.place_along(ray, 0.0);
        let [dx, dy, dz] = ray.dir.to_array().map(DoubleDouble::from);
        let (mut from, mut to) = (DoubleDouble::from(near), DoubleDouble::from(1e200));
        if !dy.is_zero() {
            let (bottom, top) = (-y / dy, (DoubleDouble::from(self.height) - y) / dy);
            (from, to) = (from.max(bottom.min(top)), to.min(bottom.max(top)));
        } else if y.is_negative() || DoubleDouble::from(self.height) < y {
            return None;
        }
        let across = dx * dx + dz * dz;
        if !across.is_zero() {
            let nearest = -(x * dx + z * dz) / across;
            let (x, z) = (x + nearest * dx, z + nearest * dz);
            let radius = DoubleDouble::from(1.01 * self.radius);
            let room = radius * radius - x * x - z * z;
            if room.is_negative() {
                return None;
            }
            let half = (room / across).sqrt();
            (from, to) = (from.max(nearest - half), to.min(nearest + half));
        }
        if to < from {
            return None;
        }
        let start = ((from + to) / DoubleDouble::from(2.0)).high;
        let [from, to] = [from, to].map(|end| (end - start.into()).high);
        let slack = 1e-12 * (to - from) + f64::MIN_POSITIVE;
        let at = self.place_along(ray, start);
        Some(Local { start, at, dir: ray.dir.to_array(), from: from - slack, to: to + slack })
    }

    /// Returns the surface's function along a ray, with its derivative: positive outside.
    fn function(&self, ray: &Local, t: DoubleDouble) -> Dual<DoubleDouble> {
        let t = Dual::variable(t);
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let place = Dual { value: ray.at[axis], slope: 0.0.into() };
            place + t * Dual::constant(ray.dir[axis])
        });
        x * x + z * z - self.formula.at(y).powi(2)
    }

    /// Returns certain bounds of the surface's function at a place of a ray.
    fn around(&self, ray: &Local, t: f64) -> Interval {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| wide(ray.at[axis]) + Interval::constant(t) * Interval::constant(ray.dir[axis]));
        x.powi(2) + z.powi(2) - self.formula.at(y).powi(2)
    }

    /// Returns certain bounds of the surface's function on a piece of a ray, and of its first and second derivatives.
    fn bounds(&self, ray: &Local, piece: Interval) -> Dual<Dual<Interval>> {
        let t = Dual::variable(Dual::variable(piece));
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let place = Dual { value: wide(ray.at[axis]), ..Dual::constant(0.0) };
            let place = Dual { value: place, ..Dual::constant(0.0) };
            place + t * Dual::constant(ray.dir[axis])
        });
        x.powi(2) + z.powi(2) - self.formula.at(y).powi(2)
    }
}

/// Returns an interval that contains a number.
fn wide(number: DoubleDouble) -> Interval {
    Interval::constant(number.high) + Interval::constant(number.low)
}

/// Tells whether a number is negative, by its bounds, and only where these do not decide, by more of its digits.
fn is_negative(bounds: Interval, number: impl FnOnce() -> DoubleDouble) -> bool {
    if bounds.has_zero() { number().is_negative() } else { bounds.high < 0.0 }
}

struct Search<'s> {
    surface: &'s Revolution,
    ray: Local,
    near: f64,
    crossings: Crossings,
}

/// What is known of a piece of a ray.
enum Piece {
    /// The piece has no root.
    Empty,
    /// The piece has at most one root, and has one if the signs at its ends differ.
    Monotone,
    /// Nothing is known.
    Open,
}

/// What a ray crosses where the function changes its sign.
#[derive(PartialEq)]
enum Kind {
    /// A point where the function is 0.
    Root,
    /// A point where the function jumps, as at a stair's step, or where its slope does.
    Ledge,
}

impl Search<'_> {
    fn run(&self) -> Truth {
        let mut pieces = vec![(self.ray.from, self.ray.to)];
        let finest = 4.0 * f64::EPSILON * self.ray.from.abs().max(self.ray.to.abs());
        for _ in 0..MOST_PIECES {
            let Some((from, to)) = pieces.pop() else { return Truth::Miss };
            let is_finest = to - from <= finest;
            match self.examine(from, to) {
                Piece::Empty => {}
                Piece::Monotone => {
                    if let Some(hit) = self.crossing(from, to, Kind::Root) {
                        return Truth::Hit(hit);
                    }
                }
                Piece::Open if is_finest && self.is_inside(from) != self.is_inside(to) => {
                    if let Some(hit) = self.crossing(from, to, Kind::Ledge) {
                        return Truth::Hit(hit);
                    }
                }
                Piece::Open if is_finest && self.may_touch(from, to) => return Truth::Undecided,
                Piece::Open if is_finest => {}
                Piece::Open => {
                    let middle = from + (to - from) / 2.0;
                    pieces.extend([(middle, to), (from, middle)]);
                }
            }
        }
        Truth::Undecided
    }

    fn examine(&self, from: f64, to: f64) -> Piece {
        let whole = self.surface.bounds(&self.ray, Interval { low: from, high: to });
        if !whole.value.value.has_zero() {
            return Piece::Empty;
        }
        if !whole.value.slope.has_zero() {
            return Piece::Monotone;
        }
        let middle = from + (to - from) / 2.0;
        let half = (to - middle).max(middle - from).next_up();
        let Bounds { value, slope } = self.at(middle, half);
        // Outward rounding covers the rounding errors of these products and sums.
        let reach = Interval { low: -half, high: half };
        let bend = whole.slope.slope;
        let value = value + slope * reach + Interval::constant(0.5) * bend * reach.powi(2);
        let slope = slope + bend * reach;
        if !value.has_zero() {
            Piece::Empty
        } else if !slope.has_zero() {
            Piece::Monotone
        } else {
            Piece::Open
        }
    }

    /// Returns the function and its slope at the centre of a piece, with a precision that fits the length of the piece.
    fn at(&self, t: f64, half: f64) -> Bounds {
        let reach = self.ray.to - self.ray.from;
        if half > 1e-4 * reach {
            let there = self.surface.bounds(&self.ray, Interval::constant(t));
            return Bounds { value: there.value.value, slope: there.value.slope };
        }
        let Dual { value, slope } = self.surface.function(&self.ray, t.into());
        let size = self.surface.radius + reach;
        let steep = 1.0 + slope.high.abs() / size;
        let around = |number: DoubleDouble, error: f64| {
            let error = DoubleDouble::from(error);
            Interval { low: (number - error).high.next_down(), high: (number + error).high.next_up() }
        };
        Bounds {
            value: around(value, ERROR * size * size * steep),
            slope: around(slope, ERROR * size * steep),
        }
    }

    /// Tells whether the ray may touch the surface on a piece of a few ulps whose ends are on one side. Beside a ledge
    /// the bounds do not decide, but the function is far from 0.
    fn may_touch(&self, from: f64, to: f64) -> bool {
        let size = self.surface.radius + self.ray.to - self.ray.from;
        let is_near = |t: f64| {
            let value = self.surface.function(&self.ray, t.into()).value;
            value.high.abs() < 1e-13 * size * size
        };
        is_near(from) || is_near(to)
    }

    fn is_inside(&self, t: f64) -> bool {
        is_negative(self.surface.around(&self.ray, t), || self.surface.function(&self.ray, t.into()).value)
    }

    /// Returns the only root of a piece, if there is one and it counts.
    fn crossing(&self, from: f64, to: f64, kind: Kind) -> Option<Hit> {
        let inside_at_first = self.is_inside(from);
        if inside_at_first == self.is_inside(to) {
            return None;
        }
        let (mut low, mut high) = (DoubleDouble::from(from), DoubleDouble::from(to));
        let mut t = DoubleDouble::from(self.guess(from, to, inside_at_first));
        let half = DoubleDouble::from(0.5);
        let mut slope = DoubleDouble::from(0.0);
        // Newton steps, and bisection where these leave the bracket.
        for _ in 0..120 {
            let value;
            Dual { value, slope } = self.surface.function(&self.ray, t);
            if value.is_negative() == inside_at_first {
                low = t;
            } else {
                high = t;
            }
            let step = t - value / slope;
            let next = if low <= step && step <= high { step } else { low + (high - low) * half };
            let moved = (next - t).high.abs();
            t = next;
            if moved <= 1e-30 * (self.ray.to - self.ray.from) || high <= low {
                break;
            }
        }
        let distance = t + self.ray.start.into();
        let is_surface = match kind {
            Kind::Root => self.is_surface(t),
            // A ledge has two sides.
            Kind::Ledge => self.is_surface(low) && self.is_surface(high),
        };
        let sign = if inside_at_first { 1.0 } else { -1.0 };
        let slope = match kind {
            Kind::Root => slope.high,
            Kind::Ledge => sign,
        };
        let counts = DoubleDouble::from(self.near) < distance && is_surface && self.crossings.count(sign);
        counts.then_some(Hit { t: distance, slope })
    }

    /// Tells whether there is a surface at the height of this point of the ray.
    fn is_surface(&self, t: DoubleDouble) -> bool {
        let y = self.ray.at[1] + t * self.ray.dir[1].into();
        let radius = &self.surface.formula;
        !y.is_negative()
            && y <= self.surface.height.into()
            && !is_negative(radius.at(wide(y)), || radius.at(y))
    }

    /// Returns the root of a piece to about the precision of `f64`.
    fn guess(&self, from: f64, to: f64, inside_at_first: bool) -> f64 {
        let [at, dir] = [self.ray.at.map(|number| number.high), self.ray.dir];
        let function = |t: f64| {
            let t = Dual::variable(t);
            let [x, y, z] = [0, 1, 2].map(|axis| Dual::constant(at[axis]) + t * Dual::constant(dir[axis]));
            x * x + z * z - self.surface.formula.at(y).powi(2)
        };
        let (mut low, mut high) = (from, to);
        let mut t = low + (high - low) / 2.0;
        for _ in 0..60 {
            let Dual { value, slope } = function(t);
            if (value < 0.0) == inside_at_first {
                low = t;
            } else {
                high = t;
            }
            let step = t - value / slope;
            let next = if low <= step && step <= high { step } else { low + (high - low) / 2.0 };
            if (next - t).abs() <= 2.0 * f64::EPSILON * t.abs() {
                break;
            }
            t = next;
        }
        t
    }
}
