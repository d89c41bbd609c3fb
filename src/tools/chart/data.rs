//! What is charted: panels of points, one for each choice.

use super::clock::Times;
use super::machine::Machine;

/// All that is charted of a scene.
pub struct Chart {
    /// What the scene is called.
    pub scene: String,
    /// Where and when it was measured.
    pub machine: Machine,
    /// One picture for each question.
    pub panels: Vec<Panel>,
    /// Whether all was measured that was to be.
    pub is_whole: bool,
}

/// Choices that answer one question, compared.
pub struct Panel {
    /// What is compared.
    pub title: String,
    /// On what.
    pub note: String,
    /// What the errors are of.
    pub subject: Subject,
    /// The choices.
    pub points: Vec<Point>,
}

/// What errors are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Distances of hits, in world units; the times are those of a ray and an object.
    Distances,
    /// Colours of pixels, one ray through each; the times are those of a pixel.
    Methods,
    /// Colours of pixels, by samples; the times are those of a pixel.
    Samples,
}

/// One choice.
pub struct Point {
    /// What it is called.
    pub name: String,
    /// What it is akin to.
    pub family: Family,
    /// Whether the scene is traced so.
    pub is_default: bool,
    /// The seconds that it takes for one ray or one pixel.
    pub times: Times,
    /// How wrong it is: of distances the 99th percentile of their errors, in world units; of colours the root of the
    /// mean square of theirs, 1 being as bright as a picture can show. Not a number where no hit is right.
    pub error: f64,
    /// The greatest error.
    pub worst: f64,
    /// Hits that are not the right ones.
    pub wrong: Wrong,
    /// Of colours, how different all but one in a hundred look at most: distances in Oklab, in hundredths of that from
    /// black to white.
    pub visible: Option<f64>,
    /// Of colours, how many of the pixels that were looked at have other bytes in the picture.
    pub changed: Option<[usize; 2]>,
    /// The samples that it has for each pixel.
    pub samples: u32,
}

/// Hits that are not the right ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wrong {
    /// The rays that were looked at and whose truth is known.
    pub of: usize,
    /// Hits that were not found.
    pub missed: usize,
    /// Hits that were found where there are none.
    pub invented: usize,
    /// Hits found at another crossing than the first.
    pub later: usize,
}

impl Wrong {
    /// All together.
    pub fn count(&self) -> usize {
        self.missed + self.invented + self.later
    }
}

/// Choices of a kind, which are drawn alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The program's own method, by its accuracy.
    Own,
    /// The course notes' methods.
    Notes,
    /// Samples along the ray.
    Sampling,
    /// Sphere tracing.
    Tracing,
    /// Methods that prove what they find.
    Bounds,
    /// Samples of pixels, spread evenly.
    Sobol,
    /// Samples of pixels, anywhere.
    Random,
}

impl Panel {
    /// What errors are, as a table calls them.
    pub fn measure(&self) -> &'static str {
        match self.subject {
            Subject::Distances => "error of the distance, 99th percentile (world units)",
            Subject::Methods | Subject::Samples => "error of the colour, RMSE (1 = white)",
        }
    }

    /// What its points take their times for, and how many of these units are a second.
    pub fn unit(&self) -> (&'static str, f64) {
        match self.subject {
            Subject::Distances => ("CPU time per ray and object (ns)", 1e9),
            Subject::Methods | Subject::Samples => ("CPU time per pixel (µs)", 1e6),
        }
    }

    /// Errors that make no difference: of a colour, far less than a step of what a picture can show.
    pub fn negligible(&self) -> f64 {
        match self.subject {
            Subject::Distances => 0.0,
            Subject::Methods | Subject::Samples => 1e-9,
        }
    }
}

/// What noise and waiting may be at most.
const MOST: f64 = 0.15;

impl Chart {
    /// How far apart rounds of the same work were, as a part of their time: that of the choice in the middle.
    pub fn noise(&self) -> f64 {
        self.middle(Times::spread)
    }

    /// How long rounds waited for other work of the machine, likewise.
    pub fn waited(&self) -> f64 {
        self.middle(|times| times.waited)
    }

    /// Whether its times cannot be trusted.
    pub fn is_noisy(&self) -> bool {
        self.noise() > MOST
    }

    /// Whether the machine had other work, which slows all choices alike.
    pub fn is_busy(&self) -> bool {
        self.waited() > MOST
    }

    fn middle(&self, of: impl Fn(&Times) -> f64) -> f64 {
        let points = self.panels.iter().flat_map(|panel| &panel.points);
        let mut parts: Vec<f64> = points.map(|point| of(&point.times)).collect();
        parts.sort_by(f64::total_cmp);
        parts.get(parts.len() / 2).copied().unwrap_or(0.0)
    }
}
