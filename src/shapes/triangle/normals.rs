//! Normals of triangles that need many digits. Each thread remembers the last ones, because rays that hit several
//! triangles of one plane compare all of them.

use super::{quick_normal, slow_normal};
use glam::DVec3;
use std::cell::Cell;
use tabray_exact::double_double::DoubleDouble;

/// The number of remembered normals.
const SIZE: usize = 64;

/// The corners of a triangle, and its normal.
type Entry = ([DVec3; 3], [DoubleDouble; 3]);

thread_local! {
    static KNOWN: Cell<Option<Box<[Entry; SIZE]>>> = const { Cell::new(None) };
}

/// Returns the result of [`exact_normal`](super::exact_normal).
#[inline]
pub(super) fn remembered_normal(corners: [DVec3; 3]) -> [DoubleDouble; 3] {
    let (normal, is_known) = quick_normal(corners);
    if is_known { normal } else { slow_or_remembered(corners) }
}

/// Returns a normal that needs many digits. Corners with the same bits have the same normal.
#[inline(never)]
fn slow_or_remembered(corners: [DVec3; 3]) -> [DoubleDouble; 3] {
    let bits = |of: &[DVec3; 3]| of.map(|at| at.to_array().map(f64::to_bits));
    let key = bits(&corners);
    let mixed = key
        .as_flattened()
        .iter()
        .fold(0_u64, |mixed, bits| (mixed ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23));
    let place = (mixed >> 32) as usize % SIZE;
    // No triangle has equal corners.
    let none = || Box::new([([DVec3::ZERO; 3], [DoubleDouble { high: 0.0, low: 0.0 }; 3]); SIZE]);
    let mut known = KNOWN.take().unwrap_or_else(none);
    let (of, normal) = &mut known[place];
    if bits(of) != key {
        (*of, *normal) = (corners, slow_normal(corners));
    }
    let normal = *normal;
    KNOWN.set(Some(known));
    normal
}
