//! Limits on what is read: images that only claim to be large, and files without an end.
#![cfg(target_os = "linux")]

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const TEXTURED: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }
material m { ambient 1 1 1 }
texture t { filename picture }
texplane p { material m normal 0 0 1 point 0 0 -1 dimensions 3 3 texname t xdir 1 0 0 mode 0 }
";

/// Makes a working directory with a scene, `textured.ray`, whose texture is the file `picture`.
fn textured() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("textured.ray"), TEXTURED).expect("a scene");
    folder
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("a pipe").success());
}

#[test]
fn a_texture_without_pixels_is_refused() {
    let folder = textured();
    for header in ["P6 0 5 255\n", "P6 5 0 255\n", "P3 0 0 255\n"] {
        fs::write(folder.path().join("picture"), header).expect("a picture");
        for command in [&["check", "textured.ray"][..], &["render", "textured.ray", "-o", "x.png"]] {
            let (status, _, said) = outcome(tabray(&folder).args(command));
            assert_eq!(status, 2, "{header} {command:?}: {said}");
            assert!(said.contains("the file of texture `t` cannot be read: "), "{said}");
        }
    }
}

#[test]
fn a_texture_that_is_a_pipe_a_device_or_a_folder_is_refused() {
    let folder = textured();
    pipe(&folder.path().join("pipe"));
    let picture = folder.path().join("picture");
    for (what, reason) in [
        ("pipe", "it is a pipe or a device, not a file"),
        ("/dev/zero", "it is a pipe or a device, not a file"),
        (".", "is a directory"),
    ] {
        std::os::unix::fs::symlink(what, &picture).expect("a link");
        let (status, _, said) = outcome(tabray(&folder).args(["check", "textured.ray"]));
        assert_eq!(status, 2, "{what}: {said}");
        assert!(said.contains(&format!("the file of texture `t` cannot be read: {reason}")), "{said}");
        fs::remove_file(&picture).expect("a link");
    }
}

#[test]
fn a_mesh_that_is_a_pipe_or_takes_too_much_memory_is_refused() {
    let folder = folder();
    let text = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
mesh wall { material m file wall.obj }";
    fs::write(folder.path().join("wall.ray"), text).expect("a scene");
    let wall = folder.path().join("wall.obj");
    pipe(&wall);
    let (status, _, said) = outcome(tabray(&folder).args(["check", "wall.ray"]));
    assert_eq!(status, 2, "{said}");
    assert!(said.contains("`wall.obj`: it is a pipe or a device, not a file"), "{said}");
    fs::remove_file(&wall).expect("a pipe");
    // A file of 400 MB without a block on the disk.
    fs::File::create(&wall).and_then(|file| file.set_len(400 << 20)).expect("a file");
    let args = ["render", "wall.ray", "-o", "x.png", "--max-memory", "1GiB"];
    let (status, _, said) = outcome(tabray(&folder).args(args));
    assert_eq!(status, 2, "{said}");
    assert!(said.contains("it has 400.0 MiB, which may take more than the"), "{said}");
}

/// Meshes that take far more memory than their files.
#[test]
fn a_mesh_keeps_to_the_limit_on_memory_while_it_is_read() {
    let folder = folder();
    let mesh = |file: &str| {
        format!(
            "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }}
            mesh wall {{ material m file {file} }}"
        )
    };
    let fan = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(500_000));
    fs::write(folder.path().join("fan.obj"), fan).expect("a mesh");
    let header = "ply\nformat binary_little_endian 1.0\nelement junk 3000000\nproperty uchar x\nelement vertex 3\n\
        property uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\nproperty list int uchar vertex_indices\n\
        property list int uchar other\nend_header\n";
    let counts = [1_500_000_i32.to_le_bytes(), 500_000_i32.to_le_bytes()];
    let (corners, other) = ([0, 1, 2].repeat(500_000), vec![0; 500_000]);
    let vertices = [0, 0, 0, 1, 0, 0, 0, 1, 0];
    let junk = vec![0; 3_000_000];
    let ply = [header.as_bytes(), &junk, &vertices, &counts[0], &corners, &counts[1], &other].concat();
    fs::write(folder.path().join("fan.ply"), ply).expect("a mesh");
    for file in ["fan.obj", "fan.ply"] {
        fs::write(folder.path().join("wall.ray"), mesh(file)).expect("a scene");
        let args = ["render", "wall.ray", "-o", "x.png", "--max-memory", "100MiB"];
        let (status, _, said) = outcome(tabray(&folder).args(args));
        assert_eq!(status, 2, "{said}");
        let message = "faces, which may take more than the";
        assert!(said.contains(message) && said.contains("of memory that are left"), "{said}");
    }
}

