//! The fuzzing targets. Each target is a function of the bytes that a fuzzer generates, and panics if a promise is
//! broken.
#![allow(dead_code, reason = "each program uses one of these functions")]

use std::fs::{self, File};
use std::io::{BufReader, Read, Seek, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use tabray::exact::double_double::DoubleDouble;
use tabray::exact::{Dual, Formula, Interval, Jet, Scalar, Wide};
use tabray::fuzz::{self, Image, Server};
use tabray::render::{Plan, Renderer, trace};
use tabray::scene::editor::{self, Files, Text, View};
use tabray::scene::{self, Loaded, Registry, Syntax, dump};
use tabray::simd::Cpu;
use tabray::tools::hits::rays::{BadRay, RayFormat, RayReader};
use tabray::tools::hits::theirs::TheirReader;
use tabray::tools::threads::renderer_with;
use tabray::world::{Accuracy, Material};
use tempfile::{NamedTempFile, TempDir, tempfile_in};

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
    // Making the surfaces of a scene takes most of the time, so only one of the dumps is read.
    let chosen = bytes.len() % 2;
    let (name, text) = (["dump.ray", "dump.toml"][chosen], &dumps[chosen]);
    let again =
        load(name, text.as_bytes(), None).unwrap_or_else(|| panic!("its own dump is refused:\n{text}"));
    let again = SYNTAXES.map(|syntax| dump::scene(&again.model, syntax));
    assert_eq!(dumps, again, "the dump of a dump differs");
}

static REGISTRY: LazyLock<&Registry> =
    LazyLock::new(|| Registry::get().expect("no two plugins claim one name"));

