//! Numbers of glTF: buffers, buffer views, and accessors, which give the types of the numbers in a view.

use super::json::{self, Gltf};
use super::meshopt;
use crate::mesh::read::model::{MemoryBudget, shown};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use tabray_world::files::held::SceneFile;
use tabray_world::text;

/// The bytes of a file's buffers.
pub struct Buffers<'f> {
    buffers: Vec<Cow<'f, [u8]>>,
    /// The views that are compressed in the file, by their indices.
    decoded: BTreeMap<usize, Vec<u8>>,
    json: &'f Gltf,
}

/// A component type of numbers.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    fn of(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("has numbers of type {code}, which glTF does not have")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Reads the number at the start of a slice, and returns it with the number that stands for 1 in normalized
    /// accessors.
    fn read(self, bytes: &[u8]) -> (f64, f64) {
        match (self, bytes) {
            (Self::I8, [a, ..]) => (f64::from(*a as i8), 127.0),
            (Self::U8, [a, ..]) => (f64::from(*a), 255.0),
            (Self::I16, [a, b, ..]) => (f64::from(i16::from_le_bytes([*a, *b])), 32767.0),
            (Self::U16, [a, b, ..]) => (f64::from(u16::from_le_bytes([*a, *b])), 65535.0),
            (Self::U32, [a, b, c, d, ..]) => {
                (f64::from(u32::from_le_bytes([*a, *b, *c, *d])), 4_294_967_295.0)
            }
            (Self::F32, [a, b, c, d, ..]) => (f64::from(f32::from_le_bytes([*a, *b, *c, *d])), 1.0),
            _ => (0.0, 1.0),
        }
    }
}

/// The elements of an accessor.
pub struct Elements<'b> {
    pub count: usize,
    /// The number of numbers of an element.
    pub width: usize,
    kind: Kind,
    is_normalized: bool,
    /// The bytes from the first element on. Missing bytes stand for numbers that are 0.
    bytes: &'b [u8],
    stride: usize,
    /// The bytes of sparse elements, by index.
    others: BTreeMap<usize, &'b [u8]>,
}

impl Elements<'_> {
    /// Returns the first `N` numbers of an element.
    pub fn get<const N: usize>(&self, index: usize) -> [f64; N] {
        let all = self.bytes.get(index * self.stride..).unwrap_or_default();
        let bytes = self.others.get(&index).copied().unwrap_or(all);
        std::array::from_fn(|at| {
            let (number, one) = self.kind.read(bytes.get(at * self.kind.size()..).unwrap_or_default());
            if self.is_normalized { (number / one).max(-1.0) } else { number }
        })
    }
}

impl<'f> Buffers<'f> {
    /// Reads the buffers of a file in a folder. `own` is the binary chunk of the file itself.
    pub fn read(
        json: &'f Gltf,
        own: Option<&'f [u8]>,
        folder: &Path,
        budget: &MemoryBudget,
    ) -> Result<Self, String> {
        let (mut buffers, mut left) = (Vec::new(), budget.left());
        for (index, json::Buffer { uri, byte_length, extensions }) in json.buffers.iter().enumerate() {
            if extensions.meshopt.fallback {
                buffers.push(Cow::Borrowed(&[][..]));
                continue;
            }
            let bytes = match uri {
                None if index == 0 => Cow::Borrowed(own.unwrap_or_default()),
                None => return Err(format!("buffer {index} has no `uri`")),
                Some(uri) => Cow::Owned(contents(uri, folder, left)?),
            };
            if bytes.len() < *byte_length {
                return Err(format!(
                    "buffer {index} has {}, but should have {byte_length}",
                    text::count(bytes.len(), "byte")
                ));
            }
            left = left.saturating_sub(if uri.is_some() { bytes.len() as u64 } else { 0 });
            buffers.push(bytes);
        }
        let mut decoded = BTreeMap::new();
        for (index, view) in json.buffer_views.iter().enumerate() {
            let Some(view) = &view.extensions.meshopt else { continue };
            let buffer =
                buffers.get(view.buffer).ok_or_else(|| format!("there is no buffer {}", view.buffer))?;
            let bytes = meshopt::decoded(view, buffer, left)?;
            left -= bytes.len() as u64;
            decoded.insert(index, bytes);
        }
        Ok(Self { buffers, decoded, json })
    }

