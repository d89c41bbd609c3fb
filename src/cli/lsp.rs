//! `tabray lsp`: a language server, which tells editors about scenes while they are written.

mod answers;
mod documents;
mod faults;
mod protocol;

use super::crash;
use super::failure::Failure;
use crate::scene::registry::Registry;
use answers::Server;
use documents::Documents;
use faults::Faults;
use lsp_server::{Connection, ErrorCode, Message, Request, Response};
use protocol::capabilities;
use serde_json::json;
use std::thread;

/// Serve editors: the Language Server Protocol on standard input and output
///
/// An editor starts it by itself: docs/tools.md says how. It finds all errors of a scene, completes, explains, renames and
/// formats, in both syntaxes.
#[derive(clap::Args)]
pub struct Args {
    /// For clients that say so; there is no other way
    #[arg(long, hide = true)]
    stdio: bool,
}

pub fn run(registry: &Registry) -> Result<(), Failure> {
    let (connection, threads) = Connection::stdio();
    let failed = |error: &dyn std::fmt::Display| Failure::Failed(format!("the editor broke off: {error}"));
    let (id, parameters) = connection.initialize_start().map_err(|error| failed(&error))?;
    let result = json!({
        "capabilities": capabilities(),
        "serverInfo": { "name": super::program::name(), "version": env!("CARGO_PKG_VERSION") },
    });
    connection.initialize_finish(id, result).map_err(|error| failed(&error))?;
    let faults = Faults::default();
    let sender = connection.sender.clone();
    let outcome = thread::scope(|scope| {
        scope.spawn(|| faults.work(registry, &|message| sender.send(message).is_ok()));
        let mut server = Server::new(Documents::new(registry), &faults, &parameters);
        let outcome = serve(&connection, &mut server);
        faults.end();
        outcome
    });
    drop((connection, sender));
    if outcome.is_ok() {
        let _ = threads.join();
    }
    outcome
}

/// Answers until the editor says that it ends.
fn serve(connection: &Connection, server: &mut Server<'_>) -> Result<(), Failure> {
    let gone = || Failure::Failed("the editor broke off".to_owned());
    for message in &connection.receiver {
        match message {
            Message::Request(request) if request.method == "shutdown" => {
                return match connection.handle_shutdown(&request) {
                    Ok(_) => Ok(()),
                    Err(error) => Err(Failure::Failed(format!("the editor broke off: {error}"))),
                };
            }
            Message::Request(request) => {
                let response = answer(server, request);
                connection.sender.send(response.into()).map_err(|_| gone())?;
            }
            Message::Notification(notification) if notification.method == "exit" => return Err(gone()),
            Message::Notification(notification) => {
                let handled = crash::catch(|| server.note(&notification.method, notification.params));
                if let Err(Failure::Failed(said)) = handled {
                    let parameters = json!({ "type": 1, "message": said });
                    let told = lsp_server::Notification::new("window/logMessage".to_owned(), parameters);
                    connection.sender.send(told.into()).map_err(|_| gone())?;
                }
            }
            Message::Response(_) => {}
        }
    }
    Err(gone())
}

fn answer(server: &mut Server<'_>, request: Request) -> Response {
    let Request { id, method, params } = request;
    match crash::catch(|| server.answer(&method, params)) {
        Ok(Ok(Some(result))) => Response::new_ok(id, result),
        Ok(Ok(None)) => {
            Response::new_err(id, ErrorCode::MethodNotFound as i32, format!("`{method}` is not known"))
        }
        Ok(Err(said)) => Response::new_err(id, ErrorCode::RequestFailed as i32, said),
        Err(Failure::Failed(said)) => Response::new_err(id, ErrorCode::InternalError as i32, said),
        Err(_) => Response::new_err(id, ErrorCode::InternalError as i32, "no answer".to_owned()),
    }
}
