//! `tabray lsp`, as editors use it.

mod client;

use crate::common::program::{folder, outcome, tabray};
use crate::common::root;
use client::{Client, marks, shown, uri};
use insta::Settings;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

const NOTES: &str = r#"# The first
# of two lines.
include colours.inc
camera eye { pixeldim 160 120  worlddim 8 6  viewpoint^ 4 ^3 6 }
material "dark 😀 blue" { ambient 0.1 0.2 4 }
let radius 1.2
repeat i 3 {
    material sha^de { ambient "i/3" 0 0 }
    sphere bead { material shade  center 1 "rad^ius + gap*i" 3  radius "radius" }
}
sphere last { material sha^de_1 center 1 2 3 raduis 2 }
revsurf vase { material re^d  surfer ^ }
li^
light lamp { location 1 2 3  emissivity 4 2 1 ^ }
"#;

const TOML: &str = r#"# The first
# of two lines.
include = "colours.toml"

[camera.eye]
pixeldim = [160, 120]
worlddim = [8, 6]
viewpoint^ = [4, ^3, 6]

[material."dark 😀 blue"]
ambient = [0.1, 0.2, 4]

[let]
radius = 1.2

[repeat.i]
count = 3

[repeat.i.material.sha^de]
ambient = ["i/3", 0, 0]

[repeat.i.sphere.bead]
material = "shade"
center = [1, "rad^ius + gap*i", 3]
radius = "radius"

[sphere.last]
material = "sha^de_1"
center = [1, 2, 3]
raduis = 2

[revsurf.vase]
material = "re^d"
surfer = "^"

