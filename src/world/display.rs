//! From light to shown colours: exposure, tone and transfer, and the rules that choose them.

use crate::material::Rgb;
use crate::rules::Rules;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// How light above white is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tone {
    /// Light above white is white.
    #[default]
    Clip,
    /// Light above white is compressed, and light far above white loses its hue: the Khronos PBR neutral tone mapper
    /// (Khronos Group, 2024).
    Neutral,
}

/// How light is encoded in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Transfer {
    /// By the curve of sRGB (IEC 61966-2-1).
    #[default]
    Srgb,
    /// In proportion.
    Linear,
}

/// The light up to which the curve of sRGB is a line, and that line's slope.
const LINE: (f64, f64) = (0.003_130_8, 12.92);

impl Transfer {
    /// Encodes light from 0 to 1. The code grows with the light.
    pub fn encode(self, light: f64) -> f64 {
        match self {
            Self::Linear => light,
            Self::Srgb if light <= LINE.0 => LINE.1 * light,
            // The line ends 3e-8 above the curve.
            Self::Srgb => (1.055 * libm::pow(light, 1.0 / 2.4) - 0.055).max(LINE.0 * LINE.1),
        }
    }

    /// Returns the light that this code, from 0 to 1, stands for.
    pub fn decode(self, code: f64) -> f64 {
        match self {
            Self::Linear => code,
            Self::Srgb if code <= 0.040_45 => code / LINE.1,
            Self::Srgb => libm::pow((code + 0.055) / 1.055, 2.4),
        }
    }

    /// Bounds the slope of the code.
    fn steepest(self) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::Srgb => LINE.1,
        }
    }
}

/// The most that the tone mapper subtracts from all channels, and the value above which it compresses the brightest
/// channel.
const TOE: f64 = 0.04;
const SHOULDER: f64 = 0.8 - TOE;
/// How quickly colours turn white beyond.
const DESATURATION: f64 = 0.15;

/// Returns the amount that the neutral tone mapper subtracts from all channels, given the least channel.
fn offset(least: f64) -> f64 {
    if least < 2.0 * TOE { least - 6.25 * least * least } else { TOE }
}

/// Returns the compressed peak of a colour, and the degree to which the colour turns white.
fn compressed(peak: f64) -> (f64, f64) {
    if peak < SHOULDER {
        return (peak, 0.0);
    }
    let room = 1.0 - SHOULDER;
    let new = 1.0 - room * room / (peak + room - SHOULDER);
    (new, 1.0 - 1.0 / (DESATURATION * (peak - new) + 1.0))
}

/// Applies the neutral tone mapper to light that is finite and not below 0.
fn neutral(light: Rgb) -> Rgb {
    let light = light - offset(light.min_element());
    let peak = light.max_element();
    if peak < SHOULDER {
        return light;
    }
    let (new, white) = compressed(peak);
    (light * (new / peak)).lerp(Rgb::splat(new), white)
}

/// Bounds the results of the neutral tone mapper for light between these bounds, which are finite and not below 0. A
/// channel may fall where another one grows.
fn neutral_within([low, high]: [Rgb; 2]) -> [Rgb; 2] {
    let [least, most] = [offset(low.min_element()), offset(high.min_element())];
    let (low, high) = ((low - most).max(Rgb::ZERO), (high - least).max(Rgb::ZERO));
    let [dark, bright] = [low.max_element(), high.max_element()];
    let ([new_dark, new_bright], [hue, white]) = {
        let (one, other) = (compressed(dark), compressed(bright));
        ([one.0, other.0], [one.1, other.1])
    };
    // The factor falls as the peak grows.
    let factor = |new: f64, peak: f64| if peak > 0.0 { new / peak } else { 1.0 };
    let (down, up) = (low * factor(new_bright, bright), high * factor(new_dark, dark));
    let up = up.min(Rgb::splat(new_bright));
    let at = |light: Rgb, new: f64| [light.lerp(Rgb::splat(new), hue), light.lerp(Rgb::splat(new), white)];
    let ([one, other], [three, four]) = (at(down, new_dark), at(up, new_bright));
    [one.min(other), three.max(four)]
}

/// How the light of a scene is shown in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    rules: Rules,
    /// The factor of all light.
    gain: f64,
    tone: Tone,
    transfer: Transfer,
}

