//! `--set`: values beside the text of a scene.

use clap::error::ErrorKind;
use clap::{ArgMatches, Command, Error, FromArgMatches};
use serde_json::Value;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use tabray_core::{files, text};

/// The most bytes of a file of values.
const MOST: u64 = 1 << 20;

/// The values that are set.
#[derive(Clone, Default)]
pub struct Args {
    /// Values, each after its name and `=`. Where several set the same, the last one counts.
    pub values: Vec<String>,
    /// What messages call the last of these values, where they are those of a sweep.
    pub set_by: Vec<String>,
}

/// The options.
#[derive(clap::Args)]
#[group(id = "what is set")]
struct Options {
    /// Override values of the scene, written as in a scene: `ball.radius=3` sets an attribute, and `radius=3` a `let`.
    /// May be given more than once
    #[arg(long, value_name = "NAME=VALUES")]
    set: Vec<String>,
    /// Override values of the scene with those of a JSON file: `{"radius": 3, "ball": {"center": [0, 1, 0]}}`; `--set`
    /// overrides these
    #[arg(long, value_name = "FILE")]
    set_from: Vec<PathBuf>,
}

impl FromArgMatches for Args {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let Options { set, set_from } = Options::from_arg_matches(matches)?;
        let mut values = Vec::new();
        for path in set_from {
            let fault = |why: String| Error::raw(ErrorKind::InvalidValue, why + "\n");
            values.extend(read(&path).map_err(fault)?);
        }
        values.extend(set);
        Ok(Self { values, set_by: Vec::new() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for Args {
    fn augment_args(command: Command) -> Command {
        <Options as clap::Args>::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        <Options as clap::Args>::augment_args_for_update(command)
    }
}

/// Reads values from a JSON file.
fn read(path: &Path) -> Result<Vec<String>, String> {
    let what = |why: &str| format!("the values in `{}` cannot be read: {why}", text::shown(path));
    let mut bytes = Vec::new();
    let read = files::open(path).and_then(|file| file.take(MOST + 1).read_to_end(&mut bytes));
    read.map_err(|error: io::Error| what(&error.to_string()))?;
    if bytes.len() as u64 > MOST {
        return Err(what("it is larger than 1 MiB"));
    }
    let value = serde_json::from_slice(&bytes).map_err(|error| what(&error.to_string()))?;
    let mut values = Vec::new();
    let is_read = matches!(value, Value::Object(_)) && add("", &value, &mut values);
    if is_read {
        Ok(values)
    } else {
        Err(what("a value is a number, a word, `true`, `false`, or a list of these"))
    }
}

/// Adds a value under its name, or each value of an object under its name in it. Tells whether all are values.
fn add(name: &str, value: &Value, values: &mut Vec<String>) -> bool {
    let word = |value: &Value| match value {
        Value::Bool(is_set) => Some(if *is_set { "yes" } else { "no" }.to_owned()),
        Value::Number(number) => Some(number.to_string()),
        Value::String(word) => Some(word.clone()),
        _ => None,
    };
    let words = match value {
        Value::Object(entries) => {
            let inner = |own: &String| if name.is_empty() { own.clone() } else { format!("{name}.{own}") };
            return entries.iter().all(|(own, value)| add(&inner(own), value, values));
        }
        Value::Array(items) => items.iter().map(word).collect::<Option<Vec<_>>>(),
        value => word(value).map(|word| vec![word]),
    };
    let is_value = words.is_some();
    values.extend(words.map(|words| format!("{name}={}", words.join(" "))));
    is_value
}

impl Args {
    /// Returns the options as a shell reads them, each after a space.
    pub fn words(&self) -> String {
        self.values.iter().map(|value| format!(" --set {}", text::quoted(value.as_ref()))).collect()
    }
}
