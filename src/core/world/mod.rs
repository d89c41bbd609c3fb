//! What a scene is made of: the traits of shapes, shaders, lights, backgrounds and cameras, and the types in their
//! signatures.

pub(crate) mod accuracy;
pub(crate) mod any_shape;
pub(crate) mod background;
pub(crate) mod body;
pub(crate) mod camera;
pub mod certify;
pub mod coincidence;
pub(crate) mod film;
pub(crate) mod hittable;
pub(crate) mod interaction;
pub(crate) mod interface;
pub(crate) mod light;
pub(crate) mod light_samples;
pub(crate) mod material;
pub(crate) mod packets;
pub(crate) mod pinhole;
pub(crate) mod sample;
pub(crate) mod shader;
pub(crate) mod shape;
pub(crate) mod solid;
pub(crate) mod texture;

pub use accuracy::{Accuracy, Bounded, Classic, Draft, Exact, Marker, Strict};
pub use any_shape::AnyShape;
pub use background::{AnyBackground, Background};
pub use body::{AnyLight, AnyShader, Body, NamedBody, Paint, Part, Solid, Warning};
pub use camera::{Camera, Origins, Projected};
pub use film::{AnyCamera, Film};
pub use hittable::{Bracketed, Certified, Hittable, Searched};
pub use interface::{AnyInterface, Crossing, Interface};
pub use light::Light;
pub use material::{Material, Rgb};
pub use shader::{Anchor, PointBounds, Sees, Shader, SurfacePoint};
pub use shape::Shape;
