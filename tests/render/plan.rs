//! No more work than a scene needs: the plan says so, and the counts of rays and tests show it.

use crate::common;
use crate::common::{model, model_in, registry, root, scenes, small, snapshots};
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use tabray::render::RayKind::{Primary, Reflected, Shadow, Transmitted};
use tabray::render::{Plan, RayStats, TestCounts, decisions, trace};
use tabray::scene::{self, Model};
use tabray::simd::Cpu;
use tabray::tools::threads::renderer_with;
use tabray::world::Accuracy;
use tempfile::TempDir;

/// Counts the rays and tests of a scene's image of 40 x 30 pixels.
fn counted(entities: &str) -> (Model, RayStats) {
    let camera = "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 7 }
        material matt { ambient 1 1 1 diffuse 2 2 2 }
        material mirror { specular 0.5 }
        material glass { diffuse 1 2 1 transparency 0.5 }";
    let model = model(&format!("{camera}\n{entities}"));
    let tally = count(&model, 2);
    (model, tally)
}

fn count(model: &Model, threads: usize) -> RayStats {
    let sum = Mutex::new(RayStats::default());
    let add = |part: RayStats| sum.lock().expect("no thread panics").add(&part);
    let renderer = renderer_with(threads).expect("threads");
    let plan = Plan::new(model);
    let [width, height] = plan.camera.pixels;
    let bands = renderer.bands(&plan, 0..width, 0..height, &add);
    let pixels: Vec<u8> = bands.flat_map(|band| band.bytes(usize::MAX).concat()).collect();
    assert_eq!(pixels, renderer.picture(&plan), "watching changes nothing");
    sum.into_inner().expect("no thread panics")
}

fn text(model: &Model) -> String {
    decisions::of(&Plan::for_picture(model)).iter().map(|decision| format!("{decision}\n")).collect()
}

/// Returns the line of a scene's plan about a subject.
fn line(model: &Model, subject: &str) -> String {
    let text = text(model);
    let line = text.lines().find(|line| line.split_whitespace().next() == Some(subject));
    line.unwrap_or_else(|| panic!("nothing about {subject} in {text}")).to_owned()
}

const FLOOR: &str = "plane floor { material matt normal 0 1 0 point 0 0 0 }";
const LAMP: &str = "light lamp { location 1 7 2 emissivity 5 5 5 }";
const PIXELS: u64 = 40 * 30;

#[test]
fn no_shadow_rays_are_cast_without_lights() {
    let (dark, tally) = counted(FLOOR);
    assert_eq!([Primary, Shadow].map(|kind| tally.rays(kind)), [PIXELS, 0]);
    assert!(line(&dark, "lights").contains("none: ") && !text(&dark).contains("shadows "));
    let (lit, tally) = counted(&format!("{FLOOR} {LAMP}"));
    let plan = Plan::new(&lit);
    let hits = (0..30).flat_map(|y| (0..40).map(move |x| (x, y)));
    let hits = hits.filter(|(x, y)| trace::pixel(&plan, *x, *y).max_element() > 0.0).count() as u64;
    assert!(hits > PIXELS / 3);
    assert_eq!(tally.rays(Shadow), hits, "one shadow ray starts from each visible point of the floor");
    assert!(line(&lit, "lights").contains("`lamp`"));
    let (_, tally) = counted(&format!("{FLOOR} {LAMP} light other {{ location 7 7 2 emissivity 5 5 5 }}"));
    assert_eq!(tally.rays(Shadow), 2 * hits);
    let (_, tally) = counted(&format!("{FLOOR} light below {{ location 1 -7 2 emissivity 5 5 5 }}"));
    assert_eq!(tally.rays(Shadow), 0, "no point of the floor faces the light");
}

#[test]
fn no_rays_are_reflected_without_mirrors() {
    let (matt, tally) =
        counted(&format!("{FLOOR} {LAMP} sphere ball {{ material matt center 4 2 -4 radius 2 }}"));
    assert_eq!(tally.rays(Reflected), 0);
    assert!(line(&matt, "mirrors").contains("none: "));
    let wall = "plane wall { material mirror normal 0 0 1 point 0 0 -4 }";
    let behind = "sphere behind { material matt center 4 3 20 radius 1 }";
    let (mirror, tally) = counted(&format!("{wall} {behind}"));
    assert_eq!(tally.rays(Reflected), PIXELS, "the wall reflects every ray, nearly always into empty space");
    assert!(line(&mirror, "mirrors").contains("`wall`"));
    let (_, tally) = counted(wall);
    assert_eq!(tally.rays(Reflected), 0, "there is nothing for the wall to reflect");
}

