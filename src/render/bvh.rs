//! A bounding volume hierarchy (BVH), for scenes of many objects.
//!
//! It is built top down by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based Bounding
//! Volume Hierarchies", 2007).

use crate::geometry::aabb::Aabb;
use glam::DVec3;

/// The number of bins along the longest axis of the objects' centres; a set of objects is split between two bins.
const BINS: usize = 16;

/// The maximum number of objects in a leaf.
const LEAF: usize = 4;

/// A binary tree of bounding boxes.
pub struct Bvh {
    nodes: Vec<Node>,
    /// The objects' indices, leaf by leaf.
    objects: Vec<u32>,
}

struct Node {
    bounds: Aabb,
    content: Content,
}

enum Content {
    /// The start and end of a range of [`Bvh::objects`].
    Leaf(u32, u32),
    /// Two child nodes: the one that follows in the list, and the one of this index, which lies farther along this axis
    /// (0 to 2).
    Parts(u32, u8),
}

impl Bvh {
    /// Builds the tree of objects, each given by its index and its bounding box.
    pub fn new(mut objects: Vec<(u32, Aabb)>) -> Self {
        let mut tree = Self { nodes: Vec::new(), objects: Vec::new() };
        tree.add(&mut objects);
        tree
    }

    /// Returns the number of nodes.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Appends the subtree of some objects.
    fn add(&mut self, objects: &mut [(u32, Aabb)]) {
        let bounds = objects.iter().fold(Aabb::EMPTY, |all, (_, bounds)| all.and(bounds));
        let index = self.nodes.len();
        let start = self.objects.len() as u32;
        self.nodes.push(Node { bounds, content: Content::Leaf(start, start + objects.len() as u32) });
        match partition(objects) {
            Some((axis, middle)) => {
                let (near, far) = objects.split_at_mut(middle);
                self.add(near);
                self.nodes[index].content = Content::Parts(self.nodes.len() as u32, axis as u8);
                self.add(far);
            }
            None => self.objects.extend(objects.iter().map(|(object, _)| *object)),
        }
    }

    /// Visits the objects in the boxes that [`Visitor::enters`] accepts, roughly from near to far along a direction.
    /// `ahead` is scratch space for the traversal stack.
    pub fn visit(&self, dir: DVec3, ahead: &mut Vec<usize>, visitor: &mut impl Visitor) {
        ahead.clear();
        ahead.push(0);
        while let Some(index) = ahead.pop() {
            let node = &self.nodes[index];
            if !visitor.enters(&node.bounds) {
                continue;
            }
            match node.content {
                Content::Leaf(from, to) => {
                    for index in &self.objects[from as usize..to as usize] {
                        visitor.object(*index as usize);
                    }
                }
                Content::Parts(far, axis) if dir[axis.into()] >= 0.0 => {
                    ahead.extend([far as usize, index + 1]);
                }
                Content::Parts(far, _) => ahead.extend([index + 1, far as usize]),
            }
        }
    }
}

/// A search for objects in a [`Bvh`].
pub trait Visitor {
    /// Tells whether the contents of a box are to be visited.
    fn enters(&mut self, bounds: &Aabb) -> bool;

    /// Visits the object of this index.
    fn object(&mut self, index: usize);
}

/// Partitions objects so that those before the returned index lie nearer along the returned axis. Returns `None` where
/// they stay together in one leaf.
fn partition(objects: &mut [(u32, Aabb)]) -> Option<(usize, usize)> {
    if objects.len() <= LEAF {
        return None;
    }
    let middles = objects
        .iter()
        .fold(Aabb::EMPTY, |all, (_, bounds)| all.and(&Aabb { low: bounds.middle(), high: bounds.middle() }));
    let size = middles.high - middles.low;
    let axis = size.max_position();
    let bin = |bounds: &Aabb| {
        let fraction = (bounds.middle()[axis] - middles.low[axis]) / size[axis];
        ((fraction * BINS as f64) as usize).min(BINS - 1)
    };
    let mut bins = [(0, Aabb::EMPTY); BINS];
    for (_, bounds) in objects.iter() {
        let (count, all) = &mut bins[bin(bounds)];
        (*count, *all) = (*count + 1, all.and(bounds));
    }
    // The probability that a ray enters a box is proportional to its surface area.
    let cost = |bins: &[(usize, Aabb)]| {
        let (count, all) =
            bins.iter().fold((0, Aabb::EMPTY), |(count, all), bin| (count + bin.0, all.and(&bin.1)));
        if count == 0 { f64::INFINITY } else { count as f64 * all.half_area() }
    };
    let (cut, best) = (1..BINS)
        .map(|cut| (cut, cost(&bins[..cut]) + cost(&bins[cut..])))
        .fold((0, f64::INFINITY), |best, other| if other.1 < best.1 { other } else { best });
    if best == f64::INFINITY {
        // All centres are one point: any partition is as good as another.
        return Some((axis, objects.len() / 2));
    }
    // The sort is stable, so that the same scene always makes the same tree.
    objects.sort_by_key(|(_, bounds)| bin(bounds) >= cut);
    Some((axis, objects.partition_point(|(_, bounds)| bin(bounds) < cut)))
}
