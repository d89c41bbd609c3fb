//! Krawczyk's test: whether a part of the rectangle of u and v has no hit, or exactly one.

use super::patch::{Patch, Patches, PatchesIn, Rectangle};
use super::search::Search;
use super::tree::Piece;
use glam::DVec3;
use tabray_exact::double_double::power_of_two;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, constants, per_axis};

/// The margin by which a part is enlarged on each side before the test, as a fraction of its width. With it, a solution
/// at a side of a part is proven like any other.
const MARGIN: f64 = 0.125;

/// The maximum number of steps for one part.
const STEPS: usize = 40;

/// The maximum number of steps of Newton's method.
const MAX_NEWTON: usize = 8;

/// The result of the test of a part.
pub(super) enum Judged<F> {
    /// The part has no hit.
    Free,
    /// The part has at most one hit, in this narrower place, which may extend beyond the part.
    One(Rectangle<F>),
    /// All hits of the part are in this place.
    In(Rectangle<F>),
}

/// Returns a part with its margin.
pub(super) fn widened<F: Float>(part: &Rectangle<F>) -> Rectangle<F> {
    part.map(|side| {
        let margin = F::of(MARGIN) * side.width();
        side + Interval { low: -margin, high: margin }
    })
}

impl<F: Float> Search<'_, F>
where
    dyn Patches: PatchesIn<F>,
{
    /// Tests a part by Krawczyk's test, and narrows it as long as that helps.
    pub(super) fn judged(&self, part: &Rectangle<F>) -> Judged<F> {
        let mut place = *part;
        for _ in 0..STEPS {
            if !self.takes_step() {
                break;
            }
            let wide = widened(&place);
            let patch = self.shape.patches.patch(&wide);
            // The comparisons are false for NaN, where the surface is undefined beyond the ends of u and v.
            if self.off(&patch.at).iter().any(|value| value.low > F::of(0.0) || value.high < F::of(0.0)) {
                return Judged::Free;
            }
            let Some(image) = self.image_around_middle(&wide, &patch) else { return Judged::In(place) };
            if image.iter().zip(&wide).all(|(image, wide)| wide.low < image.low && image.high < wide.high) {
                return Judged::One(self.narrowed(image));
            }
            let mut next = place;
            for axis in 0..2 {
                let (low, high) =
                    (place[axis].low.max(image[axis].low), place[axis].high.min(image[axis].high));
                if low > high {
                    return Judged::Free;
                }
                next[axis] = Interval { low, high };
            }
            let shrinks = |axis: usize| next[axis].width() < F::of(0.7) * place[axis].width();
            let goes_on = shrinks(0) || shrinks(1);
            place = next;
            if !goes_on || !self.is_wide(&place) {
                break;
            }
        }
        Judged::In(place)
    }

    /// Takes one of the steps that are left; returns whether there was one.
    fn takes_step(&self) -> bool {
        let left = self.steps_left.get();
        self.steps_left.set(left.saturating_sub(1));
        left > 0
    }

    /// Narrows the enclosure of a single solution.
    fn narrowed(&self, mut place: Rectangle<F>) -> Rectangle<F> {
        for _ in 0..STEPS {
            if !self.takes_step() {
                break;
            }
            let patch = self.shape.patches.patch(&place);
            let Some(image) = self.image_around_middle(&place, &patch) else { break };
            let mut next = place;
            for axis in 0..2 {
                next[axis].low = place[axis].low.max(image[axis].low);
                next[axis].high = place[axis].high.min(image[axis].high);
            }
            let is_narrower = (0..2).any(|axis| next[axis].width() < F::of(0.9) * place[axis].width());
            place = next;
            if !is_narrower {
                break;
            }
        }
        place
    }

    /// Proves the solution near a part, in a place that has at most one: Newton's method finds it in plain numbers, and
    /// Krawczyk's test proves it in a narrow place around these. `None` if that does not succeed.
    pub(super) fn solved(&self, single: &Rectangle<f64>, near: &Rectangle<F>) -> Option<Rectangle<F>> {
        let (patches, ends) = (&self.shape.patches, self.shape.ends());
        let mut uv = near.map(|side| side.middle().to_f64());
        let plain = |of: [Interval<F>; 2]| of.map(|value| value.middle().to_f64());
        let of = |vector: DVec3| constants::<Interval<F>>(vector);
        let least = ends.map(|side| side.width() * power_of_two(-40));
        let mut inverse = [[0.0; 2]; 2];
        for step in 0.. {
            let [at, along_u, along_v] = patches.at(uv);
            let off = plain(self.off(&of(at)));
            inverse = inverted([along_u, along_v].map(|along| plain(self.across(&of(along)))))?;
            let moved = inverse.map(|[one, other]| one * off[0] + other * off[1]);
            uv = [uv[0] - moved[0], uv[1] - moved[1]];
            if (0..2).all(|axis| moved[axis].abs() < least[axis]) {
                break;
            }
            if step == MAX_NEWTON {
                return None;
            }
        }
        if !self.takes_step() {
            return None;
        }
        let middle = uv.map(Interval::constant);
        let value = self.off(&patches.points(&middle));
        let place = [0, 1].map(|axis| {
            let [one, other] = inverse[axis];
            let off = (Interval::constant(one) * value[0] + Interval::constant(other) * value[1]).magnitude();
            let reach = F::of(least[axis]) + F::of(2.0) * off;
            middle[axis] + Interval { low: -reach, high: reach }
        });
        let is_in = |place: &Rectangle<F>, around: &Rectangle<F>| {
            (0..2).all(|axis| around[axis].low < place[axis].low && place[axis].high < around[axis].high)
        };
        if !is_in(&place, &single.map(Interval::from_f64)) {
            return None;
        }
        let image = self.image(&place, (&middle, &value), &patches.patch(&place).along)?.place;
        is_in(&image, &place).then_some(if F::IS_LONG { self.narrowed(image) } else { image })
    }

    /// Returns the image of a place by Krawczyk's operator, given one of its points, the left sides of the equations
    /// there, and the derivatives of the points in the place. All solutions in the place are in the image. If the image is
    /// inside the place, there is exactly one. Returns `None` if the matrix of derivatives has no inverse.
    fn image(
        &self,
        place: &Rectangle<F>,
        (middle, value): (&Rectangle<F>, &[Interval<F>; 2]),
        along: &[[Interval<F>; 3]; 2],
    ) -> Option<Image<F>> {
        let n = Interval::<F>::constant;
        // The columns are the derivatives with respect to u and v.
        let columns = [self.across(&along[0]), self.across(&along[1])];
        let middles = |of: &[Interval<F>; 2]| [of[0].middle().to_f64(), of[1].middle().to_f64()];
        let inverse = inverted([middles(&columns[0]), middles(&columns[1])])?;
        let off = [place[0] - middle[0], place[1] - middle[1]];
        let row = |row: usize| {
            let [one, other] = [n(inverse[row][0]), n(inverse[row][1])];
            // How far the product of the matrices is from the identity.
            let left = |side: usize| {
                n(f64::from(u8::from(row == side))) - (one * columns[side][0] + other * columns[side][1])
            };
            let left = [left(0), left(1)];
            let start = middle[row] - (one * value[0] + other * value[1]);
            let sum = Interval::point(left[0].magnitude()) + Interval::point(left[1].magnitude());
            (start + left[0] * off[0] + left[1] * off[1], sum.high < F::of(1.0))
        };
        let (u, v) = (row(0), row(1));
        let (place, is_single) = ([u.0, v.0], u.1 && v.1);
        place.iter().all(|side| side.is_bounded()).then_some(Image { place, is_single })
    }

    /// Returns the image of a place by Krawczyk's operator, around its middle.
    fn image_around_middle(&self, place: &Rectangle<F>, patch: &Patch<F>) -> Option<Rectangle<F>> {
        let middle = place.map(|side| Interval::point(side.middle()));
        let value = self.off(&self.shape.patches.points(&middle));
        Some(self.image(place, (&middle, &value), &patch.along)?.place)
    }
}

