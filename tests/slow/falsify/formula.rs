//! Formulas in y, or in x, y and z, parsed and evaluated without any code of the program.

use super::dyadic::Dyadic;
use super::fast::Fast;
use super::number::{Constant, Jet, Number};
use super::spline::Spline;

/// A formula. Its constants are the nearest `f64`; everything else is exact.
#[derive(Clone, Debug)]
pub enum Formula {
    /// A variable: x, y or z.
    Variable(usize),
    Spline(Spline),
    Number(Constant),
    Neg(Box<Formula>),
    Two(char, Box<[Formula; 2]>),
    Whole(Box<Formula>, u32),
    Call(String, Vec<Formula>),
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

    /// Evaluates a formula of x, y and z.
    pub fn of<T: Number>(&self, y: [&Jet<T>; 3]) -> Jet<T> {
        match self {
            Self::Variable(index) => y[*index].clone(),
            Self::Spline(spline) => spline.at(y[1]),
            Self::Number(number) => Jet::constant(T::constant(number)),
            Self::Neg(of) => of.of(y).neg(),
            Self::Whole(of, exponent) => {
                let of = of.of(y);
                let mut power: Option<Jet<T>> = None;
                for bit in (0..32 - exponent.leading_zeros()).rev() {
                    power = power.map(|power| power.square());
                    if exponent >> bit & 1 == 1 {
                        power = Some(power.map_or(of.clone(), |power| power.mul(&of)));
                    }
                }
                power.expect("an exponent from 1")
            }
            Self::Two(operation, of) => {
                let (a, b) = (of[0].of(y), of[1].of(y));
                match operation {
                    '+' => a.add(&b),
                    '-' => a.sub(&b),
                    '*' => a.mul(&b),
                    '/' => a.div(&b),
                    _ => a.power(&b),
                }
            }
            Self::Call(name, of) => {
                let a = of[0].of(y);
                match name.as_str() {
                    "sin" => a.sin(),
                    "cos" => a.cos(),
                    "exp" => a.exp(),
                    "ln" => a.ln(),
                    "sqrt" => a.root(),
                    "abs" => a.abs(),
                    "min" => a.min(&of[1].of(y)),
                    "max" => a.max(&of[1].of(y)),
                    _ => panic!("no oracle for `{name}`"),
                }
            }
        }
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
        let exponent = self.signed();
        if let Formula::Number(number) = &exponent {
            let whole = number.low;
            if whole.fract() == 0.0 && (1.0..=1000.0).contains(&whole) {
                return Formula::Whole(Box::new(base), whole as u32);
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
