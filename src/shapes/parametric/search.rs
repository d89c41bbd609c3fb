//! The first hit of a line and a parametric surface.

use super::krawczyk::{Candidate, Judged};
use super::patch::{Patch, Patches, PatchesIn, Rectangle};
use super::shape::ParametricShape;
use super::tree::Flat;
use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use tabray_exact::double_double::power_of_two;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::sight::Line;

/// The maximum number of examined parts of the rectangle for a line.
const MAX_PATCHES: usize = 2048;

/// Returns the maximum number of steps of Krawczyk's method for a line. In 237 bits, each takes some thirty times as long.
fn max_steps<F: Float>() -> usize {
    if F::IS_LONG { 1024 } else { 2304 }
}

/// The maximum number of steps for a line whose t are nearly one within its error: without an order, only a line with
/// hardly a hit is decided, and that takes few steps.
const FEW_STEPS: usize = 16;

/// Returns the least error of a line, as a fraction of a surface's size, at which t have hardly an order. With 237 bits,
/// what is decided at all is decided far more finely.
fn blurring<F: Float>() -> F {
    F::of(if F::IS_LONG { power_of_two(-40) } else { 1.0 })
}

/// The maximum number of boxes that such a line is compared with. Where products overflow, it meets all.
const FEW_BOXES: usize = 1024;

/// The maximum width of the t of an undecided place at which the place counts as a hit, as a fraction of the
/// coordinates.
const NARROW: f64 = 1e-6;

pub(super) type LeavesOut<'s, F> = dyn Fn(Interval<F>, &Rectangle<F>, bool) -> bool + 's;

/// A search for the first hit with t > 0.
pub(super) struct Search<'s, F: Float> {
    pub(super) shape: &'s ParametricShape,
    line: &'s Line<Interval<F>>,
    /// The axis with the largest component of the line's direction, and the two others.
    axes: [usize; 3],
    /// Tells whether a hit does not count, given its t, the place of its u and v, and whether the place certainly has a
    /// hit.
    is_left_out: &'s LeavesOut<'s, F>,
    /// The number of steps of Krawczyk's method that are left.
    pub(super) steps_left: Cell<usize>,
}

/// A hit.
#[derive(Clone, Copy)]
pub(super) struct Hit<F> {
    pub t: Interval<F>,
    /// The u and v of the hit.
    pub place: Rectangle<F>,
    /// The index of the leaf with the hit.
    pub leaf: usize,
    /// Whether the hit may be beyond the ends of u and v, where the surface ends.
    pub is_edge: bool,
}

/// The result of a search.
pub(super) struct Found<F> {
    /// The first proven hit.
    pub hit: Option<Hit<F>>,
    /// The t from which on there may be unproven hits.
    pub undecided: Option<F>,
    /// The t of the first place that may have a hit and is not cut further.
    pub narrow: Option<Interval<F>>,
}

/// A part waiting for its test.
struct Part<F> {
    from: f64,
    /// The order in which parts were made. It decides between equal parts.
    number: usize,
    leaf: usize,
    part: Rectangle<F>,
}

impl<F> Ord for Part<F> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.from.total_cmp(&self.from).then(other.number.cmp(&self.number))
    }
}

impl<F> PartialOrd for Part<F> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<F> PartialEq for Part<F> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<F> Eq for Part<F> {}

