//! The numbers behind an image, and the files that hold them.

use crate::output::full_range::FullRange;
use crate::output::npy;
use crate::output::picture::About;
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, SmallVec, WritableImage,
};
use std::io::{self, Cursor};
use tabray_world::named;

/// The numbers of an image's pixels, in rows from the top, each from the left.
pub enum Numbers {
    /// Three numbers for each pixel.
    Triples(Vec<f32>),
    /// The distance of the object that each pixel shows, in world units; infinite where nothing is hit.
    Distances(Vec<f64>),
    /// An index for each pixel, from 0.
    Indices {
        /// The noun for what is counted, which names the channel of an EXR.
        of: &'static str,
        /// The indices; `None` where there is nothing to count.
        indices: Vec<Option<u32>>,
    },
}

/// A format of files that hold numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    /// OpenEXR: three channels of f32, all of which a distance fills, or one of u32, where [`NONE`] stands for no
    /// index.
    Exr,
    /// A NumPy array of shape (height, width): f8, or i4, where -1 stands for no index. Triples have no such file.
    Npy,
}

named!(NumberFormat {
    Exr => "exr",
    Npy => "npy",
});

/// The number in an EXR that stands for no index.
pub const NONE: u32 = u32::MAX;

impl Numbers {
    /// Returns the file of the numbers of an image of this width and height.
    ///
    /// # Errors
    /// If the format cannot hold them.
    pub fn file(&self, format: NumberFormat, [width, height]: [usize; 2]) -> io::Result<Vec<u8>> {
        let mut file = Vec::new();
        let mut array = |descr| npy::begin(descr, &format!("({height}, {width})"), &mut file);
        match (format, self) {
            (NumberFormat::Exr, Self::Triples(numbers)) => {
                FullRange::Exr.write(&mut file, [width, height], numbers, &About::default())?;
            }
            (NumberFormat::Exr, Self::Distances(distances)) => {
                let numbers: Vec<_> = distances.iter().flat_map(|distance| [*distance as f32; 3]).collect();
                FullRange::Exr.write(&mut file, [width, height], &numbers, &About::default())?;
            }
            (NumberFormat::Exr, Self::Indices { of, indices }) => {
                let samples = indices.iter().map(|index| index.unwrap_or(NONE)).collect();
                file = channel(of, samples, [width, height])?;
            }
            (NumberFormat::Npy, Self::Triples(_)) => return Err(io::ErrorKind::InvalidInput.into()),
            (NumberFormat::Npy, Self::Distances(distances)) => {
                array("'<f8'")?;
                file.extend(distances.iter().flat_map(|distance| distance.to_le_bytes()));
            }
            (NumberFormat::Npy, Self::Indices { indices, .. }) => {
                array("'<i4'")?;
                let number = |index: &Option<u32>| index.map_or(-1, |index| index as i32);
                file.extend(indices.iter().flat_map(|index| number(index).to_le_bytes()));
            }
        }
        Ok(file)
    }
}

/// Returns an EXR with one channel of integers, which the image crate does not write.
fn channel(name: &str, samples: Vec<u32>, [width, height]: [usize; 2]) -> io::Result<Vec<u8>> {
    let channels = SmallVec::from_iter([AnyChannel::new(name, FlatSamples::U32(samples))]);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let attributes = LayerAttributes::default();
    let layer = Layer::new((width, height), attributes, encoding, AnyChannels::sort(channels));
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut file).map_err(io::Error::other)?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::read_first_flat_layer_from_file;
    use std::fs;

    #[test]
    fn an_exr_holds_each_index_as_a_whole_number() {
        // f32 has no number for the third.
        let indices = vec![Some(0), None, Some((1 << 24) + 1), Some(7), Some(8), Some(9)];
        let numbers = Numbers::Indices { of: "face", indices };
        let bytes = numbers.file(NumberFormat::Exr, [2, 3]).expect("a file");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.exr");
        fs::write(&path, &bytes).expect("a file");
        let read = read_first_flat_layer_from_file(&path).expect("an EXR").layer_data;
        assert_eq!((read.size.width(), read.size.height()), (2, 3));
        let [channel] = &read.channel_data.list[..] else { panic!("one channel") };
        assert_eq!(channel.name.to_string(), "face");
        let FlatSamples::U32(samples) = &channel.sample_data else { panic!("whole numbers") };
        assert_eq!(samples[..], [0, u32::MAX, (1 << 24) + 1, 7, 8, 9]);
    }

    #[test]
    fn an_array_holds_indices_and_distances_as_they_are() {
        let numbers = Numbers::Indices { of: "object", indices: vec![Some(3), None] };
        let array = numbers.file(NumberFormat::Npy, [2, 1]).expect("an array");
        assert!(array.ends_with(&[3, 0, 0, 0, 255, 255, 255, 255]));
        let numbers = Numbers::Distances(vec![0.1, f64::INFINITY]);
        let array = numbers.file(NumberFormat::Npy, [1, 2]).expect("an array");
        assert_eq!(array[array.len() - 16..], [0.1_f64.to_le_bytes(), f64::INFINITY.to_le_bytes()].concat());
        let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), }";
        assert!(array.starts_with(b"\x93NUMPY") && array[10..].starts_with(head.as_bytes()));
    }
}
