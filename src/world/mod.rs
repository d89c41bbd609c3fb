//! What a scene is made of: the traits of shapes, looks and lights, and what they are told.

pub mod accuracy;
pub mod any_shape;
pub mod body;
pub mod camera;
pub mod certify;
pub mod coincidence;
pub mod facing;
pub mod hittable;
pub mod landing;
pub mod light;
pub mod material;
pub(crate) mod packets;
pub mod sample;
pub mod shader;
pub mod shape;
pub mod texture;
