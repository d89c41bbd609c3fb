//! Equidistant samples over the part of the ray that is near the shape, then a refiner.
//!
//! What most programs do; POV-Ray's `sor` and much course work. However many samples there are, a grazing ray is inside
//! the surface for less than the distance between two of them, and its two roots are lost together; and where three
//! roots lie between two samples, the refiner may find the last one.

use super::refiner::{Refiner, evenly, sign_change};
use super::taylor::{FunctionOnLine, SignChange};
use crate::roots::range::Side;
use std::ops::Range;

pub fn first_root(
    line: &impl FunctionOnLine,
    span: Range<f64>,
    shortest: f64,
    origin_side: Option<Side>,
    (count, refiner): (u32, Refiner),
) -> Option<f64> {
    let SignChange { low, high, rises } = sign_change(line, evenly(&span, count), origin_side)?;
    Some(refiner.root(line, (low, high), !rises, shortest))
}
