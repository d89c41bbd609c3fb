//! A polynomial along a line from its values at nodes of the line, which is faster than operations on the coefficients.

use super::along::AlongLines;
use super::program::{Instruction, Program};
use super::step::Step;
use crate::double_double::DoubleDouble;
use crate::interval::Interval;
use crate::roots::bernstein::{BINOMIALS, Bernstein};
use crate::scalar::{Scalar, per_axis};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Half the distance from 1 to the next number: the maximum rounding error of an operation, as a fraction of its
/// result.
const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Computed bounds are multiplied by this factor to cover their own rounding.
const ROUNDED_UP: f64 = 1.0 + 1e-6;

/// The maximum degree. With higher degrees, the errors of values grow until operations on the coefficients are far more
/// precise.
const MAX_DEGREE: usize = 16;

/// The maximum number of registers of a program.
const MAX_REGISTERS: usize = 24;

/// The number of registers that is enough for most programs.
const FEW_REGISTERS: usize = 8;

/// The maximum error of a coordinate, as a fraction of the box, for which errors of values are known.
const MAX_ERROR: f64 = 1e-9;

/// A box is enlarged by this fraction of its sides, because rounding moves a line out of the box.
const AROUND: f64 = 1.0 / 1024.0;

/// The evaluation of a formula along lines in a box.
pub struct Nodes {
    program: Program,
    basis: &'static Basis,
    degree: usize,
    /// A bound of the error of a value for exact coordinates, and its growth with the error of the coordinates.
    error: [f64; 2],
    /// The maximum error of a coordinate for which the bound holds.
    most_off: f64,
    /// The maximum magnitude of a coordinate in the box.
    size: f64,
}

/// The nodes for polynomials of a degree.
struct Basis {
    /// The nodes, from -1 to 1.
    places: Vec<f64>,
    /// For each node, the Bernstein coefficients of the polynomial that is 1 at this node and 0 at the others.
    weights: Vec<Vec<f64>>,
    /// The maximum sum, over coefficients, of the absolute values of a coefficient's weights.
    norm: f64,
}

/// The nodes for each degree, once a formula needs them.
static BASES: [OnceLock<Option<Basis>>; MAX_DEGREE + 1] = [const { OnceLock::new() }; MAX_DEGREE + 1];

impl Basis {
    fn new(degree: usize) -> Option<Self> {
        let count = degree + 1;
        let places: Vec<f64> =
            (0..count).map(|node| -libm::cos(PI * (node as f64 + 0.5) / count as f64)).collect();
        let weights = weights(&places)?;
        let sum = |of: usize| weights.iter().map(|weights| weights[of].abs()).sum::<f64>();
        let norm = (0..count).map(sum).fold(0.0, f64::max);
        Some(Self { places, weights, norm })
    }
}

/// A line: the points `base + t dir`. The coordinates of `base` may be off by `blur`, and those of `dir` by `turn`.
#[derive(Clone, Copy, Debug)]
pub struct NearLine {
    /// The point at t = 0.
    pub base: [f64; 3],
    /// The direction, of a length of 1 or less.
    pub dir: [f64; 3],
    /// A bound of the error of each coordinate of the point.
    pub blur: f64,
    /// A bound of the error of each coordinate of the direction.
    pub turn: f64,
}

impl AlongLines {
    /// Prepares a formula that is a polynomial of this degree along lines in a box, given its low and its high corner.
    /// Returns `None` if it is not, or if it is too long.
    pub fn nodes(&self, degree: usize, [low, high]: [[f64; 3]; 2]) -> Option<Nodes> {
        let Self(program) = self;
        let within = per_axis(|axis| {
            let slack = AROUND * (high[axis] - low[axis]);
            Interval { low: low[axis] - slack, high: high[axis] + slack }
        });
        let size = within.iter().fold(0.0, |size: f64, side| size.max(side.magnitude()));
        let most_off = MAX_ERROR * size;
        if program.registers > MAX_REGISTERS {
            return None;
        }
        let error = |off: f64| error(program, within, off).filter(|error| *error < f64::INFINITY);
        let exact = error(0.0)?;
        // The error is a polynomial of a coordinate's error with positive coefficients, and so it is below its chord.
        let grows = (error(most_off)? - exact) / most_off;
        let basis = BASES.get(degree)?.get_or_init(|| Basis::new(degree)).as_ref()?;
        let error = [exact, ROUNDED_UP * grows.max(0.0)];
        Some(Nodes { program: program.clone(), basis, degree, error, most_off, size })
    }
}

