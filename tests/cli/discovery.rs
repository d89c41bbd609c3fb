//! What the program reports about itself and its language: the tables as JSON, completions, manual pages.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use crate::common::{assert_tells_fields, registry, root};
use serde_json::Value;
use std::fs;

fn printed(args: &[&str]) -> String {
    let (status, out, err) = outcome(tabray(&folder()).args(args));
    assert_eq!((status, err.as_str()), (0, ""), "{args:?}");
    String::from_utf8(out).expect("text")
}

#[test]
fn the_json_has_every_entity_attribute_and_choice() {
    let tables: Value = serde_json::from_str(&printed(&["list", "--json"])).expect("JSON");
    let entities = tables["entities"].as_array().expect("a list");
    assert_eq!(entities.len(), registry().iter().count());
    for (entity, told) in registry().iter().zip(entities) {
        assert_eq!(told["name"], entity.name);
        let attributes = told["attributes"].as_array().expect("a list");
        assert_eq!(attributes.len(), entity.attributes().count(), "{}", entity.name);
        for (attribute, told) in entity.attributes().zip(attributes) {
            assert_eq!(told["name"], attribute.name());
            assert_eq!(told["required"], attribute.default().is_none());
            assert_eq!(told["must_be"].as_str().unwrap_or_default(), attribute.rule());
        }
    }
    let find = |name: &str| entities.iter().find(|entity| entity["name"] == name).expect("it is told");
    let attribute = |entity: &str, name: &str| {
        let attributes = find(entity)["attributes"].as_array().expect("a list").iter();
        attributes.clone().find(|told| told["name"] == name).expect("it is told").clone()
    };
    assert_eq!(attribute("sphere", "material")["refers_to"], "material");
    assert_eq!(attribute("sphere", "center")["aliases"][0], "centre");
    assert_eq!(attribute("material", "specular")["counts"], serde_json::json!([1, 3]));
    assert_eq!(attribute("material", "ambient")["default"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(attribute("camera", "accuracy")["choices"].as_array().map(Vec::len), Some(4));
    assert_eq!(attribute("revsurf", "profile")["type"], "formula");
    assert_eq!(attribute("revsurf", "profile")["variables"], serde_json::json!(["y"]));
    assert_eq!(attribute("implicit", "formula")["variables"], serde_json::json!(["x", "y", "z"]));
    assert_eq!(find("revsurf")["one_of"][0]["names"], serde_json::json!(["surfer", "profile"]));
    let list = serde_json::json!({ "group": 2, "least": 2, "most": 64 });
    assert_eq!(attribute("lathe", "points")["list"], list);
    assert_eq!(attribute("cylinder", "open")["type"], "truth");
    assert_eq!(attribute("cylinder", "open")["default"], false);
    assert_eq!(attribute("material", "transparency")["range"], serde_json::json!([0.0, 1.0]));
    let named = |list: &str, name: &str| {
        tables[list].as_array().expect("a list").iter().find(|told| told["name"] == name).expect(name).clone()
    };
    assert_eq!(named("profiles", "cone")["number"], 1);
    assert_eq!(named("shaders", "rainbow")["number_on_planes"], 1);
}

#[test]
fn the_docs_tell_every_field_of_the_json() {
    let json = |text: &str| serde_json::from_str::<Value>(text).expect("JSON");
    assert_tells_fields("list", &json(&printed(&["list", "--json"])));
    let ball = scene("sphere/in-front.ray").display().to_string();
    assert_tells_fields("bench", &json(&printed(&["bench", "--json", "--seconds", "0", &ball])));
    assert_tells_fields("verify", &json(&printed(&["verify", "--json", &ball])));
    assert_tells_fields("verify", &json(&printed(&["verify", "--colours", "--json", &ball])));
    let folder_ = folder();
    let (_, _, stats) = outcome(tabray(&folder_).args([
        "render",
        &ball,
        "-o",
        "it.ppm",
        "--samples",
        "2",
        "--stats",
        "json",
    ]));
    assert_tells_fields("stats", &json(stats.lines().last().expect("the statistics")));
    // A picture with two samples in each pixel is not that of the scene with one.
    let graded = ["grade", &ball, "it.ppm", "--set", "eye.samples=1", "--json"];
    let (status, out, err) = outcome(tabray(&folder_).args(graded));
    assert_eq!(status, 1, "{err}");
    assert_tells_fields("grade", &json(&String::from_utf8(out).expect("text")));
    fs::write(folder_.path().join("answers.csv"), "ox,oy,oz,dx,dy,dz,t\n4,3,9,0,0,-1,2\n").expect("a file");
    let (status, out, err) = outcome(tabray(&folder_).args(["judge", &ball, "answers.csv", "--json"]));
    assert_eq!(status, 1, "{err}");
    assert_tells_fields("judge", &json(&String::from_utf8(out).expect("text")));
    let wrong = scene("wrong/duplicate-object.ray").display().to_string();
    let check = ["check", "--message-format", "json", &wrong];
    let (_, _, err) = outcome(tabray(&folder()).args(check));
    assert_tells_fields("messages", &json(err.lines().next().expect("a message")));
}

#[test]
fn completions_are_there_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = printed(&["completions", shell]);
        for word in ["render", "completions", "message-format", "samples"] {
            assert!(script.contains(word), "{shell} completes no {word}");
        }
    }
    let (status, _, err) = outcome(tabray(&folder()).args(["completions", "cmd"]));
    assert_eq!(status, 2);
    assert!(err.contains("[possible values: bash,"), "{err}");
}

