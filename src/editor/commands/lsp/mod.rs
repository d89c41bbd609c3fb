//! `tabray lsp`: a language server, which tells editors about scenes while they are written.

mod answers;
mod documents;
mod faults;
mod protocol;
mod transport;

use answers::Server;
use documents::Documents;
use faults::Faults;
use lsp_server::{ErrorCode, Message, Request};
use protocol::{capabilities, error_response, malformed, response};
use serde_json::{Value, json};
use std::io::{self, StdinLock, Write};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use tabray_cli::process::crash;
use tabray_cli::process::failure::Failure;
use tabray_cli::{Command, Group, Run};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Serve editors: the Language Server Protocol on standard input and output
///
/// Editors start this server: docs/commands.md says how to set it up. It finds the errors of a scene, completes,
/// explains, renames and formats, in both syntaxes.
#[derive(clap::Args)]
pub struct Args {
    /// For clients that say so; there is no other way
    #[arg(long, hide = true)]
    stdio: bool,
}

inventory::submit! {
    Command::new("lsp", Group::Tools, &Run(run)).placed(0, 26)
}

fn run(registry: &Registry, _: Args) -> Result<(), Failure> {
    // Messages are written on a thread of their own, so that a slow editor does not block the reader.
    let (sender, texts) = mpsc::channel();
    let writer = thread::spawn(|| write(texts));
    let mut input = io::stdin().lock();
    let parameters = begin(&mut input, &sender)?;
    let faults = Faults::default();
    let outcome = thread::scope(|scope| {
        scope.spawn(|| faults.work(registry, &|text| sender.send(text).is_ok()));
        let mut server = Server::new(Documents::new(registry), &faults, &parameters);
        let outcome = serve(&mut input, &sender, &mut server);
        faults.end();
        outcome
    });
    drop(sender);
    if outcome.is_ok() {
        let _ = writer.join();
    }
    outcome
}

/// Writes messages until the editor no longer reads, or there are no more.
fn write(texts: Receiver<String>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    for text in texts {
        write!(out, "Content-Length: {}\r\n\r\n", text.len())?;
        out.write_all(text.as_bytes())?;
        out.flush()?;
    }
    Ok(())
}

fn gone() -> Failure {
    Failure::Failed("the editor broke off".to_owned())
}

/// Reads the next message. What is none is answered with the reason.
fn next(input: &mut StdinLock<'_>, sender: &Sender<String>) -> Result<Message, Failure> {
    loop {
        match transport::read(input) {
            Ok(Some(Ok(message))) => return Ok(message),
            Ok(Some(Err(why))) => send(sender, malformed(&why))?,
            Ok(None) => return Err(gone()),
            Err(error) => {
                return Err(Failure::Failed(format!("the editor broke off: {}", text::reason(&error))));
            }
        }
    }
}

fn send(sender: &Sender<String>, text: String) -> Result<(), Failure> {
    sender.send(text).map_err(|_| gone())
}

/// Answers the first request of an editor, and returns what the editor says about itself.
fn begin(input: &mut StdinLock<'_>, sender: &Sender<String>) -> Result<Value, Failure> {
    loop {
        match next(input, sender)? {
            Message::Request(Request { id, method, params }) if method == "initialize" => {
                let result = json!({
                    "capabilities": capabilities(),
                    "serverInfo": { "name": tabray_cli::process::program::name(), "version": env!("CARGO_PKG_VERSION") },
                });
                send(sender, response(&id, &result.to_string()))?;
                return Ok(params);
            }
            Message::Request(Request { id, .. }) => {
                send(
                    sender,
                    error_response(&id, ErrorCode::ServerNotInitialized, "`initialize` comes first"),
                )?;
            }
            Message::Notification(notification) if notification.method == "exit" => return Err(gone()),
            _ => {}
        }
    }
}

/// Answers until the editor says that it ends.
fn serve(input: &mut StdinLock<'_>, sender: &Sender<String>, server: &mut Server<'_>) -> Result<(), Failure> {
    loop {
        match next(input, sender)? {
            Message::Request(request) if request.method == "shutdown" => {
                send(sender, response(&request.id, "null"))?;
                return end(input, sender);
            }
            Message::Request(Request { id, method, .. }) if method == "initialize" => {
                send(sender, error_response(&id, ErrorCode::InvalidRequest, "`initialize` comes once"))?;
            }
            Message::Request(request) => send(sender, answer(server, request))?,
            Message::Notification(notification) if notification.method == "exit" => return Err(gone()),
            Message::Notification(notification) => {
                let handled = crash::catch(|| server.note(&notification.method, notification.params));
                let told = match handled {
                    Err(Failure::Failed(said)) => {
                        Some(("window/logMessage", json!({ "type": 1, "message": said })))
                    }
                    Ok(Some(said)) => Some(("window/showMessage", json!({ "type": 2, "message": said }))),
                    _ => None,
                };
                if let Some((method, parameters)) = told {
                    send(sender, protocol::notification(method, &parameters))?;
                }
            }
            Message::Response(_) => {}
        }
    }
}

/// Waits for the editor to end, and answers nothing more.
fn end(input: &mut StdinLock<'_>, sender: &Sender<String>) -> Result<(), Failure> {
    loop {
        match next(input, sender)? {
            Message::Request(Request { id, .. }) => {
                send(sender, error_response(&id, ErrorCode::InvalidRequest, "`shutdown` came before"))?;
            }
            Message::Notification(notification) if notification.method == "exit" => return Ok(()),
            _ => {}
        }
    }
}

/// Writes the answer to a question.
fn answer(server: &mut Server<'_>, request: Request) -> String {
    let Request { id, method, params } = request;
    match crash::catch(|| server.answer(&method, params)) {
        Ok(Ok(Some(result))) => response(&id, &result),
        Ok(Ok(None)) => error_response(&id, ErrorCode::MethodNotFound, &format!("`{method}` is not known")),
        Ok(Err(said)) => error_response(&id, ErrorCode::RequestFailed, &said),
        Err(Failure::Failed(said)) => error_response(&id, ErrorCode::InternalError, &said),
        Err(_) => error_response(&id, ErrorCode::InternalError, "no answer"),
    }
}
