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
    fn colour(&self, toward: DVec3) -> Rgb {
        let height = self.up.dot(toward);
        if height < 0.0 { self.ground } else { self.horizon.lerp(self.zenith, height.min(1.0)) }
    }

    fn brightest(&self) -> Rgb {
        self.horizon.max(self.zenith).max(self.ground)
    }

    fn enclose(&self, toward: [Interval; 3]) -> [Interval; 3] {
        let number = Interval::constant;
        let height = dot(self.up.to_array().map(number), toward);
        let clamped = |height: f64| height.clamp(0.0, 1.0);
        let part = Interval { low: clamped(height.low), high: clamped(height.high) };
        per_axis(|channel| {
            let (horizon, zenith) = (number(self.horizon[channel]), number(self.zenith[channel]));
            let (air, ground) = (horizon + part * (zenith - horizon), number(self.ground[channel]));
            match (height.high < 0.0, height.low < 0.0) {
                (true, _) => ground,
                (false, true) => air.hull(ground),
                (false, false) => air,
            }
        })
    }
}
