//! Reads a scene's text as a [`Model`], or reports all its faults.

mod attributes;
mod black_scene;
mod build;
mod check;
mod cures;
mod encoding;
mod excerpt;
mod fault;
mod files;
mod foreign;
mod guesses;
mod indirect;
mod keyword;
mod languages;
mod levels;
mod listed;
mod located;
mod loops;
mod machine;
mod misplaced;
mod missing;
mod names;
mod notes;
mod numbers;
mod objects;
mod older;
mod only_rays;
mod options;
mod pack_valid;
mod parsed;
mod parts;
mod repeated;
mod repeats;
pub mod report;
mod same_words;
mod sets;
mod sources;
mod statement;
mod statements;
mod textures;
mod tokens;
mod toml;
mod toml_document;
mod toml_faults;
mod unknown;
mod values;

pub use fault::{Fault, Place, Places, Severity};
pub use guesses::find_attribute;
pub use keyword::Keyword;
pub use located::Located;
pub use machine::Message;
pub use notes::{Grammar, Node, Statement};
pub use older::is_older;
pub use only_rays::{UNUSED_CAMERA, mesh_for_rays};
pub use options::ReadOptions;
pub use parsed::{Form, Parsed, Word};
pub use statements::body as body_of_repeat;
pub use tokens::{Token, TokenForm, unescaped};
pub use toml_faults::{LINE, long_line};

use crate::registry::Registry;
use crate::syntax::Syntax;
use build::Checked;
use check::Source;
pub(crate) use encoding::decode;
use listed::Stream;
use sources::Sources;
use std::ops::Range;
use std::path::Path;
use std::time::Duration;
use tabray_core::scene::model::Model;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::any_shape::AnyShape;

/// The memory for making a model, in bytes per byte of its text.
const WEIGHT: u64 = 8;

/// The faults of one scene.
pub type Report = report::Report<'static>;

/// A model, and the warnings about its scene.
pub struct Loaded {
    /// The scene, ready to be traced.
    pub model: Model,
    /// The warnings: places with a possibly unintended meaning.
    pub warnings: Report,
    /// The time for checking the entities and constructing the model, including textures but not parsing. It is zero
    /// without a [clock](ReadOptions::clock).
    pub building: Duration,
    /// The place of each entity.
    pub places: Places,
}

/// Reads a scene. The syntax is TOML if the scene's name ends in `.toml` or its text begins like TOML, that of the
/// course's older scenes if its lines look like them, and otherwise that of the notes. `name` is the scene's name in
/// messages, and file names in the scene are relative to `folder`. An accuracy given here overrides the scene's own.
///
/// # Errors
/// Returns all faults of the scene, including warnings, in the order of the text.
pub fn read(
    registry: &Registry,
    name: &str,
    folder: &Path,
    bytes: &[u8],
    accuracy: Option<Accuracy>,
) -> Result<Loaded, Report> {
    read_by(registry, name, folder, bytes, ReadOptions { above_all: accuracy, ..ReadOptions::default() })
}

/// Reads a scene like [`read`], but with the choices of [`ReadOptions`].
///
/// # Errors
/// Returns all faults of the scene, including warnings, in the order of the text.
pub fn read_by(
    registry: &Registry,
    name: &str,
    folder: &Path,
    bytes: &[u8],
    options: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    has_types(registry, name)?;
    let text = decode(name, bytes).map_err(|report| languages::of_bytes(report, name))?;
    let syntax = match Syntax::of_name(name) {
        Some(Syntax::Toml) => Syntax::Toml,
        _ => Syntax::of_text(text),
    };
    if syntax == Syntax::Notes && is_older(registry, text) {
        return read_older(registry, (name, folder), text, options);
    }
    let read = |text: &str| read_text(registry, (name, folder), text, syntax, options);
    read(text).map_err(|report| match languages::recognised(registry, report, name, text, syntax) {
        Ok(report) => report,
        Err(report) if syntax == Syntax::Notes => {
            let again = |text: &str| read(text).map_or_else(|report| report, |loaded| loaded.warnings);
            foreign::explained(report, text, again)
        }
        Err(report) => report,
    })
}