#[test]
fn no_rays_are_transmitted_without_glass() {
    let (opaque, tally) = counted(&format!("{FLOOR} {LAMP}"));
    assert_eq!(tally.rays(Transmitted), 0);
    assert!(line(&opaque, "glass").contains("none: ") && line(&opaque, "shadows").contains("opaque"));
    let pane = "plane pane { material glass normal 0 0 1 point 0 0 -4 }";
    let (_, tally) = counted(&format!("{LAMP} {pane}"));
    assert_eq!(tally.rays(Transmitted), 0, "there is nothing behind it");
    let behind = "sphere behind { material matt center 4 3 -20 radius 1 }";
    let (pane, tally) = counted(&format!("{LAMP} {pane} {behind}"));
    assert_eq!(tally.rays(Transmitted), PIXELS);
    assert!(line(&pane, "glass").contains("`pane`") && line(&pane, "shadows").contains("tinted"));
}

#[test]
fn samples_multiply_the_primary_rays_exactly() {
    for samples in [1, 2, 3, 16, 70] {
        let mut model = model(&format!(
            "camera eye {{ pixeldim 21 13 worlddim 8 6 viewpoint 4 3 7 samples {samples} }}
             material matt {{ ambient 1 1 1 }} {FLOOR}"
        ));
        assert_eq!(count(&model, 2).rays(Primary), 21 * 13 * samples);
        model.camera.value.pixels = [1, 1];
        assert_eq!(count(&model, 2).rays(Primary), samples);
    }
}

#[test]
fn what_scatters_no_light_casts_no_shadow_rays() {
    let floor = |look: &str| {
        format!(
            "material polished {{ {look} }} plane floor {{ material polished normal 0 1 0 point 0 0 0 }} {LAMP}"
        )
    };
    let (_, tally) = counted(&floor("ambient 1 1 1 specular 0.5"));
    assert_eq!(tally.rays(Shadow), 0, "a mirror without a glint");
    let (_, tally) = counted(&floor("ambient 1 1 1 shininess 20"));
    assert_eq!(tally.rays(Shadow), 0, "a glint of nothing");
    let (_, tally) = counted(&floor("specular 0.5 shininess 20"));
    assert!(tally.rays(Shadow) > 0, "a glint");
    let (lit, tally) = counted(&floor("diffuse 0 0 1"));
    assert!(tally.rays(Shadow) > 0);
    assert!(line(&lit, "lights").contains("each point that faces it and reflects its light"));
}

#[test]
fn three_planes_are_a_list_and_rays_that_lead_away_from_one_are_not_tested_with_it() {
    let (model, tally) = counted(&format!(
        "{FLOOR} plane left {{ material matt normal 1 0 0 point 0 0 0 }}
         plane back {{ material matt normal 0 0 1 point 0 0 -9 }}"
    ));
    assert!(line(&model, "search").contains("a list of 3 objects: none has bounds"));
    let TestCounts { objects, tested, culled } = tally.tests(&model)["plane"];
    assert_eq!((objects, tested + culled), (3, 3 * PIXELS), "each ray is either tested or culled");
    // All rays lead toward the back wall, half of them downward and half of them to the left, with a quarter in both
    // halves.
    assert!((2 * PIXELS..5 * PIXELS / 2).contains(&tested), "{tested}");
}

#[test]
fn a_sphere_in_a_corner_is_hardly_ever_tested() {
    let (model, tally) =
        counted(&format!("{FLOOR} sphere ball {{ material matt center 0.5 0.5 -1 radius 0.4 }}"));
    let TestCounts { tested, culled, .. } = tally.tests(&model)["sphere"];
    assert_eq!(tested + culled, PIXELS, "each ray is either tested or culled");
    assert!(tested > 0 && tested < PIXELS / 10, "{tested}");
    let TestCounts { tested, culled, .. } = tally.tests(&model)["plane"];
    assert!(tested + culled == PIXELS && tested < 3 * PIXELS / 4, "{tested} lead down");
    assert!(line(&model, "search").contains("a list of 2 objects, 1 with bounds"));
}

