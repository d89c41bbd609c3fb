//! Meshes from arrays.

use crate::arrays::{self, Vectors};
use crate::errors;
use crate::hits::{self, Asked, Crossings, Hits, Rays};
use crate::work::How;
use glam::DVec3;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};
use tabray_core::parallel;
use tabray_core::scene::model::Model;
use tabray_core::shapes::mesh::{Mesh as Shape, Surface};
use tabray_core::text::count;
use tabray_core::world::accuracy::{Accuracy, Exact};
use tabray_core::world::any_shape::AnyShape;
use tabray_lang::{Registry, reader};

/// The number of points that are tested between two checks for a stop.
const TOGETHER: usize = 64;

/// A mesh of triangles in memory, for queries with rays and points. `tabray.mesh` makes one.
#[pyclass(frozen, module = "tabray")]
pub struct Mesh {
    surface: Arc<Surface>,
    /// The surface with its faces turned alike, once it is needed.
    turned: OnceLock<Arc<Surface>>,
    model: Model,
}

/// Makes a mesh from arrays: vertices of shape (n, 3), numbers of any type, and the corners of triangles, of shape
/// (m, 3), integers of any type; or from an object with `vertices` and `faces`, such as trimesh's. Coordinates are not
/// rounded. Triangles without an area are left out: no ray hits them.
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, threads=None))]
pub fn mesh(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    threads: Option<usize>,
) -> PyResult<Mesh> {
    let (vertices, faces) = match faces {
        Some(faces) => (vertices.clone(), faces.clone()),
        None => parts(vertices)?,
    };
    let vertices = Vectors::of(&vertices, "vertices")?;
    let rows = vertices.rows(vertices.count().unwrap_or(1))?;
    let view = rows.view();
    let count = vertices.count().unwrap_or(1);
    let faces = arrays::faces(&faces, count)?;
    let how = How { threads, progress: None };
    let surface =
        how.run(py, 0, |_, _| Surface::of_arrays((0..count).map(|index| view.row(index)).collect(), faces))?;
    let surface = Arc::new(surface.map_err(|error| PyValueError::new_err(error.to_string()))?);
    let registry = Registry::get().map_err(PyRuntimeError::new_err)?;
    let shape = AnyShape::of_packets(Shape::<Exact>::new(surface.clone(), Accuracy::Exact));
    let model = reader::model_of_shape(registry, shape).map_err(|report| errors::exception(py, &report))?;
    Ok(Mesh { surface, turned: OnceLock::new(), model })
}

/// Returns the vertices and the faces of an object that has both.
fn parts<'py>(object: &Bound<'py, PyAny>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    match [object.getattr_opt("vertices")?, object.getattr_opt("faces")?] {
        [Some(vertices), Some(faces)] => Ok((vertices, faces)),
        _ => Err(PyTypeError::new_err(format!(
            "an object of the type {} is no mesh: give vertices and faces, or an object that has `vertices` and `faces`",
            object.get_type().name()?
        ))),
    }
}

impl Mesh {
    /// Returns the surface of a closed mesh with its faces turned alike, which defines its inside.
    fn turned(&self) -> PyResult<Arc<Surface>> {
        if self.surface.is_closed() {
            return Ok(self.surface.clone());
        }
        if let Some(turned) = self.turned.get() {
            return Ok(turned.clone());
        }
        let open = self.surface.why_not_closed.open;
        if open > 0 {
            let edges = count(open, "edge");
            return Err(PyValueError::new_err(format!("the mesh is open at {edges}: it has no inside")));
        }
        let turned = self.surface.turned_alike().map_err(|error| PyValueError::new_err(error.to_string()))?;
        match turned.why_not_closed.clashing {
            0 => Ok(self.turned.get_or_init(|| Arc::new(turned)).clone()),
            clashing => Err(PyValueError::new_err(format!(
                "the faces at {} cannot be turned alike: the mesh has no inside",
                count(clashing, "edge")
            ))),
        }
    }
}

