//! The camera: from a pixel to the ray that it looks along.

use crate::geometry::ray::Ray;
use crate::geometry::sight::{self, Sight};
use crate::simd::cpu::kernels;
use crate::world::accuracy::Accuracy;
use crate::world::sample::{Sample, Sampler};
use glam::{DVec2, DVec3};

/// The viewer and a screen in the plane z = 0, whose lower left corner is the world's origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Camera {
    /// The picture's width and height in pixels.
    pub pixels: [usize; 2],
    /// The screen's width and height in world units.
    pub screen: DVec2,
    /// Where the viewer is, in front of the screen (z > 0).
    pub viewpoint: DVec3,
    /// How many rays look through each pixel.
    pub samples: u32,
    /// Where in the pixel they lie, if there is more than one.
    pub sampler: Sampler,
    /// How exactly they find their hits.
    pub accuracy: Accuracy,
}

impl Camera {
    /// The places that the rays through a pixel go through, counted as [`ray`](Self::ray) counts, each with its random
    /// numbers. A single ray goes through the middle and needs none.
    pub(crate) fn places(&self, x: usize, y: usize) -> impl Iterator<Item = (DVec2, Option<Sample>)> + use<> {
        let Self { samples, sampler, .. } = *self;
        let (pixel, middle) = ((y * self.pixels[0] + x) as u32, DVec2::new(x as f64, y as f64));
        (0..samples).map(move |index| {
            if samples == 1 {
                return (middle, None);
            }
            let sample = Sample { sampler, index, pixel };
            (middle + sample.jitter(), Some(sample))
        })
    }

    /// The ray from the viewpoint through a pixel. `x` counts from the left and `y` from the bottom; the
    /// outermost pixels lie on the edges of the screen.
    #[inline(always)]
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let (at, last) = self.place(x, y);
        Ray { origin: self.viewpoint, dir: sight::direction(self.viewpoint, at, last, self.screen) }
    }

    /// That ray before anything is rounded.
    pub fn sight(&self, x: f64, y: f64) -> Sight {
        let (at, last) = self.place(x, y);
        Sight::through(self.viewpoint, at, last, self.screen)
    }

    /// A pixel's place as parts of the last pixel's. A single pixel looks through the middle.
    #[inline(always)]
    fn place(&self, x: f64, y: f64) -> (DVec2, DVec2) {
        let part = |at: f64, pixels: usize| if pixels > 1 { (at, (pixels - 1) as f64) } else { (1.0, 2.0) };
        let ((x, last_x), (y, last_y)) = (part(x, self.pixels[0]), part(y, self.pixels[1]));
        (DVec2::new(x, y), DVec2::new(last_x, last_y))
    }
}

kernels! {
    /// The places in the middles of pixels, by column and row.
    pub(crate) fn middles(pixels: &[[usize; 2]], x: &mut [f64], y: &mut [f64]) {
        let (x, y) = (&mut x[..pixels.len()], &mut y[..pixels.len()]);
        for (lane, [column, row]) in pixels.iter().enumerate() {
            // As signed numbers, which processors convert in one step.
            (x[lane], y[lane]) = (*column as i64 as f64, *row as i64 as f64);
        }
    }

    /// The directions of the rays through these places.
    pub(crate) fn look(camera: &Camera, x: &[f64], y: &[f64]) => out {
        let count = x.len();
        let (y, mut out) = (&y[..count], out.first(count));
        for lane in 0..count {
            out.set(lane, camera.ray(x[lane], y[lane]).dir);
        }
    }
}
