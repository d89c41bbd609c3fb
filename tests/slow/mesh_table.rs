//! A table of 60 files of meshes, in all formats and as programs and people write them: the faces, the bounds and the pixels
//! of each, compared with what its maker knows and with a rasteriser that shares no code with the tracer.

use crate::common::{registry, render, snapshots};
use crate::mesh_files::{Model, bodies};
use glam::DVec3;
use std::fmt::Write;
use std::fs;
use tabray::geometry::{MISS, Ray, RayRange, Rotation};
use tabray::scene;
use tabray::shapes::mesh::read::{self, Wanted};
use tabray::shapes::mesh::{Look, Surface, ToWorld};
use tempfile::TempDir;

const PIXELS: [usize; 2] = [48, 36];
/// The width of the image, in world units.
const WIDTH: f64 = 6.0;
const POSITION: DVec3 = DVec3::new(3.0, 4.0, 6.0);
/// How near to an edge the middle of a pixel may be to be compared, in world units.
const LEAST: f64 = 1e-6;

/// A file, and what it holds.
struct File {
    habit: &'static str,
    name: &'static str,
    bytes: Vec<u8>,
    model: Model,
    /// A part of what the reader must say of it.
    said: &'static str,
}

/// The directions to the right, upward and onward of an image toward the origin.
fn frame() -> [DVec3; 3] {
    let onward = -POSITION.normalize();
    let right = onward.cross(DVec3::Y).normalize();
    [right, right.cross(onward), onward]
}

/// Returns the middles of the pixels, row by row, along the image's right and upward.
fn pixels() -> impl Iterator<Item = [f64; 2]> {
    let [columns, rows] = PIXELS;
    let size = WIDTH / columns as f64;
    (0..rows).flat_map(move |row| {
        (0..columns).map(move |column| {
            [
                (column as f64 + 0.5 - 0.5 * columns as f64) * size,
                (0.5 * rows as f64 - row as f64 - 0.5) * size,
            ]
        })
    })
}

/// Returns the distance from the image's plane of the nearest polygon at a place; infinity for none, and `None` where an edge
/// of a polygon is so near that rounding may decide.
fn depth(polygons: &[Vec<DVec3>], [x, y]: [f64; 2]) -> Option<f64> {
    let [right, up, onward] = frame();
    let mut nearest = f64::INFINITY;
    for polygon in polygons {
        let seen = |at: &DVec3| DVec3::new(at.dot(right), at.dot(up), (*at - POSITION).dot(onward));
        let corners: Vec<_> = polygon.iter().map(seen).collect();
        let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
        let (mut is_inside, mut normal) = (false, DVec3::ZERO);
        for (from, to) in edges() {
            let along = (*to - *from).truncate();
            let away = glam::DVec2::new(x - from.x, y - from.y);
            let part = (away.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            if (away - part * along).length() < LEAST {
                return None;
            }
            // Even and odd: how many edges lie to the right.
            if (from.y > y) != (to.y > y) && x < from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x) {
                is_inside = !is_inside;
            }
            normal += from.cross(*to);
        }
        if is_inside {
            let first = corners[0];
            let z = first.z - (normal.x * (x - first.x) + normal.y * (y - first.y)) / normal.z;
            nearest = nearest.min(z);
        }
    }
    Some(nearest)
}

