//! Lines and triangles in integers: whether a line of fractions crosses a triangle, and where. Nothing is rounded, and
//! so a line through an edge or a corner is decided like any other.

use crate::formula::rational::Rational;
use crate::interval::Wide;
use crate::roots::whole::Dyadic;
use dashu_int::IBig;
use std::borrow::Cow;
use std::cmp::Ordering;

/// The maximum number of bits between the smallest and the largest coordinate: those of `f64` have 2100.
const MAX_BITS: i64 = 1 << 13;

/// Exponents are multiples of this number, so that most points have one in common.
const EXPONENT_STEP: i64 = 32;

/// A line of fractions, scaled to integers.
#[derive(Clone, Debug)]
pub struct WholeLine {
    origin: [IBig; 3],
    dir: [IBig; 3],
    /// The axis along which the direction is largest.
    along: usize,
    /// A coordinate of the start times this number, over two to the power `exponent`, is an integer.
    factor: IBig,
    exponent: i64,
    /// A component of the direction times this number, over two to the power `dir_exponent`, is an integer.
    dir_factor: IBig,
    dir_exponent: i64,
}

/// A point as it is seen along a line.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The vector from the line's start.
    from_start: [IBig; 3],
    /// The coordinates across the line, after a shear that makes the line an axis.
    across: [IBig; 2],
    /// The exponent of both, at most that of the line's start.
    exponent: i64,
}

impl Seen {
    /// Returns the point with another exponent, which is no larger.
    fn scaled(&self, exponent: i64) -> Cow<'_, Self> {
        let more = (self.exponent - exponent) as usize;
        if more == 0 {
            return Cow::Borrowed(self);
        }
        let Self { from_start, across, .. } = self;
        let (from_start, across) =
            (from_start.each_ref().map(|of| of << more), across.each_ref().map(|of| of << more));
        Cow::Owned(Self { from_start, across, exponent })
    }
}

/// The place where a line crosses a triangle, beyond the line's start.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The place along the line, a fraction with a positive denominator.
    numerator: IBig,
    denominator: IBig,
    /// Whether the corners run counterclockwise as seen from the line's start.
    pub enters: bool,
    /// Whether a line beside this one crosses the triangle: one whose start is moved by an infinitesimal distance along
    /// x, by a far smaller one along y, and by an even smaller one along z (Edelsbrunner and Mücke 1990). It meets no
    /// edge.
    pub is_beside: bool,
}

impl PartialEq for Crossing {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Crossing {}

impl PartialOrd for Crossing {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Crossings of one line are ordered by their places.
impl Ord for Crossing {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

impl WholeLine {
    /// Prepares a line, given its start and its direction. Returns `None` for a line without a direction, and if the
    /// numbers are of too different magnitudes.
    pub fn new([origin, dir]: &[[Rational; 3]; 2]) -> Option<Self> {
        let (origin, factor, exponent) = whole(origin, EXPONENT_STEP)?;
        let (dir, dir_factor, dir_exponent) = whole(dir, 1)?;
        let size = |axis: &usize| if sign(&dir[*axis]).is_lt() { -&dir[*axis] } else { dir[*axis].clone() };
        let along = (0..3).max_by_key(size).filter(|axis| !dir[*axis].is_zero())?;
        Some(Self { origin, dir, along, factor, exponent, dir_factor, dir_exponent })
    }

    /// Returns a point as it is seen along the line; `None` if its numbers and those of the line are of too different
    /// magnitudes.
    pub fn seen(&self, at: [f64; 3]) -> Option<Seen> {
        let parts = at.map(Dyadic::from);
        let exponents = parts.each_ref().map(|part| part.exponent);
        let exponent = exponents.iter().map(|of| stepped(*of, EXPONENT_STEP)).fold(self.exponent, i64::min);
        let finer = self.exponent - exponent;
        if exponents.iter().map(|of| of - exponent).fold(finer, i64::max) > MAX_BITS {
            return None;
        }
        let place = |axis: usize| {
            let scaled = &parts[axis].digits << (exponents[axis] - exponent) as usize;
            scaled * &self.factor - (&self.origin[axis] << finer as usize)
        };
        let (from_start, along) = ([place(0), place(1), place(2)], self.along);
        let across = [1, 2].map(|next| {
            let axis = (along + next) % 3;
            &from_start[axis] * &self.dir[along] - &from_start[along] * &self.dir[axis]
        });
        Some(Seen { from_start, across, exponent })
    }

