//! Counts the instructions that the program executes. Other than its time, they are the same on a busy machine.

use assert_cmd::cargo::cargo_bin;
use std::process::Command;

/// Returns the number of instructions of a run of the program on one thread, as Valgrind counts them; `None`, with a
/// word, where there is no Valgrind. Valgrind knows no AVX-512, so the program takes AVX2 where the machine has it.
///
/// # Panics
/// If the run fails.
pub fn instructions(args: &[&str]) -> Option<u64> {
    if !Command::new("valgrind").arg("--version").output().is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: there is no Valgrind here, which counts instructions");
        return None;
    }
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(cargo_bin!("tabray"))
        .args(args)
        .args(["--threads", "1"])
        .output()
        .expect("Valgrind runs");
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}\n{report}");
    let count = report.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    Some(count.unwrap_or_else(|| panic!("Valgrind tells no count\n{report}")))
}
