//! The filters of a PNG's rows, which leave small numbers where a pixel is like its neighbours.

use std::iter;

/// The filters of rows.
#[derive(Clone, Copy)]
pub(super) enum Filter {
    /// Bytes are not predicted.
    None,
    /// Each byte is predicted by the one above.
    Up,
    /// Each row is predicted by the predictor that leaves the smallest numbers.
    Adaptive,
}

impl Filter {
    /// Writes the differences of a row from its prediction, after a byte that names the predictor. A pixel has three bytes
    /// or, with alpha, four.
    pub fn apply(self, pixel: usize, above: &[u8], row: &[u8], filtered: &mut [u8]) {
        if pixel == 4 {
            self.apply_to::<4>(above, row, filtered);
        } else {
            self.apply_to::<3>(above, row, filtered);
        }
    }

    fn apply_to<const PIXEL: usize>(self, above: &[u8], row: &[u8], filtered: &mut [u8]) {
        match self {
            Self::None => {
                filtered[0] = 0;
                filtered[1..].copy_from_slice(row);
            }
            Self::Up => predict::<PIXEL>(Predictor::Up, above, row, filtered),
            Self::Adaptive => {
                const ALL: [Predictor; 4] =
                    [Predictor::Up, Predictor::Left, Predictor::Mean, Predictor::Paeth];
                let mut best = (u64::MAX, Predictor::Up);
                for predictor in ALL {
                    predict::<PIXEL>(predictor, above, row, filtered);
                    let size = filtered[1..].iter().map(|byte| u64::from((*byte as i8).unsigned_abs())).sum();
                    if size <= best.0 {
                        best = (size, predictor);
                    }
                    if size == 0 {
                        break;
                    }
                }
                if filtered[0] != best.1 as u8 {
                    predict::<PIXEL>(best.1, above, row, filtered);
                }
            }
        }
    }
}

/// The predictors of a byte, as numbered in a PNG.
#[derive(Clone, Copy)]
enum Predictor {
    Left = 1,
    Up = 2,
    Mean = 3,
    Paeth = 4,
}

/// Writes the differences of a row from the prediction of a predictor, after the predictor's number. To the left of a
/// row and above the image everything is 0.
fn predict<const PIXEL: usize>(predictor: Predictor, above: &[u8], row: &[u8], filtered: &mut [u8]) {
    let (number, filtered) = filtered.split_at_mut(1);
    number[0] = predictor as u8;
    match predictor {
        Predictor::Left => each::<PIXEL>(above, row, filtered, |left, _, _| left),
        Predictor::Up => each::<PIXEL>(above, row, filtered, |_, up, _| up),
        Predictor::Mean => {
            each::<PIXEL>(above, row, filtered, |left, up, _| (left & up) + ((left ^ up) >> 1))
        }
        Predictor::Paeth => each::<PIXEL>(above, row, filtered, paeth),
    }
}

/// Writes the differences of the bytes of a row from their `prediction`, which depends on the bytes to the left, above,
/// and above to the left.
#[inline(always)]
fn each<const PIXEL: usize>(
    above: &[u8],
    row: &[u8],
    filtered: &mut [u8],
    prediction: impl Fn(u8, u8, u8) -> u8,
) {
    for at in 0..PIXEL.min(row.len()) {
        filtered[at] = row[at].wrapping_sub(prediction(0, above[at], 0));
    }
    let left = iter::zip(row, above);
    let here = iter::zip(&row[PIXEL..], &above[PIXEL..]);
    for ((out, (byte, up)), (left, corner)) in iter::zip(&mut filtered[PIXEL..], here).zip(left) {
        *out = byte.wrapping_sub(prediction(*left, *up, *corner));
    }
}

/// Returns the byte of three that is nearest to `left + up - corner`; of two equally near ones, the first.
#[inline(always)]
fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let (from_left, from_up, from_corner) = ((b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs());
    if from_left <= from_up && from_left <= from_corner {
        left
    } else if from_up <= from_corner {
        up
    } else {
        corner
    }
}
