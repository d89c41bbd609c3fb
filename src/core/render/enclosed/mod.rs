//! The colours that rays return, by the rules of light in numbers that enclose them.
//!
//! This is a second evaluation of a scene, beside that of images, from the scene's numbers on. It shares with the
//! tracer the rules, the equations of shapes, and the plugins, in which shaders and lights enclose their own light. In
//! [`Interval`]s, it proves the colour that one ray returns; in [`Affine`] numbers, the mean of the colours of all rays
//! through a [footprint](super::footprint).
//!
//! It follows each hit, shadow ray, mirror and pane. Where a decision is open, such as which of two objects is seen, the
//! colour is anything that it would be either way; where nothing else is known, anything that the scene's brightness allows.
//!
//! [`Interval`]: tabray_exact::interval::Interval
//! [`Affine`]: tabray_exact::affine::Affine

mod crossing;
mod directions;
mod emitted;
mod facets;
mod light;
mod media;
mod number;
mod panes;
mod rays;
mod sampled;
mod scene;
mod surface;
mod tangents;

pub use light::LightPoints;
pub use number::{Endpoint, Number};
pub use rays::{EnclosingTracer, Limits};
pub use scene::{Colour, EnclosedScene, SceneBounds};
