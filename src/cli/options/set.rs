//! `--set`: values beside the text of a scene.

use tabray_core::text;

/// The values that are set.
#[derive(Clone, Default, clap::Args)]
#[group(id = "what is set")]
pub struct Args {
    /// Override values of the scene, written as in a scene: `ball.radius=3` sets an attribute, and `radius=3` a `let`.
    /// May be given more than once
    #[arg(long = "set", value_name = "NAME=VALUES")]
    pub values: Vec<String>,
    /// What messages call the last of these values, where they are those of a sweep.
    #[arg(skip)]
    pub set_by: Vec<String>,
}

impl Args {
    /// Returns the options as a shell reads them, each after a space.
    pub fn words(&self) -> String {
        self.values.iter().map(|value| format!(" --set {}", text::quoted(value.as_ref()))).collect()
    }
}
