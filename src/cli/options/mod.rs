//! Options that several commands have.

pub mod cpu;
pub mod frames;
pub mod keep;
pub mod max_error;
pub mod method;
pub mod named;
pub mod number;
pub mod print;
pub mod samples;
pub mod scene;
pub mod set;
pub mod size;
pub mod stop;
pub mod threads;
