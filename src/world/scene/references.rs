//! Entities that a scene refers to by name, as values of attributes.

use crate::body::{NamedBody, ShaderFactory};
use crate::material::Material;
use crate::scene::kind::Kind;
use crate::scene::value::{Datum, Type, one_word};
use crate::texture::Texture;
use std::sync::Arc;

one_word!(
    /// A texture, which a scene refers to by its name.
    Arc<Texture>, Type::Name(Kind::Texture),
    texture => Datum::Texture { name: Arc::from(""), texture: texture.clone() },
    Datum::Texture { texture, .. } => Some(texture.clone())
);

one_word!(
    /// A material, which a scene refers to by its name.
    Arc<Material>, Type::Name(Kind::Material),
    material => Datum::Material { name: Arc::from(""), material: material.clone() },
    Datum::Material { material, .. } => Some(material.clone())
);

one_word!(
    /// An object, which a scene refers to by its name. It is seen only where entities that refer to it put it.
    NamedBody, Type::Name(Kind::Object),
    body => Datum::Object { name: Arc::from(""), body: body.clone() },
    Datum::Object { body, .. } => Some(body.clone())
);

one_word!(
    /// A shader, which a scene refers to by its name.
    ShaderFactory, Type::Name(Kind::Shader),
    paint => Datum::Shader { name: Arc::from(""), paint: paint.clone() },
    Datum::Shader { paint, .. } => Some(paint.clone())
);
