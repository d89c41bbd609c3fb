//! A camera whose rays are parallel, as in plans and elevations.

use super::look_at::{self, frame};
use std::sync::Arc;
use tabray::prelude::*;

static WIDTH: Pparm<f64> =
    Pparm::required("width", "the width of the part of the scene that the image shows")
        .unit("world units")
        .positive()
        .pose(Pose::Extent);

const TABLE: Table = &[&WIDTH as &dyn Row];

inventory::submit! {
    Entity::camera(
        "orthographic",
        "parallel rays, from the plane through `position` in the direction of `target`",
        &[look_at::TABLE, TABLE],
        |args| Ok(Arc::new(Orthographic { frame: frame(args)?, width: args.get(&WIDTH) })),
    )
}

/// A viewer who sees a part of a plane, straight ahead everywhere.
#[derive(Clone, Copy, Debug)]
struct Orthographic {
    frame: ViewFrame,
    /// The width of what the image shows, in world units.
    width: f64,
}

impl Camera for Orthographic {
    #[inline(always)]
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        Ray { origin: self.frame.beside(self.width, at), dir: self.frame.forward() }
    }

    fn origins(&self, pixels: [usize; 2]) -> Origins {
        let [wide, high] = pixels.map(|side| side as f64);
        // From the middle to a corner four pixels outside of the image.
        let radius = 0.5 * self.width * DVec2::new(wide + 8.0, high + 8.0).length() / wide;
        Origins { middle: self.frame.position(), radius }
    }

    fn project(&self, point: DVec3, pixels: [usize; 2]) -> Projected {
        let DVec3 { x, y, z } = self.frame.coordinates(point);
        if z > 0.0 {
            Projected::At(from_middle(DVec2::new(x, y) / (0.5 * self.width), pixels))
        } else {
            Projected::Nowhere
        }
    }

    fn sight(&self, at: &ImagePoint, lens: DVec2) -> Sight {
        Sight::forward(self.ray(at, lens).origin, &self.frame)
    }

    fn line<N: Scalar>(&self, at: ImagePoint<N>) -> Option<Line<N>> {
        Some(Line { origin: self.frame.exact_beside(self.width, at), dir: self.frame.exact_forward() })
    }
}
