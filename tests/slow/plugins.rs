//! Plugins dropped into a copy of the package: those that the docs show, those that `tabray new` writes, and some with
//! mistakes, whose messages the docs quote; and a separate crate with a plugin of its own.

use super::copy::{self, Built, Files};
use crate::common::{block_with, root, snapshots};
use image::RgbImage;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use tempfile::TempDir;

fn text_of(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect("a text")
}

fn readme() -> String {
    text_of("README.md")
}

fn page() -> String {
    text_of("docs/plugins.md")
}

/// Returns the plugin that docs/plugins.md begins with.
fn brick() -> String {
    block_with(&page(), "struct Brick")
}

/// Returns the number of the line at which a plugin's text registers it.
fn line(text: &str) -> usize {
    1 + text.lines().position(|line| line.contains("Entity::shape(")).expect("it registers a shape")
}

/// The files that are dropped in, by their paths.
static PLUGINS: LazyLock<Files> = LazyLock::new(|| {
    // This plugin asks for an attribute that is not in its table.
    let forgetful = brick().replace("&[&CENTER, &SIZE]", "&[&CENTER]").replace("\"brick\"", "\"block\"");
    // This plugin reads three numbers as one.
    let confused = brick()
        .replace(
            "const TABLE",
            "static WIDE: Pparm<f64> = Pparm::required(\"size\", \"its width\");\n\nconst TABLE",
        )
        .replace("0.5 * args.get(&SIZE)", "DVec3::splat(0.5 * args.get(&WIDE))")
        .replace("\"brick\"", "\"slab\"");
    let plugins = [
        ("ring", block_with(&readme(), "struct Ring")),
        ("brick", brick()),
        ("block", forgetful),
        ("slab", confused),
        ("barrel", BARREL.to_owned()),
        ("stripes", STRIPES.to_owned()),
        ("pill", PILL.to_owned()),
        ("dented", DENTED.to_owned()),
        ("empty", String::new()),
    ];
    let mut files = Files::new();
    for (name, text) in plugins {
        files.insert(plugin(name), text.into_bytes());
    }
    files.insert(PathBuf::from("src/bin/contracts.rs"), CONTRACTS.into());
    files.insert(PathBuf::from("src/bin/rival.rs"), RIVAL.into());
    files.insert(PathBuf::from("src/bin/twin.rs"), TWIN.into());
    files.extend(NEW.iter().map(|(path, bytes)| (path.clone(), bytes.clone())));
    files
});

fn plugin(name: &str) -> PathBuf {
    Path::new("plugins").join(name).with_extension("rs")
}

/// The plugins that `tabray new plugin` writes, by their kinds, and the scenes that show them.
const KINDS: [(&str, &str, &str); 5] = [
    ("shape", "loop", "scenes/entities/loop.ray"),
    ("light", "shade", "scenes/entities/shade.ray"),
    ("camera", "globe", "scenes/entities/globe.ray"),
    ("shader", "rings", "scenes/entities/rings.ray"),
    ("profile", "ringed_cup", "scenes/revsurf/ringed_cup.ray"),
];

/// All files that `tabray new plugin` writes for them.
static NEW: LazyLock<Files> = LazyLock::new(|| {
    let checkout = TempDir::new().expect("a folder");
    fs::write(checkout.path().join("Cargo.toml"), "[package]\nname = \"tabray\"\n").expect("room for a file");
    for folder in ["plugins", "scenes/entities", "scenes/revsurf", "scenes/wrong"] {
        fs::create_dir_all(checkout.path().join(folder)).expect("room for a folder");
    }
    for (kind, name) in KINDS.map(|(kind, name, _)| (kind, name)).into_iter().chain([("command", "count")]) {
        let new = Command::new(env!("CARGO_BIN_EXE_tabray"))
            .args(["new", "plugin", name, "--kind", kind])
            .current_dir(checkout.path())
            .output()
            .expect("the program runs");
        assert!(new.status.success(), "{}", String::from_utf8_lossy(&new.stderr));
    }
    fs::remove_file(checkout.path().join("Cargo.toml")).expect("it was there");
    copy::read(checkout.path())
});

