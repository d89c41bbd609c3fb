//! A formula in a box that is cut into cells. In each cell, only the operations that may matter there are carried out.
//!
//! Where a formula takes the smallest of many distances, intervals show that most of the distances cannot be the
//! smallest in a small cell. Each cell has a program without those distances, made from the program of the larger cell
//! of which it is a half.
//!
//! Source: M. J. Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces" (2020), which shortens
//! tapes for the tiles of an image.

use super::program::{MOST_REGISTERS, Program, Value, Values};
use super::step::{Function, Step};
use crate::interval::Interval;

/// A cell with this many operations or fewer is not cut: more cells would take longer to walk through.
const FEW: usize = 32;

/// The maximum number of times that the box is halved: ten times along each axis.
const HALVINGS: usize = 30;

/// The maximum number of interval operations for making cells: about a second. Hits in a cell that is then left uncut
/// take longer to find, and are the same.
const OPERATIONS: usize = 20_000_000;

/// The margin around a cell on all sides, as a fraction of the box. Places on the sides of a cell belong to it, however
/// they are rounded.
pub const MARGIN: f64 = 1.0 / (1 << 20) as f64;

/// A formula's cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// The whole box, with its margin.
    whole: [Interval; 3],
    margin: [f64; 3],
    /// The first cell is the whole box.
    cells: Vec<Cell>,
    programs: Vec<Program>,
}

#[derive(Clone, Debug, PartialEq)]
struct Cell {
    /// The index of its program.
    program: usize,
    place: [Interval; 3],
    /// Whether the formula is nowhere 0 in the cell.
    is_free: bool,
    /// The axis and the place where the cell is cut, and the first of its two halves, which follow each other.
    cut: Option<(usize, f64, [usize; 2])>,
}

impl Cells {
    /// Cuts a box, if that makes a formula shorter there.
    pub(super) fn new(values: &Values, [low, high]: [[f64; 3]; 2]) -> Option<Self> {
        let place = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        let margin = place.map(|side| MARGIN * side.width());
        let programs = vec![Program::of(values, 3)];
        let mut cells = Self { whole: widened(place, margin), margin, cells: Vec::new(), programs };
        let mut left = OPERATIONS;
        cells.add(values, 0, (place, 0), &mut left);
        (cells.cells.len() > 1).then_some(cells)
    }

    /// Adds a cell and the cells into which it is cut. The new cell is a part of a cell with these values and this
    /// program, after this number of halvings.
    fn add(
        &mut self,
        values: &Values,
        mut program: usize,
        (place, halvings): ([Interval; 3], usize),
        left: &mut usize,
    ) -> usize {
        *left = left.saturating_sub(values.list.len());
        let (mut values, value) = pruned(values, widened(place, self.margin));
        let (index, is_free) = (self.cells.len(), !value.has_zero());
        let has_choice = || values.list.iter().any(|value| is_choice(value.step));
        let is_cut = !is_free && halvings < HALVINGS && *left > 0 && values.list.len() > FEW && has_choice();
        let known = self.programs[program].instructions.len();
        let is_shorter = 4 * values.list.len() < 3 * known || !is_cut && values.list.len() < known;
        if is_shorter {
            let shorter = Program::of(&values, 3);
            // A shared value waits in a register. The program without some operations may need more registers than the
            // long one.
            if shorter.registers <= MOST_REGISTERS {
                program = self.programs.len();
                self.programs.push(shorter);
            }
        }
        self.cells.push(Cell { program, place, is_free, cut: None });
        if is_cut {
            let axis =
                (0..3).fold(
                    0,
                    |longest, axis| {
                        if place[axis].width() > place[longest].width() { axis } else { longest }
                    },
                );
            let at = place[axis].middle();
            let (mut below, mut above) = (place, place);
            (below[axis].high, above[axis].low) = (at, at);
            values.list.shrink_to_fit();
            let halves = [below, above].map(|half| self.add(&values, program, (half, halvings + 1), left));
            self.cells[index].cut = Some((axis, at, halves));
        }
        index
    }

    /// Returns the shortest program for some points; `None` where they may lie outside of the box.
    #[inline]
    pub(super) fn program(&self, at: [Interval; 3]) -> Option<&Program> {
        let is_inside =
            (0..3).all(|axis| at[axis].low >= self.whole[axis].low && at[axis].high <= self.whole[axis].high);
        if !is_inside {
            return None;
        }
        let mut cell = &self.cells[0];
        while let Some((axis, place, [below, above])) = cell.cut {
            cell = if at[axis].high <= place + self.margin[axis] {
                &self.cells[below]
            } else if at[axis].low >= place - self.margin[axis] {
                &self.cells[above]
            } else {
                break;
            };
        }
        Some(&self.programs[cell.program])
    }

