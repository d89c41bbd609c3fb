//! Cameras: the trait that a plugin implements, and rays through many places at once.

use crate::geometry::aabb::Aabb;
use crate::geometry::image_point::ImagePoint;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::rules::Rules;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::ViewMut;
use glam::{DVec2, DVec3};
use std::fmt;
use tabray_exact::affine::Affine;
use tabray_exact::scalar::Scalar;

/// A camera: which ray belongs to each point of the image.
///
/// Only [`ray`](Self::ray) and [`origins`](Self::origins) must be given. The other functions tell more about the rays,
/// which makes renders faster and lets more be proven; every default is correct.
pub trait Camera: fmt::Debug + Send + Sync + 'static {
    /// Returns the ray through a point of the image, which may lie up to two pixels outside of it. `lens` is a point of
    /// the unit disc, (0, 0) its centre; cameras whose lens has no size ignore it.
    fn ray(&self, at: &ImagePoint, lens: DVec2) -> Ray;

    /// Returns the same ray as [`ray`](Self::ray), or, where that ray takes more than plain arithmetic, a ray with a
    /// direction whose x or y is 0, which stands for "unknown". Packets of rays call this function first, and `ray`
    /// again only for the unknown ones.
    fn plain_ray(&self, at: &ImagePoint, lens: DVec2) -> Ray {
        self.ray(at, lens)
    }

    /// Returns a ball that contains the origins of all rays through an image of this width and height in pixels, and
    /// through points up to two pixels outside of it.
    fn origins(&self, pixels: [usize; 2]) -> Origins;

    /// Tells whether the rays at one place of the image differ from point to point of a lens. Every sample of a pixel
    /// then has its own point.
    fn has_lens(&self) -> bool {
        false
    }

    /// Returns the point of an image, of this width and height in pixels, that shows a point in world coordinates.
    fn project(&self, _point: DVec3, _pixels: [usize; 2]) -> Projected {
        Projected::Unknown
    }

    /// Returns the unit vectors from the viewer to the corners of an image of this width and height in pixels, in their
    /// order around the image. The corners lie half a pixel and a fraction `margin` of the image outside of the
    /// outermost pixels' centres. `None` where rays start at different points, or where not all of them lie between
    /// these vectors.
    fn corners(&self, _pixels: [usize; 2], _margin: f64) -> Option<[DVec3; 4]> {
        None
    }

    /// Returns the unrounded ray. Each component of the direction that [`ray`](Self::ray) returns is within 3 units
    /// of 2^-53 of the component here, and the origin is the same. The default treats the numbers of `ray` as exact,
    /// so that proofs are about the rays as computed.
    fn sight(&self, at: &ImagePoint, lens: DVec2) -> Sight {
        Sight::along(&self.ray(at, lens))
    }

    /// Returns the line of the ray through a point of the image, with a direction of any length, in any number type;
    /// `None` where that is not known, or where rays differ from point to point of a lens. Proofs about all rays
    /// through a pixel ask for it.
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

    /// Returns the rules of light of a scene that does not choose any.
    fn rules(&self) -> Rules {
        Rules::Free
    }

    /// Returns the z, in world units, beyond which planes are cut off under the notes' rules; `None` where there is no
    /// such rule.
    fn planes_end_at(&self) -> Option<f64> {
        None
    }
}

/// A ball that contains the origins of a camera's rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origins {
    /// The middle, in world coordinates.
    pub middle: DVec3,
    /// The radius in world units; 0 if all rays start at the middle.
    pub radius: f64,
}

impl Origins {
    /// Returns the origins of rays that all start at one point.
    pub fn at(middle: DVec3) -> Self {
        Self { middle, radius: 0.0 }
    }

    /// Returns a lower bound on the distance of a box from the origins, in world units; it may be below 0.
    pub fn distance(&self, bounds: &Aabb) -> f64 {
        self.middle.clamp(bounds.low, bounds.high).distance(self.middle) - self.radius
    }
}

/// Where the image shows a point of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projected {
    /// At this point, in pixels from the centre of the lower left pixel; it may lie outside of the image.
    At(DVec2),
    /// Nowhere: no ray leads there, or infinitely many do.
    Nowhere,
    /// The camera does not say.
    Unknown,
}

/// A camera for packets. Every [`Camera`] is one.
pub trait PacketCamera: Camera {
    /// Writes the directions of the rays through many places of the image. All these rays start at one point.
    fn fill_directions(&self, cpu: Cpu, places: &Places, dirs: ViewMut);
    /// Writes the origins and the directions of the rays that are seen at many places.
    fn fill_rays(&self, cpu: Cpu, places: &Places, origins: ViewMut, dirs: ViewMut);
    /// Calls [`Camera::line`].
    fn footprint(&self, at: ImagePoint<Affine>) -> Option<Line<Affine>>;
    /// Calls [`Camera::line`] for rounded numbers.
    fn rounded_line(&self, at: ImagePoint) -> Option<Line<f64>>;
}

/// Places in an image.
pub struct Places<'p> {
    /// The image's width and height in pixels.
    pub pixels: [usize; 2],
    /// The distances to the right from the centre of the lower left pixel, in pixels.
    pub x: &'p [f64],
    /// The distances up from the centre of the lower left pixel, in pixels.
    pub y: &'p [f64],
    /// The points of the lens, x and y in its radius; empty where all are its centre.
    pub lens: [&'p [f64]; 2],
}

impl<T: Camera> PacketCamera for T {
    fn fill_directions(&self, cpu: Cpu, places: &Places, dirs: ViewMut) {
        fill_directions(cpu, self, places.pixels, places.x, places.y, dirs);
    }

    fn fill_rays(&self, cpu: Cpu, places: &Places, origins: ViewMut, dirs: ViewMut) {
        fill_rays(cpu, self, places, origins, dirs);
    }

    fn footprint(&self, at: ImagePoint<Affine>) -> Option<Line<Affine>> {
        self.line(at)
    }

    fn rounded_line(&self, at: ImagePoint) -> Option<Line<f64>> {
        self.line(at)
    }
}

kernels! {
    /// Writes the directions of the rays through many places, without a lens.
    fn fill_directions[T: Camera](camera: &T, pixels: [usize; 2], x: &[f64], y: &[f64]) => dirs {
        let count = x.len();
        let (y, mut dirs) = (&y[..count], dirs.first(count));
        let mut zeros = 0;
        for lane in 0..count {
            let dir = camera.plain_ray(&ImagePoint { at: [x[lane], y[lane]], pixels }, DVec2::ZERO).dir;
            // The product of two components may underflow. Then, too, the single ray is asked for again.
            zeros |= u64::from(dir.x * dir.y == 0.0);
            dirs.set(lane, dir);
        }
        if zeros != 0 {
            for lane in 0..count {
                dirs.set(lane, camera.ray(&ImagePoint { at: [x[lane], y[lane]], pixels }, DVec2::ZERO).dir);
            }
        }
    }

    /// Writes the rays through many places.
    fn fill_rays[T: Camera](camera: &T, places: &Places) => origins, dirs {
        let Places { pixels, x, y, lens } = *places;
        let count = x.len();
        let (y, mut origins, mut dirs) = (&y[..count], origins.first(count), dirs.first(count));
        for lane in 0..count {
            let lens = if lens[0].is_empty() { DVec2::ZERO } else { DVec2::new(lens[0][lane], lens[1][lane]) };
            let ray = camera.ray(&ImagePoint { at: [x[lane], y[lane]], pixels }, lens);
            origins.set(lane, ray.origin);
            dirs.set(lane, ray.dir);
        }
    }
}
