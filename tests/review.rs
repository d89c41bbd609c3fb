//! `tabray diff` and `tabray review`: what they count, what their pages hold, and what accepting and rejecting does.

mod common;

use assert_cmd::cargo::{cargo_bin, cargo_bin_cmd};
use common::root;
use image::{DynamicImage, Rgb, RgbImage};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// The exit status, standard output and standard error of the program in a folder.
fn tabray(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).args(args).output().expect("the program runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

fn folder() -> TempDir {
    TempDir::new().expect("a folder")
}

/// A picture of 4 x 3 pixels, and one whose second pixel of the top row has more blue.
fn pictures() -> [RgbImage; 2] {
    let old = RgbImage::from_pixel(4, 3, Rgb([10, 20, 30]));
    let mut new = old.clone();
    new.put_pixel(1, 0, Rgb([10, 20, 60]));
    [old, new]
}

/// A folder with both of them, one in each format.
fn with_pictures() -> TempDir {
    let folder = folder();
    for (picture, name) in pictures().into_iter().zip(["old.png", "new.ppm"]) {
        picture.save(folder.path().join(name)).expect("room for a picture");
    }
    folder
}

/// What a page was given to show.
fn data(html: &str) -> Value {
    let (_, data) = html.split_once("id=\"data\">").expect("a page has its data");
    let (data, _) = data.split_once("</script>").expect("the data end");
    serde_json::from_str(data).expect("JSON")
}

#[test]
fn a_difference_is_counted_measured_and_located() {
    let (status, out, err) = tabray(with_pictures().path(), &["diff", "old.png", "new.ppm"]);
    assert_eq!((status, err.as_str()), (1, ""));
    assert_eq!(
        out,
        "1 of 12 pixels differs (8.3333 %); largest difference 30 levels, RMS 5.0000\n\
         first at 1 from the left and 2 from the bottom: (10, 20, 30) became (10, 20, 60)\n"
    );
}

#[test]
fn pictures_are_the_same_within_the_tolerance() {
    let folder = with_pictures();
    let status = |args: &[&str]| tabray(folder.path(), &[&["diff"], args].concat()).0;
    assert_eq!(status(&["old.png", "old.png"]), 0);
    assert_eq!(status(&["old.png", "new.ppm", "--tolerance", "30"]), 0);
    assert_eq!(status(&["old.png", "new.ppm", "--tolerance", "29"]), 1);
}

#[test]
fn trouble_is_no_difference() {
    let folder = with_pictures();
    let path = folder.path();
    DynamicImage::new_rgb16(4, 3).save(path.join("deep.png")).expect("room for a picture");
    DynamicImage::new_rgba8(4, 3).save(path.join("clear.png")).expect("room for a picture");
    RgbImage::new(4, 4).save(path.join("tall.png")).expect("room for a picture");
    fs::write(path.join("text.png"), "no picture").expect("room for a file");
    for (args, message) in [
        (&["nothing.png"][..], "cannot read `nothing.png`"),
        (&["text.png"], "cannot read `text.png`"),
        (&["deep.png"], "8 bits a channel"),
        (&["clear.png"], "opaque"),
        (&["tall.png"], "`old.png` has 4 x 3 pixels, and `tall.png` has 4 x 4 pixels"),
        (&["new.ppm", "-o", "new.ppm"], "end it in .html"),
        (&["new.ppm", "-o", "no/page.html"], "cannot write `no/page.html`"),
        (&["new.ppm", "--tolerance", "256"], "256"),
    ] {
        let (status, out, err) = tabray(path, &[&["diff", "old.png"], args].concat());
        assert_eq!((status, out.as_str()), (2, ""), "{args:?}: {err}");
        assert!(err.contains(message), "{err}");
    }
    assert_eq!(image::open(path.join("new.ppm")).expect("still a picture").into_rgb8(), pictures()[1]);
}

#[test]
fn a_page_stands_alone_and_escapes_names() {
    let folder = with_pictures();
    let name = "<b onclick=a>.png";
    pictures()[0].save(folder.path().join(name)).expect("room for a picture");
    let (status, _, err) = tabray(folder.path(), &["diff", name, "new.ppm", "-o", "page.html"]);
    assert_eq!(status, 1, "{err}");
    let html = fs::read_to_string(folder.path().join("page.html")).expect("the page");
    for link in ["http://", "https://", "src=", "href=\"/", "url(", "@import", name] {
        assert!(!html.contains(link), "{link}");
    }
    let data = data(&html);
    let item = &data["items"][0];
    assert_eq!(item["names"], json!([name, "new.ppm"]));
    assert_eq!(item["first"]["x"], 1);
    assert_eq!(item["first"]["y"], 2);
    for side in ["old", "new"] {
        assert!(item[side].as_str().expect("a picture").starts_with("data:image/png;base64,"));
    }
}

#[test]
fn the_first_difference_is_explained_and_a_wrong_explanation_is_called_so() {
    let folder = folder();
    let path = folder.path();
    let scene = root().join("scenes/sphere/in-front.ray").display().to_string();
    let (status, _, err) = tabray(path, &["render", &scene, "-o", "new.png"]);
    assert_eq!(status, 0, "{err}");
    let mut old = image::open(path.join("new.png")).expect("a picture").into_rgb8();
    let [r, g, b] = old.get_pixel(80, 60).0;
    old.put_pixel(80, 60, Rgb([r ^ 1, g, b]));
    old.save(path.join("old.png")).expect("room for a picture");
    let program = cargo_bin!("tabray").to_str().expect("a path in UTF-8");
    let args = ["diff", "old.png", "new.png", "-o", "page.html", "--scene", &scene, "--before", program];
    assert_eq!(tabray(path, &args).0, 1);
    let html = fs::read_to_string(path.join("page.html")).expect("the page");
    let explanations = &data(&html)["items"][0]["explanations"];
    let text = |index: usize| explanations[index][1].as_str().expect("a text").to_owned();
    let probe = tabray(path, &["probe", &scene, "80", "59"]).1;
    assert_eq!(text(1), probe);
    let wrong =
        format!("the picture has ({}, {g}, {b}) here and was made otherwise than this:\n\n{probe}", r ^ 1);
    assert_eq!(text(0), wrong);
}

/// A folder with the snapshots of tests that failed: a picture and a text that changed, and a text that is new.
fn with_pending() -> TempDir {
    let folder = folder();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join("snapshots/it's <b>").join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("room for a folder");
        fs::write(path, bytes).expect("room for a file");
    };
    let png = |picture: &RgbImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("memory takes it");
        bytes.into_inner()
    };
    let [old, new] = pictures();
    write("ball.snap", b"---\nsource: tests/a.rs\nextension: png\nsnapshot_kind: binary\n---\n");
    write("ball.snap.png", &png(&old));
    write(
        "ball.snap.new",
        b"---\nsource: tests/a.rs\nassertion_line: 7\nextension: png\nsnapshot_kind: binary\n---\n",
    );
    write("ball.snap.new.png", &png(&new));
    write("dump.snap", b"---\nsource: tests/a.rs\n---\none\ntwo\n");
    write("dump.snap.new", b"---\nsource: tests/a.rs\nassertion_line: 8\n---\none\n---\n</script>2\n");
    write("later.snap.new", b"---\nsource: tests/a.rs\nassertion_line: 9\n---\nsomething\n");
    folder
}

