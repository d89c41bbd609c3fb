//! Meshes in scenes: they look as their triangles do, whatever they are read from.

use crate::common::{model_in, registry, render};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use tabray::geometry::RayRange;
use tabray::render::Plan;
use tabray::scene;
use tabray::tools::colours::{Prover, Verdict};
use tempfile::TempDir;

const WORLD: &str = "camera eye { pixeldim 61 45 worlddim 8 6 viewpoint 4 3 6 }
    material red { ambient 1 0.3 0.2 diffuse 9 3 2 specular 0.2 shininess 20 }
    material glass { ambient 0.2 0.4 0.3 diffuse 3 5 4 transparency 0.5 }
    material mirror { ambient 0.1 0.1 0.1 diffuse 1 1 1 specular 0.6 }
    plane floor { material mirror normal 0 1 0 point 0 0.25 0 }
    sphere ball { material mirror center 6 2 -5 radius 1.5 }
    light lamp { location 2 6 1 emissivity 5 5 5 }
    light other { location 7 2 -1 emissivity 3 3 3 }
    ";

/// Returns a closed, bumpy ring: the coordinates of its vertices, and the corners of its faces.
fn ring() -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let (around, across) = (24, 12);
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for row in 0..around {
        for column in 0..across {
            let angle = |part: usize, of: usize| std::f64::consts::TAU * part as f64 / of as f64;
            let (sin, cos) = angle(row, around).sin_cos();
            let (up, out) = angle(column, across).sin_cos();
            let tube = 0.6 + 0.2 * (3.0 * angle(row, around)).sin();
            let from = 1.4 + tube * out;
            vertices.push([3.5 + from * cos, 2.0 + from * sin, -3.0 + tube * up]);
            let at = |row: usize, column: usize| (row % around) * across + column % across;
            let [a, b, c, d] =
                [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            faces.extend([[a, d, c], [a, c, b]]);
        }
    }
    (vertices, faces)
}

#[test]
fn a_mesh_looks_as_its_triangles_do() {
    let folder = TempDir::new().expect("a folder");
    let (vertices, faces) = ring();
    let mut obj = String::new();
    vertices.iter().for_each(|[x, y, z]| writeln!(obj, "v {x} {y} {z}").expect("text"));
    faces.iter().for_each(|[a, b, c]| writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).expect("text"));
    fs::write(folder.path().join("ring.obj"), obj).expect("a file");
    for material in ["red", "mirror"] {
        for accuracy in ["draft", "exact", "strict"] {
            let world = WORLD.replace("viewpoint", &format!("accuracy {accuracy} viewpoint"));
            let mesh = model_in(
                folder.path(),
                &format!("{world} mesh ring {{ material {material} file ring.obj }}"),
            );
            let mut triangles = world;
            for (index, face) in faces.iter().enumerate() {
                write!(triangles, "triangle t{index} {{ material {material} ").expect("text");
                for (number, corner) in face.iter().enumerate() {
                    let [x, y, z] = vertices[*corner];
                    write!(triangles, "vertex{} {x} {y} {z} ", number + 1).expect("text");
                }
                triangles += "}\n";
            }
            let triangles = model_in(folder.path(), &triangles);
            assert!(render(&mesh) == render(&triangles), "{material} {accuracy}");
        }
    }
}

