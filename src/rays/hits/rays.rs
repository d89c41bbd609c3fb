//! Reads rays.

use super::npy::{self, Numbers};
use super::starts::{HitSurface, StartReader};
use glam::DVec3;
use serde::Deserialize;
use std::fmt;
use std::io::{BufRead, BufReader, Read};
use tabray_core::output;
use tabray_core::query::QueryRay;
use tabray_core::text::reason;

/// The maximum length of a line, in bytes: more than any six numbers have.
const LONGEST: u64 = 1 << 12;

/// The formats of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "commands", derive(clap::ValueEnum))]
pub enum RayFormat {
    /// Six or seven numbers per line
    ///
    /// These are the origin, the direction, and the t at which the ray ends. `#` begins a comment.
    Text,
    /// A line of names, and lines of values
    ///
    /// The names are `ox`, `oy`, `oz`, `dx`, `dy`, `dz`, and `t_max` where rays end.
    Csv,
    /// A JSON object or list per line
    ///
    /// An object is `{"origin": [x, y, z], "direction": [x, y, z], "t_max": t}`. A list has the numbers as in text.
    #[cfg_attr(feature = "commands", value(name = "jsonl"))]
    JsonLines,
    /// A NumPy array
    ///
    /// Its shape is (n, 6) or (n, 7), and its type `f8` or `f4`.
    Npy,
}

/// A ray, and the t at which it ends, if it does.
#[derive(Clone, Debug)]
pub struct RayRow {
    /// The ray.
    pub ray: QueryRay,
    /// The end, in lengths of its direction.
    pub t_max: Option<f64>,
    /// The surface that it leaves, if that is told.
    pub leaves: Option<HitSurface>,
}

/// An invalid ray.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadRay {
    /// Its line, or its row in an array, from 1.
    pub number: u64,
    /// `line` or `row`.
    pub unit: &'static str,
    /// The fault, in lower case.
    pub message: String,
    /// Whether nothing can be read after it.
    pub is_last: bool,
}

impl fmt::Display for BadRay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.unit, self.number, self.message)
    }
}

/// Reads rays one after the other, in memory that does not grow with their number.
pub struct RayReader<'r> {
    rows: Rows<'r>,
    /// The answers at which the rays start, if they are told.
    starts: Option<StartReader<'r>>,
    /// The number of the last line or row.
    number: u64,
    is_over: bool,
}

/// The input of rays.
pub type Input<'r> = BufReader<Box<dyn Read + 'r>>;

enum Rows<'r> {
    Lines(Input<'r>, LineForm),
    Npy(npy::Rows<'r>),
}

/// The form of a ray on a line.
enum LineForm {
    Text,
    /// The columns of the numbers of [`COLUMNS`].
    Csv([Option<usize>; 7]),
    Json,
}

/// The columns of a CSV.
const COLUMNS: [&str; 7] = ["ox", "oy", "oz", "dx", "dy", "dz", "t_max"];

impl<'r> RayReader<'r> {
    /// Starts to read, in a format or in the one that the first bytes show.
    ///
    /// # Errors
    /// Returns an error where the input cannot be read, or where its header is not that of the format.
    pub fn new(mut input: Input<'r>, format: Option<RayFormat>) -> Result<Self, BadRay> {
        let bad = |number, unit, message| BadRay { number, unit, message, is_last: true };
        let format = match format {
            Some(format) => format,
            None => of_content(input.fill_buf().map_err(|error| bad(1, "line", reason(&error)))?),
        };
        let mut number = 0;
        let rows = match format {
            RayFormat::Text => Rows::Lines(input, LineForm::Text),
            RayFormat::JsonLines => Rows::Lines(input, LineForm::Json),
            RayFormat::Npy => {
                Rows::Npy(npy::Rows::new(Box::new(input)).map_err(|message| bad(1, "row", message))?)
            }
            RayFormat::Csv => {
                let names = next_line(&mut input, &mut number, true).transpose();
                let names = names.map_err(|(message, _)| bad(number, "line", message))?.unwrap_or_default();
                let columns = columns(&names).map_err(|message| bad(number, "line", message))?;
                Rows::Lines(input, LineForm::Csv(columns))
            }
        };
        Ok(Self { rows, starts: None, number, is_over: false })
    }

    /// Lets each ray leave the hit of one of these answers.
    pub fn leaving(self, answers: StartReader<'r>) -> Self {
        Self { starts: Some(answers), ..self }
    }

    /// Returns the fault of the last ray.
    pub(super) fn fault(&self, message: String) -> BadRay {
        BadRay { number: self.number, unit: self.unit(), message, is_last: false }
    }

    fn unit(&self) -> &'static str {
        if matches!(self.rows, Rows::Npy(_)) { "row" } else { "line" }
    }

    /// Returns the next ray without the surface that it leaves.
    fn bare(&mut self) -> Option<Result<RayRow, BadRay>> {
        let unit = self.unit();
        let read = self.numbers()?;
        let row = read.and_then(|(numbers, t_max)| of_numbers(numbers, t_max).map_err(|why| (why, false)));
        Some(numbered(row, (unit, self.number), &mut self.is_over))
    }

    /// Returns the number of rays, where the input says it.
    pub fn count(&self) -> Option<u64> {
        match &self.rows {
            Rows::Npy(rows) => Some(rows.count()),
            Rows::Lines(..) => None,
        }
    }

    /// Tells whether more can be read without waiting, as far as that is known.
    pub fn has_more(&self) -> bool {
        match &self.rows {
            Rows::Lines(input, _) => !input.buffer().is_empty(),
            Rows::Npy(_) => true,
        }
    }

    /// Returns the numbers of the next ray; `None` at the end. A fault says whether it is the last.
    fn numbers(&mut self) -> Option<Result<Numbers, (String, bool)>> {
        let (input, form) = match &mut self.rows {
            Rows::Lines(input, form) => (input, &*form),
            Rows::Npy(rows) => {
                self.number += 1;
                return rows.next();
            }
        };
        let line = match next_line(input, &mut self.number, !matches!(form, LineForm::Json))? {
            Ok(line) => line,
            Err(fault) => return Some(Err(fault)),
        };
        let numbers = match form {
            LineForm::Text => of_words(line.split(|c: char| c.is_whitespace() || c == ',')),
            LineForm::Csv(columns) => of_record(&fields(&line).collect::<Vec<_>>(), columns),
            LineForm::Json => of_json(&line),
        };
        Some(numbers.map_err(|message| (message, false)))
    }
}

