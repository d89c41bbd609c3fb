//! Compares a picture with what its scene shows, and finds out in what way it differs: the scene is rendered in other ways, each
//! a usual mistake, and a mistake is named where the picture has its colours.

mod trials;
mod views;

use glam::DVec3;
use image::RgbImage;
use rayon::prelude::*;
use std::collections::BTreeMap;
use tabray_core::render::Renderer;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_core::world::display::Display;
pub use views::View;

/// In what way pixels of a picture differ.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mistake {
    /// All of the picture is seen in another way.
    View(View),
    /// Another object is seen: this one, where that one is right; `None` for nothing.
    Object {
        /// The index of the object that the picture shows.
        shown: Option<usize>,
        /// The index of the object that the scene shows.
        right: Option<usize>,
    },
    /// These lights shine on an object, though others are in their way.
    ShadowMissing {
        /// The indices of the lights.
        lights: Vec<usize>,
        /// The index of the object.
        on: usize,
    },
    /// These lights do not shine on an object, though nothing is in their way.
    ShadowTooMuch {
        /// The indices of the lights.
        lights: Vec<usize>,
        /// The index of the object.
        on: usize,
    },
    /// The glint on an object is missing.
    GlintMissing {
        /// The index of the object.
        on: usize,
    },
    /// The glint on an object is stronger or weaker, or where there should be none.
    GlintOther {
        /// The index of the object.
        on: usize,
    },
    /// No channel differs by more than a level.
    OffByOne,
    /// No trial has this colour.
    Other,
}

/// The pixels that differ in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// How they differ.
    pub mistake: Mistake,
    /// Their number.
    pub pixels: usize,
    /// The first of them, in rows from the top: its column from the left and its row from the bottom.
    pub first: [usize; 2],
}

/// What a picture has to do with its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// The number of all pixels.
    pub pixels: usize,
    /// In what ways pixels differ, that of the most pixels first.
    pub findings: Vec<Finding>,
}

/// A picture, beside the image that is right.
pub(crate) struct Compared<'c> {
    pub plan: &'c Plan<'c>,
    pub display: Display,
    pub size: [usize; 2],
    pub theirs: &'c RgbImage,
    /// The right bytes and the index of the object that is seen, in rows from the top.
    right: Vec<([u8; 3], Option<usize>)>,
}

impl Grade {
    /// Compares a picture with the image of a scene, whose size it has. Differences of up to `tolerance` levels are none.
    /// `make` makes the scene's model again, each time to be changed.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn new<E>(
        renderer: &Renderer,
        model: &Model,
        make: &mut dyn FnMut() -> Result<Model, E>,
        theirs: &RgbImage,
        tolerance: u8,
    ) -> Result<Self, E> {
        let plan = Plan::new(model);
        let compared = Compared::new(renderer, &plan, theirs);
        let different: Vec<_> = compared
            .places()
            .filter(|at| apart(compared.theirs(*at), compared.right(*at)) > tolerance)
            .collect();
        let plain = |at: &[usize; 2]| apart(compared.theirs(*at), compared.right(*at)) <= 1;
        let (mut plain, mut open): (Vec<_>, Vec<_>) = different.into_iter().partition(plain);
        let view = View::best(renderer, &compared, &open);
        let mut found: Vec<([usize; 2], Mistake)> = Vec::new();
        if view != View::default() {
            for pixels in [&mut plain, &mut open] {
                let is_seen = |at: &[usize; 2]| {
                    let bytes = view.bytes(&compared, *at);
                    bytes.is_some_and(|bytes| apart(bytes, compared.theirs(*at)) <= 1)
                };
                let seen: Vec<bool> = renderer.run(|| pixels.par_iter().map(is_seen).collect());
                let mut seen = seen.into_iter();
                let of_view = pixels.extract_if(.., |_| seen.next().unwrap_or(false));
                found.extend(of_view.map(|at| (at, Mistake::View(view))));
            }
        }
        found.extend(plain.into_iter().map(|at| (at, Mistake::OffByOne)));
        found.extend(trials::explain(renderer, &compared, make, view, open)?);
        Ok(Self { pixels: compared.right.len(), findings: gathered(found, compared.size) })
    }

    /// Returns the number of pixels that differ.
    pub fn differing(&self) -> usize {
        self.findings.iter().map(|finding| finding.pixels).sum()
    }
}

