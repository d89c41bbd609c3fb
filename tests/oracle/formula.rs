//! Formulas in y, or in x, y and z, parsed and evaluated without any code of the program.

use super::dyadic::Dyadic;
use super::fast::Fast;
use super::number::{Constant, Jet, Number};
use super::spline::Spline;
use std::cmp::Ordering;

/// A formula. Its constants are the nearest `f64`; everything else is exact.
#[derive(Clone, Debug)]
pub enum Formula {
    /// A variable: x, y or z.
    Variable(usize),
    Spline(Spline),
    Number(Constant),
    Neg(Box<Formula>),
    Two(char, Box<[Formula; 2]>),
    Whole(Box<Formula>, i32),
    Call(String, Vec<Formula>),
    /// The second formula where the first one is not negative, and the third one elsewhere.
    If(Box<[Formula; 3]>),
}

/// What is known of a formula on a piece of a line.
#[derive(Clone)]
pub struct Piece<T> {
    /// Bounds of its values where it is defined, and of its slopes.
    pub jet: Jet<T>,
    /// Whether it is defined and continuous on the whole piece.
    pub is_whole: bool,
}

/// The sides of jumps and poles on which a formula is evaluated.
#[derive(Default)]
pub struct Sides {
    /// The number of jumps and poles that have been met.
    pub count: u32,
    /// For each of them, a bit: set for the upper side. `None` for both sides at once.
    pub chosen: Option<u32>,
}

impl Sides {
    /// Returns whether the formula is evaluated on the upper side of the next jump, or both sides at once.
    fn next(&mut self) -> Option<bool> {
        self.count += 1;
        self.chosen.map(|chosen| chosen >> (self.count - 1).min(31) & 1 == 1)
    }
}

impl<T: Number> Piece<T> {
    pub fn whole(jet: Jet<T>) -> Self {
        Self { jet, is_whole: true }
    }

    /// Returns values that lie apart, or whose slopes have no bounds.
    fn torn(value: T) -> Self {
        Self { jet: Jet { value, slope: T::any() }, is_whole: false }
    }

    fn map(self, of: impl Fn(&Jet<T>) -> Jet<T>) -> Self {
        Self { jet: of(&self.jet), ..self }
    }

    fn with(&self, other: &Self, of: impl Fn(&Jet<T>, &Jet<T>) -> Jet<T>) -> Self {
        Self { jet: of(&self.jet, &other.jet), is_whole: self.is_whole && other.is_whole }
    }

    fn int(of: i64) -> Self {
        Self::whole(Jet::constant(T::int(of)))
    }

    fn plus(&self, of: i64) -> Self {
        self.with(&Self::int(of), Jet::add)
    }

    fn neg(self) -> Self {
        self.map(Jet::neg)
    }

    /// Returns the values of an increasing function, given at the ends, with its derivative.
    fn rising(&self, of: impl Fn(&T) -> T, slope: impl Fn(&Self) -> Option<Self>) -> Self {
        let value = of(&self.jet.value.low()).hull(&of(&self.jet.value.high()));
        let slope = slope(self).map_or(T::any(), |slope| slope.jet.value.mul(&self.jet.slope));
        Self { jet: Jet { value, slope }, is_whole: self.is_whole }
    }

    /// Returns the part of the values from `low` to `high`, and whether this is all.
    fn within(self, low: &T, high: &T) -> Option<Self> {
        let value = self.jet.value.meet(&low.hull(high))?;
        let is_all = self.jet.value.sub(low).is_from_0() && high.sub(&self.jet.value).is_from_0();
        Some(Self { jet: Jet { value, ..self.jet }, is_whole: self.is_whole && is_all })
    }

