//! Reads a formula of SURFER or surf, and converts it to the notation of scenes.

use glam::DMat3;
use std::ops::Range;
use tabray_core::text::shortest;
use tabray_lang::reader::Fault;

/// The maximum nesting of parentheses, signs and powers.
const DEEPEST: usize = 200;

/// The maximum length of a converted formula, in bytes. A script multiplies the formulas that it names.
const LONGEST: usize = 1 << 20;

/// A formula in x, y and z, or a number.
#[derive(Clone, Debug)]
pub struct Value {
    /// The formula in the notation of scenes.
    pub text: String,
    level: Level,
    /// The value of a number.
    pub number: Option<f64>,
    /// The pending rotation of the formula's zero set.
    pub turn: DMat3,
}

/// The precedence of a formula's outermost operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

impl Value {
    /// Makes a number with a name.
    pub fn named(name: &str, number: f64) -> Self {
        Self { text: name.to_owned(), level: Level::Atom, number: Some(number), turn: DMat3::IDENTITY }
    }

    fn of(text: String, level: Level, number: Option<f64>) -> Self {
        Self { text, level, number, turn: DMat3::IDENTITY }
    }

    /// Returns the formula, in parentheses if its precedence is lower.
    fn within(self, level: Level) -> String {
        if self.level < level { format!("({})", self.text) } else { self.text }
    }
}

/// The meanings of names.
pub trait Names {
    /// Returns the value of a name, or `None` if it is unknown.
    fn value(&self, name: &str) -> Option<Value>;

    /// Defines a function of x, y and z by a formula, and returns its name.
    fn function(&mut self, formula: &str) -> String;

    /// Returns a suggestion for an unknown name.
    fn help(&self, name: &str) -> String;
}

/// The precedence of signs and powers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// `-x^2` is -(x^2), and powers are right-associative.
    Surfer,
    /// `-x^2` is (-x)^2, and powers are left-associative.
    Surf,
}

/// A function: its name there and in scenes, and its computation.
type Function = (&'static str, &'static str, fn(f64) -> f64);

/// The functions of both programs.
const FUNCTIONS: [Function; 17] = [
    ("sin", "sin", libm::sin),
    ("cos", "cos", libm::cos),
    ("tan", "tan", libm::tan),
    ("asin", "asin", libm::asin),
    ("acos", "acos", libm::acos),
    ("atan", "atan", libm::atan),
    ("arcsin", "asin", libm::asin),
    ("arccos", "acos", libm::acos),
    ("arctan", "atan", libm::atan),
    ("exp", "exp", libm::exp),
    ("log", "ln", libm::log),
    ("ln", "ln", libm::log),
    ("sqrt", "sqrt", libm::sqrt),
    ("ceil", "ceil", libm::ceil),
    ("floor", "floor", libm::floor),
    ("abs", "abs", libm::fabs),
    ("sign", "sign", |x| if x < 0.0 { -1.0 } else { 1.0 }),
];

/// The result of reading, or an error.
pub type Read<T> = Result<T, Box<Fault>>;

/// Reads the formula in a range of a text.
pub fn read(text: &str, range: Range<usize>, dialect: Dialect, names: &mut dyn Names) -> Read<Value> {
    let mut reader = Reader { text, at: range.start, end: range.end, dialect, names, depth: 0 };
    let value = reader.sum()?;
    match reader.peek() {
        None => Ok(value),
        Some(')') => Err(reader.fault_here("this parenthesis closes nothing").into()),
        Some(_) => Err(reader.fault_here("the formula cannot continue like this").into()),
    }
}

