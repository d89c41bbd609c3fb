//! Rays that start at the hits of others, told by the answers of an earlier run.

use crate::common::program::{folder, outcome, tabray};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

const BALLS: &str = "material grey { } sphere ball { material grey center 0 0 0 radius 5 }
    sphere core { material grey center 0 0 0 radius 3 }";

/// A cube around the origin, as an OBJ file.
fn cube(half: f64) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let side = |axis: u32| if corner >> axis & 1 == 1 { half } else { -half };
        writeln!(text, "v {} {} {}", side(0), side(1), side(2)).expect("a string");
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

/// Asks about the rays of a file.
fn asked(folder: &TempDir, options: &[&str]) -> (i32, Vec<Value>, String) {
    let (status, out, err) = outcome(tabray(folder).arg("hits").args(options));
    let text = String::from_utf8(out).expect("text");
    (status, text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect(), err)
}

fn vector(answer: &Value, name: &str) -> [f64; 3] {
    [0, 1, 2].map(|axis| answer[name][axis].as_f64().expect("a number"))
}

/// Writes rays from outside toward points near the origin, and their hits in each format, and then rays along normals of the
/// hits, with this sign.
fn prepare(folder: &TempDir, scene: &str, size: f64, sign: f64) {
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    let mut rays = String::new();
    for number in 0..300 {
        let turn = 2.4 * f64::from(number);
        let up = f64::from(number) / 150.0 - 0.999;
        let out = (1.0 - up * up).max(0.0).sqrt();
        let from = [out * turn.cos(), up, out * turn.sin()].map(|part| 9.0 * size * part);
        let toward = [0.1 * turn.sin(), 0.2 * turn.cos(), 0.3 * up].map(|part| size * part);
        let along = [0, 1, 2].map(|axis| toward[axis] - from[axis]);
        writeln!(rays, "{} {} {} {} {} {}", from[0], from[1], from[2], along[0], along[1], along[2])
            .expect("a string");
    }
    write("rays.txt", &rays);
    for name in ["a.jsonl", "a.csv"] {
        assert_eq!(asked(folder, &[scene, "rays.txt", "-o", name]).0, 0);
    }
    let (_, answers, _) = asked(folder, &[scene, "rays.txt"]);
    let mut leaving = String::new();
    for answer in &answers {
        assert_eq!(answer["verdict"], "hit");
        let ([x, y, z], [a, b, c]) =
            (vector(answer, "point"), vector(answer, "normal").map(|part| sign * part));
        writeln!(leaving, "{x} {y} {z} {a} {b} {c}").expect("a string");
    }
    write("leaving.txt", &leaving);
    // NumPy's arrays have as many answers as those of the rays.
    let numbers: Vec<u8> = rays
        .split_whitespace()
        .flat_map(|word| word.parse::<f64>().expect("a number").to_le_bytes())
        .collect();
    let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (300, 6), }";
    let head = format!("{head:117}\n");
    let array = [&b"\x93NUMPY\x01\x00\x76\x00"[..], head.as_bytes(), &numbers].concat();
    fs::write(folder.path().join("rays.npy"), array).expect("a file");
    assert_eq!(asked(folder, &[scene, "rays.npy", "-o", "a.npy"]).0, 0);
}

#[test]
fn rays_that_leave_a_convex_shape_outward_hit_nothing_of_it() {
    for (name, scene, size) in [
        ("balls.ray", BALLS.to_owned(), 5.0),
        ("tiny.obj", cube(1e-6), 1e-6),
        ("one.obj", cube(1.0), 1.0),
        ("huge.obj", cube(1e6), 1e6),
    ] {
        let folder = folder();
        fs::write(folder.path().join(name), scene).expect("a file");
        prepare(&folder, name, size, 1.0);
        for answers in ["a.jsonl", "a.csv", "a.npy"] {
            let (status, found, err) = asked(&folder, &[name, "leaving.txt", "--leaving", answers]);
            assert_eq!((status, found.len()), (0, 300), "{err}");
            assert!(found.iter().all(|answer| answer["verdict"] == "miss"), "{name} {answers}: {found:?}");
        }
    }
}

