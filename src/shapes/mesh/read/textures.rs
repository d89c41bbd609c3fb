//! Images that the materials of a file name.

use super::model::{MemoryBudget, Model, Remark};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_world::files;
use tabray_world::text;
use tabray_world::texture::Texture;

/// The maximum number of images in a message.
const FEW: usize = 5;

/// Images, each read once.
pub struct Textures<'f> {
    /// The folder for names of files, tried before the folder of the model.
    pub folder: PathBuf,
    of_model: &'f Path,
    budget: &'f MemoryBudget,
    /// The memory left, in bytes.
    memory: u64,
    known: BTreeMap<PathBuf, Option<Arc<Texture>>>,
    /// The unreadable images, each with the reason.
    broken: Vec<String>,
}

impl<'f> Textures<'f> {
    /// Prepares to read the images of a file in this folder.
    pub fn new(folder: &'f Path, budget: &'f MemoryBudget) -> Self {
        Self {
            folder: folder.to_owned(),
            of_model: folder,
            budget,
            memory: budget.left(),
            known: BTreeMap::new(),
            broken: Vec::new(),
        }
    }

    /// Reads the image in the file with this name. `place` says where the name comes from. Folders may be separated by
    /// `\`. If there is no such path, as with paths of another machine, the file name alone is tried in the same
    /// folders.
    pub fn named(&mut self, name: &str, place: &str) -> Option<Arc<Texture>> {
        let name = name.replace('\\', "/");
        let last = Path::new(&name).file_name().unwrap_or_default();
        let names = [Path::new(&name), Path::new(last)];
        let paths = names.into_iter().flat_map(|name| [self.folder.join(name), self.of_model.join(name)]);
        let path = paths.into_iter().find(|path| files::is_file(path)).unwrap_or(self.folder.join(&name));
        if let Some(known) = self.known.get(&path) {
            return known.clone();
        }
        let texture = self.read(Texture::of_model(path.clone(), None), &name, place);
        self.known.insert(path, texture.clone());
        texture
    }

    /// Reads an image from the bytes of its file.
    pub fn within(&mut self, bytes: &[u8], name: &str, place: &str) -> Option<Arc<Texture>> {
        self.read(Texture::of_model(PathBuf::from(name), Some(bytes.to_vec())), name, place)
    }

    fn read(&mut self, texture: Texture, name: &str, place: &str) -> Option<Arc<Texture>> {
        self.budget.wanted.materials.into_iter().for_each(|display| texture.decode_by(display));
        let reason = texture.load_within(self.memory).err().map(str::to_owned);
        self.memory = self.memory.saturating_sub(texture.bytes());
        let Some(reason) = reason else { return Some(Arc::new(texture)) };
        let near = if texture.is_missing() { text::nearest_file(texture.path()) } else { None };
        let reason = near.map_or(reason, |near| format!("it does not exist, but `{near}` does"));
        self.broken.push(format!("`{}` ({place}: {reason})", text::abridged(name)));
        None
    }

    /// Adds the images' files to those that a model names, and a remark if images are unreadable.
    pub fn finish(self, model: &mut Model) {
        model.files.extend(self.known.into_keys());
        if !self.broken.is_empty() {
            model.remarks.push(Remark {
                message: format!("has materials whose images cannot be read: {}", first_of(&self.broken)),
                help: "there, the materials have their plain colours",
            });
        }
    }
}

/// Lists the first few strings.
pub(super) fn first_of(all: &[String]) -> String {
    let few = all[..all.len().min(FEW)].join(", ");
    if all.len() > FEW { format!("{few} and {} more", all.len() - FEW) } else { few }
}
