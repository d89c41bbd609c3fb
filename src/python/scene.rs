//! Scenes: reading, rendering and ray queries.

use crate::errors;
use crate::hits::{self, Asked, Crossings, Hits, Rays};
use crate::image::{self, Image, Wanted};
use crate::proof::{self, Proof};
use crate::work::How;
use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::env;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use tabray_core::scene::choice::Choice;
use tabray_core::scene::model::Model;
use tabray_core::text::{count, shown};
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::sample::Sampler;
use tabray_lang::Registry;
use tabray_lang::reader::{self, Loaded, ReadOptions, Report};

/// The maximum side of an image in pixels, as for `pixeldim`.
const MAX_SIDE: usize = 100_000;

/// The maximum width of an image in a notebook, in pixels.
const SHOWN: usize = 640;

/// The text of a scene. Any number of models can be made from it.
pub struct Source {
    /// The name of the scene in messages.
    name: String,
    /// The folder to which file names in the text are relative.
    folder: PathBuf,
    bytes: Vec<u8>,
    /// The values that are set beside the text.
    sets: Vec<String>,
    /// Whether a person wrote the text. Messages show only such text.
    is_written: bool,
}

impl Source {
    /// Takes a text that the package made. `name` is its name in messages.
    fn made(name: String, folder: PathBuf, text: &str) -> Self {
        let bytes = text.as_bytes().to_vec();
        Self { name, folder, bytes, sets: Vec::new(), is_written: false }
    }

    /// Makes a model, with this accuracy or with the scene's own.
    fn load(
        &self,
        py: Python<'_>,
        accuracy: Option<Accuracy>,
        only_rays: bool,
    ) -> PyResult<Result<Loaded, Report>> {
        let registry = Registry::get().map_err(PyRuntimeError::new_err)?;
        let read = if only_rays { reader::read_for_rays } else { reader::read_by };
        let (sets, set_by) = (&self.sets[..], &vec!["set".to_owned(); self.sets.len()][..]);
        let loaded = How::PLAIN.run(py, 0, |_, _| {
            let options = ReadOptions { above_all: accuracy, sets, set_by, ..ReadOptions::default() };
            read(registry, &self.name, &self.folder, &self.bytes, options)
        })?;
        let shown = |report: Report| if self.is_written { report } else { report.without_places() };
        Ok(match loaded {
            Ok(loaded) => Ok(Loaded { warnings: shown(loaded.warnings), ..loaded }),
            Err(report) => Err(shown(report)),
        })
    }
}

/// Makes a model for ray queries only.
fn loaded_for_rays(py: Python<'_>, source: &Source) -> PyResult<Loaded> {
    source.load(py, Some(Accuracy::Exact), true)?.map_err(|report| errors::exception(py, &report))
}

/// A scene, ready for rendering and ray queries. `load`, `parse` and `scene` make one.
#[pyclass(frozen, module = "tabray")]
pub struct Scene {
    source: Source,
    model: Arc<Model>,
    /// The model with exact hits, where the scene chooses others, once it is needed.
    exact: OnceLock<Arc<Model>>,
    /// Whether the scene has a camera. One without answers ray queries only.
    #[pyo3(get)]
    has_camera: bool,
}

/// Reads the text of a scene. Its file names are relative to `folder`; `sets` are set beside it, as by `--set`. A
/// text made from dicts is not `is_written`: the caller names the parts of the dicts in messages, and messages from
/// later reads have no places.
#[pyfunction]
pub fn read(
    py: Python<'_>,
    name: String,
    folder: PathBuf,
    bytes: Vec<u8>,
    sets: Vec<String>,
    is_written: bool,
) -> PyResult<Scene> {
    let mut source = Source { name, folder, bytes, sets, is_written: true };
    let (loaded, has_camera) = match source.load(py, None, false)? {
        Ok(loaded) => (loaded, true),
        Err(report) if report.lacks_camera() => (loaded_for_rays(py, &source)?, false),
        Err(report) => return Err(errors::exception(py, &report)),
    };
    source.is_written = is_written;
    scene(py, source, loaded, has_camera)
}

/// Makes a scene from a mesh file, for ray queries.
#[pyfunction]
pub fn read_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Scene> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let source = Source::made(shown(&path), folder, &reader::mesh_for_rays(&path));
    let loaded = loaded_for_rays(py, &source)?;
    scene(py, source, loaded, false)
}

