//! Calls: functions of formulas, functions of the scene, and comparisons.

use super::{MAX_STEPS, Operations, Parsed, Parser, parse};
use crate::formula::function::{FormulaFunction, Meaning};
use crate::formula::own::OwnFunction;
use crate::formula::step::{Function, Step};
use crate::formula::words::FormulaFault;
use crate::text;
use std::ops::Range;

impl Parser<'_> {
    /// Parses the arguments of a function, and applies it.
    pub(super) fn call(&mut self, function: &FormulaFunction, place: Range<usize>) -> Parsed {
        let (name, count) = (function.name, function.arguments.len());
        let open = self.open(name, &place)?;
        let (mut starts, depth) = (vec![self.steps.len()], self.depth);
        self.enclosed(false)?;
        let is_reversed = matches!(function.meaning, Meaning::Choice) && self.comparison()?;
        while (starts.len() < count || function.takes_more()) && self.take(&[',']).is_some() {
            starts.push(self.steps.len());
            self.deeper()?;
            self.enclosed(false)?;
            // The values so far are combined into one, and so many arguments nest no deeper than two.
            if let Meaning::Operation(of) = function.meaning {
                self.steps.push(Step::Call(of));
                self.depth = depth;
            } else if function.takes_more() {
                self.depth = depth;
            }
        }
        self.depth = depth;
        self.counted(name, &place, starts.len(), count)?;
        match function.meaning {
            Meaning::Operation(of) if count == 1 => self.steps.push(Step::Call(of)),
            Meaning::Operation(_) => {}
            Meaning::Smooth(of) => self.combine(of, &starts, &place)?,
            Meaning::Fixed(of) => self.steps.push(Step::Call(of)),
            Meaning::Choice => {
                if is_reversed {
                    self.forget(starts[1]);
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

    /// Returns an error if a function does not take this number of arguments.
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

    /// Replaces the operations of arguments by the operations of a function of them. `starts` are the starts of the
    /// arguments.
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
        self.forget(starts[0]);
        self.steps.truncate(starts[0]);
        self.steps.append(&mut applied);
        Ok(())
    }

    /// Combines the first arguments, one after the other, each with the last one as the third value. `starts` are the
    /// starts of the arguments.
    fn combine(&mut self, of: Function, starts: &[usize], place: &Range<usize>) -> Parsed {
        let [_, second, ends @ ..] = starts else { return Ok(()) };
        let last = self.steps.split_off(*starts.last().unwrap_or(second));
        if self.steps.len() + ends.len() * (last.len() + 1) > MAX_STEPS {
            return Err(self.fault(place.clone(), "too many operations"));
        }
        self.forget(*second);
        let rest = self.steps.split_off(*second);
        let mut start = 0;
        for end in ends {
            let end = end - second;
            self.steps.extend_from_slice(&rest[start..end]);
            self.steps.extend_from_slice(&last);
            self.steps.push(Step::Call(of));
            start = end;
        }
        Ok(())
    }

    /// Parses the arguments of a function that the scene defines, and applies it.
    pub(super) fn own_call(&mut self, function: &OwnFunction, place: Range<usize>) -> Parsed {
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

    /// Parses the sign of a comparison and its right side. The resulting value is 0 or above if the comparison is true
    /// or, if it is reversed, if the comparison is false. Returns whether it is reversed.
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