#[test]
fn materials_are_chosen_by_name_and_the_others_are_the_meshs_own() {
    let folder = TempDir::new().expect("a folder");
    let obj = "v 0 0 -3\nv 4 0 -3\nv 4 6 -3\nv 0 6 -3\nv 8 0 -3\nv 8 6 -3\nf 1 2 3\nusemtl paint\nf 1 3 4\n\
               usemtl other\nf 2 5 6 3\n";
    fs::write(folder.path().join("wall.obj"), obj).expect("a file");
    let text = "camera eye { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 6 }
        material own { ambient 3 3 3 }
        material paint { ambient 0 9 0 }
        mesh wall { material own file wall.obj }";
    let loaded = scene::read(registry(), "scene", folder.path(), text.as_bytes(), None).expect("a model");
    assert!(loaded.warnings.to_string().contains("names 1 material that the scene does not have: `other`"));
    assert_eq!(loaded.warnings.files(), [folder.path().join("wall.obj")]);
    let image = render(&loaded.model);
    let is_green = |x: u32, y: u32| image.get_pixel(x, y).0[0] == 0 && image.get_pixel(x, y).0[1] > 0;
    let is_grey = |x: u32, y: u32| {
        image.get_pixel(x, y).0[0] > 0 && image.get_pixel(x, y).0[0] == image.get_pixel(x, y).0[1]
    };
    assert!(is_green(2, 2) && is_grey(3, 4) && is_grey(6, 3));
}

#[test]
fn a_file_that_cannot_be_read_is_watched_all_the_same() {
    let folder = TempDir::new().expect("a folder");
    let text = "camera eye { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 3 3 3 }
        mesh wall { material m file wall.obj }";
    let read = |text: &str| scene::read(registry(), "scene", folder.path(), text.as_bytes(), None).err();
    let report = read(text).expect("there is no file");
    assert_eq!(report.files(), [folder.path().join("wall.obj")]);
    for (content, said) in [
        ("", "has a file that cannot be read, `wall.obj`: it is empty"),
        ("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "has no face with an area"),
        ("v 0 0 0\nv 1 0 0\nv 0 1e200 0\nf 1 2 3\n", "has coordinates so large that their squares overflow"),
        ("v 0 0 0\nf 1 2 3\n", "`wall.obj`, line 2: there is no vertex 3: the file has 1"),
    ] {
        fs::write(folder.path().join("wall.obj"), content).expect("a file");
        let report = read(text).expect("a broken file").to_string();
        assert!(report.contains(said), "{report}");
    }
}

#[test]
fn a_probe_names_the_face() {
    let folder = TempDir::new().expect("a folder");
    let obj = "v 0 0 -3\nv 8 0 -3\nv 8 6 -3\nv 0 6 -3\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("wall.obj"), obj).expect("a file");
    let text = "camera eye { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 3 3 3 }
        mesh wall { material m file wall.obj }";
    let model = model_in(folder.path(), text);
    let shape = &model.objects[0].shape;
    for (x, y, face) in [(6.0, 2.0, "face 1"), (2.0, 4.0, "face 2"), (4.0, 3.0, "face 1")] {
        let ray = model.camera.value.ray(x, y);
        let distance = shape.distance(&ray, &RayRange::ALL);
        assert_eq!(shape.part(&ray, distance).as_deref(), Some(face));
    }
}

const OCTAHEDRON: &str = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1
    f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6";

/// Two faces that rise from an edge along x to both sides, lit from above.
const VALLEY: &str = "v -1 0 0\nv 1 0 0\nv 0 1 1\nv 0 1 -1\nf 1 3 2\nf 4 1 2";

/// Tells for each pixel whether it is black, and asserts that no proof says otherwise.
fn is_black(obj: &str, text: &str) -> Vec<bool> {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("mesh.obj"), obj).expect("a file");
    let model = model_in(folder.path(), text);
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    let [width, height] = plan.camera.pixels;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        assert_ne!(prover.traced(x, y).verdict(), Verdict::Contradicted, "{x} {y}: {text}");
    }
    render(&model).pixels().map(|pixel| pixel.0 == [0; 3]).collect()
}

