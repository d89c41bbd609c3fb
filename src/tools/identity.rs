//! What the pixels of an image depend on, for a file of some of them: only the same image is continued or assembled.

use rayon::ThreadPoolBuilder;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::env;
use std::fs::File;
use std::io::{self, Read};
use std::ops::{Not, Range};
use std::path::Path;
use tabray_core::parallel;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::entity::Args;
use tabray_core::scene::model::Model;
use tabray_core::scene::value::Datum;
use tabray_core::text::{self, Named};
use tabray_core::world::sensor::Adaptive;
use tabray_lang::dump;
use tabray_lang::syntax::Syntax;

/// Everything that the pixels of an image depend on. A field that another version did not write is empty.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Identity {
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
    /// Whether the image is transparent where it shows no object.
    #[serde(skip_serializing_if = "Not::not")]
    alpha: bool,
    /// The hash of the hashes of the parts of the scene's dump.
    scene: String,
    /// The width and the height of the image in pixels.
    size: [usize; 2],
    /// The hashes of the textures' images, by the names of the textures.
    textures: BTreeMap<String, String>,
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
            alpha: camera.alpha,
            scene: scene(model),
            size: camera.pixels,
            textures: textures.collect(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        })
    }

    /// Tells whether this build of the program has made the file.
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
        let transparent = |of: &Self| if of.alpha { "transparent" } else { "opaque" }.to_owned();
        let values = [
            ("background", transparent(old), transparent(self)),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_of_one_stop_is_told_in_the_singular() {
        let of = |exposure| Identity { exposure, ..Identity::default() };
        let told = of(Some(1.0)).differences(&of(None));
        assert_eq!(told, ["the exposure was 0 stops and is 1 stop"]);
    }
}
