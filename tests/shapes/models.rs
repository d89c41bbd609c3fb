//! Models with their own materials, images, normals and colours.

use crate::common::registry;
use image::{Rgb, RgbImage};
use std::fs;
use std::path::Path;
use tabray::geometry::Side;
use tabray::prelude::DVec3;
use tabray::render::Plan;
use tabray::scene::{self, Model};
use tabray::tools::colours::{Prover, Verdict};
use tempfile::TempDir;

/// A square of four by four with texture coordinates that repeat twice to the right, and a triangle beside it.
const WALL: &str = "mtllib my looks.mtl other.mtl\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 6 0 0\nv 8 4 0\n\
    vt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\nvn 0 0 1\n\
    usemtl Material #25\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl plain\nf 2 5 6\n";

const LOOKS: &str = "newmtl Material #25 # a comment\nKd 0.5 1 1\nKs 0.5 0.5 0.5\nNs 90\nillum 2\nd 1\n\
    map_Kd -s 1 1 1 -o 0 0 images\\two colours.png\nnewmtl plain\n  Kd 0.25 0.5 0.75\nKe 0.125 0 0\nillum 3\nKs 0.5 0.25 0\nNs 90\n";

/// Writes files to a folder.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("images")).expect("a folder");
    let image = RgbImage::from_fn(2, 2, |x, y| {
        Rgb(match (x, y) {
            (0, 0) => [128, 0, 0],
            (1, 0) => [0, 128, 0],
            (0, _) => [0, 0, 128],
            _ => [64, 64, 64],
        })
    });
    image.save(folder.path().join("images/two colours.png")).expect("an image");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

/// Reads a scene with a mesh, and returns it with its warnings.
fn read(folder: &Path, mesh: &str) -> (Model, String) {
    read_with(folder, "", mesh)
}

/// Reads a scene with a mesh after other entities, and returns it with its warnings.
fn read_with(folder: &Path, before: &str, mesh: &str) -> (Model, String) {
    let text = format!(
        "camera eye {{ pixeldim 32 24 worlddim 8 6 viewpoint 4 3 6 }} material own {{ ambient 0.5 0.5 0.5 diffuse 0.125 0.25 0.5 }}
         light lamp {{ location 3 3 5 emissivity 30 30 30 }} {before} mesh m {{ material own {mesh} }}"
    );
    match scene::read(registry(), "scene", folder, text.as_bytes(), None) {
        Ok(loaded) => (loaded.model, loaded.warnings.to_string()),
        Err(report) => panic!("{report}"),
    }
}

/// Returns the ambient, the diffuse and the mirrored colour at a point.
fn look(model: &Model, at: [f64; 3]) -> [[f64; 3]; 3] {
    let object = &model.objects[0];
    let at = object.surface_point(DVec3::from(at), Side::Outside);
    let of = [object.shader.ambient(&object.material, &at), object.shader.diffuse(&object.material, &at)];
    [of[0], of[1], object.shader.specular(&object.material, &at)].map(|colour| colour.to_array())
}

#[track_caller]
fn is_near(model: &Model, at: [f64; 3], expected: [[f64; 3]; 3]) {
    let found = look(model, at);
    let off = found.iter().flatten().zip(expected.iter().flatten()).map(|(one, other)| (one - other).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12, "{at:?}: {found:?}, not {expected:?}");
}

#[track_caller]
fn nothing_is_contradicted(model: &Model) {
    let plan = Plan::new(model);
    let prover = Prover::new(&plan);
    let [width, height] = plan.camera.pixels;
    let verdicts =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| prover.traced(x, y).verdict());
    let verdicts: Vec<_> = verdicts.collect();
    assert!(!verdicts.contains(&Verdict::Contradicted));
    let proven = verdicts.iter().filter(|verdict| **verdict == Verdict::Proven).count();
    assert!(2 * proven > verdicts.len(), "{proven}");
}

#[test]
fn an_obj_has_the_materials_and_images_of_its_material_file() {
    let folder = folder(&[("wall.obj", WALL), ("my looks.mtl", LOOKS), ("other.mtl", "")]);
    let (model, warnings) = read(folder.path(), "file wall.obj materials file normals file");
    // The middles of texels: the image repeats, and its first row is the upper one.
    for (at, diffuse) in [
        ([0.5, 3.0, 0.0], [0.25, 0.0, 0.0]),
        ([1.5, 3.0, 0.0], [0.0, 0.5, 0.0]),
        ([2.5, 3.0, 0.0], [0.25, 0.0, 0.0]),
        ([0.5, 1.0, 0.0], [0.0, 0.0, 0.5]),
        ([3.5, 1.0, 0.0], [0.125, 0.25, 0.25]),
        // Halfway between two.
        ([1.0, 3.0, 0.0], [0.125, 0.25, 0.0]),
    ] {
        is_near(&model, at, [diffuse.map(|channel| 0.5 * channel), diffuse, [0.0; 3]]);
    }
    is_near(&model, [6.5, 2.0, 0.0], [[0.25, 0.25, 0.375], [0.25, 0.5, 0.75], [0.5, 0.25, 0.0]]);
    assert!(!warnings.contains("names material"), "{warnings}");
    assert!(warnings.contains("not shown: Ks and Ns (highlights without mirror images)"), "{warnings}");
    assert!(
        warnings.contains("ignores the shininess and transparency of its file's materials: `plain`"),
        "{warnings}"
    );
    nothing_is_contradicted(&model);
    // A shader of the scene sees the texture coordinates of the file.
    let paint = "texture t { filename \"images/two colours.png\" } image paint { texture t }";
    let (model, _) = read_with(folder.path(), paint, "file wall.obj materials file shader paint");
    assert_eq!(look(&model, [2.5, 3.0, 0.0])[1], [0.0625, 0.0, 0.0]);
}

