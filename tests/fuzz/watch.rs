//! An entry for fuzzing (`tests/fuzz/`), in `tabray-page` with the feature `fuzz`.

use super::watch::answer::{self, JOBS};
use super::watch::frame::Frame;
use super::watch::session::Session;
use hyper::Request;
use hyper::body::Bytes;
use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use tabray_lang::reader::Loaded;
use tabray_lang::registry::Registry;
use tabray_serve::Work;
pub use tabray_serve::fuzz::Server;

/// Makes the server of `tabray watch`, for this scene.
///
/// # Errors
/// Those of the system.
pub fn watch(registry: &'static Registry, loaded: Loaded) -> io::Result<Server> {
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
    Server::new(async move |request: Request<Bytes>| {
        // Events end with their feed.
        let session =
            Session::new(registry, PathBuf::from("there/is/no/scene.ray"), Vec::new(), Arc::new(|| {}));
        session.feed.show(&frame);
        ControlFlow::Continue(answer::answer(&request, &session, &work).await)
    })
}
