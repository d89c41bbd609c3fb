//! Makes the page for browsers in `target/web`: `cargo run -p tabray-web-build`.
//!
//! The result is a folder to be served, which keeps itself for use without a network, and `tabray.html`, a single
//! file that works from anywhere. The module is compiled for wasm32-unknown-unknown by the cargo and the rustc that
//! compiled this program. Only crates are downloaded.

#[path = "../../page/html.rs"]
mod html;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use html::Own;
use sha2::{Digest, Sha256};
use std::env;
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// The target of the module.
const TARGET: &str = "wasm32-unknown-unknown";

/// The scripts of this page. Those of all pages are around them.
const SCRIPTS: &str = concat!(
    include_str!("../page/editor.js"),
    include_str!("../page/proof.js"),
    include_str!("../page/smooth.js"),
    include_str!("../page/formula.js"),
    include_str!("../page/files.js"),
    include_str!("../page/save.js"),
    include_str!("../page/share.js"),
    include_str!("../page/host.js"),
);

fn main() -> ExitCode {
    match made() {
        Ok(said) => {
            print!("{said}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Makes the page, and returns a list of its files.
fn made() -> Result<String, Box<dyn Error>> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| sources.join("../target"), PathBuf::from);
    let target = std::path::absolute(target)?;
    let module = optimized(module(&sources, &target.join("web-build"))?);
    let folder = target.join("web");
    fs::create_dir_all(&folder)?;

    let served = page(
        "<link rel=\"icon\" href=\"icon.svg\">\n<link rel=\"manifest\" href=\"tabray.webmanifest\">\n",
        "",
    );
    let packed = gzipped(&module)?;
    let inline =
        format!("<script type=\"application/gzip\" id=\"module\">{}</script>\n", STANDARD.encode(&packed));
    let alone = page("<link rel=\"icon\" href=\"data:,\">\n", &inline);

    let mut hash = Sha256::new();
    hash.update(&served);
    hash.update(&module);
    let version: String = hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    let offline = include_str!("../page/offline.js").replace("VERSION", &version);
    let files: [(&str, &[u8]); 6] = [
        ("index.html", served.as_bytes()),
        ("tabray.wasm", &module),
        ("offline.js", offline.as_bytes()),
        ("tabray.webmanifest", include_bytes!("../page/tabray.webmanifest")),
        ("icon.svg", include_bytes!("../page/icon.svg")),
        ("tabray.html", alone.as_bytes()),
    ];
    let mut said = String::new();
    let mut downloaded = [0; 2];
    for (name, bytes) in files {
        // A file is written under another name and then renamed: a served page is never incomplete.
        let (path, beside) = (folder.join(name), folder.join(format!(".{name}.new")));
        fs::write(&beside, bytes)?;
        fs::rename(&beside, &path)?;
        let sizes = [gzipped(bytes)?.len(), brotli(bytes).unwrap_or(0)];
        if name != "tabray.html" {
            (0..2).for_each(|index| downloaded[index] += sizes[index]);
        }
        said += &format!("{}: {}{}\n", path.display(), bytes_of(bytes.len()), compressed(sizes));
    }
    said += &format!("the page as it is served:{}\n", compressed(downloaded).replacen(',', "", 1));
    Ok(said)
}

/// Assembles the page, with additions to its head and its end.
fn page(head: &str, end: &str) -> String {
    let own = include_str!("../page/own.html").replacen('\n', &format!("\n{head}"), 1);
    let worker = concat!(
        "<script type=\"text/plain\" id=\"worker\">\n",
        include_str!("../page/worker.js"),
        "</script>\n"
    );
    html::page(&Own {
        html: &format!("{own}<!-- slot: end -->\n{end}{worker}"),
        style: include_str!("../page/web.css"),
        link: include_str!("../page/link.js"),
        scripts: SCRIPTS,
    })
}

fn bytes_of(count: usize) -> String {
    format!("{:.2} MB", count as f64 / 1e6)
}

/// Describes compressed sizes. Brotli's is left out if it is 0.
fn compressed([gzip, brotli]: [usize; 2]) -> String {
    let more = if brotli > 0 { format!(", {} by Brotli", bytes_of(brotli)) } else { String::new() };
    format!(", {} by gzip{more}", bytes_of(gzip))
}

fn gzipped(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}

/// Returns the size by Brotli, if there is a program of that name.
fn brotli(bytes: &[u8]) -> Option<usize> {
    let mut program = Command::new("brotli")
        .args(["-c", "-q", "11"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    let mut stdin = program.stdin.take()?;
    let bytes = bytes.to_vec();
    let writer = std::thread::spawn(move || stdin.write_all(&bytes));
    let output = program.wait_with_output().ok()?;
    writer.join().ok()?.ok()?;
    output.status.success().then_some(output.stdout.len())
}

/// Compiles the module, and returns it.
fn module(sources: &Path, build: &Path) -> Result<Vec<u8>, Box<dyn Error>> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let sysroot = Command::new(&rustc).args(["--print", "sysroot"]).current_dir(sources).output()?;
    let sysroot = PathBuf::from(String::from_utf8(sysroot.stdout)?.trim());
    let mut command = Command::new(cargo);
    command.args(["build", "--package", "tabray-web", "--lib", "--profile", "web", "--target", TARGET]);
    command.arg("--target-dir").arg(build);
    command.current_dir(sources);
    if sysroot.join("lib/rustlib").join(TARGET).join("lib").is_dir() {
        // The standard library for the target is installed.
    } else if sysroot.join("lib/rustlib/src/rust/library").is_dir() {
        command.env("RUSTC_BOOTSTRAP", "1").arg("-Zbuild-std=std,panic_abort");
    } else {
        return Err(format!(
            "the standard library for {TARGET} is not here\nhelp: rustup target add {TARGET}, or rustup component add rust-src"
        )
        .into());
    }
    // A compiler from rustup has its own linker; one from a distribution may need another.
    let is_there = |program: &str| {
        Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
    };
    if !has_linker(&sysroot) && !is_there("rust-lld") && is_there("wasm-ld") {
        command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", "wasm-ld");
    }
    // Vectors of two numbers, which all browsers since 2023 have, and a stack for deep reflections.
    command.env("RUSTFLAGS", "-C target-feature=+simd128 -C link-arg=-zstack-size=16777216");
    command.env_remove("CARGO_ENCODED_RUSTFLAGS");
    if !command.status()?.success() {
        return Err("the module cannot be compiled: see above".into());
    }
    let path = build.join(TARGET).join("web/tabray_web.wasm");
    fs::read(&path).map_err(|error| format!("{}: {error}", path.display()).into())
}

/// Tells whether the compiler has a linker for the module.
fn has_linker(sysroot: &Path) -> bool {
    let hosts = fs::read_dir(sysroot.join("lib/rustlib")).into_iter().flatten().flatten();
    hosts
        .map(|host| host.path().join("bin/rust-lld"))
        .any(|linker| linker.with_extension(env::consts::EXE_EXTENSION).exists())
}

/// Makes the module smaller, if there is `wasm-opt` of Binaryen.
fn optimized(module: Vec<u8>) -> Vec<u8> {
    let smaller = || -> io::Result<Vec<u8>> {
        let folder = env::temp_dir().join(format!("tabray-web-{}", std::process::id()));
        fs::create_dir_all(&folder)?;
        let [from, to] = ["from.wasm", "to.wasm"].map(|name| folder.join(name));
        fs::write(&from, &module)?;
        let ran = Command::new("wasm-opt")
            .args([
                "-O3",
                "--enable-simd",
                "--enable-bulk-memory",
                "--enable-nontrapping-float-to-int",
                "--enable-sign-ext",
            ])
            .args(["--enable-mutable-globals", "--enable-multivalue", "--enable-reference-types", "-o"])
            .args([&to, &from])
            .status();
        let read =
            ran.and_then(
                |status| if status.success() { fs::read(&to) } else { Err(io::ErrorKind::Other.into()) },
            );
        fs::remove_dir_all(&folder)?;
        read
    };
    smaller().unwrap_or(module)
}
