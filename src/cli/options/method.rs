//! `--method` and `--accuracy`: the accuracy of a render, overriding the scene's own.

use crate::process::failure::Failure;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tabray_core::scene::choice::{Choice, ChoiceName};
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;

/// How hits are computed.
#[derive(clap::Args)]
#[group(id = "how exactly")]
#[command(next_help_heading = "Method")]
pub struct Args {
    /// The method of computing hits; by default that of the scene's camera
    #[arg(long, value_name = "NAME", value_parser = among([Accuracy::Classic, Accuracy::Exact]))]
    method: Option<Accuracy>,
    /// The accuracy of the exact method
    #[arg(long, value_name = "NAME", value_parser = among([Accuracy::Draft, Accuracy::Exact, Accuracy::Strict]))]
    accuracy: Option<Accuracy>,
}

/// Makes a parser of an option that takes some accuracies, by the names that scenes use.
fn among<const N: usize>(some: [Accuracy; N]) -> impl TypedValueParser<Value = Accuracy> {
    let value = |ChoiceName { name, meaning, .. }| PossibleValue::new(name).help(text::capital(meaning));
    let values = PossibleValuesParser::new(some.map(|one| value(one.option())));
    values.map(move |name| some.into_iter().find(|one| one.option().name == name).unwrap_or_default())
}

impl Args {
    /// Returns the accuracy that is asked for, if any.
    pub fn accuracy(&self) -> Result<Option<Accuracy>, Failure> {
        if self.method == Some(Accuracy::Classic) && self.accuracy.is_some() {
            return Err(Failure::usage("the classic method has no accuracy to choose")
                .help("leave out `--method classic` or `--accuracy`"));
        }
        Ok(self.accuracy.or(self.method))
    }
}
