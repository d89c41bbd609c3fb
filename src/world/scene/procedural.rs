//! Procedural shaders as values: an object names a shader of the scene, or a type of shader, which stands for a
//! shader with the type's defaults.

use crate::body::{Body, ShaderFactory};
use crate::scene::attribute::Attribute;
use crate::scene::choice::{Choice, ChoiceName, Choices};
use crate::scene::common::SHADER;
use crate::scene::counts::Counts;
use crate::scene::entity::{Args, Construct, Entity, Refusal};
use crate::scene::kind::Kind;
use crate::scene::value::{Datum, Type, Value};
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

/// Returns the shader of a type with its defaults; `None` where an attribute has no default.
pub fn of_type(name: &str) -> Option<&'static ShaderFactory> {
    static PAINTS: LazyLock<BTreeMap<&str, ShaderFactory>> = LazyLock::new(|| {
        let made = |entity: &'static Entity| {
            let Construct::Shader(construct) = entity.construct else { return None };
            let paint = construct(&Args::blank(entity, Arc::default())).ok()?;
            Some((entity.name, paint))
        };
        inventory::iter::<Entity>().filter(|entity| has_defaults(entity)).filter_map(made).collect()
    });
    PAINTS.get(name)
}

/// Returns the types of shader that objects can name.
pub fn types() -> impl Iterator<Item = &'static Entity> {
    inventory::iter::<Entity>().filter(|entity| has_defaults(entity))
}

/// Makes the body of an object, with the look of the shader that it names, and without the parts that its shader cuts
/// out.
///
/// # Errors
/// If the constructor refuses the object.
pub fn body(args: &Args, construct: fn(&Args) -> Result<Body, Refusal>) -> Result<Body, Refusal> {
    let body = construct(args)?;
    let paint = match args.find(SHADER.name()) {
        Some(Datum::Shader { paint, .. }) => Some(paint),
        Some(Datum::Choice(choice)) => of_type(choice.name),
        _ => None,
    };
    let body = match paint {
        Some(paint) => body.painted(paint),
        None => body,
    };
    Ok(body.cut_out())
}

fn has_defaults(entity: &Entity) -> bool {
    let is_shader = matches!(entity.construct, Construct::Shader(_));
    is_shader
        && entity.groups().next().is_none()
        && entity.attributes().all(|attribute| attribute.default().is_some())
}

/// A shader, chosen by its name or by its number: `ON` is 0 for numbers on planes, and 1 for numbers on spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum ByNumber<const ON: usize> {
    /// The shader that a scene chooses.
    ShaderFactory(ShaderFactory),
    /// The type of shader of this number, as a default.
    Number(i64),
}

/// A shader, chosen by its name or by its number on planes.
pub type OnPlane = ByNumber<0>;

/// A shader, chosen by its name or by its number on spheres.
pub type OnSphere = ByNumber<1>;

/// A type of shader as an alternative, with its number on planes or on spheres.
#[derive(Clone, Copy)]
pub struct ShaderType<const ON: usize>(pub &'static Entity);

impl<const ON: usize> Choice for ShaderType<ON> {
    const WHAT: &'static str = "shader";
    const KIND: Option<Kind> = Some(Kind::Shader);

    fn all() -> Vec<Self> {
        types().map(Self).collect()
    }

    fn option(&self) -> ChoiceName {
        let Entity { name, meaning, numbers, place, .. } = *self.0;
        ChoiceName { name, number: numbers[ON], meaning, place }
    }
}

impl<const ON: usize> Value for ByNumber<ON> {
    const TYPE: Type = Type::Choice(Choices::of::<ShaderType<ON>>());
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        match self {
            Self::ShaderFactory(paint) => paint.to_datum(),
            Self::Number(number) => {
                let mut types = ShaderType::<ON>::all().into_iter().map(|shader| shader.option());
                let numbered = types.find(|shader| shader.number == Some(*number));
                numbered.map_or(Datum::Absent, Datum::Choice)
            }
        }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Choice(choice) => of_type(choice.name).cloned().map(Self::ShaderFactory),
            datum => ShaderFactory::from_datum(datum).map(Self::ShaderFactory),
        }
    }
}
