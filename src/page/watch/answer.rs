//! Answers requests for the page, for its events, and for details of the image on the page.

use super::alternative::{self, Override};
use super::camera;
use super::chart;
use super::feed::EventFeed;
use super::frame::Frame;
use super::session::Session;
use crate::html;
use crate::queries::{Answer, Asked, Query};
use http_body_util::BodyExt;
use http_body_util::channel::Channel;
use hyper::body::Bytes;
use hyper::{Method, Request, Response, StatusCode};
use std::io;
use std::ops::ControlFlow;
use std::sync::{Arc, LazyLock};
use std::time::Duration;
use tabray_cli::plan;
use tabray_cli::process::crash;
use tabray_cli::process::failure::report;
use tabray_core::render::plan::Plan;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_serve::{self as serve, Body, Client, Work};
use tabray_tools::threads::renderer_with;
use tokio::time::timeout;

/// The page, once it is asked for.
static PAGE: LazyLock<Bytes> = LazyLock::new(|| {
    let scripts = concat!(
        include_str!("page/scenes.js"),
        include_str!("page/chart.js"),
        include_str!("page/trial.js"),
        include_str!("page/text.js"),
        include_str!("page/edit.js"),
    );
    let (html, link) = (include_str!("page/own.html"), include_str!("page/server.js"));
    html::page(&html::Own { html, style: "", link, scripts }).into()
});

/// The maximum number of pixels and layers that are computed at the same time, for all pages.
pub const JOBS: usize = 4;

/// The longest time without an event for a page. An event is sent then even if there is no news, so that a closed page
/// is noticed.
const QUIET: Duration = Duration::from_secs(60);

/// The maximum length of a pixel's explanation, in bytes.
const MAX_EXPLANATION: usize = 1 << 22;

/// Splits the path of an address into the number of the scene that it is about, 0 where it names none, and the rest.
pub fn split(path: &str) -> Option<(usize, Vec<&str>)> {
    let parts: Vec<_> = path.split('/').skip(1).collect();
    match parts[..] {
        ["of", number, ref rest @ ..] if !rest.is_empty() => Some((number.parse().ok()?, rest.to_vec())),
        _ => Some((0, parts)),
    }
}

/// Answers a request about a scene.
pub async fn answer(request: &Request<Bytes>, session: &Session, work: &Work) -> Response<Body> {
    let (_, path) = split(request.uri().path()).unwrap_or_default();
    let feed = &session.feed;
    if request.method() == Method::POST {
        return match path[..] {
            ["try"] => session.try_out(request.body()),
            ["move"] => camera::move_by(session, request.body()),
            ["turn"] => camera::turn(session),
            ["discard"] => session.discard(request.body()),
            ["write"] => session.write(request.body()),
            ["save", hash] => session.save(hash, request.body()),
            _ => serve::text(StatusCode::NOT_FOUND, "there is no such page\n"),
        };
    }
    if request.method() != Method::GET {
        return serve::text(StatusCode::METHOD_NOT_ALLOWED, "this page has no such action\n");
    }
    match path[..] {
        [""] => serve::content(StatusCode::OK, "text/html; charset=utf-8", PAGE.clone()),
        ["events"] => serve::stream("text/event-stream", events(session)),
        ["camera"] => camera::state(session),
        ["plan", version] => about(feed, work, version, plan).await,
        ["chart", version, seconds] => {
            about(feed, work, version, |frame| charted(session.registry, frame, seconds)).await
        }
        ["charting", version] => match version.parse().ok().and_then(|version| feed.frame(version)) {
            Some(frame) => {
                serve::content(StatusCode::OK, "application/json", text::json(&frame.charting.units()))
            }
            None => serve::text(StatusCode::GONE, "this image no longer exists\n"),
        },
        ["other", version, how] => {
            about(feed, work, version, |frame| other_image(session.registry, frame, how)).await
        }
        [
            name @ ("probe" | "object" | "point" | "entities" | "entity" | "layer"),
            version,
            ref parts @ ..,
        ] => about(feed, work, version, |frame| query(session.registry, frame, name, parts)).await,
        _ => serve::text(StatusCode::NOT_FOUND, "there is no such page\n"),
    }
}