#[test]
fn a_smooth_mesh_keeps_light_out() {
    let inside =
        "look_at eye { pixeldim 30 30 position 0 0 0 target 1 0 0 angle 120 } material m { diffuse 1 1 1 }
        bumps flat { height \"0\" } light lamp { location 9 9 9 emissivity 100 100 100 } ";
    for mesh in [
        "mesh o { material m file mesh.obj smooth 1 }",
        "mesh o { material m file mesh.obj smooth 1 shader flat }",
        "mesh p { material m file mesh.obj smooth 1 } place o { object p rotation 10 20 30 scale 1 1.5 2 }",
    ] {
        let black = is_black(OCTAHEDRON, &format!("{inside}{mesh}"));
        assert!(black.iter().all(|is_black| *is_black), "{mesh}");
    }
}

#[test]
fn a_smooth_mesh_is_lit_only_where_the_light_is_before_its_faces() {
    let valley = |smooth| {
        let text = "look_at eye { pixeldim 60 60 position 0 5 -9 target 0 0.5 0 angle 30 }
            material m { diffuse 1 1 1 } light lamp { location 0 5 9 emissivity 100 100 100 }";
        is_black(VALLEY, &format!("{text} mesh o {{ material m file mesh.obj smooth {smooth} sides one }}"))
    };
    let (flat, smooth) = (valley(0), valley(1));
    assert!(flat.iter().zip(&smooth).all(|(flat, smooth)| !flat || *smooth));
    assert!(smooth.contains(&false));
}

#[test]
fn a_smooth_mirror_shows_only_what_is_before_its_faces() {
    let black = is_black(
        OCTAHEDRON,
        "look_at eye { pixeldim 6 6 position 0.6 0 -0.39 target 0.97 0.015 0.015 angle 120 }
         material mirror { specular 1 1 1 } background pale { colour 1 1 1 }
         mesh o { material mirror file mesh.obj smooth 1 }",
    );
    assert!(black.iter().all(|is_black| *is_black));
}

/// Returns what is said against a mesh, given as an OBJ, as a part of a solid.
fn fault_as_part(obj: &str) -> Option<String> {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("mesh.obj"), obj).expect("a file");
    let text = format!(
        "{WORLD} mesh m {{ material red file mesh.obj }} box b {{ material red center 0 0 0 size 9 9 9 }}
         intersection s {{ objects m b }}"
    );
    let result = scene::read(registry(), "scene", folder.path(), text.as_bytes(), None);
    result.err().map(|report| report.to_string())
}

/// Adds a cone around the z axis, of this many sides and with its point at a z, to an OBJ that has `before` vertices.
fn add_cone(obj: &mut String, before: usize, sides: usize, z: f64) {
    writeln!(obj, "v 0 0 {z}\nv 0 0 {}", z - 2.0).expect("text");
    for side in 0..sides {
        let (sin, cos) = (TAU * side as f64 / sides as f64).sin_cos();
        writeln!(obj, "v {cos} {sin} {}", z - 2.0).expect("text");
    }
    for side in 0..sides {
        let [point, middle] = [before + 1, before + 2];
        let [one, other] = [side, (side + 1) % sides].map(|side| before + 3 + side);
        writeln!(obj, "f {point} {one} {other}\nf {middle} {other} {one}").expect("text");
    }
}

#[test]
fn fans_and_thin_bodies_are_parts_of_solids() {
    let (mut cone, mut cones) = (String::new(), String::new());
    // Where each pair of faces around a corner is compared at length, this takes minutes.
    add_cone(&mut cone, 0, 20_000, 1.0);
    assert_eq!(fault_as_part(&cone), None);
    // No point sees all faces of two bodies from behind.
    add_cone(&mut cones, 0, 1000, 1.0);
    add_cone(&mut cones, 1002, 1000, 4.0);
    assert_eq!(fault_as_part(&cones), None);
    // Its sixfold volume is 1.1e-18, less than what plain arithmetic loses of it.
    let thin = "v 0.8684454578650953 0.38075791704476514 0.1019744021739154
v 0.24933071444268662 0.7311837167794242 0.408151054974514
v 0.18207566377777873 0.8674590942690182 0.389437311586769
v 0.5456287876001579 0.6052763605586136 0.2394981430549564
";
    let faces = [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]];
    let thin = |turn: bool| {
        faces.iter().fold(thin.to_owned(), |obj, [a, b, c]| {
            let (b, c) = if turn { (c, b) } else { (b, c) };
            format!("{obj}f {a} {b} {c}\n")
        })
    };
    assert_eq!(fault_as_part(&thin(false)), None);
    assert_eq!(fault_as_part(&thin(true)), None);
}

