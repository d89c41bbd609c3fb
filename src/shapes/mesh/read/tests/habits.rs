//! Common deviations of programs from the formats.

use super::*;

#[test]
fn the_format_is_told_by_what_a_file_holds() {
    for (ending, bytes) in all() {
        let right = named(ending, &bytes);
        assert_eq!(corners(right.as_ref().expect(ending)), corners(&tetrahedron()));
        for wrong in ["obj", "ply", "stl", "txt", ""] {
            assert_eq!(named(wrong, &bytes), right, "{ending} as {wrong}");
        }
    }
}

#[test]
fn white_space_is_what_other_readers_take_for_it() {
    for (ending, text) in [("obj", obj_text()), ("ply", ply_text()), ("stl", stl_text())] {
        let right = named(ending, &text);
        for other in [
            format!("\u{feff}{text}"),
            text.replace('\n', "\r\n"),
            text.replace('\n', "\r"),
            text.replace(' ', "\u{b}"),
            text.replace(' ', "\t \t"),
            text.replace('\n', " \n"),
            text.replace('\n', "\n\n \n"),
        ] {
            assert_eq!(named(ending, &other), right, "{other:?}");
        }
    }
    let bytes = ply_bytes(false);
    let start = bytes.windows(11).position(|word| word == b"end_header\n").expect("a header") + 11;
    let header = String::from_utf8_lossy(&bytes[..start]).into_owned();
    for end in ["\r\n", "\r"] {
        let other = [header.replace('\n', end).as_bytes(), &bytes[start..]].concat();
        assert_eq!(named("ply", &other), Ok(tetrahedron()), "{end:?}");
    }
}

#[test]
fn elements_of_a_ply_in_text_may_be_laid_out_in_any_way() {
    let text = ply_text();
    let (header, body) = text.split_once("end_header\n").expect("a header");
    for other in [body.replace(' ', "\n"), body.replace('\n', " "), body.replace("0 255", "0\n255")] {
        assert_eq!(named("ply", format!("{header}end_header\n{other}")), Ok(tetrahedron()), "{other}");
    }
    // An error is reported with its line.
    let wrong = format!("{header}end_header\n{}", body.replace(' ', "\n").replace("0.25", "x"));
    let message = "`x` is not a number".to_owned();
    assert_eq!(named("ply", wrong), Err(ReadError { at: Some(FilePosition::Line(20)), message }));
}

#[test]
fn headers_of_ply_files_hold_what_programs_write_there() {
    let text = ply_text();
    for (from, to) in [
        ("comment made by a test", "Created by a program - www.example.org, source file: "),
        ("comment made by a test", "obj_info x\n\n  comment y"),
        ("ply\n", "ply \n"),
        ("list uchar int vertex_indices", "list int64 uint64 vertex_index"),
        ("property uchar red", "property\tint64  red "),
        ("element face", "element  face"),
    ] {
        assert_eq!(named("ply", text.replacen(from, to, 1)), Ok(tetrahedron()), "{to}");
    }
    let twice = text.replace(
        "element face",
        "element vertex 1\nproperty int x\nproperty int y\nproperty int z\nelement face",
    );
    assert!(named("ply", twice).is_err());
}

#[test]
fn strips_of_a_ply_are_triangles() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n12 0 1 2 3 3 4 -1 0 1 4 -1 2\n";
    let model = named("ply", text).expect("strips");
    // Every second triangle is reversed, and one with only two corners joins strips.
    assert_eq!(model.faces, [[0, 1, 2], [2, 1, 3], [0, 1, 4]]);
    let error = named("ply", text.replace("1 4 -1", "1 5 -1")).expect_err("no vertex");
    assert_eq!(error.message, "strip 0 refers to vertex 5, and there are 5, from 0");
}

