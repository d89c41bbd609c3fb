//! Reads words as the values of an attribute.

use super::fault::Fault;
use super::parsed::{Form, Word};
use std::borrow::Cow;
use std::sync::Arc;
use tabray_core::scene::choice::Choices;
use tabray_core::scene::value::{Datum, Type};
use tabray_core::text::{self, nearest, shortest};
use tabray_exact::decimal::{self, DecimalFault};
use tabray_exact::formula::Formula;

/// Reads words as values of a type.
///
/// # Errors
/// Returns an error for each word that is not a value of the type.
pub fn read(value_type: Type, words: &[Word<'_>]) -> Result<Datum, Vec<Fault>> {
    match value_type {
        Type::Whole => all(words, whole).map(Datum::Whole),
        Type::Number | Type::Rotation => all(words, number).map(Datum::Numbers),
        Type::Word | Type::File | Type::Name(_) => words.first().ok_or_else(Vec::new).and_then(text),
        Type::Formula(variables) => {
            let mut formulas = Vec::with_capacity(words.len());
            for word in words {
                formulas.push(formula(word, variables)?);
            }
            Ok(match formulas.pop() {
                Some(formula) if formulas.is_empty() => Datum::Formula(formula),
                last => Datum::Formulas(formulas.into_iter().chain(last).collect()),
            })
        }
        Type::Truth => words.first().ok_or_else(Vec::new).and_then(truth),
        Type::Choice(choices) => words.first().ok_or_else(Vec::new).and_then(|word| choice(choices, word)),
    }
}

fn text(word: &Word<'_>) -> Result<Datum, Vec<Fault>> {
    let fault = |what| Fault::error(word.place.clone(), format!("`{}` {what}", word.text.escape_debug()));
    if word.form == Form::Number {
        return Err(vec![
            fault("is a number, not a word").help(format!("put it in quotes: \"{}\"", word.text)),
        ]);
    }
    if word.text.contains(char::is_control) {
        return Err(vec![
            fault("contains a newline or another control character")
                .help("a word must not contain control characters"),
        ]);
    }
    Ok(Datum::Word(word.text.to_string()))
}

fn truth(word: &Word<'_>) -> Result<Datum, Vec<Fault>> {
    match (word.text.as_ref(), word.form) {
        ("yes", Form::Any | Form::Text) | ("true", Form::Truth) => Ok(Datum::Truth(true)),
        ("no", Form::Any | Form::Text) | ("false", Form::Truth) => Ok(Datum::Truth(false)),
        _ => {
            let message = format!("`{}` is neither `yes` nor `no`", word.text);
            Err(vec![Fault::error(word.place.clone(), message)])
        }
    }
}

fn formula(word: &Word<'_>, variables: &'static [&'static str]) -> Result<Arc<Formula>, Vec<Fault>> {
    Formula::parse_in(&word.text, variables)
        .map(Arc::new)
        .map_err(|fault| vec![Fault::error(word.within(&fault.place), fault.message).help(fault.help)])
}

fn choice(choices: Choices, word: &Word<'_>) -> Result<Datum, Vec<Fault>> {
    // A quoted word is not a number.
    let number = word.text.parse().ok().filter(|_| word.form != Form::Text);
    let chosen = number.and_then(|number| choices.numbered(number)).or_else(|| choices.named(&word.text));
    chosen.map(Datum::Choice).ok_or_else(|| {
        let mut fault =
            Fault::error(word.place.clone(), format!("there is no {} `{}`", choices.what, word.text))
                .help(format!("the {} are {}", text::plural(choices.what), choices.listed()));
        if let Some(near) = nearest(&word.text, choices.all().iter().map(|choice| choice.name)) {
            fault = fault.label(format!("did you mean `{near}`?")).meant(Some(near));
        }
        vec![fault]
    })
}

/// The error of a word, and its correction, if known.
pub type ValueError = (&'static str, Option<Cow<'static, str>>);

fn all<T>(words: &[Word<'_>], read: fn(&str) -> Result<T, ValueError>) -> Result<Vec<T>, Vec<Fault>> {
    let mut values = Vec::with_capacity(words.len());
    let mut faults = Vec::new();
    for word in words {
        let value = match word.form {
            Form::Text => Err(("in quotes", Some("write numbers without quotes".into()))),
            Form::Any | Form::Number | Form::Truth | Form::Faulty => read(&word.text),
        };
        match value {
            Ok(value) => values.push(value),
            Err((what, help)) => {
                let fault = Fault::error(word.place.clone(), format!("`{}` is {what}", word.text));
                faults.push(Fault { help: help.map(Cow::into_owned), ..fault });
            }
        }
    }
    if faults.is_empty() { Ok(values) } else { Err(one_for_all(faults)) }
}

/// Merges several errors into one, if they are alike.
fn one_for_all(mut faults: Vec<Fault>) -> Vec<Fault> {
    let [first, .., last] = &faults[..] else { return faults };
    let parts = |fault: &Fault| {
        let (word, what) = fault.message.rsplit_once("` is ")?;
        Some((format!("{word}`"), what.to_owned(), fault.help.clone()))
    };
    let Some(parts) = faults.iter().map(parts).collect::<Option<Vec<_>>>() else { return faults };
    if parts.iter().any(|(_, what, help)| (what, help) != (&parts[0].1, &parts[0].2)) {
        return faults;
    }
    let words: Vec<_> = parts.iter().map(|(word, ..)| word.as_str()).collect();
    let what = &parts[0].1;
    let what = what.strip_prefix("not a ").map_or(what.clone(), |noun| format!("not {noun}s"));
    let message = format!("{} are {what}", text::and(&words));
    let place = first.place.as_ref().zip(last.place.as_ref()).map(|(first, last)| first.start..last.end);
    faults.truncate(1);
    (faults[0].message, faults[0].place) = (message, place);
    faults
}

/// Reads an integer.
pub fn whole(word: &str) -> Result<i64, ValueError> {
    word.parse().map_err(|_| {
        let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
        let too_large = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        let unit = word.trim_start_matches(|letter: char| letter.is_ascii_digit());
        let has_unit = unit.len() < word.len() && unit.chars().all(char::is_alphabetic) && !too_large;
        let help = if has_unit { meant(word) } else { None };
        (if too_large { "too large" } else { "not a whole number" }, help)
    })
}

/// Reads a finite number.
pub fn number(word: &str) -> Result<f64, ValueError> {
    decimal::read(word).map_err(|fault| {
        let help = match fault {
            DecimalFault::NotANumber => meant(word),
            fault => fault.help().map(Cow::Borrowed),
        };
        (fault.what(), help)
    })
}

/// Returns a suggestion for a word that is not a number.
fn meant(word: &str) -> Option<Cow<'static, str>> {
    let end = word.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(word.len());
    let (number, unit) = word.split_at(end);
    let has_unit = !unit.is_empty() && unit.chars().all(|c| c.is_alphabetic() || "°%'".contains(c));
    Some(match (number.parse::<f64>(), unit) {
        (Ok(percent), "%") => format!("write {percent} percent as `{}`", shortest(percent / 100.0)).into(),
        (Ok(_), _) if has_unit => format!("numbers have no units: write `{number}`").into(),
        _ if word.contains(',') => "separate values by white space, and write decimals with a point".into(),
        _ if word.contains('#') => "put white space before the `#` of a comment".into(),
        _ if Formula::parse_in(word, &[]).is_ok() => format!("a formula goes in quotes: `\"{word}\"`").into(),
        _ => return None,
    })
}
