//! A second opinion on each proof about a formula of a scene: from the formula as it was written, which shares no
//! simplification and no derivative with the search for hits.
//!
//! Between two places of different signs, a formula that is defined and continuous has a root. If a proof has none
//! there, or a hit where the formula is not 0, one of the two is wrong, and the answer is open.

use super::equation::{HitEnclosure, Values};
use crate::geometry::sight::Line;
use glam::DVec3;
use tabray_exact::f64x8::{F64x8, LANES};
use tabray_exact::formula::field::Field;
use tabray_exact::formula::written::{Seen, Written};
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, per_axis};

/// The number of halvings that look for a root between two places of different signs.
const HALVINGS: usize = 64;

/// After this many halvings, ends between which the formula has grown to [`POLE`] times what it was are those of a pole.
const SETTLED: usize = 16;

/// The growth that tells a pole: one of the first order grows to 65,536 times itself meanwhile.
const POLE: f64 = 1024.0;

/// One line of this many is also tried with the equation that is searched, at one of the drawn places: what is wrong
/// with that equation is wrong for many lines.
const TRIED: u64 = 16;

/// What a search did to a line.
#[derive(Default)]
pub(super) struct Trail {
    /// The ends of the part of the line in the box, rounded outward; `None` if there is none.
    pub clipped: Option<[f64; 2]>,
    /// The ends of the pieces into which that part was cut, in order.
    pub places: Vec<f64>,
    /// Whether the equation is known not to change its sign at the hit.
    pub touches: bool,
}

impl Trail {
    /// Notes the part of the line in the box.
    pub fn clip<F: Float>(&mut self, part: Option<(F, F)>) {
        self.clipped = part.map(|(from, to)| [from.to_f64().next_down(), to.to_f64().next_up()]);
    }
}

/// The check of what is claimed along a line, which is in the formula's coordinates.
struct Check<'s, F> {
    shape: &'s dyn Values<Interval<F>>,
    field: &'s Field,
    line: &'s Line<Interval<F>>,
    extent: [DVec3; 2],
    trail: &'s Trail,
    /// The middle of the line, in plain numbers.
    near: [[f64; 3]; 2],
}

/// Returns what is claimed about the first hit of a line, or that it is open where the formula as it was written
/// disagrees.
pub(super) fn first<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    claimed: HitEnclosure<F>,
    trail: &Trail,
) -> HitEnclosure<F> {
    let Some(check) = Check::new(shape, line, trail) else { return claimed };
    let holds = check.is_clipped_outward() && check.holds(0.0, claimed);
    if holds { claimed } else { HitEnclosure::Doubtful(F::of(0.0)) }
}

/// Returns what is claimed about all hits of a line, up to the first with which the formula as it was written
/// disagrees, which is then open. The claim is that there are no hits but these before an open one.
pub(super) fn all<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    mut claimed: Vec<HitEnclosure<F>>,
    trail: &Trail,
) -> Vec<HitEnclosure<F>> {
    let Some(check) = Check::new(shape, line, trail) else { return claimed };
    if !check.is_clipped_outward() {
        return vec![HitEnclosure::Doubtful(F::of(0.0))];
    }
    let mut from = F::of(0.0);
    for index in 0..=claimed.len() {
        let next = claimed.get(index).copied().unwrap_or(HitEnclosure::Misses);
        if !check.holds(from.to_f64(), next) {
            claimed.truncate(index);
            claimed.push(HitEnclosure::Doubtful(from));
            break;
        }
        if let HitEnclosure::Hits(at) = next {
            from = at.high;
        }
    }
    claimed
}

impl<'s, F: Float> Check<'s, F> {
    /// Returns the check of an equation that is a formula of the scene.
    fn new(
        shape: &'s dyn Values<Interval<F>>,
        line: &'s Line<Interval<F>>,
        trail: &'s Trail,
    ) -> Option<Self> {
        let near = [line.origin, line.dir].map(|of| of.map(|axis| axis.middle().to_f64()));
        Some(Self { shape, field: shape.field()?, line, extent: shape.extent(), trail, near })
    }

    /// Returns the line with 53 bits.
    fn coarse(&self) -> Line<Interval> {
        let coarse = |of: [Interval<F>; 3]| of.map(Interval::coarse);
        Line { origin: coarse(self.line.origin), dir: coarse(self.line.dir) }
    }

