//! A camera with a very wide angle of view, up to all of space.

use super::look_at::{self, frame};
use std::sync::Arc;
use tabray::prelude::*;

static ANGLE: Pparm<f64> = Pparm::or("angle", "the angle of view across the width of the image", 180.0)
    .unit("degrees")
    .between(0.001, 360.0);

const TABLE: Table = &[&ANGLE as &dyn Row];

inventory::submit! {
    Entity::camera(
        "fisheye",
        "a view whose angle grows evenly from the middle of the image to its edge",
        &[look_at::TABLE, TABLE],
        |args| {
            let half = 0.5 * args.get(&ANGLE).to_radians();
            Ok(Arc::new(Fisheye { frame: frame(args)?, half }))
        },
    )
}

/// An equidistant fisheye lens.
#[derive(Clone, Copy, Debug)]
struct Fisheye {
    frame: ViewFrame,
    /// Half the angle of view across the width of the image, in radians.
    half: f64,
}

impl Camera for Fisheye {
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        let [x, y, z] = self.frame.axes();
        let [right, up] = at.from_middle();
        let radius = DVec2::new(right, up).length();
        let (sin, cos) = libm::sincos(radius * self.half);
        let aside = if radius > 0.0 { sin / radius } else { 0.0 };
        let dir = cos * z + aside * (right * x + up * y);
        Ray { origin: self.frame.position(), dir: dir.normalize() }
    }

    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        Origins::at(self.frame.position())
    }

    /// What is straight behind the viewer is seen on a circle, if at all.
    fn project(&self, point: DVec3, pixels: [usize; 2]) -> Projected {
        let DVec3 { x, y, z } = self.frame.coordinates(point);
        let aside = DVec2::new(x, y);
        let radius = libm::atan2(aside.length(), z) / self.half;
        match aside.try_normalize() {
            Some(toward) => Projected::At(from_middle(radius * toward, pixels)),
            None if z > 0.0 => Projected::At(from_middle(DVec2::ZERO, pixels)),
            None => Projected::Nowhere,
        }
    }
}
