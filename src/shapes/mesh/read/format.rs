//! Formats of mesh files, recognised by the beginnings of the files.

use super::blocks::{self, words};
use super::{gltf, obj, ply, stl};
use memchr::memmem;

/// A supported format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Obj,
    Ply,
    Stl,
    Gltf,
}

/// The beginnings of other files, with what they are and what to do about them.
const OTHERS: [(&[u8], &str); 16] = [
    (b"\x1f\x8b", "it is compressed with gzip: decompress it first"),
    (b"BZh", "it is compressed with bzip2: decompress it first"),
    (b"\xfd7zXZ", "it is compressed with xz: decompress it first"),
    (b"\x28\xb5\x2f\xfd", "it is compressed with zstd: decompress it first"),
    (b"7z\xbc\xaf", "it is a 7z archive: unpack it first"),
    (b"Rar!", "it is a RAR archive: unpack it first"),
    (
        b"PK\x03\x04",
        "it is a ZIP archive, as 3MF and USDZ are: unpack it, or export it as OBJ, PLY, STL or glTF",
    ),
    (b"Kaydara FBX", "it is an FBX: export it as OBJ, PLY, STL or glTF"),
    (b"BLENDER", "it is a scene of Blender: export it as OBJ, PLY, STL or glTF"),
    (b"ISO-10303", "it is a STEP: export it as OBJ, PLY, STL or glTF"),
    (b"#VRML", "it is a VRML: export it as OBJ, PLY, STL or glTF"),
    (b"OFF", "it is an OFF: export it as OBJ, PLY, STL or glTF"),
    (
        b"version https://git-lfs",
        "it is only a pointer to a file that Git LFS stores: fetch that with `git lfs pull`",
    ),
    (b"<!DOCTYPE", "it is an HTML page, not the file that was to be downloaded"),
    (b"<html", "it is an HTML page, not the file that was to be downloaded"),
    (b"<", "it is XML, as Collada and X3D are: export it as OBJ, PLY, STL or glTF"),
];

impl Format {
    /// Recognises the format of a file by its beginning, or else by the extension of its name, in lower case.
    pub fn of(bytes: &[u8], ending: &str) -> Result<Self, String> {
        let first = words(&bytes[..bytes.len().min(1 << 10)]).next().unwrap_or_default();
        if first.is_empty() && bytes.len() < 1 << 10 {
            return Err("it is empty".to_owned());
        }
        if stl::is_whole(bytes) {
            return Ok(Self::Stl);
        }
        if is_utf_16(bytes) {
            return Err("it is a text in UTF-16: save it in UTF-8".to_owned());
        }
        let other = OTHERS.iter().find(|(begins, _)| {
            bytes
                .trim_ascii_start()
                .get(..begins.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(begins))
        });
        if let Some((_, what)) = other {
            return Err((*what).to_owned());
        }
        Ok(match ending {
            _ if is_gltf(bytes) => Self::Gltf,
            _ if first.eq_ignore_ascii_case(b"ply") => Self::Ply,
            _ if stl::is_text(bytes) => Self::Stl,
            _ if is_obj(bytes) => Self::Obj,
            "obj" => Self::Obj,
            "ply" => Self::Ply,
            "stl" => Self::Stl,
            _ => {
                return Err(
                    "neither its name nor its beginning is that of an OBJ, PLY, STL or glTF".to_owned()
                );
            }
        })
    }

    /// Tells whether a file of this format is a text.
    pub fn is_text(self, bytes: &[u8]) -> bool {
        match self {
            Self::Obj => true,
            Self::Ply => ply::is_text(bytes),
            Self::Stl => stl::is_text(bytes),
            Self::Gltf => false,
        }
    }

    /// Returns the reason why a file has no faces.
    pub fn without_faces(self, bytes: &[u8], vertices: usize) -> String {
        match self {
            Self::Obj => obj::without_faces(bytes),
            Self::Ply if vertices > 0 => "it has vertices and no faces: it is a cloud of points".to_owned(),
            Self::Ply => "it has no faces".to_owned(),
            Self::Stl | Self::Gltf => "it has no triangles".to_owned(),
        }
    }
}

/// Tells whether a text has two bytes for each character: it has a byte order mark, or begins with ASCII characters.
fn is_utf_16(bytes: &[u8]) -> bool {
    let begins = bytes.get(..8).unwrap_or_default();
    let is_wide = |zero: usize| {
        let mut pairs = begins.chunks_exact(2);
        !begins.is_empty()
            && pairs.all(|pair| pair[zero] == 0 && pair[1 - zero].is_ascii() && pair[1 - zero] != 0)
    };
    begins.starts_with(b"\xff\xfe") || begins.starts_with(b"\xfe\xff") || is_wide(0) || is_wide(1)
}

/// Tells whether a file is a GLB, or the JSON of a glTF.
fn is_gltf(bytes: &[u8]) -> bool {
    let is_json = bytes.trim_ascii_start().starts_with(b"{");
    bytes.starts_with(gltf::MAGIC) || is_json && memmem::find(bytes, b"\"asset\"").is_some()
}

/// Tells whether the first line of a text other than comments begins with a keyword of OBJ.
fn is_obj(bytes: &[u8]) -> bool {
    const WORDS: [&[u8]; 9] = [b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"];
    let mut firsts = blocks::lines(bytes).take(1000).filter_map(|line| words(line).next());
    firsts.find(|word| !word.starts_with(b"#")).is_some_and(|word| WORDS.contains(&word))
}
