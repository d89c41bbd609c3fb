//! Implicit surfaces: the points where f(x, y, z) = 0.
//!
//! A plugin gives the formula, once for every number type, and a bounding box. The rest follows: [`taylor`] isolates a
//! ray's first hit by interval arithmetic, or if the formula is a polynomial by its Bernstein coefficients along the ray,
//! and [`Dual`] numbers give the normal.

mod finely;
mod formula;

use crate::geometry::aabb::Aabb;
use crate::geometry::facet::Facet;
use crate::geometry::frame::{self, BLUR, Frame};
use crate::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use crate::geometry::sight::Line;
use crate::world::body::Body;
use crate::world::certify::Equation;
use crate::world::coincidence::ROUNDING;
use crate::world::hittable::{Bracketed, Certified, Facts, Hittable, Searched, Shape};
use crate::world::packets::shape::by_distance;
use finely::ExactRay;
pub use formula::Implicit;
use glam::{DVec2, DVec3};
use std::ops::Range;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::{Coefficient, MOST, Polynomial};
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::roots::taylor::{self, FirstRoot, SignChange};
use tabray_exact::roots::{Method, twice};
use tabray_exact::scalar::Scalar;

/// The number of plain rays that take as long as a search: that in a torus takes 25, that in a heart 60.
const RAYS_PER_SEARCH: u32 = 32;

/// The number of pieces that are judged of a ray that is rounded by more than the size of the shape: `f64` can hardly tell
/// where it is hit, however many pieces there are.
const FEW_PIECES: usize = 32;

/// The number of pieces that are judged of a ray that stands for others, as a copy's does. A ray that takes more is
/// proven.
const MOST_DRIFTING: usize = 256;

/// The maximum number of roots along a ray where the surface is cut away, for another method than the shape's own.
const MOST_CUT: usize = 64;

impl Body {
    /// Makes an object of an implicit surface with the reflectivities of its material.
    pub fn implicit(formula: impl Implicit + 'static, frame: Frame) -> Self {
        let [low, high] = formula.bounds();
        let diagonal = Polynomial::<f64, MOST>::along(Interval { low: -1.0, high: 1.0 });
        let degree = formula.along([diagonal; 3]).degree();
        let shape = ImplicitShape { formula, degree, frame, low, high };
        Self::plain(Shape::new(shape).bracketed().searched())
    }
}

/// A shape whose hits and normals are found by its formula.
struct ImplicitShape<T> {
    formula: T,
    /// The degree of the formula's [`polynomial`](Implicit::polynomial), if there is one.
    degree: Option<usize>,
    frame: Frame,
    low: DVec3,
    high: DVec3,
}

impl<T: Implicit> Hittable for ImplicitShape<T> {
    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.formula.uv(self.frame.point(at))
    }

    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let line = FormulaOnRay::new(self, ray);
        line.distance(line.first_hit(range).root, range)
    }

    /// Returns the normalized gradient of the formula. Where the gradient vanishes or does not exist, as at the tip of
    /// a cone, the normal points away from the shape's origin, and at the origin along its y axis.
    fn normal(&self, at: DVec3) -> DVec3 {
        let at = self.frame.point(at);
        let slope = |axis: usize| {
            let along =
                |own: usize| if own == axis { Dual::variable(at[own]) } else { Dual::constant(at[own]) };
            self.formula.value([along(0), along(1), along(2)]).slope
        };
        let normal =
            direction(DVec3::new(slope(0), slope(1), slope(2))).or(direction(at)).unwrap_or(DVec3::Y);
        self.frame.axes * normal
    }

    fn facts(&self) -> Facts {
        let own = Aabb { low: self.low, high: self.high };
        Facts { is_two_sided: true, may_be_costly: true, ..Facts::within(self.frame.bounds(&own)) }
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        self.formula.why_not_closed()
    }

    /// Returns the same cost for all rays that enter the box, because a search that is repeated to count it takes as
    /// long as the first one.
    fn search_cost(&self, ray: &Ray, _origin_side: Option<Side>) -> u32 {
        let outer = FormulaOnRay::new(self, ray).stretch().outer;
        if outer.start <= outer.end { RAYS_PER_SEARCH } else { 0 }
    }

    fn method(&self) -> String {
        let means =
            if self.degree.is_some() { "coefficients of a polynomial" } else { "interval arithmetic" };
        format!("first root isolated by {means}, then polished")
    }
}

