//! The conditions on a formula in x, y and z under which its surface can be hit: on the whole surface within its box,
//! the formula and its slope are bounded. Interval arithmetic proves that on smaller and smaller parts of the box.

use crate::world::body::Warning;
use glam::DVec3;
use std::collections::VecDeque;
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::Interval;

/// The number of formula operations that a check may take, a function counted as eight: some tenths of a second.
const OPERATIONS: u64 = 40_000_000;

/// The number of times that the box is halved before a part counts as a point: 18 times along each axis.
const HALVINGS: u32 = 54;

/// The largest number of parts in which a change of sign is looked for.
const PARTS: u64 = 1 << 14;

/// The reason why a formula makes no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoField {
    /// The formula has no bounds, or is not defined.
    Unbounded {
        /// A point near which the formula is unbounded or not defined.
        near: DVec3,
    },
    /// The slope has no bounds where the formula may be 0.
    Steep {
        /// A point near which the slope is unbounded.
        near: DVec3,
    },
    /// The formula is nowhere 0.
    Nowhere,
    /// Bounds take too many operations.
    Bends,
}

impl NoField {
    /// Returns the error of the formula and its correction, for messages: "has a formula ...".
    pub fn message(self) -> (String, &'static str) {
        let place = |DVec3 { x, y, z }: DVec3| format!("near x = {x:.4}, y = {y:.4}, z = {z:.4}");
        match self {
            Self::Unbounded { near } => (
                format!("that is unbounded or not defined {}", place(near)),
                "the formula has to be finite wherever it may be 0 in its box",
            ),
            Self::Steep { near } => (
                format!("whose slope is unbounded {}", place(near)),
                "where the formula is 0 in its box it must not jump, and a root or a power with a fraction must not \
                 be of something that is 0 there: write a cone as `x^2 + z^2 - y^2`, not as `sqrt(x^2 + z^2) - y`",
            ),
            Self::Nowhere => (
                "that is nowhere 0 in its box".to_owned(),
                "the surface is where the formula is 0: change the formula, or the box",
            ),
            Self::Bends => (
                "that bends too often in its box to be bounded".to_owned(),
                "give a smaller box, or a formula with fewer waves",
            ),
        }
    }
}

/// Returns a formula without the powers of its factors, with a warning for what was left out, or of what could not be: where a
/// squared factor is 0, the formula does not change its sign.
pub fn reduced(field: Field) -> (Field, Vec<Warning>) {
    let mut warnings = Vec::new();
    let (reduced, names) = field.without_powers().unwrap_or((field, Vec::new()));
    for name in names {
        warnings.push(Warning {
            attribute: "formula",
            message: format!("has a formula with a power of the factor `{name}`"),
            help: "the surface is the same without the power, and is drawn without it".to_owned(),
        });
    }
    if reduced.has_repeated_factor() {
        warnings.push(Warning {
            attribute: "formula",
            message: "has a formula that touches 0 without a change of sign on a part of its surface".to_owned(),
            help: "a factor of the formula is squared, once its products are expanded: hits there take more time, and have \
                   no inside and outside"
                .to_owned(),
        });
    }
    (reduced, warnings)
}

/// A part of the box, and the number of halvings that made it.
type Part = ([DVec3; 2], u32);

/// Proves that a formula and its slope are bounded on its surface in a box, and that there may be such a surface.
///
/// # Errors
/// The reason why the formula makes no surface.
pub fn check(field: &Field, corners: [DVec3; 2]) -> Result<(), NoField> {
    let (mut left, mut smooth) = (OPERATIONS, Vec::new());
    let mut waiting: Vec<Part> = match field.cells() {
        Some(cells) => cells.places().map(|place| (corners_of(place), 0)).collect(),
        None => vec![(corners, 0)],
    };
    while let Some(part) = waiting.pop() {
        let ([low, high], halvings) = part;
        let at = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        // The value, and a slope along each axis, of which each takes several times as long.
        left = left.checked_sub(16 * field.cost(at).max(1)).ok_or(NoField::Bends)?;
        let value = field.at(at);
        if !value.has_zero() {
            continue;
        }
        if value.is_bounded() && (0..3).all(|axis| slope(field, at, axis).is_bounded()) {
            smooth.push(part);
        } else if halvings < HALVINGS {
            waiting.extend(halves(part));
        } else {
            let near = 0.5 * (low + high);
            return Err(match value.is_bounded() {
                true => NoField::Steep { near },
                false => NoField::Unbounded { near },
            });
        }
    }
    if is_nowhere(field, smooth) { Err(NoField::Nowhere) } else { Ok(()) }
}

fn corners_of([x, y, z]: [Interval; 3]) -> [DVec3; 2] {
    [DVec3::new(x.low, y.low, z.low), DVec3::new(x.high, y.high, z.high)]
}

/// Returns the number of parts in which a change of sign is looked for: fewer for a formula of thousands of operations.
fn parts_of(field: &Field) -> u64 {
    PARTS.min(OPERATIONS / (field.formula().cost().max(1) * 2))
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

/// Tells whether a formula is certainly nowhere 0 in these parts.
fn is_nowhere(field: &Field, parts: Vec<Part>) -> bool {
    let (mut signs, mut parts, mut left) = ([false; 2], VecDeque::from(parts), parts_of(field));
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
