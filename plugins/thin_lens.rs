//! A camera with a lens. Objects nearer or farther than its focus are blurred.

use super::look_at::{self, ANGLE, LookAt, frame};
use std::sync::Arc;
use tabray::prelude::*;

static APERTURE: Pparm<f64> =
    Pparm::required("aperture", "the diameter of the lens; a single sample passes through its centre")
        .unit("world units")
        .positive();
static FOCUS: Pparm<Option<f64>> =
    Pparm::or("focus", "the distance of the plane in focus (by default that of `target`)", None)
        .unit("world units")
        .must("positive", |focus: &Option<f64>| focus.is_none_or(|focus| focus > 0.0));

const TABLE: Table = &[&ANGLE, &APERTURE, &FOCUS];

inventory::submit! {
    Entity::camera("thin_lens", "a viewer who looks through a lens with a depth of field", &[look_at::TABLE, TABLE], |args| {
        let frame = frame(args)?;
        Ok(Arc::new(ThinLens {
            middle: LookAt::new(frame, args.get(&ANGLE)),
            radius: 0.5 * args.get(&APERTURE),
            focus: args.get(&FOCUS).unwrap_or(frame.distance()),
        }))
    })
}

/// A lens that makes a sharp image of one plane.
#[derive(Clone, Copy, Debug)]
struct ThinLens {
    /// The view through the middle of the lens, in which all is sharp.
    middle: LookAt,
    /// The radius of the lens, in world units.
    radius: f64,
    /// The distance from the lens to the plane that is sharp, in world units.
    focus: f64,
}

impl Camera for ThinLens {
    fn ray(&self, at: &ImagePoint, lens: DVec2) -> Ray {
        let Ray { origin, dir } = self.middle.ray(at, DVec2::ZERO);
        let [x, y, z] = self.middle.frame.axes();
        let aside = self.radius * (lens.x * x + lens.y * y);
        // From the middle of the lens to the point in focus.
        let sharp = self.focus / dir.dot(z) * dir;
        Ray { origin: origin + aside, dir: (sharp - aside).normalize() }
    }

    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        // More than the rounding of the points of the lens.
        Origins { middle: self.middle.frame.position(), radius: 1.001 * self.radius }
    }

    fn has_lens(&self) -> bool {
        true
    }
}
