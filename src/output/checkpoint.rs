//! Checkpoints: what is rendered of a picture, in a file from which the rest can be rendered.
//!
//! A checkpoint is a PNG whose pixels are opaque where they are rendered and transparent where not. A text in it says
//! what the picture depends on.

use crate::output::picture::{AS_SHOWN, Rows};
use crate::render::tiles::{Band, TILE, Tiles};
use crate::scene::choice::Choice;
use crate::scene::dump;
use crate::scene::model::Model;
use crate::scene::syntax::Syntax;
use crate::world::sample::Sampler;
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use std::env;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::iter;
use std::ops::Range;
use std::path::Path;

/// The name of the text in the file.
const KEYWORD: &str = "tabray checkpoint";

/// What begins the hash of something that is too long to be shown.
const HASH: &str = "sha256:";

/// The hash that also changes with each build, as plugins are part of the program.
const PROGRAM: &str = "the program";

/// What the pixels of a picture depend on: names of things, and what they are.
pub struct Identity(Vec<(String, String)>);

impl Identity {
    /// That of a part of a model's picture, made by this program. `columns` count from the left, `rows` from the top.
    ///
    /// # Errors
    /// Where the program cannot read its own file.
    pub fn of(model: &Model, columns: &Range<usize>, rows: &Range<usize>) -> io::Result<Self> {
        let camera = &model.camera.value;
        let [width, height] = camera.pixels;
        let crop = if (columns.len(), rows.len()) == (width, height) {
            "none".to_owned()
        } else {
            format!("{},{},{},{}", columns.start, height - rows.end, columns.len(), rows.len())
        };
        let sampler = match camera.sampler {
            Sampler::Sobol => "sobol",
            Sampler::Random => "random",
        };
        let mut all = vec![
            ("the version of tabray".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            (PROGRAM.to_owned(), program()?),
            ("the scene".to_owned(), hash(dump::scene(model, Syntax::Notes).as_bytes())),
        ];
        for texture in &model.textures {
            let [width, height] = texture.value.size();
            let texels = texture.value.load().map_or(&[][..], |picture| picture.as_raw());
            let title = format!("the image of texture `{}`", texture.args.name);
            all.push((title, format!("{} ({width} x {height})", hash(texels))));
        }
        all.extend(
            [
                ("the size", format!("{width} x {height}")),
                ("the crop", crop),
                ("the number of samples", camera.samples.to_string()),
                ("the sampler", sampler.to_owned()),
                ("the accuracy", camera.accuracy.option().name.to_owned()),
            ]
            .map(|(what, is)| (what.to_owned(), is)),
        );
        Ok(Self(all))
    }

    /// How it differs from what it was, in words; empty where it does not.
    pub fn differences(&self, old: &Self) -> Vec<String> {
        let was = |what: &str| old.0.iter().find(|(name, _)| name == what).map(|(_, was)| was);
        let mut differences = Vec::new();
        for (what, is) in &self.0 {
            match was(what) {
                Some(was) if was == is => {}
                // Another version is another program.
                _ if what == PROGRAM && !differences.is_empty() => {}
                _ if what == PROGRAM => differences.push(format!("{what} was rebuilt")),
                Some(_) if is.starts_with(HASH) => differences.push(format!("{what} has changed")),
                Some(was) => differences.push(format!("{what} was {was} and is {is}")),
                None => differences.push(format!("{what} is new")),
            }
        }
        differences
    }

    fn to_json(&self) -> String {
        let pairs = self.0.iter().map(|(what, is)| (what.clone(), is.as_str().into()));
        Value::Object(Map::from_iter(pairs)).to_string()
    }

    fn from_json(text: &str) -> Option<Self> {
        let all: Map<_, _> = serde_json::from_str(text).ok()?;
        let pairs = all.into_iter().map(|(what, was)| Some((what, was.as_str()?.to_owned())));
        pairs.collect::<Option<_>>().map(Self)
    }
}

/// The hash of the file that this program runs from, also where another one has taken its place since.
fn program() -> io::Result<String> {
    let running = Path::new("/proc/self/exe");
    let mut file = File::open(running).or_else(|_| env::current_exe().and_then(File::open))?;
    let (mut hasher, mut block) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut block)? {
            0 => return Ok(shown(hasher)),
            read => hasher.update(&block[..read]),
        }
    }
}

