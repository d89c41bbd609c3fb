//! Exact roots of polynomials with integer coefficients, by Descartes' rule of signs and bisection.
//!
//! This is the method of [`bernstein`](super::bernstein) with integers in place of rounded coefficients. No sign is
//! undecided: roots are separated however close they are, and a touch is distinguished from a miss. A polynomial is
//! first freed of its repeated factors, because bisection would not end with them.
//!
//! Source: B. Mourrain, F. Rouillier and M.-F. Roy, "Bernstein's basis and real root isolation" (2005); the greatest common
//! divisor is that of W. S. Brown, "The subresultant PRS algorithm" (1978).

mod divisor;
mod dyadic;
mod polynomial;

pub use dyadic::Dyadic;
pub use polynomial::Whole;

use crate::interval::{Float, Wide};
use crate::roots::bernstein::BINOMIALS;
use dashu_int::IBig;
use polynomial::sign;

/// The maximum number of halvings that narrow a root's enclosure.
const HALVINGS: usize = 128;

/// A root of a polynomial.
#[derive(Clone, Debug)]
pub struct Root {
    /// Bounds of the root, without another root between them. If they are equal, they are the root itself.
    pub bounds: [Dyadic; 2],
    /// Whether the polynomial rises at the root, or `None` if its sign does not change.
    pub rises: Option<bool>,
}

impl Root {
    /// Encloses the root in 237-bit numbers.
    pub fn wide(&self) -> Wide {
        let [low, high] = &self.bounds;
        Wide { low: low.wide().low, high: high.wide().high }
    }

    /// Returns the distance from a place to the root, rounded.
    pub fn nearest(&self, from: f64) -> f64 {
        let [low, high] = &self.bounds;
        low.middle(high).plus(&Dyadic::from(from).negated()).wide().low.to_f64()
    }
}

impl Whole {
    /// Returns the first wanted root from `low` to `high`. The polynomial 0 has none.
    pub fn first_root(&self, low: f64, high: f64, is_wanted: &dyn Fn(&Root) -> bool) -> Option<Root> {
        if self.is_zero() || low > high || !(high - low).is_finite() {
            return None;
        }
        let simple = self.without_repeated_factors();
        let [low, high] = [low, high].map(Dyadic::from);
        if low == high {
            let root = Some(self.root([low.clone(), low])).filter(|root| self.is_root(root));
            return root.filter(|root| is_wanted(root));
        }
        let form = Form::of(&simple, &low, &high);
        let mut visit = |place: Place| {
            let width = &high.plus(&low.negated());
            let at = |part: &Dyadic| low.plus(&part.times(width));
            let place = match place {
                Place::At(part) => [at(&part), at(&part)],
                Place::Between(from, to) => simple.narrowed([at(&from), at(&to)]),
            };
            Some(self.root(place)).filter(|root| is_wanted(root))
        };
        form.visit(&Dyadic::from(0.0), 0, &mut visit).or_else(|| {
            let is_end = form.coefficients.last().is_some_and(IBig::is_zero);
            if is_end { visit(Place::At(Dyadic::from(1.0))) } else { None }
        })
    }

    /// Tells whether a root of this polynomial is also one of another.
    pub fn shares(&self, root: &Root, other: &Self) -> bool {
        if other.is_zero() {
            return true;
        }
        let (one, other) = (self.primitive(), other.primitive());
        let (one, other) = if one.degree() < other.degree() { (other, one) } else { (one, other) };
        if other.degree() == 0 {
            return false;
        }
        // All roots of the divisor are roots of this polynomial, and so only this one can be between the bounds.
        let shared = one.divisor(other).without_repeated_factors();
        let [before, after] = root.bounds.each_ref().map(|place| shared.sign_at(place));
        before * after <= 0 && shared.degree() > 0
    }

    fn is_root(&self, root: &Root) -> bool {
        self.sign_at(&root.bounds[0]) == 0
    }

    /// Halves the bounds of a single root. The bounds are not roots themselves.
    fn narrowed(&self, [mut low, mut high]: [Dyadic; 2]) -> [Dyadic; 2] {
        let before = self.sign_at(&low);
        for _ in 0..HALVINGS {
            let middle = low.middle(&high);
            match self.sign_at(&middle) {
                0 => return [middle.clone(), middle],
                sign if sign == before => low = middle,
                _ => high = middle,
            }
        }
        [low, high]
    }

    /// Makes a root from its bounds.
    fn root(&self, bounds: [Dyadic; 2]) -> Root {
        let [low, high] = &bounds;
        let (before, after) = if low == high {
            // The first nonzero derivative gives the signs on both sides.
            let (mut of, mut order) = (self.derivative(), 1);
            while of.sign_at(low) == 0 && of.degree() > 0 {
                (of, order) = (of.derivative(), order + 1);
            }
            let after = of.sign_at(low);
            (if order % 2 == 0 { after } else { -after }, after)
        } else {
            (self.sign_at(low), self.sign_at(high))
        };
        Root { rises: (before != after).then_some(after > 0), bounds }
    }
}

