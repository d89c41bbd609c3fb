//! Certified pixels: proofs about all rays through a pixel's footprint at once.
//!
//! The colour of a pixel, which samples estimate, is a mean over the primary rays through a square around the pixel's
//! centre, one pixel wide, and over the points of lights with a size. A footprint is a part of that square. The rules
//! of rendering are evaluated for all of its rays in [`Affine`] numbers: functions that are linear in the place
//! within the footprint, up to a bound. Where every decision is the same for all rays, the mean is known to within
//! that bound, however steep the linear part is. Where a decision is open, such as which of two objects is seen, the
//! colour is enclosed for both outcomes.
//!
//! The footprint whose mean is least known is cut into quarters, repeatedly, until the mean of the whole pixel is
//! known well enough.

use crate::enclosed::{EnclosedScene, EnclosingTracer, LightPoints, Limits, SceneBounds};
use crate::plan::depth::Depth;
use std::cell::Cell;
use tabray_exact::affine::Affine;
use tabray_exact::double_double::power_of_two;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;
use tabray_world::display::Display;
use tabray_world::geometry::image_point::ImagePoint;
use tabray_world::geometry::sight::Line;
use tabray_world::material::Rgb;
use tabray_world::scene::model::Model;
use tabray_world::sensor::Sensor;

/// How far the rays of a footprint are followed: branches that add no more than 1/400 of a level are left out.
pub(super) const LIMITS: Limits =
    Limits { hits: 48, depth: 24, places: 6, negligible: 1e-5, tolerable: f64::INFINITY };

/// The maximum number of footprints that are examined for a pixel.
pub(crate) const MAX_FOOTPRINTS: usize = 1 + 4 * 256;

/// The maximum number of times that a footprint may be cut into quarters.
pub(crate) const MAX_CUTS: u32 = 10;

/// From this number of footprints on, the search judges whether [`MAX_FOOTPRINTS`] will be enough.
const JUDGED: usize = 1 + 4 * 16;

/// An upper limit on the rounding errors of a colour within its bounds, where 1 is white.
const ROUNDING: f64 = 1e-14;

/// Proven bounds of a pixel's colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// The least possible colour, before exposure; infinite where nothing is known.
    pub low: Rgb,
    /// The greatest possible colour, before exposure.
    pub high: Rgb,
    /// The number of footprints that were examined.
    pub footprints: u32,
}

impl Proof {
    /// Returns the colour about midway between the bounds as shown, before exposure.
    pub fn middle(&self, display: &Display) -> Rgb {
        display.middle([self.low, self.high])
    }

    /// Bounds the error of a colour within the bounds, as shown: the largest difference from the true colour in any
    /// channel, where 1 is white.
    pub fn error(&self, colour: Rgb, display: &Display) -> f64 {
        let [low, high] = display.shown_within([self.low, self.high]);
        let shown = display.shown(colour);
        (high - shown).max(shown - low).max_element() + ROUNDING
    }

    /// Returns the possible colour nearest to this colour.
    pub fn nearest(&self, colour: Rgb) -> Rgb {
        colour.max(self.low).min(self.high)
    }

    /// Tells whether the error of the middle colour, as shown, is within a limit, where 1 is white.
    pub fn is_within(&self, error: f64, display: &Display) -> bool {
        self.half_width(display) <= error
    }

    /// Bounds the error of the middle colour, as shown: the largest of the channels, where 1 is white.
    pub fn half_width(&self, display: &Display) -> f64 {
        if display.truncates().is_none() {
            return self.error(self.middle(display), display);
        }
        0.5 * (display.shown(self.high) - display.shown(self.low)).max_element() + ROUNDING
    }
}

/// A part of a pixel.
#[derive(Clone, Copy)]
struct Footprint {
    /// The image position of its middle, in pixels.
    middle: [f64; 2],
    /// The number of cuts that led to it.
    cuts: u32,
    /// Encloses the mean of its colours.
    mean: [Interval; 3],
}

