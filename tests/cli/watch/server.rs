//! What the program sends to a page, which clients it answers, and how it ends.

use crate::common::{load, model, render, root};
use crate::watch::program::{Watching, ball};
use assert_cmd::cargo::{cargo_bin, cargo_bin_cmd};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::ops::ControlFlow;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;
use tabray::output::Aov;
use tabray::render::{Plan, to_byte};
use tabray::tools::probe;
use tabray::tools::threads::renderer_with;
use tempfile::TempDir;

/// Sends a request exactly as given; returns the whole answer.
fn raw(port: u16, request: &str) -> String {
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).expect("a connection");
    stream.write_all(request.replace('\n', "\r\n").as_bytes()).expect("it takes the request");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("an answer");
    answer
}

#[test]
fn a_page_is_told_the_picture_that_render_makes_first_coarse_then_all_of_it() {
    let folder = TempDir::new().expect("a folder");
    let path = root().join("scenes/light/shadow.ray");
    fs::copy(&path, folder.path().join("scene.ray")).expect("a copy");
    let watching = Watching::start(folder, &["--port", "0"]);
    let mut events = watching.events();
    let scene = events.until("scene");
    let picture = render(&load(&path));
    assert_eq!(scene["size"], serde_json::json!([picture.width(), picture.height()]));
    assert_eq!(scene["text"], fs::read_to_string(&path).expect("a text"));

    let parts = events.parts();
    let first_fine = parts.iter().position(|part| part.block == 1).expect("a fine part");
    let (coarse, fine) = parts.split_at(first_fine);
    assert!(fine.iter().all(|part| part.block == 1), "what is fine stays fine");
    for parts in [coarse, fine] {
        let covered: usize = parts.iter().map(|part| part.width * part.height).sum();
        assert_eq!(covered, picture.pixels().len());
    }
    let mut told = image::RgbImage::new(picture.width(), picture.height());
    for part in fine {
        let (colours, _) = part.channels.as_chunks::<3>();
        for (index, colour) in colours.iter().enumerate() {
            let (x, y) = (part.left + index % part.width, part.top + index / part.width);
            told.put_pixel(x as u32, y as u32, image::Rgb(colour.map(|channel| to_byte(channel.into()))));
        }
    }
    assert!(told == picture, "the same bytes");
}

#[test]
fn pixels_of_several_samples_first_have_one_ray_each() {
    let watching = Watching::text(&ball("9 0 0").replace("viewpoint", "samples 4 viewpoint"));
    let mut events = watching.events();
    events.until("scene");
    let parts = events.parts();
    let first_final = parts.iter().position(|part| part.is_final).expect("a final part");
    let (before, after) = parts.split_at(first_final);
    assert!(after.iter().all(|part| part.is_final && part.block == 1));
    let quick: usize =
        before.iter().filter(|part| part.block == 1).map(|part| part.width * part.height).sum();
    assert_eq!(quick, 80 * 60);
}

#[test]
fn a_save_is_told_however_the_file_is_written() {
    let watching = Watching::text(&ball("9 0 0"));
    let mut events = watching.events();
    assert_eq!(events.until("scene")["version"], 1);
    watching.save(&ball("0 9 0"));
    let scene = events.until("scene");
    assert_eq!((&scene["version"], scene["text"].as_str()), (&2.into(), Some(&*ball("0 9 0"))));

    fs::write(watching.scene(), ball("0 0 9")).expect("a file");
    assert_eq!(events.until("scene")["text"], ball("0 0 9"));
    events.until("done");
}

#[test]
fn a_texture_is_watched_even_one_that_is_not_there_yet() {
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("pictures")).expect("a folder");
    let text = "camera eye { pixeldim 80 60 worlddim 8 6 viewpoint 4 3 6 }
        material wall { ambient 9 9 9 } texture tiles { filename pictures/tiles.ppm }
        texplane wall { material wall texname tiles normal 0 0 1 xdir 1 0 0 point 0 0 -1 dimensions 8 6 mode 0 }";
    fs::write(folder.path().join("scene.ray"), text).expect("a file");
    let watching = Watching::start(folder, &["--port", "0"]);
    let mut events = watching.events();
    let fault = events.until("fault");
    assert!(
        fault["report"].as_str().is_some_and(|report| report.contains("`tiles` cannot be read")),
        "{fault}"
    );

    let texture = watching.folder.path().join("pictures/tiles.ppm");
    fs::write(&texture, b"P6 1 1 255 \xff\x00\x00").expect("a file");
    assert_eq!(events.until("scene")["version"], 1);
    events.until("done");
    fs::write(&texture, b"P6 1 1 255 \x00\xff\x00").expect("a file");
    assert_eq!(events.until("scene")["version"], 2);
    let parts = events.parts();
    // Which part comes last is up to the threads, and its first pixel may look past the wall.
    let (colours, _) = parts.last().expect("a part").channels.as_chunks::<3>();
    assert!(colours.iter().all(|[red, _, blue]| (*red, *blue) == (0.0, 0.0)));
    assert!(colours.iter().any(|[_, green, _]| *green > 0.0));
}

