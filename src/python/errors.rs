//! Faults of scenes as Python's exceptions and warnings, which `tabray/_errors.py` defines.

use pyo3::prelude::*;
use tabray_lang::Report;

/// Makes the exception of a report. Its text is that of the command line, and its faults are data.
pub fn exception(py: Python<'_>, report: &Report) -> PyErr {
    let error = py.import("tabray._errors").and_then(|errors| {
        errors.getattr("SceneError")?.call1((report.to_string().trim_end(), report.json()))
    });
    error.map_or_else(|broken| broken, PyErr::from_value)
}

/// Warns of each fault of a report.
pub fn warn(py: Python<'_>, report: &Report) -> PyResult<()> {
    if !report.faults().is_empty() {
        py.import("tabray._errors")?.getattr("warn")?.call1((report.json(),))?;
    }
    Ok(())
}
