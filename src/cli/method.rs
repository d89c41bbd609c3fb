//! `--method` and `--accuracy`: how exactly a scene is traced, whatever it says itself.

use super::failure::Failure;
use crate::world::accuracy::Accuracy;

#[derive(clap::Args)]
#[group(id = "how exactly")]
pub struct Args {
    /// How shapes find their hits; by default what the scene's camera says
    #[arg(long, value_name = "NAME")]
    method: Option<MethodName>,
    /// How exactly the exact method finds them
    #[arg(long, value_name = "NAME")]
    accuracy: Option<AccuracyName>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum MethodName {
    /// By the course notes' own methods, with the hits that they lose and the course's own pictures
    Classic,
    /// By bounds on their errors, the default
    Exact,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum AccuracyName {
    /// Points within about 1/1000 of a unit of the surface, where that saves time
    Draft,
    /// Points on the surface but for rounding
    Exact,
    /// As exact, in twice the precision wherever a shape has it
    Strict,
}

impl Args {
    /// What is asked for, if anything is.
    pub fn accuracy(&self) -> Result<Option<Accuracy>, Failure> {
        Ok(match (self.method, self.accuracy) {
            (Some(MethodName::Classic), Some(_)) => {
                return Err(Failure::Usage(
                    "the classic method has no accuracy to choose".to_owned(),
                    Some("leave out `--method classic` or `--accuracy`".to_owned()),
                ));
            }
            (Some(MethodName::Classic), None) => Some(Accuracy::Classic),
            (_, Some(AccuracyName::Draft)) => Some(Accuracy::Draft),
            (_, Some(AccuracyName::Strict)) => Some(Accuracy::Strict),
            (Some(MethodName::Exact), None) | (_, Some(AccuracyName::Exact)) => Some(Accuracy::Exact),
            (None, None) => None,
        })
    }
}
