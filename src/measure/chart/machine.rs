//! Where and when a chart was measured.

use std::fs;
use std::thread;
use std::time::SystemTime;
use tabray_core::simd::cpu::Cpu;

/// A machine, a build of the program, and a time.
#[derive(Clone)]
pub struct Machine {
    /// The processor's name according to the system, the level of CPU instructions that is used, and the number of its
    /// threads.
    pub processor: String,
    /// The program's version and its build settings.
    pub build: String,
    /// The time in UTC, such as `2026-11-21 09:30`.
    pub date: String,
}

impl Machine {
    /// Describes this machine, this build and the current time.
    pub fn here() -> Self {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let target = format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS);
        let build = if cfg!(debug_assertions) { "debug build" } else { "release build" };
        let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        Self {
            processor: format!(
                "{}, {}, {threads} thread{}",
                name().unwrap_or_else(|| target.clone()),
                Cpu::best(),
                if threads == 1 { "" } else { "s" }
            ),
            build: format!("tabray {}, {build} for {target}", env!("CARGO_PKG_VERSION")),
            date: now[..16].replace('T', " "),
        }
    }
}

/// Returns the processor's name according to Linux.
fn name() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
