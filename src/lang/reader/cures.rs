//! What people write in place of numbers, and how to write it.

use super::parsed::{Form, Word};
use crate::syntax::Syntax;
use tabray_core::scene::COLOUR;
use tabray_core::scene::attribute::Attribute;
use tabray_core::text::shortest;
use tabray_exact::formula::Formula;

/// Names of colours, and their light.
const COLOURS: [(&str, [f64; 3]); 26] = [
    ("black", [0.0, 0.0, 0.0]),
    ("none", [0.0, 0.0, 0.0]),
    ("white", [1.0, 1.0, 1.0]),
    ("red", [1.0, 0.0, 0.0]),
    ("green", [0.0, 1.0, 0.0]),
    ("blue", [0.0, 0.0, 1.0]),
    ("yellow", [1.0, 1.0, 0.0]),
    ("cyan", [0.0, 1.0, 1.0]),
    ("magenta", [1.0, 0.0, 1.0]),
    ("orange", [1.0, 0.5, 0.0]),
    ("purple", [0.5, 0.0, 0.5]),
    ("pink", [1.0, 0.5, 0.5]),
    ("brown", [0.5, 0.25, 0.1]),
    ("gold", [1.0, 0.75, 0.2]),
    ("silver", [0.75, 0.75, 0.75]),
    ("gray", [0.5, 0.5, 0.5]),
    ("grey", [0.5, 0.5, 0.5]),
    ("navy", [0.0, 0.0, 0.5]),
    ("teal", [0.0, 0.5, 0.5]),
    ("olive", [0.5, 0.5, 0.0]),
    ("maroon", [0.5, 0.0, 0.0]),
    ("lime", [0.0, 1.0, 0.0]),
    ("turquoise", [0.25, 0.88, 0.82]),
    ("violet", [0.93, 0.51, 0.93]),
    ("beige", [0.96, 0.96, 0.86]),
    ("ivory", [1.0, 1.0, 0.94]),
];

/// Words for numbers.
const NUMBERS: [(&str, f64); 16] = [
    ("zero", 0.0),
    ("one", 1.0),
    ("two", 2.0),
    ("three", 3.0),
    ("four", 4.0),
    ("five", 5.0),
    ("six", 6.0),
    ("seven", 7.0),
    ("eight", 8.0),
    ("nine", 9.0),
    ("ten", 10.0),
    ("twelve", 12.0),
    ("twenty", 20.0),
    ("hundred", 100.0),
    ("half", 0.5),
    ("quarter", 0.25),
];

/// Words beside those of [`NUMBERS`].
const WITH_NUMBERS: [&str; 5] = ["a", "and", "minus", "point", "thousand"];

/// Beginnings of the functions that other languages put around the numbers of a colour, a place or a direction.
const FUNCTIONS: [&str; 6] = ["rgb", "col", "vec", "point", "float", "dvec"];

