//! The numbers in which colours are enclosed.

use tabray_exact::affine::Affine;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::per_axis;
use tabray_world::certify::{
    FootprintHit, HitEnclosure, Precise, ProofMethods, gradient, gradient_over, shading_normals,
};
use tabray_world::emitter::{Chooses, EnclosedEmitter};
use tabray_world::geometry::sight::Line;
use tabray_world::number::Number;
use tabray_world::packets::light::PacketLight;

/// The number of edges of one object on a line after which its hits are in doubt.
const MAX_EDGES: usize = 4;

/// What is proven about a hit of lines.
#[derive(Clone, Copy, PartialEq)]
pub enum Hit<N: Enclosing> {
    /// Each line has a hit at this t.
    Certain(N),
    /// A line may have a hit, and if it has one, at this t.
    Perhaps(N),
    /// A line may have hits, at no smaller t than this.
    Doubtful(N::End),
}

impl<N: Enclosing> Hit<N> {
    /// Returns a lower bound on t.
    pub fn low(&self) -> N::End {
        match self {
            Self::Certain(at) | Self::Perhaps(at) => at.range().low.max(N::of(0.0)),
            Self::Doubtful(low) => *low,
        }
    }
}

/// A number that encloses all values of a quantity: at one point, or anywhere in a region.
pub trait Enclosing: Number + PartialEq {
    /// The endpoints of intervals of such numbers.
    type End: Precise;

    /// Returns an endpoint.
    fn of(value: f64) -> Self::End {
        Float::of(value)
    }

    /// Returns the interval of all values.
    fn range(self) -> Interval<Self::End>;

    /// Returns the interval of all values, rounded outward.
    fn coarse(self) -> Interval;

    /// Returns the interval of the mean over the region.
    fn mean(self) -> Interval<Self::End>;

    /// Returns a number with these values.
    fn enclosing(of: Interval<Self::End>) -> Self;

    /// Tells whether the values are known without any uncertainty, so that equal numbers are the same quantity.
    fn is_exact(self) -> bool;

    /// Returns a coordinate, from -1 to 1, of the points of a light with a size: the first or the second one.
    fn on_light(coordinate: usize) -> Self;

    /// Returns the mean over the points of a light with a size.
    fn mean_over_light(self) -> Self;

    /// Encloses what a light sends toward points.
    fn sent(light: &dyn PacketLight, toward: [Self; 3]) -> [Self; 3];

    /// Returns an extended light of any type, to be asked in this number.
    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Self>;

    /// Calls `met` with the possible hits with t > 0 of a shape, each with its part of the shape. For each part, these
    /// are the hits up to the first one that every line certainly has. The calls end when `met` returns false. `leaves`
    /// is the part on which the lines' true starts lie, if they lie on the shape.
    fn hits(
        shape: &dyn ProofMethods,
        line: &Line<Self>,
        leaves: Option<usize>,
        met: &mut dyn FnMut(Hit<Self>, usize) -> bool,
    );

    /// Encloses vectors along the normals at points of a part of a shape.
    fn gradient(shape: &dyn ProofMethods, at: [Self; 3], part: usize) -> [Self; 3];

    /// Encloses the unit normals with which points of a part are shaded, given those of the surface; `None` where
    /// they are open.
    fn shading_normal(
        shape: &dyn ProofMethods,
        at: [Self; 3],
        part: usize,
        normal: [Self; 3],
    ) -> Option<[Self; 3]>;
}

impl<F: Precise> Enclosing for Interval<F> {
    type End = F;

    fn range(self) -> Self {
        self
    }

    fn coarse(self) -> Interval {
        Interval::coarse(self)
    }

    fn mean(self) -> Self {
        self
    }

    fn enclosing(of: Self) -> Self {
        of
    }

    fn is_exact(self) -> bool {
        self.low == self.high
    }

    fn on_light(_coordinate: usize) -> Self {
        Self { low: F::of(-1.0), high: F::of(1.0) }
    }

    fn mean_over_light(self) -> Self {
        self
    }

    fn sent(light: &dyn PacketLight, toward: [Self; 3]) -> [Self; 3] {
        F::sends(light).sends(toward)
    }

    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Self> {
        F::chooses(of)
    }

