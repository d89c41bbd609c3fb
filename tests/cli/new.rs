//! `tabray new`: what it writes works at once, and no existing file is overwritten.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use crate::common::{load, render, snapshots};
use std::fs;
use std::path::Path;
use tabray::glam::{DVec2, DVec3};
use tabray::scene::dump;
use tabray::world::Projected;
use tempfile::TempDir;

#[test]
fn a_new_scene_is_sound_and_shows_something() {
    let folder = folder();
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "still.life"]));
    assert_eq!(
        (status, err.as_str()),
        (0, "wrote still.life.ray; render it with `tabray render still.life.ray`\n")
    );
    let (_, _, err) = outcome(tabray(&folder).args(["new", "scene", "two words"]));
    assert_eq!(err, "wrote two words.ray; render it with `tabray render 'two words.ray'`\n");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "still.life.ray", "--quick"]));
    assert_eq!(status, 0, "{err}");
    let picture = image::open(folder.path().join("still.life.png")).expect("a picture").into_rgb8();
    let red = picture.pixels().filter(|pixel| pixel.0[0] > 100 && pixel.0[1] < 80).count();
    assert!(red > 500, "a red ball and a red ring, {red} pixels");
}

/// Returns an OBJ of a box with these sides from a corner on; its last face is left out where it is open.
fn block(corner: f64, sides: [f64; 3], is_open: bool) -> String {
    let corners = (0..8).map(|index| {
        let at = |axis: usize| corner + if index >> axis & 1 == 0 { 0.0 } else { sides[axis] };
        format!("v {} {} {}\n", at(0), at(1), at(2))
    });
    let faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    let faces = &faces[..if is_open { 5 } else { 6 }];
    corners.chain(faces.iter().map(|face| format!("f {face}\n"))).collect()
}

#[test]
fn a_new_scene_fits_its_mesh_at_any_scale() {
    let folder = folder();
    let mut means = Vec::new();
    for (name, scale) in [("a", 1e-6), ("b", 1.0), ("c", 40.0), ("d", 1e6)] {
        let text = block(3.0 * scale, [2.0 * scale, scale, 0.5 * scale], false);
        fs::write(folder.path().join("block.obj"), text).expect("a file");
        let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", name, "--mesh", "block.obj"]));
        assert_eq!(status, 0, "{err}");
        let mut model = load(&folder.path().join(name).with_extension("ray"));
        (model.camera.value.pixels, model.camera.value.samples) = ([80, 60], 1);
        let mesh = model.objects.iter().find(|object| object.args.entity().name == "mesh").expect("a mesh");
        let bounds = mesh.shape.facts().bounds.expect("its box");
        let mut seen = Vec::new();
        for index in 0..8 {
            let at = |axis: usize| if index >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] };
            let Projected::At(place) = model.camera.value.project(DVec3::new(at(0), at(1), at(2))) else {
                panic!("a corner of the mesh is not seen");
            };
            seen.push(place);
        }
        let least = seen.iter().fold(DVec2::INFINITY, |least, place| least.min(*place));
        let most = seen.iter().fold(DVec2::NEG_INFINITY, |most, place| most.max(*place));
        assert!(least.min_element() > 0.0 && most.x < 79.0 && most.y < 59.0, "{name}: {least} {most}");
        let filled = (most - least) / DVec2::new(80.0, 60.0);
        assert!(filled.max_element() > 0.7, "{name}: {filled}");
        let picture = render(&model);
        let mean = picture.iter().map(|byte| f64::from(*byte)).sum::<f64>() / picture.len() as f64;
        assert!((50.0..200.0).contains(&mean), "{name}: {mean}");
        means.push(mean);
    }
    assert!(means.iter().all(|mean| (mean - means[0]).abs() < 2.0), "{means:?}");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "a.toml", "--mesh", "block.obj"]));
    assert_eq!(status, 0, "{err}");
    assert_eq!(
        dump::notes(&load(&folder.path().join("a.toml"))),
        dump::notes(&load(&folder.path().join("d.ray")))
    );
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "e", "--mesh", "blokc.obj"]));
    assert_eq!(status, 2);
    assert!(err.contains("it does not exist, but `block.obj` does"), "{err}");
}

