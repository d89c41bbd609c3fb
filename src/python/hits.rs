//! Hits of rays, as arrays.

use crate::rays::RayView;
pub use crate::rays::Rays;
use crate::work::{How, Progress};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyInt, PyList};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::CString;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::parallel;
use tabray_core::query::{Answer, Query, QueryRay, Verdict};
use tabray_core::scene::model::Model;
use tabray_core::text;
pub use tabray_rays::hits::Asked;
use tabray_rays::hits::columns::{self, Answered, Cell};
use tabray_rays::hits::{Ray, answers};

/// The number of packets that are answered at a time: enough for all threads, and little memory.
const TOGETHER: usize = 256;

/// The number of rays that are answered with 237 bits between two checks for a stop: about a tenth of a second.
const TIGHT: usize = 16;

/// The least number of rays that start on a surface, and the part of all, one in this many, for which a warning is worth
/// its while.
const FEW_STARTS: usize = 8;
const ONE_IN: usize = 64;

/// Passes the results of `packet` for all packets of rays to `sink`, in the order of the rays. `packet` takes the index
/// of the packet's first ray, and the rays.
fn in_packets<T: Send>(
    progress: &Progress,
    (query, rays): (&Query, &RayView),
    size: usize,
    packet: impl Fn(u64, &[Ray]) -> Vec<T> + Sync,
    mut sink: impl FnMut(T),
) -> Result<(), String> {
    let answered = |first: usize| -> Result<Vec<T>, String> {
        if progress.stops() {
            return Ok(Vec::new());
        }
        let range = first..rays.count.min(first + size);
        let of: Vec<_> = range.clone().map(|index| rays.ray(query, index)).collect::<Result<_, _>>()?;
        let answers = packet(first as u64, &of);
        progress.step(range.len());
        Ok(answers)
    };
    for first in (0..rays.count).step_by(TOGETHER * size) {
        let packets = (rays.count - first).div_ceil(size).min(TOGETHER);
        for answers in parallel::map(packets, |index| answered(first + index * size)) {
            answers?.into_iter().for_each(&mut sink);
        }
        if progress.stops() {
            break;
        }
    }
    Ok(())
}

/// Returns the number of rays in a packet.
fn packet_size(is_tight: bool) -> usize {
    if is_tight { TIGHT } else { PACKET_SIZE }
}

/// The hits of rays: one array for each property, with one entry for each ray. An entry without a value is -1 or NaN.
#[pyclass(frozen, subclass, module = "tabray", get_all)]
pub struct Hits {
    /// The answer: a `Verdict`. uint8.
    verdict: Py<PyAny>,
    /// The number of bits of the proof: 53 or 237; 0 without a proof. uint8.
    proof: Py<PyAny>,
    /// The object, an index of `Scene.objects`. int32.
    object: Py<PyAny>,
    /// The face of the object, where it has several. int32.
    face: Py<PyAny>,
    /// The t of the hit, in lengths of the ray's direction.
    t: Py<PyAny>,
    /// A lower bound of the real t; -inf without a proof.
    t_low: Py<PyAny>,
    /// An upper bound of the real t; inf without a proof.
    t_high: Py<PyAny>,
    /// The distance in world units, rounded.
    distance: Py<PyAny>,
    /// The point, rounded. (n, 3).
    point: Py<PyAny>,
    /// The unit normal of the shape there, rounded. (n, 3).
    normal: Py<PyAny>,
    /// The coordinates u and v there, where the shape has some, rounded. (n, 2).
    uv: Py<PyAny>,
    /// The fraction of what is behind the hit that it covers: 1 for a miss and an opaque surface.
    coverage: Py<PyAny>,
    /// The surface of the object, for `leaves`. int32.
    surface: Py<PyAny>,
}

/// A column of answers.
enum Array {
    Words(Vec<u8>),
    Indices(Vec<i32>),
    Numbers(Vec<f64>),
    /// Rows of as many numbers as this.
    Vectors(Vec<f64>, usize),
}

