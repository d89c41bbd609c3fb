//! Tests of all answers together, on the scenes of the repository and on random edits of them.

use super::*;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_lang::dump;
use tabray_lang::reader::Token;
use tabray_lang::reader::{self, Report};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

fn registry() -> &'static Registry {
    Registry::get().expect("no two plugins claim one name")
}

/// Returns the files of a folder and its subfolders, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Returns the text scenes of the repository, with their contents.
fn scenes() -> Vec<(PathBuf, String)> {
    let all = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"));
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|end| end == "ray" || end == "toml");
    let text = |path: PathBuf| Some((path.clone(), fs::read_to_string(path).ok()?));
    all.into_iter().filter(is_scene).filter_map(text).collect()
}

fn view(path: &Path, text: &str) -> View {
    read(registry(), &path.to_string_lossy(), Text::new(text))
}

/// Returns the content of a scene regardless of its form: its dump, or its errors.
fn meaning(path: &Path, text: &str) -> Result<String, Vec<String>> {
    let folder = path.parent().expect("a folder");
    match reader::read(registry(), "a scene", folder, text.as_bytes(), None) {
        Ok(loaded) => Ok(dump::scene(&loaded.model, Syntax::Notes)),
        Err(report) => Err(report.faults().iter().map(|fault| fault.message.clone()).collect()),
    }
}

