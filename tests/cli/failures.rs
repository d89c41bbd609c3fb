//! Messages where the system refuses what the program needs.
#![cfg(target_os = "linux")]

use crate::common::program::{folder, scene};
use assert_cmd::cargo::cargo_bin;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// Makes a working directory with a valid scene, `ball.ray`.
fn workplace() -> TempDir {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("ball.ray")).expect("a copy");
    folder
}

/// Returns a command that runs the program after some lines of shell code.
fn after(lines: &str, folder: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("{lines}\nexec \"$0\" \"$@\"")]).arg(cargo_bin!("tabray")).args(args);
    command.current_dir(folder.path());
    command
}

/// Runs a command; returns its exit status and its messages.
fn outcome(command: &mut Command) -> (i32, String) {
    let Output { status, stderr, .. } = command.output().expect("it runs");
    (status.code().unwrap_or(-1), String::from_utf8_lossy(&stderr).into_owned())
}

#[test]
fn standard_output_that_is_full_is_a_failure() {
    let folder = workplace();
    for args in [
        &["list"][..],
        &["dump", "ball.ray"],
        &["probe", "ball.ray", "1", "1"],
        &["render", "ball.ray", "-o", "-"],
        &["--help"],
        &["--version"],
        &["help", "render"],
    ] {
        let said = "error: cannot write to standard output: no space left on device\n".to_owned();
        assert_eq!(outcome(&mut after("exec > /dev/full", &folder, args)), (1, said), "{args:?}");
    }
}

#[test]
fn a_full_disk_leaves_the_old_picture() {
    // Exceeding the limit on file sizes fails like a full disk, with another reason.
    let folder = workplace();
    fs::write(folder.path().join("ball.png"), "precious").expect("a file");
    let limit = "trap '' XFSZ; ulimit -f 1";
    let args = ["render", "ball.ray", "--size", "600", "--compress", "fast"];
    let said = "error: cannot write `ball.png`: file too large\n".to_owned();
    assert_eq!(outcome(&mut after(limit, &folder, &args)), (1, said));
    assert_eq!(fs::read(folder.path().join("ball.png")).expect("still there"), b"precious");
}

#[test]
fn a_file_that_may_not_be_so_large_is_told_and_not_a_signal() {
    let folder = workplace();
    fs::write(folder.path().join("ball.png"), "precious").expect("a file");
    for args in [&["render", "ball.ray", "--size", "600"][..], &["convert", "ball.ray", "ball.toml"]] {
        let limit = if args[0] == "convert" { "ulimit -f 0" } else { "ulimit -f 1" };
        let name = if args[0] == "convert" { "ball.toml" } else { "ball.png" };
        let said = format!("error: cannot write `{name}`: file too large\n");
        assert_eq!(outcome(&mut after(limit, &folder, args)), (1, said));
    }
    assert_eq!(fs::read(folder.path().join("ball.png")).expect("still there"), b"precious");
}

#[test]
fn an_image_whose_reader_is_gone_is_a_failure() {
    let folder = workplace();
    let mut command = after("", &folder, &["render", "ball.ray", "-o", "-", "--size", "600"]);
    let mut render = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
    drop(render.stdout.take());
    let output = render.wait_with_output().expect("it ends");
    let said = "error: cannot write to standard output: broken pipe\n";
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(1), said));
}

#[test]
fn text_whose_reader_is_gone_is_no_failure() {
    let folder = workplace();
    for args in [&["hard", "ball.ray", "-n", "20000"][..], &["hits", "ball.ray", "--from-camera"]] {
        let mut command = after("", &folder, args);
        let mut program = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        drop(program.stdout.take());
        let output = program.wait_with_output().expect("it ends");
        assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
    }
}

#[test]
fn standard_output_that_is_closed_is_a_failure() {
    let folder = workplace();
    let said = "error: cannot write to standard output: it is closed\n";
    for args in [
        &["dump", "ball.ray"][..],
        &["hits", "ball.ray", "--from-camera"],
        &["probe", "ball.ray", "3", "3"],
        &["render", "ball.ray", "-o", "-"],
    ] {
        assert_eq!(outcome(&mut after("exec >&-", &folder, args)), (1, said.to_owned()), "{args:?}");
    }
}

