//! What rays hit, asked as files and pipes.

use crate::common::program::{folder, outcome, scene, tabray};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A ball of radius 5, and one within it, which is hit second.
const BALLS: &str = "material grey { } sphere ball { material grey center 0 0 0 radius 5 }
    sphere core { material grey center 0 0 0 radius 3 }";

fn with_balls() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("balls.ray"), BALLS).expect("a file");
    folder
}

/// Asks about rays that are piped in. Returns the status, the answers and the messages.
fn asked(folder: &TempDir, options: &[&str], rays: &str) -> (i32, String, String) {
    let (status, out, err) = outcome(tabray(folder).arg("hits").args(options).write_stdin(rays));
    (status, String::from_utf8(out).expect("text"), err)
}

fn lines(answers: &str) -> Vec<Value> {
    answers.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn each_ray_has_its_answer_in_lengths_of_its_direction() {
    // Where x² + 9 = 25, and where x² + 16 = 25.
    let rays =
        "10 3 0  -1 0 0\n10 4 0  -3 0 0 # scaled\n10 4 0  -3e-250 0 0\n\n10 6 0, -1 0 0\n0 0 0  0 1 0\n";
    let (status, out, err) = asked(&with_balls(), &["balls.ray", "--tight"], rays);
    assert_eq!((status, err.as_str()), (0, ""), "no camera is missed");
    let answers = lines(&out);
    let verdicts: Vec<_> = answers.iter().map(|answer| answer["verdict"].as_str().expect("a word")).collect();
    assert_eq!(verdicts, ["hit", "hit", "hit", "miss", "hit"]);
    for (answer, (t, distance)) in answers.iter().zip([(6.0, 6.0), (7.0 / 3.0, 7.0), (7.0 / 3e-250, 7.0)]) {
        let of = |name: &str| answer[name].as_f64().expect(name);
        assert!(of("t_low") <= t && t <= of("t_high"), "{answer}");
        assert!(of("t_high") - of("t_low") <= 2.0 * f64::EPSILON * t, "{answer}");
        assert!((of("t") / t - 1.0).abs() <= f64::EPSILON, "{answer}");
        assert_eq!(
            (of("distance"), &answer["object"], &answer["number"]),
            (distance, &"ball".into(), &0.into())
        );
    }
    assert_eq!(answers[0]["point"], serde_json::json!([4.0, 3.0, 0.0]));
    assert_eq!(answers[4]["object"], "core");
    assert!(answers[3].get("t").is_none() && answers[3].get("object").is_none());
}

#[test]
fn what_rounding_decides_wrongly_is_decided_or_said_to_be_open() {
    // A touching ray; one half a unit of rounding beside it, which f64 cannot tell from it; balls in one place.
    let folder = folder();
    let scene = format!("{BALLS} sphere twin {{ material grey center 0 0 0 radius 5 }}");
    fs::write(folder.path().join("three.ray"), scene).expect("a file");
    let rays =
        "10 5 0  -1 0 0\n10 5.000000000000001 0  -1 0 0\n10 4.999999999999999 0  -1 0 0\n10 0 0  -1 0 0\n";
    let (status, out, _) = asked(&folder, &["three.ray"], rays);
    let verdicts: Vec<_> = lines(&out).iter().map(|answer| answer["verdict"].to_string()).collect();
    assert_eq!(status, 0);
    // That something is hit is certain where it is not what.
    let (_, any, _) = asked(&folder, &["three.ray", "--any"], rays);
    let any: Vec<_> = lines(&any).iter().map(|answer| answer["verdict"].to_string()).collect();
    assert_eq!(any[1..], ["\"miss\"", "\"hit\"", "\"hit\""]);
    assert_ne!(verdicts[0], "\"miss\"", "{out}");
    assert_eq!(verdicts[1..], ["\"miss\"", "\"tie\"", "\"tie\""], "{out}");
}

#[test]
fn rays_end_at_their_t_and_only_whether_something_is_hit_may_be_asked() {
    let rays = "10 0 0  -1 0 0  4.5\n10 0 0  -1 0 0  5.5\n10 0 0  -1 0 0\n";
    let folder = with_balls();
    let verdicts = |options: &[&str]| -> Vec<String> {
        let (status, out, err) = asked(&folder, options, rays);
        assert_eq!(status, 0, "{err}");
        lines(&out)
            .iter()
            .map(|line| format!("{} {}", line["verdict"], line.get("object").is_some()))
            .collect()
    };
    for fast in [&[][..], &["--fast"]] {
        let with = |options: &[&'static str]| verdicts(&[&["balls.ray"], options, fast].concat());
        assert_eq!(with(&[]), ["\"miss\" false", "\"hit\" true", "\"hit\" true"]);
        assert_eq!(with(&["--t-max", "4"]), ["\"miss\" false", "\"hit\" true", "\"miss\" false"]);
        assert_eq!(with(&["--any"]), ["\"miss\" false", "\"hit\" false", "\"hit\" false"]);
    }
}

#[test]
fn all_forms_of_rays_and_answers_say_the_same() {
    let folder = with_balls();
    let texts = [
        "10 3 0 -1 0 0\n10 7 0 -1 0 0 5\n",
        "ox,oy,oz,dx,dy,dz,t_max\n10,3,0,-1,0,0,\n10, 7, 0, -1, 0, 0, 5\n",
        "# rays\n\"ox\",\"oy\",\"oz\",\"dx\",\"dy\",\"dz\",\"t_max\"\r\n10,3,0,-1,0,0,\r\n10,7,0,-1,0,0,5\r\n",
        "{\"origin\": [10, 3, 0], \"direction\": [-1, 0, 0]}\n[10, 7, 0, -1, 0, 0, 5]\n",
    ];
    let answers = texts.map(|rays| asked(&folder, &["balls.ray"], rays));
    assert!(answers.iter().all(|answer| *answer == answers[0]), "{answers:?}");
    let rays: Vec<u8> = [10.0, 3.0, 0.0, -1.0, 0.0, 0.0, f64::INFINITY, 10.0, 7.0, 0.0, -1.0, 0.0, 0.0, 5.0]
        .iter()
        .flat_map(|number: &f64| number.to_le_bytes())
        .collect();
    let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 7), }";
    let head = format!("{head:117}\n");
    let npy = [&b"\x93NUMPY\x01\x00\x76\x00"[..], head.as_bytes(), &rays].concat();
    fs::write(folder.path().join("rays.npy"), &npy).expect("a file");
    assert_eq!(asked(&folder, &["balls.ray", "rays.npy"], ""), answers[0]);
    let (status, out, err) = asked(&folder, &["balls.ray", "rays.npy", "--to", "csv"], "");
    assert_eq!((status, err.as_str()), (0, ""));
    assert_eq!(
        out,
        "verdict,proof,object,number,face,t,t_low,t_high,distance,x,y,z,nx,ny,nz,u,v,surface,coverage\n\
         hit,53 bits,ball,0,,6,5.999999999999948,6.000000000000056,6,4,3,0,0.8,0.6000000000000001,0,0.75,0.7048327646991336,0,\n\
         miss,53 bits,,,,,,,,,,,,,,,,,\n"
    );
    let (status, _, err) = asked(&folder, &["balls.ray", "rays.npy", "-o", "answers.npy"], "");
    assert_eq!((status, err.as_str()), (0, ""));
    let array = fs::read(folder.path().join("answers.npy")).expect("an array");
    let length = 10 + usize::from(u16::from_le_bytes([array[8], array[9]]));
    let head = String::from_utf8_lossy(&array[..length]);
    assert!(head.contains("('t_low', '<f8')") && head.contains("'shape': (2,)"), "{head}");
    assert_eq!(array[length], 1, "the first is a hit");
    let record = (array.len() - length) / 2;
    assert_eq!((record, array[length + record]), (1 + 1 + 4 + 4 + 4 * 8 + 8 * 8 + 4 + 8, 0));
}