    fn over(&self, by: &Self, sides: &mut Sides) -> Option<Self> {
        let (top, bottom) = (&self.jet.value, &by.jet.value);
        match bottom.sign() {
            Some(Ordering::Equal) => return None,
            Some(_) => return Some(self.with(by, Jet::div)),
            None => {}
        }
        let is_above = match (bottom.is_from_0(), bottom.neg().is_from_0()) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => sides.next(),
        };
        let part = T::int(0).hull(&T::huge());
        // Beside a pole, a quotient is far from 0.
        let beside = |top: &T, bottom: T| match (bottom.meet(&part), top.sign()) {
            (Some(bottom), Some(Ordering::Greater)) => top.div(&bottom),
            (Some(bottom), Some(Ordering::Less)) => top.neg().div(&bottom).neg(),
            (_, Some(Ordering::Equal)) => T::int(0),
            _ => T::any(),
        };
        Some(Self::torn(match is_above {
            Some(true) => beside(top, bottom.clone()),
            Some(false) => beside(&top.neg(), bottom.neg()),
            None if top.sign() == Some(Ordering::Equal) => T::int(0),
            None => T::any(),
        }))
    }

    fn root(&self) -> Option<Self> {
        match self.jet.value.sign() {
            Some(Ordering::Less) => None,
            _ if self.jet.value.is_from_0() => Some(self.clone().map(Jet::root)),
            _ if self.jet.value.neg().is_from_0() => Some(Self::torn(T::int(0))),
            _ => Some(Self::torn(self.jet.value.root())),
        }
    }

    fn ln(&self) -> Option<Self> {
        match self.jet.value.sign() {
            Some(Ordering::Greater) => Some(self.clone().map(Jet::ln)),
            _ if self.jet.value.neg().is_from_0() => None,
            _ => Some(Self::torn(self.jet.value.ln())),
        }
    }

    /// Raises to a power that is no integer.
    fn power(&self, exponent: &Self) -> Option<Self> {
        let (base, up) = (&self.jet.value, exponent.jet.value.sign());
        if base.sign() == Some(Ordering::Greater) {
            return Some(self.with(exponent, |base, exponent| base.ln().mul(exponent).exp()));
        }
        if base.neg().is_from_0() {
            let is_zero = !base.high().is_negative() && up == Some(Ordering::Greater);
            return is_zero.then(|| Self::torn(T::int(0)));
        }
        let most = base.high().ln().mul(&exponent.jet.value).exp();
        Some(match up {
            Some(Ordering::Greater) => {
                let is_whole = self.is_whole && exponent.is_whole && base.is_from_0();
                Self { is_whole, ..Self::torn(T::int(0).hull(&most)) }
            }
            Some(Ordering::Less) => Self::torn(most.hull(&T::huge())),
            // 0^0 is 1.
            _ if exponent.jet.value.is_from_0() => Self::torn(T::int(0).hull(&most.max(&T::int(1)))),
            _ => Self::torn(T::any()),
        })
    }

    fn whole_power(&self, exponent: i32, sides: &mut Sides) -> Option<Self> {
        let times = exponent.unsigned_abs();
        let mut power: Option<Jet<T>> = None;
        for bit in (0..32 - times.leading_zeros()).rev() {
            power = power.map(|power| power.square());
            if times >> bit & 1 == 1 {
                power = Some(power.map_or(self.jet.clone(), |power| power.mul(&self.jet)));
            }
        }
        let power = power.unwrap_or(Jet::constant(T::int(1)));
        let power = Self { jet: power, is_whole: self.is_whole };
        if exponent < 0 { Self::int(1).over(&power, sides) } else { Some(power) }
    }

    /// Returns the largest integer that is not above the value.
    fn floor(self, sides: &mut Sides) -> Self {
        let value = self.jet.value.floor();
        let (low, high) = (value.low(), value.high());
        if value.is_point() {
            return Self { jet: Jet::constant(value), is_whole: self.is_whole };
        }
        if !high.sub(&low).sub(&T::int(2)).is_negative() {
            return Self::torn(value);
        }
        match sides.next() {
            None => Self::torn(value),
            Some(is_above) => {
                let side = if is_above { high } else { low };
                Self { jet: Jet::constant(side), is_whole: false }
            }
        }
    }

    /// Returns 1 where the value is not negative, and 0 elsewhere.
    fn heaviside(self, sides: &mut Sides) -> Self {
        let side = |of: i64, is_whole| Self { is_whole, ..Self::int(of) };
        if self.jet.value.is_from_0() {
            return side(1, self.is_whole);
        }
        if self.jet.value.is_negative() {
            return side(0, self.is_whole);
        }
        match sides.next() {
            None => Self::torn(T::int(0).hull(&T::int(1))),
            Some(is_above) => side(i64::from(is_above), false),
        }
    }

    fn cube_root(&self) -> Self {
        let third = |of: &T| of.ln().div(&T::int(3)).exp();
        let root = |of: &T| match of.sign() {
            Some(Ordering::Greater) => third(of),
            Some(Ordering::Less) => third(&of.neg()).neg(),
            Some(Ordering::Equal) => T::int(0),
            None => T::any(),
        };
        self.rising(root, |of| {
            let root = root(&of.jet.value.low()).hull(&root(&of.jet.value.high()));
            let bottom = Self::whole(Jet::constant(root.square().mul(&T::int(3))));
            Self::int(1).over(&bottom, &mut Sides::default())
        })
    }

    fn atan(&self) -> Self {
        self.rising(T::atan, |of| {
            Self::int(1).over(&of.clone().map(Jet::square).plus(1), &mut Sides::default())
        })
    }

    fn asin(self) -> Option<Self> {
        let one = T::int(1);
        let of = self.within(&one.neg(), &one)?;
        let other = |of: &T| one.sub(&of.square()).root();
        let asin = |of: &T| of.div(&one.add(&other(of))).atan().mul(&T::int(2));
        Some(of.rising(asin, |of| {
            let bottom = Self::whole(Jet::constant(one.sub(&of.jet.value.square()).root()));
            Self::int(1).over(&bottom, &mut Sides::default())
        }))
    }

    /// Returns the angle of the point `self` up and `x` to the right.
    fn atan2(&self, x: &Self, sides: &mut Sides) -> Option<Self> {
        let (across, up) = (x.jet.value.sign(), self.jet.value.sign());
        if across == Some(Ordering::Greater) {
            return self.over(x, sides).map(|tan| tan.atan());
        }
        let half = Self::whole(Jet::constant(T::half_turn()));
        let quarter = || half.clone().map(|half| half.div(&Jet::constant(T::int(2))));
        match up {
            Some(Ordering::Greater) => {
                return x.over(self, sides).map(|tan| quarter().with(&tan.atan(), Jet::sub));
            }
            Some(Ordering::Less) => {
                return x.over(self, sides).map(|tan| quarter().neg().with(&tan.atan(), Jet::sub));
            }
            _ => {}
        }
        if across != Some(Ordering::Less) {
            let half = T::half_turn();
            return Some(Self::torn(half.neg().hull(&half)));
        }
        // At the cut, the angle is half a turn.
        let is_from_0 = self.jet.value.is_from_0();
        let angle = self.over(x, sides)?.atan();
        let is_above = if is_from_0 { Some(true) } else { sides.next() };
        let part = |is_above: bool| {
            let zero = T::int(0);
            // Above the cut, the quotient is not above 0.
            let side = if is_above { T::huge().neg().hull(&zero) } else { zero.hull(&T::huge()) };
            let value = angle.jet.value.meet(&side).unwrap_or(zero);
            let jet = Jet { value, slope: angle.jet.slope.clone() };
            let turn = if is_above { half.clone() } else { half.clone().neg() };
            turn.with(&Self { jet, is_whole: angle.is_whole && is_from_0 }, Jet::add)
        };
        Some(match is_above {
            Some(is_above) => part(is_above),
            None => Self::torn(part(false).jet.value.low().hull(&part(true).jet.value.high())),
        })
    }

    fn exp(self) -> Self {
        self.map(Jet::exp)
    }

    /// Returns half the sum, or half the difference, of the exponentials of a value and of its negative.
    fn hyperbolic(self, of: fn(&Jet<T>, &Jet<T>) -> Jet<T>) -> Self {
        let (up, down) = (self.clone().exp(), self.neg().exp());
        up.with(&down, of).map(|sum| sum.div(&Jet::constant(T::int(2))))
    }

    fn asinh(&self) -> Self {
        let one = T::int(1);
        let above = |of: &T| of.add(&of.square().add(&one).root()).ln();
        let asinh = |of: &T| if of.is_negative() { above(&of.neg()).neg() } else { above(of) };
        self.rising(asinh, |of| {
            Self::int(1).over(&of.clone().map(Jet::square).plus(1).root()?, &mut Sides::default())
        })
    }

    /// Returns the amount by which a smooth minimum is below the minimum.
    fn blend(&self, other: &Self, width: &Self, sides: &mut Sides) -> Option<Self> {
        let apart = self.with(other, Jet::sub).map(Jet::abs);
        let depth = width.with(&apart, Jet::sub).with(&Self::int(0), Jet::max).map(Jet::square);
        depth.over(&width.with(&Self::int(4), Jet::mul), sides)
    }
}