/// Returns the model of a scene, or nothing if it is refused. File names are relative to the project's folder `scenes`.
fn load(name: &str, bytes: &[u8], accuracy: Option<Accuracy>) -> Option<Loaded> {
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

/// An older scene: a sphere, a plane of finite size, and a light.
pub const OLDER: &str = "8 6\n0 0 3\n13 ball\n1 0 0\n2 1 1\n.2 .2 .3\n.5 -1 -4\n1.5\n15\n1 1 1\n1 1 1\n0 0 0\n0 1 0\n-2 -2 -5\n\
                         1 0 0\n4 4\n10 lamp\n6 6 6\n0 5 0\n";

/// Reads an older scene, which consists of numbers, or takes it for another text, which must satisfy the same as [`notes`].
pub fn older(bytes: &[u8]) {
    load_and_dump("old.txt", bytes);
}

/// Formats a scene, whose first byte chooses the syntax: it is refused, or the result is formatted, and the same scene.
pub fn fmt(bytes: &[u8]) {
    let [kind, text @ ..] = bytes else { return };
    let Ok(text) = str::from_utf8(text) else { return };
    let name = ["scene.ray", "scene.toml"][usize::from(kind % 2)];
    let formatted = |text: &str| editor::formatted(&editor::read(*REGISTRY, name, Text::new(text)));
    let Some(once) = formatted(text) else { return };
    assert_eq!(formatted(&once).as_ref(), Some(&once), "what is formatted is not: {text:?}");
    let dump = |text: &str| load(name, text.as_bytes(), None).map(|loaded| dump::notes(&loaded.model));
    assert_eq!(dump(text), dump(&once), "it is another scene: {text:?}");
}

/// Reads rays, or the answers of another tracer. The first byte chooses the format, or that the input shows it. What is refused
/// has its line and a reason, and memory does not grow with what the input claims.
pub fn hits(bytes: &[u8]) {
    let [kind, file @ ..] = bytes else { return };
    let input = BufReader::new(Box::new(file) as Box<dyn Read>);
    let is_sound = |bad: &BadRay| {
        assert!(!bad.message.is_empty() && bad.message.len() < 1 << 12, "{bad}");
        assert!(bad.number as usize <= file.len() + 1, "{bad}");
    };
    // There is nothing after the last fault, and the input has no more rays than bytes.
    let check = |faults: &mut dyn Iterator<Item = Option<BadRay>>| {
        let (mut count, mut is_over) = (0, false);
        for fault in faults {
            assert!(!is_over && count <= file.len());
            count += 1;
            is_over = fault.as_ref().is_some_and(|bad| bad.is_last);
            fault.iter().for_each(is_sound);
        }
    };
    let format =
        [None, Some(RayFormat::Text), Some(RayFormat::Csv), Some(RayFormat::JsonLines), Some(RayFormat::Npy)];
    match format.get(usize::from(kind % 6)) {
        Some(format) => match RayReader::new(input, *format) {
            Ok(rays) => check(&mut rays.map(|row| {
                let end = row.as_ref().map(|row| row.t_max);
                assert!(!end.is_ok_and(|end| end.is_some_and(f64::is_nan)), "a ray that ends nowhere");
                row.err()
            })),
            Err(bad) => is_sound(&bad),
        },
        None => match TheirReader::new(input) {
            Ok(answers) => check(&mut answers.map(Result::err)),
            Err(bad) => is_sound(&bad),
        },
    }
}

/// Rays and answers in each format, with the first byte that chooses it.
pub fn rays() -> Vec<Vec<u8>> {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 6), }";
    let header = format!("{header:<117}\n");
    let mut npy =
        [&b"\x04\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat();
    npy.extend((0..12).flat_map(|number| f64::from(number).to_le_bytes()));
    let texts = [
        "\x000 0 5  0 0 -1\n# a comment\n1e300,-0,5,0,0.5,-1,7\n",
        "\x010 0 5  0 0 -1\n",
        "\x02ox,oy,oz,dx,dy,dz,t_max\n0,0,5,0,0,-1,\n\"1\",2,3,4,5,6,9\n",
        "\x03{\"origin\": [0, 0, 5], \"direction\": [0, 0, -1], \"t_max\": 9}\n[0, 0, 5, 0, 0, -1]\n",
        "\x05ox,oy,oz,dx,dy,dz,t,hit,object,face\n0,0,5,0,0,-1,4,hit,ball,-1\n0,0,5,0,1,0,,miss,,\n",
        "\x05{\"origin\": [0, 0, 5], \"direction\": [0, 0, -1], \"hit\": true, \"t\": 4, \"object\": 0}\n",
    ];
    texts.iter().map(|text| text.as_bytes().to_vec()).chain([npy]).collect()
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
            let _: Jet = formula.at(Jet::variable(y));
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

/// Reads the file of a texture, which is accepted or refused with a reason. The checksums of a PNG are repaired first,
/// since a fuzzer does not find right ones.
pub fn texture(bytes: &[u8]) {
    let file = NamedTempFile::new_in(memory()).expect("a temporary file");
    fs::write(&file, with_checksums(bytes)).expect("it is written");
    let path = file.path().display();
    let scene = format!(
        "camera eye {{ pixeldim 2 2 worlddim 2 2 viewpoint 0 0 1 }} material plain {{ ambient 1 1 1 }} \
         texture image {{ filename {path} }} texplane wall {{ material plain normal 0 0 1 point 0 0 -1 xdir 1 0 0 \
         dimensions 1 1 texname image mode 0 }}"
    );
    load("scene.ray", scene.as_bytes(), None);
}

/// The formats of meshes, as file names end.
pub const MESHES: [&str; 5] = ["obj", "ply", "stl", "glb", "gltf"];

/// Returns a triangle in glTF, as a GLB and as text.
pub fn triangle() -> [Vec<u8>; 2] {
    let corners: Vec<u8> =
        [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5].into_iter().flat_map(f32::to_le_bytes).collect();
    let json = |uri: &str| {
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"scale":[1,2,1]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":0}},"material":0}}]}}],
            "materials":[{{"name":"a","alphaMode":"MASK","pbrMetallicRoughness":{{"baseColorFactor":[1,0.5,0,1]}}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{{uri}"byteLength":36}}]}}"#
        );
        let padded = text.len().next_multiple_of(4);
        format!("{text:padded$}").into_bytes()
    };
    let (text, kinds) = (json(""), [u32::from_le_bytes(*b"JSON"), u32::from_le_bytes(*b"BIN\0")]);
    let mut glb = [&b"glTF"[..], &2_u32.to_le_bytes(), &(28 + text.len() as u32 + 36).to_le_bytes()].concat();
    for (kind, chunk) in kinds.into_iter().zip([&text, &corners]) {
        glb.extend([&(chunk.len() as u32).to_le_bytes(), &kind.to_le_bytes(), &chunk[..]].concat());
    }
    // 36 bytes of corners in base64.
    let uri = "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAA/";
    [glb, json(&format!(r#""uri":"{uri}","#))]
}

/// Reads the file of a mesh, which is accepted or refused with a reason. The first byte chooses the format, whether all that
/// the file has is asked for, and whether an OBJ is read again with comments after it that make it many blocks, which changes
/// nothing.
pub fn mesh(bytes: &[u8]) {
    let [kind, file @ ..] = bytes else { return };
    let format = MESHES[usize::from(kind % 5)];
    let own = if kind / 5 % 2 == 0 { "" } else { "normals file materials file" };
    let path = memory().join(format!("tabray-fuzz-{}.{format}", std::process::id()));
    let read = |file: &[u8]| {
        fs::write(&path, file).expect("it is written");
        let scene = format!(
            "camera eye {{ pixeldim 2 2 worlddim 2 2 viewpoint 0 0 1 }} material plain {{ ambient 1 1 1 }} \
             mesh surface {{ material plain file {} {own} }}",
            path.display()
        );
        match scene::read(&REGISTRY, "scene.ray", Path::new(""), scene.as_bytes(), None) {
            Ok(_) => None,
            Err(report) => Some(report.to_string()),
        }
    };
    let said = read(file);
    // Blank lines after the first ones change nothing in an OBJ but the numbers of later lines. A file that ends within a
    // line may be refused for that.
    if kind / 5 < 2 && format == "obj" && file.len() < 1 << 10 {
        let lines = [file, &b"\n"[..]].concat();
        let blank = [&lines[..], &b"# a comment\n".repeat(1 << 15)].concat();
        let said = read(&lines);
        let is_continued = file.ends_with(b"\\") || file.ends_with(b"\\\r");
        assert!(
            is_continued || read(&blank).is_none() == said.is_none(),
            "comments change what is read: {said:?}"
        );
    }
    fs::remove_file(&path).expect("it was written");
    if let Some(said) = said {
        assert!(said.contains("mesh `surface` ") && said.len() < 1 << 14, "{said}");
    }
}

/// Reads a glTF: its text, or a GLB. Its first byte chooses what [`mesh`] does.
pub fn gltf(bytes: &[u8]) {
    let [kind, file @ ..] = bytes else { return };
    let is_text = file.first() == Some(&b'{');
    mesh(&[&[if is_text { 4 } else { 3 } + 5 * (kind % 2)], file].concat());
}

/// A glTF with copies, a material of two extensions and an image that is none.
pub const COPIES: &str = r#"{"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing","X_unknown"],"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0,"SCALE":0}}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0,"mode":5}]}],
"materials":[{"alphaMode":"BLEND","extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture":{"index":0}},
"KHR_materials_transmission":{"transmissionFactor":0.5}}}],"textures":[{"sampler":0,"extensions":{"EXT_texture_webp":{"source":0}}}],
"samplers":[{"wrapS":33071}],"images":[{"bufferView":0}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAA/","byteLength":36}]}"#;

/// Files of other programs, each with the first byte that chooses its kind.
pub const IMPORTED: [&str; 3] = [
    "\x00surface_equation=x^2+y^2+z^2-a\nsurface_parameter_a=0.5\nscale_factor=0.1\nlight_status_0=ON\n\
     light_position_0=1 2 3\nlight_color_0=1 1 1\nlight_intensity_0=0.5\nrotation_matrix=1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n",
    "\x01double a = 0.5;\nwidth = 40; height = 30;\nsurface = x^2+y^2+rotate(z^2, a, xAxis)-a;\nclip = sphere;\ndraw_surface;\n",
    "\x01poly p = x^3-3*x*y^2; int i = 2;\nsurface = deg(p, i)*z + p*diff(p, x);\nscale_x = 0.5;\ndraw_surface;\n",
];

/// Imports a file of SURFER or of surf, which must satisfy the same as [`notes`]. The first byte chooses the program.
pub fn import(bytes: &[u8]) {
    let [kind, text @ ..] = bytes else { return };
    load_and_dump(["scene.jsurf", "scene.surf"][usize::from(kind % 2)], text);
}

/// The only file of an editor.
struct OneFile(Arc<View>);

impl Files for OneFile {
    fn view(&self, path: &Path) -> Option<Arc<View>> {
        (path == Path::new("scene")).then(|| self.0.clone())
    }
}

/// Asks all that an editor asks about a scene while it is typed. The first byte chooses the syntax, the second one the place
/// of the cursor. What is answered lies within the text, and between its letters.
pub fn lsp(bytes: &[u8]) {
    let [kind, cursor, text @ ..] = bytes else { return };
    let Ok(text) = str::from_utf8(text) else { return };
    let name = ["scene.ray", "scene.toml"][usize::from(kind % 2)];
    let wanted = text.len() * usize::from(*cursor) / 255;
    let at = (0..=wanted).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let view = Arc::new(editor::read(*REGISTRY, name, Text::new(text)));
    let holds = |place: &Range<usize>| assert!(text.get(place.clone()).is_some(), "{place:?} of {text:?}");
    let group = editor::group(&OneFile(view.clone()), Path::new("scene"), &[]);
    let _ = editor::completions(*REGISTRY, &group, at);
    let _ = editor::signature(&view, at);
    editor::hover(&group, at).iter().for_each(|hover| holds(&hover.place));
    editor::definitions(&group, at).iter().for_each(|location| holds(&location.place));
    editor::usages(&group, at, true).iter().for_each(|location| holds(&location.place));
    if let Ok(changes) = editor::renamed(&group, at, "renamed") {
        changes.iter().for_each(|(location, _)| holds(&location.place));
    }
    editor::colours(&view).iter().for_each(|swatch| holds(&swatch.place));
    editor::hints(&view, &(0..text.len())).iter().for_each(|hint| holds(&(hint.at..hint.at)));
    editor::semantic_tokens(&view).iter().for_each(|token| holds(&token.place));
    editor::folds(&view).iter().for_each(|fold| assert!(fold.lines[0] <= fold.lines[1], "{text:?}"));
    let _ = editor::look_at(&view, &(at..at));
    let mut waiting = editor::outline(&view);
    while let Some(symbol) = waiting.pop() {
        holds(&symbol.place);
        holds(&symbol.name_place);
        waiting.extend(symbol.inner);
    }
}

/// A renderer for each instruction set of this machine.
static RENDERERS: LazyLock<Vec<Renderer>> =
    LazyLock::new(|| Cpu::all().map(|cpu| renderer_with(1).expect("a thread").on(cpu)).collect());

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
        plan.camera.display().bytes(colour)
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

/// Returns a folder in memory, if there is one, or else the folder of temporary files.
fn memory() -> PathBuf {
    Some(PathBuf::from("/dev/shm")).filter(|folder| folder.is_dir()).unwrap_or_else(std::env::temp_dir)
}

/// Returns a scene of a few pixels, with an object and a light.
fn small(width: usize, height: usize) -> Loaded {
    let scene = format!(
        "camera eye {{ pixeldim {width} {height} worlddim 8 6 viewpoint 4 3 6 }} material grey {{ diffuse 6 6 6 }} \
         sphere ball {{ material grey center 4 3 -4 radius 2 }} \
         light lamp {{ location 4 8 2 emissivity 9 9 9 }}"
    );
    load("scene.ray", scene.as_bytes(), None).expect("a scene")
}

/// The width and the height of an image with a checkpoint, in pixels, and in tiles of 16 x 16 pixels.
const UNFINISHED: [[usize; 2]; 2] = [[40, 36], [3, 3]];

/// An image, its pixels, and two of its checkpoints, each with the tiles that are rendered in it.
struct Unfinished {
    image: Image,
    pixels: Vec<[u8; 3]>,
    checkpoints: [(Vec<bool>, Vec<u8>); 2],
}

// An image and a server are not shared between threads.
thread_local! {
    static UNFINISHED_IMAGE: Unfinished = {
        let [[width, height], tiles] = UNFINISHED;
        let image = Image::new(&small(width, height).model).expect("the program's own file");
        let pixels: Vec<_> = (0..width * height).map(|at| [at, at / width, 37 * at].map(|byte| byte as u8)).collect();
        let checkpoints = [[0, 1, 2, 3, 5], [0, 1, 2, 3, 4]].map(|done| {
            let rendered: Vec<_> = (0..tiles[0] * tiles[1]).map(|tile| done.contains(&tile)).collect();
            let file = image.checkpoint(&pixels, &rendered).expect("a temporary file");
            (rendered, file)
        });
        Unfinished { image, pixels, checkpoints }
    };
}

/// Reads the file of a checkpoint: arbitrary bytes, or a genuine file with some changes, whose checksum may be
/// repaired. Nothing wrong is taken from it unless the checksum is repaired.
pub fn checkpoint(bytes: &[u8]) {
    let [kind, changes @ ..] = bytes else { return };
    UNFINISHED_IMAGE.with(|Unfinished { image, pixels, checkpoints: [one, other] }| {
        let mut file = tempfile_in(memory()).expect("a temporary file");
        let mut resume = |bytes: &[u8]| {
            file.rewind().and_then(|()| file.write_all(bytes)).expect("it is written");
            file.set_len(bytes.len() as u64).and_then(|()| file.rewind()).expect("it is written");
            image.resume(File::try_clone(&file).expect("a file"))
        };
        let filled = match kind % 3 {
            // Nobody can guess the hash of this program.
            0 => return assert!(resume(changes).is_none(), "something is not a checkpoint of this program"),
            1 => resume(&changed(&one.1, &other.1, changes)),
            _ => {
                // A checksum protects against damaged files, not against a person.
                resume(&Image::with_checksum(&changed(&one.1, &other.1, changes)));
                return;
            }
        };
        let Some((filled, tiles)) = filled else { return };
        let [[width, _], [wide, _]] = UNFINISHED;
        for (at, (pixel, rendered)) in filled.iter().zip(pixels).enumerate() {
            let tile = at / width / 16 * wide + at % width / 16;
            assert!(!tiles[tile] || pixel == rendered, "pixel {at} was never rendered so");
        }
        for (tile, is_done) in tiles.iter().enumerate() {
            assert!(!is_done || one.0[tile] || other.0[tile], "tile {tile} was never rendered");
        }
    });
}

/// Changes a file. Each change has four bytes: its kind, a position of two bytes, and a length or a value.
fn changed(file: &[u8], other: &[u8], changes: &[u8]) -> Vec<u8> {
    let mut file = file.to_vec();
    for change in changes.chunks_exact(4) {
        let &[what, high, low, value] = change else { continue };
        let start = usize::from(u16::from_be_bytes([high, low])) % (file.len() + 1);
        let end = file.len().min(start + usize::from(value));
        match what % 7 {
            0 => file.truncate(start),
            1 => file.insert(start, value),
            2 => drop(file.drain(start..end)),
            3 => drop(file.splice(end..end, file[start..end].to_vec())),
            4 => drop(file.splice(start..end, other[start.min(other.len())..end.min(other.len())].to_vec())),
            5 => file.iter_mut().skip(start).take(1).for_each(|byte| *byte ^= value),
            _ => file.iter_mut().skip(start).take(1).for_each(|byte| *byte = value),
        }
    }
    file
}

/// Replaces the checksums of a PNG's chunks with the right ones. Other files stay as they are.
fn with_checksums(file: &[u8]) -> Vec<u8> {
    let (signature, mut rest) = file.split_at(file.len().min(8));
    if signature != b"\x89PNG\r\n\x1a\n" {
        return file.to_vec();
    }
    let mut right = signature.to_vec();
    while let Some((length, after)) = rest.split_first_chunk() {
        let length = 4 + u32::from_be_bytes(*length) as usize;
        if after.len() < length + 4 {
            break;
        }
        right.extend_from_slice(&rest[..4 + length]);
        right.extend_from_slice(&checksum(&after[..length]).to_be_bytes());
        rest = &after[length + 4..];
    }
    right.extend_from_slice(rest);
    right
}

/// Returns the checksum of a PNG's chunk, a CRC-32.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        let step = |sum: u32, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 };
        (0..8).fold(sum ^ u32::from(*byte), step)
    })
}

