//! The memory use of the program, on systems that report it: Linux.

use super::failure::Failure;
use bytesize::ByteSize;
use std::fs;

/// Returns an error if the system would not provide about `bytes` bytes: an allocation that fails later ends the
/// program with a signal.
pub fn room(bytes: usize, what: &str) -> Result<(), Failure> {
    let refused = |_| {
        Failure::Failed(format!("not enough memory for {what}: it takes about {}", ByteSize(bytes as u64)))
    };
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(refused)
}

/// Returns the memory that the program uses now, in bytes.
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