/// Many programs start others with such an output, to be rid of what they say.
#[test]
fn a_null_device_that_is_open_for_reading_too_is_no_closed_output() {
    let folder = workplace();
    assert_eq!(outcome(&mut after("exec 1<> /dev/null", &folder, &["dump", "ball.ray"])), (0, String::new()));
}

#[test]
fn an_image_does_not_replace_what_it_is_made_from() {
    let folder = workplace();
    let at = |name: &str| folder.path().join(name);
    let textured = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
        include white.ray
        texture bricks { filename bricks.png }
        texplane wall { material white normal 0 0 1 point 0 0 -8 xdir 1 0 0 dimensions 8 6 texname bricks mode 0 }";
    fs::write(at("wall.ray"), textured).expect("a file");
    fs::write(at("white.ray"), "material white { ambient 2 2 2 }").expect("a file");
    fs::copy(scene("textures/bricks.png"), at("bricks.png")).expect("a copy");
    fs::hard_link(at("bricks.png"), at("other.png")).expect("a name");
    symlink("wall.ray", at("link.png")).expect("a link");
    symlink("bricks.png", at("wall-depth.png")).expect("a link");
    for name in
        ["a.png.checkpoint", "b.png.part-1-of-2", "c.png.part-2-of-2.checkpoint", "d-depth.png.part-1-of-2"]
    {
        fs::hard_link(at("bricks.png"), at(name)).expect("a name");
    }
    fs::hard_link(at("white.ray"), at("e-normal.exr")).expect("a name");
    let before = |name: &str| fs::read(at(name)).expect("it is there");
    let (wall, bricks) = (before("wall.ray"), before("bricks.png"));
    let refused = |args: &[&str], what: &str, by: &str| {
        let args = [&["render", "wall.ray"], args].concat();
        let said = format!(
            "error: {what}, which {by} would replace\n |\n = help: name another file with `-o FILE`\n"
        );
        assert_eq!(outcome(&mut after("", &folder, &args)), (2, said), "{args:?}");
    };
    for (output, more, what) in [
        ("wall.ray", &[][..], "`wall.ray` is the scene"),
        ("./link.png", &[], "`./link.png` is the scene"),
        ("bricks.png", &[], "`bricks.png` is the image of texture `bricks`"),
        ("other.png", &[], "`other.png` is the image of texture `bricks`"),
        ("wall.png", &["--aov", "depth"], "`wall-depth.png` is the image of texture `bricks`"),
        ("white.ray", &[], "`white.ray` is a file that the scene is read from"),
        ("e.png", &["--aov", "depth,normal"], "`e-normal.exr` is a file that the scene is read from"),
    ] {
        refused(&[&["--format", "png", "-o", output], more].concat(), what, "the image");
    }
    refused(
        &["-o", "e.exr", "--aov", "normal"],
        "`e-normal.exr` is a file that the scene is read from",
        "the image",
    );
    for (output, more, name, by) in [
        ("a.png", &[][..], "a.png.checkpoint", "a checkpoint"),
        ("b.png", &["--part", "1/2"], "b.png.part-1-of-2", "a part of the image"),
        ("c.png", &["--part", "2/2"], "c.png.part-2-of-2.checkpoint", "a checkpoint"),
        ("d.png", &["--part", "1/2", "--aov", "depth"], "d-depth.png.part-1-of-2", "a part of the image"),
    ] {
        let what = format!("`{name}` is the image of texture `bricks`");
        refused(&[&["-o", output], more].concat(), &what, by);
    }
    // What belongs to another part or to another way of rendering is not written.
    for args in [&["-o", "b.png"][..], &["-o", "b.png", "--part", "2/2"], &["-o", "d.png", "--aov", "depth"]]
    {
        let args = [&["render", "wall.ray", "--size", "64"], args].concat();
        assert_eq!(outcome(&mut after("", &folder, &args)).0, 0, "{args:?}");
    }
    for (args, what) in [
        (&["verify", "wall.ray", "-o", "bricks.png"][..], "`bricks.png` is the image of texture `bricks`"),
        (
            &["verify", "wall.ray", "--colours", "-o", "other.png"],
            "`other.png` is the image of texture `bricks`",
        ),
        (&["chart", "wall.ray", "-o", "bricks.png"], "`bricks.png` is the image of texture `bricks`"),
    ] {
        let (status, said) = outcome(&mut after("", &folder, args));
        let refused = format!("error: {what}, which the image would replace\n");
        assert!(status == 2 && said.starts_with(&refused), "{args:?}: {said}");
    }
    let said = "error: `wall.ray` is the scene, which the image would replace\n |\n = help: name another file with `-o FILE`\n";
    let args = ["render", "-", "--format", "ppm", "-o", "wall.ray"];
    assert_eq!(outcome(&mut after("exec < wall.ray", &folder, &args)), (2, said.to_owned()));
    assert!(before("wall.ray") == wall && before("bricks.png") == bricks);
}

