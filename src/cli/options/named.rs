//! Options that choose a value by its name, and what `--help` says of each value.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tabray_core::output::{Aov, Compression, Format};
use tabray_core::simd::cpu::Level;
use tabray_core::text::Named;
use tabray_core::world::sample::Sampler;
use tabray_lang::Syntax;
use tabray_tools::debug::LogLine;

/// A value that an option chooses.
pub trait Value: Named + Send + Sync {
    /// Returns what `--help` says of the value, if its name does not say it all.
    fn help(self) -> Option<&'static str>;
}

/// Makes a parser of the names of all values.
pub fn by_name<V: Value>() -> impl TypedValueParser<Value = V> {
    let shown = |value: &V| {
        let shown = PossibleValue::new(value.name());
        value.help().into_iter().fold(shown, PossibleValue::help)
    };
    let values = PossibleValuesParser::new(V::ALL.iter().map(shown));
    values.map(|name| V::of_name(&name).expect("only names of values are accepted"))
}

impl Value for Format {
    fn help(self) -> Option<&'static str> {
        None
    }
}

impl Value for Compression {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Fast => "Fastest",
            Self::Balanced => "Smaller files",
            Self::High => "Smallest files",
        })
    }
}

impl Value for Aov {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Depth => "Distance of the first hit: the nearer, the brighter",
            Self::Normal => "Surface normal: red, green and blue are x, y and z",
            Self::Object => "Object seen, each in its own colour",
            Self::Face => "Face of a mesh, a box, a prism or a polygon, each in its own colour",
            Self::Colour => "Colour, before it is clamped and rounded",
            Self::Cost => "Number of rays of a pixel",
            Self::Samples => "Number of samples of a pixel",
            Self::Error => {
                "Error of a pixel's colour, against four times its samples, at least 64, traced exactly"
            }
            Self::Undecided => "Pixels whose first hit could not be decided, in white; all others are black",
        })
    }
}

impl Value for Level {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Baseline => "What every machine has: SSE2 on x86-64",
            Self::Avx2 => "AVX2: four numbers at a time",
            Self::Avx512 => "AVX-512: eight numbers at a time",
        })
    }
}

impl Value for Sampler {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Sobol => "Evenly spread (a Sobol sequence)",
            Self::Random => "Random, as in the course notes",
        })
    }
}

impl Value for Syntax {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Notes => "The syntax of the course notes",
            Self::Toml => "TOML",
        })
    }
}

impl Value for LogLine {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Pix => "The pixel: its row and its column",
            Self::Hit => "What a ray hits, and where",
            Self::Drgb => "The colour of what it hits",
            Self::Irgb => "The pixel's bytes",
            Self::Offset => "The pixel's offset in the image file",
            Self::Find => "Each object that a ray finds, and its distance",
        })
    }
}
