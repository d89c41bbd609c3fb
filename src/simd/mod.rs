//! Loops that are compiled for each level of instructions.

pub(crate) mod cpu;
pub(crate) mod soa;

pub use cpu::Cpu;
pub use soa::Vectors;
