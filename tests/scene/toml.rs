//! Scenes in TOML: the same language in another syntax, and its JSON Schema.

use crate::common::{load, model, registry, render, root, scenes};
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tabray::scene::{Syntax, dump, schema};
use tempfile::TempDir;

const NOTES: &str = "
camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
material red { ambient 1 0 0 diffuse 9 1 1 }
light lamp { location 1 7 2 emissivity 5 5 5 }
sphere ball { material red center 4 3 -4 radius 2 }
light lamp { location 7 7 2 emissivity 1 2 3 }
";

const TOML: &str = "
[camera.eye]
pixeldim = [40, 30]
worlddim = [8, 6]
viewpoint = [4, 3, 6]

[material.red]
ambient = [1, 0, 0]
diffuse = [9, 1, 1]

[[light.lamp]]
location = [1, 7, 2]
emissivity = [5, 5, 5]

[sphere.ball]
material = \"red\"
center = [4, 3, -4]
radius = 2

[[light.lamp]]
location = [7, 7, 2]
emissivity = [1, 2, 3]
";

#[test]
fn both_spellings_make_the_same_model() {
    let (notes, toml) = (model(NOTES), model(TOML));
    assert_eq!(dump::scene(&notes, Syntax::Toml), dump::scene(&toml, Syntax::Toml));
    assert_eq!(dump::notes(&notes), dump::notes(&toml));
    assert!(render(&notes) == render(&toml));
}

#[test]
fn entities_of_any_types_stay_in_the_order_of_the_text() {
    let text = dump::scene(&model(TOML), Syntax::Notes);
    let titles: Vec<_> = text.lines().filter(|line| line.starts_with(char::is_alphabetic)).collect();
    assert_eq!(titles, ["camera eye", "material red", "light lamp", "sphere ball", "light lamp"]);
    let swapped = TOML.replace(
        "[[light.lamp]]",
        "[plane.p]\nmaterial = \"red\"\nnormal = [0, 1, 0]\npoint = [0, 0, 0]\n\n[[light.lamp]]",
    );
    let Some((first, last)) = swapped.rsplit_once("[plane.p]") else { panic!("{swapped}") };
    let text = dump::scene(&model(&format!("{first}[plane.q]{last}")), Syntax::Notes);
    let titles: Vec<_> = text.lines().filter(|line| line.starts_with(['l', 'p'])).collect();
    assert_eq!(titles, ["plane p", "light lamp", "plane q", "light lamp"]);
}

fn schema() -> Value {
    serde_json::to_value(schema::of(registry())).expect("JSON")
}

fn in_json(text: &str) -> Option<Value> {
    let value: toml::Value = toml::from_str(text).ok()?;
    serde_json::to_value(value).ok()
}

#[test]
fn the_schema_accepts_every_scene() {
    let schema = jsonschema::validator_for(&schema()).expect("a schema");
    for path in scenes() {
        let text = match Syntax::of_name(&path) {
            Some(Syntax::Toml) => fs::read_to_string(&path).expect("a scene"),
            _ => dump::scene(&load(&path), Syntax::Toml),
        };
        let scene = in_json(&text).unwrap_or_else(|| panic!("{} is no TOML:\n{text}", path.display()));
        let faults: Vec<_> = schema.iter_errors(&scene).map(|error| error.to_string()).collect();
        assert!(faults.is_empty(), "{}: {faults:?}", path.display());
    }
}

#[test]
fn the_schema_refuses_what_is_wrong_by_its_form() {
    let schema = jsonschema::validator_for(&schema()).expect("a schema");
    let mut refused = Vec::new();
    for path in wrong() {
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        let text = fs::read_to_string(&path).expect("a scene");
        // A text that is not TOML does not reach the schema.
        let Some(scene) = in_json(&text) else {
            let other = ["toml-syntax", "toml-twice", "toml-not-toml", "toml-in-name-only"];
            assert!(other.contains(&name.as_str()), "{name}");
            continue;
        };
        // A schema cannot tell what a name refers to, and does not restrict its characters.
        let is_beyond = ["toml-late-material", "toml-control-characters"].contains(&name.as_str());
        assert_eq!(schema.is_valid(&scene), is_beyond, "{name}");
        refused.push(name);
    }
    assert!(refused.len() > 5, "{refused:?}");
}

