//! Counts what a method gets wrong.

use super::{Hit, Truth};
use std::fmt;
use tabray::exact::double_double::DoubleDouble;
use tabray::geometry::MISS;

/// Returns the size of an ulp: the distance from a number to the next.
pub fn ulp(number: f64) -> f64 {
    number.abs().next_up() - number.abs()
}

/// The outcome of a set of rays.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of rays.
    pub rays: usize,
    /// The number of true hits.
    pub hits: usize,
    /// The number of rays whose truth is not known.
    pub undecided: usize,
    /// The number of hits that were not found.
    pub missed: usize,
    /// The number of hits that were found where there are none.
    pub invented: usize,
    /// The number of hits that were found at a later crossing than the first.
    pub later: usize,
    /// The errors of the distances of all other hits, sorted after [`finish`](Self::finish).
    pub errors: Vec<f64>,
    /// The greatest of these errors, in ulps of the distance.
    pub ulps: f64,
    /// The greatest distance of these hits from the surface.
    pub off_surface: f64,
    /// The first wrong ray: its index, its truth and the distance that was found.
    pub first_wrong: Option<(usize, Truth, f64)>,
}

/// A method's tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// An error up to which a hit certainly belongs to the first crossing.
    pub sure: f64,
    /// An error from which a hit belongs to another crossing in any case.
    pub most: f64,
}

impl Tally {
    /// Counts a ray. `next` returns the truth beyond a distance along the ray, and `off_surface` the distance from the
    /// surface of a point of the ray.
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
                    // On a ledge the surface's function does not tell, but the point is no farther off than along the
                    // ray.
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

    /// Returns the number of wrong rays.
    pub fn wrong(&self) -> usize {
        self.missed + self.invented + self.later
    }

    /// Returns the median error.
    pub fn median(&self) -> f64 {
        self.errors.get(self.errors.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Returns the greatest error.
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

/// Returns the error of a distance.
fn distance(right: DoubleDouble, found: f64) -> f64 {
    (DoubleDouble::from(found) - right).high.abs()
}

/// Tells whether the distance that was found belongs to another crossing than this hit.
fn is_another(hit: Hit, found: f64, tolerance: Tolerance, next: impl FnOnce(f64) -> Truth) -> bool {
    let error = distance(hit.t, found);
    if error.is_nan() || error > tolerance.most {
        return true;
    }
    error > tolerance.sure
        && next(hit.t.high.next_up()).hit().is_some_and(|next| distance(next.t, found) < error)
}
