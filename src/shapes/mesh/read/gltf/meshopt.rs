//! Compressed buffer views of glTF: the extension EXT_meshopt_compression.
//!
//! Source: its specification, in the repository of glTF (Khronos), with the bitstreams of attributes (version 0), triangles
//! (version 1) and indices (version 1), and three filters.

use super::json::{CompressionFilter, CompressionMode, Meshopt};

/// The elements of a group of deltas.
const GROUP: usize = 16;

/// The bytes of a block of attributes, and its greatest number of elements.
const BLOCK: [usize; 2] = [8192, 256];

/// The least length of the end of attributes, in bytes.
const TAIL: usize = 32;

/// Bytes that are read one after the other.
struct Input<'b>(&'b [u8]);

impl<'b> Input<'b> {
    fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|byte| byte[0])
    }

    /// Reads a number of up to 32 bits, seven in a byte.
    fn number(&mut self) -> Option<u32> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 127) << shift;
            if byte < 128 {
                break;
            }
        }
        Some(number)
    }
}

/// Returns a number with its sign in the lowest bit as a difference.
fn signed(number: u32) -> u32 {
    number >> 1 ^ (number & 1).wrapping_neg()
}

/// Decodes a view from the bytes of its buffer. `most` limits its length, in bytes.
///
/// # Errors
/// Returns the reason why the view cannot be decoded.
pub fn decoded(view: &Meshopt, buffer: &[u8], most: u64) -> Result<Vec<u8>, String> {
    let Meshopt { byte_offset, byte_length, byte_stride: stride, count, .. } = *view;
    let length = count.checked_mul(stride).filter(|length| *length as u64 <= most);
    let length = length.ok_or("not enough memory for a compressed buffer view")?;
    let bytes = byte_offset.checked_add(byte_length).and_then(|end| buffer.get(byte_offset..end));
    let bytes = bytes.ok_or("a compressed buffer view reaches beyond the end of its buffer")?;
    let is_right = match view.mode {
        CompressionMode::Attributes => (4..=256).contains(&stride) && stride.is_multiple_of(4),
        CompressionMode::Triangles => matches!(stride, 2 | 4) && count.is_multiple_of(3),
        CompressionMode::Indices => matches!(stride, 2 | 4),
    };
    let broken = "a compressed buffer view is damaged";
    // A run of equal elements takes two bits for each group of 16 and for each byte.
    if !is_right || count > bytes.len().saturating_mul(64) {
        return Err(broken.to_owned());
    }
    let mut decoded = match view.mode {
        CompressionMode::Attributes => attributes(bytes, count, stride),
        CompressionMode::Triangles => triangles(bytes, count / 3).map(|all| packed(&all, stride)),
        CompressionMode::Indices => indices(bytes, count).map(|all| packed(&all, stride)),
    }
    .filter(|decoded| decoded.len() == length)
    .ok_or(broken)?;
    for element in decoded.chunks_exact_mut(stride) {
        match (view.filter, stride) {
            (CompressionFilter::None, _) => {}
            (CompressionFilter::Octahedral, 4) => octahedral::<1>(element),
            (CompressionFilter::Octahedral, 8) => octahedral::<2>(element),
            (CompressionFilter::Quaternion, 8) => quaternion(element),
            (CompressionFilter::Exponential, _) => exponential(element),
            _ => return Err(broken.to_owned()),
        }
    }
    Ok(decoded)
}

/// Returns indices as bytes of 2 or 4 each.
fn packed(indices: &[u32], stride: usize) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes().into_iter().take(stride)).collect()
}

/// Decodes elements: each byte of them by its differences from the same byte of the element before.
fn attributes(bytes: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let body = bytes.len().checked_sub(stride.max(TAIL))?;
    let mut last = bytes[bytes.len() - stride..].to_vec();
    let mut input = Input(&bytes[..body]);
    (input.byte()? == 0xa0).then_some(())?;
    let most = ((BLOCK[0] / stride) & !(GROUP - 1)).min(BLOCK[1]);
    let mut all = vec![0; count.checked_mul(stride)?];
    for block in all.chunks_mut(most * stride) {
        let groups = (block.len() / stride).div_ceil(GROUP);
        for at in 0..stride {
            let heads = input.take(groups.div_ceil(4))?;
            for group in 0..groups {
                let deltas = deltas(&mut input, heads[group / 4] >> (2 * (group % 4)) & 3)?;
                let elements = block[group * GROUP * stride..].chunks_exact_mut(stride);
                for (element, delta) in elements.zip(deltas) {
                    last[at] = last[at].wrapping_add(delta >> 1 ^ (delta & 1).wrapping_neg());
                    element[at] = last[at];
                }
            }
        }
    }
    Some(all)
}

