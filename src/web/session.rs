//! A scene and its picture, and a page's requests about them.

use crate::painting::Painting;
use crate::proving::Proving;
use crate::scene::Scene;
use crate::{editing, files, formula, surfaces};
use serde::Serialize;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::Path;
use tabray_core::files::held;
use tabray_core::render::decisions;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_page::camera;
use tabray_page::queries::{Asked, Query};

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

    /// Returns what a word of a path asks for, if it is a number.
    fn at(word: &str, answer: impl FnOnce(usize) -> Self) -> Self {
        word.parse().map_or_else(|_| Self::missing(), answer)
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
        let registry = self.registry;
        let text = str::from_utf8(body).unwrap_or_default();
        let parts: Vec<&str> = path.split('/').collect();
        match parts[..] {
            ["scene", version] => self.read(version, text, None),
            ["smooth", version, width, height, part, all] => {
                match [width, height, part, all].map(str::parse) {
                    [Ok(width), Ok(height), Ok(part), Ok(all)] => {
                        self.read(version, text, Some(([width, height], [part, all])))
                    }
                    _ => Answer::missing(),
                }
            }
            ["file", name] => {
                held::hold(Path::new(&*files::decoded(name)), body.to_owned());
                Answer::new(200, "")
            }
            ["surfaces"] => Answer::json(&surfaces::all()),
            ["surface", name] => match surfaces::scene(&files::decoded(name)) {
                Ok(text) => Answer::new(200, text),
                Err(unknown) => Answer::new(404, unknown),
            },
            ["formula"] => Answer::json(&formula::of(registry, text)),
            ["formula", "change"] => Answer::changed(formula::changed(registry, text)),
            ["diagnose"] => Answer::json(&editing::diagnose(registry, text)),
            ["complete", at] => Answer::at(at, |at| Answer::json(&editing::completions(registry, text, at))),
            ["hover", at] => Answer::at(at, |at| Answer::json(&editing::hover(registry, text, at))),
            ["signature", at] => Answer::at(at, |at| Answer::json(&editing::signature(registry, text, at))),
            ["format"] => Answer::changed(editing::formatted(registry, text)),
            [what, version, ref rest @ ..] => self.about(what, version, rest, text),
            _ => Answer::missing(),
        }
    }

    /// Reads a scene, which replaces the one before. If it has errors, the one before stays. Its picture may have
    /// another size and smooth edges, of which a part is painted.
    fn read(&mut self, version: &str, text: &str, smooth: Option<([usize; 2], [usize; 2])>) -> Answer {
        match Scene::read(self.registry, version, text, smooth.map(|(size, _)| size)) {
            Ok(scene) => {
                self.painting = match smooth {
                    Some((_, part)) => Painting::smooth(&scene.model, part),
                    None => Painting::new(&scene.model),
                };
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
        match (what, rest) {
            ("paint", [n]) => Answer::at(n, |n| Answer::new(200, self.painting.next(model, n))),
            ("painted", []) => Answer::json(&self.painting.remark(model)),
            ("prove", [n]) => Answer::at(n, |n| Answer::new(200, self.proving.next(model, n))),
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
            ("camera", []) => match camera::state(registry, scene.shown()) {
                Ok(state) => Answer::json(&state),
                Err(reason) => Answer::new(409, reason),
            },
            ("move", []) => Answer::changed(scene.moved(registry, body)),
            ("turn", []) => Answer::changed(scene.turned(registry)),
            ("try", []) => Answer::changed(scene.tried(registry, body)),
            _ => {
                let asked = Asked {
                    registry,
                    shown: scene.shown(),
                    places: &scene.places,
                    renderer: |_| Ok(Renderer::default()),
                    max_explanation: MAX_EXPLANATION,
                    check: &|| ControlFlow::Continue(()),
                };
                Query::of(what, rest, model).map_or_else(Answer::missing, |query| {
                    Answer::of(
                        query.answer(&asked).map(|answer| answer.bytes).map_err(|error| error.to_string()),
                    )
                })
            }
        }
    }
}

/// The maximum length of a pixel's explanation, in bytes.
const MAX_EXPLANATION: usize = 1 << 20;