#[test]
fn many_spheres_are_in_a_tree_and_few_of_them_are_tested() {
    let spheres: String = (0..400)
        .map(|index| {
            let (x, y, z) =
                (0.4 * f64::from(index % 20), 0.3 * f64::from(index / 20), -1.0 - f64::from(index % 7));
            format!("sphere s{index} {{ material matt center {x} {y} {z} radius 0.1 }}\n")
        })
        .collect();
    let (model, tally) = counted(&format!("{FLOOR} {LAMP} {spheres}"));
    let search = line(&model, "search");
    assert!(
        search.contains("for the 400 objects with bounds") && search.contains("a list of the 1 without"),
        "{search}"
    );
    let TestCounts { objects, tested, .. } = tally.tests(&model)["sphere"];
    assert_eq!(objects, 400);
    assert!(
        tested > 0 && tested < tally.all_rays() * 400 / 10,
        "{tested} tests of {} rays",
        tally.all_rays()
    );
}

#[test]
fn no_ray_is_counted_twice() {
    for path in scenes() {
        let model = small(&path, None);
        let tally = count(&model, 2);
        for (name, TestCounts { objects, tested, culled }) in tally.tests(&model) {
            assert!(tested + culled <= tally.all_rays() * objects, "{name} in {}", path.display());
        }
        assert_eq!(count(&model, 1), tally, "{}: counts depend on the threads", path.display());
    }
}

#[test]
fn plans_are_as_before() {
    let settings = snapshots("plan");
    settings.bind(|| {
        for scene in [
            "gallery/marbles",
            "gallery/stained-glass",
            "notes/three-planes",
            "projector/shadow",
            "texture/never-used",
            "camera/samples",
            "entities/revsurf",
            "entities/torus",
        ] {
            let model = common::load(&root().join("scenes").join(scene).with_extension("ray"));
            insta::assert_snapshot!(scene.replace('/', "-"), text(&model));
        }
        let classic = fs::read(root().join("scenes/entities/revsurf.ray")).expect("a scene");
        let accuracy = Some(Accuracy::Classic);
        let classic = scene::read(registry(), "revsurf.ray", Path::new(""), &classic, accuracy);
        insta::assert_snapshot!("classic", text(&classic.unwrap_or_else(|report| panic!("{report}")).model));
    });
}

#[test]
fn a_parabola_is_one_slab_and_a_vase_is_many() {
    let slabs = |profile: &str| {
        let (model, _) = counted(&format!(
            "revsurf r {{ material matt profile \"{profile}\" direction 0 1 0 base 4 0 -4 height 4 }}"
        ));
        let line = line(&model, "revsurf");
        let number = line.split_whitespace().zip(line.split_whitespace().skip(1));
        let mut number = number.filter(|(_, noun)| noun.starts_with("slab")).map(|(number, _)| number);
        number.next().expect("a number of slabs").parse::<usize>().expect("a number")
    };
    assert_eq!([slabs("1"), slabs("2 - 0.4 * y"), slabs("sqrt(5 - y)")], [1; 3]);
    assert!(slabs("1 + 0.3 * sin(9 * y)") > 10);
}