/// The least light of each byte but 0.
static SRGB: LazyLock<[f64; 255]> = LazyLock::new(|| {
    std::array::from_fn(|index| {
        let (level, shows) = (index as f64 + 0.5, |light: f64| 255.0 * Transfer::Srgb.encode(light));
        let mut least = Transfer::Srgb.decode(level / 255.0);
        while shows(least) < level {
            least = least.next_up();
        }
        while shows(least.next_down()) >= level {
            least = least.next_down();
        }
        least
    })
});

/// The number of leading bits of a channel that tell its cell: those of its exponent, and 7 of its mantissa.
const CELL_BITS: u32 = 64 - 52 + 7;

/// For each cell from that of the least light of byte 1 to that of white, the byte of its least light. A cell spans less
/// than 1/128 of its light, and so at most one step of the bytes.
static CELLS: LazyLock<(u64, Vec<u8>)> = LazyLock::new(|| {
    let (first, last) = (cell(SRGB[0]), cell(1.0));
    let byte = |cell: u64| {
        let light = f64::from_bits(cell << (64 - CELL_BITS));
        SRGB.partition_point(|least| *least <= light) as u8
    };
    (first, (first..=last).map(byte).collect())
});

/// Returns the cell of a channel that is not below 0.
fn cell(channel: f64) -> u64 {
    channel.to_bits() >> (64 - CELL_BITS)
}

/// The slope of the curve of sRGB at the least light of each byte.
static STEEPEST: LazyLock<[f64; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| match byte.checked_sub(1).map(|index| SRGB[index]) {
        Some(light) if light > LINE.0 => 1.055 / 2.4 * libm::pow(light, 1.0 / 2.4 - 1.0),
        _ => LINE.1,
    })
});

/// Returns the byte of light under sRGB. The light is finite and not below 0.
fn srgb_byte(light: f64) -> u8 {
    let (first, bytes) = &*CELLS;
    let Some(index) = cell(light).checked_sub(*first) else { return 0 };
    let byte = bytes.get(index as usize).copied().unwrap_or(u8::MAX);
    let is_next = SRGB.get(usize::from(byte)).is_some_and(|least| *least <= light);
    byte + u8::from(is_next)
}

impl Display {
    /// Shows numbers from 0 to 1 as they are, as for alpha.
    pub const LINEAR: Self =
        Self { rules: Rules::Notes, gain: 1.0, tone: Tone::Clip, transfer: Transfer::Linear };

    /// Returns the rules of light by which the image is computed.
    pub fn rules(&self) -> Rules {
        self.rules
    }

    /// Describes how light is shown by these rules, with an exposure in stops. The notes' rules know neither tone nor
    /// transfer.
    pub fn new(rules: Rules, exposure: f64, tone: Tone, transfer: Transfer) -> Self {
        let (tone, transfer) = match rules {
            Rules::Notes => (Tone::Clip, Transfer::Linear),
            Rules::Free => (tone, transfer),
        };
        Self { rules, gain: libm::exp2(exposure), tone, transfer }
    }

    /// Returns the factor of all light where an image shows it in proportion up to white, and truncates it to bytes.
    pub fn truncates(&self) -> Option<f64> {
        (self.rules == Rules::Notes).then_some(self.gain)
    }

    /// Returns the factor of all light.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// Returns the light for a file of full range: under the notes' rules after exposure, and under the free rules
    /// before any step that is made for images.
    pub fn full_range(&self, light: Rgb) -> Rgb {
        match self.rules {
            Rules::Notes if self.gain != 1.0 => self.gain * light,
            _ => light,
        }
    }

    /// Bounds the change of any channel of the shown colour, as a multiple of the change of light.
    pub fn steepest(&self) -> f64 {
        // The tone mapper subtracts the toe, which depends on the least channel, scales all channels by the
        // brightest, and whitens by less than a sixth: at most 2 * 2.15.
        let tone = if self.tone == Tone::Clip { 1.0 } else { 5.0 };
        self.gain * tone * self.transfer.steepest()
    }

    /// Returns light after exposure and tone: finite, and not below 0; a NaN as 0.
    fn toned(&self, light: Rgb) -> Rgb {
        let light = self.exposed(light);
        if self.tone == Tone::Clip { light } else { neutral(light) }
    }

