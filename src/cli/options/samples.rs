//! `--samples`, `--max-error` and `--sampler`: how many samples the pixels of an image take, and where.

use super::max_error::{self, LEVELS, MaxError};
use crate::options::named::by_name;
use crate::options::threads;
use crate::process::failure::Failure;
use crate::process::messages;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::text::short;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::{Adaptive, Sensor};
use tabray_tools::sampling::raise::{Raised, raise};

/// The numbers of samples per pixel that `--max-error` chooses from, where `--samples` does not say.
const BY_ERROR: [u32; 2] = [4, 4096];

/// How many samples pixels take, and where.
#[derive(clap::Args)]
#[group(id = "how many samples")]
#[command(next_help_heading = "Samples")]
pub struct Args {
    /// The number of samples per pixel, to smooth edges; by default that of the scene's camera. With two powers of two,
    /// such as `4..64`, each pixel takes the first number of samples, and up to the second where its colour is less
    /// certain: at edges, in soft shadows and where objects are small
    #[arg(long, value_name = "N|MIN..MAX", value_parser = samples)]
    samples: Option<Samples>,
    /// Take as many samples in each pixel as it needs for this error, such as `2` (levels of 255) or `0.5%` (of white).
    /// The error is estimated, not proven: in the scenes of docs/accuracy.md, 98 to 100 % of the pixels kept the limit.
    /// Takes 4 to 4096 samples unless --samples gives other limits; at first more than 4 where the error of the image,
    /// measured on some pixels, would be larger
    #[arg(long, value_name = "LEVELS|PERCENT%", allow_negative_numbers = true)]
    max_error: Option<MaxError>,
    /// Prove the error of --max-error where possible. A pixel takes no samples if narrow bounds enclose its colour for
    /// all rays through it. The others take samples as without this option. The command prints the share of proven
    /// pixels, and a bound on the error of the others
    #[arg(long, requires = "max_error")]
    certain: bool,
    /// The distribution of the samples within a pixel
    #[arg(long, value_name = "NAME", default_value = "sobol", value_parser = by_name::<Sampler>())]
    sampler: Sampler,
}

/// Numbers of samples per pixel.
#[derive(Clone, Copy)]
enum Samples {
    /// The number for all pixels.
    Fixed(u32),
    /// The minimum and the maximum.
    From(u32, u32),
}

impl Args {
    /// Measures the error of a model's image, and raises the least number of samples where pixels that take few do not meet
    /// what others show. Says what was measured. Limits that are given stay, and so do pixels that are proven.
    pub fn raise(&self, model: &mut Model, threads: threads::Args, cpu: Cpu) -> Result<(), Failure> {
        let (Some(error), Some(adaptive)) = (self.max_error, model.camera.value.adaptive) else {
            return Ok(());
        };
        if self.certain || self.samples.is_some() {
            return Ok(());
        }
        let (mut plan, threads) = (Plan::new(model), threads.renderer()?.on(cpu));
        let Raised { least, error: measured, pixels } =
            raise(&mut plan, &threads, adaptive, error.of_white());
        let words = format!(
            "an error of {}, or at most {} with a confidence of 95 %, measured on {pixels} pixels with at least {least} samples",
            max_error::levels(measured.mean),
            short(LEVELS * measured.most)
        );
        if measured.most <= error.of_white() {
            messages::note(&format!("each pixel takes samples for at most {error}: {words}"));
        } else {
            messages::warning(&format!("no promise of at most {error}: {words}"), None);
        }
        model.camera.value.samples = least;
        Ok(())
    }

    /// Gives the camera the requested samples.
    pub fn apply(&self, camera: &mut Sensor) -> Result<(), Failure> {
        camera.sampler = self.sampler;
        let limits = match (self.samples, self.max_error) {
            (None, None) => return Ok(()),
            (Some(Samples::Fixed(samples)), None) => {
                camera.samples = samples;
                return Ok(());
            }
            (Some(Samples::Fixed(samples)), Some(_)) => {
                return Err(Failure::usage(format!(
                    "`--max-error` chooses the number of samples, and `--samples {samples}` fixes it"
                ))
                .help("give limits such as `--samples 4..1024`, or leave out one of the two"));
            }
            (Some(Samples::From(least, most)), _) => [least, most],
            (None, Some(_)) => BY_ERROR,
        };
        camera.samples = limits[0];
        camera.adaptive = Some(Adaptive { most: limits[1], error: self.max_error.map(MaxError::of_white) });
        camera.certain = self.certain;
        if camera.certain && camera.accuracy == Accuracy::Classic {
            return Err(Failure::usage(
                "`--certain` proves the true colours, but the classic method has colours of its own",
            )
            .help("leave out `--certain`, or give `--method exact`"));
        }
        if camera.certain && !camera.is_enclosed() {
            return Err(Failure::usage(
                "`--certain` needs a camera that says where all rays through a pixel lie",
            )
            .help("use a `camera`, a `look_at` or an `orthographic`, or leave out `--certain`"));
        }
        Ok(())
    }
}

fn samples(text: &str) -> Result<Samples, String> {
    let number = |text: &str| text.parse().ok().filter(|number| (1..=Sampler::MAX_SAMPLES).contains(number));
    let Some((least, most)) = text.split_once("..") else {
        return number(text).map(Samples::Fixed).ok_or_else(|| {
            format!("give a whole number from 1 to {}, or two as `4..64`", Sampler::MAX_SAMPLES)
        });
    };
    match (number(least), number(most)) {
        (Some(least), Some(most)) if least < most && least.is_power_of_two() && most.is_power_of_two() => {
            Ok(Samples::From(least, most))
        }
        (Some(least), Some(most)) if least < most => {
            let near = |number: u32| (number.next_power_of_two()).min(Sampler::MAX_SAMPLES);
            Err(format!("both must be powers of two, such as `{}..{}`", near(least), near(most)))
        }
        (Some(least), Some(most)) if least > most => {
            Err("the smaller number comes first, such as `4..64`".to_owned())
        }
        (Some(same), Some(_)) => Err(format!("for the same number in all pixels, give `{same}`")),
        _ => Err(format!("give two powers of two from 1 to {} as `4..64`", Sampler::MAX_SAMPLES)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_samples_are_two_powers_of_two() {
        assert!(matches!(samples("7"), Ok(Samples::Fixed(7))));
        assert!(matches!(samples("1..65536"), Ok(Samples::From(1, 65536))));
        for wrong in
            ["0", "65537", "", "..", "4..", "..4", "4..4", "64..4", "3..64", "4..65", "4..131072", "4...64"]
        {
            assert!(samples(wrong).is_err(), "{wrong}");
        }
    }
}
