//! Images as arrays.

use crate::work::How;
use glam::DVec3;
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::io::{self, Write};
use std::iter;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::{About, Format};
use tabray_core::render::flaws::Flaws;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::RenderCallbacks;
use tabray_core::render::{Renderer, trace};
use tabray_core::scene::model::Model;
use tabray_core::text::{self, count};
use tempfile::NamedTempFile;

/// An image. Its light is an array of shape (height, width, 3), float64: red, green and blue, in rows from the top.
/// `numpy.asarray` accepts an image. If it is transparent where it shows no object, the shape is (height, width, 4): alpha
/// is the last channel, and the light is that of the objects alone, premultiplied.
///
/// The light is linear, before tone, transfer curve and rounding. Under the notes' rules, it includes the exposure.
#[pyclass(frozen, module = "tabray")]
pub struct Image {
    size: [usize; 2],
    /// Red, green and blue of each pixel, and alpha if there is any: the bytes of an image file.
    bytes: Vec<u8>,
    has_alpha: bool,
    /// The light.
    #[pyo3(get)]
    array: Py<PyArray3<f64>>,
    /// The distance of the first hit at each pixel's middle, in world units; inf without one. None unless asked for.
    #[pyo3(get)]
    depth: Option<Py<PyArray2<f64>>>,
    /// The object of that hit, an index of `Scene.objects`; -1 without one. int32. None unless asked for.
    #[pyo3(get)]
    objects: Option<Py<PyArray2<i32>>>,
    /// The unit normal at that hit; 0 without one. (height, width, 3). None unless asked for.
    #[pyo3(get)]
    normals: Option<Py<PyArray3<f64>>>,
}

/// What to render.
pub struct Wanted {
    /// The width and the height in pixels; the scene's if not given.
    pub size: Option<[usize; 2]>,
    /// The number of samples of each pixel; the scene's if not given.
    pub samples: Option<u32>,
    /// Whether the image is transparent where it shows no object; the scene's choice if not given.
    pub alpha: Option<bool>,
    pub depth: bool,
    pub objects: bool,
    pub normals: bool,
}

/// The first hit at the middle of a pixel: its distance, its object and its normal.
type Seen = (f64, i32, [f64; 3]);

/// Renders an image.
pub fn render(py: Python<'_>, model: &Model, wanted: &Wanted, how: &How) -> PyResult<Image> {
    let own = &model.camera.value;
    let size = wanted.size.unwrap_or(own.pixels);
    let [width, height] = size;
    let has_alpha = wanted.alpha.unwrap_or(own.alpha);
    let flaws = Mutex::new(Flaws::default());
    let made = how.run(py, height, |renderer, progress| {
        // What may be left out of an image depends on its size.
        let mut plan = if size == own.pixels { Plan::for_picture(model) } else { Plan::new(model) };
        (plan.camera.pixels, plan.camera.samples) = (size, wanted.samples.unwrap_or(own.samples));
        plan.camera.alpha = has_alpha;
        let add = |part: Flaws| flaws.lock().unwrap_or_else(PoisonError::into_inner).add(&part);
        let overseer = RenderCallbacks { stops: &|| progress.stops(), row: &|| progress.step(1) };
        let part = [&(0..width), &(0..height)];
        let seen_light = |light: DVec3, alpha: f64| light.extend(alpha).to_array();
        let light = renderer.light(&plan, part, overseer, &add, &seen_light)?;
        let is_seen = wanted.depth || wanted.objects || wanted.normals;
        let seen = if is_seen { seen(renderer, &plan, &|| progress.stops())? } else { Vec::new() };
        let display = plan.camera.display();
        let colour = |[red, green, blue, _]: [f64; 4]| DVec3::new(red, green, blue);
        let bytes = match has_alpha {
            true => {
                light.iter().flat_map(|light| display.bytes_with_alpha(colour(*light), light[3])).collect()
            }
            false => light.iter().flat_map(|light| display.bytes(colour(*light))).collect::<Vec<_>>(),
        };
        let of = |light: [f64; 4]| display.full_range(colour(light));
        let light: Vec<f64> = match has_alpha {
            true => light.iter().flat_map(|light| of(*light).extend(light[3]).to_array()).collect(),
            false => light.iter().flat_map(|light| of(*light).to_array()).collect(),
        };
        Some((light, bytes, seen))
    })?;
    // Only an exception ends rendering early, and `run` returns it.
    let (light, bytes, seen) = made.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?;
    warn(py, &flaws.into_inner().unwrap_or_else(PoisonError::into_inner))?;
    let (flat, deep) = ((height, width), (height, width, 3));
    let channels = if has_alpha { 4 } else { 3 };
    let wrong = |error: numpy::ndarray::ShapeError| PyValueError::new_err(error.to_string());
    let depth = wanted.depth.then(|| seen.iter().map(|seen| seen.0).collect());
    let depth = depth.map(|depth| Array2::from_shape_vec(flat, depth)).transpose().map_err(wrong)?;
    let objects = wanted.objects.then(|| seen.iter().map(|seen| seen.1).collect());
    let objects = objects.map(|objects| Array2::from_shape_vec(flat, objects)).transpose().map_err(wrong)?;
    let normals = wanted.normals.then(|| seen.iter().flat_map(|seen| seen.2).collect());
    let normals = normals.map(|normals| Array3::from_shape_vec(deep, normals)).transpose().map_err(wrong)?;
    Ok(Image {
        size,
        bytes,
        has_alpha,
        array: Array3::from_shape_vec((height, width, channels), light)
            .map_err(wrong)?
            .into_pyarray(py)
            .unbind(),
        depth: depth.map(|depth| depth.into_pyarray(py).unbind()),
        objects: objects.map(|objects| objects.into_pyarray(py).unbind()),
        normals: normals.map(|normals| normals.into_pyarray(py).unbind()),
    })
}

