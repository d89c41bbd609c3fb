//! What copies cost, in instructions of the program.

use crate::common::instructions::instructions;
use crate::common::{load, registry, root};
use std::fmt::Write;
use std::fs;
use tabray::scene::{Kind, Syntax, dump};

/// The most that copies in the places of the objects themselves may cost, as a multiple of what these cost.
const MAX_RATIO: f64 = 3.0;

/// Measures, for each type of object, those in its own scene, and copies of them in the same places: each time the
/// instructions of the image, less those of the scene without these objects.
#[test]
fn a_copy_of_any_object_costs_three_times_the_object_at_most() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.ray");
    let path = path.to_str().expect("a path that is text");
    let count = |text: &str| {
        fs::write(path, text).expect("a file");
        let image = format!("{path}.ppm");
        instructions(&["render", path, "-o", &image, "--samples", "1", "--cpu", "avx2", "--quiet"])
    };
    let mut dear = Vec::new();
    for entity in registry().iter().filter(|entity| entity.kind() == Kind::Object) {
        let scene = root().join(format!("scenes/entities/{}.ray", entity.name));
        if !scene.exists() || ["place", "union", "intersection", "difference"].contains(&entity.name) {
            continue;
        }
        let mut model = load(&scene);
        let text = |model: &_| {
            dump::scene(model, Syntax::Notes).replace("../", &format!("{}/", root().join("scenes").display()))
        };
        let with = text(&model);
        let mut copies = with.clone();
        model.objects.retain(|object| {
            let is_other = object.args.entity().name != entity.name;
            if !is_other {
                let name = object.args.name();
                writeln!(copies, "\nplace copy_{name} {{ object {name} }}").expect("room");
            }
            is_other
        });
        let Some(without) = count(&text(&model)) else { return };
        let [objects, copies] =
            [with, copies].map(|text| count(&text).expect("Valgrind") as f64 - without as f64);
        let ratio = copies / objects;
        println!("{:16} {:8.1} {ratio:8.2}", entity.name, 1e-6 * objects);
        assert!(objects > 0.0, "{}: what is not seen costs nothing", entity.name);
        if ratio > MAX_RATIO {
            dear.push(format!("{}: {ratio:.2} times", entity.name));
        }
    }
    assert!(dear.is_empty(), "{dear:#?}");
}
