//! `tabray plan`: how a scene would be rendered, and why.

use crate::command::{Command, Group, Run};
use crate::options::{keep, method, samples, scene};
use crate::process::failure::{Failure, print};
use tabray_core::render::decisions::{self, Decision};
use tabray_core::render::plan::Plan;
use tabray_core::simd::cpu::Cpu;
use tabray_lang::registry::Registry;

/// Explain how a scene would be rendered: each decision with its reason
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    #[command(flatten)]
    samples: samples::Args,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    keep: keep::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray plan ball.ray
  tabray plan ball.ray --samples 4..64";

inventory::submit! {
    Command::new("plan", Group::Inside, &Run(run)).placed(0, 9)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let mut model = args.scene.load(registry, args.method.accuracy()?)?;
    args.samples.apply(&mut model.camera.value)?;
    print(&text(&args.keep.plan(&model)))
}

/// Returns the decisions of a plan, one on each line.
pub fn text(plan: &Plan) -> String {
    let best = format!("{}, the highest level of this machine; the image does not depend on it", Cpu::best());
    let cpu = Decision { subject: "instructions", text: best };
    decisions::of(plan).iter().chain([&cpu]).map(|decision| format!("{decision}\n")).collect()
}
