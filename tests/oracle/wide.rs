//! Intervals with two ends of 320 bits, rounded outward in each operation. They decide what `f64` does not.

use super::dyadic::Dyadic;
use super::number::{Constant, Number};
use dashu_int::IBig;
use dashu_int::ops::DivEuclid;
use std::cmp::Ordering;
use std::sync::OnceLock;

/// The number of significant bits of each end.
const BITS: i64 = 320;

/// The number of bits after the binary point in the sums of series.
const FIXED: i64 = 440;

/// The exponent of a bound on the error of a series' sum: 2^-400 is far more than the few hundred rounding errors of
/// 2^-440, each made up to 2^16 times as large by doubling.
const SLACK: i64 = -400;

/// An interval; without ends, it holds all numbers.
#[derive(Clone, Debug)]
pub struct Wide(Option<(Dyadic, Dyadic)>);

impl Wide {
    pub fn between(low: Dyadic, high: Dyadic) -> Self {
        Self(Some((low.rounded(BITS, false), high.rounded(BITS, true))))
    }

    pub fn point(value: &Dyadic) -> Self {
        Self::between(value.clone(), value.clone())
    }

    pub fn f64(value: f64) -> Self {
        Self::point(&Dyadic::from(value))
    }

    pub fn quotient(top: &Dyadic, bottom: &Dyadic) -> Self {
        Self(Some((top.divided(bottom, BITS, false), top.divided(bottom, BITS, true))))
    }

    pub fn root_of(square: &Dyadic) -> Self {
        Self(Some((square.root(BITS, false), square.root(BITS, true))))
    }

    pub fn ends(&self) -> Option<(&Dyadic, &Dyadic)> {
        self.0.as_ref().map(|(low, high)| (low, high))
    }

    /// Returns an `f64` near the low end.
    pub fn near(&self) -> f64 {
        self.ends().map_or(f64::NAN, |(low, _)| low.to_f64(false))
    }

    pub fn low_end(&self) -> Dyadic {
        self.ends().expect("a number with ends").0.clone()
    }

    fn around(value: Dyadic, radius: &Dyadic) -> Self {
        Self::between(value.sub(radius), value.add(radius))
    }

    /// Intersects the interval with [-1, 1], the range of sines.
    fn clipped(self) -> Self {
        let one = Dyadic::int(1);
        self.meet(&Self::between(one.neg(), one)).expect("a sine")
    }
}

fn tiny() -> Dyadic {
    Dyadic::int(1).shifted(SLACK)
}

/// Returns the number that stands for infinity as an end.
fn huge() -> Dyadic {
    Dyadic::int(1).shifted(100_000)
}

/// Divides an integer by 2^`bits`, and rounds down.
fn halved(value: &IBig, bits: i64) -> IBig {
    value >> bits as usize
}

/// Returns the inverse tangent, or the inverse hyperbolic tangent, of 1 / `of` in units of 2^-[`FIXED`].
fn series(of: i64, hyperbolic: bool) -> IBig {
    let mut power = (IBig::from(1) << FIXED as usize).div_euclid(IBig::from(of));
    let (mut sum, mut count) = (IBig::ZERO, 1_i64);
    while !power.is_zero() {
        let part = (&power).div_euclid(IBig::from(count));
        if hyperbolic || count % 4 == 1 {
            sum += part
        } else {
            sum -= part
        }
        power = power.div_euclid(IBig::from(of * of));
        count += 2;
    }
    sum
}

fn pi() -> &'static IBig {
    static PI: OnceLock<IBig> = OnceLock::new();
    PI.get_or_init(|| IBig::from(16) * series(5, false) - IBig::from(4) * series(239, false))
}

fn ln_two() -> &'static IBig {
    static LN: OnceLock<IBig> = OnceLock::new();
    LN.get_or_init(|| {
        IBig::from(18) * series(26, true) - IBig::from(2) * series(4801, true)
            + IBig::from(8) * series(8749, true)
    })
}

