//! The course notes' camera: a viewer, and an image plane at z = 0.

use crate::camera::{Camera, Origins, Projected};
use crate::geometry::image_point::ImagePoint;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{self, Line, Sight};
use crate::rules::Rules;
use glam::{DVec2, DVec3};
use tabray_exact::scalar::{Scalar, constants};

/// The z, in world units, beyond which planes are cut off: the viewer's side of the image plane (the course notes'
/// "wrong side").
const MAX_Z: f64 = 0.01;

/// A viewer, and an image plane at z = 0 whose lower left corner is the world's origin. The centres of the outermost
/// pixels lie on the edges of the image plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pinhole {
    /// The image plane's width and height in world units.
    pub screen: DVec2,
    /// The viewer's position in world coordinates, off the image plane z = 0: in front of it, where z > 0, the viewer
    /// looks along -z, and behind it along +z.
    pub viewpoint: DVec3,
}

impl Camera for Pinhole {
    #[inline(always)]
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        let (at, last) = place(at);
        Ray { origin: self.viewpoint, dir: sight::direction(self.viewpoint, at, last, self.screen) }
    }

    #[inline(always)]
    fn plain_ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        let (at, last) = place(at);
        Ray { origin: self.viewpoint, dir: sight::toward(self.viewpoint, at, last, self.screen).normalize() }
    }

    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        Origins::at(self.viewpoint)
    }

    fn project(&self, point: DVec3, pixels: [usize; 2]) -> Projected {
        let (from, depth) = (self.viewpoint, self.viewpoint.z - point.z);
        if depth.is_nan() || depth * from.z.signum() <= 0.0 || pixels.iter().any(|count| *count < 2) {
            return Projected::Nowhere;
        }
        let on_screen = from.truncate() + (point - from).truncate() * (from.z / depth);
        let last = DVec2::new((pixels[0] - 1) as f64, (pixels[1] - 1) as f64);
        Projected::At(on_screen / self.screen * last)
    }

    fn corners(&self, pixels: [usize; 2], margin: f64) -> Option<[DVec3; 4]> {
        let (apex, size) = (self.viewpoint, self.screen);
        // A single pixel looks through the middle.
        let [x, y] = pixels.map(|pixels| match pixels {
            0 | 1 => [0.5 - margin, 0.5 + margin],
            pixels => {
                let half = 0.5 / (pixels - 1) as f64 + margin;
                [-half, 1.0 + half]
            }
        });
        let corner = |x: f64, y: f64| (DVec3::new(x * size.x, y * size.y, 0.0) - apex).normalize();
        let dirs = [corner(x[0], y[0]), corner(x[1], y[0]), corner(x[1], y[1]), corner(x[0], y[1])];
        // Within a half-space.
        dirs.iter().all(|dir| dir.is_finite() && -dir.z * apex.z.signum() > 1e-6).then_some(dirs)
    }

    fn sight(&self, at: &ImagePoint, _lens: DVec2) -> Sight {
        let (at, last) = place(at);
        Sight::through(self.viewpoint, at, last, self.screen)
    }

    fn line<N: Scalar>(&self, at: ImagePoint<N>) -> Option<Line<N>> {
        let (fraction, n) = (at.fraction(), N::constant);
        let part = |side: usize| fraction[side] * n(self.screen[side]) - n(self.viewpoint[side]);
        Some(Line { origin: constants(self.viewpoint), dir: [part(0), part(1), n(-self.viewpoint.z)] })
    }

    fn rules(&self) -> Rules {
        Rules::Notes
    }

    fn screen(&self) -> Option<DVec2> {
        Some(self.screen)
    }

    fn planes_end_at(&self) -> Option<f64> {
        Some(MAX_Z)
    }
}

/// Returns an image position and the position of the last pixel. Their quotient is a fraction of the image plane's
/// width and height. A single pixel looks through the middle.
#[inline(always)]
fn place(at: &ImagePoint) -> (DVec2, DVec2) {
    let part = |at: f64, pixels: usize| if pixels > 1 { (at, (pixels - 1) as f64) } else { (1.0, 2.0) };
    let ((x, last_x), (y, last_y)) = (part(at.at[0], at.pixels[0]), part(at.at[1], at.pixels[1]));
    (DVec2::new(x, y), DVec2::new(last_x, last_y))
}