#[test]
fn an_included_file_is_watched_even_one_that_is_not_there_yet() {
    let folder = TempDir::new().expect("a folder");
    let text = "include parts.inc
        camera eye { pixeldim 80 60 worlddim 8 6 viewpoint 4 3 6 } sphere a { material m center 4 3 -3 radius 1 }";
    fs::write(folder.path().join("scene.ray"), text).expect("a file");
    let watching = Watching::start(folder, &["--port", "0", "--set", "a.radius=2"]);
    let mut events = watching.events();
    let fault = events.until("fault");
    let says = fault["report"].as_str().is_some_and(|report| report.contains("cannot read `parts.inc`"));
    assert!(says, "{fault}");
    let parts = watching.folder.path().join("parts.inc");
    fs::write(&parts, "material m { ambient 9 0 0 }").expect("a file");
    assert_eq!(events.until("scene")["version"], 1);
    fs::write(&parts, "material m { ambient 0 9 0 }").expect("a file");
    assert_eq!(events.until("scene")["version"], 2);
    fs::write(&parts, "material m { ambient -9 }").expect("a file");
    events.until("fault");
}

#[test]
fn a_broken_scene_leaves_the_last_good_picture_to_every_page() {
    let watching = Watching::text(&ball("9 0 0"));
    let mut events = watching.events();
    events.until("done");
    watching.save(&ball("9 0 0").replace("radius 2", "raduis 2"));
    let fault = events.until("fault");
    let report = fault["report"].as_str().expect("a text");
    assert!(report.contains("did you mean `radius`?") && report.contains("scene.ray:6:20"), "{report}");
    assert_eq!(fault["lines"], serde_json::json!([6]));
    assert_eq!(watching.get("probe/1/40/30").0, 200);

    let mut late = watching.events();
    assert_eq!(late.until("scene")["version"], 1);
    assert!(!late.parts().is_empty());
    assert_eq!(late.next().0, "fault");

    fs::remove_file(watching.scene()).expect("it was there");
    let fault = events.until("fault");
    assert!(
        fault["report"].as_str().is_some_and(|report| report.contains("cannot read `scene.ray`")),
        "{fault}"
    );
    assert_eq!(fault["text"], Value::Null);
    watching.save(&ball("9 0 0"));
    assert_eq!(events.until("scene")["version"], 2);
}

#[test]
fn a_save_ends_the_render_under_way() {
    // This render would take days.
    let heavy = ball("9 0 0").replace("80 60", "4000 4000").replace("viewpoint", "samples 65536 viewpoint");
    let watching = Watching::text(&heavy);
    let mut events = watching.events();
    assert_eq!(events.until("scene")["version"], 1);
    watching.save(&ball("0 9 0"));
    assert_eq!(events.until("done")["version"], 2);
    assert_eq!(watching.get("probe/1/0/0").0, 410);
}

#[test]
fn a_pixel_is_explained_as_probe_does_with_the_lines_of_its_object() {
    let text = ball("9 0 0");
    let watching = Watching::text(&text);
    watching.events().until("done");
    for ([x, y], lines) in [([40, 30], serde_json::json!([3, 7])), ([0, 0], Value::Null)] {
        let (status, answer) = watching.get(&format!("probe/1/{x}/{y}"));
        let answer: Value = serde_json::from_slice(&answer).expect("JSON");
        let mut told = Vec::new();
        probe::pixel(&Plan::new(&model(&text)), x, y, &mut told).expect("memory takes it");
        assert_eq!((status, answer["text"].as_str()), (200, str::from_utf8(&told).ok()));
        assert_eq!(answer["lines"], lines);
    }
    for path in ["probe/1/80/0", "probe/1/0/60", "probe/1/-1/0", "layer/1/nothing"] {
        assert_eq!(watching.get(path), (404, b"the image has no such part\n".to_vec()), "{path}");
    }
    assert_eq!(watching.get("nothing"), (404, b"there is no such page\n".to_vec()));
    assert_eq!(watching.get("probe/2/0/0"), (410, b"this image no longer exists\n".to_vec()));
}

#[test]
fn an_object_in_toml_has_its_lines_too() {
    let folder = TempDir::new().expect("a folder");
    let text = "[camera.eye]\npixeldim = [80, 60]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n\
        [material.paint]\nambient = [9, 0, 0]\n\n[sphere.ball]\nmaterial = 'paint'\ncenter = [4, 3, -3]\nradius = 2\n";
    fs::write(folder.path().join("scene.ray"), text).expect("a file");
    let watching = Watching::start(folder, &["--port", "0"]);
    watching.events().until("done");
    let answer: Value = serde_json::from_slice(&watching.get("probe/1/40/30").1).expect("JSON");
    assert_eq!(answer["lines"], serde_json::json!([8, 11]));
}

