//! First hits of rays that lie close together, such as the samples of a pixel, searched together.
//!
//! A beam is the set of all lines whose coordinates lie between those of its rays. Bounds of the formula and its slope
//! on a piece of the beam prove that no ray has a hit there, or that each ray has exactly one. Each ray then only
//! refines its own root. Where the bounds are not conclusive, the beam is halved, until each ray is searched alone.

use super::formula::Implicit;
use super::on_ray::{FormulaOnRay, ImplicitShape, shortest};
use glam::DVec3;
use std::array::from_fn;
use std::mem::take;
use std::ops::Range;
use tabray_exact::dual::Dual;
use tabray_exact::gradient::Gradient;
use tabray_exact::interval::Interval;
use tabray_exact::roots::newton;
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::roots::taylor::FunctionOnLine;
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::coincidence::close;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::{BEAM, RayPacket};
use tabray_world::hittable::{Bracketed, Certified};
use tabray_world::packets::shape::by_distance;

/// The minimum number of rays to search together.
const LEAST: usize = 4;

/// The maximum width of a beam, as a fraction of the longest side of the shape's box.
const WIDEST: f64 = 1.0 / 32.0;

/// The maximum number of examined pieces of a beam.
const MAX_PIECES: usize = 64;

/// The number of pieces of a beam if none is halved.
const PARTS: f64 = 8.0;

/// A piece shorter than this many times the width of the beam is not halved.
const SHORT: f64 = 0.25;

/// Closer bounds are computed on a piece if the middle of its bounds is farther from 0 than this fraction of the
/// largest change of the formula from there.
const AWAY: f64 = 0.25;

/// A ray of a beam.
struct Member<'s, T> {
    lane: usize,
    line: FormulaOnRay<'s, T>,
    stretch: Stretch,
    /// The searched part of the line.
    span: Range<f64>,
}

/// The lines `base + t dir`, for all numbers between these bounds.
struct Beam<'s, T> {
    formula: &'s T,
    base: [Interval; 3],
    dir: [Interval; 3],
    /// The end of all lines.
    to: f64,
    side: Option<Side>,
    /// The maximum width of a beam.
    widest: f64,
}

/// A part of a beam where the formula is strictly monotonic along each line.
#[derive(Clone, Copy)]
struct Run {
    start: f64,
    rises: bool,
    /// Whether the formula is above 0 at the start of the part, or `None` if that is unknown for some lines.
    was_above: Option<bool>,
}

/// The progress of a search that has found no valid root yet.
#[derive(Clone, Copy)]
struct Search {
    /// Where the search started, and the place that it has reached.
    from: f64,
    at: f64,
    /// The length of the next piece.
    step: f64,
    /// Whether the formula is above 0 at `at`, or `None` if that is unknown for some lines.
    is_above: Option<bool>,
    run: Option<Run>,
}

/// Known facts about the first valid roots.
#[derive(Clone, Copy)]
enum Found {
    /// No line has a root.
    None,
    /// Each line has a single root between these places, and none before.
    Between { low: f64, high: f64, rises: bool },
}

/// The reason why a search ended without the roots.
enum Open {
    /// A narrower beam would have closer bounds.
    Wide,
    Lost,
}

