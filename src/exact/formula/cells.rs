//! A formula in a box that is cut into cells. In each cell, only the operations that may matter there are carried out.
//!
//! If a formula takes the minimum of many distances, intervals exclude most of them in a small cell. Each cell has a
//! program without these distances, made from the program of the larger cell that it is a half of.
//!
//! Source: M. J. Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces" (2020), which shortens
//! tapes for the tiles of an image.

use super::program::{MAX_REGISTERS, Program, Value, Values};
use super::step::{Function, Step};
use crate::interval::Interval;
use std::sync::{Arc, OnceLock};

/// A cell with at most this many operations is not cut, because walking through more cells would take longer.
const FEW: usize = 32;

/// The maximum number of halvings of the box: ten along each axis.
const HALVINGS: u32 = 30;

/// The number of halvings, three along each axis, after which a cell is not cut again if they have excluded too few
/// operations for a shorter program.
const IN_VAIN: u32 = 9;

/// The margin around a cell on all sides, as a fraction of the box. With it, places on the sides of a cell belong to
/// the cell regardless of rounding.
pub const MARGIN: f64 = 1.0 / (1 << 20) as f64;

/// A formula's cells. A cell is cut on the first query of a place in it. The cut does not depend on the place.
#[derive(Clone, Debug)]
pub struct Cells {
    /// The whole box, with its margin.
    whole: [Interval; 3],
    margin: [f64; 3],
    first: Cell,
}

#[derive(Clone, Debug)]
struct Cell {
    place: [Interval; 3],
    program: Arc<Program>,
    /// Whether the formula has no zero in the cell.
    is_free: bool,
    cut: Option<Cut>,
}

/// The cut of a cell, and its halves.
#[derive(Clone, Debug)]
struct Cut {
    axis: usize,
    at: f64,
    /// The number of halvings for a half, and how many of them came after the program of the cell was made.
    halvings: u32,
    in_vain: u32,
    halves: OnceLock<Box<[Cell; 2]>>,
}

impl PartialEq for Cells {
    /// Tells whether both are the cells of the same formula in the same box, regardless of how many have been made.
    fn eq(&self, other: &Self) -> bool {
        self.whole == other.whole && self.first.program == other.first.program
    }
}

impl Cells {
    /// Cuts a box, if this may shorten a formula there.
    pub(super) fn new(program: &Program, [low, high]: [[f64; 3]; 2]) -> Option<Self> {
        let place = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        let margin = place.map(|side| MARGIN * side.width());
        let first = Cell::new(&Arc::new(program.clone()), place, [0; 2], margin);
        first.cut.is_some().then(|| Self { whole: widened(place, margin), margin, first })
    }

    /// Tells whether the formula certainly has no zero in a box.
    pub fn are_free(&self, at: [Interval; 3]) -> bool {
        self.cell(at).is_some_and(|cell| cell.is_free)
    }

    /// Returns the shortest program for a box, or `None` if the box is not inside the whole box.
    #[inline]
    pub(super) fn program(&self, at: [Interval; 3]) -> Option<&Program> {
        self.cell(at).map(|cell| &*cell.program)
    }

    /// Returns the smallest cell around a box, or `None` if the box is not inside the whole box.
    #[inline]
    fn cell(&self, at: [Interval; 3]) -> Option<&Cell> {
        let is_inside =
            (0..3).all(|axis| at[axis].low >= self.whole[axis].low && at[axis].high <= self.whole[axis].high);
        if !is_inside {
            return None;
        }
        let mut cell = &self.first;
        while let Some((axis, place, [below, above])) = cell.halves(self.margin) {
            cell = if at[axis].high <= place + self.margin[axis] {
                below
            } else if at[axis].low >= place - self.margin[axis] {
                above
            } else {
                break;
            };
        }
        Some(cell)
    }

    /// Calls a function with the part of a line between two places in each cell that may have zeros, in order along the
    /// line, until the function returns a value. The line is the points `base + t dir`.
    pub fn visit<R>(
        &self,
        base: [f64; 3],
        dir: [f64; 3],
        (low, high): (f64, f64),
        visit: &mut impl FnMut(f64, f64) -> Option<R>,
    ) -> Option<R> {
        self.visit_cell(&self.first, &(base, dir), (low, high), visit)
    }

    fn visit_cell<R>(
        &self,
        cell: &Cell,
        line: &([f64; 3], [f64; 3]),
        (low, high): (f64, f64),
        visit: &mut impl FnMut(f64, f64) -> Option<R>,
    ) -> Option<R> {
        if cell.is_free {
            return None;
        }
        let Some((axis, place, [below, above])) = cell.halves(self.margin) else { return visit(low, high) };
        let (base, dir) = (line.0[axis], line.1[axis]);
        let cut = (place - base) / dir;
        let halves = if dir > 0.0 { [below, above] } else { [above, below] };
        // A line in the plane of the cut gives a NaN, and both comparisons are false.
        if cut > low && cut < high {
            let found = self.visit_cell(halves[0], line, (low, cut), visit);
            return found.or_else(|| self.visit_cell(halves[1], line, (cut, high), visit));
        }
        let is_below = base + dir * (low + 0.5 * (high - low)) < place;
        self.visit_cell(if is_below { below } else { above }, line, (low, high), visit)
    }
}

