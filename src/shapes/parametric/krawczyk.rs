//! Krawczyk's test: whether a part of the rectangle of u and v has no hit, or exactly one.

use super::patch::{Patch, Patches, PatchesIn, Rectangle};
use super::search::Search;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::Scalar;

/// The margin by which a part is enlarged on each side before the test, as a fraction of its width. With it, a solution
/// at a side of a part is proven like any other.
const MARGIN: f64 = 0.125;

/// The maximum number of steps for one part.
const STEPS: usize = 40;

/// The result of the test of a part.
pub(super) enum Judged<F> {
    /// The part has no hit.
    Free,
    /// The part has at most one hit, in this narrower place, which may extend beyond the part.
    One(Rectangle<F>),
    /// All hits of the part are in this place.
    In(Rectangle<F>),
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
            let wide = place.map(|side| {
                let margin = F::of(MARGIN) * side.width();
                side + Interval { low: -margin, high: margin }
            });
            let patch = self.shape.patches.patch(&wide);
            // The comparisons are false for NaN, where the surface is undefined beyond the ends of u and v.
            if self.off(&patch.at).iter().any(|value| value.low > F::of(0.0) || value.high < F::of(0.0)) {
                return Judged::Free;
            }
            let Some(image) = self.image(&wide, &patch) else { return Judged::In(place) };
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
            let Some(image) = self.image(&place, &patch) else { break };
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

    /// Returns the image of a place by Krawczyk's operator. All solutions in the place are in the image. If the image
    /// is inside the place, there is exactly one. Returns `None` if the matrix of derivatives has no inverse.
    fn image(&self, place: &Rectangle<F>, patch: &Patch<F>) -> Option<Rectangle<F>> {
        let n = Interval::<F>::constant;
        let middle = place.map(|side| Interval::point(side.middle()));
        let value = self.off(&self.shape.patches.points(&middle));
        // The columns are the derivatives with respect to u and v.
        let [by_u, by_v] = [0, 1].map(|side| self.across(&patch.along[side]));
        let [[a, c], [b, d]] = [by_u, by_v].map(|of| of.map(|value| value.middle().to_f64()));
        let determinant = a * d - b * c;
        let inverse = [[d, -b], [-c, a]].map(|row| row.map(|value| value / determinant));
        if !inverse.iter().flatten().all(|value| value.is_finite()) {
            return None;
        }
        let image = [0, 1].map(|row| {
            let [one, other] = inverse[row].map(n);
            let start = middle[row] - (one * value[0] + other * value[1]);
            let left = [by_u, by_v].map(|of| one * of[0] + other * of[1]);
            let identity = if row == 0 { [n(1.0), n(0.0)] } else { [n(0.0), n(1.0)] };
            let off = |side: usize| (identity[side] - left[side]) * (place[side] - middle[side]);
            start + off(0) + off(1)
        });
        image.iter().all(|side| side.is_bounded()).then_some(image)
    }
}