/// Returns the sine and the cosine of a number of magnitude below 2^23, each with an error of less than 2^[`SLACK`].
fn sin_cos(of: &Dyadic) -> (Dyadic, Dyadic) {
    assert!(of.size() < 24, "a sine of {}", of.to_f64(false));
    let whole = of.fixed(FIXED);
    let quarter = halved(pi(), 1);
    let turns = (&whole + halved(&quarter, 1)).div_euclid(&quarter);
    let rest = &whole - &turns * &quarter;
    const HALVINGS: i64 = 8;
    let small = halved(&rest, HALVINGS);
    let square = halved(&(&small * &small), FIXED);
    let (mut sin, mut power, mut count) = (small.clone(), small, 2_i64);
    let mut versed = IBig::ZERO;
    let mut even = halved(&square, 1);
    // sin = x - x^3/6 + ..., 1 - cos = x^2/2 - x^4/24 + ...
    let mut sign = 1;
    while !power.is_zero() || !even.is_zero() {
        if sign > 0 {
            versed += &even
        } else {
            versed -= &even
        }
        sign = -sign;
        power = halved(&(power * &square), FIXED).div_euclid(IBig::from(count * (count + 1)));
        if sign > 0 {
            sin += &power
        } else {
            sin -= &power
        }
        even = halved(&(even * &square), FIXED).div_euclid(IBig::from((count + 1) * (count + 2)));
        count += 2;
        if power == IBig::from(-1) || even == IBig::from(-1) {
            break;
        }
    }
    let one = IBig::from(1) << FIXED as usize;
    let mut cos = &one - versed;
    for _ in 0..HALVINGS {
        let twice = halved(&(&sin * &cos), FIXED - 1);
        cos = &one - halved(&(&sin * &sin), FIXED - 1);
        sin = twice;
    }
    let quadrant = turns.div_euclid(IBig::from(1));
    let (sin, cos) = match &quadrant - (&quadrant).div_euclid(IBig::from(4)) * IBig::from(4) {
        q if q == IBig::from(0) => (sin, cos),
        q if q == IBig::from(1) => (cos, -sin),
        q if q == IBig::from(2) => (-sin, -cos),
        _ => (-cos, sin),
    };
    (Dyadic::parts(sin, -FIXED), Dyadic::parts(cos, -FIXED))
}

/// Returns bounds of the exponential of a number. Below 2^20 in magnitude, their relative width is about 2^-390.
fn exp(of: &Dyadic) -> Wide {
    if of.size() > 20 && of.sign() == Ordering::Less {
        return Wide::between(Dyadic::zero(), Dyadic::int(1).shifted(-1_000_000));
    }
    if of.size() > 20 {
        return Wide::any();
    }
    let whole = of.fixed(FIXED);
    let times = (&whole).div_euclid(ln_two());
    let rest = &whole - &times * ln_two();
    const HALVINGS: i64 = 8;
    let small = halved(&rest, HALVINGS);
    let one = IBig::from(1) << FIXED as usize;
    let (mut sum, mut part, mut count) = (one.clone(), one, 1_i64);
    loop {
        part = halved(&(part * &small), FIXED).div_euclid(IBig::from(count));
        if part <= IBig::from(1) {
            break;
        }
        sum += &part;
        count += 1;
    }
    for _ in 0..HALVINGS {
        sum = halved(&(&sum * &sum), FIXED);
    }
    let times = times.to_f64().value() as i64;
    Wide::around(Dyadic::parts(sum, -FIXED), &Dyadic::int(1).shifted(-390)).shifted(times)
}

