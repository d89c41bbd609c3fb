//! The page that accepts and rejects, and the requests that it may send.

use crate::review::{data, files, tabray, with_pending};
use assert_cmd::cargo::cargo_bin;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// A review that is served until it is dropped.
struct Served {
    program: Child,
    host: String,
    token: String,
}

impl Served {
    fn new(folder: &TempDir) -> Self {
        Self::at(folder, "0")
    }

    fn at(folder: &TempDir, port: &str) -> Self {
        let mut program = Command::new(cargo_bin!("tabray"))
            .args(["review", "--serve", "--port", port])
            .current_dir(folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let mut told = BufReader::new(program.stderr.take().expect("it is piped"));
        told.read_line(&mut line).expect("a line");
        let (host, token) = line
            .strip_prefix("review at http://")
            .and_then(|rest| rest.strip_suffix(" (Ctrl-C quits)\n"))
            .and_then(|address| address.split_once("/?token="))
            .unwrap_or_else(|| panic!("an address: {line}"));
        let (host, token) = (host.to_owned(), token.to_owned());
        // Further output must not block the program.
        std::thread::spawn(move || std::io::copy(&mut told, &mut std::io::sink()));
        Self { program, host, token }
    }

    /// Sends a request with the token and these headers; returns the status and the body of the answer.
    fn ask(&self, line: &str, headers: &[(&str, &str)], body: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let (token, length) = (&self.token, body.len());
        write!(stream, "{line}?token={token} HTTP/1.1\r\n{headers}Content-Length: {length}\r\n\r\n{body}")
            .expect("it listens");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it answers");
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        (head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status"), body.to_owned())
    }

    /// Sends a request as the page does; returns the answer.
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

    let told = |status: u16, text: &str| (status, text.to_owned());
    assert_eq!(
        served.decide("accept", "../../../etc/passwd", version(0)),
        told(404, "snapshots/it's <b>/../../../etc/passwd is no longer pending")
    );
    assert_eq!(
        served.decide("accept", "ball.snap", version(1)),
        told(409, "snapshots/it's <b>/ball.snap has changed since it was shown: reload this page")
    );
    assert_eq!(served.decide("change", "ball.snap", version(0)), told(404, "not found"));
    let origin = format!("http://{}", served.host);
    let headers = [("Host", served.host.as_str()), ("Origin", &origin)];
    assert_eq!(served.ask("POST /accept", &headers, "ball"), told(400, "the request names no snapshot"));
    assert_eq!(
        served.ask("POST /accept", &headers, &" ".repeat(70_000)),
        told(413, "the request is too large")
    );
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
    let later = folder.path().join("snapshots/it's <b>/later.snap.new");
    let readable = fs::read(&later).expect("it is there");
    fs::write(&later, "without a header").expect("room");
    let told = (500, "failed: see the terminal for the reason".to_owned());
    assert_eq!(served.decide("accept", "later.snap", version(2)), told);
    fs::write(&later, readable).expect("room");
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
    let (host, page) = ("the request is for another host", "the request comes from another page");
    for (headers, said) in [
        (&[("Host", rebound.as_str()), ("Origin", &origin)][..], host),
        (&[("Host", "127.0.0.1"), ("Origin", &origin)], host),
        (&[("Host", ours), ("Host", &rebound), ("Origin", &origin)], host),
        (&[("Origin", &origin)], host),
        (&[("Host", ours), ("Origin", "http://evil.example")], page),
        (&[("Host", ours), ("Origin", "null")], page),
        (&[("Host", ours), ("Origin", &origin), ("Origin", "null")], page),
        (&[("Host", ours)], "a request that changes something must name its origin"),
    ] {
        assert_eq!(served.ask("POST /accept", headers, &body), (403, said.to_owned()), "{headers:?}");
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
    let said = "give another with `--port`, or leave it out for the first free one";
    assert_eq!(err, format!("error: port {port} is in use; {said}\n"));
}
