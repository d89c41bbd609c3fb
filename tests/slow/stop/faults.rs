//! Calls of the system that fail, or at which the program is killed, one after another: each file has its old contents or
//! its new ones, and nothing else is left. `strace` makes them fail; where it is missing, these tests are skipped.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use crate::stop::{bytes, render, stop_midway, tabray_path, workplace};
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;
use tempfile::TempDir;

/// The contents of all files of a folder, by their names.
type Contents = BTreeMap<String, Vec<u8>>;

/// A command that writes files.
struct Case {
    args: &'static [&'static str],
    /// Makes the folder that it runs in.
    folder: fn() -> TempDir,
}

/// Makes a folder with a scene and what is to be replaced.
fn small() -> TempDir {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    let text = fs::read_to_string(scene("sphere/in-front.ray")).expect("a scene");
    write("ball.ray", &text);
    write("wide.ray", &format!("{text}\n\n  {}", text.replace('\n', "\n      ").replace("ball", "other")));
    write("a.png", "precious");
    write("ball.toml", "precious");
    folder
}

fn run(folder: &TempDir, args: &[&str]) {
    let (status, _, err) = outcome(tabray(folder).args(args));
    assert_eq!(status, 0, "{args:?}: {err}");
}

const SIZE: &str = "8";

const CASES: &[Case] = &[
    Case { args: &["render", "ball.ray", "--size", SIZE, "-o", "new.png"], folder: small },
    Case { args: &["render", "ball.ray", "--size", SIZE, "-o", "a.png"], folder: small },
    Case { args: &["render", "ball.ray", "--size", SIZE, "-o", "a.exr"], folder: small },
    Case {
        args: &["render", "hall.ray", "--size", "48", "--samples", "16", "-o", "a.png", "--resume"],
        folder: || {
            let folder = workplace();
            stop_midway(&folder, &["hall.ray", "--size", "48", "--samples", "16", "-o", "a.png"]);
            folder
        },
    },
    Case { args: &["render", "ball.ray", "--size", "40", "-o", "new.png", "--part", "1/2"], folder: small },
    Case {
        args: &["merge", "a.png"],
        folder: || {
            let folder = small();
            for part in ["1/2", "2/2"] {
                run(&folder, &["render", "ball.ray", "--size", "40", "-o", "a.png", "--part", part]);
            }
            folder
        },
    },
    Case {
        args: &["film", "f.png", "--sheet", "a.png", "--animation", "b.png"],
        folder: || {
            let folder = small();
            for frame in ["f-1.png", "f-2.png"] {
                run(&folder, &["render", "ball.ray", "--size", SIZE, "-o", frame]);
            }
            folder
        },
    },
    Case { args: &["convert", "ball.ray", "ball.toml"], folder: small },
    Case { args: &["fmt", "wide.ray"], folder: small },
    Case {
        args: &["fmt", "wide.ray"],
        folder: || {
            let folder = small();
            linked(&folder);
            folder
        },
    },
    Case {
        args: &["review", "--accept", "."],
        folder: || {
            let folder = folder();
            for (name, text) in [("a.snap", "old"), ("a.snap.new", "new")] {
                let text = format!("---\nsource: a.rs\n---\n{text}\n");
                fs::write(folder.path().join(name), text).expect("a file");
            }
            folder
        },
    },
];

/// Gives a file of the folder another name, which `copied` knows.
fn linked(folder: &TempDir) {
    let [one, two] = ["wide.ray", "wide.too"].map(|name| folder.path().join(name));
    fs::hard_link(one, two).expect("another name");
}

/// Makes a copy of a folder.
fn copied(folder: &TempDir) -> TempDir {
    let copy = TempDir::new().expect("a folder");
    for name in names_in(folder.path()) {
        if name == "wide.too" {
            linked(&copy);
        } else {
            fs::copy(folder.path().join(&name), copy.path().join(&name)).expect("a copy");
        }
    }
    copy
}

/// Returns the contents of a folder.
fn contents(folder: &TempDir) -> Contents {
    names_in(folder.path()).into_iter().map(|name| (name.clone(), bytes(folder, &name))).collect()
}

/// Tells whether two files are the same, but for how long a part says that it took, and for line breaks at the end, which a
/// text of several names may have for a moment.
fn are_same(name: &str, [one, other]: [&[u8]; 2]) -> bool {
    let picture = |bytes| image::load_from_memory(bytes).ok().map(|image| image.to_rgba8());
    if name.contains("part") {
        picture(one) == picture(other)
    } else {
        one.trim_ascii_end() == other.trim_ascii_end()
    }
}