/// Returns the rotation of a surface around an axis as in surf, with the opposite direction around y.
pub fn turn(axis: usize, angle: f64) -> DMat3 {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let rows = match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]],
        1 => [[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]],
        _ => [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]],
    };
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// Writes a linear combination of x, y and z plus a constant.
pub fn linear(factors: [f64; 3], constant: f64) -> String {
    let mut text = String::new();
    let terms = factors.into_iter().zip(["x", "y", "z"]).chain([(constant, "")]);
    for (factor, name) in terms.filter(|(factor, _)| *factor != 0.0) {
        let sign = match (factor < 0.0, text.is_empty()) {
            (true, true) => "-",
            (true, false) => " - ",
            (false, true) => "",
            (false, false) => " + ",
        };
        text += sign;
        text += &match (factor.abs(), name) {
            (size, "") => shortest(size),
            (1.0, name) => name.to_owned(),
            (size, name) => format!("{}*{name}", shortest(size)),
        };
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

struct Reader<'t, 'n> {
    text: &'t str,
    at: usize,
    end: usize,
    dialect: Dialect,
    names: &'n mut dyn Names,
    depth: usize,
}

impl Reader<'_, '_> {
    /// Skips white space, and returns the next character. A `\` at the end of a line continues the line.
    fn peek(&mut self) -> Option<char> {
        loop {
            let rest = &self.text[self.at..self.end];
            let next = rest.chars().next()?;
            let is_continued = next == '\\' && rest[1..].starts_with(['\n', '\r']);
            if !(next.is_whitespace() || is_continued) {
                return Some(next);
            }
            self.at += next.len_utf8();
        }
    }

    fn takes(&mut self, sign: char) -> bool {
        let is_there = self.peek() == Some(sign);
        self.at += if is_there { sign.len_utf8() } else { 0 };
        is_there
    }

    fn fault_here(&mut self, message: &str) -> Fault {
        let next = self.peek().map_or(0, char::len_utf8);
        Fault::error(Some(self.at..self.at + next), message)
    }

    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        if self.depth == DEEPEST {
            return Err(self.fault_here(&format!("the formula nests more than {DEEPEST} deep here")).into());
        }
        self.depth += 1;
        let read = read(self);
        self.depth -= 1;
        read
    }

    /// Returns the formula with its pending rotation applied.
    fn done(&mut self, value: Value) -> Value {
        if value.turn == DMat3::IDENTITY {
            return value;
        }
        // The rotated surface consists of the points with a zero of the formula after the inverse rotation.
        let back = value.turn.transpose();
        let arguments = [0, 1, 2].map(|row| linear(back.row(row).to_array(), 0.0)).join(", ");
        let name = self.names.function(&value.text);
        Value::of(format!("{name}({arguments})"), Level::Atom, None)
    }

    fn joined(&mut self, one: Value, sign: &str, other: Value, level: Level) -> Read<Value> {
        let (one, other) = (self.done(one), self.done(other));
        let (left, right) = match level {
            // A right operand of the same precedence needs parentheses: a - (b - c).
            Level::Sum => (Level::Sum, Level::Product),
            Level::Product => (Level::Product, Level::Power),
            _ => (Level::Atom, Level::Atom),
        };
        let number = one.number.zip(other.number).map(|(one, other)| match sign.trim() {
            "+" => one + other,
            "-" => one - other,
            "*" => one * other,
            "/" => one / other,
            _ => libm::pow(one, other),
        });
        let mut text = one.within(left);
        text += sign;
        text += &other.within(right);
        if text.len() > LONGEST {
            return Err(self
                .fault_here(&format!("written out, the formula has more than {LONGEST} letters"))
                .into());
        }
        Ok(Value::of(text, level, number))
    }

    fn sum(&mut self) -> Read<Value> {
        let mut sum = self.product()?;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.at += 1;
            let next = self.product()?;
            sum = self.joined(sum, if sign == '+' { " + " } else { " - " }, next, Level::Sum)?;
        }
        Ok(sum)
    }

    fn product(&mut self) -> Read<Value> {
        let mut product = self.factor()?;
        while let Some(next) = self.peek() {
            let sign = match next {
                '*' => "*",
                '/' => "/",
                _ if next == '(' || next == '.' || next.is_alphanumeric() => "",
                _ => break,
            };
            self.at += sign.len();
            let factor = self.factor()?;
            product =
                self.joined(product, if sign.is_empty() { "*" } else { sign }, factor, Level::Product)?;
        }
        Ok(product)
    }

    fn factor(&mut self) -> Read<Value> {
        match self.dialect {
            Dialect::Surfer => {
                if self.takes('-') {
                    let factor = self.deeper(Self::factor)?;
                    return Ok(self.negative(factor));
                }
                let base = self.atom()?;
                if !self.takes('^') {
                    return Ok(base);
                }
                let exponent = self.deeper(Self::factor)?;
                self.joined(base, "^", exponent, Level::Power)
            }
            Dialect::Surf => {
                let mut power = self.signed()?;
                while self.takes('^') {
                    let exponent = self.signed()?;
                    power = self.joined(power, "^", exponent, Level::Power)?;
                }
                Ok(power)
            }
        }
    }

    /// Reads an operand with its sign, which binds more tightly than a power.
    fn signed(&mut self) -> Read<Value> {
        if !self.takes('-') {
            return self.atom();
        }
        let value = self.deeper(Self::signed)?;
        Ok(self.negative(value))
    }

    fn negative(&mut self, value: Value) -> Value {
        let value = self.done(value);
        let number = value.number.map(|number| -number);
        Value::of(format!("-{}", value.within(Level::Product)), Level::Sum, number)
    }

    fn atom(&mut self) -> Read<Value> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let value = self.deeper(Self::sum)?;
                self.close()?;
                Ok(value)
            }
            Some('.' | '0'..='9') => self.number(),
            Some(letter) if letter.is_ascii_alphabetic() || letter == '_' => self.name(),
            Some(_) => Err(self
                .fault_here("this cannot be part of a formula")
                .help("a formula consists of numbers, names, + - * / ^ and parentheses")
                .into()),
            None => Err(self.fault_here("a number or a name is missing here").into()),
        }
    }

    fn close(&mut self) -> Read<()> {
        if self.takes(')') {
            Ok(())
        } else {
            Err(self.fault_here("a closing parenthesis is missing here").into())
        }
    }

    fn number(&mut self) -> Read<Value> {
        let rest = &self.text[self.at..self.end];
        let digits = |from: usize| {
            rest[from..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |length| from + length)
        };
        let whole = digits(0);
        let mut end = if rest[whole..].starts_with('.') { digits(whole + 1) } else { whole };
        if rest[end..].starts_with(['e', 'E']) {
            let signed = end + 1 + usize::from(rest[end + 1..].starts_with(['+', '-']));
            end = if digits(signed) > signed { digits(signed) } else { end };
        }
        let word = &rest[..end];
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| {
            Fault::error(Some(self.at..self.at + end), "this is not a number")
                .help("write a number as `2` or `0.5e-3`")
        })?;
        self.at += end;
        // Scenes require digits on both sides of a decimal point.
        let is_plain = whole > 0
            && rest[whole..]
                .strip_prefix('.')
                .is_none_or(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        Ok(Value::of(if is_plain { word.to_owned() } else { shortest(number) }, Level::Atom, Some(number)))
    }

    fn name(&mut self) -> Read<Value> {
        let start = self.at;
        let rest = &self.text[start..self.end];
        let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let name = &rest[..length];
        self.at += length;
        if let Some(value) = self.names.value(name) {
            return Ok(value);
        }
        if ["x", "y", "z"].contains(&name) {
            return Ok(Value::of(name.to_owned(), Level::Atom, None));
        }
        if self.peek() == Some('(') {
            if name == "rotate" && self.dialect == Dialect::Surf {
                return self.rotated();
            }
            if let Some((_, ours, compute)) = FUNCTIONS.iter().find(|(theirs, ..)| *theirs == name) {
                self.at += 1;
                let value = self.deeper(Self::sum)?;
                let value = self.done(value);
                self.close()?;
                return Ok(Value::of(
                    format!("{ours}({})", value.text),
                    Level::Atom,
                    value.number.map(compute),
                ));
            }
            let fault =
                Fault::error(Some(start..start + length), format!("the function `{name}` is not read"));
            return Err(fault.help("write out what it stands for").into());
        }
        let help = self.names.help(name);
        Err(Fault::error(Some(start..start + length), format!("`{name}` has no value")).help(help).into())
    }

    /// Reads the arguments of `rotate`: a surface, an angle and an axis.
    fn rotated(&mut self) -> Read<Value> {
        self.at += 1;
        let value = self.deeper(Self::sum)?;
        self.comma()?;
        let angle = self.deeper(Self::sum)?;
        self.comma()?;
        self.peek();
        let axis = ["xAxis", "yAxis", "zAxis"]
            .iter()
            .position(|axis| self.text[self.at..self.end].starts_with(axis));
        let (Some(axis), Some(angle)) = (axis, angle.number.filter(|angle| angle.is_finite())) else {
            return Err(self.fault_here("`rotate` needs a number, and `xAxis`, `yAxis` or `zAxis`").into());
        };
        self.at += "xAxis".len();
        self.close()?;
        Ok(Value { turn: turn(axis, angle) * value.turn, ..value })
    }

    fn comma(&mut self) -> Read<()> {
        if self.takes(',') { Ok(()) } else { Err(self.fault_here("a comma is missing here").into()) }
    }
}