impl Footprint {
    /// Returns the fraction of the pixel that it covers.
    fn area(&self) -> f64 {
        power_of_two(-2 * self.cuts as i32)
    }

    /// Returns the uncertainty that it adds to the pixel's colour; 0 where it may not be cut again.
    fn open(&self) -> f64 {
        if self.cuts == MAX_CUTS {
            return 0.0;
        }
        self.area() * self.mean.iter().fold(0.0, |open: f64, channel| open.max(channel.width()))
    }
}

/// Proves the colours of a model's pixels.
pub struct PixelProver {
    bounds: SceneBounds,
    lights: Vec<usize>,
}

impl PixelProver {
    /// Prepares the proofs of a model.
    pub fn new(model: &Model) -> Self {
        Self { bounds: SceneBounds::of(model), lights: (0..model.lights.len()).collect() }
    }

    /// Encloses the colour of a pixel, until the colour as shown is known to within `error`, where 1 is white, or
    /// until a limit is reached. `x` counts pixels from the left and `y` from the bottom.
    pub fn pixel(
        &self,
        (model, depth): (&Model, Option<&Depth>),
        camera: &Sensor,
        [x, y]: [usize; 2],
        error: f64,
    ) -> Proof {
        let Self { bounds, lights } = self;
        let (window, meets_uncertified) = (camera.window(), Cell::new(false));
        let scene = EnclosedScene { model, lights, depth, bounds, window, meets_uncertified };
        let display = &camera.display();
        let footprint = |middle: [f64; 2], cuts: u32| {
            let lines = lines(camera, middle, power_of_two(-(cuts as i32) - 1));
            let mut tracer = EnclosingTracer::new(&scene, LIMITS, LightPoints::All);
            let colour = lines.and_then(|lines| tracer.primary(&lines)).unwrap_or([Affine::WHOLE; 3]);
            Footprint { middle, cuts, mean: colour.map(|channel| channel.mean()) }
        };
        let mut all = vec![footprint([x as f64, y as f64], 0)];
        let mut count = 1;
        loop {
            let proof = proof(&all, count);
            let half = proof.half_width(display);
            if proof.is_within(error, display) || count + 4 > MAX_FOOTPRINTS {
                return proof;
            }
            // The uncertainty at edges is inversely proportional to the number of footprints.
            if count >= JUDGED && half * count as f64 > error * MAX_FOOTPRINTS as f64 {
                return proof;
            }
            let open = |index: &usize| all[*index].open();
            let widest = (0..all.len()).max_by(|one, other| open(one).total_cmp(&open(other)));
            let Some(widest) = widest.filter(|index| open(index) > 0.0) else { return proof };
            let Footprint { middle: [x, y], cuts, .. } = all.swap_remove(widest);
            let quarter = power_of_two(-(cuts as i32) - 2);
            let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
            all.extend(
                corners.map(|[right, up]| footprint([x + right * quarter, y + up * quarter], cuts + 1)),
            );
            count += 4;
        }
    }
}

/// Returns the bounds of the colour of a pixel that consists of these footprints.
fn proof(all: &[Footprint], count: usize) -> Proof {
    let mut sum = [Interval::constant(0.0); 3];
    for footprint in all {
        let area = Interval::constant(footprint.area());
        sum = [0, 1, 2].map(|channel| sum[channel] + area * footprint.mean[channel]);
    }
    Proof {
        low: Rgb::from_array(sum.map(|channel| channel.low)),
        high: Rgb::from_array(sum.map(|channel| channel.high)),
        footprints: count as u32,
    }
}

/// Returns the primary rays through a square of the image, given by its middle and half its width in pixels; `None`
/// where the camera does not enclose them.
pub(super) fn lines(camera: &Sensor, middle: [f64; 2], half: f64) -> Option<Line<Affine>> {
    let at = [0, 1].map(|side| Affine::variable(side, middle[side], half));
    camera.camera.footprint(ImagePoint { at, pixels: camera.pixels })
}
