//! Checkpoints: the finished parts of an image or of a part of one, in a file from which a later render continues.
//!
//! A checkpoint is a PNG whose pixels are opaque where they are rendered and transparent elsewhere. A text chunk says
//! what the image depends on.

use rayon::ThreadPoolBuilder;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::env;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::iter;
use std::ops::Range;
use std::path::Path;
use tabray_core::output::picture::AS_SHOWN;
use tabray_core::parallel;
use tabray_core::render::tiles::{Band, Strip, TILE, Tiles};
use tabray_core::scene::choice::Choice;
use tabray_core::scene::entity::Args;
use tabray_core::scene::model::Model;
use tabray_core::scene::value::Datum;
use tabray_core::text::{self, Named};
use tabray_core::world::sensor::Adaptive;
use tabray_lang::dump;
use tabray_lang::syntax::Syntax;

/// The keyword of the text chunk.
const KEYWORD: &str = "tabray checkpoint";

/// Everything that the pixels of an image depend on; the text chunk is its JSON. A field that another version did not
/// write is empty.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Identity {
    /// The name of the accuracy.
    accuracy: String,
    /// The part of the image that is rendered: column and row, from 0 at the lower left, and width and height, all in
    /// pixels; null where the whole image is rendered.
    crop: Option<[usize; 4]>,
    /// The hash of the program's file. It changes with each build, because plugins are part of the program.
    program: String,
    /// The hashes of the files that objects were read from, by the types and names of the objects.
    files: BTreeMap<String, String>,
    /// The name of the sampler.
    sampler: String,
    /// The exposure in stops, if colours are multiplied at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    exposure: Option<f64>,
    /// The number of samples per pixel.
    samples: u32,
    /// The maximum number of samples per pixel, and the reason for more samples, if pixels differ in their numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    more_samples: Option<String>,
    /// The hash of the hashes of the parts of the scene's dump.
    scene: String,
    /// The width and the height of the image in pixels.
    size: [usize; 2],
    /// The hashes of the textures' images, by the names of the textures.
    textures: BTreeMap<String, String>,
    /// The range of tiles of a part's checkpoint: the first one, and the first after them.
    #[serde(skip_serializing_if = "Option::is_none")]
    tiles: Option<[usize; 2]>,
    /// The version of tabray.
    version: String,
}

impl Identity {
    /// Describes a part of a model's image, made by this program. `columns` count from the left, `rows` from the top.
    ///
    /// # Errors
    /// If the program cannot read its own file.
    pub fn of(model: &Model, columns: &Range<usize>, rows: &Range<usize>) -> io::Result<Self> {
        let camera = &model.camera.value;
        let [width, height] = camera.pixels;
        let is_whole = (columns.len(), rows.len()) == (width, height);
        let textures = model.textures.iter().map(|texture| {
            let [width, height] = texture.value.size();
            let texels = texture.value.load().map(|texels| texels.raw()).unwrap_or_default();
            (texture.args.name().to_owned(), format!("{} ({width} x {height})", hash(&texels)))
        });
        Ok(Self {
            accuracy: camera.accuracy.option().name.to_owned(),
            crop: (!is_whole).then(|| [columns.start, height - rows.end, columns.len(), rows.len()]),
            files: files(model),
            program: program()?,
            sampler: camera.sampler.name().to_owned(),
            exposure: (camera.exposure != 0.0).then_some(camera.exposure),
            samples: camera.samples,
            more_samples: camera.adaptive.map(|Adaptive { most, error }| match error {
                Some(error) if camera.certain => {
                    format!("up to {most} for a certain error of {} levels", 255.0 * error)
                }
                Some(error) => format!("up to {most} for an error of {} levels", 255.0 * error),
                None => format!("up to {most}"),
            }),
            scene: scene(model),
            size: camera.pixels,
            textures: textures.collect(),
            tiles: None,
            version: env!("CARGO_PKG_VERSION").to_owned(),
        })
    }

