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

/// The number of times that a box is halved at most: six times along each axis of a cube.
const HALVINGS: usize = 2 * BLOCK;

/// The number of halvings whose parts are kept together: memory for the others is taken when a ray comes there.
const BLOCK: usize = 9;

/// What is known of some parts, four to a byte.
type Known = OnceLock<Box<[AtomicU8]>>;

/// What is known of a part, in two bits; at first, nothing.
const UNKNOWN: u8 = 0;
/// The formula is nowhere 0.
const FREE: u8 = 1;
/// The formula rises or falls along an axis everywhere, in all halves too.
const PLAIN: u8 = 2;
/// All other parts, which are halved.
const OPEN: u8 = 3;

/// The parts of a box.
pub(super) struct Parts {
    low: DVec3,
    high: DVec3,
    /// What is known about the parts. The part with the index 1 is the box, and the halves of part `i` are `2 i` and
    /// `2 i + 1`. Parts that are halved less than [`BLOCK`] times come first, and then the parts within each of the others. Made
    /// when the first ray comes.
    known: OnceLock<Box<[Known]>>,
}

impl Parts {
    pub fn new(low: DVec3, high: DVec3) -> Self {
        Self { low, high, known: OnceLock::new() }
    }

    /// Calls a function with the pieces of a line between two places on which the formula may be 0, in their order, until it
    /// returns a root. The line is the points `base + t dir`, with errors below the margins of the parts. Pieces that begin after
    /// `far` may be left out.
    pub fn visit(
        &self,
        formula: &impl Implicit,
        (base, dir): (DVec3, DVec3),
        ((low, high), far): ((f64, f64), f64),
        visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let margin = MARGIN * (self.high - self.low);
        let known = self.known.get_or_init(|| (0..=1 << BLOCK).map(|_| Known::new()).collect());
        let mut walk = Walk { formula, base, dir, margin, known, visit, far, piece: None };
        walk.part((1, OPEN), [self.low, self.high], (low, high)).or_else(|| walk.search())
    }
}

/// Returns the block of a part, and the index of the part in it.
fn placed(index: usize) -> (usize, usize) {
    let (halvings, first) = (index.ilog2() as usize, 1 << BLOCK);
    let Some(more) = halvings.checked_sub(BLOCK) else { return (0, index) };
    ((index >> more) + 1 - first, (1 << more) | (index & ((1 << more) - 1)))
}

struct Walk<'w, T> {
    formula: &'w T,
    base: DVec3,
    dir: DVec3,
    margin: DVec3,
    known: &'w [Known],
    visit: &'w mut dyn FnMut(f64, f64) -> Option<f64>,
    far: f64,
    /// The piece of the line in the last parts that are not free, one beside the other, which is not searched yet.
    piece: Option<(f64, f64)>,
}

impl<T: Implicit> Walk<'_, T> {
    /// Walks through a part, in which the line is from one place to another. `above` is what is known of the part of which it is
    /// a half.
    fn part(
        &mut self,
        (index, above): (usize, u8),
        [low, high]: [DVec3; 2],
        (from, to): (f64, f64),
    ) -> Option<f64> {
        if from > self.far && self.piece.is_none() {
            return None;
        }
        let known = self.known(index, above, [low, high]);
        if known == FREE {
            return self.search();
        }
        if index >> HALVINGS > 0 {
            self.piece = Some((self.piece.map_or(from, |piece| piece.0), to));
            return None;
        }
        let sides = high - low;
        let axis = sides.max_position();
        let (base, dir) = (self.base[axis], self.dir[axis]);
        let middle = low[axis] + 0.5 * sides[axis];
        let (mut below, mut above) = ([low, high], [low, high]);
        (below[1][axis], above[0][axis]) = (middle, middle);
        let (below, above) = (((2 * index, known), below), ((2 * index + 1, known), above));
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
    fn known(&self, index: usize, above: u8, corners: [DVec3; 2]) -> u8 {
        let (block, index) = placed(index);
        let block =
            self.known[block].get_or_init(|| (0..1 << (BLOCK - 1)).map(|_| AtomicU8::new(0)).collect());
        let (four, shift) = (&block[index / 4], 2 * (index % 4));
        let known = four.load(Ordering::Relaxed) >> shift & 3;
        if known != UNKNOWN {
            return known;
        }
        let known = self.judged(above, corners);
        // Whoever else judges it finds the same.
        four.fetch_or(known << shift, Ordering::Relaxed);
        known
    }

    fn judged(&self, above: u8, [low, high]: [DVec3; 2]) -> u8 {
        let (low, high) = (low - self.margin, high + self.margin);
        let at = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        let jumps = || self.formula.field().is_some_and(|field| field.jumps_past_0(at));
        if !self.formula.value(at).has_zero() || jumps() {
            return FREE;
        }
        if above == PLAIN {
            return PLAIN;
        }
        let slope = |along: usize| {
            let own =
                |axis: usize| if axis == along { Dual::variable(at[axis]) } else { Dual::fixed(at[axis]) };
            self.formula.value([own(0), own(1), own(2)]).slope
        };
        if (0..3).any(|axis| !slope(axis).has_zero()) { PLAIN } else { OPEN }
    }
}