/// Reads a group of differences: of 0, 2, 4 or 8 bits each, of which the greatest stands for a whole byte after them.
fn deltas(input: &mut Input, kind: u8) -> Option<[u8; GROUP]> {
    let mut deltas = [0; GROUP];
    let bits = match kind {
        0 => return Some(deltas),
        3 => return input.take(GROUP)?.try_into().ok(),
        kind => 2 * usize::from(kind),
    };
    let (packed, greatest) = (input.take(GROUP * bits / 8)?, (1_u8 << bits) - 1);
    for (index, delta) in deltas.iter_mut().enumerate() {
        let at = index * bits;
        let own = packed[at / 8] >> (8 - bits - at % 8) & greatest;
        *delta = if own == greatest { input.byte()? } else { own };
    }
    Some(deltas)
}

/// The last sixteen things, of which the newest is 0.
#[derive(Default)]
struct Last<T> {
    all: [T; 16],
    next: usize,
}

impl<T: Copy> Last<T> {
    fn push(&mut self, new: T) {
        self.all[self.next] = new;
        self.next = (self.next + 1) % 16;
    }

    fn get(&self, age: u8) -> T {
        self.all[(self.next + 15 - usize::from(age)) % 16]
    }
}

/// Decodes triangles: by an edge of one before, and by vertices that were met before, or follow the greatest one.
fn triangles(bytes: &[u8], count: usize) -> Option<Vec<u32>> {
    let (bytes, table) = bytes.split_at_checked(bytes.len().checked_sub(16)?)?;
    let mut input = Input(bytes);
    (input.byte()? == 0xe1).then_some(())?;
    let codes = input.take(count)?;
    let (mut edges, mut vertices) = (Last::<[u32; 2]>::default(), Last::<u32>::default());
    let (mut next, mut last) = (0_u32, 0_u32);
    let mut all = Vec::with_capacity(3 * count);
    let new = |next: &mut u32| {
        let own = *next;
        *next = next.wrapping_add(1);
        own
    };
    for code in codes {
        let (high, low) = (code >> 4, code & 15);
        let [a, b, c];
        if high < 15 {
            [a, b] = edges.get(high);
            c = match low {
                0 => new(&mut next),
                1..=12 => vertices.get(low),
                13 => {
                    last = last.wrapping_sub(1);
                    last
                }
                14 => {
                    last = last.wrapping_add(1);
                    last
                }
                _ => {
                    last = last.wrapping_add(signed(input.number()?));
                    last
                }
            };
            if !(1..=12).contains(&low) {
                vertices.push(c);
            }
            edges.push([c, b]);
            edges.push([a, c]);
        } else {
            let (aux, is_free) = match low {
                14 | 15 => (input.byte()?, true),
                low => (table[usize::from(low)], false),
            };
            if is_free && aux == 0 {
                next = 0;
            }
            // Vertices are counted before those of this triangle are kept.
            let known = |age: u8| vertices.get(age.wrapping_sub(1));
            let kinds = [if low == 15 { 15 } else { 0 }, aux >> 4, aux & 15];
            let mut corners = [0; 3];
            for (corner, kind) in corners.iter_mut().zip(kinds) {
                *corner = match kind {
                    0 => new(&mut next),
                    15 if is_free => 0,
                    kind => known(kind),
                };
            }
            for (corner, kind) in corners.iter_mut().zip(kinds) {
                if is_free && kind == 15 {
                    last = last.wrapping_add(signed(input.number()?));
                    *corner = last;
                }
            }
            for (corner, kind) in corners.iter().zip(kinds) {
                if kind == 0 || is_free && kind == 15 {
                    vertices.push(*corner);
                }
            }
            [a, b, c] = corners;
            edges.push([b, a]);
            edges.push([c, b]);
            edges.push([a, c]);
        }
        all.extend([a, b, c]);
    }
    Some(all)
}

/// Decodes indices, by their differences from one of two before.
fn indices(bytes: &[u8], count: usize) -> Option<Vec<u32>> {
    let mut input = Input(bytes.get(..bytes.len().checked_sub(4)?)?);
    (input.byte()? == 0xd1).then_some(())?;
    let mut last = [0_u32; 2];
    let mut next = || {
        let number = input.number()?;
        let of = &mut last[(number & 1) as usize];
        *of = of.wrapping_add(signed(number >> 1));
        Some(*of)
    };
    (0..count).map(|_| next()).collect()
}

/// Reads the numbers of an element, of `N` bytes each.
fn read<const N: usize>(element: &[u8]) -> [f64; 4] {
    std::array::from_fn(|at| match &element[at * N..][..N] {
        [byte] => f64::from(*byte as i8),
        bytes => f64::from(i16::from_le_bytes([bytes[0], bytes[1]])),
    })
}

