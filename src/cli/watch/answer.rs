//! What the page asks for: itself, its events, and more about the picture that it shows.

use super::board::Board;
use super::frame::Frame;
use crate::cli::crash;
use crate::cli::failure::tell;
use crate::cli::serve::{self, Body};
use crate::output::aov::Aov;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::tools::probe;
use crate::words;
use clap::ValueEnum;
use http_body_util::BodyExt;
use http_body_util::channel::Channel;
use hyper::body::Bytes;
use hyper::{Method, Request, Response, StatusCode};
use serde::Serialize;
use std::io;
use std::sync::Arc;

const PAGE: &str = include_str!("page.html");

/// The answer to a request.
pub async fn answer(request: &Request<Bytes>, board: &Board) -> Response<Body> {
    if request.method() != Method::GET {
        return serve::text(StatusCode::METHOD_NOT_ALLOWED, "this server is read-only\n");
    }
    let path: Vec<_> = request.uri().path().split('/').skip(1).collect();
    match path[..] {
        [""] => serve::content(StatusCode::OK, "text/html; charset=utf-8", PAGE),
        ["events"] => serve::stream("text/event-stream", events(board)),
        ["probe", version, x, y] => about(board, version, |frame| pixel(frame, x, y)).await,
        ["layer", version, name] => about(board, version, |frame| layer(frame, name)).await,
        _ => serve::text(StatusCode::NOT_FOUND, "there is no such page\n"),
    }
}

fn events(board: &Board) -> Body {
    let (mut sender, body) = Channel::new(1);
    let mut reader = board.reader();
    tokio::spawn(async move {
        // When the program ends, a page is to look for the next one soon.
        let mut event = Some(Bytes::from("retry: 500\n\n"));
        while let Some(bytes) = event {
            if sender.send_data(bytes).await.is_err() {
                return;
            }
            event = reader.next().await;
        }
    });
    body.boxed()
}

/// An answer about the present picture, which may take a while; none about one that is not there any more.
async fn about(board: &Board, version: &str, work: impl FnOnce(Arc<Frame>) -> Option<Job>) -> Response<Body> {
    let Some(frame) = version.parse().ok().and_then(|version| board.frame(version)) else {
        return serve::text(StatusCode::GONE, "this image no longer exists\n");
    };
    let Some(job) = work(frame) else {
        return serve::text(StatusCode::NOT_FOUND, "the image has no such part\n");
    };
    match tokio::task::spawn_blocking(|| crash::catch(job)).await {
        Ok(Ok(Ok((kind, bytes)))) => serve::content(StatusCode::OK, kind, bytes),
        Ok(Ok(Err(error))) if error.kind() == io::ErrorKind::Interrupted => {
            serve::text(StatusCode::GONE, "this image no longer exists\n")
        }
        Ok(Err(failure)) => {
            tell(&failure);
            serve::text(StatusCode::INTERNAL_SERVER_ERROR, "internal error: see the terminal\n")
        }
        _ => serve::text(StatusCode::INTERNAL_SERVER_ERROR, "internal error\n"),
    }
}

/// Work that ends with the type of its result and the result.
type Job = Box<dyn FnOnce() -> io::Result<(&'static str, Vec<u8>)> + Send>;

/// The explanation of a pixel, and the lines of the object that it shows.
fn pixel(frame: Arc<Frame>, x: &str, y: &str) -> Option<Job> {
    let [width, height] = frame.model.camera.value.pixels;
    let x = x.parse().ok().filter(|x| *x < width)?;
    let y = y.parse().ok().filter(|y| *y < height)?;
    Some(Box::new(move || {
        Renderer::new(1)?.run(|| {
            let mut text = Vec::new();
            probe::pixel(&Plan::new(&frame.model), x, y, &mut text)?;
            let explained =
                Explained { lines: frame.lines_of([x, y]), text: &String::from_utf8_lossy(&text) };
            Ok(("application/json", words::json(&explained).into_bytes()))
        })
    }))
}

/// How a pixel came about.
#[derive(Serialize)]
struct Explained<'e> {
    /// The first and the last line of the object that it shows, counted from 1; null where it shows none.
    lines: Option<[usize; 2]>,
    /// What `tabray probe` prints.
    text: &'e str,
}

/// A picture beside the main one: red, green and blue of each pixel.
fn layer(frame: Arc<Frame>, name: &str) -> Option<Job> {
    // An error is seen against the truth, which there is none of here.
    let aov = Aov::from_str(name, false).ok().filter(|aov| *aov != Aov::Error)?;
    Some(Box::new(move || {
        let plan = Plan::new(&frame.model);
        let layer = aov.render(&Renderer::new(0)?, &plan, &plan, &|| frame.check())?;
        Ok(("application/octet-stream", layer.bytes))
    }))
}
