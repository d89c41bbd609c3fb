//! A scene ready to be traced. It does not change during a render.

use crate::any_shape::AnyShape;
use crate::background::EnclosedBackground;
use crate::body::{AnyShader, Label, NamedBody, ShaderFactory};
use crate::geometry::ray::Side;
use crate::lamp::Lamp;
use crate::material::{Material, Reflectivity, Rgb};
use crate::scene::kind::Kind;
use crate::scene::store::Record;
use crate::scene::value::{Datum, Type};
use crate::sensor::Sensor;
use crate::surface_point::SurfacePoint;
use crate::texture::Texture;
use glam::DVec3;
use std::iter::repeat_n;
use std::path::PathBuf;
use std::ptr;
use std::sync::Arc;

/// Everything that an image depends on.
pub struct Model {
    /// The viewer and the image plane.
    pub camera: Item<Sensor>,
    /// The materials, in the order of the scene.
    pub materials: Vec<Item<Arc<Material>>>,
    /// The textures, in the order of the scene.
    pub textures: Vec<Item<Arc<Texture>>>,
    /// The shaders, in the order of the scene.
    pub shaders: Vec<Item<ShaderFactory>>,
    /// The visible objects, in the order of the scene, including visible lights.
    pub objects: Vec<Object>,
    /// The objects that other entities refer to, in the order of the scene. They are seen only where those entities
    /// put them.
    pub patterns: Vec<Item<NamedBody>>,
    /// The lights, in the order of the scene, and last the background, if it lights surfaces.
    pub lights: Vec<Item<Lamp>>,
    /// The colour of rays that hit nothing; black without a background.
    pub background: Option<Item<Arc<dyn EnclosedBackground>>>,
    /// The texts of objects, each with the order of its entity in the scene.
    pub labels: Vec<(usize, Label)>,
    /// The files that the scene names: those that it includes, and those of its entities.
    pub files: Vec<PathBuf>,
}

impl Model {
    /// Returns the entities of a kind as they were given, in the order of the scene.
    pub fn entities(&self, kind: Kind) -> Vec<&Record> {
        match kind {
            Kind::Camera => vec![&self.camera.args],
            Kind::Material => self.materials.iter().map(|item| &item.args).collect(),
            Kind::Texture => self.textures.iter().map(|item| &item.args).collect(),
            Kind::Shader => self.shaders.iter().map(|item| &item.args).collect(),
            Kind::Object => {
                let shown = self.objects.iter().map(|object| &object.args);
                let shown = shown.filter(|record| record.entity().kind() == Kind::Object);
                let mut all: Vec<_> = shown.chain(self.patterns.iter().map(|item| &item.args)).collect();
                all.sort_unstable_by_key(|record| record.order());
                // One object may appear as several.
                all.dedup_by_key(|record| record.order());
                all
            }
            Kind::Light => {
                let lights = self.lights.iter().map(|item| &item.args);
                lights.filter(|record| record.entity().kind() == Kind::Light).collect()
            }
            Kind::Background => self.background.iter().map(|item| &item.args).collect(),
        }
    }

    /// Returns for each object the number of its entity among those of all objects, from 0. A solid appears as several
    /// objects, which have one number.
    pub fn numbers(&self) -> Vec<usize> {
        let entities = self.objects.chunk_by(|one, other| one.args.order() == other.args.order());
        entities.enumerate().flat_map(|(number, of)| repeat_n(number, of.len())).collect()
    }

    /// Returns the objects that read files, in the order of the scene.
    pub fn from_files(&self) -> Vec<&Record> {
        if !self.camera.args.types().iter().any(|entity| entity.reads_files()) {
            return Vec::new();
        }
        self.entities(Kind::Object).into_iter().filter(|record| record.entity().reads_files()).collect()
    }

