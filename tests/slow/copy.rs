//! A copy of the package with further plugins in it, and beside it the crate that has a plugin of its own; built once
//! for all tests that use it.

use crate::common::root;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The programs of a copy, and the messages of its build.
pub struct Built {
    programs: PathBuf,
    /// The messages of cargo.
    pub said: String,
    /// The files of the copy that the build added or changed.
    pub touched: Vec<PathBuf>,
}

/// The folders and files that are copied.
const PARTS: [&str; 8] = [
    "Cargo.toml",
    "Cargo.lock",
    "src",
    "plugins",
    // The manifest names it.
    "scenes/generate.rs",
    // The reference begins with this file.
    "docs/language.md",
    "docs/example-plugin/Cargo.toml",
    "docs/example-plugin/src",
];

/// The files of a copy, by their paths in it.
pub type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Returns the folder in which copies are made and built.
fn base() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// Builds a copy with further files, given by their paths in it, and keeps its programs under this name.
pub fn build(name: &str, more: Files) -> Built {
    let (lock, folder) = (base().join("copy.lock"), base().join("copy"));
    let lock = File::create(lock).and_then(|lock| lock.lock().map(|()| lock)).expect("a lock");
    let files = with_package(more);
    write(&folder, &files);
    let said = cargo(&folder).unwrap_or_else(|said| panic!("{said}"));
    let touched = read(&folder).into_iter().filter(|(path, bytes)| files.get(path) != Some(bytes));
    let touched = touched.map(|(path, _)| path).filter(|path| !path.ends_with("Cargo.lock")).collect();
    // The copy that cannot be built is made in the same place, so the programs are kept elsewhere.
    let programs = base().join(name);
    fs::create_dir_all(&programs).expect("room for a folder");
    for program in ["tabray", "contracts", "count", "rival", "twin", "example-plugin"] {
        fs::copy(base().join("copy-target/debug").join(program), programs.join(program)).expect("a program");
    }
    drop(lock);
    Built { programs, said, touched }
}

/// Returns cargo's messages about a copy with further files that cannot be built.
pub fn cannot_be_built(more: Files) -> String {
    let lock =
        File::create(base().join("copy.lock")).and_then(|lock| lock.lock().map(|()| lock)).expect("a lock");
    let folder = base().join("copy");
    write(&folder, &with_package(more));
    let said = cargo(&folder).expect_err("it cannot be built");
    drop(lock);
    said
}

/// Returns the package's own files and further ones.
fn with_package(more: Files) -> Files {
    let mut files = Files::new();
    for part in PARTS {
        collect(root(), Path::new(part), &mut files);
    }
    // In one workspace, both crates are built with the same features of their dependencies, and so with the same
    // libraries.
    let manifest = files.get_mut(Path::new("Cargo.toml")).expect("a manifest");
    let text = String::from_utf8_lossy(manifest);
    let text = text.replace("members = [", "members = [\"docs/example-plugin\", ");
    *manifest = text.replace("exclude = [\"docs/example-plugin\", ", "exclude = [").into_bytes();
    files.extend(more);
    files
}

/// Builds all programs of a copy, and returns cargo's messages.
fn cargo(folder: &Path) -> Result<String, String> {
    let mut cargo = Command::new(env!("CARGO"));
    // Since examples may use the dependencies of tests, building them selects the same features as building tests, and
    // the libraries are already there.
    cargo.args(["build", "--offline", "--workspace", "--bins", "--examples"]).current_dir(folder);
    cargo.env("CARGO_TARGET_DIR", base().join("copy-target")).env("CARGO_BUILD_BUILD_DIR", base().join(".."));
    // The images are small, so the time of compilation matters more than that of rendering. The crate with a plugin of
    // its own takes seconds to compile, and its image half a minute without optimization.
    cargo.args(["--config", concat!(env!("CARGO_MANIFEST_DIR"), "/.ci/unoptimized.toml")]);
    cargo.args(["--config", "profile.dev.package.example-plugin.opt-level=2"]);
    // One copy after the other is built, each with other plugins.
    cargo.env("CARGO_INCREMENTAL", "1");
    let output = cargo.output().expect("cargo runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() { Ok(said) } else { Err(said) }
}

impl Built {
    /// Runs a program of the copy, and returns its standard output.
    pub fn prints_of(&self, program: &str, args: &[&str]) -> String {
        let Output { status, stdout, stderr } =
            Command::new(self.programs.join(program)).args(args).output().expect("the program runs");
        assert!(status.success(), "{args:?}: {}", String::from_utf8_lossy(&stderr));
        String::from_utf8(stdout).expect("text")
    }

    /// Runs `tabray`, and returns its standard output.
    pub fn prints(&self, args: &[&str]) -> String {
        self.prints_of("tabray", args)
    }

    /// Runs `tabray` with a scene on standard input, and returns its standard error.
    pub fn says(&self, args: &[&str], scene: &str) -> String {
        self.says_of("tabray", args, scene)
    }

    /// Runs a program of the copy with a scene on standard input, and returns its standard error.
    pub fn says_of(&self, program: &str, args: &[&str], scene: &str) -> String {
        let mut program = Command::new(self.programs.join(program));
        let mut program =
            program.args(args).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        io::copy(&mut scene.as_bytes(), &mut program.stdin.take().expect("it is piped")).expect("it reads");
        String::from_utf8(program.wait_with_output().expect("it ends").stderr).expect("text")
    }

    /// Renders a scene's file with a program of the copy.
    pub fn picture_of(&self, program: &str, scene: &Path) -> image::RgbImage {
        let picture = self.programs.join(scene.file_name().expect("a name")).with_extension("png");
        let paths = [scene, &picture].map(|path| path.to_str().expect("a path in UTF-8"));
        self.prints_of(program, &["render", paths[0], "-o", paths[1]]);
        image::open(&picture).expect("a picture").into_rgb8()
    }

    /// Renders a scene's text with `tabray`.
    pub fn picture(&self, name: &str, scene: &str) -> image::RgbImage {
        self.picture_of("tabray", &self.scene(name, scene))
    }

    /// Writes a scene's text to a file.
    pub fn scene(&self, name: &str, scene: &str) -> PathBuf {
        let path = self.programs.join(name).with_extension("ray");
        fs::write(&path, scene).expect("room for a file");
        path
    }
}

/// Reads all files of a folder.
pub fn read(folder: &Path) -> Files {
    let mut files = Files::new();
    collect(folder, Path::new(""), &mut files);
    files
}

/// Adds a file or all files of a folder, by their paths from `root`.
fn collect(root: &Path, path: &Path, files: &mut Files) {
    if root.join(path).is_dir() {
        for entry in fs::read_dir(root.join(path)).expect("a folder") {
            collect(root, &path.join(entry.expect("an entry").file_name()), files);
        }
    } else {
        files.insert(path.to_owned(), fs::read(root.join(path)).expect("a file"));
    }
}

/// Makes a folder hold these files and no others. Files that already have these contents are not touched, so that they
/// need not be compiled again.
fn write(folder: &Path, files: &Files) {
    fs::create_dir_all(folder).expect("room for a folder");
    let there = read(folder);
    for path in there.keys().filter(|path| !files.contains_key(*path)) {
        fs::remove_file(folder.join(path)).expect("it was there");
    }
    for (path, bytes) in files.iter().filter(|(path, bytes)| there.get(*path) != Some(bytes)) {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("room for a folder");
        fs::write(path, bytes).expect("room for a file");
    }
}
