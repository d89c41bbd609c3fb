//! `tabray new plugin`: a working plugin, and its scenes.

use crate::command::Command;
use crate::files::output;
use crate::process::failure::Failure;
use crate::process::messages;
use serde::Deserialize;
use std::fs;
use std::path::Path;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::profile::Profile;
use tabray_lang::registry::Registry;

/// Write a working, commented plugin and its scenes
///
/// A plugin is compiled into the program, so run this in the top folder of a clone of tabray. After `cargo build`,
/// scenes can use the new name.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// Its name in scenes: lower-case letters, digits and `_`
    name: String,
    /// What it adds to the language, or to the command line
    #[arg(long, default_value = "shape")]
    kind: Kind,
}

const EXAMPLES: &str = "\
Examples:
  tabray new plugin gem
  tabray new plugin stripes --kind shader";

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Kind {
    /// An entity type of objects
    Shape,
    /// A type of shader, for the looks of objects
    Shader,
    /// An entity type of lights
    Light,
    /// A profile for surfaces of revolution
    Profile,
    /// An entity type of cameras
    Camera,
    /// A program with one more command
    Command,
}

/// A file to write: its path, in which `NAME` stands for the plugin's name, and the text that it starts with.
type Template = (&'static str, &'static str);

impl Kind {
    /// Returns the files of a new plugin, the plugin itself first. In the texts, `template` and `Template` stand for
    /// its name.
    fn templates(self) -> &'static [Template] {
        match self {
            Self::Shape => &[
                ("plugins/NAME.rs", include_str!("templates/shape.rs")),
                ("scenes/entities/NAME.ray", include_str!("templates/shape.ray")),
                ("scenes/wrong/NAME.ray", include_str!("templates/shape-wrong.ray")),
            ],
            Self::Light => &[
                ("plugins/NAME.rs", include_str!("templates/light.rs")),
                ("scenes/entities/NAME.ray", include_str!("templates/light.ray")),
                ("scenes/wrong/NAME.ray", include_str!("templates/light-wrong.ray")),
            ],
            Self::Camera => &[
                ("plugins/NAME.rs", include_str!("templates/camera.rs")),
                ("scenes/entities/NAME.ray", include_str!("templates/camera.ray")),
                ("scenes/wrong/NAME.ray", include_str!("templates/camera-wrong.ray")),
            ],
            Self::Shader => &[
                ("plugins/NAME.rs", include_str!("templates/shader.rs")),
                ("scenes/entities/NAME.ray", include_str!("templates/shader.ray")),
                ("scenes/wrong/NAME.ray", include_str!("templates/shader-wrong.ray")),
            ],
            Self::Profile => &[
                ("plugins/NAME.rs", include_str!("templates/profile.rs")),
                ("scenes/revsurf/NAME.ray", include_str!("templates/profile.ray")),
            ],
            Self::Command => &[("src/bin/NAME.rs", include_str!("templates/command.rs"))],
        }
    }
}

/// The keywords of Rust that cannot be raw identifiers, so that no module can have their names.
const KEYWORDS: [&str; 3] = ["crate", "self", "super"];

pub fn run(registry: &Registry, args: &Args) -> Result<(), Failure> {
    is_checkout()?;
    let name = args.name.as_str();
    let templates = args.kind.templates();
    is_free(registry, name, args.kind)?;
    let files: Vec<_> =
        templates.iter().map(|(path, text)| (path.replace("NAME", name), named(text, name))).collect();
    for (path, _) in &files {
        output::refuse_existing(Path::new(path))?;
    }
    for (path, text) in &files {
        output::create_folder(Path::new(path).parent().unwrap_or(Path::new(".")))?;
        output::create(Path::new(path), text)?;
        messages::note(&format!("wrote {path}"));
    }
    messages::note(&match files.get(1) {
        Some((scene, _)) => format!(
            "render it with `cargo run --release -- render {scene}`; docs/plugins.md lists what else belongs to a plugin"
        ),
        None => format!("try it with `cargo run --release --bin {name} -- {name} SCENE`"),
    });
    Ok(())
}

/// The part of a `Cargo.toml` that is read here.
#[derive(Deserialize)]
struct Manifest {
    package: Package,
}

/// The part of the package's description that is read here.
#[derive(Deserialize)]
struct Package {
    /// The name of the package.
    name: String,
}

/// Checks that the working directory is a checkout of the program, from which plugins are compiled.
fn is_checkout() -> Result<(), Failure> {
    let manifest = fs::read_to_string("Cargo.toml").unwrap_or_default();
    let is_ours = toml::from_str(&manifest).is_ok_and(|Manifest { package }| package.name == "tabray");
    if is_ours && Path::new("plugins").is_dir() {
        return Ok(());
    }
    Err(Failure::usage("this is not the top folder of a checkout of tabray")
        .help("a plugin is compiled into the program: go to the folder with its `Cargo.toml` and `plugins/`"))
}

/// The names of the files in `plugins/` that are no plugins.
const OWN_FILES: [&str; 2] = ["build", "lib"];

/// Checks that a plugin can have this name.
fn is_free(registry: &Registry, name: &str, kind: Kind) -> Result<(), Failure> {
    let no_name = |what: String| {
        let help = "a plugin's name must be a Rust module name, such as `tiled_plane`";
        Err(Failure::usage(what).help(help))
    };
    let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(is_letter) {
        return no_name(format!("`{}` cannot be the name of a plugin", name.escape_debug()));
    }
    if KEYWORDS.contains(&name) {
        return no_name(format!("`{name}` is a Rust keyword"));
    }
    let what = if OWN_FILES.contains(&name) {
        format!("`plugins/{name}.rs` is not a plugin: it makes the crate of all plugins")
    } else if let Some(entity) = registry.find(name) {
        format!("the entity type `{name}` already exists, at {}", entity.place())
    } else if <&Profile>::all().iter().any(|profile| profile.option().name == name) {
        format!("the profile `{name}` already exists")
    } else if kind == Kind::Command && Command::named(name).is_some() {
        format!("the command `{name}` already exists")
    } else if kind.templates()[0].1.split(|c: char| !c.is_alphanumeric()).any(|word| word == camel_case(name))
    {
        format!("the template already uses the name `{}`", camel_case(name))
    } else {
        return Ok(());
    };
    Err(Failure::usage(what).help("give the plugin another name"))
}

/// Replaces the template's name by the plugin's.
fn named(text: &str, name: &str) -> String {
    text.replace("Template", &camel_case(name)).replace("template", name)
}

/// Turns a module's name into a type's: `TiledPlane` for `tiled_plane`.
fn camel_case(name: &str) -> String {
    let capital = |part: &str| part[..1].to_ascii_uppercase() + &part[1..];
    name.split('_').filter(|part| !part.is_empty()).map(capital).collect()
}
