//! Steps of 0.1 until the function's sign changes, then bisection to 1e-6, both in world units.
//!
//! From the course notes' page on procedural surfaces. The method skips details thinner than a step along the ray:
//! silhouettes, thin discs, ripples. Far from the ray's origin, 1e-6 is less than an ulp, and bisection needs another
//! stopping condition.

use super::bisection;
use super::refiner::sign_change;
use super::taylor::{FunctionOnLine, SignChange};
use crate::roots::range::Side;
use std::ops::Range;

const STEP: f64 = 0.1;

/// The distance to which the course notes follow a ray, in world units.
const FAR: f64 = 100.0;

pub fn first_root(
    line: &impl FunctionOnLine,
    Range { start, end }: Range<f64>,
    origin_side: Option<Side>,
) -> Option<f64> {
    let end = end.min(start + FAR);
    let count = ((end - start) / STEP).ceil() as u32;
    let places = (0..=count).map(|index| (start + f64::from(index) * STEP).min(end));
    let SignChange { low, high, rises } = sign_change(line, places, origin_side)?;
    Some(bisection::root(|t| line.at(t), (low, high), !rises, 1e-6))
}
