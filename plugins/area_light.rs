//! An area light: a rectangle or a disc that shines evenly on both sides.

use super::disc::Disc;
use super::light;
use tabray::exact::double_double::scaled;
use tabray::prelude::*;
use tabray::shapes::outline;

static TARGET: Pparm<DVec3> =
    Pparm::required("target", "a point that one of its sides faces, from its middle")
        .known_as(&["look_at", "point_at", "to"])
        .unit("world coordinates");
static DIMENSIONS: Pparm<Option<DVec2>> =
    Pparm::or("dimensions", "the width and height of a rectangle", None)
        .each(&["width", "height"])
        .unit("world units")
        .must("positive in each dimension", |size| size.is_none_or(|size| size.min_element() > 0.0));
static RADIUS: Pparm<Option<f64>> = Pparm::or("radius", "the radius of a disc", None)
    .unit("world units")
    .must("positive", |radius| radius.is_none_or(|radius| radius > 0.0));
static SHAPE: OneOf = OneOf { meaning: "the shape", names: &["dimensions", "radius"] };
static UP: Pparm<DVec3> = Pparm::or(
    "up",
    "the direction of a rectangle's height; if it faces that way, its width lies along x",
    DVec3::Y,
)
.nonzero();
pub static VISIBLE: Pparm<bool> = Pparm::or(
    "visible",
    "whether it is seen, also in mirrors; if it is not, shiny surfaces have highlights of it",
    true,
);

const TABLE: Table =
    &[&light::LOCATION, &light::EMISSIVITY, &TARGET, &DIMENSIONS, &RADIUS, &SHAPE, &UP, &VISIBLE];

inventory::submit! {
    Entity::light("area_light", "a rectangle or a disc that shines evenly on both sides", &[TABLE], |args| {
        let light = AreaLight::new(args)?;
        let too_small = Refusal {
            attribute: None,
            message: "is too small at its position: its corners coincide, or are too far away".to_owned(),
            help: "its sides must be longer than the rounding of its coordinates, about 1e-16 of their size",
        };
        light.surface().map_or(Err(too_small), |_| Ok(Box::new(light) as _))
    })
    .known_as(&["arealight", "rectlight", "quad_light", "softbox", "emitter"])
    .without_falloff()
}

struct AreaLight {
    panel: Panel,
    radiance: Rgb,
    is_visible: bool,
    accuracy: Accuracy,
}

impl AreaLight {
    fn new(args: &Args) -> Result<Self, Refusal> {
        let (middle, up) = (args.get(&light::LOCATION), scaled(args.get(&UP)).normalize());
        let Some(facing) = (args.get(&TARGET) - middle).try_normalize() else {
            return Err(Refusal {
                attribute: Some("target"),
                message: "has its `target` at its `location`".to_owned(),
                help: "it faces from `location` toward `target`, so the two must differ",
            });
        };
        let across = [up, DVec3::NEG_Z, DVec3::X].map(|up| up.cross(facing));
        let across = across.into_iter().find(|across| across.length() > 1e-6).unwrap_or(DVec3::X).normalize();
        let radius = args.get(&RADIUS);
        let size = radius.map_or(0.5 * args.get(&DIMENSIONS).unwrap_or(DVec2::ONE), DVec2::splat);
        let half = [size.x * across, size.y * facing.cross(across)];
        Ok(Self {
            panel: Panel { middle, half, is_round: radius.is_some() },
            radiance: args.get(&light::EMISSIVITY),
            is_visible: args.get(&VISIBLE),
            accuracy: args.accuracy(),
        })
    }

    /// Returns its surface; `None` if it has no area.
    fn surface(&self) -> Option<AnyShape> {
        let Panel { middle, half: [across, up], is_round } = self.panel;
        if is_round {
            let disc = Disc { radius: across.length() };
            return Some(Body::implicit(disc, Frame::around(middle, self.panel.facing())).shape);
        }
        let corners =
            vec![middle - across - up, middle + across - up, middle + across + up, middle - across + up];
        let polygon = outline::polygon(corners, vec![[0, 1, 2], [0, 2, 3]]);
        outline::body(polygon, true, false, self.accuracy).ok().map(|body| body.shape)
    }
}

impl Light for AreaLight {
    fn location(&self) -> DVec3 {
        self.panel.middle
    }

    fn sent<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        constants(self.radiance)
    }

    /// It covers at most half of all directions, which are 2 pi.
    fn brightest(&self) -> Option<Rgb> {
        Some(2.0 * self.radiance.abs())
    }

    fn size(&self) -> f64 {
        self.panel.radius()
    }

    fn emitter(&self) -> Option<&dyn EnclosedEmitter> {
        Some(self)
    }

    fn shape(&self) -> Option<AnyShape> {
        self.surface().filter(|_| self.is_visible)
    }
}

impl Emitter for AreaLight {
    fn sample<N: Number>(&self, at: [N; 3], _normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>> {
        let (toward, solid_angle) = self.panel.sample(at, numbers)?;
        let light = per_axis(|channel| solid_angle / N::pi() * N::constant(self.radiance[channel]));
        Some(EmitterPoint { toward, is_far: false, light })
    }

    fn density(&self, at: DVec3, toward: DVec3, distance: f64) -> Option<f64> {
        self.panel.density(at, toward, distance)
    }

    fn extent(&self) -> Extent {
        Extent::Panel(self.panel)
    }

    /// Mirrors show it if it is seen.
    fn has_highlights(&self) -> bool {
        !self.is_visible
    }
}