/// The programs with all of these plugins.
static BUILT: LazyLock<Built> = LazyLock::new(|| copy::build("dropped-in", PLUGINS.clone()));

#[test]
fn plugins_dropped_in_are_all_that_changes() {
    assert!(BUILT.touched.is_empty(), "{:?}", BUILT.touched);
}

#[test]
fn plugins_dropped_in_keep_their_contracts() {
    assert_eq!(BUILT.prints_of("contracts", &[]), "");
}

#[test]
fn a_file_that_registers_nothing_is_warned_of() {
    let warning = |name: &str| format!("plugins/{name}.rs registers nothing, so no scene can use it");
    assert!(BUILT.said.contains(&warning("empty")), "{}", BUILT.said);
    assert!(!BUILT.prints(&["list"]).contains("empty "));
    assert!(page().contains(&warning("brick")));
}

#[test]
fn a_file_that_is_no_module_is_refused() {
    // This copy is built after the other one, in the same place.
    LazyLock::force(&BUILT);
    let mut files = PLUGINS.clone();
    files.insert(plugin("Bad-Name"), Vec::new());
    let said = copy::cannot_be_built(files);
    assert!(said.contains("Bad-Name.rs: a plugin's file name must be a Rust module name"), "{said}");
}

#[test]
fn a_plugin_in_the_place_of_the_crate_is_refused() {
    LazyLock::force(&BUILT);
    let mut files = PLUGINS.clone();
    files.insert(plugin("lib"), brick().into_bytes());
    let said = copy::cannot_be_built(files);
    assert!(said.contains("lib.rs: the file of that name lists the plugins: take another name"), "{said}");
}

// The README's plugin

#[test]
fn the_readmes_plugin_is_listed_with_its_attributes() {
    let list = BUILT.prints(&["list"]);
    let ring = list.lines().find(|line| line.starts_with("ring ")).expect("the list has it");
    assert!(ring.contains("a flat ring"));
    assert!(BUILT.prints(&["list", "ring"]).contains("the distance from the centre to the outer edge"));
}

#[test]
fn the_readmes_plugin_is_dumped() {
    let scene = BUILT.scene("ring-dumped", &block_with(&readme(), "ring target"));
    let dump = BUILT.prints(&["dump", scene.to_str().expect("a path in UTF-8")]);
    assert!(
        dump.contains("\nring         target \nmaterial     red \nnormal         0.0   0.0   1.0 \n"),
        "{dump}"
    );
    assert!(dump.contains("\nouter          2.0 \n"), "{dump}");
}

#[test]
fn the_readmes_plugin_is_a_flat_ring() {
    let picture = BUILT.picture("ring", &block_with(&readme(), "ring target"));
    let red = picture.pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count() as f64;
    // On the image plane, which is 8 by 6 units, the ring's radii of 2 and 1 are seen as 6 / 9 of them.
    let area = std::f64::consts::PI * (4.0 - 1.0) * (6.0_f64 / 9.0).powi(2) / (8.0 * 6.0);
    assert!((red / (160.0 * 120.0) - area).abs() < 0.005, "a flat ring of the right size, {red} pixels");
}

#[test]
fn the_readmes_plugin_has_its_rules_checked() {
    let message = BUILT.says(&["check", "-"], "ring r { outer 0 }");
    assert!(message.contains("`outer` of ring `r` must be positive, not 0"), "{message}");
}

// The plugin of docs/plugins.md

#[test]
fn the_pages_plugin_gives_no_warning() {
    assert!(!BUILT.said.contains("plugins/brick.rs"), "{}", BUILT.said);
}

#[test]
fn the_pages_plugin_is_listed_as_the_page_has_it() {
    assert_eq!(BUILT.prints(&["list", "brick"]), block_with(&page(), "brick NAME"));
}

#[test]
fn the_pages_plugin_looks_as_the_page_shows_it() {
    assert_shown(&BUILT.picture("brick", &block_with(&page(), "brick low")), "brick");
}

