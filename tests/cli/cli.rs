//! The program as users run it: what it prints where, what it writes, and how it ends.

use crate::common;
use crate::common::program::{folder, names_in, outcome, scene, tabray};
use std::fs;
use std::io::Write;
use std::process::Stdio;

#[test]
fn a_picture_is_named_after_its_scene_in_the_working_directory() {
    let folder = folder();
    let (status, out, err) = outcome(tabray(&folder).arg("render").arg(scene("sphere/in-front.ray")));
    assert_eq!((status, out.len()), (0, 0), "{err}");
    assert!(err.starts_with("wrote in-front.png (160 x 120 pixels, "), "{err}");
    assert_eq!(names_in(folder.path()), ["in-front.png"]);
    assert_eq!(image::open(folder.path().join("in-front.png")).expect("a PNG").width(), 160);
}

#[test]
fn the_extension_or_the_option_says_the_format() {
    let folder = folder();
    let scene = scene("sphere/in-front.ray");
    let mut pictures = Vec::new();
    for args in [
        &["-o", "a.ppm"][..],
        &["-o", "b.PNG"],
        &["-o", "c", "--format", "png"],
        &["-o", "d.png", "--format", "ppm"],
    ] {
        let (status, _, err) = outcome(tabray(&folder).arg("render").arg(&scene).args(args));
        assert_eq!(status, 0, "{err}");
        let bytes = fs::read(folder.path().join(args[1])).expect("the file named");
        pictures.push((bytes[1], image::load_from_memory(&bytes).expect("a picture").into_rgb8()));
    }
    let kinds: Vec<_> = pictures.iter().map(|(kind, _)| *kind as char).collect();
    assert_eq!(kinds, ['6', 'P', 'P', '6']);
    assert!(pictures.iter().all(|(_, picture)| *picture == pictures[0].1));
}

#[test]
fn an_unknown_format_is_refused_before_the_scene_is_read() {
    let folder = folder();
    let (status, _, err) = outcome(tabray(&folder).args(["render", "no-such-scene.ray", "-o", "a.jpeg"]));
    assert_eq!(status, 2);
    assert!(!err.contains('\x1b'), "no colour where there is no terminal: {err:?}");
    assert!(err.contains("`a.jpeg` does not determine the format"), "{err}");
}

#[test]
fn standard_output_carries_the_picture_and_nothing_else() {
    let folder = folder();
    let (status, out, err) =
        outcome(tabray(&folder).arg("render").arg(scene("sphere/in-front.ray")).args(["-o", "-"]));
    assert_eq!((status, err.as_str()), (0, ""));
    assert!(out.starts_with(b"P6 160 120 255\n"));
    assert_eq!(out.len(), 15 + 3 * 160 * 120);
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn the_program_without_a_command_is_the_notes_program() {
    let folder = folder();
    let path = scene("material/glint.ray");
    let (status, picture, dump) = outcome(tabray(&folder).write_stdin(fs::read(&path).expect("a scene")));
    assert_eq!(status, 0, "{dump}");
    let (_, rendered, _) = outcome(tabray(&folder).arg("render").arg(&path).args(["-o", "-"]));
    let (_, dumped, _) = outcome(tabray(&folder).arg("dump").arg(&path));
    assert!(picture == rendered && dump.as_bytes() == dumped);
}

/// The course's spec1 to spec8 have a sphere `left` and an fplane `left`, and its logs have nothing but the dump.
#[test]
fn warnings_do_not_disturb_the_dump_of_the_notes_program() {
    let shared = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 6 }
        material red { ambient 9 1 1 }
        sphere left { material red center 2 3 -3 radius 1 }
        fplane left { material red normal 0 0 1 point 5 3 -3 xdir 1 0 0 dimensions 1 1 }
        light lamp { location 1 7 2 emissivity 5 5 5 }
        light lamp { location 7 7 2 emissivity 5 5 5 }\n";
    let twice = format!("{shared} material red {{ ambient 1 1 9 }}");
    let dump = |text: &str| {
        let (_, dump, _) = outcome(tabray(&folder()).args(["dump", "-"]).write_stdin(text));
        String::from_utf8(dump).expect("text")
    };
    let run = |text: &str, options: &[&str]| {
        let (status, _, err) = outcome(tabray(&folder()).args(options).write_stdin(text));
        assert_eq!(status, 0, "{err}");
        err
    };
    assert_eq!(run(shared, &[]), dump(shared));
    let told = run(&twice, &[]);
    let warning = told.strip_prefix(&dump(&twice)).expect("the dump comes first");
    assert!(warning.starts_with("warning: material `red` is defined twice"), "{warning}");
    assert_eq!(run(&twice, &["-q"]), dump(&twice));
    let (_, _, checked) = outcome(tabray(&folder()).args(["check", "-"]).write_stdin(shared));
    assert!(checked.contains("two objects have the name `left`"), "other commands warn: {checked}");
}

