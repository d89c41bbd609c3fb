//! The program as users run it, command by command.

#![allow(clippy::disallowed_methods, reason = "no picture depends on what a test computes")]

#[path = "../common/mod.rs"]
mod common;

mod alpha;
mod bench;
mod cameras;
mod certain;
mod cli;
mod colours;
mod cures;
mod discovery;
mod editor;
mod failures;
mod farm;
mod firsthour;
mod fmt;
mod frames;
mod full_range;
mod grade;
mod help;
mod hits;
mod leaving;
mod light;
mod limits;
mod messages;
mod new;
mod overlay;
mod parts;
mod print;
mod programs;
mod refusals;
mod review;
mod samples;
mod server;
mod size;
#[cfg(target_os = "linux")]
mod stops;
mod surfaces;
#[cfg(unix)]
mod terminals;
#[cfg(target_os = "linux")]
mod trust;
mod undecided;
mod watch;