/// The files below a folder of pending snapshots, and what is in them.
fn files(folder: &TempDir) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(folder.path().join("snapshots/it's <b>"))
        .expect("the snapshots")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| {
            (
                path.file_name().expect("a name").to_string_lossy().into_owned(),
                fs::read(&path).expect("a file"),
            )
        })
        .collect()
}

fn page_of(folder: &TempDir) -> Value {
    let (status, out, err) = tabray(folder.path(), &["review"]);
    assert_eq!((status, out.as_str()), (0, ""), "{err}");
    assert!(err.ends_with("wrote review.html\n"), "{err}");
    let html = fs::read_to_string(folder.path().join("review.html")).expect("the page");
    assert_eq!(html.matches("</script>").count(), 2, "no snapshot ends a script");
    data(&html)
}

#[test]
fn a_review_gathers_what_is_pending() {
    let data = page_of(&with_pending());
    let items = data["items"].as_array().expect("a list");
    let summaries: Vec<_> = items.iter().map(|item| item["summary"].as_str().expect("a text")).collect();
    assert_eq!(
        summaries,
        [
            "1 of 12 pixels differs (8.3333 %); largest difference 30 levels, RMS 5.0000",
            "lines: 1 removed, 2 added",
            "new"
        ]
    );
    assert_eq!(
        items[1]["lines"],
        json!([
            [" ", 1, 1, "one"],
            ["-", 2, null, "two"],
            ["+", null, 2, "---"],
            ["+", null, 3, "</script>2"]
        ])
    );
}

