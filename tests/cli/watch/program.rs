//! The program while it watches a scene, and the events that it sends.

use assert_cmd::cargo::cargo_bin;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Lines, Read};
use std::path::PathBuf;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// A time longer than any machine needs; only a faulty program takes as long.
pub const PATIENCE: Duration = Duration::from_secs(180);

/// Returns a scene that is rendered at once: a sphere of this colour, on lines 3 to 7.
pub fn ball(ambient: &str) -> String {
    format!(
        "camera eye {{ pixeldim 80 60 worlddim 8 6 viewpoint 4 3 6 }}\n\
         material paint {{ ambient {ambient} }}\n\
         sphere ball\n{{\n    material paint\n    center 4 3 -3  radius 2\n}}\n"
    )
}

/// A running `tabray watch`, and a folder for its scene. It is ended when it is dropped.
pub struct Watching {
    pub child: Child,
    pub folder: TempDir,
    pub port: u16,
    /// The token that lets a page in.
    pub token: String,
}

impl Watching {
    /// Watches a scene with this text, on any free port.
    pub fn text(text: &str) -> Self {
        let folder = TempDir::new().expect("a folder");
        fs::write(folder.path().join("scene.ray"), text).expect("a file");
        Self::start(folder, &["--port", "0"])
    }

    /// Watches `scene.ray` in this folder.
    pub fn start(folder: TempDir, args: &[&str]) -> Self {
        let (watching, what) = Self::start_all(folder, &["scene.ray"], args);
        assert_eq!(what, "scene.ray");
        watching
    }

    /// Watches these scenes and folders in a folder; returns what it says that it watches, too.
    pub fn start_all(folder: TempDir, scenes: &[&str], args: &[&str]) -> (Self, String) {
        let program = Command::new(cargo_bin!("tabray"));
        let (watching, what, mut stderr) = Self::start_by(program, folder, scenes, args);
        // Later output is read, so that the program does not block.
        thread::spawn(move || stderr.read_to_end(&mut Vec::new()));
        (watching, what)
    }

    /// Watches as [`start_all`](Self::start_all) does, by a command that starts the program; returns its later messages, too.
    pub fn start_by(
        mut program: Command,
        folder: TempDir,
        scenes: &[&str],
        args: &[&str],
    ) -> (Self, String, BufReader<ChildStderr>) {
        program.arg("watch").args(scenes).args(args);
        let mut child =
            program.current_dir(folder.path()).stderr(Stdio::piped()).spawn().expect("the program runs");
        let mut stderr = BufReader::new(child.stderr.take().expect("its messages"));
        let mut line = String::new();
        stderr.read_line(&mut line).expect("text");
        let (what, (port, token)) = line
            .strip_prefix("watching ")
            .and_then(|rest| rest.strip_suffix(" (Ctrl-C quits)\n"))
            .and_then(|rest| rest.split_once(" at http://127.0.0.1:"))
            .and_then(|(what, address)| Some((what.to_owned(), address.split_once("/?token=")?)))
            .unwrap_or_else(|| panic!("an address: {line}"));
        let (port, token) = (port.parse().expect("a port"), token.to_owned());
        (Self { child, folder, port, token }, what, stderr)
    }

    pub fn scene(&self) -> PathBuf {
        self.folder.path().join("scene.ray")
    }

    /// Replaces the scene in one step.
    pub fn save(&self, text: &str) {
        let beside = self.folder.path().join("scene.ray~");
        fs::write(&beside, text).expect("a file");
        fs::rename(&beside, self.scene()).expect("in its place");
    }

    pub fn url(&self, path: &str) -> String {
        format!("http://127.0.0.1:{}/{path}?token={}", self.port, self.token)
    }

    /// Requests a path; returns the status and the bytes.
    pub fn get(&self, path: &str) -> (u16, Vec<u8>) {
        let mut answer = client().get(self.url(path)).call().expect("an answer");
        (answer.status().as_u16(), answer.body_mut().read_to_vec().expect("its bytes"))
    }

    /// Returns the events of a new page.
    pub fn events(&self) -> Events {
        self.events_at("events")
    }

    /// Returns the events at a path.
    pub fn events_at(&self, path: &str) -> Events {
        let answer = client().get(self.url(path)).call().expect("an answer");
        let lines = BufReader::new(answer.into_body().into_reader()).lines();
        let mut events = Events { lines: Box::new(lines) };
        assert_eq!(events.line(), "retry: 500");
        assert_eq!(events.line(), "");
        events
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub fn client() -> ureq::Agent {
    let patience = Some(PATIENCE);
    ureq::Agent::config_builder()
        .http_status_as_error(false)
        .timeout_recv_response(patience)
        .timeout_recv_body(patience)
        .build()
        .into()
}

/// The events of a page, one after another.
pub struct Events {
    lines: Box<Lines<BufReader<ureq::BodyReader<'static>>>>,
}

impl Events {
    fn line(&mut self) -> String {
        self.lines.next().expect("more events").expect("text")
    }

    /// Returns the name and the data of the next event.
    pub fn next(&mut self) -> (String, String) {
        let mut line = self.line();
        // After a minute without events, the program sends a line with a colon.
        while line == ":" {
            assert_eq!(self.line(), "");
            line = self.line();
        }
        let name = line.strip_prefix("event: ").expect("a name").to_owned();
        let data = self.line().strip_prefix("data: ").expect("data").to_owned();
        assert_eq!(self.line(), "");
        (name, data)
    }

    /// Returns the data of the next event of this name.
    pub fn until(&mut self, name: &str) -> Value {
        loop {
            let (found, data) = self.next();
            if found == name {
                return serde_json::from_str(&data).expect("JSON");
            }
        }
    }

    /// Returns the parts up to the end of the image.
    pub fn parts(&mut self) -> Vec<Part> {
        let mut parts = Vec::new();
        loop {
            match self.next() {
                (name, data) if name == "part" => parts.push(Part::read(&data)),
                (name, _) => {
                    assert_eq!(name, "done");
                    return parts;
                }
            }
        }
    }
}

/// A part of an image.
pub struct Part {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
    pub block: usize,
    /// Whether the colours have all samples.
    pub is_final: bool,
    pub channels: Vec<f32>,
}

impl Part {
    fn read(data: &str) -> Self {
        let words: Vec<_> = data.split(' ').collect();
        let [_, left, top, width, height, block, is_final, base64] = words[..] else { panic!("{data}") };
        let number = |word: &str| word.parse().expect("a number");
        let bytes = STANDARD.decode(base64).expect("base64");
        let (fours, rest) = bytes.as_chunks();
        assert!(rest.is_empty());
        Self {
            left: number(left),
            top: number(top),
            width: number(width),
            height: number(height),
            block: number(block),
            is_final: is_final == "1",
            channels: fours.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect(),
        }
    }
}
