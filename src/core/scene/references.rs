//! What a scene refers to by name, as values of attributes.

use crate::scene::counts::Counts;
use crate::scene::kind::Kind;
use crate::scene::value::{Datum, Type, Value};
use crate::world::body::{NamedBody, Paint};
use crate::world::material::Material;
use crate::world::texture::Texture;
use std::sync::Arc;

/// A texture, which a scene refers to by its name.
impl Value for Arc<Texture> {
    const TYPE: Type = Type::Name(Kind::Texture);
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        Datum::Texture { name: Arc::from(""), texture: self.clone() }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Texture { texture, .. } => Some(texture.clone()),
            _ => None,
        }
    }
}

/// A material, which a scene refers to by its name.
impl Value for Arc<Material> {
    const TYPE: Type = Type::Name(Kind::Material);
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        Datum::Material { name: Arc::from(""), material: self.clone() }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Material { material, .. } => Some(material.clone()),
            _ => None,
        }
    }
}

/// An object, which a scene refers to by its name. It is seen only where entities that refer to it put it.
impl Value for NamedBody {
    const TYPE: Type = Type::Name(Kind::Object);
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        Datum::Object { name: Arc::from(""), body: self.clone() }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Object { body, .. } => Some(body.clone()),
            _ => None,
        }
    }
}

/// A shader, which a scene refers to by its name.
impl Value for Paint {
    const TYPE: Type = Type::Name(Kind::Shader);
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        Datum::Shader { name: Arc::from(""), paint: self.clone() }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Shader { paint, .. } => Some(paint.clone()),
            _ => None,
        }
    }
}
