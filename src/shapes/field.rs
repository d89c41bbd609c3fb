//! Questions about a formula in x, y and z in a box: whether it has a zero, whether it may have an inside, and how to
//! write it with fewer operations. Interval arithmetic on smaller and smaller parts of the box answers them.

use glam::DVec3;
use std::collections::VecDeque;
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::Interval;
use tabray_world::body::Warning;

/// The maximum number of formula operations for a question, a function counted as eight: some tenths of a second.
const OPERATIONS: u64 = 40_000_000;

/// The maximum number of such operations to find that a formula is regular, which is asked of objects that must be
/// closed: a few seconds at most. They suffice for a union of hundreds of balls.
const MAX_OPERATIONS: u64 = 10 * OPERATIONS;

/// The number of halvings of the box after which a part counts as a point: 18 along each axis.
const HALVINGS: u32 = 54;

/// The maximum number of parts that are examined for a change of sign.
const PARTS: u64 = 1 << 14;

/// A simpler formula with the zeros of another one.
pub struct Reduced {
    /// The formula. It is the numerator of a quotient of polynomials, without the powers of its factors.
    pub formula: Field,
    /// The omitted denominator, if any.
    pub denominator: Option<Field>,
    /// The squared factors that were removed from the formula, or could not be. Where a squared factor is 0, the
    /// formula does not change its sign.
    pub warnings: Vec<Warning>,
}

/// Reduces a formula to one whose zeros are found faster and more reliably.
pub fn reduced(field: Field) -> Reduced {
    let mut warnings = Vec::new();
    let (field, denominator) = match field.quotient() {
        Some([numerator, denominator]) => (numerator, Some(denominator)),
        None => (field, None),
    };
    let (formula, names) = field.without_powers().unwrap_or((field, Vec::new()));
    for name in names {
        warnings.push(Warning {
            attribute: "formula",
            message: format!("has a formula with a power of the factor `{name}`"),
            help: "the surface is the same without the power, and is drawn without it".to_owned(),
        });
    }
    if formula.has_repeated_factor() {
        warnings.push(Warning {
            attribute: "formula",
            message: "has a formula that touches 0 without a change of sign on a part of its surface".to_owned(),
            help: "a factor of the formula is squared, once its products are expanded: hits there take more time, and have \
                   no inside and outside"
                .to_owned(),
        });
    }
    Reduced { formula, denominator, warnings }
}

/// A part of the box, and the number of halvings that produced it.
type Part = ([DVec3; 2], u32);

/// Whether a formula and its slope are bounded on its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regularity {
    /// Both are certainly bounded.
    Bounded,
    /// One of them may be unbounded in a part of the box as small as a point.
    MayJump,
    /// The answer takes too many operations.
    TooCostly,
}

/// Tells whether a formula and its slope are bounded on the formula's surface in a box.
pub fn regularity(field: &Field, corners: [DVec3; 2]) -> Regularity {
    regularity_within(field, corners, MAX_OPERATIONS)
}

fn regularity_within(field: &Field, corners: [DVec3; 2], mut operations: u64) -> Regularity {
    let mut waiting: Vec<Part> = vec![(corners, 0)];
    while let Some(part) = waiting.pop() {
        let ([low, high], halvings) = part;
        // Parts overlap a little: a pole between two of them lies within both, and not at the end of each.
        let at = [0, 1, 2].map(|axis| Interval {
            low: low[axis].next_down().max(corners[0][axis]),
            high: high[axis].next_up().min(corners[1][axis]),
        });
        let cost = field.cost(at).max(1);
        let Some(left) = operations.checked_sub(cost) else { return Regularity::TooCostly };
        operations = left;
        let value = field.at(at);
        if !value.has_zero() {
            continue;
        }
        // A slope along each axis takes several times as long as the value.
        let Some(left) = operations.checked_sub(15 * cost) else { return Regularity::TooCostly };
        operations = left;
        let is_bounded = value.is_bounded() && (0..3).all(|axis| slope(field, at, axis).is_bounded());
        if !is_bounded {
            if halvings == HALVINGS {
                return Regularity::MayJump;
            }
            waiting.extend(halves(part));
        }
    }
    Regularity::Bounded
}

/// Returns the number of parts to examine for a change of sign, fewer for a formula of thousands of operations.
fn parts_of(field: &Field) -> u64 {
    PARTS.min(OPERATIONS / (field.formula().cost_in_box().max(1) * 2))
}