/// Computes brackets of the first hits of up to [`BEAM`] rays, each in its own range.
pub(super) fn bracket_each<T: Implicit>(
    shape: &ImplicitShape<T>,
    rays: RayPacket,
    ranges: &[RayRange],
    brackets: &mut [Bracket],
) {
    let singles: [Ray; BEAM] = from_fn(|lane| rays.get(lane.min(ranges.len() - 1)));
    let is_as_before = |lane: &usize| {
        let [one, other] = [lane - 1, *lane].map(|lane| (&singles[lane], &ranges[lane]));
        let of =
            |(ray, range): (&Ray, &RayRange)| (ray.origin, ray.dir, range.near, range.far, range.origin_side);
        of(one) == of(other)
    };
    // Packets are filled up with copies of their last ray.
    let own = ranges.len() - (1..ranges.len()).rev().take_while(is_as_before).count();
    let (first, rest) = (&ranges[0], &ranges[1..own]);
    // For a formula with cells, bounds on a piece of a beam would need the long program of a large cell.
    let has_cells = shape.formula.field().is_some_and(|field| field.cells().is_some());
    let is_together = own >= LEAST
        && rays.drift.is_none()
        && !shape.formula.is_cut()
        && shape.degree.is_none()
        && !has_cells
        && rest.iter().all(|range| range.origin_side == first.origin_side);
    let mut members = Vec::with_capacity(BEAM);
    for lane in 0..own {
        let (ray, range) = (&singles[lane], &ranges[lane]);
        if !is_together {
            brackets[lane] = shape.t_bounds(&RayBall { ray: *ray, drift: rays.drift }, range);
            continue;
        }
        let line = FormulaOnRay::new(shape, ray);
        let stretch = line.stretch();
        let end = if range.far < MISS { range.far + close(ray, range.far) } else { MISS };
        let start = stretch.outer.start.max(range.near - line.closest);
        let span = start..stretch.outer.end.min(end - line.closest);
        if range.far <= range.near {
            brackets[lane] = Bracket::MISS;
        } else if span.start <= span.end {
            members.push(Member { lane, line, stretch, span });
        } else {
            brackets[lane] = bracket(shape, ray, range, MISS);
        }
    }
    together(shape, &mut members, None, ranges, brackets);
    let last = brackets[own - 1];
    brackets[own..].fill(last);
}

/// Searches some rays together or in halves, from the place that an earlier search of them together reached.
fn together<T: Implicit>(
    shape: &ImplicitShape<T>,
    members: &mut [Member<T>],
    before: Option<Search>,
    ranges: &[RayRange],
    brackets: &mut [Bracket],
) {
    let own = Search::of(members);
    let mut search = before.filter(|before| before.at >= own.from).unwrap_or(own);
    let is_begun = before.is_some_and(|before| before.at > before.from);
    let found = if members.len() >= LEAST || is_begun {
        Beam::around(shape, members, ranges[members[0].lane].origin_side).first_roots(&mut search)
    } else {
        Err(Open::Lost)
    };
    let found = match found {
        Ok(found) => found,
        Err(Open::Wide) if members.len() > 1 => {
            sort(members, search.at);
            let (one, other) = members.split_at_mut(members.len() / 2);
            together(shape, one, Some(search), ranges, brackets);
            return together(shape, other, Some(search), ranges, brackets);
        }
        Err(_) => {
            for Member { lane, line, .. } in &*members {
                brackets[*lane] = shape.t_bounds(&line.ray.into(), &ranges[*lane]);
            }
            return;
        }
    };
    let mut near = None;
    for member in &*members {
        let Member { lane, line, .. } = member;
        let root = match found {
            Found::Between { low, high, rises } if low <= member.span.end => {
                let ends = member.ends((low, high), rises);
                ends.map(|ends| {
                    ends.map(|ends| root(line, ends, rises, shortest(&member.stretch.outer), &mut near))
                })
            }
            _ => Some(None),
        };
        let (ray, range) = (line.ray, &ranges[*lane]);
        brackets[*lane] = match root {
            Some(root) => bracket(shape, ray, range, root.map_or(MISS, |root| line.closest + root)),
            None => shape.t_bounds(&ray.into(), range),
        };
    }
}

impl<T: Implicit> Member<'_, T> {
    /// Returns bounds of the line's root, given bounds of the roots of all lines of the beam. Returns `Some(None)` if
    /// the line ends before its root, and `None` if that is unknown.
    fn ends(&self, (low, high): (f64, f64), rises: bool) -> Option<Option<(f64, f64)>> {
        let Self { line, stretch, span, .. } = self;
        let is_after = |low: f64, high: f64| {
            let value = line.at(Interval { low, high });
            (!value.has_zero()).then_some(rises == (value.low > 0.0))
        };
        let start = if span.start < stretch.inner.start { stretch.inner.start } else { span.start };
        let end = if span.end > stretch.inner.end { stretch.inner.end } else { span.end };
        // The root may lie before the line's start, and be followed by others.
        if start > high || start > low && is_after(span.start.min(start), start)? {
            return None;
        }
        let has_root = end >= high || is_after(end, span.end)?;
        Some(has_root.then_some((low.max(start), high.min(end))))
    }
}

