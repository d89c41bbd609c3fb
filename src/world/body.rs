//! What an object's constructor returns.

use crate::world::any_shape::AnyShape;
use crate::world::material::Material;
use crate::world::packets::light::PacketLight;
use crate::world::packets::shader::PacketShader;
use crate::world::shader::{Plain, Shader};
use crate::world::solid::{Operation, Tree};
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Any [`Shader`]: `Box::new(shader)` makes one.
pub type AnyShader = Box<dyn PacketShader>;

/// Any [`Light`](crate::world::light::Light): `Box::new(light)` makes one.
pub type AnyLight = Box<dyn PacketLight>;

/// The body of a named object, for other entities that refer to it. It is empty until the object is made, and stays empty
/// where that is faulty.
#[derive(Clone, Default)]
pub struct NamedBody(Arc<OnceLock<Arc<Body>>>);

impl NamedBody {
    /// Returns the body, if the object is made.
    pub fn get(&self) -> Option<&Arc<Body>> {
        self.0.get()
    }

    /// Sets the body, once.
    pub(crate) fn set(&self, body: Body) {
        let _ = self.0.set(Arc::new(body));
    }
}

/// All are equal: their names tell them apart.
impl PartialEq for NamedBody {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl fmt::Debug for NamedBody {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("NamedBody")
    }
}

/// What an object's constructor returns: the object's shape and its shader.
pub struct Body {
    /// The object's geometry.
    pub shape: AnyShape,
    /// The object's reflectivities.
    pub shader: AnyShader,
    /// What the user should know of the object, although it can be rendered.
    pub warnings: Vec<Warning>,
    /// The memory that the object takes beside the scene, in bytes.
    pub bytes: u64,
    /// The number of objects that lie within each other in it: 1 for a copy of a shape, 2 for a copy of a copy.
    pub depth: u32,
    /// The name that the scene gives it, where others refer to it.
    pub name: Option<Arc<str>>,
    /// The material, where it is not that of the entity that the body is made for.
    pub material: Option<Arc<Material>>,
    /// The solid, if it is made of several parts.
    pub solid: Option<Solid>,
    /// The bodies that are seen together with this one.
    pub more: Vec<Body>,
}

/// A solid that is made of closed shapes.
#[derive(Clone)]
pub struct Solid {
    /// Its parts.
    pub parts: Vec<Part>,
    /// The parts that a point must lie in to lie in the solid.
    pub tree: Tree,
}

/// A part of a solid.
#[derive(Clone)]
pub struct Part {
    /// The name that the scene gives it.
    pub name: Arc<str>,
    /// The object; its shape is closed.
    pub body: Arc<Body>,
    /// The material.
    pub material: Arc<Material>,
}

impl Solid {
    /// Combines solids.
    pub fn combined(operation: Operation, of: impl IntoIterator<Item = Self>) -> Self {
        let (mut parts, mut trees) = (Vec::new(), Vec::new());
        for one in of {
            trees.push(one.tree.moved(parts.len()));
            parts.extend(one.parts);
        }
        Self { parts, tree: Tree::Combined(operation, trees) }
    }
}

/// A warning about an object.
#[derive(Clone, Debug)]
pub struct Warning {
    /// The attribute to mark.
    pub attribute: &'static str,
    /// What may not be as intended, phrased to follow the entity's name: "leaves out 3 faces".
    pub message: String,
    /// What would be right, or what happens otherwise.
    pub help: String,
}

impl Body {
    /// Makes an object whose reflectivities are its material's.
    pub fn plain(shape: impl Into<AnyShape>) -> Self {
        Self::shaded(shape, Plain)
    }

    /// Makes an object with a shader of its own.
    pub fn shaded(shape: impl Into<AnyShape>, shader: impl Shader + 'static) -> Self {
        Self {
            shape: shape.into(),
            shader: Box::new(shader),
            warnings: Vec::new(),
            bytes: 0,
            depth: 0,
            name: None,
            material: None,
            solid: None,
            more: Vec::new(),
        }
    }
}
