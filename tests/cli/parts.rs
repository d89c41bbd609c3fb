//! Parts of images, which `merge` puts together.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

const SCENE: &str = "gallery/three-lamps.ray";

/// Runs a command in a folder, and returns its status, and what it says.
pub fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let (status, out, err) = outcome(tabray(folder).args(arguments));
    (status, String::from_utf8_lossy(&out).into_owned() + &err)
}

pub fn succeeds(folder: &TempDir, arguments: &[&str]) -> String {
    let (status, said) = run(folder, arguments);
    assert_eq!(status, 0, "{arguments:?}: {said}");
    said
}

/// Renders a scene with these options, whole to `whole/NAME`, and then to `NAME`: these parts of a number of them.
fn render(folder: &TempDir, name: &str, options: &[&str], parts: impl IntoIterator<Item = usize>, of: usize) {
    let scene = scene(SCENE);
    let scene = scene.to_str().expect("a path");
    for part in parts {
        let part = format!("{part}/{of}");
        succeeds(folder, &[&["render", scene, "-o", name, "--part", &part], options].concat());
    }
}

fn whole(folder: &TempDir, name: &str, options: &[&str]) {
    fs::create_dir_all(folder.path().join("whole")).expect("a folder");
    let (scene, path) = (scene(SCENE), format!("whole/{name}"));
    succeeds(folder, &[&["render", scene.to_str().expect("a path"), "-o", &path], options].concat());
}

/// Asserts that each file of the whole image has the same bytes as that of the merged one.
fn is_the_same(folder: &TempDir) {
    let names = names_in(&folder.path().join("whole"));
    assert!(!names.is_empty());
    for name in names {
        let [whole, merged] =
            ["whole", "."].map(|of| fs::read(folder.path().join(of).join(&name)).expect(&name));
        assert!(whole == merged, "{name}");
    }
}

/// Returns the options for one or the other level of CPU instructions, if this CPU has more than one.
fn cpu(turn: usize) -> Vec<&'static str> {
    match cfg!(target_arch = "x86_64") && std::arch::is_x86_feature_detected!("avx2") {
        true => vec!["--cpu", ["baseline", "avx2"][turn / 3 % 2]],
        false => Vec::new(),
    }
}

/// Shuffled, some of them made twice, with other instructions and other numbers of threads.
#[test]
fn an_image_of_parts_has_the_bytes_of_one_render() {
    let size = ["--size", "200"];
    for (name, of) in [("a.png", 1), ("a.png", 2), ("a.png", 16), ("a.ppm", 64)] {
        let folder = folder();
        whole(&folder, name, &size);
        // 7 has no factor in common with the numbers of parts.
        let all = (0..of).map(|index| 7 * index % of + 1);
        for (index, part) in all.chain([of, 1]).enumerate() {
            let threads = ["1", "3"][index % 2];
            let options = [&size[..], &["--threads", threads], &cpu(index)].concat();
            render(&folder, name, &options, [part], of);
        }
        succeeds(&folder, &["merge", name]);
        is_the_same(&folder);
    }
}

#[test]
fn an_image_of_parts_may_be_of_any_kind() {
    for (name, options) in [
        ("a.exr", &["--samples", "2"][..]),
        ("a.pfm", &["--crop", "20,3,67,39"]),
        ("a.png", &["--crop", "20,3,67,39", "--compress", "best", "--exposure", "0.3"]),
        ("a.png", &["--samples", "2..16", "--aov", "depth,normal,object,colour,cost,samples,error"]),
        ("a.png", &["--max-error", "6", "--certain", "--aov", "error,samples"]),
        ("a.exr", &["--aov", "depth,error"]),
        ("a.ppm", &["--aov", "object,face"]),
    ] {
        let folder = folder();
        let size = match options[0] {
            "--crop" => "90",
            // What is proven takes long, and a smaller image has fewer than five tiles.
            "--max-error" => "33",
            _ => "48",
        };
        let options = [&["--size", size], options].concat();
        whole(&folder, name, &options);
        render(&folder, name, &options, 1..=5, 5);
        succeeds(&folder, &["merge", name, "--remove-parts"]);
        is_the_same(&folder);
        assert!(names_in(folder.path()).iter().all(|name| !name.contains("part")), "the parts are removed");
    }
}

