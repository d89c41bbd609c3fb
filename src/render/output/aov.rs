//! Auxiliary images: depth, normals, objects, the cost of each pixel and its error.

use crate::bytes::to_byte;
use crate::observer::{Event, TraceObserver};
use crate::output::numbers::{NumberFormat, Numbers};
use crate::plan::Plan;
use crate::renderer::Renderer;
use crate::trace::{self, PixelBound};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::io;
use std::ops::ControlFlow;
use tabray_world::display::{Display, Tone, Transfer};
use tabray_world::geometry::sight::Sight;
use tabray_world::material::Rgb;
use tabray_world::named;
use tabray_world::rules::Rules;
use tabray_world::sensor::Sensor;

/// An auxiliary image (an arbitrary output variable). Depth, normal, object, face and the error of the distance are
/// taken along the ray through the centre of each pixel, however many samples the pixel has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Aov {
    /// Distance of the first hit, near ones bright.
    ///
    /// The nearest is white, the farthest dark grey, nothing black.
    Depth,
    /// Surface normal: red, green and blue are x, y and z.
    ///
    /// Each from -1, black, to 1.
    Normal,
    /// Object seen, each in its own colour.
    Object,
    /// Face seen of a mesh, a box, a prism or a polygon, each in its own colour.
    ///
    /// Black where nothing is hit, or a shape without faces.
    Face,
    /// Colour, before it is clamped and rounded.
    ///
    /// With all samples, as in the main image.
    Colour,
    /// Number of rays that a pixel takes.
    ///
    /// The most expensive pixel is white.
    Cost,
    /// Number of samples that a pixel takes.
    ///
    /// The maximum number is white, one is black, and equal ratios are equally far apart.
    Samples,
    /// Error of a pixel's colour, against four times its samples, at least 64, traced exactly.
    ///
    /// The worst one is white; red where another object is seen. With --certain, what is proven of it: grey up to the
    /// limit, and red where that is not certain.
    Error,
    /// Pixels whose first hit could not be decided: white, all others black.
    ///
    /// With all samples, as in the main image: one undecided camera ray makes its pixel white.
    Undecided,
}

/// An auxiliary image, row by row from the top, each row from the left.
pub struct Layer {
    /// Red, green and blue of each pixel, to be looked at.
    pub bytes: Vec<u8>,
    /// The numbers behind the image, where the numbers say more than the bytes. A normal is 0 where nothing is hit.
    /// Samples consist of their number, the estimated error of the colour, and 1 where that is above the limit, else 0.
    /// An error consists of the error of the colour, the root of the mean square over its channels; the error of the
    /// distance to the first hit, in world units; and 1 where another object is hit, else 0. A proven bound consists of
    /// the bound, where 1 is white, the number of footprints, and 1 where the bound is above the limit, else 0.
    pub numbers: Option<Numbers>,
    /// The number of rays of the most expensive pixel, and that pixel: its column from the left and its row from the
    /// bottom.
    pub most: Option<(u64, [usize; 2])>,
    /// The greatest error of a colour, where 1 is white, and its pixel: column from the left, row from the bottom.
    pub worst: Option<(f64, [usize; 2])>,
}

/// The grey of the farthest depth, as a fraction of white. It differs from the black where nothing is hit.
const FARTHEST: f64 = 0.1;

named!(Aov {
    Depth => "depth",
    Normal => "normal",
    Object => "object",
    Face => "face",
    Colour => "colour",
    Cost => "cost",
    Samples => "samples",
    Error => "error",
    Undecided => "undecided",
});

