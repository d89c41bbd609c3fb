//! The kinds of entity that a scene is made of.

use crate::text;
use serde::Serialize;
use std::fmt;

/// The kinds of entity that a scene is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The viewer and the image plane; a scene has one.
    Camera,
    /// How a surface reflects light.
    Material,
    /// An image that colours surfaces or light.
    Texture,
    /// A rule for the look of a surface.
    Shader,
    /// A shape and its material.
    Object,
    /// A source of light, which is itself not visible.
    Light,
    /// The colour of rays that hit nothing; a scene has at most one.
    Background,
}

impl Kind {
    /// Returns the kind with its article: `a light`, `an object`.
    pub fn with_article(self) -> String {
        text::with_article(&self.to_string())
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Kind::Camera => "camera",
            Kind::Material => "material",
            Kind::Texture => "texture",
            Kind::Shader => "shader",
            Kind::Object => "object",
            Kind::Light => "light",
            Kind::Background => "background",
        })
    }
}
