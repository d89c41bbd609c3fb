//! `tabray convert`: writes a scene in the other syntax, or what a file of another program shows as a scene.

use crate::command::{Command, Group, Run};
use crate::files::input::Source;
use crate::files::{input, output};
use crate::options::named::by_name;
use crate::options::scene;
use crate::process::failure::{Failure, print_scene};
use crate::process::messages;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_lang::dump;
use tabray_lang::import::{self, Imported};
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;
use tabray_tools::diagnosis;

/// Convert a scene to the other syntax, or a surface of another program to a scene
///
/// The copy loads to the identical model. It lacks the comments, and has the values of what the scene computes.
///
/// If the name of SCENE ends in .jsurf, it is a surface of SURFER; if it ends in .surf or .pic, a script of surf. Files
/// with other names and standard input are recognized by their text. The copy has the formula and its parameters, the
/// view, the body that clips the surface, the colours and the lamps. Warnings say what it leaves out.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The file to write: TOML if its name ends in .toml, the course notes' syntax otherwise; `-` writes to standard
    /// output, and needs --to
    output: PathBuf,
    /// The syntax to write, whatever the file name
    #[arg(long, value_name = "SYNTAX", value_parser = by_name::<Syntax>())]
    to: Option<Syntax>,
}

const EXAMPLES: &str = "\
Examples:
  tabray convert ball.ray ball.toml
  tabray convert ball.toml - --to ray
  tabray convert barth.jsurf barth.ray     # a surface of SURFER
  tabray convert barth.pic barth.ray       # a script of surf";

inventory::submit! {
    Command::new("convert", Group::Scenes, &Run(run)).placed(4, 5)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let syntax = syntax(&args)?;
    let mut source = args.scene.read()?;
    let imported = imported(&source)?;
    if let Some(text) = &imported {
        source = Source::of_text(&args.scene.path.with_extension("ray"), text.clone(), &args.scene.set);
    }
    let model = Arc::new(input::print_warnings(source.load(registry, None))?.model);
    if imported.is_some() {
        messages::remark(diagnosis::tried(Arc::clone(&model)));
    }
    // What was written for people to read stays as it is.
    let readable = imported.filter(|_| syntax == Syntax::Notes && args.scene.set.values.is_empty());
    let is_copy = readable.is_none();
    let scene = readable.unwrap_or_else(|| dump::scene(&model, syntax));
    if input::is_standard(&args.output) {
        return print_scene(&scene);
    }
    if let Some(what) = output::source(&args.output, &args.scene.path, &model) {
        return Err(Failure::usage(format!(
            "`{}` is {what}, which the copy would replace",
            text::shown(&args.output)
        ))
        .help("name another file: a copy has no comments and no formulas"));
    }
    if is_copy {
        is_the_same_scene(registry, &model, &scene, &args.output)?;
    }
    output::replace(&args.output, scene.as_bytes())?;
    let without = if is_copy { " (without comments)" } else { "" };
    messages::note(&format!("wrote {}{without}", text::shown(&args.output)));
    Ok(())
}

/// Returns the scene of a file of another program, if it is one, and says what it leaves out.
fn imported(source: &Source) -> Result<Option<String>, Failure> {
    let (name, bytes) = source.named();
    let Some(Imported { text, warnings, left }) = import::scene(name, bytes).map_err(Failure::Scene)? else {
        return Ok(None);
    };
    messages::warnings(&warnings);
    if !left.is_empty() {
        let words: Vec<_> = left.iter().map(|(word, line)| format!("`{word}` (line {line})")).collect();
        messages::note(&format!("left out, as it does not affect the picture: {}", words.join(", ")));
    }
    Ok(Some(text))
}

/// Returns the syntax that is asked for.
fn syntax(args: &Args) -> Result<Syntax, Failure> {
    match (args.to, Syntax::of_name(&args.output)) {
        (Some(Syntax::Notes), Some(Syntax::Toml)) => {
            Err(Failure::usage(format!("the file `{}` would be read as TOML", text::shown(&args.output)))
                .help("end its name in .ray"))
        }
        (None, None) => Err(Failure::usage(format!(
            "the name `{}` does not determine the syntax to write",
            text::shown(&args.output)
        ))
        .help("give `--to toml` or `--to ray`, or end it in .toml or .ray")),
        (asked, by_name) => Ok(asked.or(by_name).unwrap_or_default()),
    }
}

/// Checks that the copy loads to the same model. It is read as from its own path, from where it may not find the files
/// that the scene names.
fn is_the_same_scene(registry: &Registry, model: &Model, text: &str, path: &Path) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(path);
    match reader::read(registry, &text::shown(path), folder, text.as_bytes(), None) {
        Ok(copy) if dump::scene(&copy.model, Syntax::Notes) == dump::scene(model, Syntax::Notes) => Ok(()),
        Ok(_) => {
            Err(Failure::Failed(format!("the copy in `{}` would not be the same scene", text::shown(path))))
        }
        Err(_) => {
            Err(Failure::usage(format!("the scene would not find its files from `{}`", text::shown(path)))
                .help("file names are relative to the scene's folder: write the copy there"))
        }
    }
}
