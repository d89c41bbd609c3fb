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
}

impl Steps {
    /// Begins an image of this many pixels, with this many samples in each.
    pub fn new(pixels: [usize; 2], samples: u32) -> Self {
        let mut left: Vec<_> = passes(pixels, samples)
            .flat_map(|Pass { samples, areas }| areas.into_iter().map(move |area| (area, samples)))
            .collect();
        left.reverse();
        Self { left }
    }

    /// Tells whether the image is complete.
    pub fn is_done(&self) -> bool {
        self.left.is_empty()
    }

    /// Renders the next area with a plan of the image; `None` where the image is complete.
    pub fn next(&mut self, plan: &mut Plan) -> Option<(Area, Vec<Rgb>)> {
        let (area, samples) = self.left.pop()?;
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
