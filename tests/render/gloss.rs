//! Roughness and metal by images of a mesh's file.

use crate::common::{model_in, render};
use glam::DVec3;
use image::{Rgb, RgbImage};
use std::fs;
use tabray::render::Plan;
use tabray::render::trace;
use tabray::scene::Model;
use tabray::tools::colours::{Prover, Verdict};
use tempfile::TempDir;

/// A square of two by two around the origin, with a material and one image, whose texels are seen as squares.
fn square(material: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2, "material": 0}}]}}],
        "materials": [{material}],
        "textures": [{{"source": 0, "sampler": 0}}], "images": [{{"uri": "gloss.png"}}],
        "samplers": [{{"magFilter": 9728}}], "buffers": [{{"uri": "square.bin", "byteLength": 92}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
            {{"buffer": 0, "byteOffset": 80, "byteLength": 12}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
            {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}}]}}"#
    )
}

/// A material whose metal and roughness are factors of the image.
fn by_image(colour: &str) -> String {
    format!(
        r#"{{"pbrMetallicRoughness": {{"baseColorFactor": [{colour}, 1], "metallicRoughnessTexture": {{"index": 0}}}}}}"#
    )
}

/// A material of these bytes of roughness and metal.
fn by_numbers(colour: &str, [roughness, metal]: [u8; 2]) -> String {
    let [roughness, metal] = [roughness, metal].map(|byte| f64::from(byte) / 255.0);
    format!(
        r#"{{"pbrMetallicRoughness": {{"baseColorFactor": [{colour}, 1], "roughnessFactor": {roughness},
            "metallicFactor": {metal}}}}}"#
    )
}

/// Reads a scene with a square of a material and an image of this width with these bytes of roughness and metal.
fn scene(material: &str, width: u32, texel: impl Fn(u32, u32) -> [u8; 2], text: &str) -> Model {
    let folder = TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let image = RgbImage::from_fn(width, width, |x, y| {
        let [roughness, metal] = texel(x, y);
        Rgb([0, roughness, metal])
    });
    image.save(at("gloss.png")).expect("an image");
    let corners: [f32; 12] = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0];
    let uv: [f32; 8] = [0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    let faces: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = corners.iter().chain(&uv).flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend(faces.iter().flat_map(|corner| corner.to_le_bytes()));
    fs::write(at("square.bin"), bytes).expect("a file");
    fs::write(at("square.gltf"), square(material)).expect("a file");
    model_in(folder.path(), text)
}

/// A room in which the square mirrors a ball, a sky, a lamp with a size and one without.
fn room(mesh: &str) -> String {
    format!(
        "orthographic eye {{ pixeldim 32 32 position 0.5 1 5 target 0 0 0 width 2.2 samples 32 }}
         sky day {{ horizon 0.9 0.95 1 zenith 0.2 0.4 0.8 ground 0.3 0.25 0.2 lights yes }}
         area_light panel {{ location -2 2 3 target 0 0 0 dimensions 1 1 emissivity 5 5 5 }}
         light lamp {{ location 1 2 3 emissivity 0.6 0.6 0.6 }}
         material grey {{ ambient 0.05 0.05 0.05 diffuse 0.6 0.5 0.4 }}
         sphere ball {{ material grey center 0.7 0.4 1.2 radius 0.4 }} {mesh}"
    )
}

const COLOUR: &str = "0.9, 0.7, 0.4";

fn picture(material: &str, width: u32, texel: impl Fn(u32, u32) -> [u8; 2], mesh: &str) -> RgbImage {
    render(&scene(
        material,
        width,
        texel,
        &room(&format!("mesh m {{ material grey file square.gltf {mesh} }}")),
    ))
}

#[test]
fn an_image_of_one_number_is_that_number() {
    for numbers in [[77, 255], [200, 255], [20, 90], [255, 0]] {
        let image = picture(&by_image(COLOUR), 2, |_, _| numbers, "materials file");
        assert_eq!(image, picture(&by_numbers(COLOUR, numbers), 2, |_, _| [0; 2], "materials file"));
    }
}

