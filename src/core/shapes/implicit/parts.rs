//! Parts of a shape's box that its surface does not reach: found once, for all rays.
//!
//! The box is halved along its longest side, again and again, and bounds of the formula tell in which halves it is not 0. A part is
//! judged when the first ray comes to it. The judgement does not depend on the ray, so that a hit does not depend on other rays.
//!
//! Source: M. J. Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces" (2020), which finds
//! the empty parts for the tiles of an image.

use super::formula::Implicit;
use glam::DVec3;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};
use tabray_exact::dual::Dual;
use tabray_exact::formula::cells::MARGIN;
use tabray_exact::interval::Interval;

/// The number of times that a box is halved at most: five times along each axis of a cube.
const HALVINGS: usize = 15;

/// What is known of a part, in two bits; at first, nothing.
const UNKNOWN: u8 = 0;
/// The formula is nowhere 0.
const FREE: u8 = 1;
/// The formula rises or falls along an axis everywhere: halves would tell a search little more.
const PLAIN: u8 = 2;
/// All other parts, which are halved.
const OPEN: u8 = 3;

/// The parts of a box.
pub(super) struct Parts {
    low: DVec3,
    high: DVec3,
    /// What is known about the parts, four to a byte. The part with the index 1 is the box, and the halves of part `i`
    /// are `2 i` and `2 i + 1`. Made when the first ray comes.
    known: OnceLock<Box<[AtomicU8]>>,
}

impl Parts {
    pub fn new(low: DVec3, high: DVec3) -> Self {
        Self { low, high, known: OnceLock::new() }
    }

    /// Calls a function with the pieces of a line between two places on which the formula may be 0, in their order, until it
    /// returns a root. The line is the points `base + t dir`, with errors below the margins of the parts.
    pub fn visit(
        &self,
        formula: &impl Implicit,
        (base, dir): (DVec3, DVec3),
        (low, high): (f64, f64),
        visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let margin = MARGIN * (self.high - self.low);
        let known = self.known.get_or_init(|| (0..1 << (HALVINGS - 1)).map(|_| AtomicU8::new(0)).collect());
        let mut walk = Walk { formula, base, dir, margin, known, visit, piece: None };
        walk.part(1, [self.low, self.high], (low, high)).or_else(|| walk.search())
    }
}

struct Walk<'w, T> {
    formula: &'w T,
    base: DVec3,
    dir: DVec3,
    margin: DVec3,
    known: &'w [AtomicU8],
    visit: &'w mut dyn FnMut(f64, f64) -> Option<f64>,
    /// The piece of the line in the last parts that are not free, one beside the other, which is not searched yet.
    piece: Option<(f64, f64)>,
}

impl<T: Implicit> Walk<'_, T> {
    /// Walks through a part, in which the line is from one place to another.
    fn part(&mut self, index: usize, [low, high]: [DVec3; 2], (from, to): (f64, f64)) -> Option<f64> {
        let known = self.known(index, [low, high]);
        if known == FREE {
            return self.search();
        }
        if known == PLAIN || index >> HALVINGS > 0 {
            self.piece = Some((self.piece.map_or(from, |piece| piece.0), to));
            return None;
        }
        let sides = high - low;
        let axis = sides.max_position();
        let (base, dir) = (self.base[axis], self.dir[axis]);
        let middle = low[axis] + 0.5 * sides[axis];
        let (mut below, mut above) = ([low, high], [low, high]);
        (below[1][axis], above[0][axis]) = (middle, middle);
        let (below, above) = ((2 * index, below), (2 * index + 1, above));
        let cut = (middle - base) / dir;
        // Written so that a NaN, of a line in the plane of the cut, is no cut.
        if cut > from && cut < to {
            let [first, last] = if dir > 0.0 { [below, above] } else { [above, below] };
            let found = self.part(first.0, first.1, (from, cut));
            return found.or_else(|| self.part(last.0, last.1, (cut, to)));
        }
        let is_below = base + dir * (from + 0.5 * (to - from)) < middle;
        let half = if is_below { below } else { above };
        self.part(half.0, half.1, (from, to))
    }

    /// Searches the last parts that are not free.
    fn search(&mut self) -> Option<f64> {
        let (from, to) = self.piece.take()?;
        (self.visit)(from, to)
    }

    /// Returns what is known of a part, and judges it if it is the first to ask.
    fn known(&self, index: usize, corners: [DVec3; 2]) -> u8 {
        let (four, shift) = (&self.known[index / 4], 2 * (index % 4));
        let known = four.load(Ordering::Relaxed) >> shift & 3;
        if known != UNKNOWN {
            return known;
        }
        let known = self.judged(corners);
        // Whoever else judges it finds the same.
        four.fetch_or(known << shift, Ordering::Relaxed);
        known
    }

    fn judged(&self, [low, high]: [DVec3; 2]) -> u8 {
        let (low, high) = (low - self.margin, high + self.margin);
        let at = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        let jumps = || self.formula.field().is_some_and(|field| field.jumps_past_0(at));
        if !self.formula.value(at).has_zero() || jumps() {
            return FREE;
        }
        let slope = |along: usize| {
            let own =
                |axis: usize| if axis == along { Dual::variable(at[axis]) } else { Dual::fixed(at[axis]) };
            self.formula.value([own(0), own(1), own(2)]).slope
        };
        if (0..3).any(|axis| !slope(axis).has_zero()) { PLAIN } else { OPEN }
    }
}
