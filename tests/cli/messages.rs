//! `--message-format`: the same messages for people, for editors and for programs.

use crate::common::program::{folder, outcome, scene, tabray};
use serde_json::Value;
use std::fs;

fn objects(err: &str) -> Vec<Value> {
    err.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line} is JSON"))).collect()
}

/// Returns the exit status of `check` for a faulty scene, and its messages in this format.
fn told(form: &str, text: &str) -> (i32, String) {
    let (status, _, err) =
        outcome(tabray(&folder()).args(["check", "-", "--message-format", form]).write_stdin(text));
    (status, err)
}

/// A scene with several faults. Its Greek letter is two bytes and one column.
const FAULTY: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\n\
                      sphere \u{3b2} { materail 5 center 1 2\n radius 1 radius 0 }\n";

#[test]
fn short_is_a_line_for_each_fault() {
    let (status, err) = told("short", FAULTY);
    assert_eq!(status, 2);
    assert_eq!(
        err,
        "<stdin>:2:12: error: sphere `\u{3b2}` has no attribute `materail`: did you mean `material`?\n\
         <stdin>:2:23: error: `center` of sphere `\u{3b2}` takes 3 numbers, not 2\n\
         <stdin>:3:11: warning: sphere `\u{3b2}` has `radius` twice: this one is used\n\
         <stdin>:3:18: error: `radius` of sphere `\u{3b2}` must be positive, not 0\n"
    );
}

#[test]
fn json_is_an_object_for_each_fault_with_its_places() {
    let (status, err) = told("json", FAULTY);
    let objects = objects(&err);
    assert_eq!((status, objects.len()), (2, 4), "{err}");
    for object in &objects {
        for span in object["spans"].as_array().expect("spans") {
            let at = |field: &str| span[field].as_u64().expect("a number") as usize;
            let line = FAULTY.lines().nth(at("line_start") - 1).expect("a line");
            let columns =
                line.chars().skip(at("column_start") - 1).take(at("column_end") - at("column_start"));
            assert_eq!(columns.collect::<String>(), FAULTY[at("byte_start")..at("byte_end")]);
        }
    }
    let [.., twice, zero] = objects.as_slice() else { panic!("{err}") };
    assert_eq!((&twice["level"], &zero["level"]), (&"warning".into(), &"error".into()));
    assert_eq!(
        (&twice["spans"][0]["is_primary"], &twice["spans"][1]["is_primary"]),
        (&true.into(), &false.into())
    );
    assert_eq!(twice["spans"][1]["label"], "this one is ignored");
    assert_eq!(
        (&zero["spans"][0]["file_name"], &zero["spans"][0]["line_start"]),
        (&"<stdin>".into(), &3.into())
    );
    assert_eq!(zero["help"], "`radius`: the distance from the centre to the surface");
}

#[test]
fn the_three_forms_say_the_same() {
    for entry in fs::read_dir(scene("wrong")).expect("the mistakes") {
        let path = entry.expect("an entry").path();
        let told =
            |form: &str| outcome(tabray(&folder()).args(["check", "--message-format", form]).arg(&path));
        let ((status, _, human), (in_short, _, short), (in_json, _, json)) =
            (told("human"), told("short"), told("json"));
        assert_eq!((status, status), (in_short, in_json), "{}", path.display());
        let objects = objects(&json);
        assert_eq!(objects.len(), short.lines().count(), "{}", path.display());
        for (object, line) in objects.iter().zip(short.lines()) {
            let (message, rendered) = (object["message"].as_str(), object["rendered"].as_str());
            assert!(line.contains(message.expect("a message")), "{line}");
            assert!(human.contains(rendered.expect("the whole message")), "{human}");
        }
    }
}