fn write<const N: usize>(element: &mut [u8], at: usize, number: f64) {
    element[at * N..][..N].copy_from_slice(&(number.round() as i32).to_le_bytes()[..N]);
}

/// Makes a unit vector of its place on an octahedron.
fn octahedral<const N: usize>(element: &mut [u8]) {
    let [x, y, one, _] = read::<N>(element);
    let z = one - x.abs() - y.abs();
    let t = z.min(0.0);
    let [x, y] = [x, y].map(|along| along + if along >= 0.0 { t } else { -t });
    let greatest = f64::from((1_i32 << (8 * N - 1)) - 1);
    let scale = greatest / (x * x + y * y + z * z).sqrt().max(f64::MIN_POSITIVE);
    [x, y, z].into_iter().enumerate().for_each(|(at, along)| write::<N>(element, at, along * scale));
}

/// Makes a unit quaternion of three of its numbers; the fourth one gives their scale and the place of the greatest.
fn quaternion(element: &mut [u8]) {
    let own = read::<2>(element);
    let last = own[3] as i32;
    let scale = std::f64::consts::FRAC_1_SQRT_2 / f64::from(last | 3);
    let [x, y, z] = [own[0], own[1], own[2]].map(|part| part * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let place = (last & 3) as usize;
    for (at, part) in [w, x, y, z].into_iter().enumerate() {
        write::<2>(element, (place + at) % 4, part * 32767.0);
    }
}

/// Makes floats of 24 bits and an exponent.
fn exponential(element: &mut [u8]) {
    for number in element.as_chunks_mut::<4>().0 {
        let whole = i32::from_le_bytes(*number);
        let (mantissa, exponent) = (whole << 8 >> 8, whole >> 24);
        *number = (libm::ldexp(f64::from(mantissa), exponent) as f32).to_le_bytes();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(mode: CompressionMode, stride: usize, count: usize, length: usize) -> Meshopt {
        Meshopt { mode, byte_stride: stride, count, byte_length: length, ..Meshopt::default() }
    }

    /// The examples of the encoder's own tests (meshoptimizer, `tests.cpp`).
    #[test]
    fn the_encoders_examples_are_decoded() {
        let triangles = [
            0xe1, 0xf0, 0x10, 0xfe, 0xff, 0xf0, 0x0c, 0xff, 0x02, 0x02, 0x02, 0x00, 0x76, 0x87, 0x56, 0x67,
            0x78, 0xa9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00,
        ];
        let decoded_triangles =
            decoded(&view(CompressionMode::Triangles, 4, 12, triangles.len()), &triangles, 1 << 20);
        let expected = [0_u32, 1, 2, 2, 1, 3, 4, 6, 5, 7, 8, 9];
        assert_eq!(decoded_triangles, Ok(packed(&expected, 4)));
        let tricky = [
            0xe1, 0xf0, 0x10, 0xfe, 0x1f, 0x3d, 0x00, 0x0a, 0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9, 0x86,
            0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00,
        ];
        let decoded_tricky =
            decoded(&view(CompressionMode::Triangles, 2, 15, tricky.len()), &tricky, 1 << 20);
        let expected = [0_u32, 1, 2, 2, 1, 3, 0, 1, 2, 2, 1, 5, 2, 1, 4];
        assert_eq!(decoded_tricky, Ok(packed(&expected, 2)));
        let indices = [0xd1, 0x00, 0x04, 0xcd, 0x01, 0x04, 0x07, 0x98, 0x1f, 0x00, 0x00, 0x00, 0x00];
        let decoded_indices =
            decoded(&view(CompressionMode::Indices, 4, 6, indices.len()), &indices, 1 << 20);
        assert_eq!(decoded_indices, Ok(packed(&[0, 1, 51, 2, 49, 1000], 4)));
    }

    #[test]
    fn cut_and_damaged_views_are_refused_or_decoded() {
        let mut bytes: Vec<u8> = vec![0xa0];
        bytes.extend((0..400_u32).map(|index| ((index * 7919) >> 3) as u8));
        for mode in [CompressionMode::Attributes, CompressionMode::Triangles, CompressionMode::Indices] {
            bytes[0] = [0xa0, 0xe1, 0xd1][mode as usize];
            for length in 0..bytes.len() {
                let _ = decoded(&view(mode, 4, 36, length), &bytes, 1 << 20);
            }
        }
        assert!(
            decoded(&view(CompressionMode::Attributes, 4, usize::MAX / 4, 400), &bytes, 1 << 20).is_err()
        );
    }
}
