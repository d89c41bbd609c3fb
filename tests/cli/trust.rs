//! What a stranger's scene cannot reach: files outside of `--root`, the text of files that are no scenes, and what would
//! wait for ever.

use crate::common::program::{folder, outcome, tabray};
use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;
use std::time::Duration;
use tempfile::TempDir;

const HEAD: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
sphere ball { material m center 4 3 -3 radius 2 }\n";

/// A texture that is shown.
const SHOWN: &str = "texture t { filename @ }
texplane p { material m normal 0 0 1 point 0 0 -1 dimensions 3 3 texname t xdir 1 0 0 mode 0 }\n";

const SECRET: &str = "root:$6$hunter2:19000:0:99999:7:::\ndaemon:*:19000:0:99999:7:::\n";

/// A folder `in` with scenes, and beside it what they must not reach.
fn workplace() -> TempDir {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("in/deep")).expect("a folder");
    for (name, text) in [
        ("in/plain.ray", HEAD.to_owned()),
        ("in/part.ray", "sphere two { material m center 0 0 -9 radius 1 }\n".to_owned()),
        ("in/whole.ray", format!("{HEAD}include \"deep/../part.ray\"\ninclude \"again.ray\"\n")),
        ("in/texture.ray", format!("{HEAD}{}", SHOWN.replace('@', "../t.ppm"))),
        ("in/mesh.ray", format!("{HEAD}mesh w {{ material m file ../m.obj }}\n")),
        ("in/include.ray", format!("{HEAD}include \"../part.ray\"\n")),
        ("in/linked.ray", format!("{HEAD}include \"link.ray\"\n")),
        ("in/missing.ray", format!("include \"../nothing.ray\"\n{HEAD}")),
        ("part.ray", "sphere three { material m center 0 0 -9 radius 1 }\n".to_owned()),
        ("m.obj", "v 0 0 -1\nv 1 0 -1\nv 0 1 -1\nf 1 2 3\n".to_owned()),
        ("t.ppm", "P3 1 1 255 9 9 9\n".to_owned()),
        ("secret", SECRET.to_owned()),
        ("kept.png", "kept".to_owned()),
    ] {
        fs::write(at(name), text).expect("a file");
    }
    symlink(at("in/deep/third.ray"), at("in/again.ray")).expect("a link");
    fs::write(at("in/deep/third.ray"), "sphere four { material m center 0 0 -9 radius 1 }\n")
        .expect("a file");
    symlink(at("part.ray"), at("in/link.ray")).expect("a link");
    symlink(at("kept.png"), at("in/image.png")).expect("a link");
    symlink(at("new.png"), at("in/new.png")).expect("a link");
    symlink(folder.path(), at("in/out")).expect("a link");
    folder
}

fn told(folder: &TempDir, line: &str) -> (i32, String) {
    let mut command = tabray(folder);
    let (status, out, err) = outcome(command.args(line.split_whitespace()).timeout(Duration::from_secs(120)));
    (status, String::from_utf8_lossy(&out).into_owned() + &err)
}

const OUTSIDE: &str = "it is outside of the folder of `--root`";

#[test]
fn nothing_outside_of_the_root_is_read() {
    let folder = workplace();
    for scene in ["include", "linked", "texture", "mesh", "missing"] {
        let (status, said) = told(&folder, &format!("check in/{scene}.ray --root in"));
        assert!(status == 2 && said.contains(OUTSIDE), "{scene}: {said}");
        if scene != "missing" {
            assert_eq!(told(&folder, &format!("check in/{scene}.ray")).0, 0, "{scene} without a root");
        }
    }
    for command in [
        "check @",
        "dump @",
        "plan @",
        "probe @ 4 3",
        "verify @",
        "render @ -o in/x.png",
        "convert @ in/x.toml",
        "hits @ in/rays.txt",
        "hard @ -n 1",
        "chart @ -o in",
        "choose @ --max-error 9",
        "bench @",
        "farm commands @ -o in/x.png --parts 2",
    ] {
        let (status, said) = told(&folder, &format!("--root in {}", command.replace('@', "in/linked.ray")));
        assert!(status != 0 && said.contains(OUTSIDE), "{command}: {said}");
    }
    for command in ["check part.ray", "fmt part.ray", "check in/link.ray", "diff t.ppm t.ppm", "list m.obj"] {
        let (status, said) = told(&folder, &format!("--root in {command}"));
        assert!(status != 0 && said.contains(OUTSIDE), "{command}: {said}");
    }
    // Nor do guesses of what was meant look there.
    let missing = format!("{HEAD}{}", SHOWN.replace('@', "kept.ppm"));
    fs::write(folder.path().join("in/guess.ray"), missing).expect("a file");
    assert!(told(&folder, "check in/guess.ray").1.contains("kept.png"));
    let (_, said) = told(&folder, "check in/guess.ray --root in");
    assert!(!said.contains("kept.png") && !said.contains("out/"), "{said}");
    // What is inside is read, by links too.
    assert_eq!(told(&folder, "check in/whole.ray --root in"), (0, "in/whole.ray: no errors\n".to_owned()));
    let (status, said) = told(&folder, "check in/plain.ray --root nowhere");
    assert!(status == 2 && said.contains("cannot keep to the folder `nowhere`"), "{said}");
}

