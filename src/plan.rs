//! What a scene needs, decided once before any ray is traced: everything else is left out.

mod text;

pub use text::Decision;

use crate::bounds::Bounds;
use crate::model::{Model, Object};
use crate::tree::Tree;

/// From so many objects with bounds on, a tree finds them faster than a list.
const TREE: usize = 24;

/// The decisions that depend on a scene's objects.
pub struct Plan {
    /// The objects without bounds, by their indices: each is looked at for each ray.
    pub(crate) unbounded: Vec<usize>,
    /// Those with bounds, which a packet of rays looks at one by one, and the boxes around them.
    pub(crate) bounded: Vec<(usize, Bounds)>,
    /// Those with bounds, where they are many.
    pub(crate) tree: Option<Tree>,
    /// Whether any object lets light through, so that shadows have more than two shades.
    pub(crate) has_glass: bool,
}

impl Plan {
    /// The plan for a scene with these objects.
    pub fn new(objects: &[Object]) -> Self {
        let (mut unbounded, mut bounded) = (Vec::new(), Vec::new());
        for (index, object) in objects.iter().enumerate() {
            match object.shape.bounds() {
                Some(bounds) => bounded.push((index, bounds)),
                None => unbounded.push(index),
            }
        }
        let tree = (bounded.len() >= TREE).then(|| {
            let boxes = bounded.drain(..);
            Tree::new(boxes.map(|(index, bounds)| (index as u32, bounds.with_slack(0.0))).collect())
        });
        let has_glass = objects.iter().any(|object| object.material.transparency != 0.0);
        Self { unbounded, bounded, tree, has_glass }
    }

    /// All decisions about a model, each with its reason.
    pub fn decisions(model: &Model) -> Vec<Decision> {
        text::decisions(model)
    }
}
