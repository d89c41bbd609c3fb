//! Draws values for attributes by their types and rules, the same in every run.

use glam::DVec3;
use image::RgbImage;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fs;
use std::mem::swap;
use std::path::Path;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::choice::Choices;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::{Datum, Type};
use tabray_exact::formula::variables::{CURVE, HEIGHT, PATCH};
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;
use tempfile::TempDir;

/// The maximum number of draws for a value that satisfies its rule.
const TRIES: usize = 1000;

/// An image for attributes that name one, in the folder of the drawn scenes.
const PICTURE: &str = "picture.png";

/// A triangle mesh for attributes that name a file, in the same folder: a tetrahedron, and a flap beside it.
const MODEL: &str = "model.obj";

/// The text of [`MODEL`].
const TETRAHEDRON: &str = "v 0 0 0\nv 2 0 0.5\nv 0.25 2 0\nv 0 0.5 2\nv 3 3 1\n
    f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 2 5 3\n";

const FORMULAS: [&str; 4] = ["2 + sin(y)", "1", "0.5 * y", "sqrt(abs(4 - y^2))"];

/// Formulas in x, y and z.
const FIELDS: [&str; 4] =
    ["x^2 + y^2 + z^2 - 4", "sin(x) + sin(y) + sin(z)", "x + 2*y - z", "max(abs(x), abs(y)) - 1 + z^2/4"];

/// Formulas of a curve's x, y and z in t. Formulas drawn one by one mostly have a place where the curve stands still.
const CURVE_FORMULAS: [&str; 3] = ["cos(t)", "0.2*t", "sin(t)"];

/// Formulas of a surface's x, y and z in u and v: most others have folds.
const PATCH_FORMULAS: [&str; 3] = ["(2 + cos(v))*cos(u)", "sin(v)", "(2 + cos(v))*sin(u)"];

/// The folder to which the drawn scenes' file names are relative.
pub struct SceneFolder(TempDir);

impl SceneFolder {
    pub fn new() -> Self {
        let scenes = Self(TempDir::new().expect("room for a temporary folder"));
        let colours = RgbImage::from_fn(5, 4, |x, y| [50 * x as u8, 60 * y as u8, 255].into());
        colours.save(scenes.folder().join(PICTURE)).expect("room for a picture");
        fs::write(scenes.folder().join(MODEL), TETRAHEDRON).expect("room for a mesh");
        scenes
    }

    pub fn folder(&self) -> &Path {
        self.0.path()
    }
}

/// The entity types to which the entities of drawn scenes refer.
pub struct StandIns {
    /// The simplest object that is closed and bounded, or the simplest one if none is.
    object: Option<&'static Entity>,
    shaders: Vec<&'static Entity>,
}

impl StandIns {
    /// Chooses from a registry, without those that are `shunned`.
    pub fn new(registry: &Registry, scenes: &SceneFolder, shunned: &[&'static Entity]) -> Self {
        let is_one = |other: &Entity, kind: Kind| {
            let is_shunned = shunned.iter().any(|its| its.name == other.name);
            other.kind() == kind && !other.refers_to(kind) && !is_shunned
        };
        let shaders = registry.iter().filter(|other| is_one(other, Kind::Shader)).collect();
        let mut stand_ins = Self { object: None, shaders };
        let objects = registry.by_simplicity(|other| is_one(other, Kind::Object));
        let is_closed = |object: &&&'static Entity| {
            let text = Draw::new(object.name).scene(registry, object, &stand_ins);
            let read = reader::read(registry, "scene", scenes.folder(), text.as_bytes(), None);
            let shapes = read.map(|loaded| loaded.model.objects).unwrap_or_default();
            shapes.first().is_some_and(|object| {
                object.shape.why_not_closed().is_none() && object.shape.facts().bounds.is_some()
            })
        };
        stand_ins.object = objects.iter().find(is_closed).or(objects.first()).copied();
        stand_ins
    }

    /// Returns those that occur in a drawn scene.
    pub fn in_scene(&self, scene: &str) -> impl Iterator<Item = &'static Entity> {
        let is_in = |other: &&Entity| scene.contains(&format!("{} {}\n", other.name, name(other.kind())));
        self.shaders.iter().chain(&self.object).copied().filter(is_in)
    }
}

/// Draws pseudorandom numbers, and values made of them.
pub struct Draw {
    numbers: Pcg32,
    /// The numbers for values that are drawn aside.
    others: Pcg32,
}

