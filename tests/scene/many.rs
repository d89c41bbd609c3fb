//! Scenes of many entities, which are parsed, checked and constructed some at a time and on all cores.

use crate::common::{model, registry};
use std::fmt::Write;
use std::path::Path;
use tabray::scene::{self, Model, Report, Severity, Syntax, dump};

/// More entities than are parsed at one time, with a material before every hundredth sphere and a camera at the end.
fn many() -> String {
    let mut text = String::new();
    for index in 0..10_000 {
        if index % 100 == 0 {
            let _ = writeln!(text, "material m{index} {{ ambient {index} 0 0 }}");
        }
        let material = index - index % 100;
        let _ = writeln!(text, "sphere s{index} {{ material m{material} center {index} 0 -5 radius 0.5 }}");
        if index % 7 == 0 {
            let _ = writeln!(text, "light l{index} {{ location 0 {index} 0 emissivity 1 1 1 }}");
        }
    }
    text + "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 accuracy strict }\n"
}

fn faults(text: &str) -> Report {
    match scene::read(registry(), "many", Path::new(""), text.as_bytes(), None) {
        Ok(_) => panic!("faults"),
        Err(report) => report,
    }
}

#[test]
fn many_entities_are_each_what_the_text_says() {
    let Model { objects, lights, materials, .. } = model(&many());
    assert_eq!((objects.len(), lights.len(), materials.len()), (10_000, 1429, 100));
    for (index, object) in objects.iter().enumerate() {
        assert_eq!(object.args.name(), format!("s{index}"));
        assert_eq!(object.material.ambient.x, (index - index % 100) as f64);
        assert_eq!(object.shape.facts().bounds.expect("a sphere").middle().x, index as f64);
        assert!(object.shape.method().contains("twice the precision"), "the camera's accuracy");
    }
    assert!(objects.iter().map(|object| object.args.order()).is_sorted());
    assert!(lights.iter().enumerate().all(|(index, light)| light.args.name() == format!("l{}", 7 * index)));
}

#[test]
fn many_entities_survive_their_dump() {
    let first = model(&many());
    let text = dump::scene(&first, Syntax::Notes);
    assert_eq!(text.matches("sphere ").count(), 10_000);
    assert_eq!(text, dump::scene(&model(&text), Syntax::Notes));
}

#[test]
fn a_name_may_be_longer_than_any_other_word() {
    let name = "n".repeat(300);
    let text = format!("{}sphere {name} {{ material m0 center 0 0 -9 radius 1 }}", many());
    assert_eq!(model(&text).objects[10_000].args.name(), name);
}

#[test]
fn faults_far_apart_are_all_reported_whatever_their_sort() {
    let text = many()
        .replace("sphere s70 {", "spere s70 {")
        .replace("center 4321 0 -5", "center 4321 0")
        .replace("sphere s5000 ", "sphere s4999 ")
        .replace("material m6500 center 6543", "material m65000 center 6543")
        .replace("center 7777 0 -5 radius 0.5", "center 7777 0 -5 radius -0.5");
    let check = |text: &str, first: &str, more: &[&str]| {
        let report = faults(text);
        let expected = [
            first,
            "there is no entity type `spere`",
            "`center` of sphere `s4321` takes 3 numbers, not 2",
            "sphere `s4999` is defined twice",
            "there is no material `m65000`",
            "`radius` of sphere `s7777` must be positive, not -0.5",
        ];
        let expected: Vec<_> =
            expected.iter().chain(more).copied().filter(|message| !message.is_empty()).collect();
        let messages: Vec<_> = report.faults().iter().map(|fault| fault.message.as_str()).collect();
        assert_eq!(messages, expected);
        for fault in report.faults().iter().filter(|fault| fault.message.contains("`s7777`")) {
            assert_eq!(&text[fault.place.clone().expect("a place")], "-0.5");
        }
    };
    check(&text, "", &[]);
    // After a syntax error, the text is read once more.
    check(&format!("{text}\nstray"), "", &["stray word `stray`"]);
    check(&format!("}} {text}"), "stray `}`", &[]);
}

#[test]
fn missing_names_are_counted_however_many() {
    let mut text = many();
    for index in 0..25_000 {
        let _ = writeln!(text, "sphere t{index} {{ material x{index} center 0 0 -5 radius 1 }}");
        let _ = writeln!(text, "spere{index} u{index} {{ radius 1 }}");
    }
    let report = faults(&text);
    assert_eq!((report.count(Severity::Error), report.faults().len()), (50_000, 100));
    assert!(report.to_string().contains("and 49900 more errors"));
}
