//! What readers make of files, sound and broken.

use super::model::MemoryBudget;
use super::{FilePosition, Model, ReadError};
use glam::DVec3;
use proptest::prelude::*;

macro_rules! readers {
    ($($format:ident)*) => {$(
        /// Reads a file of this format, with room enough.
        mod $format {
            use super::{ReadError, Model, MemoryBudget};

            pub fn read(bytes: &[u8]) -> Result<Model, ReadError> {
                super::super::$format::read(bytes, &MemoryBudget::new(1 << 30, 0).map_err(ReadError::file)?)
            }
        }
    )*};
}
readers!(obj ply stl);

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [0.25, 1.0, 0.0], [0.0, 0.5, 2.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn tetrahedron() -> Model {
    Model { vertices: CORNERS.map(DVec3::from).to_vec(), faces: FACES.to_vec(), ..Model::default() }
}

fn obj_text() -> String {
    let vertices = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = FACES.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    vertices.chain(faces).collect()
}

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex 4\nproperty double x\nproperty float y\n\
         property double z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

fn ply_text() -> String {
    let vertices = CORNERS.iter().map(|[x, y, z]| format!("{x} {y} {z} 255\n"));
    let faces = FACES.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
    ply_header("ascii") + &vertices.chain(faces).collect::<String>()
}

fn ply_bytes(is_big: bool) -> Vec<u8> {
    let mut bytes =
        ply_header(if is_big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    let mut put = |of: Vec<u8>| bytes.extend(if is_big { of.into_iter().rev().collect() } else { of });
    for [x, y, z] in CORNERS {
        put(x.to_le_bytes().to_vec());
        put((y as f32).to_le_bytes().to_vec());
        put(z.to_le_bytes().to_vec());
        put(vec![255]);
    }
    for face in FACES {
        put(vec![3]);
        face.iter().for_each(|corner| put(corner.to_le_bytes().to_vec()));
    }
    bytes
}

fn stl_text() -> String {
    let vertex = |corner: &u32| {
        let [x, y, z] = CORNERS[*corner as usize];
        format!("vertex {x} {y} {z}\n")
    };
    let facet = |face: &[u32; 3]| {
        let vertices: String = face.iter().map(vertex).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!("solid tetrahedron\n{}endsolid tetrahedron\n", FACES.iter().map(facet).collect::<String>())
}

fn stl_bytes(title: &str) -> Vec<u8> {
    let mut bytes = title.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4_u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        for part in face.iter().flat_map(|corner| CORNERS[*corner as usize]) {
            bytes.extend((part as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// Returns the corners of each face.
fn corners(model: &Model) -> Vec<[DVec3; 3]> {
    model.faces.iter().map(|face| face.map(|corner| model.vertices[corner as usize])).collect()
}

#[test]
fn each_format_holds_the_same_triangles() {
    assert_eq!(obj::read(obj_text().as_bytes()), Ok(tetrahedron()));
    assert_eq!(obj::read(obj_text().replace('\n', "\r\n").as_bytes()), Ok(tetrahedron()));
    assert_eq!(ply::read(ply_text().as_bytes()), Ok(tetrahedron()));
    assert_eq!(ply::read(&ply_bytes(false)), Ok(tetrahedron()));
    assert_eq!(ply::read(&ply_bytes(true)), Ok(tetrahedron()));
    for stl in [stl_text().into_bytes(), stl_bytes("binary"), stl_bytes("solid, and binary all the same")] {
        assert_eq!(corners(&stl::read(&stl).expect("a model")), corners(&tetrahedron()));
    }
}

#[test]
fn an_obj_has_polygons_and_materials_and_counts_backward() {
    let text = "# a quadrilateral and two triangles\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n\
                f 1//1 2//1 3//1 4//1\nusemtl dark oak\nf -4/1/1 -3/2/1 -2/3/1\nusemtl ash\ng a\ns off\nf 1 3 4 # last";
    let model = obj::read(text.as_bytes()).expect("a model");
    assert_eq!(model.faces, [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.materials, ["dark oak", "ash"]);
    assert_eq!(model.slots, [0, 0, 1, 2]);
}

#[test]
fn a_broken_text_is_told_with_its_line() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (line, message) in [
        ("f 1 2 4", "there is no vertex 4: the file has 3"),
        ("f 1 2 -4", "there is no vertex -4: 3 vertices precede this face"),
        ("f 0 1 2", "vertices are counted from 1, so there is no vertex 0"),
        ("f 1 2 99999999999999999999", "`99999999999999999999` is not a vertex's number"),
        ("v 1 nan 2", "`nan` is not a finite number"),
        ("v 1 1e999 2", "`1e999` is not a finite number"),
        ("v 1 2", "a vertex needs three coordinates"),
        ("v 1 2 three", "`three` is not a number"),
    ] {
        let error = obj::read(format!("{vertices}{line}\nf 1 2 3\n").as_bytes()).expect_err(line);
        assert_eq!(error, ReadError { at: Some(FilePosition::Line(4)), message: message.to_owned() });
    }
    for (wrong, right, line, message) in [
        ("0.25 1 0 255", "0.25 inf 0 255", 14, "`inf` is not a finite number"),
        ("0.25 1 0 255", "0.25 x 0 255", 14, "`x` is not a number"),
        ("3 1 2 3", "3 1 2 4", 18, "face 2 refers to vertex 4, and there are 4, from 0"),
        ("3 1 2 3", "3 1 2 -1", 18, "face 2 refers to vertex -1, and there are 4, from 0"),
        ("3 1 2 3", "200 1 2 3", 18, "`200 1 2 3` is not what the header announces here"),
        ("property float y", "property flat y", 6, "`flat` is not a type of PLY"),
        ("property float y", "property float", 6, "`property float` is not what the header announces here"),
        ("vertex 4", "vertex four", 4, "`element vertex four` is not what the header announces here"),
    ] {
        let text = ply_text().replace(wrong, right);
        let error = ply::read(text.as_bytes()).expect_err(right);
        assert_eq!(error, ReadError { at: Some(FilePosition::Line(line)), message: message.to_owned() });
    }
    for (wrong, right, line, message) in [
        ("vertex 1 0 0.5\nendloop", "endloop", 6, "a facet has three vertices, and this one has 2"),
        ("vertex 1 0 0.5\nendloop", "vertex 1 nan 0.5\nendloop", 6, "`nan` is not a finite number"),
        ("facet normal", "facette normal", 2, "`facette` is not a word of STL"),
    ] {
        let text = stl_text().replacen(wrong, right, 1);
        let error = stl::read(text.as_bytes()).expect_err(right);
        assert_eq!(error, ReadError { at: Some(FilePosition::Line(line)), message: message.to_owned() });
    }
}

#[test]
fn a_file_that_ends_too_early_is_told() {
    let bytes = ply_bytes(false);
    let end = bytes.len() - 3;
    let message = "the file ends before all of its elements".to_owned();
    assert_eq!(ply::read(&bytes[..end]), Err(ReadError { at: Some(FilePosition::Byte(end)), message }));
    let bytes = stl_bytes("binary");
    let message = "the file ends after 3 of 4 triangles".to_owned();
    assert_eq!(
        stl::read(&bytes[..200 + 84 - 1]),
        Err(ReadError { at: Some(FilePosition::Byte(283)), message })
    );
    assert!(stl::read(b"").is_err() && ply::read(b"").is_err() && ply::read(b"ply\n").is_err());
}

#[test]
fn an_stl_that_is_cut_off_within_a_facet_is_told() {
    let facet = [
        "facet normal 0 0 0",
        "outer loop",
        "vertex 0 0 0",
        "vertex 1 0 0",
        "vertex 0 1 0",
        "endloop",
        "endfacet",
    ];
    for before in [&[][..], &facet] {
        let lines = [&["solid part"], before, &facet].concat();
        let whole = 1 + before.len();
        for count in whole + 1..lines.len() {
            let message = "the file ends within a facet".to_owned();
            let told = Err(ReadError { at: Some(FilePosition::Line(count + 1)), message: message.clone() });
            assert_eq!(stl::read((lines[..count].join("\n") + "\n").as_bytes()), told, "{count} lines");
            let told = Err(ReadError { at: Some(FilePosition::Line(1)), message });
            assert_eq!(stl::read(lines[..count].join(" ").as_bytes()), told, "{count} lines in one");
        }
        stl::read(lines[..whole].join("\n").as_bytes()).expect("whole facets");
    }
}

#[test]
fn a_header_that_promises_too_much_takes_no_memory() {
    for count in ["4000000000", "18446744073709551615", "99999999999999999999999"] {
        for text in [ply_text(), String::from_utf8_lossy(&ply_bytes(false)).into_owned()] {
            for element in ["element vertex 4", "element face 4"] {
                let (element, number) = (element, element.replace('4', count));
                ply::read(text.replace(element, &number).as_bytes()).expect_err(count);
            }
            let text = text.replace("end_header", &format!("element nothing {count}\nend_header"));
            ply::read(text.as_bytes()).expect_err(count);
        }
    }
    let lists = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint double x\nproperty double y\n\
                 property double z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n";
    ply::read(&[lists.as_bytes(), &[255; 64]].concat()).expect_err("a list of 2^32 numbers");
    let mut stl = stl_bytes("binary");
    stl[80..84].copy_from_slice(&[255; 4]);
    assert_eq!(stl::read(&stl).expect("those that it holds").faces.len(), 4);
}

#[test]
fn faces_of_a_ply_may_come_before_its_vertices() {
    let text = ply_text();
    let (header, body) = text.split_once("end_header\n").expect("a header");
    let (start, faces) = header.split_once("element face").expect("faces");
    let (start, vertices) = start.split_once("element vertex").expect("vertices");
    let lines: Vec<_> = body.lines().collect();
    let turned = |first: &str, last: &str| {
        let elements = format!("{start}element face{faces}element vertex{vertices}");
        format!("{elements}end_header\n{first}\n{last}\n")
    };
    let (points, corners) = (lines[..4].join("\n"), lines[4..].join("\n"));
    assert_eq!(ply::read(turned(&corners, &points).as_bytes()), Ok(tetrahedron()));
    let error = ply::read(turned(&corners.replace("3 1 2 3", "3 1 2 4"), &points).as_bytes());
    let message = "face 2 refers to vertex 4, and there are 4, from 0".to_owned();
    assert_eq!(error, Err(ReadError { at: Some(FilePosition::Line(14)), message }));
}

#[test]
fn an_obj_of_65535_materials_may_use_one_again_and_no_other() {
    let uses = |number: usize| format!("usemtl m{number}\n");
    let all: String = (0..65535).map(uses).collect();
    let text = |last: usize| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{all}{}f 1 2 3\n", uses(last));
    assert_eq!(obj::read(text(0).as_bytes()).expect("65535 materials").slots, [1]);
    let error = obj::read(text(65535).as_bytes()).expect_err("65536 materials");
    assert_eq!(error.message, "there are more than 65535 materials");
}

#[test]
fn lines_of_an_obj_may_be_continued() {
    let folded = |end: &str| {
        let text = obj_text()
            .replace("v 1 ", &format!("v\\{end}1 \\{end}  "))
            .replace(" 3\n", &format!(" \\{end}3\n"));
        // A comment is not continued.
        format!("# in C:\\a\\{end}{text}")
    };
    assert_eq!(obj::read(folded("\n").as_bytes()), Ok(tetrahedron()));
    assert_eq!(obj::read(folded("\r\n").as_bytes()), Ok(tetrahedron()));
    let error = obj::read(b"v 0 \\\n0 0\nv 0 0 \\\n\\\nx\n");
    assert_eq!(
        error,
        Err(ReadError { at: Some(FilePosition::Line(3)), message: "`x` is not a number".to_owned() })
    );
    assert!(obj::read(b"v 0 0 \\").is_err());
}

#[test]
fn an_stl_may_be_in_capitals_and_in_one_line() {
    let faces = corners(&tetrahedron());
    let text = stl_text();
    for stl in [text.to_uppercase(), text.replace('\n', " "), text.to_uppercase().replace('\n', "\t")] {
        assert_eq!(corners(&stl::read(stl.as_bytes()).expect("a model")), faces, "{stl}");
    }
    // A name may be any words.
    for name in ["my facet", "vertex endloop", "a facet normal map"] {
        let stl = text.replace("tetrahedron", name);
        assert_eq!(corners(&stl::read(stl.as_bytes()).expect("a model")), faces, "{stl}");
    }
}

/// Reads a file whose name has this ending.
fn named(ending: &str, bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    let budget = MemoryBudget::new(1 << 30, 0).map_err(ReadError::file)?;
    super::model(bytes.as_ref().to_vec(), ending, &budget)
}

fn all() -> [(&'static str, Vec<u8>); 6] {
    [
        ("obj", obj_text().into_bytes()),
        ("ply", ply_text().into_bytes()),
        ("ply", ply_bytes(false)),
        ("ply", ply_bytes(true)),
        ("stl", stl_text().into_bytes()),
        ("stl", stl_bytes("solid")),
    ]
}

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
    // What is wrong is told with its line.
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
    // Each second one is turned, and one of two corners joins strips.
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
    // What follows is no triangle.
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
        (b"glTF\x02\0\0\0".to_vec(), "it is a binary glTF: export it as OBJ, PLY or STL"),
        (
            b"<?xml version='1.0'?>".to_vec(),
            "it is XML, as Collada and X3D are: export it as OBJ, PLY or STL",
        ),
        (b"  \n".to_vec(), "it is empty"),
        (b"v 0 0 0\nv 1 1 1\n".to_vec(), "it has vertices and no faces: it is a cloud of points"),
        (b"v 0 0 0\nv 1 1 1\nl 1 2\n".to_vec(), "it has lines or points (`l`) and no faces"),
        (b"one two\n".to_vec(), "no line of it begins with `v` or `f`, so it is no OBJ"),
        (b"solid x\nendsolid x\n".to_vec(), "it has no triangles"),
    ] {
        assert_eq!(named("obj", bytes), Err(ReadError::file(said)));
    }
    assert_eq!(
        named("txt", "one"),
        Err(ReadError::file("it is no OBJ, PLY or STL, by its name and by how it begins"))
    );
}

/// Returns an OBJ of one polygon in a plane.
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
    // A convex polygon is cut from its first corner, as ever.
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

/// Files of many blocks.
#[test]
fn a_long_text_is_read_as_a_short_one_is() {
    const TIMES: usize = 20_000;
    // Each face refers to the last three vertices.
    let part = "v 0 0 0\nv 1 0 0.5 # a comment\nv 0 1 \\\n 2\nf -3 -2 -1\n";
    let long = part.repeat(TIMES);
    let model = obj::read(long.as_bytes()).expect("a model");
    assert_eq!((model.vertices.len(), model.faces.len()), (3 * TIMES, TIMES));
    assert!(
        (0..).zip(&model.faces).all(|(face, corners)| *corners == [3 * face, 3 * face + 1, 3 * face + 2])
    );
    let named = format!("{long}usemtl a\n{long}usemtl b\nf 1 2 3\n");
    let model = obj::read(named.as_bytes()).expect("a model");
    let count = |slot| model.slots.iter().filter(|of| **of == slot).count();
    assert_eq!([count(0), count(1), count(2)], [TIMES, TIMES, 1]);
    // The first of several faults is told, wherever blocks begin.
    let lines = 5 * TIMES;
    for line in [1, 7, lines / 3, lines / 2, lines] {
        let mut text: Vec<_> = long.lines().collect();
        let whole = line - line % 5;
        text.splice(whole..whole, ["f x"]);
        text.push("v x");
        let error = obj::read(text.join("\n").as_bytes());
        let message = "`x` is not a vertex's number".to_owned();
        assert_eq!(error, Err(ReadError { at: Some(FilePosition::Line(whole + 1)), message }));
    }
    let facet =
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let long = format!("solid\n{}endsolid\n", facet.repeat(TIMES));
    let model = stl::read(long.as_bytes()).expect("a model");
    assert_eq!((model.vertices.len(), model.faces.len()), (3 * TIMES, TIMES));
    for facet in [0, 3, TIMES / 2, TIMES - 1] {
        let mut lines: Vec<_> = long.lines().collect();
        lines.remove(1 + 7 * facet + 3);
        let message = "a facet has three vertices, and this one has 2".to_owned();
        let error = Err(ReadError { at: Some(FilePosition::Line(1 + 7 * facet + 5)), message });
        assert_eq!(stl::read(lines.join("\n").as_bytes()), error);
    }
    let header = ply_header("ascii").replace("face 4", &format!("face {TIMES}"));
    let vertices = CORNERS.map(|[x, y, z]| format!("{x} {y} {z} 255\n")).concat();
    let long = format!("{header}{vertices}{}", "3 0 1 2\n".repeat(TIMES));
    assert_eq!(ply::read(long.as_bytes()).expect("a model").faces, vec![[0, 1, 2]; TIMES]);
    let wrong = format!("{header}{vertices}{}3 0 1 9\n", "3 0 1 2\n".repeat(TIMES - 1));
    let message = format!("face {} refers to vertex 9, and there are 4, from 0", TIMES - 1);
    assert_eq!(
        ply::read(wrong.as_bytes()),
        Err(ReadError { at: Some(FilePosition::Line(15 + TIMES)), message })
    );
}

#[test]
fn a_model_takes_no_more_memory_than_there_is() {
    let fan = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(40_000));
    let faces = 3 * 40_000 - 2;
    let budget = |memory: u64| MemoryBudget::new(memory, fan.len() as u64).expect("room for the file");
    let enough = 160 * (faces + 2) + 48 * 3 + fan.len() as u64;
    assert!(super::obj::read(fan.as_bytes(), &budget(enough)).is_ok());
    let error = super::obj::read(fan.as_bytes(), &budget(enough - 400)).expect_err("too little");
    assert!(error.message.starts_with("it has at least 3 vertices and 120000 faces, which may take more"));
    assert!(MemoryBudget::new(2999, 1000).is_err());
}

proptest! {
    #![proptest_config(crate::properties())]

    #[test]
    fn a_file_with_some_bytes_changed_never_panics(
        which in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = match which {
            0 => obj_text().into_bytes(),
            1 => ply_text().into_bytes(),
            2 => ply_bytes(false),
            3 => ply_bytes(true),
            4 => stl_text().into_bytes(),
            _ => stl_bytes("binary"),
        };
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        bytes.truncate(bytes.len() - cut.index(bytes.len()) % 40);
        for ending in ["obj", "ply", "stl"] {
            if let Ok(model) = named(ending, &bytes) {
                prop_assert!(model.vertices.iter().all(|at| at.is_finite()));
                prop_assert!(model.faces.iter().flatten().all(|corner| (*corner as usize) < model.vertices.len()));
            }
        }
    }
}
