//! `--method` and `--accuracy`: how exactly a scene is traced, whatever it says itself.

use super::failure::Failure;
use crate::world::accuracy::Accuracy;

#[derive(clap::Args)]
#[group(id = "how exactly")]
pub struct Args {
    /// The method of computing hits; by default that of the scene's camera
    #[arg(long, value_name = "NAME")]
    method: Option<MethodName>,
    /// The accuracy of the exact method
    #[arg(long, value_name = "NAME")]
    accuracy: Option<AccuracyName>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum MethodName {
    /// The course notes' methods, which lose some hits and reproduce the course's images
    Classic,
    /// Methods with error bounds, the default
    Exact,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum AccuracyName {
    /// Hit points within about 1/1000 of a unit of the surface, where that saves time
    Draft,
    /// Hit points on the surface, up to rounding
    Exact,
    /// Like exact, in twice the precision wherever a shape supports it
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
