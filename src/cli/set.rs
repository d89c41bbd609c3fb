//! `--set`: values beside the text of a scene.

/// The values that are set.
#[derive(Clone, Default, clap::Args)]
#[group(id = "what is set")]
pub struct Args {
    /// Set values beside the scene's text: `ball.radius=3` those of an attribute, written as in a scene, and `radius=3`
    /// that of a `let`; may be given more than once
    #[arg(long = "set", value_name = "NAME=VALUES")]
    pub values: Vec<String>,
}
