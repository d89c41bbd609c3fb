//! The picture of a scene, which sharpens step by step.

use crate::scene::Scene;
use serde_json::{Value, json};
use tabray_core::render::Levels;
use tabray_core::render::progressive::{Area, Steps};
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sensor::Sensor;
use tabray_lang::reader;
use tabray_page::display::singles;
use tabray_tools::diagnosis;

/// The number of samples at the edges of a smooth picture.
const SMOOTH: u32 = 16;

/// A picture: its remaining steps, and its pixels so far.
#[derive(Default)]
pub struct Painting {
    steps: Option<Steps>,
    size: [usize; 2],
    /// Red, green and blue of each pixel, in rows from the top.
    bytes: Vec<u8>,
    /// Red, green and blue of each pixel in the same order, before they are clamped and rounded to levels: 1 is white.
    colours: Vec<f32>,
    levels: Levels,
}

/// A complete picture.
pub struct Whole<'p> {
    /// The width and the height in pixels.
    pub size: [usize; 2],
    /// Red, green and blue of each pixel, in rows from the top.
    pub bytes: &'p [u8],
    /// Red, green and blue of each pixel in the same order, before they are clamped and rounded to levels: 1 is white.
    pub colours: &'p [f32],
}

impl Painting {
    /// Begins the picture of a scene.
    pub fn new(model: &Model) -> Self {
        let camera = &model.camera.value;
        let size @ [width, height] = camera.pixels;
        let numbers = 3 * width * height;
        let steps = Some(Steps::new(size, camera.samples));
        Self { steps, size, bytes: vec![0; numbers], colours: vec![0.0; numbers], levels: Levels::default() }
    }

    /// Begins a part of the picture with smooth edges. There are this many parts in all.
    pub fn smooth(model: &Model, [part, all]: [usize; 2]) -> Self {
        let Sensor { pixels, samples, .. } = model.camera.value;
        Self { steps: Some(Steps::smooth(pixels, samples.max(SMOOTH), part, all)), ..Self::new(model) }
    }

    /// Renders the next areas, up to `count`. An area starts with seven numbers of 32 bits, little-endian: left, top,
    /// width, height, the side of a block, 1 if the area is final and 0 if not, and the number of blocks. Red, green
    /// and blue of each block follow in single precision, and then as bytes, which are padded to a multiple of four.
    /// The result is empty when the picture is complete.
    pub fn next(&mut self, model: &Model, count: usize) -> Vec<u8> {
        let mut out = Vec::new();
        let Some(mut steps) = self.steps.take() else { return out };
        if !steps.is_done() {
            let mut plan = Scene::plan(model);
            for _ in 0..count {
                let Some((area, colours)) = steps.next(&mut plan) else { break };
                self.take(model, &area, &colours, &mut out);
            }
        }
        self.steps = Some(steps);
        out
    }

    /// Stores an area, and writes it for the page.
    fn take(&mut self, model: &Model, area: &Area, colours: &[Rgb], out: &mut Vec<u8>) {
        let Area { corner: [left, top], size: [width, height], block, is_final } = *area;
        for number in [left, top, width, height, block, usize::from(is_final), colours.len()] {
            out.extend((number as u32).to_le_bytes());
        }
        let display = model.camera.value.display();
        let bytes: Vec<u8> = colours.iter().flat_map(|colour| display.bytes(*colour)).collect();
        out.extend(singles(colours));
        out.extend(&bytes);
        out.resize(out.len().next_multiple_of(4), 0);
        if !is_final {
            return;
        }
        self.levels.add(&bytes);
        let row = 3 * width;
        for (index, (bytes, colours)) in bytes.chunks(row).zip(colours.chunks(width)).enumerate() {
            let from = 3 * ((top + index) * self.size[0] + left);
            self.bytes[from..from + row].copy_from_slice(bytes);
            let full = colours.iter().flat_map(|colour| display.full_range(*colour).as_vec3().to_array());
            for (place, number) in self.colours[from..from + row].iter_mut().zip(full) {
                *place = number;
            }
        }
    }

    /// Returns the picture.
    ///
    /// # Errors
    /// Returns a message if the picture is not complete.
    pub fn whole(&self) -> Result<Whole<'_>, String> {
        let is_done = self.steps.as_ref().is_some_and(Steps::is_done);
        is_done
            .then_some(Whole { size: self.size, bytes: &self.bytes, colours: &self.colours })
            .ok_or_else(|| "the picture is not complete yet: wait for it".to_owned())
    }

    /// Returns why a complete picture is black, burnt or empty, if it is.
    pub fn remark(&self, model: &Model) -> Value {
        let [width, height] = self.size;
        let remark = diagnosis::remark(&Scene::plan(model), [&(0..width), &(0..height)], &self.levels);
        let remark = remark.filter(|_| self.whole().is_ok() && !reader::is_black(model));
        let words = remark.map(|remark| format!("warning: {}\nhelp: {}", remark.message, remark.help));
        json!({ "words": words })
    }
}
