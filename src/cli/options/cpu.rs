//! `--cpu`: the level of CPU instructions.

use crate::options::named::by_name;
use crate::process::failure::Failure;
use tabray_core::simd::cpu::{Cpu, Level};
use tabray_core::text::Named;

/// The level of CPU instructions.
#[derive(clap::Args)]
#[group(id = "instructions")]
#[command(next_help_heading = "Speed")]
pub struct Args {
    /// The highest level of CPU instructions to use, by default the highest that this machine has; the image does not
    /// depend on it
    #[arg(long, value_name = "NAME", value_parser = by_name::<Level>())]
    cpu: Option<Level>,
}

impl Args {
    /// Returns the level that is asked for, or the highest of this machine.
    pub fn cpu(&self) -> Result<Cpu, Failure> {
        let Some(level) = self.cpu else { return Ok(Cpu::best()) };
        Cpu::of(level).ok_or_else(|| {
            let here: Vec<_> = Cpu::all().map(|cpu| format!("`--cpu {cpu}`")).collect();
            Failure::usage(format!("this machine does not have the instructions of `{}`", level.name()))
                .help(format!("it has {}", here.join(", ")))
        })
    }
}
