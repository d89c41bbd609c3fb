//! The rules of imports that Cargo does not hold: in the core, each folder imports only from folders below it, and in no
//! crate two files import each other.
//!
//! `docs/architecture.md` lists the crates and the folders of the core, from the top layer down; it is compared with the
//! tree here, as `docs/data/dependencies.csv` is with the manifests. Imports of a module's tests are left out.

mod imports;

use imports::{Import, Tree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::iter;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns all `.rs` files below a folder, with paths from the package's folder.
fn sources(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if entry.is_dir() {
                folders.push(entry);
            } else if entry.extension().is_some_and(|extension| extension == "rs") {
                found.push(entry.strip_prefix(root()).expect("below the package").to_owned());
            }
        }
    }
    found.sort();
    found
}

/// The crates, from the bottom up, but for the program and the plugins, whose files are few or import nothing.
const CRATES: [&str; 7] = ["exact", "core", "lang", "tools", "cli", "python", "web"];

/// Returns the modules of a crate, without its examples and the templates of `tabray new`.
fn tree(crate_: &str) -> Tree {
    let files = sources(&format!("src/{crate_}")).into_iter();
    let is_example = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "examples");
    let files = files.filter(|path| !path.starts_with("src/cli/new/templates") && !is_example(path));
    Tree::new(files.map(|path| (path.clone(), fs::read_to_string(root().join(path)).expect("a file"))))
}

fn architecture() -> String {
    fs::read_to_string(root().join("docs/architecture.md")).expect("the page")
}

/// Returns what a table of the page lists, from the top layer down.
fn listed<'p>(page: &'p str, title: &str) -> Vec<&'p str> {
    let table = page.split("\n## ").find(|part| part.starts_with(title)).expect("a table");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| [`"));
    rows.filter_map(|row| row.split('`').next()).collect()
}

/// The title of the table of the core's folders.
const ROOMS: &str = "The rooms of the core\n";

/// Describes the imports from folders that do not lie below.
fn from_above(tree: &Tree, rooms: &[&str]) -> Vec<String> {
    let floor =
        |module: &[String]| rooms.iter().position(|room| Some(*room) == module.first().map(String::as_str));
    let is_wrong = |import: &&Import| {
        let (from, to) = (floor(&import.from), floor(&import.to));
        // The prelude is for plugins only.
        from > to || import.from[0] != import.to[0] && import.to[0] == "prelude"
    };
    let told =
        |import: &Import| format!("{import}, and `{}` does not lie below `{}`", import.to[0], import.from[0]);
    tree.imports.iter().filter(is_wrong).map(told).collect()
}

/// Returns a cycle of imports, if there is one.
fn circle(tree: &Tree) -> Option<Vec<String>> {
    let mut onward: BTreeMap<&[String], Vec<&Import>> = BTreeMap::new();
    for import in &tree.imports {
        onward.entry(&import.from).or_default().push(import);
    }
    let mut done = BTreeSet::new();
    for start in onward.keys() {
        // The path to the current module, and for each module on it the index of the next import to follow.
        let mut way: Vec<&Import> = Vec::new();
        let mut waiting = vec![(*start, 0)];
        while let Some((module, next)) = waiting.last_mut() {
            let import =
                if done.contains(module) { None } else { onward.get(module).and_then(|all| all.get(*next)) };
            *next += 1;
            let Some(import) = import else {
                done.insert(*module);
                waiting.pop();
                way.pop();
                continue;
            };
            way.push(import);
            if let Some(begin) = waiting.iter().position(|(module, _)| *module == import.to) {
                return Some(way[begin..].iter().map(|import| import.to_string()).collect());
            }
            waiting.push((&import.to, 0));
        }
    }
    None
}