/// The place of the only root of a piece, as a part of the whole.
enum Place {
    At(Dyadic),
    Between(Dyadic, Dyadic),
}

/// A polynomial in Bernstein form, times a positive number.
struct Form {
    coefficients: Vec<IBig>,
}

impl Form {
    /// Returns the form from one place to another.
    fn of(polynomial: &Whole, low: &Dyadic, high: &Dyadic) -> Self {
        let degree = polynomial.degree();
        let exponent = low.exponent.min(high.exponent);
        let [low, high] = [low, high].map(|place| &place.digits << (place.exponent - exponent) as usize);
        let (width, down, up) = (&high - &low, (-exponent).max(0) as usize, exponent.max(0) as usize);
        // Horner's scheme with `low + width s`, times powers of two.
        let mut powers: Vec<IBig> = vec![IBig::ZERO; degree + 1];
        for (step, coefficient) in polynomial.coefficients.iter().rev().enumerate() {
            for index in (0..=step).rev() {
                let before = if index > 0 { &powers[index - 1] * &width } else { IBig::ZERO };
                powers[index] = (&powers[index] * &low + before) << up;
            }
            powers[0] += coefficient << (down * step);
        }
        let binomial = |n: usize, k: usize| IBig::from(BINOMIALS[n][k] as u64);
        // This is a multiple of all binomials of the degree.
        let common = (1..=degree as u64 + 1).fold(1_u128, |common, of| {
            let of = u128::from(of);
            common / gcd(common, of) * of
        });
        let common = IBig::from(common);
        let scaled: Vec<IBig> =
            powers.iter().enumerate().map(|(power, of)| of * &common / binomial(degree, power)).collect();
        let coefficients = (0..=degree).map(|index| {
            (0..=index)
                .map(|power| &scaled[power] * binomial(index, power))
                .fold(IBig::ZERO, |sum, of| sum + of)
        });
        Self { coefficients: coefficients.collect() }
    }

    /// Returns the number of sign changes between the ends, ignoring zeros.
    fn changes(&self) -> usize {
        let mut signs = self.coefficients.iter().map(sign).filter(|sign| *sign != 0);
        let Some(mut last) = signs.next() else { return 0 };
        signs.map(|sign| usize::from(std::mem::replace(&mut last, sign) != sign)).sum()
    }

    /// Visits the roots of a form from its start on, without its end, until the visitor returns a value. The form is
    /// that of the piece with this start and this number of halvings.
    fn visit<R>(
        &self,
        start: &Dyadic,
        halvings: i64,
        visit: &mut impl FnMut(Place) -> Option<R>,
    ) -> Option<R> {
        let length = Dyadic::new(IBig::ONE, -halvings);
        if self.coefficients[0].is_zero()
            && let Some(taken) = visit(Place::At(start.clone()))
        {
            return Some(taken);
        }
        let ends_at_root = |form: &Self| {
            form.coefficients[0].is_zero() || form.coefficients.last().is_some_and(IBig::is_zero)
        };
        match self.changes() {
            0 => None,
            1 if !ends_at_root(self) => visit(Place::Between(start.clone(), start.plus(&length))),
            _ => {
                let [lower, upper] = self.halves();
                let middle = start.plus(&Dyadic::new(IBig::ONE, -halvings - 1));
                let taken = lower.visit(start, halvings + 1, visit);
                taken.or_else(|| upper.visit(&middle, halvings + 1, visit))
            }
        }
    }

    /// Returns the forms for both halves.
    fn halves(&self) -> [Self; 2] {
        let mut upper = self.coefficients.clone();
        let (count, mut lower) = (upper.len(), Vec::with_capacity(upper.len()));
        lower.push(&upper[0] << (count - 1));
        for step in 1..count {
            for index in 0..count - step {
                let (before, after) = upper.split_at_mut(index + 1);
                before[index] += &after[0];
            }
            lower.push(&upper[0] << (count - 1 - step));
        }
        for (index, of) in upper.iter_mut().enumerate() {
            *of <<= index;
        }
        [Self::new(lower), Self::new(upper)]
    }

    /// Makes a form from coefficients, without their common powers of two.
    fn new(mut coefficients: Vec<IBig>) -> Self {
        let zeros = coefficients.iter().filter_map(|of| of.trailing_zeros()).min().unwrap_or(0);
        coefficients.iter_mut().for_each(|of| *of >>= zeros);
        Self { coefficients }
    }
}