/// The host that the servers believe to be.
const HOST: &str = "127.0.0.1:3000";

/// Sends bytes to a server, with `TOKEN` and other words replaced. Returns whether a request was let in.
fn request(server: &Server, bytes: &[u8], words: &[(&str, &str)]) -> bool {
    let token = server.url.split_once("token=").expect("a token").1;
    let words: Vec<_> = words.iter().copied().chain([("TOKEN", token), ("HOST", HOST)]).collect();
    let bytes = replaced(bytes, &words);
    let served = server.serve(&bytes);
    let sent = String::from_utf8_lossy(&served.sent);
    let (head, _) = sent.split_once("\r\n\r\n").unwrap_or((&sent, ""));
    let status = head.get(9..12).unwrap_or_default();
    assert!(head.is_empty() || head.starts_with("HTTP/1."), "{head}");
    assert!(!sent.contains(token), "the token is told: {sent}");
    if !served.is_let_in {
        assert!(["", "400", "403", "408", "413", "414", "431", "505"].contains(&status), "{head}");
        return false;
    }
    assert!(may_enter(&bytes, token), "this was let in:\n{}", String::from_utf8_lossy(&bytes));
    assert!(["200", "400", "404", "405", "409", "410"].contains(&status), "{head}");
    assert!(head.contains("\r\ncache-control: no-store\r\n"), "{head}");
    true
}