/// Reads a scene like [`read_by`], but only for queries of rays. Adds a camera to a scene without one.
///
/// # Errors
/// Returns all faults of the scene, including warnings, in the order of the text.
pub fn read_for_rays(
    registry: &Registry,
    name: &str,
    folder: &Path,
    bytes: &[u8],
    options: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    let options = ReadOptions { only_rays: true, ..options };
    let read = |bytes: &[u8]| read_by(registry, name, folder, bytes, options);
    read(bytes).or_else(|report| match report.lacks_camera() {
        true => read(&only_rays::with_camera(bytes, report.syntax())),
        false => Err(report),
    })
}

/// Makes a model of one object with this shape, for ray queries only: a mesh from arrays, for example, has no entity
/// type.
///
/// # Errors
/// Returns a fault if the program has no entity types.
pub fn model_of_shape(registry: &Registry, shape: impl Into<AnyShape>) -> Result<Model, Report> {
    let text = only_rays::ONE_OBJECT.as_bytes();
    let loaded = read_for_rays(registry, "shape", Path::new(""), text, ReadOptions::default())?;
    let mut model = loaded.model;
    model.objects[0].shape = shape.into();
    Ok(model)
}

/// Tells whether nothing in a scene is visible, like the warning of the reader.
pub fn is_black(model: &Model) -> bool {
    black_scene::warning(model).is_some()
}

/// Checks that the program has entity types.
fn has_types(registry: &Registry, name: &str) -> Result<(), Report> {
    if !registry.is_empty() {
        return Ok(());
    }
    let mut report = Report::new(name, "", Syntax::Notes);
    let fault = Fault::error(None, "this program has no entity types".to_owned());
    report.add(
        fault.help(
            "they register themselves where they are linked: write `use tabray_plugins as _;`".to_owned(),
        ),
    );
    Err(report)
}

/// Reads a scene's text.
fn read_text(
    registry: &Registry,
    (name, folder): (&str, &Path),
    text: &str,
    syntax: Syntax,
    options: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    let room = options.memory.map_or(u64::MAX, |memory| memory / WEIGHT);
    let sources = Sources::read((name, folder), text, syntax, options, room);
    let begin = || sources.report(name, syntax);
    let checked = |report: &mut report::Report<'_>, mut source: Source<'_, '_>| {
        build::model(registry, folder, options, &mut source, report)
    };
    let mut report = begin();
    if syntax == Syntax::Toml {
        let parse = |part: Range<usize>, report: &mut report::Report<'_>| {
            toml::parse(registry, &sources.text[..part.end], part.start, report)
        };
        // A long and valid text is parsed and checked in one pass.
        if let Some(parts) = toml::independent_parts(&sources.text[..sources.own.end]) {
            let mut errors = report.clone();
            let mut stream = Stream::new(registry, &sources, &parse, &mut errors, parts);
            let all = checked(&mut report, Source::Stream(Box::new(move || stream.next())));
            if all.0.is_some() && errors.faults().is_empty() && report.faults().is_empty() {
                return finish(all, registry, report, options);
            }
            report = begin();
        }
        return read_list(registry, folder, &sources, &parse, report, options);
    }
    // A valid text is parsed and checked in one pass.
    let mut errors = report.clone();
    let Some(parser) = statements::parser(registry, &sources, &mut errors) else {
        return Err(errors.into_owned());
    };
    let all = checked(&mut report, Source::Text(&sources.text, Box::new(parser)));
    if !errors.is_fatal() {
        return finish(all, registry, report, options);
    }
    drop(all);
    // All syntax errors are reported before all other faults. After too many syntax errors, nothing else is reported.
    let (mut report, mut nowhere) = (begin(), report::Report::default());
    statements::parse(registry, &sources, &mut report);
    if report.has_enough() {
        return Err(report.into_owned());
    }
    let Some(parser) = statements::parser(registry, &sources, &mut nowhere) else {
        return Err(report.into_owned());
    };
    let all = checked(&mut report, Source::Text(&sources.text, Box::new(parser.reading_on())));
    finish(all, registry, report, options)
}