#[test]
fn rooms_take_from_rooms_below_alone() {
    let (tree, page) = (tree("core"), architecture());
    assert!(tree.imports.len() > 400, "{} imports are found", tree.imports.len());
    let wrong = from_above(&tree, &listed(&page, ROOMS));
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn files_take_from_each_other_in_no_circle() {
    for crate_ in CRATES {
        let circle = circle(&tree(crate_));
        let told = circle.iter().flatten().cloned().collect::<Vec<_>>().join("\n");
        assert_eq!(circle, None, "\n{crate_}:\n{told}\n");
    }
}

#[test]
fn the_page_lists_the_rooms_that_there_are() {
    let page = architecture();
    let rooms = listed(&page, ROOMS);
    let there: BTreeSet<_> = tree("core").rooms().into_iter().collect();
    assert_eq!(rooms.iter().map(|room| (*room).to_owned()).collect::<BTreeSet<_>>(), there);
    assert_eq!(rooms.len(), there.len(), "each once");
}

/// Returns the Markdown files of a folder, by their names.
fn pages(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(root().join(folder)).expect("a folder").map(|file| file.expect("a file").path());
    let mut pages: Vec<_> = files.filter(|path| path.extension().is_some_and(|name| name == "md")).collect();
    pages.sort();
    pages
}

/// Returns the files that a page links to, without the headings in them.
fn links(page: &str) -> impl Iterator<Item = &str> {
    let links = page.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    links.filter(|link| !link.is_empty() && !link.contains("://"))
}

#[test]
fn pages_link_to_what_is_there() {
    let mut broken = Vec::new();
    for page in pages(".").into_iter().chain(pages("docs")) {
        let text = fs::read_to_string(&page).expect("a page");
        let missing = links(&text).filter(|link| !page.with_file_name(link).exists());
        broken.extend(missing.map(|link| format!("{}: {link}", page.display())));
    }
    assert!(broken.is_empty(), "these links lead nowhere:\n{}", broken.join("\n"));
}

#[test]
fn the_index_lists_the_pages_that_there_are() {
    let index = fs::read_to_string(root().join("docs/README.md")).expect("the index");
    let listed: BTreeSet<_> = links(&index).filter(|link| !link.starts_with("..")).collect();
    let pages = pages("docs");
    let names = pages.iter().filter_map(|page| page.file_name()?.to_str());
    assert_eq!(listed, names.filter(|name| *name != "README.md").collect());
}

#[test]
fn the_drawings_name_what_is_there() {
    let page = architecture();
    let drawings: String = page.split("```").skip(1).step_by(2).collect();
    let words =
        drawings.split([' ', ',', '\n', ':', ';']).filter(|word| word.contains('/') && word.len() > 3);
    for word in words.filter(|word| !word.starts_with("plugins/")) {
        let path = root().join("src").join(word.trim_start_matches("src/"));
        assert!(path.exists(), "src/{word} is not there");
    }
}

/// Returns the manifests of the program and of the workspace's members.
fn manifests() -> Vec<toml::Table> {
    let read = |folder: &str| {
        let text = fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("a manifest");
        toml::from_str::<toml::Table>(&text).expect("a manifest in TOML")
    };
    let all = read(".");
    let members = all["workspace"]["members"].as_array().expect("members").clone();
    iter::once(all).chain(members.iter().map(|member| read(member.as_str().expect("a folder")))).collect()
}

/// Returns the external crates in the tables of this name, also those for single systems.
fn crates(manifest: &toml::Table, table: &str) -> BTreeSet<String> {
    let targets = manifest.get("target").and_then(toml::Value::as_table);
    let targets = targets.into_iter().flat_map(toml::Table::values).filter_map(toml::Value::as_table);
    let tables = targets.chain([manifest]).filter_map(|target| target.get(table)?.as_table());
    let names = tables.flat_map(toml::Table::keys);
    names.filter(|name| !name.starts_with("tabray")).cloned().collect()
}

/// Returns the rows of a table in `docs/data`, but for the names of its columns.
fn table(name: &str) -> Vec<Vec<String>> {
    let text =
        fs::read_to_string(root().join("docs/data").join(name).with_extension("csv")).expect("a table");
    text.lines().skip(1).map(cells).collect()
}

/// Returns the cells of a row of comma-separated values.
fn cells(row: &str) -> Vec<String> {
    let (mut cells, mut is_quoted) = (vec![String::new()], false);
    for letter in row.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            _ => cells.last_mut().expect("a first cell").push(letter),
        }
    }
    cells
}

#[test]
fn crates_that_read_hostile_bytes_are_those_that_are_linked() {
    let lock = fs::read_to_string(root().join("Cargo.lock")).expect("the locked versions");
    for row in table("hostile") {
        assert!(row.len() == 5 && row.iter().all(|cell| !cell.is_empty()), "{row:?}");
        for name in row[0].split(", ") {
            assert!(lock.contains(&format!("\nname = \"{name}\"\n")), "no crate is named {name}");
        }
    }
}