/// Makes a pickled scene again, without its warnings: `__reduce__` gives the arguments.
#[pyfunction]
pub fn read_again(
    py: Python<'_>,
    name: String,
    folder: PathBuf,
    bytes: Vec<u8>,
    sets: Vec<String>,
    is_written: bool,
    has_camera: bool,
) -> PyResult<Scene> {
    let source = Source { name, folder, bytes, sets, is_written };
    let loaded = if has_camera {
        source.load(py, None, false)?.map_err(|report| errors::exception(py, &report))?
    } else {
        loaded_for_rays(py, &source)?
    };
    Ok(Scene::new(source, loaded, has_camera))
}

fn scene(py: Python<'_>, source: Source, loaded: Loaded, has_camera: bool) -> PyResult<Scene> {
    errors::warn(py, &loaded.warnings)?;
    Ok(Scene::new(source, loaded, has_camera))
}

impl Scene {
    fn new(source: Source, loaded: Loaded, has_camera: bool) -> Self {
        Self { source, model: Arc::new(loaded.model), exact: OnceLock::new(), has_camera }
    }

    /// Returns the model with this accuracy.
    fn with(&self, py: Python<'_>, accuracy: Accuracy) -> PyResult<Arc<Model>> {
        if self.model.camera.value.accuracy == accuracy {
            return Ok(self.model.clone());
        }
        if let Some(model) = self.exact.get().filter(|_| accuracy == Accuracy::Exact) {
            return Ok(model.clone());
        }
        let loaded = self.source.load(py, Some(accuracy), !self.has_camera)?;
        let model = Arc::new(loaded.map_err(|report| errors::exception(py, &report))?.model);
        Ok(if accuracy == Accuracy::Exact { self.exact.get_or_init(|| model).clone() } else { model })
    }

    fn needs_camera(&self) -> PyResult<()> {
        let told = "the scene has no camera, and so no image: add one, such as a `look_at`";
        if self.has_camera { Ok(()) } else { Err(PyValueError::new_err(told)) }
    }

    /// Returns the size of an image, given one side or both.
    fn size(&self, width: Option<usize>, height: Option<usize>) -> PyResult<Option<[usize; 2]>> {
        let [own_width, own_height] = self.model.camera.value.pixels;
        let scaled = |side: usize, of: usize, to: usize| {
            ((side as f64 * to as f64 / of as f64).round() as usize).max(1)
        };
        let size = match (width, height) {
            (None, None) => return Ok(None),
            (Some(width), None) => [width, scaled(width, own_width, own_height)],
            (None, Some(height)) => [scaled(height, own_height, own_width), height],
            (Some(width), Some(height)) => [width, height],
        };
        if size.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            Ok(Some(size))
        } else {
            let [width, height] = size;
            Err(PyValueError::new_err(format!(
                "an image of {width} x {height} pixels cannot be made: each side is from 1 to {MAX_SIDE}"
            )))
        }
    }
}

/// Finds the accuracy of this name.
fn accuracy(name: &str) -> PyResult<Accuracy> {
    let found = Accuracy::ALL.into_iter().find(|accuracy| accuracy.option().name == name);
    found.ok_or_else(|| {
        let names = Accuracy::ALL.map(|accuracy| accuracy.option().name).join(", ");
        PyValueError::new_err(format!("there is no method `{name}`: the methods are {names}"))
    })
}