/// Inward, the ball within is hit 2 units on. Some rounded points lie outside of their ball, which bare rays hit there.
#[test]
fn rays_that_leave_a_ball_inward_hit_what_is_in_it() {
    let folder = folder();
    fs::write(folder.path().join("balls.ray"), BALLS).expect("a file");
    prepare(&folder, "balls.ray", 5.0, -1.0);
    let (_, found, _) = asked(&folder, &["balls.ray", "leaving.txt", "--leaving", "a.jsonl"]);
    for answer in &found {
        let t = answer["t"].as_f64().expect("a number");
        assert!(answer["object"] == "core" && (t - 2.0).abs() < 1e-12, "{answer}");
    }
    let (_, bare, _) = asked(&folder, &["balls.ray", "leaving.txt"]);
    assert!(bare.iter().any(|answer| answer["object"] == "ball"), "{bare:?}");
}

#[test]
fn answers_that_are_no_starts_are_refused_and_harm_nothing() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("balls.ray", BALLS);
    write("cube.obj", &cube(1.0));
    write("rays.txt", "0 0 9 0 0 -1\n0 9 9 0 0 -1\n");
    assert_eq!(asked(&folder, &["balls.ray", "rays.txt", "-o", "a.jsonl"]).0, 0);
    let first = fs::read_to_string(folder.path().join("a.jsonl")).expect("answers");
    let hit = first.lines().next().expect("a line").to_owned();
    write("one.jsonl", &hit);
    write("three.jsonl", &format!("{hit}\n{hit}\n{hit}\n"));
    write("other.jsonl", &format!("{hit}\n{}\n", hit.replace("\"number\":0", "\"number\":7")));
    write("no.jsonl", "{\"x\": 1}\n");
    write("no.csv", "a,b\n1,2\n");
    write("late.csv", "\n\na,b\n1,2\n");
    fs::write(folder.path().join("cut.npy"), b"\x93NUMPY\x01\x00").expect("a file");
    for (answers, says) in [
        ("a.jsonl", "`rays.txt`, line 2: the answer that it leaves has no proven hit"),
        ("one.jsonl", "line 2: there is no answer for it to leave"),
        ("three.jsonl", "no ray follows, and there are more answers to leave"),
        ("other.jsonl", "line 2: the scene has no object 7"),
        ("no.jsonl", "line 1: the answer that it leaves, line 1: it is no answer of `tabray hits`"),
        ("no.csv", "`no.csv`, line 1: the first line lacks `number` or `surface`"),
        ("late.csv", "`late.csv`, line 3: the first line lacks `number` or `surface`"),
        ("cut.npy", "`cut.npy`, row 1: it is not a NumPy array"),
        ("none.csv", "cannot read `none.csv`"),
    ] {
        let (status, found, err) = asked(&folder, &["balls.ray", "rays.txt", "--leaving", answers]);
        assert!([1, 2].contains(&status) && err.contains(says), "{answers}: {status} {found:?} {err}");
    }
    let (status, _, err) =
        asked(&folder, &["balls.ray", "rays.txt", "--leaving", "a.jsonl", "-o", "a.jsonl"]);
    assert!(status == 2 && err.contains("`a.jsonl` is the answers that rays leave"), "{err}");
    assert_eq!(fs::read_to_string(folder.path().join("a.jsonl")).expect("answers"), first);
    let (status, found, err) =
        asked(&folder, &["balls.ray", "rays.txt", "--leaving", "a.jsonl", "--skip-bad"]);
    assert_eq!((status, found.len()), (0, 1), "{err}");
    // Surfaces that no shape has are no hits of this scene. What they lead to is nobody's, but an answer.
    for scene in ["balls.ray", "cube.obj"] {
        write("far.jsonl", "{\"verdict\":\"hit\",\"number\":0,\"surface\":4000000}\n".repeat(2).as_str());
        let (status, found, err) = asked(&folder, &[scene, "rays.txt", "--leaving", "far.jsonl"]);
        assert_eq!((status, found.len()), (0, 2), "{err}");
    }
}