    fn hits(
        shape: &dyn ProofMethods,
        line: &Line<Self>,
        leaves: Option<usize>,
        met: &mut dyn FnMut(Hit<Self>, usize) -> bool,
    ) {
        let proofs = F::proofs(shape);
        let (mut found, mut part) = proofs.first_hit(line, leaves);
        let mut start: Option<Self> = None;
        for round in 0..=MAX_EDGES {
            let from_start = |at: Self| start.map_or(at, |start| start + at);
            let hit = match found {
                HitEnclosure::Misses => return,
                HitEnclosure::Hits(at) => Hit::Certain(from_start(at)),
                // Too many to follow.
                HitEnclosure::Edge(at) if round == MAX_EDGES => Hit::Doubtful(from_start(at).low),
                HitEnclosure::Edge(at) => Hit::Perhaps(from_start(at)),
                HitEnclosure::Doubtful(low) => Hit::Doubtful(from_start(Self::point(low)).low),
            };
            let goes_on = met(hit, part);
            let Hit::Perhaps(at) = hit else { return };
            if !goes_on {
                return;
            }
            // Beyond its edge, a surface does not hide what lies behind it.
            let behind = Line { origin: line.at(at), dir: line.dir };
            (found, part) = proofs.first_hit(&behind, Some(part));
            start = Some(at);
        }
    }

    fn gradient(shape: &dyn ProofMethods, at: [Self; 3], part: usize) -> [Self; 3] {
        gradient(F::proofs(shape), at, part)
    }

    fn shading_normal(
        shape: &dyn ProofMethods,
        at: [Self; 3],
        part: usize,
        normal: [Self; 3],
    ) -> Option<[Self; 3]> {
        F::proofs(shape).shading_normal(at, part, normal)
    }
}

/// The variables that stand for the point of a light with a size: two coordinates in a disc of radius 1.
const ON_LIGHT: [usize; 2] = [2, 3];

impl Enclosing for Affine {
    type End = f64;

    fn range(self) -> Interval {
        Affine::range(&self)
    }

    fn coarse(self) -> Interval {
        Affine::range(&self)
    }

    fn mean(self) -> Interval {
        Affine::mean(&self)
    }

    fn enclosing(of: Interval) -> Self {
        of.into()
    }

    fn is_exact(self) -> bool {
        self.rest == 0.0
    }

    fn on_light(coordinate: usize) -> Self {
        Self::variable(ON_LIGHT[coordinate], 0.0, 1.0)
    }

    fn mean_over_light(self) -> Self {
        ON_LIGHT.iter().fold(self, |mean, index| mean.without(*index))
    }

    fn sent(light: &dyn PacketLight, toward: [Self; 3]) -> [Self; 3] {
        light.sends(toward)
    }

    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Self> {
        of
    }

    fn hits(
        shape: &dyn ProofMethods,
        line: &Line<Self>,
        leaves: Option<usize>,
        met: &mut dyn FnMut(Hit<Self>, usize) -> bool,
    ) {
        let mut goes_on = true;
        shape.hits(line, leaves, &mut |hit, part| {
            let hit = match hit {
                FootprintHit::Hits(at) => Hit::Certain(at),
                FootprintHit::Perhaps(at) => Hit::Perhaps(at),
                FootprintHit::Doubtful(low) => Hit::Doubtful(low),
            };
            goes_on = goes_on && met(hit, part);
        });
    }

    fn gradient(shape: &dyn ProofMethods, at: [Self; 3], part: usize) -> [Self; 3] {
        gradient_over(shape, at, part)
    }

    fn shading_normal(
        shape: &dyn ProofMethods,
        at: [Self; 3],
        part: usize,
        normal: [Self; 3],
    ) -> Option<[Self; 3]> {
        shading_normals(shape, at, part, normal)
    }
}

/// Returns the intervals of a vector.
pub(super) fn ranges<N: Enclosing>(vector: [N; 3]) -> [Interval<N::End>; 3] {
    per_axis(|axis| vector[axis].range())
}

/// Encloses lines, rounded outward.
pub(super) fn coarse<N: Enclosing>(line: &Line<N>) -> Line<Interval> {
    let coarse = |vector: [N; 3]| per_axis(|axis| vector[axis].coarse());
    Line { origin: coarse(line.origin), dir: coarse(line.dir) }
}
