//! Progressive rendering: the whole image coarsely, then tile by tile with one ray for each pixel, then with all
//! samples.

use crate::flaws::Flaws;
use crate::plan::Plan;
use crate::renderer::Renderer;
use crate::trace::{Scratch, Tracer};
use std::ops::ControlFlow;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::material::Rgb;
use tabray_world::parallel;
use tabray_world::simd::cpu::Cpu;

/// The width and height of a block, in pixels. The coarse pass traces one pixel of each block.
const BLOCK: usize = 8;

/// The width and height of a tile, in pixels: small enough to be rendered quickly, and a multiple of [`BLOCK`].
const AREA_SIZE: usize = 32;

/// The width and height, in blocks, of the squares that are traced together.
const SQUARE: usize = 8;

/// The number of levels by which a channel of two pixels side by side differs where an edge is smoothed.
const STEP: u8 = 8;

/// A rectangle of an image. Positions count pixels from the left and from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The upper left pixel.
    pub corner: [usize; 2],
    /// The width and height in pixels.
    pub size: [usize; 2],
    /// The width and height of a block in pixels. Each block has one colour; blocks at the right and lower edges may be
    /// smaller.
    pub block: usize,
    /// Whether the colours are those of the image, with all samples.
    pub is_final: bool,
}

impl Area {
    /// Returns the number of blocks across and down.
    pub fn blocks(&self) -> [usize; 2] {
        self.size.map(|side| side.div_ceil(self.block))
    }

    /// Computes the colours of the blocks. Returns `None` if `check`, called before each packet of rays, breaks.
    fn colours(&self, plan: &Plan, check: &impl Fn() -> ControlFlow<()>) -> Option<Vec<Rgb>> {
        let camera = &plan.camera;
        let [across, down] = self.blocks();
        let middle = |side: usize, index: usize| {
            let start = index * self.block;
            self.corner[side] + start + (self.block / 2).min(self.size[side] - start - 1)
        };
        let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        let mut colours = vec![Rgb::ZERO; across * down];
        for top in (0..down).step_by(SQUARE) {
            for left in (0..across).step_by(SQUARE) {
                let rows = top..down.min(top + SQUARE);
                let square: Vec<_> = rows
                    .flat_map(|row| (left..across.min(left + SQUARE)).map(move |column| [column, row]))
                    .collect();
                for blocks in square.chunks((PACKET_SIZE / camera.samples as usize).max(1)) {
                    if check().is_break() {
                        return None;
                    }
                    let place = |[column, row]: &[usize; 2]| {
                        [middle(0, *column), camera.pixels[1] - 1 - middle(1, *row)]
                    };
                    let pixels: Vec<_> = blocks.iter().map(place).collect();
                    let seen = tracer.pixels(&pixels);
                    for (index, [column, row]) in blocks.iter().enumerate() {
                        colours[row * across + column] = seen.get(index);
                    }
                }
            }
        }
        Some(colours)
    }

    /// Computes the colours of pixels by one ray for each, and again by `samples` rays where a pixel next to it looks
    /// different.
    fn smoothed(&self, plan: &mut Plan, samples: u32) -> Vec<Rgb> {
        let [left, top] = self.corner.map(|side| side.saturating_sub(1));
        let [right, bottom] =
            [0, 1].map(|side| (self.corner[side] + self.size[side] + 1).min(plan.camera.pixels[side]));
        let around = Self { corner: [left, top], size: [right - left, bottom - top], ..*self };
        plan.camera.samples = 1;
        let colours = around.colours(plan, &|| ControlFlow::Continue(())).unwrap_or_default();
        let display = plan.camera.display();
        let bytes: Vec<_> = colours.iter().map(|colour| display.bytes(*colour)).collect();
        let index = |[x, y]: [usize; 2]| (y - top) * (right - left) + x - left;
        let is_edge = |at: &[usize; 2]| {
            let [x, y] = *at;
            let beside = [[x.max(left + 1) - 1, y], [(x + 1).min(right - 1), y]];
            let above = [[x, y.max(top + 1) - 1], [x, (y + 1).min(bottom - 1)]];
            let mine = bytes[index(*at)];
            let differs = |other: [usize; 2]| {
                mine.iter().zip(bytes[index(other)]).any(|(one, other)| one.abs_diff(other) > STEP)
            };
            beside.into_iter().chain(above).any(differs)
        };
        let pixels = (self.corner[1]..self.corner[1] + self.size[1])
            .flat_map(|y| (self.corner[0]..self.corner[0] + self.size[0]).map(move |x| [x, y]));
        let mut smoothed: Vec<_> = pixels.clone().map(|at| colours[index(at)]).collect();
        let edges: Vec<_> = pixels.enumerate().filter(|(_, at)| is_edge(at)).collect();
        plan.camera.samples = samples;
        let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
        let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        for some in edges.chunks((PACKET_SIZE / samples as usize).max(1)) {
            let pixels: Vec<_> = some.iter().map(|(_, [x, y])| [*x, plan.camera.pixels[1] - 1 - y]).collect();
            let seen = tracer.pixels(&pixels);
            for (which, (place, _)) in some.iter().enumerate() {
                smoothed[*place] = seen.get(which);
            }
        }
        smoothed
    }
}

