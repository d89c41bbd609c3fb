//! `tabray mesh`: writes an object of a scene as a closed mesh of triangles.

use crate::surface_mesh::{Body, Event, Format, NoBody, NoMesh, Sheet, Singular, mesh};
use glam::DVec3;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock};
use tabray_cli::files::input;
use tabray_cli::files::output::{self, Output};
use tabray_cli::options::named::{Value, by_name};
use tabray_cli::options::{scene, threads};
use tabray_cli::process::failure::Failure;
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::progress::Progress;
use tabray_cli::process::{memory, messages};
use tabray_cli::{Command, Group, Run};
use tabray_core::text::{count, list, short, shortest, shown};
use tabray_lang::registry::Registry;

/// How many places are listed.
const LISTED: usize = 5;

/// Write an object as a closed mesh of triangles, within a proven distance
///
/// The mesh is watertight and two-manifold, and its triangles face outward. Interval arithmetic proves that no point of
/// it is farther than E from the object's surface, and no point of the surface farther than E from the mesh; otherwise,
/// the command fails and says where. It warns of places where mesh and surface may be joined differently, such as the
/// nodes of an algebraic surface.
///
/// The object must be closed: an implicit, a surface of revolution, a solid, or a copy of one. If its box cuts an
/// implicit, the faces of the box close it. With `--thickness`, the surface may be open, or parametric: the mesh is then
/// that of all points within half of the thickness of it. The distance from a parametric surface is computed, not proven.
/// The scene needs no camera.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The name of the object
    name: String,
    /// The file to write; its name ends in .stl, .obj or .ply, and `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The largest distance between the mesh and the surface, in world units; by default a 200th of the object's size
    #[arg(short, long, value_name = "E", value_parser = above_0)]
    error: Option<f64>,
    /// Give the surface this thickness, in world units; its middle is the surface
    #[arg(long, value_name = "T", value_parser = above_0)]
    thickness: Option<f64>,
    /// The format, whatever the file name
    #[arg(long, value_name = "FORMAT", value_parser = by_name::<Format>())]
    format: Option<Format>,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray mesh ball.ray ball -o ball.stl
  tabray mesh gyroid.ray gyroid -o gyroid.ply --error 0.01";

/// The part of an object's size that is the error by default.
const FRACTION: f64 = 1.0 / 200.0;

fn above_0(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number above 0, in world units".to_owned())
}

impl Value for Format {
    fn help(self) -> Option<&'static str> {
        Some(match self {
            Self::Stl => "Binary STL, as printers read it",
            Self::Obj => "Wavefront's text",
            Self::Ply => "Binary PLY",
        })
    }
}

