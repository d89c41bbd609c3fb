//! A scene and its picture, and a page's requests about them.

use crate::painting::Painting;
use crate::proving::Proving;
use crate::scene::Scene;
use crate::{editing, files, formula, surfaces};
use serde::Serialize;
use serde_json::{Value, json};
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use tabray_core::files::held;
use tabray_core::output::aov::Aov;
use tabray_core::render::decisions;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::text;
use tabray_core::text::Named;
use tabray_lang::registry::Registry;
use tabray_page::{camera, entities, fields};
use tabray_tools::probe;

/// The answer to a request, with a status as in HTTP.
pub struct Answer {
    /// 200; 404 for something unknown, 409 for something impossible, 410 for a replaced scene, and 422 for a scene
    /// with errors.
    pub status: u16,
    /// The text, JSON or bytes that were requested.
    pub bytes: Vec<u8>,
}

impl Answer {
    fn new(status: u16, bytes: impl Into<Vec<u8>>) -> Self {
        Self { status, bytes: bytes.into() }
    }

    fn json(value: &impl Serialize) -> Self {
        Self::new(200, text::json(value))
    }

    /// Returns the bytes, or the reason why there are none.
    fn of(result: Result<Vec<u8>, String>) -> Self {
        result.map_or_else(|reason| Self::new(409, reason), |bytes| Self::new(200, bytes))
    }

    /// Returns a changed text, or the reason why it was not changed.
    fn changed(result: Result<String, String>) -> Self {
        Self::of(result.map(|text| text::json(&json!({ "text": text })).into_bytes()))
    }

    fn missing() -> Self {
        Self::new(404, "there is nothing of that kind to ask")
    }
}

/// One scene, until the next one replaces it.
pub struct Session {
    registry: &'static Registry,
    scene: Option<Scene>,
    painting: Painting,
    proving: Proving,
}

impl Default for Session {
    fn default() -> Self {
        Self::new()
    }
}

impl Session {
    /// Begins a session without a scene.
    ///
    /// # Panics
    /// If entity types contradict each other, which the program's tests exclude.
    pub fn new() -> Self {
        tabray_plugins::link();
        tabray_import::link();
        let registry = Registry::get().expect("entity types that do not contradict each other");
        Self { registry, scene: None, painting: Painting::default(), proving: Proving::default() }
    }

    /// Answers a request with a path, whose parts are separated by `/`, and a body.
    pub fn answer(&mut self, path: &str, body: &[u8]) -> Answer {
        let text = str::from_utf8(body).unwrap_or_default();
        let parts: Vec<&str> = path.split('/').collect();
        match parts[..] {
            ["scene", version] => self.read(version, text),
            ["file", name] => {
                held::hold(Path::new(&*files::decoded(name)), body.to_owned());
                Answer::new(200, "")
            }
            ["surfaces"] => Answer::json(&surfaces::all()),
            ["surface", name] => {
                surfaces::scene(name).map_or_else(Answer::missing, |text| Answer::new(200, text))
            }
            ["formula"] => Answer::json(&formula::of(self.registry, text)),
            ["formula", "change"] => Answer::changed(formula::changed(self.registry, text)),
            ["diagnose"] => Answer::json(&editing::diagnose(self.registry, text)),
            ["complete", at] => at.parse().map_or_else(
                |_| Answer::missing(),
                |at| Answer::json(&editing::completions(self.registry, text, at)),
            ),
            ["hover", at] => at.parse().map_or_else(
                |_| Answer::missing(),
                |at| Answer::json(&editing::hover(self.registry, text, at)),
            ),
            ["signature", at] => at.parse().map_or_else(
                |_| Answer::missing(),
                |at| Answer::json(&editing::signature(self.registry, text, at)),
            ),
            ["format"] => Answer::changed(editing::formatted(self.registry, text)),
            [what, version, ref rest @ ..] => self.about(what, version, rest, text),
            _ => Answer::missing(),
        }
    }

    /// Reads a scene, which replaces the one before. If it has errors, the one before stays.
    fn read(&mut self, version: &str, text: &str) -> Answer {
        match Scene::read(self.registry, version, text) {
            Ok(scene) => {
                self.painting = Painting::new(&scene.model);
                self.proving = Proving::default();
                let description = scene.description();
                self.scene = Some(scene);
                Answer::json(&description)
            }
            Err(unread) => Answer::new(422, text::json(&unread)),
        }
    }

