//! Meshes and textures as programs and people write them: each habit of real files in a small file of its own.

use crate::common::{registry, render};
use crate::mesh_files::{Model, bodies};
use image::RgbImage;
use std::fs;
use tabray::scene;
use tempfile::TempDir;

/// A cube from 0 to 1, of twelve triangles.
fn cube() -> Model {
    bodies::cube().of_triangles()
}

/// Renders a scene with a mesh from a file, and returns it with the warnings, or the errors.
fn shown(name: &str, bytes: &[u8], attributes: &str) -> Result<(RgbImage, String), String> {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join(name), bytes).expect("a file");
    let text = format!(
        "look_at eye {{ pixeldim 40 30 position 3 2.2 4 target 0.5 0.5 0.5 angle 25 }}
         material m {{ ambient 0.2 0.2 0.2 diffuse 1 1 1 }}
         light lamp {{ location 3 5 4 emissivity 30 30 30 }}
         mesh o {{ material m file \"{name}\" {attributes} }}"
    );
    match scene::read(registry(), "scene", folder.path(), text.as_bytes(), None) {
        Ok(loaded) => Ok((render(&loaded.model), loaded.warnings.to_string())),
        Err(report) => Err(report.to_string()),
    }
}

#[test]
fn files_that_other_programs_read_show_the_same_cube() {
    let (right, silence) = shown("cube.obj", cube().obj().as_bytes(), "").expect("a cube");
    assert!(silence.is_empty() && right.pixels().any(|pixel| pixel.0[0] > 100));
    let (obj, ply, stl) = (cube().obj(), cube().ply(), cube().stl());
    let lines = |end: &str, text: &str| text.replace('\n', end).into_bytes();
    let flipped: String = obj
        .lines()
        .enumerate()
        .map(|(number, line)| match line.split(' ').collect::<Vec<_>>()[..] {
            ["f", a, b, c] if number % 3 == 0 => format!("f {a} {c} {b}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    let inside_out = obj.lines().map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
        ["f", a, b, c] => format!("f {c} {b} {a}\n"),
        _ => format!("{line}\n"),
    });
    let inside_out: String = inside_out.collect();
    // The file, and a part of what is said of it, if anything is.
    for (habit, name, bytes, said) in [
        ("usemtl without a name", "a.obj", format!("usemtl\n{obj}").into_bytes(), ""),
        (
            "a face of two corners",
            "a.obj",
            format!("{obj}f 1 2\n").into_bytes(),
            "leaves out 1 face of fewer",
        ),
        ("carriage returns", "a.obj", lines("\r", &obj), ""),
        ("vertical tabs", "a.obj", obj.replace(' ', "\u{b}").into_bytes(), ""),
        ("a byte order mark", "a.obj", format!("\u{feff}{obj}").into_bytes(), ""),
        ("an STL named as an OBJ", "a.obj", stl.clone().into_bytes(), ""),
        (
            "faces before vertices",
            "a.obj",
            {
                let (v, f) = obj.split_at(obj.find("f ").expect("a face"));
                format!("{f}{v}").into_bytes()
            },
            "",
        ),
        ("faces turned unevenly", "a.obj", flipped.into_bytes(), "turns 4 of 12 faces"),
        ("all faces turned inward", "a.obj", inside_out.into_bytes(), "turns 12 of 12 faces"),
        ("blank lines", "a.ply", ply.replace("0 1 0\n", "\n0 1 0\n \n").into_bytes(), ""),
        ("elements over two lines", "a.ply", ply.replace("3 0 3 2", "3\n0 3 2").into_bytes(), ""),
        (
            "a face of no corner",
            "a.ply",
            (ply.replace("face 12", "face 13") + "0\n").into_bytes(),
            "leaves out 1 face of fewer",
        ),
        (
            "a comment without its word",
            "a.ply",
            ply.replace("element vertex", "Created by a program\nelement vertex").into_bytes(),
            "",
        ),
        ("numbers of 64 bits", "a.ply", ply.replace("uchar int", "int64 uint64").into_bytes(), ""),
        ("a PLY named as an STL", "a.stl", ply.clone().into_bytes(), ""),
        ("end solid", "a.stl", stl.replace("endsolid", "end solid").into_bytes(), ""),
        ("end loop", "a.stl", stl.replace("endloop", "end loop").into_bytes(), ""),
        ("a byte order mark", "a.stl", format!("\u{feff}{stl}").into_bytes(), ""),
        ("carriage returns", "a.stl", lines("\r", &stl), ""),
        ("a title like a text", "a.stl", cube().stl_bytes("solid cube", 12, &[]), ""),
        ("a title like a text, and a spare byte", "a.stl", cube().stl_bytes("solid cube", 12, b"\n"), ""),
        (
            "a count that is too small",
            "a.stl",
            cube().stl_bytes("cube", 5, &[]),
            "announces 5 triangles and holds 12",
        ),
        ("a count of 0", "a.stl", cube().stl_bytes("cube", 0, &[]), "announces 0 triangles and holds 12"),
        ("an STL without an ending", "cube", cube().stl_bytes("cube", 12, &[]), ""),
    ] {
        let (picture, warnings) =
            shown(name, &bytes, "").unwrap_or_else(|errors| panic!("{habit}: {errors}"));
        assert!(picture == right, "{habit}");
        assert!(warnings.contains(said) && warnings.is_empty() == said.is_empty(), "{habit}: {warnings}");
    }
}

#[test]
fn files_that_cannot_be_read_are_called_what_they_are() {
    let wide: Vec<u8> =
        format!("\u{feff}{}", cube().obj()).encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (name, bytes, said) in [
        ("a.obj", wide, "UTF-16"),
        ("a.ply", b"\x1f\x8b\x08\0\0\0\0\0\0\x03\x01\x02".to_vec(), "gzip"),
        ("a.stl", b"PK\x03\x04\x14\0\0\0".to_vec(), "ZIP"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), "cloud of points"),
        ("a.obj", b"version https://git-lfs.github.com/spec/v1\n".to_vec(), "git lfs pull"),
        (
            "a.ply",
            cube().ply().into_bytes()[..cube().ply().len() - 20].to_vec(),
            "ends before all of its elements",
        ),
    ] {
        let errors = shown(name, &bytes, "").err().unwrap_or_else(|| panic!("{said}"));
        assert!(errors.contains(said), "{said}: {errors}");
    }
}

#[test]
fn a_polygon_with_a_dent_covers_what_an_even_odd_test_says() {
    let crown = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
    let folder = TempDir::new().expect("a folder");
    let vertices: String = crown.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    fs::write(folder.path().join("a.obj"), format!("{vertices}f 1 2 3 4 5\n")).expect("a file");
    let text = "orthographic eye { pixeldim 60 45 position 2 2 5 target 2 2 0 width 6 }
        material m { ambient 5 5 5 } mesh a { material m file a.obj }";
    let loaded = scene::read(registry(), "scene", folder.path(), text.as_bytes(), None).expect("a scene");
    let picture = render(&loaded.model);
    for (column, row, pixel) in picture.enumerate_pixels() {
        let at = [2.0 + (f64::from(column) + 0.5 - 30.0) * 0.1, 2.0 - (f64::from(row) + 0.5 - 22.5) * 0.1];
        let is_crossed = |(from, to): (&[f64; 2], &[f64; 2])| {
            (from[1] > at[1]) != (to[1] > at[1])
                && at[0] < from[0] + (at[1] - from[1]) / (to[1] - from[1]) * (to[0] - from[0])
        };
        let inside =
            crown.iter().zip(crown.iter().cycle().skip(1)).filter(|edge| is_crossed(*edge)).count() % 2 == 1;
        let distance = |(from, to): (&[f64; 2], &[f64; 2])| {
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            ((at[0] - from[0]) * dy - (at[1] - from[1]) * dx).abs() / (dx * dx + dy * dy).sqrt()
        };
        let is_near = crown.iter().zip(crown.iter().cycle().skip(1)).any(|edge| distance(edge) < 1e-6);
        assert!(is_near || (pixel.0[0] > 0) == inside, "{column} {row}");
    }
}
