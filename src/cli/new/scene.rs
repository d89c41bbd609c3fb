//! `tabray new scene`: a commented scene, or one that shows a mesh.

use super::mesh_scene;
use crate::files::output;
use crate::process::failure::Failure;
use crate::process::{messages, program};
use std::path::PathBuf;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// Write a commented scene, ready to render
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene's name or its file; a name without an extension gets that of its syntax
    name: PathBuf,
    /// Write TOML, as for a file that ends in .toml
    #[arg(long)]
    toml: bool,
    /// Show the mesh in this file, with a camera, lights and a floor that fit its size
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  tabray new scene ball
  tabray new scene ball --toml
  tabray new scene part --mesh part.stl";

pub fn run(registry: &Registry, args: &Args) -> Result<(), Failure> {
    let ending = args.name.extension().and_then(|ending| ending.to_str());
    let mut path = args.name.clone().into_os_string();
    let syntax = match ending {
        Some("ray") if args.toml => {
            return Err(Failure::usage(format!(
                "the file `{}` would not be read as TOML",
                text::shown(&args.name)
            ))
            .help("end its name in .toml, or leave out `--toml`"));
        }
        Some("ray") => Syntax::Notes,
        Some("toml") => Syntax::Toml,
        _ if args.toml => {
            path.push(".toml");
            Syntax::Toml
        }
        _ => {
            path.push(".ray");
            Syntax::Notes
        }
    };
    let path = PathBuf::from(path);
    let text = match (&args.mesh, syntax) {
        (Some(mesh), syntax) => mesh_scene::text(registry, mesh, &path, syntax)?,
        (None, Syntax::Notes) => include_str!("templates/scene.ray").to_owned(),
        (None, Syntax::Toml) => include_str!("templates/scene.toml").to_owned(),
    };
    let program = program::name();
    output::create(&path, &text.replace("`tabray ", &format!("`{program} ")))?;
    let word = text::quoted(path.as_os_str());
    messages::note(&format!("wrote {}; render it with `{program} render {word}`", text::shown(path)));
    Ok(())
}
