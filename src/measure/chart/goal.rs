//! The goal of a choice, and the estimates of the choices.

use super::timings::Cost;
use tabray_core::world::accuracy::Accuracy;

/// The error for which small things are measured where none is given: a level.
const SMALL_ERROR: f64 = 1.0 / 255.0;

/// The greatest ratio of an upper limit to an error that is known well enough, and an error that is as good as none.
const KNOWN: f64 = 1.3;
const NOTHING: f64 = 0.05 / 255.0;

/// The goal of a choice.
#[derive(Clone, Copy)]
pub enum Goal {
    /// A maximum error.
    Error {
        /// The error, as a fraction of white.
        most: f64,
        /// Whether it is the 99.9th percentile of the pixels' errors, not their root mean square.
        worst: bool,
    },
    /// A maximum time, and the least error within it.
    Time {
        /// The time for the image on all cores, in seconds.
        most: f64,
        /// Whether the error is that of the worst pixels, as for an error.
        worst: bool,
    },
    /// None: all numbers of samples are measured.
    None,
}

/// The cost and the error of an accuracy and a number of samples, with all sources of error together.
#[derive(Clone, Copy)]
pub struct Estimate {
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The number of samples per pixel, from a Sobol sequence; the least where pixels take different ones.
    pub samples: u32,
    /// The greatest number of samples, where pixels take different ones.
    pub most: Option<u32>,
    /// The mean number of rays from the viewer for a pixel: its samples, and where pixels take different numbers, its
    /// part of the probes that decide on them.
    pub rays: f64,
    /// The cost of the render of the whole image.
    pub cost: Cost,
    /// The measured error, where 1 is white.
    pub error: f64,
    /// The upper limit of the error of the whole image: as measured, with a confidence of 95 %, or a bound, with one of
    /// 99 %.
    pub bound: f64,
    /// The largest measured error of a pixel, where 1 is white.
    pub worst: f64,
    /// The number of pixels on which the error was measured.
    pub pixels: usize,
}

/// Things that may be smaller than the gaps between samples.
#[derive(Clone, Copy)]
pub struct Small {
    /// The number of pixels that may show them. All of them were measured, unless they are too many.
    pub pixels: usize,
    /// The part of all bounds that is due to things missed in these pixels, where 1 is white.
    pub missed: f64,
    /// Whether so many pixels may show them that none was looked for.
    pub is_left_out: bool,
}

/// Estimates, and the measurements behind them.
pub struct Estimates {
    /// The choices: those of the scene's own accuracy first, by ascending samples; those where pixels take different
    /// numbers follow the others of their accuracy.
    pub all: Vec<Estimate>,
    /// The scene's own accuracy.
    pub own: Accuracy,
    /// The number of pixels of the image.
    pub pixels: usize,
    /// Things that may be smaller than the gaps between samples.
    pub small: Small,
    /// The number of samples per pixel that the choices were compared with.
    pub against: u32,
    /// Whether time ran out, and fewer pixels were measured than planned.
    pub is_short: bool,
}

impl Goal {
    /// Tells whether an error or a bound is that of the worst pixels.
    pub(super) fn is_worst(self) -> bool {
        matches!(self, Self::Error { worst: true, .. } | Self::Time { worst: true, .. })
    }

    /// Returns the first choice that meets the goal, among those of one accuracy by ascending samples.
    pub fn first_meeting(self, estimates: &[Estimate]) -> Option<&Estimate> {
        match self {
            Self::Error { most, .. } => estimates.iter().find(|one| one.bound <= most),
            Self::Time { most, .. } => estimates.iter().rfind(|one| one.cost.time.range[1] <= most),
            Self::None => None,
        }
    }

    /// Tells whether more pixels would hardly tell more about these choices of one accuracy.
    pub(super) fn is_clear(self, estimates: &[Estimate]) -> bool {
        let is_known = |one: &Estimate| one.bound <= KNOWN * one.error.max(NOTHING);
        match self {
            Self::Error { most, .. } => match estimates.iter().find(|one| one.error <= most) {
                Some(one) => one.bound <= most && is_known(one),
                None => estimates.last().is_some_and(|last| last.error > KNOWN * most),
            },
            Self::Time { .. } => self.first_meeting(estimates).is_none_or(is_known),
            Self::None => estimates.iter().all(is_known),
        }
    }

    /// Returns an error that is small for the goal, where 1 is white.
    pub(super) fn error(self) -> f64 {
        match self {
            Self::Error { most, .. } => most,
            Self::Time { .. } | Self::None => SMALL_ERROR,
        }
    }

    pub(super) fn is_none(self) -> bool {
        matches!(self, Self::None)
    }

    /// Tells whether a render of this cost is estimated to take at most the time that is allowed.
    pub(super) fn is_likely(self, cost: &Cost) -> bool {
        matches!(self, Self::Time { most, .. } if cost.time.mean <= most)
    }
}

impl Estimate {
    /// Returns the number of samples, as `--samples` takes it.
    pub fn numbers(&self) -> String {
        match self.most {
            Some(most) => format!("{}..{most}", self.samples),
            None => self.samples.to_string(),
        }
    }
}
