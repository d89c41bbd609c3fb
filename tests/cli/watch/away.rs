//! Files and folders that go away and come back, and a system that does not tell of changes.

use crate::watch::browser::Browser;
use crate::watch::page::shown;
use crate::watch::program::{Watching, ball, client};
use assert_cmd::cargo::cargo_bin;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Runs git in a folder, or says that there is none.
fn git(folder: &Path, args: &[&str]) -> bool {
    let mut git = Command::new("git");
    git.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    git.args(["-c", "user.name=it", "-c", "user.email=it@localhost", "-c", "commit.gpgsign=false"])
        .args(args);
    match git.status() {
        Ok(status) => {
            assert!(status.success(), "{args:?}");
            true
        }
        Err(_) => {
            eprintln!("SKIPPED: there is no `git`");
            false
        }
    }
}

#[test]
fn a_branch_without_the_folder_and_back_leaves_nothing_deaf() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    if !git(at, &["init", "--quiet", "--initial-branch=main"]) {
        return;
    }
    git(at, &["commit", "--quiet", "--allow-empty", "--message=empty"]);
    git(at, &["checkout", "--quiet", "-b", "scenes"]);
    fs::create_dir_all(at.join("deep/in")).expect("folders");
    fs::write(at.join("deep/in/paint.ray"), "material paint { ambient 9 0 0 }\n").expect("a file");
    let text = ball("9 0 0").replace("material paint { ambient 9 0 0 }", "include in/paint.ray");
    fs::write(at.join("deep/scene.ray"), &text).expect("a file");
    git(at, &["add", "."]);
    git(at, &["commit", "--quiet", "--message=scenes"]);
    let (watching, _) = Watching::start_all(folder, &["deep/scene.ray"], &["--port", "0"]);
    let at = watching.folder.path();
    let mut events = watching.events();
    events.until("done");
    for ambient in ["0 9 0", "0 0 9"] {
        git(at, &["checkout", "--quiet", "main"]);
        assert!(!at.join("deep").exists());
        let fault = events.until("fault");
        assert!(fault["report"].as_str().is_some_and(|report| report.contains("cannot read")), "{fault}");
        git(at, &["checkout", "--quiet", "scenes"]);
        assert_eq!(events.until("scene")["text"], text);
        events.until("done");
        // The file that it includes, in a folder that is new again.
        fs::write(at.join("deep/in/paint.ray"), format!("material paint {{ ambient {ambient} }}\n"))
            .expect("a file");
        events.until("scene");
        git(at, &["checkout", "--quiet", "."]);
        events.until("scene");
    }
}

#[test]
fn a_folder_of_scenes_that_is_made_anew_is_followed() {
    let folder = TempDir::new().expect("a folder");
    let scenes = folder.path().join("scenes");
    let make = |ambient: &str| {
        fs::create_dir(&scenes).expect("a folder");
        fs::write(scenes.join("a.ray"), ball(ambient)).expect("a file");
    };
    make("9 0 0");
    let (watching, _) = Watching::start_all(folder, &["scenes"], &["--port", "0"]);
    let mut events = watching.events();
    events.until("done");
    fs::rename(&scenes, watching.folder.path().join("old")).expect("another name");
    events.until("fault");
    make("0 9 0");
    assert_eq!(events.until("scene")["text"], ball("0 9 0"));
    fs::write(scenes.join("b.ray"), ball("0 0 9")).expect("a file");
    while !events.until("scenes").to_string().contains("b.ray") {}
}

/// Runs a command in the namespace of a process, as root there; tells whether it succeeds.
#[cfg(target_os = "linux")]
fn within(process: u32, args: &[&str]) -> bool {
    let mut enter = Command::new("nsenter");
    enter
        .args(["--user", "--preserve-credentials", "--mount", "--wd", "--target", &process.to_string()])
        .args(args);
    enter.status().is_ok_and(|status| status.success())
}

