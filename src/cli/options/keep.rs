//! `--keep-all`: whether objects and lights that can change no byte of the image are left out.

use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;

/// Whether everything is traced.
#[derive(clap::Args)]
#[group(id = "what is left out")]
#[command(next_help_heading = "Speed")]
pub struct Args {
    /// Also trace objects and lights that the image does not need; the image is the same
    #[arg(long)]
    keep_all: bool,
}

impl Args {
    /// Makes the plan of a model's image.
    pub fn plan<'m>(&self, model: &'m Model) -> Plan<'m> {
        if self.keep_all { Plan::new(model) } else { Plan::for_picture(model) }
    }
}