#[test]
fn a_part_that_is_killed_or_stopped_is_resumed() {
    let folder = folder();
    let options = ["--size", "120", "--samples", "1024", "--threads", "1"];
    whole(&folder, "a.png", &options);
    let scene = scene(SCENE);
    let arguments = |part: &str| {
        let words = ["render", scene.to_str().expect("a path"), "-o", "a.png", "--resume", "--part", part];
        [&words[..], &options].concat().iter().map(|word| (*word).to_owned()).collect::<Vec<_>>()
    };
    // The first part is stopped at later and later times, until it is done.
    let (mut limit, mut kept) = (20, 0);
    loop {
        let (words, limit_of) = (arguments("1/4"), format!("{limit}ms"));
        let words: Vec<_> = words.iter().map(String::as_str).chain(["--time-limit", &limit_of]).collect();
        let (status, said) = run(&folder, &words);
        kept += usize::from(said.contains("% of part 1/4 to a.png.part-1-of-4.checkpoint"));
        match status {
            0 => break,
            130 => limit += limit / 10,
            _ => panic!("{said}"),
        }
    }
    assert!(kept > 0, "the part was not stopped in its midst");
    // 50 are killed, and 13 interrupted.
    for turn in 0..63_u64 {
        let part = format!("{}/4", turn % 4 + 1);
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("tabray"))
            .args(arguments(&part))
            .args(cpu(turn as usize))
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program runs");
        thread::sleep(Duration::from_millis(13 * turn * turn % 97 + turn));
        if turn % 5 != 0 {
            child.kill().expect("it ends");
        } else {
            let _ =
                Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
        }
        child.wait().expect("it ends");
    }
    for part in ["1/4", "2/4", "3/4", "4/4"] {
        let words = arguments(part);
        succeeds(&folder, &words.iter().map(String::as_str).collect::<Vec<_>>());
    }
    succeeds(&folder, &["merge", "a.png"]);
    is_the_same(&folder);
    let left = [
        "a.png",
        "a.png.part-1-of-4",
        "a.png.part-2-of-4",
        "a.png.part-3-of-4",
        "a.png.part-4-of-4",
        "whole",
    ];
    assert_eq!(names_in(folder.path()), left);
    let words = arguments("2/4");
    let said = succeeds(&folder, &words.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.contains("a.png.part-2-of-4 exists already"), "{said}");
}

#[test]
fn a_part_that_is_there_loses_its_checkpoint() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    let (part, checkpoint) = (place("a.png.part-1-of-2"), place("a.png.part-1-of-2.checkpoint"));
    let options = ["--part", "1/2", "--size", "120", "--samples", "256", "--threads", "1", "--resume"];
    let scene = scene(SCENE);
    let words = [&["render", scene.to_str().expect("a path"), "-o", "a.png"], &options[..]].concat();
    // A render that is stopped, later and later until something is kept.
    let mut limit = 20;
    while !checkpoint.exists() {
        let (status, said) = run(&folder, &[&words[..], &["--time-limit", &format!("{limit}ms")]].concat());
        assert_eq!(status, 130, "{said}");
        limit += limit / 10;
    }
    let kept = fs::read(&checkpoint).expect("a checkpoint");
    succeeds(&folder, &words);
    assert!(part.exists() && !checkpoint.exists());
    // As if the program had been killed between the two.
    fs::write(&checkpoint, &kept).expect("a checkpoint");
    let said = succeeds(&folder, &words);
    assert!(said.contains("exists already") && !checkpoint.exists(), "{said}");
    // A file that is none of its own stays.
    fs::write(&checkpoint, "notes").expect("a file");
    succeeds(&folder, &words);
    assert!(checkpoint.exists());
}

/// Changes a byte of a file.
pub fn damage(path: &Path, at: impl Fn(usize) -> usize) {
    let mut bytes = fs::read(path).expect("a part");
    let at = at(bytes.len());
    bytes[at] ^= 1;
    fs::write(path, bytes).expect("a part");
}