    /// Tells whether the fractions of light that objects let pass are all known to be from 0 to 1.
    pub fn tints_are_fractions(&self) -> bool {
        let is_fraction = |object: &Object| match object.shader.uniform(&object.material) {
            Some(look) => look.diffuse.min_element() >= 0.0,
            None => object.shader.brightest(&object.material).is_some(),
        };
        let mut glass = self.objects.iter().filter(|object| object.material.transparency != 0.0);
        glass.all(is_fraction)
    }
}

/// An entity of a scene: its attributes as they were given, and the value that the constructor made of them.
pub struct Item<T> {
    /// The entity's type, name and values.
    pub args: Record,
    /// The value that the constructor made.
    pub value: T,
}

/// A visible object.
pub struct Object {
    /// The object's type, name and values.
    pub args: Record,
    /// The object's material.
    pub material: Arc<Material>,
    /// The object's geometry.
    pub shape: AnyShape,
    /// The object's look.
    pub shader: AnyShader,
}

impl Object {
    /// Tells whether the object is a mirror that keeps sizes: a patch of a surface appears as large in it as at the end
    /// of a straight path of the same length.
    pub fn is_flat_mirror(&self) -> bool {
        let is_bent = self.shape.is_smooth() || self.shader.bends();
        self.shape.facts().plane.is_some() && !is_bent && self.material.roughness() == 0.0
    }

    /// Tells whether another object certainly has the same shape: the same type, and the same values except for
    /// material and shader. The answer is `false` for objects that may be made of others, such as solids, and for
    /// those read from files, such as meshes.
    pub fn is_shaped_as(&self, other: &Self) -> bool {
        let entity = self.args.entity();
        if !ptr::eq(entity, other.args.entity()) || entity.reads_files() {
            return false;
        }
        let (one, other) = (self.args.args(), other.args.args());
        one.values().zip(other.values()).all(|((attribute, one), (_, other))| match attribute.value_type() {
            Type::Name(Kind::Material | Kind::Shader) => true,
            Type::Name(Kind::Object) => *one == Datum::Absent && one == other,
            _ => one == other,
        })
    }

    /// Returns the point where a ray hits the surface on this side, with the properties that the shader sees.
    #[inline]
    pub fn surface_point(&self, position: DVec3, side: Side) -> SurfacePoint {
        let sees = self.shader.sees();
        if sees.is_position() {
            return SurfacePoint::at(position);
        }
        let outward = || {
            let normal = self.shape.normal(position);
            self.shape.shading_normal(position, normal)
        };
        let normal = if sees.normal { outward() } else { DVec3::ZERO };
        SurfacePoint::seen(&*self.shape, sees, position, normal, side)
    }

    /// Tells whether no light passes through the object.
    #[inline]
    pub fn is_opaque(&self) -> bool {
        self.material.transparency == 0.0 && !self.shader.covers_in_part()
    }

    /// Tells whether light that passes through the object may be bent.
    #[inline]
    pub fn bends_light(&self) -> bool {
        self.material.transparency != 0.0 && self.material.interface.is_some()
    }

    /// Returns the fraction of light that passes through on its way from a lamp at this point, for each channel: all
    /// where nothing is [covered](crate::shader::Shader::coverage), and the [tint](Self::tint) of what is.
    pub fn passed(&self, at: &SurfacePoint) -> Rgb {
        let tint = if self.material.transparency == 0.0 { Rgb::ZERO } else { self.tint(at) };
        if !self.shader.covers_in_part() {
            return tint;
        }
        let covered = self.shader.coverage_at(at);
        covered * tint + Rgb::splat(1.0 - covered)
    }

    /// Returns the fraction of light that passes through at this point, for each channel: transparency times the
    /// diffuse colour, scaled so that the strongest channel is 1. Glass without a diffuse colour is grey. The fraction
    /// is at most 1, and below 0 where the diffuse colour is below 0.
    #[inline]
    pub fn tint(&self, at: &SurfacePoint) -> Rgb {
        let diffuse = self.shader.colour_at(Reflectivity::Diffuse, &self.material, at);
        let strongest = diffuse.max_element();
        let colour = if strongest > 0.0 { diffuse / strongest } else { DVec3::ONE };
        self.material.transparency * colour
    }
}
