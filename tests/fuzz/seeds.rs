//! Writes the inputs that fuzzing starts from: the project's scenes as corpora, and the words of its tables as a
//! dictionary.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs, io};
use tabray::scene::Registry;

#[path = "target.rs"]
mod target;

/// Returns the files below a folder, sorted by path.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() { files.extend(self::files(&path)?) } else { files.push(path) }
    }
    Ok(files)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = PathBuf::from(env::args().nth(1).ok_or("the folder to write to is missing")?);
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).ok_or("there is no project")?;
    let write = |target: &str, name: usize, bytes: &[u8]| {
        let folder = out.join("corpus").join(target);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(format!("seed-{name}")), bytes)
    };
    let mut formulas = BTreeSet::from(["y".to_owned(), "2 + sin(y)".to_owned()]);
    for (index, path) in files(&project.join("scenes"))?.iter().enumerate() {
        let bytes = fs::read(path)?;
        match path.extension().and_then(|extension| extension.to_str()) {
            Some(kind @ ("ray" | "toml")) => {
                let is_toml = kind == "toml";
                let text = String::from_utf8_lossy(&bytes);
                // Loading a profile takes longer than everything else. `render` starts from such scenes, too.
                if bytes.len() <= 1024 && !text.contains("profile") {
                    write(if is_toml { "toml" } else { "notes" }, index, &bytes)?;
                    write("fmt", index, &[&[u8::from(is_toml)], &*bytes].concat())?;
                    write("lsp", index, &[&[u8::from(is_toml), 128], &*bytes].concat())?;
                }
                for accuracy in 0..4 {
                    let first = accuracy + if is_toml { 4 } else { 0 };
                    write("render", 8 * index + usize::from(first), &[&[first], &*bytes].concat())?;
                }
                formulas.extend(text.split('"').skip(1).step_by(2).map(str::to_owned));
            }
            Some(kind @ ("obj" | "ply" | "stl")) if bytes.len() < 1 << 14 => {
                let format = target::MESHES.iter().position(|format| *format == kind).unwrap_or(0) as u8;
                for (first, name) in [(format, 2 * index), (format + 5, 2 * index + 1)] {
                    write("mesh", name, &[&[first], &bytes[..bytes.len().min(2000)]].concat())?;
                }
            }
            Some("png" | "ppm" | "pgm" | "pbm") if bytes.len() < 1 << 14 => write("texture", index, &bytes)?,
            _ => {}
        }
    }
    // A triangle in bytes.
    let corners: Vec<u8> =
        [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5].into_iter().flat_map(f32::to_le_bytes).collect();
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    write("mesh", 1000, &[&[1], ply.as_bytes(), &corners, &[3, 0, 1, 2]].concat())?;
    write(
        "mesh",
        1001,
        &[&[2][..], &[b' '; 80], &1_u32.to_le_bytes(), &[0; 12], &corners, &[0; 2]].concat(),
    )?;
    for (index, bytes) in target::triangle().into_iter().enumerate() {
        let kind = 3 + index as u8;
        for (first, name) in [(kind, 1002 + 2 * index), (kind + 5, 1003 + 2 * index)] {
            write("mesh", name, &[&[first], &bytes[..]].concat())?;
        }
        write("gltf", index, &[&[1], &bytes[..]].concat())?;
    }
    write("gltf", 2, &[&[1], target::COPIES.as_bytes()].concat())?;
    for (index, text) in target::IMPORTED.iter().enumerate() {
        write("import", index, text.as_bytes())?;
    }
    write("older", 0, target::OLDER.as_bytes())?;
    for (index, bytes) in target::rays().into_iter().enumerate() {
        write("hits", index, &bytes)?;
    }
    for (index, formula) in formulas.iter().enumerate() {
        write("formula", index, formula.as_bytes())?;
    }
    for (target, requests) in [("watch", &target::TO_WATCH[..]), ("review", &target::TO_REVIEW)] {
        for (index, request) in requests.iter().enumerate() {
            write(target, index, request.as_bytes())?;
        }
    }
    for kind in 0..3 {
        write("checkpoint", usize::from(kind), &[kind, 5, 0, 99, 1])?;
    }
    let mut words = BTreeSet::new();
    for entity in Registry::get()?.iter() {
        words.insert(entity.name.to_owned());
        words.extend(entity.attributes().map(|attribute| attribute.name().to_owned()));
    }
    let functions =
        "sin cos tan exp ln sqrt abs floor min max 1e300 1e-320 -0 nan inf let include repeat count"
            .split(' ');
    words.extend(functions.map(str::to_owned));
    let meshes = "v f usemtl solid facet normal outer loop vertex endloop endfacet endsolid ply format ascii \
                  binary_little_endian binary_big_endian element face property list uchar int float double \
                  vertex_indices end_header";
    words.extend(meshes.split_whitespace().map(str::to_owned));
    let names = "GET POST HEAD HTTP/1.0 HTTP/1.1 Host: Origin: Sec-Fetch-Site: Sec-Fetch-Dest: Content-Length: \
                 Transfer-Encoding: Connection: Expect: chunked close same-origin none cross-site document http:// \
                 localhost:3000 ?token= TOKEN HOST SNAPSHOT VERSION /events /probe/1/ /layer/1/ /accept /reject \
                 100-continue";
    let requests = names.split_whitespace().chain(["\r\n", "\r\n\r\n"]).map(str::to_owned).collect();
    for (name, words) in [("words.dict", words), ("requests.dict", requests)] {
        let line = |word: &String| format!("\"{}\"\n", word.replace('\r', "\\x0d").replace('\n', "\\x0a"));
        fs::write(out.join(name), words.iter().map(line).collect::<String>())?;
    }
    Ok(())
}
