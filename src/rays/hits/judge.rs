//! Judges the answers of another tracer by proofs.

use super::TOGETHER;
use super::rays::BadRay;
use super::theirs::{Object, TheirAnswer, TheirReader};
use rayon::prelude::*;
use serde::Serialize;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::query::{Answer, Crossing, Query, Verdict};
use tabray_core::render::Renderer;
use tabray_exact::interval::Interval;

/// The judgement on an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// It misses a surface that is certainly hit.
    Missed,
    /// It hits where the ray certainly hits nothing.
    Invented,
    /// It hits a surface that the ray meets only behind the first.
    Later,
    /// Its t is that of no surface, up to the tolerance.
    Inaccurate,
    /// It hits where the first surface is, but names another object.
    OtherObject,
    /// It hits where the first surface is, but names another face.
    OtherFace,
    /// The proof does not decide, as where the ray touches a surface or passes through an edge.
    Open,
    /// It is right.
    Right,
}

impl Finding {
    /// All judgements, the worst ones first.
    pub const ALL: [Self; 8] = [
        Self::Missed,
        Self::Invented,
        Self::Later,
        Self::Inaccurate,
        Self::OtherObject,
        Self::OtherFace,
        Self::Open,
        Self::Right,
    ];

    /// Returns the meaning, in lower case.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Missed => "missed a surface that is hit",
            Self::Invented => "hit where nothing is hit",
            Self::Later => "hit a surface behind the first",
            Self::Inaccurate => "hit where no surface is, up to the tolerance",
            Self::OtherObject => "named another object",
            Self::OtherFace => "named another face",
            Self::Open => "not judged: the ray touches a surface, or passes through an edge",
            Self::Right => "right",
        }
    }

    /// Tells whether the answer is wrong.
    pub fn is_wrong(self) -> bool {
        !matches!(self, Self::Open | Self::Right)
    }
}

/// A judged answer.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The judgement.
    pub finding: Finding,
    /// The number of the answer, from 1.
    pub number: u64,
    /// The answer.
    pub theirs: TheirAnswer,
    /// The proof's answer.
    pub ours: Answer,
    /// A lower bound on the error of their t, in units in the last place of f64 and of f32, if both are known.
    pub ulps: Option<[f64; 2]>,
}

/// The errors of t of right answers, counted by the powers of 2 between which they are.
#[derive(Clone, Debug)]
pub struct Errors {
    /// The numbers of errors that are 0, at most 1, at most 2, at most 4 and so on.
    counts: [u64; 66],
    /// The largest.
    pub most: f64,
}

/// The judgements on all answers.
#[derive(Clone, Debug)]
pub struct Report {
    /// The numbers of answers of each kind, in the order of [`Finding::ALL`].
    pub counts: [u64; 8],
    /// The errors of t, in units in the last place of f64 and of f32.
    pub errors: [Errors; 2],
    /// The worst of the wrong answers, at most [`WORST`].
    pub worst: Vec<Judged>,
    /// The number of lines that were not answers.
    pub bad: u64,
}

/// The maximum number of wrong answers that are shown.
pub const WORST: usize = 20;

/// The maximum number of bad lines that are reported.
const TOLD: usize = 10;

impl Errors {
    const NONE: Self = Self { counts: [0; 66], most: 0.0 };

    fn add(&mut self, error: f64) {
        let index = if error == 0.0 { 0 } else { 1 + libm::log2(error).ceil().clamp(0.0, 64.0) as usize };
        self.counts[index] += 1;
        self.most = self.most.max(error);
    }

    /// Returns a power of 2, or 0, that at least this part of all errors does not exceed; `None` where there are none.
    pub fn within(&self, part: f64) -> Option<f64> {
        let all: u64 = self.counts.iter().sum();
        let mut sum = 0;
        let index = self.counts.iter().position(|count| {
            sum += count;
            sum > 0 && sum as f64 >= part * all as f64
        })?;
        Some(if index == 0 { 0.0 } else { libm::ldexp(1.0, index as i32 - 1) })
    }
}

impl Report {
    /// Tells whether any answer is wrong.
    pub fn is_wrong(&self) -> bool {
        Finding::ALL.iter().zip(&self.counts).any(|(finding, count)| finding.is_wrong() && *count > 0)
    }

    /// Returns the number of all judged answers.
    pub fn all(&self) -> u64 {
        self.counts.iter().sum()
    }

    fn add(&mut self, judged: Judged) {
        self.counts[judged.finding as usize] += 1;
        if let (Finding::Right, Some(ulps)) = (judged.finding, judged.ulps) {
            self.errors.iter_mut().zip(ulps).for_each(|(errors, error)| errors.add(error));
        }
        if judged.finding.is_wrong() {
            self.worst.push(judged);
            if self.worst.len() == 2 * WORST {
                self.keep_worst();
            }
        }
    }

    /// Keeps the worst answers: by their kinds, and among those of a kind the ones with the largest errors.
    fn keep_worst(&mut self) {
        let error = |judged: &Judged| judged.ulps.map_or(f64::INFINITY, |[ulps, _]| ulps);
        self.worst.sort_by(|one, other| {
            let by_error = error(other).total_cmp(&error(one));
            one.finding.cmp(&other.finding).then(by_error).then(one.number.cmp(&other.number))
        });
        self.worst.truncate(WORST);
    }
}

