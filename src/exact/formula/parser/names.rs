//! Names in formulas: variables, numbers, and functions with their arguments.

use super::{Meant, Operations, Parsed, Parser, parse};
use crate::formula::function::{self, Meaning};
use crate::formula::own::OwnFunction;
use crate::formula::step::{Function, Step};
use crate::formula::variables::{OF_FORMULAS, SURFACE};
use crate::formula::words::{FormulaFault, is_in_name};
use crate::text;
use std::f64::consts::PI;
use std::ops::Range;

/// The maximum number of operations of a formula. A function that is itself a formula may use an argument more than
/// once, so nested calls may use it many times.
const MAX_STEPS: usize = 1 << 18;

impl Parser<'_> {
    /// Parses a name and, if it is a function, its arguments.
    pub fn name(&mut self) -> Parsed {
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
            // `X` is x, unless the scene has a number of this name.
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

    /// Explains a name that has no meaning here.
    fn unknown(&self, word: &str, place: Range<usize>) -> FormulaFault {
        let fault = self.fault(place, format!("unknown name `{word}` in a formula"));
        let product: Vec<_> = word.split("").filter(|letter| !letter.is_empty()).collect();
        let help = match word {
            _ if product.iter().all(|letter| self.variables.contains(letter)) => {
                format!("write a product as `{}`", product.join("*"))
            }
            "e" => "write `exp(1)` for the number e".to_owned(),
            _ => return FormulaFault { unknown: Some(word.to_owned()), ..fault },
        };
        FormulaFault { help, ..fault }
    }

    /// Parses the arguments of a function, and applies it.
    fn call(&mut self, function: &function::FormulaFunction, place: Range<usize>) -> Parsed {
        let (name, count) = (function.name, function.arguments.len());
        let open = self.open(name, &place)?;
        let (mut starts, depth) = (vec![self.steps.len()], self.depth);
        self.enclosed(false)?;
        let is_reversed = matches!(function.meaning, Meaning::Choice) && self.comparison()?;
        while (starts.len() < count || function.takes_more()) && self.take(&[',']).is_some() {
            starts.push(self.steps.len());
            self.deeper()?;
            self.enclosed(false)?;
            if let Meaning::Operation(of) = function.meaning {
                // The values so far are combined into one, so that many arguments nest no deeper than two.
                self.steps.push(Step::Call(of));
                self.depth = depth;
            }
        }
        self.depth = depth;
        self.counted(name, &place, starts.len(), count)?;
        match function.meaning {
            Meaning::Operation(of) if count == 1 => self.steps.push(Step::Call(of)),
            Meaning::Operation(_) => {}
            Meaning::Fixed(of) => self.steps.push(Step::Call(of)),
            Meaning::Choice => {
                if is_reversed {
                    let count = self.steps.len() - starts[2];
                    self.steps[starts[1]..].rotate_right(count);
                }
                self.steps.push(Step::Call(Function::If));
            }
            Meaning::Formula(text) => {
                let Operations { steps, .. } = parse(text, function.arguments, &|_| None, self.value)?;
                self.apply(&steps, &starts, &place)?;
            }
        }
        self.close(open)
    }

    /// Consumes the parenthesis before arguments, and returns its place.
    fn open(&mut self, name: &str, place: &Range<usize>) -> Result<usize, FormulaFault> {
        let open = self.at;
        match self.take(&['(']) {
            Some(_) => Ok(open),
            None => Err(self.fault(place.clone(), format!("`{name}` needs its argument in parentheses"))),
        }
    }

    /// Reports a fault if the number of arguments is not one that the function takes.
    fn counted(&mut self, name: &str, place: &Range<usize>, found: usize, count: usize) -> Parsed {
        let takes = text::count(count, "value");
        if found < count {
            return Err(self.fault(place.clone(), format!("`{name}` takes {takes}, separated by commas")));
        }
        match self.peek() {
            Some(',') => Err(self.fault(place.clone(), format!("`{name}` takes only {takes}"))),
            _ => Ok(()),
        }
    }

    /// Replaces the operations of arguments by the operations of a function of them. `starts` are the places where the
    /// arguments start.
    fn apply(&mut self, of: &[Step], starts: &[usize], place: &Range<usize>) -> Parsed {
        let uses = |step: &Step| match step {
            Step::Variable(index) => {
                let at = usize::from(*index);
                starts[at]..starts.get(at + 1).copied().unwrap_or(self.steps.len())
            }
            _ => 0..0,
        };
        let length: usize = of.iter().map(|step| uses(step).len().max(1)).sum();
        if self.steps.len() + length > MAX_STEPS {
            return Err(self.fault(place.clone(), "too many operations"));
        }
        let mut applied = Vec::with_capacity(length);
        for step in of {
            match step {
                Step::Variable(_) => applied.extend_from_slice(&self.steps[uses(step)]),
                step => applied.push(*step),
            }
        }
        self.steps.truncate(starts[0]);
        self.steps.append(&mut applied);
        Ok(())
    }

    /// Parses the arguments of a function of the scene's own, and applies it.
    fn own_call(&mut self, function: &OwnFunction, place: Range<usize>) -> Parsed {
        let (name, depth) = (self.text[place.clone()].to_owned(), self.depth);
        let open = self.open(&name, &place)?;
        let (mut starts, mut arguments) = (Vec::new(), Vec::new());
        loop {
            starts.push(self.steps.len());
            let start = self.at;
            self.enclosed(false)?;
            arguments.push(self.edits.take(self.text, start..self.at));
            if starts.len() == function.count() || self.take(&[',']).is_none() {
                break;
            }
            self.deeper()?;
        }
        self.depth = depth;
        self.counted(&name, &place, starts.len(), function.count())?;
        self.apply(&function.steps, &starts, &place)?;
        self.close(open)?;
        if !self.edits.call(place.start..self.at, &function.pieces, &arguments) {
            return Err(self.fault(place, "too many operations"));
        }
        Ok(())
    }

    /// Parses the sign of a comparison and its right side. The resulting value is 0 or above where the comparison holds
    /// or, if it is reversed, where it does not hold. Returns whether it is reversed.
    fn comparison(&mut self) -> Result<bool, FormulaFault> {
        let Some(sign) = self.take(&['<', '>', '≤', '≥']) else {
            let fault = self.fault_here("expected a comparison");
            let help = "`if` takes a comparison and two values, as in `if(x < 0, -x, x)`, with `<`, `<=`, `>` or `>=`";
            return Err(FormulaFault { help: help.to_owned(), ..fault });
        };
        let is_or_equal = matches!(sign, '≤' | '≥') || self.text[self.at..].starts_with('=');
        self.at += usize::from(self.text[self.at..].starts_with('=') && is_or_equal && sign.is_ascii());
        self.deeper()?;
        self.enclosed(false)?;
        self.depth -= 1;
        self.steps.push(Step::Sub);
        // a < b is the opposite of a - b >= 0, and a > b is the opposite of b - a >= 0.
        if matches!((sign, is_or_equal), ('>', false) | ('<' | '≤', true)) {
            self.steps.push(Step::Neg);
        }
        Ok(!is_or_equal)
    }
}