impl Mistake {
    /// Returns a name of the kind of mistake.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::View(view) => view.kind(),
            Self::Object { .. } => "wrong object",
            Self::ShadowMissing { .. } => "shadow missing",
            Self::ShadowTooMuch { .. } => "too much shadow",
            Self::GlintMissing { .. } | Self::GlintOther { .. } => "glint",
            Self::OffByOne => "off by one",
            Self::Other => "other",
        }
    }

    /// Describes the mistake, in words that complete "the picture".
    pub fn words(&self, model: &Model) -> String {
        let object = |index: &usize| format!("`{}`", model.objects[*index].args.name());
        let seen = |index: &Option<usize>| index.as_ref().map_or("nothing".to_owned(), object);
        let lights =
            |lights: &[usize]| text::list(lights.iter().map(|index| model.lights[*index].args.name()));
        match self {
            Self::View(view) => view.words(),
            Self::Object { shown, right } => format!("shows {} where {} is seen", seen(shown), seen(right)),
            Self::ShadowMissing { lights: of, on } => {
                format!("has light of {} on {}, though something is in its way", lights(of), object(on))
            }
            Self::ShadowTooMuch { lights: of, on } => {
                format!("lacks light of {} on {}, though nothing is in its way", lights(of), object(on))
            }
            Self::GlintMissing { on } => format!("lacks the glint on {}", object(on)),
            Self::GlintOther { on } => format!("has another glint on {}", object(on)),
            Self::OffByOne => "differs by a level, as by rounding".to_owned(),
            Self::Other => "has other colours, which no trial explains".to_owned(),
        }
    }
}

impl<'c> Compared<'c> {
    fn new(renderer: &Renderer, plan: &'c Plan<'c>, theirs: &'c RgbImage) -> Self {
        let (display, size) = (plan.camera.display(), plan.camera.pixels);
        let pixel = |index: usize| {
            let [x, y] = place(index, size);
            let sight = plan.camera.sight(x as f64, y as f64);
            (display.bytes(trace::pixel(plan, x, y)), trace::first_hit(plan, &sight).map(|hit| hit.index))
        };
        let right = renderer.run(|| (0..size[0] * size[1]).into_par_iter().map(pixel).collect());
        Self { plan, display, size, theirs, right }
    }

    /// Returns all pixels, in rows from the top: columns from the left and rows from the bottom.
    pub fn places(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let size = self.size;
        (0..size[0] * size[1]).map(move |index| place(index, size))
    }

    pub fn theirs(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        self.theirs.get_pixel(x as u32, (self.size[1] - 1 - y) as u32).0
    }

    pub fn right(&self, at: [usize; 2]) -> [u8; 3] {
        self.right[self.index(at)].0
    }

    pub fn object(&self, at: [usize; 2]) -> Option<usize> {
        self.right[self.index(at)].1
    }

    fn index(&self, [x, y]: [usize; 2]) -> usize {
        (self.size[1] - 1 - y) * self.size[0] + x
    }
}

fn place(index: usize, [width, height]: [usize; 2]) -> [usize; 2] {
    [index % width, height - 1 - index / width]
}

/// Returns the largest difference of a channel, in levels.
pub(crate) fn apart(one: [u8; 3], other: [u8; 3]) -> u8 {
    let [r, g, b] = [0, 1, 2].map(|channel| one[channel].abs_diff(other[channel]));
    r.max(g).max(b)
}

/// Returns the bytes of colours from 0 to 1.
pub(crate) fn levels(shown: DVec3) -> [u8; 3] {
    shown.to_array().map(|channel| (255.0 * channel).round() as u8)
}

/// Counts the pixels of each mistake.
fn gathered(found: Vec<([usize; 2], Mistake)>, [width, height]: [usize; 2]) -> Vec<Finding> {
    let order = |[x, y]: [usize; 2]| (height - 1 - y) * width + x;
    let mut kinds: BTreeMap<Mistake, Finding> = BTreeMap::new();
    for (at, mistake) in found {
        let of = kinds.entry(mistake).or_insert_with_key(|mistake| Finding {
            mistake: mistake.clone(),
            pixels: 0,
            first: at,
        });
        of.pixels += 1;
        if order(at) < order(of.first) {
            of.first = at;
        }
    }
    let mut findings: Vec<_> = kinds.into_values().collect();
    // Of as many pixels, the order is that of the kinds.
    findings.sort_by(|one, other| other.pixels.cmp(&one.pixels));
    findings
}