inventory::submit! {
    Command::new("mesh", Group::Scenes, &Run(run)).placed(5, 6)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let Args { output, name, .. } = &args;
    let format = args.format.or_else(|| Format::of_name(output)).ok_or_else(|| {
        let message = format!("the name `{}` does not determine the format of the mesh", shown(output));
        Failure::usage(message).help("end it in .stl, .obj or .ply, or give `--format`")
    })?;
    let model = input::print_warnings(args.scene.read()?.load_for_rays(registry, None))?.model;
    output::refuse_source_by(output, "the mesh", &args.scene.path, &model)?;
    let name = &shown(name);
    let refused = |fault| no_body(&args.scene.path, name, fault);
    let size = 2.0 * Body::bounds_of(&model, &args.name).map_err(refused)?.half_size().max_element();
    let error = args.error.unwrap_or_else(|| {
        let most = args.thickness.map_or(f64::INFINITY, |thickness| thickness / 8.0);
        let error = most.min(FRACTION * size);
        short(error).parse().unwrap_or(error)
    });
    interrupt::catch(InterruptAction::Exit("no mesh is written"))?;
    let (memory, renderer) = (memory::left(), args.threads.renderer()?);
    let (body, share) = match args.thickness {
        None => (Body::of(&model, &args.name).map_err(refused)?, error),
        Some(thickness) if error >= thickness / 2.0 => {
            let [error, thickness] = [error, thickness].map(shortest);
            let message = format!("an error of {error} is too large for a thickness of {thickness}");
            return Err(Failure::usage(message).help("give an `--error` of less than half of the thickness"));
        }
        // Half of the error is for the distance from the surface, the other half for the triangles.
        Some(thickness) => {
            let (sheet, share) = (Sheet::of(&model, &args.name).map_err(refused)?, error / 2.0);
            let body = with_progress(|tell| renderer.run(|| sheet.thickened(thickness, share, memory, tell)));
            let body = body.map_err(|fault| match fault {
                // An error of which there is a mesh would be too large for the thickness.
                NoMesh::TooMany(least) if 2.0 * least >= thickness / 2.0 => {
                    let least = short(8.0 * 2.0 * least);
                    Failure::usage(format!(
                        "`{name}` is too large for a thickness of {}",
                        shortest(thickness)
                    ))
                    .help(format!("give a `--thickness` of about {least} or more"))
                }
                fault => no_mesh(name, (error, share), &fault),
            });
            (body?, share)
        }
    };
    let made = with_progress(|tell| renderer.run(|| mesh(&body, share, memory, tell)));
    let made = made.map_err(|fault| no_mesh(name, (error, share), &fault))?;
    let mut out = BufWriter::new(Output::open(output)?);
    let written = format.write(&made, name, &mut out);
    output::finished(output, written, out)?;
    messages::note(&format!(
        "wrote {}: {}, closed, with a volume of {}",
        shown(output),
        count(made.faces.len(), "triangle"),
        short(made.volume())
    ));
    if let Some(closed_by) = body.closed_by {
        messages::note(&format!("the mesh is closed by {closed_by}; `--thickness` leaves the surface open"));
    }
    match &made.tangled {
        Some(places) if !places.is_empty() => messages::warning(
            &format!(
                "the surface and the mesh may be joined differently in {}: {}",
                count(places.len(), "cell"),
                listed(places)
            ),
            Some(
                "its normals may turn by a right angle there, as at a node or an edge; a smaller `--error` makes these \
                 places smaller",
            ),
        ),
        Some(_) => {}
        None => messages::note(
            "it was not checked whether the mesh is connected as the object is: look at it where parts nearly touch",
        ),
    }
    if !made.singular.is_empty() {
        messages::warning(
            &format!(
                "the surface may be singular, with a gradient of 0, {}",
                first(&made.singular, |place| singular(*place))
            ),
            Some("a smaller `box`, or a `clip`, leaves such places out"),
        );
    }
    if made.far.is_empty() {
        messages::note(&match args.thickness {
            None => format!(
                "each point of the mesh is within {} of the surface, and each point of the surface of the mesh",
                shortest(error)
            ),
            Some(thickness) => format!(
                "the distance of each point of the mesh from the surface is within {} of {}",
                shortest(error),
                shortest(thickness / 2.0)
            ),
        });
        return Ok(());
    }
    Err(Failure::Failed(format!(
        "the mesh is not proven to be within {} of the surface in {}, which a smaller `box` or a `clip` may leave out: {}",
        shortest(error),
        count(made.far.len(), "cell"),
        listed(&made.far)
    )))
}

/// Does work, and shows its progress.
fn with_progress<R>(work: impl FnOnce(&(dyn Fn(Event) + Sync)) -> R) -> R {
    let progress: RwLock<Option<Progress>> = RwLock::default();
    let begin = |steps: Option<usize>| {
        let mut progress = progress.write().unwrap_or_else(PoisonError::into_inner);
        progress.iter().for_each(Progress::end);
        *progress = steps.map(Progress::new);
    };
    let tell = |event| match event {
        Event::Expected { triangles, steps } => {
            if let Some(triangles) = triangles {
                messages::note(&format!(
                    "about {} triangles are to be made, and then merged",
                    rounded(triangles)
                ));
            }
            begin(Some(steps));
        }
        Event::Done(steps) => {
            let progress = progress.read().unwrap_or_else(PoisonError::into_inner);
            progress.iter().for_each(|progress| progress.advance(steps));
        }
    };
    let done = work(&tell);
    begin(None);
    done
}