#[test]
fn a_faulty_scene_without_a_command_gives_messages_alone() {
    let (status, out, err) = outcome(tabray(&folder()).write_stdin("sphere ball {"));
    assert_eq!((status, out.len()), (2, 0));
    assert!(err.contains("--> <stdin>:1:1"), "{err}");
}

#[test]
fn a_scene_from_standard_input_needs_a_name_for_its_picture() {
    let folder = folder();
    let text = fs::read(scene("sphere/in-front.ray")).expect("a scene");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "-"]).write_stdin(text.clone()));
    assert_eq!(status, 2);
    assert!(err.contains("name a file with `-o FILE`"), "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "-", "-o", "a.png"]).write_stdin(text));
    assert_eq!(status, 0, "{err}");
}

#[test]
fn a_faulty_scene_leaves_the_old_picture_alone() {
    let folder = folder();
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let (status, out, err) =
        outcome(tabray(&folder).arg("render").arg(scene("wrong/zero-radius.ray")).args(["-o", "a.png"]));
    assert_eq!((status, out.len()), (2, 0));
    assert!(err.contains("zero-radius.ray:18:14"), "{err}");
    assert_eq!(fs::read(folder.path().join("a.png")).expect("still there"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png"]);
}

#[test]
fn every_mistake_ends_with_2_and_every_scene_with_0() {
    let folder = folder();
    for path in common::scenes() {
        let (status, _, err) = outcome(tabray(&folder).arg("check").arg(&path));
        assert_eq!(status, 0, "{}: {err}", path.display());
    }
    for entry in fs::read_dir(scene("wrong")).expect("the mistakes") {
        let path = entry.expect("an entry").path();
        let (status, out, err) = outcome(tabray(&folder).arg("render").arg(&path));
        let warned = err.contains("warning: ") && !err.contains("error: ");
        assert_eq!((status, out.len()), (if warned { 0 } else { 2 }, 0), "{}: {err}", path.display());
    }
}

#[test]
fn check_tells_of_all_scenes_and_remembers_the_bad_one() {
    let (status, out, err) = outcome(
        tabray(&folder()).arg("check").arg(scene("wrong/zero-radius.ray")).arg(scene("sphere/in-front.ray")),
    );
    assert_eq!((status, out.len()), (2, 0));
    assert!(err.contains("must be positive") && err.contains("in-front.ray: no errors"), "{err}");
}

#[test]
fn a_scene_that_cannot_be_read_is_named_with_the_reason() {
    let folder = folder();
    let (status, _, err) = outcome(tabray(&folder).args(["render", "no-such-scene.ray"]));
    assert_eq!(
        (status, err.as_str()),
        (1, "error: cannot read `no-such-scene.ray`: no such file or directory\n")
    );
    let (status, _, err) = outcome(tabray(&folder).args(["dump", "."]));
    assert_eq!((status, err.as_str()), (1, "error: cannot read `.`: is a directory\n"));
}

#[cfg(unix)]
#[test]
fn an_endless_device_is_no_scene() {
    let (status, _, err) = outcome(tabray(&folder()).args(["check", "/dev/zero"]));
    assert_eq!(status, 2);
    assert!(err.contains("unexpected NUL byte"), "{err}");
}

#[test]
fn an_unwritable_place_is_told_with_its_reason() {
    let folder = folder();
    fs::create_dir(folder.path().join("folder.png")).expect("a folder");
    let scene = scene("sphere/in-front.ray");
    for (place, reason) in [
        (
            "no/such/folder/a.png",
            "error: cannot write `no/such/folder/a.png`: there is no folder `no/such/folder`\n",
        ),
        ("folder.png", "error: cannot write `folder.png`: is a directory\n"),
    ] {
        let (status, _, err) = outcome(tabray(&folder).arg("render").arg(&scene).args(["-o", place]));
        assert_eq!(status, 1);
        assert_eq!(err, reason);
    }
    assert_eq!(names_in(folder.path()), ["folder.png"]);
}

#[test]
fn a_file_that_is_read_only_is_not_replaced() {
    let folder = folder();
    let path = folder.path().join("a.png");
    fs::write(&path, "precious").expect("a file");
    let mut permissions = fs::metadata(&path).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).expect("read-only");
    let (status, _, err) =
        outcome(tabray(&folder).arg("render").arg(scene("sphere/in-front.ray")).args(["-o", "a.png"]));
    assert_eq!(status, 1);
    assert!(err.contains("cannot write `a.png`: permission denied"), "{err}");
    assert_eq!(fs::read(&path).expect("still there"), b"precious");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure_with_its_reason() {
    let (status, _, err) = outcome(tabray(&folder()).arg("render").arg(scene("sphere/in-front.ray")).args([
        "-o",
        "/dev/full",
        "--format",
        "png",
    ]));
    assert_eq!(status, 1);
    assert!(err.contains("cannot write `/dev/full`: no space left on device"), "{err}");
    assert!(fs::metadata("/dev/full").expect("still a device").len() == 0);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_permissions_stay_as_they_were() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder();
    let (target, link) = (folder.path().join("target.png"), folder.path().join("link.png"));
    fs::write(&target, "old").expect("a file");
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("permissions");
    symlink("target.png", &link).expect("a link");
    let (status, _, err) =
        outcome(tabray(&folder).arg("render").arg(scene("sphere/in-front.ray")).args(["-o", "link.png"]));
    assert_eq!(status, 0, "{err}");
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert!(image::open(&target).is_ok());
    assert_eq!(fs::metadata(&target).expect("there").permissions().mode() & 0o777, 0o640);
    assert_eq!(names_in(folder.path()), ["link.png", "target.png"]);
}

#[test]
fn a_reader_that_has_had_enough_is_no_failure() {
    for args in [vec!["list"], vec!["dump", "big.ray"]] {
        let folder = folder();
        let text = fs::read_to_string(scene("sphere/in-front.ray")).expect("a scene");
        fs::write(folder.path().join("big.ray"), text.replace("160 120", "1600 1200")).expect("a file");
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("tabray"))
            .args(&args)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty());
    }
}