/// A tetrahedron, with a camera, a lamp, a sun and a spotlight.
const STAGED: &str = r#"{
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 32, "color": [1, 0.5, 0.25]},
        {"type": "directional", "intensity": 4},
        {"type": "spot", "intensity": 0, "spot": {"outerConeAngle": 0.5}}
    ]}},
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.1}}],
    "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
    "nodes": [
        {"mesh": 0},
        {"camera": 0, "translation": [0, 1, 6]},
        {"translation": [0, 3, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
            "extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"translation": [0, 0, 9], "extensions": {"KHR_lights_punctual": {"light": 2}}}
    ],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}
    ],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
    "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AACAvwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAgD8AAIA/AAABAAIAAAABAAMAAQACAAMAAgAAAAMA"}]
}"#;

#[test]
fn a_new_scene_has_the_camera_and_the_lights_of_its_file() {
    let folder = folder();
    fs::write(folder.path().join("a.gltf"), STAGED).expect("a file");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "a", "--mesh", "a.gltf"]));
    assert_eq!(status, 0, "{err}");
    let text = fs::read_to_string(folder.path().join("a.ray")).expect("the scene");
    let from = text.find("# The first camera").expect("a camera");
    snapshots("meshes").bind(|| insta::assert_snapshot!("staged", &text[from..]));
    let (status, _, err) = outcome(tabray(&folder).args(["render", "a.ray", "--size", "96"]));
    assert_eq!(status, 0, "{err}");
    let picture = image::open(folder.path().join("a.png")).expect("a picture").into_rgb8();
    assert!(picture.dimensions() == (96, 64) && picture.pixels().any(|pixel| pixel.0[0] > 100));
}

#[test]
fn a_new_scene_of_any_format_looks_the_same_at_any_scale() {
    let folder = folder();
    for format in ["obj", "ply", "stl"] {
        let picture = |scale: f64| {
            // A tetrahedron.
            let corners = [[3.0, 1.0, 2.0], [5.0, 1.0, 2.0], [3.0, 2.0, 2.0], [3.5, 1.5, 4.0]];
            let corners = corners.map(|corner| corner.map(|side| (side * scale).to_string()).join(" "));
            let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
            let of = |line: &dyn Fn([usize; 3]) -> String| {
                faces.iter().map(|face| line(*face)).collect::<String>()
            };
            let text = match format {
                "obj" => {
                    corners.iter().map(|corner| format!("v {corner}\n")).collect::<String>()
                        + &of(&|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1))
                }
                "ply" => format!(
                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                     element face 4\nproperty list uchar int vertex_indices\nend_header\n{}\n{}",
                    corners.join("\n"),
                    of(&|[a, b, c]| format!("3 {a} {b} {c}\n"))
                ),
                _ => format!(
                    "solid s\n{}endsolid s\n",
                    of(&|face| {
                        let lines = face.map(|corner| format!("vertex {}\n", corners[corner])).concat();
                        format!("facet normal 0 0 0\nouter loop\n{lines}endloop\nendfacet\n")
                    })
                ),
            };
            let (file, name) = (format!("part.{format}"), format!("{format}-{scale}.ray"));
            fs::write(folder.path().join(&file), text).expect("a file");
            let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", &name, "--mesh", &file]));
            assert_eq!(status, 0, "{err}");
            let mut model = load(&folder.path().join(name));
            (model.camera.value.pixels, model.camera.value.samples) = ([40, 30], 1);
            render(&model)
        };
        let [small, large] = [1e-3, 1e6].map(picture);
        let differ =
            small.iter().zip(large.iter()).filter(|(small, large)| small.abs_diff(**large) > 2).count();
        // Coordinates have few digits.
        assert!(differ <= small.len() / 100, "{format}: {differ} of {} bytes", small.len());
        assert!(small.iter().any(|byte| *byte > 120), "{format}");
    }
}

