//! Reads the answers of an earlier run, at whose hits rays start.

use super::columns;
use super::npy;
use super::rays::{BadRay, Input, next_line, numbered};
use serde::Deserialize;
use std::io::Read;
use tabray_core::output::npy::MAGIC;
use tabray_core::text::reason;

/// The surface of a hit: the number of its object and that of the object's surface, as
/// [`Query::start`](tabray_core::query::Query::start) takes them.
pub type HitSurface = [usize; 2];

/// Reads answers one after the other, in any format in which they are written.
pub struct StartReader<'r> {
    input: Input<'r>,
    form: Form,
    /// The number of the last line or row.
    number: u64,
    is_over: bool,
}

/// The form of an answer.
enum Form {
    Json,
    /// The columns of the two numbers.
    Csv([usize; 2]),
    /// Records of this many bytes, with the two numbers at these of them, and the number of records that are left.
    Npy {
        size: usize,
        at: [usize; 2],
        left: u64,
    },
}

/// The names of the two numbers in text, and in arrays.
const IN_TEXT: [&str; 2] = ["number", "surface"];
const IN_ARRAYS: [&str; 2] = ["object", "surface"];

#[derive(Deserialize)]
struct Json {
    verdict: Option<String>,
    number: Option<usize>,
    surface: Option<usize>,
}

impl<'r> StartReader<'r> {
    /// Starts to read answers. The first bytes tell their format.
    ///
    /// # Errors
    /// Returns an error where the input cannot be read, or where its header is not that of answers.
    pub fn new(mut input: Input<'r>) -> Result<Self, BadRay> {
        let bad = |number, unit, message| BadRay { number, unit, message, is_last: true };
        let head = std::io::BufRead::fill_buf(&mut input).map_err(|error| bad(1, "line", reason(&error)))?;
        let mut number = 0;
        let form = if head.starts_with(MAGIC) {
            records(&mut input).map_err(|message| bad(1, "row", message))?
        } else if head.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{') {
            Form::Json
        } else {
            let names = next_line(&mut input, &mut number, false).transpose();
            let names = names.map_err(|(message, _)| bad(number, "line", message))?.unwrap_or_default();
            let names = fields(&names);
            let columns = IN_TEXT.map(|name| names.iter().position(|known| known == name));
            let [Some(object), Some(surface)] = columns else {
                let message = "the first line lacks `number` or `surface`: give what `tabray hits` wrote";
                return Err(bad(number, "line", message.to_owned()));
            };
            Form::Csv([object, surface])
        };
        Ok(Self { input, form, number, is_over: false })
    }

    fn surface(&mut self) -> Option<Result<Option<HitSurface>, (String, bool)>> {
        if let Form::Npy { size, at, left } = &mut self.form {
            *left = left.checked_sub(1)?;
            self.number += 1;
            return Some(record(&mut self.input, *size, *at));
        }
        let line = match next_line(&mut self.input, &mut self.number, false)? {
            Ok(line) => line,
            Err(fault) => return Some(Err(fault)),
        };
        let surface = match &self.form {
            Form::Csv(columns) => of_record(&line, columns),
            _ => of_json(&line),
        };
        Some(surface.map_err(|message| (message, false)))
    }
}

impl Iterator for StartReader<'_> {
    type Item = Result<Option<HitSurface>, BadRay>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let surface = self.surface()?;
        let unit = if matches!(self.form, Form::Npy { .. }) { "row" } else { "line" };
        Some(numbered(surface, (unit, self.number), &mut self.is_over))
    }
}

/// Reads the header of an array of answers.
fn records(input: &mut Input<'_>) -> Result<Form, String> {
    let head = npy::head(input).map_err(|_| "it is not a NumPy array".to_owned())?;
    let shape = npy::value(&head, "shape").unwrap_or_default();
    let left = shape.strip_prefix('(').and_then(|shape| shape.strip_suffix(",)")?.parse().ok());
    let (true, Some(left)) = (head.contains(&columns::record()), left) else {
        return Err("it is no array of answers, as `tabray hits -o answers.npy` writes it".to_owned());
    };
    let (mut record, mut at) = (Vec::new(), [0; 2]);
    for (name, absent) in columns::of_arrays() {
        if let Some(index) = IN_ARRAYS.iter().position(|known| *known == name) {
            at[index] = record.len();
        }
        absent.write(&mut record);
    }
    Ok(Form::Npy { size: record.len(), at, left })
}

fn record(input: &mut Input<'_>, size: usize, at: [usize; 2]) -> Result<Option<HitSurface>, (String, bool)> {
    let mut bytes = vec![0; size];
    input.read_exact(&mut bytes).map_err(|error| npy::unread(&error))?;
    let number = |at: usize| {
        let number = bytes[at..].first_chunk().map(|bytes| i32::from_le_bytes(*bytes));
        number.and_then(|number| usize::try_from(number).ok())
    };
    Ok(number(at[0]).zip(number(at[1])).map(<[usize; 2]>::from))
}

/// Returns the fields of a line of CSV, in which names of objects may be in quotes.
fn fields(line: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
    record.iter().map(|field| field.trim().to_owned()).collect()
}

fn of_record(line: &str, columns: &[usize; 2]) -> Result<Option<HitSurface>, String> {
    let fields = fields(line);
    let number = |column: usize| match fields.get(column).map(String::as_str) {
        None | Some("") => Ok(None),
        Some(word) => word.parse().map(Some).map_err(|_| "it is no answer of `tabray hits`".to_owned()),
    };
    Ok(number(columns[0])?.zip(number(columns[1])?).map(<[usize; 2]>::from))
}

fn of_json(line: &str) -> Result<Option<HitSurface>, String> {
    let answer: Json = serde_json::from_str(line).map_err(|error| error.to_string())?;
    match answer.verdict {
        None => Err("it is no answer of `tabray hits`".to_owned()),
        Some(_) => Ok(answer.number.zip(answer.surface).map(<[usize; 2]>::from)),
    }
}
