//! Lists the files of this folder, so that a file put there is compiled in, and a file deleted there is left out.
//!
//! Writes `$OUT_DIR/plugins.rs`, a macro with a `mod` for each plugin in sorted order; `lib.rs` expands it. The modules'
//! names are raw identifiers, so that a plugin can be named after a keyword of Rust: `box`.

use std::path::Path;
use std::{env, fs, io};

/// The files of this folder that are no plugins.
const OWN: [&str; 2] = ["build", "lib"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=.");
    let mut names = Vec::new();
    for file in fs::read_dir(".")? {
        let path = Path::new("plugins").join(file?.file_name());
        if path.extension().is_none_or(|extension| extension != "rs") {
            continue;
        }
        let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let text = fs::read_to_string(path.file_name().unwrap_or_default())?;
        let registers = text.contains("inventory::submit!");
        // Compiling all of them again for their tests would take a minute.
        if name != "build" && text.contains("#[test]") {
            println!(
                "cargo::warning={}: its tests do not run here: put them into a file of tests/",
                path.display()
            );
        }
        if OWN.contains(&name) {
            if registers && name == "lib" {
                println!(
                    "cargo::error={}: the file of that name lists the plugins: take another name",
                    path.display()
                );
            }
        } else if is_module_name(name) {
            names.push(name.to_owned());
            if !registers {
                println!(
                    "cargo::warning={} registers nothing, so no scene can use it: add `inventory::submit! {{ ... }}`",
                    path.display()
                );
            }
        } else {
            println!(
                "cargo::error={}: a plugin's file name must be a Rust module name, such as `tiled_plane.rs`",
                path.display()
            );
        }
    }
    names.sort();
    let modules: String = names.iter().map(|name| format!("    mod r#{name};\n")).collect();
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    fs::write(
        Path::new(&out).join("plugins.rs"),
        format!("macro_rules! plugins {{ () => {{\n{modules}}} }}\n"),
    )
}

fn is_module_name(name: &str) -> bool {
    // These three keywords cannot be raw identifiers.
    !["crate", "self", "super"].contains(&name)
        && name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}
