//! What a method gets wrong, counted.

use super::{Hit, Truth};
use std::fmt;
use tabray::geometry::MISS;
use tabray::numeric::double_double::DoubleDouble;

/// The distance from one number to the next.
pub fn ulp(number: f64) -> f64 {
    number.abs().next_up() - number.abs()
}

/// How a set of rays went.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The rays.
    pub rays: usize,
    /// The hits that there are.
    pub hits: usize,
    /// The rays whose truth is not known.
    pub undecided: usize,
    /// The hits that were not found.
    pub missed: usize,
    /// The hits that were found where there is none.
    pub invented: usize,
    /// The hits that were found at another crossing than the first.
    pub later: usize,
    /// The distances' errors of all other hits, sorted once [`finish`](Self::finish)ed.
    pub errors: Vec<f64>,
    /// The greatest of them in units in the last place of the distance.
    pub ulps: f64,
    /// How far off the surface the worst of these hits is.
    pub off_surface: f64,
    /// The first ray that went wrong, by its index, what is true and what was found.
    pub first_wrong: Option<(usize, Truth, f64)>,
}

/// A method's tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// An error that is certainly none in the choice of a crossing.
    pub sure: f64,
    /// An error that is one in any case.
    pub most: f64,
}

impl Tally {
    /// Counts a ray. `next` is the truth farther along the ray than a distance, and `off_surface` how far a distance
    /// is off the surface.
    pub fn count(
        &mut self,
        truth: Truth,
        found: f64,
        tolerance: Tolerance,
        next: impl FnOnce(f64) -> Truth,
        off_surface: impl FnOnce(f64) -> f64,
    ) {
        let index = self.rays;
        self.rays += 1;
        let is_right = match truth {
            Truth::Undecided => {
                self.undecided += 1;
                return;
            }
            Truth::Miss => {
                self.invented += usize::from(found != MISS);
                found == MISS
            }
            Truth::Hit(hit) => {
                self.hits += 1;
                if found == MISS {
                    self.missed += 1;
                    false
                } else if is_another(hit, found, tolerance, next) {
                    self.later += 1;
                    false
                } else {
                    let error = distance(hit.t, found);
                    self.errors.push(error);
                    self.ulps = self.ulps.max(error / ulp(hit.t.high));
                    // On a ledge the surface's function does not say, but the ray cannot be farther off than along it.
                    self.off_surface = self.off_surface.max(off_surface(found).min(error));
                    true
                }
            }
        };
        if !is_right && self.first_wrong.is_none() {
            self.first_wrong = Some((index, truth, found));
        }
    }

    /// Sorts the errors.
    pub fn finish(mut self) -> Self {
        self.errors.sort_by(f64::total_cmp);
        self
    }

    /// How many rays went wrong.
    pub fn wrong(&self) -> usize {
        self.missed + self.invented + self.later
    }

    /// The error that half of the hits do not exceed.
    pub fn median(&self) -> f64 {
        self.errors.get(self.errors.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// The greatest error.
    pub fn worst(&self) -> f64 {
        self.errors.last().copied().unwrap_or(f64::NAN)
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, hits, undecided, missed, invented, later, .. } = self;
        write!(
            f,
            "{rays} rays, {hits} hits, {undecided} undecided: {missed} missed, {invented} invented, {later} later; \
             off by {:.1e}, at most {:.1e} or {:.1} ulp; off the surface by {:.1e}",
            self.median(),
            self.worst(),
            self.ulps,
            self.off_surface
        )
    }
}

/// How far a distance is from the true one.
fn distance(right: DoubleDouble, found: f64) -> f64 {
    (DoubleDouble::from(found) - right).high.abs()
}

/// Whether what was found is another crossing than this hit.
fn is_another(hit: Hit, found: f64, tolerance: Tolerance, next: impl FnOnce(f64) -> Truth) -> bool {
    let error = distance(hit.t, found);
    if error.is_nan() || error > tolerance.most {
        return true;
    }
    error > tolerance.sure
        && next(hit.t.high.next_up()).hit().is_some_and(|next| distance(next.t, found) < error)
}