    #[inline]
    fn exposed(&self, light: Rgb) -> Rgb {
        (self.gain * light).map(|channel| if channel > 0.0 { channel.min(f64::MAX) } else { 0.0 })
    }

    /// Returns light as an image shows it before it is rounded to bytes: each channel from 0 to 1, a NaN as 0.
    #[inline]
    pub fn shown(&self, light: Rgb) -> Rgb {
        match self.rules {
            Rules::Notes => self.exposed(light).min(Rgb::ONE),
            Rules::Free => self.encoded(self.toned(light)),
        }
    }

    fn encoded(&self, light: Rgb) -> Rgb {
        light.map(|channel| self.transfer.encode(channel.min(1.0)))
    }

    /// Bounds the displayed values of light between these bounds, before rounding.
    pub fn shown_within(&self, bounds: [Rgb; 2]) -> [Rgb; 2] {
        match self.tone {
            Tone::Clip => bounds.map(|light| self.shown(light)),
            Tone::Neutral => {
                neutral_within(bounds.map(|light| self.exposed(light))).map(|light| self.encoded(light))
            }
        }
    }

    /// Tells whether the shown colours of all light between these bounds are less than a distance apart. `false` where
    /// only the shown colours themselves would tell.
    pub fn are_within(&self, [low, high]: [Rgb; 2], distance: f64) -> bool {
        // The slope of the code falls as the light grows.
        let apart = |channel: usize| {
            let from = (self.gain * low[channel]).clamp(0.0, 1.0);
            let slope = match self.transfer {
                Transfer::Linear => 1.0,
                Transfer::Srgb => STEEPEST[usize::from(srgb_byte(from))],
            };
            slope * ((self.gain * high[channel]).min(1.0) - from)
        };
        // Rounding is far below a part in a hundred.
        self.tone == Tone::Clip && (0..3).all(|channel| apart(channel) < 0.99 * distance)
    }

    /// Returns light between two bounds whose shown colour is about midway between those of the bounds.
    pub fn middle(&self, [low, high]: [Rgb; 2]) -> Rgb {
        let gain = self.gain;
        let channel = |low: f64, high: f64| {
            let (below, above) = (low < 0.0, gain * high > 1.0);
            match (gain * low >= 1.0, high <= 0.0) {
                // All of a range above white is shown as white, and all of one below black as black.
                (true, _) if high.is_infinite() => low,
                (_, true) if low.is_infinite() => high,
                (false, false) if self.transfer != Transfer::Linear => {
                    let code = |light: f64| self.transfer.encode((gain * light).clamp(0.0, 1.0));
                    let middle = self.transfer.decode(0.5 * (code(low) + code(high))) / gain;
                    // Not `clamp`, which refuses what is no number: overflows give it.
                    middle.max(low).min(high)
                }
                (false, false) if below || above => 0.5 * (low.max(0.0) + high.min(1.0 / gain)),
                _ => 0.5 * (low + high),
            }
        };
        Rgb::from_array([0, 1, 2].map(|index| channel(low[index], high[index])))
    }

    /// Returns the bytes that show light.
    pub fn bytes(&self, light: Rgb) -> [u8; 3] {
        match self.rules {
            Rules::Notes => (self.gain * light).to_array().map(|channel| (255.0 * channel) as u8),
            Rules::Free => self.toned(light).to_array().map(|channel| self.byte(channel)),
        }
    }

    /// Returns the bytes that show premultiplied light where it is opaque, and the byte of its alpha. What is transparent
    /// is black.
    pub fn bytes_with_alpha(&self, light: Rgb, alpha: f64) -> [u8; 4] {
        let byte = (255.0 * alpha).round() as u8;
        let [red, green, blue] = if byte == 0 { [0; 3] } else { self.bytes(light / alpha) };
        [red, green, blue, byte]
    }

    /// Returns the light that a byte of a texture stands for, from 0 to 1. The image shows this light with the same
    /// byte, apart from exposure and tone. The notes divide by 256.
    pub fn light_of(&self, byte: u8) -> f64 {
        match self.rules {
            Rules::Notes => f64::from(byte) / 256.0,
            Rules::Free => self.transfer.decode(f64::from(byte) / 255.0),
        }
    }

