//! The parser, from the text of a formula to its operations in postfix order.

mod calls;

use super::function;
use super::own::{Edits, OwnFunction, Piece};
use super::step::{Function, MAX_DEPTH, Step, deepest};
use super::variables::{OF_FORMULAS, SPACE, SURFACE};
use super::words::{FormulaFault, SUPERSCRIPTS, is_in_name, language};
use crate::decimal;
use std::f64::consts::PI;
use std::mem::replace;
use std::ops::Range;
use std::sync::Arc;

/// The meaning of a name in a scene.
#[derive(Clone, Debug)]
pub enum Meant {
    /// A number.
    Number(f64),
    /// A function that the scene defines.
    Function(Arc<OwnFunction>),
}

/// Looks up a name of a scene.
pub type Named<'n> = &'n dyn Fn(&str) -> Option<Meant>;

/// The parsed text.
pub(super) struct Operations {
    pub steps: Vec<Step>,
    /// The text, with the names of a scene replaced.
    pub pieces: Vec<Piece>,
    /// Whether the text calls functions of the scene.
    pub has_calls: bool,
    /// The operations that parts of the text stand for, each part after those within it.
    pub parts: Vec<Part>,
}

/// A part of the text of a formula.
pub(super) struct Part {
    pub text: Range<usize>,
    /// Its operations.
    pub steps: Range<usize>,
}

/// The maximum whole exponent of a power that is computed by multiplications.
const MAX_POWER: i32 = 1000;

/// The maximum number of operations of a formula. A function that is itself a formula may use an argument more than
/// once, and nested calls many times.
const MAX_STEPS: usize = 1 << 18;

/// Parses the operations of a formula in these variables and named numbers. An equation in x, y and z is the difference
/// of its sides.
pub(super) fn parse(
    text: &str,
    variables: &[&str],
    named: Named<'_>,
    value: fn(&[Step]) -> f64,
) -> Result<Operations, FormulaFault> {
    let mut parser = Parser {
        text,
        variables,
        named,
        at: 0,
        steps: Vec::new(),
        edits: Edits::default(),
        parts: Vec::new(),
        depth: 0,
        is_in_bars: false,
        value,
    };
    parser.sum()?;
    let equals = parser.at;
    if parser.take(&['=']).is_some() {
        if variables != SPACE {
            let help = "an equation is one of a surface, in x, y and z: here, write the value alone";
            let fault = parser.fault(equals..parser.at, "expected a value, not an equation");
            return Err(FormulaFault { help: help.to_owned(), ..fault });
        }
        parser.deeper()?;
        parser.sum()?;
        parser.steps.push(Step::Sub);
    }
    match parser.peek() {
        None if deepest(&parser.steps) <= MAX_DEPTH => {
            let pieces = parser.edits.take(text, 0..text.len());
            let Parser { steps, edits, parts, .. } = parser;
            Ok(Operations { steps, pieces, has_calls: edits.has_calls, parts })
        }
        None => Err(parser.fault_here("formula nested too deeply")),
        Some(')') => Err(parser.fault_here("unmatched `)`")),
        Some('<' | '>' | '≤' | '≥') => {
            let fault = parser.fault_here("expected a value, not a comparison");
            Err(FormulaFault {
                help: "a comparison chooses between two values: `if(a < b, c, d)`".to_owned(),
                ..fault
            })
        }
        Some(_) => Err(parser.fault_here("expected an operator")),
    }
}

struct Parser<'t> {
    text: &'t str,
    variables: &'t [&'t str],
    named: Named<'t>,
    at: usize,
    steps: Vec<Step>,
    /// The names so far.
    edits: Edits,
    parts: Vec<Part>,
    /// The number of values on the stack or the depth of parentheses, whichever is greater.
    depth: usize,
    /// Whether a `|` ends an absolute value.
    is_in_bars: bool,
    /// Returns the value of operations without variables.
    value: fn(&[Step]) -> f64,
}

type Parsed = Result<(), FormulaFault>;

impl<'t> Parser<'t> {
    /// Skips white space and returns the next character.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// Consumes and returns the next character if it is one of these.
    fn take(&mut self, any: &[char]) -> Option<char> {
        let next = self.peek().filter(|next| any.contains(next))?;
        self.at += next.len_utf8();
        Some(next)
    }

    fn fault(&self, place: Range<usize>, message: impl Into<String>) -> FormulaFault {
        FormulaFault { place, message: message.into(), help: language(self.variables), unknown: None }
    }

    fn fault_here(&mut self, message: &str) -> FormulaFault {
        let width = self.peek().map_or(0, char::len_utf8);
        self.fault(self.at..self.at + width, message)
    }

    /// Notes that the text from one place on stands for the operations from another on.
    fn note(&mut self, [text, steps]: [usize; 2]) {
        self.parts.push(Part { text: text..self.at, steps: steps..self.steps.len() });
    }