impl Draw {
    /// Seeds the generator with a plugin's name, so the values for a plugin do not depend on the other plugins.
    pub fn new(name: &str) -> Self {
        let seed = name.bytes().fold(0, |seed: u64, byte| seed.wrapping_mul(257).wrapping_add(byte.into()));
        Self { numbers: Pcg32::new(seed, 0), others: Pcg32::new(seed, 1) }
    }

    /// Draws a number from 0 to 1.
    pub fn part(&mut self) -> f64 {
        f64::from(self.numbers.next_u32()) / f64::from(u32::MAX)
    }

    /// Draws an integer from 0 to `count - 1`.
    fn below(&mut self, count: usize) -> usize {
        self.numbers.next_u32() as usize % count
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// Draws a unit vector.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let vector = DVec3::new(self.part(), self.part(), self.part()) * 2.0 - 1.0;
            if vector.length() <= 1.0
                && let Some(direction) = vector.try_normalize()
            {
                return direction;
            }
        }
    }

    /// Draws a number like those of scenes: round ones and small ones.
    fn number(&mut self) -> f64 {
        match self.below(5) {
            0 => self.below(9) as f64 - 4.0,
            1 | 2 => (self.below(201) as f64 - 100.0) / 10.0,
            3 => self.part(),
            _ => self.part() * 20.0 - 10.0,
        }
    }

    /// Draws a scene with an entity of this type, and with the entities that it may refer to.
    pub fn scene(&mut self, registry: &Registry, entity: &'static Entity, stand_ins: &StandIns) -> String {
        let mut text = String::new();
        for kind in [Kind::Camera, Kind::Material, Kind::Texture] {
            let its = |other: &&'static Entity| other.kind() == kind;
            if kind != Kind::Camera && !its(&entity) && !entity.refers_to(kind) {
                continue;
            }
            // Where a type has the kind's own name, that is the one that others refer to.
            let usual = || registry.find(&kind.to_string()).filter(its).or_else(|| registry.iter().find(its));
            if let Some(other) = Some(entity).filter(its).or_else(usual) {
                text += &self.entity(other, name(kind));
            }
        }
        let mut objects = String::new();
        if entity.refers_to(Kind::Object)
            && let Some(other) = stand_ins.object
        {
            let most = entity.attributes().filter(|its| is_name_of(*its, Kind::Object));
            let most = most.map(|its| its.arity().examples().into_iter().max().unwrap_or(1)).max();
            // Half of the time they are all the same, as objects that are drawn separately hardly ever meet.
            let (first, most) = (self.entity(other, "NAME"), most.unwrap_or(1));
            let are_same = most > 1 && self.below(2) == 0;
            for index in 0..most {
                let one = if index == 0 || are_same { first.clone() } else { self.entity(other, "NAME") };
                objects += &one.replacen("NAME", &of_list(name(Kind::Object), index), 1);
            }
        }
        if matches!(entity.kind(), Kind::Shader | Kind::Object | Kind::Light | Kind::Background) {
            let (tried, named) = (self.entity(entity, "tried"), format!("shader {}\n", name(Kind::Shader)));
            if objects.contains(&named) || tried.contains(&named) {
                // Which shaders there are changes nothing else that is drawn.
                let mut own = Pcg32::new(self.others.next_u32().into(), 2);
                swap(&mut self.others, &mut own);
                text += &self.aside(|draw| draw.shader(registry, entity, &stand_ins.shaders));
                self.others = own;
            }
            text += &objects;
            text += &tried;
        }
        text
    }

    /// Draws a shader that others can refer to, with the texture that it may refer to.
    fn shader(&mut self, registry: &Registry, user: &Entity, shaders: &[&'static Entity]) -> String {
        if shaders.is_empty() {
            return String::new();
        }
        let shader = self.pick(shaders);
        let needs = |kind| shader.refers_to(kind) && !user.refers_to(kind);
        let mut text = String::new();
        for kind in [Kind::Material, Kind::Texture].into_iter().filter(|kind| needs(*kind)) {
            let usual = registry.find(&kind.to_string());
            if let Some(other) = usual.or_else(|| registry.iter().find(|other| other.kind() == kind)) {
                text += &self.entity(other, name(kind));
            }
        }
        text + &self.entity(shader, name(Kind::Shader))
    }

    /// Draws from other numbers: later draws do not depend on this one.
    fn aside<T>(&mut self, draw: impl FnOnce(&mut Self) -> T) -> T {
        swap(&mut self.numbers, &mut self.others);
        let drawn = draw(self);
        swap(&mut self.numbers, &mut self.others);
        drawn
    }

    fn entity(&mut self, entity: &Entity, name: &str) -> String {
        let mut lines = String::new();
        let groups: Vec<_> = entity.groups().map(|group| (group.names, self.pick(group.names))).collect();
        for attribute in entity.attributes() {
            let chosen = groups.iter().find(|(names, _)| names.contains(&attribute.name()));
            if chosen.is_some_and(|(_, chosen)| *chosen != attribute.name()) {
                continue;
            }
            // A shader that is given no attribute is refused.
            let must = chosen.is_some() || entity.kind() == Kind::Shader && lines.is_empty();
            let positive = entity.kind() == Kind::Material;
            let values = match attribute.value_type() {
                Type::Name(Kind::Shader) => self.aside(|draw| draw.values(attribute, must, positive)),
                _ => self.values(attribute, must, positive),
            };
            if let Some(values) = values {
                lines += &format!("    {}\n", Syntax::Notes.pair(attribute.name(), &values));
            }
        }
        format!("{} {name}\n{{\n{lines}}}\n", entity.name)
    }

    /// Draws values that an attribute allows, in a scene's syntax; `None` leaves the default.
    fn values(&mut self, attribute: &dyn Attribute, must: bool, positive: bool) -> Option<Vec<String>> {
        if attribute.default().is_some() && !must && self.below(2) == 0 {
            return None;
        }
        let count = self.pick(&attribute.arity().examples());
        let word = |word: &str| Some(vec![word.to_owned()]);
        let datum = |draw: &mut Self| match attribute.value_type() {
            Type::Whole => Datum::Whole((0..count).map(|_| draw.whole()).collect()),
            Type::Number | Type::Rotation => {
                let sign = |number: f64| if positive { number.abs() } else { number };
                Datum::Numbers((0..count).map(|_| sign(draw.number())).collect())
            }
            Type::Choice(choices) => Datum::Choice(draw.pick(&choices.all())),
            Type::Truth => Datum::Truth(draw.below(2) == 0),
            Type::Word | Type::File | Type::Name(_) | Type::Formula(_) => Datum::Absent,
        };
        match attribute.value_type() {
            Type::Word => word(PICTURE),
            Type::File => word(MODEL),
            // All possible names: an entity that nothing refers to would be tried as well.
            Type::Name(kind) => {
                let most = attribute.arity().examples().into_iter().max().unwrap_or(count);
                Some((0..most).map(|index| of_list(name(kind), index)).collect())
            }
            Type::Choice(Choices { kind: Some(kind), .. }) if self.aside(|draw| draw.below(2) == 0) => {
                word(name(kind))
            }
            Type::Formula(HEIGHT) => word(&format!("\"{}\"", self.pick(&FORMULAS))),
            Type::Formula(CURVE) => word(&format!("\"{}\"", CURVE_FORMULAS[axis(attribute)])),
            Type::Formula(PATCH) => word(&format!("\"{}\"", PATCH_FORMULAS[axis(attribute)])),
            Type::Formula(_) => word(&format!("\"{}\"", self.pick(&FIELDS))),
            _ => {
                let drawn = (0..TRIES).map(|_| datum(self)).find(|datum| attribute.allows(datum));
                Some(Syntax::Notes.values(&drawn?))
            }
        }
    }

    fn whole(&mut self) -> i64 {
        match self.below(2) {
            0 => self.below(3) as i64,
            _ => 1 + self.below(640) as i64,
        }
    }
}

/// Returns the axis whose coordinate an attribute is, or else the first one.
fn axis(attribute: &dyn Attribute) -> usize {
    "xyz".find(attribute.name()).unwrap_or(0)
}

/// Tells whether an attribute takes the name of an entity of this kind.
fn is_name_of(attribute: &dyn Attribute, kind: Kind) -> bool {
    matches!(attribute.value_type(), Type::Name(named) if named == kind)
}

/// Returns the name of one of several entities.
fn of_list(name: &str, index: usize) -> String {
    if index == 0 { name.to_owned() } else { format!("{name}{index}") }
}

/// Returns the name of the entity of this kind that others refer to.
fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Camera => "eye",
        Kind::Material => "m",
        Kind::Texture => "t",
        Kind::Shader => "s",
        Kind::Object => "o",
        Kind::Light | Kind::Background => "tried",
    }
}
