//! A projector: a light that projects an image.

use super::fplane::{self, finite_plane};
use super::light::{self, PointLight};
use super::plane;
use super::texplane::{self, Picture};
use tabray::prelude::*;
use tabray::shapes::rectangle::{FinitePlane, Rectangle};

static HEADING: Derived = Derived(|_| Datum::Word(String::new()).line("projector", " \n"));

const TABLE: Table = &[&HEADING as &dyn Row];

inventory::submit! {
    Entity::light(
        "projector",
        "a light that projects a texture through a rectangle, which is itself invisible",
        &[light::TABLE, TABLE, plane::TABLE, fplane::TABLE, fplane::ROTATION, texplane::TABLE],
        |args| Ok(match args.accuracy() {
            Accuracy::Classic => Box::new(Projector::new(args, finite_plane::<Classic>(args)?)?),
            Accuracy::Draft | Accuracy::Exact => Box::new(Projector::new(args, finite_plane::<Exact>(args)?)?),
            Accuracy::Strict => Box::new(Projector::new(args, finite_plane::<Strict>(args)?)?),
        }),
    )
    .dumped_as("light")
}

/// A light behind a rectangle, and the image on the rectangle.
struct Projector<A> {
    light: PointLight,
    window: FinitePlane<A>,
    picture: Picture,
}

impl<A> Projector<A> {
    fn new(args: &Args, window: FinitePlane<A>) -> Result<Self, Refusal> {
        Ok(Self { light: PointLight::new(args), picture: Picture::new(args, window.rectangle)?, window })
    }
}

impl<A: AccuracyTag> Light for Projector<A> {
    #[inline]
    fn location(&self) -> DVec3 {
        self.light.location
    }

    /// Light reaches a point only if the path from the light passes through the rectangle, and takes on the image's
    /// colour there.
    #[inline]
    fn sent<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        let nothing = [N::constant(0.0); 3];
        let Some((at, inside)) = self.window.passed(toward, self.light.location) else { return nothing };
        let (sent, texel) = (self.light.sent(toward), self.picture.colour(at));
        (-inside).either(nothing, per_axis(|channel| sent[channel] * texel[channel]))
    }

    /// The lines through the light and the rectangle are a pyramid on either side of the light. The region is clear if
    /// it lies outside of a side of each pyramid, or before the rectangle and outside of the pyramid behind the light.
    fn is_clear_of(&self, region: &Aabb) -> bool {
        let (from, Rectangle { corner, dimensions, sides }) = (self.light.location, self.window.rectangle);
        let at = |x: f64, y: f64| corner + x * dimensions.x * sides[0] + y * dimensions.y * sides[1] - from;
        let (corners, middle) = ([at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)], at(0.5, 0.5));
        let [low, high] = [region.low - from, region.high - from];
        let largest = |of: DVec3| of.abs().max_element();
        // Far above the rounding errors of these heights. It is infinite for an unbounded region, which is not clear.
        let slack =
            1e-9 * (largest(from) + largest(low) + largest(high) + largest(corner) + dimensions.length());
        // The least and the greatest height of the region above a plane through the light.
        let heights = |normal: DVec3| {
            let (one, other) = (normal * low, normal * high);
            (one.min(other).element_sum() + slack, one.max(other).element_sum() - slack)
        };
        // The normals point inward, unless the light lies in the rectangle's plane, where nothing is clear.
        let inward =
            |normal: DVec3| normal.try_normalize().map(|normal| normal * normal.dot(middle).signum());
        let pairs = [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(one, other)| corners[one].cross(corners[other]));
        let Some(away) = inward(sides[0].cross(sides[1])) else { return false };
        let [mut before, mut behind] =
            [heights(away).1 < away.dot(middle) - 2.0 * slack, heights(away).0 > 2.0 * slack];
        for normal in pairs {
            let Some((least, most)) = inward(normal).map(heights) else { return false };
            before |= most < -2.0 * slack;
            behind |= least > 2.0 * slack;
        }
        before && behind && slack.is_finite()
    }

    /// The emissivity is the bound, times the brightest texel's.
    fn brightest(&self) -> Option<Rgb> {
        self.light.uniform().map(|emissivity| self.picture.texture.brightest() * emissivity)
    }

    fn size(&self) -> f64 {
        self.light.size()
    }
}
