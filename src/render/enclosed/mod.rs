//! Enclosures of the colours of rays: the rules of light, evaluated in numbers that enclose.
//!
//! This is a second evaluation of a scene, separate from that of images. It shares with the tracer the rules, the
//! equations of shapes, and the plugins, in which shaders and lights enclose their own light. In [`Interval`]s, it
//! proves the colour that one ray returns; in [`Affine`] numbers, the mean of the colours of all rays through a
//! [footprint](super::footprint).
//!
//! It follows each hit, shadow ray, mirror and pane. Where a decision is open, such as which of two objects is seen,
//! the colour is enclosed for both outcomes; where nothing else is known, by the scene's brightness.
//!
//! [`Interval`]: tabray_exact::interval::Interval
//! [`Affine`]: tabray_exact::affine::Affine

mod emitted;
mod light;
mod media;
mod number;
mod panes;
mod rays;
mod round;
mod scene;
mod surface;
mod tangents;

pub use light::LightPoints;
pub use number::Enclosing;
pub use rays::{EnclosingTracer, Limits};
pub use scene::{Colour, EnclosedScene, SceneBounds};
