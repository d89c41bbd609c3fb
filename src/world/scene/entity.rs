//! Entity types, which plugins register, and the arguments of their constructors.

pub use crate::scene::setting::{Refusal, Setting};

use crate::accuracy::Accuracy;
use crate::background::AnyBackground;
use crate::body::{AnyLight, Body, ShaderFactory};
use crate::lamp::Lamp;
use crate::material::Material;
use crate::rules::{Fading, Rules};
use crate::scene::attribute::Attribute;
use crate::scene::common::{
    ACCURACY, ALPHA, AT, BACKGROUND, BOUNCES, EXPOSURE, FALLOFF, FILM, LIGHT, LIGHTS, MATERIAL,
    MATERIAL_OF_ALL, OBJECT, OF_OBJECTS, PIXELDIM, RULES, SAMPLES, SHADER, TONE, TRANSFER,
};
use crate::scene::counts::OneOf;
use crate::scene::kind::Kind;
use crate::scene::pparm::{AttributeValue, Attributes, Row, Table};
use crate::scene::value::{Datum, Type};
use crate::sensor::{AnyCamera, Sensor};
use crate::text;
use crate::texture::Texture;
use std::ops::Deref;
use std::panic::Location;
use std::sync::Arc;
use std::{fmt, iter};

/// An entity type of the scene language: a name, a table of attributes and a constructor.
///
/// A plugin registers one with `inventory::submit!`.
pub struct Entity {
    /// The name in the scene language.
    pub name: &'static str,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// Other names that a scene may use.
    pub aliases: &'static [&'static str],
    /// The words by which other programs call the type, in lower case. Messages about these words suggest the type.
    pub known_as: &'static [&'static str],
    /// Makes the entity from its checked values.
    pub construct: Construct,
    /// The name that the notes' dump prints.
    pub dump_name: &'static str,
    /// The numbers that the notes give a shader on planes and on spheres.
    pub numbers: [Option<i64>; 2],
    tables: &'static [Table],
    /// The attributes that it has before and after those of its tables.
    common: [Table; 2],
    pub(crate) place: &'static Location<'static>,
}

inventory::collect!(Entity);

