//! The errors and warnings of a scene of numbers, in its own terms.

use super::codes::{Numbers, PROJECTOR, Rule, UNREAD, VIEWPOINT};
use super::rows::{Number, Row};
use crate::reader::fault::Fault;
use std::ops::Range;
use tabray_core::text::shortest;

/// The ordinals of a line's numbers in messages.
const COUNTED: [&str; 3] = ["first", "second", "third"];

/// Warns of a skipped line with an unexpected beginning.
pub fn skipped(row: &Row<'_>, expected: &str) -> Fault {
    Fault::warning(Some(row.place()), format!("this line begins with no {expected}, and is skipped"))
}

/// Warns of a scene without its first two lines.
pub fn fragment(place: Range<usize>, ([width, height], [x, y, z]): ([f64; 2], [f64; 3])) -> Fault {
    Fault::warning(
        Some(place),
        "this scene is a fragment: the lines of the world size and of the viewpoint are missing",
    )
    .label(format!("read as after `{width} {height}` and `{x} {y} {z}`, which most scenes begin with"))
}

/// Reports a code that has another meaning in this scene than in others.
pub fn other_numbering(code: &Number) -> Fault {
    let message = "this scene has a different numbering, which is not read";
    let label = match code.code() {
        Some(PROJECTOR) => "12 is a plane there, and a projector in the numbering that is read",
        _ => "a light has a radius there, and none in the numbering that is read",
    };
    Fault::error(Some(code.place.clone()), message).label(label).help(
        "the codes that are read are 10 light, 11 spotlight, 13 sphere, 14 to 17 planes, 19 and 20 procedural, 21 to 23, \
         and 25 to 28",
    )
}

/// Reports a code with unknown lines.
pub fn unread(code: u32, place: Range<usize>) -> Option<Fault> {
    let (_, message) = UNREAD.iter().find(|(unread, _)| *unread == code)?;
    Some(Fault::error(Some(place), *message).help("leave its lines out"))
}

/// The current object, for messages: its name, the place of its code, and the description of the lines after the code.
pub struct Context {
    pub name: &'static str,
    pub place: Option<Range<usize>>,
    pub usage: String,
}

impl Context {
    fn fault(&self, place: Range<usize>, message: String) -> Fault {
        let fault = Fault::error(Some(place), message).help(self.usage.clone());
        match &self.place {
            Some(place) if self.name != "scene" => {
                fault.also(Some(place.clone()), format!("the {} begins here", self.name))
            }
            _ => fault,
        }
    }
}

/// Reports the end of the text in place of a line.
pub fn ends_early(line: &str, context: &Context, end: usize) -> Fault {
    let fault = context.fault(end..end, format!("the {line} of this {} is missing", context.name));
    fault.label("the text ends here")
}

/// Reports a line with too few numbers.
pub fn too_few(line: &Numbers, row: &Row<'_>, count: usize, begins_object: bool, context: &Context) -> Fault {
    let Numbers { name, count: expected, .. } = line;
    if begins_object {
        let fault = context.fault(row.place(), format!("the {name} of this {} is missing", context.name));
        return fault.label("another object begins here");
    }
    let numbers = if *expected == 1 { "number" } else { "numbers" };
    let message = format!("the {name} of this {} has {expected} {numbers}, not {count}", context.name);
    let next = COUNTED.get(count).copied().unwrap_or("next");
    context.fault(row.place(), message).label(format!("the {next} number is missing"))
}

/// Reports a number with invalid characters after it, or one that is too large.
pub fn unlike_a_number(row: &Row<'_>, value: &Number) -> Option<Fault> {
    let place = value.place.clone();
    if value.value.is_infinite() {
        return Some(Fault::error(Some(place), "this number is too large").help("the largest is 1.8e308"));
    }
    let more = row.more_digits(value)?;
    let place = place.start..place.end + more.len();
    let fault = Fault::error(Some(place), "this is not one number");
    Some(fault.help("a number has a `.` before its fraction, and white space after it"))
}

/// Reports numbers that break their rule.
pub fn against_rule(line: &Numbers, values: &[Number], context: &Context) -> Option<Fault> {
    let (must, is_bad): (_, fn(f64) -> bool) = match line.rule {
        Rule::Point if line.name == VIEWPOINT.name => {
            ("off the screen: its z must not be 0", |value| value == 0.0)
        }
        Rule::Any | Rule::Direction | Rule::Point => ("", |_| false),
        Rule::Lengths => ("positive", |value| value <= 0.0),
        Rule::Fraction => ("from 0, opaque, to 1", |value| !(0.0..=1.0).contains(&value)),
        Rule::Angle => ("above 0 and at most 180 degrees", |value| !(value > 0.0 && value <= 180.0)),
        Rule::Mode => {
            ("1, which fits the texture, or 2, which tiles it", |value| ![1.0, 2.0].contains(&value))
        }
    };
    let Numbers { name, count, .. } = line;
    if line.rule == Rule::Direction && values.iter().all(|value| value.value == 0.0) {
        let place = values.first()?.place.start..values.last()?.place.end;
        return Some(context.fault(place, format!("the {name} of this {} must not be 0 0 0", context.name)));
    }
    // Of a point, only the last number counts.
    let first = if line.rule == Rule::Point { values.len() - 1 } else { 0 };
    let at = first + values[first..].iter().position(|value| is_bad(value.value))?;
    let value = &values[at];
    let message = match line.rule {
        Rule::Point => format!("the {name} of this {} must be {must}", context.name),
        _ => {
            let which = if *count > 1 { format!("the {} number of ", COUNTED[at]) } else { String::new() };
            let not = shortest(value.value);
            format!("{which}the {name} of this {} must be {must}, not {not}", context.name)
        }
    };
    Some(context.fault(value.place.clone(), message))
}
