//! The columns of answers: JSON, CSV, NumPy's arrays and the Python package are all written from one table.

use serde::ser::{Serialize, SerializeMap, Serializer};
use tabray_core::query::{Answer, Query, Surroundings, Verdict};
use tabray_core::text;
use tabray_core::world::certify::Precision;

/// An answer, with all that is known about it.
pub struct Answered<'q, 'm> {
    /// The scene that was asked.
    pub query: &'q Query<'m>,
    /// The index of the ray, where a ray may have several answers.
    pub ray: Option<u64>,
    /// The answer.
    pub answer: Answer,
    /// Whether the ray enters a closed object, where it may have several answers.
    pub enters: Option<bool>,
    /// The surface at the hit.
    pub surface: Option<Surroundings>,
}

/// A column of answers.
struct Column {
    /// The name in JSON, and in CSV but for vectors.
    name: &'static str,
    /// The name in arrays; `None` if they do not have the column.
    array: Option<&'static str>,
    value: Value,
}

/// The value of a column. In text, what there is not is left out, and so are numbers that are not finite.
enum Value {
    /// A word, which is a number in arrays.
    Word(fn(&Answer) -> (&'static str, u8)),
    /// The name of an object, which arrays do not have.
    Name(for<'a> fn(&'a Answered) -> Option<&'a str>),
    /// An index; -1 in arrays where there is none.
    Index(fn(&Answered) -> Option<u64>),
    /// Yes or no, which arrays do not have.
    Flag(fn(&Answered) -> Option<bool>),
    /// A number; NaN or infinite in arrays where there is none.
    Number(fn(&Answer) -> f64),
    /// A fraction, where it is below 1; 1 in arrays where there is none.
    Part(fn(&Surroundings) -> Option<f64>),
    /// Numbers with these names in CSV, at most three; NaN in arrays where there are none.
    Vector(&'static [&'static str], fn(&Surroundings) -> Option<[f64; 3]>),
}

impl Column {
    const fn both(name: &'static str, value: Value) -> Self {
        Self { name, array: Some(name), value }
    }

    const fn text(name: &'static str, value: Value) -> Self {
        Self { name, array: None, value }
    }
}

/// The columns in the order of JSON and of arrays.
static COLUMNS: [Column; 16] = [
    Column::text(RAY, Value::Index(|of| of.ray)),
    Column::both("verdict", Value::Word(|of| verdict(of.verdict))),
    Column::both("proof", Value::Word(|of| proof(of.proof))),
    Column::text("object", Value::Name(object)),
    Column { array: Some("object"), ..Column::text("number", Value::Index(number)) },
    Column::both("face", Value::Index(|of| of.surface?.face.map(u64::from))),
    Column::text(ENTERS, Value::Flag(|of| of.enters)),
    Column::both("t", Value::Number(|of| of.t)),
    Column::both("t_low", Value::Number(|of| of.bounds.low)),
    Column::both("t_high", Value::Number(|of| of.bounds.high)),
    Column::both("distance", Value::Number(|of| of.distance)),
    Column::both("point", Value::Vector(&["x", "y", "z"], |at| Some(at.point.to_array()))),
    Column::both("normal", Value::Vector(&["nx", "ny", "nz"], |at| Some(at.normal.to_array()))),
    Column::both("uv", Value::Vector(&["u", "v"], |at| at.uv.map(|uv| [uv.x, uv.y, f64::NAN]))),
    Column::both("surface", Value::Index(|of| Some(of.query.surface(&of.answer)? as u64))),
    Column::both("coverage", Value::Part(|at| at.coverage)),
];

/// The columns that answers have only where a ray may have several. They are the first ones of CSV.
const RAY: &str = "ray";
const ENTERS: &str = "enters";

/// Returns the columns in the order of CSV.
fn of_csv(are_all: bool) -> impl Iterator<Item = &'static Column> {
    let is_of_all = |column: &&Column| [RAY, ENTERS].contains(&column.name);
    let of_all = COLUMNS.iter().filter(move |column| are_all && is_of_all(column));
    of_all.chain(COLUMNS.iter().filter(move |column| !is_of_all(column)))
}

/// Returns the first line of CSV.
pub(super) fn csv_names(are_all: bool) -> Vec<&'static str> {
    let names = |column: &'static Column| match &column.value {
        Value::Vector(names, _) => *names,
        _ => std::slice::from_ref(&column.name),
    };
    of_csv(are_all).flat_map(names).copied().collect()
}

/// Returns the name and the number of a verdict.
pub fn verdict(of: Verdict) -> (&'static str, u8) {
    match of {
        Verdict::Miss => ("miss", 0),
        Verdict::Hit => ("hit", 1),
        Verdict::Edge => ("edge", 2),
        Verdict::Tie => ("tie", 3),
        Verdict::Undecided => ("undecided", 4),
    }
}

/// Returns the words for a proof, and the number of its bits.
fn proof(of: Option<Precision>) -> (&'static str, u8) {
    match of {
        None => ("none", 0),
        Some(Precision::Double) => ("53 bits", 53),
        Some(Precision::Octuple) => ("237 bits", 237),
    }
}

fn object<'a>(of: &'a Answered) -> Option<&'a str> {
    of.answer.object.map(|index| of.query.model().objects[index].args.name())
}