#[test]
fn a_copy_does_not_replace_the_scene() {
    let folder = workplace();
    let at = |name: &str| folder.path().join(name);
    let before = fs::read(at("ball.ray")).expect("a scene");
    symlink("ball.ray", at("link.ray")).expect("a link");
    for (args, lines) in [
        (["convert", "ball.ray", "ball.ray"], ""),
        (["convert", "ball.ray", "./link.ray"], ""),
        (["convert", "-", "ball.ray"], "exec < ball.ray"),
    ] {
        let (status, said) = outcome(&mut after(lines, &folder, &args));
        assert!(
            status == 2 && said.contains("is the scene, which the copy would replace"),
            "{args:?}: {said}"
        );
    }
    assert_eq!(fs::read(at("ball.ray")).expect("still there"), before);
    assert_eq!(outcome(&mut after("", &folder, &["convert", "ball.ray", "copy.ray"])).0, 0);
}

#[test]
fn a_render_under_nohup_outlives_its_terminal() {
    let folder = workplace();
    let hang_up = |lines: &str| {
        let args = ["render", "ball.ray", "--size", "400", "--samples", "16384", "--time-limit", "3s"];
        let mut render = after(lines, &folder, &args).stderr(Stdio::piped()).spawn().expect("it starts");
        thread::sleep(Duration::from_secs(1));
        kill(Pid::from_raw(render.id() as i32), Signal::SIGHUP).expect("a signal");
        let mut said = String::new();
        render.stderr.take().expect("a pipe").read_to_string(&mut said).expect("a text");
        render.wait().expect("an end");
        said
    };
    let said = hang_up("trap '' HUP");
    assert!(said.contains("the time limit of 3s has been reached"), "{said}");
    // The tests themselves may run under nohup, and a shell cannot undo that.
    let said = hang_up("exec env --default-signal=HUP \"$0\" \"$@\"");
    assert!(said.contains("interrupted") && !said.contains("limit"), "{said}");
}

#[test]
fn a_link_to_nothing_yet_stays_a_link() {
    let folder = workplace();
    fs::create_dir(folder.path().join("images")).expect("a folder");
    symlink("images/one.png", folder.path().join("two.png")).expect("a link");
    symlink("two.png", folder.path().join("ball.png")).expect("a link");
    let (status, err) = outcome(&mut after("", &folder, &["render", "ball.ray"]));
    assert_eq!(status, 0, "{err}");
    let is_link = |name: &str| folder.path().join(name).symlink_metadata().expect("there").is_symlink();
    assert!(is_link("ball.png") && is_link("two.png") && !is_link("images/one.png"));
    symlink("round.png", folder.path().join("round.png")).expect("a link");
    let (status, err) = outcome(&mut after("", &folder, &["render", "ball.ray", "-o", "round.png"]));
    assert_eq!(status, 1, "{err}");
    assert!(err.starts_with("error: cannot write `round.png`: too many levels of symbolic links"), "{err}");
}