#[test]
fn what_a_material_file_lacks_is_told_and_shown_as_the_mesh() {
    let folder = folder(&[("wall.obj", WALL)]);
    let said = |text: &str| {
        let (model, warnings) = read(folder.path(), "file wall.obj materials file");
        assert!(warnings.contains(text), "{warnings}");
        model
    };
    let model = said(
        "names material files that cannot be read: `my` (line 1: no such file or directory), `looks.mtl`",
    );
    assert_eq!(look(&model, [0.5, 3.0, 0.0])[1], [0.125, 0.25, 0.5]);
    fs::write(folder.path().join("other.mtl"), "").expect("a file");
    let looks = |text: &str| fs::write(folder.path().join("my looks.mtl"), text).expect("a file");
    looks("newmtl Material #25\nKd 1 0 0\nmap_Kd C:\\images\\none.png\nnewmtl plain\nKd red\n");
    let model = said(
        "images cannot be read: `C:/images/none.png` (line 3 of `my looks.mtl`: no such file or directory)",
    );
    assert_eq!(look(&model, [0.5, 3.0, 0.0])[1], [1.0, 0.0, 0.0]);
    said("lines that are not understood: line 5 of `my looks.mtl`");
    looks("newmtl plain\nKd 0 1 0\nd 0.5\n");
    let model = said("names materials that its material files do not have: `Material #25`");
    assert_eq!(look(&model, [0.5, 3.0, 0.0])[1], [0.125, 0.25, 0.5]);
    assert_eq!(look(&model, [6.5, 2.0, 0.0])[1], [0.0, 1.0, 0.0]);
    // Where all faces agree, they are as clear as their material.
    looks("newmtl plain\nKd 0 1 0\nd 0.5\nnewmtl Material #25\nTr 0.5\n");
    assert_eq!(read(folder.path(), "file wall.obj materials file").0.objects[0].material.transparency, 0.5);
}

#[test]
fn colours_of_vertices_are_blended_between_them() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n\
        end_header\n0 0 0 0 0 0\n4 0 0 128 0 0\n4 4 0 128 64 0\n0 4 0 0 64 0\n4 0 1 2 3\n";
    let folder = folder(&[("wall.ply", ply)]);
    let (model, warnings) = read(folder.path(), "file wall.ply materials file");
    assert!(warnings.is_empty(), "{warnings}");
    for (at, colour) in [([1.0, 1.0, 0.0], [0.125, 0.0625, 0.0]), ([3.0, 2.0, 0.0], [0.375, 0.125, 0.0])] {
        let [own, diffuse] =
            [[0.5; 3], [0.125, 0.25, 0.5]].map(|own| [0, 1, 2].map(|channel| own[channel] * colour[channel]));
        is_near(&model, at, [own, diffuse, [0.0; 3]]);
    }
    nothing_is_contradicted(&model);
}

#[test]
fn colours_of_vertices_of_an_obj_are_those_of_bytes() {
    let face = "usemtl plain\nf 1 2 3 4\n";
    let bright =
        format!("mtllib plain.mtl\nv 0 0 0 0 0 0\nv 4 0 0 0.5 0 0\nv 4 4 0\nv 0 4 0 0 1 0 1\n{face}");
    // As other programs write them; the last vertex has a weight.
    let bytes = format!(
        "mtllib plain.mtl\nv 0 0 0 0 0 0\nv 4 0 0 128 0 0\nv 4 4 0 255 255 255\nv 0 4 0 0 255 0\n{face}"
    );
    for text in [bright, bytes] {
        let folder = folder(&[("wall.obj", &text), ("plain.mtl", "newmtl plain\nKd 1 1 0.5\n")]);
        let (model, warnings) = read(folder.path(), "file wall.obj materials file");
        assert!(warnings.is_empty(), "{warnings}");
        // Under the notes' rules, bytes are divided by 256; the first edge between triangles is from the first to the
        // third corner.
        let [all, half] = [255.0, 128.0].map(|byte| byte / 256.0);
        for (at, [red, green, blue]) in [
            ([4.0, 0.0, 0.0], [half, 0.0, 0.0]),
            ([0.0, 4.0, 0.0], [0.0, all, 0.0]),
            ([2.0, 2.0, 0.0], [0.5 * all; 3]),
        ] {
            let diffuse = [red, green, 0.5 * blue];
            is_near(&model, at, [diffuse.map(|channel| 0.5 * channel), diffuse, [0.0; 3]]);
        }
    }
    let (model, warnings) = read(
        folder(&[("wall.obj", "v 0 0 0 1\nv 4 0 0 1\nv 0 4 0 1\nf 1 2 3\n")]).path(),
        "file wall.obj materials file",
    );
    assert!(warnings.contains("has a file without materials and colours"), "{warnings}");
    assert_eq!(look(&model, [1.0, 1.0, 0.0])[1], [0.125, 0.25, 0.5]);
}

#[test]
fn a_scene_is_read_from_the_files_that_its_models_name() {
    let folder = folder(&[("wall.obj", WALL), ("my looks.mtl", LOOKS)]);
    let named = |mesh: &str| {
        let files = read(folder.path(), mesh).0.files;
        let relative = files
            .iter()
            .map(|file| file.strip_prefix(folder.path()).expect("a file of the folder").display());
        relative.map(|file| file.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(named("file wall.obj"), ["wall.obj"]);
    assert_eq!(
        named("file wall.obj materials file"),
        ["wall.obj", "my looks.mtl", "other.mtl", "images/two colours.png"]
    );
}
