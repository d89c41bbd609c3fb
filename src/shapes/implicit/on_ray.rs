//! The formula of an implicit surface along a ray.

use super::finely::TrueRay;
use super::formula::Implicit;
use super::parts::Parts;
use glam::DVec3;
use std::ops::Range;
use std::sync::OnceLock;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::formula::along::AlongLines;
use tabray_exact::formula::cells::MARGIN;
use tabray_exact::formula::field::Field;
use tabray_exact::formula::nodes::{NearLine, Nodes};
use tabray_exact::formula::recorded::Recorded;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::Polynomial;
use tabray_exact::roots::bernstein::{Bernstein, NearRoot};
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::roots::taylor::{self, FirstRoot, SignChange};
use tabray_exact::roots::twice;
use tabray_exact::scalar::Scalar;
use tabray_world::certify::Equation;
use tabray_world::geometry::frame::{self, BLUR, Frame};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayError, RayRange, Side};

/// The maximum number of examined pieces on a ray with a rounding error larger than the shape. In `f64`, its hit is
/// hardly decidable with any number of pieces.
const FEW_PIECES: usize = 32;

/// The maximum number of operations of a search if each piece is evaluated once, as long as that leaves
/// [`MIN_PIECES`]. No ray takes longer, however often its formula oscillates.
const OPERATIONS: u64 = 20_000;

/// The number of pieces that may be examined for any formula.
const MIN_PIECES: usize = 128;

/// The maximum number of examined pieces on a ray that stands for others, such as a ray in the space of a copy. With
/// more pieces, a proof decides.
const MAX_DRIFTING: usize = 256;

/// A shape with hits and normals from its formula.
pub(super) struct ImplicitShape<T> {
    pub formula: T,
    /// The formula, once a proof has asked for it: proofs interpret it, to be compiled once and not for each formula.
    pub recorded: OnceLock<Recorded>,
    /// The [`polynomial`](Implicit::polynomial) of a formula that no scene gives.
    pub along_lines: Option<AlongLines>,
    /// The degree of that of any formula, if it is a polynomial.
    pub degree: Option<usize>,
    pub frame: Frame,
    pub low: DVec3,
    pub high: DVec3,
    pub parts: Parts,
    /// The maximum number of examined pieces on a ray.
    pub most_pieces: usize,
    /// The evaluation of the polynomial along lines, unless it is too long.
    pub nodes: Option<Nodes>,
}

impl<T: Implicit> ImplicitShape<T> {
    /// Returns the formula's value as it was recorded.
    pub fn value(&self) -> &Recorded {
        self.recorded.get_or_init(|| Recorded::of(|at| self.formula.value(at)))
    }

    /// Tells whether a root may be no hit, because the surface is cut off there or its formula is not defined.
    pub fn has_gaps(&self) -> bool {
        self.formula.is_cut() || self.formula.field().is_some_and(Field::divides)
    }

    /// Tells whether no divisor of the formula, as it was written, is 0 at the points of a box, or one is 0 at all of
    /// them; `None` if that is uncertain.
    fn is_defined(&self, at: [Interval; 3]) -> Option<bool> {
        match self.formula.field().filter(|field| field.divides()) {
            Some(field) => field.written().at(&at).is_defined(),
            None => Some(true),
        }
    }
}

/// Returns the maximum number of examined pieces on a ray, for a formula that takes so many operations.
pub(super) fn most_pieces(cost: u64) -> usize {
    ((OPERATIONS / cost.max(1)) as usize).clamp(MIN_PIECES, taylor::MAX_PIECES)
}

/// Whether a surface is kept at a root, and whether that is certain in `f64`.
pub(super) struct Kept {
    pub is_kept: bool,
    pub is_certain: bool,
}