/// Asserts that the docs show this image.
fn assert_shown(picture: &RgbImage, name: &str) {
    let shown = image::open(root().join("docs").join(name).with_extension("png")).expect("a picture");
    assert!(*picture == shown.into_rgb8(), "docs/{name}.png is stale: docs/plugins.md says how to make it");
}

// Mistakes

const A_BRICK: &str = "camera eye { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
    brick b { material m center 1 1 1 }";

#[test]
fn a_constructor_that_asks_for_what_is_not_in_its_table_is_told() {
    let said = BUILT.says(&["check", "-"], &A_BRICK.replace("brick b", "block b"));
    let line = line(&brick());
    let message = |name: &str| {
        format!(
            "the plugin `{name}` asks for `size`, which is not in the table it registers at plugins/{name}.rs:{line}: add it there"
        )
    };
    assert!(said.contains("(plugins/block.rs:"), "the plugin's own line is told: {said}");
    assert!(said.contains(&message("block")), "{said}");
    assert!(page().contains(&message("brick")), "the page has the message");
}

#[test]
fn a_constructor_that_asks_for_another_type_is_told() {
    let scene = A_BRICK.replace("brick b", "slab b").replace("center 1 1 1", "center 1 1 1 size 1 1 1");
    let said = BUILT.says(&["check", "-"], &scene);
    // In this plugin, there are two more lines above the registration.
    let line = line(&brick()) + 2;
    let message = format!(
        "the plugin `slab` asks for `size` with another type than in the table it registers at plugins/slab.rs:{line}: give both the same type"
    );
    assert!(said.contains("(plugins/slab.rs:") && said.contains(&message), "{said}");
}

#[test]
fn plugins_that_contradict_each_other_are_told_with_their_places() {
    let settings = snapshots("refusals");
    let told = BUILT.says_of("rival", &["list"], "");
    settings.bind(|| insta::assert_snapshot!("plugins-that-contradict-each-other", told));
}

#[test]
fn a_name_that_is_taken_is_told_as_the_page_has_it() {
    let told = BUILT.says_of("rival", &["list"], "");
    let registered = "the entity type `sphere` is registered twice, at plugins/";
    let (_, places) = told.split_once(registered).unwrap_or_else(|| panic!("{told}"));
    let (taken, rival) = places.split_once(" and at ").expect("two places");
    assert!(rival.starts_with("src/bin/rival.rs:"), "{told}");
    let (taken, _) = taken.split_once(".rs:").expect("a line");
    let mine = format!("{registered}brick.rs:{} and at plugins/{taken}.rs:", line(&brick()));
    assert!(page().contains(&mine), "{told}");
}

// Profiles and shaders

#[test]
fn a_profile_dropped_in_is_known_by_its_name() {
    let scene = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 5 5 5 }
        revsurf cask { material m surfer barrel base 4 0 -4 direction 0 1 0 height 4 }";
    assert!(BUILT.says(&["check", "-"], scene).contains("-: no errors"));
}

#[test]
fn a_shader_dropped_in_is_known_by_its_name() {
    let scene = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 5 5 5 }
        psphere ball { material m shader stripes center 4 3 -3 radius 1 }";
    assert!(BUILT.says(&["check", "-"], scene).contains("-: no errors"));
}

// A shape without an equation

