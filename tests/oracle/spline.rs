//! Natural cubic splines, their coefficients to 300 bits, evaluated piece by piece.

use super::dyadic::Dyadic;
use super::number::{Constant, Jet, Number};

/// A spline: its pieces, each with its ends and the coefficients of a cubic in the distance from its lower end.
#[derive(Clone, Debug)]
pub struct Spline(Vec<([Constant; 2], [Constant; 4])>);

const BITS: i64 = 300;

impl Spline {
    /// Makes the spline through points, each given as its y and its value.
    pub fn new(points: &[[Dyadic; 2]]) -> Self {
        let over = |top: &Dyadic, bottom: &Dyadic| top.divided(bottom, BITS, false);
        let pieces = points.len() - 1;
        let width = |piece: usize| points[piece + 1][0].sub(&points[piece][0]);
        let slope = |piece: usize| over(&points[piece + 1][1].sub(&points[piece][1]), &width(piece));
        // Gauss's elimination of the equations of the second derivatives, whose first and last are 0.
        let zero = Dyadic::zero();
        let (mut diagonal, mut right) = (vec![Dyadic::int(1); pieces + 1], vec![zero.clone(); pieces + 1]);
        for at in 1..pieces {
            diagonal[at] = width(at - 1).add(&width(at)).shifted(1);
            right[at] = slope(at).sub(&slope(at - 1)).mul(&Dyadic::int(6));
            if at > 1 {
                let factor = over(&width(at - 1), &diagonal[at - 1]);
                diagonal[at] = diagonal[at].sub(&factor.mul(&width(at - 1)));
                right[at] = right[at].sub(&factor.mul(&right[at - 1]));
            }
        }
        let mut bend = vec![zero; pieces + 1];
        for at in (1..pieces).rev() {
            bend[at] = over(&right[at].sub(&width(at).mul(&bend[at + 1])), &diagonal[at]);
        }
        let six = Dyadic::int(6);
        let all = (0..pieces).map(|piece| {
            let twice = bend[piece].shifted(1).add(&bend[piece + 1]);
            let first = slope(piece).sub(&over(&width(piece).mul(&twice), &six));
            let third = over(&bend[piece + 1].sub(&bend[piece]), &six.mul(&width(piece)));
            let ends = [points[piece][0].clone(), points[piece + 1][0].clone()];
            let coefficients = [points[piece][1].clone(), first, bend[piece].shifted(-1), third];
            (ends.map(Constant::from), coefficients.map(Constant::from))
        });
        Self(all.collect())
    }

    pub fn at<T: Number>(&self, y: &Jet<T>) -> Jet<T> {
        let pieces = self.0.iter().filter_map(|([low, high], coefficients)| {
            let value = y.value.meet(&T::constant(low).hull(&T::constant(high)))?;
            let inner = Jet { value, slope: y.slope.clone() };
            let from = inner.sub(&Jet::constant(T::constant(low)));
            let [c0, c1, c2, c3] = coefficients.each_ref().map(|of| Jet::constant(T::constant(of)));
            Some(c0.add(&from.mul(&c1)).add(&from.square().mul(&c2.add(&from.mul(&c3)))))
        });
        pieces.reduce(|one, other| one.hull(&other)).unwrap_or(Jet { value: T::any(), slope: T::any() })
    }
}
