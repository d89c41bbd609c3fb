//! Scenes that compute: named numbers, formulas in place of numbers, included files, what is repeated, and values that are
//! set beside the text.

use crate::common::program::{folder, outcome, tabray};
use crate::common::{model, model_in, registry};
use proptest::prelude::*;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use tabray::scene::{self, Syntax, dump};

/// The time after which a test takes a scene for one that is never refused, however busy the machine.
const HANGS: Duration = Duration::from_secs(60);

const HEAD: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n";

/// Returns what a scene is, written out.
fn written(text: &str) -> String {
    dump::scene(&model(text), Syntax::Notes)
}

/// Returns the messages about a scene in a folder, which must be refused.
fn refused(folder: &Path, name: &str, text: &str) -> String {
    match scene::read(registry(), name, folder, text.as_bytes(), None) {
        Ok(_) => panic!("it is read: {text}"),
        Err(report) => report.to_string(),
    }
}

proptest! {
    #[test]
    fn a_scene_with_numbers_and_rounds_is_the_scene_written_out(
        a in -9_i32..9, b in 1_i32..99, outer in 0_u32..5, inner in 0_u32..4
    ) {
        let (x, y) = (f64::from(a) / 4.0, f64::from(b) / 8.0);
        let notes = format!(
            "{HEAD}let a {x:?}\nlet b \"{b}/8\"\nrepeat i {outer} {{\n let c \"a*i + b\"\n \
             material p {{ ambient \"i\" 0 \"b\" }}\n repeat j \"{inner} + 0*c\" {{\n  \
             sphere s {{ material p center \"c\" \"j - a\" \"-4/(j + b)\" radius \"0.5 + i/b\" }} }} }}\n\
             sphere last {{ material m center \"a\" 0 -4 radius \"b\" }}\n"
        );
        let toml = format!(
            "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n\
             [material.m]\nambient = [1, 1, 1]\n[let]\na = {x:?}\nb = \"{b}/8\"\n\
             [repeat.i]\ncount = {outer}\n[repeat.i.let]\nc = \"a*i + b\"\n\
             [repeat.i.material.p]\nambient = [\"i\", 0, \"b\"]\n\
             [repeat.i.repeat.j]\ncount = \"{inner} + 0*c\"\n\
             [repeat.i.repeat.j.sphere.s]\nmaterial = \"p\"\ncenter = [\"c\", \"j - a\", \"-4/(j + b)\"]\n\
             radius = \"0.5 + i/b\"\n[sphere.last]\nmaterial = \"m\"\ncenter = [\"a\", 0, -4]\nradius = \"b\"\n"
        );
        let mut plain = HEAD.to_owned();
        for i in 0..outer {
            let c = x * f64::from(i) + y;
            let _ = writeln!(plain, "material p_{i} {{ ambient {i} 0 {y:?} }}");
            for j in 0..inner {
                let (second, third) = (f64::from(j) - x, -4.0 / (f64::from(j) + y));
                let radius = 0.5 + f64::from(i) / y;
                let _ = writeln!(
                    plain,
                    "sphere s_{i}_{j} {{ material p_{i} center {c:?} {second:?} {third:?} radius {radius:?} }}"
                );
            }
        }
        let _ = writeln!(plain, "sphere last {{ material m center {x:?} 0 -4 radius {y:?} }}");
        let plain = written(&plain);
        prop_assert_eq!(&written(&notes), &plain);
        prop_assert_eq!(&written(&toml), &plain);
        // What is written out is a scene, and the same one.
        prop_assert_eq!(&written(&plain), &plain);
    }
}

#[test]
fn named_numbers_stand_in_formulas_of_profiles_and_surfaces_and_are_numbers_in_the_dump() {
    let text = written(&format!(
        "{HEAD}let r 1.5\nlet n -2\nlet tiny 1e-7\n\
         revsurf vase {{ material m direction 0 1 0 base 4 0 -4 height 1 profile \"r + (y + 1)^n/9 + tiny\" }}\n\
         implicit ball {{ material m formula \"x^2 + y^2 + z^2 - r^2 - n\" box -2 -2 -2 2 2 2 }}\n"
    ));
    assert!(text.contains("\"1.5 + (y + 1)^(-2)/9 + 1e-7\""), "{text}");
    assert!(text.contains("\"x^2 + y^2 + z^2 - 1.5^2 - (-2)\""), "{text}");
    assert_eq!(written(&text), text);
}