impl Formula {
    /// Parses a formula that has no mistakes.
    pub fn read(text: &str) -> Self {
        let mut reader = Reader { rest: text };
        let formula = reader.sum();
        assert!(reader.peek().is_none(), "{text}: {}", reader.rest);
        formula
    }

    pub fn at<T: Number>(&self, y: &Jet<T>) -> Jet<T> {
        self.of([y, y, y])
    }

    /// Evaluates a formula of x, y and z. Where it is nowhere defined, its value may be anything.
    pub fn of<T: Number>(&self, at: [&Jet<T>; 3]) -> Jet<T> {
        let piece = self.on(at, &mut Sides::default());
        piece.map_or(Jet { value: T::any(), slope: T::any() }, |piece| piece.jet)
    }

    /// Evaluates a formula of x, y and z on a piece of a line; `None` where it is nowhere defined.
    pub fn on<T: Number>(&self, at: [&Jet<T>; 3], sides: &mut Sides) -> Option<Piece<T>> {
        Some(match self {
            Self::Variable(index) => Piece::whole(at[*index].clone()),
            Self::Spline(spline) => Piece::whole(spline.at(at[1])),
            Self::Number(number) => Piece::whole(Jet::constant(T::constant(number))),
            Self::Neg(of) => of.on(at, sides)?.neg(),
            Self::Whole(of, exponent) => of.on(at, sides)?.whole_power(*exponent, sides)?,
            Self::Two(operation, of) => {
                let (a, b) = (of[0].on(at, sides)?, of[1].on(at, sides)?);
                match operation {
                    '+' => a.with(&b, Jet::add),
                    '-' => a.with(&b, Jet::sub),
                    '*' => a.with(&b, Jet::mul),
                    '/' => a.over(&b, sides)?,
                    _ => a.power(&b)?,
                }
            }
            Self::If(of) => {
                let [condition, one, other] = &**of;
                let condition = condition.on(at, sides)?;
                let (value, is_sure) = (&condition.jet.value, condition.is_whole);
                let is_above = match (value.is_from_0(), value.is_negative()) {
                    (true, _) => Some(true),
                    (_, true) => Some(false),
                    _ => sides.next(),
                };
                let is_sure = is_sure && (value.is_from_0() || value.is_negative());
                match is_above {
                    Some(is_above) => {
                        let piece = if is_above { one } else { other }.on(at, sides)?;
                        Piece { is_whole: piece.is_whole && is_sure, ..piece }
                    }
                    None => match (one.on(at, sides), other.on(at, sides)) {
                        (Some(one), Some(other)) => Piece::torn(one.jet.hull(&other.jet).value),
                        (one, other) => Piece::torn(one.or(other)?.jet.value),
                    },
                }
            }
            Self::Call(name, of) => Self::call(name, of, at, sides)?,
        })
    }