impl Aov {
    /// Returns the formats of the files that hold the numbers of the image.
    pub fn number_formats(self) -> &'static [NumberFormat] {
        match self {
            Self::Depth | Self::Object | Self::Face => &[NumberFormat::Exr, NumberFormat::Npy],
            Self::Normal | Self::Colour | Self::Samples | Self::Error => &[NumberFormat::Exr],
            Self::Cost | Self::Undecided => &[],
        }
    }

    /// Renders this image. `truth` is a plan of the same scene, exact and with many samples; only the error uses it.
    /// `done` is called after each row, and may break off.
    ///
    /// # Errors
    /// `Interrupted` if `done` broke off.
    pub fn render(
        self,
        renderer: &Renderer,
        plan: &Plan,
        truth: &Plan,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> io::Result<Layer> {
        let setting = Setting::of(&plan.camera);
        match self {
            Self::Depth => Ok(depth(&each(renderer, plan, done, |x, y| depth_at(plan, x, y))?)),
            Self::Normal => Ok(normal(&each(renderer, plan, done, |x, y| normal_at(plan, x, y))?)),
            Self::Object => Ok(indices("object", each(renderer, plan, done, |x, y| object_at(plan, x, y))?)),
            Self::Face => Ok(indices("face", each(renderer, plan, done, |x, y| face_at(plan, x, y))?)),
            Self::Colour => {
                Ok(colour(&each(renderer, plan, done, |x, y| trace::pixel(plan, x, y))?, &setting.display()))
            }
            Self::Cost => Ok(cost(&each(renderer, plan, done, |x, y| cost_at(plan, x, y))?, setting.size)),
            Self::Samples => {
                Ok(samples(&each(renderer, plan, done, |x, y| trace::samples(plan, x, y))?, &setting))
            }
            Self::Error if plan.camera.certain => {
                let proofs =
                    each(renderer, plan, done, |x, y| trace::bounded(plan, x, y).unwrap_or_default())?;
                Ok(bounds(&proofs, &setting))
            }
            Self::Error => {
                let errors = each(renderer, plan, done, |x, y| PixelError::of(plan, truth, x, y))?;
                Ok(error(&errors, setting.size))
            }
            Self::Undecided => {
                Ok(undecided(&each(renderer, plan, done, |x, y| trace::is_undecided(plan, x, y))?))
            }
        }
    }
}

/// The settings of a render on which the colours of an auxiliary image depend, besides the numbers of its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// The width and height of the image in pixels.
    pub size: [usize; 2],
    /// The maximum number of samples of a pixel.
    most: u32,
    /// The limit on the error of a pixel, where 1 is white, as its bits: a number written in decimals may come back as
    /// another.
    limit: Option<u64>,
    /// How light is shown: the exposure is given as its bits.
    display: (Rules, u64, Tone, Transfer),
    /// Whether errors are proven.
    pub(super) certain: bool,
}

impl Setting {
    /// Returns the settings of a camera.
    pub fn of(camera: &Sensor) -> Self {
        Self {
            size: camera.pixels,
            most: camera.adaptive.map_or(camera.samples, |adaptive| adaptive.most),
            limit: camera.adaptive.and_then(|adaptive| adaptive.error).map(f64::to_bits),
            display: (camera.rules, camera.exposure.to_bits(), camera.tone, camera.transfer),
            certain: camera.certain,
        }
    }

    pub(super) fn display(&self) -> Display {
        let (rules, exposure, tone, transfer) = self.display;
        Display::new(rules, f64::from_bits(exposure), tone, transfer)
    }

    fn limit(&self) -> Option<f64> {
        self.limit.map(f64::from_bits)
    }
}

/// Counts the rays of a pixel.
struct Rays(u64);

impl TraceObserver for Rays {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        if let Event::Search(_) = event {
            self.0 += 1;
        }
    }
}

fn each<T: Clone + Default + Send>(
    renderer: &Renderer,
    plan: &Plan,
    done: &(dyn Fn() -> ControlFlow<()> + Sync),
    pixel: impl Fn(usize, usize) -> T + Sync,
) -> io::Result<Vec<T>> {
    let [_, height] = plan.camera.pixels;
    renderer.pixels(plan, 0..height, done, pixel).ok_or_else(|| io::ErrorKind::Interrupted.into())
}

pub(super) fn depth_at(plan: &Plan, x: usize, y: usize) -> f64 {
    trace::first_hit(plan, &middle(plan, x, y)).map_or(f64::INFINITY, |hit| hit.distance)
}

pub(super) fn normal_at(plan: &Plan, x: usize, y: usize) -> Option<DVec3> {
    trace::first_hit(plan, &middle(plan, x, y)).map(|hit| hit.object.shape.normal(hit.point))
}