fn hash(bytes: &[u8]) -> String {
    shown(Sha256::new_with_prefix(bytes))
}

fn shown(hasher: Sha256) -> String {
    hasher.finalize().iter().fold(HASH.to_owned(), |text, byte| format!("{text}{byte:02x}"))
}

/// Writes a checkpoint of a picture of this size. `rows` has all of the picture's rows, whether they are rendered or not.
///
/// # Errors
/// Those of `out` and `rows`, and a size that a PNG cannot have.
pub fn write(
    out: impl Write,
    [width, height]: [usize; 2],
    identity: &Identity,
    tiles: &Tiles,
    mut rows: Rows,
) -> io::Result<()> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(out, side(width)?, side(height)?);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(AS_SHOWN);
    encoder.add_itxt_chunk(KEYWORD.to_owned(), identity.to_json())?;
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    let (mut colours, mut pixels) = (vec![[0; 3]; width], vec![[0; 4]; width]);
    for row in 0..height {
        rows.next(colours.as_flattened_mut())?;
        for ((pixel, [red, green, blue]), is_done) in iter::zip(&mut pixels, &colours).zip(tiles.row(row)) {
            *pixel = if is_done { [*red, *green, *blue, u8::MAX] } else { [0; 4] };
        }
        stream.write_all(pixels.as_flattened())?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
}

/// A checkpoint to go on from, which is read band by band.
pub struct Checkpoint {
    /// What its picture depended on.
    pub identity: Identity,
    png: png::Reader<BufReader<File>>,
    row: Vec<[u8; 4]>,
}

impl Checkpoint {
    /// Opens one.
    ///
    /// # Errors
    /// Those of the file; of kind `InvalidData` where it is no checkpoint.
    pub fn open(file: File) -> io::Result<Self> {
        let png = png::Decoder::new(BufReader::with_capacity(1 << 16, file)).read_info().map_err(invalid)?;
        let info = png.info();
        let text = info.utf8_text.iter().find(|text| text.keyword == KEYWORD);
        let identity = text.and_then(|text| Identity::from_json(&text.get_text().ok()?));
        let is_plain =
            png.output_color_type() == (png::ColorType::Rgba, png::BitDepth::Eight) && !info.interlaced;
        let identity = identity.filter(|_| is_plain).ok_or(io::ErrorKind::InvalidData)?;
        let row = vec![[0; 4]; info.width as usize];
        Ok(Self { identity, png, row })
    }

    /// The width and height of its picture.
    pub fn size(&self) -> [usize; 2] {
        [self.png.info().width, self.png.info().height].map(|side| side as usize)
    }

    /// Fills a band with what is rendered of it. Bands come from the top.
    ///
    /// # Errors
    /// Those of the file; of kind `InvalidData` where it is broken, or ends before the band does.
    pub fn fill(&mut self, band: &mut Band) -> io::Result<()> {
        let across = self.row.len().div_ceil(TILE);
        band.tiles.fill(true);
        for (row, pixels) in band.pixels.chunks_mut(self.row.len()).enumerate() {
            let read = self.png.read_row(self.row.as_flattened_mut()).map_err(invalid)?;
            read.ok_or(io::ErrorKind::InvalidData)?;
            for (column, (pixel, [red, green, blue, alpha])) in iter::zip(pixels, &self.row).enumerate() {
                *pixel = [*red, *green, *blue];
                if *alpha != u8::MAX {
                    band.tiles[row / TILE * across + column / TILE] = false;
                }
            }
        }
        Ok(())
    }
}

/// A file that ends too soon is broken, too.
fn invalid(error: png::DecodingError) -> io::Error {
    match error {
        png::DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => error,
        _ => io::ErrorKind::InvalidData.into(),
    }
}
