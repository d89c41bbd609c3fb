//! Reads the answers of another tracer, each with its ray.

use super::rays::{
    BadRay, Input, RayRow, columns, fields, next_line, numbered, of_numbers, of_record, short,
};
use serde::Deserialize;
use std::io::BufRead;
use tabray_core::text::reason;

/// The answer of another tracer about a ray.
#[derive(Clone, Debug)]
pub struct TheirAnswer {
    /// The ray.
    pub row: RayRow,
    /// The origin and the direction, as they were read.
    pub numbers: [f64; 6],
    /// Whether it hits.
    pub hits: bool,
    /// The hit, in lengths of the direction, if it is given.
    pub t: Option<f64>,
    /// The object, if it is given.
    pub object: Option<Object>,
    /// The index of the face, if it is given.
    pub face: Option<u64>,
}

/// An object, as another tracer names it.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Object {
    /// By its index in the scene, from 0.
    Number(usize),
    /// By its name.
    Name(String),
}

/// The columns of the numbers of a ray and of an answer.
struct Columns {
    ray: [Option<usize>; 7],
    answer: [Option<usize>; 4],
}

/// Reads answers one after the other.
pub struct TheirReader<'r> {
    input: Input<'r>,
    /// `None` for JSON lines.
    columns: Option<Columns>,
    number: u64,
    is_over: bool,
}

/// The columns of an answer.
const ANSWER: [&str; 4] = ["hit", "t", "object", "face"];

/// An answer in the form of JSON.
#[derive(Deserialize)]
struct Json {
    origin: [f64; 3],
    #[serde(alias = "dir")]
    direction: [f64; 3],
    t_max: Option<f64>,
    hit: Option<bool>,
    t: Option<f64>,
    object: Option<Object>,
    face: Option<i64>,
}

impl<'r> TheirReader<'r> {
    /// Starts to read CSV or JSON lines. The first bytes tell which.
    ///
    /// # Errors
    /// Returns an error where the input cannot be read, or where the first line of CSV lacks columns.
    pub fn new(mut input: Input<'r>) -> Result<Self, BadRay> {
        let bad = |number, message| BadRay { number, unit: "line", message, is_last: true };
        let head = input.fill_buf().map_err(|error| bad(1, reason(&error)))?;
        let first = head.iter().find(|byte| !byte.is_ascii_whitespace());
        if first == Some(&b'{') {
            return Ok(Self { input, columns: None, number: 0, is_over: false });
        }
        let mut number = 0;
        let names = next_line(&mut input, &mut number, true).transpose();
        let names = names.map_err(|(message, _)| bad(number, message))?.unwrap_or_default();
        let ray = columns(&names).map_err(|message| bad(number, message))?;
        let answer = ANSWER.map(|column| fields(&names).position(|name| name == column));
        if answer[..2] == [None; 2] {
            let message = "the first line lacks `t` or `hit`: it names the columns, `ox,oy,oz,dx,dy,dz,t`, and perhaps \
                `hit`, `object`, `face` and `t_max`";
            return Err(bad(number, message.to_owned()));
        }
        Ok(Self { input, columns: Some(Columns { ray, answer }), number, is_over: false })
    }

    fn answer(&self, line: &str) -> Result<TheirAnswer, String> {
        let Some(columns) = &self.columns else { return of_json(line) };
        let record: Vec<_> = fields(line).collect();
        let (numbers, t_max) = of_record(&record, &columns.ray)?;
        let field = |at: usize| {
            let word = columns.answer[at].and_then(|column| record.get(column).copied());
            word.filter(|word| !word.is_empty())
        };
        let hit = field(0).map(|word| match word.to_ascii_lowercase().as_str() {
            "1" | "true" | "hit" | "yes" => Ok(true),
            "0" | "false" | "miss" | "no" => Ok(false),
            _ => Err(format!("`{}` is neither `hit` nor `miss`", short(word))),
        });
        let t = field(1).map(|word| {
            word.parse::<f64>().map_err(|_| format!("`{}` is not a number for `t`", short(word)))
        });
        let object = field(2).filter(|word| *word != "-1").map(|word| match word.parse() {
            Ok(number) => Object::Number(number),
            Err(_) => Object::Name(word.to_owned()),
        });
        let face = field(3).map(|word| {
            word.parse::<i64>().map_err(|_| format!("`{}` is not a number for `face`", short(word)))
        });
        TheirAnswer::new(numbers, t_max, hit.transpose()?, t.transpose()?, object, face.transpose()?)
    }
}

impl TheirAnswer {
    fn new(
        numbers: [f64; 6],
        t_max: Option<f64>,
        hit: Option<bool>,
        t: Option<f64>,
        object: Option<Object>,
        face: Option<i64>,
    ) -> Result<Self, String> {
        let row = of_numbers(numbers, t_max)?;
        // Tracers report a miss by an infinite or negative t, or by none.
        let t = t.filter(|t| t.is_finite() && *t >= 0.0);
        let hits = hit.unwrap_or(t.is_some());
        let face = face.and_then(|face| u64::try_from(face).ok());
        Ok(Self { row, numbers, hits, t: t.filter(|_| hits), object, face })
    }
}

fn of_json(line: &str) -> Result<TheirAnswer, String> {
    let Json { origin: [a, b, c], direction: [d, e, f], t_max, hit, t, object, face } =
        serde_json::from_str(line).map_err(|error| error.to_string())?;
    TheirAnswer::new([a, b, c, d, e, f], t_max, hit, t, object, face)
}

impl Iterator for TheirReader<'_> {
    type Item = Result<TheirAnswer, BadRay>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let is_csv = self.columns.is_some();
        let line = next_line(&mut self.input, &mut self.number, is_csv)?;
        let answer = line.and_then(|line| self.answer(&line).map_err(|why| (why, false)));
        Some(numbered(answer, ("line", self.number), &mut self.is_over))
    }
}
