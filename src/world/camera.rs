//! The camera: from a pixel to its primary ray.

use crate::geometry::ray::Ray;
use crate::geometry::sight::{self, Sight};
use crate::simd::cpu::{Cpu, kernels};
use crate::world::accuracy::Accuracy;
use crate::world::sample::{self, Sample, Sampler};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// The viewer, and an image plane at z = 0 whose lower left corner is the world's origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Camera {
    /// The image's width and height in pixels.
    pub pixels: [usize; 2],
    /// The image plane's width and height in world units.
    pub screen: DVec2,
    /// The viewer's position in world coordinates, in front of the image plane (z > 0).
    pub viewpoint: DVec3,
    /// The number of primary rays per pixel, from 1 to [`Sampler::MOST`].
    pub samples: u32,
    /// When a pixel takes more primary rays than `samples`; `None` where all take the same number.
    pub adaptive: Option<Adaptive>,
    /// Whether pixels whose colours are proven to be within [`Adaptive::error`] take no primary rays.
    pub certain: bool,
    /// How the rays are placed within a pixel, if there is more than one.
    pub sampler: Sampler,
    /// What the samplers' sequences are scrambled with beside the pixel: 0 in a render, and another number where the
    /// same image is wanted with independent samples.
    pub scramble: u32,
    /// The exposure in stops: colours are multiplied by 2 to this power.
    pub exposure: f64,
    /// How exactly hits are found.
    pub accuracy: Accuracy,
}

/// How many primary rays a pixel takes, where pixels differ in that: [`Camera::samples`], and then twice as many again
/// and again, each time by the sampler's sequence, until its estimated error is small enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// The maximum number of primary rays per pixel: [`Camera::samples`] times a power of two.
    pub most: u32,
    /// The error of a pixel's colour, where 1 is white, that is to be estimated at last; `None` where the samples are to
    /// lower the error of the whole image.
    pub error: Option<f64>,
}

impl Camera {
    /// Returns the factor of all colours.
    pub(crate) fn gain(&self) -> f64 {
        libm::exp2(self.exposure)
    }

    /// Returns what the sequence of a pixel's samples depends on. The pixel may lie outside of the image.
    #[inline]
    pub(crate) fn seed(&self, x: i64, y: i64) -> u32 {
        (y * self.pixels[0] as i64 + x) as u32 ^ self.scramble
    }

    /// Returns the image positions of the first `count` of a pixel's primary rays, in pixels as [`ray`](Self::ray) takes
    /// them, each with its random numbers. If all pixels have a single ray, it goes through the centre and needs none.
    pub(crate) fn places(
        &self,
        x: usize,
        y: usize,
        count: u32,
    ) -> impl Iterator<Item = (DVec2, Option<Sample>)> + use<> {
        let (sampler, is_single) = (self.sampler, self.samples == 1 && self.adaptive.is_none());
        let (pixel, middle) = (self.seed(x as i64, y as i64), DVec2::new(x as f64, y as f64));
        (0..count).map(move |index| {
            if is_single {
                return (middle, None);
            }
            let sample = Sample { sampler, index, pixel };
            (middle + sample.jitter(), Some(sample))
        })
    }

    /// Lists the samples of pixels, given by column and row, and writes the image positions of their rays as
    /// [`places`](Self::places) returns them. `range` counts the samples from the first one of the first pixel.
    pub(crate) fn scatter(
        &self,
        cpu: Cpu,
        pixels: &[[usize; 2]],
        range: Range<usize>,
        list: &mut Vec<Sample>,
        [x, y]: [&mut [f64]; 2],
    ) {
        let (sampler, samples) = (self.sampler, self.samples as usize);
        // Each pixel of the range, with its part of the range.
        let runs = (range.start / samples..range.end.div_ceil(samples)).map(|pixel| {
            let all = pixel * samples..(pixel + 1) * samples;
            (pixels[pixel], range.start.max(all.start)..range.end.min(all.end), all.start)
        });
        list.clear();
        for ([column, row], run, first) in runs.clone() {
            let pixel = self.seed(column as i64, row as i64);
            list.extend(run.map(|at| Sample { sampler, index: (at - first) as u32, pixel }));
        }
        sample::jitters(cpu, list, x, y);
        for ([column, row], run, _) in runs {
            let run = run.start - range.start..run.end - range.start;
            x[run.clone()].iter_mut().for_each(|x| *x += column as f64);
            y[run].iter_mut().for_each(|y| *y += row as f64);
        }
    }

    /// Returns the ray from the viewpoint through an image position. `x` counts pixels from the left and `y` from the
    /// bottom; the centres of the outermost pixels lie on the edges of the image plane.
    #[inline(always)]
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let (at, last) = self.place(x, y);
        Ray { origin: self.viewpoint, dir: sight::direction(self.viewpoint, at, last, self.screen) }
    }

    /// Returns the ray through an image position, as [`ray`](Self::ray) has it, before anything is rounded.
    pub fn sight(&self, x: f64, y: f64) -> Sight {
        let (at, last) = self.place(x, y);
        Sight::through(self.viewpoint, at, last, self.screen)
    }

    /// Returns the image position at which a point in world coordinates is seen, in pixels as [`ray`](Self::ray) takes
    /// them; `None` for points that are not in front of the viewer, and where all rays of a row or column are one.
    pub(crate) fn project(&self, point: DVec3) -> Option<DVec2> {
        let (from, depth) = (self.viewpoint, self.viewpoint.z - point.z);
        if depth.is_nan() || depth <= 0.0 || self.pixels.contains(&1) {
            return None;
        }
        let on_screen = from.truncate() + (point - from).truncate() * (from.z / depth);
        let last = DVec2::new((self.pixels[0] - 1) as f64, (self.pixels[1] - 1) as f64);
        Some(on_screen / self.screen * last)
    }

    /// Returns an image position and the position of the last pixel, whose quotient is a fraction of the image plane's
    /// width and height. A single pixel looks through the middle.
    #[inline(always)]
    fn place(&self, x: f64, y: f64) -> (DVec2, DVec2) {
        let part = |at: f64, pixels: usize| if pixels > 1 { (at, (pixels - 1) as f64) } else { (1.0, 2.0) };
        let ((x, last_x), (y, last_y)) = (part(x, self.pixels[0]), part(y, self.pixels[1]));
        (DVec2::new(x, y), DVec2::new(last_x, last_y))
    }
}

kernels! {
    /// Writes the image positions of pixel centres, given by column and row.
    pub(crate) fn middles(pixels: &[[usize; 2]], x: &mut [f64], y: &mut [f64]) {
        let (x, y) = (&mut x[..pixels.len()], &mut y[..pixels.len()]);
        for (lane, [column, row]) in pixels.iter().enumerate() {
            // Signed integers are converted in one instruction, unsigned ones are not.
            (x[lane], y[lane]) = (*column as i64 as f64, *row as i64 as f64);
        }
    }

    /// Writes the directions of the primary rays through image positions.
    pub(crate) fn look(camera: &Camera, x: &[f64], y: &[f64]) => out {
        let count = x.len();
        let (y, mut out) = (&y[..count], out.first(count));
        for lane in 0..count {
            out.set(lane, camera.ray(x[lane], y[lane]).dir);
        }
    }
}