    /// Tells whether no part of the line in the box is certainly clipped away.
    fn is_clipped_outward(&self) -> bool {
        let ([low, high], [origin, dir]) = (self.extent, self.near);
        let is_outside = |t: f64| {
            (0..3).any(|axis| {
                let (start, along) = (origin[axis], t * dir[axis]);
                // Far more than the rounding of the line and of this sum.
                let rounding = 64.0 * f64::EPSILON * (start.abs() + along.abs());
                start + along < low[axis] + rounding || start + along > high[axis] - rounding
            })
        };
        match self.trail.clipped {
            Some([from, to]) => (from <= 0.0 || is_outside(from)) && (to == f64::INFINITY || is_outside(to)),
            None => match self.within((0.0, f64::INFINITY)) {
                Some((from, to)) => is_outside(from + 0.5 * (to - from)),
                None => true,
            },
        }
    }

    /// Tells whether the formula does not disagree with the claim that a hit is the first one after a place.
    fn holds(&self, from: f64, claimed: HitEnclosure<F>) -> bool {
        match claimed {
            HitEnclosure::Misses => self.signs(from, f64::INFINITY, None).is_some(),
            HitEnclosure::Hits(at) => {
                let [low, high] = [at.low.to_f64(), at.high.to_f64()];
                // Where rounding does not hide a change of sign of a formula that is defined everywhere, intervals tell
                // no other.
                let ends = self.field.is_total().then_some([low, high]);
                let changes = self.signs(from, low, ends);
                changes.is_some_and(|changes| changes || self.is_root(at))
            }
            HitEnclosure::Edge(at) => self.signs(from, at.low.to_f64(), None).is_some(),
            HitEnclosure::Doubtful(_) => true,
        }
    }

    /// Tells whether the formula may be defined and 0 in an interval, and change its sign there unless it is known not to.
    fn is_root(&self, root: Interval<F>) -> bool {
        let mut written = self.field.written();
        let mut seen = |t| written.at(&self.line.at(t));
        let low = seen(Interval::point(root.low));
        if low.is_defined() == Some(false) {
            return false;
        }
        let Some(before) = low.sign() else { return true };
        let high = seen(Interval::point(root.high));
        if high.is_defined() == Some(false) {
            return false;
        }
        // A formula of which squares were left out does not change its sign, either.
        let may_touch = self.trail.touches || !self.field.keeps_signs();
        high.sign() != Some(before) || may_touch && seen(root).sign().is_none()
    }

    /// Returns `None` if the formula certainly changes its sign between two places, as far as it is seen at the ends of
    /// pieces, and at places drawn from the bits of the line, or if it is not what is searched there. Otherwise tells
    /// whether its signs at the ends of a root behind these places differ, up to rounding.
    fn signs(&self, from: f64, to: f64, root: Option<[f64; 2]>) -> Option<bool> {
        let [origin, dir] = self.near;
        let part = self.within((from, to));
        let (from, to) = match part {
            Some(part) => part,
            None if root.is_none() => return Some(false),
            None => (from, from),
        };
        let first = self.trail.places.partition_point(|t| *t <= from);
        let mut ends = self.trail.places[first..].iter().copied().take_while(|t| *t < to).peekable();
        // The signs at a hit and before it take one packet.
        let count = match (part, root) {
            (None, _) => 0,
            (_, None) => LANES,
            _ => LANES - 4,
        };
        let mut bits = bits_of(origin, dir);
        let is_tried = bits.is_multiple_of(TRIED);
        let drawn = (0..count).map(|place| {
            bits = bits.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            let part = (bits >> 11) as f64 / (1_u64 << 53) as f64;
            from + (place as f64 + part) / count as f64 * (to - from)
        });
        let mut drawn = drawn.peekable();
        if is_tried
            && let Some(place) = drawn.peek()
            && !self.agrees(*place)
        {
            return None;
        }
        let mut next = || match (ends.peek(), drawn.peek()) {
            (Some(end), Some(place)) if end < place => ends.next(),
            (_, Some(_)) => drawn.next(),
            (_, None) => ends.next(),
        };
        let mut last: Option<(f64, bool)> = None;
        let mut waiting = root;
        loop {
            let (mut some, mut count) = ([to; LANES], 0);
            while let Some(place) = if count < LANES { next() } else { None } {
                some[count] = place;
                count += 1;
            }
            let behind = waiting.take_if(|_| count + 2 <= LANES);
            if let Some(ends) = behind {
                some[count..count + 2].copy_from_slice(&ends);
            } else if count == 0 {
                return Some(false);
            }
            let at =
                per_axis(|axis| F64x8::constant(origin[axis]) + F64x8::constant(dir[axis]) * F64x8(some));
            let values = self.field.as_written_at(at).0;
            for (t, value) in some[..count].iter().zip(values) {
                if value.is_nan() || value == 0.0 {
                    continue;
                }
                let is_above = value > 0.0;
                if let Some((before, was_above)) = last
                    && was_above != is_above
                    && self.crosses(before, *t)
                {
                    return None;
                }
                last = Some((*t, is_above));
            }
            if behind.is_some() {
                return Some(values[count] * values[count + 1] < 0.0);
            }
        }
    }

