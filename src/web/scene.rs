//! A scene of a page: a text without files around it.

use crate::text::{NAME, view, without_files};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use tabray_core::files::{held, plain};
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::scene::value::Datum;
use tabray_core::text::list;
use tabray_lang::reader::{self, Places, ReadOptions, Report};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;
use tabray_page::camera::{self, MoveRequest};
use tabray_page::display::Display;
use tabray_page::trial_values::{self, Try};
use tabray_page::{Shown, lines};

/// The maximum number of pixels of a picture.
const MAX_PIXELS: usize = 1 << 22;

/// The maximum memory of a scene, in bytes. A page that runs out of memory is lost.
const MEMORY: u64 = 1 << 29;

/// A valid scene.
pub struct Scene {
    /// The page's name of the scene. The next one has another version.
    pub version: String,
    pub text: String,
    pub model: Model,
    pub places: Places,
    warnings: String,
    lacking: Vec<String>,
}

/// The description of a scene for the page.
#[derive(Serialize)]
pub struct Description {
    display: Display,
    size: [usize; 2],
    warnings: String,
    /// The files that the scene names and the page does not have.
    lacking: Vec<String>,
}

/// The reason why there is no scene.
#[derive(Serialize)]
pub struct Unread {
    /// The marked lines, from 1.
    lines: Vec<usize>,
    /// The errors, as text for people.
    report: String,
    /// The files that the scene names and the page does not have.
    lacking: Vec<String>,
}

impl Scene {
    /// Reads a scene, with its picture at this size instead of its own.
    ///
    /// # Errors
    /// Returns the faults of the scene.
    pub fn read(
        registry: &Registry,
        version: &str,
        text: &str,
        size: Option<[usize; 2]>,
    ) -> Result<Self, Unread> {
        let options = ReadOptions { memory: Some(MEMORY), ..ReadOptions::default() };
        let mut loaded = reader::read_by(registry, NAME, Path::new(""), text.as_bytes(), options)
            .map_err(|report| Unread::of(&report, text))?;
        if let Some(size) = size {
            loaded.model.camera.value.pixels = size.map(|side| side.max(1));
        }
        let [width, height] = loaded.model.camera.value.pixels;
        if width.saturating_mul(height) > MAX_PIXELS {
            let report = format!(
                "error: an image of {width} x {height} pixels is too large for a page\n\
                 help: the maximum is {MAX_PIXELS} pixels, such as 2048 x 2048"
            );
            return Err(Unread { lines: Vec::new(), report, lacking: Vec::new() });
        }
        let (warnings, lacking) =
            (loaded.warnings.to_string() + &shared(&loaded.warnings), lacking(&loaded.warnings));
        Ok(Self {
            version: version.to_owned(),
            text: text.to_owned(),
            model: loaded.model,
            places: loaded.places,
            warnings,
            lacking,
        })
    }

    /// Returns the description of the scene for the page.
    pub fn description(&self) -> Description {
        let camera = &self.model.camera.value;
        let (warnings, lacking) = (self.warnings.clone(), self.lacking.clone());
        Description { display: Display::of(camera), size: camera.pixels, warnings, lacking }
    }

    /// Returns the scene for queries of a page.
    pub fn shown(&self) -> Shown<'_> {
        Shown { model: &self.model, name: NAME, text: &self.text, sets: &[] }
    }

    /// Returns the text with the camera moved.
    ///
    /// # Errors
    /// Returns why the camera cannot be moved.
    pub fn moved(&self, registry: &Registry, body: &str) -> Result<String, String> {
        let wanted: MoveRequest =
            serde_json::from_str(body).map_err(|_| "this is not a movement of the camera".to_owned())?;
        let after = wanted.moved(&self.model).ok_or("the camera cannot go there")?;
        let name = self.model.camera.args.name();
        let mut text = self.text.clone();
        for (attribute, numbers) in &after {
            if self.says(registry, name, attribute, numbers) {
                continue;
            }
            let values = Syntax::Notes.values(&Datum::Numbers(numbers.clone()));
            text = written(registry, &text, name, attribute, &values)?;
        }
        Ok(text)
    }

    /// Tells whether the text already gives an attribute these numbers.
    fn says(&self, registry: &Registry, name: &str, attribute: &str, numbers: &[f64]) -> bool {
        let view = self.shown().view(registry);
        let given = trial_values::given(&view, name, attribute);
        given.iter().map(|word| view.word(*word).parse().ok()).eq(numbers.iter().copied().map(Some))
    }

    /// Returns the text with a `look_at` instead of its `camera`.
    ///
    /// # Errors
    /// Returns why no `look_at` can be written.
    pub fn turned(&self, registry: &Registry) -> Result<String, String> {
        let (name, view) = (self.model.camera.args.name(), self.shown().view(registry));
        Ok(camera::turned(&view, name)?.applied(&view.text).as_str().to_owned())
    }

    /// Returns the text with other values of an attribute, or with another number of a `let`.
    ///
    /// # Errors
    /// Returns why the values cannot be written.
    pub fn tried(&self, registry: &Registry, body: &str) -> Result<String, String> {
        let Try { name, attribute, values } = Try::of(body.as_bytes()).ok_or("these are not numbers")?;
        written(registry, &self.text, &name, &attribute, &values)
    }

    /// Makes the plan of the picture.
    pub fn plan(model: &Model) -> Plan<'_> {
        Plan::for_picture(model)
    }
}

impl Unread {
    fn of(report: &Report, text: &str) -> Self {
        let places = report.faults().iter().filter_map(|fault| fault.place.as_ref());
        let lines = places.filter_map(|place| lines(text, place)).map(|[first, _]| first).collect();
        Self { lines, report: without_files(&report.to_string()), lacking: lacking(report) }
    }
}

/// Returns the files that a scene names but the page does not have.
fn lacking(report: &Report) -> Vec<String> {
    let files = report.files().iter().filter(|file| held::place(file).is_none());
    files.map(|file| file.to_string_lossy().into_owned()).collect()
}

/// Returns a warning for each held file that is used for several files of a scene.
fn shared(report: &Report) -> String {
    let mut named = BTreeMap::<_, BTreeSet<_>>::new();
    for file in report.files() {
        if let Some(place) = held::place(file) {
            named.entry(place).or_default().insert(plain(file).display().to_string());
        }
    }
    let several = named.iter().filter(|(_, files)| files.len() > 1).map(|(place, files)| {
        let files = list(files.iter().map(String::as_str));
        format!(
            "warning: the file `{}` stands for {files}\nhelp: give these files different names\n",
            place.display()
        )
    });
    several.collect()
}

/// Writes values of an attribute into a text.
fn written(
    registry: &Registry,
    text: &str,
    name: &str,
    attribute: &str,
    values: &[String],
) -> Result<String, String> {
    let view = view(registry, text);
    let written = trial_values::write(&view, name, attribute, values);
    let written =
        written.ok_or_else(|| format!("`{name}` has no place of its own in the text: change the text"))?;
    Ok(written.as_str().to_owned())
}