/// Returns bounds of the logarithm of a positive number.
fn ln(of: &Dyadic) -> Wide {
    // The logarithm of the number divided by its power of two, from an `f64` by Newton's method.
    let size = of.size();
    let rest = of.shifted(-size);
    let mut at = Dyadic::from(rest.to_f64(false).ln());
    let mut off = Wide::int(0);
    for _ in 0..4 {
        off = Wide::point(&rest).mul(&exp(&at.neg())).sub(&Wide::int(1));
        let step = off.low_end();
        if step.size() < -250 {
            break;
        }
        at = at.add(&step).rounded(BITS + 20, false);
    }
    // ln(1 + d) lies between d - d^2 and d for small d.
    let square = off.square();
    let off = off.hull(&off).add(&square.neg().low().hull(&Wide::int(0)));
    let twos = Wide::around(Dyadic::parts(ln_two().clone(), -FIXED), &tiny()).mul(&Wide::int(size));
    Wide::point(&at).add(&off).add(&twos)
}

/// Returns bounds of the inverse tangent of a number.
fn atan(of: &Dyadic) -> Wide {
    if of.size() > 60 {
        let quarter = Wide::half_turn().shifted(-1);
        let quarter = if of.sign() == Ordering::Less { quarter.neg() } else { quarter };
        // Of a number below 2^-60.
        let rest = atan(&Wide::int(1).div(&Wide::point(of)).low_end());
        let slack = Wide::around(Dyadic::zero(), &Dyadic::int(1).shifted(-BITS));
        return quarter.sub(&rest).add(&slack);
    }
    // From an `f64`, atan(v) = a + atan((v cos a - sin a) / (cos a + v sin a)).
    let number = Wide::point(of);
    let mut at = Dyadic::from(of.to_f64(false).atan());
    let mut rest = Wide::int(0);
    for _ in 0..3 {
        let (sin, cos) = Wide::point(&at).sin_cos();
        rest = number.mul(&cos).sub(&sin).div(&cos.add(&number.mul(&sin)));
        let step = rest.low_end();
        if step.size() < -120 {
            break;
        }
        at = at.add(&step).rounded(BITS + 20, false);
    }
    // atan(d) lies between d - |d|^3 and d + |d|^3.
    let cube = rest.square().mul(&rest.abs());
    let slack = cube.neg().low().hull(&cube.high());
    Wide::point(&at).add(&rest).add(&slack)
}

impl Wide {
    fn shifted(&self, power: i64) -> Self {
        Self(self.0.as_ref().map(|(low, high)| (low.shifted(power), high.shifted(power))))
    }
}

impl Number for Wide {
    fn exact(value: &Dyadic) -> Self {
        Self::point(value)
    }

    fn constant(of: &Constant) -> Self {
        Self::point(&of.exact)
    }

    fn of(value: &Wide) -> Self {
        value.clone()
    }

    fn any() -> Self {
        Self(None)
    }

    fn add(&self, other: &Self) -> Self {
        match (self.ends(), other.ends()) {
            (Some(a), Some(b)) => Self::between(a.0.add(b.0), a.1.add(b.1)),
            _ => Self::any(),
        }
    }

    fn mul(&self, other: &Self) -> Self {
        let (Some(a), Some(b)) = (self.ends(), other.ends()) else { return Self::any() };
        let products = match (self.sign(), other.sign()) {
            (Some(Ordering::Greater), Some(Ordering::Greater)) => {
                return Self::between(a.0.mul(b.0), a.1.mul(b.1));
            }
            (Some(Ordering::Greater), Some(Ordering::Less)) => {
                return Self::between(a.1.mul(b.0), a.0.mul(b.1));
            }
            (Some(Ordering::Less), Some(Ordering::Greater)) => {
                return Self::between(a.0.mul(b.1), a.1.mul(b.0));
            }
            (Some(Ordering::Less), Some(Ordering::Less)) => return Self::between(a.1.mul(b.1), a.0.mul(b.0)),
            (Some(Ordering::Equal), _) | (_, Some(Ordering::Equal)) => return Self::int(0),
            _ => [a.0.mul(b.0), a.0.mul(b.1), a.1.mul(b.0), a.1.mul(b.1)],
        };
        let mut least = &products[0];
        let mut most = &products[0];
        for product in &products[1..] {
            if product.compare(least).is_lt() {
                least = product;
            }
            if product.compare(most).is_gt() {
                most = product;
            }
        }
        Self::between(least.clone(), most.clone())
    }