#[test]
fn every_dependency_has_its_reason() {
    let all = |table: &str| -> BTreeSet<String> {
        manifests().iter().flat_map(|manifest| crates(manifest, table)).collect()
    };
    let program = all("dependencies");
    // A crate that the program has, tests have too.
    let tests = all("dev-dependencies").into_iter().filter(|name| name == "nix" || !program.contains(name));
    let tests = tests.collect();
    for (where_, there) in [("program", &program), ("tests", &tests)] {
        let mut told = BTreeSet::new();
        for row in table("dependencies") {
            let [name, used_in, what, why] = &row[..] else { panic!("{row:?}") };
            assert!(!what.is_empty() && !why.is_empty(), "{row:?}");
            assert!(used_in != where_ || told.insert(name.clone()), "{name} is there twice");
        }
        assert_eq!(told, *there, "docs/data/dependencies.csv against the manifests");
    }
}

fn example(files: &[(&str, &str)]) -> Tree {
    Tree::new(files.iter().map(|(path, text)| (Path::new("src/core").join(path), (*text).to_owned())))
}

#[test]
fn imports_from_above_are_found() {
    let files = |low: &'static str| {
        [
            ("high/mod.rs", "pub mod a; pub use a::A;"),
            ("high/a.rs", "use crate::low::b::B;\npub struct A;"),
            ("low/mod.rs", "pub mod b;"),
            ("low/b.rs", low),
        ]
    };
    let wrong = |low: &'static str| from_above(&example(&files(low)), &["high", "low"]);
    assert!(wrong("pub struct B;").is_empty());
    for low in [
        "\nuse crate::high::a::A;",
        "\nuse {std::fmt, crate::high::{a::{self, A}}};",
        "\nfn f() { if true { g(crate::high::A::new()) } }",
        "\nmacro! { fn f() => { let a = $crate::high::a::A; } }",
        "\nmod inner { use super::super::super::high::A; }",
    ] {
        let wrong = wrong(low);
        assert!(!wrong.is_empty(), "{low}");
        assert!(wrong[0].starts_with("src/core/low/b.rs:2: `low::b` takes from `high::a`"), "{wrong:?}");
    }
    for low in [
        "#[cfg(test)]\nmod tests { use crate::high::a::A; }",
        "/// As [`A`](crate::high::a::A).\n// crate::high::a::A\nconst B: &str = \"crate::high::a::A\";",
    ] {
        assert!(wrong(low).is_empty(), "{low}");
    }
}

#[test]
fn packages_by_themselves_are_in_no_workspace() {
    for folder in ["docs/example-plugin", "tests/fuzz", "tests/wasm"] {
        let manifest = root().join(folder).join("Cargo.toml");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["locate-project", "--workspace", "--message-format", "plain", "--manifest-path"]);
        let found = cargo.arg(&manifest).output().expect("cargo runs");
        let said = String::from_utf8_lossy(&found.stderr);
        assert_eq!(
            String::from_utf8_lossy(&found.stdout).trim_end(),
            manifest.display().to_string(),
            "{said}"
        );
    }
}

#[test]
fn circles_are_found() {
    let wrong = |files: &[(&str, &str)]| circle(&example(files));
    let straight = [("r/mod.rs", "mod a; mod b; use a::A;"), ("r/a.rs", "use super::b::B;"), ("r/b.rs", "")];
    assert_eq!(wrong(&straight), None);
    let by_a_file = [straight[0], straight[1], ("r/b.rs", "\nuse crate::r::a::A;")];
    assert_eq!(wrong(&by_a_file).map(|circle| circle.len()), Some(2));
    let by_the_folder =
        [("r/mod.rs", "mod a; fn f() { a::g() } pub const N: u8 = 1;"), ("r/a.rs", "use super::N;")];
    assert_eq!(wrong(&by_the_folder).map(|circle| circle.len()), Some(2));
    // A method in a file other than its type's is imported from that file.
    let by_a_method = [
        ("r/mod.rs", "mod a; mod b;"),
        ("r/a.rs", "pub struct A; impl A { fn f(&self) { self.g() } }"),
        ("r/b.rs", "use super::a::A; impl A { fn g(&self) {} }"),
    ];
    assert_eq!(wrong(&by_a_method).map(|circle| circle.len()), Some(2));
}