#[test]
fn nothing_pending_is_no_failure_and_no_page() {
    let folder = folder();
    fs::create_dir(folder.path().join("snapshots")).expect("room for a folder");
    assert_eq!(
        tabray(folder.path(), &["review"]),
        (0, String::new(), "nothing is pending in `snapshots`\n".into())
    );
    assert!(!folder.path().join("review.html").exists());
    let (status, _, err) = tabray(folder.path(), &["review", "elsewhere"]);
    assert_eq!(status, 2);
    assert!(err.contains("there is neither a folder nor a snapshot `elsewhere`"), "{err}");
}

#[test]
fn what_cannot_be_shown_is_told_and_the_rest_is_shown() {
    let folder = with_pending();
    fs::remove_file(folder.path().join("snapshots/it's <b>/ball.snap.new.png")).expect("it is there");
    let (status, _, err) = tabray(folder.path(), &["review"]);
    assert_eq!(status, 2);
    assert!(err.contains("ball.snap.new`: the file beside it is missing"), "{err}");
    let html = fs::read_to_string(folder.path().join("review.html")).expect("the page");
    assert_eq!(data(&html)["items"].as_array().map(Vec::len), Some(2));
}

#[cfg(unix)]
#[test]
fn the_commands_on_the_page_work_as_they_stand() {
    let folder = with_pending();
    let before = files(&folder);
    let data = page_of(&folder);
    let run = |index: usize, verb: &str| {
        let command = data["items"][index]["decision"][verb].as_str().expect("a command");
        let done =
            Command::new("sh").args(["-c", command]).current_dir(folder.path()).output().expect("a shell");
        assert!(done.status.success(), "{command}: {}", String::from_utf8_lossy(&done.stderr));
    };
    run(0, "accept");
    run(1, "reject");
    run(2, "accept");
    let mut expected = before.clone();
    for new in ["ball.snap.new", "dump.snap.new", "later.snap.new"] {
        expected.remove(new);
    }
    expected.insert("ball.snap.png".into(), expected["ball.snap.new.png"].clone());
    expected.remove("ball.snap.new.png");
    expected.insert("later.snap".into(), b"---\nsource: tests/a.rs\n---\nsomething\n".to_vec());
    assert_eq!(files(&folder), expected);
}

/// A review that is served, and ended when it goes.
struct Served {
    program: Child,
    host: String,
}

