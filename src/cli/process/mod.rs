//! What all commands share as a process: arguments, messages, interrupts, limits, exit statuses.

pub mod arguments;
pub mod bounds;
pub mod color;
pub mod crash;
pub mod failure;
pub mod help;
pub mod interrupt;
pub mod memory;
pub mod messages;
pub mod program;
pub mod progress;
pub mod temporary;
pub mod time_limit;
pub mod visible;
