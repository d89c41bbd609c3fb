//! OpenEXR images whose colours are not the channels R, G and B of one part, which is what the image reader takes: grey
//! ones, and those of several layers.

use crate::files::ImageBytes;
use crate::text;
use exr::error::Error;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, read as read_exr};
use image::{DynamicImage, ImageError, Rgba, Rgba32FImage};
use std::error::Error as _;

/// The channels of the first colours in a file.
struct Colours {
    /// The part of the file.
    part: usize,
    /// The names of red, green and blue, which are equal in a grey image.
    names: [String; 3],
    /// The name of the opacity, if there is one.
    alpha: Option<String>,
    /// Whether there are other colours.
    are_several: bool,
}

/// Reads an image within `most` bytes of memory, and tells whether it has more layers than the one that is shown.
///
/// # Errors
/// Returns the reason why the image cannot be read.
pub(super) fn read(bytes: &mut dyn ImageBytes, most: u64) -> Result<(DynamicImage, bool), String> {
    bytes.rewind().map_err(|error| text::reason(&error))?;
    let chunks = exr::block::read(bytes, false).map_err(|error| reason(&error))?;
    let Colours { part, names, alpha, are_several } = colours(chunks.headers())?;
    let taken = chunks.headers().iter().map(|Header { layer_size, channels, shared_attributes, .. }| {
        let bytes = |[width, height]: [usize; 2], of_pixel: usize| {
            (width as u64).saturating_mul(height as u64).saturating_mul(of_pixel as u64)
        };
        let shown = shared_attributes.display_window.size;
        let held = bytes([layer_size.width(), layer_size.height()], channels.bytes_per_pixel);
        held.saturating_add(bytes([shown.width(), shown.height()], 16))
    });
    if taken.fold(0, u64::saturating_add) > most {
        return Err(format!("it takes more than {} of memory", bytesize::ByteSize(most)));
    }
    let levels = read_exr().no_deep_data().largest_resolution_level();
    let image = levels.all_channels().all_layers().all_attributes().non_parallel().from_chunks(chunks);
    let image = image.map_err(|error| reason(&error))?;
    let layer = &image.layer_data[part];
    let samples = |name: &String| {
        let channel = layer.channel_data.list.iter().find(|channel| channel.name == **name);
        channel.map(|channel| &channel.sample_data)
    };
    let [red, green, blue] = names.each_ref().map(samples);
    let alpha = alpha.as_ref().and_then(samples);
    let window = image.attributes.display_window;
    let pixel = |x: u32, y: u32| {
        // Outside of the part's own window, there is nothing.
        let place = |at: u32, from: i32, own: i32, size: usize| {
            usize::try_from(i64::from(at) + i64::from(from) - i64::from(own)).ok().filter(|at| *at < size)
        };
        let own = layer.attributes.layer_position;
        let column = place(x, window.position.x(), own.x(), layer.size.width());
        let index = column
            .zip(place(y, window.position.y(), own.y(), layer.size.height()))
            .map(|(column, row)| row * layer.size.width() + column);
        let value = |samples: Option<&exr::image::FlatSamples>, none: f32| match (samples, index) {
            (None, _) => none,
            (Some(samples), Some(index)) => samples.value_by_flat_index(index).to_f32(),
            (Some(_), None) => 0.0,
        };
        Rgba([value(red, 0.0), value(green, 0.0), value(blue, 0.0), value(alpha, 1.0)])
    };
    let [width, height] = [window.size.width(), window.size.height()].map(|side| side as u32);
    if width == 0 || height == 0 {
        return Err(format!("it is {width} x {height} pixels, so it is empty"));
    }
    let picture = DynamicImage::ImageRgba32F(Rgba32FImage::from_fn(width, height, pixel));
    let picture = if alpha.is_some() { picture } else { DynamicImage::ImageRgb32F(picture.into_rgb32f()) };
    Ok((picture, are_several))
}

/// Finds the first colours of a file, or the first grey.
fn colours(headers: &[Header]) -> Result<Colours, String> {
    let names_of = |header: &Header| -> Vec<String> {
        header.channels.list.iter().map(|channel| channel.name.to_string()).collect()
    };
    let mut found = Vec::new();
    for (part, header) in headers.iter().enumerate() {
        let names = names_of(header);
        let has = |prefix: &str, end: &str| names.contains(&format!("{prefix}{end}"));
        for name in &names {
            let of_layer = |end: char| {
                let prefix = name.strip_suffix(end)?;
                (prefix.is_empty() || prefix.ends_with('.')).then_some(prefix)
            };
            let (prefix, of) = match (of_layer('R'), of_layer('Y')) {
                (Some(prefix), _) if has(prefix, "G") && has(prefix, "B") => (prefix, ["R", "G", "B"]),
                (_, Some(prefix)) if has(prefix, "RY") || has(prefix, "BY") => {
                    return Err(not_read("with luminance and chroma"));
                }
                (_, Some(prefix)) => (prefix, ["Y"; 3]),
                // Whatever it is, it may be shown as grey.
                _ if names.len() == 1 => ("", [&**name; 3]),
                _ => continue,
            };
            found.push(Colours {
                part,
                names: of.map(|end| format!("{prefix}{end}")),
                alpha: has(prefix, "A").then(|| format!("{prefix}A")),
                are_several: false,
            });
        }
    }
    let are_several = found.len() > 1;
    let is_grey = |colours: &Colours| colours.names[0] == colours.names[1];
    found.sort_by_key(is_grey);
    match found.into_iter().next() {
        Some(first) => Ok(Colours { are_several, ..first }),
        None => {
            let names: Vec<_> = headers.iter().flat_map(names_of).collect();
            let names: Vec<_> = names.iter().map(|name| format!("`{}`", text::abridged(name))).collect();
            let few: Vec<_> = names.iter().take(8).map(String::as_str).collect();
            Err(format!("it is an EXR without colours: its channels are {}", text::and(&few)))
        }
    }
}