#[test]
fn pixels_that_a_shape_without_an_equation_may_cover_are_not_certified() {
    let scene = BUILT.scene(
        "pill",
        "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 5 5 5 }
        material w { ambient 0 0 5 } plane wall { material w normal 0 0 1 point 0 0 -8 }
        pill p { material m from 3 2 -3 to 5 4 -3 radius 0.7 }
        sphere s { material w center 3 2 0 radius 0.8 }",
    );
    let scene = scene.to_str().expect("a path in UTF-8");
    let numbers: Value = serde_json::from_str(&BUILT.prints(&["verify", scene, "--json"])).expect("JSON");
    assert_eq!(numbers["uncertified"], Value::from(["pill"].to_vec()));
    let of = |kind: &str| numbers["pixels"][kind].as_u64().expect("a number");
    assert_eq!((of("ties"), of("contradicted"), of("proven") + of("not_certified")), (0, 0, 1200));
    // Those whose rays meet the box around the pill, and not the sphere, which is in front of it.
    let open = (0..1200).filter(|pixel| {
        let dir = [f64::from(pixel % 40) / 39.0 * 8.0 - 4.0, f64::from(pixel / 40) / 29.0 * 6.0 - 3.0, -6.0];
        let slab = |axis: usize, low: f64, high: f64| {
            let [one, other] = [low, high].map(|end| (end - [4.0, 3.0, 6.0][axis]) / dir[axis]);
            (one.min(other), one.max(other))
        };
        let slabs = [slab(0, 2.3, 5.7), slab(1, 1.3, 4.7), slab(2, -3.7, -2.3)];
        let [from, to] =
            slabs.iter().fold([0.0, f64::INFINITY], |[from, to], slab| [slab.0.max(from), slab.1.min(to)]);
        let (along, square) =
            (-dir[0] - dir[1] - 6.0 * dir[2], dir.iter().map(|part| part * part).sum::<f64>());
        from < to && along * along < square * (1.0 + 1.0 + 36.0 - 0.64)
    });
    assert_eq!(of("not_certified"), open.count() as u64);
    let said = BUILT.prints(&["verify", scene]);
    let counted = format!(", 0 ties, {} not certified: `pill`, 0 contradicted\n", of("not_certified"));
    assert!(said.contains(&counted), "{said}");
}

// A shape with a fault

#[test]
fn a_fault_in_a_tenth_of_the_pixels_is_noticed_by_render() {
    let scene = "orthographic eye { pixeldim 400 300  position 0 0 5  target 0 0 0  width 2.26 }
        material m { ambient 0.5 0.5 0.5 } dented d { material m }";
    let scene = BUILT.scene("dented", scene);
    let paths = [scene.clone(), scene.with_extension("png")];
    let paths = paths.each_ref().map(|path| path.to_str().expect("a path in UTF-8"));
    let noticed = |options: &[&str]| {
        let args = [&["render", paths[0], "-o", paths[1]][..], options].concat();
        let said = BUILT.says(&args, "");
        let warning = said.lines().find(|line| line.contains("finds another object than the first"));
        let warning = warning.unwrap_or_else(|| panic!("{said}"));
        let numbers: Vec<usize> = warning.split(' ').filter_map(|word| word.parse().ok()).collect();
        assert!(warning.ends_with(" pixels that were tried") && numbers.len() == 2, "{warning}");
        [numbers[0], numbers[1]]
    };
    // A slow machine may not come to try all.
    let once = noticed(&[]);
    assert!(once[1] <= 64, "{once:?}");
    for options in [["--threads", "1"], ["--part", "2/3"]] {
        let [contradicted, tried] = noticed(&options);
        assert!(tried != once[1] || contradicted == once[0], "{contradicted} of {tried}, {once:?}");
    }
}

// What `tabray new plugin` writes

#[test]
fn a_new_plugin_of_each_kind_shows_something() {
    for (_, name, scene) in KINDS {
        let scene = String::from_utf8_lossy(&NEW[Path::new(scene)]);
        let picture = BUILT.picture(name, &scene);
        let orange = picture.pixels().filter(|pixel| pixel.0[0] > 60 && pixel.0[0] / 2 > pixel.0[2]).count();
        assert!(orange > 300, "{name} shows something orange, {orange} pixels");
    }
}

#[test]
fn a_new_plugins_mistake_is_one() {
    let mut mistakes = 0;
    for (_, name, _) in KINDS {
        let Some(mistake) = NEW.get(&Path::new("scenes/wrong").join(name).with_extension("ray")) else {
            continue;
        };
        let message = BUILT.says(&["check", "-"], &String::from_utf8_lossy(mistake));
        assert!(message.contains(&format!("{name} `")) && message.contains("2 errors"), "{message}");
        mistakes += 1;
    }
    assert_eq!(mistakes, 4, "of a shape, of a light, of a shader and of a camera");
}

// A command more

