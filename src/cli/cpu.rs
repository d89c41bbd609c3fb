//! `--cpu`: which of the processor's instructions are used.

use super::failure::Failure;
use crate::simd::cpu::{Cpu, Level};

#[derive(clap::Args)]
#[group(id = "instructions")]
pub struct Args {
    /// The most of the processor's instructions that may be used for the picture, which is the same with any; by
    /// default all that this machine has
    #[arg(long, value_name = "NAME")]
    cpu: Option<CpuName>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum CpuName {
    /// What every machine has
    Baseline,
    /// AVX2: four numbers at a time
    Avx2,
    /// AVX-512: eight numbers at a time
    Avx512,
}

impl Args {
    /// What is asked for, or the best there is.
    pub fn cpu(&self) -> Result<Cpu, Failure> {
        let Some(name) = self.cpu else { return Ok(Cpu::best()) };
        let (level, name) = match name {
            CpuName::Baseline => (Level::Baseline, "baseline"),
            CpuName::Avx2 => (Level::Avx2, "AVX2"),
            CpuName::Avx512 => (Level::Avx512, "AVX-512"),
        };
        Cpu::of(level).ok_or_else(|| {
            let here: Vec<_> = Cpu::all().map(|cpu| format!("`--cpu {cpu}`")).collect();
            Failure::Usage(
                format!("this machine does not have {name} instructions"),
                Some(format!("it has {}", here.join(", "))),
            )
        })
    }
}
