//! The types of attribute values in the scene language.

use crate::body::{NamedBody, ShaderFactory};
use crate::material::{Material, Rgb};
use crate::scene::choice::{Choice, ChoiceName, Choices};
use crate::scene::counts::Counts;
use crate::scene::kind::Kind;
use crate::texture::Texture;
use glam::{DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;
use tabray_exact::formula::Formula;
use tabray_exact::formula::field::{CurveField, Field, PatchField, SurfaceField};
use tabray_exact::formula::variables::{CURVE, HEIGHT, PATCH, SPACE, SURFACE};

/// The names of the values of a colour. Editors show a swatch for an attribute whose values have these names.
pub const COLOUR: &[&str] = &["red", "green", "blue"];

/// The type of an attribute's values.
#[derive(Clone, Copy, Debug)]
pub enum Type {
    /// Whole numbers.
    Whole,
    /// Finite real numbers.
    Number,
    /// One word, which needs quotes where it contains white space or braces.
    Word,
    /// The name of a file, relative to the scene's folder, from which the entity is read.
    File,
    /// The name of an entity of this kind, which must be defined before it is used.
    Name(Kind),
    /// The name or the number of one of several alternatives.
    Choice(Choices),
    /// A formula in these variables.
    Formula(&'static [&'static str]),
    /// Yes or no.
    Truth,
    /// The angles of a rotation around x, then y, then z, in degrees, or an axis and the angle around it.
    Rotation,
}

/// The values of one attribute, checked for type, number and rule.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// Whole numbers, one or more.
    Whole(Vec<i64>),
    /// Real numbers, one or more, all finite.
    Numbers(Vec<f64>),
    /// One word.
    Word(String),
    /// A material and its name.
    Material {
        /// The name that the scene gives it.
        name: Arc<str>,
        /// The material of this name.
        material: Arc<Material>,
    },
    /// A texture and its name.
    Texture {
        /// The name that the scene gives it.
        name: Arc<str>,
        /// The texture of this name.
        texture: Arc<Texture>,
    },
    /// An object and its name.
    Object {
        /// The name that the scene gives it.
        name: Arc<str>,
        /// The body of the object of this name.
        body: NamedBody,
    },
    /// Objects and their names, each once.
    Objects(Vec<(Arc<str>, NamedBody)>),
    /// A shader and its name.
    Shader {
        /// The name that the scene gives it.
        name: Arc<str>,
        /// The shader of this name.
        paint: ShaderFactory,
    },
    /// One of several alternatives.
    Choice(ChoiceName),
    /// A formula.
    Formula(Arc<Formula>),
    /// Several formulas.
    Formulas(Vec<Arc<Formula>>),
    /// Yes or no.
    Truth(bool),
    /// No value, where an attribute may be left out.
    Absent,
}

impl Datum {
    /// Tells whether both are the same entity or alternative. `false` says nothing.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Material { name, material }, Self::Material { name: name2, material: material2 }) => {
                Arc::ptr_eq(name, name2) && Arc::ptr_eq(material, material2)
            }
            (Self::Texture { name, texture }, Self::Texture { name: name2, texture: texture2 }) => {
                Arc::ptr_eq(name, name2) && Arc::ptr_eq(texture, texture2)
            }
            (Self::Object { name, .. }, Self::Object { name: name2, .. })
            | (Self::Shader { name, .. }, Self::Shader { name: name2, .. }) => Arc::ptr_eq(name, name2),
            (Self::Choice(one), Self::Choice(other)) => one == other,
            _ => false,
        }
    }

    /// Writes the value's line in the notes' dump: a label, the values and the end of the line.
    pub fn line(&self, label: &str, ending: &str) -> String {
        let values = match self {
            Self::Whole(numbers) => numbers.iter().map(|number| format!(" {number:5}")).collect(),
            Self::Numbers(numbers) => numbers.iter().map(|number| format!(" {number:5.1}")).collect(),
            Self::Texture { name, .. } => format!(" {name:<15}"),
            Self::Choice(ChoiceName { number: Some(number), .. }) => format!(" {number:5}"),
            Self::Absent => return String::new(),
            Self::Formula(formula) => format!(" {formula}"),
            Self::Formulas(formulas) => formulas.iter().map(|formula| format!(" {formula}")).collect(),
            Self::Word(word) => format!(" {word}"),
            Self::Material { name, .. } | Self::Object { name, .. } | Self::Shader { name, .. } => {
                format!(" {name}")
            }
            Self::Choice(choice) => format!(" {}", choice.name),
            Self::Objects(all) => all.iter().map(|(name, _)| format!(" {name}")).collect(),
            Self::Truth(truth) => format!(" {}", yes_or_no(*truth)),
        };
        format!("{label:<12}{values}{ending}")
    }
}

