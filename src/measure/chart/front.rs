//! The Pareto front: the choices that no other choice beats.

use super::data::{Chart, Panel, Point};

/// The ratio up to which times count as equal.
pub const SAME_TIME: f64 = 1.1;

/// The ratio up to which errors count as equal.
const SAME_ERROR: f64 = 1.5;

/// Marks the points that are beaten by none, of those that count. Errors up to `negligible` count as equal.
fn of(points: &[Point], counts: impl Fn(&Point) -> bool, negligible: f64) -> Vec<bool> {
    let is_best =
        |point: &Point| counts(point) && fastest_dominating(points, &counts, point, negligible).is_none();
    points.iter().map(is_best).collect()
}

/// Returns the fastest choice that beats `beaten`, if any of those that count does.
pub fn fastest_dominating<'p>(
    points: &'p [Point],
    counts: impl Fn(&Point) -> bool,
    beaten: &Point,
    negligible: f64,
) -> Option<&'p Point> {
    points
        .iter()
        .filter(|other| counts(other) && dominates(other, beaten, negligible))
        .min_by(|a, b| a.times.least.total_cmp(&b.times.least))
}

/// Tells whether `one` is as fast and as accurate as `other`, and clearly faster or clearly more accurate.
fn dominates(one: &Point, other: &Point, negligible: f64) -> bool {
    let time = one.times.least / other.times.least;
    let [error, than] = [one, other].map(|point| point.error.max(negligible));
    time <= SAME_TIME && error <= SAME_ERROR * than && (time * SAME_TIME < 1.0 || error * SAME_ERROR < than)
}

impl Chart {
    /// Marks the points of a panel that are on the Pareto front: those that no other beats, of the choices that have no
    /// wrong or inaccurate hits in any panel.
    pub fn front(&self, panel: &Panel) -> Vec<bool> {
        of(&panel.points, |point| !self.has_faults(&point.name), panel.negligible())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Family, Times, WrongHits};

    fn point(time: f64, error: f64, missed: usize) -> Point {
        Point {
            name: String::new(),
            family: Family::Own,
            is_default: false,
            times: Times { least: time, median: time, rounds: 1, waited: 0.0 },
            error,
            worst: error,
            wrong: WrongHits { of: 9, missed, ..WrongHits::default() },
            visible: None,
            changed: None,
            samples: 1,
        }
    }

    #[test]
    fn the_front_is_what_none_beats() {
        let points = [
            point(1.0, 1e-3, 0),
            point(2.0, 1e-6, 0),
            point(2.1, 1e-6, 0),
            point(3.0, 1e-6, 0),
            point(3.0, 0.0, 0),
            point(0.1, 1e-9, 1),
        ];
        let is_right = |point: &Point| point.wrong.count() == 0;
        assert_eq!(of(&points, is_right, 0.0), [true, true, true, false, true, false]);
        assert_eq!(of(&points, is_right, 1e-5), [true, true, true, false, false, false]);
    }
}
