//! A camera that stands anywhere and looks toward a point.

use std::sync::Arc;
use tabray::prelude::*;

pub static POSITION: Pparm<DVec3> = Pparm::required("position", "the position of the viewer")
    .unit("world coordinates")
    .pose(Pose::Position)
    .known_as(&["location", "from", "eye", "origin"]);
pub static TARGET: Pparm<DVec3> =
    Pparm::required("target", "the point that is seen in the middle of the image")
        .known_as(&["look_at", "lookat", "at", "to"])
        .unit("world coordinates")
        .pose(Pose::Target);
pub static UP: Pparm<DVec3> = Pparm::or("up", "a direction that points up in the image", DVec3::Y)
    .must("a nonzero vector", |up: &DVec3| *up != DVec3::ZERO)
    .pose(Pose::Up);
pub static ANGLE: Pparm<f64> = Pparm::or("angle", "the angle of view across the width of the image", 50.0)
    .known_as(&["fov", "fovx"])
    .unit("degrees")
    .between(0.001, 179.0);

/// The rows of a camera that looks from a position toward a target.
pub const TABLE: Table = &[&POSITION, &TARGET, &UP];
/// The row of its angle of view.
const VIEW: Table = &[&ANGLE as &dyn Row];

inventory::submit! {
    Entity::camera("look_at", "a viewer anywhere, who looks toward a point", &[TABLE, VIEW], |args| {
        Ok(Arc::new(LookAt::new(frame(args)?, args.get(&ANGLE))))
    })
    .known_as(&["perspective", "pinhole"])
}

/// Returns the frame of a camera whose table has the rows of [`TABLE`].
///
/// # Errors
/// If the line of sight has no direction, or is along `up`.
pub fn frame(args: &Args) -> Result<ViewFrame, Refusal> {
    let (position, target) = (args.get(&POSITION), args.get(&TARGET));
    if (target - position).try_normalize().is_none() {
        return Err(Refusal {
            attribute: Some("target"),
            message: "has its `target` at its `position`".to_owned(),
            help: "the viewer looks from `position` toward `target`, so the two must differ",
        });
    }
    ViewFrame::new(position, target, args.get(&UP)).ok_or_else(|| Refusal {
        attribute: Some("up"),
        message: "looks along its `up`".to_owned(),
        help: "`up` points up in the image; any direction that is not along the line of sight will do",
    })
}

/// A viewer who looks toward a point.
#[derive(Clone, Copy, Debug)]
pub struct LookAt {
    pub frame: ViewFrame,
    /// The angle of view across the width of the image, in degrees.
    pub angle: f64,
    /// The tangent of half of it.
    tangent: DoubleDouble,
}

impl LookAt {
    pub fn new(frame: ViewFrame, angle: f64) -> Self {
        Self { frame, angle, tangent: half_tangent(angle) }
    }
}

impl Camera for LookAt {
    #[inline(always)]
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        Ray { origin: self.frame.position(), dir: self.frame.direction(self.tangent, at) }
    }

    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        Origins::at(self.frame.position())
    }

    fn project(&self, point: DVec3, pixels: [usize; 2]) -> Projected {
        let DVec3 { x, y, z } = self.frame.coordinates(point);
        if z > 0.0 {
            Projected::At(from_middle(DVec2::new(x, y) / (z * self.tangent.high), pixels))
        } else {
            Projected::Nowhere
        }
    }

    fn corners(&self, pixels: [usize; 2], margin: f64) -> Option<[DVec3; 4]> {
        let outside = |side: usize| 0.5 + margin * pixels[side] as f64;
        let corner = |right: bool, top: bool| {
            let side = |side: usize, is_far: bool| {
                if is_far { pixels[side] as f64 - 1.0 + outside(side) } else { -outside(side) }
            };
            self.frame.direction(self.tangent, &ImagePoint { at: [side(0, right), side(1, top)], pixels })
        };
        let dirs = [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
        // Within half of space.
        dirs.iter().all(|dir| dir.dot(self.frame.forward()) > 1e-6).then_some(dirs)
    }

    fn sight(&self, at: &ImagePoint, _lens: DVec2) -> Sight {
        Sight::ahead(&self.frame, self.angle, *at)
    }

    fn line<N: Scalar>(&self, at: ImagePoint<N>) -> Option<Line<N>> {
        let dir = self.frame.exact_direction(self.angle, at);
        Some(Line { origin: constants(self.frame.position()), dir })
    }
}