#[test]
fn functions_of_a_scene_are_what_they_stand_for() {
    let entities = "sphere s { material m center \"f(1, 0)\" \"ring(3)\" -4 radius \"ring(2)/2\" }
        implicit i { material m formula \"f(x, 2y) + ring(z) = 2\" box -1 -1 -1 1 1 1 }";
    let of_numbers = "sphere s { material m center 1 7 -4 radius 1.5 }";
    let notes = [
        "let k 2\nlet f(u, v) = \"u^2 + k v\" # a comment\nlet ring(r) \"f(r, -r/2) + if(r < 1, 0, 1)\"\n",
        "let k 2 let f(u,v) \"u^2 + k v\" let \"ring( r )\" \"f(r, -r/2) + if(r < 1, 0, 1)\"\n",
    ];
    let expected = written(&format!("{HEAD}{notes}{entities}", notes = notes[0]));
    assert!(expected.starts_with(&written(&format!("{HEAD}{of_numbers}"))), "{expected}");
    assert_eq!(written(&format!("{HEAD}{notes}{entities}", notes = notes[1])), expected);
    assert_eq!(written(&expected), expected);
    let toml = "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n[material.m]\nambient = [1, 1, 1]\n\
        [let]\nk = 2\n\"f(u, v)\" = \"u^2 + k v\"\n\"ring(r)\" = \"f(r, -r/2) + if(r < 1, 0, 1)\"\n\
        [sphere.s]\nmaterial = \"m\"\ncenter = [\"f(1, 0)\", \"ring(3)\", -4]\nradius = \"ring(2)/2\"\n\
        [implicit.i]\nmaterial = \"m\"\nformula = \"f(x, 2y) + ring(z) = 2\"\nbox = [[-1, -1, -1], [1, 1, 1]]\n";
    let toml = toml.replace("[[-1, -1, -1], [1, 1, 1]]", "[-1, -1, -1, 1, 1, 1]");
    assert_eq!(written(&toml), expected);
}

#[test]
fn what_is_wrong_with_a_function_is_marked_there() {
    for (text, said) in [
        ("let f(pi) \"1\"", "`pi` cannot be the name of an argument"),
        ("let f(u, u) \"u\"", "`u` is an argument twice"),
        ("let f() \"1\"", "`` cannot be the name of an argument"),
        ("let f(u) 3", "`3` is not a formula in quotes"),
        ("let sin(u) \"u\"", "`sin` cannot be the name of a number"),
        ("let f(u) \"u + w\"", "unknown name `w` in a formula"),
        ("let f(u) \"u*f(u - 1)\"", "the function `f` is used before it is defined"),
        ("let f(u) \"u\" let f(v) \"v\"", "the number `f` is defined twice"),
        ("let f(u, v) \"u\" let a \"f(1)\"", "`f` takes 2 values, separated by commas"),
        ("let f(u, v \"u\"", "its arguments end with `)`"),
    ] {
        let message = refused(Path::new(""), "scene.ray", &format!("{HEAD}{text}\n"));
        assert!(message.contains(said), "{text}: {message}");
    }
    // What is faulty is told once.
    let message = refused(Path::new(""), "scene.ray", &format!("{HEAD}let f(u) \"u +\" let a \"f(1)\"\n"));
    assert!(message.contains("1 error") && message.contains("expected a value"), "{message}");
}

#[test]
fn formulas_of_forty_thousand_terms_are_read_quickly() {
    let start = Instant::now();
    for (operation, term) in [("+", "sin(#*x)"), ("*", "(x-#*y)")] {
        let terms: Vec<_> = (1..40_000).map(|number| term.replace('#', &number.to_string())).collect();
        let formula = terms.join(operation);
        let text = format!("{HEAD}implicit s {{ material m box -1 -1 -1 1 1 1 formula \"{formula}\" }}\n");
        assert_eq!(model(&text).objects.len(), 1);
    }
    assert!(start.elapsed() < HANGS, "{:?}", start.elapsed());
}

#[test]
fn a_hundred_thousand_rounds_are_read_quickly_and_many_more_are_refused() {
    let start = Instant::now();
    let text = format!(
        "{HEAD}repeat i 100000 {{ sphere s {{ material m center \"i/9\" \"sqrt(i)\" -4 radius \"1 + i\" }} }}\n"
    );
    let model = model(&text);
    assert_eq!(model.objects.len(), 100_000);
    assert_eq!(model.objects[99_999].args.name(), "s_99999");
    assert!(start.elapsed() < HANGS, "{:?}", start.elapsed());
    let long = "# a long line\n".repeat(100_000);
    for body in [
        "sphere s { material m center 1 2 -4 radius 1 }".to_owned(),
        format!("repeat j 1000000 {{ {long} }}"),
        "repeat j 1000000 { repeat k 1000000 { } }".to_owned(),
    ] {
        let said = refused(Path::new(""), "scene", &format!("{HEAD}repeat i 1000000 {{\n{body}\n}}\n"));
        assert!(said.contains("the scene repeats too much"), "{said}");
    }
}

#[test]
fn rounds_within_rounds_without_end_are_refused_quickly() {
    let nested = |depth: usize| {
        let opened: String = (0..depth).map(|index| format!("repeat i{index} 1 {{\n")).collect();
        let closed = "}".repeat(depth);
        format!("{HEAD}{opened} sphere s {{ material m center 4 3 -4 radius 1 }}\n{closed}\n")
    };
    assert_eq!(model(&nested(32)).objects.len(), 1);
    let start = Instant::now();
    let said = refused(Path::new(""), "scene", &nested(50_000));
    assert!(said.contains("`repeat i32` is nested too deep"), "{said}");
    assert!(start.elapsed() < HANGS, "{:?}", start.elapsed());
}

#[test]
fn a_number_that_a_variable_of_a_formula_hides_is_refused_there() {
    let scene = |formula: &str| format!("{HEAD}let u 0.25\nformula f {{ ambient \"{formula}\" }}\n");
    let said = refused(Path::new(""), "scene", &scene("1 + u"));
    assert!(said.contains("`u` is a variable of this formula and a number of the scene"), "{said}");
    model(&scene("1 + v"));
}

#[test]
fn many_unknown_names_are_told_quickly() {
    let numbers: String = (0..20_000).map(|index| format!("let n{index} {index}\n")).collect();
    let wrong: String = (0..20_000)
        .map(|index| format!("sphere s{index} {{ material m center \"m{index}\" 0 -4 radius 1 }}\n"))
        .collect();
    let start = Instant::now();
    let said = refused(Path::new(""), "scene", &format!("{HEAD}{numbers}{wrong}"));
    assert!(said.ends_with("scene: 20000 errors\n"), "{said}");
    assert!(start.elapsed() < HANGS, "{:?}", start.elapsed());
}

#[test]
fn a_fault_in_every_round_is_told_once() {
    let said = refused(
        Path::new(""),
        "scene",
        &format!("{HEAD}repeat i 50000 {{\n sphere s {{ material m center 0 \"i\" -4 radius -1 }} }}\n"),
    );
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
    assert!(said.contains("and 49999 more errors") && said.contains("scene: 50000 errors"), "{said}");
}

#[test]
fn included_files_are_read_as_if_they_stood_there() {
    let folder = folder();
    let parts = folder.path().join("parts");
    fs::create_dir(&parts).expect("a folder");
    for (name, text) in [
        ("parts/head.inc", HEAD),
        ("parts/all.inc", "include head.inc\nlet r 2 include more.inc"),
        ("parts/more.inc", "sphere a { material m center 0 0 -4 radius \"r\" }"),
        ("parts/head.toml", "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n"),
        ("parts/all.toml", "include = [\"head.toml\"]\n[let]\nr = 2\n[material.m]\nambient = [1, 1, 1]\n"),
    ] {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let notes = "include parts/all.inc\nsphere b { material m center \"r\" 0 -4 radius 1 }";
    let notes = dump::scene(&model_in(folder.path(), notes), Syntax::Notes);
    let plain =
        "sphere a { material m center 0 0 -4 radius 2 } sphere b { material m center 2 0 -4 radius 1 }";
    assert_eq!(notes, written(&format!("{HEAD}{plain}")));
    let toml =
        "include = \"parts/all.toml\"\n[sphere.b]\nmaterial = \"m\"\ncenter = [\"r\", 0, -4]\nradius = 1\n";
    let toml = dump::scene(&model_in(folder.path(), toml), Syntax::Notes);
    assert_eq!(toml, written(&format!("{HEAD}sphere b {{ material m center 2 0 -4 radius 1 }}")));
}

#[test]
fn a_fault_in_an_included_file_is_marked_in_that_file() {
    let folder = folder();
    fs::write(folder.path().join("a.inc"), "\nsphere a { material m center 0 0 -4\n radius -1 }\n")
        .expect("a file");
    fs::write(folder.path().join("b.ray"), format!("{HEAD}include a.inc\n")).expect("a file");
    let check = |form| outcome(tabray(&folder).args(["check", "b.ray", "--message-format", form]));
    let (status, _, short) = check("short");
    assert_eq!(status, 2, "{short}");
    assert_eq!(short, "a.inc:3:9: error: `radius` of sphere `a` must be positive, not -1\n");
    let (_, _, human) = check("human");
    assert!(human.contains(" --> a.inc:3:9\n") && human.contains("3 |  radius -1 }"), "{human}");
    let (_, _, json) = check("json");
    assert!(json.contains("\"file_name\":\"a.inc\"") && json.contains("\"line_start\":3"), "{json}");
}

#[test]
fn files_that_cannot_be_included_are_refused() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("a.inc", "include b.inc");
    write("b.inc", "include a.inc");
    write("colours.inc", "");
    write("bytes.inc", "\u{0}");
    std::fs::write(folder.path().join("latin.inc"), b"# f\xfcr alle\n").expect("a file");
    for index in 0..20 {
        write(&format!("deep{index}.inc"), &format!("include deep{}.inc", index + 1));
    }
    let twice = |name: &str| format!("include {name} ").repeat(2);
    for index in 0..12 {
        write(&format!("wide{index}.inc"), &twice(&format!("wide{}.inc", index + 1)));
    }
    write("wide12.inc", "");
    for (file, says) in [
        ("a.inc", "`a.inc` includes itself"),
        ("s.ray", "`s.ray` includes itself"),
        ("colors.inc", "did you mean `colours.inc`?"),
        ("no/such.inc", "cannot read `no/such.inc`"),
        ("bytes.inc", "`bytes.inc` is not text"),
        ("latin.inc", "`latin.inc` is probably encoded in Latin-1"),
        ("deep0.inc", "is one file too many"),
        ("wide0.inc", "is one file too many"),
        ("/dev/zero", "it is a pipe or a device, not a file"),
        (".", "cannot read `.`: "),
    ] {
        let text = format!("{HEAD}include {file}\n");
        write("s.ray", &text);
        let said = refused(folder.path(), "s.ray", &text);
        assert!(said.contains(says), "{file}: {said}");
    }
}

#[test]
fn what_is_set_is_checked_like_the_text_and_marked_in_the_option() {
    let folder = folder();
    let text = format!("{HEAD}let r 2\nsphere ball {{ material m center 0 0 -4 radius \"r\" }}\n");
    fs::write(folder.path().join("a.ray"), &text).expect("a file");
    fs::write(
        folder.path().join("a.toml"),
        "[let]\nr = 2\n".to_owned() + &dump::scene(&model(&text), Syntax::Toml),
    )
    .expect("a file");
    let dumped = |scene: &str, sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let (status, out, err) = outcome(tabray(&folder).args(["dump", scene, "--format", "ray"]).args(sets));
        (status, String::from_utf8_lossy(&out).into_owned(), err)
    };
    for scene in ["a.ray", "a.toml"] {
        for (sets, line) in [
            (&["ball.radius=3"][..], "radius   3\n"),
            (&["sphere.ball.radius=\"2*r\""], "radius   4\n"),
            (&["ball.radius=5", "ball.radius=6"], "radius   6\n"),
            (&["eye.viewpoint=4 3 7"], "viewpoint 4 3 7\n"),
            (&["eye.accuracy=strict"], "accuracy  strict\n"),
            (&["m.ambient=1 2 3", "r=9"], "ambient 1 2 3\n"),
        ] {
            let (status, out, err) = dumped(scene, sets);
            assert!(status == 0 && out.contains(line), "{scene} {sets:?}: {out}{err}");
        }
        for (set, says) in [
            ("ball.radius=-3", "--set:1:13\n"),
            ("ball.radius=-3", "must be positive, not -3"),
            ("ball.raduis=3", "did you mean `radius`?"),
            ("bal.radius=3", "did you mean `ball`?"),
            ("ball.radius=1 2", "takes 1 number, not 2"),
            ("ball.material=n", "there is no material `n`"),
            ("ball.radius=\"q\"", "unknown name `q` in a formula"),
            ("eye.accuracy=strct", "did you mean `strict`?"),
            ("q=3", "the scene has no number `q`"),
            ("r=", "takes 1 value, not 0"),
            ("r=x", "`x` is not a number"),
            ("r", "`r` sets no value"),
            ("ball.radius=}", "stray `}`"),
            ("ball.radius=\"1", "missing closing quote"),
        ] {
            let (status, _, err) = dumped(scene, &[set]);
            assert!(status == 2 && err.contains(says), "{scene} {set}: {err}");
        }
    }
    let (_, out, _) = dumped("a.ray", &["r=7"]);
    assert!(out.contains("radius   7\n"), "{out}");
}

