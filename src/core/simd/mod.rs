//! Kernels, compiled for each level of instructions, and the arrays that they work on.

pub(crate) mod cpu;
pub(crate) mod soa;

pub use cpu::Cpu;
pub use soa::Vectors;
