//! A scene ready to be traced. It does not change while a picture is made.

use crate::scene::entity::Args;
use crate::scene::kind::Kind;
use crate::world::any_shape::AnyShape;
use crate::world::body::{AnyLight, AnyShader};
use crate::world::camera::Camera;
use crate::world::material::{Material, Rgb};
use crate::world::texture::Texture;
use glam::DVec3;
use std::sync::Arc;

/// All that a picture is made from.
pub struct Model {
    /// The viewer and the screen.
    pub camera: Item<Camera>,
    /// The materials, in the order of the scene.
    pub materials: Vec<Item<Arc<Material>>>,
    /// The textures, in the order of the scene.
    pub textures: Vec<Item<Arc<Texture>>>,
    /// The visible objects, in the order of the scene.
    pub objects: Vec<Object>,
    /// The lights, in the order of the scene.
    pub lights: Vec<Item<AnyLight>>,
}

impl Model {
    /// The entities of a kind as they were given, in the order of the scene.
    pub fn entities(&self, kind: Kind) -> Vec<&Args> {
        match kind {
            Kind::Camera => vec![&self.camera.args],
            Kind::Material => self.materials.iter().map(|item| &item.args).collect(),
            Kind::Texture => self.textures.iter().map(|item| &item.args).collect(),
            Kind::Object => self.objects.iter().map(|object| &object.args).collect(),
            Kind::Light => self.lights.iter().map(|item| &item.args).collect(),
        }
    }
}

/// An entity of a scene: its attributes as given, and what its constructor made of them.
pub struct Item<T> {
    /// Type, name and values.
    pub args: Args,
    /// The thing itself.
    pub value: T,
}

/// A visible object.
pub struct Object {
    /// Type, name and values.
    pub args: Args,
    /// What it is made of.
    pub material: Arc<Material>,
    /// Where it is.
    pub shape: AnyShape,
    /// What it looks like.
    pub shader: AnyShader,
}

impl Object {
    /// How much it tints light of each channel that passes through: transparency times the diffuse colour,
    /// its strongest channel being 1. Glass without a diffuse colour is grey.
    pub fn tint(&self, at: DVec3) -> Rgb {
        let diffuse = self.shader.diffuse(&self.material, at);
        let strongest = diffuse.max_element();
        let colour = if strongest > 0.0 { diffuse / strongest } else { DVec3::ONE };
        self.material.transparency * colour
    }
}
