//! First hits of a surface whose equation is a polynomial, found from its coefficients along the line, rounded or
//! exact.

use super::check::{self, Trail};
use super::equation::{HitEnclosure, Values, hit_at, is_kept, may_be_hit};
use crate::geometry::sight::{Line, Sight};
use tabray_exact::formula::field::Field;
use tabray_exact::formula::rational::Rational;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_exact::polynomial::{Coefficient, MAX_COEFFICIENTS, Polynomial};
use tabray_exact::roots::isolation::{self, RootPart};
use tabray_exact::roots::whole::Root;
use tabray_exact::scalar::per_axis;

/// Finds the first hit with t > 0 of a line in world coordinates; `None` where the equation is no polynomial. With
/// `leaves`, the line's true start lies on the shape, and the result is also `None` where the root at the start is
/// not told from others.
pub(super) fn first_hit<C: Coefficient>(
    shape: &dyn Values<Interval<C::End>>,
    line: &Line<Interval<C::End>>,
    leaves: bool,
) -> Option<HitEnclosure<C::End>> {
    let (line, mut trail, mut first) = (shape.to_local(*line), Trail::default(), HitEnclosure::Misses);
    visit_hits::<C>(shape, &line, leaves, &mut trail, &mut |hit| {
        first = hit;
        true
    })?;
    let first = check::first(shape, &line, first, &trail);
    (!(leaves && matches!(first, HitEnclosure::Doubtful(_)))).then_some(first)
}

/// Finds the hits with t > 0 in order, up to the first that is open; `None` where [`first_hit`] returns `None`.
pub(super) fn all_hits<C: Coefficient>(
    shape: &dyn Values<Interval<C::End>>,
    line: &Line<Interval<C::End>>,
    leaves: bool,
) -> Option<Vec<HitEnclosure<C::End>>> {
    let (line, mut trail, mut all) = (shape.to_local(*line), Trail::default(), Vec::new());
    visit_hits::<C>(shape, &line, leaves, &mut trail, &mut |hit| {
        all.push(hit);
        !matches!(hit, HitEnclosure::Hits(_))
    })?;
    let all = check::all(shape, &line, all, &trail);
    (!(leaves && matches!(all[..], [HitEnclosure::Doubtful(_), ..]))).then_some(all)
}

/// Visits the hits with t > 0 of a line in the equation's coordinates, in order, until the visitor returns true; `None`
/// where the equation is no polynomial. Notes the ends of the pieces that have no root.
fn visit_hits<C: Coefficient>(
    shape: &dyn Values<Interval<C::End>>,
    line: &Line<Interval<C::End>>,
    leaves: bool,
    trail: &mut Trail,
    visit: &mut dyn FnMut(HitEnclosure<C::End>) -> bool,
) -> Option<()> {
    let (along_lines, zero) = (shape.polynomial()?, C::End::of(0.0));
    let [low, high] = shape.widened_extent();
    let part = line.clip(low, high);
    trail.clip(part);
    let Some((mut from, to)) = part else { return Some(()) };
    if !to.is_finite() {
        return None;
    }
    if leaves {
        // The root at the start lies inside the piece, not at its end.
        from = from - (to - from) * C::End::of(0.125);
    }
    // The parameter counts from near the shape, so a piece of the line is not a small difference of large numbers.
    let half = (Interval::point(to) - Interval::point(from)).high * C::End::of(0.5);
    let base = Interval::point(from + half);
    let near = Line { origin: line.at(base), dir: line.dir };
    let along = Polynomial::<C, MAX_COEFFICIENTS>::along(Interval { low: -1.0, high: 1.0 });
    let place = |axis: usize| {
        let step = near.dir[axis] * Interval::point(half);
        Polynomial::enclosed(near.origin[axis]) + Polynomial::enclosed(step) * along
    };
    let polynomial = along_lines.polynomial(per_axis(place));
    polynomial.degree()?;
    let interval = |[low, high]: [C; 2]| {
        let [low, high] = [low.bounds(0.0).low, high.bounds(0.0).high];
        Interval::point(half) * Interval { low, high }
    };
    // The start is the only root of a part that it is certainly in.
    let is_start = |[low, high]: [C; 2]| {
        let place = |end: C| base + Interval::point(half) * end.bounds(0.0);
        leaves && place(low).high < zero && place(high).low > zero
    };
    let (near_base, near_half) = (base.low.to_f64(), half.to_f64());
    let mut hit = |part: RootPart<C>| match part {
        RootPart::Free([low, _]) => {
            trail.places.push(near_base + near_half * low.nearest());
            None
        }
        RootPart::Root { ends, rises } => {
            let at = interval(isolation::enclosed(&polynomial, ends, rises));
            let distance = base + at;
            if distance.high <= zero || distance.low <= zero && is_start(ends) {
                return None;
            }
            if distance.low <= zero {
                return Some(HitEnclosure::Doubtful(zero));
            }
            hit_at(shape, &near, at, distance)
        }
        RootPart::Hidden(ends) => {
            let at = interval(ends);
            // A root that is certainly cut off is no hit.
            let is_open = may_be_hit(shape, &near, at) && (base + at).high > zero;
            is_open.then(|| HitEnclosure::Doubtful((base + at).low.max(zero)))
        }
    };
    isolation::visit(&polynomial, |part| hit(part).filter(|hit| visit(*hit)).map(drop));
    Some(())
}

