//! Loops that are compiled for each level of instructions.

pub mod cpu;
pub mod soa;
