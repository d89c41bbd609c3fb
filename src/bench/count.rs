//! What a frame does: its rays by kind and its tests by object.

use crate::cpu::Cpu;
use crate::model::Model;
use crate::render::TILE;
use crate::trace::Tracer;
use crate::watch::{Count, Kind, Watch};

/// The rays of a frame by kind, and the tests of each object.
#[derive(Clone, Debug, Default)]
pub(super) struct Counts {
    pub primary: usize,
    pub shadow: usize,
    /// Mirrored and through glass.
    pub onward: usize,
    /// By the object's index.
    pub tests: Vec<usize>,
}

impl Watch for Counts {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        match count {
            Count::Rays(Kind::Primary, rays) => self.primary += rays,
            Count::Rays(Kind::Shadow, rays) => self.shadow += rays,
            Count::Rays(Kind::Reflected | Kind::Transmitted, rays) => self.onward += rays,
            Count::Tested(object, rays) => self.tests[object] += rays,
            Count::Culled(..) => (),
        }
    }
}

impl Counts {
    /// Those of a model's frame.
    pub fn of(model: &Model, cpu: Cpu) -> Self {
        let mut counts = Self { tests: vec![0; model.objects.len()], ..Self::default() };
        let mut tracer = Tracer::new(model, cpu, &mut counts);
        for tile in tiles(model) {
            tracer.pixels(&tile, |_, _| ());
        }
        counts
    }

    /// All rays.
    pub fn rays(&self) -> usize {
        self.primary + self.shadow + self.onward
    }
}

/// The pixels of a frame, tile by tile as the renderer takes them: from the left and from the bottom.
pub(super) fn tiles(model: &Model) -> impl Iterator<Item = Vec<[usize; 2]>> {
    let [width, height] = model.camera.value.pixels;
    (0..height).step_by(TILE).flat_map(move |top| {
        (0..width).step_by(TILE).map(move |left| {
            let rows = top..height.min(top + TILE);
            let row = move |y| (left..width.min(left + TILE)).map(move |x| [x, height - 1 - y]);
            rows.flat_map(row).collect()
        })
    })
}

/// The objects that the rays from the viewer and the first rays to lights are tested against.
#[derive(Default)]
pub(super) struct Tested {
    pub primary: Vec<usize>,
    pub shadow: Vec<usize>,
    kind: Option<Kind>,
}

impl Watch for Tested {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        match (count, self.kind) {
            (Count::Rays(kind, _), _) => self.kind = Some(kind),
            (Count::Tested(object, _), Some(Kind::Primary)) => self.primary.push(object),
            (Count::Tested(object, _), Some(Kind::Shadow)) => self.shadow.push(object),
            _ => (),
        }
    }
}

impl Tested {
    /// Those of a tile, each once.
    pub fn of(model: &Model, cpu: Cpu, tile: &[[usize; 2]]) -> Self {
        let mut tested = Self::default();
        Tracer::new(model, cpu, &mut tested).pixels(tile, |_, _| ());
        for objects in [&mut tested.primary, &mut tested.shadow] {
            objects.sort_unstable();
            objects.dedup();
        }
        tested
    }
}