/// A formula along a ray.
pub(super) struct FormulaOnRay<'s, T> {
    pub shape: &'s ImplicitShape<T>,
    /// The ray's point closest to the shape's origin, in the shape's own coordinates. From there, distant shapes are
    /// hit as precisely as near ones.
    pub base: DVec3,
    pub dir: DVec3,
    /// A bound of the error of each coordinate of that point, in world units.
    pub blur: f64,
    /// A bound of the error of each component of the direction.
    pub turn: f64,
    /// Whether only roots that are proven in `f64` count.
    pub by_proof: bool,
    /// The ray in world space, and the distance of `base` along it, in world units.
    pub ray: &'s Ray,
    pub closest: f64,
}

impl<'s, T: Implicit> FormulaOnRay<'s, T> {
    pub fn new(shape: &'s ImplicitShape<T>, ray: &'s Ray) -> Self {
        let closest = (shape.frame.origin - ray.origin).dot(ray.dir);
        let base = shape.frame.direction(shape.frame.from_origin(ray, closest));
        let dir = shape.frame.direction(ray.dir);
        Self { shape, base, dir, blur: frame::blur(base, closest), turn: BLUR, by_proof: false, ray, closest }
    }

    /// Returns the formula along the exact ray.
    pub fn exactly(&self) -> TrueRay<'s, T> {
        TrueRay { shape: self.shape, ray: self.ray, closest: self.closest }
    }

    /// Makes the ray stand for all rays within a drift.
    pub fn within(self, drift: RayError) -> Self {
        let blur = self.blur + drift.origin + self.closest.abs() * drift.dir;
        Self { blur, turn: self.turn + drift.dir, by_proof: true, ..self }
    }

    /// Returns a bracket of the first hits, for all rays that this one stands for.
    pub fn bracket(&self, range: &RayRange) -> Bracket {
        let stretch = self.stretch();
        let root = match self.first_root(&stretch, range, &mut MAX_DRIFTING.clone()) {
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
        // The function does not cross 0 before the root, and so has the same sign there as at the start.
        let is_first = if rises { start.high < 0.0 } else { start.low > 0.0 };
        let is_kept = !self.shape.has_gaps() || {
            let at = self.on_line(Interval { low, high });
            self.shape.formula.inside_trim(at).low >= 0.0 && self.shape.is_defined(at) == Some(true)
        };
        if is_first && is_kept {
            let near = (self.closest + low - rounding).max(0.0);
            Bracket { near, far: self.closest + high + rounding }
        } else {
            Bracket::UNKNOWN
        }
    }

    /// Returns the part of the ray in the box, from the ray's origin on. It does not depend on the range, and so a hit
    /// is the same in all ranges that contain it.
    pub fn stretch(&self) -> Stretch {
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

    /// Returns the first root of a stretch in a range, after examining at most `pieces` pieces, which it counts
    /// down.
    fn first_root(&self, stretch: &Stretch, range: &RayRange, pieces: &mut usize) -> FirstRoot {
        let shortest = shortest(&stretch.outer);
        taylor::first_root_within(self, stretch, self.closest, range, shortest, pieces)
    }

    /// Tells whether the ray's rounding error is larger than the shape, in arithmetic with `rounding` times the error
    /// of `f64`.
    pub fn is_lost(&self, rounding: f64) -> bool {
        rounding * self.blur > (self.shape.high - self.shape.low).max_element()
    }

    pub fn first_hit(&self, range: &RayRange) -> FirstRoot {
        let stretch = self.stretch();
        let mut pieces = if self.is_lost(1.0) { FEW_PIECES } else { self.shape.most_pieces };
        if !self.shape.has_gaps() {
            return self.first_root(&stretch, range, &mut pieces);
        }
        let (mut range, mut all_certain) = (*range, true);
        loop {
            let found = self.first_root(&stretch, &range, &mut pieces);
            let kept = found.root.map(|root| self.kept(root));
            let Kept { is_kept, is_certain } = kept.unwrap_or(Kept { is_kept: true, is_certain: true });
            all_certain &= found.is_certain && is_certain;
            match found.root {
                Some(root) if !is_kept => range.near = self.closest + root,
                root => return FirstRoot { root, is_certain: all_certain },
            }
        }
    }

    /// Tells whether the surface is kept at a root, and its formula defined. If `f64` does not decide whether it is cut
    /// off, the root is refined in double-double arithmetic.
    pub fn kept(&self, root: f64) -> Kept {
        let error = 4.0 * f64::EPSILON * root.abs() + self.blur;
        let at = self.on_line(Interval { low: root - error, high: root + error });
        if self.shape.is_defined(at) != Some(true) {
            // Only a divisor that is exactly 0, as along a ray in a plane of poles, leaves out what seems to be a root.
            let point = (self.base + root * self.dir).to_array().map(Interval::constant);
            return Kept { is_kept: self.shape.is_defined(point) != Some(false), is_certain: false };
        }
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

    /// Encloses the points at the distances `t` along all rays that may have been rounded to this one.
    pub fn on_line<N: Scalar>(&self, t: N) -> [N; 3] {
        let along =
            |axis: usize| N::about(self.base[axis], self.blur) + N::about(self.dir[axis], self.turn) * t;
        [along(0), along(1), along(2)]
    }

    /// Returns the distance of a root along the ray in world space, or [`MISS`] if there is none in the range.
    pub fn distance(&self, root: Option<f64>, range: &RayRange) -> f64 {
        root.map_or(MISS, |root| range.keep(self.closest + root))
    }
}

/// Returns the minimum length for halving pieces of a span: 4 EPSILON times its largest number.
pub(super) fn shortest(span: &Range<f64>) -> f64 {
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
        let is_free = || formula.field()?.cells().map(|cells| cells.are_free(self.on_line(piece)));
        formula.is_cut() && formula.inside_trim(self.on_line(piece)).high < 0.0 || is_free().unwrap_or(false)
    }

    fn degree(&self) -> Option<usize> {
        self.shape.degree
    }

    fn polynomial<const N: usize>(&self, piece: Interval) -> Polynomial<f64, N> {
        let at = self.on_line(Polynomial::along(piece));
        self.shape.polynomial().map_or_else(Polynomial::unknown, |along| along.polynomial(at))
    }

    fn form<const N: usize>(&self, piece: Interval) -> Option<Bernstein<f64, N>> {
        let by_nodes = |nodes: &Nodes| {
            let (base, dir) = (self.base.to_array(), self.dir.to_array());
            nodes.form(&NearLine { base, dir, blur: self.blur, turn: self.turn }, piece)
        };
        self.shape.nodes.as_ref().and_then(by_nodes).or_else(|| Bernstein::of(&self.polynomial(piece)))
    }

    fn finished(&self, near: &NearRoot, hidden: f64) -> Option<f64> {
        self.exactly().finished(near, hidden)
    }

    fn polished(&self, root: f64) -> f64 {
        let hidden = self.at(Interval::constant(root)).width();
        self.exactly().polished(root, hidden, self.at(Dual::variable(root)).slope.abs())
    }

    fn pieces(
        &self,
        ends: (f64, f64),
        far: f64,
        mut visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let ImplicitShape { formula, low, high, parts, .. } = self.shape;
        let error = self.blur + self.turn * ends.0.abs().max(ends.1.abs());
        // With small errors, a line is in the parts of the box where it seems to be, given their margins.
        let is_precise = error <= 0.5 * MARGIN * (*high - *low).min_element();
        if !is_precise {
            return visit(ends.0, ends.1);
        }
        match formula.field().and_then(Field::cells) {
            Some(cells) => cells.visit(self.base.to_array(), self.dir.to_array(), ends, &mut visit),
            None => parts.visit(formula, (self.base, self.dir), (ends, far), &mut visit),
        }
    }

    fn wants_proof(&self) -> bool {
        self.by_proof
    }

    /// Decides a piece in double-double arithmetic along the ray in world space, which distinguishes nearly all touches
    /// from misses.
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