#[test]
fn names_of_materials_may_have_blanks_and_signs() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Material #25\nf 1 2 3\nusemtl dark  oak # of the door\nf 1 2 3\n\
                usemtl\nf 1 2 3\nusemtl Material #25\nf 1 2 3\n";
    let model = named("obj", text).expect("a model");
    assert_eq!(
        (&model.materials[..], &model.slots[..]),
        (&["Material #25".to_owned(), "dark oak".to_owned()][..], &[1, 2, 0, 1][..])
    );
}

#[test]
fn faces_of_two_corners_are_left_out_and_told() {
    let obj = obj_text() + "f 1 2\nf\nf 3\n";
    let ply = ply_text().replace("face 4", "face 6") + "2 0 1\n0\n";
    for (ending, text, message) in [
        ("obj", obj, "leaves out 3 faces of fewer than three corners"),
        ("ply", ply, "leaves out 2 faces of fewer than three corners"),
    ] {
        let model = named(ending, text).expect("a model");
        assert_eq!(model.faces, FACES);
        assert_eq!(model.remarks.iter().map(|remark| &remark.message[..]).collect::<Vec<_>>(), [message]);
    }
    let error = named("obj", "v 0 0 0\nv 1 0 0\nf 1 2\n").expect_err("no face");
    assert_eq!(error.message, "none of its faces has three corners");
}

#[test]
fn the_vertices_of_an_obj_may_come_after_its_faces() {
    let text = obj_text();
    let (vertices, faces) = text.split_at(text.find("f ").expect("faces"));
    assert_eq!(named("obj", format!("{faces}{vertices}")), Ok(tetrahedron()));
    let error = named("obj", format!("{faces}f 1 2 5\n{vertices}"));
    let message = "there is no vertex 5: the file has 4".to_owned();
    assert_eq!(error, Err(ReadError { at: Some(FilePosition::Line(5)), message }));
}

#[test]
fn the_triangles_of_an_stl_are_those_that_it_holds() {
    let whole = stl_bytes("solid by a program");
    for (announced, spare, message) in [
        (4, 1, None),
        (4, 49, None),
        (0, 0, Some("has a file that announces 0 triangles and holds 4")),
        (1, 0, Some("has a file that announces 1 triangle and holds 4")),
        (3, 7, Some("has a file that announces 3 triangles and holds 4")),
        (4_000_000_000, 0, Some("has a file that announces 4000000000 triangles and holds 4")),
    ] {
        let mut bytes = whole.clone();
        bytes[80..84].copy_from_slice(&u32::to_le_bytes(announced));
        bytes.resize(whole.len() + spare, b' ');
        let model = named("stl", bytes).expect("a model");
        assert_eq!(corners(&model), corners(&tetrahedron()), "{announced}");
        assert_eq!(model.remarks.first().map(|remark| &remark.message[..]), message);
    }
    // The bytes that follow are not a triangle.
    let bytes = [whole, vec![255; 50]].concat();
    assert_eq!(named("stl", bytes).expect("a model").faces.len(), 4);
    let text = stl_text();
    for (from, to) in [("endloop", "end loop"), ("endfacet", "End Facet"), ("endsolid", "end solid")] {
        assert_eq!(named("stl", text.replace(from, to)), named("stl", &text), "{to}");
    }
}

