//! The named numbers and the functions of a scene, and formulas in place of numbers.

use super::cures;
use super::fault::{Fault, Place, Severity};
use super::parsed::{Form, Word};
use super::report::Report;
use super::tokens::Tokens;
use super::values;
use crate::syntax::Syntax;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;
use tabray_core::scene::value::Type;
use tabray_core::text::{list, nearest, shortest};
use tabray_exact::formula::variables::{CURVE, SURFACE};
use tabray_exact::formula::{self, Formula, FormulaFault, Meant, Named, OwnFunction, is_in_name, is_taken};

/// The maximum number of names that a message lists.
const LISTED: usize = 8;

/// The notation of a function definition, for messages.
const FUNCTION: &str = "write a function as `let f(u, v) \"u^2 + v\"`";

/// A named number or function of a scene.
struct Number {
    name: String,
    /// The value, or `None` for a faulty definition. Uses of such a name are not reported.
    value: Option<Meant>,
    place: Place,
}

/// The numbers named so far.
#[derive(Default)]
pub struct Numbers<'a> {
    all: Vec<Number>,
    by_name: HashMap<String, usize>,
    /// The text in the notes' syntax, which may define names later.
    text: &'a str,
    /// The names defined anywhere in the text, with their places, found on first use.
    anywhere: Option<HashMap<String, Place>>,
}

impl<'a> Numbers<'a> {
    /// Begins without numbers, for a text in the notes' syntax.
    pub fn of(text: &'a str) -> Self {
        Self { text, ..Self::default() }
    }

    /// Begins without numbers, for a text that defines these names.
    pub fn of_names(names: HashMap<String, Place>) -> Self {
        Self { anywhere: Some(names), ..Self::default() }
    }

    /// Returns the number of names, for a later call of [`keep`](Self::keep).
    #[inline]
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Forgets all names except the first `len`.
    pub fn keep(&mut self, len: usize) {
        for number in self.all.drain(len..) {
            self.by_name.remove(&number.name);
        }
    }

    /// Changes a number, given by the number of names before it.
    pub fn change(&mut self, index: usize, value: f64) {
        if let Some(number) = self.all.get_mut(index) {
            number.value = Some(Meant::Number(value));
        }
    }