impl fmt::Debug for Entity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` of {}", self.name, self.place())
    }
}

/// The constructor of an entity type, by kind.
#[derive(Clone, Copy)]
pub enum Construct {
    /// Makes a camera.
    Camera(fn(&Args) -> Result<AnyCamera, Refusal>),
    /// Makes a material.
    Material(fn(&Args) -> Result<Material, Refusal>),
    /// Makes a texture.
    Texture(fn(&Args) -> Result<Texture, Refusal>),
    /// Makes a shader, which objects name.
    Shader(fn(&Args) -> Result<ShaderFactory, Refusal>),
    /// Makes an object's shape and, if it has one, its shader.
    Object(fn(&Args) -> Result<Body, Refusal>),
    /// Makes a light.
    Light(fn(&Args) -> Result<AnyLight, Refusal>),
    /// Makes a background.
    Background(fn(&Args) -> Result<AnyBackground, Refusal>),
}

/// Writes the functions that describe entity types. Each is given by the kind of its constructor and the type that the
/// constructor makes.
macro_rules! entity_types {
    ($($(#[$doc:meta])* $name:ident: $Kind:ident($Made:ty);)*) => {$(
        $(#[$doc])*
        #[track_caller]
        pub const fn $name(
            name: &'static str,
            meaning: &'static str,
            tables: &'static [Table],
            construct: fn(&Args) -> Result<$Made, Refusal>,
        ) -> Self {
            Self::new(name, meaning, tables, Construct::$Kind(construct))
        }
    )*};
}

impl Entity {
    entity_types! {
        /// Describes a camera type. The attributes of every camera are added to its table: `pixeldim` before its own,
        /// and those from `samples` on after them.
        camera: Camera(AnyCamera);
        /// Describes a material type.
        material: Material(Material);
        /// Describes a texture type.
        texture: Texture(Texture);
        /// Describes a type of shader.
        shader: Shader(ShaderFactory);
        /// Describes a shape. The attributes `material` and `shader` are added to its table.
        shape: Object(Body);
        /// Describes a light type. The attributes `falloff` and `at` are added to its table.
        light: Light(AnyLight);
        /// Describes a type of background. The attribute `lights` is added to its table.
        background: Background(AnyBackground);
    }

    /// Sets the number that the notes give a shader on planes.
    pub const fn on_plane(mut self, number: i64) -> Self {
        self.numbers[0] = Some(number);
        self
    }

    /// Sets the number that the notes give a shader on spheres.
    pub const fn on_sphere(mut self, number: i64) -> Self {
        self.numbers[1] = Some(number);
        self
    }

    /// Describes an object that is made of others. The optional attribute `material` is added to its table.
    #[track_caller]
    pub const fn of_objects(
        name: &'static str,
        meaning: &'static str,
        tables: &'static [Table],
        construct: fn(&Args) -> Result<Body, Refusal>,
    ) -> Self {
        Self { common: [OF_OBJECTS, &[]], ..Self::new(name, meaning, tables, Construct::Object(construct)) }
    }

    /// Takes the attributes `falloff` and `at` from a type of light whose distance changes nothing but the angle at
    /// which it is seen.
    pub const fn without_falloff(mut self) -> Self {
        self.common = [&[], &[]];
        self
    }

    #[track_caller]
    const fn new(
        name: &'static str,
        meaning: &'static str,
        tables: &'static [Table],
        construct: Construct,
    ) -> Self {
        let common: [Table; 2] = match construct {
            Construct::Camera(_) => FILM,
            Construct::Object(_) => [OBJECT, &[]],
            Construct::Light(_) => [&[], LIGHT],
            Construct::Background(_) => [&[], BACKGROUND],
            _ => [&[], &[]],
        };
        let (aliases, numbers, place): (&[&str], _, _) = (&[], [None; 2], Location::caller());
        let known_as = aliases;
        Self { name, meaning, aliases, known_as, construct, dump_name: name, numbers, tables, common, place }
    }

    /// Sets other names that a scene may use.
    pub const fn alias(mut self, aliases: &'static [&'static str]) -> Self {
        self.aliases = aliases;
        self
    }

    /// Sets other programs' words for the type, in lower case.
    pub const fn known_as(mut self, words: &'static [&'static str]) -> Self {
        self.known_as = words;
        self
    }

    /// Sets the name that the notes' dump prints, where it differs from the type's own.
    pub const fn dumped_as(mut self, name: &'static str) -> Self {
        self.dump_name = name;
        self
    }

    /// Returns the kind of entity that the constructor makes.
    pub fn kind(&self) -> Kind {
        match self.construct {
            Construct::Camera(_) => Kind::Camera,
            Construct::Material(_) => Kind::Material,
            Construct::Texture(_) => Kind::Texture,
            Construct::Shader(_) => Kind::Shader,
            Construct::Object(_) => Kind::Object,
            Construct::Light(_) => Kind::Light,
            Construct::Background(_) => Kind::Background,
        }
    }

    /// Returns the rows of the type's table, in the order of the dump.
    pub fn rows(&self) -> impl Iterator<Item = &'static dyn Row> + use<> {
        // The parts of a solid have shaders of their own.
        let has_own = |row: &&dyn Row| {
            row.attribute().is_some_and(|its| {
                let is_list_of_objects =
                    matches!(its.value_type(), Type::Name(Kind::Object)) && its.arity().most() > 1;
                its.name() == SHADER.name() || is_list_of_objects
            })
        };
        let takes_shader = self.kind() == Kind::Object && !self.tables.iter().copied().flatten().any(has_own);
        let shader = takes_shader.then_some(&SHADER as &'static dyn Row);
        let [first, last] = self.common;
        iter::once(first).chain(self.tables.iter().copied()).chain([last]).flatten().copied().chain(shader)
    }

    /// Returns the type's attributes, in the order of its table.
    pub fn attributes(&self) -> impl Iterator<Item = &'static dyn Attribute> + use<> {
        self.rows().filter_map(|row| row.attribute())
    }

    /// Tells whether an attribute takes the name of an entity of this kind.
    pub fn refers_to(&self, kind: Kind) -> bool {
        self.attributes().any(|attribute| match attribute.value_type() {
            Type::Name(named) => named == kind,
            Type::Choice(choices) => choices.kind == Some(kind),
            _ => false,
        })
    }

    /// Returns the groups of attributes from which a scene must give exactly one.
    pub fn groups(&self) -> impl Iterator<Item = &'static OneOf> + use<> {
        self.rows().filter_map(|row| row.one_of())
    }

    /// Tells whether a constructor reads files that the entity names.
    pub fn reads_files(&self) -> bool {
        self.attributes().any(|attribute| matches!(attribute.value_type(), Type::File))
    }

    /// Returns the file and line that register the type.
    pub fn place(&self) -> String {
        text::place(self.place)
    }
}

/// An entity of a scene as a constructor sees it: its type, its name and its checked values.
#[derive(Clone)]
pub struct Args {
    /// The entity's type.
    pub entity: &'static Entity,
    /// The entity's name.
    pub name: String,
    /// The entity's index among the scene's entities, in the order of the text, from 0.
    pub order: usize,
    /// The scene around the entity.
    pub setting: Arc<Setting>,
    /// Whether the entity is an object that others are made of, which is not seen itself.
    pub is_pattern: bool,
    attributes: Attributes,
}

impl Args {
    /// Makes the arguments of an entity. `values` holds one value for each attribute of the entity type, in table
    /// order.
    pub fn new(
        entity: &'static Entity,
        name: String,
        order: usize,
        values: Vec<AttributeValue>,
        setting: Arc<Setting>,
    ) -> Self {
        let attributes = Attributes::new((entity.name, entity.place), entity.attributes(), values);
        Self { entity, name, order, setting, is_pattern: false, attributes }
    }

    /// Makes the arguments of an entity whose attributes all have their defaults, as far as they have any.
    pub(crate) fn blank(entity: &'static Entity, setting: Arc<Setting>) -> Self {
        let values =
            entity.attributes().map(|attribute| (attribute.default().unwrap_or(Datum::Absent), false));
        Self::new(entity, String::new(), 0, values.collect(), setting)
    }

    /// Returns every attribute with its value and whether the scene gives it, in the order of the table.
    pub fn values_mut(&mut self) -> impl Iterator<Item = (&'static dyn Attribute, &mut Datum, &mut bool)> {
        self.attributes.values_mut()
    }

    /// Returns the accuracy with which the scene is traced.
    pub fn accuracy(&self) -> Accuracy {
        self.setting.camera.accuracy
    }

    /// Returns the z, in world units, beyond which planes are cut off by the scene's camera and its rules of light;
    /// `None` if they are not, and for an object that others are made of, whose coordinates are not the world's.
    pub fn planes_end_at(&self) -> Option<f64> {
        if self.is_pattern { None } else { self.setting.camera.planes_end_at() }
    }

    /// Returns the sensor of a camera with this entity's attributes, and with an accuracy and rules of light that
    /// override its own. With the notes' method the rules are the notes', too, unless the scene itself chooses both
    /// otherwise.
    pub fn sensor(&self, camera: AnyCamera, (accuracy, rules): (Option<Accuracy>, Option<Rules>)) -> Sensor {
        let is_classic = accuracy == Some(Accuracy::Classic);
        // The notes' command line has a default accuracy of its own.
        let own = || self.get_given(&ACCURACY).unwrap_or(self.accuracy());
        let accuracy = accuracy.unwrap_or_else(own);
        let rules = rules.unwrap_or_else(|| match self.get(&RULES) {
            Some(rules) if !is_classic => rules,
            None if accuracy != Accuracy::Classic => camera.rules(),
            _ => Rules::Notes,
        });
        let (exposure, tone, transfer, bounces) = match rules {
            Rules::Notes => Default::default(),
            Rules::Free => (self.get(&EXPOSURE), self.get(&TONE), self.get(&TRANSFER), self.get(&BOUNCES)),
        };
        Sensor {
            // The attributes' rules ensure that these casts are lossless.
            samples: self.get(&SAMPLES) as u32,
            accuracy,
            rules,
            exposure,
            tone,
            transfer,
            bounces: bounces as u32,
            alpha: self.get(&ALPHA),
            ..Sensor::new(camera, self.get(&PIXELDIM).map(|side| side as usize))
        }
    }

    /// Returns the lamp of a light with this entity's attributes.
    pub fn lamp(&self, light: AnyLight) -> Lamp {
        let fading = match self.find(FALLOFF.name()) {
            Some(_) => Fading { falloff: self.get(&FALLOFF), at: self.get(&AT) },
            None => Fading::NONE,
        };
        Lamp { light, fading }
    }

    /// Tells whether a background lights surfaces.
    pub fn lights(&self) -> bool {
        self.get(&LIGHTS)
    }

    /// Returns the names of a camera's attributes that the scene gives and only the free rules use.
    pub fn given_of_free_rules(&self) -> impl Iterator<Item = &'static str> {
        let names = [EXPOSURE.name(), TONE.name(), TRANSFER.name(), BOUNCES.name()];
        names.into_iter().filter(|name| self.given().any(|(attribute, _)| attribute.name() == *name))
    }

    /// Returns the material of an object.
    ///
    /// # Panics
    /// If the entity is not an object.
    #[track_caller]
    pub fn material(&self) -> Arc<Material> {
        self.get(&MATERIAL)
    }

    /// Returns the material that is given to an object made of others, if there is one.
    ///
    /// # Panics
    /// If the entity is not such an object.
    #[track_caller]
    pub fn material_of_all(&self) -> Option<Arc<Material>> {
        self.get(&MATERIAL_OF_ALL)
    }

    /// Tells whether the entity refers to an object that could not be made.
    pub fn refers_to_nothing(&self) -> bool {
        self.values().any(|(_, datum)| match datum {
            Datum::Object { body, .. } => body.get().is_none(),
            Datum::Objects(all) => all.iter().any(|(_, body)| body.get().is_none()),
            _ => false,
        })
    }

    /// Tells whether the attribute that a refusal marks is in the type's table. It is if the refusal marks none.
    pub fn has_what_is_refused(&self, refusal: &Refusal) -> bool {
        refusal.attribute.is_none_or(|attribute| self.find(attribute).is_some())
    }
}

/// Gives direct access to the entity's attributes.
impl Deref for Args {
    type Target = Attributes;

    fn deref(&self) -> &Attributes {
        &self.attributes
    }
}
