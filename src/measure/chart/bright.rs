//! The parts of an image that may show something bright, found by bounds on the colours of all rays through them.

use glam::DVec2;
use tabray_core::geometry::aabb::Aabb;
use tabray_core::render::brightness::Brightness;
use tabray_core::render::plan::Plan;
use tabray_core::world::sensor::Sensor;

/// How many times the half width of a pixel is halved.
const CUTS: u32 = 5;

/// The greatest number of cells of a pixel.
const CELLS: usize = 16;

/// Cutting a square is of use if the largest bound of its quarters is below this part of its own bound.
const BETTER: f64 = 0.9;

/// A square part of a pixel that may show something bright.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub middle: DVec2,
    pub half: f64,
    /// A bound on its brightness.
    pub most: f64,
}

impl Cell {
    pub fn area(&self) -> f64 {
        (2.0 * self.half).powi(2)
    }

    pub fn contains(&self, place: DVec2) -> bool {
        (place - self.middle).abs().max_element() <= self.half
    }
}

/// Bounds on the colours of an image.
pub(super) struct Bounds<'b> {
    pub bounds: Brightness<'b>,
    pub camera: &'b Sensor,
    /// A bound on the brightness of the whole image.
    pub most: f64,
    /// The brightness up to which nothing counts as small.
    pub bright: f64,
    /// The brightness that stands for an unbounded one.
    pub unbounded: f64,
}

/// Returns the brightness of a surface that mirrors and glass may show, where nothing bounds their light: a scene
/// without bright surfaces shows nothing bright in them.
pub(super) fn unbounded(plan: &Plan) -> f64 {
    let Some(depth) = &plan.depth else { return f64::INFINITY };
    let viewer = plan.camera.origins();
    let shown = plan.model.objects.iter().zip(&depth.objects).filter(|(_, bounds)| bounds.beyond > 0.0);
    let distance = |bounds: Option<Aabb>| bounds.map_or(0.0, |bounds| viewer.distance(&bounds));
    let nearest =
        shown.map(|(object, _)| distance(object.shape.facts().bounds)).fold(f64::INFINITY, f64::min);
    let own = depth.objects.iter().map(|bounds| bounds.own).fold(0.0, f64::max);
    let most = plan.camera.display().steepest() * own / nearest;
    if nearest > 0.0 { most } else { f64::INFINITY }
}

impl Bounds<'_> {
    /// Adds the pixels of a square of the image that may show something bright. `corner` is its lower left pixel. Returns
    /// the number of parts that were looked at.
    pub fn find(&self, corner: [usize; 2], side: usize, pixels: &mut Vec<([usize; 2], Cell)>) -> usize {
        let [x, y] = corner;
        if x >= self.camera.pixels[0] || y >= self.camera.pixels[1] {
            return 0;
        }
        let half = 0.5 * side as f64;
        let Some(cell) = self.cell(DVec2::new(x as f64, y as f64) + (half - 0.5), half) else { return 1 };
        if side == 1 {
            pixels.push((corner, cell));
            return 1;
        }
        let side = side / 2;
        let corners = [[x, y], [x + side, y], [x, y + side], [x + side, y + side]];
        1 + corners.into_iter().map(|corner| self.find(corner, side, pixels)).sum::<usize>()
    }

    /// Adds all pixels of a square of the image, without looking at them.
    pub fn all(&self, [x, y]: [usize; 2], side: usize, pixels: &mut Vec<([usize; 2], Cell)>) {
        let ([width, height], most) = (self.camera.pixels, self.known(self.most));
        for (x, y) in (y..height.min(y + side)).flat_map(|y| (x..width.min(x + side)).map(move |x| (x, y))) {
            pixels.push(([x, y], Cell { middle: DVec2::new(x as f64, y as f64), half: 0.5, most }));
        }
    }

    /// Returns a bound on brightness, with a number for an unbounded one.
    fn known(&self, most: f64) -> f64 {
        if most.is_finite() { most } else { self.unbounded }
    }

    /// Returns a square with its bound; `None` if it shows nothing bright. A pixel that is white in any case can hide
    /// nothing, but the bright part of a pixel adds to its mean.
    fn cell(&self, middle: DVec2, half: f64) -> Option<Cell> {
        let [low, high] = self.bounds.within(self.camera, middle.to_array(), half);
        let channels = (0..3).filter(|channel| half < 0.5 || low[*channel] < 1.0);
        let most = channels.map(|channel| self.known(high[channel])).fold(0.0, f64::max);
        (most > self.bright).then_some(Cell { middle, half, most })
    }

    /// Returns the parts of a pixel that may show something bright.
    pub fn cut(&self, whole: Cell) -> Vec<Cell> {
        let mut cells = vec![whole];
        for _ in 0..CUTS {
            let mut smaller = Vec::new();
            for Cell { middle, half, .. } in &cells {
                let half = 0.5 * half;
                let corners = [[-half, -half], [half, -half], [-half, half], [half, half]];
                smaller.extend(
                    corners.iter().filter_map(|off| self.cell(*middle + DVec2::from_array(*off), half)),
                );
            }
            let most = smaller.iter().map(|cell| cell.most).fold(0.0, f64::max);
            // Where bounds do not depend on the place, smaller cells are of no use.
            let is_same = smaller.len() == 4 * cells.len() && most >= BETTER * whole.most;
            if smaller.len() > CELLS || is_same && cells.len() > 1 {
                break;
            }
            cells = smaller;
        }
        if cells.len() == 4 && cells[0].half == 0.25 { vec![whole] } else { cells }
    }
}