#[test]
fn nothing_outside_of_the_root_is_written() {
    let folder = workplace();
    for output in ["x.png", "in/../x.png", "in/image.png", "in/new.png", "in/out/x.png", "in/none/../../x/"] {
        let (status, said) = told(&folder, &format!("render in/plain.ray --root in -o {output}"));
        assert!(status != 0 && said.contains(OUTSIDE), "{output}: {said}");
    }
    let (status, said) = told(&folder, "convert in/plain.ray in/out/x.toml --root in");
    assert!(status != 0 && said.contains(OUTSIDE), "{said}");
    assert_eq!(fs::read(folder.path().join("kept.png")).expect("a file"), b"kept");
    for name in ["x.png", "new.png", "x", "x.toml"] {
        assert!(!folder.path().join(name).exists(), "{name}");
    }
    assert_eq!(told(&folder, "render in/plain.ray --root in -o in/deep/x.png").0, 0);
}

/// A text in another language than the scene is any file of the machine: messages show nothing of it.
#[test]
fn a_file_that_is_no_scene_is_not_shown() {
    let folder = workplace();
    symlink(folder.path().join("secret"), folder.path().join("in/innocent.ray")).expect("a link");
    let scenes = [
        ("include.ray", format!("include \"../secret\"\n{HEAD}")),
        ("link.ray2.ray", format!("{HEAD}include \"innocent.ray\"\n")),
        ("inner.ray", "include \"../secret\" sphere two { material m center 0 0 -9 radius -1 }\n".to_owned()),
        ("outer.ray", format!("include \"inner.ray\"\n{HEAD}")),
        ("include.toml", "include = \"../secret\"\n".to_owned()),
        ("mesh.ray", format!("{HEAD}mesh w {{ material m file ../secret }}\n")),
        ("texture.ray", format!("{HEAD}{}", SHOWN.replace('@', "../secret"))),
    ];
    for (name, text) in &scenes {
        fs::write(folder.path().join("in").join(name), text).expect("a file");
    }
    for (name, _) in &scenes {
        for form in ["human", "short", "json"] {
            let (status, said) = told(&folder, &format!("check in/{name} --message-format {form}"));
            assert_eq!(status, 2, "{name}: {said}");
            for word in ["hunter2", "root", "daemon", "19000"] {
                assert!(!said.contains(word), "{name}, {word}: {said}");
            }
        }
    }
    let (_, said) = told(&folder, "check in/include.ray");
    assert!(
        said.contains("`in/../secret` is not a scene") && said.contains("--> in/include.ray:1:9"),
        "{said}"
    );
    // A file that is named like a scene is shown.
    fs::write(folder.path().join("in/wrong.ray"), "sphere hunter2 { radius -1 }\n").expect("a file");
    fs::write(folder.path().join("in/a.ray"), format!("include \"wrong.ray\"\n{HEAD}")).expect("a file");
    assert!(told(&folder, "check in/a.ray").1.contains("1 | sphere hunter2 { radius -1 }"));
}

#[test]
fn values_of_a_file_are_set_and_files_that_never_end_or_lie_outside_are_refused() {
    let folder = workplace();
    fs::write(folder.path().join("in/values.json"), "{\"ball\": {\"radius\": 0.5, \"center\": [4, 3, -9]}}")
        .expect("a file");
    let (status, said) = told(&folder, "dump in/plain.ray --root in --set-from in/values.json");
    assert!(status == 0 && said.contains("-9.0") && said.contains("0.5"), "{said}");
    fs::write(folder.path().join("long.json"), format!("{{\"a\": \"{}\"}}", "b".repeat(2 << 20)))
        .expect("a file");
    for (line, why) in [
        ("check in/plain.ray --root in --set-from secret", OUTSIDE),
        ("check in/plain.ray --set-from long.json", "it is larger than 1 MiB"),
        ("check in/plain.ray --set-from /dev/zero", "cannot be read"),
        ("check in/plain.ray --set-from secret", "expected value at line 1"),
    ] {
        let (status, said) = told(&folder, line);
        assert!(status == 2 && said.contains(why) && !said.contains("hunter2"), "{line}: {said}");
    }
}

#[test]
fn nothing_that_waits_or_never_ends_is_read() {
    let folder = workplace();
    let pipe = folder.path().join("in/pipe.ray");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("a pipe").success());
    for file in
        ["pipe.ray", "/dev/zero", "/dev/tty", "/dev/stdin", "/proc/kmsg", "/proc/self/fd/0", "/proc/kcore"]
    {
        for entity in [
            format!("include \"{file}\"\n"),
            SHOWN.replace('@', &format!("\"{file}\"")),
            format!("mesh w {{ material m file \"{file}\" }}\n"),
        ] {
            fs::write(folder.path().join("in/a.ray"), format!("{HEAD}{entity}")).expect("a file");
            let (status, said) = told(&folder, "check in/a.ray");
            assert_eq!(status, 2, "{entity}: {said}");
        }
    }
}
