//! Entries for fuzzing (`tests/fuzz/`): what the program reads from its files and from its clients, handed in as bytes.
//!
//! A module of `tabray-cli` with the feature `fuzz`. The targets call what the library does not offer otherwise: the
//! servers without sockets, and checkpoints without an image. They are compiled without `cfg(fuzzing)`, under which the
//! decoder of PNGs would check nothing.

use super::review::decide::Review;
use super::serve::Work;
use super::serve::access::Access;
use super::serve::connections::{Answer, Connections, Limits};
use super::serve::reach::Reach;
use super::watch::answer::{self, JOBS};
use super::watch::frame::Frame;
use super::watch::session::Session;
use crate::options::size::Region;
use crate::rendering::resume::{self, ResumedImage};
use hyper::Request;
use hyper::body::Bytes;
use sha2::{Digest, Sha256};
use std::cell::Cell;
use std::fs::File;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::task::{Context, Poll};
use tabray_core::output::picture::Format;
use tabray_core::render::tiles::Band;
use tabray_core::scene::model::Model;
use tabray_lang::reader::Loaded;
use tabray_lang::registry::Registry;
use tabray_tools::pixels::{Label, Writer, take_tile};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::runtime::{Builder, Runtime};

/// An image that is rendered in parts, with a checkpoint in between.
pub struct Image {
    label: Label,
    part: Region,
}

impl Image {
    /// Begins the image of a model.
    pub fn new(model: &Model) -> Option<Self> {
        let part = Region::whole(&model.camera.value);
        let label = resume::label(model, &part, Format::Ppm, &[]).ok()?;
        Some(Self { label, part })
    }

    /// Makes the checkpoint of an image with these pixels, of which only these tiles are rendered; both in rows from the
    /// top, each from the left.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn checkpoint(&self, pixels: &[[u8; 3]], tiles: &[bool]) -> io::Result<Vec<u8>> {
        let (mut writer, mut bytes) = (Writer::new(Vec::new(), &self.label)?, Vec::new());
        for (tile, is_done) in tiles.iter().enumerate() {
            let place = self.label.grid().tile(tile);
            take_tile(pixels.as_flattened(), 3 * self.label.size[0], place, 3, &mut bytes);
            writer.tile(is_done.then_some(&bytes))?;
        }
        writer.finish()
    }

    /// Replaces the checksum at the end of a checkpoint with the right one.
    pub fn with_checksum(file: &[u8]) -> Vec<u8> {
        let text = &file[..file.len().saturating_sub(32)];
        [text, &Sha256::digest(text)].concat()
    }

    /// Continues from a checkpoint: returns all pixels, and which tiles need not be rendered any more. Nothing where the
    /// checkpoint is refused.
    pub fn resume(&self, file: File) -> Option<(Vec<[u8; 3]>, Vec<bool>)> {
        let mut begun = ResumedImage::read(PathBuf::new(), Ok(file), &self.label).ok()?;
        let band = Band::blank(self.part.columns.clone(), self.part.rows.clone());
        begun.fill(&band, 0).ok()?;
        let (mut pixels, mut tiles) = (Vec::new(), Vec::new());
        for index in 0..band.strips.len() {
            let strip = band.strip(index);
            pixels.extend_from_slice(&strip.pixels);
            tiles.extend_from_slice(&strip.tiles);
        }
        Some((pixels, tiles))
    }
}

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
    /// Makes the server of `tabray watch`, for this scene.
    ///
    /// # Errors
    /// Those of the system.
    pub fn watch(registry: &'static Registry, loaded: Loaded) -> io::Result<Self> {
        let frame = Arc::new(Frame {
            version: 1,
            name: "scene.ray".to_owned(),
            text: String::new(),
            warnings: String::new(),
            model: loaded.model,
            places: loaded.places,
            folder: PathBuf::new(),
            sets: Vec::new(),
            accuracy: None,
            charting: Default::default(),
            stale: AtomicBool::new(false),
        });
        let work = Work::new(JOBS);
        Self::new(async move |request: Request<Bytes>| {
            // Events end with their feed.
            let session =
                Session::new(registry, PathBuf::from("there/is/no/scene.ray"), Vec::new(), Arc::new(|| {}));
            session.feed.show(&frame);
            ControlFlow::Continue(answer::answer(&request, &session, &work).await)
        })
    }

    /// Makes the server of `tabray review --serve`, for the snapshots of this folder.
    ///
    /// # Errors
    /// Those of the system.
    pub fn review(registry: &'static Registry, folder: &Path) -> io::Result<Self> {
        let review = Review::new(registry, folder.to_owned(), None);
        Self::new(async move |request: Request<Bytes>| review.answer(&request).await)
    }

    fn new<A: AsyncFn(Request<Bytes>) -> Answer + 'static>(answer: A) -> io::Result<Self> {
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