impl Iterator for RayReader<'_> {
    type Item = Result<RayRow, BadRay>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let row = self.bare();
        let Some(starts) = &mut self.starts else { return row };
        let start = starts.next();
        let is_last = row.is_none() != start.is_none();
        self.is_over |= is_last;
        let fault = |message: &str| BadRay { is_last, ..self.fault(message.to_owned()) };
        Some(match (row, start) {
            (None, None) => return None,
            (None, Some(_)) => Err(fault("no ray follows, and there are more answers to leave")),
            (Some(_), None) => Err(fault("there is no answer for it to leave")),
            (Some(Err(bad)), _) => Err(bad),
            (Some(Ok(_)), Some(Err(bad))) => Err(fault(&format!("the answer that it leaves, {bad}"))),
            (Some(Ok(_)), Some(Ok(None))) => Err(fault("the answer that it leaves has no proven hit")),
            (Some(Ok(row)), Some(Ok(leaves))) => Ok(RayRow { leaves, ..row }),
        })
    }
}

/// Adds to a fault the line or the row that it is in, and ends the reader after the last one.
pub(super) fn numbered<T>(
    row: Result<T, (String, bool)>,
    (unit, number): (&'static str, u64),
    is_over: &mut bool,
) -> Result<T, BadRay> {
    row.map_err(|(message, is_last)| {
        *is_over = is_last;
        BadRay { number, unit, message, is_last }
    })
}

/// Returns the format that the first bytes of rays show.
fn of_content(head: &[u8]) -> RayFormat {
    if head.starts_with(output::npy::MAGIC) {
        return RayFormat::Npy;
    }
    let text = String::from_utf8_lossy(head);
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
    match first {
        Some(line) if line.starts_with(['{', '[']) => RayFormat::JsonLines,
        Some(line) if fields(line).any(|name| COLUMNS.contains(&name)) => RayFormat::Csv,
        _ => RayFormat::Text,
    }
}

/// Reads the next line that is not empty, and counts all lines; `None` at the end. `#` may begin a comment. A fault
/// says whether it is the last.
pub(super) fn next_line(
    input: &mut impl BufRead,
    number: &mut u64,
    may_have_comments: bool,
) -> Option<Result<String, (String, bool)>> {
    loop {
        *number += 1;
        let mut bytes = Vec::new();
        match input.take(LONGEST).read_until(b'\n', &mut bytes) {
            Ok(0) => return None,
            Ok(read) if read as u64 == LONGEST && !bytes.ends_with(b"\n") => {
                return Some(Err((format!("it is longer than {LONGEST} bytes"), true)));
            }
            Ok(_) => {}
            Err(error) => return Some(Err((reason(&error), true))),
        }
        let Ok(text) = str::from_utf8(&bytes) else {
            return Some(Err(("it is not UTF-8".to_owned(), false)));
        };
        let text = if may_have_comments { text.split('#').next().unwrap_or_default() } else { text };
        let text = text.trim_start_matches('\u{feff}').trim();
        if !text.is_empty() {
            return Some(Ok(text.to_owned()));
        }
    }
}

/// Returns the fields of a line of CSV. Numbers and their names need no quotes, but may have them.
pub(super) fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|field| field.trim().trim_matches('"'))
}