impl<T: Implicit> Bracketed for ImplicitShape<T> {
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if !ray.is_single() {
            return FormulaOnRay::new(self, ray).within(ray.drift).bracket(range);
        }
        let is_on_surface = || self.is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| {
            let line = FormulaOnRay { by_proof: true, ..FormulaOnRay::new(self, ray) };
            let FirstRoot { root, is_certain } = line.first_hit(range);
            is_certain.then(|| line.distance(root, range))
        })
    }

    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

impl<T: Implicit> Certified for ImplicitShape<T> {
    fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        let height = self.formula.extruded()?;
        let size = (at.abs() + self.frame.origin.abs()).element_sum();
        // The box that extends the error along each axis reaches no farther along any other one.
        let (at, error) = (self.frame.point(at), 1.75 * error + ROUNDING * size);
        let is_upward = at.y > 0.5 * height;
        let end = if is_upward { height } else { 0.0 };
        let is_alone = (at.y - end).abs() + error < 0.25 * height;
        let around = |place: f64| Interval { low: place - error, high: place + error };
        let amid = self.formula.value([around(at.x), Interval::constant(0.5 * height), around(at.z)]);
        (is_alone && amid.high < 0.0).then(|| self.frame.facet(end, is_upward))
    }
}

impl<T: Implicit> Searched for ImplicitShape<T> {
    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> f64 {
        let line = FormulaOnRay::new(self, ray);
        let (Stretch { outer, .. }, mut left) = (line.stretch(), *range);
        for _ in 0..MOST_CUT {
            let root = method.first_root(&line, outer.clone(), line.closest, &left, shortest(&outer));
            match root {
                Some(root) if self.formula.is_cut() && !line.kept(root).is_kept => {
                    // A method may find the root where it starts again, unless it knows that the line leaves there.
                    let rises = taylor::FunctionOnLine::at(&line, Dual::variable(root)).slope > 0.0;
                    left.origin_side = Some(if rises { Side::Outside } else { Side::Inside });
                    left.near = line.closest + root;
                }
                root => return line.distance(root, range),
            }
        }
        MISS
    }
}

impl<T: Implicit> Equation for ImplicitShape<T> {
    fn to_local<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        self.frame.line(line)
    }

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.value(at)
    }

    fn is_polynomial(&self) -> bool {
        self.degree.is_some()
    }

    fn along<C: Coefficient, const N: usize>(&self, at: [Polynomial<C, N>; 3]) -> Polynomial<C, N> {
        self.formula.along(at)
    }

    fn field(&self) -> Option<&Field> {
        self.formula.field()
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        self.formula.uv_bounds(at)
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        let inside = |axis: usize| {
            let (low, high) = (N::constant(self.low[axis]), N::constant(self.high[axis]));
            (at[axis] - low).min(high - at[axis])
        };
        inside(0).min(inside(1)).min(inside(2)).min(self.formula.inside_trim(at))
    }

    fn extent(&self) -> [DVec3; 2] {
        [self.low, self.high]
    }
}

/// Returns the unit vector along a vector of any length, or `None` if it has no direction.
fn direction(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

/// Whether a surface is kept at a root, and whether that is certain in `f64`.
struct Kept {
    is_kept: bool,
    is_certain: bool,
}

/// A formula along a ray.
struct FormulaOnRay<'s, T> {
    shape: &'s ImplicitShape<T>,
    /// The ray in the shape's own coordinates, starting at its point closest to the shape's origin, so that distant
    /// shapes are hit as precisely as near ones.
    base: DVec3,
    dir: DVec3,
    /// A bound of the error of each coordinate of that point, in world units.
    blur: f64,
    /// A bound of the error of each component of the direction.
    turn: f64,
    /// Whether a root counts only where bounds in `f64` prove it.
    by_proof: bool,
    /// The ray in the world, and the distance of that point along it, in world units.
    ray: &'s Ray,
    closest: f64,
}