impl Cell {
    /// Makes a cell of a part of a larger cell with this program, after these numbers of halvings.
    fn new(
        above: &Arc<Program>,
        place: [Interval; 3],
        [halvings, in_vain]: [u32; 2],
        margin: [f64; 3],
    ) -> Self {
        let (values, value) = pruned(above, widened(place, margin));
        let (known, len, is_free) = (above.instructions.len(), values.list.len() - 3, !value.has_zero());
        let is_shorter = 4 * len < 3 * known;
        let in_vain = if is_shorter { 0 } else { in_vain };
        let has_choice = || values.list.iter().any(|value| is_choice(value.step));
        let is_cut = !is_free && halvings < HALVINGS && in_vain < IN_VAIN && len > FEW && has_choice();
        let shorter = (is_shorter || !is_cut && len < known)
            .then(|| Program::of(&values, 3))
            // A shared value occupies a register. The program without some operations may thus need more registers than
            // the long one.
            .filter(|program| program.registers <= MAX_REGISTERS);
        let cut = is_cut.then(|| {
            let width = |axis: usize| place[axis].width();
            let axis =
                (1..3).fold(0, |longest, axis| if width(axis) > width(longest) { axis } else { longest });
            let (at, halvings, in_vain) = (place[axis].middle(), halvings + 1, in_vain + 1);
            Cut { axis, at, halvings, in_vain, halves: OnceLock::new() }
        });
        Self { place, program: shorter.map_or_else(|| above.clone(), Arc::new), is_free, cut }
    }

    /// Returns the axis and the place of the cut, and the cell's halves, which are made on first use. Returns `None` if
    /// the cell is not cut.
    fn halves(&self, margin: [f64; 3]) -> Option<(usize, f64, &[Self; 2])> {
        let &Cut { axis, at, halvings, in_vain, ref halves } = self.cut.as_ref()?;
        let made = || {
            let (mut below, mut above) = (self.place, self.place);
            (below[axis].high, above[axis].low) = (at, at);
            let half = |place| Self::new(&self.program, place, [halvings, in_vain], margin);
            Box::new([below, above].map(half))
        };
        Some((axis, at, halves.get_or_init(made)))
    }
}

fn widened(place: [Interval; 3], margin: [f64; 3]) -> [Interval; 3] {
    [0, 1, 2]
        .map(|axis| Interval { low: place[axis].low - margin[axis], high: place[axis].high + margin[axis] })
}

/// Tells whether an operation may choose one of several operands, depending on the place.
pub(super) fn is_choice(step: Step) -> bool {
    use Function::{Abs, Floor, Heaviside, If, Max, Min, Smax, Smin};
    matches!(step, Step::Call(Min | Max | Abs | Floor | Heaviside | If | Smin | Smax))
}

/// Returns the values of a formula that matter in a box, and bounds of the formula there.
fn pruned(program: &Program, place: [Interval; 3]) -> (Values, Interval) {
    let values = program.values(3);
    let list = &values.list;
    let mut bounds: Vec<Interval> = Vec::with_capacity(list.len());
    // For each value, the equal value in the box, and its operation.
    let (mut same, mut steps) = (Vec::with_capacity(list.len()), Vec::with_capacity(list.len()));
    for (index, value) in list.iter().enumerate() {
        // Variables, which come first, and numbers have no operands.
        let operand =
            |which: usize| if value.step.operands() > which { same[value.operands[which]] } else { 0 };
        let (first, second, third) = (operand(0), operand(1), operand(2));
        let (mut step, mut own) = (value.step, index);
        let (a, b, bound) = match step {
            Step::Variable(axis) => (Interval::WHOLE, Interval::WHOLE, place[usize::from(axis)]),
            step => {
                let (a, b) = (bounds[first], bounds[second]);
                (a, b, step.of::<Interval, true>(a, b, || bounds[third], None))
            }
        };
        match step {
            Step::Call(Function::Min) if a.high <= b.low => own = first,
            Step::Call(Function::Min) if b.high <= a.low => own = second,
            Step::Call(Function::Max) if a.high <= b.low => own = second,
            Step::Call(Function::Max) if b.high <= a.low => own = first,
            // Beyond the width, a smooth minimum or maximum is exact.
            Step::Call(of @ (Function::Smin | Function::Smax)) if bounds[third].low > 0.0 => {
                let (width, is_min) = (bounds[third].high, of == Function::Smin);
                if (b - a).low >= width {
                    own = if is_min { first } else { second };
                } else if (a - b).low >= width {
                    own = if is_min { second } else { first };
                }
            }
            Step::Call(Function::Abs) if a.low >= 0.0 => own = first,
            Step::Call(Function::Abs) if a.high <= 0.0 => step = Step::Neg,
            Step::Call(Function::Heaviside) if a.low > 0.0 => step = Step::Number(1.0),
            Step::Call(Function::Heaviside) if a.high < 0.0 => step = Step::Number(0.0),
            Step::Call(Function::If) if a.low >= 0.0 => own = second,
            Step::Call(Function::If) if a.high < 0.0 => own = third,
            Step::Call(Function::Floor) => {
                step = a.certain_floor().map_or(step, Step::Number);
            }
            _ => {}
        }
        same.push(own);
        bounds.push(bound);
        steps.push(Value { step, operands: [first, second, third] });
    }
    let result = same[values.result];
    let value = bounds[result];
    // The values that the result depends on, in order.
    let mut is_used = vec![false; list.len()];
    is_used[..3].fill(true);
    is_used[result] = true;
    for index in (3..list.len()).rev() {
        if is_used[index] {
            steps[index].used().iter().for_each(|used| is_used[*used] = true);
        }
    }
    let (mut places, mut kept) = (vec![0; list.len()], Vec::new());
    for index in 0..list.len() {
        if is_used[index] {
            places[index] = kept.len();
            let Value { step, operands } = steps[index];
            kept.push(Value { step, operands: operands.map(|operand| places[operand]) });
        }
    }
    let pruned = Values { list: kept, result: places[result] };
    (pruned, value)
}

