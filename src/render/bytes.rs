//! Conversion of colours to bytes.

use tabray_exact::scalar::Scalar;
use tabray_world::display::Display;
use tabray_world::material::Rgb;
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::View;

/// Returns the level of a channel: 255 is white. A byte shows its integer part.
#[inline(always)]
pub fn level<N: Scalar>(channel: N) -> N {
    N::constant(255.0) * channel
}

/// Converts a channel to a byte: 1 and more becomes 255, 0 and less becomes 0, and values between are truncated, not
/// rounded. A NaN becomes 0.
pub fn to_byte(channel: f64) -> u8 {
    level(channel) as u8
}

/// Converts colours to the bytes that show them.
pub(crate) fn to_bytes(cpu: Cpu, display: &Display, colours: View, pixels: &mut [[u8; 3]]) {
    let Some(gain) = display.truncates() else {
        return to_bytes_of_runs(cpu, display, colours, pixels);
    };
    const CHUNK: usize = 64;
    let mut packed = [0; CHUNK];
    for (pixels, first) in pixels.chunks_mut(CHUNK).zip((0..).step_by(CHUNK)) {
        let packed = &mut packed[..pixels.len()];
        pack(cpu, gain, colours.part(first..first + pixels.len()), packed);
        let (eights, rest) = pixels.as_chunks_mut::<8>();
        let (packed, packed_rest) = packed.as_chunks::<8>();
        for (pixels, [a, b, c, d, e, f, g, h]) in eights.iter_mut().zip(packed) {
            // The 24 bytes of eight pixels are three numbers.
            let words =
                [a | b << 24 | c << 48, c >> 16 | d << 8 | e << 32 | f << 56, f >> 8 | g << 16 | h << 40];
            pixels.as_flattened_mut().copy_from_slice(words.map(u64::to_le_bytes).as_flattened());
        }
        for (pixel, packed) in rest.iter_mut().zip(packed_rest) {
            let [red, green, blue, ..] = packed.to_le_bytes();
            *pixel = [red, green, blue];
        }
    }
}

/// Converts premultiplied colours to the bytes that show them where they are opaque, and their alpha to bytes. What is
/// transparent is black.
pub(crate) fn to_bytes_with_alpha(
    display: &Display,
    (colours, alpha): (View, &[f64]),
    pixels: &mut [[u8; 3]],
    bytes: &mut [u8],
) {
    for (index, ((byte, pixel), alpha)) in bytes.iter_mut().zip(pixels).zip(alpha).enumerate() {
        let [red, green, blue, last] = display.bytes_with_alpha(colours.get(index), *alpha);
        (*pixel, *byte) = ([red, green, blue], last);
    }
}

/// The number of colours that are compared at once.
const RUN: usize = 16;

/// Converts colours to bytes one by one. Much of an image is of one colour, which is converted once.
fn to_bytes_of_runs(cpu: Cpu, display: &Display, colours: View, pixels: &mut [[u8; 3]]) {
    const RUNS: usize = 16;
    let mut last = None;
    let mut bytes_of = |colour: Rgb| match last {
        Some((same, bytes)) if same == colour => bytes,
        _ => {
            let bytes = display.bytes(colour);
            last = Some((colour, bytes));
            bytes
        }
    };
    let mut differ = [0; RUNS];
    for (pixels, first) in pixels.chunks_mut(RUN * RUNS).zip((0..).step_by(RUN * RUNS)) {
        let colours = colours.part(first..first + pixels.len());
        compare(cpu, colours, &mut differ[..pixels.len() / RUN]);
        for (run, (pixels, first)) in pixels.chunks_mut(RUN).zip((0..).step_by(RUN)).enumerate() {
            if pixels.len() == RUN && differ[run] == 0 {
                pixels.fill(bytes_of(colours.get(first)));
            } else {
                let colours = (first..).map(|index| colours.get(index));
                pixels.iter_mut().zip(colours).for_each(|(pixel, colour)| *pixel = bytes_of(colour));
            }
        }
    }
}

kernels! {
    /// Tells of each whole run of colours whether one differs from its first, as a NaN does: then a number is not 0.
    fn compare(colours: View, differ: &mut [u64]) {
        let View { x, y, z } = colours;
        let whole = RUN * differ.len();
        let runs = x[..whole].as_chunks::<RUN>().0.iter().zip(y[..whole].as_chunks::<RUN>().0);
        for (differ, ((x, y), z)) in differ.iter_mut().zip(runs.zip(z[..whole].as_chunks::<RUN>().0)) {
            let mut any = 0;
            for lane in 0..RUN {
                let is_same = (x[lane] == x[0]) & (y[lane] == y[0]) & (z[lane] == z[0]);
                any |= u64::from(!is_same);
            }
            *differ = any;
        }
    }
}

/// 2^52: adding it rounds a number from 0 to 255 to an integer, which then is the lowest bits of the sum.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// Returns a number whose lowest byte is the result of [`to_byte`], and whose next two bytes are 0. Its operations
/// have vector instructions; a conversion to a byte has none.
#[inline(always)]
fn quantized(channel: f64) -> u64 {
    let level = level(channel);
    let level = if level > 0.0 { level } else { 0.0 };
    let level = if level < 255.0 { level } else { 255.0 };
    let whole = level + WHOLE;
    let whole = if whole - WHOLE > level { whole - 1.0 } else { whole };
    whole.to_bits()
}

kernels! {
    /// Packs the bytes of each colour into a number, red lowest.
    fn pack(gain: f64, colours: View, packed: &mut [u64]) {
        let count = packed.len();
        let View { x, y, z } = colours;
        let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
        for lane in 0..count {
            let all =
                quantized(gain * x[lane]) | quantized(gain * y[lane]) << 8 | quantized(gain * z[lane]) << 16;
            packed[lane] = all & 0xff_ffff;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use std::iter;
    use tabray_world::display::{Tone, Transfer};
    use tabray_world::rules::Rules;

    #[test]
    fn many_channels_have_the_bytes_of_single_ones() {
        let notes = |stops: f64| Display::new(Rules::Notes, stops, Tone::Clip, Transfer::Linear);
        let extremes = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, -1e-300, 1e-300, 1.0, 1e300];
        let levels = (0..=256).map(|level| f64::from(level) / 255.0);
        let near = levels.flat_map(|level| [level.next_down(), level, level.next_up()]);
        // Whole runs of one colour, and those that begin or end in one.
        let even = [(0.0, 50), (f64::NAN, 20), (0.25, 39)];
        let even = even.into_iter().flat_map(|(channel, count)| iter::repeat_n(channel, count));
        let channel: Vec<f64> = extremes.into_iter().chain(even).chain(near).collect();
        for cpu in Cpu::all() {
            for display in
                [notes(0.0), notes(0.7), Display::new(Rules::Free, 0.7, Tone::Neutral, Transfer::Srgb)]
            {
                let mut pixels = vec![[1; 3]; channel.len()];
                to_bytes(cpu, &display, View { x: &channel, y: &channel, z: &channel }, &mut pixels);
                let single: Vec<_> =
                    channel.iter().map(|channel| display.bytes(DVec3::splat(*channel))).collect();
                assert_eq!(pixels, single);
            }
        }
    }
}