impl Nodes {
    /// Returns the formula on a piece of a line in the box, or `None` if its error is unknown.
    pub fn form<const N: usize>(&self, line: &NearLine, piece: Interval) -> Option<Bernstein<f64, N>> {
        match self.degree + 1 {
            0..=4 => self.form_by::<N, 4>(line, piece),
            5..=6 => self.form_by::<N, 6>(line, piece),
            7..=8 => self.form_by::<N, 8>(line, piece),
            9..=10 => self.form_by::<N, 10>(line, piece),
            11..=14 => self.form_by::<N, 14>(line, piece),
            _ => self.form_by::<N, { MAX_DEGREE + 2 }>(line, piece),
        }
    }

    fn form_by<const N: usize, const LANES: usize>(
        &self,
        &NearLine { base, dir, blur, turn }: &NearLine,
        piece: Interval,
    ) -> Option<Bernstein<f64, N>> {
        let far = piece.magnitude();
        let off = blur + (turn + 16.0 * ROUNDING) * far + 8.0 * ROUNDING * self.size;
        // The comparison is false for NaN.
        let is_near = off <= self.most_off;
        if !is_near || self.degree >= N {
            return None;
        }
        let (middle, half) = (0.5 * piece.low + 0.5 * piece.high, 0.5 * (piece.high - piece.low));
        let mut at = [[0.0; LANES]; 3];
        for (lane, place) in self.basis.places.iter().enumerate() {
            let t = middle + half * place;
            for axis in 0..3 {
                at[axis][lane] = base[axis] + t * dir[axis];
            }
        }
        let values = match self.program.registers {
            ..=FEW_REGISTERS => run::<LANES, FEW_REGISTERS>(&self.program, at),
            _ => run::<LANES, MAX_REGISTERS>(&self.program, at),
        };
        let (mut coefficients, mut largest) = ([0.0; N], 0.0_f64);
        for (value, weights) in values.iter().zip(&self.basis.weights) {
            largest = largest.max(value.abs());
            let sums = &mut coefficients[..weights.len()];
            for of in 0..weights.len() {
                sums[of] += weights[of] * value;
            }
        }
        let [exact, grows] = self.error;
        let rounding = (self.degree + 8) as f64 * ROUNDING * largest;
        let error = ROUNDED_UP * self.basis.norm * (exact + grows * off + rounding) + f64::MIN_POSITIVE;
        Bernstein::known(coefficients, self.degree, error)
    }
}

/// Evaluates a program at several points.
fn run<const LANES: usize, const REGISTERS: usize>(program: &Program, at: [[f64; LANES]; 3]) -> [f64; LANES] {
    let mut registers = [[0.0; LANES]; REGISTERS];
    registers[..3].copy_from_slice(&at);
    for Instruction { step, operands, result } in &program.instructions {
        // `map` of an array would be a call for each element.
        let (a, b) = (&registers[usize::from(operands[0])], &registers[usize::from(operands[1])]);
        let mut value = [0.0; LANES];
        macro_rules! each {
            ($lane:ident => $of:expr) => {
                for $lane in 0..LANES {
                    value[$lane] = $of;
                }
            };
        }
        match *step {
            Step::Mul => each!(lane => a[lane] * b[lane]),
            Step::Add => each!(lane => a[lane] + b[lane]),
            Step::Sub => each!(lane => a[lane] - b[lane]),
            Step::Div => each!(lane => a[lane] / b[lane]),
            Step::Neg => each!(lane => -a[lane]),
            Step::Scale(factor) => each!(lane => a[lane] * factor),
            Step::Shift(by) => each!(lane => a[lane] + by),
            Step::Number(number) => value = [number; LANES],
            // A program with another step has no nodes.
            _ => value = *a,
        }
        registers[usize::from(*result)] = value;
    }
    registers[usize::from(program.result)]
}

/// Returns a bound of the error of a program's value in a box. Coordinates may be off by `off`. Returns `None` if the
/// program has operations other than sums, products, and quotients by numbers.
fn error(program: &Program, within: [Interval; 3], off: f64) -> Option<f64> {
    let error = program.fold(within.map(|axis| (axis, off)), |step, [&(a, a_off), &(b, b_off), _]| {
        let (a_size, b_size) = (a.magnitude(), b.magnitude());
        let (value, handed_on) = match step {
            Step::Mul => (a * b, a_off * (b_size + b_off) + a_size * b_off),
            Step::Add => (a + b, a_off + b_off),
            Step::Sub => (a - b, a_off + b_off),
            Step::Div if b.low == b.high && b_off == 0.0 && b_size > 0.0 => (a / b, a_off / b_size),
            Step::Neg => (-a, a_off),
            Step::Scale(factor) => (a * Interval::constant(factor), a_off * factor.abs()),
            Step::Shift(by) => (a + Interval::constant(by), a_off),
            Step::Number(number) => (Interval::constant(number), 0.0),
            _ => return None,
        };
        let is_exact = matches!(step, Step::Neg | Step::Number(_));
        let rounded = if is_exact { 0.0 } else { ROUNDING * (value.magnitude() + handed_on) };
        let off = ROUNDED_UP * (handed_on + rounded) + if is_exact { 0.0 } else { f64::MIN_POSITIVE };
        value.is_bounded().then_some((value, off))
    });
    error.map(|(_, off)| off)
}

