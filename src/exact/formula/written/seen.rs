//! Plain intervals of the values of a formula, which tell where it is defined and continuous.

use crate::formula::step::{Function, Step};
use crate::interval::{Float, Interval};
use crate::scalar::Scalar;

/// What is known of a formula's values at the points of a box.
#[derive(Clone, Copy, Debug)]
pub struct Seen<F> {
    /// Bounds of the values where the formula is defined.
    pub low: F,
    /// The upper bound.
    pub high: F,
    /// What may be wrong with the values, as the sum of [`MAYBE_UNDEFINED`], [`UNDEFINED`] and [`MAYBE_JUMPS`].
    pub(super) faults: u8,
}

/// The formula may not be defined at some of the points.
pub(super) const MAYBE_UNDEFINED: u8 = 1;

/// The formula is not defined at any of the points.
const UNDEFINED: u8 = 2;

/// The formula may not be continuous.
const MAYBE_JUMPS: u8 = 4;

impl<F: Float> Seen<F> {
    pub(super) fn whole() -> Self {
        Self::of(-F::INFINITY, F::INFINITY)
    }

    pub(super) fn of(low: F, high: F) -> Self {
        Self { low, high, faults: 0 }
    }

    /// Tells whether the formula is defined at all of the points, or at none; `None` if that is uncertain.
    pub fn is_defined(&self) -> Option<bool> {
        match self.faults {
            faults if faults & UNDEFINED != 0 => Some(false),
            faults => (faults & MAYBE_UNDEFINED == 0).then_some(true),
        }
    }

    /// Tells whether the formula is certainly defined at all of the points, and continuous.
    pub fn is_continuous(&self) -> bool {
        self.faults == 0
    }

    /// Returns whether the values have one sign, which is then that of a positive or a negative number.
    pub fn sign(&self) -> Option<bool> {
        let zero = F::of(0.0);
        if self.low > zero || self.high < zero { Some(self.low > zero) } else { None }
    }

    fn has(&self, number: f64) -> bool {
        self.low <= F::of(number) && self.high >= F::of(number)
    }