    /// Describes the checkpoint of a part that has these tiles of the image.
    pub fn of_tiles(self, Range { start, end }: &Range<usize>) -> Self {
        Self { tiles: Some([*start, *end]), ..self }
    }

    /// Tells whether this build of the program has made the checkpoint.
    ///
    /// # Errors
    /// If the program cannot read its own file.
    pub fn is_of_this_program(&self) -> io::Result<bool> {
        Ok(self.program == program()?)
    }

    /// Lists the differences from an older identity, in words; empty where there are none.
    pub fn differences(&self, old: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        if self.version != old.version {
            // Another version is another program, so the program's hash need not be compared.
            differences.push(format!("the version of tabray was {} and is {}", old.version, self.version));
        } else if self.program != old.program {
            differences.push("the program was rebuilt".to_owned());
        }
        let textures = self.textures.iter().filter(|(name, hash)| old.textures.get(*name) != Some(hash));
        let textures = textures.map(|(name, _)| format!("the image of texture `{name}`"));
        let files = self.files.iter().filter(|(name, hash)| old.files.get(*name) != Some(hash));
        let files = files.map(|(name, _)| format!("the file of {name}"));
        let scene = (self.scene != old.scene).then(|| "the scene".to_owned());
        differences
            .extend(scene.into_iter().chain(textures).chain(files).map(|what| format!("{what} has changed")));
        let size = |[width, height]: [usize; 2]| format!("{width} x {height}");
        let crop = |crop: Option<[usize; 4]>| {
            crop.map_or("none".to_owned(), |crop| crop.map(|number| number.to_string()).join(","))
        };
        let more = |of: &Self| of.more_samples.clone().unwrap_or_else(|| "none".to_owned());
        let exposure = |of: &Self| {
            let stops = of.exposure.unwrap_or(0.0);
            format!("{stops} {}", if stops.abs() == 1.0 { "stop" } else { "stops" })
        };
        let values = [
            ("size", size(old.size), size(self.size)),
            ("crop", crop(old.crop), crop(self.crop)),
            ("number of samples", old.samples.to_string(), self.samples.to_string()),
            ("number of further samples", more(old), more(self)),
            ("exposure", exposure(old), exposure(self)),
            ("sampler", old.sampler.clone(), self.sampler.clone()),
            ("accuracy", old.accuracy.clone(), self.accuracy.clone()),
        ];
        let others = values.into_iter().filter(|(_, was, is)| was != is);
        differences.extend(others.map(|(what, was, is)| format!("the {what} was {was} and is {is}")));
        if self.tiles != old.tiles {
            differences.push("it is another part".to_owned());
        }
        differences
    }
}

/// Returns the hash of the file that this program was started from, even if another file has replaced it since.
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

/// The number of entities that are hashed together.
const TOGETHER: usize = 1 << 12;

/// Returns the hash of a scene, computed on all threads: a user may be waiting for an interrupted render to end.
fn scene(model: &Model) -> String {
    let entities = dump::in_order(model);
    let chunks: Vec<_> = entities.chunks(TOGETHER).collect();
    let hash = |index: usize| {
        let mut hasher = Sha256::new();
        let mut memory = None;
        for record in chunks[index] {
            add(&mut hasher, record.args_in(&mut memory));
        }
        hasher.finalize()
    };
    let pool = (chunks.len() > 1).then(|| ThreadPoolBuilder::new().build().ok()).flatten();
    let hashes: Vec<_> = match pool {
        Some(pool) => parallel::run_on(&pool, || parallel::map(chunks.len(), hash)),
        None => (0..chunks.len()).map(hash).collect(),
    };
    shown(hashes.iter().fold(Sha256::new(), |all, hash| all.chain_update(hash)))
}

