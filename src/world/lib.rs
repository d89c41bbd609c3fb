//! What a scene is made of: geometry, tables of entity types, the model, the traits of shapes, shaders, lights and cameras,
//! and proofs of hits.
//!
//! This is one of the three crates behind `tabray-core`, which has an overview of them all.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

// For the macros.
pub use glam;
pub use tabray_exact as exact;

pub mod accuracy;
pub mod any_shape;
pub mod background;
pub mod ball;
pub mod bent;
mod bmp_file;
pub mod body;
pub mod camera;
pub mod certify;
pub mod coat;
pub mod coincidence;
mod cutout;
pub mod directions;
pub mod display;
pub mod emitter;
mod exr_file;
pub mod files;
pub mod geometry;
pub mod hittable;
mod image_file;
pub mod interface;
pub mod lamp;
pub mod light;
pub mod luminous;
pub mod material;
pub mod memory;
pub mod number;
pub mod packets;
pub mod panel;
pub mod parallel;
pub mod patch;
pub mod pinhole;
pub mod repeated;
pub mod rules;
pub mod sample;
pub mod scene;
pub mod sensor;
pub mod shader;
pub mod simd;
pub mod sky_light;
pub mod sky_map;
pub mod solid;
mod sums;
pub mod surface_formula;
pub mod surface_point;
pub mod texels;
pub mod text;
pub mod texture;
mod whole_image;

pub use accuracy::{Accuracy, AccuracyTag, Classic, Draft, Exact, NotClassic, Strict};
pub use any_shape::AnyShape;
pub use background::{AnyBackground, Background};
pub use ball::Ball;
pub use bent::{Bend, Bent};
pub use body::{AnyLight, AnyShader, Body, NamedBody, Part, ShaderFactory, Solid, Warning};
pub use camera::{Camera, Origins, Projected};
pub use emitter::{Emitter, EmitterPoint, EnclosedEmitter, Extent};
pub use hittable::{Bracketed, Certified, Facts, Hittable, Shape, Sides};
pub use interface::{AnyInterface, Crossing, Interface, Law, Medium};
pub use light::Light;
pub use material::{Material, Rgb};
pub use panel::Panel;
pub use patch::Patch;
pub use rules::Rules;
pub use sensor::{AnyCamera, Sensor};
pub use shader::{Anchor, Shader};
pub use surface_point::{Point, ShaderInputs, SurfacePoint};

#[cfg(test)]
#[path = "../properties.rs"]
mod property_tests;
#[cfg(test)]
use property_tests::properties;