/// An image by Krawczyk's operator.
struct Image<F> {
    place: Rectangle<F>,
    /// Whether the place has at most one solution: no matrix of derivatives between two of its points is singular, as
    /// each, multiplied by one matrix, differs from the identity by less than 1.
    is_single: bool,
}

/// Returns the inverse of a matrix, given its columns, if its numbers are finite.
fn inverted([[a, c], [b, d]]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let determinant = a * d - b * c;
    let inverse = [[d, -b], [-c, a]].map(|row| row.map(|value| value / determinant));
    inverse.iter().flatten().all(|value| value.is_finite()).then_some(inverse)
}

/// A part of a leaf that may have hits.
pub(super) struct Candidate {
    pub part: Rectangle<f64>,
    /// The t at which it begins.
    pub from: f64,
    /// A place around it with at most one solution.
    pub single: Option<Rectangle<f64>>,
}

impl Search<'_, f64> {
    /// Calls a function with parts of a piece of the surface that have all its hits, with at most one in each part, as far
    /// as this is known without more cuts.
    pub(super) fn candidates(&self, piece: &Piece, each: &mut dyn FnMut(Candidate)) {
        let Some(candidate) = self.candidate(piece) else { return };
        let halves = || piece.halves(&*self.shape.patches);
        match if candidate.single.is_some() { None } else { halves() } {
            Some(halves) => halves.iter().for_each(|half| self.candidates(half, each)),
            None => each(candidate),
        }
    }

    /// Tests a piece of a leaf by the bounds of its points and slopes, without an evaluation of the formula. Returns `None`
    /// if it has no hit.
    fn candidate(&self, piece: &Piece) -> Option<Candidate> {
        let Piece { part, wide, centre, along, .. } = piece;
        let (mut part, middle) = (*part, part.map(|side| Interval::point(side.middle())));
        let Some(Image { place, is_single }) = self.image(wide, (&middle, &self.off(centre)), along) else {
            return Some(Candidate { part, from: 0.0, single: None });
        };
        for axis in 0..2 {
            let (low, high) = (part[axis].low.max(place[axis].low), part[axis].high.min(place[axis].high));
            if low > high {
                return None;
            }
            part[axis] = Interval { low, high };
        }
        let off = [0, 1].map(|side| part[side] - middle[side]);
        let at = per_axis(|axis| centre[axis] + along[0][axis] * off[0] + along[1][axis] * off[1]);
        let t = self.t(&at);
        let is_behind = t.high <= 0.0;
        let single = is_single.then_some(*wide);
        (!is_behind).then_some(Candidate { part, from: t.low.max(0.0), single })
    }
}