    /// Evaluates a function, as the page on the language says what it is.
    fn call<T: Number>(name: &str, of: &[Self], at: [&Jet<T>; 3], sides: &mut Sides) -> Option<Piece<T>> {
        let one = || Piece::int(1);
        let mut all = of.iter().map(|of| of.on(at, sides)).collect::<Option<Vec<_>>>()?.into_iter();
        let mut next = || all.next().expect("an argument");
        let a = next();
        Some(match name {
            "sin" => a.map(Jet::sin),
            "cos" => a.map(Jet::cos),
            "tan" => a.clone().map(Jet::sin).over(&a.map(Jet::cos), sides)?,
            "asin" => a.asin()?,
            "acos" => {
                let quarter = T::half_turn().div(&T::int(2));
                Piece::whole(Jet::constant(quarter)).with(&a.asin()?, Jet::sub)
            }
            "atan" => a.atan(),
            "exp" => a.exp(),
            "ln" | "log" => a.ln()?,
            "log2" | "log10" => {
                let base = T::int(if name == "log2" { 2 } else { 10 }).ln();
                a.ln()?.over(&Piece::whole(Jet::constant(base)), sides)?
            }
            "sqrt" => a.root()?,
            "cbrt" => a.cube_root(),
            "abs" => a.map(Jet::abs),
            "floor" => a.floor(sides),
            "ceil" => a.neg().floor(sides).neg(),
            "round" => {
                let half = Jet::constant(T::int(1).div(&T::int(2)));
                a.with(&Piece::whole(half), Jet::add).floor(sides)
            }
            "trunc" => match (a.jet.value.is_from_0(), a.jet.value.is_negative()) {
                (true, _) => a.floor(sides),
                (_, true) => a.neg().floor(sides).neg(),
                _ => {
                    let (low, high) = (a.jet.value.neg().high().floor().neg(), a.jet.value.high().floor());
                    let (low, high) = (low.min(&T::int(0)), high.max(&T::int(0)));
                    let value = low.hull(&high);
                    let is_one = value.is_point();
                    Piece {
                        jet: Jet { value, slope: if is_one { T::int(0) } else { T::any() } },
                        is_whole: a.is_whole && is_one,
                    }
                }
            },
            "fract" => a.clone().with(&a.floor(sides), Jet::sub),
            "mod" => {
                let by = next();
                let times = a.over(&by, sides)?.floor(sides);
                a.with(&by.with(&times, Jet::mul), Jet::sub)
            }
            "sinh" => a.hyperbolic(Jet::sub),
            "cosh" => a.hyperbolic(Jet::add),
            "tanh" => {
                let grown = a.clone().with(&a, Jet::add).exp().plus(1);
                one().with(&Piece::int(2).over(&grown, sides)?, Jet::sub)
            }
            "asinh" => a.asinh(),
            "acosh" => {
                let a = a.within(&T::int(1), &T::huge())?;
                let other = a.clone().map(Jet::square).plus(-1).root()?;
                a.with(&other, Jet::add).ln()?
            }
            "atanh" => {
                let (up, down) = (a.plus(1), a.neg().plus(1));
                if up.jet.value.neg().is_from_0() || down.jet.value.neg().is_from_0() {
                    return None;
                }
                let half = |of: Piece<T>| of.map(|of| of.div(&Jet::constant(T::int(2))));
                half(up.ln()?.with(&down.ln()?, Jet::sub))
            }
            "atan2" => a.atan2(&next(), sides)?,
            "hypot" => a.map(Jet::square).with(&next().map(Jet::square), Jet::add).root()?,
            "min" => all.fold(a, |a, b| a.with(&b, Jet::min)),
            "max" => all.fold(a, |a, b| a.with(&b, Jet::max)),
            "heaviside" => a.heaviside(sides),
            "sign" => a.heaviside(sides).with(&Piece::int(2), Jet::mul).plus(-1),
            "step" => next().with(&a, Jet::sub).heaviside(sides),
            "clamp" => {
                let low = next();
                a.with(&low, Jet::max).with(&next(), Jet::min)
            }
            "mix" => {
                let b = next();
                a.with(&b.with(&a, Jet::sub).with(&next(), Jet::mul), Jet::add)
            }
            "smoothstep" => {
                let (high, x) = (next(), next());
                let part = x.with(&a, Jet::sub).over(&high.with(&a, Jet::sub), sides)?;
                let part = part.with(&Piece::int(0), Jet::max).with(&one(), Jet::min);
                let rest = part.with(&Piece::int(-2), Jet::mul).plus(3);
                part.map(Jet::square).with(&rest, Jet::mul)
            }
            "smin" | "smax" => {
                let mut all: Vec<_> = all.collect();
                let width = all.pop().expect("a width");
                let is_max = name == "smax";
                let turned = |of: Piece<T>| if is_max { of.neg() } else { of };
                let mut least = turned(a);
                for other in all {
                    let other = turned(other);
                    let blend = least.blend(&other, &width, sides)?;
                    least = least.with(&other, Jet::min).with(&blend, Jet::sub);
                }
                turned(least)
            }
            _ => panic!("no oracle for `{name}`"),
        })
    }