impl<'s, T: Implicit> FormulaOnRay<'s, T> {
    fn new(shape: &'s ImplicitShape<T>, ray: &'s Ray) -> Self {
        let closest = (shape.frame.origin - ray.origin).dot(ray.dir);
        let base = shape.frame.direction(shape.frame.from_origin(ray, closest));
        let dir = shape.frame.direction(ray.dir);
        Self { shape, base, dir, blur: frame::blur(base, closest), turn: BLUR, by_proof: false, ray, closest }
    }

    /// Returns the formula along the ray as it is given.
    fn exactly(&self) -> ExactRay<'s, T> {
        let ImplicitShape { formula, frame, .. } = self.shape;
        ExactRay { formula, frame, ray: self.ray, closest: self.closest }
    }

    /// Stands for all rays within a drift.
    fn within(self, drift: RayError) -> Self {
        let blur = self.blur + drift.origin + self.closest.abs() * drift.dir;
        Self { blur, turn: self.turn + drift.dir, by_proof: true, ..self }
    }

    /// Returns a bracket of the first hits of all rays that this one stands for.
    fn bracket(&self, range: &RayRange) -> Bracket {
        let stretch = self.stretch();
        let root = match self.first_root(&stretch, range, MOST_DRIFTING) {
            FirstRoot { root: Some(root), is_certain: true } => root,
            FirstRoot { root: None, is_certain: true } => return Bracket::MISS,
            _ => return Bracket::UNKNOWN,
        };
        let start = taylor::FunctionOnLine::at(self, Interval::<f64>::constant(stretch.outer.start));
        let rounding = 4.0 * f64::EPSILON * (self.closest.abs() + root.abs());
        let width = 4.0 * (self.blur + self.turn * root.abs()) + rounding;
        let Some(SignChange { low, high, rises }) = taylor::bracket(self, root, width) else {
            return Bracket::UNKNOWN;
        };
        // The function does not cross 0 from the start to the root, and so has the sign there that it starts with.
        let is_first = if rises { start.high < 0.0 } else { start.low > 0.0 };
        let is_kept = !self.shape.formula.is_cut()
            || self.shape.formula.inside_trim(self.on_line(Interval { low, high })).low >= 0.0;
        if is_first && is_kept {
            let near = (self.closest + low - rounding).max(0.0);
            Bracket { near, far: self.closest + high + rounding }
        } else {
            Bracket::UNKNOWN
        }
    }

    /// Returns the part of the ray in the box, from the ray's origin on, whatever the range is: so a hit is the same in
    /// every range that contains it.
    fn stretch(&self) -> Stretch {
        let ImplicitShape { low, high, .. } = self.shape;
        let reach = 2.0 * low.abs().max(high.abs()).element_sum();
        let mut stretch = Stretch::from(-self.closest..f64::INFINITY);
        for axis in 0..3 {
            stretch.cut(
                (self.base[axis], self.dir[axis]),
                [low[axis], high[axis]],
                [self.blur, self.turn],
                reach,
            );
        }
        stretch
    }

    /// Returns the first root of a stretch in a range, after judging at most this number of pieces.
    fn first_root(&self, stretch: &Stretch, range: &RayRange, mut pieces: usize) -> FirstRoot {
        let shortest = shortest(&stretch.outer);
        taylor::first_root_within(self, stretch, self.closest, range, shortest, &mut pieces)
    }

    /// Whether the ray is rounded by more than the size of the shape, where rounding is this fraction of that in `f64`.
    fn is_lost(&self, rounding: f64) -> bool {
        rounding * self.blur > (self.shape.high - self.shape.low).max_element()
    }

    fn first_hit(&self, range: &RayRange) -> FirstRoot {
        let stretch = self.stretch();
        let pieces = if self.is_lost(1.0) { FEW_PIECES } else { taylor::MAX_PIECES };
        if !self.shape.formula.is_cut() {
            return self.first_root(&stretch, range, pieces);
        }
        let (mut range, mut all_certain) = (*range, true);
        loop {
            let found = self.first_root(&stretch, &range, pieces);
            let kept = found.root.map(|root| self.kept(root));
            let Kept { is_kept, is_certain } = kept.unwrap_or(Kept { is_kept: true, is_certain: true });
            all_certain &= found.is_certain && is_certain;
            match found.root {
                Some(root) if !is_kept => range.near = self.closest + root,
                root => return FirstRoot { root, is_certain: all_certain },
            }
        }
    }

    /// Tells whether the surface is kept at a root. Where that is not certain in `f64`, it is decided at a
    /// root in double-double arithmetic.
    fn kept(&self, root: f64) -> Kept {
        let error = 4.0 * f64::EPSILON * root.abs() + self.blur;
        let at = self.on_line(Interval { low: root - error, high: root + error });
        let kept = self.shape.formula.inside_trim(at);
        if kept.low >= 0.0 || kept.high < 0.0 {
            return Kept { is_kept: kept.low >= 0.0, is_certain: true };
        }
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        let value = |t| self.shape.formula.value(exact.along(t));
        let start = DoubleDouble::from(root);
        let Dual { value, slope } = value(Dual::variable(start));
        let fine = start - value / slope;
        let kept = self.shape.formula.inside_trim(exact.along(Dual::<DoubleDouble>::fixed(fine))).value;
        Kept { is_kept: kept.high >= 0.0, is_certain: false }
    }

    /// Encloses the points at distances along every ray that this one may have been rounded from.
    fn on_line<N: Scalar>(&self, t: N) -> [N; 3] {
        let along =
            |axis: usize| N::about(self.base[axis], self.blur) + N::about(self.dir[axis], self.turn) * t;
        [along(0), along(1), along(2)]
    }

    /// Returns the distance of a root along the ray in the world; [`MISS`] for none, and outside of the range.
    fn distance(&self, root: Option<f64>, range: &RayRange) -> f64 {
        root.map_or(MISS, |root| range.keep(self.closest + root))
    }
}