/// Returns how to write what words mean as the values of an attribute that takes numbers, if that is clear.
pub fn cure(attribute: &dyn Attribute, words: &[Word<'_>], syntax: Syntax) -> Option<String> {
    if !attribute.value_type().is_numeric() {
        return None;
    }
    let text = words.iter().map(|word| word.text.as_ref()).collect::<Vec<_>>().join(" ");
    let text = text.trim();
    let write = |numbers: &[f64]| {
        let numbers: Vec<_> = numbers.iter().map(|number| shortest(*number)).collect();
        format!("`{}`", syntax.pair(attribute.name(), &numbers))
    };
    let takes = |count: usize| attribute.arity().allow(count);
    let lower = text.to_lowercase();
    if takes(3)
        && let Some(colour) = colour(text)
    {
        return Some(format!("a colour is its red, green and blue: {}", write(&colour)));
    }
    if let ("yes" | "true" | "on" | "no" | "false" | "off", true) = (&*lower, takes(1)) {
        let number = f64::from(u8::from(matches!(&*lower, "yes" | "true" | "on")));
        return Some(format!("write {}", write(&[number])));
    }
    // `4x4` samples are 16.
    if let (true, Some((across, up))) = (attribute.name() == "samples", lower.split_once(['x', '*']))
        && let (Ok(across), Ok(up)) = (across.parse::<u16>(), up.parse::<u16>())
    {
        return Some(format!("{across} x {up} samples are {}", write(&[f64::from(across) * f64::from(up)])));
    }
    let is_colour = takes(3) && attribute.each() == COLOUR;
    if let (true, false, Some([level])) = (is_colour, takes(1), numbers(text).as_deref()) {
        return Some(format!("a grey is three equal numbers: {}", write(&[*level; 3])));
    }
    if let ("scale" | "size", true, false, Some([length])) =
        (attribute.name(), takes(3), takes(1), numbers(text).as_deref())
    {
        return Some(format!("the same along each axis is {}", write(&[*length; 3])));
    }
    if let (true, [word]) = (is_colour, words)
        && !takes(1)
        && Formula::parse_in(&word.text, &[]).is_ok()
    {
        let level = format!("\"{}\"", word.text);
        let pair = syntax.pair(attribute.name(), &[level.clone(), level.clone(), level]);
        return Some(format!("a formula goes in quotes, and a grey is three equal numbers: `{pair}`"));
    }
    if is_colour && words.iter().all(|word| word.form != Form::Text && is_name(&word.text)) {
        let such = write(&[0.8, 0.5, 0.2]);
        return Some(format!(
            "a colour is its red, green and blue, such as {such}; the name of a material goes after `material`"
        ));
    }
    // What is written as numbers are is not cured by writing it so, and percentages are told one by one.
    let are_numbers = words.iter().all(|word| word.text.trim_end_matches('%').parse::<f64>().is_ok());
    let numbers = numbers(text).filter(|numbers| !are_numbers && takes(numbers.len()))?;
    let is_levels = lower.starts_with("rgb") && numbers.iter().any(|number| *number > 1.0);
    let numbers = match is_levels {
        true => numbers.iter().map(|level| (level / 255.0 * 1000.0).round() / 1000.0).collect(),
        false => numbers,
    };
    Some(format!("write {}", write(&numbers)))
}

/// Returns how to write what a text in quotes means in place of a formula.
pub fn in_quotes(text: &str, syntax: Syntax) -> Option<String> {
    let (numbers, what) = match colour(text) {
        Some(colour) => (colour.to_vec(), "a colour is its red, green and blue"),
        None => {
            let is_plain =
                |numbers: &Vec<f64>| numbers.len() > 1 || text.ends_with('%') || is_of_a_number(text);
            (numbers(text).filter(is_plain)?, "write numbers without quotes")
        }
    };
    let numbers: Vec<_> = numbers.iter().map(|number| shortest(*number)).collect();
    Some(match syntax {
        Syntax::Notes => format!("{what}: `{}`", numbers.join(" ")),
        Syntax::Toml if numbers.len() == 1 => format!("{what}: `{}`", numbers[0]),
        Syntax::Toml => format!("{what}: `[{}]`", numbers.join(", ")),
    })
}

/// Tells whether a word may be the name of an entity.
fn is_name(word: &str) -> bool {
    word.starts_with(char::is_alphabetic)
        && word.chars().all(|letter| letter.is_alphanumeric() || letter == '_')
}

/// Returns the light of a colour by its name, dark or light, or written as `#ff8000`.
fn colour(text: &str) -> Option<[f64; 3]> {
    let lower = text.to_lowercase();
    let named = |name: &str| {
        let name = name.trim_start_matches([' ', '-', '_']);
        COLOURS.iter().find(|(known, _)| *known == name).map(|(_, colour)| *colour)
    };
    let dark = || Some(named(lower.strip_prefix("dark")?)?.map(|level| level / 2.0));
    let light = || Some(named(lower.strip_prefix("light")?)?.map(|level| f64::midpoint(level, 1.0)));
    if let Some(colour) = named(&lower).or_else(dark).or_else(light) {
        return Some(colour);
    }
    let digits = text.strip_prefix('#').or(text.strip_prefix("0x"))?;
    let level = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    let levels = (digits.len() == 6).then(|| [level(0), level(2), level(4)])?;
    let [Some(red), Some(green), Some(blue)] = levels else { return None };
    Some([red, green, blue].map(|level| (f64::from(level) / 255.0 * 1000.0).round() / 1000.0))
}

/// Tells whether a word belongs to a number in words.
pub fn is_of_a_number(word: &str) -> bool {
    NUMBERS.iter().any(|(name, _)| *name == word) || WITH_NUMBERS.contains(&word)
}

/// Reads a number: in digits, also with the `f` of other languages, or as a word.
fn number(word: &str) -> Option<f64> {
    let digits = word.strip_suffix('f').filter(|digits| digits.ends_with(|last: char| last.is_ascii_digit()));
    let named =
        || NUMBERS.iter().find(|(name, _)| word.eq_ignore_ascii_case(name)).map(|(_, number)| *number);
    digits.unwrap_or(word).parse().ok().or_else(named)
}

fn is_function(word: &str) -> bool {
    let lower = word.to_lowercase();
    word.chars().all(char::is_alphanumeric) && FUNCTIONS.iter().any(|function| lower.starts_with(function))
}

/// Reads numbers that are joined by commas, brackets, an `x`, a `*` or the word of a function, whose minus is another
/// sign or stands apart, or that are percentages or words.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let text = text.replace(['\u{2212}', '\u{2013}', '\u{2014}'], "-").replace('\u{d7}', "x");
    let text = text.replace(" %", "%").replace(" by ", "x").replace(" and ", " ").replace("minus ", "- ");
    let body = match text.split_once(['(', '[', '<', '{']) {
        Some((before, body)) if before.is_empty() || is_function(before) => body,
        Some(_) => return None,
        None => &text,
    };
    let body = body.trim_end_matches([')', ']', '>', '}', ';', ',']);
    // A product beside another number is a formula.
    let is_product = body.contains('*')
        && !body.starts_with('*')
        && !body.ends_with('*')
        && !body.replace(" *", "*").replace("* ", "*").contains(' ');
    let has_words = body.contains(|letter: char| letter.is_alphabetic() && !"xXeEf".contains(letter));
    let is_between = |letter: char| match letter {
        ',' | ';' => true,
        'x' | 'X' => !has_words,
        '*' => is_product,
        _ => letter.is_whitespace(),
    };
    let (mut numbers, mut is_minus) = (Vec::new(), false);
    for word in body.split(is_between).filter(|word| !word.is_empty()) {
        if word == "-" && !is_minus {
            is_minus = true;
            continue;
        }
        let number: f64 = match word.strip_suffix('%') {
            Some(percent) => percent.parse::<f64>().ok()? / 100.0,
            None => number(word)?,
        };
        numbers.push(if is_minus { -number } else { number });
        is_minus = false;
    }
    (!is_minus && !numbers.is_empty() && numbers.iter().all(|number| number.is_finite())).then_some(numbers)
}
