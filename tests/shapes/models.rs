//! Models with their own materials, images, normals and colours.

use crate::common::{model_in, registry, render};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::Path;
use tabray::geometry::Side;
use tabray::prelude::{DVec3, Reflectivity};
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
    let at = DVec3::from(at);
    let object = model.objects.iter().find(|object| object.shape.is_on_surface(at, 1e-9)).expect("a face");
    let at = object.surface_point(at, Side::Outside);
    Reflectivity::ALL.map(|of| object.shader.colour_at(of, &object.material, &at).to_array())
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
    assert!(!warnings.contains("not shown"), "{warnings}");
    // Without mirror images, `Ks` is the strength of highlights alone.
    let highlights =
        model.objects.iter().map(|object| (object.material.highlight, object.material.shininess));
    let highlights: Vec<_> = highlights.collect();
    assert_eq!(highlights, [(DVec3::splat(0.5), 90.0), (DVec3::ZERO, 90.0)]);
    nothing_is_contradicted(&model);
    // A shader of the scene sees the texture coordinates of the file.
    let paint = "texture t { filename \"images/two colours.png\" } image paint { texture t }";
    let (model, _) = read_with(folder.path(), paint, "file wall.obj materials file shader paint");
    assert_eq!(look(&model, [2.5, 3.0, 0.0])[1], [0.0625, 0.0, 0.0]);
}

/// A square of two by two with the image of two colours, shown as a texture and a sampler say.
fn square(transform: &str, sampler: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2, "material": 0}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"metallicFactor": 0, "baseColorTexture": {{"index": 0,
            "extensions": {{"KHR_texture_transform": {{{transform}}}}}}}}}}}],
        "textures": [{{"source": 0, "sampler": 0}}], "images": [{{"uri": "images/two colours.png"}}],
        "samplers": [{{"magFilter": 9728 {sampler}}}], "buffers": [{{"uri": "square.bin", "byteLength": 92}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
            {{"buffer": 0, "byteOffset": 80, "byteLength": 12}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
            {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}}]}}"#
    )
}

