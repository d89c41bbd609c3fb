//! `tabray farm`: what a job scheduler takes to render an image in parts, or the frames of a film.

mod commands;
mod job;
mod kubernetes;
mod slurm;

use clap::FromArgMatches;
use job::{Job, word};
use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use tabray_cli::line;
use tabray_cli::options::number::whole;
use tabray_cli::process::failure::{Failure, print};
use tabray_cli::process::messages;
use tabray_cli::render;
use tabray_cli::{Command, Group, Run};
use tabray_core::output::full_range::FullRange;
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Write the jobs that render the parts of an image, or the frames of a film, on a cluster
///
/// Checks the options and the scene first, like `render`. Submits nothing.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    engine: Engine,
}

const EXAMPLES: &str = "\
Examples:
  tabray farm slurm hall.ray -o big.png --parts 64 -- --samples 256
  tabray farm slurm ball.ray -o film.png --parts 24 -- --frames 1..240 --sweep ball.radius=1..2
  tabray farm commands hall.ray -o big.png --parts 64 > parts.txt
  tabray farm kubernetes hall.ray -o big.png --parts 64 > big.yaml";

#[derive(clap::Subcommand)]
enum Engine {
    /// Write the scripts of a Slurm job array into the folder IMAGE.slurm, and print the command that submits them
    ///
    /// Each task of the array renders a part, and a job that depends on all of them puts the image or the film together.
    #[command(after_long_help = EXAMPLES)]
    Slurm(Order),
    /// Print the commands that render the parts, one per line; they can run in any order, or at the same time
    ///
    /// The commands suit GNU parallel, `xargs`, OpenCue's `cuecmd`, Flamenco's scripts and arrays of AWS Batch. The
    /// command that then joins the parts or the frames goes to standard error.
    #[command(after_long_help = EXAMPLES)]
    Commands {
        #[command(flatten)]
        order: Order,
        /// Run each command with `podman` in this container image, with the working directory as /scenes
        #[arg(long, value_name = "NAME")]
        container: Option<String>,
    },
    /// Print the manifests of two Kubernetes jobs: one renders the parts, and one puts the image or the film together
    ///
    /// The second job is suspended until the first one is complete; the commands are printed to standard error. Paths are
    /// relative to the volume with the scene, which all nodes mount.
    #[command(after_long_help = EXAMPLES)]
    Kubernetes {
        #[command(flatten)]
        order: Order,
        /// The container image; docs/cluster/Containerfile makes one
        #[arg(long, value_name = "NAME", default_value = concat!("tabray:", env!("CARGO_PKG_VERSION")))]
        container: String,
        /// The claim of the volume with the scene
        #[arg(long, value_name = "NAME", default_value = "scenes")]
        claim: String,
    },
}

/// What is to be rendered.
#[derive(clap::Args)]
#[group(skip)]
struct Order {
    /// The scene
    scene: PathBuf,
    /// The image, or the name of the frames, in a folder that all nodes share
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The number of parts; with `--frames`, each has every Nth frame
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=100_000))]
    parts: u32,
    /// Options of `render` for each part
    #[arg(last = true, value_name = "OPTIONS")]
    options: Vec<String>,
}

inventory::submit! {
    Command::new("farm", Group::Rendering, &Run(run)).placed(4, 3)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    match &args.engine {
        Engine::Slurm(order) => slurm::write(&order.checked(registry)?, &program()?),
        Engine::Commands { order, container } => {
            let job = order.checked(registry)?;
            let program = match container {
                Some(name) => {
                    job.refuse_absolute("the working directory")?;
                    commands::in_container(name)
                }
                None => program()?,
            };
            print(&commands::text(&job, &program))?;
            messages::note(&format!("once all of them have ended: {program} {}", job.last));
            Ok(())
        }
        Engine::Kubernetes { order, container, claim } => {
            let job = order.checked(registry)?;
            job.refuse_absolute("the volume")?;
            let name = kubernetes::name(&job.path);
            print(&kubernetes::manifests(&job, &name, container, claim))?;
            messages::note(&kubernetes::steps(&name));
            Ok(())
        }
    }
}

/// Returns this program, as a word for a shell.
fn program() -> Result<String, Failure> {
    word(&env::current_exe()?)
}

impl Order {
    /// Checks the scene and the options of the parts.
    fn checked(&self, registry: &Registry) -> Result<Job, Failure> {
        let Self { scene, output, parts, options } = self;
        let [scene_word, image] = [word(scene)?, word(output)?];
        if let Some(option) = options.iter().find(|option| option.contains(char::is_control)) {
            return Err(Failure::usage(format!(
                "a script cannot have the option `{}`",
                text::visible(option)
            ))
            .help("give options without line ends and other control characters"));
        }
        let part = format!("1/{parts}");
        let words = ["tabray", "render", "--resume", "--part", &part].map(OsString::from);
        let given = options.iter().map(OsString::from);
        let mut image_option = OsString::from("--output=");
        image_option.push(output);
        let files = [image_option, "--".into(), scene.into()];
        let words = words.into_iter().chain(given).chain(files);
        let matches = line().try_get_matches_from(words).unwrap_or_else(|error| error.exit());
        let args = matches.subcommand_matches("render").map(render::Args::from_arg_matches);
        let Some(Ok(args)) = args else { return Err(Failure::AlreadyReported) };
        let last = match args.check(registry)? {
            None => format!("merge {image}"),
            Some(_) if FullRange::of(output).is_some() => {
                return Err(Failure::usage(format!(
                    "frames as `{}` cannot be resumed or put together",
                    text::shown(output)
                ))
                .help("name .png or .ppm files"));
            }
            Some(frames) => {
                format!(
                    "film {image} --frames {frames} --animation {}",
                    word(&output.with_extension("apng"))?
                )
            }
        };
        let options = options.iter().map(|option| format!(" {}", text::quoted(option.as_ref()))).collect();
        Ok(Job { scene: scene_word, image, path: output.clone(), parts: *parts, options, last })
    }
}