#[test]
fn a_new_command_works_and_is_listed_in_its_group() {
    let scene = BUILT.scene("counted", &block_with(&page(), "brick low"));
    assert_eq!(BUILT.prints_of("count", &["count", scene.to_str().expect("a path in UTF-8")]), "4 objects\n");
    let help = BUILT.prints_of("count", &["--help"]);
    let (_, inside) = help.split_once("\nLooking inside:\n").expect("the group");
    let (inside, _) = inside.split_once("\n\n").expect("the group ends");
    assert!(inside.ends_with("\n  count        Tell how many objects a scene has"), "{inside}");
    assert!(BUILT.prints_of("count", &["completions", "bash"]).contains("count__subcmd__count"));
}

#[test]
fn the_page_has_the_command_that_is_written() {
    let text = String::from_utf8_lossy(&NEW[Path::new("src/bin/count.rs")]);
    assert_eq!(block_with(&page(), "Run(run)"), text);
    assert!(text.lines().count() <= 30, "it is short");
}

#[test]
fn a_command_of_a_taken_name_is_refused_with_both_places() {
    let said = BUILT.says_of("twin", &["list"], "");
    assert!(said.starts_with("error: the command `render` is registered twice, at src/"), "{said}");
    assert!(said.contains("src/bin/twin.rs:9") && said.contains("src/cli/render.rs:"), "{said}");
}

// A separate crate

#[test]
fn a_plugin_in_a_crate_of_its_own_is_in_that_program() {
    assert!(BUILT.prints_of("example-plugin", &["list"]).contains("tangle "));
}

