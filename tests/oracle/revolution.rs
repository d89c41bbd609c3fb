//! A curve turned about the y axis: its hits as the oracle finds them, and places on it, to aim rays at.

use super::{Crossings, Surface, Truth, spelt};
use glam::DVec3;
use tabray::exact::{Dual, Formula, Interval, double_double::DoubleDouble};
use tabray::geometry::Ray;

/// A curve x = g(y) turned about the y axis through a base. Where g is below 0 there is no surface.
pub struct Revolution {
    surface: Surface,
    formula: Formula,
    base: DVec3,
    height: f64,
    /// An upper bound of the radius.
    radius: f64,
}

impl Revolution {
    /// Makes the surface of a formula's curve, from a base to a height above it.
    pub fn new(formula: &str, base: DVec3, height: f64) -> Self {
        const PIECES: i32 = 1024;
        let place = format!("direction 0 1 0 base {} height {height:?}", spelt(base));
        let surface = Surface::read(&format!("revsurf r {{ profile \"{formula}\" {place} }}"));
        let formula = Formula::parse(formula).expect("a formula");
        let end = |index: i32| height * f64::from(index) / f64::from(PIECES);
        let radius = (0..PIECES).map(|piece| {
            let heights = Interval { low: end(piece), high: end(piece + 1).next_up() };
            formula.at(heights).magnitude()
        });
        let radius = radius.fold(0.0, f64::max);
        Self { surface, formula, base, height, radius }
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
    pub fn first_hit(&self, ray: &Ray, mut near: f64, crossings: Crossings) -> Truth {
        loop {
            match self.surface.first_hit(ray, near) {
                Truth::Hit(hit) if !crossings.count(hit.slope) => near = hit.t.high.next_up(),
                truth => return truth,
            }
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
}
