//! What is proven of a picture's pixels, some of them at a time.

use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_tools::verify::{self, Verdict};

/// How many pixels are proven.
#[derive(Default)]
pub struct Proving {
    next: usize,
}

impl Proving {
    /// Proves the next pixels, in rows from the top: a byte for each, 1 where what the tracer finds is proven, 2 where several
    /// objects tie, 3 where a shape has no equation, and 4 where the tracer is wrong. Nothing says that there are no more.
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
