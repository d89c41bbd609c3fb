//! `tabray render --frames --sweep`: one image for each frame, with values that change from frame to frame.

use crate::options::number::whole;
use crate::process::failure::Failure;
use std::fmt;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use tabray_core::text;
use tabray_exact::decimal::{self, DecimalFault};

/// The highest number of a frame.
const MAX_FRAME: u32 = 999_999;

/// The minimum number of digits in the name of a frame.
const DIGITS: usize = 4;

/// The frames that are rendered, and what changes from one to the next.
#[derive(clap::Args)]
#[group(id = "which frames")]
#[command(next_help_heading = "Parts and frames")]
pub struct Args {
    /// Render one image for each frame from A to B: `-o film.png --frames 1..240` writes film-0001.png to
    /// film-0240.png. With --part K/N, every Nth frame from the Kth on
    #[arg(long, value_name = "A..B", value_parser = range)]
    pub frames: Option<Range>,
    /// Override values like --set, but with different ones in each frame: `vase.height=4..6` goes evenly from 4 in the
    /// first frame to 6 in the last. In formulas, as in `eye.viewpoint="4*cos(2*pi*t)" 3 6`, t goes from 0 to 1. May be
    /// given more than once
    #[arg(long = "sweep", value_name = "NAME=VALUES", requires = "frames")]
    sweeps: Vec<String>,
    /// Render only this frame of --frames, for example as one task of a job array; with --part, only a part of this
    /// frame
    #[arg(long, value_name = "N", value_parser = whole::<u32>(0..=MAX_FRAME), requires = "frames")]
    frame: Option<u32>,
}

/// The numbers of the first and the last frame.
#[derive(Clone, Debug)]
pub struct Range(pub RangeInclusive<u32>);

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.0.start(), self.0.end())
    }
}

/// A frame to render.
#[derive(Debug, PartialEq)]
pub struct Frame {
    /// The path of its image.
    pub path: PathBuf,
    /// The values for `--set`.
    pub sets: Vec<String>,
}

/// Reads a range of frames, such as `1..240`.
///
/// # Errors
/// A message for people, if the text is no range.
pub fn range(text: &str) -> Result<Range, String> {
    let number = |text: &str| text.parse().ok().filter(|number| (0..=MAX_FRAME).contains(number));
    let ends = text.split_once("..").and_then(|(first, last)| number(first).zip(number(last)));
    let ends = ends.filter(|(first, last)| first <= last);
    ends.map(|(first, last)| Range(first..=last))
        .ok_or_else(|| format!("give the first and the last frame as `1..240`, each up to {MAX_FRAME}"))
}

impl Args {
    /// Returns the frames to render, if there are any: all, or one, or those of the part. `part` is left where it is a
    /// part of a single frame.
    pub fn of(&self, picture: &Path, part: &mut Option<[usize; 2]>) -> Result<Option<Vec<Frame>>, Failure> {
        let Some(Range(range)) = &self.frames else { return Ok(None) };
        if let Some(frame) = self.frame {
            if !range.contains(&frame) {
                let (first, last) = (range.start(), range.end());
                return Err(Failure::usage(format!("there is no frame {frame}"))
                    .help(format!("`--frames {first}..{last}` has {first} to {last}")));
            }
            return Ok(Some(vec![self.frame(picture, frame)]));
        }
        let [number, of] = part.take().unwrap_or([1, 1]);
        let numbers = range.clone().skip(number - 1).step_by(of);
        Ok(Some(numbers.map(|number| self.frame(picture, number)).collect()))
    }

    /// Returns what messages call the values of a frame.
    pub fn set_by(&self) -> Vec<String> {
        self.sweeps.iter().map(|sweep| format!("--sweep {sweep}")).collect()
    }

    fn frame(&self, picture: &Path, number: u32) -> Frame {
        let Some(Range(range)) = &self.frames else {
            return Frame { path: picture.to_owned(), sets: Vec::new() };
        };
        let (first, last) = (*range.start(), *range.end());
        let t = f64::from(number - first) / f64::from((last - first).max(1));
        let sets = self.sweeps.iter().map(|sweep| at(sweep, t)).collect();
        Frame { path: path(picture, number, last), sets }
    }
}

