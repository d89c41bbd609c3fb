//! What a scene needs, decided once before any ray is traced: everything else is left out.

pub(crate) mod depth;
mod text;

use depth::{Depth, Onward};
pub use text::Decision;

use crate::geometry::bounds::Bounds;
use crate::render::tree::Tree;
use crate::scene::model::{Model, Object};

/// From so many objects with bounds on, a tree finds them faster than a list.
const TREE: usize = 24;

/// The box around an object, where that is heeded: the notes' program tests every ray against each of its shapes.
pub(crate) fn bounds(object: &Object) -> Option<Bounds> {
    object.shape.bounds().filter(|_| !object.shape.packets().is_of_the_notes())
}

/// Whether an object is not in a region, where that is heeded.
pub(crate) fn is_clear_of(object: &Object, region: &Bounds) -> bool {
    object.shape.is_clear_of(region) && !object.shape.packets().is_of_the_notes()
}

/// The decisions that depend on a scene's objects and lights.
pub struct Plan {
    /// The objects without bounds, or whose bounds are ignored, by their indices: each is looked at for each ray.
    pub(crate) unbounded: Vec<usize>,
    /// Those with bounds, which a packet of rays looks at one by one, and the boxes around them.
    pub(crate) bounded: Vec<(usize, Bounds)>,
    /// Those with bounds, where they are many.
    pub(crate) tree: Option<Tree>,
    /// Whether any object lets light through, so that shadows have more than two shades.
    pub(crate) has_glass: bool,
    /// How deep rays are followed; nothing where none goes on.
    pub(crate) depth: Option<Depth>,
}

impl Plan {
    /// The plan for a scene.
    pub fn new(model: &Model) -> Self {
        let objects = &model.objects;
        let (mut unbounded, mut bounded) = (Vec::new(), Vec::new());
        for (index, object) in objects.iter().enumerate() {
            match bounds(object) {
                Some(bounds) => bounded.push((index, bounds)),
                None => unbounded.push(index),
            }
        }
        let tree = (bounded.len() >= TREE).then(|| {
            let boxes = bounded.drain(..);
            Tree::new(boxes.map(|(index, bounds)| (index as u32, bounds.with_slack(0.0))).collect())
        });
        let has_glass = objects.iter().any(|object| object.material.transparency != 0.0);
        Self { unbounded, bounded, tree, has_glass, depth: Depth::new(model) }
    }

    /// How rays go on from an object, by its index.
    pub(crate) fn onward(&self, index: usize) -> Onward {
        match &self.depth {
            Some(depth) => depth.objects[index],
            // Where no ray goes on, nobody asks.
            None => Onward::NONE,
        }
    }

    /// All decisions about a model, each with its reason.
    pub fn decisions(model: &Model) -> Vec<Decision> {
        text::decisions(model)
    }
}
