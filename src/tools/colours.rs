//! Proves the colours of pixels: encloses each channel in an interval, and compares the bytes with those of the image.
//!
//! A decision that intervals leave open widens the colour, or opens the pixel.

use std::cell::Cell;
use std::ops::ControlFlow;
use tabray_core::geometry::sight::Sight;
use tabray_core::render::bytes::level;
use tabray_core::render::enclosed::{
    Colour, EnclosedScene, EnclosingTracer, LightPoints, Limits, SceneBounds,
};
use tabray_core::render::plan::Plan;
use tabray_core::render::plan::depth::FAINT;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace;
use tabray_core::world::certify::Precise;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_exact::interval::{Float, Fraction, Interval};
use tabray_exact::scalar::{Scalar, per_axis};

/// The limits for following rays: branches that no byte is likely to notice are left out, and those that are open by
/// a level open the pixel.
fn limits<F: Float>() -> Limits {
    // An operation with many digits takes a hundred times as long.
    let fewer = if F::IS_LONG { 10 } else { 1 };
    let (hits, depth) = (4000 / fewer, 300 / fewer);
    Limits { hits, depth, places: usize::MAX, negligible: 1e-11, tolerable: 1.0 / 255.0 }
}

/// The verdict on a byte, or on a pixel: the last in this order of those of its bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The byte is that of the true colour.
    Proven,
    /// The byte is not that of the true colour, but `f64` does not tell: the true ray passes through an edge, or the
    /// true level is an integer, up to rounding. An enclosure in `f64` contains the byte.
    Rounded,
    /// The enclosure of the true colour contains several bytes, or the colour is not known.
    #[default]
    Open,
    /// The byte is open because a ray may meet a shape without an equation.
    Uncertified,
    /// No enclosure of the true colour contains the byte.
    Contradicted,
}

impl Verdict {
    /// All verdicts, in their order.
    pub const ALL: [Self; 5] =
        [Self::Proven, Self::Rounded, Self::Open, Self::Uncertified, Self::Contradicted];
}

/// The verdicts on the three bytes of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// The verdicts on red, green and blue.
    pub channels: [Verdict; 3],
}

impl Pixel {
    /// Returns the verdict on the whole pixel.
    pub fn verdict(&self) -> Verdict {
        self.channels.into_iter().max().unwrap_or_default()
    }
}

/// The result of one precision for a pixel.
struct Attempt {
    pixel: Pixel,
    /// Whether the colour was enclosed, and no branch of it only bounded.
    is_enclosed: bool,
    /// Whether a higher precision would tell no more.
    is_final: bool,
    /// Whether a ray may meet a shape without an equation.
    meets_uncertified: bool,
}

/// The enclosure of a pixel's colour in one precision.
struct Enclosed<F: Precise> {
    /// The colour; `None` where it is open.
    colour: Option<Colour<Interval<F>>>,
    /// Whether any branch was only bounded by its largest magnitude.
    is_open: bool,
    /// Whether branches were not followed because of a limit.
    is_spent: bool,
    /// Whether a ray may meet a shape without an equation.
    meets_uncertified: bool,
}

impl Attempt {
    /// Returns a verdict that names the reason why it is open.
    fn named(&self, verdict: Verdict) -> Verdict {
        if verdict == Verdict::Open && self.meets_uncertified { Verdict::Uncertified } else { verdict }
    }
}

/// Proves the colours of an image.
pub struct Prover<'p, 'm> {
    plan: &'p Plan<'m>,
    bounds: SceneBounds,
}

impl<'p, 'm> Prover<'p, 'm> {
    /// Prepares the proofs of a plan.
    pub fn new(plan: &'p Plan<'m>) -> Self {
        Self { plan, bounds: SceneBounds::of(plan.model) }
    }

    /// Returns the verdict on a pixel as the tracer renders it: `x` counts from the left, `y` from the bottom.
    pub fn traced(&self, x: usize, y: usize) -> Pixel {
        self.pixel(x, y, self.plan.camera.display().bytes(trace::pixel(self.plan, x, y)))
    }

    /// Returns the verdict on a pixel with these bytes: `x` counts from the left, `y` from the bottom.
    pub fn pixel(&self, x: usize, y: usize, bytes: [u8; 3]) -> Pixel {
        let quick = self.verdicts::<f64>(x, y, bytes);
        if quick.is_final {
            return Pixel { channels: quick.pixel.channels.map(|verdict| quick.named(verdict)) };
        }
        let last = self.verdicts::<Fraction>(x, y, bytes);
        let may_round = quick.is_enclosed;
        let channels = per_axis(|channel| match last.pixel.channels[channel] {
            Verdict::Contradicted if may_round && quick.pixel.channels[channel] == Verdict::Open => {
                Verdict::Rounded
            }
            verdict => last.named(verdict),
        });
        Pixel { channels }
    }