/// Returns the path of a frame's image.
pub fn path(picture: &Path, number: u32, last: u32) -> PathBuf {
    let digits = DIGITS.max(last.to_string().len());
    let mut name = picture.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{number:0digits$}"));
    if let Some(extension) = picture.extension() {
        name.push(".");
        name.push(extension);
    }
    picture.with_file_name(name)
}

/// Returns the value that a sweep sets at a time from 0 to 1.
fn at(sweep: &str, t: f64) -> String {
    let (name, values) = sweep.split_once('=').unwrap_or((sweep, ""));
    // Every second piece between quotes is a formula.
    let pieces = values.split('"').enumerate().map(|(index, piece)| match index % 2 {
        0 => between(piece, t),
        _ => with_time(piece, t),
    });
    let values = pieces.collect::<Vec<_>>().join("\"");
    if sweep.contains('=') { format!("{name}={values}") } else { name.to_owned() }
}

/// Replaces each range as `4..6` by the number at a time, or by an end of it that is no finite number, for the message
/// about that.
fn between(values: &str, t: f64) -> String {
    let number = |word: &str| {
        let (from, to) = word.split_once("..")?;
        match [from, to].map(decimal::read) {
            [Err(DecimalFault::NotANumber), _] | [_, Err(DecimalFault::NotANumber)] => None,
            [Err(_), _] => Some(from.to_owned()),
            [_, Err(_)] => Some(to.to_owned()),
            [Ok(_), Ok(to)] if t == 1.0 => Some(text::shortest(to)),
            [Ok(from), Ok(to)] => {
                let distance = to - from;
                // The distance may be infinite where all numbers between are not.
                let at = if distance.is_finite() { from + t * distance } else { (1.0 - t) * from + t * to };
                Some(text::shortest(at))
            }
        }
    };
    let words = values.split(' ').map(|word| number(word).unwrap_or_else(|| word.to_owned()));
    words.collect::<Vec<_>>().join(" ")
}

/// Replaces the word `t` of a formula by a number.
fn with_time(formula: &str, t: f64) -> String {
    let is_in_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let (mut out, mut word) = (String::new(), String::new());
    let time = format!("({t})");
    for letter in formula.chars().chain(['\0']) {
        if is_in_word(letter) {
            word.push(letter);
            continue;
        }
        out.push_str(if word == "t" { &time } else { &word });
        word.clear();
        out.push(letter);
    }
    out.pop();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_change_evenly_or_by_formula() {
        assert_eq!(at("vase.height=4..6", 0.25), "vase.height=4.5");
        assert_eq!(at("eye.viewpoint=1..-1 3 1e1..0", 1.0), "eye.viewpoint=-1 3 0");
        assert_eq!(
            at("eye.viewpoint=\"4*cos(2*pi*t)+tan(t)\" 3 0..1", 0.5),
            "eye.viewpoint=\"4*cos(2*pi*(0.5))+tan((0.5))\" 3 0.5"
        );
        assert_eq!(at("a.b=file..other", 0.5), "a.b=file..other");
        assert_eq!(at("nothing", 0.5), "nothing");
        for (range, wrong) in
            [("1e400..1", "1e400"), ("nan..1", "nan"), ("0..inf", "inf"), ("1..-1e-400", "-1e-400")]
        {
            for t in [0.0, 0.5, 1.0] {
                assert_eq!(at(&format!("a.b={range}"), t), format!("a.b={wrong}"), "{range} at {t}");
            }
        }
    }

    #[test]
    fn a_sweep_over_all_numbers_passes_those_between() {
        let values = |range: &str| [0.0, 0.25, 0.5, 1.0].map(|t| at(&format!("a.b={range}"), t));
        assert_eq!(values("-1e308..1e308"), ["a.b=-1e308", "a.b=-5e307", "a.b=0", "a.b=1e308"]);
        let all = format!("{}..{}", f64::MAX, f64::MIN);
        assert_eq!(values(&all)[2], "a.b=0");
        assert_eq!(values("5e-324..1e-323")[0], "a.b=5e-324");
    }

    #[test]
    fn frames_are_named_by_their_numbers() {
        assert_eq!(path(Path::new("d/film.png"), 7, 240), Path::new("d/film-0007.png"));
        assert_eq!(path(Path::new("film"), 7, 24_000), Path::new("film-00007"));
    }
}
