//! For those who compare images with what they should be: the mistakes in an image of a scene, the differences of two
//! images, and snapshots that wait for a decision.

mod diff;
mod explain;
#[cfg(feature = "fuzz")]
#[doc(hidden)]
#[path = "../../tests/fuzz/review.rs"]
pub mod fuzz;
mod grade;
pub mod grading;
mod report;
mod review;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