    /// Returns the bytes of a view, from an offset on.
    pub fn view(&self, index: usize, offset: usize) -> Result<&[u8], String> {
        let view =
            self.json.buffer_views.get(index).ok_or_else(|| format!("there is no buffer view {index}"))?;
        let beyond = || format!("buffer view {index} reaches beyond the end of buffer {}", view.buffer);
        if let Some(bytes) = self.decoded.get(&index) {
            return bytes.get(offset..).ok_or_else(beyond);
        }
        let buffer =
            self.buffers.get(view.buffer).ok_or_else(|| format!("there is no buffer {}", view.buffer))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| buffer.get(view.byte_offset..end));
        let bytes = bytes.and_then(|bytes| bytes.get(offset..));
        bytes.ok_or_else(beyond)
    }

    /// Returns the elements of an accessor. The number of components in each element must be one of `widths`.
    pub fn elements(
        &self,
        index: usize,
        widths: &[usize],
        budget: &MemoryBudget,
    ) -> Result<Elements<'_>, String> {
        let accessor =
            self.json.accessors.get(index).ok_or_else(|| format!("there is no accessor {index}"))?;
        let wrong = |what: String| format!("accessor {index} {what}");
        let json::Accessor { buffer_view, byte_offset, component_type, normalized, count, shape, sparse } =
            accessor;
        let kind = Kind::of(*component_type).map_err(wrong)?;
        let width = match &shape[..] {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        if !widths.contains(&width) {
            return Err(wrong(format!(
                "is of type `{}`, which is not what it is used as",
                shown(shape.as_bytes())
            )));
        }
        budget.holds(*count, 0)?;
        let size = width * kind.size();
        let (mut bytes, mut stride) = (&[][..], size);
        if let Some(view) = buffer_view {
            bytes = self.view(*view, *byte_offset)?;
            stride =
                self.json.buffer_views[*view].byte_stride.filter(|stride| *stride >= size).unwrap_or(size);
            let needed = count.saturating_sub(1).checked_mul(stride).and_then(|last| last.checked_add(size));
            if *count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
                return Err(wrong(format!("has {count} elements, more than its buffer view holds")));
            }
        }
        let mut others = BTreeMap::new();
        if let Some(json::Sparse { count: some, indices, values }) = sparse {
            let of = Kind::of(indices.component_type).map_err(wrong)?;
            let places = self.view(indices.buffer_view, indices.byte_offset)?;
            let values = self.view(values.buffer_view, values.byte_offset)?;
            let is_held =
                |each: usize, bytes: &[u8]| some.checked_mul(each).is_some_and(|end| end <= bytes.len());
            if !is_held(of.size(), places) || !is_held(size, values) {
                return Err(wrong(format!("has {some} sparse elements, more than its buffer views hold")));
            }
            for (place, value) in places.chunks_exact(of.size()).zip(values.chunks_exact(size)).take(*some) {
                let place = of.read(place).0 as usize;
                if place >= *count {
                    return Err(wrong(format!("has {count} elements and a sparse one of index {place}")));
                }
                others.insert(place, value);
            }
        }
        Ok(Elements { count: *count, width, kind, is_normalized: *normalized, bytes, stride, others })
    }
}

/// Returns the bytes of a URI: the data in the URI itself, or the contents of a file.
pub fn contents(uri: &str, folder: &Path, most: u64) -> Result<Vec<u8>, String> {
    if let Some(bytes) = data(uri) {
        return bytes;
    }
    let path = folder.join(&*unescaped(uri));
    let cannot = |reason: String| format!("its buffer `{}` cannot be read: {reason}", text::abridged(uri));
    let file = SceneFile::open(&path).map_err(|error| {
        let near = if path.exists() { None } else { text::nearest_file(&path) };
        cannot(near.map_or(text::reason(&error), |near| format!("it does not exist, but `{near}` does")))
    })?;
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(|error| cannot(text::reason(&error)))?;
    if bytes.len() as u64 > most {
        return Err(cannot("not enough memory for it".to_owned()));
    }
    Ok(bytes)
}

/// Returns the buffer files that a model in a folder names.
pub fn files(json: &Gltf, folder: &Path) -> Vec<PathBuf> {
    let uris = json.buffers.iter().filter_map(|buffer| buffer.uri.as_deref());
    uris.filter(|uri| data(uri).is_none()).map(|uri| folder.join(&*unescaped(uri))).collect()
}

/// Returns the bytes in a data URI, or `None` for any other URI.
pub fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (kind, data) = uri.strip_prefix("data:")?.split_once(',')?;
    Some(if kind.ends_with(";base64") {
        STANDARD.decode(data).map_err(|error| format!("one of its URIs is not in base64: {error}"))
    } else {
        Ok(unescaped(data).into_owned().into_bytes())
    })
}

/// Returns a URI with its percent escapes decoded, such as `%20`.
pub fn unescaped(uri: &str) -> Cow<'_, str> {
    if !uri.contains('%') {
        return Cow::Borrowed(uri);
    }
    let (mut bytes, mut rest) = (Vec::new(), uri.as_bytes());
    while let [first, after @ ..] = rest {
        let digits = after.get(..2).filter(|_| *first == b'%').and_then(|digits| str::from_utf8(digits).ok());
        let escaped = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    Cow::Owned(String::from_utf8_lossy(&bytes).into_owned())
}