    /// Returns the names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.all.iter().map(|number| number.name.as_str())
    }

    /// Names a number, or reports the reason why it cannot have the name. `None` stands for a faulty number.
    pub fn define(&mut self, name: &Word<'_>, value: Option<f64>, report: &mut Report<'_>) {
        self.name(name, value.map(Meant::Number), report);
    }

    /// Defines a function by its head, `f(u, v)`, and the formula of its arguments, or reports the reason why it cannot
    /// be defined. Returns `None` if the word is not the head of a function.
    pub fn function(&mut self, head: &Word<'_>, value: &Word<'_>, report: &mut Report<'_>) -> Option<()> {
        let (name, arguments) = formula::head(&head.text)?;
        let function = match arguments {
            Err(reason) => {
                let message =
                    format!("`{}` is not the head of a function: {reason}", head.text.escape_debug());
                report.add(Fault::error(head.place.clone(), message).help(FUNCTION));
                None
            }
            Ok(_) if value.form != Form::Text => {
                let message = format!("`{}` is not a formula in quotes", value.text.escape_debug());
                report.add(Fault::error(value.place.clone(), message).help(FUNCTION));
                None
            }
            Ok(arguments) => {
                let mut used = Vec::new();
                let parsed =
                    self.named(&mut used, |named| OwnFunction::parse(&arguments, &value.text, named));
                let fault = parsed.as_ref().err().cloned().map(|fault| self.explained(value, fault, report));
                fault.into_iter().for_each(|fault| report.add(fault));
                parsed.ok().filter(|_| used.iter().all(|(_, value)| !f64::is_nan(*value)))
            }
        };
        let name = Word { text: name.to_owned().into(), ..head.clone() };
        self.name(&name, function.map(|function| Meant::Function(Arc::new(function))), report);
        Some(())
    }

    fn name(&mut self, name: &Word<'_>, value: Option<Meant>, report: &mut Report<'_>) {
        let mut letters = name.text.chars();
        let is_name = letters.next().is_some_and(char::is_alphabetic) && letters.all(is_in_name);
        let fault = |message| Fault::error(name.place.clone(), message);
        if !is_name {
            let message = format!("`{}` cannot be the name of a number", name.text.escape_debug());
            let help =
                "a name that formulas can use begins with a letter, and has only letters, digits and `_`";
            report.add(fault(message).help(help));
        } else if is_taken(&name.text) {
            let message = format!("`{}` cannot be the name of a number", name.text);
            report.add(
                fault(message)
                    .help(format!("in formulas, `{}` already has a meaning: choose another name", name.text)),
            );
        } else if let Some(known) = self.by_name.get(&*name.text) {
            let message = format!("the number `{}` is defined twice", name.text);
            report.add(
                fault(message)
                    .also(self.all[*known].place.clone(), "the first one")
                    .help("a named number does not change: choose another name"),
            );
        } else {
            self.by_name.insert(name.text.to_string(), self.all.len());
            self.all.push(Number { name: name.text.to_string(), value, place: name.place.clone() });
        }
    }

    /// Returns the value of a word: a number, or a formula in quotes. Returns `None` after reporting an error, or if
    /// the formula depends on a number with a reported error.
    pub fn number(&mut self, word: &Word<'_>, report: &mut Report<'_>) -> Option<f64> {
        if word.form != Form::Text {
            return values::number(&word.text)
                .map_err(|(what, help)| {
                    let fault = Fault::error(word.place.clone(), format!("`{}` is {what}", word.text));
                    report.add(
                        fault.help(
                            help.unwrap_or("a number, or a formula in quotes, is expected here".into()),
                        ),
                    );
                })
                .ok();
        }
        let mut used = Vec::new();
        let fault = match self.formula(word, &[], &mut used) {
            Ok(_) if used.iter().any(|(_, value)| f64::is_nan(*value)) => return None,
            Ok(formula) => match formula.at(0.0) {
                value if f64::is_finite(value) => return Some(value),
                value => {
                    let what = if value.is_nan() { "not a number" } else { "infinite" };
                    let fault = Fault::error(word.place.clone(), format!("`{}` is {what}", word.text));
                    used.dedup();
                    let values = used.iter().map(|(name, value)| format!("`{name}` is {}", shortest(*value)));
                    let values = values.collect::<Vec<_>>().join(" and ");
                    if values.is_empty() { fault } else { fault.help(format!("here {values}")) }
                }
            },
            Err(fault) => match cures::in_quotes(&word.text, report.syntax()) {
                Some(cure) => Fault::error(
                    word.place.clone(),
                    format!("`{}` is not a formula", word.text.escape_debug()),
                )
                .help(cure),
                None => self.explained(word, fault, report),
            },
        };
        report.add(fault);
        None
    }

    /// Returns a value of an attribute, with formulas and names replaced by numbers.
    pub fn word(&mut self, word: Word<'a>, value_type: Option<Type>, report: &mut Report<'_>) -> Word<'a> {
        match value_type {
            Some(value_type)
                if value_type.is_numeric()
                    && word.form == Form::Text
                    && word.text.parse::<f64>().is_err() =>
            {
                match self.number(&word, report) {
                    Some(number) => Word { text: shortest(number).into(), form: Form::Number, ..word },
                    None => Word { form: Form::Faulty, ..word },
                }
            }
            Some(value_type)
                if value_type.is_numeric() && word.form == Form::Any && self.is_formula_of_names(&word) =>
            {
                let fault = Fault::error(word.place.clone(), format!("`{}` is not in quotes", word.text));
                report.add(fault.help(format!("a formula goes in quotes: `\"{}\"`", word.text)));
                Word { form: Form::Faulty, ..word }
            }
            Some(Type::Formula(variables)) if self.may_name(&word.text, variables) => {
                let mut used = Vec::new();
                match self.formula(&word, variables, &mut used) {
                    Ok(_) if used.is_empty() => word,
                    Ok(_) if used.iter().any(|(_, value)| f64::is_nan(*value)) => {
                        Word { form: Form::Faulty, ..word }
                    }
                    Ok(formula) => Word { text: formula.to_string().into(), ..word },
                    // The attribute explains it.
                    Err(fault) if self.all.is_empty() && fault.unknown.as_deref().is_none_or(is_variable) => {
                        word
                    }
                    Err(fault) => {
                        let fault = self.explained(&word, fault, report);
                        report.add(fault);
                        Word { form: Form::Faulty, ..word }
                    }
                }
            }
            _ => word,
        }
    }

    /// Tells whether a formula may name numbers of the scene, or what is to be explained as unknown.
    fn may_name(&self, formula: &str, variables: &[&str]) -> bool {
        let words = formula.split(|letter| !is_in_name(letter));
        let mut names = words.map(|word| word.trim_start_matches(|letter: char| letter.is_ascii_digit()));
        let is_other = |name: &str| !is_taken(name) && !variables.contains(&name);
        !self.all.is_empty() || names.any(|name| name.starts_with(char::is_alphabetic) && is_other(name))
    }

    /// Tells whether a word without quotes is a named number, or a formula of some.
    fn is_formula_of_names(&self, word: &Word<'_>) -> bool {
        // Most words are numbers.
        let may_name = |letter: char| letter.is_alphabetic() && !matches!(letter, 'e' | 'E');
        self.by_name.contains_key(&*word.text)
            || !self.all.is_empty() && word.text.contains(may_name) && {
                let mut used = Vec::new();
                self.formula(word, &[], &mut used).is_ok() && !used.is_empty()
            }
    }

    /// Parses a word as a formula, and collects the named numbers in it.
    fn formula(
        &self,
        word: &Word<'_>,
        variables: &'static [&'static str],
        used: &mut Vec<(String, f64)>,
    ) -> Result<Formula, FormulaFault> {
        self.named(used, |named| Formula::parse_with(&word.text, variables, named))
    }

    /// Calls a function with the meanings of names, and collects the used names with their numbers. Functions count as
    /// 0, and faulty definitions as NaN.
    fn named<T>(&self, used: &mut Vec<(String, f64)>, parse: impl FnOnce(Named<'_>) -> T) -> T {
        let seen = RefCell::new(used);
        parse(&|name| {
            let value = self.all[*self.by_name.get(name)?].value.clone().unwrap_or(Meant::Number(f64::NAN));
            let number = if let Meant::Number(number) = value { number } else { 0.0 };
            seen.borrow_mut().push((name.to_owned(), number));
            Some(value)
        })
    }

    /// Returns the error of a formula, with a suggestion.
    fn explained(&mut self, word: &Word<'_>, fault: FormulaFault, report: &Report<'_>) -> Fault {
        let mut told = Fault::error(word.within(&fault.place), fault.message);
        let Some(unknown) = fault.unknown else { return told.help(fault.help) };
        let text = self.text;
        if let Some(place) = self.anywhere().get(&unknown) {
            let head = place.clone().and_then(|place| text.get(place));
            let what = if head.is_some_and(|head| head.contains('(')) { "function" } else { "number" };
            told.message = format!("the {what} `{unknown}` is used before it is defined");
            return told
                .also(place.clone(), "defined here")
                .help(format!("a {what} must be defined before it is used"));
        }
        let is_told = report.would_list(Severity::Error, &told.place);
        let is_called = word.text[fault.place.end..].trim_start().starts_with('(');
        let functions = formula::functions().map(|(name, _)| name).filter(|_| is_called);
        if let Some(near) = nearest(&unknown, self.names().chain(functions).filter(|_| is_told)) {
            told = told.label(format!("did you mean `{near}`?")).meant(Some(near));
        } else if !is_called && !is_taken(&unknown) && !is_variable(&unknown) {
            told = told.label(match report.syntax() {
                Syntax::Notes => format!("give it a value first: `let {unknown} 1`"),
                Syntax::Toml => format!("give it a value first: `{unknown} = 1` in `[let]`"),
            });
        }
        let names = list(self.names().take(LISTED));
        let more = if self.all.len() > LISTED { " and others" } else { "" };
        let known = match self.all.len() {
            0 => String::new(),
            1 => format!("; the named number is {names}"),
            _ => format!("; the named numbers are {names}{more}"),
        };
        told.help(format!("{}{known}", fault.help))
    }

    /// Returns the names defined anywhere in the text.
    fn anywhere(&mut self) -> &HashMap<String, Place> {
        let text = self.text;
        self.anywhere.get_or_insert_with(|| {
            let (mut names, nowhere) = (HashMap::new(), &mut Report::default());
            let mut tokens = Tokens::of(text, nowhere);
            while let Some(token) = tokens.step(nowhere) {
                if let (true, Some(name)) = (tokens.raw(token) == "let", tokens.ahead[0]) {
                    let head = tokens.text(name);
                    let called = head.split('(').next().unwrap_or_default().to_owned();
                    names.insert(called, Some(name.place()));
                }
            }
            names
        })
    }
}

/// Tells whether a name is a variable of some formulas.
fn is_variable(name: &str) -> bool {
    SURFACE.contains(&name) || CURVE.contains(&name)
}
