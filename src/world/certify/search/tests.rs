//! Tests of searches.

use super::*;
use crate::certify::equation::Equation;
use glam::DVec3;
use std::cell::Cell;
use tabray_exact::scalar::Scalar;

/// A profile's step at x = 0.3, and the number of times that it was evaluated.
struct Step(Cell<usize>);

impl Equation for Step {
    fn value<N: Scalar>(&self, [x, _, _]: [N; 3]) -> N {
        self.0.set(self.0.get() + 1);
        (x - N::constant(0.3)).floor() + N::constant(0.5)
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

#[test]
fn a_shape_smaller_than_rounding_is_in_doubt_after_a_few_pieces() {
    let step = Step(Cell::new(0));
    let third = |x| Interval::<f256>::constant(x) / Interval::constant(3.0);
    let line =
        Line { origin: [third(1e90), third(0.5), third(0.5)], dir: [third(-1.0), third(0.0), third(0.0)] };
    let found = first_hit(&step, &line, false, 2000);
    assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
    assert!(step.0.get() < 100, "{} evaluations", step.0.get());
}

#[test]
fn a_jump_is_left_in_doubt_after_a_few_pieces() {
    let step = Step(Cell::new(0));
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]].map(|of| of.map(Interval::<f256>::constant));
    let HitEnclosure::Doubtful(from) = first_hit(&step, &Line { origin, dir }, false, 2000) else {
        panic!("a jump is no root")
    };
    assert!((from.to_f64() - 2.3).abs() < 1e-14, "{from:?}");
    assert!(step.0.get() < 200, "{} evaluations", step.0.get());
}

/// A plane whose equation is squared, at x = 1/3, and the number of times that it was evaluated.
struct Squared(Cell<usize>);

impl Equation for Squared {
    fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
        self.0.set(self.0.get() + 1);
        (x - N::constant(1.0) / N::constant(3.0)).powi(2) * (y + N::constant(7.0))
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

#[test]
fn a_touch_is_left_in_doubt_after_a_few_pieces() {
    let squared = Squared(Cell::new(0));
    let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<f256>::constant));
    let HitEnclosure::Doubtful(from) = first_hit(&squared, &Line { origin, dir }, false, 2000) else {
        panic!("no digits tell a touch from a miss")
    };
    let third = f256::from(7.0) / f256::from(3.0);
    assert!(from <= third && third - from < f256::from(1e-30), "{from:?}");
    assert!(squared.0.get() < 100, "{} evaluations", squared.0.get());
}

#[test]
fn many_digits_are_spent_only_where_few_leave_a_hit_in_doubt() {
    let step = Step(Cell::new(0));
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
    first_hit::<f64>(&step, &line, false, 2000);
    let few = step.0.replace(0);
    let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
    let found = first_hit_in_turns((&step, &step), &line, false, [2000; 2]);
    assert!(
        matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 2.3).abs() < 1e-14),
        "{found:?}"
    );
    assert!(step.0.get() < few + 20, "{} evaluations, {few} of them with 53 bits", step.0.get());
}

/// A wave without zeros, whose crests come closer and closer together at x = 0, and the number of times that it was
/// evaluated, with 53 bits and with more.
struct Waves([Cell<usize>; 2]);

impl Equation for Waves {
    fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
        count_by_size::<N>(&self.0);
        let wave = (N::constant(1.0) / x).sin();
        wave * wave + N::constant(0.5) + N::constant(0.1) * y
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

fn count_by_size<N>(counts: &[Cell<usize>; 2]) {
    let count = &counts[usize::from(size_of::<N>() >= size_of::<Interval<f256>>())];
    count.set(count.get() + 1);
}

#[test]
fn waves_without_end_are_given_up() {
    let waves = Waves(Default::default());
    let [origin, dir] = [[-2.0, 1.5, 0.5], [1.0, -0.25, 0.0]].map(|of| of.map(Interval::constant));
    let found = first_hit_in_turns((&waves, &waves), &Line { origin, dir }, false, [400, 20]);
    assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
    let [few, more] = waves.0.map(Cell::into_inner);
    assert!(few <= 4 * 400 && more <= 4 * 20, "{few} and {more} evaluations");
}

/// A plane at x = 0.7, and what is nearly one at x = 1/3, with the numbers of evaluations.
struct Planes([Cell<usize>; 2]);

impl Equation for Planes {
    fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
        count_by_size::<N>(&self.0);
        let third = x - N::constant(1.0) / N::constant(3.0);
        (third.powi(2) + N::constant(1e-20)) * (x - N::constant(0.7)) * (y + N::constant(7.0))
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

#[test]
fn what_few_digits_leave_open_is_decided_by_more_and_from_there_few_go_on() {
    let planes = Planes(Default::default());
    let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::constant));
    let found = first_hit_in_turns((&planes, &planes), &Line { origin, dir }, false, [2000; 2]);
    let HitEnclosure::Hits(at) = found else { panic!("{found:?}") };
    assert!((at.low.to_f64() - 2.7).abs() < 1e-15, "{at:?}");
    let [few, more] = planes.0.map(Cell::into_inner);
    assert!(few < 400 && more < 120, "{few} and {more} evaluations");
}

/// A formula that is 0 on one side of a plane, and the number of times that it was evaluated.
struct Half(Cell<usize>);

impl Equation for Half {
    fn value<N: Scalar>(&self, [x, _, _]: [N; 3]) -> N {
        self.0.set(self.0.get() + 1);
        x.max(N::constant(0.0))
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }
}

#[test]
fn where_a_formula_is_0_all_along_a_piece_it_is_not_cut() {
    let half = Half(Cell::new(0));
    let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<f256>::constant));
    let found = first_hit(&half, &Line { origin, dir }, false, 2000);
    assert!(
        // The box is a little larger than the extent.
        matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 1.0).abs() < 1e-11),
        "{found:?}"
    );
    assert!(half.0.get() < 10, "{} evaluations", half.0.get());
}
