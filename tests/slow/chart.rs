//! Charts of speed against accuracy, checked on scenes whose results are known.

use crate::common::{assert_tells_fields, registry, root, scenes, small};
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use std::cell::LazyCell;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;
use std::time::{Duration, Instant};
use tabray::render::Plan;
use tabray::scene::{self, Model};
use tabray::tools::chart::{self, Chart, Panel, Progress, WrongHitsOf};
use tabray::tools::verify::{self, Verdict};
use tabray::world::Accuracy;
use tempfile::TempDir;

/// A thin disc on a rod, which samples along a ray step over.
const FLANGE: &str = "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 7 7 }
    material m { ambient 2 1 0 diffuse 9 9 9 }
    revsurf flange
    {
        material m profile \"0.3 + 2*exp(-(20*(y-3))^2)\" direction 0 1 0 base 4 0 -4 height 6
    }
    light lamp { location 1 7 3 emissivity 9 9 9 size 0.5 }";

/// A sphere in front of a wall. Only its edge needs more than one sample.
const EDGE: &str = "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
    material white { ambient 8 8 8 }
    material red { ambient 8 0 0 }
    plane wall { material white normal 0 0 1 point 0 0 -2 }
    sphere ball { material red center 4.3 3.1 -1 radius 1.7 }";

/// A [`Progress`] that stops the measurement after this many units of work.
struct Patience(usize);

impl Progress for Patience {
    fn more(&mut self, _units: usize) {}

    fn done(&mut self, units: usize) -> ControlFlow<()> {
        self.0 = self.0.saturating_sub(units);
        if self.0 == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn measured(text: &str, patience: usize) -> Chart {
    let load = |accuracy: Option<Accuracy>| -> io::Result<Model> {
        let loaded = scene::read(registry(), "scene", Path::new(""), text.as_bytes(), accuracy);
        Ok(loaded.map_err(|report| io::Error::other(report.to_string()))?.model)
    };
    chart::measure("scene", &load, &mut Patience(patience)).expect("a chart")
}

/// The chart of the sphere in front of a wall, for all tests that look at it.
static OF_EDGE: LazyLock<Chart> = LazyLock::new(|| measured(EDGE, usize::MAX));

fn panel<'c>(chart: &'c Chart, part: &str) -> &'c Panel {
    chart
        .panels
        .iter()
        .find(|panel| panel.title.contains(part))
        .unwrap_or_else(|| panic!("a panel of {part}"))
}

fn wrong(panel: &Panel, name: &str) -> usize {
    let point = panel.points.iter().find(|point| point.name == name);
    point.unwrap_or_else(|| panic!("{name} in {}", panel.title)).wrong.count()
}

fn error(panel: &Panel, name: &str) -> f64 {
    let point = panel.points.iter().find(|point| point.name == name);
    point.unwrap_or_else(|| panic!("{name} in {}", panel.title)).error
}

#[test]
fn wrong_hits_are_counted_where_methods_have_them_and_the_default_has_none() {
    let chart = measured(FLANGE, usize::MAX);
    assert!(chart.is_whole);
    let grazing = panel(&chart, "flange: grazing rays");
    for name in ["classic", "steps of 0.1", "64 + Newton", "16 + turning points"] {
        assert!(wrong(grazing, name) > 20, "{name}: {}", wrong(grazing, name));
    }
    for panel in chart.panels.iter().filter(|panel| panel.title.starts_with("flange")) {
        for name in ["draft", "exact", "strict", "intervals", "Taylor bounds"] {
            assert_eq!(wrong(panel, name), 0, "{name}, {}", panel.title);
        }
        assert!(error(panel, "exact") < 1e-8 && error(panel, "draft") > 1e-8, "{}", panel.title);
    }
    // In the image, the methods that lose no hit change no pixel, and those that lose hits change some.
    let picture = panel(&chart, "by method");
    let changed = |name: &str| {
        picture
            .points
            .iter()
            .find(|point| point.name == name)
            .and_then(|point| point.changed)
            .expect("a count")[0]
    };
    assert_eq!((changed("exact"), changed("intervals")), (0, 0));
    assert!(changed("classic") > 0);
    // The light has a size, so there is a panel of its soft shadows. The chart can be drawn.
    panel(&chart, "soft shadows alone");
    assert!(chart::svg(&chart).expect("a drawing").contains("steps of 0.1: "));
    let png = image::load_from_memory(&chart::png(&chart).expect("a drawing")).expect("a PNG");
    assert!(png.width() >= 1040 && png.height() > 1000, "{} x {}", png.width(), png.height());
}