    fn div(&self, other: &Self) -> Self {
        let (Some(a), Some(b)) = (self.ends(), other.ends()) else { return Self::any() };
        if b.0.is_zero() && b.1.sign() == Ordering::Greater && a.0.sign() == Ordering::Greater {
            return Self(Some((a.0.divided(b.1, BITS, false), huge())));
        }
        if !matches!(other.sign(), Some(Ordering::Less | Ordering::Greater)) {
            return Self::any();
        }
        let one = Dyadic::int(1);
        self.mul(&Self(Some((one.divided(b.1, BITS, false), one.divided(b.0, BITS, true)))))
    }

    fn neg(&self) -> Self {
        Self(self.0.as_ref().map(|(low, high)| (high.neg(), low.neg())))
    }

    fn square(&self) -> Self {
        let positive = self.abs();
        match positive.ends() {
            Some((low, high)) => Self::between(low.square(), high.square()),
            None => Self::any(),
        }
    }

    fn root(&self) -> Self {
        let Some((low, high)) = self.ends() else { return Self::any() };
        let zero = Dyadic::zero();
        let above = |end: &Dyadic| if end.sign() == Ordering::Less { zero.clone() } else { end.clone() };
        Self(Some((above(low).root(BITS, false), above(high).root(BITS, true))))
    }

    fn sin_cos(&self) -> (Self, Self) {
        let Some((low, high)) = self.ends() else { return (Self::any(), Self::any()) };
        let middle = low.add(high).shifted(-1);
        let radius = high.sub(low).shifted(-1).add(&tiny());
        if middle.size() >= 24 || radius.size() > 3 {
            let one = Dyadic::int(1);
            let all = Self::between(one.neg(), one);
            return (all.clone(), all);
        }
        let (sin, cos) = sin_cos(&middle);
        (Self::around(sin, &radius).clipped(), Self::around(cos, &radius).clipped())
    }

    fn exp(&self) -> Self {
        match self.ends() {
            Some((low, high)) => exp(low).hull(&exp(high)),
            None => Self::any(),
        }
    }

    fn ln(&self) -> Self {
        match self.ends() {
            Some((low, high)) if low.sign() == Ordering::Greater => ln(low).hull(&ln(high)),
            Some((_, high)) if high.sign() == Ordering::Greater => Self::point(&huge().neg()).hull(&ln(high)),
            _ => Self::any(),
        }
    }

    fn abs(&self) -> Self {
        let Some((low, high)) = self.ends() else { return Self::any() };
        if low.sign() != Ordering::Less {
            self.clone()
        } else if high.sign() != Ordering::Greater {
            self.neg()
        } else {
            let other = low.neg();
            let most = if other.compare(high).is_gt() { other } else { high.clone() };
            Self(Some((Dyadic::zero(), most)))
        }
    }

    fn min(&self, other: &Self) -> Self {
        self.neg().max(&other.neg()).neg()
    }

    fn max(&self, other: &Self) -> Self {
        let (Some(a), Some(b)) = (self.ends(), other.ends()) else { return Self::any() };
        let larger =
            |one: &Dyadic, two: &Dyadic| if one.compare(two).is_lt() { two.clone() } else { one.clone() };
        Self(Some((larger(a.0, b.0), larger(a.1, b.1))))
    }

    fn hull(&self, other: &Self) -> Self {
        match (self.ends(), other.ends()) {
            (Some((low, _)), Some((_, high))) => Self(Some((low.clone(), high.clone()))),
            _ => Self::any(),
        }
    }

