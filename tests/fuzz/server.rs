//! Entries for fuzzing (`tests/fuzz/`): the servers of pages, without sockets.
//!
//! A module of `tabray-serve` with the feature `fuzz`.

use super::Answer;
use super::access::Access;
use super::connections::{Connections, Limits};
use super::reach::Reach;
use hyper::Request;
use hyper::body::Bytes;
use std::cell::Cell;
use std::io;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::runtime::{Builder, Runtime};

/// The port that addresses name; nothing listens there.
const PORT: u16 = 3000;

/// The server of a page, without a socket.
pub struct Server {
    /// The address of the page, with the token.
    pub url: String,
    respond: Respond,
}

type Respond = Box<dyn Fn(&[u8]) -> Served>;

/// The result of a connection.
pub struct Served {
    /// The bytes that were sent to the client.
    pub sent: Vec<u8>,
    /// Whether a request was let in and has been answered.
    pub is_let_in: bool,
}

impl Server {
    /// Makes a server that answers so.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new<A: AsyncFn(Request<Bytes>) -> Answer + 'static>(answer: A) -> io::Result<Self> {
        let access = Access::new(Reach::local(Some(PORT)), PORT).map_err(io::Error::other)?;
        let url = access.url();
        let is_let_in = Rc::new(Cell::new(false));
        let answered = is_let_in.clone();
        let connections = Rc::new(Connections::new(access, Limits::USUAL, async move |request| {
            answered.set(true);
            answer(request).await
        }));
        let runtime: Runtime = Builder::new_current_thread().enable_all().build()?;
        let respond = move |bytes: &[u8]| {
            is_let_in.set(false);
            let mut sent = Vec::new();
            let client = Client { unread: bytes, patience: 8, is_let_in: &is_let_in, sent: &mut sent };
            runtime.block_on(connections.clone().serve(client, 0));
            Served { sent, is_let_in: is_let_in.get() }
        };
        Ok(Self { url, respond: Box::new(respond) })
    }

    /// Serves a connection on which a client sends these bytes.
    pub fn serve(&self, bytes: &[u8]) -> Served {
        (self.respond)(bytes)
    }
}

/// A client that sends bytes, waits for the answer if they are a request that is let in, and closes the connection.
struct Client<'c> {
    unread: &'c [u8],
    /// The number of times that the server may ask for more before the connection is closed: it asks before it looks at
    /// the bytes that it has.
    patience: u32,
    is_let_in: &'c Cell<bool>,
    sent: &'c mut Vec<u8>,
}

impl AsyncRead for Client<'_> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        if self.unread.is_empty() {
            if self.is_let_in.get() {
                return Poll::Pending;
            }
            if self.patience > 0 {
                self.patience -= 1;
                context.waker().wake_by_ref();
                return Poll::Pending;
            }
        }
        let (now, later) = self.unread.split_at(buffer.remaining().min(self.unread.len()));
        buffer.put_slice(now);
        self.unread = later;
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for Client<'_> {
    fn poll_write(mut self: Pin<&mut Self>, _: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        self.sent.extend_from_slice(bytes);
        Poll::Ready(Ok(bytes.len()))
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}
