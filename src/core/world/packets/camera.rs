//! Cameras, for the rays through many places at once.

use crate::geometry::image_point::ImagePoint;
use crate::geometry::sight::Line;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::ViewMut;
use crate::world::camera::Camera;
use glam::DVec2;
use tabray_exact::affine::Affine;

/// A camera for packets. Every [`Camera`] is one.
pub trait PacketCamera: Camera {
    /// Writes the directions of the rays that are seen at many places, which all start at one point.
    fn look(&self, cpu: Cpu, places: &Places, dirs: ViewMut);
    /// Writes the origins and the directions of the rays that are seen at many places.
    fn look_from(&self, cpu: Cpu, places: &Places, origins: ViewMut, dirs: ViewMut);
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
    fn look(&self, cpu: Cpu, places: &Places, dirs: ViewMut) {
        look(cpu, self, places.pixels, places.x, places.y, dirs);
    }

    fn look_from(&self, cpu: Cpu, places: &Places, origins: ViewMut, dirs: ViewMut) {
        look_from(cpu, self, places, origins, dirs);
    }

    fn footprint(&self, at: ImagePoint<Affine>) -> Option<Line<Affine>> {
        self.line(at)
    }

    fn rounded_line(&self, at: ImagePoint) -> Option<Line<f64>> {
        self.line(at)
    }
}

kernels! {
    /// Writes the directions of the rays that are seen at many places, without a lens.
    fn look[T: Camera](camera: &T, pixels: [usize; 2], x: &[f64], y: &[f64]) => dirs {
        let count = x.len();
        let (y, mut dirs) = (&y[..count], dirs.first(count));
        let mut zeros = 0;
        for lane in 0..count {
            let dir = camera.plain_ray(&ImagePoint { at: [x[lane], y[lane]], pixels }, DVec2::ZERO).dir;
            // The product of two others may underflow; then, too, the rays are asked for again.
            zeros |= u64::from(dir.x * dir.y == 0.0);
            dirs.set(lane, dir);
        }
        if zeros != 0 {
            for lane in 0..count {
                dirs.set(lane, camera.ray(&ImagePoint { at: [x[lane], y[lane]], pixels }, DVec2::ZERO).dir);
            }
        }
    }

    /// Writes the rays that are seen at many places.
    fn look_from[T: Camera](camera: &T, places: &Places) => origins, dirs {
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
