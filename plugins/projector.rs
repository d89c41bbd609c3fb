//! A projector: a light that projects an image.

use super::fplane::{self, finite_plane};
use super::light::{self, PointLight};
use super::plane;
use super::texplane::{self, Picture};
use crate::prelude::*;
use crate::shapes::rectangle::{FinitePlane, Window};

static HEADING: Derived = Derived(|_| Datum::Word(String::new()).line("projector", " \n"));

const TABLE: Table = &[&HEADING as &dyn Row];

inventory::submit! {
    Entity::light(
        "projector",
        "a light that projects a texture through a rectangle, which is itself invisible",
        &[light::TABLE, TABLE, plane::TABLE, fplane::TABLE, fplane::ROTATION, texplane::TABLE],
        |args| Ok(match args.accuracy() {
            Accuracy::Classic => Box::new(Projector::new(args, finite_plane::<Classic>(args)?)),
            Accuracy::Draft => Box::new(Projector::new(args, finite_plane::<Draft>(args)?)),
            Accuracy::Exact => Box::new(Projector::new(args, finite_plane::<Exact>(args)?)),
            Accuracy::Strict => Box::new(Projector::new(args, finite_plane::<Strict>(args)?)),
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
    fn new(args: &Args, window: FinitePlane<A>) -> Self {
        Self { light: PointLight::new(args), picture: Picture::new(args, window.rectangle), window }
    }
}

impl<A: Send + Sync> Light for Projector<A>
where
    FinitePlane<A>: Window,
{
    #[inline]
    fn location(&self) -> DVec3 {
        self.light.location
    }

    /// Light reaches a point only if the path from the light passes through the rectangle, and takes on the image's
    /// colour there.
    #[inline]
    fn emissivity(&self, toward: DVec3) -> Option<Rgb> {
        let ray = Ray { origin: toward, dir: (self.light.location - toward).normalize() };
        let distance = self.window.crossing(&ray)?;
        Some(self.light.emissivity * self.picture.colour(ray.at(distance)))
    }

    fn enclose<F: Precise>(&self, toward: [Interval<F>; 3]) -> Option<[Interval<F>; 3]> {
        let n = Interval::<F>::constant;
        let zero = n(0.0);
        let minus = |one: [Interval<F>; 3], other: DVec3| per_axis(|axis| one[axis] - n(other[axis]));
        let away = minus(toward, self.light.location).map(|part| -part);
        let normal = self.window.plane.given_normal::<Interval<F>>();
        let slope = dot(normal, away);
        let crossing = -dot(normal, minus(toward, self.window.plane.point)) / slope;
        let at = per_axis(|axis| toward[axis] + crossing * away[axis]);
        // Below 0 where the path does not pass through the rectangle.
        let inside = crossing.min(self.window.inside_of(at));
        if inside.high < zero.low || slope.is_zero() {
            return Some([zero; 3]);
        }
        let texel = self.picture.enclose(at);
        let sent = per_axis(|channel| n(self.light.emissivity[channel]) * texel[channel]);
        Some(if inside.low > zero.low { sent } else { sent.map(|channel| channel.hull(zero)) })
    }

    /// The emissivity is the bound, since no texel is above 1.
    fn brightest(&self) -> Option<Rgb> {
        self.light.uniform()
    }

    fn size(&self) -> f64 {
        self.light.size()
    }
}