    /// Tries a proof in one precision.
    fn verdicts<F: Precise>(&self, x: usize, y: usize, bytes: [u8; 3]) -> Attempt {
        let Enclosed { colour, is_open, is_spent, meets_uncertified } = self.colour::<F>(x, y);
        let Some(colour) = colour else {
            let pixel = Pixel::default();
            return Attempt { pixel, is_enclosed: false, is_final: is_spent, meets_uncertified };
        };
        let (display, leaves_out) = (self.plan.camera.display(), self.plan.depth.is_some());
        // Rays may be left out that add less than `FAINT` to a pixel, or under the free rules change it by less than
        // `MAX_ERROR`.
        let (missing, off) = if leaves_out { (FAINT, MAX_ERROR) } else { (0.0, 0.0) };
        let possible = match display.truncates() {
            Some(_) => colour.map(|channel| truncated(channel, missing)),
            None => rounded(&display, &colour, off),
        };
        let channels = per_axis(|channel| verdict(possible[channel], bytes[channel]));
        let is_final = is_spent || !channels.contains(&Verdict::Open);
        Attempt { pixel: Pixel { channels }, is_enclosed: !is_open, is_final, meets_uncertified }
    }

    /// Encloses a pixel's colour, the mean of its samples.
    fn colour<F: Precise>(&self, x: usize, y: usize) -> Enclosed<F> {
        let (plan, camera) = (self.plan, &self.plan.camera);
        let scene = EnclosedScene {
            model: plan.model,
            lights: &plan.needs.lights,
            depth: plan.depth.as_ref(),
            bounds: &self.bounds,
            window: camera.window(),
            meets_uncertified: Cell::new(false),
        };
        let mut sum = Some([Interval::constant(0.0); 3]);
        let (mut is_open, mut is_spent) = (false, false);
        for (place, sample) in camera.places(x, y, camera.samples) {
            let sight: Sight = camera.sight_of(place, sample.as_ref());
            let lights = sample.map_or(LightPoints::Middle, LightPoints::Of);
            let mut tracer = EnclosingTracer::new(&scene, limits::<F>(), lights);
            let colour = tracer.primary(&sight.line::<Interval<F>>());
            is_open |= tracer.is_open();
            is_spent |= tracer.is_spent();
            sum = sum.zip(colour).map(|(sum, colour)| per_axis(|channel| sum[channel] + colour[channel]));
            if sum.is_none() {
                break;
            }
        }
        let count = Interval::constant(f64::from(camera.samples));
        let mean = |sum: Colour<Interval<F>>| per_axis(|channel| sum[channel] / count);
        let colour = if camera.samples == 1 { sum } else { sum.map(mean) };
        Enclosed { colour, is_open, is_spent, meets_uncertified: scene.meets_uncertified.get() }
    }

