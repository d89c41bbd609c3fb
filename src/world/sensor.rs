//! The sensor: it records a camera's image, and finds the primary rays of a pixel.

use crate::accuracy::Accuracy;
use crate::camera::{Origins, PacketCamera, Places, Projected};
use crate::display::{Display, Tone, Transfer};
use crate::geometry::image_point::ImagePoint;
use crate::geometry::ray::Ray;
use crate::geometry::sight::Sight;
use crate::patch::Window;
use crate::pinhole::Pinhole;
use crate::rules::Rules;
use crate::sample::{self, Sample, Sampler, Samples};
use crate::simd::cpu::{Cpu, kernels};
use glam::{DVec2, DVec3};
use std::ops::Range;
use std::sync::Arc;
use tabray_exact::affine::Affine;

/// Any [`Camera`](crate::camera::Camera): `Arc::new(camera)` makes one.
pub type AnyCamera = Arc<dyn PacketCamera>;

/// The sensor of a camera: the image's size, its samples and its exposure, and the camera that projects onto it.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// The camera itself: which ray belongs to each place of the image.
    pub camera: AnyCamera,
    /// The image's width and height in pixels.
    pub pixels: [usize; 2],
    /// The number of primary rays per pixel, from 1 to [`Sampler::MAX_SAMPLES`].
    pub samples: u32,
    /// The rule by which a pixel takes more primary rays than `samples`; `None` if all take the same number.
    pub adaptive: Option<Adaptive>,
    /// Whether pixels take no primary rays if their colours are proven to be within the error of adaptive sampling.
    pub certain: bool,
    /// The distribution of the rays within a pixel, if there is more than one.
    pub sampler: Sampler,
    /// A number that scrambles the samplers' sequences together with the pixel: 0 in a render, and another one for the
    /// same image with independent samples.
    pub scramble: u32,
    /// The exposure in stops: shown light is multiplied by 2 to this power.
    pub exposure: f64,
    /// How light above white is shown, under the free rules.
    pub tone: Tone,
    /// How light is encoded, under the free rules.
    pub transfer: Transfer,
    /// The accuracy with which hits are found.
    pub accuracy: Accuracy,
    /// The rules of light.
    pub rules: Rules,
    /// The number of surfaces by which light may go on to a matt one, besides those that reflect or transmit it: 0 where
    /// matt surfaces do not light each other.
    pub bounces: u32,
    /// Whether image files are transparent where they show no object.
    pub alpha: bool,
}

/// The sensor of the notes' camera, without pixels.
impl Default for Sensor {
    fn default() -> Self {
        Self::new(Arc::new(Pinhole::default()), [0; 2])
    }
}

/// The number of primary rays of a pixel in adaptive sampling: [`Sensor::samples`], doubled again and again with the
/// next samples of the sampler's sequence, until the pixel's estimated error is small enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// The maximum number of primary rays per pixel: [`Sensor::samples`] times a power of two.
    pub most: u32,
    /// The limit on a pixel's estimated error, where 1 is white; `None` if the samples are to lower the error of the
    /// whole image.
    pub error: Option<f64>,
}

impl Sensor {
    /// Makes the sensor of a camera, with one sample for each pixel.
    pub fn new(camera: AnyCamera, pixels: [usize; 2]) -> Self {
        Self {
            camera,
            pixels,
            samples: 1,
            adaptive: None,
            certain: false,
            sampler: Sampler::default(),
            scramble: 0,
            exposure: 0.0,
            tone: Tone::default(),
            transfer: Transfer::default(),
            accuracy: Accuracy::default(),
            rules: Rules::default(),
            bounces: 0,
            alpha: false,
        }
    }

    /// Tells whether each pixel has a single ray through its middle, which needs no random numbers. Where light bounces,
    /// even a single ray draws where it goes on.
    pub fn is_single(&self) -> bool {
        self.samples == 1 && self.adaptive.is_none() && self.bounces == 0
    }

    /// Returns the z, in world units, beyond which planes are cut off, if they are.
    pub fn planes_end_at(&self) -> Option<f64> {
        self.camera.planes_end_at().filter(|_| self.rules == Rules::Notes)
    }

    /// Returns the window through which each sample looks; `None` where samples show points: under the notes' rules,
    /// and where the number of samples depends on the pixel.
    pub fn window(&self) -> Option<Window> {
        if self.rules == Rules::Notes || self.adaptive.is_some() {
            return None;
        }
        let [x, y] = self.pixels.map(|side| 0.5 * (side as f64 - 1.0));
        let (middle, next) = (self.ray(x, y), [self.ray(x + 1.0, y), self.ray(x, y + 1.0)]);
        let part = 1.0 / f64::from(self.samples).sqrt();
        let widest = |of: fn(&Ray) -> DVec3| {
            let apart = next.each_ref().map(|next| (of(next) - of(&middle)).length());
            part * apart[0].max(apart[1])
        };
        let window = Window {
            start: widest(|ray| ray.origin),
            spread: widest(|ray| ray.dir),
            pixel: f64::from(self.samples).sqrt(),
        };
        (window.start.is_finite() && window.spread.is_finite()).then_some(window)
    }

    /// Returns how light is shown in the image.
    pub fn display(&self) -> Display {
        Display::new(self.rules, self.exposure, self.tone, self.transfer)
    }