    fn meet(&self, other: &Self) -> Option<Self> {
        let (a, b) = match (self.ends(), other.ends()) {
            (Some(a), Some(b)) => (a, b),
            (None, _) => return Some(other.clone()),
            (_, None) => return Some(self.clone()),
        };
        let low = if a.0.compare(b.0).is_lt() { b.0 } else { a.0 };
        let high = if a.1.compare(b.1).is_lt() { a.1 } else { b.1 };
        low.compare(high).is_le().then(|| Self(Some((low.clone(), high.clone()))))
    }

    fn sign(&self) -> Option<Ordering> {
        let (low, high) = self.ends()?;
        match (low.sign(), high.sign()) {
            (Ordering::Greater, _) => Some(Ordering::Greater),
            (_, Ordering::Less) => Some(Ordering::Less),
            (Ordering::Equal, Ordering::Equal) => Some(Ordering::Equal),
            _ => None,
        }
    }

    fn inner(&self) -> Self {
        let (low, high) = self.ends().expect("a box with ends");
        let part = high.sub(low).mul(&Dyadic::int(495)).shifted(-10);
        let point = low.add(&part).rounded(BITS, false);
        Self(Some((point.clone(), point)))
    }

    fn low(&self) -> Self {
        Self(self.0.as_ref().map(|(low, _)| (low.clone(), low.clone())))
    }

    fn high(&self) -> Self {
        Self(self.0.as_ref().map(|(_, high)| (high.clone(), high.clone())))
    }

    fn atan(&self) -> Self {
        match self.ends() {
            Some((low, high)) => atan(low).hull(&atan(high)),
            None => {
                let quarter = Self::half_turn().shifted(-1);
                quarter.neg().hull(&quarter)
            }
        }
    }

    fn floor(&self) -> Self {
        let floor = |of: &Dyadic| if of.size() > BITS { of.clone() } else { Dyadic::parts(of.fixed(0), 0) };
        Self(self.ends().map(|(low, high)| (floor(low), floor(high))))
    }

    fn half_turn() -> Self {
        Self::around(Dyadic::parts(pi().clone(), -FIXED), &tiny())
    }

    fn huge() -> Self {
        Self(Some((huge(), huge())))
    }

    fn is_point(&self) -> bool {
        self.ends().is_some_and(|(low, high)| low.compare(high).is_eq())
    }

    fn is_from_0(&self) -> bool {
        self.ends().is_some_and(|(low, _)| low.sign().is_ge())
    }

    fn is_narrow(&self, size: &Self, bits: i64) -> bool {
        let (low, high) = self.ends().expect("a box with ends");
        let size = size.ends().map_or(0, |(_, high)| high.size());
        high.sub(low).size() <= low.size().max(size) - bits
    }

    fn is_half(&self, other: &Self) -> bool {
        match (self.ends(), other.ends()) {
            (Some(a), Some(b)) => a.1.sub(a.0).shifted(1).compare(&b.1.sub(b.0)).is_lt(),
            _ => false,
        }
    }

    fn to_wide(&self) -> Wide {
        self.clone()
    }

    fn int(number: i64) -> Self {
        Self::exact(&Dyadic::int(number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_hold_their_values_and_little_else() {
        for x in [0.7, -2.9, 13.25, 1e-20, 4e6 + 0.3] {
            let number = Wide::f64(x);
            let (sin, cos) = number.sin_cos();
            let one = sin.square().add(&cos.square()).sub(&Wide::int(1));
            assert!(one.sign().is_none() && one.ends().expect("ends").1.size() < -280, "{x}: {one:?}");
            assert!((sin.near() - x.sin()).abs() < 1e-15 && (cos.near() - x.cos()).abs() < 1e-15, "{x}");
            if x > 0.0 {
                let back = number.ln().exp().sub(&number);
                assert!(back.sign().is_none() && back.ends().expect("ends").1.size() < -270, "{x}: {back:?}");
                assert!((number.ln().near() - x.ln()).abs() < 1e-13, "{x}");
            }
            let root = Number::abs(&number).root();
            assert!(root.square().sub(&Number::abs(&number)).sign().is_none(), "{x}");
        }
    }
}
