//! Compares a picture with the image of its scene, and finds the kinds of differences. The scene is rendered with
//! usual mistakes, and a mistake is named where the picture has its colours.

mod compared;
mod mistake;
mod trials;
mod views;

use compared::{Compared, apart};
use image::RgbImage;
pub use mistake::Mistake;
use rayon::prelude::*;
use std::collections::BTreeMap;
use tabray_core::render::Renderer;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
pub use views::View;

/// The pixels that differ in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The kind of difference.
    pub mistake: Mistake,
    /// Their number.
    pub pixels: usize,
    /// The first of them, in rows from the top: its column from the left and its row from the bottom.
    pub first: [usize; 2],
}

/// The result of comparing a picture with its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// The number of all pixels.
    pub pixels: usize,
    /// The differences by kind, that of the most pixels first.
    pub findings: Vec<Finding>,
}

impl Grade {
    /// Compares a picture with the image of a scene, whose size it has. Differences of up to `tolerance` levels are
    /// none. `make` makes the scene's model again, each time to be changed.
    ///
    /// # Errors
    /// Returns the errors of `make`.
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
        Ok(Self { pixels: compared.places().count(), findings: gathered(found, compared.size) })
    }

    /// Returns the number of pixels that differ.
    pub fn differing(&self) -> usize {
        self.findings.iter().map(|finding| finding.pixels).sum()
    }
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
    // Findings with as many pixels are in the order of their mistakes.
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.pixels));
    findings
}
