//! `tabray list`: the entity types and their attributes, from their tables, and what the file of a mesh holds.

use crate::command::{Command, Group, Run};
use crate::files::mesh;
use crate::process::failure::{Failure, print};
use crate::process::program;
use std::path::Path;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::value::Datum;
use tabray_core::text;
use tabray_lang::list_json::Tables;
use tabray_lang::reference;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// List the entity types, the attributes of one, or what a mesh has
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The entity type whose attributes to list, or a mesh file. Of a mesh, prints the bounds, faces and parts, whether
    /// it is closed, a guess of its unit, and its normals, texture coordinates, colours and materials
    entity: Option<String>,
    /// Print the whole reference of the language as Markdown
    #[arg(long, conflicts_with = "entity")]
    markdown: bool,
    /// Print all tables as JSON, for programs
    #[arg(long, conflicts_with_all = ["entity", "markdown"])]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  tabray list
  tabray list sphere
  tabray list part.stl
  tabray list --json";

inventory::submit! {
    Command::new("list", Group::First, &Run(run)).placed(1, 22)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    if args.markdown {
        return print(&reference::markdown(registry));
    }
    if args.json {
        return print(&text::json_in_lines(&Tables::of(registry)));
    }
    let Some(name) = args.entity else {
        return print(&columns(
            registry
                .iter()
                .map(|entity| [entity.name.to_owned(), entity.kind().to_string(), entity.meaning.to_owned()]),
        ));
    };
    // A type's name has no ending.
    if registry.find(&name).is_none() && (name.contains('.') || Path::new(&name).is_file()) {
        return print(&mesh::described(Path::new(&name))?);
    }
    let entity = registry.find(&name).ok_or_else(|| {
        let help = match registry.nearest(&name) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("`{} list` lists all entity types", program::name()),
        };
        Failure::usage(format!("there is no entity type `{name}`")).help(help)
    })?;
    print(&details(entity))
}

fn details(entity: &'static Entity) -> String {
    let rows = entity.attributes().map(|attribute| {
        let names: Vec<_> = [attribute.name()].iter().chain(attribute.aliases()).copied().collect();
        [names.join(", "), attribute.takes(), condition(attribute), attribute.meaning().to_owned()]
    });
    let also = match entity.aliases {
        [] => String::new(),
        aliases => format!("Alias: {}.\n", aliases.join(", ")),
    };
    format!(
        "{} NAME {{ ... }}\n\n{}: {}.\n{also}\n{}",
        entity.name,
        entity.kind(),
        entity.meaning,
        columns(rows)
    )
}

/// Says whether an attribute is required, what its values must be, and their unit.
fn condition(attribute: &dyn Attribute) -> String {
    let mut parts = vec![match attribute.default() {
        Some(Datum::Absent) => "optional".to_owned(),
        Some(default) => format!("default {}", Syntax::Notes.values(&default).join(" ")),
        None => "required".to_owned(),
    }];
    if !attribute.rule().is_empty() {
        parts.push(format!("must be {}", attribute.rule()));
    }
    if !attribute.unit().is_empty() {
        parts.push(format!("in {}", attribute.unit()));
    }
    parts.join(", ")
}

/// Formats rows of text in columns as wide as their widest entry.
fn columns<const N: usize>(rows: impl Iterator<Item = [String; N]>) -> String {
    let rows: Vec<_> = rows.collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<_> = (0..N).map(width).collect();
    let line = |row: &[String; N]| {
        let padded: String =
            row.iter().zip(&widths).map(|(text, width)| format!("{text:width$}  ")).collect();
        padded.trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}