    fn is_bounded(&self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Widens bounds that were rounded. A sum is exact where it is 0.
    fn rounded(low: F, high: F) -> Self {
        let (low, high) = F::outward(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self::of(low, high) }
    }

    fn sum(low: F, high: F) -> Self {
        let (low, high) = F::outward_sum(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self::of(low, high) }
    }

    /// Widens bounds that were computed by functions.
    fn computed(low: F, high: F) -> Self {
        let (low, high) = F::around(low, high);
        let (low, high) = F::around(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self::of(low, high) }
    }

    fn at_least(self, least: f64) -> Self {
        Self { low: self.low.max(F::of(least)), high: self.high.max(F::of(least)), ..self }
    }

    /// Adds what may be wrong with an operand.
    #[inline(always)]
    fn with(self, operand: Self) -> Self {
        Self { faults: self.faults | operand.faults, ..self }
    }

    /// Demands a condition that holds at all of the points, or at none, or at some.
    fn only_if(self, is_met: Option<bool>) -> Self {
        let fault = match is_met {
            Some(true) => 0,
            Some(false) => UNDEFINED,
            None => MAYBE_UNDEFINED,
        };
        Self { faults: self.faults | fault, ..self }
    }

    /// Demands that values that may jump do not.
    fn continuous_if(self, is_met: bool) -> Self {
        Self { faults: self.faults | if is_met { 0 } else { MAYBE_JUMPS }, ..self }
    }

    fn is_not_0(self) -> Option<bool> {
        match self.has(0.0) {
            false => Some(true),
            true if self.low == self.high => Some(false),
            true => None,
        }
    }

    /// Tells whether the values are from 0 on; with `or_0`, 0 itself counts.
    fn is_positive(self, or_0: bool) -> Option<bool> {
        let zero = F::of(0.0);
        if self.low > zero || or_0 && self.low >= zero {
            Some(true)
        } else if self.high < zero || !or_0 && self.high <= zero {
            Some(false)
        } else {
            None
        }
    }

    fn negative(self) -> Self {
        Self { low: -self.high, high: -self.low, ..self }
    }

    fn plus(self, b: Self) -> Self {
        Self::sum(self.low + b.low, self.high + b.high).with(self).with(b)
    }

    fn times(self, b: Self) -> Self {
        let values = match F::product_ends([self.low, self.high], [b.low, b.high]) {
            Some((low, high)) => Self::rounded(low, high),
            None => self.times_0_or_infinity(b),
        };
        values.with(self).with(b)
    }

    /// Returns the product of values that may be 0 or unbounded.
    #[inline(never)]
    fn times_0_or_infinity(self, b: Self) -> Self {
        let zero = F::of(0.0);
        // An unbounded operand has finite values, and so their products with 0 are 0.
        let product = |one: F, other: F| if one == zero || other == zero { zero } else { one * other };
        let ends = [(self.low, b.low), (self.low, b.high), (self.high, b.low), (self.high, b.high)];
        let [low, high] = extremes(ends.map(|(one, other)| product(one, other)));
        let is_0 = |of: Self| of.low == zero && of.high == zero;
        if is_0(self) || is_0(b) {
            return Self::of(zero, zero);
        }
        let values = Self::rounded(low, high);
        if self.low >= zero && b.low >= zero { values.at_least(0.0) } else { values }
    }

    fn over(self, b: Self) -> Self {
        let zero = F::of(0.0);
        let values = if b.has(0.0) || !b.is_bounded() || !self.is_bounded() {
            Self::whole()
        } else if self.low == zero && self.high == zero {
            Self::of(zero, zero)
        } else {
            let ends = [(self.low, b.low), (self.low, b.high), (self.high, b.low), (self.high, b.high)];
            let [low, high] = extremes(ends.map(|(one, other)| one / other));
            Self::rounded(low, high)
        };
        values.with(self).with(b).only_if(b.is_not_0())
    }

    fn squared(self) -> Self {
        let size = self.absolute();
        if size.high == F::of(0.0) {
            return size;
        }
        Self::rounded(size.low * size.low, size.high * size.high).at_least(0.0).with(self)
    }

    fn power(self, exponent: u32) -> Self {
        match exponent {
            0 => Self::of(F::of(1.0), F::of(1.0)).with(self),
            1 => self,
            _ if exponent.is_multiple_of(2) => self.power(exponent / 2).squared(),
            _ => self.power(exponent / 2).squared().times(self),
        }
    }

    fn absolute(self) -> Self {
        let (below, above) = (-self.low, self.high);
        let high = if below > above { below } else { above };
        let low = if self.low > F::of(0.0) {
            self.low
        } else if self.high < F::of(0.0) {
            -self.high
        } else {
            F::of(0.0)
        };
        Self { low, high, ..self }
    }

    /// Returns the hull of a choice between two values.
    fn either(self, b: Self) -> Self {
        let fault = |of: Self| if of.is_defined() == Some(true) { 0 } else { MAYBE_UNDEFINED };
        let faults = match [self, b].map(|of| of.is_defined()) {
            [Some(false), Some(false)] => UNDEFINED,
            _ => fault(self) | fault(b),
        };
        Self { low: self.low.min(b.low), high: self.high.max(b.high), faults: faults | MAYBE_JUMPS }
    }

    /// Returns the sine or the cosine. Their slopes are at most 1.
    fn wave(self, of: impl Fn([F; 2]) -> [F; 2]) -> Self {
        let (one, half) = (F::of(1.0), F::of(0.5) * (self.high - self.low));
        let middle = self.low + half;
        let known = Self::computed(of([middle; 2])[0], of([middle; 2])[0]);
        // The middle is rounded.
        let reach = half + F::of(4.0) * F::EPSILON * (self.low.abs() + self.high.abs());
        let near = Self::sum(known.low - reach, known.high + reach);
        let is_near = reach < one;
        let values = if is_near { near } else { Self::of(-one, one) };
        Self { low: values.low.max(-one), high: values.high.min(one), ..values }.with(self)
    }

    pub(super) fn one(self, step: Step) -> Self {
        let (zero, one) = (F::of(0.0), F::of(1.0));
        let number = |of: f64| Self::of(F::of(of), F::of(of));
        match step {
            Step::Neg => self.negative(),
            Step::Scale(factor) => self.times(number(factor)),
            Step::Shift(by) => self.plus(number(by)),
            Step::Powi(exponent) if exponent < 0 => number(1.0).over(self.power(exponent.unsigned_abs())),
            Step::Powi(exponent) => self.power(exponent.unsigned_abs()),
            Step::Call(Function::Sin) => self.wave(|angles| F::sines(angles).0),
            Step::Call(Function::Cos) => self.wave(|angles| F::sines(angles).1),
            Step::Call(Function::Tan) => {
                self.wave(|angles| F::sines(angles).0).over(self.wave(|angles| F::sines(angles).1))
            }
            Step::Call(Function::Exp) => {
                let (low, high) = F::exps(self.low, self.high);
                Self::computed(low.min(F::MAX), high).at_least(0.0).with(self)
            }
            Step::Call(Function::Ln) => {
                let within = self.at_least(0.0);
                let (low, high) = F::lns(within.low, within.high);
                let values = Self::computed(low, high);
                let low = if within.low == zero { -F::INFINITY } else { values.low };
                Self { low, ..values }.with(self).only_if(self.is_positive(false))
            }
            Step::Call(Function::Sqrt) => {
                let within = self.at_least(0.0);
                let values = Self::rounded(within.low.sqrt(), within.high.sqrt()).at_least(0.0);
                values.with(self).only_if(self.is_positive(true))
            }
            Step::Call(Function::Abs) => self.absolute(),
            Step::Call(Function::Floor) => {
                let values = Self::of(self.low.floor(), self.high.floor());
                values.continuous_if(values.low == values.high).with(self)
            }
            Step::Call(Function::Heaviside) => {
                let low = if self.low >= zero { one } else { zero };
                let high = if self.high < zero { zero } else { one };
                Self::of(low, high).continuous_if(low == high).with(self)
            }
            // The values of a spline are not looked up.
            Step::Spline => Self::whole().with(self),
            _ => Self::whole().with(self).only_if(None),
        }
    }

    pub(super) fn two(self, step: Step, b: Self) -> Self {
        let zero = F::of(0.0);
        match step {
            Step::Add => self.plus(b),
            Step::Sub => self.plus(b.negative()),
            Step::Mul => self.times(b),
            Step::Div => self.over(b),
            Step::Call(Function::Min) => {
                Self::of(self.low.min(b.low), self.high.min(b.high)).with(self).with(b)
            }
            Step::Call(Function::Max) => {
                Self::of(self.low.max(b.low), self.high.max(b.high)).with(self).with(b)
            }
            Step::Call(Function::Pow) => {
                let power = self.one(Step::Call(Function::Ln)).times(b).one(Step::Call(Function::Exp));
                // 0 is a base for positive exponents only.
                let is_met = if b.low > zero { self.is_positive(true) } else { self.is_positive(false) };
                Self::of(power.low, power.high).with(self).with(b).only_if(is_met)
            }
            Step::Call(Function::Atan2) => {
                let half_turn = Self::computed(F::PI, F::PI).high;
                let is_aside = self.low > zero || self.high < zero || b.low > zero;
                let values = if is_aside || self.low >= zero {
                    let ends =
                        [(self.low, b.low), (self.low, b.high), (self.high, b.low), (self.high, b.high)];
                    let [low, high] = extremes(ends.map(|(y, x)| y.atan2(x)));
                    Self::computed(low, high)
                } else {
                    Self::of(-half_turn, half_turn).continuous_if(false)
                };
                let is_off_origin = is_aside || b.high < zero;
                values.with(self).with(b).only_if(is_off_origin.then_some(true))
            }
            _ => Self::whole().with(self).with(b).only_if(None),
        }
    }

    pub(super) fn three(self, step: Step, b: Self, c: Self) -> Self {
        let zero = F::of(0.0);
        match step {
            Step::Call(Function::If) => {
                let chosen = if self.low >= zero {
                    b
                } else if self.high < zero {
                    c
                } else {
                    b.either(c)
                };
                chosen.with(self)
            }
            Step::Call(Function::Smin | Function::Smax) => {
                let apart = c.plus(self.plus(b.negative()).absolute().negative()).at_least(0.0);
                let blend = apart.squared().over(c.times(Self::of(F::of(4.0), F::of(4.0))));
                match step {
                    Step::Call(Function::Smin) => {
                        self.two(Step::Call(Function::Min), b).plus(blend.negative())
                    }
                    _ => self.two(Step::Call(Function::Max), b).plus(blend),
                }
            }
            Step::Call(Function::Noise) => {
                let at = [self, b, c].map(|of| Interval { low: of.low, high: of.high });
                let Interval { low, high } = Interval::noise(at, [0; 3]);
                Self::of(low, high).with(self).with(b).with(c)
            }
            _ => Self::whole().only_if(None),
        }
    }
}

/// Returns the smallest and the largest of four numbers.
fn extremes<F: Float>([first, rest @ ..]: [F; 4]) -> [F; 2] {
    let low = rest.iter().fold(first, |low, of| if *of < low { *of } else { low });
    let high = rest.iter().fold(first, |high, of| if *of > high { *of } else { high });
    [low, high]
}