#[test]
fn a_refusal_of_what_is_set_marks_the_option() {
    let folder = folder();
    let plane = "fplane p { material m normal 0 0 1 point 0 0 -4 xdir 1 0 0 dimensions 1 1 }\n";
    fs::write(folder.path().join("a.ray"), format!("{HEAD}{plane}")).expect("a file");
    let (status, _, err) = outcome(tabray(&folder).args(["check", "a.ray", "--set", "p.xdir=0 0 2"]));
    assert!(status == 2 && err.contains("--set:1:3\n") && err.contains("p.xdir=0 0 2"), "{err}");
}

#[test]
fn every_command_that_takes_a_scene_takes_what_is_set() {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), HEAD).expect("a file");
    for args in [
        &["render", "a.ray"][..],
        &["dump", "a.ray"],
        &["convert", "a.ray", "b.toml"],
        &["check", "a.ray"],
        &["plan", "a.ray"],
        &["probe", "a.ray", "0", "0"],
        &["verify", "a.ray"],
        &["chart", "a.ray"],
        &["choose", "a.ray", "--max-error", "1"],
        &["bench", "a.ray"],
    ] {
        let (status, _, err) = outcome(tabray(&folder).args(args).args(["--set", "eye.pixeldim=0 6"]));
        assert!(status == 2 && err.contains("--set:1:14"), "{args:?}: {err}");
    }
}

#[test]
fn choose_prints_what_is_set_in_its_command_line() {
    let folder = folder();
    let text = format!("{HEAD}let r 2\nsphere ball {{ material m center 4 3 -4 radius \"r\" }}\n");
    fs::write(folder.path().join("a.ray"), text).expect("a file");
    let sets = ["--set", "eye.pixeldim=40 30", "--set", "ball.radius=1"];
    let (status, out, err) =
        outcome(tabray(&folder).args(["choose", "a.ray", "--max-error", "50"]).args(sets));
    let out = String::from_utf8_lossy(&out);
    assert!(
        status == 0 && out.contains("render a.ray --set 'eye.pixeldim=40 30' --set ball.radius=1 --"),
        "{out}{err}"
    );
}