    /// Returns an upper bound of the formula's values from 0 to a height: the greatest of the bounds over pieces of it.
    pub fn most_up_to(&self, height: f64) -> f64 {
        const PIECES: usize = 64;
        let bounds = (0..PIECES).map(|piece| {
            let at = |end: usize| height * end as f64 / PIECES as f64;
            let y = Fast { low: at(piece), high: at(piece + 1).min(height) };
            self.at(&Jet::constant(y)).value.high
        });
        bounds.fold(0.0, f64::max).min(1e150)
    }

    /// Returns the sum of a formula and a number.
    pub fn plus(self, number: Dyadic) -> Self {
        Self::Two('+', Box::new([self, Self::Number(number.into())]))
    }

    /// Returns the square of the formula's value. If the formula is a square root, this is its argument.
    pub fn squared_at<T: Number>(&self, y: &Jet<T>) -> Jet<T> {
        match self {
            Self::Call(name, of) if name == "sqrt" => of[0].at(y),
            _ => self.at(y).square(),
        }
    }

    /// Returns a number that has the sign of the formula's value or, if the formula is a square root, of its argument.
    pub fn sign_at<T: Number>(&self, y: &T) -> T {
        match self {
            Self::Call(name, of) if name == "sqrt" => of[0].at(&Jet::constant(y.clone())).value,
            _ => self.at(&Jet::constant(y.clone())).value,
        }
    }
}