#[test]
fn a_program_of_its_own_has_its_own_name_and_version() {
    let version = format!("example-plugin (tabray {})\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(BUILT.prints_of("example-plugin", &["--version"]), version);
    for args in [&["--help"][..], &["render", "--help"], &["completions", "bash"], &["completions", "zsh"]] {
        let said = BUILT.prints_of("example-plugin", args);
        assert!(said.contains("example-plugin") && !said.contains("tabray "), "{args:?}: {said}");
    }
    assert!(
        BUILT.prints_of("example-plugin", &["render", "--help"]).contains("Usage: example-plugin render ")
    );
}

#[test]
fn a_plugin_in_a_crate_of_its_own_looks_as_the_page_shows_it() {
    let picture = BUILT.picture_of("example-plugin", &root().join("docs/example-plugin/tangle.ray"));
    assert_shown(&picture, "tangle");
}

#[test]
fn the_page_has_the_program_of_a_crate_of_its_own() {
    assert!(page().contains(&text_of("docs/example-plugin/src/main.rs")), "the page shows another program");
}

/// A program that checks the contracts of the plugins that are dropped in, except those whose mistake stops a scene from
/// being built, and of revsurfs, which can have the profiles.
const CONTRACTS: &str = "//! Contracts.

use tabray::scene::{Kind, Registry};
use tabray::tools::contract;

const CHECKED: [&str; 4] = [\"brick\", \"loop\", \"revsurf\", \"ring\"];

fn main() {
    let all = Registry::get().expect(\"no two plugins claim one name\");
    let sound = all.iter().filter(|entity| entity.kind() != Kind::Object || CHECKED.contains(&entity.name));
    for breach in contract::breaches(&Registry::of(sound).expect(\"they were one already\")) {
        println!(\"{breach}\");
    }
}
";

/// A program with plugins that claim names and numbers of other plugins. They are not in the library, as no program that
/// has them runs.
const RIVAL: &str = "//! What others have already.

use tabray::prelude::*;

fn main() -> std::process::ExitCode {
    tabray::cli::run()
}

inventory::submit! { Entity::shape(\"sphere\", \"another ball\", &[], |_| unreachable!()) }
inventory::submit! { Profile::new(\"cone\", \"another cone\", \"1\") }
inventory::submit! { Profile::new(\"crooked\", \"no formula\", \"2 +\") }
inventory::submit! { Entity::shader(\"checks\", \"its number is that of tiles\", &[], |_| unreachable!()).on_plane(0) }
";

/// A program with a command that claims the name of another.
const TWIN: &str = "//! What others have already.

use tabray::cli::{self, Command, Group, Run, clap};

fn main() -> std::process::ExitCode {
    cli::run()
}

tabray::prelude::inventory::submit! { Command::new(\"render\", Group::Tools, &Run(nothing)) }

#[derive(clap::Args)]
struct Args {}

fn nothing(_: &tabray::scene::Registry, _: Args) -> std::process::ExitCode {
    std::process::ExitCode::SUCCESS
}
";

/// A plugin in `plugins/` may call the core `crate`.
const BARREL: &str = "//! A barrel.

use crate::prelude::*;

inventory::submit! {
    Profile::new(\"barrel\", \"a barrel 4 high\", \"1.5 - 0.1 * (y - 2)^2\")
}
";

const STRIPES: &str = "//! Stripes, as wide as a tenth of the anchor's unit.

use tabray::prelude::*;

inventory::submit! {
    Entity::shader(\"stripes\", \"stripes across y\", &[], |_| Ok(ShaderFactory::new(Stripes)))
}

struct Stripes(Anchor);

impl Shader for Stripes {
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own = constants(material.reflectivity(of));
        if of != Reflectivity::Ambient {
            return Some(own);
        }
        let n = N::constant;
        let along = n(10.0) * (at.position[1] - n(self.0.origin.y)) / n(self.0.unit);
        Some(tiled(own, [n(0.0); 3], [along, n(0.0)], None))
    }
}
";

/// A shape without an equation.
const PILL: &str = "//! A cylinder with round ends.

use tabray::prelude::*;

static FROM: Pparm<DVec3> = Pparm::required(\"from\", \"the middle of one end\").unit(\"world coordinates\");
static TO: Pparm<DVec3> = Pparm::required(\"to\", \"the middle of the other end\").unit(\"world coordinates\");
static RADIUS: Pparm<f64> = Pparm::required(\"radius\", \"half of its width\").unit(\"world units\").positive();

inventory::submit! {
    Entity::shape(\"pill\", \"a cylinder with round ends\", &[&[&FROM, &TO, &RADIUS]], |args| {
        Ok(Body::plain(Pill { from: args.get(&FROM), to: args.get(&TO), radius: args.get(&RADIUS) }))
    })
}

struct Pill {
    from: DVec3,
    to: DVec3,
    radius: f64,
}

impl Pill {
    /// Returns the vector from its axis to a point.
    fn out(&self, at: DVec3) -> DVec3 {
        let axis = self.to - self.from;
        at - self.from - axis * ((at - self.from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0)
    }
}

impl Hittable for Pill {
    /// Steps along the ray, each time by the distance from the surface.
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let mut distance = 0.0;
        for _ in 0..1000 {
            let step = (self.out(ray.at(distance)).length() - self.radius).abs();
            if step < 1e-9 {
                return range.keep(distance);
            }
            distance += step;
        }
        MISS
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.out(at).normalize()
    }

    fn facts(&self) -> Facts {
        let out = DVec3::splat(self.radius);
        Facts::within(Aabb { low: self.from.min(self.to) - out, high: self.from.max(self.to) + out })
    }
}
";

/// A shape whose hits are not always those of its equation.
const DENTED: &str = "//! A ball, in whose middle the tracer sees a hole.

use tabray::exact::roots::Method;
use tabray::prelude::*;

inventory::submit! {
    Entity::shape(\"dented\", \"a ball with a fault\", &[], |_| Ok(Body::plain(Shape::new(Dented).certified())))
}

struct Dented;

impl Hittable for Dented {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let middle = ray.origin.dot(ray.dir);
        let distance = -middle - (middle * middle - ray.origin.length_squared() + 1.0).sqrt();
        let is_seen = ray.at(distance).truncate().length() > 0.35;
        if is_seen { range.keep(distance) } else { MISS }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        at.normalize()
    }

    fn facts(&self) -> Facts {
        Facts::within(Aabb { low: -DVec3::ONE, high: DVec3::ONE })
    }
}

impl Equation for Dented {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        dot(at, at) - N::constant(1.0)
    }
}

impl Certified for Dented {
    fn distance_by(&self, _method: Method, ray: &Ray, range: &RayRange) -> Option<f64> {
        Some(self.distance(ray, range))
    }
}
";