#[test]
fn a_texture_is_read_once_before_the_first_ray_and_never_if_nothing_uses_it() {
    let folder = TempDir::new().expect("a folder");
    let file = folder.path().join("bricks.png");
    fs::copy(root().join("scenes/textures/bricks.png"), &file).expect("a copy");
    let wall = |name: &str, x: f64| {
        format!(
            "texplane {name} {{ material m texname {name} mode 0 normal 0 0 1 point {x} 0 -4 xdir 1 0 0 dimensions 3 3 }}"
        )
    };
    let model = model_in(
        folder.path(),
        &format!(
            "camera eye {{ pixeldim 40 30 worlddim 8 6 viewpoint 4 3 7 }} material m {{ ambient 9 9 9 }}
             texture one {{ filename bricks.png }} texture two {{ filename bricks.png }}
             texture missing {{ filename no/such/file.png }} {} {}",
            wall("one", 0.0),
            wall("two", 4.0)
        ),
    );
    fs::remove_file(&file).expect("a file");
    let [one, two, missing] = [0, 1, 2].map(|index| &model.textures[index].value);
    let [one, two] = [one, two].map(|texture| std::ptr::from_ref(texture.load().expect("read before")));
    assert_eq!(one, two, "one picture in memory for two names of one file");
    assert!(common::render(&model).pixels().any(|pixel| pixel.0[0] > 2 * pixel.0[2]), "bricks are seen");
    assert!(missing.load().is_err());
    assert!(text(&model).contains("`missing` is not read: nothing uses it"), "{}", text(&model));
}

/// Runs the program in a new folder; returns its status, standard output and standard error.
fn outcome(args: &[&str]) -> (i32, String, String) {
    let folder = TempDir::new().expect("a folder");
    let output = cargo_bin_cmd!("tabray").current_dir(folder.path()).args(args).output().expect("it runs");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap_or(-1), text(&output.stdout), text(&output.stderr))
}

fn file(scene: &str) -> String {
    root().join("scenes").join(scene).display().to_string()
}

#[test]
fn plan_prints_every_decision_and_the_instructions() {
    let (status, out, err) = outcome(&["plan", &file("gallery/marbles.ray")]);
    assert_eq!((status, err.as_str()), (0, ""));
    for subject in ["image", "accuracy", "lights", "shadows", "glass", "mirrors", "search", "instructions"] {
        assert!(out.lines().any(|line| line.starts_with(&format!("{subject} "))), "{subject}: {out}");
    }
    let (_, classic, _) = outcome(&["plan", &file("gallery/marbles.ray"), "--method", "classic"]);
    assert!(classic.contains("none has bounds"), "{classic}");
    assert_eq!(outcome(&["plan", &file("wrong/zero-radius.ray")]).0, 2);
    assert_eq!(outcome(&["plan", "no-such-scene.ray"]).0, 1);
}

#[test]
fn statistics_go_to_standard_error_and_change_nothing_else() {
    let scene = file("material/mirror.ray");
    let plain = outcome(&["render", &scene, "-o", "-"]);
    let (status, out, err) = outcome(&["render", &scene, "-o", "-", "--stats", "json"]);
    assert_eq!((status, out), (0, plain.1));
    let stats: Value = serde_json::from_str(&err).expect("one object and nothing else");
    assert_eq!(stats["rays"]["primary"], 160 * 120);
    assert_eq!(stats["rays"]["transmitted"], 0);
    assert!(stats["rays"]["reflected"].as_u64() > Some(0), "{err}");
    let model = common::load(Path::new(&scene));
    let tally = count(&model, 1);
    for (name, tests) in tally.tests(&model) {
        assert_eq!(stats["tests"][name]["tested"], tests.tested, "{name}");
        assert_eq!(stats["tests"][name]["culled"], tests.culled, "{name}");
        assert_eq!(stats["tests"][name]["objects"], tests.objects, "{name}");
    }
    for stage in ["reading", "building", "rendering", "writing"] {
        assert!(stats["seconds"][stage].as_f64() >= Some(0.0), "{stage}: {err}");
    }
    if cfg!(target_os = "linux") {
        // The peak is at least the image itself, and less than a machine has.
        assert!((160 * 120 * 3..1 << 34).contains(&stats["peak_memory"].as_u64().expect("bytes")), "{err}");
    }

    let (status, _, err) = outcome(&["render", "--stats=json", &scene, "-o", "-"]);
    assert!(status == 0 && serde_json::from_str::<Value>(&err).is_ok(), "{err}");

    let (status, _, err) = outcome(&["render", "-o", "a.png", "--stats", &scene]);
    assert_eq!(status, 0, "{err}");
    for word in
        ["primary", "shadow", "reflected", "transmitted", "tested", "culled", "rendering", "wrote a.png"]
    {
        assert!(err.contains(word), "{word}: {err}");
    }
}