    /// Returns where the line crosses a triangle, whose edges belong to it. A line in the plane of the triangle does
    /// not cross it.
    pub fn crossing(&self, corners: [&Seen; 3]) -> Option<Crossing> {
        let exponent = corners.iter().map(|corner| corner.exponent).fold(self.exponent, i64::min);
        let scaled = corners.map(|corner| corner.scaled(exponent));
        let corners = scaled.each_ref().map(|corner| &**corner);
        let [a, b, c] = corners;
        let edges = [[b, c], [c, a], [a, b]];
        // Each is the triple product of the edge's ends and the direction, times the direction's largest component.
        let sides = edges.map(|[from, to]| &from.across[0] * &to.across[1] - &from.across[1] * &to.across[0]);
        let signs = sides.each_ref().map(sign);
        if signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater) {
            return None;
        }
        let sum = sides.iter().fold(IBig::ZERO, |sum, side| sum + side);
        let mut denominator = &sum * &self.dir[self.along];
        if denominator.is_zero() {
            return None;
        }
        let parts = sides.iter().zip(corners).filter(|(side, _)| !side.is_zero());
        let mut numerator = parts.fold(IBig::ZERO, |all, (side, at)| all + side * &at.from_start[self.along]);
        // The product of the normal and the direction has the sign of this quotient.
        let enters = sign(&denominator).is_lt();
        if enters {
            (numerator, denominator) = (-numerator, -denominator);
        }
        // The places of all crossings count in the unit of the line's start.
        denominator <<= (self.exponent - exponent) as usize;
        let moved = |[from, to]: [&Seen; 2], side: Ordering| match side {
            Ordering::Equal => self.moved(from, to),
            _ if sign(&self.dir[self.along]).is_lt() => side.reverse(),
            _ => side,
        };
        let turn = if enters { Ordering::Less } else { Ordering::Greater };
        let is_beside = edges.into_iter().zip(signs).all(|(edge, side)| moved(edge, side) == turn);
        sign(&numerator).is_gt().then_some(Crossing { numerator, denominator, enters, is_beside })
    }

    /// Tells on which side of an edge that the line meets the moved line passes.
    fn moved(&self, from: &Seen, to: &Seen) -> Ordering {
        let edge = |axis: usize| &to.from_start[axis] - &from.from_start[axis];
        // The derivative of the triple product along an axis is a component of the cross product of the direction and
        // the edge.
        let part = |(u, v): (usize, usize)| sign(&(&self.dir[u] * edge(v) - &self.dir[v] * edge(u)));
        part((1, 2)).then_with(|| part((2, 0))).then_with(|| part((0, 1)))
    }

