//! Queries about a scene and its image that `watch` and a page without a server answer alike.

use crate::{Shown, camera, entities, fields};
use serde::Serialize;
use std::io::{self, Write};
use std::ops::ControlFlow;
use tabray_core::output::aov::Aov;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::text::{self, Named};
use tabray_lang::reader::Places;
use tabray_lang::registry::Registry;
use tabray_tools::probe;

/// A query of a page.
pub enum Query {
    /// What `tabray probe` says about a pixel, and the lines of the object that it shows.
    Probe([usize; 2]),
    /// The attributes of the object that a pixel shows.
    Object([usize; 2]),
    /// The point that a pixel shows.
    Point([usize; 2]),
    /// The scene's own numbers and its entities.
    Entities,
    /// The attributes of an entity by its index, or the scene's own numbers.
    Entity(String),
    /// An image beside the main one: red, green and blue of each pixel.
    Layer(Aov),
}

/// A scene that a page asks about, and the means to answer.
pub struct Asked<'a> {
    /// The entity types.
    pub registry: &'a Registry,
    /// The scene.
    pub shown: Shown<'a>,
    /// The place of each entity in the text.
    pub places: &'a Places,
    /// Returns a renderer with this many threads, 0 for one on each core.
    pub renderer: fn(usize) -> io::Result<Renderer>,
    /// The maximum length of a pixel's explanation, in bytes.
    pub max_explanation: usize,
    /// Breaks if nobody wants the answer any more.
    pub check: &'a (dyn Fn() -> ControlFlow<()> + Sync),
}

/// An answer.
pub struct Answer {
    /// The media type.
    pub kind: &'static str,
    /// The content.
    pub bytes: Vec<u8>,
}

impl Answer {
    fn json(value: &impl Serialize) -> Self {
        Self { kind: "application/json", bytes: text::json(value).into_bytes() }
    }
}

impl Query {
    /// Reads a query: its name, and the other parts of the request's path. `None` where the image has no such part.
    pub fn of(name: &str, parts: &[&str], model: &Model) -> Option<Self> {
        let pixel = || {
            let [width, height] = model.camera.value.pixels;
            let [x, y] = parts else { return None };
            Some([x.parse().ok().filter(|x| *x < width)?, y.parse().ok().filter(|y| *y < height)?])
        };
        Some(match (name, parts) {
            ("probe", _) => Self::Probe(pixel()?),
            ("object", _) => Self::Object(pixel()?),
            ("point", _) => Self::Point(pixel()?),
            ("entities", []) => Self::Entities,
            ("entity", [order]) => Self::Entity((*order).to_owned()),
            // The error needs a reference image, which is not available here.
            ("layer", [name]) => Self::Layer(Aov::of_name(name).filter(|aov| *aov != Aov::Error)?),
            _ => return None,
        })
    }

    /// Answers the query.
    ///
    /// # Errors
    /// Returns an error if threads cannot be started, or if nobody wants the answer any more.
    pub fn answer(&self, of: &Asked) -> io::Result<Answer> {
        let Asked { registry, shown, .. } = *of;
        Ok(match self {
            Self::Probe(at) => explanation(of, *at)?,
            Self::Object(at) => Answer::json(&fields::of_pixel(registry, shown, *at)),
            Self::Point(at) => Answer::json(&camera::point(shown.model, *at)),
            Self::Entities => Answer::json(&entities::all(registry, shown)),
            Self::Entity(order) => Answer::json(&entities::fields(registry, shown, order)),
            Self::Layer(aov) => {
                let plan = Plan::new(shown.model);
                let bytes = aov.render(&(of.renderer)(0)?, &plan, &plan, of.check)?.bytes;
                Answer { kind: "application/octet-stream", bytes }
            }
        })
    }
}

/// The explanation of a pixel.
#[derive(Serialize)]
struct PixelExplanation<'e> {
    /// The first and the last line of the object that the pixel shows, from 1; null where it shows none.
    lines: Option<[usize; 2]>,
    /// The output of `tabray probe`, or the beginning of it.
    text: &'e str,
}

fn explanation(of: &Asked, [x, y]: [usize; 2]) -> io::Result<Answer> {
    (of.renderer)(1)?.run(|| {
        let mut told = LimitedText { text: Vec::new(), max: of.max_explanation, check: of.check };
        match probe::pixel(&Plan::new(of.shown.model), x, y, &mut told) {
            Err(error) if error.kind() == io::ErrorKind::StorageFull => {
                told.text.extend(b"\n...\n\nthis is too long for a page; `tabray probe` prints all of it\n");
            }
            written => written?,
        }
        let told = String::from_utf8_lossy(&told.text);
        let lines = of.shown.lines_of([x, y], of.places);
        Ok(Answer::json(&PixelExplanation { lines, text: &text::visible_lines(&told) }))
    })
}

/// Collects a pixel's explanation while a page waits for it and it is not too long.
struct LimitedText<'a> {
    text: Vec<u8>,
    max: usize,
    check: &'a (dyn Fn() -> ControlFlow<()> + Sync),
}

impl Write for LimitedText<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.check)().is_break() {
            // An operation that fails with `Interrupted` would be tried again.
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        if self.text.len() + bytes.len() > self.max {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.text.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_explanation_ends_where_it_is_too_long_or_nobody_wants_it() {
        let mut told = LimitedText { text: Vec::new(), max: 1000, check: &|| ControlFlow::Continue(()) };
        told.write_all(&[b'a'; 1000]).expect("it is not too long");
        let full = told.write_all(b"a").expect_err("now it is");
        assert_eq!((full.kind(), told.text.len()), (io::ErrorKind::StorageFull, 1000));
        let mut told = LimitedText { text: Vec::new(), max: 1000, check: &|| ControlFlow::Break(()) };
        assert_eq!(told.write_all(b"a").expect_err("nobody").kind(), io::ErrorKind::BrokenPipe);
    }
}