impl Array {
    /// Begins a column of values like this one.
    fn like(cell: Cell) -> Self {
        match cell {
            Cell::Word(_) => Self::Words(Vec::new()),
            Cell::Index(_) => Self::Indices(Vec::new()),
            Cell::Number(_) => Self::Numbers(Vec::new()),
            Cell::Vector(_, width) => Self::Vectors(Vec::new(), width),
        }
    }

    fn push(&mut self, cell: Cell) {
        match (self, cell) {
            (Self::Words(all), Cell::Word(one)) => all.push(one),
            (Self::Indices(all), Cell::Index(one)) => all.push(one),
            (Self::Numbers(all), Cell::Number(one)) => all.push(one),
            (Self::Vectors(all, width), Cell::Vector(one, _)) => all.extend_from_slice(&one[..*width]),
            _ => unreachable!("a column has values of one kind"),
        }
    }

    fn into_array(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        Ok(match self {
            Self::Words(all) => all.into_pyarray(py).into_any().unbind(),
            Self::Indices(all) => all.into_pyarray(py).into_any().unbind(),
            Self::Numbers(all) => all.into_pyarray(py).into_any().unbind(),
            Self::Vectors(all, width) => {
                let rows = Array2::from_shape_vec((all.len() / width, width), all);
                let rows = rows.map_err(|error| PyValueError::new_err(error.to_string()))?;
                rows.into_pyarray(py).into_any().unbind()
            }
        })
    }
}

/// The columns of answers.
struct Columns(Vec<Array>);

impl Columns {
    fn new() -> Self {
        Self(columns::of_arrays().map(|(_, absent)| Array::like(absent)).collect())
    }

    fn add(&mut self, answer: &Answered) {
        self.0.iter_mut().zip(answer.cells()).for_each(|(array, cell)| array.push(cell));
    }

    fn into_hits(self, py: Python<'_>) -> PyResult<Hits> {
        let arrays = self.0.into_iter().map(|array| array.into_array(py)).collect::<PyResult<Vec<_>>>()?;
        Hits::of(arrays)
    }
}

/// The crossings of rays and surfaces: the arrays of `Hits` with one entry for each crossing, and a last entry for each
/// ray, which tells whether more crossings may follow.
#[pyclass(frozen, extends = Hits, module = "tabray", get_all)]
pub struct Crossings {
    /// The index of the ray. int64.
    ray: Py<PyArray1<i64>>,
    /// 1 where the ray enters a closed shape, 0 where it leaves one, -1 otherwise. int8.
    enters: Py<PyArray1<i8>>,
}

/// Makes pickled answers again of their arrays.
#[pyfunction]
pub fn hits_of(arrays: Vec<Py<PyAny>>) -> PyResult<Hits> {
    Hits::of(arrays)
}

/// Makes pickled crossings again of the arrays of their answers, and of their own.
#[pyfunction]
pub fn crossings_of(
    py: Python<'_>,
    arrays: Vec<Py<PyAny>>,
    ray: Py<PyArray1<i64>>,
    enters: Py<PyArray1<i8>>,
) -> PyResult<Py<Crossings>> {
    Py::new(py, PyClassInitializer::from(Hits::of(arrays)?).add_subclass(Crossings { ray, enters }))
}

/// Finds the first hits of rays.
pub fn hits(py: Python<'_>, model: &Model, rays: &Rays, asked: &Asked, how: &How) -> PyResult<Hits> {
    let rays = rays.view();
    let columns = how.run(py, rays.count, |_, progress| {
        let (query, mut columns) = (Query::new(model), Columns::new());
        let packet = |first: u64, of: &[Ray]| answers(&query, asked, first, of);
        let add = |answer: Answered| columns.add(&answer);
        in_packets(progress, (&query, &rays), packet_size(asked.tight), packet, add).map(|()| columns)
    })?;
    columns.map_err(PyValueError::new_err)?.into_hits(py)
}

