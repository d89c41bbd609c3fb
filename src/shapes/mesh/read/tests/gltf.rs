//! Valid and broken glTF files.

use super::super::{Model, ReadError};
use super::attributes::whole;
use super::named;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use proptest::prelude::*;

/// Returns bytes as a data URI.
fn uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes))
}

/// Returns the text of a file with a buffer: four corners of a square as floats, and the indices 0 to 3 as bytes, as
/// 16-bit and as 32-bit numbers, from the bytes 48, 52 and 60 on.
fn text(nodes: &str, primitives: &str) -> String {
    let mut bytes = Vec::new();
    for number in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(0..4_u8);
    (0..4_u16).for_each(|index| bytes.extend(index.to_le_bytes()));
    (0..4_u32).for_each(|index| bytes.extend(index.to_le_bytes()));
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{nodes},
        "meshes":[{{"primitives":{primitives}}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
            {{"bufferView":0,"byteOffset":48,"componentType":5121,"count":4,"type":"SCALAR"}},
            {{"bufferView":0,"byteOffset":52,"componentType":5123,"count":4,"type":"SCALAR"}},
            {{"bufferView":0,"byteOffset":60,"componentType":5125,"count":4,"type":"SCALAR"}},
            {{"componentType":5126,"count":4,"type":"VEC3","sparse":{{"count":1,"indices":{{"bufferView":0,"byteOffset":51,
                "componentType":5121}},"values":{{"bufferView":0,"byteOffset":12}}}}}}
        ],
        "bufferViews":[{{"buffer":0,"byteLength":76}}],"buffers":[{{"byteLength":76,"uri":"{}"}}]}}"#,
        uri(&bytes)
    )
}