/// Renders three panes half a unit apart, which reflect this fraction of the light, in a new folder. Returns the
/// statistics and the other messages.
fn panes(specular: &str, method: &str) -> (Value, String) {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("pane.ray");
    let pane = |index: usize, z: f64| format!("plane p{index} {{ material g normal 0 0 1 point 0 0 {z} }}");
    let panes =
        [-1.0, -1.5, -2.0].into_iter().enumerate().map(|(index, z)| pane(index, z)).collect::<String>();
    let scene = format!(
        "camera c {{ pixeldim 3 3 worlddim 8 6 viewpoint 4 3 6 }}
         material g {{ ambient 0.5 0.6 0.7 diffuse 1 1 1 specular {specular} transparency 0.5 }} {panes}"
    );
    fs::write(&path, scene).expect("a file");
    let args = ["render", &path.display().to_string(), "-o", "-", "--method", method, "--stats", "json"];
    let (status, _, err) = outcome(&args);
    assert_eq!(status, 0, "{err}");
    let (said, stats) = err.trim_end().rsplit_once('\n').unwrap_or(("", &err));
    (serde_json::from_str(stats).expect("an object"), said.to_owned())
}

#[test]
fn pixels_that_are_cut_off_are_counted_and_told_of_with_what_they_lack() {
    let (stats, said) = panes("0.1", "exact");
    assert_eq!((stats["cut"]["pixels"].as_u64(), said.as_str()), (Some(0), ""));
    let rays = stats["rays"]["reflected"].as_u64();
    assert!(rays < Some(2000), "{rays:?}");
    // The notes' method leaves out nothing.
    let (stats, said) = panes("0.4", "classic");
    let levels = stats["cut"]["levels"].as_f64().expect("a bound");
    assert!(stats["cut"]["pixels"].as_u64() > Some(0) && levels > 0.1 && levels < 255.0, "{stats}");
    assert!(said.starts_with("warning: ") && said.contains("the work of 20000 simple rays"), "{said}");
    assert!(said.contains("off by at most ") && said.contains("of 255 levels"), "{said}");
    // More light is reflected than arrives.
    let (stats, said) = panes("1", "exact");
    assert!(stats["cut"]["pixels"].as_u64() > Some(0) && stats["cut"]["levels"].is_null(), "{stats}");
    assert!(said.contains("nothing bounds"), "{said}");
}

#[test]
fn a_plan_says_how_deep_rays_are_followed() {
    let pane = "plane wall { material matt normal 0 0 1 point 0 0 -9 }
        plane one { material glass normal 0 0 1 point 0 0 -4 }";
    let depth = |entities: &str| line(&counted(entities).0, "depth");
    assert!(!text(&counted(FLOOR).0).contains("depth "), "no ray goes on");
    let bounded = depth(pane);
    assert!(
        bounded.contains("1/1024 of a level") && bounded.contains("the work of 20000 simple ones"),
        "{bounded}"
    );
    let mirrors = format!(
        "{FLOOR} material all {{ specular 1 }} plane a {{ material all normal 0 0 1 point 0 0 -4 }}
        plane b {{ material all normal 0 1 0 point 0 9 0 }}"
    );
    assert!(depth(&mirrors).contains("as much light as they receive"), "{}", depth(&mirrors));
    let touched = depth(&format!("{pane} light l {{ location 4 3 -9 emissivity 1 1 1 }}"));
    assert!(touched.contains("`wall` may have any brightness"), "{touched}");
}

#[test]
fn instructions_are_chosen_among_those_that_are_there() {
    let scene = file("gallery/stained-glass.ray");
    let render = |cpu: &str| {
        let args = ["render", &scene, "--size", "32", "-o", "a.png", "--cpu", cpu, "--stats", "json"];
        let (status, _, err) = outcome(&args);
        (status, err)
    };
    for cpu in ["baseline", "avx2", "avx512"] {
        let (status, err) = render(cpu);
        if Cpu::all().any(|here| here.to_string() == cpu) {
            assert_eq!(status, 0, "{err}");
        } else {
            assert_eq!(status, 2);
            assert!(err.contains("this machine does not have") && err.contains("`--cpu baseline`"), "{err}");
        }
    }
    assert_eq!(render("mmx").0, 2);
}