#[test]
fn what_is_written_is_on_the_disk_before_it_has_its_name() {
    let folder = workplace();
    let mut traced = Command::new("strace");
    traced.args(["-f", "-e", "trace=fsync,linkat,rename,renameat,renameat2", "-o", "calls"]);
    traced.arg(cargo_bin!("tabray")).args(["render", "ball.ray"]).current_dir(folder.path());
    if !traced.output().is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: there is no `strace` here, or it may not be used");
        return;
    }
    let calls = fs::read_to_string(folder.path().join("calls")).expect("text");
    let calls = calls.lines().filter_map(|line| Some(line.split_once(' ')?.1.trim().split_once('(')?.0));
    // `strace` writes `???` for the call of a thread that has just ended.
    let calls: Vec<_> = calls.filter(|call| *call != "???").collect();
    assert_eq!(calls, ["fsync", "linkat", "fsync"]);
}

#[test]
fn threads_that_the_system_does_not_give_are_a_failure() {
    let folder = workplace();
    let args = ["render", "ball.ray", "--threads", "1000", "-o", "a.png"];
    let (status, err) = outcome(&mut after("ulimit -v 4000000", &folder, &args));
    assert_eq!(status, 1, "{err}");
    assert!(err.starts_with("error: cannot start threads to render with: "), "{err}");
    assert!(!folder.path().join("a.png").exists());
}

#[test]
fn too_few_open_files_are_a_failure_of_whatever_needs_one() {
    let folder = workplace();
    let mut told = BTreeSet::new();
    'limits: for limit in 4.. {
        let limit = format!("ulimit -n {limit}");
        let mut watch = after(&limit, &folder, &["watch", "ball.ray", "--port", "0"]);
        let mut watch = watch.stderr(Stdio::piped()).spawn().expect("it runs");
        let (mut last, mut caller) = (String::new(), None);
        for line in BufReader::new(watch.stderr.take().expect("it is piped")).lines() {
            last = line.expect("text");
            if let Some((_, address)) = last.split_once("watching ball.ray at http://") {
                caller = address.split_once('/').map(|(address, _)| TcpStream::connect(address));
            }
            // It has all that it needs itself.
            if last.starts_with("warning: cannot accept every connection: ") {
                watch.kill().and_then(|()| watch.wait()).expect("it ends");
                break 'limits;
            }
        }
        drop(caller);
        // With even fewer files, the shell cannot start the program.
        match watch.wait().expect("it ends").code() {
            Some(1) => drop(told.insert(last)),
            status => assert_eq!(status, Some(127), "{last}"),
        }
    }
    let said = ["cannot read `ball.ray`", "the server stopped"];
    assert_eq!(Vec::from_iter(told), said.map(|said| format!("error: {said}: too many open files")));
}

/// Another user, who may read this folder and its contents but change nothing.
struct Guest {
    folder: TempDir,
}