    /// Encloses the t of a crossing, in lengths of the line's direction.
    pub fn t(&self, crossing: &Crossing) -> Wide {
        let above = &crossing.numerator * &self.dir_factor;
        let below = Dyadic::new(&crossing.denominator * &self.factor, self.dir_exponent - self.exponent);
        let whole = &above / &below.digits;
        if &whole * &below.digits == above {
            return Dyadic::new(whole, -below.exponent).wide();
        }
        Dyadic::new(above, 0).wide() / below.wide()
    }
}

/// Returns a vector as integers, and the factor and the exponent that make them. The exponent is a multiple of `step`.
fn whole(of: &[Rational; 3], step: i64) -> Option<([IBig; 3], IBig, i64)> {
    let parts = of.each_ref().map(Rational::fraction);
    let factor = parts.iter().fold(IBig::ONE, |factor, (_, _, below)| match factor == **below {
        true => factor,
        false => factor * *below,
    });
    let lowest = parts.iter().map(|(_, exponent, _)| stepped(*exponent, step)).min()?;
    if parts.iter().any(|(_, exponent, _)| exponent - lowest > MAX_BITS) {
        return None;
    }
    let whole =
        parts.map(|(above, exponent, below)| (above << (exponent - lowest) as usize) * (&factor / below));
    Some((whole, factor, lowest))
}

/// Returns the largest multiple of a step that is no larger than an exponent.
fn stepped(exponent: i64, step: i64) -> i64 {
    exponent.div_euclid(step) * step
}

fn sign(of: &IBig) -> Ordering {
    of.cmp(&IBig::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Float;
    use crate::scalar::Scalar;

    type Vector = [f64; 3];

    fn crossing(origin: Vector, dir: Vector, corners: [Vector; 3]) -> Option<(Crossing, Wide)> {
        let line = [origin, dir].map(|of| of.map(Rational::from));
        let line = WholeLine::new(&line).expect("a line");
        let seen = corners.map(|corner| line.seen(corner).expect("a point"));
        let crossing = line.crossing(seen.each_ref())?;
        let t = line.t(&crossing);
        Some((crossing, t))
    }

    const TRIANGLE: [Vector; 3] = [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]];

    #[test]
    fn edges_and_corners_belong_to_a_triangle() {
        for ([x, y], is_hit) in [
            ([0.25, 0.25], true),
            ([0.5, 0.5], true),
            ([0.5, 0.5_f64.next_up()], false),
            ([0.0, 0.0], true),
            ([0.25, 0.0], true),
            ([0.25, -5e-324], false),
            ([1.0, 0.0], true),
            ([1.0_f64.next_up(), 0.0], false),
        ] {
            for dir in [[0.0, 0.0, -3.0], [0.0, 0.0, -1e-200]] {
                let found = crossing([x, y, 2.0], dir, TRIANGLE);
                assert_eq!(found.is_some(), is_hit, "{x} {y}");
                let t = -1.5 / dir[2];
                assert!(found.is_none_or(|(found, at)| found.enters && at.low.to_f64() == t), "{x} {y}");
            }
        }
        assert!(crossing([0.25, 0.25, 0.5], [0.0, 0.0, 1.0], TRIANGLE).is_none(), "the start is no crossing");
        assert!(crossing([-1.0, 0.25, 0.5], [1.0, 0.0, 0.0], TRIANGLE).is_none(), "in the plane");
        let behind = crossing([0.25, 0.25, 0.25], [0.0, 0.0, 1.0], TRIANGLE);
        assert!(behind.is_some_and(|(behind, at)| !behind.enters && at.low == at.high));
    }

    /// Coordinates of all magnitudes are scaled to different integers. The places along the line are the same.
    #[test]
    fn places_of_triangles_of_all_magnitudes_are_compared() {
        let line = [[0.0, 0.0, 3.0], [0.0, 0.0, -2.0]].map(|of: Vector| of.map(Rational::from));
        let line = WholeLine::new(&line).expect("a line");
        let crossing = |size: f64, height: f64| {
            let corners = [[size, size, height], [-size, 0.0, height], [0.0, -size, height]];
            let seen = corners.map(|corner| line.seen(corner).expect("a point"));
            line.crossing(seen.each_ref()).expect("a crossing")
        };
        let [one, tiny, large] = [1.0, 5e-324, 1e300].map(|size| crossing(size, 0.5));
        assert!(one == tiny && one == large && tiny == large);
        assert!([&one, &tiny, &large].into_iter().all(|at| line.t(at) == Wide::constant(1.25)));
        let behind = crossing(3e-200, 0.5_f64.next_down());
        assert!(one < behind && tiny < behind && large < behind);
    }

    /// A line moved off a corner crosses one of the triangles around it, from whichever side it comes.
    #[test]
    fn beside_a_corner_one_triangle_is_crossed() {
        let top = [0.125, 0.75, 0.375];
        let around: [Vector; 5] =
            [[1.0, 0.1, 0.0], [0.2, 1.3, 0.1], [-1.0, 0.8, 0.0], [-0.6, -1.0, 0.2], [0.9, -0.8, 0.0]];
        for dir in [[0.25, 0.5, -1.0], [0.0, 0.0, 1.0], [-0.5, 0.0, 2.0], [0.125, -0.25, -4.0]] {
            let start: Vector = [0, 1, 2].map(|axis| top[axis] - dir[axis]);
            let line = [start, dir].map(|of| of.map(Rational::from));
            let line = WholeLine::new(&line).expect("a line");
            let seen = |at| line.seen(at).expect("a point");
            let (top, around) = (seen(top), around.map(seen));
            let fan = (0..5).map(|at| [&top, &around[at], &around[(at + 1) % 5]]);
            let found: Vec<_> = fan.filter_map(|triangle| line.crossing(triangle)).collect();
            assert_eq!(found.len(), 5, "{dir:?}");
            assert_eq!(found.iter().filter(|crossing| crossing.is_beside).count(), 1, "{dir:?}");
            let is_there = |of: &Crossing| *of == found[0] && line.t(of) == Wide::constant(1.0);
            assert!(found.iter().all(is_there), "{dir:?}");
        }
    }
}