fn events(session: &Session) -> Body {
    let (mut sender, body) = Channel::new(1);
    let (mut subscriber, viewer) = (session.feed.subscribe(), session.add_viewer());
    tokio::spawn(async move {
        // When the program ends, the page should soon look for the next one.
        let mut event = Some(Bytes::from("retry: 500\n\n"));
        while let Some(bytes) = event {
            if sender.send_data(bytes).await.is_err() {
                return;
            }
            let quiet = Some(Bytes::from_static(b":\n\n"));
            event = timeout(QUIET, subscriber.next()).await.unwrap_or(quiet);
        }
    });
    // The closure owns `viewer`, so that the page counts as looking until the body is dropped, which is when it has gone.
    let looked_at = move |frame| {
        let _ = &viewer;
        frame
    };
    body.map_frame(looked_at).boxed()
}

/// Answers a request about the current image, which may take a while; fails if the image has been replaced.
async fn about(
    feed: &EventFeed,
    work: &Work,
    version: &str,
    job: impl FnOnce(Arc<Frame>) -> Option<Job>,
) -> Response<Body> {
    let Some(frame) = version.parse().ok().and_then(|version| feed.frame(version)) else {
        return serve::text(StatusCode::GONE, "this image no longer exists\n");
    };
    let Some(job) = job(frame) else {
        return serve::text(StatusCode::NOT_FOUND, "the image has no such part\n");
    };
    match work.run(|client| crash::catch(|| job(client))).await {
        Some(Ok(Ok((kind, bytes)))) => serve::content(StatusCode::OK, kind, bytes),
        Some(Ok(Err(error)))
            if [io::ErrorKind::Interrupted, io::ErrorKind::BrokenPipe].contains(&error.kind()) =>
        {
            serve::text(StatusCode::GONE, "this image no longer exists\n")
        }
        Some(Ok(Err(error))) if error.kind() == io::ErrorKind::InvalidData => {
            serve::text(StatusCode::CONFLICT, &format!("{error}\n"))
        }
        Some(Err(failure)) => {
            report(&failure);
            serve::text(StatusCode::INTERNAL_SERVER_ERROR, "internal error: see the terminal\n")
        }
        _ => serve::text(StatusCode::INTERNAL_SERVER_ERROR, "internal error\n"),
    }
}

/// A job that returns the type of its result and the result.
type Job = Box<dyn FnOnce(&Client) -> io::Result<(&'static str, Vec<u8>)> + Send>;

/// Breaks if the image is stale or the client has gone.
fn check(frame: &Frame, client: &Client) -> ControlFlow<()> {
    frame.check()?;
    client.check()
}

/// Answers a query that a page without a server has too.
fn query(registry: &'static Registry, frame: Arc<Frame>, name: &str, parts: &[&str]) -> Option<Job> {
    let query = Query::of(name, parts, &frame.model)?;
    Some(Box::new(move |client| {
        let asked = Asked {
            registry,
            shown: frame.shown(),
            places: &frame.places,
            renderer: renderer_with,
            max_explanation: MAX_EXPLANATION,
            check: &|| check(&frame, client),
        };
        query.answer(&asked).map(|Answer { kind, bytes }| (kind, bytes))
    }))
}

/// Writes the plan of the image, as `tabray plan` does.
fn plan(frame: Arc<Frame>) -> Option<Job> {
    Some(Box::new(move |_| {
        let words = plan::text(&Plan::for_picture(&frame.model));
        Ok(("text/plain; charset=utf-8", text::visible_lines(&words).into_owned().into_bytes()))
    }))
}

/// Measures the chart of the scene, in this many seconds.
fn charted(registry: &'static Registry, frame: Arc<Frame>, seconds: &str) -> Option<Job> {
    let seconds = seconds.parse().ok().filter(|seconds| (1..=chart::MAX_SECONDS).contains(seconds))?;
    Some(Box::new(move |client| {
        let limit = Duration::from_secs(seconds);
        let chart = chart::measure(registry, &frame, limit, || check(&frame, client))?;
        Ok(("application/json", chart))
    }))
}

/// Renders the image with another accuracy or number of samples.
fn other_image(registry: &'static Registry, frame: Arc<Frame>, how: &str) -> Option<Job> {
    let how = Override::named(how)?;
    Some(Box::new(move |client| {
        let image = alternative::image(registry, &frame, how, || check(&frame, client))?;
        Ok(("application/octet-stream", image))
    }))
}
