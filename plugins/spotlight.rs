//! A spotlight: a light that shines into a cone.

use super::light::{self, PointLight};
use tabray::prelude::*;

static POINT: Pparm<DVec3> =
    Pparm::required("point", "a point on the axis of the beam").unit("world coordinates").not_dumped();
static DIRECTION: Derived = Derived(|args| {
    let axis: [f64; 3] = axis(args.get(&POINT), PointLight::new(args).location);
    axis.to_datum().line("direction", " \n")
});
static THETA: Pparm<f64> = Pparm::required("theta", "the angle between the axis and the edge of the beam")
    .unit("degrees")
    .must("above 0 and at most 180", |theta| *theta > 0.0 && *theta <= 180.0)
    .dumped("halfwidth", "   \n");

const TABLE: Table = &[&POINT, &DIRECTION, &THETA];

inventory::submit! {
    Entity::light("spotlight", "a light that shines in a cone", &[light::TABLE, TABLE], |args| {
        let (light, point) = (PointLight::new(args), args.get(&POINT));
        let axis = Known::each(axis(point, light.location), axis(point, light.location));
        if !axis.iter().all(|along| along.rounded.is_finite()) {
            return Err(Refusal {
                attribute: Some("point"),
                message: "has its `point` at its `location`".to_owned(),
                help: "`point` must differ from `location`: the beam goes from `location` toward `point`",
            });
        }
        let edge = args.get(&THETA) * std::f64::consts::PI / 180.0;
        let enclosed = (Wide::constant(args.get(&THETA)) * Wide::pi() / Wide::constant(180.0)).cos();
        Ok(Box::new(Spotlight { light, axis, cos_edge: Known { rounded: libm::cos(edge), enclosed } }))
    })
    .dumped_as("light")
    .known_as(&["spot_light", "spot"])
}

/// Returns the unit vector along the axis of the beam; NaN where `point` is the light's location.
fn axis<N: Number>(point: DVec3, location: DVec3) -> [N; 3] {
    unit(per_axis(|axis| N::constant(point[axis]) - N::constant(location[axis])))
}

struct Spotlight {
    light: PointLight,
    axis: [Known; 3],
    /// The cosine of the angle between the axis and the edge.
    cos_edge: Known,
}

impl Light for Spotlight {
    #[inline]
    fn location(&self) -> DVec3 {
        self.light.location
    }

    #[inline]
    fn sent<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        let location = self.light.location;
        let away = unit(per_axis(|axis| toward[axis] - N::constant(location[axis])));
        let outside = N::known(&self.cos_edge) - dot(away, Known::vector(&self.axis));
        outside.either([N::constant(0.0); 3], self.light.sent(toward))
    }

    /// The region is clear if the sphere around its corners is clear of the cone: if its centre lies off the axis by
    /// more than the angles of the cone and of the sphere together.
    fn is_clear_of(&self, region: &Aabb) -> bool {
        let (between, radius) = (region.middle() - self.light.location, region.half_size().length());
        let distance = between.length();
        if !(radius < distance && distance.is_finite()) {
            return false;
        }
        let off = libm::acos(
            (between.dot(DVec3::from(self.axis.map(|along| along.rounded))) / distance).clamp(-1.0, 1.0),
        );
        // The slack is far above the rounding errors of these angles, which are the largest around 0 and 180 degrees.
        off > libm::acos(self.cos_edge.rounded.clamp(-1.0, 1.0)) + libm::asin(radius / distance) + 1e-6
    }

    fn brightest(&self) -> Option<Rgb> {
        self.light.uniform()
    }

    fn size(&self) -> f64 {
        self.light.size()
    }
}
