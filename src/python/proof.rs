//! Proofs of which object each pixel shows.

use crate::work::How;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_tools::verify::{self, Verdict};

/// The verdicts on all pixels: masks of shape (height, width), in rows from the top. Exactly one mask is True at each
/// pixel. A proof is about the ray through the middle of the pixel.
#[pyclass(frozen, module = "tabray")]
pub struct Proof {
    verdicts: Array2<Verdict>,
}

/// Proves which object each pixel shows, and compares it with the object that the tracer finds.
pub fn verify(py: Python<'_>, model: &Model, how: &How) -> PyResult<Proof> {
    let [width, height] = model.camera.value.pixels;
    let verdicts = how.run(py, height, |renderer, progress| {
        let done = || {
            progress.step(1);
            if progress.stops() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        verify::picture(renderer, &Plan::new(model), &done).ok()
    })?;
    let verdicts = verdicts.and_then(|pixels| {
        let verdicts = pixels.iter().map(|pixel| pixel.verdict).collect();
        Array2::from_shape_vec((height, width), verdicts).ok()
    });
    // Only an exception ends the proof early, and `run` returns it.
    Ok(Proof { verdicts: verdicts.ok_or_else(|| PyKeyboardInterrupt::new_err(()))? })
}

impl Proof {
    fn mask<'py>(&self, py: Python<'py>, of: Verdict) -> Bound<'py, PyArray2<bool>> {
        self.verdicts.mapv(|verdict| verdict == of).into_pyarray(py)
    }
}

#[pymethods]
impl Proof {
    /// The pixels at which the tracer finds what is certainly first: an object or nothing.
    #[getter]
    fn proven<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<bool>> {
        self.mask(py, Verdict::Proven)
    }

    /// The pixels at which 237 bits do not decide which object is first, or whether one is touched. The tracer finds
    /// one of them.
    #[getter]
    fn tie<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<bool>> {
        self.mask(py, Verdict::Tie)
    }

    /// The pixels that may show a shape without an equation. Only its bounds are proven.
    #[getter]
    fn undecided<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<bool>> {
        self.mask(py, Verdict::Uncertified)
    }

    /// The pixels at which the tracer finds an object that is certainly not the first.
    #[getter]
    fn contradicted<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<bool>> {
        self.mask(py, Verdict::Contradicted)
    }

    fn __repr__(&self) -> String {
        let count = |of: Verdict| self.verdicts.iter().filter(|verdict| **verdict == of).count();
        format!(
            "<tabray.Proof of {} pixels: {} proven, {} tie, {} undecided, {} contradicted>",
            self.verdicts.len(),
            count(Verdict::Proven),
            count(Verdict::Tie),
            count(Verdict::Uncertified),
            count(Verdict::Contradicted)
        )
    }
}
