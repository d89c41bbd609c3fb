//! What rays hit: against the notes' numbers, against true ones, and against what each plugin promises.

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod arithmetic;
mod contract;
mod double_double;
mod implicit;
mod notes;
mod stability;