    /// Calls a function with the part of a line, from one place to another, in each cell where the formula may be 0, in
    /// order along the line, until the function returns something. The line is the points `base + t dir`.
    pub fn visit<R>(
        &self,
        base: [f64; 3],
        dir: [f64; 3],
        (low, high): (f64, f64),
        visit: &mut impl FnMut(f64, f64) -> Option<R>,
    ) -> Option<R> {
        self.visit_cell(0, &(base, dir), (low, high), visit)
    }

    fn visit_cell<R>(
        &self,
        index: usize,
        line: &([f64; 3], [f64; 3]),
        (low, high): (f64, f64),
        visit: &mut impl FnMut(f64, f64) -> Option<R>,
    ) -> Option<R> {
        let cell = &self.cells[index];
        if cell.is_free {
            return None;
        }
        let Some((axis, place, [below, above])) = cell.cut else { return visit(low, high) };
        let (base, dir) = (line.0[axis], line.1[axis]);
        let cut = (place - base) / dir;
        let halves = if dir > 0.0 { [below, above] } else { [above, below] };
        // A line in the plane of the cut gives a NaN, which both comparisons treat as no cut.
        if cut > low && cut < high {
            let found = self.visit_cell(halves[0], line, (low, cut), visit);
            return found.or_else(|| self.visit_cell(halves[1], line, (cut, high), visit));
        }
        let is_below = base + dir * (low + 0.5 * (high - low)) < place;
        self.visit_cell(if is_below { below } else { above }, line, (low, high), visit)
    }

    /// Returns the cells where the formula may be 0, and which are not cut.
    pub fn places(&self) -> impl Iterator<Item = [Interval; 3]> + '_ {
        let open = self.cells.iter().filter(|cell| !cell.is_free && cell.cut.is_none());
        open.map(|cell| cell.place)
    }
}

fn widened(place: [Interval; 3], margin: [f64; 3]) -> [Interval; 3] {
    [0, 1, 2]
        .map(|axis| Interval { low: place[axis].low - margin[axis], high: place[axis].high + margin[axis] })
}

/// Tells whether an operation may choose among several, depending on the place.
pub(super) fn is_choice(step: Step) -> bool {
    use Function::{Abs, Floor, Heaviside, If, Max, Min};
    matches!(step, Step::Call(Min | Max | Abs | Floor | Heaviside | If))
}

/// Returns the values of a formula that matter in a box, and bounds on the formula there.
fn pruned(values: &Values, place: [Interval; 3]) -> (Values, Interval) {
    let list = &values.list;
    let mut bounds: Vec<Interval> = Vec::with_capacity(list.len());
    // For each value, the value that it equals in the box, and its operation.
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
    // The values from which the result is computed, in order.
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
    use std::sync::Arc;

    /// Returns 125 balls on a grid, as their distances.
    fn balls() -> Field {
        let place = |index: i32| 0.4 * f64::from(index) - 0.8;
        let ball = |index: i32| {
            let [x, y, z] = [index / 25, index / 5 % 5, index % 5].map(place);
            format!("sqrt((x - {x})^2 + (y - {y})^2 + (z - {z})^2) - 0.1")
        };
        let balls: Vec<_> = (0..125).map(ball).collect();
        let formula = Formula::parse_in(&format!("min({})", balls.join(", ")), SPACE).expect("a formula");
        Field::new(Arc::new(formula)).expect("its variables are x, y and z")
    }

    #[test]
    fn a_formula_has_the_same_values_in_its_cells() {
        let (whole, cut) = (balls(), balls().within([[-1.0; 3], [1.0; 3]]));
        let cells = cut.cells().expect("it is cut");
        assert!(cells.places().count() > 100);
        for step in 0..20_000 {
            let at = [7, 31, 101].map(|factor| f64::from(step * factor % 997) / 997.0 * 2.2 - 1.1);
            let (one, other): (f64, f64) = (whole.at(at), cut.at(at));
            assert_eq!(one, other, "{at:?}");
        }
    }

    #[test]
    fn a_line_meets_all_balls_in_its_cells() {
        let cut = balls().within([[-1.0; 3], [1.0; 3]]);
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