/// Tells whether a formula is certainly above 0 on all sides of a box.
pub fn is_outside(field: &Field, [low, high]: [DVec3; 2]) -> bool {
    let side = |index: usize| {
        let (axis, mut from, mut to) = (index / 2, low, high);
        if index.is_multiple_of(2) {
            to[axis] = low[axis];
        } else {
            from[axis] = high[axis];
        }
        ([from, to], 0)
    };
    let mut waiting: Vec<Part> = (0..6).map(side).collect();
    let mut left = parts_of(field);
    while let Some(part) = waiting.pop() {
        let ([low, high], _) = part;
        let value = field.at([0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] }));
        if value.low > 0.0 {
            continue;
        }
        if value.high <= 0.0 || left == 0 {
            return false;
        }
        left -= 1;
        waiting.extend(halves(part));
    }
    true
}

/// Encloses a formula in a box.
pub fn bounds(field: &Field, [low, high]: [DVec3; 2]) -> Interval {
    field.at([0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] }))
}

/// The number of places tried along each side of a box. It is even, because many formulas are 0 in the middle.
const TRIED: usize = 8;

/// Tells whether a formula is finite at none of the places tried in a box, and infinite at most of them: its values
/// exceed the range of f64.
pub fn overflows(field: &Field, [low, high]: [DVec3; 2]) -> bool {
    let along = |place: usize| (place as f64 + 0.5) / TRIED as f64;
    let places = (0..TRIED.pow(3)).map(|place| [place % TRIED, place / TRIED % TRIED, place / TRIED.pow(2)]);
    let mut infinite = 0;
    for place in places {
        let part = DVec3::from(place.map(along));
        let value = field.at((low + part * (high - low)).to_array());
        if value.is_finite() {
            return false;
        }
        infinite += usize::from(value.is_infinite());
    }
    2 * infinite > TRIED.pow(3)
}

/// Tells whether a formula certainly has no zero in a box.
pub fn is_nowhere(field: &Field, corners: [DVec3; 2]) -> bool {
    let (mut signs, mut left) = ([false; 2], parts_of(field));
    let mut parts = VecDeque::from([(corners, 0)]);
    while let Some(part) = parts.pop_front() {
        let ([low, high], _) = part;
        let at = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        signs[usize::from(field.at((0.5 * (low + high)).to_array()) < 0.0)] = true;
        if signs == [true; 2] || left == 0 {
            return false;
        }
        left -= 1;
        if field.at(at).has_zero() {
            parts.extend(halves(part));
        }
    }
    true
}

fn slope(field: &Field, at: [Interval; 3], along: usize) -> Interval {
    let own = |axis: usize| if axis == along { Dual::variable(at[axis]) } else { Dual::fixed(at[axis]) };
    field.at([own(0), own(1), own(2)]).slope
}

/// Returns the halves of a part, cut across its longest side.
fn halves(([low, high], halvings): Part) -> [Part; 2] {
    let axis = (high - low).max_position();
    let middle = low[axis] + 0.5 * (high[axis] - low[axis]);
    let (mut below, mut above) = (high, low);
    (below[axis], above[axis]) = (middle, middle);
    [([low, below], halvings + 1), ([above, high], halvings + 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tabray_exact::formula::Formula;

    #[test]
    fn a_check_that_is_given_up_is_no_jump() {
        let check = |text: &str, operations: u64| {
            let formula = Formula::parse_in(text, Field::VARIABLES).expect("a formula");
            let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
            regularity_within(&field, [DVec3::splat(-2.0), DVec3::splat(2.0)], operations)
        };
        assert_eq!(check("x^2 + y^2 + z^2 - 1", MAX_OPERATIONS), Regularity::Bounded);
        assert_eq!(check("y - floor(x) - 0.5*z", MAX_OPERATIONS), Regularity::MayJump);
        assert_eq!(check("y - floor(x) - 0.5*z", 10), Regularity::TooCostly);
    }

    #[test]
    fn a_pole_between_two_parts_of_the_box_may_be_a_jump() {
        for pole in
            ["1/x", "-1/x", "atan(1/x)", "exp(1/x) - 2", "min(1/x, y)", "1/(x - 0.5)", "1/(x - 0.3)", "1/x^3"]
        {
            let text = format!("max(x^2 + y^2 + z^2 - 1, {pole})");
            let formula = Formula::parse_in(&text, Field::VARIABLES).expect("a formula");
            let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
            let found = regularity(&field, [DVec3::splat(-2.0), DVec3::splat(2.0)]);
            assert_eq!(found, Regularity::MayJump, "{text}");
        }
    }
}
