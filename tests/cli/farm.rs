//! What `tabray farm` writes for schedulers, and what it refuses before it writes anything.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use std::fs;
use std::process::Command;
use tempfile::TempDir;

/// A folder with a scene of some pixels.
fn workplace() -> TempDir {
    let folder = folder();
    let ball = "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 0 0 }
sphere ball { material m center 4 3 -3 radius 2 }\n";
    fs::write(folder.path().join("ball.ray"), ball).expect("a scene");
    folder
}

fn farm(folder: &TempDir, words: &[&str]) -> (i32, String, String) {
    let (status, out, err) = outcome(tabray(folder).arg("farm").args(words));
    (status, String::from_utf8(out).expect("text"), err)
}

#[test]
fn options_scenes_and_names_with_faults_are_refused_before_anything_is_written() {
    let folder = workplace();
    fs::write(folder.path().join("wrong.ray"), "sphere a { radius -1 }").expect("a scene");
    for engine in ["slurm", "commands", "kubernetes"] {
        for (words, said) in [
            ("ball.ray -o x.png --parts 2 -- --sampels 4", "unexpected argument '--sampels'"),
            ("ball.ray -o x.png --parts 2 -- --samples none", "invalid value 'none'"),
            ("ball.ray -o x.png --parts 2 -- --crop 0,0,99,99", "error: "),
            ("ball.ray -o x.png --parts 2 -- --set ball.radius=-1", "must be positive"),
            ("ball.ray -o x.png --parts 2 -- --frames 1..9 --sweep ball.radius=1..-1", "must be positive"),
            ("ball.ray -o x.exr --parts 2 -- --frames 1..9", "cannot be resumed or put together"),
            ("ball.ray -o x.gif --parts 2", "does not determine the format"),
            ("ball.ray -o ball.ray --parts 2", "`ball.ray`"),
            ("missing.ray -o x.png --parts 2", "cannot read `missing.ray`"),
            ("wrong.ray -o x.png --parts 2", "must be positive"),
            ("- -o x.png --parts 2", "standard input and output are those of one machine"),
            ("ball.ray -o a\nb.png --parts 2", "a script cannot name `a\\nb.png`"),
            ("ball.ray -o x.png --parts 2 -- --set a=\x1b", "a script cannot have the option `a=\\u{1b}`"),
        ] {
            let words: Vec<_> = [engine].into_iter().chain(words.split(' ')).collect();
            let (status, out, err) = farm(&folder, &words);
            assert!(status != 0 && out.is_empty() && err.contains(said), "{words:?}: {out}{err}");
            assert_eq!(names_in(folder.path()), ["ball.ray", "wrong.ray"], "{words:?}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_text_is_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = workplace();
    let mut command = tabray(&folder);
    let name = OsStr::from_bytes(b"a\xff.png");
    let (status, _, err) =
        outcome(command.args(["farm", "slurm", "ball.ray", "--parts", "2", "-o"]).arg(name));
    assert!(status == 2 && err.contains(r"a script cannot name `a\xff.png`"), "{err}");
}

/// What Slurm would take for something else is written so that it does not.
#[test]
fn the_scripts_of_a_film_say_what_they_mean() {
    let folder = workplace();
    let words = "slurm ball.ray -o 5%a\"'.png --parts 3 -- --frames 1..4 --sweep ball.radius=1..2";
    let (status, line, err) = farm(&folder, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(status, 0, "{err}");
    assert!(
        line.starts_with("sbatch --dependency=afterok:$(sbatch --parsable '5%a\"'\\''.png.slurm/"),
        "{line}"
    );
    let read =
        |name: &str| fs::read_to_string(folder.path().join("5%a\"'.png.slurm").join(name)).expect("a script");
    let [render, merge] = ["render.sbatch", "merge.sbatch"].map(read);
    assert!(render.contains("#SBATCH --output=\"5%%a\\\"'.png.slurm/part-%a.log\"\n"), "{render}");
    assert!(merge.contains("#SBATCH --kill-on-invalid-dep=yes\n"), "{merge}");
    let run = |script: &str, task: &str| {
        let mut bash = Command::new("bash");
        bash.args(["-c", script]).current_dir(folder.path()).env("SLURM_ARRAY_TASK_ID", task);
        let done = bash.output().expect("a shell");
        assert!(done.status.success(), "{script}: {}", String::from_utf8_lossy(&done.stderr));
    };
    ["1", "2", "3"].iter().for_each(|task| run(&render, task));
    run(&merge, "");
    assert!(folder.path().join("5%a\"'.apng").exists());
}

#[test]
fn commands_stand_one_a_line_and_make_the_image() {
    let folder = workplace();
    let (status, out, err) = farm(&folder, &["commands", "ball.ray", "--output=-x.png", "--parts", "3"]);
    assert_eq!(status, 0, "{err}");
    assert_eq!(out.lines().count(), 3);
    let last = err.strip_prefix("once all of them have ended: ").expect("the last command");
    for line in out.lines().chain([last]) {
        let mut bash = Command::new("bash");
        let done = bash.args(["-c", line]).current_dir(folder.path()).output().expect("a shell");
        assert!(done.status.success(), "{line}: {}", String::from_utf8_lossy(&done.stderr));
    }
    assert!(folder.path().join("-x.png").exists());
    let words = "commands ball.ray -o x.png --parts 1 --container tabray:1 -- --size 8";
    let (_, out, _) = farm(&folder, &words.split(' ').collect::<Vec<_>>());
    let start = "podman run --rm --volume \"$PWD\":/scenes tabray:1 render ball.ray -o x.png";
    assert_eq!(out, format!("{start} --part 1/1 --resume --size 8\n"));
    let path = scene("sphere/in-front.ray");
    let path = path.to_str().expect("a path");
    let (status, _, err) = farm(&folder, &["kubernetes", path, "-o", "x.png", "--parts", "2"]);
    assert!(status == 2 && err.contains("is not relative to the volume"), "{err}");
}

#[test]
fn kubernetes_is_given_two_jobs() {
    let folder = workplace();
    let (status, out, err) = farm(
        &folder,
        &["kubernetes", "ball.ray", "-o", "Big_1 $(A).png", "--parts", "64", "--", "--samples", "4"],
    );
    assert_eq!(status, 0, "{err}");
    let part = r#"exec tabray render ball.ray -o 'Big_1 $$(A).png' --part \"$((JOB_COMPLETION_INDEX + 1))\"/64 --resume --samples 4"#;
    for line in [
        "  name: big-1---a-parts\nspec:\n  completions: 64\n",
        concat!("          image: \"tabray:", env!("CARGO_PKG_VERSION"), "\"\n"),
        &format!("          command: [\"sh\",\"-c\",\"{part}\"]\n"),
        "  name: big-1---a-merge\nspec:\n  suspend: true\n",
        "          command: [\"sh\",\"-c\",\"exec tabray merge 'Big_1 $$(A).png'\"]\n",
        "          persistentVolumeClaim: {claimName: \"scenes\"}\n",
    ] {
        assert!(out.contains(line), "{line} is not in\n{out}");
    }
    assert!(err.contains("kubectl patch job/big-1---a-merge"), "{err}");
}