impl<'s, F: Float> Search<'s, F>
where
    dyn Patches: PatchesIn<F>,
{
    pub fn new(
        shape: &'s ParametricShape,
        line: &'s Line<Interval<F>>,
        is_left_out: &'s LeavesOut<'s, F>,
    ) -> Self {
        let size = |axis: usize| line.dir[axis].middle().to_f64().abs();
        let steepest = (0..3).fold(0, |most, axis| if size(axis) > size(most) { axis } else { most });
        let axes = [steepest, (steepest + 1) % 3, (steepest + 2) % 3];
        Self { shape, line, axes, is_left_out, steps_left: Cell::new(max_steps::<F>()) }
    }

    pub fn first(&self) -> Found<F> {
        // All parts would be tried: the numbers of such a line are too large for the box test in `f64`.
        let mut blurred_from = None;
        if let Some(Aabb { low, high }) = self.shape.tree.bounds() {
            let nothing = Found { hit: None, undecided: None, narrow: None };
            let Some((entry, is_blurred)) = self.line.blurred(low, high) else { return nothing };
            let steepest = self.axes[0];
            let error = self.line.at(Interval::point(entry))[steepest].width();
            let has_no_order =
                is_blurred[steepest] || error > blurring::<F>() * F::of(high[steepest] - low[steepest]);
            // No part is told from others where products of the line's numbers overflow.
            let whole = per_axis(|axis| Interval { low: F::of(low[axis]), high: F::of(high[axis]) });
            let overflows = self.off(&whole).iter().any(|off| !off.is_bounded());
            if overflows || is_blurred == [true; 3] || has_no_order && !self.line.is_exact() {
                return Found { undecided: Some(entry), ..nothing };
            }
            if has_no_order {
                self.steps_left.set(FEW_STEPS);
                blurred_from = Some(entry);
            }
        }
        let (mut waiting, mut number) = (BinaryHeap::new(), 0);
        let mut found = Found { hit: None, undecided: None, narrow: None };
        // Tests in `f64` are faster, and come first.
        let line = Line { origin: self.line.origin.map(nearly), dir: self.line.dir.map(nearly) };
        let quick = Search::<f64>::new(self.shape, &line, &|_, _, _| false);
        // Without an order, the boxes are compared one by one, as long as that tells them apart.
        let mut boxes_left = if blurred_from.is_some() { FEW_BOXES } else { usize::MAX };
        quick.steps_left.set(if blurred_from.is_some() { 8 * FEW_STEPS } else { max_steps::<f64>() });
        self.shape.tree.along(&line, &mut |leaf| {
            boxes_left -= 1;
            if boxes_left == 0 {
                return f64::NEG_INFINITY;
            }
            let is_met = quick.may_meet(self.shape.tree.flat(leaf));
            let Aabb { low, high } = *self.shape.tree.around(leaf);
            if let Some((enters, _)) = line.clip(low, high).filter(|_| is_met) {
                let piece = self.shape.tree.piece(&*self.shape.patches, leaf);
                quick.candidates(piece, &mut |Candidate { part, from, single }| {
                    let from = from.max(enters).next_down();
                    if from > found.end() {
                        return;
                    }
                    let wide = part.map(Interval::from_f64);
                    if let Some(place) = single.and_then(|single| self.solved(&single, &wide)) {
                        self.add(&mut found, leaf, place);
                    } else if !(F::IS_LONG && matches!(quick.judged(&part), Judged::Free)) {
                        waiting.push(Part { from, number, leaf, part: wide });
                        number += 1;
                    }
                });
            }
            found.end()
        });
        if boxes_left == 0 {
            return Found { undecided: blurred_from, ..found };
        }
        let mut left = (if F::IS_LONG { MAX_PATCHES / 32 } else { MAX_PATCHES }).max(2 * number);
        while let Some(Part { from, leaf, part, .. }) = waiting.pop() {
            // Nothing that waits comes before what is known, or may be a hit.
            let is_behind = |t: Interval<F>| F::of(from) > t.high;
            if found.hit.is_some_and(|hit: Hit<F>| is_behind(hit.t)) || found.narrow.is_some_and(is_behind) {
                break;
            }
            if left == 0 || self.steps_left.get() == 0 {
                found.doubt(F::of(from));
                self.note_narrow(&mut found, self.t(&self.shape.patches.points(&part)), &part);
                break;
            }
            left -= 1;
            match self.judged(&part) {
                Judged::Free => {}
                Judged::One(place) => self.add(&mut found, leaf, place),
                Judged::In(place) => {
                    let t = self.t(&self.shape.patches.points(&place));
                    if t.high <= F::of(0.0) || self.is_off(&place) {
                        continue;
                    }
                    if !self.is_wide(&place) {
                        if !(self.is_left_out)(t, &place, false) {
                            found.doubt(t.low);
                        }
                        self.note_narrow(&mut found, t, &place);
                        continue;
                    }
                    let axis = self.longer(&place);
                    let (mut one, mut other, middle) = (place, place, place[axis].middle());
                    (one[axis].high, other[axis].low) = (middle, middle);
                    for part in [one, other] {
                        let from = t.low.to_f64().next_down().max(0.0);
                        waiting.push(Part { from, number, leaf, part });
                        number += 1;
                    }
                }
            }
        }
        found
    }

    /// Notes a place with undecided hits if its points are at nearly the same distance from the line's start. A pole is
    /// a single point, however wide its u is.
    fn note_narrow(&self, found: &mut Found<F>, t: Interval<F>, place: &Rectangle<F>) {
        let is_narrow = t.width().to_f64() <= NARROW * (t.high.to_f64().abs() + self.shape.size());
        if is_narrow && t.high > F::of(0.0) && !(self.is_left_out)(t, place, false) {
            found.narrow = Some(found.narrow.filter(|known| known.low <= t.low).unwrap_or(t));
        }
    }

    /// Adds the only solution of a place, if it is a hit.
    fn add(&self, found: &mut Found<F>, leaf: usize, place: Rectangle<F>) {
        let ends = self.shape.ends().map(Interval::<F>::from_f64);
        let is_in = |axis: usize| ends[axis].low <= place[axis].low && place[axis].high <= ends[axis].high;
        let mut t = self.t(&self.near(&place).at);
        if self.is_off(&place) || t.high <= F::of(0.0) || (self.is_left_out)(t, &place, true) {
            return;
        }
        if t.low <= F::of(0.0) {
            return found.doubt(F::of(0.0));
        }
        let mut is_edge = !(is_in(0) && is_in(1));
        if is_edge && let Some(on_end) = self.hit_on_an_end(&place, &ends) {
            (t, is_edge) = (t.hull(on_end), false);
        }
        let hit = Hit { t, place, leaf, is_edge };
        found.hit = Some(match found.hit {
            Some(known) if known.t.low <= t.high && t.low <= known.t.high => {
                if !meet(&known.place, &place) {
                    // Either of the two sheets may be hit first.
                    found.doubt(known.t.low.min(t.low));
                }
                let t = Interval { low: known.t.low.min(t.low), high: known.t.high.min(t.high) };
                Hit { t, is_edge: known.is_edge && hit.is_edge, ..known }
            }
            Some(known) if known.t.low <= t.low => known,
            _ => hit,
        });
    }

    /// Encloses the t of a hit at an end of u or of v near a place, if one certainly exists: in one of the two planes
    /// through the line lies all of the surface's edge there, and the edge crosses the other plane.
    fn hit_on_an_end(&self, place: &Rectangle<F>, ends: &Rectangle<F>) -> Option<Interval<F>> {
        let zero = F::of(0.0);
        (0..2).find_map(|axis| {
            let (own, across) = (place[axis], place[1 - axis]);
            let margin = F::of(16.0) * across.width();
            let across = across + Interval { low: -margin, high: margin };
            let is_in = ends[1 - axis].low <= across.low && across.high <= ends[1 - axis].high;
            let end = [ends[axis].low, ends[axis].high]
                .into_iter()
                .find(|end| is_in && own.low <= *end && *end <= own.high)?;
            let edge = |across: Interval<F>| {
                let mut edge = [Interval::point(end); 2];
                edge[1 - axis] = across;
                edge
            };
            let off = |across| self.off(&self.shape.patches.points(&edge(across)));
            let (all, [low, high]) =
                (off(across), [across.low, across.high].map(|at| off(Interval::point(at))));
            let crosses = |plane: usize| {
                low[plane].high < zero && high[plane].low > zero
                    || high[plane].high < zero && low[plane].low > zero
            };
            let is_hit = (0..2).any(|plane| all[plane].is_zero() && crosses(1 - plane));
            is_hit.then(|| self.t(&self.near(&edge(across)).at))
        })
    }

    /// Tells whether a place lies beyond the ends of u and v.
    fn is_off(&self, place: &Rectangle<F>) -> bool {
        let ends = self.shape.ends().map(Interval::<F>::from_f64);
        (0..2).any(|axis| place[axis].high < ends[axis].low || ends[axis].high < place[axis].low)
    }

    /// Encloses the points of a narrow place by the mean value form.
    fn near(&self, place: &Rectangle<F>) -> Patch<F> {
        let mut patch = self.shape.patches.patch(place);
        let middle = place.map(|side| Interval::point(side.middle()));
        let centre = self.shape.patches.points(&middle);
        for axis in 0..3 {
            let off = [0, 1].map(|side| patch.along[side][axis] * (place[side] - middle[side]));
            let by_slopes = centre[axis] + off[0] + off[1];
            let at = &mut patch.at[axis];
            *at = Interval { low: at.low.max(by_slopes.low), high: at.high.min(by_slopes.high) };
        }
        patch
    }

    /// Encloses the t of points on the line.
    pub(super) fn t(&self, at: &[Interval<F>; 3]) -> Interval<F> {
        let [axis, ..] = self.axes;
        (at[axis] - self.line.origin[axis]) / self.line.dir[axis]
    }

    /// Returns the left sides of the equations of two planes through the line.
    pub(super) fn off(&self, at: &[Interval<F>; 3]) -> [Interval<F>; 2] {
        self.across(&per_axis(|axis| at[axis] - self.line.origin[axis]))
    }

    /// Returns the components of a vector along the normals of these planes.
    pub(super) fn across(&self, vector: &[Interval<F>; 3]) -> [Interval<F>; 2] {
        let ([axis, one, other], dir) = (self.axes, &self.line.dir);
        let along = |side: usize| vector[side] * dir[axis] - vector[axis] * dir[side];
        [along(one), along(other)]
    }

    /// Tells whether a place is wide enough to be cut.
    pub(super) fn is_wide(&self, place: &Rectangle<F>) -> bool {
        let least = F::of(power_of_two(if F::IS_LONG { -120 } else { -40 }));
        let ends = self.shape.ends();
        (0..2).any(|axis| place[axis].width() > least * F::of(ends[axis].width()))
    }

    /// Returns the longer side of a place, relative to the rectangle.
    fn longer(&self, place: &Rectangle<F>) -> usize {
        let part = |axis: usize| place[axis].width().to_f64() / self.shape.ends()[axis].width();
        usize::from(part(1) > part(0))
    }
}