#[test]
fn the_layers_are_those_of_aov() {
    let watching = Watching::text(&ball("9 0 0"));
    watching.events().until("done");
    let renderer = renderer_with(1).expect("a thread");
    for aov in [Aov::Depth, Aov::Normal, Aov::Object, Aov::Cost] {
        let model = model(&ball("9 0 0"));
        let plan = Plan::new(&model);
        let layer = aov.render(&renderer, &plan, &plan, &|| ControlFlow::Continue(()));
        let expected = layer.unwrap_or_else(|_| panic!("nobody interrupts {aov:?}")).bytes;
        assert_eq!(watching.get(&format!("layer/1/{}", format!("{aov:?}").to_lowercase())), (200, expected));
    }
}

#[test]
fn a_picture_too_large_for_a_page_is_refused_with_the_size_that_is_not() {
    let watching = Watching::text(&ball("9 0 0").replace("80 60", "100000 100000"));
    let fault = watching.events().until("fault");
    let said = "error: an image of 100000 x 100000 pixels is too large for a page\n\
                help: the maximum is 16777216 pixels, such as 4096 x 4096";
    assert_eq!(fault["report"], said);
}

#[test]
fn foreign_hosts_and_origins_are_refused() {
    let watching = Watching::text(&ball("9 0 0"));
    let port = watching.port;
    let status = |headers: &str| {
        let request = format!("GET /?token={} HTTP/1.1\nConnection: close\n{headers}\n", watching.token);
        let answer = raw(port, &request);
        answer.split(' ').nth(1).and_then(|status| status.parse::<u16>().ok()).expect("a status")
    };
    for own in ["127.0.0.1", "localhost"] {
        assert_eq!(status(&format!("Host: {own}:{port}\n")), 200);
        assert_eq!(status(&format!("Host: {own}:{port}\nOrigin: http://{own}:{port}\n")), 200);
    }
    for foreign in [
        "Host: example.com\n".to_owned(),
        format!("Host: example.com:{port}\n"),
        format!("Host: 127.0.0.1.example.com:{port}\n"),
        "Host: 127.0.0.1\n".to_owned(),
        "Host: 127.0.0.1:1\n".to_owned(),
        String::new(),
        format!("Host: 127.0.0.1:{port}\nOrigin: http://example.com\n"),
        format!("Host: 127.0.0.1:{port}\nOrigin: https://127.0.0.1:{port}\n"),
        format!("Host: 127.0.0.1:{port}\nOrigin: null\n"),
        format!("Host: 127.0.0.1:{port}\nHost: example.com\n"),
    ] {
        let status = status(&foreign);
        assert!(status == 403 || status == 400, "{status} for {foreign}");
    }
    let token = &watching.token;
    let post = format!("POST /?token={token} HTTP/1.1\nHost: 127.0.0.1:{port}\nConnection: close\n");
    let answer = raw(port, &format!("{post}\n"));
    assert!(answer.starts_with("HTTP/1.1 403 "), "{answer}");
    let answer = raw(port, &format!("{post}Origin: http://127.0.0.1:{port}\n\n"));
    assert!(answer.starts_with("HTTP/1.1 404 "), "{answer}");
    let put = post.replace("POST", "PUT");
    let answer = raw(port, &format!("{put}Origin: http://127.0.0.1:{port}\n\n"));
    assert!(answer.starts_with("HTTP/1.1 405 "), "{answer}");
}

