//! The parser: from the text of a formula to its operations in postfix order.

use super::step::{Function, MAX_DEPTH, Step};
use crate::decimal;
use crate::text;
use std::f64::consts::PI;
use std::ops::Range;

/// An error in the text of a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaFault {
    /// The byte range of the text to mark.
    pub place: Range<usize>,
    /// The error, for messages.
    pub message: String,
    /// The correction, for messages.
    pub help: String,
    /// The name that is unknown, if that is what is wrong.
    pub unknown: Option<String>,
}

/// Looks up a number by the name that a scene gives it.
pub type Named<'n> = &'n dyn Fn(&str) -> Option<f64>;

/// The operations of a formula, and the named numbers in its text, each with its place.
pub(super) type Operations = (Vec<Step>, Vec<(Range<usize>, f64)>);

/// The functions of a formula: name, function and number of arguments.
const FUNCTIONS: [(&str, Function, usize); 10] = [
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("tan", Function::Tan, 1),
    ("exp", Function::Exp, 1),
    ("ln", Function::Ln, 1),
    ("sqrt", Function::Sqrt, 1),
    ("abs", Function::Abs, 1),
    ("floor", Function::Floor, 1),
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
];

/// Returns the names of the functions of formulas, each with the number of its arguments.
pub fn functions() -> impl Iterator<Item = (&'static str, usize)> {
    FUNCTIONS.iter().map(|(name, _, count)| (*name, *count))
}

/// Returns whether a name means something in every formula, so that a scene cannot give it to a number.
pub fn is_taken(name: &str) -> bool {
    ["x", "y", "z", "pi"].contains(&name) || FUNCTIONS.iter().any(|(function, ..)| *function == name)
}

/// Says what a formula in these variables consists of.
fn language(variables: &[&str]) -> String {
    let variables = match variables {
        [] => "named numbers".to_owned(),
        variables => text::list(variables.iter().copied()),
    };
    format!(
        "a formula consists of numbers, {variables}, `pi`, + - * / ^, parentheses, and the functions \
         sin cos tan exp ln sqrt abs floor of one value and min max of two"
    )
}

/// Parses the operations of a formula in these variables and named numbers.
pub(super) fn parse(text: &str, variables: &[&str], named: Named<'_>) -> Result<Operations, FormulaFault> {
    let mut parser =
        Parser { text, variables, named, at: 0, steps: Vec::new(), numbers: Vec::new(), depth: 0 };
    parser.sum()?;
    match parser.peek() {
        None => Ok((parser.steps, parser.numbers)),
        Some(')') => Err(parser.fault_here("unmatched `)`")),
        Some(_) => Err(parser.fault_here("expected an operator")),
    }
}

struct Parser<'t> {
    text: &'t str,
    variables: &'t [&'t str],
    named: Named<'t>,
    at: usize,
    steps: Vec<Step>,
    /// The named numbers so far, each with its place.
    numbers: Vec<(Range<usize>, f64)>,
    /// The number of values on the stack or the depth of parentheses, whichever is greater.
    depth: usize,
}

type Parsed = Result<(), FormulaFault>;

impl<'t> Parser<'t> {
    /// Skips blanks and returns the next character.
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

    fn sum(&mut self) -> Parsed {
        self.deeper()?;
        self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            self.product()?;
            self.steps.push(if sign == '+' { Step::Add } else { Step::Sub });
        }
        self.depth -= 1;
        Ok(())
    }

    fn product(&mut self) -> Parsed {
        self.signed()?;
        while let Some(sign) = self.take(&['*', '/']) {
            self.deeper()?;
            self.signed()?;
            self.depth -= 1;
            self.steps.push(if sign == '*' { Step::Mul } else { Step::Div });
        }
        Ok(())
    }

    /// Parses a sign and its operand. Unary minus binds less tightly than a power: -y^2 is -(y^2).
    fn signed(&mut self) -> Parsed {
        if self.take(&['-']).is_some() {
            self.deeper()?;
            self.signed()?;
            self.depth -= 1;
            self.steps.push(Step::Neg);
            return Ok(());
        }
        self.power()
    }

    fn power(&mut self) -> Parsed {
        self.atom()?;
        if self.take(&['^']).is_none() {
            return Ok(());
        }
        let exponent = self.steps.len();
        self.deeper()?;
        self.signed()?;
        self.depth -= 1;
        let whole = match self.steps[exponent..] {
            [Step::Number(number)] => Some(number),
            [Step::Number(number), Step::Neg] => Some(-number),
            _ => None,
        };
        match whole.filter(|number| number.fract() == 0.0 && number.abs() <= 1000.0) {
            Some(number) => {
                self.steps.truncate(exponent);
                self.steps.push(Step::Powi(number as i32));
            }
            None => self.steps.push(Step::Call(Function::Pow)),
        }
        Ok(())
    }

    fn atom(&mut self) -> Parsed {
        match self.peek() {
            Some('(') => {
                let open = self.at;
                self.at += 1;
                self.sum()?;
                self.close(open)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            _ => Err(self.fault_here("expected a value")),
        }
    }

    fn close(&mut self, open: usize) -> Parsed {
        match self.take(&[')']) {
            Some(_) => Ok(()),
            None => Err(self.fault(open..open + 1, "unclosed `(`")),
        }
    }

    fn number(&mut self) -> Parsed {
        let start = self.at;
        let bytes = self.text.as_bytes();
        while let Some(byte) = bytes.get(self.at)
            && (byte.is_ascii_alphanumeric()
                || *byte == b'.'
                || (matches!(byte, b'+' | b'-') && matches!(bytes[self.at - 1], b'e' | b'E')))
        {
            self.at += 1;
        }
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
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        self.at += length;
        let word = &rest[..length];
        let place = start..self.at;
        if let Some(variable) = self.variables.iter().position(|name| *name == word) {
            if (self.named)(word).is_some() {
                let message = format!("`{word}` is a variable of this formula and a number of the scene");
                return Err(self.fault(place, message));
            }
            self.steps.push(Step::Variable(variable as u8));
            return Ok(());
        }
        match (word, FUNCTIONS.iter().find(|(name, ..)| *name == word)) {
            ("pi", _) => self.steps.push(Step::Number(PI)),
            (_, Some((_, function, arguments))) => {
                self.arguments(word, place, *arguments)?;
                self.steps.push(Step::Call(*function));
            }
            _ => {
                let Some(number) = (self.named)(word) else {
                    let fault = self.fault(place, format!("unknown name `{word}` in a formula"));
                    return Err(FormulaFault { unknown: Some(word.to_owned()), ..fault });
                };
                self.steps.push(Step::Number(number));
                self.numbers.push((place, number));
            }
        }
        Ok(())
    }

    fn arguments(&mut self, name: &str, place: Range<usize>, count: usize) -> Parsed {
        let open = self.at;
        if self.take(&['(']).is_none() {
            return Err(self.fault(place, format!("`{name}` needs its argument in parentheses")));
        }
        self.sum()?;
        for _ in 1..count {
            if self.take(&[',']).is_none() {
                return Err(self.fault(place, format!("`{name}` takes {count} values, separated by commas")));
            }
            self.deeper()?;
            self.sum()?;
            self.depth -= 1;
        }
        if self.peek() == Some(',') {
            let takes = text::count(count, "value");
            return Err(self.fault(place, format!("`{name}` takes only {takes}")));
        }
        self.close(open)
    }

    fn deeper(&mut self) -> Parsed {
        self.depth += 1;
        if self.depth >= MAX_DEPTH { Err(self.fault_here("formula nested too deeply")) } else { Ok(()) }
    }
}
