//! `tabray farm`: writes scripts with which a job scheduler renders the parts of an image.

use crate::files::output;
use crate::options::number::whole;
use crate::process::failure::{self, Failure};
use std::env;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use tabray_core::text;

/// Write scripts that render the parts of an image on a cluster
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    engine: Engine,
}

const EXAMPLES: &str = "\
Examples:
  tabray farm slurm hall.ray -o big.png --parts 64 -- --samples 256";

#[derive(clap::Subcommand)]
enum Engine {
    Slurm(Slurm),
}

/// Write the scripts of a Slurm job array into the folder IMAGE.slurm, and print the command that submits them
///
/// Each task of the array renders a part, and a job that depends on all of them puts the image together. Nothing is
/// submitted.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
struct Slurm {
    /// The scene
    scene: PathBuf,
    /// The image, in a folder that all nodes share
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The number of parts
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=100_000))]
    parts: u32,
    /// Options of `render` for each part
    #[arg(last = true, value_name = "OPTIONS")]
    options: Vec<String>,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let Engine::Slurm(Slurm { scene, output: image, parts, options }) = &args.engine;
    let (program, image_word) = (quoted(&env::current_exe()?), quoted(image));
    let folder = output::append_to_path(image, ".slurm");
    let [render, merge] = ["render.sbatch", "merge.sbatch"].map(|name| folder.join(name));
    let mut words = String::new();
    for option in options {
        let _ = write!(words, " {}", text::quoted(option.as_ref()));
    }
    let name = image.file_stem().unwrap_or_default();
    let log = |name: &str| quoted(&folder.join(name));
    let (label, scene) = (text::quoted(name), quoted(scene));
    let render_text = format!(
        "#!/bin/bash
#SBATCH --job-name={label}
#SBATCH --array=1-{parts}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={}
#SBATCH --signal=B:INT@60
# A part whose node fails is queued again, and --resume renders what is left of it. A minute before the time limit, the
# program is interrupted and keeps what is done.
echo \"part $SLURM_ARRAY_TASK_ID of {parts}, on ${{SLURMD_NODENAME:-$(hostname)}}, start ${{SLURM_RESTART_COUNT:-0}}\" >&2
exec {program} render {scene} -o {image_word} --part \"$SLURM_ARRAY_TASK_ID/{parts}\" --resume \\
    --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"{words}
",
        log("part-%a.log")
    );
    let merge_text = format!(
        "#!/bin/bash
#SBATCH --job-name={label}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={}
exec {program} merge {image_word} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"
",
        log("merge.log")
    );
    output::create_folder(&folder)?;
    output::replace(&render, render_text.as_bytes())?;
    output::replace(&merge, merge_text.as_bytes())?;
    let [render, merge] = [&render, &merge].map(|path| quoted(path));
    failure::print(&format!("sbatch --dependency=afterok:$(sbatch --parsable {render}) {merge}\n"))
}

fn quoted(path: &Path) -> String {
    text::quoted(path.as_os_str())
}