#[test]
fn what_is_no_ray_is_told_with_its_line_and_harms_no_answers_that_were_there() {
    let folder = with_balls();
    let old = folder.path().join("answers.csv");
    fs::write(&old, "old").expect("a file");
    let rays = "10 0 0 -1 0 0\n1 2 three 4 5 6\n1 2 3 0 0 0\n1 2 3\n";
    let (status, out, err) = asked(&folder, &["balls.ray", "-o", "answers.csv"], rays);
    assert_eq!((status, out.as_str()), (2, ""));
    for told in [
        "error: `<stdin>`, line 2: `three` is not a number\n",
        "`<stdin>`, line 3: its direction is 0\n",
        "`<stdin>`, line 4: a ray has six numbers, its origin and its direction, and perhaps the t at which it ends; here are 3\n",
        "`--skip-bad` leaves such rays out, and counts them",
    ] {
        assert!(err.contains(told), "{told}\n{err}");
    }
    assert_eq!(fs::read_to_string(&old).expect("a file"), "old");
    let (status, out, err) = asked(&folder, &["balls.ray", "--skip-bad"], rays);
    assert_eq!((status, lines(&out).len()), (0, 1));
    assert_eq!(err, "warning: 3 lines are not rays and were left out\n");
}

#[test]
fn a_mesh_is_asked_without_a_scene_and_names_its_faces() {
    let folder = folder();
    fs::write(folder.path().join("my part.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
        .expect("a file");
    // The last two go through the edge that both faces share, and through a corner of the surface.
    let rays = "0.75 0.25 1  0 0 -1\n0.25 0.75 1  0 0 -1\n0.5 0.5 1  0 0 -1\n1 1 1  0 0 -1\n";
    let (status, out, err) = asked(&folder, &["my part.obj"], rays);
    assert_eq!(status, 0, "{err}");
    let answers = lines(&out);
    assert_eq!((&answers[0]["face"], &answers[1]["face"]), (&0.into(), &1.into()));
    for answer in &answers[2..] {
        assert_eq!((&answer["verdict"], &answer["t"]), (&"hit".into(), &1.0.into()), "no gap along an edge");
    }
    assert!(answers.iter().all(|answer| answer["object"] == "my part"));
    assert_eq!(err, "");
    let named = fs::read_to_string(folder.path().join("my part.obj"))
        .expect("a file")
        .replace("f 1", "usemtl red\nf 1");
    fs::write(folder.path().join("red.obj"), named).expect("a file");
    assert_eq!(asked(&folder, &["red.obj"], rays).2, "", "colours are of no interest");
    fs::write(folder.path().join("bad.obj"), "v 0 0\n").expect("a file");
    let (status, _, err) = asked(&folder, &["bad.obj"], rays);
    assert!(status == 2 && err.contains("cannot read `bad.obj` as a mesh: line 1"), "{err}");
}

/// What is said of a mesh shows no line of a scene that nobody wrote.
#[test]
fn a_warning_about_a_mesh_is_about_its_file() {
    let folder = folder();
    let bent = "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n";
    fs::write(folder.path().join("bent.obj"), bent).expect("a file");
    let (status, _, err) = asked(&folder, &["bent.obj"], "0.7 0.2 9  0 0 -1\n");
    assert_eq!(status, 0, "{err}");
    assert!(err.starts_with("warning: mesh `bent` has polygons that are not flat: 1\n"), "{err}");
    assert!(!err.contains("material") && !err.contains("-->"), "{err}");
}

#[test]
fn answers_depend_on_the_rays_alone() {
    let folder = folder();
    let scene = scene("gallery/marbles.ray");
    let answers = |options: &[&str]| {
        let scene = scene.to_str().expect("a path");
        let options = [&[scene, "--from-camera", "--set", "eye.pixeldim=40 30"], options].concat();
        let (status, out, err) = asked(&folder, &options, "");
        assert_eq!((status, err.as_str()), (0, ""));
        out
    };
    let one = answers(&["--threads", "1"]);
    assert_eq!(one.lines().count(), 1200);
    assert!(answers(&["--threads", "5"]) == one);
    // What the tracer finds is what is proven.
    let found =
        |text: &str| -> Vec<_> { lines(text).iter().map(|line| line.get("object").cloned()).collect() };
    assert!(found(&one) == found(&answers(&["--fast"])));
}

#[test]
fn who_asks_through_a_pipe_has_an_answer_before_the_next_question() {
    let folder = with_balls();
    let mut child = Command::new(env!("CARGO_BIN_EXE_tabray"))
        .current_dir(folder.path())
        .args(["hits", "balls.ray", "-q"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut rays = child.stdin.take().expect("a pipe");
    let mut answers = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    for verdict in ["hit", "miss", "hit"] {
        let ray = if verdict == "hit" { "10 0 0  -1 0 0" } else { "10 0 0  1 0 0" };
        writeln!(rays, "{ray}").expect("it reads");
        let answer = answers.next().expect("an answer").expect("text");
        assert!(answer.contains(&format!("\"verdict\":\"{verdict}\"")), "{answer}");
    }
    drop(rays);
    assert!(child.wait().expect("it ends").success());
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = with_balls();
    fs::write(folder.path().join("long.csv"), "ox,".repeat(1 << 20)).expect("a file");
    for (options, says) in [
        (&["-"][..], "standard input cannot be both"),
        (&["balls.ray", "--to", "npy"], "an array needs to know the number of its answers first"),
        (&["balls.ray", "-o", "answers.txt"], "end it in .jsonl, .csv or .npy"),
        (&["balls.ray", "-o", "balls.ray"], "has no known format"),
        (&["balls.ray", "--t-max", "0"], "give a positive number"),
        (&["balls.ray", "--from", "csv"], "the first line lacks `ox`"),
        (&["balls.ray", "--from", "npy"], "row 1: "),
        (&["balls.ray", "none.txt"], "cannot read `none.txt`"),
        (&["balls.ray", "long.csv"], "it is longer than 4096 bytes"),
    ] {
        let (status, out, err) = asked(&folder, options, "1 2 3 4 5 6\n");
        assert!(out.is_empty() && [1, 2].contains(&status) && err.contains(says), "{options:?}: {err}");
    }
}

#[test]
fn all_surfaces_that_a_ray_crosses_are_told_in_their_order() {
    let rays = "10 0 0  -1 0 0\n10 5 0  -1 0 0\n10 4 0  -1 0 0  9\n";
    let (status, out, err) = asked(&with_balls(), &["balls.ray", "--all"], rays);
    assert_eq!((status, err.as_str()), (0, ""));
    let found: Vec<_> = lines(&out)
        .iter()
        .map(|answer| {
            let word = |name: &str| answer[name].as_str().unwrap_or("-").to_owned();
            format!("{} {} {} {}", answer["ray"], word("verdict"), word("object"), answer["enters"])
        })
        .collect();
    let right = [
        "0 hit ball true",
        "0 hit core true",
        "0 hit core false",
        "0 hit ball false",
        "0 miss - null",
        "1 undecided - null",
        "2 hit ball true",
        "2 miss - null",
    ];
    assert_eq!(found, right, "{out}");
    // Each crossing of a mesh has its own face.
    let folder = with_balls();
    fs::write(folder.path().join("box.ray"), "material m { } box b { material m center 0 0 0 size 2 3 4 }")
        .expect("a file");
    let (_, out, _) = asked(&folder, &["box.ray", "--all"], "0.1 9 0.2  0 -1 0\n0 9 0  0 -1 0\n");
    let faces: Vec<_> = lines(&out).iter().map(|answer| answer["face"].as_u64()).collect();
    assert_eq!(faces, [Some(5), Some(4), None, Some(5), Some(4), None]);
    let (_, csv, _) = asked(&with_balls(), &["balls.ray", "--all", "--to", "csv"], rays);
    assert!(
        csv.starts_with("ray,enters,verdict,")
            && csv.lines().nth(1).is_some_and(|line| line.starts_with("0,true,hit,"))
    );
    let (status, _, err) = asked(&with_balls(), &["balls.ray", "--all", "-o", "a.npy"], rays);
    assert!(status == 2 && err.contains("leave out `--all`"), "{err}");
}

/// Judges answers that are piped in. Returns the status, the report and the messages.
fn judged(folder: &TempDir, options: &[&str], answers: &str) -> (i32, String, String) {
    let (status, out, err) =
        outcome(tabray(folder).args(["judge", "balls.ray"]).args(options).write_stdin(answers));
    (status, String::from_utf8(out).expect("text"), err)
}

#[test]
fn answers_of_another_tracer_are_judged_each_for_what_it_is() {
    let folder = with_balls();
    let answers = "ox,oy,oz,dx,dy,dz,hit,t,object\n\
        10,3,0,-1,0,0,hit,6,ball\n\
        10,0,0,-2,0,0,1,2.5000001,0\n\
        10,6,0,-1,0,0,miss,,\n\
        10,3,0,-1,0,0,miss,,\n\
        10,6,0,-1,0,0,hit,9,ball\n\
        10,0,0,-1,0,0,hit,7,core\n\
        10,0,0,-1,0,0,hit,15,ball\n\
        10,0,0,-1,0,0,hit,6,ball\n\
        10,0,0,-1,0,0,hit,5,core\n\
        10,5,0,-1,0,0,miss,,\n";
    let (status, out, err) = judged(&folder, &["--json"], answers);
    assert_eq!((status, err.as_str()), (1, "error: 6 answers are wrong\n"));
    let report: Value = serde_json::from_str(&out).expect("JSON");
    for (name, count) in [
        ("answers", 10),
        ("right", 3),
        ("missed", 1),
        ("invented", 1),
        ("later", 2),
        ("inaccurate", 1),
        ("other_object", 1),
        ("open", 1),
    ] {
        assert_eq!(report[name], count, "{name}: {out}");
    }
    // The worst is repeated by the line that it names.
    let repeat = report["worst"][0]["repeat"].as_str().expect("a command");
    assert_eq!(repeat, "echo '10 3 0 -1 0 0' | tabray hits balls.ray");
    // Below the tolerance nothing is wrong, and JSON says the same.
    let right = "{\"origin\": [10, 0, 0], \"direction\": [-1, 0, 0], \"t\": 5.00001, \"object\": \"ball\"}\n";
    assert_eq!(judged(&folder, &[], right).0, 0);
    assert_eq!(judged(&folder, &["--tolerance", "1e-9"], right).0, 1);
    let (status, _, err) = judged(&folder, &[], "ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n");
    assert!(status == 2 && err.contains("line 1: the first line lacks `t` or `hit`"), "{err}");
    let (status, _, err) = judged(&folder, &[], "ox,oy,oz,dx,dy,dz,t\n1,2,3,0,0,0,6\n1,2,3,4,x,6,1\n");
    assert_eq!(status, 2);
    assert!(
        err.contains("line 2: its direction is 0") && err.contains("line 3: `x` is not a number for `dy`"),
        "{err}"
    );
}

#[test]
fn wrong_answers_are_shown_where_they_lie() {
    let folder = with_balls();
    let answers = "ox,oy,oz,dx,dy,dz,t\n10,0,0,-1,0,0,\n";
    let (status, _, err) = judged(&folder, &["-o", "wrong.png"], answers);
    assert!(status == 2 && err.contains("the scene has no camera to show it"), "{err}");
    let eye = "look_at eye { pixeldim 41 31 position 20 0 0 target 0 0 0 angle 40 }";
    fs::write(folder.path().join("balls.ray"), format!("{eye} {BALLS}")).expect("a file");
    assert_eq!(judged(&folder, &["-o", "wrong.png"], answers).0, 1);
    let picture = image::open(folder.path().join("wrong.png")).expect("an image").to_rgb8();
    let red: Vec<_> = picture.enumerate_pixels().filter(|(.., pixel)| pixel.0 == [255, 40, 40]).collect();
    assert!(red.len() == 9 && red.iter().any(|(x, y, _)| [*x, *y] == [20, 15]), "{red:?}");
}

#[test]
fn hard_rays_reach_edges_corners_and_seams_and_are_the_same_for_any_number_of_threads() {
    let folder = folder();
    let scene = "material m { } box b { material m center 0 0 0 size 2 3 4 } sphere s { material m center 1 0 0 radius 1 }";
    fs::write(folder.path().join("hard.ray"), scene).expect("a file");
    let rays = |threads: &str, seed: &str| {
        let args = ["hard", "hard.ray", "-n", "600", "--threads", threads, "--seed", seed];
        let (status, out, err) = outcome(tabray(&folder).args(args));
        assert_eq!((status, err.as_str()), (0, ""));
        String::from_utf8(out).expect("text")
    };
    let one = rays("1", "1");
    assert_eq!(one, rays("3", "1"));
    assert_ne!(one, rays("1", "2"));
    assert_eq!(one.lines().count(), 601);
    for place in ["outline", "edge", "corner", "seam"] {
        assert!(one.lines().any(|line| line.contains(&format!(",{place},"))), "no {place}");
    }
    let (status, out, err) = asked(&folder, &["hard.ray", "--to", "csv"], &one);
    assert_eq!((status, err.as_str(), out.lines().count()), (0, "", 601));
    // A plane alone has nothing to be aimed at.
    fs::write(
        folder.path().join("plane.ray"),
        "material m { } plane p { material m normal 0 1 0 point 0 0 0 }",
    )
    .expect("a file");
    let (status, _, err) = outcome(tabray(&folder).args(["hard", "plane.ray", "-n", "10"]));
    assert!(status == 0 || err.contains("no ray is hard"), "{status} {err}");
}
