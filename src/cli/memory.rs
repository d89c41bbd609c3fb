//! The memory use of the program, on systems that report it: Linux.

use std::fs;

/// The memory that it has now, in bytes.
pub fn now() -> Option<u64> {
    status("VmRSS:")
}

/// Returns the most memory that the program has used at one time, in bytes.
///
/// The number from `getrusage` would include the program that started this one.
pub fn peak() -> Option<u64> {
    status("VmHWM:")
}

fn status(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let size = status.lines().find_map(|line| line.strip_prefix(name))?;
    Some(size.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}