/// Lists the areas of a pass over an image in the order in which they are rendered: with blocks of pixels, or with
/// single pixels.
fn areas([width, height]: [usize; 2], block: usize, is_final: bool) -> Vec<Area> {
    let wide = if block > 1 { width } else { AREA_SIZE };
    let corners =
        (0..height).step_by(AREA_SIZE).flat_map(|top| (0..width).step_by(wide).map(move |left| [left, top]));
    let area = |[left, top]: [usize; 2]| {
        let size = [wide.min(width - left), AREA_SIZE.min(height - top)];
        Area { corner: [left, top], size, block, is_final }
    };
    corners.map(area).collect()
}

/// A pass over an image.
#[derive(Clone, Debug)]
struct Pass {
    /// The number of samples of a pixel.
    samples: u32,
    areas: Vec<Area>,
}

/// Lists the passes over an image with this many samples per pixel.
fn passes(pixels: [usize; 2], samples: u32) -> impl Iterator<Item = Pass> {
    let all = [(BLOCK, 1), (1, 1), (1, samples)].into_iter().take(if samples > 1 { 3 } else { 2 });
    all.map(move |(block, rays)| Pass {
        samples: rays,
        areas: areas(pixels, block, block == 1 && rays == samples),
    })
}

/// The remaining areas of an image that is rendered step by step on one thread. Unlike with [`render`], the caller
/// may do other work between two areas.
#[derive(Clone, Debug)]
pub struct Steps {
    /// The areas and the samples of their pixels, the last one first.
    left: Vec<(Area, u32)>,
    /// Whether only edges have all samples.
    smooths: bool,
}

impl Steps {
    /// Begins an image of this many pixels, with this many samples in each.
    pub fn new(pixels: [usize; 2], samples: u32) -> Self {
        let mut left: Vec<_> = passes(pixels, samples)
            .flat_map(|Pass { samples, areas }| areas.into_iter().map(move |area| (area, samples)))
            .collect();
        left.reverse();
        Self { left, smooths: false }
    }

    /// Begins an image of which only edges have this many samples. Of `all` that share the work, it is this one's part.
    pub fn smooth(pixels: [usize; 2], samples: u32, part: usize, all: usize) -> Self {
        let areas = areas(pixels, 1, true).into_iter().skip(part).step_by(all.max(1));
        let mut left: Vec<_> = areas.map(|area| (area, samples)).collect();
        left.reverse();
        Self { left, smooths: true }
    }

    /// Tells whether the image is complete.
    pub fn is_done(&self) -> bool {
        self.left.is_empty()
    }

    /// Renders the next area with a plan of the image; `None` where the image is complete.
    pub fn next(&mut self, plan: &mut Plan) -> Option<(Area, Vec<Rgb>)> {
        let (area, samples) = self.left.pop()?;
        if self.smooths {
            return Some((area, area.smoothed(plan, samples)));
        }
        plan.camera.samples = samples;
        let colours = area.colours(plan, &|| ControlFlow::Continue(()))?;
        Some((area, colours))
    }
}

/// Renders an image and passes each area to `part` as it is finished, with the unclamped colours of its blocks in rows
/// from the top, each from the left. The first pass is coarse, with one ray for a block; where pixels have several
/// samples, the next one has one ray for each pixel; the last one has all samples.
///
/// `check` is called before each packet of rays. Once it has returned `Break`, it must keep doing so.
pub fn render(
    renderer: &Renderer,
    plan: &mut Plan,
    part: impl Fn(Area, Vec<Rgb>) + Sync,
    check: impl Fn() -> ControlFlow<()> + Sync,
) -> ControlFlow<()> {
    for Pass { samples, areas } in passes(plan.camera.pixels, plan.camera.samples) {
        plan.camera.samples = samples;
        let plan = &*plan;
        // Each thread takes the next area, so that areas are finished roughly in their order.
        let work = |(): &mut (), index: usize| {
            let area: Area = areas[index];
            if let Some(colours) = area.colours(plan, &check) {
                part(area, colours);
            }
        };
        renderer.run(|| parallel::for_each_in_order(areas.len(), &work));
        if check().is_break() {
            return ControlFlow::Break(());
        }
    }
    ControlFlow::Continue(())
}
