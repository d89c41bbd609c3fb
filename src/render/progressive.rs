//! A picture in parts, for someone who looks on: all of it coarsely, then tile by tile.

use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::render::trace::{Scratch, Tracer};
use crate::simd::cpu::Cpu;
use crate::world::material::Rgb;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The coarse pass traces one pixel of each block of so many each way.
const BLOCK: usize = 8;

/// The width and height of a tile: short enough to wait for, and a whole number of blocks.
const AREA_SIZE: usize = 32;

/// The width and height, in blocks, of what is traced together.
const SQUARE: usize = 8;

/// A rectangle of a picture, counted from the left and from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// Its left upper pixel.
    pub corner: [usize; 2],
    /// Its width and height in pixels.
    pub size: [usize; 2],
    /// The width and height of its blocks, each of one colour. Those at the right and lower edges may be smaller.
    pub block: usize,
}

impl Area {
    /// How many blocks it has each way.
    pub fn blocks(&self) -> [usize; 2] {
        self.size.map(|side| side.div_ceil(self.block))
    }

    /// The colours of its blocks, or nothing where `check`, asked before each packet of rays, breaks off.
    fn colours(&self, plan: &Plan, check: &impl Fn() -> ControlFlow<()>) -> Option<Vec<Rgb>> {
        let camera = &plan.camera;
        let [across, down] = self.blocks();
        let middle = |side: usize, index: usize| {
            let start = index * self.block;
            self.corner[side] + start + (self.block / 2).min(self.size[side] - start - 1)
        };
        let (mut scratch, mut nobody) = (Scratch::default(), ());
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

/// The areas of a picture in the order in which they are made, first those of the coarse pass.
fn passes([width, height]: [usize; 2]) -> [Vec<Area>; 2] {
    let areas = |wide: usize, block: usize| {
        let corners = (0..height)
            .step_by(AREA_SIZE)
            .flat_map(move |top| (0..width).step_by(wide).map(move |left| [left, top]));
        corners
            .map(|[left, top]| Area {
                corner: [left, top],
                size: [wide.min(width - left), AREA_SIZE.min(height - top)],
                block,
            })
            .collect()
    };
    [areas(width, BLOCK), areas(AREA_SIZE, 1)]
}

/// Makes a picture and hands out its parts as they are finished: the colours of an area's blocks from the top and
/// from the left, before they are clamped. A finer part comes after all the coarser ones.
///
/// `check` is asked before each packet of rays. Once it has broken off, it must go on to.
pub fn render(
    renderer: &Renderer,
    plan: &Plan,
    part: impl Fn(Area, Vec<Rgb>) + Sync,
    check: impl Fn() -> ControlFlow<()> + Sync,
) -> ControlFlow<()> {
    for areas in passes(plan.camera.pixels) {
        let next = AtomicUsize::new(0);
        // Each thread takes the next area, so that they come in their order, as nearly as they can.
        renderer.run(|| {
            rayon::broadcast(|_| {
                while let Some(area) = areas.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match area.colours(plan, &check) {
                        Some(colours) => part(*area, colours),
                        None => break,
                    }
                }
            })
        });
        if check().is_break() {
            return ControlFlow::Break(());
        }
    }
    ControlFlow::Continue(())
}
