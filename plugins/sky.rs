//! A sky: a gradient from the horizon up to the zenith.

use tabray::exact::double_double::scaled;
use tabray::prelude::*;

static HORIZON: Pparm<Rgb> = Pparm::or(
    "horizon",
    "the red, green and blue at the horizon, where 1 is white",
    Rgb::new(0.85, 0.9, 1.0),
)
.must("0 or more in each channel", is_light);
static ZENITH: Pparm<Rgb> =
    Pparm::or("zenith", "the red, green and blue straight up", Rgb::new(0.2, 0.4, 0.85))
        .must("0 or more in each channel", is_light);
static GROUND: Pparm<Option<Rgb>> = Pparm::or(
    "ground",
    "the red, green and blue below the horizon; without it, the colour of the horizon",
    None,
)
.must("0 or more in each channel", |ground| ground.is_none_or(|ground| is_light(&ground)));
static UP: Pparm<DVec3> =
    Pparm::or("up", "the direction of the zenith", DVec3::Y).nonzero().shown(|up| scaled(up).normalize());

const TABLE: Table = &[&HORIZON, &ZENITH, &GROUND, &UP];

fn is_light(colour: &Rgb) -> bool {
    colour.min_element() >= 0.0
}

inventory::submit! {
    Entity::background("sky", "a gradient from the horizon up to the zenith where there is no object", &[TABLE], |args| {
        let (horizon, zenith) = (args.get(&HORIZON), args.get(&ZENITH));
        let (ground, up) = (args.get(&GROUND).unwrap_or(horizon), scaled(args.get(&UP)).normalize());
        Ok(Box::new(Sky { horizon, zenith, ground, up }))
    })
}

struct Sky {
    horizon: Rgb,
    zenith: Rgb,
    ground: Rgb,
    up: DVec3,
}

impl Background for Sky {
    /// Goes from the horizon's colour to the zenith's in proportion to the sine of the elevation.
    fn colour<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        let height = dot(constants(self.up), toward);
        let part = height.max(N::constant(0.0)).min(N::constant(1.0));
        let air = N::lerp(constants(self.horizon), constants(self.zenith), part);
        height.either(air, constants(self.ground))
    }

    fn brightest(&self) -> Rgb {
        self.horizon.max(self.zenith).max(self.ground)
    }
}