#[test]
fn a_new_scene_shows_a_model_as_its_file_says() {
    let folder = folder();
    let model = format!("mtllib a.mtl\nusemtl a\n{}", block(-1.0, [2.0, 2.0, 2.0], false));
    fs::write(folder.path().join("a.obj"), model).expect("a file");
    for (looks, is_shown) in [("newmtl b\n", false), ("newmtl a\nKd 1 0 0\n", true)] {
        fs::write(folder.path().join("a.mtl"), looks).expect("a file");
        let name = if is_shown { "shown" } else { "plain" };
        let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", name, "--mesh", "a.obj"]));
        assert_eq!(status, 0, "{err}");
        let text = fs::read_to_string(folder.path().join(name).with_extension("ray")).expect("a scene");
        assert_eq!(text.contains("    materials   file "), is_shown, "{text}");
        assert!(!text.contains("normals     file"), "{text}");
    }
}

/// The edges along its tube are of up to 50 degrees.
#[test]
fn a_new_scene_of_the_knot_is_smooth_and_warns_of_nothing() {
    let folder = folder();
    let knot = scene("models/knot.obj");
    fs::copy(&knot, folder.path().join("knot.obj")).expect("a copy");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "knot", "--mesh", "knot.obj"]));
    assert_eq!((status, err.lines().count()), (0, 1), "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["check", "knot.ray"]));
    assert_eq!((status, err.as_str()), (0, "knot.ray: no errors\n"));
    let text = fs::read_to_string(folder.path().join("knot.ray")).expect("a scene");
    let looks: Vec<_> = ["red", "ivory"].map(|name| format!("material {name} {{ diffuse ")).into();
    assert!(looks.iter().all(|look| text.contains(look)) && text.contains("crease      50 "), "{text}");
}

#[test]
fn a_new_scene_has_the_camera_and_the_lights_of_a_binary_file_too() {
    let folder = folder();
    let mut json = STAGED.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| u32::try_from(bytes).expect("a few").to_le_bytes();
    let chunk = [&length(json.len())[..], b"JSON", &json].concat();
    let file = [&b"glTF\x02\0\0\0"[..], &length(12 + chunk.len()), &chunk].concat();
    fs::write(folder.path().join("a.glb"), file).expect("a file");
    fs::write(folder.path().join("b.gltf"), STAGED).expect("a file");
    let [binary, text] = [("a", "a.glb"), ("b", "b.gltf")].map(|(name, file)| {
        let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", name, "--mesh", file]));
        assert_eq!(status, 0, "{err}");
        fs::read_to_string(folder.path().join(name).with_extension("ray")).expect("a scene")
    });
    assert!(binary.contains("light lamp1") && binary.contains("sun lamp2"), "{binary}");
    assert_eq!(binary.replace("a.glb", "b.gltf"), text);
}

#[test]
fn a_mesh_in_the_place_of_a_scene_is_told_what_shows_it() {
    let folder = folder();
    fs::write(folder.path().join("part.obj"), block(-1.0, [2.0, 40.0, 0.1], false)).expect("a file");
    fs::write(folder.path().join("part.GLB"), b"glTF\x02\x00\x00\x00\xff").expect("a file");
    for name in ["part.obj", "part.GLB"] {
        let (status, _, err) = outcome(tabray(&folder).args(["render", name]));
        assert_eq!(status, 2, "{err}");
        assert!(err.contains("this is a mesh, not a scene"), "{err}");
        assert!(
            err.contains(&format!("`tabray new scene NAME --mesh {name}` writes a scene that shows it")),
            "{err}"
        );
    }
}