pub(super) fn object_at(plan: &Plan, x: usize, y: usize) -> Option<u32> {
    trace::first_hit(plan, &middle(plan, x, y)).map(|hit| hit.index as u32)
}

pub(super) fn face_at(plan: &Plan, x: usize, y: usize) -> Option<u32> {
    let sight = middle(plan, x, y);
    trace::first_hit(plan, &sight).and_then(|hit| hit.object.shape.face_hit(&sight.ray(), hit.distance))
}

pub(super) fn cost_at(plan: &Plan, x: usize, y: usize) -> u64 {
    let mut rays = Rays(0);
    trace::observe_pixel(plan, x, y, &mut rays);
    rays.0
}

fn middle(plan: &Plan, x: usize, y: usize) -> Sight {
    plan.camera.sight(x as f64, y as f64)
}

fn shown_all(colours: impl Iterator<Item = DVec3>) -> Vec<u8> {
    colours.flat_map(|colour| colour.to_array().map(to_byte)).collect()
}

pub(super) fn depth(depths: &[f64]) -> Layer {
    // Brightness falls with 1 / distance, so near objects keep their contrast beside a plane that extends to
    // infinity.
    let finite = || depths.iter().filter(|depth| depth.is_finite()).map(|depth| 1.0 / depth);
    let (far, near) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    let grey = |depth: &f64| match 1.0 / depth {
        0.0 => 0.0,
        _ if near == far => 1.0,
        nearness => FARTHEST + (1.0 - FARTHEST) * (nearness - far) / (near - far),
    };
    Layer {
        bytes: shown_all(depths.iter().map(grey).map(DVec3::splat)),
        numbers: Some(Numbers::Distances(depths.to_vec())),
        most: None,
        worst: None,
    }
}

pub(super) fn normal(normals: &[Option<DVec3>]) -> Layer {
    Layer {
        bytes: shown_all(normals.iter().map(|normal| normal.map_or(DVec3::ZERO, |n| 0.5 * n + 0.5))),
        numbers: Some(Numbers::Triples(
            normals.iter().flat_map(|n| n.unwrap_or_default().to_array().map(|part| part as f32)).collect(),
        )),
        most: None,
        worst: None,
    }
}

pub(super) fn colour(colours: &[Rgb], display: &Display) -> Layer {
    let exact = |colour: &Rgb| display.full_range(*colour).as_vec3().to_array();
    Layer {
        bytes: colours.iter().flat_map(|colour| display.bytes(*colour)).collect(),
        numbers: Some(Numbers::Triples(colours.iter().flat_map(exact).collect())),
        most: None,
        worst: None,
    }
}

pub(super) fn indices(of: &'static str, indices: Vec<Option<u32>>) -> Layer {
    Layer {
        bytes: shown_all(indices.iter().map(|index| index.map_or(DVec3::ZERO, colour_of))),
        numbers: Some(Numbers::Indices { of, indices }),
        most: None,
        worst: None,
    }
}

pub(super) fn undecided(pixels: &[bool]) -> Layer {
    Layer {
        bytes: pixels.iter().flat_map(|is_undecided| [if *is_undecided { 255 } else { 0 }; 3]).collect(),
        numbers: None,
        most: None,
        worst: None,
    }
}

pub(super) fn cost(costs: &[u64], [width, height]: [usize; 2]) -> Layer {
    let most = costs.iter().copied().max().unwrap_or(0);
    let place = costs.iter().position(|cost| *cost == most).unwrap_or(0);
    Layer {
        bytes: shown_all(costs.iter().map(|cost| DVec3::splat(*cost as f64 / most.max(1) as f64))),
        numbers: None,
        most: Some((most, [place % width, height - 1 - place / width])),
        worst: None,
    }
}

pub(super) fn samples(pixels: &[(u32, Option<f64>)], setting: &Setting) -> Layer {
    let most = setting.most;
    let shade = |(samples, _): &(u32, Option<f64>)| {
        let part = libm::log2(f64::from(*samples)) / libm::log2(f64::from(most));
        DVec3::splat(if most == 1 { 1.0 } else { part })
    };
    let limit = setting.limit().unwrap_or(f64::INFINITY);
    let numbers = |(samples, error): &(u32, Option<f64>)| {
        let error = error.unwrap_or(0.0);
        [*samples as f32, error as f32, f32::from(u8::from(error > limit))]
    };
    Layer {
        bytes: shown_all(pixels.iter().map(shade)),
        numbers: Some(Numbers::Triples(pixels.iter().flat_map(numbers).collect())),
        most: None,
        worst: None,
    }
}