#[cfg(test)]
mod tests {
    use crate::formula::Formula;
    use crate::formula::field::Field;
    use crate::formula::variables::SPACE;
    use crate::interval::Interval;
    use crate::scalar::Scalar;
    use std::sync::Arc;

    /// Returns the distances of 125 balls on a grid, combined by a function.
    fn balls(combined: impl Fn(String) -> String) -> Field {
        let place = |index: i32| 0.4 * f64::from(index) - 0.8;
        let ball = |index: i32| {
            let [x, y, z] = [index / 25, index / 5 % 5, index % 5].map(place);
            format!("sqrt((x - {x})^2 + (y - {y})^2 + (z - {z})^2) - 0.1")
        };
        let balls: Vec<_> = (0..125).map(ball).collect();
        let formula = Formula::parse_in(&combined(balls.join(", ")), SPACE).expect("a formula");
        Field::new(Arc::new(formula)).expect("its variables are x, y and z")
    }

    #[test]
    fn a_formula_has_the_same_values_in_its_cells() {
        for combined in [
            |balls| format!("min({balls})"),
            |balls| format!("smin({balls}, 0.05)"),
            |balls| format!("-smax(-9, -abs(min({balls})), 0.05)"),
        ] {
            let (whole, cut) = (balls(combined), balls(combined).within([[-1.0; 3], [1.0; 3]]));
            assert!(cut.cells().is_some(), "it is cut");
            for step in 0..20_000 {
                let at = [7, 31, 101].map(|factor| f64::from(step * factor % 997) / 997.0 * 2.2 - 1.1);
                let (one, other): (f64, f64) = (whole.at(at), cut.at(at));
                assert_eq!(one, other, "{at:?}");
            }
        }
    }

    #[test]
    fn a_cell_has_a_short_program_only_where_a_place_in_it_is_asked_for() {
        let cut = balls(|balls| format!("min({balls})")).within([[-1.0; 3], [1.0; 3]]);
        let cells = cut.cells().expect("it is cut");
        let made = || {
            fn of(cell: &super::Cell) -> usize {
                let halves = cell.cut.as_ref().and_then(|cut| cut.halves.get());
                1 + halves.map_or(0, |halves| halves.iter().map(of).sum())
            }
            of(&cells.first)
        };
        assert_eq!(made(), 1);
        let (at, whole) = ([Interval::constant(0.71); 3], cells.first.program.instructions.len());
        let program = cells.program(at).expect("the point is in the box");
        assert!(program.instructions.len() < 32 && whole > 500, "{} {whole}", program.instructions.len());
        assert!(made() < 64, "{}", made());
        assert!(cells.are_free([Interval::constant(0.2); 3]));
    }

    #[test]
    fn a_line_meets_all_balls_in_its_cells() {
        let cut = balls(|balls| format!("min({balls})")).within([[-1.0; 3], [1.0; 3]]);
        let mut parts = Vec::new();
        let cells = cut.cells().expect("it is cut");
        let nothing: Option<()> = cells.visit([0.0; 3], [1.0, 0.01, 0.0], (-1.0, 1.0), &mut |low, high| {
            parts.push((low, high));
            None
        });
        assert_eq!(nothing, None);
        for end in [-0.9, -0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7, 0.9] {
            assert!(
                parts.iter().any(|(low, high)| (low - 0.01..high + 0.01).contains(&end)),
                "{end} {parts:?}"
            );
        }
        assert!(parts.windows(2).all(|pair| pair[0].1 <= pair[1].0), "{parts:?}");
        assert!(parts.iter().map(|(low, high)| high - low).sum::<f64>() < 1.9, "{parts:?}");
    }
}