#[test]
fn list_knows_every_entity_and_attribute() {
    let folder = folder();
    let (status, out, _) = outcome(tabray(&folder).arg("list"));
    let out = String::from_utf8(out).expect("text");
    assert_eq!(status, 0);
    for entity in common::registry().iter() {
        assert!(out.lines().any(|line| line.starts_with(&format!("{} ", entity.name))), "{}", entity.name);
        let (status, out, _) = outcome(tabray(&folder).args(["list", entity.name]));
        let out = String::from_utf8(out).expect("text");
        assert_eq!(status, 0);
        for attribute in entity.attributes() {
            assert!(out.contains(attribute.name()) && out.contains(attribute.meaning()), "{out}");
        }
    }
    let (status, _, err) = outcome(tabray(&folder).args(["list", "spere"]));
    assert_eq!(status, 2);
    assert!(err.contains("did you mean `sphere`?"), "{err}");
}

#[test]
fn help_tells_the_exit_status() {
    let (status, out, _) = outcome(tabray(&folder()).arg("--help"));
    let out = String::from_utf8(out).expect("text");
    assert_eq!(status, 0);
    for code in ["  0  ", "  1  ", "  2  ", "130  "] {
        assert!(out.contains(code), "{out}");
    }
}

#[test]
fn a_scene_larger_than_any_scene_is_refused_in_bounded_memory() {
    let folder = folder();
    let path = folder.path().join("huge.ray");
    let mut file = fs::File::create(&path).expect("a file");
    file.write_all(b"# a comment that goes on for ever").expect("room");
    // The reader finds no NUL byte where it looks first, and no memory should be allocated for such a length.
    file.set_len(1 << 36).expect("a file with a hole");
    let (status, _, err) = outcome(tabray(&folder).arg("check").arg(&path));
    assert_eq!(status, 2);
    assert!(err.contains("unexpected NUL byte"), "{err}");
}

