//! Pixels that may show something bright that is smaller than the gaps between their samples: lamps, stars, wires and
//! glints, seen directly, in mirrors or in glass.
//!
//! They are found by bounds on the colours of all rays through a part of the image. Where these allow more than
//! samples are sure to see, the part is cut into quarters, down to parts of a pixel: to the cells in which the bright
//! thing must be. Then all of these pixels are measured, by many samples in the cells and some in the rest of the
//! pixel.

use super::bright::{Bounds, Cell, unbounded};
use super::progress::Progress;
use glam::DVec2;
use std::io;
use std::ops::Range;
use tabray_core::parallel;
use tabray_core::render::brightness::Brightness;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace::{Scratch, Tracer};
use tabray_core::simd::cpu::Cpu;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::{Sample, Sampler};
use tabray_core::world::sensor::Sensor;
use tabray_tools::sampling::places::Drawing;
use tabray_tools::sampling::right::{Right, SCRAMBLES};

/// The least and the greatest brightness, where 1 is white, up to which nothing counts as small. Something less
/// bright must take a large part of a pixel, or of many pixels, to matter, and then samples see it.
const BRIGHT: [f64; 2] = [4.0, 64.0];

/// The least number of squares that are looked at at once, and the part of them, one in this many; and the part of the first
/// pixels, one in this many, from which on small things may be everywhere.
const TRIED: usize = 32;
const TOO_MANY: usize = 2;

/// The width in pixels of the squares that are looked at first.
const SQUARE: usize = 8;

/// The usual number of parts of the image that are looked at.
const LOOKS: f64 = 65_536.0;

/// The greatest number of pixels that are cut into cells.
const CUT: usize = 500;

/// The samples of each image that counts as right: of the rest of a pixel, and at first of its cells.
const REST: u32 = 128;
const FIRST: u32 = 64;

/// The part of the goal below which the bound on missed things should be.
const WANTED: f64 = 0.15;

/// The largest expected square of the missed light, for a thing of the size that is missed most: a thing that takes
/// the part p of a cell is missed by n samples with a probability of at most exp(-p n), and p exp(-p n / 2) n is at
/// most 2 / e.
const EXPECTED: f64 = 0.541_341_132_946_451;

/// Divided by the part of a cell that a thing takes, the number of samples that miss it with a probability of 1 %.
const SURE: f64 = 4.605_170_185_988_091;

/// A pixel that may show something bright and small.
struct SmallPixel {
    at: [usize; 2],
    cells: Vec<Cell>,
    /// The sums of the samples of each image, in the rest and in each cell, and their numbers.
    rest: [(Rgb, u32); 2],
    sums: [Vec<Rgb>; 2],
    count: u32,
}

/// The pixels of an image that may show something bright and small.
pub(super) struct SmallThings {
    pixels: Vec<SmallPixel>,
    display: Display,
    is_measured: bool,
    is_left_out: bool,
}

/// Bounds on things missed in the pixels that may show something small.
#[derive(Default)]
pub(super) struct Missed {
    /// A bound on the mean light missed in each pixel, where 1 is white.
    pub pixels: Vec<f64>,
    /// A bound on the light missed in one pixel.
    pub largest: f64,
}

impl Missed {
    /// Bounds the root mean square over an image of this many pixels.
    pub fn error(&self, all: usize) -> f64 {
        let squares: f64 = self.pixels.iter().map(|missed| EXPECTED * missed * missed).sum();
        ((squares + self.largest * self.largest) / all as f64).sqrt()
    }
}

impl SmallThings {
    /// Returns an empty set, for images with this display.
    pub fn none(display: Display) -> Self {
        Self { pixels: Vec::new(), display, is_measured: true, is_left_out: false }
    }

