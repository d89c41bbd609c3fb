//! Surfaces of which an image cuts parts out: rays see what they would see of the parts that are left.

use crate::common::{model_in, registry, render};
use image::{GrayImage, Luma, Rgba, RgbaImage};
use std::fs;
use std::path::Path;
use tabray::render::Plan;
use tabray::scene;
use tabray::tools::assumptions;
use tabray::tools::verify::{self, Verdict};
use tempfile::TempDir;

/// A camera, a lamp, and a mirror behind what stands on the floor.
const ROOM: &str = "look_at eye { pixeldim 64 48 position 0.3 2.1 5 target 0.1 0.9 0 angle 45 }
    light lamp { location 1.7 3.1 4.3 emissivity 1 1 1 }
    material white { ambient 0.2 0.2 0.2 diffuse 1 1 1 } material mirror { specular 0.8 }
    fplane floor { material white normal 0 1 0 point -3 0 3 xdir 1 0 0 dimensions 6 6 }
    fplane wall { material mirror normal 0 0 1 point -2 0 -2 xdir 1 0 0 dimensions 4 3 }
    texture t { filename alpha.png cutout yes } image cut { texture t } ";

/// A square of two by two.
const SQUARE: &str = "mtllib square.mtl\nv -1 0.125 0\nv 1 0.125 0\nv 1 2.125 0\nv -1 2.125 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

/// Its upper left and its lower right quarter.
const QUARTERS: &str = "v -1 1.125 0\nv 0 1.125 0\nv 0 2.125 0\nv -1 2.125 0\nv 0 0.125 0\nv 1 0.125 0\nv 1 1.125 0\n\
    f 1 2 3 4\nf 5 6 7 2\n";

/// Writes the two meshes, and images whose upper left and lower right quarters are more than half opaque, or bright.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let byte = |x, y| if (x < 32) == (y < 32) { 128 } else { 127 };
    RgbaImage::from_fn(64, 64, |x, y| Rgba([255, 255, 255, byte(x, y)]))
        .save(at("alpha.png"))
        .expect("an image");
    GrayImage::from_fn(64, 64, |x, y| Luma([byte(x, y)])).save(at("grey.png")).expect("an image");
    for (name, text) in
        [("square.obj", SQUARE), ("quarters.obj", QUARTERS), ("square.mtl", "newmtl m\nmap_d grey.png\n")]
    {
        fs::write(at(name), text).expect("a file");
    }
    folder
}

fn room(folder: &Path, object: &str) -> scene::Model {
    model_in(folder, &format!("{ROOM}{object}"))
}

#[test]
fn rays_pass_where_an_image_cuts_a_surface_out() {
    let folder = folder();
    let by = |rules: &str, object: &str| {
        let room = ROOM.replace("angle 45", &format!("angle 45 rules {rules}"));
        render(&model_in(folder.path(), &format!("{room}{object}")))
    };
    let left =
        ["free", "notes"].map(|rules| by(rules, "mesh m { material white file quarters.obj sides one }"));
    let whole =
        ["free", "notes"].map(|rules| by(rules, "mesh m { material white file square.obj sides one }"));
    assert!(left[0] != whole[0] && left[1] != whole[1]);
    let plane = "material white normal 0 0 1 point -1 0.125 0 xdir 1 0 0 dimensions 2 2";
    for cut in [
        format!("texplane p {{ {plane} texname t mode 0 }}"),
        format!("fplane p {{ {plane} shader cut }}"),
        format!(
            "fplane p {{ {} shader cut }} place c {{ object p translation 0 0 4 }}",
            plane.replace("5 0 x", "5 -4 x")
        ),
        "mesh m { material white file square.obj sides one materials file }".to_owned(),
        "mesh m { material white file square.obj sides one materials file shader cut }".to_owned(),
    ] {
        // By the free rules, the opacity that a file gives is what is covered.
        let is_of_file = cut.contains("materials file") && !cut.contains("shader");
        let (rules, left) = if is_of_file { ("notes", &left[1]) } else { ("free", &left[0]) };
        let found = by(rules, &cut);
        let off = found.pixels().zip(left.pixels()).filter(|(one, other)| one != other).count();
        assert_eq!(off, 0, "{rules} {cut}");
    }
}

#[test]
fn nothing_is_proven_of_a_hit_that_may_be_cut_out() {
    let folder = folder();
    let model = room(folder.path(), "mesh m { material white file square.obj materials file }");
    assert_eq!(assumptions::uncertified(&model), ["cutout"]);
    let plan = Plan::new(&model);
    let [width, height] = plan.camera.pixels;
    let verdicts = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let verdicts: Vec<_> = verdicts.map(|(x, y)| verify::pixel(&plan, x, y).verdict).collect();
    let count = |of: Verdict| verdicts.iter().filter(|verdict| **verdict == of).count();
    assert_eq!(count(Verdict::Contradicted), 0);
    // Rays that miss the whole square miss what is left of it.
    assert_eq!(count(Verdict::Proven) + count(Verdict::Uncertified), verdicts.len());
    assert!(count(Verdict::Uncertified) * 3 < verdicts.len(), "{}", count(Verdict::Uncertified));
}

#[test]
fn what_is_cut_out_is_no_part_of_a_solid() {
    let folder = folder();
    let text = format!(
        "{ROOM} sphere a {{ material white center 0 1 0 radius 1 shader cut }}
         sphere b {{ material white center 0.5 1 0 radius 1 }} union u {{ objects a b }}"
    );
    let report =
        scene::read(registry(), "scene", folder.path(), text.as_bytes(), None).err().expect("a fault");
    assert!(report.to_string().contains("parts of its surface are cut out"), "{report}");
}