/// The system tells nothing of a mount: what is seen of it is seen by looking.
#[cfg(target_os = "linux")]
#[test]
fn a_mount_that_comes_and_goes_is_followed() {
    // A namespace of its own, in which anybody may mount.
    let apart = ["--user", "--map-root-user", "--mount", "--propagation", "private"];
    let tried = Command::new("unshare")
        .args(apart)
        .args(["sh", "-c", "mount -t tmpfs tmpfs /mnt && command -v nsenter"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    if !tried.is_ok_and(|status| status.success()) {
        println!("SKIPPED: nothing may be mounted here, or there is no `unshare`, `nsenter` or `mount`");
        return;
    }
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("drive")).expect("a folder");
    fs::write(folder.path().join("drive/scene.ray"), ball("9 0 0")).expect("a file");
    let mut program = Command::new("unshare");
    program.args(apart).arg(cargo_bin!("tabray"));
    let (watching, ..) = Watching::start_by(program, folder, &["drive/scene.ray"], &["--port", "0"]);
    let mut events = watching.events();
    let text = |event: &serde_json::Value| event["text"].as_str().expect("text").to_owned();
    assert_eq!(text(&events.until("scene")), ball("9 0 0"));
    let run = |args: &[&str]| assert!(within(watching.child.id(), args), "{args:?}");
    let save =
        |ambient: &str| run(&["sh", "-c", r#"printf %s "$1" > drive/scene.ray"#, "sh", &ball(ambient)]);
    for ambient in ["0 9 0", "0 0 9"] {
        // The scene is not on the drive.
        run(&["mount", "-t", "tmpfs", "tmpfs", "drive"]);
        events.until("fault");
        save(ambient);
        assert_eq!(text(&events.until("scene")), ball(ambient));
        save("9 9 0");
        assert_eq!(text(&events.until("scene")), ball("9 9 0"));
        run(&["umount", "drive"]);
        assert_eq!(text(&events.until("scene")), ball("9 0 0"));
    }
    // As before, the system tells of changes where the drive was.
    fs::write(watching.folder.path().join("drive/scene.ray"), ball("0 9 9")).expect("a file");
    assert_eq!(text(&events.until("scene")), ball("0 9 9"));
}

/// Returns a command that starts the program such that calls of the system fail, as `strace` injects it; `None`, with a
/// word, where there is no `strace`.
#[cfg(target_os = "linux")]
fn with_fault(fault: &str) -> Option<Command> {
    let inject = format!("inject={fault}");
    let command = |program: &Path| {
        let mut strace = Command::new("strace");
        strace.args(["-D", "-f", "-qq", "-o", "/dev/null", "-e", &inject]).arg(program);
        strace
    };
    let tried = command(Path::new("true")).stderr(Stdio::null()).status();
    if !tried.is_ok_and(|status| status.success()) {
        eprintln!("SKIPPED: there is no `strace`, or it may not trace");
        return None;
    }
    Some(command(cargo_bin!("tabray")))
}

/// Lets the system refuse to watch anything, as it does when it watches as much as it allows.
#[cfg(target_os = "linux")]
#[test]
fn where_the_system_does_not_watch_files_they_are_looked_at_and_both_say_so() {
    let Some(program) = with_fault("inotify_init1:error=EMFILE") else { return };
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("scene.ray"), ball("9 0 0")).expect("a file");
    let (mut watching, _, mut stderr) = Watching::start_by(program, folder, &["scene.ray"], &["--port", "0"]);
    let mut events = watching.events();
    let reason = "cannot watch files: too many open files; its files are looked at once a second";
    assert_eq!(events.until("watching"), reason);
    events.until("done");
    watching.save(&ball("0 9 0"));
    assert_eq!(events.until("scene")["text"], ball("0 9 0"));
    if let Some(browser) = Browser::open(&watching.url("")) {
        shown(&browser, 2);
        assert_eq!(browser.text("return document.querySelector('#deaf:not([hidden])').textContent"), reason);
    }
    watching.child.kill().expect("it runs");
    let mut said = String::new();
    stderr.read_to_string(&mut said).expect("text");
    assert!(said.contains(&format!("warning: {reason}\n")), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_fault_while_values_are_written_leaves_the_old_scene_or_the_new_one() {
    let (old, new) = (ball("9 0 0"), ball("9 0 0").replace("radius 2", "radius 3"));
    for calls in ["fsync", "linkat", "rename,renameat,renameat2"] {
        for kill in ["", ":signal=KILL"] {
            let Some(program) = with_fault(&format!("{calls}:error=EIO{kill}:when=1")) else { return };
            let folder = TempDir::new().expect("a folder");
            fs::write(folder.path().join("scene.ray"), &old).expect("a file");
            let (watching, ..) = Watching::start_by(program, folder, &["scene.ray"], &["--port", "0"]);
            watching.events().until("done");
            let origin = format!("http://127.0.0.1:{}", watching.port);
            let send = |path: &str, body: &str| {
                client().post(watching.url(path)).header("Origin", &origin).send(body)
            };
            let tried = r#"{"name":"ball","attribute":"radius","values":["3"]}"#;
            assert_eq!(send("try", tried).expect("an answer").status(), 200);
            let written = send("write", "").is_ok_and(|answer| answer.status() == 200);
            let text = fs::read_to_string(watching.scene()).expect("a scene");
            assert!(text == if written { &*new } else { &*old }, "{calls}{kill}: {text}");
            let names = fs::read_dir(watching.folder.path())
                .expect("a folder")
                .flatten()
                .map(|entry| entry.file_name());
            let left: Vec<_> = names.filter(|name| name != "scene.ray").collect();
            // The next program that writes into the folder removes it.
            assert!(
                left.is_empty() || (calls.starts_with("rename") && !kill.is_empty()),
                "{calls}{kill}: {left:?}"
            );
        }
    }
}
