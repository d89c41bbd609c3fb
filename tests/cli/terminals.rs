//! What strangers name, a terminal, a page and a script show as escapes: controls, turned directions, what has no width,
//! and bytes that are no UTF-8.

use crate::common::program::{folder, outcome, tabray};
use crate::watch::program::Watching;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::Command;
use tabray_core::text;
use tempfile::TempDir;

/// A word that is a name in a scene.
const WORD: &str = "b\u{202e}al\u{200b}l\u{2066}";

/// The beginning of a file's name: it sets a terminal's title, clears the screen by a control of one character, and has a
/// line of its own.
const FILE: &[u8] = b"e\x1b]0;a\x07v\xc2\x9b2J\xff\xe2\x80\xae\nFORGED: ";
const FORGED: &str = "FORGED";

fn name(ending: &str) -> OsString {
    let mut name = OsStr::from_bytes(FILE).to_owned();
    name.push(ending);
    name
}

fn scene() -> String {
    format!(
        "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} light white {{ emissivity 1 1 1 location 9 9 9 }}
         texture \"{WORD}\" {{ filename \"{WORD}.ppm\" }} material \"{WORD}\" {{ diffuse 1 0 0 ambient 0.1 0.1 0.1 }}
         # a comment that a terminal obeys: \x1b[2J \u{9b}2J
         sphere \"{WORD}\" {{ material \"{WORD}\" center 4 3 -3 radius 2 }}\n"
    )
}

/// A folder with a scene, one with faults, a mesh, images and rays.
fn hostile() -> TempDir {
    let folder = folder();
    let write = |name: OsString, text: &[u8]| fs::write(folder.path().join(name), text).expect("a file");
    write(name(".ray"), scene().as_bytes());
    write(format!("{WORD}.ppm").into(), b"P6 1 1 255\n\xff\x80\x00");
    write(name(".ppm"), b"P6 1 1 255\n\xff\x80\x00");
    write(name("right.ppm"), &[b"P6 8 6 255\n", &[99; 8 * 6 * 3][..]].concat());
    write(name("2.ppm"), b"P6 1 1 255\n\x00\x80\x00");
    write(name(".rays"), b"4 3 6 0 0 -1\n0 0 6 0 0 1\n");
    write(name("bad.rays"), b"4 3 6 \x1b[2J \xc2\x9b\n");
    let faults = [
        format!("sphere \"{WORD}\" {{ material a\u{9b}b \x1b[2J 3 radius \u{200b} -1 }}"),
        format!("include \"{WORD}\x1b\u{9b}.ray\" camera \u{202e}x {{ }}"),
        format!(
            "mesh \"{WORD}\" {{ file \"\u{202e}.obj\" material m }} material m {{ }} texture t {{ filename \"\x1b\" }}"
        ),
    ];
    write(name("bad.ray"), faults.join("\n").as_bytes());
    write(name("bad.toml"), format!("[[sphere]]\nname = \"{WORD}\x1b\u{9b}\"\n\u{202e} = 3\n").as_bytes());
    let mtl =
        "mtllib \u{202e}\u{9b}\x1b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \u{202e}\u{9b}\x1b\nf 1 2 3\n";
    write(name(".obj"), mtl.as_bytes());
    fs::create_dir(folder.path().join(name("charts"))).expect("a folder");
    write(name("bad.obj"), "v 0 \x1b[2J\u{9b} 0\n\u{202e} 3\n".as_bytes());
    folder
}

/// Panics if an output would do anything to a terminal but show itself.
fn assert_seen(what: &str, bytes: &[u8]) {
    let shown = std::str::from_utf8(bytes);
    let shown = shown.unwrap_or_else(|error| panic!("{what}: {error}: {:?}", String::from_utf8_lossy(bytes)));
    assert!(!shown.lines().any(|line| line.starts_with(FORGED)), "{what}: {shown}");
    let hidden = |letter: char| letter != '\n' && letter != '\t' && text::is_unseen(letter);
    if let Some(at) = shown.find(hidden) {
        let before = text::boundary(shown, at.saturating_sub(60));
        panic!("{what}: {:?}", &shown[before..text::boundary(shown, at + 60)]);
    }
}