/// Returns why the image reader does not read an OpenEXR image, if the file may be sound.
pub(super) fn reason_of(error: &ImageError) -> Option<String> {
    let ImageError::Decoding(error) = error else { return None };
    Some(reason(error.source()?.downcast_ref()?))
}

fn reason(error: &Error) -> String {
    match error {
        Error::NotSupported(what) if what.contains("subsampling") => not_read("with subsampled chroma"),
        Error::NotSupported(what) if what.contains("deep") => not_read("with deep data"),
        Error::NotSupported(what) if what.contains("compression") => {
            let name =
                what.rsplit(": ").next().unwrap_or_default().split_whitespace().next().unwrap_or_default();
            match what.contains(": ") {
                true => not_read(&format!("with the compression {}", name.to_uppercase())),
                false => not_read("with an unknown compression"),
            }
        }
        Error::NotSupported(_) => not_read("of a kind"),
        Error::Io(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => text::reason(error),
        _ => "it is corrupt".to_owned(),
    }
}

fn not_read(what: &str) -> String {
    format!("it is an EXR {what}, which is not read: save it with channels R, G and B, or as PNG")
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
        WritableImage,
    };
    use std::io::Cursor;

    /// Returns a file with these parts of 2 by 2 texels, each with channels and their first texel.
    fn file(parts: &[&[(&str, f32)]]) -> Vec<u8> {
        let layers = parts.iter().enumerate().map(|(index, channels)| {
            let list: SmallVec<_> = channels
                .iter()
                .map(|(name, value)| AnyChannel::new(*name, FlatSamples::F32(vec![*value, 0.25, 0.5, 0.75])))
                .collect();
            let name = LayerAttributes::named(&*format!("part {index}"));
            Layer::new((2, 2), name, Encoding::UNCOMPRESSED, AnyChannels::sort(list))
        });
        let layers: SmallVec<_> = layers.collect();
        let mut bytes = Cursor::new(Vec::new());
        let window = exr::prelude::IntegerBounds::from_dimensions((2, 2));
        let image = Image::from_layers(exr::prelude::ImageAttributes::new(window), layers);
        image.write().non_parallel().to_buffered(&mut bytes).expect("a file");
        bytes.into_inner()
    }

    fn first(parts: &[&[(&str, f32)]]) -> Result<([f32; 4], bool), String> {
        let (picture, are_several) = read(&mut Cursor::new(file(parts)), 1 << 20)?;
        let picture = picture.into_rgba32f();
        assert_eq!(picture.get_pixel(1, 1).0[0], 0.75);
        Ok((picture.get_pixel(0, 0).0, are_several))
    }

    #[test]
    fn grey_and_layers_are_read() {
        assert_eq!(first(&[&[("Y", 2.0)]]), Ok(([2.0, 2.0, 2.0, 1.0], false)));
        assert_eq!(first(&[&[("A", 0.5), ("Y", 2.0)]]), Ok(([2.0, 2.0, 2.0, 0.5], false)));
        let layered = [("left.B", 3.0), ("left.G", 2.0), ("left.R", 1.0), ("left.Z", 9.0), ("right.Y", 7.0)];
        assert_eq!(first(&[&layered]), Ok(([1.0, 2.0, 3.0, 1.0], true)));
        assert_eq!(first(&[&[("Z", 9.0)], &layered[..3]]), Ok(([1.0, 2.0, 3.0, 1.0], true)));
        assert_eq!(first(&[&[("Z", 9.0)]]), Ok(([9.0, 9.0, 9.0, 1.0], false)));
    }

    #[test]
    fn what_has_no_colours_or_takes_too_much_memory_is_named() {
        let said = first(&[&[("u", 1.0), ("v", 1.0)]]).expect_err("no colours");
        assert_eq!(said, "it is an EXR without colours: its channels are `u` and `v`");
        let said = first(&[&[("BY", 1.0), ("RY", 1.0), ("Y", 1.0)]]).expect_err("chroma");
        assert!(said.starts_with("it is an EXR with luminance and chroma, which is not read: "), "{said}");
        let said = read(&mut Cursor::new(file(&[&[("Y", 2.0)]])), 9).expect_err("too much");
        assert_eq!(said, "it takes more than 9 B of memory");
    }
}
