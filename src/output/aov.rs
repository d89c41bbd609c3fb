//! Pictures of what a renderer works with beside colours: depth, normals, objects, what each pixel costs, and how
//! wrong it is.

use crate::geometry::sight::Sight;
use crate::render::bytes::{shown, to_byte};
use crate::render::observer::{Event, TraceObserver};
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::render::trace;
use clap::ValueEnum;
use glam::DVec3;
use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::{self, Cursor};
use std::ops::ControlFlow;

/// A picture beside the main one (an arbitrary output variable). All but the cost look along the middle of each
/// pixel, however many samples it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
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
    /// Number of rays that a pixel takes.
    ///
    /// The most expensive pixel is white.
    Cost,
    /// Error of a pixel's colour, against four times its samples, at least 64, traced exactly.
    ///
    /// The worst one is white; red where another object is seen.
    Error,
}

/// Such a picture, from the top and from the left.
pub struct Layer {
    /// Red, green and blue of each pixel, to be looked at.
    pub bytes: Vec<u8>,
    /// The numbers behind it, three for each pixel, where there is more to them than the bytes tell. A depth
    /// fills all three channels and is infinite where there is nothing; a normal is 0 there. An error has that of the
    /// colour, the root of the mean square over its channels, then that of the first hit's distance, and 1 where that
    /// is another object's.
    pub exact: Option<Vec<f32>>,
    /// The rays that the most expensive pixel costs, and that pixel, counted as everywhere: from the left and
    /// from the bottom.
    pub most: Option<(u64, [usize; 2])>,
    /// The greatest error of a colour, and its pixel.
    pub worst: Option<(f64, [usize; 2])>,
}

/// The part of white that the farthest depth has, to tell it from nothing.
const FARTHEST: f64 = 0.1;

impl Aov {
    /// Whether its layer has exact numbers.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Depth | Self::Normal | Self::Error)
    }

    /// Makes this picture. `truth` is the same scene, exact and with many samples, which only the error is
    /// seen against. `done` is told of each row, and may break off.
    ///
    /// # Errors
    /// `Interrupted` where `done` broke off.
    pub fn render(
        self,
        renderer: &Renderer,
        plan: &Plan,
        truth: &Plan,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> io::Result<Layer> {
        match self {
            Self::Depth => Ok(depth(&each(renderer, plan, done, |x, y| {
                trace::first_hit(plan, &middle(plan, x, y)).map_or(f64::INFINITY, |hit| hit.distance)
            })?)),
            Self::Normal => Ok(normal(&each(renderer, plan, done, |x, y| {
                let hit = trace::first_hit(plan, &middle(plan, x, y));
                hit.map(|hit| hit.object.shape.normal(hit.point))
            })?)),
            Self::Object => Ok(object(&each(renderer, plan, done, |x, y| {
                trace::first_hit(plan, &middle(plan, x, y)).map(|hit| hit.index)
            })?)),
            Self::Cost => {
                let costs = each(renderer, plan, done, |x, y| {
                    let mut rays = Rays(0);
                    trace::observe_pixel(plan, x, y, &mut rays);
                    rays.0
                })?;
                Ok(cost(&costs, plan.camera.pixels))
            }
            Self::Error => {
                let errors = each(renderer, plan, done, |x, y| Off::of(plan, truth, x, y))?;
                Ok(error(&errors, plan.camera.pixels))
            }
        }
    }
}

impl Layer {
    /// The exact numbers as an OpenEXR file.
    ///
    /// # Errors
    /// Where there are none, and a size that the format cannot hold.
    pub fn exr(&self, [width, height]: [usize; 2]) -> io::Result<Vec<u8>> {
        let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
        let numbers = self.exact.as_ref().ok_or(io::ErrorKind::InvalidInput)?;
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
        let mut file = Cursor::new(Vec::new());
        OpenExrEncoder::new(&mut file)
            .write_image(&bytes, size(width)?, size(height)?, ExtendedColorType::Rgb32F)
            .map_err(io::Error::other)?;
        Ok(file.into_inner())
    }
}

