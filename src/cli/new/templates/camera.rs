//! A template: a camera that sees all around, as on a map of the world. Describe it here.

use super::look_at::{self, frame};
use tabray::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

// Each attribute has a name, a meaning, a unit and a rule. One made with `required` must be given, one made with `or`
// has a default. The parser, its messages and the reference are made from these descriptions.
static TURNS: Pparm<f64> =
    Pparm::or("turns", "how much of a full turn the width of the image shows", 1.0).between(0.01, 1.0);

const TABLE: Table = &[&TURNS];

// Its name in scenes, its meaning, and how it is made from values that have been checked. It takes the attributes of
// every camera, those of `look_at` that say where it stands, and its own.
inventory::submit! {
    Entity::camera("template", "a camera that sees all around", &[look_at::TABLE, TABLE], |args| {
        Ok(Arc::new(Template { frame: frame(args)?, half: PI * args.get(&TURNS) }))
    })
}

#[derive(Debug)]
struct Template {
    frame: ViewFrame,
    /// Half the angle that the width of the image shows, in radians.
    half: f64,
}

impl Camera for Template {
    /// Returns the ray that is seen at a place of the image. Its direction is a unit vector.
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        let [x, y, z] = self.frame.axes();
        // From -1 to 1 across the width of the image, and as far per pixel up.
        let [right, up] = at.from_middle().map(|part| part * self.half);
        let ((sin, cos), (sin_up, cos_up)) = (libm::sincos(right), libm::sincos(up));
        let dir = cos_up * (sin * x + cos * z) + sin_up * y;
        Ray { origin: self.frame.position(), dir: dir.normalize() }
    }

    /// Returns where rays start: all at one point, or within a ball.
    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        Origins::at(self.frame.position())
    }
}
