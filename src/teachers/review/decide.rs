//! `tabray review --serve`: the page on which snapshots are accepted and rejected.

use super::items::items;
use super::pending::{self, Pending};
use crate::report;
use hyper::body::Bytes;
use hyper::{Request, Response, StatusCode};
use serde::Deserialize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use tabray_cli::process::failure::{self, Failure};
use tabray_cli::process::messages;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_serve::{self as serve, Answer, Reach, Server, Work};

/// Serves the page, and carries out the user's decisions.
pub fn serve(
    registry: &'static Registry,
    folder: PathBuf,
    before: Option<PathBuf>,
    port: Option<u16>,
) -> Result<(), Failure> {
    let server = Server::open(Reach::local(port))?;
    messages::note(&format!("review at {} (Ctrl-C quits)", server.url()));
    let review = Review::new(registry, folder, before);
    let run = server.run(async move |request: Request<Bytes>| review.answer(&request).await);
    run.map_err(|error| Failure::Failed(format!("the server stopped: {}", text::reason(&error))))
}

/// The snapshots of a folder, which a page decides about.
pub struct Review {
    registry: &'static Registry,
    folder: PathBuf,
    before: Option<PathBuf>,
    work: Work,
}

impl Review {
    /// Begins to review the pending snapshots below a folder, whose old images `before` made.
    pub fn new(registry: &'static Registry, folder: PathBuf, before: Option<PathBuf>) -> Self {
        // One job at a time, so that no page is made while a snapshot is moved.
        Self { registry, folder, before, work: Work::new(1) }
    }

    /// Answers a request: for the page, or to accept or reject a snapshot. The last decision breaks.
    pub async fn answer(&self, request: &Request<Bytes>) -> Answer {
        let Self { registry, folder, before, work } = self;
        let path = (request.method().as_str(), request.uri().path());
        if path == ("GET", "/") {
            let (registry, folder, before) = (*registry, folder.clone(), before.clone());
            let page = work.run(move |_| page(registry, &folder, before.as_deref())).await;
            let failed = || serve::text(StatusCode::INTERNAL_SERVER_ERROR, "internal error");
            return ControlFlow::Continue(page.unwrap_or_else(failed));
        }
        let _turn = work.turn().await;
        let verdict = match path {
            ("POST", "/accept") => decide(folder, request.body(), "accepted", Pending::accept),
            ("POST", "/reject") => decide(folder, request.body(), "rejected", Pending::reject),
            _ => Err((StatusCode::NOT_FOUND, "not found".to_owned())),
        };
        match verdict {
            Ok(told) => {
                messages::note(&told);
                let response = serve::text(StatusCode::OK, &told);
                let is_last = pending::find(folder).is_ok_and(|found| found.is_empty());
                if is_last { ControlFlow::Break(response) } else { ControlFlow::Continue(response) }
            }
            Err((status, reason)) => ControlFlow::Continue(serve::text(status, &reason)),
        }
    }
}

fn page(registry: &Registry, folder: &Path, before: Option<&Path>) -> Response<serve::Body> {
    let html = items(registry, folder, before)
        .and_then(|(items, _)| report::html("tabray review", &items, true).map_err(Failure::from));
    match html {
        Ok(html) => serve::content(StatusCode::OK, "text/html; charset=utf-8", html),
        Err(failure) => {
            failure::report(&failure);
            serve::text(StatusCode::INTERNAL_SERVER_ERROR, "failed: see the terminal for the reason")
        }
    }
}

/// The request of the page to accept or reject a snapshot.
#[derive(Deserialize)]
struct DecisionRequest {
    /// The path of the snapshot.
    snapshot: String,
    /// The version of the snapshot that the page showed.
    version: String,
}

/// Accepts or rejects a snapshot, if it is still the version that the page showed.
fn decide(
    folder: &Path,
    body: &[u8],
    verdict: &str,
    act: impl Fn(&Pending) -> Result<(), Failure>,
) -> Result<String, (StatusCode, String)> {
    let request = serde_json::from_slice(body);
    let DecisionRequest { snapshot: name, version } =
        request.map_err(|_| (StatusCode::BAD_REQUEST, "the request names no snapshot".to_owned()))?;
    let failed = |failure: Failure| {
        failure::report(&failure);
        (StatusCode::INTERNAL_SERVER_ERROR, "failed: see the terminal for the reason".to_owned())
    };
    let found = pending::find(folder).map_err(failed)?;
    let named = |new: &&PathBuf| text::shown(new.with_extension("")) == name;
    let Some(new) = found.iter().find(named) else {
        return Err((StatusCode::NOT_FOUND, format!("{name} is no longer pending")));
    };
    let snapshot = Pending::read(new).map_err(failed)?;
    if snapshot.version() != version {
        return Err((
            StatusCode::CONFLICT,
            format!("{name} has changed since it was shown: reload this page"),
        ));
    }
    act(&snapshot).map_err(failed)?;
    Ok(format!("{verdict} {name}"))
}