#[test]
fn parts_that_do_not_belong_together_are_refused_with_the_reason() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    let refused = |arguments: &[&str], says: &str| {
        let (status, said) = run(&folder, &[&["merge", "a.png"], arguments].concat());
        // What the system refuses to read is no fault of the command line.
        let right = if says == "cannot read `gone`" { 1 } else { 2 };
        assert!(status == right && said.contains(says), "{says}: {said}");
        assert!(!place("a.png").exists());
    };
    refused(&[], "there is no part of `a.png`");
    refused(&["gone"], "cannot read `gone`");
    let size = ["--size", "80"];
    render(&folder, "a.png", &size, [1, 2, 6, 8], 8);
    refused(&[], "`a.png` lacks parts 3 to 5, 7 of 8");
    render(&folder, "a.png", &size, [3, 4, 5], 8);
    refused(&[], "`a.png` lacks part 7 of 8");
    let seventh = place("a.png.part-7-of-8");
    render(&folder, "a.png", &["--size", "81"], [7], 8);
    refused(&[], "the size was 80 x 60 and is 81 x 61");
    render(&folder, "a.png", &["--size", "80", "--set", "eye.viewpoint=4 3 7"], [7], 8);
    refused(&[], "the scene has changed");
    render(&folder, "a.png", &size, [7], 9);
    fs::remove_file(&seventh).expect("a part");
    refused(&[], "there are 9 parts and not 8");
    fs::remove_file(place("a.png.part-7-of-9")).expect("a part");
    render(&folder, "a.png", &size, [7], 8);
    let good = fs::read(&seventh).expect("a part");
    damage(&seventh, |len| len - 40);
    refused(&[], "`a.png.part-7-of-8` is damaged: the checksum at the end is wrong");
    damage(&place("a.png.part-2-of-8"), |len| len - 1);
    refused(&[], "`a.png.part-2-of-8`, `a.png.part-7-of-8` are damaged");
    damage(&place("a.png.part-2-of-8"), |len| len - 1);
    for bytes in
        [&b""[..], b"tabray part 1\n", b"tabray part 1\n{}\n", b"\xff\xd8 garbage", &good[..good.len() - 1]]
    {
        fs::write(&seventh, bytes).expect("a file");
        refused(&[], "cannot read `a.png.part-7-of-8`: it is");
    }
    // So many parts as nobody has, with a checksum that is right.
    let label = good.iter().position(|byte| *byte == b'{').expect("a label");
    let text = String::from_utf8_lossy(&good[label..]).replace("\"part\":[7,8]", "\"part\":[7,100000000000]");
    fs::write(&seventh, [&good[..label], text.as_bytes()].concat()).expect("a file");
    refused(&[], "cannot read `a.png.part-7-of-8`: it is damaged: its header makes no sense");
    let mut other = good.clone();
    let end = other.len();
    other[end - 1] ^= 1;
    fs::write(place("other"), other).expect("a file");
    fs::write(&seventh, &good).expect("a part");
    let all: Vec<_> = (1..=8).map(|part| format!("a.png.part-{part}-of-8")).collect();
    let all: Vec<_> = all.iter().map(String::as_str).chain(["other"]).collect();
    refused(&all, "are two versions of part 7");
    fs::write(place("other"), &good).expect("a part");
    for name in ["scene.ray", "a.ppm", "a.exr"] {
        fs::write(place(name), "precious").expect("a file");
        let (status, said) = run(&folder, &[&["merge", name], &all[..8]].concat());
        assert!(status == 2 && said.contains(&format!("of a .png image, not of `{name}`")), "{said}");
        assert_eq!(fs::read_to_string(place(name)).expect("still there"), "precious");
    }
    succeeds(&folder, &[&["merge", "a.png"], &all[..]].concat());
    whole(&folder, "a.png", &size);
    is_the_same(&folder);
}

