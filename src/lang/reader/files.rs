//! Names of files in places where scenes have names of entities, and what to write there.

use super::misplaced::IMAGES;
use crate::syntax::Syntax;
use std::path::Path;
use std::slice;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::Type;

/// The extensions of models, and of their materials.
const MODELS: [&str; 6] = ["obj", "stl", "ply", "off", "gltf", "glb"];
const MATERIALS: &str = "mtl";

fn has_extension(word: &str, extensions: &[&str]) -> bool {
    let extension = Path::new(word).extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|own| extensions.iter().any(|extension| own.eq_ignore_ascii_case(extension)))
}

/// Tells whether a word is the name of an image or of a model.
pub fn is_file(word: &str) -> bool {
    has_extension(word, &IMAGES) || has_extension(word, &MODELS)
}

/// Tells whether an attribute takes the name of a file.
pub fn takes(attribute: &dyn Attribute) -> bool {
    matches!(attribute.value_type(), Type::File) || attribute.name() == "filename"
}

/// Returns the name of a file without its folder and its extension.
pub fn stem(word: &str) -> Option<&str> {
    let is_known = is_file(word) || has_extension(word, &[MATERIALS]);
    Path::new(word).file_stem().and_then(|stem| stem.to_str()).filter(|_| is_known)
}

/// Returns what to define and to write where the name of a file stands for an entity of a kind. `attribute` is to be
/// written, too.
pub fn cure(kind: Kind, word: &str, attribute: Option<&str>, syntax: Syntax) -> Option<String> {
    let stem = stem(word)?;
    let texture = syntax.entity("texture", stem, &[syntax.pair("filename", &[syntax.word(word)])]);
    let image = syntax.entity("image", "NAME", &[syntax.pair("texture", &[syntax.word(stem)])]);
    let name = syntax.word(stem);
    let name = attribute
        .map_or(format!("`{name}` here"), |its| format!("`{}`", syntax.pair(its, slice::from_ref(&name))));
    match kind {
        Kind::Texture if has_extension(word, &IMAGES) => {
            Some(format!("the file of an image belongs to a texture: define {texture}, and write {name}"))
        }
        Kind::Shader | Kind::Material if has_extension(word, &IMAGES) => Some(format!(
            "a shader draws an image: define a texture with this file, {texture}, and a shader, {image}, and give the \
             object `{}`",
            syntax.pair("shader", &[syntax.word("NAME")])
        )),
        Kind::Material if has_extension(word, &[MATERIALS]) => Some(format!(
            "such a file belongs to that of a `mesh`; define the material in the scene, {}, and write {name}",
            syntax.entity("material", stem, &["...".to_owned()])
        )),
        _ => None,
    }
}
