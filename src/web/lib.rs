//! Scenes in a browser, without a server.
//!
//! A [`Session`] holds one scene and answers requests by path and body, as the server of `tabray watch` does: the
//! picture in steps, proofs of pixels, the plan, explained pixels, files, and an editor's queries about a text. In
//! WebAssembly, `exports` offers it as plain functions over memory, which a web worker calls.
//!
//! ```
//! use tabray_web::Session;
//!
//! let mut session = Session::new();
//! let scene = session.answer("surface/barth-6", b"");
//! let read = session.answer("scene/1", &scene.bytes);
//! assert_eq!(read.status, 200);
//! ```

mod editing;
#[cfg(target_arch = "wasm32")]
pub mod exports;
mod files;
mod formula;
mod painting;
mod proving;
mod scene;
mod session;
mod surfaces;
#[cfg(test)]
mod tests;
mod text;

pub use session::{Answer, Session};
