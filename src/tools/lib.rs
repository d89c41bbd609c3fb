//! Tools that use a model for more than rendering: contracts, proofs, explanations, checkpoints and parts.

pub mod assumptions;
pub mod clock;
pub mod colours;
pub mod contract;
pub mod debug;
pub mod diagnosis;
pub mod identity;
pub mod off_surface;
pub mod overlay;
pub mod pixels;
pub mod probe;
pub mod sampling;
pub mod threads;
pub mod unchecked;
pub mod verify;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
