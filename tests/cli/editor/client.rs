//! An editor, as the language server sees it.

use lsp_server::{Message, Notification, Request};
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::BufReader;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use tempfile::TempDir;

/// A client that asks one question after the other.
pub struct Client {
    pub program: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    asked: i32,
    pub told: VecDeque<Notification>,
    pub capabilities: Value,
}

impl Client {
    pub fn start(folder: &TempDir) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_tabray"))
            .arg("lsp")
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let input = program.stdin.take().expect("a pipe");
        let output = BufReader::new(program.stdout.take().expect("a pipe"));
        let mut client =
            Self { program, input, output, asked: 0, told: VecDeque::new(), capabilities: Value::Null };
        let item = json!({ "completionItem": { "snippetSupport": true } });
        let action = json!({ "disabledSupport": true });
        let capabilities = json!({ "textDocument": { "completion": item, "codeAction": action } });
        let begun = client.ask("initialize", json!({ "capabilities": capabilities })).expect("capabilities");
        assert_eq!(begun["serverInfo"]["name"], "tabray");
        client.capabilities = begun["capabilities"].clone();
        client.note("initialized", json!({}));
        client
    }

    pub fn note(&mut self, method: &str, parameters: Value) {
        let message = Message::from(Notification::new(method.to_owned(), parameters));
        message.write(&mut self.input).expect("the server reads");
    }

    /// Asks a question, and returns the answer, or the reason why there is none.
    /// What is refused for its place in the session has the number that the protocol has for it.
    pub fn ask(&mut self, method: &str, parameters: Value) -> Result<Value, String> {
        self.asked += 1;
        let message = Message::from(Request::new(self.asked.into(), method.to_owned(), parameters));
        message.write(&mut self.input).expect("the server reads");
        loop {
            match Message::read(&mut self.output).expect("a message").expect("an answer") {
                Message::Response(response) => {
                    assert_eq!(response.id, self.asked.into());
                    let response = serde_json::to_value(response).expect("JSON");
                    return match response.get("error") {
                        Some(error) => Err(error["message"].as_str().unwrap_or_default().to_owned()),
                        None => Ok(response["result"].clone()),
                    };
                }
                Message::Notification(told) => self.told.push_back(told),
                Message::Request(_) => panic!("the server asks nothing"),
            }
        }
    }

    /// Returns the faults of a file that the server tells next.
    pub fn faults(&mut self, uri: &str) -> Value {
        loop {
            let told = self.told.pop_front().unwrap_or_else(|| {
                match Message::read(&mut self.output).expect("a message").expect("a message") {
                    Message::Notification(told) => told,
                    other => panic!("{other:?}"),
                }
            });
            if told.method == "textDocument/publishDiagnostics" && told.params["uri"] == uri {
                return told.params["diagnostics"].clone();
            }
        }
    }

    pub fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "tabray", "version": 1, "text": text });
        self.note("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub fn end(mut self) {
        self.ask("shutdown", Value::Null).expect("an answer");
        self.note("exit", Value::Null);
        assert_eq!(self.program.wait().expect("an end").code(), Some(0));
    }
}

pub fn uri(folder: &Path, name: &str) -> String {
    format!("file://{}/{name}", folder.canonicalize().expect("a folder").display())
}

/// Takes each `^` out of a scene, and returns the positions.
pub fn marks(text: &str) -> (String, Vec<Value>) {
    let mut positions = Vec::new();
    let mut lines: Vec<String> = Vec::new();
    for (line, text) in text.lines().enumerate() {
        let mut kept = String::new();
        for part in text.split('^') {
            kept += part;
            positions.push((line, kept.encode_utf16().count()));
        }
        positions.pop();
        lines.push(kept);
    }
    let position = |(line, character)| json!({ "line": line, "character": character });
    (lines.join("\n") + "\n", positions.into_iter().map(position).collect())
}

/// Writes an answer with one value on each line.
pub fn shown(answer: &Result<Value, String>) -> String {
    match answer {
        Ok(Value::Array(all)) if !all.is_empty() => all.iter().map(|one| format!("  {one}\n")).collect(),
        Ok(one) => format!("  {one}\n"),
        Err(reason) => format!("  error: {reason}\n"),
    }
}