#[test]
fn files_of_other_kinds_are_named() {
    let utf_16 = |is_big: bool, text: &str| -> Vec<u8> {
        let bytes = |letter: u16| if is_big { letter.to_be_bytes() } else { letter.to_le_bytes() };
        text.encode_utf16().flat_map(bytes).collect()
    };
    let text = obj_text();
    for (bytes, said) in [
        (b"\x1f\x8b\x08\0\0\0\0\0\0\x03".to_vec(), "it is compressed with gzip: decompress it first"),
        (utf_16(false, &format!("\u{feff}{text}")), "it is a text in UTF-16: save it in UTF-8"),
        (utf_16(true, &format!("\u{feff}{text}")), "it is a text in UTF-16: save it in UTF-8"),
        (utf_16(false, &text), "it is a text in UTF-16: save it in UTF-8"),
        (b"OFF\n3 1 0\n".to_vec(), "it is an OFF: export it as OBJ, PLY, STL or glTF"),
        (
            b"<?xml version='1.0'?>".to_vec(),
            "it is XML, as Collada and X3D are: export it as OBJ, PLY, STL or glTF",
        ),
        (b"  \n".to_vec(), "it is empty"),
        (b"v 0 0 0\nv 1 1 1\n".to_vec(), "it has vertices and no faces: it is a cloud of points"),
        (b"v 0 0 0\nv 1 1 1\nl 1 2\n".to_vec(), "it has lines or points (`l`) and no faces"),
        (b"one two\n".to_vec(), "no line of it begins with `v` or `f`, so it is not an OBJ"),
        (b"solid x\nendsolid x\n".to_vec(), "it has no triangles"),
    ] {
        assert_eq!(named("obj", bytes), Err(ReadError::file(said)));
    }
    assert_eq!(
        named("txt", "one"),
        Err(ReadError::file("neither its name nor its beginning is that of an OBJ, PLY, STL or glTF"))
    );
}

/// Returns an OBJ with one flat polygon.
fn polygon(corners: &[[f64; 2]]) -> String {
    let vertices: String = corners.iter().map(|[x, y]| format!("v {x} {y} {}\n", x - 2.0 * y)).collect();
    format!("{vertices}f{}\n", (1..=corners.len()).map(|corner| format!(" {corner}")).collect::<String>())
}

#[test]
fn polygons_with_dents_are_cut_into_triangles_that_fill_them() {
    let crown = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
    let dart = [[0.0, 0.0], [4.0, -1.0], [1.0, 0.5], [-1.0, 4.0]];
    let (mut comb, teeth) = (vec![[0.0, -1.0], [40.0, -1.0]], 40);
    comb.extend(
        (0..=teeth).rev().flat_map(|tooth| [[f64::from(tooth), 3.0], [f64::from(tooth) - 0.5, 0.25]]),
    );
    for (corners, area) in [(&crown[..], 10.0), (&dart[..], 3.75), (&comb[..], f64::NAN)] {
        for is_reversed in [false, true] {
            let mut run = corners.to_vec();
            if is_reversed {
                run.reverse();
            }
            for first in 0..run.len().min(5) {
                run.rotate_left(first);
                let model = named("obj", polygon(&run)).expect("a polygon");
                let doubled = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).z;
                let areas: Vec<_> = self::corners(&model).into_iter().map(doubled).collect();
                let edges = run.iter().zip(run.iter().cycle().skip(1));
                let whole: f64 = edges.map(|([ax, ay], [bx, by])| ax * by - ay * bx).sum();
                assert_eq!(areas.len(), run.len() - 2);
                assert!(areas.iter().all(|area| area * whole >= 0.0), "{areas:?}");
                assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-9);
                assert!(area.is_nan() || whole.abs() == 2.0 * area);
                assert_eq!(model.remarks, []);
            }
        }
    }
    // A convex polygon is cut into a fan.
    let model = named("obj", polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
        .expect("a polygon");
    assert_eq!(model.faces, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn the_materials_of_polygons_with_dents_are_kept() {
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3 4 5\nusemtl c\nf 3 4 5\n";
    let model = named("obj", text).expect("a model");
    assert_eq!(model.slots, [1, 2, 2, 2, 3]);
    assert_eq!([model.faces[0], model.faces[4]], [[0, 1, 2], [2, 3, 4]]);
}

#[test]
fn a_face_that_is_not_flat_is_told() {
    let quad = |height: f64| format!("v 0 0 0\nv 1 0 0\nv 1 1 {height}\nv 0 1 0\nf 1 2 3 4\n");
    let told = named("obj", quad(0.6)).expect("a model").remarks;
    assert_eq!(told[0].message, "has polygons that are not flat: 1");
    assert_eq!(named("obj", quad(0.1)).expect("a model").remarks, []);
}