/// Compares the picture of four columns of an image with those of squares that have the numbers of one column each.
#[track_caller]
fn each_column_is_as_a_material(columns: [[u8; 2]; 4], finish: fn(String) -> String) {
    let together = picture(&finish(by_image(COLOUR)), 4, |x, _| columns[x as usize], "materials file");
    for (column, numbers) in columns.into_iter().enumerate() {
        let alone = picture(&finish(by_numbers(COLOUR, numbers)), 4, |_, _| [0; 2], "materials file");
        // Pixels whose rays meet this column alone: it is about 29 / 4 pixels wide, and the first begins in the second pixel.
        let left = 3 + 29 * column as u32 / 4;
        let middle = left..left + 5;
        for (x, y) in middle.flat_map(|x| (2..30).map(move |y| (x, y))) {
            let (one, other) = (together.get_pixel(x, y).0, alone.get_pixel(x, y).0);
            let off = one.into_iter().zip(other).map(|(one, other)| one.abs_diff(other)).max();
            assert!(off <= Some(1), "{numbers:?}, {x} {y}: {one:?} and {other:?}");
        }
    }
}

#[test]
fn each_part_of_an_image_is_as_a_material_of_its_numbers() {
    each_column_is_as_a_material([[60, 255], [110, 255], [0, 255], [200, 0]], |material| material);
    each_column_is_as_a_material([[0, 0], [60, 0], [150, 0], [255, 0]], |material| {
        let glass = r#"{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1}}, "#;
        material.replacen('{', glass, 1)
    });
}

#[test]
fn a_copy_is_glossy_as_its_original() {
    let texel = |x: u32, y: u32| [40 * x as u8, 60 * y as u8];
    let placed = "materials file translation 5 0 0 } place copy { object m translation -5 0 0";
    let here = picture(&by_image(COLOUR), 4, texel, "materials file");
    let off = |other: &RgbImage| {
        here.iter().zip(other.iter()).map(|(one, other)| one.abs_diff(*other)).max().unwrap_or(0)
    };
    let copied = off(&picture(&by_image(COLOUR), 4, texel, placed));
    assert!(copied <= 1, "{copied}");
    // The image matters.
    assert!(off(&picture(&by_numbers(COLOUR, [255, 255]), 4, texel, "materials file")) > 20);
}

#[test]
fn metal_in_part_returns_all_light_that_it_gets_and_no_more() {
    let text = "orthographic eye { pixeldim 16 16 position 1 2 3 target 0 0 0 width 1.2 samples 64 }
         background white { colour 0.8 0.8 0.8 lights yes } material grey { diffuse 0.5 0.5 0.5 }
         mesh m { material grey file square.gltf materials file }";
    let white = scene(&by_image("1, 1, 1"), 8, |x, y| [36 * x as u8, 36 * y as u8], text);
    let plan = Plan::new(&white);
    for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
        let off = (trace::pixel(&plan, x, y) - DVec3::splat(0.8)).abs().max_element();
        assert!(off < 1.0 / 255.0, "{x} {y}: {off}");
    }
}

#[test]
fn proofs_contradict_no_image_of_roughness() {
    let text = "orthographic eye { pixeldim 16 16 position 0.5 1 5 target 0 0 0 width 2.2 }
         background b { colour 0.2 0.3 0.4 } light lamp { location 1 2 3 emissivity 0.6 0.6 0.6 }
         material grey { ambient 0.1 0.1 0.1 } mesh m { material grey file square.gltf materials file }";
    let model = scene(&by_image(COLOUR), 4, |x, _| [80 * x as u8, 255], text);
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    let verdicts: Vec<_> = (0..256).map(|pixel| prover.traced(pixel % 16, pixel / 16).verdict()).collect();
    assert!(!verdicts.contains(&Verdict::Contradicted));
    let proven = verdicts.iter().filter(|verdict| **verdict == Verdict::Proven).count();
    assert!(proven > 20 && proven < 200, "{proven}");
}