#[test]
fn a_mesh_is_described() {
    let (folder, text) = (folder(), |out: Vec<u8>| String::from_utf8(out).expect("a text"));
    for (name, is_open) in [("closed.obj", false), ("open.obj", true)] {
        fs::write(folder.path().join(name), block(-1.0, [2.0, 40.0, 0.1], is_open)).expect("a file");
    }
    let (status, out, _) = outcome(tabray(&folder).args(["list", "closed.obj"]));
    let expected = "bounds  -1 -1 -1 to 1 39 -0.9\nsize    2 x 40 x 0.1\nfaces   12 triangles\nparts   1\nclosed  yes\n\
        units   not in the file; perhaps millimetres, by its size\nnormals none\nuv      none\ncolours none\nlooks   none\n";
    assert_eq!((status, text(out).as_str()), (0, expected));
    let (_, out, _) = outcome(tabray(&folder).args(["list", "open.obj"]));
    let out = text(out);
    assert!(out.contains("\nclosed  no: open at 4 edges\n"), "{out}");
    let text_of = "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3//1\nusemtl b\nf 2//1 4//1 3//1\n";
    fs::write(folder.path().join("whole.obj"), text_of).expect("a file");
    fs::write(folder.path().join("a.mtl"), "newmtl a\nKd 1 0 0\nmap_Kd a.png\n").expect("a file");
    let (_, out, _) = outcome(tabray(&folder).args(["list", "whole.obj"]));
    let out = text(out);
    let own = "normals at all corners\nuv      at 2 of 6 corners\ncolours at all corners\n\
        looks   1 of 2 materials, with 0 images\nnames   a, b\n";
    assert!(
        out.contains(own) && out.contains("note    it has materials whose images cannot be read"),
        "{out}"
    );
    let (status, _, err) = outcome(tabray(&folder).args(["list", "no.obj"]));
    assert_eq!(status, 2, "{err}");
}

#[test]
fn a_new_scene_in_toml_is_the_same_one() {
    let folder = folder();
    for args in [&["new", "scene", "a"][..], &["new", "scene", "a", "--toml"], &["new", "scene", "b.toml"]] {
        assert_eq!(outcome(tabray(&folder).args(args)).0, 0);
    }
    assert_eq!(names_in(folder.path()), ["a.ray", "a.toml", "b.toml"]);
    let [notes, toml] = ["a.ray", "b.toml"].map(|name| load(&folder.path().join(name)));
    assert_eq!(dump::notes(&notes), dump::notes(&toml));
    assert!(render(&notes) == render(&toml));
}

#[test]
fn no_scene_is_written_in_the_place_of_another_file() {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), "precious").expect("a file");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "a"]));
    assert_eq!(status, 2);
    assert!(err.contains("`a.ray` already exists"), "{err}");
    assert_eq!(fs::read(folder.path().join("a.ray")).expect("still there"), b"precious");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "b.ray", "--toml"]));
    assert_eq!(status, 2);
    assert!(err.contains("`b.ray` would not be read as TOML"), "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["new", "scene", "no/such/folder/a"]));
    assert_eq!(status, 1);
    assert!(
        err.contains("cannot write `no/such/folder/a.ray`: there is no folder `no/such/folder`"),
        "{err}"
    );
    assert_eq!(names_in(folder.path()), ["a.ray"]);
}

/// Makes a folder that looks like a checkout to the command.
fn checkout() -> TempDir {
    let folder = folder();
    for path in ["plugins", "scenes/entities", "scenes/wrong"] {
        fs::create_dir_all(folder.path().join(path)).expect("a folder");
    }
    fs::write(folder.path().join("Cargo.toml"), "[package]\nname = \"tabray\"\n").expect("a file");
    folder
}

fn refused(folder: &TempDir, name: &str) -> String {
    let (status, _, err) = outcome(tabray(folder).args(["new", "plugin", "--", name]));
    assert_eq!(status, 2, "{name}: {err}");
    err
}

