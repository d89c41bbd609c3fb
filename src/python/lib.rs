//! The Python package `tabray`: scenes, images, hits and proofs as NumPy arrays. `docs/python.md` shows its use.
//!
//! This is the module `tabray._native`. Parts that are simpler in Python are in `tabray/`.

mod arrays;
mod errors;
mod hits;
mod image;
mod mesh;
mod proof;
mod rays;
mod scene;
mod work;

// Links the entity types.
use tabray_import as _;
use tabray_plugins as _;

/// The part of the package in Rust.
#[pyo3::pymodule]
mod _native {
    use pyo3::exceptions::PyRuntimeError;
    use pyo3::{PyResult, pyfunction};
    use tabray_core::text;
    use tabray_lang::Registry;
    use tabray_lang::list_json::Tables;

    #[pymodule_export]
    use crate::hits::{Crossings, Hits, crossings_of, hits_of};
    #[pymodule_export]
    use crate::image::Image;
    #[pymodule_export]
    use crate::mesh::{Mesh, mesh};
    #[pymodule_export]
    use crate::proof::Proof;
    #[pymodule_export]
    use crate::scene::{Scene, read, read_again, read_mesh};

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "this is its name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    /// Returns the tables of the scene language as JSON, as `tabray list --json` prints them.
    #[pyfunction]
    fn tables() -> PyResult<String> {
        let registry = Registry::get().map_err(PyRuntimeError::new_err)?;
        Ok(text::json(&Tables::of(registry)))
    }
}
