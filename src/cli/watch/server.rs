//! The web server: the page, its events, and answers to what it asks. It talks to this machine alone.

use super::super::Failure;
use super::board::Board;
use super::frame::Frame;
use crate::aov::Aov;
use crate::probe;
use crate::render::Renderer;
use http_body_util::channel::Channel;
use http_body_util::combinators::BoxBody;
use http_body_util::{BodyExt, Full};
use hyper::body::{Bytes, Incoming};
use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::TokioIo;
use serde_json::json;
use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::ops::RangeInclusive;
use std::sync::Arc;

const PAGE: &str = include_str!("page.html");

/// Where the server looks for a port that is free.
const PORTS: RangeInclusive<u16> = 3000..=u16::MAX;

/// What every answer says: it is for this page alone, and for now.
const HEADERS: [(HeaderName, &str); 4] = [
    (header::CACHE_CONTROL, "no-store"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
];

type Answer = Response<BoxBody<Bytes, Infallible>>;

/// A server that listens, and answers once it [runs](Self::run).
pub struct Server {
    listener: TcpListener,
    port: u16,
}

impl Server {
    /// A server on this port, or on the first free one from 3000.
    ///
    /// # Errors
    /// Where the port is taken, or none is to be had.
    pub fn bind(port: Option<u16>) -> Result<Self, Failure> {
        let listen = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = match port {
            Some(port) => listen(port).map_err(|error| (port, error)),
            None => PORTS
                .map(|port| listen(port).map_err(|error| (port, error)))
                .find(|tried| !matches!(tried, Err((_, error)) if error.kind() == io::ErrorKind::AddrInUse))
                .unwrap_or_else(|| Err((u16::MAX, io::ErrorKind::AddrInUse.into()))),
        };
        let cannot = |(port, error): (u16, io::Error)| match error.kind() {
            io::ErrorKind::AddrInUse => Failure::Failed(format!(
                "port {port} is taken; give `--port` another one, or leave it out for the first free one"
            )),
            _ => Failure::Failed(format!("cannot listen on port {port}: {error}")),
        };
        let listener = listener.map_err(cannot)?;
        listener.set_nonblocking(true)?;
        Ok(Self { port: listener.local_addr()?.port(), listener })
    }

    /// The address of its page.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers for as long as it can listen.
    ///
    /// # Errors
    /// The reason why it no longer can.
    pub fn run(self, board: &Arc<Board>) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
        runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            loop {
                let stream = match listener.accept().await {
                    Ok((stream, _)) => stream,
                    Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => continue,
                    Err(error) => return Err(error),
                };
                let (board, port) = (board.clone(), self.port);
                let service = service_fn(move |request| answer(request, board.clone(), port));
                // A page that goes away in the middle of an answer is no failure.
                tokio::spawn(http1::Builder::new().serve_connection(TokioIo::new(stream), service));
            }
        })
    }
}

async fn answer(request: Request<Incoming>, board: Arc<Board>, port: u16) -> Result<Answer, Infallible> {
    let mut answer = if !is_own(request.headers(), port) {
        refusal(StatusCode::FORBIDDEN, "this server talks to its own page alone\n")
    } else if request.method() != Method::GET {
        refusal(StatusCode::METHOD_NOT_ALLOWED, "this server is read only\n")
    } else {
        let path: Vec<_> = request.uri().path().split('/').skip(1).collect();
        match path[..] {
            [""] => ok("text/html; charset=utf-8", Full::from(PAGE).boxed()),
            ["events"] => ok("text/event-stream", events(&board)),
            ["probe", version, x, y] => about(&board, version, |frame| pixel(frame, x, y)).await,
            ["layer", version, name] => about(&board, version, |frame| layer(frame, name)).await,
            _ => refusal(StatusCode::NOT_FOUND, "there is no such page\n"),
        }
    };
    for (name, value) in HEADERS {
        answer.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    Ok(answer)
}

/// Whether a request comes from the page or from its user, and not from another page that their browser shows:
/// that would name another host, by way of a name that leads here, or another origin.
fn is_own(headers: &HeaderMap, port: u16) -> bool {
    let is_host = |host: &str| {
        ["127.0.0.1", "localhost"].iter().any(|name| {
            let rest = host.strip_prefix(name);
            rest.is_some_and(|rest| rest == format!(":{port}") || (rest.is_empty() && port == 80))
        })
    };
    let all = |name, is_right: &dyn Fn(&str) -> bool| {
        headers.get_all(name).iter().all(|value| value.to_str().is_ok_and(is_right))
    };
    headers.contains_key(header::HOST)
        && all(header::HOST, &is_host)
        && all(header::ORIGIN, &|origin| origin.strip_prefix("http://").is_some_and(is_host))
}

fn events(board: &Board) -> BoxBody<Bytes, Infallible> {
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
async fn about(board: &Board, version: &str, work: impl FnOnce(Arc<Frame>) -> Option<Job>) -> Answer {
    let Some(frame) = version.parse().ok().and_then(|version| board.frame(version)) else {
        return refusal(StatusCode::GONE, "this picture is not there any more\n");
    };
    let Some(job) = work(frame) else {
        return refusal(StatusCode::NOT_FOUND, "the picture has no such part\n");
    };
    match tokio::task::spawn_blocking(job).await {
        Ok(Ok((content, bytes))) => ok(content, Full::from(bytes).boxed()),
        Ok(Err(error)) if error.kind() == io::ErrorKind::Interrupted => {
            refusal(StatusCode::GONE, "this picture is not there any more\n")
        }
        _ => refusal(StatusCode::INTERNAL_SERVER_ERROR, "something went wrong\n"),
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
            probe::pixel(&frame.model, x, y, &mut text)?;
            let data = json!({ "text": String::from_utf8_lossy(&text), "lines": frame.lines_of([x, y]) });
            Ok(("application/json", data.to_string().into_bytes()))
        })
    }))
}

/// A picture beside the main one: red, green and blue of each pixel.
fn layer(frame: Arc<Frame>, name: &str) -> Option<Job> {
    let aov = [Aov::Depth, Aov::Normal, Aov::Object, Aov::Cost].into_iter().find(|aov| aov.name() == name)?;
    Some(Box::new(move || {
        let layer = aov.render(&Renderer::new(0)?, &frame.model, &|| frame.check())?;
        Ok(("application/octet-stream", layer.bytes))
    }))
}

fn ok(content: &'static str, body: BoxBody<Bytes, Infallible>) -> Answer {
    let mut answer = Response::new(body);
    answer.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(content));
    answer
}

fn refusal(status: StatusCode, words: &'static str) -> Answer {
    let mut answer = ok("text/plain; charset=utf-8", Full::from(words).boxed());
    *answer.status_mut() = status;
    answer
}
