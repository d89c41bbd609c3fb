//! An entry for fuzzing (`tests/fuzz/`), in `tabray-teachers` with the feature `fuzz`.

use super::review::decide::Review;
use hyper::Request;
use hyper::body::Bytes;
use std::io;
use std::path::Path;
use tabray_lang::registry::Registry;
use tabray_serve::fuzz::Server;

/// Makes the server of `tabray review --serve`, for the snapshots of this folder.
///
/// # Errors
/// Those of the system.
pub fn review(registry: &'static Registry, folder: &Path) -> io::Result<Server> {
    let review = Review::new(registry, folder.to_owned(), None);
    Server::new(async move |request: Request<Bytes>| review.answer(&request).await)
}
