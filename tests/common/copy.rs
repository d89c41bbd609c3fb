//! A copy of the package, into which plugins are dropped.

use super::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A copy of the package to drop files into. What is built of all copies stays, to keep the next run quick.
pub struct Copy {
    /// Where it is.
    pub folder: PathBuf,
    target: PathBuf,
}

impl Copy {
    /// A copy of this name.
    pub fn new(name: &str) -> Self {
        let base = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let copy = Self { folder: base.join(name), target: base.join("dropped-in-target") };
        let _ = fs::remove_dir_all(&copy.folder);
        fs::create_dir_all(&copy.folder).expect("room for a copy");
        for file in ["Cargo.toml", "Cargo.lock"] {
            fs::copy(root().join(file), copy.folder.join(file)).expect("a copy");
        }
        // The reference begins with it.
        fs::create_dir(copy.folder.join("docs")).expect("room for a folder");
        fs::copy(root().join("docs/language.md"), copy.folder.join("docs/language.md")).expect("a copy");
        for folder in ["src", "plugins"] {
            copy_all(&root().join(folder), &copy.folder.join(folder));
        }
        copy
    }

    /// A path that is not in the copy.
    pub fn outside(&self, name: &str) -> PathBuf {
        self.target.join(name)
    }

    /// Builds its program; what cargo says.
    pub fn build(&self) -> String {
        self.cargo(&self.folder, &["build", "--locked"])
    }

    /// Builds its program, if that can be; what cargo says.
    pub fn cargo_build(&self) -> Result<String, String> {
        self.cargo_says(&self.folder, &["build", "--locked"])
    }

    /// What cargo says in a folder of the copy, where all goes well.
    pub fn cargo(&self, folder: &Path, args: &[&str]) -> String {
        self.cargo_says(folder, args).unwrap_or_else(|said| panic!("{said}"))
    }

    fn cargo_says(&self, folder: &Path, args: &[&str]) -> Result<String, String> {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(args).current_dir(folder).env("CARGO_TARGET_DIR", &self.target);
        // Its pictures are small: what counts is how long the compiler takes.
        cargo.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0").env("CARGO_PROFILE_DEV_DEBUG", "0");
        cargo.args(["--config", "profile.dev.package.'*'.opt-level=0"]);
        let output = cargo.output().expect("cargo runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.success() { Ok(said) } else { Err(said) }
    }

    /// Starts a plugin of each kind with the program; their names and their scenes.
    pub fn new_plugins(&self) -> [(&'static str, &'static str); 4] {
        for folder in ["entities", "psphere", "revsurf", "wrong"] {
            fs::create_dir_all(self.folder.join("scenes").join(folder)).expect("room for a folder");
        }
        let plugins = [
            ("shape", "loop", "scenes/entities/loop.ray"),
            ("light", "shade", "scenes/entities/shade.ray"),
            ("shader", "rings", "scenes/psphere/rings.ray"),
            ("profile", "ringed_cup", "scenes/revsurf/ringed_cup.ray"),
        ];
        plugins.map(|(kind, name, scene)| {
            let new = Command::new(self.target.join("debug/tabray"))
                .args(["new", "plugin", name, "--kind", kind])
                .current_dir(&self.folder)
                .output()
                .expect("the program runs");
            assert!(new.status.success(), "{}", String::from_utf8_lossy(&new.stderr));
            (name, scene)
        })
    }

    /// Builds its program with one more beside it, which tries the contracts of all its plugins, and runs that.
    pub fn keeps_contracts(&self) {
        let (folder, program) = (self.folder.join("src/bin"), "contracts");
        fs::create_dir_all(&folder).expect("room for a folder");
        let path = folder.join(program).with_extension("rs");
        fs::write(&path, "//! Contracts.\nfn main() {\n    tabray::tools::contract::assert_kept();\n}\n")
            .expect("room");
        self.cargo(&self.folder, &["build", "--locked", "--bin", program]);
        self.program_prints(program, &[]);
        fs::remove_dir_all(&folder).expect("it was there");
    }

    /// What the program prints.
    pub fn prints(&self, args: &[&str]) -> String {
        self.program_prints("tabray", args)
    }

    /// What a program prints that was built here.
    pub fn program_prints(&self, program: &str, args: &[&str]) -> String {
        let program = self.target.join("debug").join(program);
        let Output { status, stdout, stderr } =
            Command::new(program).args(args).output().expect("the program runs");
        assert!(status.success(), "{args:?}: {}", String::from_utf8_lossy(&stderr));
        String::from_utf8(stdout).expect("text")
    }

    /// What the program says of a scene on standard input.
    pub fn run(&self, args: &[&str], scene: &str) -> String {
        let program = self.target.join("debug/tabray");
        let output =
            assert_cmd::Command::new(program).args(args).write_stdin(scene).output().expect("it runs");
        String::from_utf8(output.stderr).expect("text")
    }

    /// Every file of the copy and what is in it.
    pub fn files(&self) -> BTreeSet<(PathBuf, Vec<u8>)> {
        let mut files = BTreeSet::new();
        let mut folders = vec![self.folder.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    files.insert((path.clone(), fs::read(&path).expect("a file")));
                }
            }
        }
        files
    }
}

/// Copies a folder.
pub fn copy_all(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("room for a copy");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy_all(&path, &target);
        } else {
            fs::copy(&path, &target).expect("a copy");
        }
    }
}