/// Hashes the given values of an entity: numbers by their bytes, which is much faster than as text, and all else as
/// in a dump. The length of each part comes before it.
fn add(hasher: &mut Sha256, args: &Args) {
    let mut part = |bytes: &[u8]| {
        hasher.update((bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    part(args.entity.name.as_bytes());
    part(args.name.as_bytes());
    part(&args.given().count().to_le_bytes());
    for (attribute, datum) in args.given() {
        part(attribute.name().as_bytes());
        match datum {
            Datum::Numbers(numbers) => {
                let bytes: Vec<_> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
                part(&bytes);
            }
            other => Syntax::Notes.values(other).iter().for_each(|word| part(word.as_bytes())),
        }
    }
}

fn files(model: &Model) -> BTreeMap<String, String> {
    let objects = model.objects.iter().map(|object| (&object.args, &object.shape));
    let patterns = model.patterns.iter().filter_map(|item| Some((&item.args, &item.value.get()?.shape)));
    let from_files = objects.chain(patterns).filter(|(record, _)| record.entity().reads_files());
    let named = from_files.map(|(record, shape)| {
        let mut hasher = Sha256::new();
        shape.read_from_files(&mut |bytes| hasher.update(bytes));
        (format!("{} `{}`", record.entity().name, record.name()), shown(hasher))
    });
    named.collect()
}

fn hash(bytes: &[u8]) -> String {
    shown(Sha256::new_with_prefix(bytes))
}

fn shown(hasher: Sha256) -> String {
    text::sha256(&hasher.finalize())
}

/// Writes a checkpoint of the top of an image, with this number of columns and rows. `next` fills in the bytes of one
/// row after the other, whether they are rendered or not.
///
/// # Errors
/// Returns the errors of `out` and `next`, and an error where a PNG cannot have the size.
pub fn write(
    mut out: impl Write,
    [width, height]: [usize; 2],
    identity: &Identity,
    tiles: &Tiles,
    mut next: impl FnMut(&mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(&mut out as &mut dyn Write, side(width)?, side(height)?);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(AS_SHOWN);
    encoder.add_itxt_chunk(KEYWORD.to_owned(), text::json(identity))?;
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    let (mut colours, mut pixels) = (vec![[0; 3]; width], vec![[0; 4]; width]);
    for row in 0..height {
        next(colours.as_flattened_mut())?;
        for ((pixel, [red, green, blue]), is_done) in iter::zip(&mut pixels, &colours).zip(tiles.row(row)) {
            *pixel = if is_done { [*red, *green, *blue, u8::MAX] } else { [0; 4] };
        }
        stream.write_all(pixels.as_flattened())?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
}

/// A checkpoint to continue from, which is read band by band.
pub struct Checkpoint {
    /// The settings and inputs on which the checkpoint's image depends.
    pub identity: Identity,
    png: png::Reader<BufReader<File>>,
    /// The number of columns, which is checked only by [`fits`](Self::fits).
    width: usize,
    /// The number of rows that are still to be read.
    rows: usize,
}

impl Checkpoint {
    /// Opens a checkpoint.
    ///
    /// # Errors
    /// Returns the errors of the file, and one of kind `InvalidData` if the file is not a checkpoint.
    pub fn open(file: File) -> io::Result<Self> {
        let mut png = png::Decoder::new(BufReader::with_capacity(1 << 16, file));
        png.ignore_checksums(false);
        let png = png.read_info().map_err(invalid)?;
        let info = png.info();
        // A compressed text might be a thousand times longer than the file.
        let text = info.utf8_text.iter().find(|text| text.keyword == KEYWORD && !text.compressed);
        let identity = text.and_then(|text| serde_json::from_str::<Identity>(&text.get_text().ok()?).ok());
        let is_plain =
            png.output_color_type() == (png::ColorType::Rgba, png::BitDepth::Eight) && !info.interlaced;
        let identity = identity.filter(|_| is_plain).ok_or(io::ErrorKind::InvalidData)?;
        let (width, rows) = (info.width as usize, info.height as usize);
        Ok(Self { identity, png, width, rows })
    }

    /// Tells whether this can be the checkpoint of an image of this size: of the same width, and of the same height or
    /// cut off between two rows of tiles.
    pub fn fits(&self, [width, height]: [usize; 2]) -> bool {
        self.width == width && (self.rows == height || self.rows < height && self.rows.is_multiple_of(TILE))
    }

    /// Fills a band with the pixels that are already rendered, and leaves the rest. Bands must be passed in order, from
    /// the top.
    ///
    /// # Errors
    /// Returns the errors of the file, and one of kind `InvalidData` if the file is corrupt. Some corruption is noticed
    /// only at the end of the file, after earlier bands were filled.
    pub fn fill(&mut self, band: &Band) -> io::Result<()> {
        let mut row = vec![[0; 4]; self.width];
        for index in 0..band.strips.len() {
            let Strip { pixels, tiles } = &mut *band.strip(index);
            if self.rows == 0 {
                return Ok(());
            }
            tiles.fill(true);
            for pixels in pixels.chunks_mut(self.width) {
                let read = self.png.read_row(row.as_flattened_mut()).map_err(invalid)?;
                read.ok_or(io::ErrorKind::InvalidData)?;
                self.rows -= 1;
                for (column, (pixel, [red, green, blue, alpha])) in iter::zip(pixels, &row).enumerate() {
                    *pixel = [*red, *green, *blue];
                    if *alpha != u8::MAX {
                        tiles[column / TILE] = false;
                    }
                }
            }
            if self.rows == 0 {
                // The checksums come after the pixels.
                self.png.finish().map_err(invalid)?;
            }
        }
        Ok(())
    }

    /// Returns the number of rows that are still to be read.
    pub fn rows_left(&self) -> usize {
        self.rows
    }
}

/// Makes an error of kind `InvalidData`, also for a file that ends too soon.
fn invalid(error: png::DecodingError) -> io::Error {
    match error {
        png::DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => error,
        _ => io::ErrorKind::InvalidData.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Seek;

    const SIZE: [usize; 2] = [20, 18];

    /// Makes a file with these bytes.
    fn file(bytes: &[u8]) -> File {
        let mut file = tempfile::tempfile().expect("a temporary file");
        file.write_all(bytes).and_then(|()| file.rewind()).expect("it is written");
        file
    }

    fn blank() -> Band {
        Band::blank(0..SIZE[0], 0..SIZE[1])
    }

    /// Returns all bytes and tiles of an image, as a checkpoint fills them.
    fn filled(bytes: &[u8]) -> io::Result<(Vec<u8>, Vec<bool>)> {
        let mut checkpoint = Checkpoint::open(file(bytes))?;
        if !checkpoint.fits(SIZE) {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let band = blank();
        checkpoint.fill(&band)?;
        let tiles = (0..band.strips.len()).flat_map(|index| band.strip(index).tiles.clone()).collect();
        Ok((band.bytes(usize::MAX).concat(), tiles))
    }

    #[test]
    fn a_difference_of_one_stop_is_told_in_the_singular() {
        let of = |exposure| Identity { exposure, ..Identity::default() };
        let told = of(Some(1.0)).differences(&of(None));
        assert_eq!(told, ["the exposure was 0 stops and is 1 stop"]);
    }

    #[test]
    fn a_damaged_byte_anywhere_is_noticed_or_harmless() {
        let pixels: Vec<u8> = (0..3 * SIZE[0] * SIZE[1]).map(|byte| (byte * byte / 97) as u8).collect();
        let band = blank();
        (0..2).for_each(|index| band.strip(index).tiles.fill(true));
        let mut tiles = Tiles::none(SIZE);
        tiles.add(&band);
        let (mut bytes, mut left) = (Vec::new(), &pixels[..]);
        let next = |row: &mut [u8]| left.read_exact(row);
        write(&mut bytes, SIZE, &Identity::default(), &tiles, next).expect("memory takes it");
        let whole = (pixels, vec![true; 4]);
        assert!(filled(&bytes).expect("nothing is damaged") == whole);
        for at in 0..bytes.len() {
            for mask in [1, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= mask;
                assert!(
                    filled(&damaged).is_ok_and(|filled| filled == whole) || filled(&damaged).is_err(),
                    "{at}"
                );
            }
            assert!(filled(&bytes[..at]).is_err(), "cut off at {at}");
        }
    }
}
