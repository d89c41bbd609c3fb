//! The data of a chart: panels of points, one point for each choice.

use super::machine::Machine;
use super::times::Times;
use tabray_tools::unchecked::Unchecked;

/// All charted data of a scene.
#[derive(Clone)]
pub struct Chart {
    /// The name of the scene.
    pub scene: String,
    /// The machine, the build and the date of the measurement.
    pub machine: Machine,
    /// One panel for each question.
    pub panels: Vec<Panel>,
    /// The entity types whose hits cannot be proven.
    pub unchecked: Vec<Unchecked>,
    /// Whether the measurement was completed.
    pub is_whole: bool,
}

/// Choices that answer one question, compared.
#[derive(Clone)]
pub struct Panel {
    /// The title.
    pub title: String,
    /// A note on the rays or pixels that are compared.
    pub note: String,
    /// The quantity whose errors are compared.
    pub subject: Subject,
    /// The choices.
    pub points: Vec<Point>,
}

/// A quantity whose errors are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Distances of hits, in world units. Times are for one ray and one object.
    Distances,
    /// Colours of pixels, with one ray through each. Times are for one pixel.
    Methods,
    /// Colours of pixels, by the number of samples. Times are for one pixel.
    Samples,
    /// Colours of pixels, by the number of times that rays are reflected or transmitted. Times are for one pixel.
    Depth,
    /// Colours of pixels, by accuracy and number of samples. Times are for one pixel.
    Whole,
}

/// A choice, with its cost and its error.
#[derive(Clone)]
pub struct Point {
    /// The choice's name.
    pub name: String,
    /// The group of choices that it is drawn with.
    pub family: Family,
    /// Whether the scene is traced in this way by default.
    pub is_default: bool,
    /// The times for one ray or one pixel, in seconds.
    pub times: Times,
    /// The error: for distances the 99th percentile of their errors, in world units; for colours the root mean square
    /// of theirs, where 1 is white. NaN if no hit is right.
    pub error: f64,
    /// The greatest error, in the same unit.
    pub worst: f64,
    /// The numbers of wrong hits.
    pub wrong: WrongHits,
    /// For colours, the 99th percentile of the visible differences: distances in Oklab, in hundredths of the distance
    /// from black to white.
    pub visible: Option<f64>,
    /// For colours, how many pixels have other bytes in the image, and how many were compared.
    pub changed: Option<[usize; 2]>,
    /// The number of samples per pixel.
    pub samples: u32,
}

/// The numbers of wrong hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongHits {
    /// The number of rays that were compared and whose true hit is known.
    pub of: usize,
    /// Hits that were not found.
    pub missed: usize,
    /// Hits that were found where there are none.
    pub invented: usize,
    /// Hits found at a later crossing than the first.
    pub later: usize,
    /// Hits that are farther from the first crossing than its conditioning explains, where no other one lies between.
    /// Inaccurate hits are not counted among the wrong ones.
    pub inaccurate: usize,
}

/// The numbers of wrong hits of each method on one set of rays.
pub struct WrongHitsOf {
    /// The title of the set.
    pub title: String,
    /// The methods, each with its name.
    pub counts: Vec<(String, WrongHits)>,
}

impl WrongHits {
    /// Returns the number of all wrong hits.
    pub fn count(&self) -> usize {
        self.missed + self.invented + self.later
    }

    /// Returns the number of all hits that are wrong or inaccurate.
    pub fn faults(&self) -> usize {
        self.count() + self.inaccurate
    }
}

/// A group of choices that are drawn alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The program's own method, by accuracy.
    Own,
    /// The course notes' methods.
    Notes,
    /// Root finders that sample the function along the ray.
    Sampling,
    /// Sphere tracing.
    Tracing,
    /// Methods that prove what they find.
    Bounds,
    /// Samples within pixels from a Sobol sequence.
    Sobol,
    /// Samples within pixels at random positions.
    Random,
    /// Samples within pixels from a Sobol sequence, more where a pixel needs them.
    Adaptive,
}

impl Panel {
    /// Returns the name of the errors in tables.
    pub fn measure(&self) -> &'static str {
        match self.subject {
            Subject::Distances => "error of the distance, 99th percentile (world units)",
            Subject::Methods | Subject::Samples | Subject::Depth | Subject::Whole => {
                "error of the colour, RMSE (1 = white)"
            }
        }
    }

    /// Returns the name and the unit of the times, and the number of these units in a second.
    pub fn unit(&self) -> (&'static str, f64) {
        match self.subject {
            Subject::Distances => ("CPU time per ray and object (ns)", 1e9),
            Subject::Methods | Subject::Samples | Subject::Depth | Subject::Whole => {
                ("CPU time per pixel (µs)", 1e6)
            }
        }
    }

    /// Returns the error below which errors do not matter: for a colour, far less than one level of a channel.
    pub fn negligible(&self) -> f64 {
        match self.subject {
            Subject::Distances => 0.0,
            Subject::Methods | Subject::Samples | Subject::Depth | Subject::Whole => 1e-9,
        }
    }
}

/// The greatest noise and the greatest waiting time, as fractions, for times that can be trusted.
const MAX_NOISE: f64 = 0.15;

impl Chart {
    /// Returns the relative excess of the median round over the shortest: the median over all choices.
    pub fn noise(&self) -> f64 {
        self.middle(Times::spread)
    }

    /// Returns the time that rounds waited for other work of the machine, as a fraction of the time that they took: the
    /// median over all choices.
    pub fn waited(&self) -> f64 {
        self.middle(|times| times.waited)
    }

    /// Tells whether the times are too noisy to be trusted.
    pub fn is_noisy(&self) -> bool {
        self.noise() > MAX_NOISE
    }

    /// Tells whether the machine had other work, which slows all choices alike.
    pub fn is_busy(&self) -> bool {
        self.waited() > MAX_NOISE
    }

    /// Tells whether the times are in doubt for one of these reasons.
    pub fn is_doubtful(&self) -> bool {
        self.is_noisy() || self.is_busy()
    }

    /// Tells whether a choice has wrong or inaccurate hits in any panel.
    pub fn has_faults(&self, choice: &str) -> bool {
        let mut points = self.panels.iter().flat_map(|panel| &panel.points);
        points.any(|point| point.name == choice && point.wrong.faults() > 0)
    }

    /// Tells whether a point is kept from the front by what its choice does in another panel.
    pub fn is_barred(&self, point: &Point) -> bool {
        point.wrong.faults() == 0 && self.has_faults(&point.name)
    }

    fn middle(&self, of: impl Fn(&Times) -> f64) -> f64 {
        // The whole image is timed in its own way, without a median.
        let panels = self.panels.iter().filter(|panel| panel.subject != Subject::Whole);
        let points = panels.flat_map(|panel| &panel.points);
        let mut parts: Vec<f64> = points.map(|point| of(&point.times)).collect();
        parts.sort_unstable_by(f64::total_cmp);
        parts.get(parts.len() / 2).copied().unwrap_or(0.0)
    }
}
