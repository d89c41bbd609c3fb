//! A spotlight: a light that shines into a cone.

use super::light::{self, PointLight};
use tabray::prelude::*;

static POINT: Pparm<DVec3> =
    Pparm::required("point", "a point on the axis of the beam").unit("world coordinates").not_dumped();
static DIRECTION: Derived = Derived(|args| axis(args).to_datum().line("direction", " \n"));
static THETA: Pparm<f64> = Pparm::required("theta", "the angle between the axis and the edge of the beam")
    .unit("degrees")
    .must("above 0 and at most 180", |theta| *theta > 0.0 && *theta <= 180.0)
    .dumped("halfwidth", "   \n");

const TABLE: Table = &[&POINT, &DIRECTION, &THETA];

inventory::submit! {
    Entity::light("spotlight", "a light that shines in a cone", &[light::TABLE, TABLE], |args| {
        if !axis(args).is_finite() {
            return Err(Refusal {
                attribute: Some("point"),
                message: "has its `point` at its `location`".to_owned(),
                help: "`point` must differ from `location`: the beam goes from `location` toward `point`",
            });
        }
        let edge = args.get(&THETA) * std::f64::consts::PI / 180.0;
        let cosine = (Wide::constant(args.get(&THETA)) * Wide::pi() / Wide::constant(180.0)).cos();
        let (light, point) = (PointLight::new(args), args.get(&POINT));
        Ok(Box::new(Spotlight { light, axis: axis(args), cos_edge: libm::cos(edge), point, cosine }))
    })
    .dumped_as("light")
    .known_as(&["spot_light", "spot"])
}

/// Returns the unit vector along the axis of the beam; NaN where `point` is the light's location.
fn axis(args: &Attributes) -> DVec3 {
    (args.get(&POINT) - PointLight::new(args).location).normalize()
}

struct Spotlight {
    light: PointLight,
    axis: DVec3,
    cos_edge: f64,
    /// The point on the axis.
    point: DVec3,
    /// Encloses the cosine of the angle between the axis and the edge.
    cosine: Wide,
}

impl Light for Spotlight {
    #[inline]
    fn location(&self) -> DVec3 {
        self.light.location
    }

    #[inline]
    fn emissivity(&self, toward: DVec3) -> Option<Rgb> {
        let cos = (toward - self.light.location).normalize().dot(self.axis);
        (cos > self.cos_edge).then_some(self.light.emissivity)
    }

    fn enclose<F: Precise>(&self, toward: [Interval<F>; 3]) -> Option<[Interval<F>; 3]> {
        let n = Interval::<F>::constant;
        let location = constants(self.light.location);
        let from = |at: [Interval<F>; 3]| per_axis(|axis| at[axis] - location[axis]);
        let (axis, away) = (from(constants(self.point)), from(toward));
        let inside =
            dot(away, axis) - F::narrow(self.cosine.into()) * (dot(away, away) * dot(axis, axis)).sqrt();
        let (sent, nothing) = (constants::<Interval<F>>(self.light.emissivity), [n(0.0); 3]);
        Some(match inside.has_zero() {
            true => per_axis(|channel| sent[channel].hull(nothing[channel])),
            false if inside.low > nothing[0].low => sent,
            false => nothing,
        })
    }

    /// The region is clear if the sphere around its corners is clear of the cone: if its centre lies off the axis by
    /// more than the angles of the cone and of the sphere together.
    fn is_clear_of(&self, region: &Aabb) -> bool {
        let (between, radius) = (region.middle() - self.light.location, region.half_size().length());
        let distance = between.length();
        if !(radius < distance && distance.is_finite()) {
            return false;
        }
        let off = libm::acos((between.dot(self.axis) / distance).clamp(-1.0, 1.0));
        // The slack is far above the rounding errors of these angles, which are the largest around 0 and 180 degrees.
        off > libm::acos(self.cos_edge.clamp(-1.0, 1.0)) + libm::asin(radius / distance) + 1e-6
    }

    fn brightest(&self) -> Option<Rgb> {
        self.light.uniform()
    }

    fn size(&self) -> f64 {
        self.light.size()
    }
}