/// Finds the crossings of rays and surfaces.
pub fn crossings(
    py: Python<'_>,
    model: &Model,
    rays: &Rays,
    tight: bool,
    how: &How,
) -> PyResult<Py<Crossings>> {
    let rays = rays.view();
    let all = how.run(py, rays.count, |_, progress| {
        let (query, mut columns) = (Query::new(model), Columns::new());
        let (mut numbers, mut enters) = (Vec::new(), Vec::new());
        let asked = Asked { tight, all: true, ..Asked::default() };
        let packet = |first: u64, of: &[Ray]| answers(&query, &asked, first, of);
        let add = |answer: Answered| {
            numbers.push(answer.ray.map_or(-1, |ray| ray as i64));
            enters.push(answer.enters.map_or(-1, i8::from));
            columns.add(&answer);
        };
        let size = packet_size(tight);
        in_packets(progress, (&query, &rays), size, packet, add).map(|()| (numbers, enters, columns))
    })?;
    let (ray, enters, columns) = all.map_err(PyValueError::new_err)?;
    let (ray, enters) = (ray.into_pyarray(py).unbind(), enters.into_pyarray(py).unbind());
    Py::new(py, PyClassInitializer::from(columns.into_hits(py)?).add_subclass(Crossings { ray, enters }))
}

/// Tells for each ray whether anything may be hit before its end.
pub fn occluded<'py>(
    py: Python<'py>,
    model: &Model,
    rays: &Rays,
    fast: bool,
    how: &How,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let rays = rays.view();
    let may_be = how.run(py, rays.count, |_, progress| {
        let (query, mut may_be, mut starts) = (Query::new(model), Vec::new(), 0);
        let packet = |_: u64, rays: &[Ray]| {
            let (of, ends): (Vec<_>, Vec<_>) = rays.iter().cloned().unzip();
            let answers = if fast { query.traced(&of) } else { query.proven(&of, false) };
            let told = |((answer, ray), end): ((Answer, &QueryRay), &f64)| {
                let starts = query.starts_on_surface(ray, &answer);
                let is_hit =
                    if fast { answer.t < *end } else { answer.any_within(*end).verdict != Verdict::Miss };
                (is_hit, starts)
            };
            answers.into_iter().zip(&of).zip(&ends).map(told).collect()
        };
        let add = |(is_hit, is_start): (bool, bool)| {
            may_be.push(is_hit);
            starts += usize::from(is_start);
        };
        in_packets(progress, (&query, &rays), PACKET_SIZE, packet, add).map(|()| (may_be, starts))
    })?;
    let (may_be, starts) = may_be.map_err(PyValueError::new_err)?;
    if starts >= FEW_STARTS && starts * ONE_IN >= may_be.len() {
        let of = may_be.len();
        let told = format!(
            "{starts} of {of} rays start within rounding of a surface, and hit it: `leaves=hits` tells which they leave"
        );
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(told)?, 1)?;
    }
    Ok(may_be.into_pyarray(py))
}

impl Hits {
    /// Makes answers of the arrays of `columns::of_arrays`, in their order.
    fn of(arrays: Vec<Py<PyAny>>) -> PyResult<Self> {
        let mut arrays: BTreeMap<_, _> = columns::of_arrays().map(|(name, _)| name).zip(arrays).collect();
        let mut of = |name: &'static str| arrays.remove(name).ok_or_else(|| PyKeyError::new_err(name));
        Ok(Self {
            verdict: of("verdict")?,
            proof: of("proof")?,
            object: of("object")?,
            face: of("face")?,
            t: of("t")?,
            t_low: of("t_low")?,
            t_high: of("t_high")?,
            distance: of("distance")?,
            point: of("point")?,
            normal: of("normal")?,
            uv: of("uv")?,
            coverage: of("coverage")?,
            surface: of("surface")?,
        })
    }

