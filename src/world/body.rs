//! What a constructor of an object makes.

use crate::world::any_shape::AnyShape;
use crate::world::packets::light::PacketLight;
use crate::world::packets::shader::PacketShader;
use crate::world::shader::{Plain, Shader};

/// Any [`Shader`]: `Box::new(shader)` makes one.
pub type AnyShader = Box<dyn PacketShader>;

/// Any [`Light`](crate::world::light::Light): `Box::new(light)` makes one.
pub type AnyLight = Box<dyn PacketLight>;

/// What the constructor of an object makes: its shape and its shader.
pub struct Body {
    /// Where it is.
    pub shape: AnyShape,
    /// What it looks like.
    pub shader: AnyShader,
}

impl Body {
    /// An object that looks like its material.
    pub fn plain(shape: impl Into<AnyShape>) -> Self {
        Self::shaded(shape, Plain)
    }

    /// An object with a look of its own.
    pub fn shaded(shape: impl Into<AnyShape>, shader: impl Shader + 'static) -> Self {
        Self { shape: shape.into(), shader: Box::new(shader) }
    }
}
