//! Parts of a shape's box that do not contain its surface, found once for all rays.
//!
//! The box is halved repeatedly along its longest side, and bounds of the formula tell which halves contain no zero. A
//! part is examined when the first ray enters it. The result does not depend on the ray, and so the hits of a ray do
//! not depend on other rays.
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

/// The maximum number of halvings of a box: six along each axis of a cube.
const HALVINGS: usize = 2 * BLOCK;

/// The number of operations of a formula above which its box is halved less often, once for each doubling: parts are
/// there to save time.
const CHEAP: u64 = 32;

/// The number of halvings whose parts share a block of memory. The other blocks are allocated when a ray enters them.
const BLOCK: usize = 9;

/// The states of some parts, four to a byte.
type Known = OnceLock<Box<[AtomicU8]>>;

/// The state of a part that was not examined yet. States take two bits.
const UNKNOWN: u8 = 0;
/// The formula has no zero.
const FREE: u8 = 1;
/// The formula is strictly monotonic along an axis, in all halves too.
const PLAIN: u8 = 2;
/// Any other part, which is halved.
const OPEN: u8 = 3;

/// The parts of a box.
pub(super) struct Parts {
    low: DVec3,
    high: DVec3,
    /// The states of the parts. The box has the index 1, and the halves of part `i` have the indices `2 i` and `2 i +
    /// 1`. The first block has the parts that are halved less than [`BLOCK`] times, and each other block those within
    /// one part. Made for the first ray.
    known: OnceLock<Box<[Known]>>,
    halvings: usize,
}

impl Parts {
    /// Returns the parts of a box for a formula that takes so many operations.
    pub fn new(low: DVec3, high: DVec3, cost: u64) -> Self {
        let dearer = (cost.max(CHEAP) / CHEAP).ilog2() as usize;
        Self { low, high, known: OnceLock::new(), halvings: HALVINGS.saturating_sub(dearer).max(BLOCK) }
    }

    /// Calls a function with the pieces of a line between two places that may have zeros, in order, until it returns a
    /// root. The line is the points `base + t dir`, with errors below the margins of the parts. Pieces that begin after
    /// `far` may be omitted.
    pub fn visit(
        &self,
        formula: &impl Implicit,
        (base, dir): (DVec3, DVec3),
        ((low, high), far): ((f64, f64), f64),
        visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let margin = MARGIN * (self.high - self.low);
        let known = self.known.get_or_init(|| (0..=1 << BLOCK).map(|_| Known::new()).collect());
        let halvings = self.halvings;
        let mut walk = Walk { formula, base, dir, margin, known, halvings, visit, far, piece: None };
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
    halvings: usize,
    visit: &'w mut dyn FnMut(f64, f64) -> Option<f64>,
    far: f64,
    /// The piece of the line in the last contiguous parts with possible zeros. It is not searched yet.
    piece: Option<(f64, f64)>,
}

impl<T: Implicit> Walk<'_, T> {
    /// Walks through a part, which contains the line from one place to another. `above` is the state of the part's
    /// parent.
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
        if index >> self.halvings > 0 {
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
        // The comparisons are false for NaN, which a line in the plane of the cut gives.
        if cut > from && cut < to {
            let [first, last] = if dir > 0.0 { [below, above] } else { [above, below] };
            let found = self.part(first.0, first.1, (from, cut));
            return found.or_else(|| self.part(last.0, last.1, (cut, to)));
        }
        let is_below = base + dir * (from + 0.5 * (to - from)) < middle;
        let half = if is_below { below } else { above };
        self.part(half.0, half.1, (from, to))
    }

    /// Searches the last parts with possible zeros.
    fn search(&mut self) -> Option<f64> {
        let (from, to) = self.piece.take()?;
        (self.visit)(from, to)
    }

    /// Returns the state of a part, and examines the part on first use.
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
        // Other threads find the same state.
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