#[test]
#[ignore = "takes more than 1 GiB of memory"]
fn a_text_larger_than_any_scene_is_refused() {
    let script = "yes | head -c 1100000000 | \"$0\" check -";
    let program = assert_cmd::cargo::cargo_bin!("tabray");
    let output =
        std::process::Command::new("sh").args(["-c", script]).arg(program).output().expect("sh runs");
    assert_eq!(output.status.code(), Some(2));
    let said = "error: `<stdin>` is larger than 1024 MiB, too large for a scene\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), said);
}

#[test]
fn a_method_is_chosen_by_the_scene_or_by_an_option() {
    let folder = folder();
    let text = fs::read_to_string(scene("revsurf/leaning.ray")).expect("a scene");
    let classic = text.replace("pixeldim", "accuracy classic\n    pixeldim");
    fs::write(folder.path().join("exact.ray"), &text).expect("a file");
    fs::write(folder.path().join("classic.ray"), classic).expect("a file");
    let picture = |args: &[&str]| {
        let (status, out, err) = outcome(tabray(&folder).arg("render").args(args).args(["-o", "-"]));
        assert_eq!(status, 0, "{err}");
        out
    };
    let (exact, classic) = (picture(&["exact.ray"]), picture(&["classic.ray"]));
    assert_ne!(exact, classic);
    assert_eq!(picture(&["exact.ray", "--method", "classic"]), classic);
    assert_eq!(picture(&["classic.ray", "--method", "exact"]), exact);
    assert_eq!(picture(&["classic.ray", "--accuracy", "strict"]), exact);
    let both = ["render", "exact.ray", "--method", "classic", "--accuracy", "draft"];
    let (status, _, err) = outcome(tabray(&folder).args(both));
    assert_eq!(status, 2);
    assert!(err.contains("the classic method has no accuracy to choose"), "{err}");
}

#[test]
fn the_program_without_a_command_uses_the_notes_methods_unless_the_camera_says_otherwise() {
    let folder = folder();
    let text = fs::read_to_string(scene("revsurf/leaning.ray")).expect("a scene");
    let (status, notes, _) = outcome(tabray(&folder).write_stdin(text.as_str()));
    assert_eq!(status, 0);
    let path = scene("revsurf/leaning.ray");
    let rendered =
        |method| outcome(tabray(&folder).arg("render").arg(&path).args(["--method", method, "-o", "-"])).1;
    assert_eq!(notes, rendered("classic"));

    let asked = text.replace("pixeldim", "accuracy exact\n    pixeldim");
    let (status, asked, _) = outcome(tabray(&folder).write_stdin(asked));
    assert_eq!(status, 0);
    assert!(asked == rendered("exact") && asked != notes, "the camera has its say");
}
