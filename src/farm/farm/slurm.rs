//! The scripts of a Slurm job array.

use super::job::{Job, word};
use std::io;
use std::path::Path;
use tabray_cli::files::output;
use tabray_cli::process::failure::{Failure, print};
use tabray_core::text;

/// Writes the scripts, and prints the command that submits them.
pub fn write(job: &Job, program: &str) -> Result<(), Failure> {
    let folder = output::append_to_path(&job.path, ".slurm");
    // The parts would find no folder for their image.
    if job.path.parent().is_some_and(|parent| !parent.as_os_str().is_empty() && !parent.is_dir()) {
        return Err(Failure::cannot_write(&job.path, &io::ErrorKind::NotFound.into()));
    }
    let [render, merge] = ["render.sbatch", "merge.sbatch"].map(|name| folder.join(name));
    let words = [word(&render)?, word(&merge)?];
    let [render_text, merge_text] = [render_text(job, program, &folder)?, merge_text(job, program, &folder)?];
    output::create_folder(&folder)?;
    output::replace(&render, render_text.as_bytes())?;
    output::replace(&merge, merge_text.as_bytes())?;
    let [render, merge] = words;
    print(&format!("sbatch --dependency=afterok:$(sbatch --parsable {render}) {merge}\n"))
}

fn render_text(job: &Job, program: &str, folder: &Path) -> Result<String, Failure> {
    let Job { parts, .. } = job;
    let (label, log, part) = (label(job), log(folder, "part-%a.log")?, job.part("\"$SLURM_ARRAY_TASK_ID\""));
    Ok(format!(
        "#!/bin/bash
#SBATCH --job-name={label}
#SBATCH --array=1-{parts}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={log}
#SBATCH --signal=B:INT@60
# A part whose node fails is queued again, and --resume renders what is left of it. A minute before the time limit, the
# program is interrupted and keeps what is done.
echo \"part $SLURM_ARRAY_TASK_ID of {parts}, on ${{SLURMD_NODENAME:-$(hostname)}}, start ${{SLURM_RESTART_COUNT:-0}}\" >&2
exec {program} {part} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"
"
    ))
}

fn merge_text(job: &Job, program: &str, folder: &Path) -> Result<String, Failure> {
    let (label, log, last) = (label(job), log(folder, "merge.log")?, &job.last);
    let threads = if last.starts_with("merge") { " --threads \"${SLURM_CPUS_PER_TASK:-1}\"" } else { "" };
    Ok(format!(
        "#!/bin/bash
#SBATCH --job-name={label}
#SBATCH --requeue
#SBATCH --kill-on-invalid-dep=yes
#SBATCH --open-mode=append
#SBATCH --output={log}
exec {program} {last}{threads}
"
    ))
}

fn label(job: &Job) -> String {
    quoted(&text::shown(job.path.file_stem().unwrap_or_default()))
}

/// Returns the path of a log. In a folder's name, `%` stands for nothing else.
fn log(folder: &Path, name: &str) -> Result<String, Failure> {
    let folder = folder.to_str().unwrap_or_default();
    // Slurm replaces nothing in a name with a backslash, so that all parts would have one log.
    if folder.contains('\\') {
        return Err(Failure::usage(format!("the logs of Slurm cannot be in `{folder}`"))
            .help("give the image a name without backslashes"));
    }
    Ok(quoted(&format!("{}/{name}", folder.replace('%', "%%"))))
}

/// Quotes a word as `sbatch` reads it in a script's comments.
fn quoted(word: &str) -> String {
    format!("\"{}\"", word.replace('\\', "\\\\").replace('"', "\\\""))
}