#[test]
fn all_that_is_said_with_json_is_json() {
    let scene = scene("sphere/in-front.ray");
    let scene = scene.to_str().expect("UTF-8");
    for (status, level, args) in [
        (0, "note", vec!["render", scene, "--size", "8"]),
        (0, "note", vec!["convert", scene, "a.toml"]),
        (0, "note", vec!["check", scene]),
        (0, "note", vec!["verify", scene, "-o", "a.png"]),
        (0, "note", vec!["new", "scene", "a"]),
        (2, "error", vec!["list", "spere"]),
        (1, "error", vec!["dump", "no-such-scene.ray"]),
        (1, "error", vec!["render", scene, "-o", "no/such/folder/a.png"]),
        (2, "error", vec!["render", scene, "--crop", "0,0,900,1"]),
        (2, "error", vec!["probe", scene, "900", "0"]),
    ] {
        let (ended, _, err) = outcome(tabray(&folder()).args(["--message-format", "json"]).args(&args));
        assert_eq!(ended, status, "{args:?}: {err}");
        let objects = objects(&err);
        assert!(
            !objects.is_empty() && objects.iter().all(|object| object["level"] == level),
            "{args:?}: {err}"
        );
    }
}

#[test]
fn an_error_without_a_place_is_a_line_too() {
    let (status, _, err) = outcome(tabray(&folder()).args(["list", "spere", "--message-format", "short"]));
    assert_eq!((status, err.as_str()), (2, "error: there is no entity type `spere`\n"));
}

/// Each write to a datagram socket is received separately.
#[cfg(unix)]
#[test]
fn a_message_is_one_write() {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixDatagram;
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let folder = folder();
    fs::write(folder.path().join("faulty.ray"), FAULTY).expect("room for a scene");
    let (stderr, told) = UnixDatagram::pair().expect("sockets");
    told.set_read_timeout(Some(Duration::from_millis(20))).expect("a time limit");
    let mut command = Command::new(env!("CARGO_BIN_EXE_tabray"));
    command.current_dir(folder.path()).args(["check", "faulty.ray"]);
    let mut program = command.stderr(Stdio::from(OwnedFd::from(stderr))).spawn().expect("the program runs");
    let (mut messages, mut room) = (Vec::new(), [0; 1 << 16]);
    loop {
        let is_over = program.try_wait().expect("a status").is_some();
        match told.recv(&mut room) {
            Ok(count) if count > 0 => messages.push(String::from_utf8_lossy(&room[..count]).into_owned()),
            _ if is_over => break,
            _ => {}
        }
    }
    let [message] = messages.as_slice() else { panic!("{messages:#?}") };
    assert!(message.starts_with("error: ") && message.contains("must be positive"), "{message}");
}

#[test]
fn two_signs_are_no_whole_number() {
    let (status, err) = told(
        "short",
        "camera eye { pixeldim --8 +-6 worlddim 8 6 viewpoint 4 3 6 samples 99999999999999999999 }",
    );
    assert_eq!(status, 2);
    let expected = "<stdin>:1:23: error: `--8` and `+-6` are not whole numbers";
    assert!(err.starts_with(expected) && err.contains("error: `99999999999999999999` is too large"), "{err}");
}

/// A word with a letter that is not seen would look like the word that is meant.
#[test]
fn letters_that_are_not_seen_are_named() {
    for (letter, shown) in [('\u{feff}', "\\u{feff}"), ('\u{200b}', "\\u{200b}"), ('\u{202e}', "\\u{202e}")] {
        let (status, err) = told(
            "short",
            &format!("camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 samples{letter} 1 }}"),
        );
        assert_eq!(status, 2);
        let expected =
            format!("error: camera `eye` has no attribute `samples{shown}`: did you mean `samples`?");
        assert!(err.contains(&expected), "{err}");
    }
}

#[test]
fn a_value_below_0_is_told_what_would_be_right() {
    for (option, value, help) in [
        ("--samples", "-1", "give a whole number from 1 to 65536, or two as `4..64`"),
        ("--part", "-1/4", "give a part as `3/16`: its number, from 1, and of how many parts, up to 100000"),
        ("--time-limit", "-1s", "give a time above 0 and its unit, as `90s`, `5m` or `1.5h`"),
        ("--size", "-5", "give a width as `800`, or both as `800x600`, each from 1 to 100000"),
    ] {
        let (status, _, err) = outcome(tabray(&folder()).args(["render", "ball.ray", option, value]));
        assert_eq!(status, 2, "{err}");
        let expected = format!("error: invalid value '{value}' for '{option} <");
        assert!(err.starts_with(&expected) && err.contains(&format!(">': {help}\n")), "{err}");
    }
}