impl Search<'_, f64> {
    /// Tells whether the line may pass through the bounds of a leaf.
    fn may_meet(&self, flat: &Flat) -> bool {
        let n = Interval::<f64>::constant;
        let around = |of: [f64; 3]| self.across(&of.map(|value| Interval { low: -value, high: value }));
        let (middle, error) = (self.off(&flat.middle.map(n)), around(flat.error));
        let sides = flat.sides.map(|side| self.across(&side.map(n)));
        (0..2).all(|plane| {
            let reach = sides[0][plane].magnitude() + sides[1][plane].magnitude() + error[plane].magnitude();
            let apart = middle[plane].low.max(-middle[plane].high);
            // The comparison is false for NaN: unbounded leaves are not missed.
            let is_missed = apart > reach * (1.0 + ROUNDED);
            !is_missed
        })
    }
}

/// More than the error of a sum of three numbers, as a fraction of the sum.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Encloses numbers in doubles, exactly if they are doubles.
fn nearly<F: Float>(of: Interval<F>) -> Interval {
    let nearest = Interval { low: of.low.to_f64(), high: of.high.to_f64() };
    let is_same = F::of(nearest.low) == of.low && F::of(nearest.high) == of.high;
    if is_same { nearest } else { of.coarse() }
}

/// Tells whether two places may have a common point.
pub(super) fn meet<F: Float>(one: &Rectangle<F>, other: &Rectangle<F>) -> bool {
    (0..2).all(|axis| one[axis].low <= other[axis].high && other[axis].low <= one[axis].high)
}

impl<F: Float> Found<F> {
    /// Returns the t beyond which nothing matters.
    fn end(&self) -> f64 {
        self.hit.map_or(f64::INFINITY, |hit| hit.t.high.to_f64().next_up())
    }

    fn doubt(&mut self, from: F) {
        let from = from.max(F::of(0.0));
        self.undecided = Some(self.undecided.map_or(from, |known| known.min(from)));
    }
}
