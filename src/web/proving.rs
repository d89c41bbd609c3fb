//! Proofs of a picture's pixels, some at a time.

use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_tools::verify::{self, Verdict};

/// The progress of the proof of a picture.
#[derive(Default)]
pub struct Proving {
    next: usize,
}

impl Proving {
    /// Proves the next pixels, in rows from the top. Returns a byte for each: 1 where the tracer's hit is proven, 2
    /// where several objects tie, 3 where a shape has no equation, and 4 where the tracer is wrong. The result is
    /// empty when all pixels are done.
    pub fn next(&mut self, model: &Model, count: usize) -> Vec<u8> {
        let plan = Plan::new(model);
        let [width, height] = plan.camera.pixels;
        let end = self.next.saturating_add(count).min(width * height);
        let verdict = |at: usize| match verify::pixel(&plan, at % width, height - 1 - at / width).verdict {
            Verdict::Proven => 1,
            Verdict::Tie => 2,
            Verdict::Uncertified => 3,
            Verdict::Contradicted => 4,
        };
        let verdicts = (self.next..end).map(verdict).collect();
        self.next = end;
        verdicts
    }
}
