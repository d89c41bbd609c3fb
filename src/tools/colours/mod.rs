//! Proves the colours of pixels: encloses each channel in an interval, and compares the bytes with those of the image.
//!
//! This is a second evaluation of the rules by which a scene is rendered, in intervals from the scene's numbers on. It
//! shares no arithmetic with the tracer: only the equations of shapes, and what shaders and lights enclose. It follows all
//! that a pixel's colour depends on: each hit, shadow ray, mirror and pane, and the tile or texel that is met. What an
//! interval leaves open widens the colour, or opens the pixel.

mod light;
mod rays;
mod scene;
mod surface;

use crate::geometry::sight::Sight;
use crate::numeric::interval::{Float, Fraction, Interval};
use crate::numeric::scalar::Scalar;
use crate::render::plan::Plan;
use crate::render::plan::depth::FAINT;
use crate::render::renderer::Renderer;
use f256::f256;
use rays::Tracer;
use scene::{Colour, Number, Scene};
use std::io;
use std::ops::ControlFlow;

/// What is proven of a byte, or of a pixel: of all of its bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The byte is that of the true colour.
    Proven,
    /// The interval of the true colour holds several bytes.
    #[default]
    Open,
    /// No colour in the interval has the byte.
    Contradicted,
}

/// A pixel's verdicts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// What is proven of each channel.
    pub channels: [Verdict; 3],
}

impl Pixel {
    /// Returns the verdict on the whole pixel.
    pub fn verdict(&self) -> Verdict {
        self.channels.into_iter().max().unwrap_or_default()
    }
}

/// Proves the colours of an image.
pub struct Prover<'p, 'm> {
    plan: &'p Plan<'m>,
    scene: Scene<'p, 'm>,
}

impl<'p, 'm> Prover<'p, 'm> {
    /// Prepares the proofs of a plan.
    pub fn new(plan: &'p Plan<'m>) -> Self {
        Self { plan, scene: Scene::new(plan) }
    }

    /// Returns the verdict on a pixel with these bytes: `x` counts from the left, `y` from the bottom.
    pub fn pixel(&self, x: usize, y: usize, bytes: [u8; 3]) -> Pixel {
        let (quick, is_final) = self.verdicts::<f64>(x, y, bytes);
        if is_final {
            return quick;
        }
        let (wide, is_final) = self.verdicts::<f256>(x, y, bytes);
        if is_final { wide } else { self.verdicts::<Fraction>(x, y, bytes).0 }
    }

    /// Encloses a pixel's colour in `f64`; `None` where it is open.
    #[cfg(test)]
    fn colour(&self, x: usize, y: usize) -> Option<Colour<f64>> {
        self.mean(x, y).0
    }

    /// Returns the verdict, and whether a higher precision would not change it.
    fn verdicts<F: Number>(&self, x: usize, y: usize, bytes: [u8; 3]) -> (Pixel, bool) {
        let (colour, is_spent) = self.mean::<F>(x, y);
        let Some(colour) = colour else { return (Pixel::default(), is_spent) };
        // Rays may be left out that add less than this to a pixel.
        let missing = if self.plan.depth.is_some() { FAINT } else { 0.0 };
        let channels = [0, 1, 2].map(|channel| verdict(colour[channel], bytes[channel], missing));
        (Pixel { channels }, is_spent || !channels.contains(&Verdict::Open))
    }

    /// Encloses a pixel's colour, the mean of its samples, and tells whether a limit on the number of rays was reached.
    fn mean<F: Number>(&self, x: usize, y: usize) -> (Option<Colour<F>>, bool) {
        let camera = &self.plan.camera;
        let mut sum = [Interval::constant(0.0); 3];
        let mut is_spent = false;
        for (place, sample) in camera.places(x, y) {
            let sight: Sight = camera.sight(place.x, place.y);
            let mut tracer = Tracer::new(&self.scene, sample);
            let colour = tracer.primary::<F>(&sight.line());
            is_spent |= tracer.is_spent();
            let Some(colour) = colour else { return (None, is_spent) };
            sum = [0, 1, 2].map(|channel| sum[channel] + colour[channel]);
        }
        let count = Interval::constant(f64::from(camera.samples));
        let mean = if camera.samples == 1 { sum } else { sum.map(|channel| channel / count) };
        (Some(mean), is_spent)
    }

    /// Returns the verdicts on all pixels, row by row from the top. `done` is called after each row, and may break off.
    ///
    /// # Errors
    /// `Interrupted` if `done` broke off.
    pub fn picture(
        &self,
        renderer: &Renderer,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> io::Result<Vec<Pixel>> {
        let [width, height] = self.plan.camera.pixels;
        let bytes = renderer.picture(self.plan);
        let verdict = |x: usize, y: usize| {
            let first = 3 * ((height - 1 - y) * width + x);
            self.pixel(x, y, [0, 1, 2].map(|channel| bytes[first + channel]))
        };
        let pixels = renderer.pixels(self.plan, 0..height, done, verdict);
        pixels.ok_or_else(|| io::ErrorKind::Interrupted.into())
    }
}

/// Returns the verdict on the byte of a channel. `missing` is the most that the image may lack.
fn verdict<F: Float>(channel: Interval<F>, byte: u8, missing: f64) -> Verdict {
    let level = Interval::constant(255.0) * channel;
    let to_byte = |level: F| level.floor().to_f64() as u8;
    let (low, high) = (to_byte(level.low), to_byte(level.high));
    let least = to_byte((level - Interval::constant(255.0 * missing)).low);
    if low == high && byte == low {
        Verdict::Proven
    } else if (least..=high).contains(&byte) {
        Verdict::Open
    } else {
        Verdict::Contradicted
    }
}
