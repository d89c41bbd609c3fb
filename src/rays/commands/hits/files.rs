//! The files of rays and of answers.

use crate::hits::answers::AnswerFormat;
use crate::hits::rays::{BadRay, Input};
use std::io::{self, BufReader, IsTerminal, Read};
use std::path::Path;
use tabray_cli::files::input::is_standard;
use tabray_cli::files::paths::open_stream;
use tabray_cli::process::failure::Failure;
use tabray_cli::process::messages;
use tabray_core::text;

/// How much is read at a time, in bytes: many lines, so that all threads have work.
const BUFFER: usize = 1 << 20;

/// Returns the name of the rays in messages.
pub fn name(rays: &Path) -> String {
    if is_standard(rays) { "<stdin>".to_owned() } else { text::shown(rays) }
}

/// Returns the format of a file of answers, by its name.
pub fn of_name(path: &Path) -> Result<AnswerFormat, Failure> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        Some("jsonl" | "ndjson") => Ok(AnswerFormat::JsonLines),
        Some("csv") => Ok(AnswerFormat::Csv),
        Some("npy") => Ok(AnswerFormat::Npy),
        _ if is_standard(path) => Ok(AnswerFormat::JsonLines),
        _ => {
            let help = "end it in .jsonl, .csv or .npy";
            Err(Failure::usage(format!("`{}` has no known format", text::shown(path))).help(help))
        }
    }
}

/// Opens a file of rays or of answers, or standard input, of which `what` says what is expected.
pub fn open<'r>(path: &Path, what: &str) -> Result<Input<'r>, Failure> {
    let input: Box<dyn Read> = if is_standard(path) {
        if io::stdin().is_terminal() {
            messages::note(&format!("reading {what} from the terminal; Ctrl-D ends them"));
        }
        Box::new(io::stdin())
    } else {
        let file = open_stream(path).map_err(|error| {
            Failure::Unread(format!("cannot read `{}`: {}", text::shown(path), text::reason(&error)), None)
        })?;
        Box::new(file)
    };
    Ok(BufReader::with_capacity(BUFFER, input))
}

/// Refuses a file that does not hold rays or answers, as `what` says, and shows its first bad lines.
pub fn refuse(path: &Path, bad: &[BadRay], what: &str) -> Failure {
    let lines: Vec<_> = bad.iter().map(|bad| format!("`{}`, {bad}", name(path))).collect();
    let help = format!("`--skip-bad` leaves such {what} out, and counts them");
    Failure::usage(lines.join("\nerror: ")).help(help)
}

/// Warns of bad lines that were left out.
pub fn tell_of_bad(bad: u64, what: &str) {
    if bad > 0 {
        let were =
            if bad == 1 { format!("is not a {what} and was") } else { format!("are not {what}s and were") };
        messages::warning(&format!("{} {were} left out", text::count(bad as usize, "line")), None);
    }
}

/// Refuses a scene and something else that are both to be read from standard input.
pub fn refuse_two_on_standard_input(scene: &Path, other: &Path, what: &str) -> Result<(), Failure> {
    if is_standard(scene) && is_standard(other) {
        let help = format!("give the {what} in a file, or the scene");
        return Err(Failure::usage("standard input cannot be both").help(help));
    }
    Ok(())
}