#[pymethods]
impl Mesh {
    /// Finds the first hits of rays, as `Scene.hits` does. The face is the index of the triangle.
    #[pyo3(signature = (
        origins, directions, t_max=None, *, leaves=None, fast=false, tight=false, threads=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn hits<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        t_max: Option<&Bound<'py, PyAny>>,
        leaves: Option<&Bound<'py, Hits>>,
        fast: bool,
        tight: bool,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Hits> {
        let rays = Rays::of(origins, directions, t_max, leaves)?;
        hits::hits(
            py,
            &self.model,
            &rays,
            &Asked { fast, tight, ..Asked::default() },
            &How { threads, progress },
        )
    }

    /// Finds the crossings of rays and the mesh, as `Scene.crossings` does.
    #[pyo3(signature = (origins, directions, t_max=None, *, tight=false, threads=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn crossings<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        t_max: Option<&Bound<'py, PyAny>>,
        tight: bool,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Py<Crossings>> {
        let rays = Rays::of(origins, directions, t_max, None)?;
        hits::crossings(py, &self.model, &rays, tight, &How { threads, progress })
    }

    /// Tells for each ray whether anything is hit before its end, as `Scene.occluded` does.
    #[pyo3(signature = (
        origins, directions, t_max=None, *, leaves=None, fast=false, threads=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn occluded<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        t_max: Option<&Bound<'py, PyAny>>,
        leaves: Option<&Bound<'py, Hits>>,
        fast: bool,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let rays = Rays::of(origins, directions, t_max, leaves)?;
        hits::occluded(py, &self.model, &rays, fast, &How { threads, progress })
    }

    /// Tells for each point whether it is inside: 1 inside, 0 outside, and -1 where 237 bits do not tell, as on the
    /// surface. int8.
    ///
    /// A point is inside where the mesh winds around it: the number of bodies around it, less that of those turned
    /// inside out, is not 0. Each crossing of a line from the point is proven. Overlapping bodies are one, and a body
    /// turned inward within another is a cavity, as in a solid. Faces that are turned against their neighbours are
    /// turned alike first, as in meshes from files. The mesh must be closed.
    #[pyo3(signature = (points, *, threads=None, progress=None))]
    fn inside<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let surface = self.turned()?;
        let points = Vectors::of(points, "points")?;
        let count = points.count().unwrap_or(1);
        let rows = points.rows(count)?;
        let view = rows.view();
        let point = |index: usize| -> Result<i8, usize> {
            let at: DVec3 = view.row(index);
            let known = at.is_finite().then(|| surface.winds_around(at)).ok_or(index)?;
            Ok(known.map_or(-1, i8::from))
        };
        let inside: Result<Vec<i8>, usize> = How { threads, progress }.run(py, count, |_, progress| {
            let parts = parallel::map(count.div_ceil(TOGETHER), |part| {
                let range = part * TOGETHER..count.min((part + 1) * TOGETHER);
                progress.step(range.len());
                let range = if progress.stops() { 0..0 } else { range };
                range.map(point).collect::<Result<Vec<_>, _>>()
            });
            parts.into_iter().collect::<Result<Vec<_>, _>>().map(|parts| parts.concat())
        })?;
        let inside = inside.map_err(|at| PyValueError::new_err(format!("point {at} is not finite")))?;
        Ok(inside.into_pyarray(py))
    }

    /// Whether the mesh is closed: each edge joins an even number of triangles.
    #[getter]
    fn is_closed(&self) -> bool {
        self.surface.why_not_closed.open == 0
    }

    /// The low and the high corner of a bounding box.
    #[getter]
    fn bounds(&self) -> [[f64; 3]; 2] {
        self.surface.bounds().map(|corner| corner.to_array())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, impl IntoPyObject<'py>)> {
        let (vertices, faces) = self.surface.to_arrays();
        let vertices: Vec<[f64; 3]> = vertices.iter().map(DVec3::to_array).collect();
        let arrays = (Array2::from(vertices).into_pyarray(py), Array2::from(faces).into_pyarray(py));
        Ok((py.import("tabray._native")?.getattr("mesh")?, arrays))
    }

    /// Nothing changes a mesh: it is its own copy.
    fn __copy__(own: Py<Self>) -> Py<Self> {
        own
    }

    fn __deepcopy__(own: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        own
    }

    fn __repr__(&self) -> String {
        let closed = if self.is_closed() { "closed" } else { "open" };
        format!("<tabray.Mesh of {}, {closed}>", count(self.surface.face_count(), "triangle"))
    }
}
