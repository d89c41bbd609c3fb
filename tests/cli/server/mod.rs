//! The servers of `tabray watch` and `tabray review --serve` on a machine with other users.
#![cfg(unix)]

#[cfg(target_os = "linux")]
mod crowds;
mod pages;
mod strangers;

use crate::watch::program::{PATIENCE, ball};
use assert_cmd::cargo::cargo_bin;
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use tempfile::TempDir;

const WATCH: &[&str] = &["watch", "scene.ray"];
const REVIEW: &[&str] = &["review", "--serve"];

/// A running server, which is ended when it is dropped.
struct Running {
    program: Child,
    folder: TempDir,
    /// The address and the port on which it listens.
    host: String,
    token: String,
    /// The later output on standard error.
    said: Arc<Mutex<String>>,
}

impl Running {
    /// Starts both servers, each in a folder of its own.
    fn both() -> [Self; 2] {
        [WATCH, REVIEW].map(|args| Self::start(args, folder(&ball("9 0 0"))))
    }

    /// Starts a server in a folder, on any free port.
    fn start(args: &[&str], folder: TempDir) -> Self {
        Self::start_after("", &[args, &["--port", "0"]].concat(), folder)
    }

    /// Starts a server after a line of shell code.
    fn start_after(line: &str, args: &[&str], folder: TempDir) -> Self {
        let mut program = Command::new("sh")
            .args(["-c", &format!("{line}\nexec \"$0\" \"$@\"")])
            .arg(cargo_bin!("tabray"))
            .args(args)
            .current_dir(folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut stderr = BufReader::new(program.stderr.take().expect("its messages"));
        let mut line = String::new();
        stderr.read_line(&mut line).expect("text");
        let (host, token) = line
            .split_once(" at http://")
            .and_then(|(_, rest)| rest.strip_suffix(" (Ctrl-C quits)\n"))
            .and_then(|address| address.split_once("/?token="))
            .map(|(host, token)| (host.to_owned(), token.to_owned()))
            .unwrap_or_else(|| panic!("an address: {line}"));
        let said = Arc::<Mutex<String>>::default();
        let heard = said.clone();
        thread::spawn(move || {
            for line in stderr.lines().map_while(Result::ok) {
                *heard.lock().expect("nobody panics") += &(line + "\n");
            }
        });
        Self { program, folder, host, token, said }
    }

    /// Ends the server, and returns its folder.
    fn end(mut self) -> TempDir {
        self.kill();
        std::mem::replace(&mut self.folder, TempDir::new().expect("a folder"))
    }

    fn kill(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }

    fn url(&self) -> String {
        format!("http://{}/?token={}", self.host, self.token)
    }

    /// Opens a connection and sends this text, with `HOST` and `TOKEN` filled in.
    fn send(&self, text: &str) -> TcpStream {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time");
        let text = text.replace("TOKEN", &self.token).replace("HOST", &self.host).replace('\n', "\r\n");
        // The server may refuse a client before it has sent everything.
        let _ = stream.write_all(text.as_bytes());
        stream
    }

    /// Sends a request exactly as given; returns the status and the text of the answer.
    fn ask(&self, request: &str) -> (u16, String) {
        answer(self.send(request))
    }

    /// Returns the status of the page.
    fn page(&self) -> u16 {
        self.ask("GET /?token=TOKEN HTTP/1.1\nHost: HOST\n\n").0
    }

    /// Returns all files of the folder, with their contents.
    fn files(&self) -> BTreeMap<String, Vec<u8>> {
        ["", "snapshots"]
            .iter()
            .flat_map(|folder| fs::read_dir(self.folder.path().join(folder)).expect("a folder"))
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.is_file())
            .map(|path| (path.display().to_string(), fs::read(&path).expect("a file")))
            .collect()
    }

    fn said(&self) -> String {
        self.said.lock().expect("nobody panics").clone()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Returns the status and the text of an answer; the status is 0 if the connection ends without one.
fn answer(mut stream: TcpStream) -> (u16, String) {
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer);
    let (head, text) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok());
    (status.unwrap_or(0), text.to_owned())
}

/// Makes a folder with a scene of this text and a pending snapshot.
fn folder(scene: &str) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("scene.ray"), scene).expect("a file");
    fs::create_dir(folder.path().join("snapshots")).expect("a folder");
    fs::write(folder.path().join("snapshots/a.snap.new"), "---\n---\nnew\n").expect("a file");
    folder
}
