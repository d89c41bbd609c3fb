//! What the pages say of the tree is so: links and drawings lead to files, and `docs/data` lists the crates that the
//! manifests name.

use std::collections::BTreeSet;
use std::fs;
use std::iter;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn architecture() -> String {
    fs::read_to_string(root().join("docs/architecture.md")).expect("the page")
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