    /// Returns these arrays.
    fn arrays(&self, py: Python<'_>) -> Vec<Py<PyAny>> {
        let array = |name| match name {
            "verdict" => &self.verdict,
            "proof" => &self.proof,
            "object" => &self.object,
            "face" => &self.face,
            "t" => &self.t,
            "t_low" => &self.t_low,
            "t_high" => &self.t_high,
            "distance" => &self.distance,
            "point" => &self.point,
            "normal" => &self.normal,
            "uv" => &self.uv,
            "coverage" => &self.coverage,
            "surface" => &self.surface,
            _ => unreachable!("each column is an array of answers"),
        };
        columns::of_arrays().map(|(name, _)| array(name).clone_ref(py)).collect()
    }

    /// Returns the objects and the surfaces that this many rays leave.
    pub fn starts<'py>(&self, py: Python<'py>, rays: usize) -> PyResult<[PyReadonlyArray1<'py, i32>; 2]> {
        let of = |array: &Py<PyAny>| array.bind(py).extract::<PyReadonlyArray1<'py, i32>>();
        let starts = [of(&self.object)?, of(&self.surface)?];
        match starts[0].len()? {
            hits if hits == rays => Ok(starts),
            hits => Err(PyValueError::new_err(format!(
                "`leaves` has {hits} hits for {rays} rays: give one for each, as `hits[indices]` does"
            ))),
        }
    }
}

#[pymethods]
impl Hits {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.verdict.bind(py).len()
    }

    /// The arrays in the order of the columns, from which `hits_of` makes the answers again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, impl IntoPyObject<'py>)> {
        Ok((py.import("tabray._native")?.getattr("hits_of")?, (self.arrays(py),)))
    }

    /// Returns some of the answers, chosen as those of an array: by a mask, by indices or by a slice.
    fn __getitem__(&self, py: Python<'_>, index: &Bound<'_, PyAny>) -> PyResult<Self> {
        let index = if index.is_instance_of::<PyInt>() {
            PyList::new(py, [index])?.into_any()
        } else {
            index.clone()
        };
        let of = |array: Py<PyAny>| Ok(array.bind(py).get_item(&index)?.unbind());
        Self::of(self.arrays(py).into_iter().map(of).collect::<PyResult<_>>()?)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let verdicts = self.verdict.bind(py).cast::<PyArray1<u8>>()?.try_readonly()?;
        let verdicts = verdicts.as_array();
        let count = |of: u8| verdicts.iter().filter(|verdict| **verdict == of).count();
        let named = ["miss", "hit", "edge", "tie", "undecided"];
        let told = (0..).zip(named).map(|(of, name)| (count(of), name)).filter(|(count, _)| *count > 0);
        let told = told.map(|(count, name)| format!("{count} {name}")).collect::<Vec<_>>().join(", ");
        Ok(format!(
            "<tabray.Hits of {} rays: {}>",
            verdicts.len(),
            if told.is_empty() { "none" } else { &told }
        ))
    }
}

#[pymethods]
impl Crossings {
    fn __reduce__<'py>(own: PyRef<'py, Self>) -> PyResult<(Bound<'py, PyAny>, impl IntoPyObject<'py>)> {
        let py = own.py();
        let of = py.import("tabray._native")?.getattr("crossings_of")?;
        let (ray, enters) = (own.ray.clone_ref(py), own.enters.clone_ref(py));
        Ok((of, (own.as_super().arrays(py), ray, enters)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let rays = self.ray.bind(py).try_readonly()?;
        // The last record of each ray is no crossing.
        let count = rays.as_array().iter().collect::<BTreeSet<_>>().len();
        let crossings = text::count(rays.len()? - count, "crossing");
        Ok(format!("<tabray.Crossings of {}: {crossings}>", text::count(count, "ray")))
    }
}