[li^

[light.lamp]
location = [1, 2, 3]
emissivity = [4, 2, 1]
^
"#;

#[test]
fn a_session_has_answers_to_all_that_an_editor_asks() {
    for (syntax, text, included) in [
        ("ray", NOTES, ("colours.inc", "material red { ambient 1 0 0 }\nlet gap 2\n")),
        ("toml", TOML, ("colours.toml", "[material.red]\nambient = [1, 0, 0]\n[let]\ngap = 2\n")),
    ] {
        let folder = folder();
        fs::write(folder.path().join(included.0), included.1).expect("room");
        let mut client = Client::start(&folder);
        let uri = uri(folder.path(), &format!("scene.{syntax}"));
        let (text, positions) = marks(text);
        client.open(&uri, &text);
        let faults = client.faults(&uri);
        let mut told = format!("faults\n{}", shown(&Ok(faults)));
        let document = json!({ "uri": uri });
        let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        for (at, position) in positions.iter().enumerate() {
            for (method, more) in [
                ("completion", json!({})),
                ("hover", json!({})),
                ("signatureHelp", json!({})),
                ("definition", json!({})),
                ("references", json!({ "context": { "includeDeclaration": true } })),
                ("rename", json!({ "newName": "dark shade" })),
            ] {
                let mut question = json!({ "textDocument": document, "position": position });
                question
                    .as_object_mut()
                    .expect("an object")
                    .extend(more.as_object().expect("an object").clone());
                let mut answer = client.ask(&format!("textDocument/{method}"), question);
                if let (Ok(Value::Array(items)), "completion") = (&mut answer, method) {
                    // All types would be too many.
                    items.retain(|item| {
                        at != 7 || item["label"].as_str().is_some_and(|name| name.starts_with("li"))
                    });
                    items.iter_mut().for_each(|item| {
                        let item = item.as_object_mut().expect("an object");
                        item.retain(|field, _| ["label", "detail", "textEdit"].contains(&field.as_str()));
                    });
                }
                let is_empty = matches!(&answer, Ok(Value::Null)) || answer == Ok(json!([]));
                if !is_empty && !answer.as_ref().is_err_and(|reason| reason.starts_with("there is no name")) {
                    told += &format!(
                        "\n{method} at {}:{}\n{}",
                        position["line"],
                        position["character"],
                        shown(&answer)
                    );
                }
            }
        }
        for method in
            ["documentSymbol", "foldingRange", "documentColor", "inlayHint", "codeAction", "formatting"]
        {
            let question =
                json!({ "textDocument": document, "range": whole, "context": { "diagnostics": [] } });
            let answer = client.ask(&format!("textDocument/{method}"), question);
            told += &format!("\n{method}\n{}", shown(&answer));
        }
        client.end();
        let place = folder.path().canonicalize().expect("a folder").display().to_string();
        let mut settings = Settings::clone_current();
        settings.set_snapshot_path(root().join("snapshots/editor"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!(syntax, told.replace(&place, "FOLDER")));
    }
}

#[test]
fn words_are_told_apart_by_the_legend() {
    let folder = folder();
    let mut client = Client::start(&folder);
    let begun = client.capabilities.clone();
    let legend = &begun["semanticTokensProvider"]["legend"]["tokenTypes"];
    let (uri, text) =
        (uri(folder.path(), "scene.ray"), "material \"😀\" { ambient 1 0 0 }\nlet r \"2 +\n k\"\n");
    client.open(&uri, text);
    let answer = client.ask("textDocument/semanticTokens/full", json!({ "textDocument": { "uri": uri } }));
    let data: Vec<usize> = serde_json::from_value(answer.expect("tokens")["data"].clone()).expect("numbers");
    let (mut line, mut column, mut told) = (0, 0, String::new());
    for token in data.chunks(5) {
        column = if token[0] == 0 { column } else { 0 } + token[1];
        line += token[0];
        let units: Vec<_> = text.lines().nth(line).expect("a line").encode_utf16().collect();
        let word = String::from_utf16(&units[column..column + token[2]]).expect("whole letters");
        told += &format!("{word}:{} ", legend[token[3]].as_str().expect("a kind"));
    }
    let want = "material:type \"😀\":variable ambient:property 1:number 0:number 0:number let:keyword r:variable 2:number \
                +:operator k:variable ";
    assert_eq!(told, want);
    client.end();
}

#[test]
fn faults_follow_what_is_typed() {
    let folder = folder();
    let mut client = Client::start(&folder);
    let uri = uri(folder.path(), "a.ray");
    // Without them there would be a warning: the image is black.
    let seen = "material m { ambient 1 1 1 }\nsphere s { material m  center 4 3 -4  radius 1 }\n";
    client.open(&uri, &format!("camera eye {{ pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }}\n{seen}"));
    assert_eq!(client.faults(&uri), json!([]));
    let change = |from: [u32; 2], to: [u32; 2], text: &str| {
        let [start, end] =
            [from, to].map(|[line, character]| json!({ "line": line, "character": character }));
        json!({ "range": { "start": start, "end": end }, "text": text })
    };
    let document = json!({ "uri": uri, "version": 2 });
    let changes = json!([change([0, 13], [0, 21], "pixldim"), change([1, 0], [1, 0], "# ß\n")]);
    client.note("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    let faults = client.faults(&uri);
    assert_eq!(faults[0]["range"]["end"], json!({ "line": 0, "character": 20 }), "{faults}");
    let range = faults[0]["range"].clone();
    let question =
        json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": faults } });
    let actions = client.ask("textDocument/codeAction", question).expect("actions");
    assert_eq!(actions[0]["edit"]["changes"][&uri][0]["newText"], "pixeldim", "{actions}");
    client.note("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    assert_eq!(client.faults(&uri), json!([]));
    client.end();
}

#[test]
fn toml_that_is_no_scene_is_left_alone() {
    let folder = folder();
    let mut client = Client::start(&folder);
    let uri = uri(folder.path(), "Cargo.toml");
    client.open(&uri, "[package]\nname = \"a\"\n");
    assert_eq!(client.faults(&uri), json!([]));
    let question = json!({ "textDocument": { "uri": uri } });
    assert_eq!(client.ask("textDocument/formatting", question), Ok(Value::Null));
    assert_eq!(
        client.ask("textDocument/unheard", json!({})),
        Err("`textDocument/unheard` is not known".to_owned())
    );
    client.end();
}

#[test]
fn an_editor_that_breaks_off_is_a_failure() {
    let folder = folder();
    let mut client = Client::start(&folder);
    client.note("exit", Value::Null);
    assert_eq!(client.program.wait().expect("an end").code(), Some(1));
    for (input, reason) in [
        (
            "Content-Length: 99999999999999\r\n\r\n{}".to_owned(),
            "a message ends after 2 of 99999999999999 bytes",
        ),
        ("Content-Length: -1\r\n\r\n{}".to_owned(), "`-1` is not a length"),
        ("Content-Type: x\r\n\r\n{}".to_owned(), "a header has no `Content-Length`"),
        ("x".repeat(1 << 20), "what it says is not preceded by a header"),
    ] {
        let (status, _, err) = outcome(tabray(&folder).arg("lsp").write_stdin(input));
        let said = format!("error: the editor broke off: {reason}");
        assert!(status == 1 && err.starts_with(&said) && err.len() < 200, "{err}");
    }
}

#[test]
fn what_is_no_message_is_answered_with_the_reason() {
    let folder = folder();
    let text = |text: &str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
    let shutdown = r#"{"jsonrpc":"2.0","id":7,"method":"shutdown"}"#;
    let initialize = r#"{"jsonrpc":"2.0","id":6,"method":"initialize","params":{"capabilities":{}}}"#;
    let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
    let input: String = ["{}}", initialize, "[1, 2", shutdown, exit].map(text).concat();
    let (status, out, err) = outcome(tabray(&folder).arg("lsp").write_stdin(input));
    assert_eq!((status, err.as_str()), (0, ""));
    let out = String::from_utf8(out).expect("text");
    let at = |part: &str| out.find(part).unwrap_or_else(|| panic!("{part}: {out}"));
    let malformed = r#""code":-32700,"message":"this message is malformed: "#;
    assert!(at(malformed) < at(r#""id":6"#) && at(r#""id":6"#) < at(r#""id":7"#), "{out}");
    assert_eq!(out.matches(malformed).count(), 2, "{out}");
}

#[test]
fn after_shutdown_and_for_a_second_initialize_the_request_is_refused() {
    let folder = folder();
    let mut client = Client::start(&folder);
    let refused = |answer: Result<Value, String>, said: &str| assert_eq!(answer, Err(said.to_owned()));
    refused(client.ask("initialize", json!({ "capabilities": {} })), "`initialize` comes once");
    client.ask("shutdown", Value::Null).expect("an answer");
    for method in ["shutdown", "initialize", "textDocument/hover", "nonsense"] {
        refused(client.ask(method, json!({})), "`shutdown` came before");
    }
    client.note("textDocument/didOpen", json!({}));
    client.note("exit", Value::Null);
    assert!(client.program.wait().expect("an end").success());
}

/// A text that is too large is not read, and the server goes on.
#[test]
fn a_text_of_17_mib_is_refused() {
    let folder = folder();
    let mut client = Client::start(&folder);
    let uri = uri(folder.path(), "large.ray");
    client.open(&uri, &"# nothing\n".repeat((17 << 20) / 10));
    let asked = json!({ "textDocument": { "uri": uri }, "options": {} });
    assert!(client.ask("textDocument/formatting", asked).is_ok_and(|answer| answer.is_null()));
    let told = client.told.iter().find(|told| told.method == "window/showMessage").expect("a message");
    let message = told.params["message"].as_str().expect("text");
    assert!(message.contains("large.ray` is larger than 16 MiB, and is not read"), "{message}");
    client.open(&uri, "sphere a { radius 1 }\n");
    assert!(!client.faults(&uri).as_array().expect("faults").is_empty());
    client.end();
}

#[test]
fn a_scene_has_the_faults_of_an_included_file_as_it_is_open() {
    let folder = folder();
    fs::write(folder.path().join("colours.inc"), "material red { ambient 1 0 0 }\n").expect("room");
    let mut client = Client::start(&folder);
    let [scene, colours] = ["a.ray", "colours.inc"].map(|name| uri(folder.path(), name));
    let seen = "sphere s { material red  center 4 3 -4  radius 1 }\n";
    client.open(
        &scene,
        &format!("include colours.inc\ncamera eye {{ pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }}\n{seen}"),
    );
    assert_eq!(client.faults(&scene), json!([]));
    client.open(&colours, "material crimson { ambient 1 0 0 }\n");
    let told = client.faults(&scene);
    assert!(told[0]["message"].as_str().is_some_and(|message| message.contains("`red`")), "{told}");
    let text = "material red { ambiend 1 0 0 }\n";
    let document = json!({ "uri": colours, "version": 2 });
    client.note(
        "textDocument/didChange",
        json!({ "textDocument": document, "contentChanges": [{ "text": text }] }),
    );
    let told = client.faults(&colours);
    assert!(told[0]["message"].as_str().is_some_and(|message| message.contains("`ambiend`")), "{told}");
    // What is stored counts again.
    client.note("textDocument/didClose", json!({ "textDocument": { "uri": colours } }));
    client.told.clear();
    assert_eq!(client.faults(&scene), json!([]));
    client.end();
}

/// A text as an editor keeps it.
struct Typed(Vec<char>);

impl Typed {
    /// Returns the position of a character: lines and UTF-16 units, counted from the beginning.
    fn position(&self, at: usize) -> Value {
        let (mut line, mut character) = (0, 0);
        for (index, letter) in self.0[..at].iter().enumerate() {
            if *letter == '\n' || *letter == '\r' && self.0.get(index + 1) != Some(&'\n') {
                (line, character) = (line + 1, 0);
            } else {
                character += letter.len_utf16();
            }
        }
        json!({ "line": line, "character": character })
    }

    /// Replaces a part of the text, and returns the change as an editor tells it.
    fn change(&mut self, start: usize, end: usize, text: &str) -> Value {
        // No position is between the two characters of a line's end.
        let is_within = |at: &usize| *at > 0 && self.0[at - 1] == '\r' && self.0.get(*at) == Some(&'\n');
        let [start, end] = [start, end].map(|at| if is_within(&at) { at - 1 } else { at });
        let range = json!({ "start": self.position(start), "end": self.position(end) });
        self.0.splice(start..end, text.chars());
        json!({ "range": range, "text": text })
    }
}

/// TABRAY_EDITS edits, or 300.
#[test]
fn faults_after_random_edits_are_those_of_the_text_opened_anew() {
    let edits = std::env::var("TABRAY_EDITS").map_or(300, |edits| edits.parse().expect("a number"));
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
        "let ",
        "repeat i 2 {",
        "sphere b {",
        "[sphere.b]\n",
        "material ",
        "center ",
        "1e5",
        "\\",
        "ß",
        "\u{1f600}",
        "\r\n",
        "\r",
        "\u{a0}",
        "-",
        "7",
    ];
    let scenes: Vec<_> = ["ray", "toml"]
        .iter()
        .flat_map(|end| scenes_ending_in(end))
        .filter_map(|path| fs::read_to_string(path).ok())
        .filter(|text| text.len() < 2000 && !text.contains("include"))
        .collect();
    let folder = folder();
    let [mut typing, mut anew] = [Client::start(&folder), Client::start(&folder)];
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let mut next = move |below: usize| (random.next_u64() % below.max(1) as u64) as usize;
    let (mut made, mut with_faults) = (0, 0);
    while made < edits {
        let scene = &scenes[next(scenes.len())];
        // Other scenes stand in other files, so that nothing is left of them.
        let end = if scene.contains("\n[") { "toml" } else { "ray" };
        let uri = uri(folder.path(), &format!("{made}.{end}"));
        let mut typed = Typed(scene.chars().collect());
        // A text in TOML of which too little is left is a scene's only if it was one before.
        for client in [&mut typing, &mut anew] {
            client.open(&uri, scene);
            client.faults(&uri);
        }
        for version in 2..22 {
            let changes: Vec<_> = (0..1 + next(3))
                .map(|_| {
                    let start = next(typed.0.len() + 1);
                    let end = (start + if next(3) == 0 { 0 } else { next(12) }).min(typed.0.len());
                    typed.change(start, end, if next(4) == 0 { "" } else { words[next(words.len())] })
                })
                .collect();
            made += changes.len();
            let document = json!({ "uri": uri, "version": version });
            typing.note(
                "textDocument/didChange",
                json!({ "textDocument": document, "contentChanges": changes }),
            );
            let text: String = typed.0.iter().collect();
            anew.open(&uri, &text);
            let [now, fresh] = [&mut typing, &mut anew].map(|client| client.faults(&uri));
            assert_eq!(now, fresh, "{text:?}");
            with_faults += usize::from(now != json!([]));
        }
        for client in [&mut typing, &mut anew] {
            client.note("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
            assert_eq!(client.faults(&uri), json!([]));
        }
    }
    assert!(with_faults > 0, "random edits make faults");
    typing.end();
    anew.end();
}

/// Returns the scenes of the repository whose names have this end.
fn scenes_ending_in(end: &str) -> Vec<PathBuf> {
    let folders = ["language", "notes", "toml", "sphere", "wrong", "light"]
        .map(|name| root().join("scenes").join(name));
    let entries = folders.iter().filter_map(|folder| folder.read_dir().ok()).flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|other| other == end));
    paths.sort();
    paths
}

/// The tests of docs/editors/vscode: the grammar in the engine of Visual Studio Code, and a session of its client library.
#[test]
fn the_extension_of_visual_studio_code_passes_its_tests() {
    let folder = root().join("docs/editors/vscode");
    let has_node = Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    if !has_node || !folder.join("node_modules/vscode-textmate").is_dir() {
        eprintln!(
            "SKIPPED: `node` or its modules are missing; `npm install` in {} installs these",
            folder.display()
        );
        return;
    }
    let output = Command::new("npm")
        .args(["test", "--silent"])
        .current_dir(&folder)
        .env("TABRAY", env!("CARGO_BIN_EXE_tabray"))
        .output()
        .expect("npm starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
