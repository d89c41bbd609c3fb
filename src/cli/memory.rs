//! The memory use of the program, on systems that report it: Linux.

use super::failure::Failure;
use bytesize::ByteSize;
use std::fs;

/// Refuses what takes about so many bytes where the system would not give them: allocations further down end the program
/// with a signal.
pub fn room(bytes: usize, what: &str) -> Result<(), Failure> {
    let refused = |_| {
        Failure::Failed(format!("not enough memory for {what}: it takes about {}", ByteSize(bytes as u64)))
    };
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(refused)
}

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
