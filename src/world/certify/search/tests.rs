//! Tests of searches.

use super::*;
use crate::certify::equation::Equation;
use glam::DVec3;
use std::cell::Cell;
use tabray_exact::scalar::Scalar;

/// The equations of the tests. They are one type, because searches are compiled for each type.
#[derive(Clone, Copy)]
enum Formula {
    /// A profile's step at x = 0.3.
    Step,
    /// A plane whose equation is squared, at x = 1/3.
    Squared,
    /// A wave without zeros, whose crests come closer and closer together at x = 0.
    Waves,
    /// A plane at x = 0.7, and what is nearly one at x = 1/3.
    Planes,
    /// A formula that is 0 on one side of a plane.
    Half,
}

/// An equation, and the numbers of times that it was evaluated, with 53 bits and with more.
struct Counted(Formula, [Cell<usize>; 2]);

impl Counted {
    fn new(formula: Formula) -> Self {
        Self(formula, Default::default())
    }

    /// Returns the numbers of evaluations since the last call.
    fn take(&self) -> [usize; 2] {
        self.1.each_ref().map(Cell::take)
    }

    fn total(&self) -> usize {
        self.take().iter().sum()
    }
}

impl Equation for Counted {
    fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
        let count = &self.1[usize::from(size_of::<N>() >= size_of::<Interval<Fraction>>())];
        count.set(count.get() + 1);
        let n = N::constant;
        let third = || x - n(1.0) / n(3.0);
        match self.0 {
            Formula::Step => (x - n(0.3)).floor() + n(0.5),
            Formula::Squared => third().powi(2) * (y + n(7.0)),
            Formula::Waves => {
                let wave = (n(1.0) / x).sin();
                wave * wave + n(0.5) + n(0.1) * y
            }
            Formula::Planes => (third().powi(2) + n(1e-20)) * (x - n(0.7)) * (y + n(7.0)),
            Formula::Half => x.max(n(0.0)),
        }
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

#[test]
fn a_shape_smaller_than_rounding_is_in_doubt_after_a_few_pieces() {
    let step = Counted::new(Formula::Step);
    let third = |x| Interval::<Fraction>::constant(x) / Interval::constant(3.0);
    let line =
        Line { origin: [third(1e90), third(0.5), third(0.5)], dir: [third(-1.0), third(0.0), third(0.0)] };
    let found = first_hit(&step, &line, false, 2000);
    assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
    let count = step.total();
    assert!(count < 100, "{count} evaluations");
}

#[test]
fn a_jump_is_left_in_doubt_after_a_few_pieces() {
    let step = Counted::new(Formula::Step);
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]].map(|of| of.map(Interval::<Fraction>::constant));
    let HitEnclosure::Doubtful(from) = first_hit(&step, &Line { origin, dir }, false, 2000) else {
        panic!("a jump is no root")
    };
    assert!((from.to_f64() - 2.3).abs() < 1e-14, "{from:?}");
    let count = step.total();
    assert!(count < 200, "{count} evaluations");
}

#[test]
fn a_touch_is_left_in_doubt_after_a_few_pieces() {
    let squared = Counted::new(Formula::Squared);
    let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<Fraction>::constant));
    let HitEnclosure::Doubtful(from) = first_hit(&squared, &Line { origin, dir }, false, 2000) else {
        panic!("no digits tell a touch from a miss")
    };
    let third = Fraction::from(7.0) / Fraction::from(3.0);
    assert!(from <= third && third - from < Fraction::from(1e-30), "{from:?}");
    let count = squared.total();
    assert!(count < 100, "{count} evaluations");
}

#[test]
fn many_digits_are_spent_only_where_few_leave_a_hit_in_doubt() {
    let step = Counted::new(Formula::Step);
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
    first_hit::<f64>(&step, &line, false, 2000);
    let few = step.total();
    let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
    let found = first_hit_in_turns((&step, &step), &line, false, [2000; 2]);
    assert!(
        matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 2.3).abs() < 1e-14),
        "{found:?}"
    );
    let count = step.total();
    assert!(count < few + 20, "{count} evaluations, {few} of them with 53 bits");
}

#[test]
fn waves_without_end_are_given_up() {
    let waves = Counted::new(Formula::Waves);
    let [origin, dir] = [[-2.0, 1.5, 0.5], [1.0, -0.25, 0.0]].map(|of| of.map(Interval::constant));
    let found = first_hit_in_turns((&waves, &waves), &Line { origin, dir }, false, [400, 20]);
    assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
    let [few, more] = waves.take();
    assert!(few <= 4 * 400 && more <= 4 * 20, "{few} and {more} evaluations");
}

#[test]
fn what_few_digits_leave_open_is_decided_by_more_and_from_there_few_go_on() {
    let planes = Counted::new(Formula::Planes);
    let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::constant));
    let found = first_hit_in_turns((&planes, &planes), &Line { origin, dir }, false, [2000; 2]);
    let HitEnclosure::Hits(at) = found else { panic!("{found:?}") };
    assert!((at.low.to_f64() - 2.7).abs() < 1e-15, "{at:?}");
    let [few, more] = planes.take();
    assert!(few < 400 && more < 120, "{few} and {more} evaluations");
}

#[test]
fn where_a_formula_is_0_all_along_a_piece_it_is_not_cut() {
    let half = Counted::new(Formula::Half);
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<Fraction>::constant));
    let found = first_hit(&half, &Line { origin, dir }, false, 2000);
    assert!(
        // The box is a little larger than the extent.
        matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 1.0).abs() < 1e-11),
        "{found:?}"
    );
    let count = half.total();
    assert!(count < 10, "{count} evaluations");
}
