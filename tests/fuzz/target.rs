//! The fuzzing targets. Each target is a function of the bytes that a fuzzer generates, and panics if a promise is
//! broken.
#![allow(dead_code, reason = "each program uses one of these functions")]

use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use tabray::numeric::double_double::DoubleDouble;
use tabray::numeric::{Dual, Formula, Interval, Scalar, Wide};
use tabray::render::{Plan, Renderer, to_byte, trace};
use tabray::scene::{self, Loaded, Registry, Syntax, dump};
use tabray::simd::Cpu;
use tabray::world::{Accuracy, Material};
use tempfile::NamedTempFile;

const SYNTAXES: [Syntax; 2] = [Syntax::Notes, Syntax::Toml];

/// The maximum length of the messages about one scene, in bytes.
const LONGEST_REPORT: usize = 1 << 20;

/// Reads a scene in the notes' syntax: it is refused with messages, or its dump is a scene with the same dump.
pub fn notes(bytes: &[u8]) {
    load_and_dump("scene.ray", bytes);
}

/// Reads a scene in TOML, which must satisfy the same as [`notes`].
pub fn toml(bytes: &[u8]) {
    load_and_dump("scene.toml", bytes);
}

fn load_and_dump(name: &str, bytes: &[u8]) {
    let Some(loaded) = load(name, bytes, None) else { return };
    let dumps = SYNTAXES.map(|syntax| dump::scene(&loaded.model, syntax));
    for (syntax, text) in SYNTAXES.iter().zip(&dumps) {
        let name = if *syntax == Syntax::Toml { "dump.toml" } else { "dump.ray" };
        let again =
            load(name, text.as_bytes(), None).unwrap_or_else(|| panic!("its own dump is refused:\n{text}"));
        let again = SYNTAXES.map(|syntax| dump::scene(&again.model, syntax));
        assert_eq!(dumps, again, "the dump of a dump differs");
    }
}

/// Returns the model of a scene, or nothing if it is refused. File names are relative to the project's folder `scenes`.
fn load(name: &str, bytes: &[u8], accuracy: Option<Accuracy>) -> Option<Loaded> {
    static REGISTRY: LazyLock<&Registry> =
        LazyLock::new(|| Registry::get().expect("no two plugins claim one name"));
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().find(|folder| folder.join("scenes").is_dir());
    let folder = folder.expect("the project's folder").join("scenes");
    match scene::read(&REGISTRY, name, &folder, bytes, accuracy) {
        Ok(loaded) => Some(loaded),
        Err(report) => {
            let text = report.to_string();
            assert!(text.contains("error"), "it is refused without an error:\n{text}");
            assert!(text.len() <= LONGEST_REPORT, "its messages have {} bytes", text.len());
            None
        }
    }
}

/// Evaluates a formula with every number type.
pub fn formula(bytes: &[u8]) {
    let Ok(formula) = str::from_utf8(bytes).map_err(drop).and_then(|text| Formula::parse(text).map_err(drop))
    else {
        return;
    };
    for formula in [formula.squared(), formula] {
        for y in [0.0, 1.0, -1.0, 0.3, 1e-9, -7.5, 1e9] {
            let eight = formula.at_eight([y; 8]);
            let one: Dual<f64> = formula.at(Dual::variable(y));
            let is_same = |one: f64, other: f64| one == other || one.is_nan() && other.is_nan();
            assert!(is_same(one.value, eight.value.0[7]), "{formula:?} at {y}: {one:?} and {eight:?}");
            assert!(is_same(one.slope, eight.slope.0[7]), "{formula:?} at {y}: {one:?} and {eight:?}");
            let _: f64 = formula.at(y);
            let _: DoubleDouble = formula.at(DoubleDouble::from(y));
            let _: Dual<Dual<f64>> = formula.at(Dual::variable(Dual::variable(y)));
            holds(formula.at(Interval::constant(y)));
            holds(formula.at(Interval { low: y - 0.5, high: y + 0.5 }));
            let Dual { value, slope } =
                formula.at(Dual::variable(Interval { low: y - 1e-3, high: y + 1e-3 }));
            holds(value);
            holds(slope);
        }
        let _: Wide = formula.at(Wide::constant(0.3));
    }
}

/// Asserts that the ends of an interval are in order.
fn holds(Interval { low, high }: Interval<f64>) {
    assert!(low <= high, "{low} to {high}");
}

/// Reads the file of a texture, which is accepted or refused with a reason.
pub fn texture(bytes: &[u8]) {
    let file = NamedTempFile::new_in("/dev/shm").or_else(|_| NamedTempFile::new()).expect("a temporary file");
    fs::write(&file, bytes).expect("it is written");
    let path = file.path().display();
    let scene = format!(
        "camera eye {{ pixeldim 2 2 worlddim 2 2 viewpoint 0 0 1 }} material plain {{ ambient 1 1 1 }} \
         texture image {{ filename {path} }} texplane wall {{ material plain normal 0 0 1 point 0 0 -1 xdir 1 0 0 \
         dimensions 1 1 texname image mode 0 }}"
    );
    load("scene.ray", scene.as_bytes(), None);
}

/// A renderer for each instruction set of this machine.
static RENDERERS: LazyLock<Vec<Renderer>> =
    LazyLock::new(|| Cpu::all().map(|cpu| Renderer::new(1).expect("a thread").on(cpu)).collect());

/// Renders a small image of a scene: packets of rays, with every instruction set, give the same bytes as single rays,
/// and no colour is NaN.
pub fn render(bytes: &[u8]) {
    let [kind, text @ ..] = bytes else { return };
    let accuracy = Accuracy::ALL[usize::from(kind % 4)];
    let name = if kind & 4 == 0 { "scene.ray" } else { "scene.toml" };
    let Some(mut loaded) = load(name, text, Some(accuracy)) else { return };
    // A pixel between mirrors may cost 20,000 rays.
    let goes_on =
        |material: &Material| material.specular.length_squared() > 0.0 || material.transparency != 0.0;
    let [width, height] =
        if loaded.model.objects.iter().any(|object| goes_on(&object.material)) { [3, 2] } else { [8, 6] };
    let camera = &mut loaded.model.camera.value;
    (camera.pixels, camera.samples) = ([width, height], camera.samples.min(2));
    let plan = Plan::new(&loaded.model);
    let pixel = |x, y| {
        let colour = trace::pixel(&plan, x, y);
        assert!(!colour.is_nan(), "pixel {x} {y} has the colour {colour}");
        colour.to_array().map(to_byte)
    };
    // The pixels are computed on a renderer's thread, whose stack has room for deep reflections.
    let alone = RENDERERS[0].run(|| {
        let pixels = (0..height).rev().flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels.flat_map(|(x, y)| pixel(x, y)).collect::<Vec<u8>>()
    });
    for renderer in &*RENDERERS {
        assert_eq!(renderer.picture(&plan), alone, "packets and single rays differ");
    }
}
