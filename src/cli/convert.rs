//! `tabray convert`: a scene in the other spelling.

use super::failure::{Failure, print};
use super::output::Output;
use super::{input, messages};
use crate::scene::dump;
use crate::scene::model::Model;
use crate::scene::reader;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Write a scene in the other spelling
///
/// Everything is carried over but comments: the copy makes the identical model.
#[derive(clap::Args)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// Where to write it: as TOML if the name ends in .toml, in the course notes' spelling if not; `-` writes to
    /// standard output
    output: PathBuf,
    /// The spelling to write, whatever the name
    #[arg(long, value_name = "SPELLING")]
    to: Option<SyntaxName>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum SyntaxName {
    /// That of the course notes
    Ray,
    Toml,
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let syntax = syntax(&args)?;
    let model = input::load(registry, &args.scene, None)?;
    let text = dump::scene(&model, syntax);
    if input::is_standard(&args.output) {
        return print(&text);
    }
    is_the_same_scene(registry, &model, &text, &args.output)?;
    let mut output = Output::open(&args.output)?;
    output
        .write_all(text.as_bytes())
        .and_then(|()| output.finish())
        .map_err(|error| Failure::cannot_write(&args.output, &error))?;
    messages::note(&format!("wrote {} (comments are not carried over)", args.output.display()));
    Ok(())
}

/// The spelling that is asked for.
fn syntax(args: &Args) -> Result<Syntax, Failure> {
    let asked = args.to.map(|name| match name {
        SyntaxName::Ray => Syntax::Notes,
        SyntaxName::Toml => Syntax::Toml,
    });
    match (asked, Syntax::of_name(&args.output)) {
        (Some(Syntax::Notes), Some(Syntax::Toml)) => Err(Failure::Usage(
            format!("the file `{}` would be read as TOML", args.output.display()),
            Some("end its name in .ray".to_owned()),
        )),
        (None, None) => Err(Failure::Usage(
            format!("the name `{}` does not say which spelling to write", args.output.display()),
            Some("give `--to toml` or `--to ray`, or end it in .toml or .ray".to_owned()),
        )),
        (asked, by_name) => Ok(asked.or(by_name).unwrap_or_default()),
    }
}

/// Reads the copy as from its place, where it may not find the files that the scene names.
fn is_the_same_scene(registry: &Registry, model: &Model, text: &str, path: &Path) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(path);
    match reader::read(registry, &path.display().to_string(), folder, text.as_bytes(), None) {
        Ok(copy) if dump::scene(&copy.model, Syntax::Notes) == dump::scene(model, Syntax::Notes) => Ok(()),
        Ok(_) => {
            Err(Failure::Failed(format!("the copy in `{}` would not be the same scene", path.display())))
        }
        Err(_) => Err(Failure::Usage(
            format!("from `{}` the scene would not find the files that it names", path.display()),
            Some("file names start from the scene's folder: write the copy there".to_owned()),
        )),
    }
}