/// Returns the row of a file, and what is wrong with it.
fn row(file: &File) -> (String, Vec<String>) {
    let File { habit, name, bytes, model, said } = file;
    let (folder, mut wrong) = (TempDir::new().expect("a folder"), Vec::new());
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("a file");
    let cells = |what: &str| format!("{habit:44} {name:8} {what}");
    let read = match read::read(&path, Wanted::default(), u64::MAX) {
        Ok(read) => read,
        Err(error) => return (cells("refused"), vec![format!("{habit}: {}", error.message)]),
    };
    let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
    let surface = Surface::new(read, &placement, Look { crease: None, is_two_sided: true });
    let surface = surface.unwrap_or_else(|error| panic!("{habit}: it {}", error.message().0));
    let mut compared = |what: &str, is_right: bool| {
        if !is_right {
            wrong.push(format!("{habit}: {what}"));
        }
    };
    let faces = surface.face_count();
    compared(&format!("{faces} faces, not {}", model.count()), faces == model.count());
    let [low, high] = surface.bounds();
    compared(&format!("bounds {low} {high}"), surface.bounds() == model.bounds());
    let remarks: Vec<_> = surface.remarks.iter().map(|remark| remark.message.clone()).collect();
    let remarks = remarks.join("; ");
    compared(&remarks, remarks.contains(said) && remarks.is_empty() == said.is_empty());
    let text = format!(
        "orthographic eye {{ pixeldim {} {} position 3 4 6 target 0 0 0 width {WIDTH} }}
         material m {{ ambient 0.5 0.5 0.5 }} mesh o {{ material m file \"{name}\" }}",
        PIXELS[0], PIXELS[1]
    );
    let loaded = scene::read(registry(), "scene", folder.path(), text.as_bytes(), None);
    let scene = loaded.unwrap_or_else(|report| panic!("{habit}: {report}")).model;
    let (image, polygons, [right, up, onward]) = (render(&scene), model.polygons(), frame());
    let (mut covered, mut near) = (0, 0);
    for (pixel, at) in image.pixels().zip(pixels()) {
        let Some(truth) = depth(&polygons, at) else {
            near += 1;
            continue;
        };
        let is_covered = truth < f64::INFINITY;
        covered += usize::from(is_covered);
        let ray = Ray { origin: POSITION + at[0] * right + at[1] * up, dir: onward };
        let distance = scene.objects[0].shape.distance(&ray, &RayRange::ALL);
        let is_depth = if is_covered { (distance - truth).abs() < 1e-12 } else { distance == MISS };
        compared(&format!("the pixel at {at:?}"), (pixel.0[0] > 0) == is_covered);
        compared(&format!("the distance at {at:?} is {distance}, not {truth}"), is_depth);
    }
    let closed = if surface.is_closed() { "closed" } else { "open" };
    let shown = |at: DVec3| at.to_array().map(|part| part.to_string()).join(" ");
    let [low, high] = [low, high].map(shown);
    let parts = surface.count_parts();
    (cells(&format!("{faces:3} {parts:5} {closed:7} {covered:4} {near:4} {low} to {high}; {remarks}")), wrong)
}

/// Returns a text with each line of a kind replaced by some others.
fn lines(text: &str, begin: &str, change: impl Fn(&str) -> String) -> Vec<u8> {
    let changed = text.lines().map(|line| match line.starts_with(begin) {
        true => change(line) + "\n",
        false => line.to_owned() + "\n",
    });
    changed.collect::<String>().into_bytes()
}

fn obj_files(all: &mut Vec<File>) {
    let (cube, crown, comb) = (bodies::cube(), bodies::crown(), bodies::comb());
    let cubes = cube.placed(2.0, [-1.0; 3]);
    let mut add = |habit, bytes: Vec<u8>, model: &Model, said| {
        all.push(File { habit, name: "a.obj", bytes, model: model.clone(), said });
    };
    let text = cubes.obj();
    let bytes = |text: &str| text.as_bytes().to_vec();
    add("squares", bytes(&text), &cubes, "");
    add("triangles", cubes.of_triangles().obj().into(), &cubes, "");
    add("a polygon with a dent", crown.obj().into(), &crown, "");
    add("a polygon with three dents", comb.obj().into(), &comb, "");
    add("a dent, turned inside out", crown.turned(|_| true).obj().into(), &crown, "turns 16 of 16 faces");
    let negative = |line: &str| {
        let corners = line.split(' ').skip(1).map(|corner| corner.parse::<i64>().expect("a corner") - 9);
        corners.fold("f".to_owned(), |line, corner| format!("{line} {corner}"))
    };
    add("corners counted from the end", lines(&text, "f ", negative), &cubes, "");
    let slashed = |more: &'static str| {
        move |line: &str| {
            let corners = line.split(' ').skip(1).map(|corner| format!(" {corner}{more}"));
            format!("f{}", corners.collect::<String>())
        }
    };
    let with = |what: &str| format!("{what}{text}");
    let coordinates = "vt 0 0\nvt 1 0\nvn 0 0 1\n";
    add("vt and vn", lines(&with(coordinates), "f ", slashed("/1/1")), &cubes, "");
    add("vt alone", lines(&with(coordinates), "f ", slashed("/2")), &cubes, "");
    add("vn alone", lines(&with(coordinates), "f ", slashed("//1")), &cubes, "");
    add("colours after coordinates", lines(&text, "v ", |line| format!("{line} 0.5 0.25 1")), &cubes, "");
    add("a byte order mark", with("\u{feff}").into(), &cubes, "");
    add("carriage returns alone", text.replace('\n', "\r").into(), &cubes, "");
    add("no newline at the end", bytes(text.trim_end()), &cubes, "");
    add("comments after words", lines(&text, "f ", |line| format!("{line} # a side")), &cubes, "");
    add("`#` in the name of a material", with("usemtl Material #25\n").into(), &cubes, "");
    add("a group, an object and a smoothing group", with("o cube\ng side #1\ns 1\n").into(), &cubes, "");
    let broken = |line: &str| line.replacen(' ', " \\\n ", 3);
    add("lines continued on the next", lines(&text, "f ", broken), &cubes, "");
    add("numbers with exponents", lines(&text, "v ", |line| line.replace('1', "10.0E-1")), &cubes, "");
    let pieces = cubes.in_pieces();
    add("a vertex for each corner", pieces.obj().into(), &cubes, "");
    add(
        "faces turned unevenly",
        cubes.turned(|face| face % 3 == 0).obj().into(),
        &cubes,
        "turns 4 of 12 faces",
    );
    let more = format!("{text}f 1 2\nf 3\nl 1 7\np 4\n");
    add("lines, points and faces of two corners", more.into(), &cubes, "leaves out 2 faces of fewer");
    add("a face whose corners lie on one line", format!("{text}f 1 2 2\n").into(), &cubes, "without an area");
}

fn ply_files(all: &mut Vec<File>) {
    let (cube, frame, hills, strip) =
        (bodies::cube().placed(1.5, [-0.75; 3]), bodies::frame(), bodies::hills(), bodies::strip());
    let crown = bodies::crown();
    let mut add = |habit, bytes: Vec<u8>, model: &Model, said| {
        all.push(File { habit, name: "a.ply", bytes, model: model.clone(), said });
    };
    let (text, header) = (frame.ply(), "end_header\n");
    add("text", text.clone().into(), &frame, "");
    add("bytes, little end first", frame.ply_bytes(false), &frame, "");
    add("bytes, big end first", frame.ply_bytes(true), &frame, "");
    add("bytes, a polygon with a dent", crown.ply_bytes(false), &crown, "");
    add("text, an open surface", hills.ply().into(), &hills, "");
    add(
        "bytes, an open surface turned unevenly",
        hills.turned(|face| face % 4 == 1).ply_bytes(true),
        &hills,
        "turns 5 of 18 faces",
    );
    add("text, carriage returns", text.replace('\n', "\r").into(), &frame, "");
    add("text, carriage returns and newlines", text.replace('\n', "\r\n").into(), &frame, "");
    add("text, blank lines", text.replace(header, "end_header\n\n \n").into(), &frame, "");
    let (before, rest) = text.split_at(text.find(header).expect("a header") + header.len());
    add("text, all elements in one line", format!("{before}{}", rest.replace('\n', " ")).into(), &frame, "");
    let notes = "comment made by hand\nobj_info none\nCreated by a program\nelement vertex";
    add("text, notes of all kinds", text.replace("element vertex", notes).into(), &frame, "");
    add("text, corners of 64 bits", text.replace("uchar int", "int64 uint64").into(), &frame, "");
    add("text, `vertex_index`", text.replace("vertex_indices", "vertex_index").into(), &frame, "");
    let no_corners =
        text.replace(&format!("element face {}", frame.faces.len()), "element face 18") + "0\n2 0 1\n";
    add("text, faces of two corners and none", no_corners.into(), &frame, "leaves out 2 faces of fewer");
    let mut doubles = cube.ply_bytes(false);
    let start = doubles.windows(11).position(|window| window == header.as_bytes()).expect("a header") + 11;
    let numbers: Vec<u8> = cube
        .vertices
        .iter()
        .flat_map(|at| {
            let of = |part: f32| f64::from(part).to_le_bytes();
            [[7; 8].as_slice(), &of(at[0]), &of(at[1]), &of(at[2]), &[200, 100, 50]].concat()
        })
        .collect();
    let faces = doubles.split_off(start + 12 * cube.vertices.len());
    doubles.truncate(start);
    let wide = String::from_utf8(doubles).expect("a header").replace("float", "double");
    let wide = wide.replace("property double x", "property double quality\nproperty double x");
    let wide = wide.replace(
        "element face",
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face",
    );
    add("bytes, doubles between other properties", [wide.into_bytes(), numbers, faces].concat(), &cube, "");
    let list = strip.ply();
    let vertices = list[..list.find("element face").expect("faces")].to_owned();
    let corners: String = (0..8).map(|corner| format!(" {corner}")).collect();
    let numbers: String = strip.vertices.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let strips = |corners: &str, count: usize| {
        format!(
            "{vertices}element tristrips 1\nproperty list int int vertex_indices\nend_header\n{numbers}{count}{corners}\n"
        )
    };
    add("text, a strip of triangles", strips(&corners, 8).into(), &strip, "");
    add(
        "text, two strips in one",
        strips(" 0 1 2 3 4 -1 4 3 5 6 7 -1", 12).into(),
        &Model {
            faces: [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [5, 3, 6], [5, 6, 7]].map(Vec::from).to_vec(),
            ..strip.clone()
        },
        "",
    );
}

fn stl_files(all: &mut Vec<File>) {
    let cube = bodies::cube().placed(2.0, [-1.0; 3]).of_triangles();
    let (pair, shell, frame) =
        (bodies::pair().of_triangles(), bodies::shell().of_triangles(), bodies::frame().of_triangles());
    let mut add = |habit, bytes: Vec<u8>, model: &Model, said| {
        all.push(File { habit, name: "a.stl", bytes, model: model.clone(), said });
    };
    let text = pair.stl();
    add("text, two bodies that overlap", text.clone().into(), &pair, "");
    add("bytes", frame.stl_bytes("frame", 32, &[]), &frame, "");
    add("bytes, a cavity", shell.stl_bytes("shell", 24, &[]), &shell, "");
    add("bytes, a title like a text", pair.stl_bytes("solid pair", 24, &[]), &pair, "");
    add("bytes, spare ones after a title like a text", pair.stl_bytes("solid", 24, b"\n"), &pair, "");
    add("bytes, a count that is too small", cube.stl_bytes("cube", 7, &[]), &cube, "announces 7 triangles");
    add(
        "bytes, a count that is 1 too small",
        cube.stl_bytes("cube", 11, &[]),
        &cube,
        "announces 11 triangles",
    );
    add("bytes, a count of 0", cube.stl_bytes("", 0, &[]), &cube, "announces 0 triangles");
    add(
        "text, `end solid` and `end loop`",
        text.replace("endloop", "end loop").replace("endsolid", "end solid").into(),
        &pair,
        "",
    );
    add("text, in capitals", text.to_uppercase().into(), &pair, "");
    add("text, a byte order mark", format!("\u{feff}{text}").into(), &pair, "");
    add("text, carriage returns", text.replace('\n', "\r").into(), &pair, "");
    let tetrahedron = bodies::tetrahedron();
    let two = cube.placed(0.25, [1.25, 1.25, 0.0]);
    add("text, two solids", format!("{}{}", tetrahedron.stl(), two.stl()).into(), &tetrahedron.and(&two), "");
}

fn gltf_files(all: &mut Vec<File>) {
    let cube = bodies::cube().placed(1.5, [-0.75; 3]).of_triangles();
    let (strip, pair) = (bodies::strip(), bodies::pair().of_triangles());
    let mut add = |habit, name, bytes: Vec<u8>, model: &Model| {
        all.push(File { habit, name, bytes, model: model.clone(), said: "" });
    };
    let (plain, indexed) = (r#"{"mesh":0}"#, r#","indices":1"#);
    add("a buffer in the text", "a.gltf", cube.gltf(&[plain], indexed).into(), &cube);
    add("in bytes", "a.glb", pair.glb(&[plain], indexed), &pair);
    add("a vertex for each corner, no indices", "a.glb", cube.in_pieces().glb(&[plain], ""), &cube);
    add("a strip", "a.gltf", strip.gltf(&[plain], r#","mode":5"#).into(), &strip);
    let fan = Model { faces: (1..7).map(|at| vec![0, at, at + 1]).collect(), ..strip.clone() };
    add("a fan", "a.gltf", strip.gltf(&[plain], r#","mode":6"#).into(), &fan);
    let small = cube.placed(0.5, [0.0; 3]);
    let moved = [
        r#"{"mesh":0,"translation":[-1,0.5,0]}"#,
        r#"{"mesh":0,"scale":[2,2,2],"translation":[0.5,-0.25,0]}"#,
    ];
    let both = small.placed(1.0, [-1.0, 0.5, 0.0]).and(&small.placed(2.0, [0.5, -0.25, 0.0]));
    add("two places of one mesh", "a.glb", small.glb(&moved, indexed), &both);
    let mirrored = r#"{"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0.5,0,0,1]}"#;
    let mut mirror = pair.clone();
    mirror.vertices.iter_mut().for_each(|at| at[0] = 0.5 - at[0]);
    add("mirrored by a matrix", "a.gltf", pair.gltf(&[mirrored], indexed).into(), &mirror);
    add("GLB named as an OBJ", "a.obj", pair.glb(&[plain], indexed), &pair);
}

#[test]
fn sixty_files_are_read_as_their_makers_know_them_and_look_as_a_rasteriser_draws_them() {
    let mut all = Vec::new();
    obj_files(&mut all);
    ply_files(&mut all);
    stl_files(&mut all);
    gltf_files(&mut all);
    let mut table =
        format!("{:44} {:8} tri parts       pixels near bounds, and what is said\n", "habit", "file");
    let mut wrong = Vec::new();
    for file in &all {
        let (row, mut faults) = row(file);
        writeln!(table, "{}", row.trim_end_matches("; ")).expect("text");
        wrong.append(&mut faults);
    }
    println!("{table}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(all.len(), 60);
    snapshots("meshes").bind(|| insta::assert_snapshot!("table", table));
}