/// Replaces words, from left to right.
fn replaced(bytes: &[u8], words: &[(&str, &str)]) -> Vec<u8> {
    let (mut all, mut rest) = (Vec::new(), bytes);
    while let [first, after @ ..] = rest {
        match words.iter().find(|(word, _)| rest.starts_with(word.as_bytes())) {
            Some((word, by)) => {
                all.extend_from_slice(by.as_bytes());
                rest = &rest[word.len()..];
            }
            None => {
                all.push(*first);
                rest = after;
            }
        }
    }
    all
}

/// Tells whether the head of a request has everything that only the printed page sends: the token, the host, and no
/// foreign origin.
fn may_enter(bytes: &[u8], token: &str) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.trim_start_matches(['\r', '\n']).lines();
    let mut words = lines.next().unwrap_or_default().split(' ');
    let (method, target) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let query = target.split('#').next().and_then(|target| target.split_once('?')).map(|(_, query)| query);
    let path = target.split(['?', '#']).next().unwrap_or_default();
    let headers: Vec<_> = lines
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_once(':'))
        .map(|(name, value)| {
            (name.to_ascii_lowercase(), value.trim_matches([' ', '\t']).to_ascii_lowercase())
        })
        .collect();
    let all = |wanted: &str| {
        headers.iter().filter(|(name, _)| name == wanted).map(|(_, value)| value.as_str()).collect::<Vec<_>>()
    };
    let origins = [format!("http://{HOST}"), "http://localhost:3000".to_owned()];
    let is_visit = method == "GET" && path.ends_with('/') && all("sec-fetch-dest") == ["document"];
    query == Some(&format!("token={token}"))
        && [&[HOST][..], &["localhost:3000"]].contains(&&all("host")[..])
        && all("origin").iter().all(|origin| origins.iter().any(|ours| ours == origin))
        && (method == "GET" || !all("origin").is_empty())
        && (is_visit || all("sec-fetch-site").iter().all(|site| ["same-origin", "none"].contains(site)))
}