fn gcd(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the product of factors `a x - b`, and of others.
    fn product(roots: &[(i64, i64)], others: &[&[i64]]) -> Whole {
        let linear = roots.iter().map(|(a, b)| vec![-*b, *a]);
        let factors = linear.chain(others.iter().map(|other| other.to_vec()));
        let mut coefficients = vec![IBig::ONE];
        for factor in factors {
            let mut next = vec![IBig::ZERO; coefficients.len() + factor.len() - 1];
            for (power, of) in coefficients.iter().enumerate() {
                for (other, by) in factor.iter().enumerate() {
                    next[power + other] += of * IBig::from(*by);
                }
            }
            coefficients = next;
        }
        Whole::new(coefficients)
    }

    fn first(of: &Whole, low: f64, high: f64) -> Option<(f64, Option<bool>)> {
        of.first_root(low, high, &|_| true).map(|root| (root.nearest(0.0), root.rises))
    }

    #[test]
    fn roots_of_every_multiplicity_are_found_with_their_signs() {
        let of = product(&[(3, 1), (3, 1), (7, 5), (7, 5), (7, 5), (1, 2)], &[&[5, 0, 1]]);
        assert_eq!(first(&of, 0.0, 4.0), Some((1.0 / 3.0, None)));
        assert_eq!(first(&of, 0.5, 4.0), Some((5.0 / 7.0, Some(false))));
        assert_eq!(first(&of, 1.0, 4.0), Some((2.0, Some(true))));
        assert_eq!(first(&of, 2.0, 4.0), Some((2.0, Some(true))));
        assert_eq!(first(&of, 1.0, 2.0), Some((2.0, Some(true))));
        assert_eq!(first(&of, 2.5, 4.0), None);
        let rising = of.first_root(0.0, 4.0, &|root| root.rises == Some(true)).expect("a root");
        assert_eq!(rising.bounds[0], Dyadic::from(2.0));
        assert_eq!(first(&product(&[(8, 3), (8, 3)], &[]), 0.0, 1.0), Some((0.375, None)));
        assert_eq!(first(&Whole::new(vec![IBig::ZERO]), 0.0, 1.0), None);
        assert_eq!(first(&Whole::new(vec![IBig::from(3)]), 0.0, 1.0), None);
    }

    #[test]
    fn a_root_that_two_polynomials_share_is_told() {
        let of = product(&[(3, 1), (7, 5), (7, 5)], &[&[5, 0, 1]]);
        let all = [0.0, 0.5].map(|from| of.first_root(from, 1.0, &|_| true).expect("a root"));
        for (other, expected) in [
            (product(&[(7, 5), (1, -3)], &[]), [false, true]),
            (product(&[(3, 1), (3, 1), (3, 1), (7, 5), (9, 1)], &[&[1, 1, 1]]), [true, true]),
            (product(&[(7, 4), (1, 0)], &[&[5, 0, 1]]), [false; 2]),
            (product(&[], &[&[2]]), [false; 2]),
            (product(&[], &[&[0]]), [true; 2]),
        ] {
            assert_eq!(all.each_ref().map(|root| of.shares(root, &other)), expected, "{other:?}");
        }
    }

    #[test]
    fn clusters_are_told_apart_and_near_misses_are_none() {
        let one = 1_i64 << 61;
        let of = product(&[(one, one / 3), (one, one / 3 + 1), (one, one / 3 + 2)], &[]);
        let root = of.first_root(0.0, 1.0, &|root| root.rises == Some(false)).expect("a root");
        let third = Dyadic::new(IBig::from(one / 3 + 1), -61);
        assert!(root.wide().low <= third.wide().low && third.wide().high <= root.wide().high);
        assert!((root.wide().high - root.wide().low).to_f64() < 1e-36);
        // (3 x - 1)^2 + 1e-18
        let mut near = product(&[(3_000_000_000, 1_000_000_000), (3_000_000_000, 1_000_000_000)], &[]);
        near.coefficients[0] += IBig::ONE;
        assert_eq!(first(&near, 0.0, 1.0), None);
        near.coefficients[0] -= IBig::from(2);
        assert_eq!(first(&near, 0.0, 1.0).map(|root| root.1), Some(Some(false)));
    }

    #[test]
    fn numbers_are_enclosed_by_those_of_237_bits() {
        for (digits, exponent) in
            [(IBig::from(-7), 3), (IBig::ONE << 300, -300), ((IBig::ONE << 300) + 1, -299)]
        {
            let of = Dyadic::new(digits, exponent);
            let Wide { low, high } = of.wide();
            assert!(low <= high && (high - low).to_f64() < 1e-60, "{of:?}");
            let [first, last] = of.wide().ends();
            assert_eq!(Dyadic::from(first) == of, first == last, "{of:?}");
        }
        assert_eq!(Dyadic::from(-0.1).wide().low.to_f64(), -0.1);
    }
}
