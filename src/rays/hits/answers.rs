//! Writes answers.

use super::npy;
use serde::Serialize;
use std::io::{self, Write};
use tabray_core::output;
use tabray_core::query::{Answer, Query, Surroundings, Verdict};
use tabray_core::text;
use tabray_core::world::certify::Precision;

/// How answers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnswerFormat {
    /// A JSON object a line; what there is not is left out.
    JsonLines,
    /// A line of names, and then of values; what there is not is empty.
    Csv,
    /// A structured NumPy array; what there is not is -1 or NaN.
    Npy,
}

/// An answer to be written.
pub(super) struct Answered<'q, 'm> {
    pub query: &'q Query<'m>,
    /// The index of the ray, where a ray may have several answers.
    pub ray: Option<u64>,
    pub answer: Answer,
    pub enters: Option<bool>,
    pub surface: Option<Surroundings>,
}

/// An answer in the form of JSON.
#[derive(Serialize)]
struct Line<'m> {
    #[serde(skip_serializing_if = "Option::is_none")]
    ray: Option<u64>,
    verdict: &'static str,
    proof: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    object: Option<&'m str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    face: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    enters: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_low: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_high: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    point: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    normal: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    uv: Option<[f64; 2]>,
}

/// The columns of answers as CSV.
const COLUMNS: &str = "verdict,proof,object,number,face,t,t_low,t_high,distance,x,y,z,nx,ny,nz,u,v";

/// The columns before these where a ray may have several answers.
const COLUMNS_OF_ALL: &str = "ray,enters";

/// Returns the name of a verdict.
pub fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Hit => "hit",
        Verdict::Miss => "miss",
        Verdict::Edge => "edge",
        Verdict::Tie => "tie",
        Verdict::Undecided => "undecided",
    }
}

/// Returns the number of a verdict in an array.
pub fn code(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Miss => 0,
        Verdict::Hit => 1,
        Verdict::Edge => 2,
        Verdict::Tie => 3,
        Verdict::Undecided => 4,
    }
}

/// Returns the number of bits of a proof, 0 without one.
fn bits(proof: Option<Precision>) -> u8 {
    match proof {
        None => 0,
        Some(Precision::Double) => 53,
        Some(Precision::Octuple) => 237,
    }
}

impl<'m> Answered<'_, 'm> {
    fn line(&self) -> Line<'m> {
        let Self { query, ray, answer, enters, surface } = self;
        let there = |number: f64| number.is_finite().then_some(number);
        let proof = match answer.proof {
            None => "none",
            Some(Precision::Double) => "53 bits",
            Some(Precision::Octuple) => "237 bits",
        };
        Line {
            ray: *ray,
            enters: *enters,
            verdict: name(answer.verdict),
            proof,
            object: answer.object.map(|index| query.model().objects[index].args.name()),
            number: answer.object.map(|index| query.number(index)),
            face: surface.and_then(|surface| surface.face),
            t: there(answer.t),
            t_low: there(answer.bounds.low),
            t_high: there(answer.bounds.high),
            distance: there(answer.distance),
            point: surface.map(|surface| surface.point.to_array()),
            normal: surface.map(|surface| surface.normal.to_array()),
            uv: surface.and_then(|surface| surface.uv).map(|uv| uv.to_array()),
        }
    }

    fn record(&self) -> npy::Record {
        let Self { query, answer, surface, .. } = self;
        let none = [f64::NAN; 3];
        npy::Record {
            verdict: code(answer.verdict),
            proof: bits(answer.proof),
            object: answer.object.map_or(-1, |index| query.number(index) as i32),
            face: surface.and_then(|surface| surface.face).map_or(-1, |face| face as i32),
            along: [answer.t, answer.bounds.low, answer.bounds.high, answer.distance],
            point: surface.map_or(none, |surface| surface.point.to_array()),
            normal: surface.map_or(none, |surface| surface.normal.to_array()),
            uv: surface.and_then(|surface| surface.uv).map_or([f64::NAN; 2], |uv| uv.to_array()),
        }
    }
}

impl AnswerFormat {
    /// Writes the text before the answers. An array needs the number of answers. `are_all` says whether a ray may
    /// have several answers.
    ///
    /// # Errors
    /// Returns the errors of `out`, and for an array, an error where the number is not known.
    pub fn begin(self, count: Option<u64>, are_all: bool, out: &mut dyn Write) -> io::Result<()> {
        match (self, count) {
            (Self::JsonLines, _) => Ok(()),
            (Self::Csv, _) if are_all => writeln!(out, "{COLUMNS_OF_ALL},{COLUMNS}"),
            (Self::Csv, _) => writeln!(out, "{COLUMNS}"),
            (Self::Npy, Some(count)) => output::npy::begin(npy::RECORD, &format!("({count},)"), out),
            (Self::Npy, None) => {
                Err(io::Error::new(io::ErrorKind::InvalidInput, "an array needs its length first"))
            }
        }
    }

    /// Returns the text or the bytes of some answers.
    pub(super) fn written<'q, 'm: 'q>(
        self,
        answers: impl Iterator<Item = Answered<'q, 'm>>,
    ) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self {
            Self::JsonLines => {
                for answer in answers {
                    bytes.extend_from_slice(text::json(&answer.line()).as_bytes());
                    bytes.push(b'\n');
                }
            }
            Self::Csv => {
                let mut out = csv::WriterBuilder::new().has_headers(false).from_writer(&mut bytes);
                for answer in answers {
                    out.write_record(fields(&answer.line()))?;
                }
                out.flush()?;
                drop(out);
            }
            Self::Npy => answers.for_each(|answer| answer.record().write(&mut bytes)),
        }
        Ok(bytes)
    }
}

/// Returns the fields of an answer as CSV.
fn fields(line: &Line) -> Vec<String> {
    let number = |of: Option<f64>| of.map_or(String::new(), |of| of.to_string());
    let index = |of: Option<usize>| of.map_or(String::new(), |of| of.to_string());
    let of_all =
        line.ray.map(|ray| [ray.to_string(), line.enters.map_or(String::new(), |enters| enters.to_string())]);
    let mut fields: Vec<_> = of_all.into_iter().flatten().collect();
    fields.extend([
        line.verdict.to_owned(),
        line.proof.to_owned(),
        text::visible(line.object.unwrap_or_default()).into_owned(),
    ]);
    fields.extend([index(line.number), index(line.face.map(|face| face as usize))]);
    fields.extend([line.t, line.t_low, line.t_high, line.distance].map(number));
    for vector in [line.point, line.normal] {
        fields.extend((0..3).map(|axis| number(vector.map(|of| of[axis]))));
    }
    fields.extend((0..2).map(|axis| number(line.uv.map(|of| of[axis]))));
    fields
}
