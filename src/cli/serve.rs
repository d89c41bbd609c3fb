//! A server for a page on this machine.
//!
//! It listens on the loopback address alone. Pages from elsewhere, which a browser on this machine may show too, are
//! kept out by what they cannot forge: the `Host` header, where a foreign name was made to lead here, and the `Origin`
//! header. What is sent to change something must have one.

use super::failure::Failure;
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
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::ops::{ControlFlow, RangeInclusive};
use std::rc::Rc;
use tokio::sync::Notify;
use tokio::task::{LocalSet, spawn_local};

/// Where it looks for a port that is free.
const PORTS: RangeInclusive<u16> = 3000..=u16::MAX;

/// The most bytes of a request's body that are read.
const LARGEST: usize = 1 << 16;

/// What every answer says: it is for this page alone, which asks nobody else, and for now.
const HEADERS: [(HeaderName, &str); 5] = [
    (header::CACHE_CONTROL, "no-store"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
];

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
        let listen = |port| Self::listen(port).map_err(|error| (port, error));
        let server = match port {
            Some(port) => listen(port),
            None => PORTS
                .map(listen)
                .find(|tried| !matches!(tried, Err((_, error)) if error.kind() == io::ErrorKind::AddrInUse))
                .unwrap_or_else(|| Err((u16::MAX, io::ErrorKind::AddrInUse.into()))),
        };
        server.map_err(|(port, error)| match error.kind() {
            io::ErrorKind::AddrInUse => Failure::Failed(format!(
                "port {port} is in use; give another with `--port`, or leave it out for the first free one"
            )),
            _ => Failure::Failed(format!("cannot listen on port {port}: {}", words::reason(&error))),
        })
    }

    fn listen(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        Ok(Self { listener, port })
    }

    /// Where the page is.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers the requests that may be, until an answer breaks off: it is the last one.
    ///
    /// # Errors
    /// The reason why it can no longer listen.
    pub fn run<A>(self, answer: A) -> io::Result<()>
    where
        A: AsyncFn(Request<Bytes>) -> ControlFlow<Response<Body>, Response<Body>> + 'static,
    {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
        let port = self.port;
        LocalSet::new().block_on(&runtime, async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let (answer, end) = (Rc::new(answer), Rc::new(Notify::new()));
            let outcome = Rc::new(Cell::new(Ok(())));
            let (ended, told) = (end.clone(), outcome.clone());
            spawn_local(async move {
                loop {
                    let stream = match listener.accept().await {
                        Ok((stream, _)) => stream,
                        // A connection that failed on its way here concerns nobody.
                        Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => continue,
                        Err(error) => {
                            told.set(Err(error));
                            return end.notify_one();
                        }
                    };
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
            outcome.replace(Ok(()))
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
        Err(_) => ControlFlow::Continue(text(StatusCode::PAYLOAD_TOO_LARGE, "the request is too large")),
    }
}

/// Refuses what comes from elsewhere.
fn admit(request: &Request<Incoming>, port: u16) -> Result<(), &'static str> {
    let ours = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let values = |name: HeaderName| request.headers().get_all(name).iter().map(HeaderValue::as_bytes);
    let is_ours = |host: &[u8]| ours.iter().any(|ours| host.eq_ignore_ascii_case(ours.as_bytes()));
    if values(header::HOST).count() != 1 || !values(header::HOST).all(is_ours) {
        return Err("the request is for another host");
    }
    if request.method() != Method::GET && !request.headers().contains_key(header::ORIGIN) {
        return Err("a request that changes something must name its origin");
    }
    if !values(header::ORIGIN).all(|origin| origin.strip_prefix(b"http://").is_some_and(is_ours)) {
        return Err("the request comes from another page");
    }
    Ok(())
}

/// An answer that is a text.
pub fn text(status: StatusCode, text: &str) -> Response<Body> {
    content(status, "text/plain; charset=utf-8", text.to_owned())
}

/// An answer of this type, as in its `Content-Type` header.
pub fn content(status: StatusCode, kind: &'static str, bytes: impl Into<Bytes>) -> Response<Body> {
    let mut response = stream(kind, Full::new(bytes.into()).boxed());
    *response.status_mut() = status;
    response
}

/// An answer of this type, whatever its body is.
pub fn stream(kind: &'static str, body: Body) -> Response<Body> {
    let mut response = Response::new(body);
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    response
}

/// Keeps browsers from storing an answer, from taking it for something else and from showing it within other pages.
fn guard(response: &mut Response<Body>) {
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
}
