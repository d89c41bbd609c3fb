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
    /// A box around each object that has bounds, by its index.
    pub(crate) bounds: Vec<Option<Bounds>>,
    /// The objects that a packet of rays looks at one by one.
    pub(crate) listed: Vec<usize>,
    /// Whether any of those has bounds.
    pub(crate) has_bounds: bool,
    /// The others, where they are many.
    pub(crate) tree: Option<Tree>,
    /// Whether any object lets light through, so that shadows have more than two shades.
    pub(crate) has_glass: bool,
}

impl Plan {
    /// The plan for a scene with these objects.
    pub fn new(objects: &[Object]) -> Self {
        let bounds: Vec<_> = objects.iter().map(|object| object.shape.bounds()).collect();
        let bounded = |index: &usize| bounds[*index].is_some();
        let has_tree = (0..objects.len()).filter(bounded).count() >= TREE;
        let listed: Vec<_> = (0..objects.len()).filter(|index| !(has_tree && bounded(index))).collect();
        let has_bounds = listed.iter().any(bounded);
        let tree = has_tree.then(|| {
            let boxes = bounds.iter().enumerate();
            let boxes = boxes.filter_map(|(index, bounds)| Some((index as u32, (*bounds)?.with_slack(0.0))));
            Tree::new(boxes.collect())
        });
        let has_glass = objects.iter().any(|object| object.material.transparency != 0.0);
        Self { bounds, listed, has_bounds, tree, has_glass }
    }

    /// All decisions about a model, each with its reason.
    pub fn decisions(model: &Model) -> Vec<Decision> {
        text::decisions(model)
    }
}