    /// Returns the byte of a channel after exposure and tone, under the free rules.
    fn byte(&self, channel: f64) -> u8 {
        match self.transfer {
            Transfer::Linear => (255.0 * channel).round() as u8,
            Transfer::Srgb => srgb_byte(channel),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn free() -> [Display; 4] {
        let all = [
            (Tone::Clip, Transfer::Srgb),
            (Tone::Clip, Transfer::Linear),
            (Tone::Neutral, Transfer::Srgb),
            (Tone::Neutral, Transfer::Linear),
        ];
        all.map(|(tone, transfer)| Display::new(Rules::Free, 0.0, tone, transfer))
    }

    #[test]
    fn codes_are_those_of_the_standard() {
        // Bytes and their light, from tables of sRGB.
        for (byte, light) in [
            (0_u8, 0.0),
            (10, 0.003_035_27),
            (64, 0.051_269_46),
            (128, 0.215_860_5),
            (188, 0.502_886_5),
            (255, 1.0),
        ] {
            let code = f64::from(byte) / 255.0;
            assert!((Transfer::Srgb.decode(code) - light).abs() < 1e-6, "{byte}");
            assert_eq!(free()[0].bytes(Rgb::splat(light)), [byte; 3]);
        }
    }

    #[test]
    fn each_byte_is_that_of_its_own_light() {
        for byte in 0..=255_u8 {
            let code = f64::from(byte) / 255.0;
            assert_eq!(free()[0].bytes(Rgb::splat(Transfer::Srgb.decode(code))), [byte; 3]);
            assert_eq!(free()[1].bytes(Rgb::splat(code)), [byte; 3]);
        }
    }

    #[test]
    fn the_byte_of_a_cell_is_that_of_the_least_lights() {
        for least in *SRGB {
            for light in [least.next_down(), least, least.next_up(), 0.996 * least, 1.004 * least] {
                assert_eq!(srgb_byte(light), SRGB.partition_point(|least| *least <= light) as u8, "{light}");
            }
        }
        assert_eq!([0.0, 1e-300, 1.0, 2.0, f64::MAX].map(srgb_byte), [0, 0, 255, 255, 255]);
    }

    #[test]
    fn greys_of_the_tone_mapper_are_as_published() {
        // Below the toe, on the line, at the shoulder, and far beyond it.
        for (light, shown) in [(0.04, 0.01), (0.5, 0.46), (0.8, 0.76), (1.04, 0.88), (1e6, 1.0)] {
            let found = neutral(Rgb::splat(light));
            assert!((found - shown).abs().max_element() < 1e-6, "{light}: {found}");
        }
    }

    #[test]
    fn what_is_no_number_is_black_and_what_is_infinite_is_white() {
        for display in free() {
            assert_eq!(display.bytes(Rgb::NAN), [0; 3]);
            assert_eq!(display.bytes(Rgb::splat(f64::NEG_INFINITY)), [0; 3]);
            assert_eq!(display.bytes(Rgb::INFINITY), [255; 3]);
        }
    }

    fn light() -> impl Strategy<Value = Rgb> {
        prop::array::uniform3(prop_oneof![0.0..0.1, 0.0..2.0, 0.0..100.0]).prop_map(Rgb::from_array)
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn a_byte_is_the_rounded_level(light in light()) {
            for display in free() {
                let levels = 255.0 * display.shown(light);
                for (byte, level) in display.bytes(light).into_iter().zip(levels.to_array()) {
                    prop_assert!((f64::from(byte) - level).abs() <= 0.5 + 1e-12, "{byte} {level}");
                }
            }
        }

        #[test]
        fn bounds_of_light_bound_what_is_shown(one in light(), other in light(), part in prop::array::uniform3(0.0..=1.0)) {
            let (low, high) = (one.min(other), one.max(other));
            let inside = low + Rgb::from_array(part) * (high - low);
            for display in free() {
                let [least, most] = display.shown_within([low, high]);
                let shown = display.shown(inside);
                prop_assert!((shown - least).min_element() > -1e-14 && (most - shown).min_element() > -1e-14);
                let apart = (most - least).max_element();
                prop_assert!(!display.are_within([low, high], apart), "{low} {high}");
                let steepest = display.steepest() * (high - low).max_element();
                prop_assert!((display.shown(low) - shown).abs().max_element() <= steepest + 1e-12);
            }
        }
    }
}
