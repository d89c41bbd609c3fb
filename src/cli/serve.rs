//! A server for a page on this machine.
//!
//! It listens on the loopback address alone. Pages from elsewhere, which a browser on this machine may show too, are
//! kept out by what they cannot forge: the `Host` header, where a foreign name was made to lead here, and the `Origin`
//! header. What is sent to change something must have one.

use super::Failure;
use crate::words;
use http_body_util::combinators::BoxBody;
use http_body_util::{BodyExt, Full, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{self, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::TokioIo;
use std::cell::Cell;
use std::convert::Infallible;
use std::net::{Ipv4Addr, TcpListener};
use std::ops::ControlFlow;
use std::rc::Rc;
use tokio::sync::Notify;
use tokio::task::{LocalSet, spawn_local};

/// The port that is tried first.
const FIRST_PORT: u16 = 3000;

/// The most bytes of a request's body that are read.
const LARGEST: usize = 1 << 16;

/// What an answer holds: all at once, or as it comes about.
pub type Body = BoxBody<Bytes, Infallible>;

/// A server that listens.
pub struct Server {
    listener: TcpListener,
    port: u16,
}

impl Server {
    /// Listens on this port, or on the first free one from 3000.
    pub fn open(port: Option<u16>) -> Result<Self, Failure> {
        let listen = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = match port {
            Some(port) => listen(port).map_err(|error| {
                Failure::Failed(format!("cannot listen on port {port}: {}", words::reason(&error)))
            })?,
            None => (FIRST_PORT..=u16::MAX)
                .find_map(|port| listen(port).ok())
                .ok_or_else(|| Failure::Failed(format!("no port from {FIRST_PORT} is free")))?,
        };
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        Ok(Self { listener, port })
    }

    /// Where the page is.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers the requests that may be, until an answer breaks off: it is the last one.
    pub fn run<A>(self, answer: A) -> Result<(), Failure>
    where
        A: AsyncFn(Request<Bytes>) -> ControlFlow<Response<Body>, Response<Body>> + 'static,
    {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
        let port = self.port;
        LocalSet::new().block_on(&runtime, async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let (answer, end) = (Rc::new(answer), Rc::new(Notify::new()));
            let ended = end.clone();
            spawn_local(async move {
                loop {
                    // A connection that failed on its way here concerns nobody.
                    let Ok((stream, _)) = listener.accept().await else { continue };
                    let (answer, end) = (answer.clone(), end.clone());
                    spawn_local(async move {
                        let is_last = Cell::new(false);
                        let service = service_fn(async |request| {
                            let answered = respond(&*answer, request, port).await;
                            is_last.set(is_last.get() || answered.is_break());
                            let (ControlFlow::Continue(mut response) | ControlFlow::Break(mut response)) =
                                answered;
                            guard(&mut response);
                            Ok::<_, Infallible>(response)
                        });
                        // Who does not listen to the end has gone.
                        let mut connection = http1::Builder::new();
                        let _ = connection
                            .keep_alive(false)
                            .serve_connection(TokioIo::new(stream), service)
                            .await;
                        if is_last.get() {
                            end.notify_one();
                        }
                    });
                }
            });
            ended.notified().await;
            Ok(())
        })
    }
}

/// The answer to a request: what is made of it, or why it is refused.
async fn respond<A>(
    answer: &A,
    request: Request<Incoming>,
    port: u16,
) -> ControlFlow<Response<Body>, Response<Body>>
where
    A: AsyncFn(Request<Bytes>) -> ControlFlow<Response<Body>, Response<Body>>,
{
    if let Err(reason) = admit(&request, port) {
        return ControlFlow::Continue(text(StatusCode::FORBIDDEN, reason));
    }
    let (head, body) = request.into_parts();
    match Limited::new(body, LARGEST).collect().await {
        Ok(body) => answer(Request::from_parts(head, body.to_bytes())).await,
        Err(_) => ControlFlow::Continue(text(StatusCode::PAYLOAD_TOO_LARGE, "too much was sent")),
    }
}

/// Refuses what comes from elsewhere.
fn admit(request: &Request<Incoming>, port: u16) -> Result<(), &'static str> {
    let ours = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let values = |name: HeaderName| request.headers().get_all(name).iter().map(HeaderValue::as_bytes);
    let is_ours = |host: &[u8]| ours.iter().any(|ours| host.eq_ignore_ascii_case(ours.as_bytes()));
    if values(header::HOST).count() != 1 || !values(header::HOST).all(is_ours) {
        return Err("this is not the host that was asked for");
    }
    if request.method() != Method::GET && !request.headers().contains_key(header::ORIGIN) {
        return Err("a request that changes something must name its origin");
    }
    if !values(header::ORIGIN).all(|origin| origin.strip_prefix(b"http://").is_some_and(is_ours)) {
        return Err("a page from elsewhere may not ask this");
    }
    Ok(())
}

/// An answer that is a text.
pub fn text(status: StatusCode, text: &str) -> Response<Body> {
    content(status, "text/plain; charset=utf-8", text.to_owned())
}

/// An answer of this type, as in its `Content-Type` header.
pub fn content(status: StatusCode, kind: &'static str, bytes: impl Into<Bytes>) -> Response<Body> {
    let mut response = Response::new(Full::new(bytes.into()).boxed());
    *response.status_mut() = status;
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    response
}

/// Keeps browsers from storing an answer, from taking it for something else and from showing it within other pages.
fn guard(response: &mut Response<Body>) {
    for (name, value) in [
        (header::CACHE_CONTROL, "no-store"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::X_FRAME_OPTIONS, "DENY"),
    ] {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
}