/// A Rust type that a [`Pparm`](crate::scene::pparm::Pparm) can be a key for.
pub trait Value: Clone + Send + Sync + 'static {
    /// The type of the values in a scene.
    const TYPE: Type;
    /// The numbers of values from which a Rust value can be read.
    const ARITY: Counts;
    /// The names of its values in a row; empty where they have none.
    const EACH: &[&str] = &[];
    /// Converts a default to a datum.
    fn to_datum(&self) -> Datum;
    /// Converts a datum to a value, or returns `None` where the datum's type or its number of values does not fit.
    fn from_datum(datum: &Datum) -> Option<Self>;
}

/// Implements [`Value`] for a type of one word, given its [`Type`] and its conversions to a datum and from one.
macro_rules! one_word {
    ($(#[$doc:meta])* $Value:ty, $type:expr, $value:ident => $datum:expr, $($from:pat $(if $fits:expr)? => $to:expr),+) => {
        $(#[$doc])*
        impl $crate::scene::value::Value for $Value {
            const TYPE: $crate::scene::value::Type = $type;
            const ARITY: $crate::scene::counts::Counts = $crate::scene::counts::Counts::Of(&[1]);

            fn to_datum(&self) -> $crate::scene::value::Datum {
                let $value = self;
                $datum
            }

            fn from_datum(datum: &$crate::scene::value::Datum) -> Option<Self> {
                match datum {
                    $($from $(if $fits)? => $to,)+
                    _ => None,
                }
            }
        }
    };
}
pub(crate) use one_word;

/// Implements [`Value`] for a type, by its conversions to an array of numbers and from one.
macro_rules! of_array {
    ($Value:ty, $type:ident, $Array:ty, $names:expr, $value:ident => $array:expr, $from:expr) => {
        impl Value for $Value {
            const EACH: &[&str] = $names;
            const TYPE: Type = Type::$type;
            const ARITY: Counts = <$Array>::ARITY;

            fn to_datum(&self) -> Datum {
                let $value = *self;
                $array.to_datum()
            }

            fn from_datum(datum: &Datum) -> Option<Self> {
                <$Array>::from_datum(datum).map($from)
            }
        }
    };
}

of_array!(f64, Number, [f64; 1], &[], number => [number], |[number]| number);
of_array!(i64, Whole, [i64; 1], &[], number => [number], |[number]| number);
of_array!(DVec2, Number, [f64; 2], &[], vector => vector.to_array(), DVec2::from);
of_array!(DVec3, Number, [f64; 3], &["x", "y", "z"], vector => vector.to_array(), DVec3::from);

/// A number for each of red, green and blue, written as three numbers, or as one number where the three are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerChannel(pub Rgb);

impl Value for PerChannel {
    const EACH: &[&str] = COLOUR;
    const TYPE: Type = Type::Number;
    const ARITY: Counts = Counts::Of(&[1, 3]);

    fn to_datum(&self) -> Datum {
        let Self(Rgb { x, y, z }) = *self;
        Datum::Numbers(if x == y && y == z { vec![x] } else { vec![x, y, z] })
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        f64::from_datum(datum).map(Rgb::splat).or_else(|| Rgb::from_datum(datum)).map(Self)
    }
}

/// A whole number for each of red, green and blue, written as three numbers, or as one where the three are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholePerChannel(pub [i64; 3]);

impl Value for WholePerChannel {
    const TYPE: Type = Type::Whole;
    const ARITY: Counts = Counts::Of(&[1, 3]);

    fn to_datum(&self) -> Datum {
        let Self([red, green, blue]) = *self;
        Datum::Whole(if red == green && green == blue { vec![red] } else { vec![red, green, blue] })
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        i64::from_datum(datum).map(|each| [each; 3]).or_else(|| Value::from_datum(datum)).map(Self)
    }
}

/// Implements [`Value`] for arrays of numbers.
macro_rules! numbers {
    ($Number:ty, $type:ident, $datum:ident) => {
        impl<const N: usize> Value for [$Number; N] {
            const TYPE: Type = Type::$type;
            const ARITY: Counts = Counts::Of(&[N]);

            fn to_datum(&self) -> Datum {
                Datum::$datum(self.to_vec())
            }

            fn from_datum(datum: &Datum) -> Option<Self> {
                match datum {
                    Datum::$datum(numbers) => numbers.as_slice().try_into().ok(),
                    _ => None,
                }
            }
        }
    };
}

numbers!(f64, Number, Numbers);
numbers!(i64, Whole, Whole);

one_word!(String, Type::Word, word => Datum::Word(word.clone()), Datum::Word(word) => Some(word.clone()));

one_word!(
    /// The name of a file.
    PathBuf, Type::File,
    path => Datum::Word(path.display().to_string()),
    Datum::Word(path) => Some(path.into())
);

one_word!(
    /// A formula in y.
    Arc<Formula>, Type::Formula(HEIGHT),
    formula => Datum::Formula(formula.clone()),
    Datum::Formula(formula) if formula.variables() == HEIGHT => Some(formula.clone())
);

one_word!(
    /// A formula in x, y and z.
    Field, Type::Formula(SPACE),
    field => Datum::Formula(field.formula().clone()),
    Datum::Formula(formula) => Self::new(formula.clone())
);

one_word!(
    /// A formula in u and v.
    PatchField, Type::Formula(PATCH),
    field => Datum::Formula(field.formula().clone()),
    Datum::Formula(formula) => Self::new(formula.clone())
);

one_word!(
    /// A formula in t.
    CurveField, Type::Formula(CURVE),
    field => Datum::Formula(field.formula().clone()),
    Datum::Formula(formula) => Self::new(formula.clone())
);

one_word!(
    /// A formula of a surface.
    SurfaceField, Type::Formula(SURFACE),
    field => Datum::Formula(field.formula().clone()),
    Datum::Formula(formula) => Self::new(formula.clone())
);

/// A formula of a surface for each of red, green and blue, written as three formulas, or as one where the three are
/// equal.
impl Value for [SurfaceField; 3] {
    const TYPE: Type = Type::Formula(SURFACE);
    const ARITY: Counts = Counts::Of(&[1, 3]);

    fn to_datum(&self) -> Datum {
        Datum::Formulas(self.iter().map(|field| field.formula().clone()).collect())
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        let field = |formula: &Arc<Formula>| SurfaceField::new(formula.clone());
        match datum {
            Datum::Formula(formula) => Some([field(formula)?, field(formula)?, field(formula)?]),
            Datum::Formulas(formulas) => match &formulas[..] {
                [red, green, blue] => Some([field(red)?, field(green)?, field(blue)?]),
                _ => None,
            },
            _ => None,
        }
    }
}

one_word!(
    /// Yes or no.
    bool, Type::Truth, truth => Datum::Truth(*truth), Datum::Truth(truth) => Some(*truth)
);

/// Writes a truth as the notes' syntax does.
pub fn yes_or_no(truth: bool) -> &'static str {
    if truth { "yes" } else { "no" }
}

/// An attribute that may be left out.
impl<T: Value> Value for Option<T> {
    const TYPE: Type = T::TYPE;
    const ARITY: Counts = T::ARITY;
    const EACH: &[&str] = T::EACH;

    fn to_datum(&self) -> Datum {
        self.as_ref().map_or(Datum::Absent, T::to_datum)
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Absent => Some(None),
            datum => T::from_datum(datum).map(Some),
        }
    }
}

/// One of several alternatives, which a scene chooses by name or number.
impl<T: Choice> Value for T {
    const TYPE: Type = Type::Choice(Choices::of::<T>());
    const ARITY: Counts = Counts::Of(&[1]);

    fn to_datum(&self) -> Datum {
        Datum::Choice(self.option())
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Choice(chosen) => T::all().into_iter().find(|choice| choice.option().name == chosen.name),
            _ => None,
        }
    }
}