    /// Finds the pixels of a plan's image with things that together change the image by more than an error. `samples`
    /// is the number of samples of each measured pixel. Without bounds, finds none if that would be a large part of the
    /// pixels: to know them would not help. What this part of the usual work leaves out counts as found.
    ///
    /// # Errors
    /// Returns `Interrupted` if `progress` breaks off.
    pub fn find(
        plan: &Plan,
        threads: &Renderer,
        (error, is_certain): (f64, bool),
        (samples, effort): (u32, f64),
        progress: &mut dyn Progress,
    ) -> io::Result<Self> {
        let camera = &plan.camera;
        let [width, height] = camera.pixels;
        let bounds = Brightness::new(plan.model);
        let mut found = Self::none(camera.display());
        // Something matters in this many white pixels, or in one pixel that is as bright as the root of that. Samples
        // are sure to see a thing so bright that it takes a certain part of these.
        let matters = (width * height) as f64 * error * error;
        let bright = f64::from(samples) * if matters < 1.0 { matters.sqrt() } else { matters } / SURE;
        let bright = bright.clamp(BRIGHT[0], BRIGHT[1]);
        let most = bounds.most(camera);
        if most <= bright {
            return Ok(found);
        }
        let bounds = Bounds { bounds, camera, most, bright, unbounded: unbounded(plan) };
        let sides = camera.pixels.map(|side| side.div_ceil(SQUARE));
        let drawing = Drawing::new(sides);
        let squares: Vec<_> =
            (0..sides[0] * sides[1]).map(|index| drawing.at(index).map(|side| side * SQUARE)).collect();
        let first = TRIED.max(squares.len() / TRIED);
        let (mut whole, mut looked_at, mut rest) = (Vec::new(), 0, &squares[..]);
        while !rest.is_empty() && looked_at as f64 <= effort * LOOKS && !progress.is_late() {
            let (part, others) = rest.split_at(first.min(rest.len()));
            let one = |index: usize| {
                let mut pixels = Vec::new();
                (bounds.find(part[index], SQUARE, &mut pixels), pixels)
            };
            for (looks, pixels) in threads.run(|| parallel::map(part.len(), one)) {
                looked_at += looks;
                whole.extend(pixels);
            }
            let is_first = rest.len() == squares.len();
            if !is_certain && is_first && TOO_MANY * whole.len() > part.len() * SQUARE * SQUARE {
                return Ok(Self { is_left_out: true, ..found });
            }
            if progress.done(0).is_break() {
                return Err(io::ErrorKind::Interrupted.into());
            }
            rest = others;
        }
        rest.iter().for_each(|square| bounds.all(*square, SQUARE, &mut whole));
        whole.sort_by_key(|([x, y], _)| [*y, *x]);
        let is_cut = whole.len() <= CUT;
        let cells = |index: usize| if is_cut { bounds.cut(whole[index].1) } else { vec![whole[index].1] };
        let cells = threads.run(|| parallel::map(whole.len(), cells));
        let pixel = |((at, _), cells): (([usize; 2], Cell), Vec<Cell>)| {
            let sums = [(); 2].map(|()| vec![Rgb::ZERO; cells.len()]);
            (!cells.is_empty()).then_some(SmallPixel { at, cells, rest: [(Rgb::ZERO, 0); 2], sums, count: 0 })
        };
        found.pixels = whole.into_iter().zip(cells).filter_map(pixel).collect();
        Ok(found)
    }

    /// Returns the pixels, by column and row.
    pub fn pixels(&self) -> Vec<[usize; 2]> {
        self.pixels.iter().map(|pixel| pixel.at).collect()
    }

    /// Tells whether the right colours are known.
    pub fn is_measured(&self) -> bool {
        self.is_measured
    }

    /// Tells whether so many pixels may show something small that none was looked for.
    pub fn is_left_out(&self) -> bool {
        self.is_left_out
    }

    /// Takes samples until the missed light is a small part of an error, or more than a greatest number is to be taken.
    pub fn measure(
        &mut self,
        plan: &mut Plan,
        threads: &Renderer,
        (error, max_samples): (f64, usize),
        progress: &mut dyn Progress,
    ) -> io::Result<()> {
        // The colour of the only sample of a pixel may be cut to what is shown, and a mean of such colours is too dark.
        plan.camera.samples = REST;
        let all = plan.camera.pixels[0] * plan.camera.pixels[1];
        let cost = |pixel: &SmallPixel, count: u32| 2 * pixel.cells.len() * count as usize;
        let mut taken: usize =
            self.pixels.iter().map(|pixel| 2 * REST as usize + cost(pixel, pixel.first())).sum();
        if taken > max_samples {
            self.is_measured = false;
            return Ok(());
        }
        let mut wanted: Vec<(usize, u32)> =
            self.pixels.iter().enumerate().map(|(index, pixel)| (index, pixel.first())).collect();
        while !wanted.is_empty() {
            progress.more(taken / 10);
            self.take(plan, threads, &wanted);
            if progress.done(taken / 10).is_break() {
                return Err(io::ErrorKind::Interrupted.into());
            }
            let limit = (WANTED * error).powi(2) * all as f64;
            let open = self.of_each(SmallPixel::open);
            if open.iter().sum::<f64>() <= limit {
                break;
            }
            // The samples of the most uncertain pixels are doubled.
            let least = limit / self.pixels.len() as f64;
            wanted = open
                .iter()
                .zip(&self.pixels)
                .enumerate()
                .filter(|(_, (open, pixel))| **open > least && 2 * pixel.count <= Sampler::MAX_SAMPLES)
                .map(|(index, (_, pixel))| (index, 2 * pixel.count))
                .collect();
            let more: usize = wanted.iter().map(|(index, count)| cost(&self.pixels[*index], count / 2)).sum();
            taken += more;
            if taken > max_samples || progress.is_late() {
                break;
            }
        }
        Ok(())
    }

    /// Gives pixels, by their indices, this many samples in each cell and image.
    fn take(&mut self, plan: &Plan, threads: &Renderer, wanted: &[(usize, u32)]) {
        let pixels = &self.pixels;
        let part = |range: Range<usize>| {
            let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
            let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
            let more = |(index, count): &(usize, u32)| pixels[*index].more(*count, &plan.camera, &mut tracer);
            wanted[range].iter().map(more).collect::<Vec<_>>()
        };
        let sums = threads.run(|| parallel::map_ranges(wanted.len(), 2, &part));
        for ((index, count), (rest, sums)) in wanted.iter().zip(sums) {
            let pixel = &mut self.pixels[*index];
            (pixel.rest, pixel.sums, pixel.count) = (rest, sums, *count);
        }
    }

