//! Hits of rays, as arrays.

use crate::arrays::{Rows, Vectors, View, numbers};
use crate::work::{How, Progress};
use glam::{DVec2, DVec3};
use numpy::ndarray::{Array2, ArrayView1};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::BTreeSet;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::parallel;
use tabray_core::query::{Answer, Crossing, Query, QueryRay, Surroundings};
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_core::world::certify::Precision;
use tabray_rays::hits::answers::code;

/// The number of packets that are answered at a time: enough for all threads, and little memory.
const TOGETHER: usize = 256;

/// The number of rays that are answered with 237 bits between two checks for a stop: about a tenth of a second.
const TIGHT: usize = 16;

/// How rays are answered.
#[derive(Clone, Copy)]
pub struct Asked {
    /// Whether nothing is proven.
    pub fast: bool,
    /// Whether bounds are narrowed with 237 bits.
    pub tight: bool,
}

/// The rays of a query.
pub struct Rays<'py> {
    count: usize,
    origins: Rows<'py>,
    directions: Rows<'py>,
    ends: Option<PyReadonlyArray1<'py, f64>>,
}

/// A view of the rays, for other threads.
struct RayView<'a> {
    count: usize,
    origins: View<'a>,
    directions: View<'a>,
    ends: Option<ArrayView1<'a, f64>>,
}

impl<'py> Rays<'py> {
    /// Takes the arrays of rays.
    pub fn of(
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        t_max: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let [from, along] = [Vectors::of(origins, "origins")?, Vectors::of(directions, "directions")?];
        let count = match (from.count(), along.count()) {
            (Some(one), Some(other)) if one != other => {
                return Err(PyValueError::new_err(format!(
                    "there are {one} origins and {other} directions: give as many of both, or one for all"
                )));
            }
            (one, other) => one.or(other).unwrap_or(1),
        };
        let ends = t_max.map(|ends| numbers(ends, "t_max", count)).transpose()?;
        Ok(Self { count, origins: from.rows(count)?, directions: along.rows(count)?, ends })
    }

    fn view(&self) -> RayView<'_> {
        let ends = self.ends.as_ref().map(|ends| ends.as_array());
        RayView { count: self.count, origins: self.origins.view(), directions: self.directions.view(), ends }
    }
}

impl RayView<'_> {
    /// Returns a ray with the t of its end, or a message about its fault.
    fn ray(&self, index: usize) -> Result<(QueryRay, f64), String> {
        let (origin, dir) = (self.origins.row(index), self.directions.row(index));
        let ray = QueryRay::new(origin, dir).ok_or_else(|| match dir == DVec3::ZERO {
            true => format!("the direction of ray {index} is 0: a ray goes somewhere"),
            false => format!("ray {index} is not finite: its origin is {origin}, and its direction {dir}"),
        })?;
        let end = self.ends.map_or(f64::INFINITY, |ends| ends[index]);
        if end > 0.0 {
            Ok((ray, end))
        } else {
            Err(format!("`t_max` of ray {index} is {end}: give a positive number"))
        }
    }
}