struct Reader<'t> {
    rest: &'t str,
}

impl Reader<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn take(&mut self, one: char) -> bool {
        let is_there = self.peek() == Some(one);
        if is_there {
            self.rest = &self.rest[one.len_utf8()..];
        }
        is_there
    }

    fn sum(&mut self) -> Formula {
        let mut left = self.product();
        loop {
            let operation = match self.peek() {
                Some(sign @ ('+' | '-')) => sign,
                _ => return left,
            };
            self.take(operation);
            left = Formula::Two(operation, Box::new([left, self.product()]));
        }
    }

    fn product(&mut self) -> Formula {
        let mut left = self.signed();
        loop {
            let operation = match self.peek() {
                Some(sign @ ('*' | '/')) => sign,
                _ => return left,
            };
            self.take(operation);
            left = Formula::Two(operation, Box::new([left, self.signed()]));
        }
    }

    fn signed(&mut self) -> Formula {
        if self.take('-') { Formula::Neg(Box::new(self.signed())) } else { self.power() }
    }

    fn power(&mut self) -> Formula {
        let base = self.atom();
        if !self.take('^') {
            return base;
        }
        let exponent = match self.signed() {
            Formula::Neg(of) => match *of {
                Formula::Number(number) => Formula::Number(number.exact.neg().into()),
                of => Formula::Neg(Box::new(of)),
            },
            exponent => exponent,
        };
        if let Formula::Number(number) = &exponent {
            let whole = number.low;
            if whole.fract() == 0.0 && whole.abs() <= 1000.0 {
                return Formula::Whole(Box::new(base), whole as i32);
            }
        }
        Formula::Two('^', Box::new([base, exponent]))
    }

    fn atom(&mut self) -> Formula {
        if self.take('(') {
            let inner = self.sum();
            assert!(self.take(')'), "a `)` at {}", self.rest);
            return inner;
        }
        let bytes = self.rest.as_bytes();
        if bytes[0].is_ascii_alphabetic() {
            let end = bytes.iter().position(|byte| !byte.is_ascii_alphanumeric()).unwrap_or(bytes.len());
            let (name, rest) = self.rest.split_at(end);
            self.rest = rest;
            if let Some(index) = ["x", "y", "z"].iter().position(|variable| *variable == name) {
                return Formula::Variable(index);
            }
            assert!(self.take('('), "a `(` after {name}");
            let mut of = vec![self.sum()];
            if let Some(sign @ ('<' | '>')) = self.peek() {
                self.take(sign);
                let is_equal = self.take('=');
                let other = self.sum();
                let [one, two] = [0; 2].map(|_| {
                    assert!(self.take(','), "a `,` at {}", self.rest);
                    self.sum()
                });
                assert!(self.take(')'), "a `)` at {}", self.rest);
                // a < b where a - b >= 0 does not hold.
                let first = of.remove(0);
                let [more, less] = if (sign == '>') == is_equal { [first, other] } else { [other, first] };
                let branches = if is_equal { [one, two] } else { [two, one] };
                let [one, two] = branches;
                let above = Formula::Two('-', Box::new([more, less]));
                return Formula::If(Box::new([above, one, two]));
            }
            while self.take(',') {
                of.push(self.sum());
            }
            assert!(self.take(')'), "a `)` at {}", self.rest);
            return Formula::Call(name.to_owned(), of);
        }
        let is_part = |at: usize| {
            let byte = bytes[at];
            byte.is_ascii_alphanumeric()
                || byte == b'.'
                || (matches!(byte, b'+' | b'-') && matches!(bytes[at - 1], b'e' | b'E'))
        };
        let end = (0..bytes.len()).find(|at| !is_part(*at)).unwrap_or(bytes.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        let number = Dyadic::from(word.parse().unwrap_or_else(|_| panic!("a number, not `{word}`")));
        Formula::Number(number.into())
    }
}