#[test]
fn images_of_gltf_are_turned_and_wrapped_as_it_says() {
    let folder = folder(&[]);
    let corners: [f32; 12] = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0, 2.0, 0.0];
    let uv: [f32; 8] = [0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    let faces: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = corners.iter().chain(&uv).flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend(faces.iter().flat_map(|corner| corner.to_le_bytes()));
    fs::write(folder.path().join("square.bin"), bytes).expect("a file");
    let (red, green, blue, grey) = ([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5], [0.25; 3]);
    let coated = square("", "").replace(
        r#"{"pbrMetallicRoughness""#,
        r#"{"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}}},
        "pbrMetallicRoughness""#,
    );
    fs::write(folder.path().join("square.gltf"), coated).expect("a file");
    let (_, warnings) = read(folder.path(), "file square.gltf materials file");
    assert!(warnings.contains("clearcoatTexture of KHR_materials_clearcoat"), "{warnings}");
    for (transform, sampler, upper, lower) in [
        ("", "", [red, green], [blue, grey]),
        // Texture coordinates turn counterclockwise, and so the image clockwise.
        (r#""rotation": 1.5707963267948966"#, "", [blue, red], [grey, green]),
        (r#""offset": [0.5, 0]"#, "", [green, red], [grey, blue]),
        (r#""offset": [0.5, 0]"#, r#", "wrapS": 33071"#, [green, green], [grey, grey]),
        (r#""offset": [1, 0]"#, r#", "wrapS": 33648"#, [green, red], [grey, blue]),
        (r#""offset": [0, 0.5], "scale": [1, 1]"#, r#", "wrapT": 33071"#, [blue, grey], [blue, grey]),
    ] {
        fs::write(folder.path().join("square.gltf"), square(transform, sampler)).expect("a file");
        let (model, warnings) = read(folder.path(), "file square.gltf materials file");
        assert!(!warnings.contains("not shown"), "{warnings}");
        for (y, row) in [(1.6, upper), (0.4, lower)] {
            for (x, diffuse) in [0.4, 1.6].into_iter().zip(row) {
                is_near(&model, [x, y, 0.0], [diffuse.map(|channel| 0.5 * channel), diffuse, [0.0; 3]]);
            }
        }
    }
}

/// Two cubes, with a material each.
fn cubes(one: &str, other: &str) -> String {
    let corners = |left: f64| {
        let corner = |at: usize| {
            let [x, y, z] = [at & 1, at >> 1 & 1, at >> 2].map(|side| side as f64);
            format!("v {} {y} {z}\n", left + x)
        };
        (0..8).map(corner).collect::<String>()
    };
    let faces = |first: usize| {
        let face = |face: &[usize; 4]| {
            let [a, b, c, d] = face.map(|corner| first + corner);
            format!("f {a} {b} {c} {d}\n")
        };
        [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]]
            .iter()
            .map(face)
            .collect::<String>()
    };
    format!("{}{}usemtl {one}\n{}usemtl {other}\n{}", corners(0.0), corners(1.5), faces(0), faces(8))
}

#[test]
fn faces_of_two_materials_are_seen_as_two_meshes() {
    let (looks, both) = ("mtllib looks.mtl\n", cubes("red", "clear"));
    let (one, other) = both.split_once("usemtl clear").expect("two");
    let (corners, _) = one.split_once("usemtl").expect("a material");
    let folder = folder(&[
        ("both.obj", &both),
        ("one.obj", one),
        ("other.obj", &format!("{corners}usemtl clear{other}")),
        ("files.obj", &format!("{looks}{both}")),
        ("red.obj", &format!("{looks}{}", cubes("red", "none"))),
        ("clear.obj", &format!("{looks}{}", cubes("none", "clear"))),
        (
            "looks.mtl",
            "newmtl red\nKd 0.8 0.2 0.1\nillum 3\nKs 0.2 0.2 0.2\nnewmtl clear\nKd 0.4 0.9 0.5\nd 0.3\n\
          newmtl none\nd 0\n",
        ),
    ]);
    let picture = |objects: &str| {
        render(&model_in(
            folder.path(),
            &format!(
                "look_at eye {{ pixeldim 48 36 position 2 3 6 target 1.2 0.5 0.5 angle 35 samples 2 }}
                 sky day {{ lights yes }} light lamp {{ location 3 5 4 emissivity 1 1 1 }}
                 material own {{ diffuse 0.5 0.5 0.5 }} material red {{ diffuse 0.8 0.2 0.1 specular 0.3 }}
                 glass clear {{ index 1.4 attenuation 0.3 0.8 0.4 at 1 }}
                 plane floor {{ material own normal 0 1 0 point 0 0 0 }} {objects}"
            ),
        ))
    };
    // By the names of the scene's materials, as a copy too.
    let parts = "mesh one { material red file one.obj } mesh two { material clear file other.obj }";
    let together = picture("mesh both { material own file both.obj }");
    assert_eq!(together, picture(parts));
    let far = "mesh both { material own file both.obj translation 5 0 0 } place copy { object both translation -5 0 0 }";
    assert_eq!(together, picture(far));
    // By the file's, of which one covers nothing.
    let of_file = |name: &str| format!("mesh {name} {{ material own file {name}.obj materials file }} ");
    assert_eq!(picture(&of_file("files")), picture(&(of_file("red") + &of_file("clear"))));
}

/// An image says how metallic and how rough each point is, in place of a number.
#[test]
fn images_of_metal_and_roughness_hold_at_each_point() {
    let looks = "newmtl Material #25\nKd 0.5 0.25 1\nPm 0\nmap_Pm images/two colours.png\n\
        map_Pr images/two colours.png\nPr 0.9\nnewmtl plain\nKd 0.5 0.5 0.5\nPm 1\nPr 0.5\n";
    let folder = folder(&[("wall.obj", WALL), ("my looks.mtl", looks), ("other.mtl", "")]);
    let (model, warnings) = read(folder.path(), "file wall.obj materials file");
    assert!(!warnings.contains("not shown"), "{warnings}");
    let near = |at: [f64; 3], colour: [f64; 3], part: f64| {
        let [ambient, diffuse, specular] =
            [0.5, 1.0 - part, part].map(|factor| colour.map(|channel| factor * channel));
        is_near(&model, at, [ambient, diffuse, specular]);
    };
    let forged = |byte: f64| byte / 255.0 * (1.0 - byte / 255.0).powi(2);
    // Red is what counts; the last point is halfway between two texels.
    for (at, byte) in
        [([0.5, 3.0, 0.0], 128.0), ([1.5, 3.0, 0.0], 0.0), ([3.5, 1.0, 0.0], 64.0), ([1.0, 3.0, 0.0], 64.0)]
    {
        near(at, [0.5, 0.25, 1.0], forged(byte));
    }
    near([6.5, 2.0, 0.0], [0.5; 3], 0.25);
    nothing_is_contradicted(&model);
}

#[test]
fn what_a_mesh_of_glass_does_not_take_from_its_file_is_told() {
    let folder = folder(&[("wall.obj", WALL), ("my looks.mtl", LOOKS), ("other.mtl", "")]);
    let clear = "glass clear { } mesh other { material clear file wall.obj materials file }";
    let (_, warnings) = read_with(folder.path(), clear, "file wall.obj");
    assert!(warnings.contains("its file's materials give their colours alone"), "{warnings}");
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
fn of_an_opacity_and_a_transparency_the_opacity_counts() {
    let folder = folder(&[("a.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n")]);
    for (lines, transparency, is_told) in [
        ("d 1\nTr 1\n", 0.0, true),
        ("Tr 1\nd 1\n", 0.0, true),
        ("Tr 0.25\nd 0.75\n", 0.25, false),
        ("Tr 0.75\n", 0.75, false),
        ("d 0.5\nTr 0.25\n", 0.5, true),
    ] {
        fs::write(folder.path().join("a.mtl"), format!("newmtl a\n{lines}")).expect("a file");
        let (model, warnings) = read(folder.path(), "file a.obj materials file");
        assert_eq!(model.objects[0].material.transparency, transparency, "{lines}");
        assert_eq!(warnings.contains("not shown: Tr (`d` says otherwise)"), is_told, "{lines}{warnings}");
    }
}

/// A material file has no end, but its last line may show that it is not whole.
#[test]
fn a_material_file_that_ends_within_a_line_is_told() {
    let folder = folder(&[("a.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n")]);
    for (last, is_told) in [
        ("Kd 0.5 0.25 0.125", false),
        ("Kd 0.5 0.25 0.", true),
        ("Kd 0.5 0.25", true),
        ("Kd 0.5", true),
        ("Kd 0.5\n", false),
        ("Ns 1e", true),
        ("map_Kd two.", false),
    ] {
        fs::write(folder.path().join("a.mtl"), format!("newmtl a\n{last}")).expect("a file");
        let (_, warnings) = read(folder.path(), "file a.obj materials file");
        assert_eq!(warnings.contains("not understood: line 2 of `a.mtl`"), is_told, "{last}: {warnings}");
    }
}

#[test]
fn a_file_of_another_kind_is_not_what_a_missing_one_meant() {
    let obj = "mtllib wall.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
    let folder = folder(&[("wall.obj", obj)]);
    let said = || read(folder.path(), "file wall.obj materials file").1;
    assert!(said().contains("`wall.mtl` (line 1: no such file or directory)"), "{}", said());
    fs::write(folder.path().join("wal.mtl"), "").expect("a file");
    assert!(said().contains("but `wal.mtl` does"), "{}", said());
}

#[test]
fn images_of_bumps_are_normals_or_heights_by_what_they_hold() {
    let folder = folder(&[(
        "a.obj",
        "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
    )]);
    fs::write(folder.path().join("a.mtl"), "newmtl a\nmap_Bump a.png\n").expect("a file");
    type Texel = fn(u32, u32) -> [u8; 3];
    let images: [(Texel, bool); 4] = [
        (|x, y| [118 + 5 * (x % 4) as u8, 118 + 5 * (y % 4) as u8, 253], true),
        // Heights in a file of colours, a photograph's colours, and grey.
        (|x, _| [90 + x as u8, 90 + x as u8, 92 + x as u8], false),
        (|x, y| [200, 120 + x as u8, 40 + y as u8], false),
        (|x, _| [10 * x as u8; 3], false),
    ];
    for (texel, is_normals) in images {
        let image = image::RgbImage::from_fn(16, 16, |x, y| image::Rgb(texel(x, y)));
        image.save(folder.path().join("a.png")).expect("an image");
        let (_, warnings) = read(folder.path(), "file a.obj materials file");
        assert_eq!(!warnings.contains("map_Bump (an image of heights)"), is_normals, "{warnings}");
    }
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

/// A square whose corners have texture coordinates for each face, as MeshLab and OpenMVS write them.
const TEXTURED: &str = "ply\nformat ascii 1.0\ncomment TextureFile images/two colours.png\nelement vertex 4\nproperty float x\n\
    property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\n\
    property list uchar float texcoord\nproperty int texnumber\nend_header\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n\
    4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 1 2 6 0 0 1 0 1 1 7\n";

#[test]
fn a_ply_has_images_by_the_corners_of_its_faces() {
    let text = folder(&[("wall.ply", TEXTURED)]);
    let (model, warnings) = read(text.path(), "file wall.ply materials file");
    // The second face covers the first one, and names an image that there is not.
    assert!(!warnings.contains("without materials and colours"), "{warnings}");
    let of_obj = folder(&[
        (
            "wall.obj",
            "mtllib wall.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
        ),
        ("wall.mtl", "newmtl a\nmap_Kd images/two colours.png\n"),
    ]);
    let (other, _) = read(of_obj.path(), "file wall.obj materials file");
    for at in [[0.5, 3.0, 0.0], [1.0, 3.5, 0.0], [0.25, 1.5, 0.0]] {
        assert_eq!(look(&model, at), look(&other, at), "{at:?}");
    }
    let missing = folder(&[("wall.ply", &TEXTURED.replace("two colours", "none"))]);
    let (_, warnings) = read(missing.path(), "file wall.ply materials file");
    assert!(warnings.contains("images cannot be read: `images/none.png` (line 3: "), "{warnings}");
}

#[test]
fn a_ply_has_colours_of_faces() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        end_header\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n3 0 1 2 128 0 0\n3 0 2 3 0 64 0\n";
    let folder = folder(&[("wall.ply", text)]);
    let (model, warnings) = read(folder.path(), "file wall.ply materials file");
    assert!(warnings.is_empty(), "{warnings}");
    assert_eq!(look(&model, [3.0, 1.0, 0.0])[1], [0.0625, 0.0, 0.0]);
    assert_eq!(look(&model, [1.0, 3.0, 0.0])[1], [0.0, 0.0625, 0.0]);
}