    /// Returns the seed of a pixel's sequence of samples. The pixel may lie outside of the image.
    #[inline]
    pub fn seed(&self, x: i64, y: i64) -> u32 {
        (y * self.pixels[0] as i64 + x) as u32 ^ self.scramble
    }

    /// Returns the image positions of the first `count` of a pixel's primary rays, in pixels as [`ray`](Self::ray)
    /// takes them, each with its random numbers. A [single](Self::is_single) ray goes through the centre and
    /// needs none.
    pub fn places(
        &self,
        x: usize,
        y: usize,
        count: u32,
    ) -> impl Iterator<Item = (DVec2, Option<Sample>)> + use<> {
        let (sampler, is_single) = (self.sampler, self.is_single());
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
    pub fn scatter(
        &self,
        cpu: Cpu,
        pixels: &[[usize; 2]],
        range: Range<usize>,
        list: &mut Samples,
        [x, y]: [&mut [f64]; 2],
    ) {
        let samples = self.samples as usize;
        // Each pixel of the range, with its part of the range.
        let runs = (range.start / samples..range.end.div_ceil(samples)).map(|pixel| {
            let all = pixel * samples..(pixel + 1) * samples;
            (pixels[pixel], range.start.max(all.start)..range.end.min(all.end), all.start)
        });
        list.begin(self.sampler);
        for ([column, row], run, first) in runs.clone() {
            let indices = (run.start - first) as u32..(run.end - first) as u32;
            list.extend(self.seed(column as i64, row as i64), indices);
        }
        sample::jitters(cpu, list, x, y);
        for ([column, row], run, _) in runs {
            let run = run.start - range.start..run.end - range.start;
            x[run.clone()].iter_mut().for_each(|x| *x += column as f64);
            y[run].iter_mut().for_each(|y| *y += row as f64);
        }
    }

    /// Lists the sample of one index of each pixel, given by column and row, and writes the image positions of their
    /// rays.
    pub fn scatter_each(
        &self,
        cpu: Cpu,
        pixels: &[[usize; 2]],
        index: u32,
        list: &mut Samples,
        [x, y]: [&mut [f64]; 2],
    ) {
        list.begin(self.sampler);
        for [column, row] in pixels {
            list.extend(self.seed(*column as i64, *row as i64), index..index + 1);
        }
        sample::jitters(cpu, list, x, y);
        for (([column, row], x), y) in pixels.iter().zip(x).zip(y) {
            *x += *column as f64;
            *y += *row as f64;
        }
    }

    /// Returns the point of the image at a distance, in pixels, from the centre of the lower left pixel.
    #[inline(always)]
    fn point(&self, x: f64, y: f64) -> ImagePoint {
        ImagePoint { at: [x, y], pixels: self.pixels }
    }

    /// Returns the ray through an image position and the centre of the lens, if the camera has one. `x` counts pixels
    /// from the left and `y` from the bottom.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        self.camera.ray(&self.point(x, y), DVec2::ZERO)
    }

    /// Returns the unrounded ray of [`ray`](Self::ray).
    pub fn sight(&self, x: f64, y: f64) -> Sight {
        self.sight_through(x, y, DVec2::ZERO)
    }

    /// Returns the unrounded ray through an image position, in pixels, and a point of the lens, in units of its
    /// radius.
    pub fn sight_through(&self, x: f64, y: f64, lens: DVec2) -> Sight {
        self.camera.sight(&self.point(x, y), lens)
    }

    /// Returns the unrounded ray of a sample at an image position, in pixels.
    pub fn sight_of(&self, place: DVec2, sample: Option<&Sample>) -> Sight {
        let sample = sample.filter(|_| self.camera.has_lens());
        self.sight_through(place.x, place.y, sample.map_or(DVec2::ZERO, Sample::on_lens))
    }

    /// Returns the image position that shows a point in world coordinates.
    pub fn project(&self, point: DVec3) -> Projected {
        self.camera.project(point, self.pixels)
    }

    /// Returns a ball that contains the origins of all primary rays.
    pub fn origins(&self) -> Origins {
        self.camera.origins(self.pixels)
    }

    /// Returns the largest magnitude of a coordinate of any primary ray's origin, in world units.
    pub fn max_coordinate(&self) -> f64 {
        let Origins { middle, radius } = self.origins();
        middle.abs().max_element() + radius
    }

    /// Tells whether proofs about all rays through a pixel are possible.
    pub fn is_enclosed(&self) -> bool {
        let [x, y] = [0, 1].map(|side| Affine::variable(side, 0.0, 0.5));
        self.camera.footprint(ImagePoint { at: [x, y], pixels: self.pixels }).is_some()
    }

    /// Returns points of the image for the camera, each with its point of the lens, in units of its radius, if the lens
    /// has a size.
    pub fn places_of<'p>(&self, [x, y]: [&'p [f64]; 2], lens: [&'p [f64]; 2]) -> Places<'p> {
        Places { pixels: self.pixels, x, y, lens }
    }
}

kernels! {
    /// Writes the image positions of pixel centres, given by column and row.
    pub fn middles(pixels: &[[usize; 2]], x: &mut [f64], y: &mut [f64]) {
        let (x, y) = (&mut x[..pixels.len()], &mut y[..pixels.len()]);
        for (lane, [column, row]) in pixels.iter().enumerate() {
            // Signed integers are converted in one instruction, unsigned ones are not.
            (x[lane], y[lane]) = (*column as i64 as f64, *row as i64 as f64);
        }
    }
}