#[test]
fn the_schema_gives_one_error_for_one_fault_in_its_place() {
    let schema = jsonschema::validator_for(&schema()).expect("a schema");
    let scene = "[camera.eye]\npixeldim = [160, 120]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n\
        [material.grey]\nambient = [2, 2, 2]\nspecular = [0.1, 0.2, 0.3]\ntransparency = 0.5\n\
        [sphere.ball]\nmaterial = \"grey\"\ncenter = [4, \"1 + 2\", -4]\nradius = 1\n\
        [revsurf.vase]\nmaterial = \"grey\"\nsurfer = 2\ndirection = [0, 1, 0]\nbase = [4, 0, -4]\nheight = 6\n";
    for (right, wrong, place) in [
        ("[160, 120]", "[160, 120.5]", "/camera/eye/pixeldim/1"),
        ("[160, 120]", "[160, 120, 9]", "/camera/eye/pixeldim"),
        ("transparency = 0.5", "transparency = 2", "/material/grey/transparency"),
        ("[0.1, 0.2, 0.3]", "[0.1, 0.2]", "/material/grey/specular"),
        ("[0.1, 0.2, 0.3]", "[0.1, true, 0.2]", "/material/grey/specular/1"),
        ("radius = 1", "radius = -1", "/sphere/ball/radius"),
        ("radius = 1", "radius = 0", "/sphere/ball/radius"),
        ("radius = 1", "radius = true", "/sphere/ball/radius"),
        ("radius = 1", "raduis = 1\nradius = 1", "/sphere/ball"),
        ("radius = 1", "", "/sphere/ball"),
        ("surfer = 2", "", "/revsurf/vase"),
        ("surfer = 2", "surfer = 2\nprofile = \"2\"", "/revsurf/vase/profile"),
        ("[camera.eye]", "[camera]", ""),
    ] {
        assert!(scene.contains(right), "{right}");
        let value = in_json(&scene.replace(right, wrong)).expect("TOML");
        let faults: Vec<_> =
            schema.iter_errors(&value).map(|error| error.instance_path().to_string()).collect();
        if !place.is_empty() {
            assert_eq!(faults, [place], "{wrong}");
        }
        assert!(!faults.is_empty(), "{wrong}");
    }
    let value = in_json(scene).expect("TOML");
    assert!(schema.is_valid(&value));
}

/// Returns the faulty scenes in TOML.
fn wrong() -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join("scenes/wrong")).expect("the mistakes");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<_> = paths.filter(|path| Syntax::of_name(path) == Some(Syntax::Toml)).collect();
    paths.sort();
    paths
}

#[test]
fn every_attribute_of_a_scene_is_in_the_schema_with_its_meaning() {
    let schema = schema();
    for entity in registry().iter() {
        for attribute in entity.attributes() {
            let at = format!("/properties/{}/additionalProperties", entity.name);
            let body = schema.pointer(&at).expect("the type");
            let body = body.pointer("/anyOf/0").unwrap_or(body);
            let description = body["properties"][attribute.name()]["description"].as_str();
            let starts = description.is_some_and(|text| text.starts_with(attribute.meaning()));
            assert!(starts, "{} {}: {description:?}", entity.name, attribute.name());
        }
    }
}

/// Runs `tabray convert` in a folder; returns its exit status and its messages.
fn convert(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).arg("convert").args(args).output();
    let output = output.expect("the program runs");
    (output.status.code(), String::from_utf8_lossy(&[output.stderr, output.stdout].concat()).into_owned())
}