#[test]
fn the_page_is_one_file_without_links() {
    let watching = Watching::text(&ball("9 0 0"));
    let (status, page) = watching.get("");
    let page = String::from_utf8(page).expect("text");
    assert_eq!(status, 200);
    for link in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!page.contains(link), "{link}");
    }
    let head = raw(
        watching.port,
        &format!(
            "GET /?token={} HTTP/1.1\nHost: 127.0.0.1:{}\nConnection: close\n\n",
            watching.token, watching.port
        ),
    );
    for header in ["content-security-policy: default-src 'none';", "referrer-policy: no-referrer"] {
        assert!(head.contains(header), "{head}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn nothing_listens_beyond_loopback() {
    let watching = Watching::text(&ball("9 0 0"));
    let port = format!(":{:04X}", watching.port);
    let listening: Vec<_> = ["/proc/net/tcp", "/proc/net/tcp6"]
        .iter()
        .flat_map(|table| {
            fs::read_to_string(table).unwrap_or_default().lines().map(str::to_owned).collect::<Vec<_>>()
        })
        .filter_map(|line| {
            let words: Vec<_> = line.split_whitespace().collect();
            // The fourth word is the state; 0A means listening.
            (words[3] == "0A" && words[1].ends_with(&port)).then(|| words[1].to_owned())
        })
        .collect();
    assert_eq!(listening, [format!("0100007F{port}")]);
}

#[test]
fn a_taken_port_is_passed_over_unless_it_is_asked_for() {
    let watch = |args: &[&str]| {
        let folder = TempDir::new().expect("a folder");
        fs::write(folder.path().join("scene.ray"), ball("9 0 0")).expect("a file");
        Watching::start(folder, args)
    };
    let (first, second) = (watch(&[]), watch(&[]));
    assert!(first.port >= 3000 && second.port > first.port, "{} {}", first.port, second.port);

    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let port = taken.local_addr().expect("its address").port().to_string();
    let output = cargo_bin_cmd!("tabray")
        .arg("watch")
        .arg(first.scene())
        .args(["--port", &port])
        .output()
        .expect("the program runs");
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.starts_with(&format!("error: port {port} is in use")), "{err}");
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().to_str().expect("a path in UTF-8");
    for (status, scene, reason) in [
        (2, "-", "standard input cannot be watched"),
        (1, "no-such-scene.ray", "cannot read `no-such-scene.ray`"),
        (1, "no/such/folder.ray", "cannot read `no/such/folder.ray`"),
        (1, path, "there is no scene in the folder"),
    ] {
        let output = cargo_bin_cmd!("tabray")
            .current_dir(folder.path())
            .args(["watch", scene, "--port", "0"])
            .output()
            .expect("the program runs");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{err}");
        assert!(err.starts_with("error: ") && err.contains(reason), "{err}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_page_without_a_browser_is_to_be_opened_by_hand() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("scene.ray"), ball("9 0 0")).expect("a file");
    let mut watch = Command::new(cargo_bin!("tabray"));
    watch.args(["watch", "scene.ray", "--port", "0", "--open", "--message-format", "json"]);
    watch.current_dir(folder.path()).env("PATH", "").stderr(Stdio::piped());
    let mut watch = watch.spawn().expect("the program runs");
    let mut lines = BufReader::new(watch.stderr.take().expect("its messages")).lines();
    let mut note = || {
        let line = lines.next().expect("a line").expect("text");
        let note: Value = serde_json::from_str(&line).expect("JSON");
        note["message"].as_str().expect("a message").to_owned()
    };
    let (address, browser) = (note(), note());
    let _ = watch.kill();
    watch.wait().expect("it ends");
    assert!(address.starts_with("watching scene.ray at "), "{address}");
    assert!(
        browser.starts_with("cannot open a browser: ") && browser.ends_with("; open the address yourself"),
        "{browser}"
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_with_status_0_even_while_it_renders() {
    let heavy = ball("9 0 0").replace("80 60", "4000 4000").replace("viewpoint", "samples 65536 viewpoint");
    let mut watching = Watching::text(&heavy);
    let killed = std::process::Command::new("kill").args(["-INT", &watching.child.id().to_string()]).status();
    assert!(killed.expect("kill runs").success());
    assert_eq!(watching.child.wait().expect("it ends").code(), Some(0));
}

#[test]
fn reading_a_file_is_no_change_of_it() {
    let watching = Watching::text(&ball("9 0 0"));
    let mut events = watching.events();
    events.until("done");
    fs::read(watching.scene()).expect("the file");
    thread::sleep(Duration::from_millis(200));
    watching.save(&ball("0 9 0"));
    let scene = events.until("scene");
    assert_eq!((&scene["version"], scene["text"].as_str()), (&2.into(), Some(&*ball("0 9 0"))));
}

/// Returns the CPU time of a process, in hundredths of a second.
#[cfg(target_os = "linux")]
fn cpu_time(process: u32) -> u64 {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).expect("it runs");
    let (_, fields) = stat.rsplit_once(')').expect("its name");
    fields.split_whitespace().skip(11).take(2).map(|ticks| ticks.parse::<u64>().expect("a number")).sum()
}

#[cfg(target_os = "linux")]
#[test]
fn an_image_waits_while_no_page_is_open() {
    let watching = Watching::text(&ball("9 0 0").replace("80 60", "1600 1200 samples 64"));
    let mut events = watching.events();
    events.until("scene");
    drop(events);
    let process = watching.child.id();
    let mut last = cpu_time(process);
    let waiting = loop {
        thread::sleep(Duration::from_millis(500));
        let now = cpu_time(process);
        if now <= last + 2 {
            break now;
        }
        last = now;
    };
    let mut events = watching.events();
    events.until("done");
    // It was not finished before.
    assert!(cpu_time(process) > waiting + 20);
}
