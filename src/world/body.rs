//! What a constructor of an object makes.

use crate::world::hittable::Hittable;
use crate::world::shader::{Plain, Shader};

/// What the constructor of an object makes: its shape and its shader.
pub struct Body {
    /// Where it is.
    pub shape: Box<dyn Hittable>,
    /// What it looks like.
    pub shader: Box<dyn Shader>,
}

impl Body {
    /// An object that looks like its material.
    pub fn plain(shape: impl Hittable + 'static) -> Self {
        Self::shaded(shape, Plain)
    }

    /// An object with a look of its own.
    pub fn shaded(shape: impl Hittable + 'static, shader: impl Shader + 'static) -> Self {
        Self { shape: Box::new(shape), shader: Box::new(shader) }
    }
}
