//! Entries for fuzzing (`tests/fuzz/`): what the program reads from its files and from its clients, handed in as bytes.
//!
//! A module of `tabray-cli` with the feature `fuzz`. The targets call what the library does not offer otherwise: checkpoints
//! without an image here, and servers without sockets in the crates of the pages. They are compiled without
//! `cfg(fuzzing)`, under which the decoder of PNGs would check nothing.

use crate::files::provenance::Provenance;
use crate::options::size::Region;
use crate::rendering::resume::{self, ResumedImage};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io;
use std::path::PathBuf;
use tabray_core::output::picture::Format;
use tabray_core::render::tiles::Band;
use tabray_core::scene::model::Model;
use tabray_tools::pixels::{Label, Writer, take_tile};

/// An image that is rendered in parts, with a checkpoint in between.
pub struct Image {
    label: Label,
    part: Region,
}

impl Image {
    /// Begins the image of a model.
    pub fn new(model: &Model) -> Option<Self> {
        let part = Region::whole(&model.camera.value);
        let label = resume::label(model, &part, Format::Ppm, &Provenance::default()).ok()?;
        Some(Self { label, part })
    }

    /// Makes the checkpoint of an image with these pixels, of which only these tiles are rendered; both in rows from the
    /// top, each from the left.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn checkpoint(&self, pixels: &[[u8; 3]], tiles: &[bool]) -> io::Result<Vec<u8>> {
        let (mut writer, mut bytes) = (Writer::new(Vec::new(), &self.label)?, Vec::new());
        for (tile, is_done) in tiles.iter().enumerate() {
            let place = self.label.grid().tile(tile);
            take_tile(pixels.as_flattened(), 3 * self.label.size[0], place, 3, &mut bytes);
            writer.tile(is_done.then_some(&bytes))?;
        }
        writer.finish()
    }

    /// Replaces the checksum at the end of a checkpoint with the right one.
    pub fn with_checksum(file: &[u8]) -> Vec<u8> {
        let text = &file[..file.len().saturating_sub(32)];
        [text, &Sha256::digest(text)].concat()
    }

    /// Continues from a checkpoint: returns all pixels, and which tiles need not be rendered any more. Nothing where the
    /// checkpoint is refused.
    pub fn resume(&self, file: File) -> Option<(Vec<[u8; 3]>, Vec<bool>)> {
        let mut begun = ResumedImage::read(PathBuf::new(), Ok(file), &self.label).ok()?;
        let band = Band::blank(self.part.columns.clone(), self.part.rows.clone(), false);
        begun.fill(&band, 0).ok()?;
        let (mut pixels, mut tiles) = (Vec::new(), Vec::new());
        for index in 0..band.strips.len() {
            let strip = band.strip(index);
            pixels.extend_from_slice(&strip.pixels);
            tiles.extend_from_slice(&strip.tiles);
        }
        Some((pixels, tiles))
    }
}
