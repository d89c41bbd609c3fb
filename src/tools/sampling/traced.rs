//! Some pixels of an image, traced in groups as a render traces them: their colours and their costs.

use super::places::{self, Pixels};
use crate::clock;
use glam::DVec2;
use std::hint::black_box;
use std::mem::replace;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::parallel;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::observer::{Count, RayKind, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::tiles::TOGETHER;
use tabray_core::render::trace::{PixelBound, Scratch, Tracer};
use tabray_core::simd::cpu::Cpu;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sample;

/// The time of a group, in seconds, below which the first use of scratch space matters.
const SHORT: f64 = 1e-3;

/// A group of pixels that were traced together.
#[derive(Clone, Default)]
pub struct Group {
    /// The colours, before they are clamped to what an image can show.
    pub colours: Vec<Rgb>,
    /// The rays.
    pub rays: Rays,
    /// The proven bounds of the pixels; none where nothing is proven.
    pub bounds: Vec<PixelBound>,
    /// The CPU time, in seconds.
    pub seconds: f64,
}

/// Rays that are counted.
#[derive(Clone, Copy, Default)]
pub struct Rays {
    /// Rays of all kinds.
    pub all: u64,
    /// Rays from the viewer.
    pub primary: u64,
    /// The samples of pixels that take different numbers of them, without probes.
    pub samples: u64,
    /// Whether a pixel has used up its ray budget.
    pub is_cut: bool,
}

/// Counts the rays of a group, and keeps what is proven of its pixels.
#[derive(Default)]
struct Counted {
    rays: Rays,
    bounds: Vec<PixelBound>,
}

impl TraceObserver for Counted {
    fn count(&mut self, count: Count) {
        match count {
            Count::Rays(kind, rays) => {
                self.rays.all += rays as u64;
                self.rays.primary += if kind == RayKind::Primary { rays as u64 } else { 0 };
            }
            Count::Sampled(samples) => self.rays.samples += u64::from(samples),
            Count::Cut(_) => self.rays.is_cut = true,
            Count::Bounded { error, is_certified, footprints } => {
                self.bounds.push(PixelBound { error, is_certified, footprints });
            }
            _ => {}
        }
    }
}

/// The scratch space of a thread, and whether it has been used.
#[derive(Default)]
struct Warmed {
    scratch: Scratch,
    is_warm: bool,
}

/// Traces groups of pixels on all threads of a renderer, and returns them in their order.
pub fn groups(threads: &Renderer, plan: &Plan, pixels: &[impl AsRef<[[usize; 2]]> + Sync]) -> Vec<Group> {
    let traced = Mutex::new(vec![Group::default(); pixels.len()]);
    let one = |state: &mut Warmed, index: usize| {
        let mut trace = || group(plan, pixels[index].as_ref(), &mut state.scratch);
        let first = trace();
        let is_first = !replace(&mut state.is_warm, true);
        let group = if is_first && first.seconds < SHORT { trace() } else { first };
        traced.lock().unwrap_or_else(PoisonError::into_inner)[index] = group;
    };
    threads.run(|| parallel::for_each_in_order(pixels.len(), &one));
    traced.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn group(plan: &Plan, pixels: &[[usize; 2]], scratch: &mut Scratch) -> Group {
    let mut counted = Counted::default();
    let start = clock::now();
    let mut tracer = Tracer::new(plan, Cpu::best(), scratch, &mut counted);
    let view = tracer.pixels(pixels);
    let seconds = (clock::now() - start).as_secs_f64();
    let colours = (0..pixels.len()).map(|pixel| view.get(pixel)).collect();
    let Counted { rays, bounds } = counted;
    Group { colours, rays, bounds, seconds }
}

/// Traces pixels that may lie far apart, and returns the colour of each, before it is clamped, and the number of
/// samples of each where pixels differ in that.
pub fn apart(threads: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> (Vec<Rgb>, Vec<u64>) {
    // Pixels that take as many samples as they need share probes only with their neighbours.
    let is_fixed = plan.camera.adaptive.is_none();
    let at_once = if is_fixed { (4 * PACKET_SIZE / plan.camera.samples as usize).max(1) } else { 1 };
    let groups = groups(threads, plan, &pixels.chunks(at_once).collect::<Vec<_>>());
    let samples = groups.iter().map(|group| group.rays.samples).collect();
    (groups.into_iter().flat_map(|group| group.colours).collect(), samples)
}

/// A whole image, its pixels in rows from the bottom.
#[derive(Default)]
pub struct Image {
    /// The colours, before they are clamped to what an image can show.
    pub colours: Vec<Rgb>,
    /// The proven bounds of the pixels; none where nothing is proven.
    pub bounds: Vec<PixelBound>,
    /// The number of rays from the viewer.
    pub primary: u64,
    /// The CPU time of all threads, in seconds.
    pub seconds: f64,
}

/// Traces a whole image, in tiles as a render does.
pub fn image(threads: &Renderer, plan: &Plan) -> Image {
    let size @ [width, height] = plan.camera.pixels;
    let tiles = places::all_tiles(size, if plan.camera.adaptive.is_some() { TOGETHER } else { 1 });
    let mut image = Image { colours: vec![Rgb::ZERO; width * height], ..Image::default() };
    for (pixels, group) in tiles.iter().zip(groups(threads, plan, &tiles)) {
        let places = pixels.iter().map(|[x, y]| y * width + x);
        image.primary += group.rays.primary;
        image.seconds += group.seconds;
        if !group.bounds.is_empty() {
            image.bounds.resize(width * height, PixelBound::default());
        }
        places.clone().zip(group.colours).for_each(|(place, colour)| image.colours[place] = colour);
        places.zip(group.bounds).for_each(|(place, bound)| image.bounds[place] = bound);
    }
    image
}

/// Traces places of the image with their samples, those of each of these pixels together, and returns the colours of each
/// pixel, before they are clamped.
pub fn places(
    threads: &Renderer,
    plan: &Plan,
    pixels: &[[usize; 2]],
    of_pixel: impl Fn([usize; 2]) -> Vec<(DVec2, Sample)> + Sync,
) -> Vec<Vec<Rgb>> {
    let part = |range: Range<usize>| {
        let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        pixels[range].iter().map(|pixel| tracer.places(&of_pixel(*pixel))).collect::<Vec<_>>()
    };
    threads.run(|| parallel::map_ranges(pixels.len(), 1, &part))
}

/// Returns the colours of pixels that may lie far apart, as they are shown.
pub fn shown(threads: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> Vec<Rgb> {
    let display = plan.camera.display();
    apart(threads, plan, pixels).0.into_iter().map(|colour| display.shown(colour)).collect()
}

/// Traces tiles on this thread, to be timed.
pub fn tiles(plan: &Plan, tiles: &[Pixels]) {
    let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
    for tile in tiles {
        black_box(Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody).pixels(tile));
    }
}