/// Older versions wrote parts of another format, and checkpoints that are PNGs with a text.
#[test]
fn what_an_older_version_left_is_refused_and_stays() {
    let folder = folder();
    let older = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\x06\0\0\0\x1f\x15\xc4\x89\0\0\0\x19iTXttabray checkpoint\0";
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    for (name, bytes, args, help) in [
        (
            "a.png.checkpoint",
            &older[..],
            &["render", "a.ray", "-o", "a.png", "--resume"][..],
            "leave out `--resume`",
        ),
        (
            "b.png.part-1-of-1.checkpoint",
            older,
            &["render", "a.ray", "-o", "b.png", "--resume", "--part", "1/1"],
            "leave out `--resume`",
        ),
        (
            "c.png.part-1-of-1",
            b"tabray part 1\n{\"part\":[1,1]}\n",
            &["merge", "c.png"],
            "render the parts again",
        ),
    ] {
        fs::write(folder.path().join(name), bytes).expect("a file");
        let (status, said) = run(&folder, args);
        let says =
            format!("error: cannot read `{name}`: it is of an older version of tabray\n |\n = help: {help}");
        assert!(status == 2 && said.starts_with(&says), "{said}");
        assert!(fs::read(folder.path().join(name)).expect("still there") == bytes);
    }
}

#[test]
fn an_unfinished_part_is_not_merged() {
    let folder = folder();
    let scene = scene(SCENE);
    let words =
        ["render", scene.to_str().expect("a path"), "-o", "a.png", "--part", "1/1", "--samples", "256"];
    let (checkpoint, mut limit) = ("a.png.part-1-of-1.checkpoint", 20);
    while !folder.path().join(checkpoint).exists() {
        let (status, said) = run(&folder, &[&words[..], &["--time-limit", &format!("{limit}ms")]].concat());
        assert_eq!(status, 130, "{said}");
        limit += limit / 10;
    }
    let (status, said) = run(&folder, &["merge", "a.png", checkpoint]);
    let says = format!("cannot read `{checkpoint}`: it is a checkpoint of an unfinished part");
    assert!(status == 2 && said.contains(&says) && !folder.path().join("a.png").exists(), "{said}");
}

#[test]
fn parts_that_there_cannot_be_are_refused() {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    for (options, says) in [
        (&["--part", "0/16"][..], "parts are counted from 1: the first is `1/16`"),
        (&["--part", "17/16"], "the last of 16 parts is `16/16`"),
        (&["--part", "3"], "give a part as `3/16`"),
        (&["--part", "1/0"], "give a part as `3/16`"),
        (&["--part", "1/100001"], "give a part as `3/16`"),
        (&["--part", "3/100000"], "cannot have 100000 parts"),
        (&["--part", "1/2", "-o", "-"], "a part cannot be written beside standard output"),
    ] {
        let (status, said) = run(&folder, &[&["render", "a.ray"], options].concat());
        assert!(status == 2 && said.contains(says), "{options:?}: {said}");
    }
    assert_eq!(names_in(folder.path()), ["a.ray"]);
}

/// The scripts are run here as Slurm runs them, task by task.
#[test]
fn the_scripts_of_a_job_array_render_and_merge_an_image() {
    let folder = folder();
    let scene = scene(SCENE);
    let scene = scene.to_str().expect("a path");
    let size = ["--size", "60"];
    let words = [&["farm", "slurm", scene, "-o", "my image.png", "--parts", "3", "--"][..], &size].concat();
    let said = succeeds(&folder, &words);
    let [render, merge] = ["render", "merge"].map(|script| format!("'my image.png.slurm/{script}.sbatch'"));
    assert_eq!(said, format!("sbatch --dependency=afterok:$(sbatch --parsable {render}) {merge}\n"));
    let bash = |script: &str, task: &str| {
        let mut bash = Command::new("bash");
        bash.arg(folder.path().join("my image.png.slurm").join(script)).current_dir(folder.path());
        let done = bash.env("SLURM_ARRAY_TASK_ID", task).output().expect("a shell");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    };
    ["2", "3", "1"].iter().for_each(|task| bash("render.sbatch", task));
    bash("merge.sbatch", "");
    whole(&folder, "my image.png", &size);
    is_the_same(&folder);
}