/// Returns the length below which pieces of a span are not cut: four EPSILON, a few ulps, of its largest number.
fn shortest(span: &Range<f64>) -> f64 {
    4.0 * f64::EPSILON * span.start.abs().max(span.end.abs())
}

impl<T: Implicit> taylor::FunctionOnLine for FormulaOnRay<'_, T> {
    const VALUES_FIRST: bool = T::IS_IN_WIDE_BOX;

    fn at<N: Scalar>(&self, t: N) -> N {
        self.shape.formula.value(self.on_line(t))
    }

    fn is_broken(&self, piece: Interval) -> bool {
        self.shape.formula.field().is_some_and(|field| field.jumps_past_0(self.on_line(piece)))
    }

    fn is_left_out(&self, piece: Interval) -> bool {
        let formula = &self.shape.formula;
        formula.is_cut() && formula.inside_trim(self.on_line(piece)).high < 0.0
    }

    fn degree(&self) -> Option<usize> {
        self.shape.degree
    }

    fn polynomial<const N: usize>(&self, piece: Interval) -> Polynomial<f64, N> {
        self.shape.formula.along(self.on_line(Polynomial::along(piece)))
    }

    fn polished(&self, root: f64) -> f64 {
        let hidden = self.at(Interval::constant(root)).width();
        self.exactly().polished(root, hidden, self.at(Dual::variable(root)).slope.abs())
    }

    fn pieces(&self, ends: (f64, f64), mut visit: &mut dyn FnMut(f64, f64) -> Option<f64>) -> Option<f64> {
        match self.shape.formula.field().and_then(Field::cells) {
            Some(cells) => cells.visit(self.base.to_array(), self.dir.to_array(), ends, &mut visit),
            None => visit(ends.0, ends.1),
        }
    }

    fn wants_proof(&self) -> bool {
        self.by_proof
    }

    /// Decides a piece in double-double arithmetic from the ray in the world, which tells nearly all touches from
    /// misses.
    fn undecided(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        if self.is_lost(twice::STILL_HIDDEN) {
            return None;
        }
        if let Some(degree) = self.shape.degree {
            return self.exactly().first_root(degree, piece, origin_side);
        }
        let hidden = self.at(Interval::constant(piece.middle())).width();
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        twice::first_root(|t| self.shape.formula.value(exact.along(t)), piece, origin_side, hidden)
    }
}