impl Served {
    fn new(folder: &TempDir) -> Self {
        let mut program = Command::new(cargo_bin!("tabray"))
            .args(["review", "--serve", "--port", "0"])
            .current_dir(folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let mut told = BufReader::new(program.stderr.take().expect("it is piped"));
        told.read_line(&mut line).expect("a line");
        let (_, url) = line.split_once("http://").expect("where the page is");
        let (host, _) = url.split_once('/').expect("an end");
        // What else it says must not stop it.
        std::thread::spawn(move || std::io::copy(&mut told, &mut std::io::sink()));
        Self { program, host: host.to_owned() }
    }

    /// The status and the body of the answer to a request with these headers.
    fn ask(&self, line: &str, headers: &[(&str, &str)], body: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        write!(stream, "{line} HTTP/1.1\r\n{headers}Content-Length: {}\r\n\r\n{body}", body.len())
            .expect("it listens");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it answers");
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        (head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status"), body.to_owned())
    }

    /// The answer to what the page itself asks.
    fn decide(&self, verb: &str, name: &str, version: &Value) -> (u16, String) {
        let origin = format!("http://{}", self.host);
        let body =
            json!({ "snapshot": format!("snapshots/it's <b>/{name}"), "version": version }).to_string();
        self.ask(&format!("POST /{verb}"), &[("Host", &self.host), ("Origin", &origin)], &body)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

#[test]
fn a_served_page_accepts_and_rejects_what_it_shows_and_then_ends() {
    let folder = with_pending();
    let before = files(&folder);
    let mut served = Served::new(&folder);
    let (status, html) = served.ask("GET /", &[("Host", &served.host)], "");
    assert_eq!(status, 200);
    let page = data(&html);
    assert_eq!(page["served"], true);
    let version = |index: usize| &page["items"][index]["decision"]["version"];

    assert_eq!(served.decide("accept", "../../../etc/passwd", version(0)).0, 404);
    assert_eq!(served.decide("accept", "ball.snap", version(1)).0, 409);
    assert_eq!(served.decide("change", "ball.snap", version(0)).0, 404);
    assert_eq!(files(&folder), before, "nothing was decided yet");

    assert_eq!(served.decide("accept", "ball.snap", version(0)).0, 200);
    assert_eq!(served.decide("reject", "dump.snap", version(1)).0, 200);
    assert_eq!(served.decide("reject", "dump.snap", version(1)).0, 404);
    let after = files(&folder);
    assert_eq!(after["ball.snap.png"], before["ball.snap.new.png"]);
    assert_eq!(after["ball.snap"], before["ball.snap"]);
    assert_eq!(after["dump.snap"], before["dump.snap"]);
    assert_eq!(
        after.keys().collect::<Vec<_>>(),
        ["ball.snap", "ball.snap.png", "dump.snap", "later.snap.new"]
    );

    fs::write(folder.path().join("snapshots/it's <b>/later.snap.new"), "---\n---\nelse\n").expect("room");
    assert_eq!(served.decide("accept", "later.snap", version(2)).0, 409, "what was not seen is not accepted");
    let page = data(&served.ask("GET /", &[("Host", &served.host)], "").1);
    assert_eq!(served.decide("accept", "later.snap", &page["items"][0]["decision"]["version"]).0, 200);
    assert_eq!(files(&folder)["later.snap"], b"---\n---\nelse\n");
    assert!(served.program.wait().expect("it ends").success());
}

#[test]
fn pages_and_names_from_elsewhere_are_refused() {
    let folder = with_pending();
    let before = files(&folder);
    let served = Served::new(&folder);
    let ours = served.host.as_str();
    let (_, port) = ours.split_once(':').expect("a port");
    let version = &data(&served.ask("GET /", &[("Host", ours)], "").1)["items"][2]["decision"]["version"];
    let body = json!({ "snapshot": "snapshots/it's <b>/later.snap", "version": version }).to_string();
    let origin = format!("http://{ours}");
    let rebound = format!("evil.example:{port}");
    for headers in [
        &[("Host", rebound.as_str()), ("Origin", &origin)][..],
        &[("Host", "127.0.0.1"), ("Origin", &origin)],
        &[("Host", ours), ("Host", &rebound), ("Origin", &origin)],
        &[("Origin", &origin)],
        &[("Host", ours), ("Origin", "http://evil.example")],
        &[("Host", ours), ("Origin", "null")],
        &[("Host", ours), ("Origin", &origin), ("Origin", "null")],
        &[("Host", ours)],
    ] {
        assert_eq!(served.ask("POST /accept", headers, &body).0, 403, "{headers:?}");
    }
    assert_eq!(served.ask("GET /", &[("Host", &rebound)], "").0, 403);
    assert_eq!(served.ask("GET /", &[("Host", ours), ("Origin", "http://evil.example")], "").0, 403);
    assert_eq!(files(&folder), before);
    let localhost = format!("localhost:{port}");
    assert_eq!(served.ask("GET /", &[("Host", &localhost)], "").0, 200);
}

#[test]
fn a_port_that_is_taken_is_refused_when_it_was_asked_for() {
    let folder = with_pending();
    let served = Served::new(&folder);
    let (_, port) = served.host.split_once(':').expect("a port");
    let (status, _, err) = tabray(folder.path(), &["review", "--serve", "--port", port]);
    assert_eq!(status, 1);
    assert!(err.contains(&format!("cannot listen on port {port}")), "{err}");
}

#[test]
fn a_browser_shows_the_page() {
    let folder = with_pictures();
    tabray(folder.path(), &["diff", "old.png", "new.ppm", "-o", "page.html"]);
    let page = format!("file://{}", folder.path().join("page.html").display());
    let profile = format!("--user-data-dir={}", folder.path().join("profile").display());
    let shown = Command::new("chromium")
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"])
        .args([&profile, &page])
        .stderr(Stdio::null())
        .output();
    let Ok(shown) = shown else {
        let _ = writeln!(std::io::stderr(), "SKIPPED: there is no chromium here");
        return;
    };
    let page = String::from_utf8_lossy(&shown.stdout);
    assert!(page.contains("<h1>old.png and new.ppm</h1>"), "{page}");
    assert_eq!(page.matches("<canvas").count(), 3, "old, difference and new");
    assert!(page.contains("1 from the left, 2 from the bottom"), "the first pixel that differs is marked");
    assert!(page.contains("apart 0 0 30"), "its bytes are read from the pictures");
}
