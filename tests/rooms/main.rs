//! The rules of imports: each folder of `src/` imports only from folders below it, and no two files import each other.
//!
//! `docs/architecture.md` lists the folders, from the top layer down; it is compared with the tree here, as
//! `docs/dependencies.md` is with `Cargo.toml`. Imports of a module's tests are left out.

mod imports;

use imports::{Import, Tree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

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

/// Returns the modules of the crate, without separate programs and the templates of `tabray new`.
fn tree() -> Tree {
    let is_module = |path: &PathBuf| {
        let programs = ["src/main.rs", "src/build.rs", "src/cli/new/templates"];
        !programs.iter().any(|program| path.starts_with(program))
    };
    let files = sources("src").into_iter().filter(is_module);
    Tree::new(files.map(|path| (path.clone(), fs::read_to_string(root().join(path)).expect("a file"))))
}

fn architecture() -> String {
    fs::read_to_string(root().join("docs/architecture.md")).expect("the page")
}

/// Returns the folders of the page's table, from the top layer down.
fn rooms(page: &str) -> Vec<&str> {
    let table = page.split("\n## ").find(|part| part.starts_with("Folders\n")).expect("a table of folders");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| [`"));
    rows.filter_map(|row| row.split('`').next()).collect()
}

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
    let (tree, page) = (tree(), architecture());
    assert!(tree.imports.len() > 900, "{} imports are found", tree.imports.len());
    let wrong = from_above(&tree, &rooms(&page));
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn files_take_from_each_other_in_no_circle() {
    let circle = circle(&tree());
    assert_eq!(circle, None, "\n{}\n", circle.iter().flatten().cloned().collect::<Vec<_>>().join("\n"));
}

#[test]
fn plugins_take_what_others_see_alone() {
    let tree = tree();
    let mut hidden = Vec::new();
    for path in sources("plugins") {
        let text = fs::read_to_string(root().join(&path)).expect("a plugin");
        for (line, segments) in imports::crate_paths(&text) {
            if !tree.is_public(&segments) {
                hidden.push(format!("{}:{line}: crate::{} is hidden", path.display(), segments.join("::")));
            }
        }
    }
    assert!(hidden.is_empty(), "a plugin could not stand outside of the package:\n{}\n", hidden.join("\n"));
}

#[test]
fn the_page_lists_the_rooms_that_there_are() {
    let page = architecture();
    let listed: BTreeSet<_> = rooms(&page).into_iter().map(str::to_owned).collect();
    let there: BTreeSet<_> = tree().rooms().into_iter().collect();
    assert_eq!(listed, there);
    assert_eq!(listed.len(), rooms(&page).len(), "each once");
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
fn the_drawing_names_what_is_there() {
    let page = architecture();
    let drawing = page.split("```").nth(1).expect("a drawing");
    let words = drawing.split([' ', ',', '\n']).filter(|word| word.contains('/') && word.len() > 3);
    for word in words.filter(|word| !word.starts_with("plugins/")) {
        assert!(root().join("src").join(word).exists(), "src/{word} is not there");
    }
}

/// Returns the crates in a table of `Cargo.toml` and in the tables of the same name for single systems.
fn crates(manifest: &toml::Table, table: &str) -> BTreeSet<String> {
    let targets = manifest["target"].as_table().expect("targets").values().filter_map(toml::Value::as_table);
    let tables = targets.chain([manifest]).filter_map(|target| target.get(table)?.as_table());
    tables.flat_map(toml::Table::keys).cloned().collect()
}

#[test]
fn every_dependency_has_its_reason() {
    let read = |file| fs::read_to_string(root().join(file)).expect("a text");
    let manifest: toml::Table = toml::from_str(&read("Cargo.toml")).expect("a manifest");
    let page = read("docs/dependencies.md");
    for (title, table) in [("In the program", "dependencies"), ("In the tests", "dev-dependencies")] {
        let section = page.split("\n## ").find(|section| section.starts_with(title)).expect(title);
        let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
        let mut told = BTreeSet::new();
        for row in rows {
            let cells: Vec<_> = row.trim_end_matches(" |").split(" | ").collect();
            assert!(cells.len() == 3 && cells.iter().all(|cell| !cell.is_empty()), "| `{row}");
            assert!(told.insert(cells[0].trim_end_matches('`').to_owned()), "{row} is there twice");
        }
        assert_eq!(told, crates(&manifest, table), "docs/dependencies.md against the {table} of Cargo.toml");
    }
}

fn example(files: &[(&str, &str)]) -> Tree {
    Tree::new(files.iter().map(|(path, text)| (Path::new("src").join(path), (*text).to_owned())))
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
        assert!(wrong[0].starts_with("src/low/b.rs:2: `low::b` takes from `high::a`"), "{wrong:?}");
    }
    for low in [
        "#[cfg(test)]\nmod tests { use crate::high::a::A; }",
        "/// As [`A`](crate::high::a::A).\n// crate::high::a::A\nconst B: &str = \"crate::high::a::A\";",
    ] {
        assert!(wrong(low).is_empty(), "{low}");
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
