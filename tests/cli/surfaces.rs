//! Surfaces of other programs become scenes, and objects of scenes meshes.

use crate::common::program::{folder, names_in, outcome, tabray};
use std::fs;

const JSURF: &str = "surface_equation=x^2+y^2+z^2-a\nsurface_parameter_a=0.5\nsurface_title=A ball\n";

#[test]
fn a_surface_of_surfer_is_converted_and_says_what_it_leaves() {
    let folder = folder();
    fs::write(folder.path().join("a.jsurf"), JSURF).expect("written");
    let (status, _, err) = outcome(tabray(&folder).args(["convert", "a.jsurf", "a.ray"]));
    assert_eq!(
        (status, err.as_str()),
        (0, "left out, as it does not affect the picture: `surface_title` (line 3)\nwrote a.ray\n")
    );
    let text = fs::read_to_string(folder.path().join("a.ray")).expect("a scene");
    assert!(text.contains("let a 0.5\n") && text.contains("# Left out: surface_title (line 3).\n"), "{text}");
    let (status, out, err) = outcome(tabray(&folder).args(["convert", "a.jsurf", "-", "--to", "toml"]));
    assert_eq!(status, 0, "{err}");
    assert!(
        String::from_utf8_lossy(&out).contains("[implicit.surface]"),
        "{}",
        String::from_utf8_lossy(&out)
    );
    // Other commands say how to get there.
    let (status, _, err) = outcome(tabray(&folder).args(["check", "a.jsurf"]));
    assert_eq!(status, 2);
    assert!(
        err.contains("this is a surface of SURFER, not a scene") && err.contains("tabray convert"),
        "{err}"
    );
}

/// A surface beyond the ball may be known at once by its bounds, or to rays alone.
#[test]
fn a_ball_that_holds_no_surface_has_no_object_in_view() {
    let folder = folder();
    for (square, status_then) in [("400", 2), ("2", 0)] {
        let surface = format!("surface_equation=x^2+y^2+z^2-{square}\n");
        fs::write(folder.path().join("a.jsurf"), surface).expect("written");
        let (status, _, err) = outcome(tabray(&folder).args(["convert", "a.jsurf", "a.ray"]));
        assert!(status == status_then && err.contains("no object is in view"), "{square}: {status} {err}");
    }
}

#[test]
fn an_object_becomes_a_mesh_that_is_read_again() {
    let folder = folder();
    let scene = "orthographic eye { pixeldim 4 4  position 0 0 9  target 0 0 0  width 4 }
        material m { diffuse 1 1 1 }
        sphere ball { material m  center 0 0 0  radius 1 }
        plane floor { material m  normal 0 1 0  point 0 -1 0 }";
    fs::write(folder.path().join("a.ray"), scene).expect("written");
    for file in ["a.stl", "a.obj", "a.ply"] {
        let (status, _, err) =
            outcome(tabray(&folder).args(["mesh", "a.ray", "ball", "-o", file, "--error", "0.05"]));
        assert_eq!(status, 0, "{err}");
        assert!(err.contains("each point of the mesh is within 0.05 of the surface"), "{err}");
        let (status, out, err) = outcome(tabray(&folder).args(["list", file]));
        assert_eq!(status, 0, "{err}");
        let out = String::from_utf8_lossy(&out);
        assert!(out.contains("parts   1\nclosed  yes\n"), "{out}");
    }
    for (args, fault) in [
        (["mesh", "a.ray", "bal", "-o", "b.stl"], "`a.ray` has no object `bal`"),
        (["mesh", "a.ray", "floor", "-o", "b.stl"], "`floor` has no end"),
        (["mesh", "a.ray", "ball", "-o", "b.txt"], "does not determine the format of the mesh"),
        (["mesh", "a.ray", "ball", "-o", "a.ray"], "does not determine the format of the mesh"),
    ] {
        let (status, _, err) = outcome(tabray(&folder).args(args));
        assert_eq!(status, 2, "{err}");
        assert!(err.contains(fault), "{err}");
    }
    assert_eq!(names_in(folder.path()), ["a.obj", "a.ply", "a.ray", "a.stl"]);
}

#[test]
fn a_mesh_needs_no_camera_and_tells_what_it_takes() {
    let folder = folder();
    let scene = "material m { } heart h { material m  center 0 0 0  size 1 }";
    fs::write(folder.path().join("a.ray"), scene).expect("written");
    let args = ["mesh", "a.ray", "h", "-o", "a.ply", "--error", "0.02", "--progress", "json"];
    let (status, _, err) = outcome(tabray(&folder).args(args));
    assert_eq!(status, 0, "{err}");
    let lines: Vec<_> = err.lines().collect();
    assert!(
        lines[0].starts_with("about ") && lines[0].ends_with(" triangles are to be made, and then merged"),
        "{err}"
    );
    assert!(lines[1].starts_with("{\"progress\":{\"done\":"), "{err}");
}