/// Each command, with the endings of the names of the files that it reads or writes; `@` stands for such a name.
const COMMANDS: [&[&str]; 51] = [
    &["check", "@.ray"],
    &["check", "@bad.ray"],
    &["check", "@bad.toml"],
    &["check", "@.rays"],
    &["check", "@missing.ray"],
    &["dump", "@.ray"],
    &["dump", "@bad.ray", "--format", "toml"],
    &["plan", "@.ray"],
    &["probe", "@.ray", "4", "3"],
    &["probe", "@.ray", "4", "3", "--json"],
    &["verify", "@.ray"],
    &["verify", "@.ray", "--json"],
    &["verify", "@.ray", "--colours"],
    &["hits", "@.ray", "@.rays"],
    &["hits", "@.ray", "@bad.rays"],
    &["hits", "@.ray", "@.unknown"],
    &["judge", "@.ray", "@bad.rays"],
    &["hard", "@.ray", "-n", "3"],
    &["render", "@.ray", "-o", "@.png", "--stats"],
    &["render", "@.ray", "-o", "@.png", "--stats", "json", "--debug", "pix,hit,find", "--at", "4,3"],
    &["render", "@.ray", "-o", "@.none"],
    &["render", "@.ray", "-o", "@.none/a.png"],
    &["render", "@.ray", "-o", "@.png", "--part", "1/2"],
    &["render", "@bad.ray", "@.ray", "-o", "@folder"],
    &["chart", "@.ray", "-o", "@charts", "--time-limit", "1s"],
    &["chart", "@bad.ray"],
    &["chart", "@.ray", "-o", "@.none/a.svg"],
    &["choose", "@.ray", "--max-error", "20", "--time-limit", "1s"],
    &["choose", "@bad.ray", "--max-error", "2"],
    &["bench", "@.ray", "--seconds", "0.001"],
    &["bench", "@.ray", "--seconds", "0.001", "--json"],
    &["mesh", "@.ray", WORD, "-o", "@.stl"],
    &["mesh", "@.ray", "\u{202e}\x1b", "-o", "@.obj"],
    &["mesh", "@.ray", WORD, "-o", "@.none"],
    &["grade", "@.ray", "@.ppm"],
    &["grade", "@.ray", "@right.ppm", "--json"],
    &["new", "scene", "@mesh.ray", "--mesh", "@.obj"],
    &["merge", "@missing.png"],
    &["film", "@.png", "--sheet", "@sheet.png"],
    &["diff", "@.ppm", "@2.ppm"],
    &["diff", "@.ppm", "@missing.ppm"],
    &["convert", "@.ray", "@.toml"],
    &["convert", "@.ray", "@.none"],
    &["fmt", "@.ray"],
    &["fmt", "@bad.ray"],
    &["fmt", "--check", "@.toml"],
    &["list", "@.obj"],
    &["list", "@bad.obj"],
    &["list", "\u{202e}\x1b"],
    &["new", "scene", "@.ray"],
    &["--\x1b\u{9b}"],
];

#[test]
fn every_command_shows_what_is_not_seen_as_escapes() {
    let folder = hostile();
    for form in ["human", "short", "json"] {
        for words in COMMANDS {
            let word = |word: &&str| word.strip_prefix('@').map_or_else(|| (*word).into(), name);
            let words: Vec<OsString> = words.iter().map(word).collect();
            let output = tabray(&folder).args(["--message-format", form]).args(&words).output();
            let output = output.expect("the program runs");
            let what = format!("{form} {words:?}");
            assert_seen(&what, &output.stdout);
            assert_seen(&what, &output.stderr);
            assert!(output.status.code().is_some_and(|status| status <= 2), "{what}: {:?}", output.status);
        }
    }
    let (status, _, err) = outcome(tabray(&folder).write_stdin(scene()));
    assert_eq!(status, 0, "{err}");
    assert_seen("the notes' dump", err.as_bytes());
}

/// A scene for another program is written as it is, and on a terminal as escapes.
#[test]
fn a_scene_is_shown_on_a_terminal_and_kept_in_a_pipe() {
    let folder = hostile();
    let text = scene();
    fs::write(folder.path().join("plain.ray"), &text).expect("a file");
    let (status, piped, err) = outcome(tabray(&folder).args(["fmt", "-"]).write_stdin(text));
    assert_eq!(status, 0, "{err}");
    let piped = String::from_utf8(piped).expect("text");
    assert!(piped.contains("\x1b[2J \u{9b}2J") && piped.contains(WORD), "{piped}");
    if !Path::new("/usr/bin/script").exists() {
        println!("SKIPPED: there is no /usr/bin/script to make a terminal");
        return;
    }
    let program = assert_cmd::cargo::cargo_bin!("tabray").display();
    for command in ["fmt - < plain.ray", "dump plain.ray --format ray", "convert plain.ray - --to toml"] {
        let mut script = Command::new("/usr/bin/script");
        script.args(["-qec", &format!("{program} {command}"), "/dev/null"]).current_dir(folder.path());
        let output = script.output().expect("it runs");
        assert!(output.status.success(), "{command}");
        // The terminal ends lines by itself.
        let shown = String::from_utf8(output.stdout).expect("text").replace("\r\n", "\n");
        assert_seen(command, shown.as_bytes());
        assert!(shown.contains("\\u{202e}al\\u{200b}"), "{shown}");
    }
}

#[test]
fn the_page_is_told_of_names_and_faults_in_escapes() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("scene.ray"), scene()).expect("a file");
    let watching = Watching::start(folder, &["--port", "0"]);
    let mut events = watching.events();
    let mut version = events.until("done")["version"].clone();
    for path in ["entities/@", "object/@/4/3", "plan/@", "probe/@/4/3"] {
        // A file that has only just been written may be read twice.
        let (status, answer) = loop {
            match watching.get(&path.replace('@', &version.to_string())) {
                (410, _) => version = events.until("done")["version"].clone(),
                answer => break answer,
            }
        };
        assert_eq!(status, 200, "{path}");
        assert_seen(path, &answer);
    }
    let wrong = format!("{}\nsphere \"{WORD}\" {{ material \x1b\u{9b} radius -1 }}", scene());
    watching.save(&wrong);
    let fault = events.until("fault");
    assert_seen("the report", fault["report"].as_str().expect("text").as_bytes());
}