    fn of_each<T>(&self, of: fn(&SmallPixel, &Display) -> T) -> Vec<T> {
        self.pixels.iter().map(|pixel| of(pixel, &self.display)).collect()
    }

    /// Returns the right colours, one of each of the two images.
    pub fn right(&self) -> Vec<Right> {
        self.of_each(SmallPixel::shown)
    }

    /// Returns bounds on missed things: on everything, where nothing is measured.
    pub fn missed(&self) -> Missed {
        if !self.is_measured {
            return Missed { pixels: vec![EXPECTED.sqrt().recip(); self.pixels.len()], largest: 0.0 };
        }
        let pixels = self.of_each(SmallPixel::missed);
        let largest = self.of_each(SmallPixel::largest).into_iter().fold(0.0, f64::max);
        Missed { pixels, largest }
    }
}

impl SmallPixel {
    /// Returns the number of samples in each cell and image at first.
    fn first(&self) -> u32 {
        let each = FIRST / (self.cells.len() as u32).min(FIRST / 8);
        // A cell that is the whole pixel has no rest.
        if self.cells.len() == 1 && self.cells[0].half == 0.5 { FIRST + REST } else { each }
            .next_power_of_two()
    }

    /// Returns the part of the pixel that the cells take.
    fn area(&self) -> f64 {
        self.cells.iter().map(Cell::area).sum()
    }

    /// Takes samples until each cell has this many in each image. Returns the sums of the rest, and those of the
    /// cells.
    fn more(&self, count: u32, camera: &Sensor, tracer: &mut Tracer) -> ([(Rgb, u32); 2], [Vec<Rgb>; 2]) {
        let middle = DVec2::new(self.at[0] as f64, self.at[1] as f64);
        let (mut rest, mut sums) = (self.rest, self.sums.clone());
        for (image, scramble) in SCRAMBLES.into_iter().enumerate() {
            let seed = (self.at[1] * camera.pixels[0] + self.at[0]) as u32 ^ scramble;
            if self.count == 0 {
                let sample = |index| Sample { sampler: Sampler::Sobol, index, pixel: seed };
                let samples = (0..REST).map(sample).map(|sample| (middle + sample.jitter(), sample));
                let outside: Vec<_> = samples
                    .filter(|(place, _)| !self.cells.iter().any(|cell| cell.contains(*place)))
                    .collect();
                rest[image] = (tracer.places(&outside).into_iter().sum(), outside.len() as u32);
            }
            for (index, (cell, sum)) in self.cells.iter().zip(&mut sums[image]).enumerate() {
                let pixel = seed ^ (index as u32 + 1).wrapping_mul(0x85eb_ca6b);
                let sample = |index| Sample { sampler: Sampler::Sobol, index, pixel };
                let places: Vec<_> = (self.count..count)
                    .map(sample)
                    .map(|sample| (cell.middle + 2.0 * cell.half * sample.jitter(), sample))
                    .collect();
                *sum += tracer.places(&places).into_iter().sum::<Rgb>();
            }
        }
        (rest, sums)
    }

    /// Returns the colours that the two images show.
    fn shown(&self, display: &Display) -> Right {
        [0, 1].map(|image| {
            let (rest, count) = self.rest[image];
            let of_rest = if count > 0 { (1.0 - self.area()) * rest / f64::from(count) } else { Rgb::ZERO };
            let cells = self.cells.iter().zip(&self.sums[image]);
            let of_cells: Rgb = cells.map(|(cell, sum)| cell.area() * *sum / f64::from(self.count)).sum();
            display.shown(of_rest + of_cells)
        })
    }

    /// Returns how much brighter the pixel may get.
    fn room(&self, display: &Display) -> f64 {
        let [one, other] = self.shown(display);
        (1.0 - one.min(other)).max_element()
    }

    /// Bounds the mean of the missed light: that of things of the size that is missed most, in all cells.
    fn missed(&self, display: &Display) -> f64 {
        let samples = 2.0 * f64::from(self.count);
        self.cells.iter().map(|cell| cell.area() * cell.most / samples).sum::<f64>().min(self.room(display))
    }

    /// Bounds the missed light of a thing in one cell, with a confidence of 99 %.
    fn largest(&self, display: &Display) -> f64 {
        let samples = 2.0 * f64::from(self.count);
        let of_cells = self.cells.iter().map(|cell| SURE * cell.area() * cell.most / samples);
        of_cells.fold(0.0, f64::max).min(self.room(display))
    }

    /// Returns the square of the uncertainty: of the missed light, and of the noise of the samples.
    fn open(&self, display: &Display) -> f64 {
        let [one, other] = self.shown(display);
        self.missed(display).max(self.largest(display)).powi(2) + 0.25 * (one - other).length_squared() / 3.0
    }
}