#[cfg(unix)]
#[test]
fn bash_completes_commands_options_and_entity_types() {
    let completed = |words: &[&str]| {
        let current = words[words.len() - 1];
        let script = format!(
            "{}\nCOMP_WORDS=(tabray {})\nCOMP_CWORD={}\n_tabray tabray '{current}' ''\necho \"${{COMPREPLY[@]}}\"",
            printed(&["completions", "bash"]),
            words.join(" "),
            words.len(),
        );
        let output = std::process::Command::new("bash").args(["-c", &script]).output().expect("bash runs");
        String::from_utf8(output.stdout).expect("text").trim().to_owned()
    };
    assert_eq!(completed(&["rend"]), "render");
    assert_eq!(completed(&["render", "--quic"]), "--quick");
    assert_eq!(completed(&["list", "tiled"]), "tiled_plane");
}

/// Returns the names of the commands, as the help lists them in groups.
fn commands() -> Vec<String> {
    let help = printed(&["--help"]);
    let (_, rest) = help.split_once("Rendering:\n").expect("the commands");
    let (groups, _) = rest.split_once("\nOptions:\n").expect("the options");
    let lines = groups.lines().filter_map(|line| line.strip_prefix("  "));
    let names: Vec<_> = lines.filter_map(|line| Some(line.split_whitespace().next()?.to_owned())).collect();
    assert!(names.len() > 20, "{names:?}");
    names
}

#[test]
fn every_command_has_its_page() {
    let folder = folder();
    let (status, _, err) = outcome(tabray(&folder).args(["man", "share/man/man1"]));
    assert_eq!(status, 0, "{err}");
    let pages = names_in(&folder.path().join("share/man/man1"));
    assert_eq!(err, format!("wrote {} pages to share/man/man1\n", pages.len()));
    for command in commands() {
        let page = format!("tabray-{command}.1");
        assert!(command == "help" || pages.contains(&page), "there is no {page}: {pages:?}");
    }
    let page = fs::read_to_string(folder.path().join("share/man/man1/tabray-render.1")).expect("a page");
    assert!(page.contains(".TH tabray-render 1") && page.contains("\\-\\-quick"), "{page}");
}

#[test]
fn the_page_of_commands_names_every_one() {
    let page = fs::read_to_string(root().join("docs/commands.md")).expect("the page");
    for command in commands() {
        let is_told = [' ', '`'].iter().any(|end| page.contains(&format!("`tabray {command}{end}")));
        assert!(is_told, "docs/commands.md has no {command}");
    }
}