/// Whether the program itself, which grows with each build profile, can be loaded into so many KiB of addresses.
fn is_loaded(kib: usize) -> bool {
    let limited = format!("ulimit -v {kib}; exec \"$0\" --version");
    let mut shell = assert_cmd::Command::new("bash");
    shell.args(["-c", &limited]).arg(env!("CARGO_BIN_EXE_tabray"));
    outcome(&mut shell).0 == 0
}

/// Memory that the system refuses anywhere ends the program with a message, and no file is left.
#[test]
fn memory_that_is_refused_is_told() {
    let folder = folder();
    let mut balls =
        "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n".to_owned();
    for ball in 0..20_000 {
        balls += &format!("sphere s{ball} {{ material m center {ball} 1 2 radius 1 }}\n");
    }
    fs::write(folder.path().join("balls.ray"), balls).expect("a scene");
    let mut refused = 0;
    for kib in (20_000..160_000).step_by(20_000) {
        for command in ["check balls.ray", "render balls.ray -o x.png", "convert balls.ray x.toml"] {
            let limited = format!("ulimit -v {kib}; exec \"$0\" {command}");
            let mut shell = assert_cmd::Command::new("bash");
            shell.args(["-c", &limited]).arg(env!("CARGO_BIN_EXE_tabray")).current_dir(folder.path());
            let (status, _, said) = outcome(&mut shell);
            let written = names_in(folder.path());
            match status {
                0 => assert!(
                    command.starts_with("check") || written.len() == 2,
                    "{command} in {kib}: {written:?}"
                ),
                // The system ends a program whose own code does not fit, and the C library one that has no memory to
                // start a thread; see docs/farms.md.
                -1 => assert!(
                    said.starts_with("Fatal glibc error: failed to register TLS destructor")
                        || said.is_empty() && !is_loaded(kib),
                    "{command} in {kib}: {said}"
                ),
                // The program itself cannot be loaded.
                127 => assert!(said.contains("error while loading shared libraries"), "{said}"),
                _ => {
                    assert_eq!((status, written.len()), (1, 1), "{command} in {kib}: {said}");
                    assert!(said.starts_with("error: "), "{said}");
                    refused += usize::from(said.contains("memory for `balls.ray`: the system refused"));
                }
            }
            for file in ["x.png", "x.toml"] {
                let _ = fs::remove_file(folder.path().join(file));
            }
        }
    }
    assert!(refused > 0, "some limit is met within the program");
}

#[test]
fn a_checkpoint_that_is_a_pipe_is_refused() {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("ball.ray")).expect("a copy");
    pipe(&folder.path().join("ball.png.checkpoint"));
    let (status, _, said) = outcome(tabray(&folder).args(["render", "ball.ray", "--resume"]));
    assert_eq!(status, 2, "{said}");
    assert!(
        said.contains("cannot read `ball.png.checkpoint`: it is a pipe or a device, not a file"),
        "{said}"
    );
}