/// Passes the results of `packet` for all packets of rays to `sink`, in the order of the rays. `packet` takes the index
/// of the packet's first ray, the rays, and the t at which each ray ends.
fn in_packets<T: Send>(
    progress: &Progress,
    rays: &RayView,
    size: usize,
    packet: impl Fn(usize, &[QueryRay], &[f64]) -> Vec<T> + Sync,
    mut sink: impl FnMut(T),
) -> Result<(), String> {
    let answered = |first: usize| -> Result<Vec<T>, String> {
        if progress.stops() {
            return Ok(Vec::new());
        }
        let range = first..rays.count.min(first + size);
        let (of, ends): (Vec<_>, Vec<_>) =
            range.clone().map(|index| rays.ray(index)).collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let answers = packet(first, &of, &ends);
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

/// The answer to one ray, with the surface at its hit.
type Told = (Answer, Option<Surroundings>);

/// Adds the surface to an answer, and names the object by its number.
fn told(query: &Query, ray: &QueryRay, answer: Answer) -> Told {
    let surface = query.surroundings(ray, &answer);
    (Answer { object: answer.object.map(|object| query.number(object)), ..answer }, surface)
}

/// The hits of rays: one array for each property, with one entry for each ray. An entry without a value is -1 or NaN.
#[pyclass(frozen, subclass, module = "tabray", get_all)]
pub struct Hits {
    /// The answer: a `Verdict`. uint8.
    verdict: Py<PyArray1<u8>>,
    /// The number of bits of the proof: 53 or 237; 0 without a proof. uint8.
    proof: Py<PyArray1<u8>>,
    /// The object, an index of `Scene.objects`. int32.
    object: Py<PyArray1<i32>>,
    /// The face of the object, where it has several. int32.
    face: Py<PyArray1<i32>>,
    /// The t of the hit, in lengths of the ray's direction.
    t: Py<PyArray1<f64>>,
    /// A lower bound of the real t; -inf without a proof.
    t_low: Py<PyArray1<f64>>,
    /// An upper bound of the real t; inf without a proof.
    t_high: Py<PyArray1<f64>>,
    /// The distance in world units, rounded.
    distance: Py<PyArray1<f64>>,
    /// The point, rounded. (n, 3).
    point: Py<PyArray2<f64>>,
    /// The unit normal of the shape there, rounded. (n, 3).
    normal: Py<PyArray2<f64>>,
    /// The coordinates u and v there, where the shape has some, rounded. (n, 2).
    uv: Py<PyArray2<f64>>,
}

/// The columns of the answers.
#[derive(Default)]
struct Columns {
    verdict: Vec<u8>,
    proof: Vec<u8>,
    object: Vec<i32>,
    face: Vec<i32>,
    t: Vec<f64>,
    t_low: Vec<f64>,
    t_high: Vec<f64>,
    distance: Vec<f64>,
    point: Vec<f64>,
    normal: Vec<f64>,
    uv: Vec<f64>,
}

impl Columns {
    fn add(&mut self, (answer, surface): Told) {
        let index = |index: Option<u32>| index.map_or(-1, |index| index as i32);
        let vector = |vector: Option<DVec3>| vector.unwrap_or(DVec3::NAN).to_array();
        self.verdict.push(code(answer.verdict));
        self.proof.push(match answer.proof {
            None => 0,
            Some(Precision::Double) => 53,
            Some(Precision::Octuple) => 237,
        });
        self.object.push(index(answer.object.map(|object| object as u32)));
        self.face.push(index(surface.and_then(|surface| surface.face)));
        self.t.push(answer.t);
        self.t_low.push(answer.bounds.low);
        self.t_high.push(answer.bounds.high);
        self.distance.push(answer.distance);
        self.point.extend(vector(surface.map(|surface| surface.point)));
        self.normal.extend(vector(surface.map(|surface| surface.normal)));
        let uv = surface.and_then(|surface| surface.uv);
        self.uv.extend(uv.unwrap_or(DVec2::NAN).to_array());
    }

    fn into_hits(self, py: Python<'_>) -> PyResult<Hits> {
        fn array<T: numpy::Element>(py: Python<'_>, of: Vec<T>) -> Py<PyArray1<T>> {
            of.into_pyarray(py).unbind()
        }
        let rows = |of: Vec<f64>, width: usize| {
            let rows = Array2::from_shape_vec((of.len() / width, width), of);
            rows.map(|rows| rows.into_pyarray(py).unbind())
                .map_err(|error| PyValueError::new_err(error.to_string()))
        };
        Ok(Hits {
            verdict: array(py, self.verdict),
            proof: array(py, self.proof),
            object: array(py, self.object),
            face: array(py, self.face),
            t: array(py, self.t),
            t_low: array(py, self.t_low),
            t_high: array(py, self.t_high),
            distance: array(py, self.distance),
            point: rows(self.point, 3)?,
            normal: rows(self.normal, 3)?,
            uv: rows(self.uv, 2)?,
        })
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

/// Finds the first hits of rays.
pub fn hits(py: Python<'_>, model: &Model, rays: &Rays, asked: Asked, how: &How) -> PyResult<Hits> {
    let rays = rays.view();
    let columns = how.run(py, rays.count, |_, progress| {
        let (query, mut columns) = (Query::new(model), Columns::default());
        let packet = |_: usize, of: &[QueryRay], ends: &[f64]| -> Vec<Told> {
            let answers = if asked.fast { query.traced(of) } else { query.proven(of, asked.tight) };
            let ended = answers.into_iter().zip(ends).map(|(answer, end)| answer.within(*end));
            ended.zip(of).map(|(answer, ray)| told(&query, ray, answer)).collect()
        };
        let size = packet_size(asked.tight);
        in_packets(progress, &rays, size, packet, |told| columns.add(told)).map(|()| columns)
    })?;
    columns.map_err(PyValueError::new_err)?.into_hits(py)
}

/// Finds the crossings of rays and surfaces.
pub fn crossings(
    py: Python<'_>,
    model: &Model,
    rays: &Rays,
    is_tight: bool,
    how: &How,
) -> PyResult<Py<Crossings>> {
    let rays = rays.view();
    let all = how.run(py, rays.count, |_, progress| {
        let (query, mut columns) = (Query::new(model), Columns::default());
        let (mut numbers, mut enters) = (Vec::new(), Vec::new());
        let packet = |first: usize, of: &[QueryRay], ends: &[f64]| {
            let of_ray = |(number, (ray, end)): (usize, (&QueryRay, &f64))| {
                let crossings = query.crossings(ray, *end, is_tight).into_iter();
                let one = |of: Crossing| (number, of.enters, told(&query, ray, of.answer));
                crossings.map(one).collect::<Vec<_>>()
            };
            (first..).zip(of.iter().zip(ends)).flat_map(of_ray).collect()
        };
        let add = |(number, is_entered, told): (usize, Option<bool>, Told)| {
            numbers.push(number as i64);
            enters.push(is_entered.map_or(-1, i8::from));
            columns.add(told);
        };
        in_packets(progress, &rays, packet_size(is_tight), packet, add).map(|()| (numbers, enters, columns))
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
        let (query, mut may_be) = (Query::new(model), Vec::new());
        let packet = |_: usize, of: &[QueryRay], ends: &[f64]| match fast {
            true => query.traced(of).iter().zip(ends).map(|(answer, end)| answer.t < *end).collect(),
            false => query.occluded(of, ends),
        };
        in_packets(progress, &rays, PACKET_SIZE, packet, |is_hit| may_be.push(is_hit)).map(|()| may_be)
    })?;
    Ok(may_be.map_err(PyValueError::new_err)?.into_pyarray(py))
}

#[pymethods]
impl Hits {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.verdict.bind(py).as_any().len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let verdicts = self.verdict.bind(py).try_readonly()?;
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
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let rays = self.ray.bind(py).try_readonly()?;
        // The last record of each ray is no crossing.
        let count = rays.as_array().iter().collect::<BTreeSet<_>>().len();
        let crossings = text::count(rays.len()? - count, "crossing");
        Ok(format!("<tabray.Crossings of {}: {crossings}>", text::count(count, "ray")))
    }
}
