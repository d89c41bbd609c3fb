//! Reads scenes from files and from standard input.

use crate::files::paths::open_stream;
use crate::options::set;
use crate::process::failure::Failure;
use crate::process::{crash, memory, messages};
use sha2::{Digest, Sha256};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::{self, Loaded, ReadOptions, Report};
use tabray_lang::registry::Registry;

/// The maximum size of a scene, in bytes: far more than written scenes have, and far less than memory holds.
const LARGEST: u64 = 1 << 30;

/// The memory for making a model of many objects of few words, in bytes per byte of its text.
const MODEL: usize = 8;

/// Tells whether this path stands for standard input.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// Reads a scene with what is set beside its text, prints its warnings and returns its model, with the given accuracy or
/// with its own.
pub fn load(
    registry: &Registry,
    path: &Path,
    sets: &set::Args,
    accuracy: Option<Accuracy>,
) -> Result<Model, Failure> {
    print_warnings(Source::read(path, sets)?.load(registry, accuracy)).map(|loaded| loaded.model)
}

/// The warnings that were printed last.
static TOLD: Mutex<String> = Mutex::new(String::new());

/// Prints the warnings of a scene that was loaded, unless they are those of the scene before: the frames of a film
/// mostly have the same.
pub fn print_warnings(loaded: Result<Loaded, Report>) -> Result<Loaded, Failure> {
    let loaded = loaded.map_err(Failure::Scene)?;
    let mut print_warnings = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    let warnings = loaded.warnings.short();
    if *print_warnings != warnings {
        messages::warnings(&loaded.warnings);
        *print_warnings = warnings;
    }
    Ok(loaded)
}

/// The text of a scene, from which any number of models can be made.
pub struct Source {
    name: String,
    folder: PathBuf,
    bytes: Vec<u8>,
    sets: set::Args,
}

impl Source {
    /// Reads the text of a scene, beside which values are set.
    pub fn read(path: &Path, sets: &set::Args) -> Result<Self, Failure> {
        let (name, bytes) = read(path)?;
        let source =
            Self { name, folder: path.parent().unwrap_or(path).to_owned(), bytes, sets: sets.clone() };
        let size = MODEL.saturating_mul(source.bytes.len());
        memory::refuse_too_large(size, &format!("the model of `{}`", source.name))?;
        Ok(source)
    }

    /// Takes a text for that of a file.
    pub fn of_text(path: &Path, text: String, sets: &set::Args) -> Self {
        let folder = path.parent().unwrap_or(path).to_owned();
        Self { name: text::shown(path), folder, bytes: text.into_bytes(), sets: sets.clone() }
    }

    /// Returns the name of the text in messages, and its bytes.
    pub fn named(&self) -> (&str, &[u8]) {
        (&self.name, &self.bytes)
    }

    /// Returns the SHA-256 of the text, as `sha256sum` prints it.
    pub fn hash(&self) -> String {
        text::sha256(&Sha256::digest(&self.bytes))
    }

    /// Makes a model, with the given accuracy or with the scene's own, and its warnings.
    pub fn load(&self, registry: &Registry, accuracy: Option<Accuracy>) -> Result<Loaded, Report> {
        self.load_by(registry, ReadOptions { above_all: accuracy, ..ReadOptions::default() })
    }

    /// Makes a model that is asked about rays alone, and its warnings.
    pub fn load_for_rays(&self, registry: &Registry, accuracy: Option<Accuracy>) -> Result<Loaded, Report> {
        let chosen = self.chosen(ReadOptions { above_all: accuracy, ..ReadOptions::default() });
        reader::read_for_rays(registry, &self.name, &self.folder, &self.bytes, chosen)
    }

    /// Makes a model and its warnings, with the choices of [`ReadOptions`].
    pub fn load_by(&self, registry: &Registry, options: ReadOptions<'_>) -> Result<Loaded, Report> {
        reader::read_by(registry, &self.name, &self.folder, &self.bytes, self.chosen(options))
    }

    fn chosen<'s>(&'s self, options: ReadOptions<'s>) -> ReadOptions<'s> {
        ReadOptions { sets: &self.sets.values, set_by: &self.sets.set_by, ..options }
    }
}

/// Returns the name of a scene in messages, and its bytes.
pub fn read(path: &Path) -> Result<(String, Vec<u8>), Failure> {
    let (name, bytes) = if is_standard(path) {
        ("<stdin>".to_owned(), to_first_nul(io::stdin().lock()))
    } else {
        (text::shown(path), open_stream(path).and_then(to_first_nul))
    };
    crash::set_scene(&name);
    match bytes {
        Ok(bytes) if bytes.len() as u64 > LARGEST => {
            let message = format!("`{name}` is larger than {} MiB, too large for a scene", LARGEST >> 20);
            Err(Failure::usage(message))
        }
        Ok(bytes) => Ok((name, bytes)),
        Err(error) => {
            let near = text::nearest_file(path).filter(|_| error.kind() == io::ErrorKind::NotFound);
            Err(Failure::Unread(
                format!("cannot read `{name}`: {}", text::reason(&error)),
                near.map(|near| format!("did you mean `{}`?", text::shown(path.with_file_name(near)))),
            ))
        }
    }
}

/// Reads a stream to its end, or to the end of a block with a NUL byte: scenes have none, and devices may have no end. Each
/// block is as long as all before it, so that large scenes are read in few pieces.
fn to_first_nul(source: impl Read) -> io::Result<Vec<u8>> {
    let mut source = source.take(LARGEST + 1);
    let mut bytes = Vec::new();
    loop {
        let start = bytes.len();
        let read = source.by_ref().take(start.max(1 << 16) as u64).read_to_end(&mut bytes)?;
        if read == 0 || bytes[start..].contains(&0) {
            return Ok(bytes);
        }
    }
}
