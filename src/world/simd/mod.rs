//! Kernels, compiled for each level of instructions, and the arrays that they work on.

pub mod cpu;
pub mod soa;

pub use cpu::Cpu;
pub use soa::Vectors;