impl Guest {
    fn new() -> Self {
        let folder = workplace();
        // The copy is made by another process: a program that another test starts meanwhile would inherit the copy's
        // open file, and a file that is open for writing cannot be run.
        let copied = Command::new("cp").arg(cargo_bin!("tabray")).arg(folder.path().join("tabray")).status();
        assert!(copied.expect("cp runs").success());
        Self { folder }
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    fn allow(&self, name: &str, mode: u32) {
        fs::set_permissions(self.path(name), fs::Permissions::from_mode(mode)).expect("permissions");
    }

    /// Runs the program; root runs it as an unprivileged user.
    fn outcome(&self, args: &[&str]) -> (i32, String) {
        let mut command = Command::new(self.path("tabray"));
        command.args(args).current_dir(self.folder.path());
        if fs::metadata("/proc/self").expect("a process").uid() == 0 {
            command.uid(65534).gid(65534);
        }
        outcome(&mut command)
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        self.allow("", 0o755);
    }
}

#[test]
fn folders_and_files_without_permission_are_named() {
    let guest = Guest::new();
    fs::create_dir(guest.path("snapshots")).expect("a folder");
    fs::write(guest.path("snapshots/a.snap.new"), "---\n---\na text\n").expect("a file");
    fs::write(guest.path("secret.ray"), "").expect("a file");
    fs::create_dir(guest.path("closed")).expect("a folder");
    fs::copy(guest.path("ball.ray"), guest.path("closed/ball.ray")).expect("a copy");
    for (name, mode) in [("", 0o555), ("snapshots", 0o555), ("secret.ray", 0o000), ("closed", 0o111)] {
        guest.allow(name, mode);
    }
    for (status, args, said) in [
        (1, &["render", "ball.ray"][..], "cannot write `ball.png`: permission denied"),
        (1, &["new", "scene", "a"], "cannot write `a.ray`: permission denied"),
        (1, &["convert", "ball.ray", "ball.toml"], "cannot write `ball.toml`: permission denied"),
        (1, &["man", "pages"], "cannot create the folder `pages`: permission denied"),
        (1, &["chart", "ball.ray", "-o", "charts"], "cannot create the folder `charts`: permission denied"),
        (1, &["check", "secret.ray"], "cannot read `secret.ray`: permission denied"),
        (1, &["review", "closed"], "cannot read `closed`: permission denied"),
        (1, &["review", "--reject", "snapshots"], "cannot remove `snapshots/a.snap.new`: permission denied"),
    ] {
        assert_eq!(guest.outcome(args), (status, format!("error: {said}\n")), "{args:?}");
    }
    let free = fs::read_to_string("/proc/sys/net/ipv4/ip_unprivileged_port_start");
    if free.is_ok_and(|free| free.trim().parse::<u16>().is_ok_and(|free| free > 80)) {
        let said = "error: cannot listen on port 80: permission denied\n".to_owned();
        assert_eq!(guest.outcome(&["watch", "ball.ray", "--port", "80"]), (1, said));
    }
    guest.allow("snapshots", 0o755);
    guest.allow("closed", 0o755);
    assert!(Path::new(&guest.path("snapshots/a.snap.new")).is_file());
}

#[test]
fn a_program_that_cannot_read_itself_says_so_where_a_checkpoint_must_know_it() {
    let guest = Guest::new();
    guest.allow("", 0o777);
    guest.allow("tabray", 0o111);
    fs::write(guest.path("ball.png.checkpoint"), checkpoint()).expect("a file");
    let said =
        "error: cannot read the program's own file, whose hash a checkpoint contains: permission denied\n";
    assert_eq!(guest.outcome(&["render", "ball.ray", "--resume"]), (1, said.to_owned()));
}

/// Makes a file that claims to be a checkpoint.
fn checkpoint() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.add_itxt_chunk("tabray checkpoint".to_owned(), "{}".to_owned()).expect("a text");
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&[0; 4])).expect("memory takes it");
    bytes
}

#[test]
fn a_terminal_gets_no_picture() {
    let folder = workplace();
    let terminal = |command: &str| {
        let program = cargo_bin!("tabray").to_str().expect("UTF-8");
        let mut script = Command::new("script");
        script.args(["-qec", &command.replace("tabray", &format!("'{program}'")), "/dev/null"]);
        script.current_dir(folder.path()).stdin(Stdio::null()).env("NO_COLOR", "1").output()
    };
    for command in ["tabray render ball.ray -o -", "tabray < ball.ray"] {
        let Ok(output) = terminal(command) else {
            eprintln!("SKIPPED: there is no `script` here, which makes a terminal");
            return;
        };
        let said = String::from_utf8_lossy(&output.stdout).replace('\r', "");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(
            said,
            "error: standard output is a terminal, which cannot show images\n |\n \
             = help: redirect it with `> FILE` or `|`, or name a file with `-o FILE`\n"
        );
    }
}

#[test]
fn a_person_who_types_the_name_alone_gets_the_help() {
    let folder = folder();
    let program = cargo_bin!("tabray").to_str().expect("UTF-8");
    let output = Command::new("script")
        .args(["-qec", &format!("'{program}'"), "/dev/null"])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .output();
    let Ok(output) = output else {
        eprintln!("SKIPPED: there is no `script` here, which makes a terminal");
        return;
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("Usage: tabray [OPTIONS] [COMMAND]"), "{said}");
}