#[test]
fn a_scene_comes_through_a_pipe_if_somebody_writes() {
    let folder = folder();
    let path = folder.path().join("pipe");
    pipe(&path);
    let text = fs::read(scene("sphere/in-front.ray")).expect("a scene");
    let writer = thread::spawn({
        let path = path.clone();
        move || {
            thread::sleep(Duration::from_millis(200));
            fs::OpenOptions::new().write(true).open(path).and_then(|mut pipe| pipe.write_all(&text))
        }
    });
    let (status, _, said) = outcome(tabray(&folder).args(["check", "pipe"]));
    assert_eq!((status, said.as_str()), (0, "pipe: no errors\n"));
    writer.join().expect("no panic").expect("it was read");

    let start = Instant::now();
    let (status, _, said) = outcome(tabray(&folder).args(["check", "pipe"]));
    assert_eq!(
        (status, said.as_str()),
        (1, "error: cannot read `pipe`: no program writes to this pipe (waited 5 s)\n")
    );
    assert!(start.elapsed() < Duration::from_secs(30), "it ends");
}

/// Comparing the pipe with the scene must not open it: that would wait for a writer.
#[test]
fn an_image_goes_through_a_pipe_if_somebody_reads() {
    let folder = folder();
    let path = folder.path().join("pipe");
    pipe(&path);
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("ball.ray")).expect("a copy");
    let mut render = tabray(&folder);
    render.args(["render", "ball.ray", "-q", "--format", "ppm", "-o"]).timeout(Duration::from_secs(60));
    let (status, bytes, said) = outcome(render.arg("-"));
    assert_eq!((status, said.as_str()), (0, ""));

    let mut render = tabray(&folder);
    render
        .args(["render", "ball.ray", "-q", "--format", "ppm", "-o", "pipe"])
        .timeout(Duration::from_secs(60));
    let mut reader = Command::new("cat").arg(&path).stdout(Stdio::piped()).spawn().expect("a reader");
    let (status, _, said) = outcome(&mut render);
    let mut read = Vec::new();
    if status != 0 {
        reader.kill().expect("a reader");
    }
    reader.stdout.take().expect("a pipe").read_to_end(&mut read).expect("what was written");
    reader.wait().expect("a reader");
    assert_eq!((status, said.as_str()), (0, ""));
    assert!(read == bytes);

    let (status, _, said) = outcome(&mut render);
    assert_eq!(
        (status, said.as_str()),
        (1, "error: cannot write `pipe`: no program reads this pipe (waited 5 s)\n")
    );
}