    /// Answers a request about the scene with a version.
    fn about(&mut self, what: &str, version: &str, rest: &[&str], body: &str) -> Answer {
        let Some(scene) = self.scene.as_ref().filter(|scene| scene.version == version) else {
            return Answer::new(410, "this picture has been replaced");
        };
        let (model, registry) = (&scene.model, self.registry);
        let place = |x: &str, y: &str| {
            let [width, height] = model.camera.value.pixels;
            Some([x.parse().ok().filter(|x| *x < width)?, y.parse().ok().filter(|y| *y < height)?])
        };
        let at_pixel = |answer: &dyn Fn([usize; 2]) -> Answer| match rest {
            [x, y] => place(x, y).map_or_else(Answer::missing, answer),
            _ => Answer::missing(),
        };
        match (what, rest) {
            ("paint", [count]) => count.parse().map_or_else(
                |_| Answer::missing(),
                |count| Answer::new(200, self.painting.next(model, count)),
            ),
            ("painted", []) => Answer::json(&self.painting.remark(model)),
            ("prove", [count]) => count.parse().map_or_else(
                |_| Answer::missing(),
                |count| Answer::new(200, self.proving.next(model, count)),
            ),
            ("bytes", []) => Answer::of(self.painting.whole().map(|whole| whole.bytes.to_vec())),
            ("png", []) => Answer::of(files::png(&self.painting)),
            ("exr", []) => Answer::of(files::exr(&self.painting)),
            ("stl", [name]) => Answer::of(files::stl(model, &files::decoded(name))),
            ("objects", []) => Answer::json(&files::names(model)),
            ("plan", []) => {
                let plan = Plan::for_picture(model);
                let words: String =
                    decisions::of(&plan).iter().map(|decision| format!("{decision}\n")).collect();
                Answer::new(200, text::visible_lines(&words).into_owned())
            }
            ("probe", _) => at_pixel(&|at| probed(scene, at)),
            ("object", _) => at_pixel(&|at| Answer::json(&fields::of_pixel(registry, scene.shown(), at))),
            ("point", _) => at_pixel(&|at| Answer::json(&camera::point(model, at))),
            ("layer", [name]) => layer(&Plan::new(model), name),
            ("entities", []) => Answer::json(&entities::all(registry, scene.shown())),
            ("entity", [order]) => Answer::json(&entities::fields(registry, scene.shown(), order)),
            ("camera", []) => match camera::state(registry, scene.shown()) {
                Ok(state) => Answer::json(&state),
                Err(reason) => Answer::new(409, reason),
            },
            ("move", []) => Answer::changed(scene.moved(registry, body)),
            ("turn", []) => Answer::changed(scene.turned(registry)),
            ("try", []) => Answer::changed(scene.tried(registry, body)),
            _ => Answer::missing(),
        }
    }
}

/// The maximum length of a pixel's explanation, in bytes.
const MAX_EXPLANATION: usize = 1 << 20;

/// The first bytes of an explanation.
struct Beginning(Vec<u8>);

impl io::Write for Beginning {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0.len() + bytes.len() > MAX_EXPLANATION {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Explains a pixel, and finds the lines of the object that it shows.
fn probed(scene: &Scene, [x, y]: [usize; 2]) -> Answer {
    let mut told = Beginning(Vec::new());
    if probe::pixel(&Plan::new(&scene.model), x, y, &mut told).is_err() {
        told.0.extend(b"\n...\n\nthis is too long for a page; `tabray probe` prints all of it\n");
    }
    let told = String::from_utf8_lossy(&told.0);
    let lines = scene.shown().lines_of([x, y], &scene.places);
    let explained: Value = json!({ "text": text::visible_lines(&told), "lines": lines });
    Answer::json(&explained)
}

/// Renders an auxiliary image: red, green and blue of each pixel.
fn layer(plan: &Plan, name: &str) -> Answer {
    // The error needs a reference image, which is not available here.
    let Some(aov) = Aov::of_name(name).filter(|aov| *aov != Aov::Error) else { return Answer::missing() };
    let made = aov.render(&Renderer::default(), plan, plan, &|| ControlFlow::Continue(()));
    made.map_or_else(|error| Answer::new(409, error.to_string()), |layer| Answer::new(200, layer.bytes))
}
