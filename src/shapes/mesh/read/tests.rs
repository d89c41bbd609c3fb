//! Results of the readers for valid and broken files.

mod attributes;
mod gltf;
mod habits;

use super::model::MemoryBudget;
use super::{FilePosition, Model, ReadError, Wanted};
use glam::DVec3;
use proptest::prelude::*;
use std::path::Path;

macro_rules! readers {
    ($($format:ident($($folder:expr),*))*) => {$(
        /// Reads a file of this format, with enough memory.
        mod $format {
            use super::{ReadError, Model, budget};

            pub fn read(bytes: &[u8]) -> Result<Model, ReadError> {
                let budget = budget(1 << 30, 0).map_err(ReadError::file)?;
                super::super::$format::read(bytes, $($folder,)* &budget)
            }
        }
    )*};
}
readers!(obj(std::path::Path::new("")) ply(std::path::Path::new("")) stl());

/// Makes a budget for a file of this length, with only triangles wanted.
fn budget(memory: u64, file: u64) -> Result<MemoryBudget, String> {
    MemoryBudget::new(memory, file, Wanted::default())
}

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

/// Cutting one takes a time that grows with the square of its corners.
#[test]
fn a_concave_polygon_of_too_many_corners_is_told() {
    // The corners of a star lie on two circles by turns.
    let star = |count: u32| {
        let corner = |index: u32| {
            let (sin, cos) = libm::sincos(f64::from(index) * std::f64::consts::TAU / f64::from(count));
            let radius = f64::from(1 + index % 2);
            format!("v {} {} 0\n", radius * cos, radius * sin)
        };
        let face: String = (1..=count).map(|index| format!(" {index}")).collect();
        (0..count).map(corner).collect::<String>() + "f" + &face + "\n"
    };
    let told = |count: u32| {
        let model = named("obj", star(count)).expect("a mesh");
        model
            .remarks
            .iter()
            .any(|remark| remark.message == "has 1 concave polygon with too many corners to be cut")
    };
    assert_eq!([1000, 32_768 + 2].map(told), [false, true]);
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
fn a_cut_file_with_an_end_is_refused() {
    const LENGTHS: usize = 150;
    for (ending, bytes) in [
        ("ply", ply_bytes(false)),
        ("ply", ply_bytes(true)),
        ("stl", stl_bytes("binary")),
        ("stl", stl_bytes("solid, and binary all the same")),
        ("glb", gltf::small()),
    ] {
        named(ending, &bytes).expect("a whole file");
        for cut in 0..LENGTHS {
            let length = bytes.len() * cut / LENGTHS;
            assert!(named(ending, &bytes[..length]).is_err(), "{ending}, {length} of {} bytes", bytes.len());
        }
    }
}

/// Where the indices have one digit, a cut one is missing.
#[test]
fn a_text_that_ends_within_a_line_is_refused_or_told() {
    let text = obj_text();
    for length in 0..text.len() {
        let cut = &text[..length];
        let last = cut.lines().last().unwrap_or_default();
        let is_whole = text.lines().any(|line| line == last);
        assert!(named("obj", cut).is_err() || is_whole, "{length}: {last}");
    }
    for (line, within) in [("f 1 2", "a line"), ("f 1/1 2/1 3/", "a number"), ("v 1 2 3.", "a number")] {
        let message = format!("the file ends within {within}");
        let told = Err(ReadError { at: Some(FilePosition::Line(9)), message });
        assert_eq!(named("obj", format!("{text}{line}")), told);
    }
    let text = stl_text();
    let end = text.find("endsolid").expect("its end");
    for length in 0..end {
        let is_told = |model: Model| model.remarks[0].message == "has a file without `endsolid` at its end";
        assert!(named("stl", &text[..length]).map_or(true, is_told), "{length}");
    }
    assert_eq!(named("stl", &text).expect("a model").remarks, []);
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
        // A comment does not continue.
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
    // A name may consist of any words.
    for name in ["my facet", "vertex endloop", "a facet normal map"] {
        let stl = text.replace("tetrahedron", name);
        assert_eq!(corners(&stl::read(stl.as_bytes()).expect("a model")), faces, "{stl}");
    }
}

/// Reads a file with this extension.
fn named(ending: &str, bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    let budget = budget(1 << 30, 0).map_err(ReadError::file)?;
    super::model(bytes.as_ref().to_vec(), ending, Path::new(""), &budget)
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
    // The first of several errors is reported, wherever blocks begin.
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
    let budget = |memory: u64| budget(memory, fan.len() as u64).expect("room for the file");
    let enough = 160 * (faces + 2) + 48 * 3 + fan.len() as u64;
    assert!(super::obj::read(fan.as_bytes(), Path::new(""), &budget(enough)).is_ok());
    let error =
        super::obj::read(fan.as_bytes(), Path::new(""), &budget(enough - 400)).expect_err("too little");
    assert!(error.message.starts_with("it has at least 3 vertices and 120000 faces, which may take more"));
    assert!(self::budget(2999, 1000).is_err());
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
