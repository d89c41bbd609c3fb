//! What a scene is made of: the traits of shapes, looks and lights, and what they are told.

pub(crate) mod accuracy;
pub(crate) mod body;
pub(crate) mod camera;
pub mod certify;
pub mod coincidence;
pub(crate) mod facing;
pub(crate) mod hittable;
pub(crate) mod landing;
pub(crate) mod light;
pub(crate) mod material;
pub(crate) mod sample;
pub(crate) mod shader;
pub(crate) mod texture;

pub use accuracy::Accuracy;
pub use body::Body;
pub use camera::Camera;
pub use hittable::Hittable;
pub use light::Light;
pub use material::{Material, Rgb};
pub use shader::Shader;
