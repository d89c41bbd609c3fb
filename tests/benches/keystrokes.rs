//! `cargo bench --bench keystrokes`: how long an editor waits for `tabray lsp` after a keystroke in a scene of 1 MB, in both
//! syntaxes, with errors in it and without: the median and the worst of the answers of each kind, in milliseconds. Time runs
//! from before the change is sent until the answer has been read, but not parsed.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// The size of the scenes, in bytes.
const SIZE: usize = 1 << 20;

/// The keystrokes that are followed by each kind of question.
const KEYSTROKES: usize = 20;

/// What is asked after a keystroke.
const QUESTIONS: [&str; 9] = [
    "completion",
    "hover",
    "signatureHelp",
    "documentSymbol",
    "foldingRange",
    "documentColor",
    "inlayHint",
    "references",
    "formatting",
];

struct Client {
    program: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    asked: usize,
    /// The last version of the text, and the one whose faults were told last.
    version: i64,
    told: i64,
}

impl Client {
    fn start() -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_tabray"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let input = program.stdin.take().expect("a pipe");
        let output = BufReader::with_capacity(1 << 20, program.stdout.take().expect("a pipe"));
        let mut client = Self { program, input, output, asked: 0, version: 1, told: 0 };
        client.ask("initialize", json!({ "capabilities": {} }));
        client.send(json!({ "method": "initialized", "params": {} }));
        client
    }

    fn send(&mut self, mut message: Value) {
        message["jsonrpc"] = "2.0".into();
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("the server reads");
    }

    fn message(&mut self) -> Vec<u8> {
        let (mut length, mut line) = (0, String::new());
        loop {
            line.clear();
            self.output.read_line(&mut line).expect("a message");
            match line.trim_end() {
                "" => break,
                line => length = line.rsplit(' ').next().and_then(|size| size.parse().ok()).unwrap_or(length),
            }
        }
        let mut text = vec![0; length];
        self.output.read_exact(&mut text).expect("a message");
        text
    }

    /// Returns the next message that has a text near its beginning.
    fn message_with(&mut self, mark: &str) -> Vec<u8> {
        loop {
            let message = self.message();
            if String::from_utf8_lossy(&message[..message.len().min(200)]).contains(mark) {
                return message;
            }
            self.note(&message);
        }
    }

    /// Takes note of the version whose faults a message tells.
    fn note(&mut self, message: &[u8]) {
        let end = String::from_utf8_lossy(&message[message.len().saturating_sub(30)..]).into_owned();
        let version =
            end.rsplit_once("\"version\":").and_then(|(_, end)| end.trim_end_matches('}').parse().ok());
        self.told = version.unwrap_or(self.told);
    }

    fn ask(&mut self, method: &str, params: Value) -> Vec<u8> {
        self.asked += 1;
        let id = self.asked;
        self.send(json!({ "id": id, "method": method, "params": params }));
        self.message_with(&format!("\"id\":{id},"))
    }

    /// Waits for the faults of the last version, and returns the length of the message.
    fn faults(&mut self) -> usize {
        let mut length = 0;
        while self.told < self.version {
            let message = self.message();
            length = message.len();
            self.note(&message);
        }
        length
    }

    fn change(&mut self, uri: &str, line: usize, characters: [usize; 2], text: &str) {
        self.version += 1;
        let [start, end] = characters.map(|character| json!({ "line": line, "character": character }));
        let change = json!({ "range": { "start": start, "end": end }, "text": text });
        let document = json!({ "uri": uri, "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        self.send(json!({ "method": "textDocument/didChange", "params": params }));
    }
}

/// Returns a scene of 1 MB, and the lines whose last number is typed at.
fn scene(is_toml: bool, is_wrong: bool) -> (String, Vec<usize>) {
    let mut text = match is_toml {
        true => "[camera.eye]\npixeldim = [64, 48]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n\n",
        false => "camera eye { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 6 }\n",
    }
    .to_owned();
    let (mut line, mut typed) = (text.lines().count(), Vec::new());
    for index in 0.. {
        if text.len() >= SIZE {
            break;
        }
        let [x, y, z] = [index % 89, index % 67, index % 97].map(|number| f64::from(number) / 10.0);
        // One name in a thousand is not that of a material.
        let shade = if is_wrong && index % 1000 == 7 {
            "nothing".to_owned()
        } else {
            format!("shade_{}", index / 20)
        };
        if index % 20 == 0 {
            text += &match is_toml {
                true => format!("[material.shade_{}]\nambient = [{x}, {y}, 0.5]\n\n", index / 20),
                false => format!("material shade_{} {{ ambient {x} {y} 0.5 }}\n", index / 20),
            };
            line += if is_toml { 3 } else { 1 };
        }
        text += &match is_toml {
            true => format!(
                "[sphere.ball_{index}]\nmaterial = \"{shade}\"\ncenter = [{x}, {y}, -{z}]\nradius = 0.125\n\n"
            ),
            false => {
                format!("sphere ball_{index} {{ material {shade}  center {x} {y} -{z}  radius 0.125 }}\n")
            }
        };
        typed.push(if is_toml { line + 3 } else { line });
        line += if is_toml { 5 } else { 1 };
    }
    (text, typed)
}

fn print(what: &str, mut times: Vec<Duration>, bytes: usize) {
    times.sort_unstable();
    let [median, worst] =
        [times[times.len() / 2], times[times.len() - 1]].map(|time| time.as_secs_f64() * 1e3);
    println!("  {what:<16} {median:>8.1} {worst:>8.1} {bytes:>10}");
}

fn main() {
    for (name, is_toml, is_wrong) in [
        (".ray", false, false),
        (".ray with errors", false, true),
        ("TOML", true, false),
        ("TOML with errors", true, true),
    ] {
        let (text, typed) = scene(is_toml, is_wrong);
        let lines: Vec<_> = text.lines().collect();
        let uri = format!("file:///tmp/keystrokes.{}", if is_toml { "toml" } else { "ray" });
        let mut client = Client::start();
        let document = json!({ "uri": uri, "languageId": "tabray", "version": 1, "text": text });
        client.send(json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } }));
        client.faults();
        println!("{name}, {} bytes: median, worst [ms]; answer [bytes]", text.len());
        for question in QUESTIONS.iter().chain(&["diagnostics"]) {
            let (mut times, mut bytes) = (Vec::new(), 0);
            for stroke in 0..KEYSTROKES {
                let line = typed[(stroke * 7919 + 1) % typed.len()];
                // A digit after the radius, and a backspace.
                let column = lines[line].trim_end_matches([' ', '}']).len();
                for (columns, letter) in [([column, column], "5"), ([column, column + 1], "")] {
                    let start = Instant::now();
                    client.change(&uri, line, columns, letter);
                    if *question == "diagnostics" {
                        bytes = client.faults();
                        times.push(start.elapsed());
                        continue;
                    }
                    // The name of a material, of the ball or of a value.
                    let column = if is_toml { 2 } else { 12 };
                    let params = json!({
                        "textDocument": { "uri": uri },
                        "position": { "line": if is_toml { line - 3 } else { line }, "character": column },
                        "range": { "start": { "line": line.saturating_sub(30), "character": 0 }, "end": { "line": line + 30, "character": 0 } },
                        "context": { "includeDeclaration": true },
                    });
                    bytes = client.ask(&format!("textDocument/{question}"), params).len();
                    times.push(start.elapsed());
                    client.faults();
                }
            }
            print(question, times, bytes);
        }
        client.ask("shutdown", Value::Null);
        client.send(json!({ "method": "exit" }));
        client.program.wait().expect("an end");
    }
}
