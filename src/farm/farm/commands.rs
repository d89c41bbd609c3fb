//! Commands for schedulers that take one a line.

use super::job::Job;
use tabray_core::text;

/// Returns the commands that render the parts, one a line.
pub fn text(job: &Job, program: &str) -> String {
    (1..=job.parts).map(|part| format!("{program} {}\n", job.part(&part.to_string()))).collect()
}

/// Returns the words before the program's arguments that run it in a container.
pub fn in_container(container: &str) -> String {
    let container = text::quoted(container.as_ref());
    format!("podman run --rm --volume \"$PWD\":/scenes {container}")
}