#[pymethods]
impl Scene {
    /// Renders the image. Width and height in pixels, the samples of each pixel, the method ("exact", "strict",
    /// "draft" or "classic") and whether the image is transparent where it shows no object, `alpha`, are the scene's own
    /// by default. If only width or only height is given, the other follows. `depth`, `objects` and `normals` add arrays of these. `progress` is called with the numbers of
    /// finished rows and of all rows.
    #[pyo3(signature = (
        *, samples=None, width=None, height=None, method=None, alpha=None, depth=false, objects=false, normals=false,
        threads=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn render(
        &self,
        py: Python<'_>,
        samples: Option<u32>,
        width: Option<usize>,
        height: Option<usize>,
        method: Option<&str>,
        alpha: Option<bool>,
        depth: bool,
        objects: bool,
        normals: bool,
        threads: Option<usize>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Image> {
        self.needs_camera()?;
        if samples.is_some_and(|samples| !(1..=Sampler::MAX_SAMPLES).contains(&samples)) {
            return Err(PyValueError::new_err(format!(
                "`samples` must be from 1 to {}",
                Sampler::MAX_SAMPLES
            )));
        }
        let wanted = Wanted { size: self.size(width, height)?, samples, alpha, depth, objects, normals };
        let model = match method {
            None => self.model.clone(),
            Some(name) => self.with(py, accuracy(name)?)?,
        };
        image::render(py, &model, &wanted, &How { threads, progress })
    }

    /// Finds the first hits of rays, each with a proof. Origins and directions are arrays of shape (n, 3), or (3,)
    /// for one that is used for all rays. Arrays of float64 or float32 are not copied. Directions need not be unit
    /// vectors: t is in lengths of the direction. `t_max` is the t at which rays end, a number or one for each. `leaves`
    /// are the hits of other rays at which these start, one for each: a rounded point lies on either side of its surface,
    /// which a ray that leaves it does not hit there.
    /// `fast` proves nothing and returns the tracer's hits; `tight` narrows the bounds of t with 237 bits, in many
    /// times the time. `progress` is called with the numbers of finished rays and of all rays.
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
        let model = self.with(py, Accuracy::Exact)?;
        hits::hits(py, &model, &rays, &Asked { fast, tight, ..Asked::default() }, &How { threads, progress })
    }

    /// Finds the crossings of each ray with surfaces before `t_max`, in their order along the ray. The last entry of each ray has
    /// the verdict MISS if there are no more crossings, and UNDECIDED if there may be more from its `t_low` on. The other
    /// arguments are those of `hits`.
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
        let model = self.with(py, Accuracy::Exact)?;
        hits::crossings(py, &model, &rays, tight, &How { threads, progress })
    }

    /// Tells for each ray whether anything is hit before `t_max`, as for shadows. False is proven; True also stands
    /// where 237 bits do not tell. With `fast`, nothing is proven. `leaves` is that of `hits`; without it, a warning tells
    /// of rays that start on a surface.
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
        let model = self.with(py, Accuracy::Exact)?;
        hits::occluded(py, &model, &rays, fast, &How { threads, progress })
    }

    /// Proves for each pixel which object it shows.
    #[pyo3(signature = (*, threads=None, progress=None))]
    fn verify(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Proof> {
        self.needs_camera()?;
        proof::verify(py, &self.model, &How { threads, progress })
    }

    /// The names of the objects that rays may hit, in the order of the indices in arrays.
    #[getter]
    fn objects(&self) -> Vec<&str> {
        let entities = self.model.objects.chunk_by(|one, other| one.args.order() == other.args.order());
        entities.map(|of| of[0].args.name()).collect()
    }

    /// The width and the height of the image in pixels; None without a camera.
    #[getter(size)]
    fn own_size(&self) -> Option<(usize, usize)> {
        let [width, height] = self.model.camera.value.pixels;
        self.has_camera.then_some((width, height))
    }

    /// A pickle has the text of the scene, and the full name of its folder: the scene is read again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, impl IntoPyObject<'py>)> {
        let Source { name, folder, bytes, sets, is_written } = &self.source;
        let folder = env::current_dir()?.join(folder);
        let again = py.import("tabray._native")?.getattr("read_again")?;
        Ok((again, (name, folder, PyBytes::new(py, bytes), sets, *is_written, self.has_camera)))
    }

    /// Nothing changes a scene: it is its own copy.
    fn __copy__(own: Py<Self>) -> Py<Self> {
        own
    }

    fn __deepcopy__(own: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        own
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        if !self.has_camera {
            return Ok(None);
        }
        let [width, _] = self.model.camera.value.pixels;
        let size = self.size((width > SHOWN).then_some(SHOWN), None)?;
        let wanted =
            Wanted { size, samples: None, alpha: None, depth: false, objects: false, normals: false };
        image::render(py, &self.model, &wanted, &How::PLAIN)?._repr_png_(py).map(Some)
    }

    fn __repr__(&self) -> String {
        let Model { objects, lights, .. } = &*self.model;
        let image = match self.own_size() {
            Some((width, height)) => format!("{width} x {height} pixels"),
            None => "no camera".to_owned(),
        };
        let (objects, lights) = (count(objects.len(), "object"), count(lights.len(), "light"));
        format!("<tabray.Scene `{}`: {objects}, {lights}, {image}>", self.source.name)
    }
}