/// Returns the corners of a model's faces.
fn corners(model: &Model) -> Vec<[DVec3; 3]> {
    model.faces.iter().map(|face| face.map(|corner| model.vertices[corner as usize])).collect()
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

#[test]
fn strips_and_fans_of_all_kinds_of_indices_are_triangles() {
    let at = |corner: usize| DVec3::new(SQUARE[corner][0], SQUARE[corner][1], 0.0);
    for (mode, faces) in
        [(4, vec![[0, 1, 2]]), (5, vec![[0, 1, 2], [1, 3, 2]]), (6, vec![[1, 2, 0], [2, 3, 0]])]
    {
        for indices in ["", r#","indices":1"#, r#","indices":2"#, r#","indices":3"#] {
            let primitive = format!(r#"[{{"attributes":{{"POSITION":0}},"mode":{mode}{indices}}}]"#);
            let model = named("gltf", text(r#"[{"mesh":0}]"#, &primitive)).expect("a model");
            let faces: Vec<_> = faces.iter().map(|face| face.map(at)).collect();
            assert_eq!(corners(&model), faces, "{mode} {indices}");
        }
    }
    // A sparse accessor without a view is 0, except for one element.
    let model = named("gltf", text(r#"[{"mesh":0}]"#, r#"[{"attributes":{"POSITION":4},"mode":6}]"#))
        .expect("a model");
    assert_eq!(model.vertices, [DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::X]);
}

#[test]
fn nodes_place_what_they_have() {
    let nodes = r#"[{"children":[1,2],"translation":[10,0,0]},{"mesh":0,"scale":[-2,1,1],"rotation":[0,0,2,2]},
        {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]}]"#;
    let primitives =
        r#"[{"attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":0}},{"attributes":{"POSITION":0},"mode":1}]"#;
    let primitives = primitives.replace(r#","TEXCOORD_0":0"#, "");
    let model = whole("glb", text(nodes, &primitives)).expect("a model");
    let found = corners(&model);
    // The mesh is mirrored, and then turned by 90 degrees around z. Its faces are mirrored, too.
    let right = [[10.0, 0.0, 0.0], [9.0, -2.0, 0.0], [10.0, -2.0, 0.0]].map(DVec3::from);
    assert!(found[0].into_iter().zip(right).all(|(one, other)| (one - other).length() < 1e-12), "{found:?}");
    assert_eq!(found[1], [[10.0, 0.0, 5.0], [11.0, 0.0, 5.0], [11.0, 1.0, 5.0]].map(DVec3::from));
    assert_eq!(model.remarks[0].message, "leaves out lines or points of its file: 2 primitives");
    let normals = model.attributes.normals.at(0).expect("normals");
    assert!((DVec3::from(normals[2].map(f64::from)) + DVec3::Y).length() < 1e-6, "{normals:?}");
}

#[test]
fn files_that_are_no_gltf_or_broken_are_told() {
    let sound = text(r#"[{"mesh":0}]"#, r#"[{"attributes":{"POSITION":0},"indices":1}]"#);
    for (from, to, said) in [
        (
            r#""nodes":[{"mesh":0}]"#,
            r#""nodes":[{"children":[0]}]"#,
            "node 0 can be reached in two ways, but nodes must form a tree",
        ),
        (r#""nodes":[0]"#, r#""nodes":[7]"#, "there is no node 7"),
        (r#""mesh":0"#, r#""mesh":9"#, "there is no mesh 9"),
        (r#""scene":0"#, r#""scene":3"#, "there is no scene of the index that `scene` gives"),
        (r#""POSITION":0"#, r#""POSITION":9"#, "in mesh 0, there is no accessor 9"),
        (
            r#""POSITION":0"#,
            r#""POSITION":1"#,
            "in mesh 0, accessor 1 is of type `SCALAR`, which is not what it is used as",
        ),
        (
            r#""indices":1"#,
            r#""indices":1,"mode":9"#,
            "in mesh 0, a primitive has mode 9, which glTF does not have",
        ),
        (r#""indices":1"#, r#""indices":1,"material":2"#, "in mesh 0, there is no material 2"),
        (
            r#""indices":1"#,
            r#""indices":1}, {"attributes":{"POSITION":0},"indices":9"#,
            "in mesh 0, there is no accessor 9",
        ),
        (r#""byteOffset":48"#, r#""byteOffset":0"#, "XX"),
        (r#""count":4,"type":"VEC3"}"#, r#""count":99999999999,"type":"VEC3"}"#, "YY"),
        (
            r#""count":4,"type":"VEC3"}"#,
            r#""count":40,"type":"VEC3"}"#,
            "in mesh 0, accessor 0 has 40 elements, more than its buffer view holds",
        ),
        (
            r#""count":4,"type":"VEC3"}"#,
            r#""count":2,"type":"VEC3"}"#,
            "in mesh 0, a face refers to vertex 2, and there are 2, from 0",
        ),
        ("5126,", "5100,", "in mesh 0, accessor 0 has numbers of type 5100, which glTF does not have"),
        (
            r#""byteLength":76}]"#,
            r#""byteLength":77}]"#,
            "in mesh 0, buffer view 0 reaches beyond the end of buffer 0",
        ),
        (
            r#""byteLength":76}]"#,
            r#""byteLength":76,"byteOffset":18446744073709551615}]"#,
            "in mesh 0, buffer view 0 reaches beyond the end of buffer 0",
        ),
        (r#""byteLength":76,"uri""#, r#""byteLength":80,"uri""#, "buffer 0 has 76 bytes, but should have 80"),
        (r#""version":"2.0""#, r#""version":"1.0""#, "it is glTF 1.0, and only glTF 2 is read"),
        (
            r#"{"version":"2.0"}"#,
            r#"{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]"#,
            "it requires the extension `KHR_draco_mesh_compression`, which is not read: decompress it first, as `gltf-transform cp a.glb b.glb` does",
        ),
    ] {
        assert!(sound.contains(from), "{from}");
        let told = named("gltf", sound.replacen(from, to, 1));
        match said {
            "XX" => assert!(told.is_ok()),
            "YY" => assert!(told.expect_err("too many").message.contains("may take more than the")),
            said => assert_eq!(told, Err(ReadError::file(said)), "{to}"),
        }
    }
    let cut = named("gltf", &sound[..sound.len() - 40]).expect_err("a cut file");
    assert!(cut.message.starts_with("its JSON is not glTF: EOF") && cut.at.is_some(), "{cut:?}");
    let missing = sound.replace("data:application", "no such file.bin?");
    let message = named("gltf", missing).expect_err("no buffer").message;
    assert!(
        message.starts_with("its buffer `no such file.bin?")
            && message.ends_with("cannot be read: no such file or directory"),
        "{message}"
    );
}

/// Returns a GLB with a JSON chunk and a binary chunk.
fn glb(json: &str, own: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", own)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

pub(super) fn small() -> Vec<u8> {
    let json = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]}"#;
    let json = format!("{json:<400}");
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    glb(&json, &numbers.map(f32::to_le_bytes).concat())
}

#[test]
fn a_glb_holds_its_buffer() {
    let model = named("obj", small()).expect("a model, whatever its name");
    assert_eq!(corners(&model), [[DVec3::ZERO, DVec3::X, DVec3::Y]]);
    for (place, byte, said) in [
        (4, 1, "it is a GLB of version 1, and only version 2 is read"),
        (13, 200, "the file ends early"),
        (16, b'X', "a GLB begins with its JSON"),
    ] {
        let mut bytes = small();
        bytes[place] = byte;
        assert_eq!(named("glb", bytes).expect_err("a broken file").message, said);
    }
}

proptest! {
    #![proptest_config(crate::properties())]

    #[test]
    fn a_glb_with_some_bytes_changed_never_panics(changes in prop::collection::vec((0..480_usize, any::<u8>()), 1..6)) {
        let mut bytes = small();
        for (place, byte) in changes {
            let place = place % bytes.len();
            bytes[place] = byte;
        }
        let _ = whole("glb", bytes);
    }

    #[test]
    fn a_gltf_with_other_numbers_never_panics(place in 0..200_usize, number in prop_oneof![0..100_u64, any::<u64>()]) {
        let text = text(r#"[{"mesh":0}]"#, r#"[{"attributes":{"POSITION":0,"NORMAL":4},"indices":1},{"attributes":{"POSITION":4},"mode":5}]"#);
        let (head, tail) = text.split_at(text.find("data:").expect("a buffer"));
        let digits: Vec<_> = head.char_indices().filter(|(_, letter)| letter.is_ascii_digit()).map(|(at, _)| at).collect();
        let at = digits[place % digits.len()];
        let _ = whole("gltf", format!("{}{number}{}{tail}", &head[..at], &head[at + 1..]));
    }
}

#[test]
fn copies_are_placed_and_unknown_extensions_are_named() {
    let json = r#"{"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing","EXT_unknown"],
        "nodes":[{"mesh":0,"translation":[0,0,5],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]}"#;
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let model = named("glb", glb(json, &numbers.map(f32::to_le_bytes).concat())).expect("a model");
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let placed = corner.map(|copy| corner.map(|at| at + copy + 5.0 * DVec3::Z));
    assert_eq!(corners(&model), placed);
    assert_eq!(model.remarks[0].message, "has extensions in its file that are not read: `EXT_unknown`");
    let required = json.replace("extensionsUsed", "extensionsRequired");
    let said = named("glb", glb(&required, &[])).expect_err("it is not read").message;
    assert_eq!(
        said,
        "it requires the extension `EXT_unknown`, which is not read: export it without, or as OBJ"
    );
}