    /// Returns the verdicts on all pixels of the image that is rendered here, row by row from the top. `done` is called
    /// after each row; once `stops` returns true, pixels have no verdict.
    pub fn picture(
        &self,
        renderer: &Renderer,
        done: &(dyn Fn() + Sync),
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<Pixel>> {
        let [width, height] = self.plan.camera.pixels;
        let bytes = renderer.picture(self.plan);
        let verdict = |x: usize, y: usize| {
            let first = 3 * ((height - 1 - y) * width + x);
            (!stops()).then(|| self.pixel(x, y, per_axis(|channel| bytes[first + channel])))
        };
        let done = || {
            done();
            ControlFlow::Continue(())
        };
        renderer.pixels(self.plan, 0..height, &done, verdict).unwrap_or_default()
    }
}

/// The bytes that a channel may be: the least of an image that leaves out rays, the least and the greatest of one
/// that does not, and the greatest of one that leaves out rays.
type Possible = [u8; 4];

/// The maximum error in levels of an image of the free rules where rays are left out: the image shows the middle of
/// bounds that are up to a level apart.
const MAX_ERROR: f64 = 0.5;

/// Returns the bytes of a channel under the notes' rules. `missing` is the most that the image may lack.
fn truncated<F: Float>(channel: Interval<F>, missing: f64) -> Possible {
    let level = level(channel);
    let least = (level - Interval::constant(255.0 * missing)).low;
    [least, level.low, level.high, level.high].map(|level| level.floor().to_f64() as u8)
}

/// Returns the bytes of a colour under the free rules. `off` is the number of levels that the image may be off.
fn rounded<F: Float>(display: &Display, colour: &Colour<Interval<F>>, off: f64) -> [Possible; 3] {
    // An upper limit on the rounding errors of a level in `f64`, and of its code.
    const OFF: f64 = 1e-9;
    let end = |of: fn(&Interval<F>) -> F| Rgb::from_array(per_axis(|channel| of(&colour[channel]).to_f64()));
    let (low, high) = (end(|channel| channel.low), end(|channel| channel.high));
    let [low, high] = display.shown_within([low, high]);
    let byte = |level: f64| level.round() as u8;
    per_axis(|channel| {
        [
            byte(255.0 * low[channel] - off - OFF),
            byte(255.0 * low[channel] - OFF),
            byte(255.0 * high[channel] + OFF),
            byte(255.0 * high[channel] + off + OFF),
        ]
    })
}

/// Returns the verdict on the byte of a channel.
fn verdict([least, low, high, most]: Possible, byte: u8) -> Verdict {
    if low == high && byte == low {
        Verdict::Proven
    } else if (least..=most).contains(&byte) {
        Verdict::Open
    } else {
        Verdict::Contradicted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use tabray_core::scene::model::Model;
    use tabray_lang::reader;
    use tabray_lang::registry::Registry;

    /// The middle pixel of 3 x 3 looks along -z, from 7 units in front of z = -2.
    fn model(objects: &str) -> Model {
        let registry = Registry::get().expect("sound types");
        let scene = format!(
            "camera eye {{ pixeldim 3 3 worlddim 8 6 viewpoint 4 3 5 }}
             light lamp {{ location 4 6 2 emissivity 8 8 8 }} {objects}"
        );
        reader::read(registry, "scene", Path::new(""), scene.as_bytes(), None).expect("a sound scene").model
    }

    /// Asserts that the red of the middle pixel is this fraction, in every precision.
    #[track_caller]
    fn is_red(objects: &str, [numerator, denominator]: [f64; 2]) {
        fn red<F: Precise>(prover: &Prover) -> Interval<F> {
            prover.colour::<F>(1, 1).colour.expect("a known colour")[0]
        }
        fn is_enclosed<F: Float>(red: Interval<F>, [numerator, denominator]: [f64; 2], within: f64) {
            let off = red * Interval::constant(denominator) - Interval::constant(numerator);
            assert!(off.has_zero() && red.width().to_f64() < within, "{red:?}");
        }
        let model = model(objects);
        let plan = Plan::new(&model);
        let prover = Prover::new(&plan);
        is_enclosed(red::<f64>(&prover), [numerator, denominator], 1e-12);
        is_enclosed(red::<Fraction>(&prover), [numerator, denominator], 1e-60);
        is_enclosed(red::<Fraction>(&prover), [numerator, denominator], 1e-60);
        assert_eq!(prover.traced(1, 1).verdict(), Verdict::Proven);
        let byte = (255.0 * numerator / denominator) as u8;
        assert_eq!(prover.pixel(1, 1, [byte + 1, 0, 0]).channels[0], Verdict::Contradicted);
    }

    const BALL: &str = "sphere ball { material matt center 4 3 -3 radius 1 }";

    #[test]
    fn light_behind_undecided_panes_is_open_where_a_tint_is_below_0() {
        // Panes in one place are not decided. The green that they let pass is below 0, and darkens the ball.
        let model = model(
            "material matt { ambient 3.5 3.5 3.5 diffuse 1.25 1.25 1.25 }
             material glass { diffuse 1 -1 1 transparency 0.5 }
             plane one { material glass normal 0 1 0 point 0 4 0 }
             plane other { material glass normal 0 1 0 point 0 4 0 }
             sphere ball { material matt center 4 3 -3 radius 1 }",
        );
        let plan = Plan::new(&model);
        assert_eq!(Prover::new(&plan).traced(1, 1).channels[1], Verdict::Open);
    }

    #[test]
    fn light_is_scattered_as_worked_out_by_hand() {
        // The light is at (0, 3, 4) from the point: 5 away, at a cosine of 4/5. It adds 1.25 * 8 * 4/5 / 5 to 1/2.
        let matt = "material matt { ambient 0.5 0.5 0.5 diffuse 1.25 1.25 1.25 }";
        is_red(&format!("{matt} {BALL}"), [21.0, 70.0]);
    }

    #[test]
    fn a_glint_is_as_worked_out_by_hand() {
        // Half of the way to the light is (0, 3/5, 9/5); the square of its cosine is 9/10.
        let shiny = "material matt { specular 0.125 shininess 2 }";
        is_red(&format!("{shiny} {BALL}"), [9.0, 70.0]);
    }

    #[test]
    fn shadows_and_panes_are_as_worked_out_by_hand() {
        let matt = "material matt { ambient 0.5 0.5 0.5 diffuse 1.25 1.25 1.25 }";
        let stop = "sphere stop { material matt center 4 4.5 0 radius 0.25 }";
        is_red(&format!("{matt} {BALL} {stop}"), [0.5, 7.0]);
        // Both walls of the ball of glass tint the light with 1/4 of red: 1.6 / 16 is added to 1/2.
        let glass = "material glass { diffuse 1 2 2 transparency 0.5 }";
        let pane = "sphere pane { material glass center 4 4.5 0 radius 0.25 }";
        is_red(&format!("{matt} {glass} {BALL} {pane}"), [6.0, 70.0]);
    }

    #[test]
    fn mirrors_and_glass_are_as_worked_out_by_hand() {
        // The mirror shows the far ball 9 before it, 16 from the viewer by way of it.
        let mirror = "material m { ambient 0.5 0.5 0.5 specular 0.25 } plane wall { material m normal 0 0 1 point 0 0 -2 }";
        let behind = "material far { ambient 6 6 6 } sphere far { material far center 4 3 8 radius 1 }";
        // 1/14 + 3/32
        is_red(&format!("{mirror} {behind}"), [37.0, 224.0]);
    }

    #[test]
    fn a_background_in_a_mirror_is_as_worked_out_by_hand() {
        let mirror = "material m { ambient 0.5 0.5 0.5 specular 0.25 } plane wall { material m normal 0 0 1 point 0 0 -2 }";
        // 1/14 + 1/8
        is_red(&format!("{mirror} background pale {{ colour 0.5 0 0 }}"), [11.0, 56.0]);
        is_red("background pale { colour 0.5 0 0 }", [1.0, 2.0]);
    }

    #[test]
    fn a_wall_behind_a_rim_that_is_missed_is_seen() {
        // The ball is cut one part in 2^53 before its nearest point, which intervals in `f64` do not tell. Its inner
        // wall is 9 away; the screen behind it is as bright as the rim would be, at 7.
        let model = model(
            "material pale { ambient 6 6 6 } material bright { ambient 12 12 12 }
             quadric cut { material pale coefficients 1 1 1 0 0 0 0 0 0 1 center 4 3 -3
                           box -2 -2 -2 2 2 0.9999999999999999 }
             plane screen { material bright normal 0 0 1 point 0 0 -9 }",
        );
        let plan = Plan::new(&model);
        let prover = Prover::new(&plan);
        let red = prover.colour::<f64>(1, 1).colour.expect("a known colour")[0];
        assert!((red * Interval::constant(9.0) - Interval::constant(6.0)).has_zero(), "{red:?}");
        assert_eq!(prover.pixel(1, 1, [170; 3]).verdict(), Verdict::Proven);
        assert_ne!(prover.pixel(1, 1, [218; 3]).verdict(), Verdict::Proven);
    }

    #[test]
    fn a_pixel_at_the_edge_of_a_tile_is_decided() {
        let tiles = |color: &str| {
            format!(
                "material matt {{ ambient {color} }} pplane wall {{ material matt normal 0 0 1 point 0 0 -2 shader 0 }}"
            )
        };
        // The point is (4, 3, -2): the corner of four tiles. That of greater x and z is even, without blue.
        let model = model(&tiles("3.5 3.5 3.5"));
        let plan = Plan::new(&model);
        let prover = Prover::new(&plan);
        assert_eq!(prover.pixel(1, 1, [127, 127, 0]).channels, [Verdict::Proven; 3]);
        assert_eq!(
            prover.pixel(1, 1, [0, 127, 127]).channels,
            [Verdict::Rounded, Verdict::Proven, Verdict::Rounded]
        );
        assert_eq!(prover.pixel(1, 1, [0, 128, 127]).verdict(), Verdict::Contradicted);
    }
}