/// Runs a command of which one call fails, with a kill if so; returns its status and its messages, or `None` if there is no
/// such call. -1 is the status of a program that was killed.
fn with_fault(
    folder: &TempDir,
    args: &[&str],
    calls: &str,
    kills: bool,
    count: usize,
) -> Option<(i32, String)> {
    let log = TempDir::new().expect("a folder");
    let signal = if kills { ":signal=KILL" } else { "" };
    let mut traced = Command::new("strace");
    traced.args(["-f", "-qq", "-o"]).arg(log.path().join("calls"));
    traced.args([
        "-e",
        &format!("trace={calls}"),
        "-e",
        &format!("inject={calls}:error=EIO{signal}:when={count}"),
    ]);
    traced.arg(tabray_path()).args(args).args(if args[0] == "render" {
        &["--threads", "1"][..]
    } else {
        &[]
    });
    let output = traced.current_dir(folder.path()).output().expect("strace runs");
    let calls = fs::read_to_string(log.path().join("calls")).expect("text");
    let (status, err) =
        (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned());
    (status == -1 || calls.contains("(INJECTED)")).then_some((status, err))
}

/// Lets each of some calls fail, in each command; returns the numbers of faults and of kills.
fn all_faults(calls: &[&str]) -> [usize; 2] {
    let mut counts = [0; 2];
    for Case { args, folder } in CASES {
        let original = folder();
        let (before, clean) = (contents(&original), copied(&original));
        run(&clean, args);
        let after = contents(&clean);
        for (calls, kills) in calls.iter().flat_map(|calls| [(calls, false), (calls, true)]) {
            for count in 1.. {
                let folder = copied(&original);
                let Some((status, err)) = with_fault(&folder, args, calls, kills, count) else { break };
                let what = format!("{args:?}, {calls} {count}, {status}: {err}");
                counts[usize::from(kills)] += 1;
                assert!(if kills { status == -1 } else { [0, 1, 2, 127].contains(&status) }, "{what}");
                assert!(!err.contains("internal error") && !err.contains("panicked"), "{what}");
                let mut now = contents(&folder);
                if kills {
                    now.retain(|name, _| !name.starts_with(".tabray-"));
                }
                for name in now.keys().chain(before.keys()).chain(after.keys()) {
                    let is = |other: &Contents| match (now.get(name), other.get(name)) {
                        (Some(one), Some(other)) => are_same(name, [one, other]),
                        (one, other) => one.is_none() && other.is_none(),
                    };
                    assert!(is(&after) || (is(&before) && status != 0), "{name}: {what}");
                }
                if kills {
                    // The next run finds nothing in its way, and leaves nothing.
                    let (_, _, said) = outcome(tabray(&folder).args(*args));
                    let now = contents(&folder);
                    assert!(now.keys().eq(after.keys()), "{:?}: {what}\n{said}", now.keys());
                    assert!(
                        now.iter().all(|(name, now)| are_same(name, [now, &after[name]])),
                        "{what}\n{said}"
                    );
                }
            }
        }
    }
    counts
}

/// Tells whether faults can be injected here, and says so where not.
fn has_strace() -> bool {
    let tried = Command::new("strace").args(["-f", "-qq", "-o", "/dev/null", "true"]).output();
    let can = tried.is_ok_and(|output| output.status.success());
    if !can {
        eprintln!("SKIPPED: there is no `strace` here, or it may not trace");
    }
    can
}

#[test]
fn a_fault_while_a_file_gets_its_name_leaves_the_old_one_or_the_new_one() {
    if has_strace() {
        let counts = all_faults(&["linkat", "rename,renameat,renameat2", "unlink,unlinkat"]);
        assert!(counts.iter().all(|count| *count >= 15), "{counts:?}");
    }
}

/// `cargo test --test slow -- --ignored --nocapture a_fault_of_any_call` takes minutes; `.ci/nightly` runs it.
#[test]
#[ignore = "takes minutes: .ci/nightly"]
fn a_fault_of_any_call_leaves_the_old_files_or_the_new_ones() {
    if has_strace() {
        let counts = all_faults(&[
            "openat",
            "write,writev,pwrite64",
            "fsync,fdatasync",
            "linkat",
            "rename,renameat,renameat2",
            "unlink,unlinkat",
            "ftruncate,fallocate,fchmod,fchown",
        ]);
        println!("{} faults and {} kills: no file was lost, and none was left", counts[0], counts[1]);
    }
}

#[test]
fn two_renders_that_continue_from_one_checkpoint_both_end_well() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "160", "--samples", "16", "-o", "a.png"];
    render(&folder, &[&args[..5], &["-o", "whole.png"]].concat());
    stop_midway(&folder, &args);
    let resume = || {
        let mut command = Command::new(tabray_path());
        command.arg("render").args(args).arg("--resume").current_dir(folder.path()).spawn().expect("it runs")
    };
    let both = [resume(), resume()].map(|mut render| render.wait().expect("it ends").code());
    assert_eq!(both, [Some(0); 2]);
    assert!(bytes(&folder, "a.png") == bytes(&folder, "whole.png"));
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray", "whole.png"]);
}