#[test]
fn formatting_changes_neither_meaning_nor_comments_and_ends_at_once() {
    let mut formats = 0;
    for (path, text) in scenes() {
        let Some(new) = formatted(&view(&path, &text)) else {
            assert!(
                path.starts_with(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/wrong")),
                "{}",
                path.display()
            );
            continue;
        };
        formats += 1;
        assert_eq!(formatted(&view(&path, &new)).as_ref(), Some(&new), "{}", path.display());
        let comments = |text: &str| -> Vec<String> {
            let comment = |line: &str| Some(line[line.find('#')?..].trim_end().to_owned());
            text.lines().filter(|line| !line.contains('"')).filter_map(comment).collect()
        };
        assert_eq!(comments(&new), comments(&text), "{}", path.display());
        // Large scenes take long to load, and have the same elements as the others.
        if text.len() < 1 << 16 {
            assert_eq!(meaning(&path, &new), meaning(&path, &text), "{}", path.display());
        }
    }
    assert!(formats > 200, "{formats} scenes are formatted");
}

#[test]
fn a_form_is_that_of_the_scenes() {
    let format = |name: &str, text: &str| formatted(&view(Path::new(name), text)).expect("a sound form");
    let notes = "# a\n\n\n\ncamera  eye # viewer\n{ # opens\npixeldim 160 # wide\n 120   # high\n\n worlddim 8 6\n# c\nviewpoint\
                 \t4 3 6 }# closes\nlet a 1\nlet radius   2\nsphere b{material red center 1 2 3 radius 4}plane longer { material \
                 blue  normal 0 0 1 }\nrepeat i   3 { sphere c { material red } }";
    insta::assert_snapshot!(format("a.ray", notes), @r##"
    # a

    camera eye # viewer
    { # opens
        pixeldim  160 # wide
                  120 # high

        worlddim  8 6
        # c
        viewpoint 4 3 6
    } # closes
    let a      1
    let radius 2
    sphere b      { material red   center 1 2 3  radius 4 }
    plane  longer { material blue  normal 0 0 1 }
    repeat i 3 {
        sphere c { material red }
    }
    "##);
    let toml = "include=\"a\"\n\n\n[camera.eye]  # x\npixeldim=[160,120]\n\nworlddim = [ 8 ,6 ]\nviewpoint= [\n4, # a\n 3,\n6 ]\n\
                sphere.b={radius=1,material=\"red\"}";
    insta::assert_snapshot!(format("a.toml", toml), @r##"
    include = "a"

    [camera.eye] # x
    pixeldim = [160, 120]

    worlddim  = [8, 6]
    viewpoint = [
        4, # a
        3,
        6]
    sphere.b = { radius = 1, material = "red" }
    "##);
    assert_eq!(format("a.ray", "camera eye {\r\n}\r\n"), "camera eye\r\n{\r\n}\r\n");
    assert_eq!(formatted(&view(Path::new("a.ray"), "camera eye { viewpoint 1")), None);
    for wrong in [
        "[[[",
        "[[a.b]]]",
        "[.a]",
        "a = \"x",
        "a = 1 2",
        "a =",
        "= 1",
        "a = 1\rb = 2",
        "a = tru",
        "a = 1 # \u{1}",
    ] {
        assert_eq!(formatted(&view(Path::new("a.toml"), wrong)), None, "{wrong:?}");
    }
    assert!(formatted(&view(Path::new("a.toml"), "a = 1\na = 2")).is_some(), "its form has no errors");
}

/// Adds the places of the words and braces of items in the notes' syntax.
fn places(items: &[view::Item], found: &mut Vec<Range<usize>>) {
    let keyword = |place: &Range<usize>, keyword: &str| place.start..place.start + keyword.len();
    let braces = |body: &Range<usize>| [body.start - 1..body.start, body.end..body.end + 1];
    for item in items {
        match item {
            view::Item::Entity(entity) => {
                found.extend(braces(&entity.body));
                found.extend([entity.kind].into_iter().chain(entity.name).map(view::Word::place));
                for attribute in &entity.attributes {
                    found.extend(
                        [&[attribute.name], &attribute.values[..]].concat().iter().map(|word| word.place()),
                    );
                }
            }
            view::Item::Let(number) => {
                found.push(keyword(&number.place, "let"));
                found.extend([number.name, number.value].into_iter().flatten().map(view::Word::place));
            }
            view::Item::Include(include) => {
                found.push(keyword(&include.place, "include"));
                found.extend(include.files.iter().map(|file| file.place()));
            }
            view::Item::Repeat(repeat) => {
                found.push(keyword(&repeat.place, "repeat"));
                found.extend(braces(&repeat.body));
                found.extend([repeat.name, repeat.count].into_iter().flatten().map(view::Word::place));
                places(&repeat.items, found);
            }
        }
    }
}

#[test]
fn a_view_holds_each_word_and_brace_of_a_sound_scene() {
    let mut scenes = scenes();
    let values = "1 ".repeat(5000);
    scenes
        .push((PathBuf::from("many.ray"), format!("sphere ball {{ radius {values}}} # more than are right")));
    let mut views = 0;
    for (path, text) in scenes {
        let view = view(&path, &text);
        if view.syntax == Syntax::Toml || !view.breaks.is_empty() {
            continue;
        }
        views += 1;
        let (mut found, mut wanted, mut at) = (Vec::new(), Vec::new(), 0);
        places(&view.items, &mut found);
        found.sort_unstable_by_key(|place| place.start);
        while let Some(token) = Token::at(&text, at, &mut Report::default()) {
            at = token.end;
            wanted.extend((!token.is_trivia()).then(|| token.place()));
        }
        assert_eq!(found, wanted, "{}", path.display());
    }
    assert!(views > 100, "{views} views");
}

#[test]
fn a_view_ends_values_where_the_reader_does() {
    let text = "place ring { object ball  rotation 90 0 0 translation 6 1 -2 }\nunion both { objects ball ring material grey }\n";
    let form = formatted(&view(Path::new("a.ray"), text)).expect("a sound form");
    assert!(
        form.contains(" rotation 90 0 0  translation 6 1 -2 ") && form.contains(" ball ring  material grey "),
        "{form}"
    );
}

#[test]
fn a_stray_word_leaves_what_is_repeated_its_brace() {
    let scene =
        "camera eye { pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }\nmaterial red { ambient 9 0 0 }\n";
    let text = format!(
        "{scene}repeat i 2 {{ sphere ball {{ material red  center 4 3 0  radius 1 }} stray }}\n\
         sphere other {{ material red  center 4 3 0  radius 1 }}"
    );
    let view = view(Path::new("a.ray"), &text);
    assert_eq!(
        view.breaks.iter().map(|fault| fault.message.as_str()).collect::<Vec<_>>(),
        ["stray word `stray`"]
    );
    assert!(view.entity("other").is_some());
    assert_eq!(meaning(Path::new("a.ray"), &text), Err(vec!["stray word `stray`".to_owned()]));
}

/// The open files of a test.
struct Open(BTreeMap<PathBuf, Arc<View>>);

impl Files for Open {
    fn view(&self, path: &Path) -> Option<Arc<View>> {
        self.0.get(path).cloned()
    }
}

fn open(files: &[(&Path, &str)]) -> Open {
    Open(files.iter().map(|(path, text)| (path.to_path_buf(), Arc::new(view(path, text)))).collect())
}

/// Applies the changes of one file to its text.
fn changed(text: &str, path: &Path, mut changes: Vec<(Location, String)>) -> String {
    let mut text = text.to_owned();
    changes.sort_by_key(|(found, _)| std::cmp::Reverse(found.place.start));
    for (found, with) in changes {
        assert_eq!(found.path, path);
        text.replace_range(found.place, &with);
    }
    text
}

#[test]
fn a_name_that_is_changed_there_and_back_leaves_the_text_as_it_was() {
    let mut names = 0;
    for (path, text) in scenes() {
        if text.len() > 1 << 14 || meaning(&path, &text).is_err() || text.contains("include") {
            continue;
        }
        let first = open(&[(&path, &text)]);
        let all = first.0[&path].names();
        for definition in all.definitions.iter().take(20) {
            // Lights may share a name, and unneeded quotes of a name are not written again.
            let at = definition.name.place.start;
            let is_shared = all.named(definition.name.namespace, &definition.name.text).len() > 1;
            if is_shared || text[..at].ends_with(['"', '\'']) {
                continue;
            }
            let there = renamed(&group(&first, &path, &[]), at, "other_name").expect("a name that is free");
            let new = changed(&text, &path, there);
            assert!(meaning(&path, &new).is_ok(), "{}: {}\n{new}", path.display(), definition.name.text);
            let second = open(&[(&path, &new)]);
            let back = group(&second, &path, &[]);
            let back = renamed(&back, new.find("other_name").expect("the name"), &definition.name.text);
            let old = changed(&new, &path, back.expect("the old name is free"));
            assert_eq!(old, text, "{}: {}", path.display(), definition.name.text);
            names += 1;
        }
    }
    assert!(names > 500, "{names} names are changed");
}

/// Asks everything about a position, and checks that all answers lie in the text.
fn ask(path: &Path, text: &Text, at: usize) {
    let view = Arc::new(read(registry(), &path.to_string_lossy(), text.clone()));
    let (at, length) = (tabray_core::text::boundary(text.as_str(), at), text.as_str().len());
    let check = |place: &Range<usize>| {
        assert!(place.start <= place.end && place.end <= length, "{place:?} of {length}");
        assert!(text.as_str().get(place.clone()).is_some(), "{place:?} cuts a character");
        assert_eq!(text.offset(text.position(place.start)), text.offset(text.position(place.start)));
    };
    let files = Open(BTreeMap::from([(path.to_owned(), view.clone())]));
    let group = group(&files, path, &[]);
    completions(registry(), &group, at).iter().for_each(|one| check(&one.place));
    hover(&group, at).iter().for_each(|hover| check(&hover.place));
    if let Some(signature) = signature(&view, at) {
        assert!(signature.active < signature.values.len());
    }
    definitions(&group, at).iter().chain(&usages(&group, at, true)).for_each(|found| check(&found.place));
    for (found, _) in renamed(&group, at, "other").into_iter().flatten() {
        check(&found.place);
    }
    name_at_cursor(&view, at).iter().for_each(|meant| check(&meant.place));
    hints(&view, &(0..length)).iter().for_each(|hint| check(&(hint.at..hint.at)));
    let tokens = semantic_tokens(&view);
    tokens.iter().for_each(|token| check(&token.place));
    assert!(tokens.is_sorted_by(|one, next| one.place.end <= next.place.start), "{tokens:?}");
    for swatch in colours(&view) {
        check(&swatch.place);
        presented(&view, &swatch.place, swatch.colour);
    }
    fn within(symbol: &Symbol, check: &dyn Fn(&Range<usize>)) {
        check(&symbol.place);
        check(&symbol.name_place);
        assert!(symbol.place.start <= symbol.name_place.start && symbol.name_place.end <= symbol.place.end);
        symbol.inner.iter().for_each(|inner| within(inner, check));
    }
    outline(&view).iter().for_each(|symbol| within(symbol, &check));
    folds(&view).iter().for_each(|fold| assert!(fold.lines[0] < fold.lines[1]));
    if let Some(new) = formatted(&view) {
        let letters = |text: &str| {
            let mut letters: Vec<_> = text.chars().filter(|letter| !letter.is_whitespace()).collect();
            letters.sort_unstable();
            letters
        };
        assert_eq!(letters(&new), letters(text.as_str()), "{:?}", text.as_str());
        let again = read(registry(), &path.to_string_lossy(), Text::new(new.as_str()));
        assert_eq!(formatted(&again), Some(new), "{:?}", text.as_str());
    }
}

/// Random edits of scenes, each followed by all questions: `TABRAY_EDITS` of them, or a thousand.
#[test]
fn a_text_that_is_edited_at_random_has_answers() {
    let edits = std::env::var("TABRAY_EDITS").map_or(1000, |edits| edits.parse().expect("a number"));
    let words = [
        "{",
        "}",
        "\"",
        "#",
        "\n",
        " ",
        "[",
        "]",
        "=",
        ".",
        ",",
        "'",
        "\"\"\"",
        "let ",
        "repeat i 2 {",
        "include ",
        "sphere b {",
        "[sphere.b]\n",
        "[repeat.i]\n",
        "[[light.a]]\n",
        "material ",
        "center ",
        "1e5",
        "\\",
        "ß",
        "\u{1f600}",
        "\r\n",
        "\u{a0}",
        "radius = \"a*i\"",
        "x_0",
        "-",
    ];
    let all: Vec<_> = scenes().into_iter().filter(|(_, text)| text.len() < 4000).collect();
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let mut next = move |below: usize| (random.next_u64() % below.max(1) as u64) as usize;
    let mut made = 0;
    while made < edits {
        let (path, text) = &all[next(all.len())];
        let mut text = Text::new(text.as_str());
        for _ in 0..20 {
            let length = text.as_str().len();
            let start = next(length + 1);
            let end = if next(3) == 0 { start } else { (start + next(12)).min(length) };
            let with = match next(4) {
                0 => "",
                1 => text.as_str().get(start..end).unwrap_or_default(),
                _ => words[next(words.len())],
            };
            text = text.edited(start..end, with);
            ask(path, &text, next(text.as_str().len() + 1));
            made += 1;
        }
    }
}

#[test]
fn what_is_nested_deeply_has_answers() {
    for (name, text) in [
        ("a.ray", "repeat i 2 { ".repeat(5_000)),
        ("a.ray", "sphere { ".repeat(5_000)),
        ("a.toml", format!("a = {}", "[".repeat(10_000))),
        ("a.toml", format!("[sphere.b]\nx = {}", "{ a = ".repeat(5_000))),
        ("a.toml", format!("[repeat{}]\n", ".i.repeat".repeat(5_000))),
    ] {
        ask(Path::new(name), &Text::new(text), 17);
    }
}