#[test]
fn an_open_mesh_is_no_part_of_a_solid() {
    let open = OCTAHEDRON.replace("f 1 4 6", "");
    let fault = fault_as_part(&open).expect("a fault");
    assert!(fault.contains("some of its edges belong to one face only"), "{fault}");
}

#[test]
fn both_sides_of_an_open_mesh_are_lit_unless_a_scene_wants_one() {
    let text = "look_at eye { pixeldim 20 20 position 0 0 5 target 0 0 0 angle 20 }
        material m { diffuse 1 1 1 } light lamp { location 0 0 5.1 emissivity 9 9 9 }
        mesh o { material m file mesh.obj";
    for (face, is_dark) in [("f 1 2 3 4", false), ("f 4 3 2 1", true)] {
        let obj = format!("v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\n{face}\n");
        assert!(!is_black(&obj, &format!("{text} }}")).contains(&true));
        assert!(!is_black(&obj, &format!("{text} sides one }}")).contains(&!is_dark));
    }
}

#[test]
fn a_mesh_that_is_inside_out_refracts_as_one_that_is_not() {
    let picture = |turned: fn(usize) -> bool| {
        let folder = TempDir::new().expect("a folder");
        let lines = OCTAHEDRON.lines().enumerate().map(|(index, line)| {
            match line.trim().split(' ').collect::<Vec<_>>()[..] {
                ["f", a, b, c] if turned(index) => format!("f {a} {c} {b}"),
                _ => line.to_owned(),
            }
        });
        let obj = lines.collect::<Vec<_>>().join("\n");
        fs::write(folder.path().join("mesh.obj"), obj).expect("a file");
        render(&model_in(
            folder.path(),
            &format!(
                "{WORLD} glass clear {{ index 1.5 }} mesh o {{ material clear file mesh.obj translation 4 3 -2 scale 2 2 2 }}"
            ),
        ))
    };
    let right = picture(|_| false);
    assert!(right == picture(|_| true));
    assert!(right == picture(|face| face % 3 == 0));
}

#[test]
fn glass_bodies_of_a_mesh_that_overlap_refract_as_their_union() {
    let folder = TempDir::new().expect("a folder");
    let corners = |x: f64| {
        let moved = |line: &str| match line.trim().split(' ').collect::<Vec<_>>()[..] {
            ["v", first, y, z] => format!("v {} {y} {z}\n", x + first.parse::<f64>().expect("a number")),
            _ => String::new(),
        };
        OCTAHEDRON.lines().map(moved).collect::<String>()
    };
    let faces = |before: usize| {
        let counted = |word: &str| match word.parse::<usize>() {
            Ok(corner) => format!(" {}", before + corner),
            Err(_) => word.to_owned(),
        };
        let lines = OCTAHEDRON.lines().filter(|line| line.trim().starts_with('f'));
        lines.map(|line| line.trim().split(' ').map(counted).collect::<String>() + "\n").collect::<String>()
    };
    for (name, obj) in [
        ("one.obj", corners(0.0) + &faces(0)),
        ("two.obj", corners(0.75) + &faces(0)),
        ("both.obj", corners(0.0) + &corners(0.75) + &faces(0) + &faces(6)),
    ] {
        fs::write(folder.path().join(name), obj).expect("a file");
    }
    let mesh = |name: &str| {
        format!(
            "mesh {name} {{ material clear file {name}.obj translation 3.5 3 -2 scale 1.5 1.25 1.5 rotation 10 20 5 }}"
        )
    };
    let picture = |objects: &str| {
        render(&model_in(folder.path(), &format!("{WORLD} glass clear {{ index 1.5 }} {objects}")))
    };
    let union =
        picture(&format!("{} {} union u {{ material clear objects one two }}", mesh("one"), mesh("two")));
    assert!(picture(&mesh("both")) == union);
    assert!(picture(&format!("{} place p {{ object both }}", mesh("both"))) == union);
}