/// Judges all answers of a reader. A t is right within `tolerance` times the real t. `each` is called with each wrong
/// answer, in their order.
///
/// # Errors
/// Returns the first lines that are not answers, unless `skip_bad` is set.
pub fn read(
    renderer: &Renderer,
    query: &Query,
    tolerance: f64,
    answers: &mut TheirReader,
    skip_bad: bool,
    each: &mut dyn FnMut(&Judged),
) -> Result<Report, Vec<BadRay>> {
    let mut report =
        Report { counts: [0; 8], errors: [Errors::NONE, Errors::NONE], worst: Vec::new(), bad: 0 };
    loop {
        let (mut part, mut bad) = (Vec::new(), Vec::new());
        while part.len() < TOGETHER && bad.len() < TOLD {
            match answers.next() {
                None => break,
                Some(Ok(answer)) => part.push(answer),
                Some(Err(fault)) => {
                    report.bad += 1;
                    if !skip_bad || fault.is_last {
                        bad.push(fault);
                    }
                }
            }
        }
        if !bad.is_empty() {
            return Err(bad);
        }
        if part.is_empty() {
            report.keep_worst();
            return Ok(report);
        }
        let packet = |theirs: &[TheirAnswer]| {
            let rays: Vec<_> = theirs.iter().map(|of| of.row.ray.clone()).collect();
            let ours = query.proven(&rays, false).into_iter().zip(theirs);
            ours.map(|(ours, theirs)| judged(query, theirs, ours, tolerance)).collect::<Vec<_>>()
        };
        let packets: Vec<_> = renderer.run(|| part.par_chunks(PACKET_SIZE).map(packet).collect());
        for judged in packets.into_iter().flatten() {
            let judged = Judged { number: report.all() + 1, ..judged };
            if judged.finding.is_wrong() {
                each(&judged);
            }
            report.add(judged);
        }
    }
}

/// Judges an answer, given the proof's.
fn judged(query: &Query, theirs: &TheirAnswer, ours: Answer, tolerance: f64) -> Judged {
    let ours = ours.within(theirs.row.t_max.unwrap_or(f64::INFINITY));
    let ulps = theirs.t.filter(|_| ours.bounds.high.is_finite()).map(|t| {
        let (error, real) = (distance(t, ours.bounds), ours.t.abs());
        let single = real as f32;
        [error / (real.next_up() - real), error / f64::from(single.next_up() - single)]
    });
    let finding = finding(query, theirs, &ours, tolerance);
    Judged { finding, number: 0, theirs: theirs.clone(), ours, ulps }
}

fn finding(query: &Query, theirs: &TheirAnswer, ours: &Answer, tolerance: f64) -> Finding {
    let is_at = |t: f64, bounds: Interval| distance(t, bounds) <= tolerance * t.abs().max(bounds.high.abs());
    let is_certain = ours.bounds.high.is_finite();
    match (ours.verdict, theirs.hits) {
        (Verdict::Miss, false) => Finding::Right,
        (Verdict::Miss, true) => Finding::Invented,
        (Verdict::Edge, false) => Finding::Open,
        (Verdict::Hit | Verdict::Tie, false) => Finding::Missed,
        (Verdict::Undecided, false) => {
            if is_certain {
                Finding::Missed
            } else {
                Finding::Open
            }
        }
        (verdict, true) => match theirs.t {
            Some(t) if !is_certain || !is_at(t, ours.bounds) => {
                let is_early = t < ours.bounds.low && !is_at(t, ours.bounds);
                let mut crossings = query.crossings(&theirs.row.ray, f64::INFINITY, false).into_iter();
                match verdict {
                    _ if is_early => Finding::Inaccurate,
                    Verdict::Edge | Verdict::Undecided => Finding::Open,
                    _ if crossings.any(|of| of.answer.t.is_finite() && is_at(t, of.answer.bounds)) => {
                        Finding::Later
                    }
                    _ => Finding::Inaccurate,
                }
            }
            _ if verdict == Verdict::Hit => of_names(query, theirs, ours, tolerance),
            _ => Finding::Right,
        },
    }
}

/// Judges the object and the face that an answer at the right place names.
fn of_names(query: &Query, theirs: &TheirAnswer, ours: &Answer, tolerance: f64) -> Finding {
    let is_other = |object: usize| match &theirs.object {
        None => false,
        Some(Object::Number(number)) => *number != query.number(object),
        Some(Object::Name(name)) => query.model().objects[object].args.name() != name,
    };
    if ours.object.is_some_and(is_other) {
        // Where surfaces meet, the tolerance allows for another order.
        let is_there = |of: Crossing| {
            of.answer.object.is_some_and(|object| !is_other(object))
                && theirs.t.is_some_and(|t| distance(t, of.answer.bounds) <= tolerance * t.abs())
        };
        let crossings = query.crossings(&theirs.row.ray, f64::INFINITY, false);
        return if crossings.into_iter().any(is_there) { Finding::Right } else { Finding::OtherObject };
    }
    let face = theirs.face.and_then(|_| query.surroundings(&theirs.row.ray, ours)).and_then(|of| of.face);
    match (theirs.face, face) {
        (Some(theirs), Some(ours)) if theirs != u64::from(ours) => Finding::OtherFace,
        _ => Finding::Right,
    }
}

/// Returns the distance of a number from an interval.
fn distance(t: f64, Interval { low, high }: Interval) -> f64 {
    (low - t).max(t - high).max(0.0)
}
