//! Measurements of speed and accuracy: charts of the choices that a scene has, the cheapest choice for an error, speeds on
//! one core, and numbers of samples.

pub mod bench;
pub mod certain;
pub mod chart;
mod commands;
pub mod measuring;
pub mod sampling;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