/// Returns a number with two digits and zeros.
fn rounded(number: usize) -> usize {
    let unit = 10_usize.pow(number.max(1).ilog10().saturating_sub(1));
    number.div_ceil(unit) * unit
}

fn point(at: DVec3) -> String {
    let signed = |number: f64| format!("{}{}", if number < 0.0 { "-" } else { "" }, short(number.abs()));
    at.to_array().map(signed).join(" ")
}

/// Says where a surface is singular.
fn singular(place: Singular) -> String {
    let between = |[one, other]: [DVec3; 2]| format!("from {} to {}", point(one), point(other));
    match place {
        Singular::Point(at) => format!("at {}", point(at)),
        Singular::Curve(ends, cells) => {
            format!("along a curve {} through {}", between(ends), count(cells, "cell"))
        }
        Singular::Part(corners, cells) => {
            format!("in {}, {}", count(cells, "adjoining cell"), between(corners))
        }
    }
}

/// Lists the first places.
fn listed(places: &[[DVec3; 2]]) -> String {
    first(places, |[low, high]| format!("{} to {}", point(*low), point(*high)))
}

/// Lists the first things.
fn first<T>(of: &[T], text: impl Fn(&T) -> String) -> String {
    let more = if of.len() > LISTED { format!(", and {} more", of.len() - LISTED) } else { String::new() };
    of.iter().take(LISTED).map(text).collect::<Vec<_>>().join(", ") + &more
}

fn no_body(scene: &Path, name: &str, fault: NoBody) -> Failure {
    let (message, help) = match fault {
        NoBody::Unknown(names) => {
            let names: Vec<_> = names.iter().map(shown).collect();
            (
                format!("`{}` has no object `{name}`", shown(scene)),
                format!("its objects are {}", list(names.iter().map(String::as_str))),
            )
        }
        NoBody::Open(why) => (
            format!("`{name}` encloses nothing: {why}"),
            "a mesh is made of closed objects: a sphere, a solid, an `implicit` within its box; `--thickness` closes \
             others"
                .to_owned(),
        ),
        NoBody::Unbounded => {
            (format!("`{name}` has no end"), "an `intersection` with a box has one".to_owned())
        }
        NoBody::Unproven => (
            format!("`{name}` has no equation, so nothing is proven about its surface"),
            "a thickness takes a type with an equation, such as `implicit`, `disc` or `mesh`".to_owned(),
        ),
        NoBody::Mesh => (
            format!("`{name}` is a mesh already, or may be made of one"),
            "intervals cannot tell the inside of a mesh: leave it out of the scene".to_owned(),
        ),
    };
    Failure::usage(message).help(help)
}

/// Says why there is no mesh. `share` is the part of the error that the work had.
fn no_mesh(name: &str, (error, share): (f64, f64), fault: &NoMesh) -> Failure {
    let (error, parts) = (shortest(error), error / share);
    let (message, help) = match fault {
        NoMesh::Empty => (
            format!("nothing of `{name}` is larger than the error of {error}"),
            "give a smaller `--error`".to_owned(),
        ),
        NoMesh::TooMany(least) => (
            format!("a mesh of `{name}` within {error} has too many triangles{}", memory::beyond_chosen()),
            format!("give an `--error` of about {} or more", short(parts * least)),
        ),
        NoMesh::TooFine => (
            format!("an error of {error} is too small for the digits of mesh files"),
            "give a larger `--error`".to_owned(),
        ),
        NoMesh::Open => return Failure::Failed(format!("the mesh of `{name}` is not closed")),
    };
    Failure::usage(message).help(help)
}