/// Sorts rays along the axis on which they are farthest apart at the distance `t`. They are few; the library's sort would
/// be compiled for each shape, and is larger than the rest of this search.
fn sort<T: Implicit>(members: &mut [Member<T>], t: f64) {
    let at = |member: &Member<T>| member.line.base + t * member.line.dir;
    let [low, high] =
        [DVec3::min, DVec3::max].map(|end| members.iter().map(at).reduce(end).unwrap_or_default());
    let axis = (high - low).max_position();
    for index in 1..members.len() {
        for place in (1..=index).rev() {
            if at(&members[place - 1])[axis].total_cmp(&at(&members[place])[axis]).is_le() {
                break;
            }
            members.swap(place - 1, place);
        }
    }
}

/// Returns the bracket of a ray with its first root at this distance.
fn bracket<T: Implicit>(shape: &ImplicitShape<T>, ray: &Ray, range: &RayRange, distance: f64) -> Bracket {
    let is_on_surface = || shape.is_on_surface(ray.origin, range.origin_error);
    by_distance(ray, range, is_on_surface, |range| Some(range.keep(distance)))
}

/// A root of one line, to guess those of its neighbours.
struct Near {
    root: f64,
    at: [f64; 3],
    /// The gradient of the formula at the root.
    slopes: [f64; 3],
}

impl Near {
    /// Estimates the root of another line.
    fn guess<T: Implicit>(&self, line: &FormulaOnRay<T>) -> f64 {
        let beside = line.on_line(self.root);
        let along = |of: [f64; 3]| (0..3).map(|axis| self.slopes[axis] * of[axis]).sum::<f64>();
        self.root - along(per_axis(|axis| beside[axis] - self.at[axis])) / along(line.dir.to_array())
    }
}

/// Returns the root of a line between two places, as precisely as a search of this line alone.
fn root<T: Implicit>(
    line: &FormulaOnRay<T>,
    (low, high): (f64, f64),
    rises: bool,
    shortest: f64,
    near: &mut Option<Near>,
) -> f64 {
    let guess = near.as_ref().map_or(f64::NAN, |near| near.guess(line));
    let guess = if low < guess && guess < high { guess } else { low + 0.5 * (high - low) };
    let root = newton::root(|t| line.at(Dual::variable(t)), (low, high), !rises, guess, 0.5 * shortest);
    if near.is_none() {
        let at = line.on_line(root);
        let Gradient { slopes, .. } = line.shape.formula.value(Gradient::point(at));
        *near = Some(Near { root, at, slopes });
    }
    root
}