/// Requests to `tabray watch`, from its page and from others.
pub const TO_WATCH: [&str; 7] = [
    "GET /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nSec-Fetch-Dest: document\r\nSec-Fetch-Site: cross-site\r\n\r\n",
    "GET /events?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nSec-Fetch-Site: same-origin\r\n\r\n",
    "GET /probe/1/4/3?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nOrigin: http://HOST\r\n\r\n",
    "GET /layer/1/depth?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n",
    "GET /probe/2/9/9?token=TOKEN HTTP/1.0\nHost: localhost:3000\n\n",
    "GET /events?token=0123456789abcdef0123456789abcdef HTTP/1.1\r\nHost: HOST\r\n\r\n",
    "GET / HTTP/1.1\r\nHost: example.com\r\nOrigin: http://example.com\r\nCookie: token=TOKEN\r\n\r\n",
];

/// Requests to `tabray review`, from its page and from others.
pub const TO_REVIEW: [&str; 5] = [
    "GET /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nSec-Fetch-Site: none\r\n\r\n",
    "POST /reject?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nOrigin: http://HOST\r\nTransfer-Encoding: chunked\r\n\r\n\
     2\r\n{}\r\n0\r\n\r\n",
    "POST /accept?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nOrigin: http://HOST\r\nContent-Length: 200\r\n\r\n\
     {\"snapshot\": \"SNAPSHOT\", \"version\": \"VERSION\"}                                                        \
                                                                                                                  ",
    "POST /accept?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nContent-Length: 2\r\n\r\n{}",
    "POST /accept HTTP/1.1\r\nHost: HOST\r\nOrigin: http://HOST\r\nContent-Length: 2\r\n\r\n{}",
];