/// Reads one of the course's older scenes.
fn read_older(
    registry: &Registry,
    (name, folder): (&str, &Path),
    text: &str,
    options: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    let sources = Sources::alone(name, text, options);
    let parse = |part: Range<usize>, report: &mut report::Report<'_>| {
        older::parse(&sources.text, part, folder, report)
    };
    // Their lamps are far away, and their colours match that.
    let options = ReadOptions { may_be_bright: true, ..options };
    read_list(registry, folder, &sources, &parse, sources.report(name, Syntax::Notes), options)
}

/// Reads a scene, parsing all entities before checking any.
fn read_list<'s>(
    registry: &Registry,
    folder: &Path,
    sources: &'s Sources<'s>,
    parse: listed::Parse<'_, 's, 's>,
    mut report: report::Report<'s>,
    options: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    let parsed = listed::entities(registry, sources, parse, &mut report);
    if report.has_enough() {
        return Err(report.into_owned());
    }
    let checked = build::model(registry, folder, options, &mut Source::List(&parsed), &mut report);
    finish(checked, registry, report, options)
}

/// Makes a model without any text (the notes' `modelstat.c`). The entities are checked like those of a text. File names
/// are relative to the working directory.
///
/// ```
/// use tabray_lang::{Parsed, Registry, build};
/// // Links the entity types, which register themselves.
/// use tabray_plugins as _;
///
/// let built = build(Registry::get()?, [
///     Parsed::new("camera", "cam1")
///         .set("pixeldim", [640, 480])
///         .set("worlddim", [8.0, 6.0])
///         .set("viewpoint", [4.0, 3.0, 6.0]),
///     Parsed::new("material", "green").set("ambient", [0.0, 5.0, 0.0]),
///     Parsed::new("plane", "leftwall")
///         .set("material", "green")
///         .set("normal", [3.0, 0.0, 1.0])
///         .set("point", [0.0, 0.0, 0.0]),
/// ])?;
/// assert_eq!(built.model.objects.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns all faults of the scene, without places.
pub fn build(
    registry: &Registry,
    parsed: impl IntoIterator<Item = Parsed<'static>>,
) -> Result<Loaded, Report> {
    has_types(registry, "model")?;
    let mut report = Report::new("model", "", Syntax::Notes);
    let parsed: Vec<_> = parsed.into_iter().collect();
    let mut source = Source::List(&parsed);
    let checked = build::model(registry, Path::new(""), ReadOptions::default(), &mut source, &mut report);
    finish(checked, registry, report, ReadOptions::default())
}

/// Returns a checked scene, if it has no errors.
fn finish(
    (model, places, building): Checked,
    registry: &Registry,
    mut report: report::Report<'_>,
    ReadOptions { only_rays, .. }: ReadOptions<'_>,
) -> Result<Loaded, Report> {
    if places.is_empty() && !report.is_fatal() {
        report
            .add(Fault::error(Some(0..0), "the scene is empty").help(registry.first_steps(report.syntax())));
    }
    match model {
        Some(model) if !report.is_fatal() => {
            let black = if only_rays { None } else { black_scene::warning(&model) };
            let indirect = indirect::warnings(&model).filter(|_| !only_rays);
            black.into_iter().chain(indirect).for_each(|warning| report.add(warning));
            Ok(Loaded { model, warnings: report.into_owned(), building, places })
        }
        _ => Err(report.into_owned()),
    }
}