    /// Tells whether what is searched does not disagree with the formula as it was written at a place: about its sign,
    /// and about where it is defined.
    fn agrees(&self, t: f64) -> bool {
        let at = self.line.at(Interval::constant(t));
        let written = self.field.written().at(&at);
        if written.is_defined() == Some(true) && self.shape.inside_trim(at).high < F::of(0.0) {
            let is_cut = self.shape.condition(at).low < F::of(0.0);
            return is_cut || !self.is_inside(at.map(Interval::coarse));
        }
        let is_same = self.field.keeps_signs() && self.field.poles().is_none();
        let value = self.shape.value(at);
        let is_known = written.is_defined() == Some(true) && !value.has_zero();
        !(is_same && is_known && written.sign() == Some(value.high < F::of(0.0)))
    }

    /// Returns the part of a line between two places that is in the box, in plain numbers.
    fn within(&self, (mut from, mut to): (f64, f64)) -> Option<(f64, f64)> {
        let ([low, high], [origin, dir]) = (self.extent, self.near);
        for axis in 0..3 {
            let [one, other] = [low[axis], high[axis]].map(|side| (side - origin[axis]) / dir[axis]);
            if dir[axis] != 0.0 {
                (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
            } else if origin[axis] < low[axis] || origin[axis] > high[axis] {
                return None;
            }
        }
        (from < to && to.is_finite()).then_some((from, to))
    }

    /// Tells whether the formula certainly crosses 0 between two places, inside of the box.
    fn crosses(&self, mut low: f64, mut high: f64) -> bool {
        let line = self.coarse();
        let mut written: Written<f64> = self.field.written();
        let mut seen = |low: f64, high: f64| written.at(&line.at(Interval { low, high }));
        let sign = |of: Seen<f64>| of.sign().filter(|_| of.is_defined() == Some(true));
        let size = |of: Seen<f64>| of.low.abs().min(of.high.abs());
        let mut ends = [seen(low, low), seen(high, high)];
        let [Some(before), Some(after)] = ends.map(sign) else {
            return false;
        };
        if before == after {
            return false;
        }
        let first = size(ends[0]).max(size(ends[1]));
        for halving in 0..HALVINGS {
            if halving == SETTLED && ends.iter().any(|end| size(*end) > POLE * first) {
                return false;
            }
            let over = seen(low, high);
            if over.is_continuous() && self.is_inside(line.at(Interval { low, high })) {
                let condition =
                    self.shape.condition(self.line.at(Interval { low: F::of(low), high: F::of(high) }));
                if condition.low >= F::of(0.0) || condition.high < F::of(0.0) {
                    return condition.low >= F::of(0.0);
                }
            }
            let middle = low + 0.5 * (high - low);
            let within = seen(middle, middle);
            match sign(within) {
                Some(sign) if sign == before => (low, ends[0]) = (middle, within),
                Some(_) => (high, ends[1]) = (middle, within),
                None => return false,
            }
        }
        false
    }

    fn is_inside(&self, at: [Interval; 3]) -> bool {
        let [low, high] = self.extent;
        (0..3).all(|axis| at[axis].low > low[axis] && at[axis].high < high[axis])
    }
}

/// Mixes the bits of a line.
fn bits_of(origin: [f64; 3], dir: [f64; 3]) -> u64 {
    origin.iter().chain(&dir).fold(0, |bits: u64, number| {
        (bits ^ number.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    })
}

#[cfg(test)]
mod tests;