impl<'s, T: Implicit> Beam<'s, T> {
    fn around(shape: &'s ImplicitShape<T>, members: &[Member<T>], side: Option<Side>) -> Self {
        let hull = |of: &dyn Fn(&FormulaOnRay<T>) -> (f64, f64)| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for member in members {
                let (middle, error) = of(&member.line);
                (low, high) = (low.min(middle - error), high.max(middle + error));
            }
            Interval { low: low.next_down(), high: high.next_up() }
        };
        let base = per_axis(|axis| hull(&|line| (line.base[axis], line.blur)));
        let dir = per_axis(|axis| hull(&|line| (line.dir[axis], line.turn)));
        let to = members.iter().map(|member| member.span.end).fold(f64::NEG_INFINITY, f64::max);
        let widest = WIDEST * (shape.high - shape.low).max_element();
        Self { formula: &shape.formula, base, dir, to, side, widest }
    }

    /// Returns the lines on a piece, with their slopes.
    fn lines(&self, piece: Interval) -> [Dual<Interval>; 3] {
        per_axis(|axis| Dual { value: self.base[axis] + self.dir[axis] * piece, slope: self.dir[axis] })
    }

    /// Returns bounds of the formula at a place.
    fn at(&self, t: f64) -> Interval {
        let t = Interval::constant(t);
        self.formula.value(per_axis(|axis| self.base[axis] + self.dir[axis] * t))
    }

    /// Finds the first valid roots.
    fn first_roots(&self, search: &mut Search) -> Result<Found, Open> {
        let from = search.from;
        let far = self.to.abs().max(from.abs());
        let width =
            (0..3).map(|axis| self.base[axis].width() + far * self.dir[axis].width()).fold(0.0, f64::max);
        if !(width <= self.widest && from.is_finite() && self.to.is_finite()) {
            return Err(Open::Wide);
        }
        // In a wider beam, the sign may have been unknown.
        let start = self.at(search.at);
        if search.is_above.is_none() && !start.has_zero() {
            let (above, from_now) = (start.low > 0.0, search.at);
            search.is_above = Some(above);
            if let Some(run) = search.run
                && let Some(found) = self.ended(&run, search, from_now, above)?
            {
                return Ok(found);
            }
        }
        let mut is_halved = false;
        for _ in 0..MAX_PIECES {
            let Search { at: low, step, is_above, run, .. } = *search;
            if low >= self.to {
                return if run.is_none() { Ok(Found::None) } else { Err(Open::Wide) };
            }
            let high = if low + 1.5 * step < self.to { low + step } else { self.to };
            let piece = Interval { low, high };
            let Dual { value, slope } = self.formula.value(self.lines(piece));
            let is_smooth = value.is_bounded() && slope.is_bounded();
            if is_smooth && value.has_zero() && !slope.has_zero() {
                let rises = slope.low > 0.0;
                let run = run.unwrap_or(Run { start: low, rises, was_above: is_above });
                if run.rises != rises {
                    return Err(Open::Wide);
                }
                (search.at, search.is_above, search.run) = (high, None, Some(run));
                let end = self.at(high);
                if !end.has_zero()
                    && let Some(found) = self.ended(&run, search, high, end.low > 0.0)?
                {
                    return Ok(found);
                }
                continue;
            }
            let half = (0.5 * (high - low)).next_up();
            // The mean value form is hardly closer where the value in the middle is near 0.
            let is_away = value.middle().abs() > AWAY * half * slope.magnitude();
            let value = match value.has_zero() && is_smooth && is_away {
                true => self.at(low + 0.5 * (high - low)) + slope * Interval { low: -half, high: half },
                false => value,
            };
            if value.has_zero() {
                (search.step, is_halved) = (0.5 * (high - low), true);
                if search.step <= SHORT * width {
                    return Err(Open::Wide);
                }
                continue;
            }
            let above = value.low > 0.0;
            if let Some(run) = run
                && let Some(found) = self.ended(&run, search, low, above)?
            {
                return Ok(found);
            }
            if search.is_above.is_some_and(|was| was != above) {
                return Err(Open::Lost);
            }
            // The double length has just failed.
            let longer = if take(&mut is_halved) { 1.0 } else { 2.0 };
            (search.at, search.step, search.is_above) = (high, longer * (high - low), Some(above));
        }
        Err(Open::Lost)
    }

    /// Ends a run at a place where all lines have the same sign. Returns its root, if valid.
    fn ended(&self, run: &Run, search: &mut Search, end: f64, above: bool) -> Result<Option<Found>, Open> {
        let Run { start, rises, was_above } = *run;
        let counts = self.side.is_none_or(|side| rises == (side == Side::Inside));
        let found = match was_above {
            Some(was_above) if was_above == above => None,
            Some(_) if rises != above => return Err(Open::Lost),
            Some(_) if counts => Some(Found::Between { low: start, high: end, rises }),
            Some(_) => None,
            // A formula that rises to a negative value was negative before.
            None if rises != above => None,
            // Lines that leave the surface start on it.
            None if self.side.is_some() && !counts && start == search.from => None,
            None => return Err(Open::Lost),
        };
        (search.is_above, search.run) = (Some(above), None);
        Ok(found)
    }
}

impl Search {
    fn of<T>(members: &[Member<T>]) -> Self {
        let from = members.iter().map(|member| member.span.start).fold(f64::INFINITY, f64::min);
        let to = members.iter().map(|member| member.span.end).fold(f64::NEG_INFINITY, f64::max);
        Self { from, at: from, step: (to - from) / PARTS, is_above: None, run: None }
    }
}

#[cfg(test)]
mod tests;
