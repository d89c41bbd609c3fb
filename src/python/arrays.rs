//! Arrays as arguments: rows of three numbers, of either precision and any layout, and indices.

use glam::DVec3;
use numpy::ndarray::ArrayView2;
use numpy::{
    Element, PyArrayDescrMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Returns an object as an array; an array is returned as it is.
fn array<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = object.py();
    Ok(py.import("numpy")?.getattr("require")?.call1((object, py.None(), "A"))?.cast_into()?)
}

fn converted<'py>(array: &Bound<'py, PyUntypedArray>, to: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    Ok(array.call_method1("astype", (to,))?.cast_into()?)
}

fn repeated<'py>(
    array: &Bound<'py, PyUntypedArray>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyUntypedArray>> {
    Ok(array.py().import("numpy")?.getattr("broadcast_to")?.call1((array, shape.to_vec()))?.cast_into()?)
}

fn shaped(name: &str, array: &Bound<'_, PyUntypedArray>, right: &str) -> PyErr {
    let sides = array.shape().iter().map(usize::to_string).collect::<Vec<_>>();
    let comma = if sides.len() == 1 { "," } else { "" };
    PyValueError::new_err(format!("`{name}` has the shape ({}{comma}): give {right}", sides.join(", ")))
}

/// Points or directions: an array of shape (n, 3), or of shape (3,) for one row that is used for all.
pub struct Vectors<'py>(Bound<'py, PyUntypedArray>);

/// The rows of an array of points or directions.
pub enum Rows<'py> {
    F64(PyReadonlyArray2<'py, f64>),
    F32(PyReadonlyArray2<'py, f32>),
}

/// A view of the rows, for other threads.
#[derive(Clone, Copy)]
pub enum View<'a> {
    F64(ArrayView2<'a, f64>),
    F32(ArrayView2<'a, f32>),
}

impl<'py> Vectors<'py> {
    /// Takes an array of `float64` or `float32` without a copy, and converts other numbers.
    pub fn of(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let array = array(object)?;
        let (is_float, is_native) = (array.dtype().kind() == b'f', array.dtype().is_native_byteorder());
        let is_taken = is_float && is_native != Some(false) && matches!(array.dtype().itemsize(), 4 | 8);
        let array = if is_taken { array } else { converted(&array, "float64")? };
        match array.shape() {
            [3] | [_, 3] => Ok(Self(array)),
            _ => Err(shaped(name, &array, "(n, 3), or (3,) for one that stands for all")),
        }
    }

    /// Returns the number of rows; `None` for a single row that stands for any number.
    pub fn count(&self) -> Option<usize> {
        (self.0.ndim() == 2).then(|| self.0.shape()[0])
    }

    /// Returns `count` rows.
    pub fn rows(&self, count: usize) -> PyResult<Rows<'py>> {
        let array = if self.0.ndim() == 2 { self.0.clone() } else { repeated(&self.0, &[count, 3])? };
        Ok(match array.extract() {
            Ok(rows) => Rows::F64(rows),
            Err(_) => Rows::F32(array.extract()?),
        })
    }
}

impl Rows<'_> {
    /// Returns a view of the rows.
    pub fn view(&self) -> View<'_> {
        match self {
            Self::F64(array) => View::F64(array.as_array()),
            Self::F32(array) => View::F32(array.as_array()),
        }
    }
}

impl View<'_> {
    /// Returns the row of this index.
    #[inline]
    pub fn row(&self, index: usize) -> DVec3 {
        match self {
            Self::F64(rows) => DVec3::from([0, 1, 2].map(|axis| rows[[index, axis]])),
            Self::F32(rows) => DVec3::from([0, 1, 2].map(|axis| f64::from(rows[[index, axis]]))),
        }
    }
}

/// Takes one number for all rays, or an array with a number for each.
pub fn numbers<'py>(
    object: &Bound<'py, PyAny>,
    name: &str,
    count: usize,
) -> PyResult<PyReadonlyArray1<'py, f64>> {
    let array = converted(&array(object)?, "float64")?;
    match array.shape() {
        [] => repeated(&array, &[count])?.extract(),
        [length] if *length == count => array.extract(),
        _ => Err(shaped(name, &array, &format!("a number, or ({count},) for one of each ray"))),
    }
}

/// Takes the corners of triangles: an array of integers of shape (m, 3), indices below `vertices`.
pub fn faces(object: &Bound<'_, PyAny>, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    let array = array(object)?;
    let dtype = array.dtype();
    if !matches!(dtype.kind(), b'i' | b'u') {
        return Err(PyTypeError::new_err(format!("`faces` has the type {dtype}: give integers")));
    }
    if !matches!(array.shape(), [_, 3]) {
        return Err(shaped("faces", &array, "(m, 3)"));
    }
    if let Ok(faces) = array.extract() {
        return indices::<i64>(&faces, vertices);
    }
    if let Ok(faces) = array.extract() {
        return indices::<i32>(&faces, vertices);
    }
    if let Ok(faces) = array.extract() {
        return indices::<u32>(&faces, vertices);
    }
    let wide = if dtype.kind() == b'u' { "uint64" } else { "int64" };
    let wide = converted(&array, wide)?;
    match wide.extract() {
        Ok(faces) => indices::<u64>(&faces, vertices),
        Err(_) => indices::<i64>(&wide.extract()?, vertices),
    }
}

fn indices<T: Copy + Element + Into<i128>>(
    faces: &PyReadonlyArray2<'_, T>,
    vertices: usize,
) -> PyResult<Vec<[u32; 3]>> {
    let faces = faces.as_array();
    let corner = |face: usize, corner: usize| {
        let index: i128 = faces[[face, corner]].into();
        u32::try_from(index).ok().filter(|index| (*index as usize) < vertices).ok_or_else(|| {
            let last = vertices.saturating_sub(1);
            PyIndexError::new_err(format!(
                "corner {corner} of face {face} is {index}, which is not the index of a vertex: there are {vertices}, 0 to {last}"
            ))
        })
    };
    (0..faces.nrows()).map(|face| Ok([corner(face, 0)?, corner(face, 1)?, corner(face, 2)?])).collect()
}
