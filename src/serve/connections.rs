//! Connections: the limits of their number and duration, and the handling of each request.
//!
//! Any client can open a thousand connections and send nothing. A connection is idle until it has sent the head of a
//! request that is let in; where there are too many idle connections, the oldest is closed. So a client that sends its
//! request at once is answered, however many others send nothing.

use super::access::Access;
use super::response::{Body, guard, text};
use http_body_util::{BodyExt, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::future::poll_fn;
use std::io;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::pin::Pin;
use std::rc::Rc;
use std::task::Poll;
use std::time::Duration;
use tabray_cli::process::messages;
use tabray_core::text;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::TcpListener;
use tokio::sync::{Notify, Semaphore};
use tokio::task::{AbortHandle, spawn_local, yield_now};
use tokio::time::{sleep, timeout};
use tokio_io_timeout::TimeoutStream;

/// The maximum size of a request's head, in bytes.
const MAX_HEAD: usize = 1 << 14;

/// The maximum size of a request's body, in bytes.
const MAX_BODY: usize = 1 << 16;

/// The pause before the next connection is accepted, after the system refused one.
const PAUSE: Duration = Duration::from_millis(50);

/// The number of files that must be free before another connection is accepted: answering a request opens some too.
#[cfg(unix)]
const SPARE_FILES: usize = 8;

/// The minimum number of idle connections that are kept, even where the system allows hardly any open files. What a
/// connection has sent is read before this many others are accepted.
const MIN_IDLE: usize = 4;

/// An answer; `Break` if it is the last one.
pub type Answer = ControlFlow<Response<Body>, Response<Body>>;

/// An answer that is still to come. It is in a box, so that the server's code is compiled once for all that answer.
type FutureAnswer = Pin<Box<dyn Future<Output = Answer>>>;

/// Limits on numbers and times.
#[derive(Clone, Copy)]
pub struct Limits {
    /// The maximum number of idle connections: those that have not yet sent a request that is let in.
    pub idle: usize,
    /// The maximum number of requests that are answered at the same time. Each page keeps one of them open.
    pub requests: usize,
    /// The maximum time for the head of a request, and for its body.
    pub request_time: Duration,
    /// The maximum time that an answer may wait for its reader without progress. It is long, because a page that
    /// decodes a large image, or is paused in a debugger, reads nothing in the meantime.
    pub write_time: Duration,
}

impl Limits {
    /// The limits of a server for one person: a small part of the files that a process may have open.
    pub const USUAL: Self = Self {
        idle: 32,
        requests: 64,
        request_time: Duration::from_secs(10),
        write_time: Duration::from_secs(60),
    };
}

/// The connections of a server.
pub struct Connections {
    access: Access,
    limits: Limits,
    answer: Box<dyn Fn(Request<Bytes>) -> FutureAnswer>,
    /// The tasks of idle connections, oldest first.
    idle: RefCell<BTreeMap<u64, AbortHandle>>,
    /// A permit for each request that may be answered at the same time.
    slots: Semaphore,
    end: Notify,
}

impl Connections {
    pub fn new<A>(access: Access, limits: Limits, answer: A) -> Self
    where
        A: AsyncFn(Request<Bytes>) -> Answer + 'static,
    {
        let slots = Semaphore::new(limits.requests);
        let answer = Rc::new(answer);
        let answer = Box::new(move |request| -> FutureAnswer {
            let answer = answer.clone();
            Box::pin(async move { answer(request).await })
        });
        Self { access, limits, answer, idle: RefCell::default(), slots, end: Notify::new() }
    }

    /// Accepts connections and answers their requests, until an answer breaks.
    pub async fn run(self, listener: TcpListener) {
        let connections = Rc::new(self);
        spawn_local(connections.clone().accept(listener));
        connections.end.notified().await;
    }

    async fn accept(self: Rc<Self>, listener: TcpListener) {
        let mut max_idle = self.limits.idle;
        let mut is_told = false;
        for number in 0.. {
            let accepted = match spare_files(&listener) {
                Err(error) if self.idle.borrow().len() > MIN_IDLE => Err(error),
                _ => listener.accept().await,
            };
            match accepted {
                Ok((stream, _)) => {
                    let task = spawn_local(self.clone().serve(stream, number));
                    self.idle.borrow_mut().insert(number, task.abort_handle());
                    self.close_oldest(max_idle);
                    // What has been sent meanwhile is read before more connections are accepted.
                    yield_now().await;
                }
                // A connection that was aborted before it was accepted is no failure.
                Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => {}
                // Usually too many files are open.
                Err(error) => {
                    if !is_told {
                        let reason = text::reason(&error);
                        messages::warning(&format!("cannot accept every connection: {reason}"), None);
                    }
                    is_told = true;
                    max_idle = MIN_IDLE.max(self.idle.borrow().len().min(max_idle) / 2);
                    self.close_oldest(max_idle);
                    sleep(PAUSE).await;
                }
            }
        }
    }

    /// Closes the oldest idle connections until at most `max_idle` are left.
    fn close_oldest(&self, max_idle: usize) {
        let mut idle = self.idle.borrow_mut();
        while idle.len() > max_idle
            && let Some((_, task)) = idle.pop_first()
        {
            task.abort();
        }
    }

    /// Reads one request from a connection and answers it.
    pub async fn serve(self: Rc<Self>, stream: impl AsyncRead + AsyncWrite, number: u64) {
        let (slot, is_last) = (Cell::new(None), Cell::new(false));
        let service = service_fn(async |request: Request<Incoming>| {
            let mut response = if let Err(reason) = self.access.admit(&request) {
                text(StatusCode::FORBIDDEN, reason)
            } else if let Ok(taken) = self.slots.try_acquire() {
                slot.set(Some(taken));
                self.idle.borrow_mut().remove(&number);
                let answer = self.respond(request).await;
                is_last.set(answer.is_break());
                let (ControlFlow::Continue(response) | ControlFlow::Break(response)) = answer;
                response
            } else {
                text(StatusCode::SERVICE_UNAVAILABLE, "too many requests at once")
            };
            guard(&mut response);
            Ok::<_, Infallible>(response)
        });
        let mut stream = TimeoutStream::new(stream);
        stream.set_write_timeout(Some(self.limits.write_time));
        // A client that does not read to the end has gone.
        let _ = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(self.limits.request_time)
            .max_buf_size(MAX_HEAD)
            .keep_alive(false)
            .serve_connection(TokioIo::new(Box::pin(stream)), service)
            .await;
        self.idle.borrow_mut().remove(&number);
        if is_last.get() {
            self.end.notify_one();
        }
    }

    /// Returns the answer to a request that was let in.
    async fn respond(&self, request: Request<Incoming>) -> Answer {
        let (head, body) = request.into_parts();
        let refusal = |status, reason| ControlFlow::Continue(text(status, reason));
        let body = match timeout(self.limits.request_time, Limited::new(body, MAX_BODY).collect()).await {
            Ok(Ok(body)) => body.to_bytes(),
            Ok(Err(_)) => return refusal(StatusCode::PAYLOAD_TOO_LARGE, "the request is too large"),
            Err(_) => return refusal(StatusCode::REQUEST_TIMEOUT, "the request did not arrive in time"),
        };
        let mut answer = (self.answer)(Request::from_parts(head, body));
        // A panic ends this answer only.
        poll_fn(|context| {
            let polled = catch_unwind(AssertUnwindSafe(|| answer.as_mut().poll(context)));
            polled
                .unwrap_or_else(|_| Poll::Ready(refusal(StatusCode::INTERNAL_SERVER_ERROR, "internal error")))
        })
        .await
    }
}

/// Returns an error if the system does not let this process open [`SPARE_FILES`] more files.
#[cfg(unix)]
fn spare_files(listener: &TcpListener) -> io::Result<()> {
    use std::os::fd::AsFd;
    let copy = || listener.as_fd().try_clone_to_owned();
    (0..SPARE_FILES).map(|_| copy()).collect::<io::Result<Vec<_>>>().map(drop)
}

/// Elsewhere, accepting a connection is what fails.
#[cfg(not(unix))]
fn spare_files(_: &TcpListener) -> io::Result<()> {
    Ok(())
}