const NO_NAME: &str = "a plugin's name must be a Rust module name, such as `tiled_plane`";
const TAKEN: &str = "give the plugin another name";
const IN_THE_WAY: &str = "existing files are not overwritten: choose another name";

#[test]
fn a_plugin_that_cannot_be_is_refused_and_nothing_is_written() {
    let folder = checkout();
    fs::write(folder.path().join("plugins/gem.rs"), "precious").expect("a file");
    fs::write(folder.path().join("scenes/wrong/coil.ray"), "precious").expect("a file");
    for (name, says, help) in [
        ("Gem", "`Gem` cannot be the name of a plugin", NO_NAME),
        ("2d", "`2d` cannot be", NO_NAME),
        ("a-b", "`a-b` cannot be", NO_NAME),
        ("../a", "`../a` cannot be", NO_NAME),
        ("", "`` cannot be", NO_NAME),
        ("a\nb", "`a\\nb` cannot be", NO_NAME),
        ("crate", "`crate` is a Rust keyword", NO_NAME),
        ("sphere", "the entity type `sphere` already exists, at plugins/sphere.rs:", TAKEN),
        ("tplane", "the entity type `tplane` already exists, at plugins/tiled_plane.rs:", TAKEN),
        ("rainbow", "the entity type `rainbow` already exists, at plugins/rainbow.rs:", TAKEN),
        ("cone", "the profile `cone` already exists", TAKEN),
        ("body", "the template already uses the name `Body`", TAKEN),
        ("lib", "`plugins/lib.rs` is not a plugin: it makes the crate of all plugins", TAKEN),
        ("build", "`plugins/build.rs` is not a plugin", TAKEN),
        ("gem", "`plugins/gem.rs` already exists", IN_THE_WAY),
        ("coil", "`scenes/wrong/coil.ray` already exists", IN_THE_WAY),
    ] {
        let err = refused(&folder, name);
        assert!(err.contains(says) && err.ends_with(&format!("\n |\n = help: {help}\n")), "{name}: {err}");
    }
    let written = |path: &str| names_in(&folder.path().join(path));
    assert_eq!(
        (written("plugins"), written("scenes/wrong")),
        (vec!["gem.rs".to_owned()], vec!["coil.ray".to_owned()])
    );
    assert!(written("scenes/entities").is_empty());
}

#[test]
fn a_plugin_belongs_in_a_checkout() {
    let folder = folder();
    assert!(refused(&folder, "gem").contains("this is not the top folder of a checkout of tabray"));
    fs::write(folder.path().join("Cargo.toml"), "[package]\nname = \"other\"\n").expect("a file");
    fs::create_dir(folder.path().join("plugins")).expect("a folder");
    assert!(refused(&folder, "gem").contains("go to the folder with its `Cargo.toml` and `plugins/`"));
    assert!(names_in(&folder.path().join("plugins")).is_empty());
}

#[test]
fn a_plugin_comes_with_its_scenes() {
    let folder = checkout();
    let (status, _, err) = outcome(tabray(&folder).args(["new", "plugin", "cut_gem"]));
    assert_eq!(status, 0, "{err}");
    for path in ["plugins/cut_gem.rs", "scenes/entities/cut_gem.ray", "scenes/wrong/cut_gem.ray"] {
        let text = fs::read_to_string(folder.path().join(path)).expect("it is there");
        assert!(text.contains("cut_gem") && !text.contains("emplate"), "{path}: {text}");
        assert!(err.contains(&format!("wrote {path}\n")), "{err}");
    }
    let last = "render it with `cargo run --release -- render scenes/entities/cut_gem.ray`; docs/plugins.md lists what \
                else belongs to a plugin\n";
    assert!(err.ends_with(last), "{err}");
    assert!(
        fs::read_to_string(folder.path().join(Path::new("plugins/cut_gem.rs")))
            .expect("text")
            .contains("struct CutGem")
    );
}