/// Counts rays.
struct Rays(u64);

impl TraceObserver for Rays {
    const SEES: bool = true;

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

fn middle(plan: &Plan, x: usize, y: usize) -> Sight {
    plan.camera.sight(x as f64, y as f64)
}

fn shown_all(colours: impl Iterator<Item = DVec3>) -> Vec<u8> {
    colours.flat_map(|colour| colour.to_array().map(to_byte)).collect()
}

fn depth(depths: &[f64]) -> Layer {
    // As light fades: with 1 / distance. So a plane that goes on for ever leaves the near things their contrast.
    let finite = || depths.iter().filter(|depth| depth.is_finite()).map(|depth| 1.0 / depth);
    let (far, near) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    let grey = |depth: &f64| match 1.0 / depth {
        0.0 => 0.0,
        _ if near == far => 1.0,
        nearness => FARTHEST + (1.0 - FARTHEST) * (nearness - far) / (near - far),
    };
    Layer {
        bytes: shown_all(depths.iter().map(grey).map(DVec3::splat)),
        exact: Some(depths.iter().flat_map(|depth| [*depth as f32; 3]).collect()),
        most: None,
        worst: None,
    }
}

fn normal(normals: &[Option<DVec3>]) -> Layer {
    Layer {
        bytes: shown_all(normals.iter().map(|normal| normal.map_or(DVec3::ZERO, |n| 0.5 * n + 0.5))),
        exact: Some(
            normals.iter().flat_map(|n| n.unwrap_or_default().to_array().map(|part| part as f32)).collect(),
        ),
        most: None,
        worst: None,
    }
}

fn object(objects: &[Option<usize>]) -> Layer {
    Layer {
        bytes: shown_all(objects.iter().map(|object| object.map_or(DVec3::ZERO, colour_of))),
        exact: None,
        most: None,
        worst: None,
    }
}

fn cost(costs: &[u64], [width, height]: [usize; 2]) -> Layer {
    let most = costs.iter().copied().max().unwrap_or(0);
    let place = costs.iter().position(|cost| *cost == most).unwrap_or(0);
    Layer {
        bytes: shown_all(costs.iter().map(|cost| DVec3::splat(*cost as f64 / most as f64))),
        exact: None,
        most: Some((most, [place % width, height - 1 - place / width])),
        worst: None,
    }
}

/// How far off a pixel is.
#[derive(Clone, Copy, Default)]
struct Off {
    /// The root of the mean square of its channels' errors.
    colour: f64,
    /// The error of the distance that its middle sees.
    distance: f64,
    /// Whether its middle sees another object.
    is_other: bool,
}

impl Off {
    fn of(plan: &Plan, truth: &Plan, x: usize, y: usize) -> Self {
        let colours = [plan, truth].map(|plan| shown(trace::pixel(plan, x, y)));
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

fn error(errors: &[Off], [width, height]: [usize; 2]) -> Layer {
    let worst = errors.iter().map(|off| off.colour).fold(0.0, f64::max);
    let place = errors.iter().position(|off| off.colour == worst).unwrap_or(0);
    let shade = |off: &Off| match off {
        Off { is_other: true, .. } => DVec3::X,
        _ if worst == 0.0 => DVec3::ZERO,
        Off { colour, .. } => DVec3::splat(colour / worst),
    };
    let numbers = |off: &Off| [off.colour, off.distance, f64::from(off.is_other)].map(|number| number as f32);
    Layer {
        bytes: shown_all(errors.iter().map(shade)),
        exact: Some(errors.iter().flat_map(numbers).collect()),
        most: None,
        worst: Some((worst, [place % width, height - 1 - place / width])),
    }
}

/// A colour for the object of this index: hues a golden section apart, so that any first few differ well.
fn colour_of(index: usize) -> DVec3 {
    let hue = (index as f64 * 0.618_033_988_749_895).fract();
    let channel = |shift: f64| ((6.0 * (hue + shift).fract() - 3.0).abs() - 1.0).clamp(0.0, 1.0);
    let pure = DVec3::new(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0));
    0.25 + 0.75 * pure
}