/// Finds the first hit with t > 0 of a ray exactly; `None` where the equation is no polynomial, or if its coefficients
/// or the numbers of the ray are not fractions of few enough digits.
pub(super) fn exact_hit(shape: &dyn Values<Wide>, sight: &Sight) -> Option<HitEnclosure<Fraction>> {
    let along_lines = shape.polynomial()?;
    let near = shape.to_local(sight.line());
    let [origin, dir] = exact_line(&near)?;
    let polynomial = along_lines.exactly(&origin, &dir)?;
    let poles = match shape.field().and_then(Field::poles) {
        Some(poles) => Some(poles.along_lines().exactly(&origin, &dir)?),
        None => None,
    };
    let [low, high] = shape.widened_extent();
    let (part, mut trail) = (near.clip(low, high), Trail::default());
    trail.clip(part);
    let Some((from, to)) = part else {
        return Some(check::first(shape, &near, HitEnclosure::Misses, &trail));
    };
    let [from, to] = [from.to_f64().next_down().max(0.0), to.to_f64().next_up()];
    if !to.is_finite() {
        return None;
    }
    let is_hit = |at: Wide| {
        let kept = (at.high > Fraction::of(0.0)).then(|| is_kept(shape, &near, at));
        kept.unwrap_or(Some(false))
    };
    let is_pole = |root: &Root| poles.as_ref().is_some_and(|poles| polynomial.shares(root, poles));
    let is_wanted = |root: &Root| is_hit(root.wide()) != Some(false) && !is_pole(root);
    let root = polynomial.first_root(from, to, &is_wanted);
    trail.touches = root.as_ref().is_some_and(|root| root.rises.is_none());
    let found = match root.map(|root| root.wide()) {
        None => HitEnclosure::Misses,
        Some(at) if is_hit(at).is_some() => HitEnclosure::Hits(at),
        Some(at) => HitEnclosure::Edge(at),
    };
    Some(check::first(shape, &near, found, &trail))
}

/// Returns the start and the direction of a line, if its numbers are exact.
pub fn exact_line(line: &Line<Wide>) -> Option<[[Rational; 3]; 2]> {
    let exact = |of: &Wide| if of.low == of.high { Rational::of(of.low) } else { None };
    let all = |[x, y, z]: &[Wide; 3]| Some([exact(x)?, exact(y)?, exact(z)?]);
    Some([all(&line.origin)?, all(&line.dir)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certify::equation::Equation;
    use f256::f256;
    use glam::DVec3;
    use std::cell::Cell;
    use tabray_exact::formula::along::AlongLines;
    use tabray_exact::scalar::Scalar;

    /// Three planes, and the number of times that their equation was evaluated.
    struct Planes {
        count: Cell<usize>,
        along_lines: AlongLines,
    }

    const PLACES: [f64; 3] = [-0.5, 0.25, 0.75];

    fn product<N: Scalar>([x, _, _]: [N; 3]) -> N {
        PLACES.map(|place| x - N::constant(place)).into_iter().fold(N::constant(1.0), |all, one| all * one)
    }

    fn planes() -> Planes {
        Planes { count: Cell::new(0), along_lines: AlongLines::recorded(product).expect("a polynomial") }
    }

    impl Equation for Planes {
        fn value<N: Scalar>(&self, at: [N; 3]) -> N {
            self.count.update(|count| count + 1);
            product(at)
        }

        fn polynomial(&self) -> Option<&AlongLines> {
            Some(&self.along_lines)
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn a_line_that_leaves_a_root_finds_the_next_one_without_a_search() {
        let planes = planes();
        for (start, next) in PLACES.into_iter().zip([Some(0.75), Some(0.5), None]) {
            let error = Fraction::from(1e-40);
            let x = Interval { low: Fraction::from(start) - error, high: Fraction::from(start) + error };
            let [y, z] = [0.1, 0.2].map(Interval::constant);
            let line = Line { origin: [x, y, z], dir: [1.0, 0.0, 0.0].map(Interval::constant) };
            match (first_hit::<f256>(&planes, &line, true), next) {
                (Some(HitEnclosure::Hits(at)), Some(next)) => {
                    assert!(
                        at.low <= Fraction::from(next) && Fraction::from(next) <= at.high,
                        "{at:?} from {start}"
                    );
                }
                (Some(HitEnclosure::Misses), None) => {}
                (found, _) => panic!("{found:?} from {start}"),
            }
        }
        assert_eq!(planes.count.get(), 0);
    }

    #[test]
    fn a_simple_root_where_a_piece_is_halved_is_a_hit() {
        let error = Fraction::from(1e-60);
        let x = Interval { low: Fraction::from(-2.0) - error, high: Fraction::from(-2.0) + error };
        let [y, z] = [0.1, 0.2].map(Interval::constant);
        let line = Line { origin: [x, y, z], dir: [1.0, 0.0, 0.0].map(Interval::constant) };
        let found = first_hit::<f256>(&planes(), &line, false);
        let Some(HitEnclosure::Hits(at)) = found else { panic!("{found:?}") };
        let at = (at.low.to_f64(), at.high.to_f64());
        assert_eq!(at, (1.5, 1.5));
    }
}