/// The number of hits of a panel's camera rays.
fn hits(panel: &Panel) -> usize {
    let (_, rest) = panel.note.split_once("rays, ").expect("the rays");
    rest.split_once(" hits").expect("the hits").0.parse().expect("a number")
}

#[test]
fn thin_things_get_rays_aimed_at_them() {
    let wires = "camera eye { pixeldim 160 120 worlddim 8 6 viewpoint 4 3 7 } material m { ambient 1 1 1 }
        repeat i 12 { cylinder wire { material m base \"0.5+0.6*i\" 1 -2 direction 0.1 1 0 height 4 radius 0.01 } }
        plane floor { material m normal 0 1 0 point 0 0 0 }";
    let chart = measured(wires, usize::MAX);
    let found = hits(panel(&chart, "camera rays"));
    assert!(found > 12 * 30, "{found} hits of 12 wires and a floor");
}

#[test]
fn a_chart_of_many_balls_is_whole_within_its_time() {
    let folder = TempDir::new().expect("a folder");
    let balls = "camera eye { pixeldim 320 240 worlddim 8 6 viewpoint 4 3 7 samples 4 }
        material m { ambient 0.3 0.3 0.3 diffuse 3 2 1 }
        repeat i 1600 { sphere ball { material m center \"0.2*(i - 40*floor(i/40))\" \"0.15*floor(i/40)\" -2 radius 0.07 } }
        light lamp { location 1 7 3 emissivity 9 9 9 }";
    std::fs::write(folder.path().join("balls.ray"), balls).expect("a file");
    let args = ["chart", "balls.ray", "-o", "balls.json", "--time-limit", "60s"];
    let output = cargo_bin_cmd!("tabray").current_dir(&folder).args(args).output().expect("it runs");
    let [said, told] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
    assert!(output.status.success(), "{told}");
    assert!(
        !said.contains("Not everything was measured") && said.contains("the whole image"),
        "{said}{told}"
    );
}

/// Tells whether a proof contradicts a hit of any pixel, with each object of a scene alone.
fn is_contradicted(load: &dyn Fn() -> Model) -> bool {
    (0..load().objects.len()).any(|index| {
        let mut model = load();
        model.objects = vec![model.objects.swap_remove(index)];
        let plan = Plan::new(&model);
        let [width, height] = plan.camera.pixels;
        (0..width * height)
            .any(|pixel| verify::pixel(&plan, pixel % width, pixel / width).verdict == Verdict::Contradicted)
    })
}

#[test]
fn no_method_that_proofs_do_not_contradict_has_a_wrong_hit_in_a_chart() {
    let (mut sets, mut classic, mut faults) = (0, 0, Vec::new());
    for path in scenes() {
        let load = |accuracy: Option<Accuracy>| {
            let mut model = small(&path, accuracy);
            let pixels = &mut model.camera.value.pixels;
            *pixels = pixels.map(|side| side.div_ceil(2));
            model
        };
        // As many pairs of camera rays as there are: all pixels that are verified.
        let pairs = [usize::MAX >> 1, 130];
        let counts = chart::wrong_hits(&|accuracy| Ok(load(accuracy)), pairs, &mut Patience(usize::MAX));
        let is_classic_wrong = LazyCell::new(|| is_contradicted(&|| load(Some(Accuracy::Classic))));
        for WrongHitsOf { title, counts } in counts.expect("counts") {
            sets += 1;
            for (name, wrong) in counts {
                let count = match name.as_str() {
                    "exact" | "strict" => wrong.faults(),
                    "draft" => wrong.count(),
                    // The grazing rays of a chart pass edges more closely than any pixel. A proof about an object alone
                    // does not tell its crossings apart.
                    "classic" if title.ends_with("camera rays") => wrong.missed + wrong.invented,
                    _ => 0,
                };
                if name == "classic" && count > 0 {
                    classic += 1;
                }
                if count > 0 && !(name == "classic" && *is_classic_wrong) {
                    faults.push(format!("{}, {title}: {name}: {wrong:?}", path.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(sets > 200 && classic > 10, "{sets} sets, {classic} with hits that the notes' methods lose");
}

/// Rays through the rim of a tube pass through the wall where it is cut off, and hit it inside.
#[test]
fn methods_with_bounds_go_on_behind_a_root_that_is_cut_off() {
    let tube = "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3.6 7 } material m { ambient 1 1 1 }
        cylinder tube { material m base 5 0.9 -3.6 direction -0.7 0.35 0.8 height 2 radius 0.9 open yes }";
    let load = |accuracy: Option<Accuracy>| -> io::Result<Model> {
        let loaded = scene::read(registry(), "scene", Path::new(""), tube.as_bytes(), accuracy);
        Ok(loaded.map_err(|report| io::Error::other(report.to_string()))?.model)
    };
    let sets = chart::wrong_hits(&load, [1000, 2000], &mut Patience(usize::MAX)).expect("counts");
    let mut bounded = 0;
    for WrongHitsOf { title, counts } in sets {
        for (name, wrong) in counts {
            if ["intervals", "Taylor bounds", "exact"].contains(&name.as_str()) {
                assert_eq!(wrong.count(), 0, "{title}: {name}: {wrong:?}");
                bounded += 1;
            }
        }
    }
    assert_eq!(bounded, 6);
}

#[test]
fn sobol_reaches_with_24_samples_what_random_reaches_with_64() {
    let samples = panel(&OF_EDGE, "edges");
    assert!(error(samples, "sobol 24") <= error(samples, "random 64"));
    assert!(error(samples, "random 64") < 0.2 * error(samples, "sobol 1"));
    assert!(
        !OF_EDGE.front(samples)
            [samples.points.iter().position(|point| point.name == "random 64").expect("it")]
    );
}

#[test]
fn what_breaks_off_keeps_what_is_measured() {
    let chart = measured(EDGE, 1_000_000);
    assert!(!chart.is_whole && !chart.panels.is_empty() && chart.panels.len() < 4, "{}", chart.panels.len());
    assert!(chart::words(&chart).ends_with("Not everything was measured: these are the results by then.\n"));
}

/// Returns the errors in a chart's numbers, by panel and choice.
fn errors(numbers: &Value) -> Vec<(String, String, Value)> {
    let panels = numbers["panels"].as_array().expect("panels");
    panels
        .iter()
        .flat_map(|panel| {
            let title = panel["title"].as_str().expect("a title").to_owned();
            panel["points"].as_array().expect("points").iter().map(move |point| {
                let counts = ["error", "worst", "missed", "invented", "later", "visible", "changed"];
                let counts = counts.map(|count| point[count].clone());
                (title.clone(), point["choice"].to_string(), Value::from(counts.to_vec()))
            })
        })
        .collect()
}

#[test]
fn a_chart_has_all_its_files_and_its_errors_are_the_same_twice() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("edge.ray"), EDGE).expect("a file");
    let mut chart = cargo_bin_cmd!("tabray");
    let args = ["chart", "edge.ray", "-o", ".", "--time-limit", "1h"];
    let output = chart.current_dir(folder.path()).args(args).output().expect("the program runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read = |extension: &str| {
        let path = folder.path().join("edge-chart").with_extension(extension);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let [svg, png, csv, json, words] = ["svg", "png", "csv", "json", "txt"].map(read);
    assert!(!svg.is_empty() && !png.is_empty());
    assert_eq!(String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&words));
    assert!(words.starts_with(b"What to do:\n  "), "{}", String::from_utf8_lossy(&words));
    let numbers: Value = serde_json::from_slice(&json).expect("JSON");
    assert_eq!(String::from_utf8_lossy(&csv).lines().count(), 1 + errors(&numbers).len());
    assert_tells_fields("chart", &numbers);
    let again = serde_json::from_str(&chart::json(&OF_EDGE)).expect("JSON");
    assert_eq!(errors(&numbers), errors(&again));
}

#[test]
fn choices_for_an_image_of_few_pixels_are_measured_on_all_of_them() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("few.ray"), EDGE.replace("40 30", "8 6")).expect("a file");
    let mut choose = cargo_bin_cmd!("tabray");
    let chosen = choose.current_dir(folder.path()).args(["choose", "few.ray", "--max-error", "10%"]).output();
    let chosen = chosen.expect("it runs");
    let text = String::from_utf8_lossy(&chosen.stdout);
    assert!(
        text.contains("measured on 48 of 48 pixels"),
        "{text}{}",
        String::from_utf8_lossy(&chosen.stderr)
    );
}

#[test]
fn what_is_chosen_is_a_command_line_that_renders() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("edge.ray"), EDGE).expect("a file");
    let choose = |limit: &[&str]| {
        let mut choose = cargo_bin_cmd!("tabray");
        // A busy machine measures the same, but takes longer.
        let always = ["choose", "edge.ray", "--time-limit", "1h"];
        choose.current_dir(folder.path()).args(always).args(limit).output().expect("it runs")
    };
    let chosen = choose(&["--max-error", "1%"]);
    let text = String::from_utf8(chosen.stdout).expect("UTF-8");
    // All pixels of a small image are measured.
    let said = "\nThe marked choice is the fastest with an error of at most 1 % of white (2.55 levels of 255). \
                Errors are in levels of 255, and were measured on 1200 of 1200 pixels, drawn from all parts of the image; that of \
                the whole image is at most what the table says, with a confidence of 95 %. Choices ";
    assert!(text.contains(said), "{text}");
    let line = text.lines().last().expect("a command line");
    let mut words = line.split(' ');
    assert_eq!(words.next(), Some("tabray"), "{text}");
    let mut render = Command::new(assert_cmd::cargo::cargo_bin!("tabray"));
    assert!(render.current_dir(folder.path()).args(words).status().expect("it runs").success(), "{line}");
    assert!(folder.path().join("edge.png").is_file());
    // One sample is not enough for this error, and the marked line states the error of its choice.
    let marked = text.lines().find(|line| line.starts_with('>')).expect("a marked line");
    let cells: Vec<_> = marked.split_whitespace().collect();
    // The greatest number, where pixels take different ones.
    let most = |cell: &str| cell.rsplit("..").next()?.parse::<u32>().ok();
    assert!(most(cells[2]).is_some_and(|samples| samples > 1), "{text}");
    assert!(cells[3..5].iter().all(|error| error.parse::<f64>().is_ok_and(|error| error <= 2.55)), "{text}");
    // What is chosen rests on counts, not on times.
    let samples = |text: &str| {
        let marked = text.lines().find(|line| line.starts_with('>'))?;
        // All columns before the two of times.
        Some(marked.split_whitespace().take(6).map(str::to_owned).collect::<Vec<_>>())
    };
    for _ in 0..3 {
        let again = String::from_utf8(choose(&["--max-error", "1%"]).stdout).expect("UTF-8");
        assert_eq!(samples(&again), samples(&text), "{again}");
    }
    let worst = String::from_utf8(choose(&["--max-error", "1%", "--worst"]).stdout).expect("UTF-8");
    let number = |text: &str| most(&samples(text)?[2]);
    assert!(number(&worst) > number(&text), "the worst pixels are worse than the mean: {worst}");

    let never = |options: &[&str]| {
        let never = choose(options);
        assert_eq!(never.status.code(), Some(1));
        String::from_utf8_lossy(&never.stderr).into_owned()
    };
    let said = never(&["--max-error", "1e-10%"]);
    let start = "error: no choice was measured to have an error of at most 1e-10 % of white (2.55e-10 levels of 255); the nearest is \
                 `--samples ";
    assert!(said.starts_with(start), "{said}");
    let said = never(&["--max-error", "1e-10%", "--certain"]);
    let start = "error: no choice is certain to have an error of at most 1e-10 % of white (2.55e-10 levels of 255); the least bound is ";
    assert!(said.starts_with(start), "{said}");
    // A bound takes in what may lie in the pixels that are not measured.
    let bounded = String::from_utf8(choose(&["--max-error", "1%", "--certain"]).stdout).expect("UTF-8");
    assert!(
        bounded.contains("by a bound with a confidence of 99 %") && samples(&bounded).is_some(),
        "{bounded}"
    );
    let text = String::from_utf8(choose(&["--max-time", "1000"]).stdout).expect("UTF-8");
    let times = text.lines().find(|line| line.starts_with("It takes ")).expect("a line of times");
    assert!(times.contains(" of CPU time for ") && times.contains(" rays of all kinds"), "{text}");
    assert!(text.contains("\nThe marked choice is the one with the least error within 1000 s on "), "{text}");
    let said = never(&["--max-time", "1e-9"]);
    let least =
        said.strip_prefix("error: no choice is sure to take at most 0.000000001 s; the fastest may take ");
    let least = least.and_then(|least| least.strip_suffix(" s\n")?.parse::<f64>().ok());
    assert!(least.is_some_and(|least| least > 0.0), "{said}");
    for wrong in
        [&["--max-error", "0"][..], &["--max-error", "0.01"], &[], &["--max-time", "1", "--max-error", "1"]]
    {
        assert_eq!(choose(wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn the_number_of_rays_that_is_stated_is_what_the_render_counts() {
    let folder = TempDir::new().expect("a folder");
    let mirror = "material mirror { ambient 1 0 0 diffuse 2 0 0 specular 0.5 }
        light lamp { location 1 7 3 emissivity 9 9 9 } sphere";
    std::fs::write(
        folder.path().join("edge.ray"),
        EDGE.replacen("sphere", mirror, 1).replace("red center", "mirror center"),
    )
    .expect("a file");
    let run = |args: &[&str]| {
        let mut tabray = cargo_bin_cmd!("tabray");
        let output = tabray.current_dir(folder.path()).args(args).output().expect("it runs");
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned())
    };
    // So long that what is chosen does not depend on the clock.
    let [said, _] = run(&["choose", "edge.ray", "--max-time", "1000", "--time-limit", "1h"]);
    let (stated, _) = said.split_once(" rays of all kinds").expect("a number of rays");
    let mut words = stated.rsplit(' ');
    let unit = match words.next() {
        Some("thousand") => 1e3,
        Some("million") => 1e6,
        other => panic!("{other:?}: {said}"),
    };
    let stated = unit * words.next().and_then(|number| number.parse::<f64>().ok()).expect("a number");
    let mut render: Vec<_> = said.lines().last().expect("a command line").split(' ').skip(1).collect();
    render.push("--stats");
    let [_, stats] = run(&render);
    let cast = |kind: &str| {
        let line = stats.lines().find(|line| line.starts_with(kind)).unwrap_or_else(|| panic!("{stats}"));
        line.rsplit(' ').next().and_then(|count| count.parse::<f64>().ok()).expect("a count")
    };
    let counted: f64 = ["primary", "shadow", "reflected", "transmitted"].map(cast).iter().sum();
    // One sample in each pixel was counted, in its middle, and the render takes many.
    assert!(cast("reflected") > 0.0 && (stated / counted - 1.0).abs() < 0.02, "{stated} of {counted}");
}

/// Makes a scene with a mesh of many triangles, whose every pixel is expensive for methods that take rays one by one.
fn net(folder: &Path) {
    let side = 33;
    let mut text = String::new();
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        text += &format!(
            "v {} {} {}\n",
            f64::from(x) / 4.0,
            f64::from(y) / 5.0,
            f64::from((x * 7 + y * 5) % 11) / 20.0
        );
    }
    for (x, y) in (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| (x, y))) {
        let corner = |x: i32, y: i32| y * side + x + 1;
        text += &format!("f {} {} {}\n", corner(x, y), corner(x + 1, y), corner(x + 1, y + 1));
        text += &format!("f {} {} {}\n", corner(x, y), corner(x + 1, y + 1), corner(x, y + 1));
    }
    std::fs::write(folder.join("net.obj"), text).expect("a file");
    let scene = "camera eye { pixeldim 320 240 worlddim 8 6 viewpoint 4 3 7 } material m { ambient 1 1 1 diffuse 4 4 4 }
        light lamp { location 1 7 3 emissivity 5 5 5 size 0.5 }
        mesh net { material m file net.obj }";
    std::fs::write(folder.join("net.ray"), scene).expect("a file");
}

#[test]
fn choosing_ends_in_time_on_a_mesh_of_2048_triangles() {
    let folder = TempDir::new().expect("a folder");
    net(folder.path());
    let mut choose = cargo_bin_cmd!("tabray");
    let start = Instant::now();
    let output = choose.current_dir(folder.path()).args(["choose", "net.ray", "--max-error", "5"]).output();
    let output = output.expect("it runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    // Ten seconds, and what the machine's other work takes.
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
    assert!(text.lines().any(|line| line.starts_with('>')), "{text}");
}

/// A light that goes from mirror to mirror could meet any ball after any other, and bounds on it have a limit of work.
#[test]
fn choosing_answers_where_1600_balls_mirror_each_other() {
    let folder = TempDir::new().expect("a folder");
    let scene = "look_at eye { pixeldim 320 240 position 0 12 30 target 0 0 0 angle 45 }
        material m { diffuse 0.7 0.6 0.5 specular 0.1 shininess 40 } plane floor { material m normal 0 1 0 point 0 -0.5 0 }
        repeat i 40 { repeat j 40 { sphere s { material m center \"i-19.5\" 0 \"j-19.5\" radius 0.4 } } }
        light lamp { location 3 15 6 emissivity 0.9 0.9 0.9 }";
    std::fs::write(folder.path().join("balls.ray"), scene).expect("a file");
    let mut choose = cargo_bin_cmd!("tabray");
    let args = ["choose", "balls.ray", "--max-error", "3", "--time-limit", "2m"];
    let output = choose.current_dir(folder.path()).args(args).output().expect("it runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.lines().any(|line| line.starts_with('>')), "{text}");
}

#[test]
fn a_chart_ends_near_its_time_limit_and_shows_what_it_has() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("flange.ray"), FLANGE.replace("64 48", "640 480")).expect("a file");
    let mut chart = cargo_bin_cmd!("tabray");
    let start = Instant::now();
    let args = ["chart", "flange.ray", "-o", ".", "--time-limit", "4s"];
    let output = chart.current_dir(folder.path()).args(args).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        // Which panel is complete first depends on the machine; each has its methods and its fastest ones.
        assert!(text.contains("Pareto front: "), "{text}");
        // A fast machine has a complete chart, though a coarse one.
        let is_short = said.contains("there was not enough time for all of the chart");
        assert_eq!(text.contains("Not everything was measured"), is_short, "{text}{said}");
    } else {
        // On a machine with much other work.
        assert!(said.contains("nothing is measured yet"), "{said}");
    }
    let mut chart = cargo_bin_cmd!("tabray");
    let args = ["chart", "flange.ray", "-o", ".", "--time-limit", "1ms"];
    let output = chart.current_dir(folder.path()).args(args).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    // While the scene is read, as most often, or later.
    match output.status.code() {
        Some(130) => assert_eq!(said, "the time limit of 1ms has been reached\n"),
        code => {
            assert_eq!(code, Some(1), "{said}");
            assert!(said.contains("the time limit has been reached, and nothing is measured yet"), "{said}");
        }
    }
}

#[test]
fn the_program_refuses_a_folder_that_cannot_be_made() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("file"), "precious").expect("a file");
    let scene = root().join("scenes/camera/one-pixel.ray");
    let mut chart = cargo_bin_cmd!("tabray");
    let output = chart.current_dir(folder.path()).arg("chart").arg(scene).args(["-o", "file"]).output();
    let output = output.expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    let said = "error: cannot create the folder `file`: a file of this name exists\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), said);
}