/// Shows proven bounds: grey up to the limit, and red beyond.
pub(super) fn bounds(pixels: &[PixelBound], setting: &Setting) -> Layer {
    let [width, height] = setting.size;
    let limit = setting.limit().unwrap_or(1.0);
    let worst = pixels.iter().map(|pixel| pixel.error).fold(0.0, f64::max);
    let place = pixels.iter().position(|pixel| pixel.error == worst).unwrap_or(0);
    let shade = |pixel: &PixelBound| match pixel.is_certified {
        true => DVec3::splat(0.5 * pixel.error / limit),
        false => DVec3::X,
    };
    let numbers = |pixel: &PixelBound| {
        let open = if pixel.is_certified { 0.0 } else { 1.0 };
        [(pixel.error as f32).next_up(), pixel.footprints as f32, open]
    };
    Layer {
        bytes: shown_all(pixels.iter().map(shade)),
        numbers: Some(Numbers::Triples(pixels.iter().flat_map(numbers).collect())),
        most: None,
        worst: Some((worst, [place % width, height - 1 - place / width])),
    }
}

/// The errors of a pixel.
#[derive(Clone, Copy, Default)]
pub(super) struct PixelError {
    /// The root of the mean square of the channels' errors, where 1 is white.
    pub colour: f64,
    /// The error of the distance along the ray through the pixel's centre, in world units; 0 where another object is
    /// hit.
    pub distance: f64,
    /// Whether the ray through the pixel's centre hits another object.
    pub is_other: bool,
}

impl PixelError {
    pub fn of(plan: &Plan, truth: &Plan, x: usize, y: usize) -> Self {
        let colours = [plan, truth].map(|plan| plan.camera.display().shown(trace::pixel(plan, x, y)));
        let [found, right] = [plan, truth].map(|plan| trace::first_hit(plan, &middle(plan, x, y)));
        let [found, right] = [found, right].map(|hit| hit.map(|hit| (hit.index, hit.distance)));
        let is_other = found.map(|(index, _)| index) != right.map(|(index, _)| index);
        let distance = match (found, right) {
            (Some((_, found)), Some((_, right))) if !is_other => (found - right).abs(),
            _ => 0.0,
        };
        Self { colour: (colours[0] - colours[1]).length() / 3.0_f64.sqrt(), distance, is_other }
    }
}

pub(super) fn error(errors: &[PixelError], [width, height]: [usize; 2]) -> Layer {
    let worst = errors.iter().map(|pixel| pixel.colour).fold(0.0, f64::max);
    let place = errors.iter().position(|pixel| pixel.colour == worst).unwrap_or(0);
    let shade = |pixel: &PixelError| match pixel {
        PixelError { is_other: true, .. } => DVec3::X,
        _ if worst == 0.0 => DVec3::ZERO,
        PixelError { colour, .. } => DVec3::splat(colour / worst),
    };
    let numbers = |pixel: &PixelError| {
        [pixel.colour, pixel.distance, f64::from(pixel.is_other)].map(|number| number as f32)
    };
    Layer {
        bytes: shown_all(errors.iter().map(shade)),
        numbers: Some(Numbers::Triples(errors.iter().flat_map(numbers).collect())),
        most: None,
        worst: Some((worst, [place % width, height - 1 - place / width])),
    }
}

/// Returns a colour for this index. Hues advance by the golden ratio, so the first few differ well however many there
/// are.
fn colour_of(index: u32) -> DVec3 {
    let hue = (f64::from(index) * 0.618_033_988_749_895).fract();
    let channel = |shift: f64| ((6.0 * (hue + shift).fract() - 3.0).abs() - 1.0).clamp(0.0, 1.0);
    let pure = DVec3::new(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0));
    0.25 + 0.75 * pure
}
