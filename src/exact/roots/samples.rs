//! Equidistant samples over the part of the ray near the shape, then a refiner.
//!
//! Most programs work like this, such as POV-Ray's `sor` and much course work. With any number of samples, a grazing
//! ray may be inside the surface for less than the distance between two samples, and its two roots are lost together.
//! With three roots between two samples, the refiner may find the last one.
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
