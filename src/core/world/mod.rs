//! What a scene is made of: the traits of shapes, shaders, lights, backgrounds and cameras, and the types in their
//! signatures.

pub mod accuracy;
pub mod any_shape;
pub mod background;
pub mod bent;
pub mod body;
pub mod camera;
pub mod certify;
pub mod coincidence;
pub mod display;
pub mod emitter;
pub mod hittable;
pub mod interface;
pub mod lamp;
pub mod light;
pub mod material;
pub mod packets;
pub mod panel;
pub mod patch;
pub mod pinhole;
mod repeated;
pub mod rules;
pub mod sample;
pub mod sensor;
pub mod shader;
pub mod sky_light;
pub mod solid;
mod sums;
pub mod texels;
pub mod texture;

pub use accuracy::{Accuracy, AccuracyTag, Bounded, Classic, Draft, Exact, Strict};
pub use any_shape::AnyShape;
pub use background::{AnyBackground, Background};
pub use bent::{Bend, Bent};
pub use body::{AnyLight, AnyShader, Body, NamedBody, Part, ShaderFactory, Solid, Warning};
pub use camera::{Camera, Origins, Projected};
pub use emitter::{Emitter, Extent, LightSample};
pub use hittable::{Bracketed, Certified, Facts, Hittable, Searched, Shape, Sides};
pub use interface::{AnyInterface, Crossing, Interface, Medium};
pub use light::Light;
pub use material::{Material, Rgb};
pub use panel::Panel;
pub use patch::Patch;
pub use rules::Rules;
pub use sensor::{AnyCamera, Sensor};
pub use shader::{Anchor, PointBounds, Shader, ShaderInputs, SurfacePoint};
