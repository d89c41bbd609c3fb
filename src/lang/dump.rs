//! Writes a model as text: like the notes' program, or as a scene that can be loaded again.

use crate::syntax::Syntax;
use std::collections::HashMap;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::entity::Args;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::Model;
use tabray_core::scene::store::Record;
use tabray_core::scene::value::Datum;

/// Returns the notes' dump: camera, materials, objects and lights, with numbers to one decimal. Textures, shaders and
/// backgrounds are omitted.
pub fn notes(model: &Model) -> String {
    let kinds = [Kind::Camera, Kind::Material, Kind::Object, Kind::Light];
    let mut memory = None;
    let entities = kinds.into_iter().flat_map(|kind| model.entities(kind));
    entities.map(|record| notes_block(record.args_in(&mut memory))).collect()
}

fn notes_block(args: &Args) -> String {
    let (before, after_name, after) = match args.entity.kind() {
        Kind::Camera => ("", "", "\n\n"),
        Kind::Material | Kind::Texture | Kind::Shader => ("\n", " ", ""),
        Kind::Object | Kind::Light | Kind::Background => ("", " ", "\n"),
    };
    let lines: String = args.entity.rows().map(|row| row.dump(args)).collect();
    format!("{before}{:<12} {}{after_name}\n{lines}{after}", args.entity.dump_name, args.name)
}

/// Returns a scene, in either syntax, that loads to the identical model. It has all digits of each number, the entities
/// in their order, and only the attributes that were given.
pub fn scene(model: &Model, syntax: Syntax) -> String {
    let entities = in_order(model);
    // TOML needs an array of tables if two entities have the same title.
    let mut counts: HashMap<_, usize> = HashMap::new();
    if syntax == Syntax::Toml {
        entities
            .iter()
            .for_each(|record| *counts.entry((record.entity().name, record.name())).or_default() += 1);
    }
    let (mut text, mut memory) = (String::new(), None);
    for record in entities {
        if !text.is_empty() {
            text += "\n";
        }
        let args = record.args_in(&mut memory);
        let count = counts.get(&(args.entity.name, record.name()));
        text += &block(args, syntax, count.is_some_and(|count| *count > 1));
    }
    text
}

/// Returns an entity of such a scene. `repeated` tells whether another entity of its type has the same name.
pub fn block(args: &Args, syntax: Syntax, repeated: bool) -> String {
    let (kind, name) = (args.entity.name, syntax.key(&args.name));
    let width = args.given().map(|(attribute, _)| attribute.name().len()).max().unwrap_or(0);
    let line = |(attribute, datum): (&dyn Attribute, &Datum)| {
        let padded = format!("{:<width$}", attribute.name());
        syntax.pair(&padded, &syntax.values(datum))
    };
    let lines = args.given().map(line);
    match syntax {
        Syntax::Notes => {
            let lines: String = lines.map(|line| format!("    {line}\n")).collect();
            format!("{kind} {name}\n{{\n{lines}}}\n")
        }
        Syntax::Toml => {
            let title = if repeated { format!("[[{kind}.{name}]]") } else { format!("[{kind}.{name}]") };
            let lines: String = lines.map(|line| line + "\n").collect();
            format!("{title}\n{lines}")
        }
    }
}

/// Returns all entities of a model in the order of its scene.
pub fn in_order(model: &Model) -> Vec<&Record> {
    let kinds = [
        Kind::Camera,
        Kind::Material,
        Kind::Texture,
        Kind::Shader,
        Kind::Object,
        Kind::Light,
        Kind::Background,
    ];
    let mut all: Vec<_> = kinds.into_iter().flat_map(|kind| model.entities(kind)).collect();
    all.sort_unstable_by_key(|record| record.order());
    all
}
