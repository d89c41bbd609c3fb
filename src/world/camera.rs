//! Cameras: the trait that a plugin implements.

use crate::geometry::aabb::Aabb;
use crate::geometry::image_point::ImagePoint;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::scalar::Scalar;
use glam::{DVec2, DVec3};
use std::fmt;

/// A camera: which ray is seen at each place of the image.
///
/// Only [`ray`](Self::ray) and [`origins`](Self::origins) must be given. What else is known of the rays makes renders
/// faster and lets more be proven; every default is correct.
pub trait Camera: fmt::Debug + Send + Sync + 'static {
    /// Returns the ray that is seen at a place, which may lie up to two pixels outside of the image. `lens` is a point of
    /// the unit disc, (0, 0) its centre, which only cameras whose lens has a size take into account.
    fn ray(&self, at: &ImagePoint, lens: DVec2) -> Ray;

    /// Returns what [`ray`](Self::ray) does; where that takes more than plain arithmetic, a direction whose x or y is 0 may
    /// stand for it. Of many rays, these alone are asked for again.
    fn plain_ray(&self, at: &ImagePoint, lens: DVec2) -> Ray {
        self.ray(at, lens)
    }

    /// Returns a ball that holds the origins of all rays to places in an image with this width and height in pixels, and
    /// up to two pixels outside of it.
    fn origins(&self, pixels: [usize; 2]) -> Origins;

    /// Tells whether the rays at one place of the image differ from point to point of a lens. Every sample of a pixel
    /// then has its own point.
    fn has_lens(&self) -> bool {
        false
    }

    /// Returns where a point in world coordinates is seen in an image with this width and height in pixels.
    fn project(&self, _point: DVec3, _pixels: [usize; 2]) -> Projected {
        Projected::Unknown
    }

    /// Returns the unit vectors from the viewer to the corners of an image with this width and height in pixels, half a
    /// pixel and a fraction `margin` of the image outside of the outermost pixels' centres: in the order around the
    /// image. `None` where rays start at different points, or where not all are between these.
    fn corners(&self, _pixels: [usize; 2], _margin: f64) -> Option<[DVec3; 4]> {
        None
    }

    /// Returns the ray before anything is rounded: each component of [`ray`](Self::ray)'s direction is at most 3 units
    /// of 2^-53 from it, and the origin is the same. By default the numbers of `ray` are taken for exact, so that it is
    /// the rays as computed about which something is proven.
    fn sight(&self, at: &ImagePoint, lens: DVec2) -> Sight {
        Sight::along(&self.ray(at, lens))
    }

    /// Returns the line of the ray that is seen at a place, of any length, in any number type; `None` where that is not
    /// known, or where rays differ from point to point of a lens. Proofs about all rays through a pixel ask for it.
    fn line<N: Scalar>(&self, _at: ImagePoint<N>) -> Option<Line<N>>
    where
        Self: Sized,
    {
        None
    }

    /// Returns the width and height in world units of the image plane, if the camera has one.
    fn screen(&self) -> Option<DVec2> {
        None
    }

    /// Returns the z, in world units, beyond which planes are not there; `None` where there is no such rule.
    fn planes_end_at(&self) -> Option<f64> {
        None
    }
}

/// A ball that holds the origins of a camera's rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origins {
    /// The middle, in world coordinates.
    pub middle: DVec3,
    /// The radius in world units; 0 where all rays start at the middle.
    pub radius: f64,
}

impl Origins {
    /// The origins of rays that all start at one point.
    pub fn at(middle: DVec3) -> Self {
        Self { middle, radius: 0.0 }
    }

    /// Returns a lower bound on the distance of a box from the origins, in world units; it may be below 0.
    pub fn distance(&self, bounds: &Aabb) -> f64 {
        self.middle.clamp(bounds.low, bounds.high).distance(self.middle) - self.radius
    }
}

/// Where a point in the world is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projected {
    /// At this place, in pixels from the centre of the lower left pixel; it may lie outside of the image.
    At(DVec2),
    /// Nowhere: no ray leads there, or infinitely many do.
    Nowhere,
    /// The camera does not say.
    Unknown,
}
