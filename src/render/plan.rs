//! What a scene needs, decided once before any ray is traced: everything else is left out.

pub(crate) mod depth;

use depth::{Depth, Onward};

use crate::geometry::aabb::Aabb;
use crate::render::bvh::Bvh;
use crate::render::culling;
use crate::scene::model::Model;
use crate::world::camera::Camera;

/// From so many objects with bounds on, a tree finds them faster than a list.
pub(crate) const TREE: usize = 24;

/// A model with the decisions that depend on its objects and lights: what rays are traced through.
pub struct Plan<'m> {
    /// The scene.
    pub model: &'m Model,
    /// How it is looked at, at first by the model's own camera. Size, samples and sampler are free to be others; the rest
    /// is what the plan was made for.
    pub camera: Camera,
    /// The objects without bounds, by their indices: each is looked at for each ray.
    pub(crate) unbounded: Vec<usize>,
    /// Those with bounds, which a packet of rays looks at one by one, and the boxes around them.
    pub(crate) bounded: Vec<(usize, Aabb)>,
    /// Those with bounds, where they are many.
    pub(crate) tree: Option<Bvh>,
    /// Whether any object lets light through, so that shadows have more than two shades.
    pub(crate) has_glass: bool,
    /// How deep rays are followed; nothing where none goes on.
    pub(crate) depth: Option<Depth>,
}

impl<'m> Plan<'m> {
    /// The plan for a model.
    pub fn new(model: &'m Model) -> Self {
        let objects = &model.objects;
        let (mut unbounded, mut bounded) = (Vec::new(), Vec::new());
        for (index, object) in objects.iter().enumerate() {
            match culling::bounds(object) {
                Some(bounds) => bounded.push((index, bounds)),
                None => unbounded.push(index),
            }
        }
        let tree = (bounded.len() >= TREE).then(|| {
            let boxes = bounded.drain(..);
            Bvh::new(boxes.map(|(index, bounds)| (index as u32, bounds.with_slack(0.0))).collect())
        });
        let has_glass = objects.iter().any(|object| object.material.transparency != 0.0);
        let (camera, depth) = (model.camera.value.clone(), Depth::new(model));
        Self { model, camera, unbounded, bounded, tree, has_glass, depth }
    }

    /// How rays go on from an object, by its index.
    pub(crate) fn onward(&self, index: usize) -> Onward {
        match &self.depth {
            Some(depth) => depth.objects[index],
            // Where no ray goes on, nobody asks.
            None => Onward::NONE,
        }
    }
}
