//! A tree of boxes (a bounding volume hierarchy), for scenes of many objects.
//!
//! It is built from the top by the surface area heuristic over a few bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007).

use crate::geometry::aabb::Aabb;
use glam::DVec3;

/// Places at which a set of objects may be parted, along the longest way between their middles.
const BINS: usize = 16;

/// So few objects are not parted any more.
const LEAF: usize = 4;

/// Objects in boxes in boxes.
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
    /// Objects, by their range.
    Leaf(u32, u32),
    /// Two nodes, the one that follows in the list and this one, which lies farther along this axis.
    Parts(u32, u8),
}

impl Bvh {
    /// The tree of some objects, each with its index and its box.
    pub fn new(mut objects: Vec<(u32, Aabb)>) -> Self {
        let mut tree = Self { nodes: Vec::new(), objects: Vec::new() };
        tree.add(&mut objects);
        tree
    }

    /// How many nodes it has.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    fn add(&mut self, objects: &mut [(u32, Aabb)]) {
        let bounds = objects.iter().fold(Aabb::EMPTY, |all, (_, bounds)| all.and(bounds));
        let index = self.nodes.len();
        let start = self.objects.len() as u32;
        self.nodes.push(Node { bounds, content: Content::Leaf(start, start + objects.len() as u32) });
        match part(objects) {
            Some((axis, middle)) => {
                let (near, far) = objects.split_at_mut(middle);
                self.add(near);
                self.nodes[index].content = Content::Parts(self.nodes.len() as u32, axis as u8);
                self.add(far);
            }
            None => self.objects.extend(objects.iter().map(|(object, _)| *object)),
        }
    }

    /// Hands out, with `object`, the objects in the boxes that `enters` lets in, about from near to far along a
    /// direction. `ahead` is room to work in.
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

/// Someone who looks for objects in a [`Tree`].
pub trait Visitor {
    /// Whether what is in a box is of interest.
    fn enters(&mut self, bounds: &Aabb) -> bool;

    /// Looks at the object of this index.
    fn object(&mut self, index: usize);
}

/// Orders objects so that those before the index given lie nearer along an axis; nothing where they are better left
/// together.
fn part(objects: &mut [(u32, Aabb)]) -> Option<(usize, usize)> {
    if objects.len() <= LEAF {
        return None;
    }
    let middles = objects
        .iter()
        .fold(Aabb::EMPTY, |all, (_, bounds)| all.and(&Aabb { low: bounds.middle(), high: bounds.middle() }));
    let size = middles.high - middles.low;
    let axis = size.max_position();
    let bin = |bounds: &Aabb| {
        let part = (bounds.middle()[axis] - middles.low[axis]) / size[axis];
        ((part * BINS as f64) as usize).min(BINS - 1)
    };
    let mut bins = [(0, Aabb::EMPTY); BINS];
    for (_, bounds) in objects.iter() {
        let (count, all) = &mut bins[bin(bounds)];
        (*count, *all) = (*count + 1, all.and(bounds));
    }
    // The area of a box tells how likely a ray comes into it.
    let cost = |bins: &[(usize, Aabb)]| {
        let (count, all) =
            bins.iter().fold((0, Aabb::EMPTY), |(count, all), bin| (count + bin.0, all.and(&bin.1)));
        if count == 0 { f64::INFINITY } else { count as f64 * all.half_area() }
    };
    let (cut, best) = (1..BINS)
        .map(|cut| (cut, cost(&bins[..cut]) + cost(&bins[cut..])))
        .fold((0, f64::INFINITY), |best, other| if other.1 < best.1 { other } else { best });
    if best == f64::INFINITY {
        // Their middles are one point: any parting is as good as another.
        return Some((axis, objects.len() / 2));
    }
    // Stable, so that one scene makes one tree.
    objects.sort_by_key(|(_, bounds)| bin(bounds) >= cut);
    Some((axis, objects.partition_point(|(_, bounds)| bin(bounds) < cut)))
}