/// A formula whose check takes as many evaluations as that of a short one takes minutes.
#[test]
fn a_formula_of_a_hundred_thousand_factors_is_read() {
    let scene = format!(
        "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }}
        implicit wall {{ material m box -1 -1 -1 1 1 1 formula \"{}x - 0.5\" }}",
        "x*".repeat(100_000)
    );
    let folder = folder();
    let mut check = tabray(&folder);
    let (status, _, said) =
        outcome(check.args(["check", "-"]).write_stdin(scene).timeout(Duration::from_secs(60)));
    // On a slow machine its pixels take too long to be tried, and a warning says so.
    assert!(status == 0 && said.ends_with("-: no errors\n"), "{status}: {said}");
}

#[test]
fn a_picture_that_claims_to_be_huge_takes_no_memory() {
    let folder = textured();
    let file = fs::File::create(folder.path().join("picture")).expect("a file");
    let mut encoder = png::Encoder::new(file, 6_000, 6_000);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().and_then(|writer| writer.into_stream_writer()).expect("a header");
    for _ in 0..6_000 {
        writer.write_all(&[0; 18_000]).expect("a row");
    }
    writer.finish().expect("a picture");
    let args = ["render", "textured.ray", "-o", "x.ppm", "--max-memory"];
    let (status, _, said) = outcome(tabray(&folder).args(args).arg("60MiB"));
    assert_eq!(status, 2, "{said}");
    assert!(said.contains("the file of texture `t` cannot be read: it takes more than "), "{said}");
    let (status, _, said) = outcome(tabray(&folder).args(args).arg("1GiB"));
    assert_eq!(status, 0, "{said}");
    // 30000 x 30000 pixels are 2.5 GiB.
    fs::write(folder.path().join("picture"), "P6 30000 30000 255\n").expect("a picture");
    let (status, _, said) = outcome(tabray(&folder).args(["check", "textured.ray"]));
    assert_eq!(status, 2, "{said}");
    assert!(said.contains("it takes more than 1.0 GiB of memory"), "{said}");
}

/// A PNG with a colour profile of 100 MB, which is not read at all.
#[test]
fn a_colour_profile_takes_no_memory() {
    let folder = textured();
    let mut info = png::Info::with_size(2, 2);
    (info.color_type, info.icc_profile) = (png::ColorType::Rgb, Some(vec![0; 100_000_000].into()));
    let mut png = Vec::new();
    let encoder = png::Encoder::with_info(&mut png, info).expect("an encoder");
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[9; 12]).expect("pixels");
    writer.finish().expect("an end");
    assert!(png.len() < 1_000_000);
    fs::write(folder.path().join("picture"), png).expect("a picture");
    let args = ["check", "textured.ray", "--max-memory", "64MiB"];
    let (status, _, said) = outcome(tabray(&folder).args(args));
    assert!(status == 0 && said.ends_with("textured.ray: no errors\n"), "{said}");
}

/// Each command keeps to the limit, and names it.
#[test]
fn every_command_that_reads_a_scene_keeps_to_the_limit_on_memory() {
    let folder = folder();
    let head = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n";
    let balls = "repeat i 500000 { sphere s { material m center 1 2 3 radius 1 } }\n";
    fs::write(folder.path().join("balls.ray"), format!("{head}{balls}")).expect("a scene");
    fs::write(folder.path().join("rays.txt"), "0 0 9 0 0 -1\n").expect("a file");
    for command in [
        "check",
        "dump",
        "plan",
        "probe @ 1 1",
        "verify",
        "hits @ rays.txt",
        "hard",
        "choose @ --max-error 9",
        "chart",
        "bench",
        "convert @ x.toml",
        "render @ -o x.png",
        "farm commands @ -o x.png --parts 2",
    ] {
        let line = if command.contains('@') {
            command.replace('@', "balls.ray")
        } else {
            format!("{command} balls.ray")
        };
        let mut program = tabray(&folder);
        let (status, _, said) = outcome(program.args(line.split(' ')).args(["--max-memory", "64MiB"]));
        assert_eq!(status, 1, "{line}: {said}");
        assert!(
            said.contains("not enough memory") && said.contains("`--max-memory` is 64.0 MiB"),
            "{line}: {said}"
        );
        assert_eq!(names_in(folder.path()), ["balls.ray", "rays.txt"], "{line}");
    }
}

/// What is not done by then is not shown. Once they have begun, a render, a chart and a choice say what they have.
#[test]
fn every_command_that_reads_a_scene_keeps_to_the_limit_on_time() {
    let folder = folder();
    let head = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n";
    let balls = "repeat i 1000000 { sphere s { material m center 1 2 3 radius 1 } }\n";
    fs::write(folder.path().join("balls.ray"), format!("{head}{balls}")).expect("a scene");
    fs::write(folder.path().join("rays.txt"), "0 0 9 0 0 -1\n").expect("a file");
    for line in [
        "check balls.ray",
        "dump balls.ray",
        "plan balls.ray",
        "probe balls.ray 1 1",
        "verify balls.ray",
        "verify --colours balls.ray",
        "hits balls.ray rays.txt",
        "hard balls.ray",
        "bench balls.ray",
        "chart balls.ray -o x.svg",
        "choose balls.ray --max-error 2",
        "convert balls.ray x.toml",
        "render balls.ray -o x.png",
        "farm commands balls.ray -o x.png --parts 2",
    ] {
        let mut program = tabray(&folder);
        let (status, _, said) = outcome(program.args(line.split(' ')).args(["--time-limit", "30ms"]));
        assert_eq!(status, 130, "{line}: {said}");
        assert!(said.starts_with("the time limit of 30ms has been reached\n"), "{line}: {said}");
        assert_eq!(names_in(folder.path()), ["balls.ray", "rays.txt"], "{line}");
    }
}