/// Connects to the server of `tabray watch`, which answers nothing without the token.
pub fn watch(bytes: &[u8]) {
    thread_local! {
        static SERVER: Server = fuzz::watch(*REGISTRY, small(8, 6)).expect("a server");
    }
    SERVER.with(|server| request(server, bytes, &[]));
}

/// A folder with two snapshots that await a decision, and the server that shows them.
struct Waiting {
    folder: TempDir,
    server: Server,
    /// The path and the content of each file.
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Waiting {
    fn new() -> Self {
        let folder = TempDir::new_in(memory()).expect("a folder");
        let header = "---\nsource: a.rs\n---\n";
        let files = ["one.snap", "one.snap.new", "two.snap", "two.snap.new"]
            .map(|name| (folder.path().join(name), format!("{header}{name}\n").into_bytes()));
        let server = fuzz::review(&REGISTRY, folder.path()).expect("a server");
        let waiting = Self { folder, server, files: files.into() };
        waiting.restore();
        waiting
    }

    fn restore(&self) {
        for (path, content) in &self.files {
            fs::write(path, content).expect("it is written");
        }
    }

    /// Tells whether all files are as they were.
    fn is_untouched(&self) -> bool {
        fs::read_dir(self.folder.path()).is_ok_and(|entries| entries.count() == self.files.len())
            && self.files.iter().all(|(path, content)| fs::read(path).is_ok_and(|is| is == *content))
    }
}

/// Connects to the server of `tabray review`. Snapshots change only if the request is let in and names a snapshot as
/// the page shows it, here as `SNAPSHOT` and `VERSION`.
pub fn review(bytes: &[u8]) {
    thread_local! {
        static WAITING: (Waiting, String) = {
            let waiting = Waiting::new();
            let token = waiting.server.url.split_once("token=").expect("a token").1;
            let request = format!("GET /?token={token} HTTP/1.1\r\nHost: {HOST}\r\n\r\n");
            let page = waiting.server.serve(request.as_bytes()).sent;
            let page = String::from_utf8_lossy(&page).into_owned();
            let (_, version) = page.split_once(r#""version":""#).expect("a version");
            let version = version.split('"').next().expect("a version").to_owned();
            (waiting, version)
        };
    }
    WAITING.with(|(waiting, version)| {
        let snapshot = waiting.files[0].0.display().to_string();
        let is_let_in = request(&waiting.server, bytes, &[("SNAPSHOT", &snapshot), ("VERSION", version)]);
        if !waiting.is_untouched() {
            let says = |word: &str| bytes.windows(word.len()).any(|window| window == word.as_bytes());
            let is_said = ["POST", "TOKEN", "SNAPSHOT", "VERSION"].into_iter().all(says);
            assert!(is_let_in && is_said, "this changed the snapshots:\n{}", String::from_utf8_lossy(bytes));
            let other = &waiting.files[2..];
            assert!(other.iter().all(|(path, content)| fs::read(path).is_ok_and(|is| is == *content)));
            waiting.restore();
        }
    });
}