    /// Returns where a part of the text begins, for [`note`](Self::note).
    fn start(&mut self) -> [usize; 2] {
        self.peek();
        [self.at, self.steps.len()]
    }

    /// Forgets the parts of operations that are about to be replaced, from one on.
    fn forget(&mut self, from: usize) {
        while self.parts.pop_if(|part| part.steps.start >= from).is_some() {}
    }

    fn sum(&mut self) -> Parsed {
        self.deeper()?;
        let start = self.start();
        self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            self.product()?;
            self.steps.push(if sign == '+' { Step::Add } else { Step::Sub });
            self.note(start);
        }
        self.depth -= 1;
        Ok(())
    }

    /// Parses a product. The sign between factors may be omitted: `2x`, `(x + y)(x - y)`.
    fn product(&mut self) -> Parsed {
        let part = self.start();
        let start = part[0];
        self.signed()?;
        let mut divides = false;
        loop {
            let before = self.at;
            let sign = self.factor_sign();
            if sign.is_none() && !self.begins_factor() {
                return Ok(());
            }
            self.deeper()?;
            let factor = self.at;
            self.signed()?;
            self.depth -= 1;
            if sign.is_none() && divides {
                let whole = self.text[start..self.at].trim_end();
                let (one, other) = (self.text[start..before].trim_end(), self.text[factor..self.at].trim());
                let message = format!("`{whole}` can be read in two ways");
                let fault = self.fault(start..start + whole.len(), message);
                let (dividend, divisor) = one.rsplit_once('/').unwrap_or((one, ""));
                let help = format!("write `{one}*{other}` or `{dividend}/({divisor}*{other})`");
                return Err(FormulaFault { help, ..fault });
            }
            divides = sign == Some('/');
            self.steps.push(if divides { Step::Div } else { Step::Mul });
            self.note(part);
        }
    }

    /// Consumes a `*` that is not the beginning of `**`, or a `/`.
    fn factor_sign(&mut self) -> Option<char> {
        self.peek();
        if self.text[self.at..].starts_with("**") { None } else { self.take(&['*', '/']) }
    }

    /// Tells whether the next character begins a factor without a sign.
    fn begins_factor(&mut self) -> bool {
        let is_in_bars = self.is_in_bars;
        self.peek().is_some_and(|next| next == '(' || next.is_alphabetic() || next == '|' && !is_in_bars)
    }

    /// Parses a sign and its operand. Unary minus binds less tightly than a power: -y^2 is -(y^2).
    fn signed(&mut self) -> Parsed {
        if let Some(sign) = self.take(&['-', '+']) {
            self.deeper()?;
            self.signed()?;
            self.depth -= 1;
            if sign == '-' {
                self.steps.push(Step::Neg);
            }
            return Ok(());
        }
        self.power()
    }

    /// Parses a power: `x^2`, `x**2` or `x²`.
    fn power(&mut self) -> Parsed {
        let start = self.start();
        self.atom()?;
        let exponent = self.steps.len();
        if let Some(power) = self.superscript()? {
            self.steps.push(Step::Powi(power));
            self.note(start);
            return Ok(());
        }
        if self.text[self.at..].starts_with("**") {
            self.at += 2;
        } else if self.take(&['^']).is_none() {
            return Ok(());
        }
        self.deeper()?;
        self.signed()?;
        self.depth -= 1;
        let is_constant = |step: &Step| !matches!(step, Step::Variable(_) | Step::Spline);
        let mut power = Step::Call(Function::Pow);
        if self.steps[exponent..].iter().all(is_constant) {
            let number = (self.value)(&self.steps[exponent..]);
            self.forget(exponent);
            self.steps.truncate(exponent);
            if number.fract() == 0.0 && number.abs() <= f64::from(MAX_POWER) {
                power = Step::Powi(number as i32);
            } else {
                self.steps.push(Step::Number(number));
            }
        }
        self.steps.push(power);
        self.note(start);
        Ok(())
    }

    /// Consumes the digits of an exponent: `²`, `¹²`.
    fn superscript(&mut self) -> Result<Option<i32>, FormulaFault> {
        let value = |digit: char| SUPERSCRIPTS.iter().position(|known| *known == digit);
        self.peek();
        let (start, mut power) = (self.at, None);
        while let Some((digit, letter)) =
            self.text[self.at..].chars().next().and_then(|letter| Some((value(letter)?, letter)))
        {
            self.at += letter.len_utf8();
            power = Some((10 * power.unwrap_or(0) + digit as i32).min(MAX_POWER + 1));
        }
        if power > Some(MAX_POWER) {
            return Err(self.fault(start..self.at, "a power is at most 1000"));
        }
        Ok(power)
    }

    fn atom(&mut self) -> Parsed {
        let start = self.start();
        self.atom_alone()?;
        self.note(start);
        Ok(())
    }

    fn atom_alone(&mut self) -> Parsed {
        match self.peek() {
            Some('(') => {
                let open = self.at;
                self.at += 1;
                self.enclosed(false)?;
                self.close(open)
            }
            Some('|') if !self.is_in_bars => {
                let open = self.at;
                self.at += 1;
                self.enclosed(true)?;
                if self.take(&['|']).is_none() {
                    return Err(self.fault(open..open + 1, "unclosed `|`"));
                }
                self.steps.push(Step::Call(Function::Abs));
                Ok(())
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            _ => Err(self.fault_here("expected a value")),
        }
    }

    /// Parses the contents of parentheses, or of `| |`, where a nested `|` needs parentheses.
    fn enclosed(&mut self, is_in_bars: bool) -> Parsed {
        let outer = replace(&mut self.is_in_bars, is_in_bars);
        self.sum()?;
        self.is_in_bars = outer;
        Ok(())
    }

    fn close(&mut self, open: usize) -> Parsed {
        match self.take(&[')']) {
            Some(_) => Ok(()),
            None => Err(self.fault(open..open + 1, "unclosed `(`")),
        }
    }

    fn number(&mut self) -> Parsed {
        let start = self.at;
        let digits = |at: usize| {
            let rest = self.text[at..].bytes();
            at + rest.take_while(|byte| byte.is_ascii_digit() || *byte == b'.').count()
        };
        let mut end = digits(start);
        // An `e` is an exponent only before digits. In `2exp(x)`, it begins a function.
        if let Some(exponent) = self.text[end..].strip_prefix(['e', 'E']) {
            let unsigned = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            if unsigned.starts_with(|c: char| c.is_ascii_digit()) {
                end = digits(self.text.len() - unsigned.len());
            }
        }
        self.at = end;
        let word = &self.text[start..self.at];
        let number = decimal::read(word).map_err(|fault| {
            let told = self.fault(start..self.at, format!("`{word}` is {}", fault.what()));
            FormulaFault { help: fault.help().map_or(told.help, str::to_owned), ..told }
        })?;
        self.steps.push(Step::Number(number));
        Ok(())
    }

    fn name(&mut self) -> Parsed {
        let start = self.at;
        let rest = &self.text[start..];
        let length = rest.find(|c: char| !is_in_name(c)).unwrap_or(rest.len());
        self.at += length;
        let word = &rest[..length];
        let place = start..self.at;
        let gives_way = || self.variables == SURFACE && OF_FORMULAS.contains(&word);
        if let Some(variable) = self.variables.iter().position(|name| *name == word)
            && !((self.named)(word).is_some() && gives_way())
        {
            if (self.named)(word).is_some() {
                let message = format!("`{word}` is a variable of this formula and a number of the scene");
                return Err(self.fault(place, message));
            }
            self.variable(place, variable);
            return Ok(());
        }
        let (named, lower) = ((self.named)(word), word.to_lowercase());
        match (word, named, function::find(word)) {
            ("pi" | "π", _, _) => self.steps.push(Step::Number(PI)),
            (_, Some(meant), function) if function.is_none_or(|function| !function.is_reserved()) => {
                match meant {
                    Meant::Number(number) => {
                        self.steps.push(Step::Number(number));
                        self.edits.number(self.text, place, number);
                    }
                    Meant::Function(function) => self.own_call(&function, place)?,
                }
            }
            (_, _, Some(function)) => self.call(function, place)?,
            // `X` is x, unless the scene has a number with this name.
            _ => match self.variables.iter().position(|name| *name == lower && word.len() == 1) {
                Some(variable) => self.variable(place, variable),
                None => return Err(self.unknown(word, place)),
            },
        }
        Ok(())
    }

    fn variable(&mut self, place: Range<usize>, index: usize) {
        self.steps.push(Step::Variable(index as u8));
        self.edits.variable(place, index);
    }

    /// Explains an unknown name.
    fn unknown(&self, word: &str, place: Range<usize>) -> FormulaFault {
        let fault = self.fault(place, format!("unknown name `{word}` in a formula"));
        let product: Vec<_> = word.split("").filter(|letter| !letter.is_empty()).collect();
        let help = match word {
            _ if product.iter().all(|letter| self.variables.contains(letter)) => {
                format!("write a product as `{}`", product.join("*"))
            }
            "e" => "write `exp(1)` for the number e".to_owned(),
            "pow" | "power" => "write `a^b` for a power".to_owned(),
            "sqr" | "square" => "write `x^2` for a square".to_owned(),
            "arcsin" | "arccos" | "arctan" => format!("write `a{}`", &word[3..]),
            "length" | "norm" => "write `sqrt(x^2 + y^2 + z^2)` for a length".to_owned(),
            _ => return FormulaFault { unknown: Some(word.to_owned()), ..fault },
        };
        FormulaFault { help, ..fault }
    }

    fn deeper(&mut self) -> Parsed {
        self.depth += 1;
        if self.depth >= MAX_DEPTH { Err(self.fault_here("formula nested too deeply")) } else { Ok(()) }
    }
}