fn number(of: &Answered) -> Option<u64> {
    of.answer.object.map(|index| of.query.number(index) as u64)
}

/// The value of a column of arrays.
#[derive(Clone, Copy, Debug)]
pub enum Cell {
    /// The number of a word.
    Word(u8),
    /// An index, or -1.
    Index(i32),
    /// A number.
    Number(f64),
    /// As many of the numbers as this.
    Vector([f64; 3], usize),
}

impl Cell {
    /// Returns the type of the column, as NumPy writes it.
    fn descr(self, name: &str) -> String {
        match self {
            Self::Word(_) => format!("('{name}', '|u1')"),
            Self::Index(_) => format!("('{name}', '<i4')"),
            Self::Number(_) => format!("('{name}', '<f8')"),
            Self::Vector(_, width) => format!("('{name}', '<f8', ({width},))"),
        }
    }

    /// Appends the bytes of the value.
    pub(super) fn write(self, out: &mut Vec<u8>) {
        match self {
            Self::Word(code) => out.push(code),
            Self::Index(index) => out.extend_from_slice(&index.to_le_bytes()),
            Self::Number(number) => out.extend_from_slice(&number.to_le_bytes()),
            Self::Vector(numbers, width) => {
                numbers[..width].iter().for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
            }
        }
    }
}

/// Returns the names of the columns of arrays, each with the value of an answer that does not have it.
pub fn of_arrays() -> impl Iterator<Item = (&'static str, Cell)> {
    COLUMNS.iter().filter_map(|column| Some((column.array?, column.value.cell(None)?)))
}

/// Returns the type of a record of an array, as NumPy writes it.
pub(super) fn record() -> String {
    let columns: Vec<_> = of_arrays().map(|(name, absent)| absent.descr(name)).collect();
    format!("[{}]", columns.join(", "))
}

impl Value {
    /// Returns the value in an array, if arrays have it.
    fn cell(&self, of: Option<&Answered>) -> Option<Cell> {
        Some(match self {
            Self::Word(word) => Cell::Word(of.map_or(0, |of| word(&of.answer).1)),
            Self::Index(index) => Cell::Index(of.and_then(index).map_or(-1, |index| index as i32)),
            Self::Number(number) => Cell::Number(of.map_or(f64::NAN, |of| number(&of.answer))),
            Self::Part(part) => {
                let part = of.and_then(|of| part(of.surface.as_ref()?));
                Cell::Number(part.unwrap_or(1.0))
            }
            Self::Vector(names, vector) => {
                let numbers = of.and_then(|of| vector(of.surface.as_ref()?));
                Cell::Vector(numbers.unwrap_or([f64::NAN; 3]), names.len())
            }
            Self::Name(_) | Self::Flag(_) => return None,
        })
    }
}

impl Answered<'_, '_> {
    /// Returns the values of the columns of arrays, in the order of [`of_arrays`].
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        COLUMNS
            .iter()
            .filter(|column| column.array.is_some())
            .filter_map(|column| column.value.cell(Some(self)))
    }

    /// Returns the fields of a line of CSV.
    pub(super) fn fields(&self) -> Vec<String> {
        fn written<T: ToString>(value: Option<T>) -> String {
            value.map_or(String::new(), |value| value.to_string())
        }
        let mut fields = Vec::new();
        for column in of_csv(self.ray.is_some()) {
            match &column.value {
                Value::Word(word) => fields.push(word(&self.answer).0.to_owned()),
                Value::Name(name) => fields.push(text::visible(name(self).unwrap_or_default()).into_owned()),
                Value::Index(index) => fields.push(written(index(self))),
                Value::Flag(flag) => fields.push(written(flag(self))),
                Value::Number(number) => fields.push(written(finite(number(&self.answer)))),
                Value::Part(part) => fields.push(written(self.surface.as_ref().and_then(part))),
                Value::Vector(names, vector) => {
                    let numbers = self.surface.as_ref().and_then(vector);
                    fields.extend((0..names.len()).map(|at| written(numbers.map(|numbers| numbers[at]))));
                }
            }
        }
        fields
    }
}

/// Returns a number as text has it.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// As a JSON object.
impl Serialize for Answered<'_, '_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        fn entry<M: SerializeMap>(
            map: &mut M,
            name: &str,
            value: Option<impl Serialize>,
        ) -> Result<(), M::Error> {
            value.map_or(Ok(()), |value| map.serialize_entry(name, &value))
        }
        let mut map = to.serialize_map(None)?;
        for Column { name, value, .. } in &COLUMNS {
            match value {
                Value::Word(word) => map.serialize_entry(name, word(&self.answer).0)?,
                Value::Name(of) => entry(&mut map, name, of(self))?,
                Value::Index(index) => entry(&mut map, name, index(self))?,
                Value::Flag(flag) => entry(&mut map, name, flag(self))?,
                Value::Number(number) => entry(&mut map, name, finite(number(&self.answer)))?,
                Value::Part(part) => entry(&mut map, name, self.surface.as_ref().and_then(part))?,
                Value::Vector(names, vector) => {
                    let numbers = self.surface.as_ref().and_then(vector);
                    entry(&mut map, name, numbers.as_ref().map(|numbers| &numbers[..names.len()]))?;
                }
            }
        }
        map.end()
    }
}