/// Returns for each node the Bernstein coefficients of the polynomial that is 1 at this node and 0 at the others, by
/// Gaussian elimination in double-double arithmetic.
fn weights(places: &[f64]) -> Option<Vec<Vec<f64>>> {
    let (count, zero, one) = (places.len(), DoubleDouble::from(0.0), DoubleDouble::from(1.0));
    let degree = count - 1;
    // Each row has the basis at a node, and the row's combination of the values.
    let mut rows: Vec<Vec<DoubleDouble>> = Vec::with_capacity(count);
    for (node, place) in places.iter().enumerate() {
        let x = (one + DoubleDouble::from(*place)) * DoubleDouble::from(0.5);
        let basis = |of: usize| {
            let powers = x.powi(of as i32) * (one - x).powi((degree - of) as i32);
            powers * DoubleDouble::from(BINOMIALS[degree][of])
        };
        let of_values = (0..count).map(|other| if other == node { one } else { zero });
        rows.push((0..count).map(basis).chain(of_values).collect());
    }
    for column in 0..count {
        let size = |row: &usize| rows[*row][column].high.abs();
        let pivot = (column..count).max_by(|one, other| size(one).total_cmp(&size(other)))?;
        rows.swap(column, pivot);
        let inverse = one / rows[column][column];
        if !inverse.high.is_finite() {
            return None;
        }
        rows[column].iter_mut().for_each(|of| *of = *of * inverse);
        let own = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(index, _)| *index != column) {
            let factor = row[column];
            row.iter_mut().zip(&own).for_each(|(of, own)| *of = *of - factor * *own);
        }
    }
    let of_node = |node: usize| rows.iter().map(|row| row[count + node].high).collect();
    Some((0..count).map(of_node).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::tests::field;
    use crate::polynomial::{MAX_COEFFICIENTS, Polynomial};

    #[test]
    fn values_at_nodes_tell_the_coefficients() {
        let corners = [[-1.5; 3], [1.5; 3]];
        for (text, degree) in [
            ("x^2 + y^2 + z^2 - 1", 2),
            ("4*(x^2 + y^2 + z^2) + 16*x*y*z - 1", 3),
            ("(x^2 + y^2 + z^2 - 1)^3 - x^2*z^3/3 - (2 - y)^2*z^3", 6),
            ("(x^4 - y^2*z)^3 - x*(z - 0.5)^8 + 7", 12),
            ("(x^4 - 2*y^3 + z)^4 - 3*x^7*y^9", 16),
        ] {
            let field = field(text);
            let along_lines = field.along_lines();
            let nodes = along_lines.nodes(degree, corners).expect(text);
            for step in 0..40 {
                let number = |by: usize| ((step * by) % 97) as f64 / 97.0 - 0.5;
                let line = NearLine {
                    base: [number(31), number(53), number(71)],
                    dir: [0.5 + 0.5 * number(11), 0.6 * number(29), 0.5],
                    blur: 1e-15,
                    turn: 1e-15,
                };
                let piece = Interval { low: -0.8 + 0.2 * number(5), high: 0.9 };
                let form = nodes.form::<MAX_COEFFICIENTS>(&line, piece).expect(text);
                let along = Polynomial::<DoubleDouble, MAX_COEFFICIENTS>::along(piece);
                let place = |axis: usize| {
                    Polynomial::constant(line.base[axis]) + Polynomial::constant(line.dir[axis]) * along
                };
                let exact = Bernstein::of(&along_lines.polynomial(per_axis(place))).expect(text);
                let pairs = form.coefficients().iter().zip(exact.coefficients());
                let off = pairs.map(|(one, other)| (*one - other.high).abs()).fold(0.0, f64::max);
                assert!(off <= form.error(), "{text}: {off:e} {:e}", form.error());
                let largest = form.coefficients().iter().fold(0.0, |most: f64, of| most.max(of.abs()));
                assert!(degree > 12 || form.error() < 1e-7 * largest, "{text}: {:e}", form.error());
            }
        }
    }

    #[test]
    fn what_is_no_polynomial_has_no_nodes() {
        for text in ["sin(x)", "x/y", "sqrt(x^2)", "x^-1 + y", "1e300*x^20*1e300"] {
            assert!(field(text).along_lines().nodes(3, [[-1.5; 3], [1.5; 3]]).is_none(), "{text}");
        }
    }
}
