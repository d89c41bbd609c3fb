//! Attributes of the corners of faces in each format.

use super::super::model::MemoryBudget;
use super::super::{Model, NO_VALUE, ReadError, Wanted};
use glam::DVec3;
use std::path::Path;
use tabray_world::sensor::Sensor;

/// Reads a file with all contents wanted.
pub(super) fn whole(ending: &str, bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    let wanted = Wanted { normals: true, materials: Some(Sensor::default().display()) };
    let budget = MemoryBudget::new(1 << 30, 0, wanted).map_err(ReadError::file)?;
    super::super::model(bytes.as_ref().to_vec(), ending, Path::new("/nowhere"), &budget)
}

#[test]
fn corners_keep_what_they_have_where_polygons_are_cut() {
    // A dart and a crown. Their texture coordinates and normals equal their positions.
    let places = [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4], [9, 9]];
    let vertices: String = places.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    let of_texture: String = places.iter().rev().map(|[x, y]| format!("vt {x} {y} 0.5\n")).collect();
    let normals: String = places.iter().map(|[x, y]| format!("vn {x} {y} 1\n")).collect();
    let corner = |at: i32| format!(" {at}/{}/{}", 7 - at, at - 7);
    let face: String = (1..=5).map(corner).collect();
    let text = format!("{vertices}{of_texture}{normals}f 1 2 6\nf{face}\nf 1// 2//2 3/4\nf 1 2\n");
    let model = whole("obj", text).expect("a model");
    let (uv, normals) = (&model.attributes.uv, &model.attributes.normals);
    assert_eq!([uv.faces.len(), normals.faces.len(), model.faces.len()], [5; 3]);
    for face in 1..4 {
        for (side, corner) in model.faces[face].into_iter().enumerate() {
            let DVec3 { x, y, .. } = model.vertices[corner as usize];
            let at = [x as f32, y as f32];
            assert_eq!(uv.values[uv.faces[face][side] as usize], at);
            assert_eq!(normals.values[normals.faces[face][side] as usize], [at[0], at[1], 1.0]);
        }
    }
    assert_eq!([uv.faces[0], normals.faces[0]], [[NO_VALUE; 3]; 2]);
    assert_eq!([uv.faces[4], normals.faces[4]], [[NO_VALUE, NO_VALUE, 3], [NO_VALUE, 1, NO_VALUE]]);
}

#[test]
fn numbers_of_what_there_is_not_are_told() {
    for (corner, said) in [
        ("3/4/1", "there is no `vt` 4: the file has 2"),
        ("3/1/9", "there is no `vn` 9: the file has 1"),
        ("3/0/1", "`vt` are counted from 1, so there is no `vt` 0"),
        ("3/-3/1", "there is no `vt` -3: 2 `vt` precede this face"),
        ("3/x/1", "`3/x/1` is not a vertex's number"),
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/1/1 {corner}\n");
        assert_eq!(whole("obj", &text), Err(ReadError::line(7, said)));
        assert!(super::named("obj", &text).is_ok(), "what is not wanted is not read");
    }
    // A file without any of them is valid.
    let model = whole("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3\n").expect("a model");
    assert!(model.attributes.is_empty());
}

const HEADER: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
    property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
    property uchar alpha\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

#[test]
fn vertices_of_a_ply_have_normals_colours_and_texture_coordinates() {
    let text =
        "0 0 0 0 0 1 255 0 64 255 0 0\n1 0 0 0 1 nan 0 0 0 255 1 0\n0 1 0 2 0 0 0 0 0 255 0.5 1\n3 2 0 1\n";
    let in_text = whole("ply", format!("ply\nformat ascii 1.0\n{HEADER}{text}"));
    let mut models = vec![in_text];
    for (name, is_big) in [("little", false), ("big", true)] {
        let mut bytes = format!("ply\nformat binary_{name}_endian 1.0\n{HEADER}").into_bytes();
        let mut put = |mut of: Vec<u8>| {
            if is_big {
                of.reverse();
            }
            bytes.extend(of);
        };
        for line in text.lines().take(3) {
            for (place, word) in line.split(' ').enumerate() {
                let number: f32 = word.parse().expect("a number");
                put(if (6..10).contains(&place) {
                    vec![number as u8]
                } else {
                    number.to_le_bytes().to_vec()
                });
            }
        }
        put(vec![3]);
        [2, 0, 1].into_iter().for_each(|corner: i32| put(corner.to_le_bytes().to_vec()));
        models.push(whole("ply", bytes));
    }
    for model in models {
        let Model { faces, attributes, .. } = model.expect("a model");
        assert_eq!(faces, [[2, 0, 1]]);
        let lists = [attributes.normals.faces, attributes.uv.faces, attributes.colours.faces];
        assert!(lists.iter().all(|list| **list == faces));
        assert_eq!(attributes.normals.values[2], [2.0, 0.0, 0.0]);
        assert!(attributes.normals.values[1][2].is_nan());
        // Bytes are decoded as in the notes.
        assert_eq!(attributes.colours.values[0], [255.0 / 256.0, 0.0, 0.25, 1.0]);
        assert_eq!(attributes.uv.values, [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]);
    }
}

#[test]
fn a_file_without_what_is_wanted_is_told() {
    let told = |text: &str| whole("obj", text).expect("a model").remarks;
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let messages: Vec<_> = told(text).into_iter().map(|remark| remark.message).collect();
    assert_eq!(messages, ["has a file without normals", "has a file without materials and colours"]);
}