#[test]
fn converting_there_and_back_gives_the_same_scene() {
    // File names are relative to the scene's folder, so the textures and the models are copied too.
    let root_of_copies = TempDir::new().expect("a folder");
    let folder = root_of_copies.path().join("copies");
    fs::create_dir(&folder).expect("a folder");
    for kind in ["textures", "models", "parts"] {
        let copies = root_of_copies.path().join(kind);
        fs::create_dir(&copies).expect("a folder");
        for entry in fs::read_dir(root().join("scenes").join(kind)).expect("the files") {
            let path = entry.expect("an entry").path();
            fs::copy(&path, copies.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    for (index, path) in scenes().iter().enumerate() {
        let (there, back) = (format!("{index}.toml"), format!("{index}.ray"));
        let source = folder.join(path.file_name().expect("a name"));
        fs::copy(path, &source).expect("a copy");
        let (status, said) = convert(&folder, &[&source.display().to_string(), &there]);
        assert_eq!(status, Some(0), "{}: {said}", path.display());
        let (status, said) = convert(&folder, &[&there, &back]);
        assert_eq!(status, Some(0), "{}: {said}", path.display());
        let [first, there, back] = [source, folder.join(&there), folder.join(&back)]
            .map(|path| dump::scene(&load(&path), Syntax::Notes));
        assert!(first == there && there == back, "{}", path.display());
    }
}

#[test]
fn converting_says_that_comments_are_lost_and_writes_no_half_of_a_file() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a.ray"), format!("# a comment\n{NOTES}")).expect("a file");
    fs::write(folder.path().join("broken.ray"), "camera eye {").expect("a file");
    fs::write(folder.path().join("kept.toml"), "what was there").expect("a file");
    let (status, said) = convert(folder.path(), &["broken.ray", "kept.toml"]);
    assert_eq!(status, Some(2), "{said}");
    assert_eq!(fs::read_to_string(folder.path().join("kept.toml")).expect("a file"), "what was there");
    let (status, said) = convert(folder.path(), &["a.ray", "kept.toml"]);
    assert_eq!((status, said.contains("(without comments)")), (Some(0), true), "{said}");
    assert!(
        fs::read_to_string(folder.path().join("kept.toml")).expect("a file").starts_with("[camera.eye]\n")
    );
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 3);
}

#[test]
fn converting_asks_which_spelling_is_meant() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a.ray"), NOTES).expect("a file");
    for (args, status, says) in [
        (&["a.ray", "b"][..], 2, "does not determine the syntax to write"),
        (&["a.ray", "-"], 2, "does not determine the syntax to write"),
        (&["a.ray", "b.toml", "--to", "ray"], 2, "would be read as TOML"),
        (&["a.ray", "-", "--to", "toml"], 0, "[camera.eye]"),
        (&["a.ray", "b", "--to", "toml"], 0, "wrote b"),
    ] {
        let (got, said) = convert(folder.path(), args);
        assert_eq!((got, said.contains(says)), (Some(status), true), "{args:?}: {said}");
    }
}

#[test]
fn converting_refuses_a_place_from_where_textures_are_not_found() {
    let folder = TempDir::new().expect("a folder");
    let scene = root().join("scenes/entities/texture.ray").display().to_string();
    let (status, said) = convert(folder.path(), &[&scene, "a.toml"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("would not find its files from"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn standard_input_may_be_toml() {
    let output = cargo_bin_cmd!("tabray").args(["dump", "-"]).write_stdin(TOML).output().expect("it runs");
    assert_eq!(String::from_utf8_lossy(&output.stdout), dump::notes(&model(NOTES)));
}

#[test]
fn lists_truths_and_formulas_are_the_same_in_both_syntaxes() {
    let notes = model(
        "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
        material red { ambient 1 0 0 }
        lathe vase { material red points 0 1  0.5 2  1 1.5  base 4 0 -4 }
        cylinder tube { material red base 4 0 -4 height 1 radius 1 open yes }
        implicit ball { material red formula \"x^2 + y^2 + z^2 - 1\" box -2 -2 -2 2 2 2 }",
    );
    let toml = dump::scene(&notes, Syntax::Toml);
    for line in ["[0, 1, 0.5, 2, 1, 1.5]", "= true\n", "= \"x^2 + y^2 + z^2 - 1\""] {
        assert!(toml.contains(line), "{toml}");
    }
    for toml in [toml.clone(), toml.replace("= true", "= \"yes\"")] {
        assert_eq!(dump::scene(&model(&toml), Syntax::Notes), dump::scene(&notes, Syntax::Notes));
    }
    let quoted = dump::scene(&notes, Syntax::Notes);
    assert!(quoted.contains("open     yes\n") && quoted.contains("points   0 1 0.5 2 1 1.5\n"), "{quoted}");
}