/// Returns the columns of the numbers, given the names of the columns.
pub(super) fn columns(names: &str) -> Result<[Option<usize>; 7], String> {
    let columns = COLUMNS.map(|column| fields(names).position(|name| name == column));
    let missing = COLUMNS[..6].iter().zip(&columns).filter(|(_, at)| at.is_none());
    let missing: Vec<_> = missing.map(|(name, _)| format!("`{name}`")).collect();
    if missing.is_empty() {
        return Ok(columns);
    }
    Err(format!(
        "the first line lacks {}: it names the columns, `ox,oy,oz,dx,dy,dz` and perhaps `t_max`",
        missing.join(", ")
    ))
}

fn of_words<'w>(words: impl Iterator<Item = &'w str>) -> Result<Numbers, String> {
    let mut numbers = Vec::with_capacity(7);
    for word in words.filter(|word| !word.is_empty()).take(8) {
        numbers.push(word.parse().map_err(|_| format!("`{}` is not a number", short(word)))?);
    }
    of_list(&numbers)
}

fn of_list(numbers: &[f64]) -> Result<Numbers, String> {
    match *numbers {
        [a, b, c, d, e, f] => Ok(([a, b, c, d, e, f], None)),
        [a, b, c, d, e, f, end] => Ok(([a, b, c, d, e, f], Some(end))),
        _ => Err(format!(
            "a ray has six numbers, its origin and its direction, and perhaps the t at which it ends; here {}",
            match numbers.len() {
                1 => "is 1".to_owned(),
                8.. => "are more than 7".to_owned(),
                count => format!("are {count}"),
            }
        )),
    }
}

pub(super) fn of_record(record: &[&str], columns: &[Option<usize>; 7]) -> Result<Numbers, String> {
    let mut numbers = [f64::INFINITY; 7];
    for (number, (column, name)) in numbers.iter_mut().zip(columns.iter().zip(COLUMNS)) {
        let Some(column) = column else { continue };
        let word = record.get(*column).copied().unwrap_or_default();
        if !(word.is_empty() && name == "t_max") {
            *number = word.parse().map_err(|_| format!("`{}` is not a number for `{name}`", short(word)))?;
        }
    }
    let [a, b, c, d, e, f, end] = numbers;
    Ok(([a, b, c, d, e, f], (end != f64::INFINITY).then_some(end)))
}

/// A ray in the form of JSON.
#[derive(Deserialize)]
#[serde(untagged)]
enum Json {
    List(Vec<f64>),
    Named {
        origin: [f64; 3],
        #[serde(alias = "dir")]
        direction: [f64; 3],
        t_max: Option<f64>,
    },
}

fn of_json(line: &str) -> Result<Numbers, String> {
    // An untagged enum does not say where a text is invalid JSON.
    let value: serde_json::Value = serde_json::from_str(line).map_err(|error| error.to_string())?;
    match serde_json::from_value(value) {
        Ok(Json::List(numbers)) => of_list(&numbers),
        Ok(Json::Named { origin: [a, b, c], direction: [d, e, f], t_max }) => Ok(([a, b, c, d, e, f], t_max)),
        Err(_) => Err(r#"a ray is `{"origin": [0, 0, 9], "direction": [0, 0, -1]}`, with `t_max` if it ends, or a list of these numbers"#
            .to_owned()),
    }
}

pub(super) fn of_numbers([a, b, c, d, e, f]: [f64; 6], t_max: Option<f64>) -> Result<RayRow, String> {
    let (origin, dir) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
    if t_max.is_some_and(|end| end.is_nan() || end <= 0.0) {
        return Err("a ray ends at a positive t".to_owned());
    }
    let ray = QueryRay::new(origin, dir);
    let why = if dir == DVec3::ZERO { "its direction is 0" } else { "its numbers are not all finite" };
    ray.map(|ray| RayRow { ray, t_max, leaves: None }).ok_or_else(|| why.to_owned())
}

pub(super) fn short(word: &str) -> String {
    word.chars().take(20).collect()
}