#[test]
fn an_open_surface_becomes_a_mesh_with_a_thickness() {
    let folder = folder();
    let scene = "material m { } disc d { material m  center 0 0 0  normal 0 1 0  radius 1 }
        plane p { material m  normal 0 1 0  point 0 0 0 }";
    fs::write(folder.path().join("a.ray"), scene).expect("written");
    let made = |name: &str, more: &[&str]| {
        outcome(tabray(&folder).args(["mesh", "a.ray", name, "-o", "a.stl"]).args(more))
    };
    for (name, more, said) in [
        ("d", &[][..], "`d` encloses nothing: "),
        ("d", &[], "; `--thickness` closes others"),
        ("p", &["--thickness", "0.1"], "`p` has no end"),
        (
            "d",
            &["--thickness", "0.1", "--error", "0.1"],
            "an error of 0.1 is too large for a thickness of 0.1",
        ),
        ("d", &["--thickness", "0.001", "--max-memory", "64MiB"], "give a `--thickness` of about "),
        ("d", &["--thickness", "1e-9"], "give a larger `--error`"),
    ] {
        let (status, _, err) = made(name, more);
        assert!(status == 2 && err.contains(said), "{name} {more:?}: {err}");
    }
    let (status, _, err) = made("d", &["--thickness", "0.5", "--error", "0.1"]);
    assert_eq!(status, 0, "{err}");
    assert!(
        err.contains("the distance of each point of the mesh from the surface is within 0.1 of 0.25"),
        "{err}"
    );
}

#[test]
fn points_near_a_surface_are_looked_for_with_progress() {
    let folder = folder();
    let scene = "material m { } sphere s { material m  center 0 0 0  radius 1 }";
    fs::write(folder.path().join("a.ray"), scene).expect("written");
    let args = ["mesh", "a.ray", "s", "-o", "a.stl", "--thickness", "0.3", "--error", "0.06"];
    let (status, _, err) = outcome(tabray(&folder).args(args).args(["--progress", "json"]));
    let lines: Vec<_> = err.lines().collect();
    let made = lines.iter().position(|line| line.ends_with(" triangles are to be made, and then merged"));
    assert!(status == 0 && made.is_some_and(|made| made > 0), "{err}");
    assert!(lines[0].starts_with("{\"progress\":{\"done\":"), "{err}");
    // All that was expected, about.
    let last = lines[made.unwrap_or(1) - 1];
    let number = |name: &str| {
        let after = last.split(&format!("\"{name}\":")).nth(1).expect("a number");
        after.split([',', '}']).next().and_then(|number| number.parse::<f64>().ok()).expect("a number")
    };
    assert!((number("done") / number("of") - 1.0).abs() < 0.25, "{last}");
}

#[test]
fn what_is_not_proven_of_how_a_mesh_is_connected_is_told_with_what_to_do() {
    let folder = folder();
    let scene = "material m { } box b { material m  center 0 0 0  size 1 1 1 }
        heart h { material m  center 0 0 0  size 1 }
        implicit whisker { material m  box -1 -1 -1 1 1 1  formula \"(x^2 + y^2 + z^2 - 0.2)*(x^2 + y^2)\" }";
    fs::write(folder.path().join("a.ray"), scene).expect("written");
    let args = ["mesh", "a.ray", "whisker", "-o", "a.ply", "--error", "0.1"];
    let (status, _, err) = outcome(tabray(&folder).args(args));
    assert!(
        status == 1 && err.contains(" cells, which a smaller `box` or a `clip` may leave out: "),
        "{err}"
    );
    let singular = "warning: the surface may be singular, with a gradient of 0, along a curve from ";
    assert!(err.lines().any(|line| line.starts_with(singular) && line.ends_with(" cells")), "{err}");
    for (name, said) in [
        ("b", "connected as the object is: look at it where parts nearly touch\n"),
        ("h", "as at a node or an edge; a smaller `--error` makes these places smaller\n"),
    ] {
        let args = ["mesh", "a.ray", name, "-o", "a.ply", "--error", "0.1"];
        let (status, _, err) = outcome(tabray(&folder).args(args));
        assert!(status == 0 && err.contains(said), "{err}");
        fs::remove_file(folder.path().join("a.ply")).expect("a mesh");
    }
}
