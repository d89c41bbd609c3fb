//! A server for a page of tabray. Unless another address is given, it listens on the loopback address only.

mod access;
mod connections;
#[cfg(feature = "fuzz")]
#[doc(hidden)]
#[path = "../../tests/fuzz/server.rs"]
pub mod fuzz;
mod reach;
mod response;
mod work;

pub use connections::Answer;
pub use reach::Reach;
pub use response::{Body, content, stream, text};
pub use work::{Client, Work};

use access::Access;
use connections::{Connections, Limits};
use hyper::Request;
use hyper::body::Bytes;
use socket2::SockRef;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::ops::RangeInclusive;
use tabray_cli::process::failure::Failure;
use tabray_core::text;
use tokio::task::LocalSet;

/// The ports that are tried when none is given.
const PORTS: RangeInclusive<u16> = 3000..=u16::MAX;

/// The maximum length of the system's queue of connections that are not yet accepted. If the queue is full, a client
/// tries again after a second or more.
const QUEUE: i32 = 4096;

/// A listening server.
pub struct Server {
    listener: TcpListener,
    access: Access,
}

impl Server {
    /// Listens on the port that is given, or on the first free one from 3000.
    pub fn open(reach: Reach) -> Result<Self, Failure> {
        reach.check()?;
        let listen = |port| Self::listen((reach.host, port).into()).map_err(|error| (port, error));
        let listener = match reach.port {
            Some(port) => listen(port),
            None => PORTS
                .map(listen)
                .find(|tried| !matches!(tried, Err((_, error)) if error.kind() == io::ErrorKind::AddrInUse))
                .unwrap_or_else(|| Err((u16::MAX, io::ErrorKind::AddrInUse.into()))),
        };
        let (listener, port) = listener.map_err(|(port, error)| match error.kind() {
            io::ErrorKind::AddrInUse => Failure::Failed(format!(
                "port {port} is in use; give another with `--port`, or leave it out for the first free one"
            )),
            _ => {
                let reason = text::reason(&error);
                let at = if reach.host.is_loopback() { String::new() } else { format!(" of {}", reach.host) };
                Failure::Failed(format!("cannot listen on port {port}{at}: {reason}"))
            }
        })?;
        let access = Access::new(reach, port)
            .map_err(|error| Failure::Failed(format!("the system has no random numbers: {error}")))?;
        Ok(Self { listener, access })
    }

    fn listen(at: SocketAddr) -> io::Result<(TcpListener, u16)> {
        let listener = TcpListener::bind(at)?;
        SockRef::from(&listener).listen(QUEUE)?;
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        Ok((listener, port))
    }

    /// Returns the address of the page. Anyone who has this address is let in.
    pub fn url(&self) -> String {
        self.access.url()
    }

    /// Answers the requests that are let in, until an answer breaks.
    ///
    /// # Errors
    /// The reason why the server cannot start.
    pub fn run<A>(self, answer: A) -> io::Result<()>
    where
        A: AsyncFn(Request<Bytes>) -> Answer + 'static,
    {
        self.run_within(Limits::USUAL, answer)
    }

    fn run_within<A>(self, limits: Limits, answer: A) -> io::Result<()>
    where
        A: AsyncFn(Request<Bytes>) -> Answer + 'static,
    {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        LocalSet::new().block_on(&runtime, async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            Connections::new(self.access, limits, answer).run(listener).await;
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests;
