//! Encloses a formula's values on an interval, and proves its first zero: `cargo run -p tabray-exact --example bounds`.

use std::fmt::Write;
use tabray_exact::roots::range::RayRange;
use tabray_exact::roots::taylor::{self, FunctionOnLine};
use tabray_exact::{Formula, Interval, Scalar};

/// A formula in y along a line, with y as the distance.
struct Along(Formula);

impl FunctionOnLine for Along {
    fn at<N: Scalar>(&self, t: N) -> N {
        self.0.at(t)
    }
}

/// Describes the bounds of a formula, and its first zero.
pub fn answer() -> Result<String, Box<dyn std::error::Error>> {
    let mut out = String::new();
    let wave = Formula::parse("1.5 + sin(y) - y/4").map_err(|fault| fault.message)?;
    for high in [8.0, 4.0, 2.0, 1.0] {
        let over = wave.at(Interval { low: 0.0, high });
        let has_root = if over.has_zero() { "may be 0" } else { "is not 0" };
        writeln!(out, "y from 0 to {high}: from {:.3} to {:.3}, so it {has_root}", over.low, over.high)?;
    }
    let line = Along(wave);
    let first = taylor::first_root(&line, &(0.0..8.0).into(), 0.0, &RayRange::ALL, 1e-15);
    let root = first.root.ok_or("it has no root")?;
    writeln!(out, "the first root is {root:.12}{}", if first.is_certain { ", which is proven" } else { "" })?;
    Ok(out)
}

#[allow(dead_code, reason = "a test compares the answer")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", answer()?);
    Ok(())
}