/// Returns the first hits at the middles of all pixels.
fn seen(renderer: &Renderer, plan: &Plan, stops: &(dyn Fn() -> bool + Sync)) -> Option<Vec<Seen>> {
    let ([_, height], numbers) = (plan.camera.pixels, plan.model.numbers());
    let pixel = |x: usize, y: usize| -> Seen {
        match trace::first_hit(plan, &plan.camera.sight(x as f64, y as f64)) {
            None => (f64::INFINITY, -1, [0.0; 3]),
            Some(hit) => {
                let normal = hit.object.shape.normal(hit.point);
                (hit.distance, numbers[hit.index] as i32, normal.to_array())
            }
        }
    };
    let done = || if stops() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    renderer.pixels(plan, 0..height, &done, pixel)
}

/// Warns of pixels with flaws.
fn warn(py: Python<'_>, flaws: &Flaws) -> PyResult<()> {
    let told = [
        (
            flaws.cuts.pixels,
            "not finished: mirrors or glass spawn too many rays; a lower `specular` or `transparency` ends them sooner",
        ),
        (flaws.undecided.pixels(), "could not be decided: a surface that rays touch may be missing there"),
    ];
    for (pixels, what) in told.into_iter().filter(|(pixels, _)| *pixels > 0) {
        let message = format!("{} {what}", count(pixels as usize, "pixel"));
        py.import("tabray._errors")?.getattr("warn_of_image")?.call1((message,))?;
    }
    Ok(())
}

impl Image {
    /// Returns what a file says besides the pixels.
    fn about(&self, dpi: Option<u32>) -> About<'static> {
        About { texts: &[], dpi, alpha: self.has_alpha }
    }

    /// Encodes the image in this format.
    fn encoded(&self, format: Format, dpi: Option<u32>) -> io::Result<Vec<u8>> {
        let (mut file, about) = (Vec::new(), self.about(dpi));
        format.write_on(None, &about, &mut file, self.size, iter::once(Ok(self.bytes.clone())))?;
        Ok(file)
    }

    fn full_range(&self, py: Python<'_>, format: FullRange, dpi: Option<u32>) -> PyResult<Vec<u8>> {
        let array: PyReadonlyArray3<'_, f64> = self.array.bind(py).try_readonly()?;
        let numbers: Vec<f32> = array.as_array().iter().map(|number| *number as f32).collect();
        let mut file = Vec::new();
        format.write(&mut file, self.size, &numbers, &self.about(dpi))?;
        Ok(file)
    }
}

/// Writes a file, which appears when it is complete.
fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file: NamedTempFile = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.persist(path).map(drop).map_err(|error| error.error)
}

#[pymethods]
impl Image {
    /// Writes the image to a file, in the format of the file name's ending. .png and .ppm have the bytes that the
    /// command line writes; .exr and .pfm have the light, as float32. An existing file is replaced when the new one
    /// is complete. A transparent image is a .png, whose alpha is not premultiplied, or an .exr, where it is. `dpi` records in a .png or an .exr with how many pixels per inch the image is to be printed.
    #[pyo3(signature = (path, *, dpi=None))]
    fn save(&self, py: Python<'_>, path: PathBuf, dpi: Option<u32>) -> PyResult<()> {
        if dpi.is_some_and(|dpi| !(1..=100_000).contains(&dpi)) {
            return Err(PyValueError::new_err("`dpi` is a whole number from 1 to 100000"));
        }
        let bytes = match (Format::of(&path), FullRange::of(&path)) {
            (Some(Format::Ppm), _) | (_, Some(FullRange::Pfm)) if dpi.is_some() || self.has_alpha => {
                let what = if dpi.is_some() { "record `dpi`" } else { "be transparent" };
                let told = format!("`{}` cannot {what}: end it in .png or .exr", text::shown(&path));
                return Err(PyValueError::new_err(told));
            }
            (Some(format), _) => self.encoded(format, dpi)?,
            (None, Some(format)) => self.full_range(py, format, dpi)?,
            (None, None) => {
                let told = format!(
                    "`{}` has no known format: end it in .png, .ppm, .exr or .pfm",
                    text::shown(&path)
                );
                return Err(PyValueError::new_err(told));
            }
        };
        let cannot = |error: io::Error| {
            let told = format!("cannot write `{}`: {}", text::shown(&path), text::reason(&error));
            io::Error::new(error.kind(), told).into()
        };
        py.detach(|| write(&path, &bytes)).map_err(cannot)
    }

    /// The width and the height in pixels.
    #[getter]
    fn size(&self) -> (usize, usize) {
        (self.size[0], self.size[1])
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = self.array.bind(py).as_any();
        match (dtype, copy) {
            (None, None | Some(false)) => Ok(array.clone()),
            (None, Some(true)) => array.call_method0("copy"),
            (Some(dtype), Some(true)) => array.call_method1("astype", (dtype,)),
            (Some(dtype), _) => py.import("numpy")?.getattr("asarray")?.call1((array, dtype)),
        }
    }

    pub(crate) fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.encoded(Format::Png(Compression::Balanced), None)?))
    }

    fn __repr__(&self) -> String {
        format!("<tabray.Image of {} x {} pixels>", self.size[0], self.size[1])
    }
}
