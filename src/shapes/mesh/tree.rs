//! The search tree of a mesh: a bounding volume hierarchy whose nodes have eight boxes in single precision.
//!
//! It is built top down by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based Bounding
//! Volume Hierarchies", 2007). Boxes are rounded outward, in coordinates of the mesh's own size and position, so that
//! single precision costs little wherever the mesh lies. The tree does not depend on the number of threads.

use crate::geometry::aabb::Aabb;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// The number of boxes of a node.
pub(super) const WIDTH: usize = 8;

/// The maximum number of faces in a leaf.
pub(super) const LEAF: usize = 4;

/// The number of bins along each axis; a set of faces is split between two bins.
const BINS: usize = 16;

/// The depth from which on sets are halved, whatever their boxes: an upper bound for the depth of every tree is this,
/// and 11 levels for 2^32 faces.
const MAX_DEPTH: usize = 20;

/// The number of faces from which on the parts of a node are built on several threads.
const PARALLEL: usize = 1 << 13;

/// The largest number of faces, for which the start of a leaf fits its code.
pub(super) const MAX_FACES: usize = 1 << 28;

/// The bit of a child's code that marks a leaf; the three bits below it are the number of faces less 1, and the others
/// are the index of the first one.
const IS_LEAF: u32 = 1 << 31;

/// A tree over the faces of a mesh.
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    pub space: Space,
}

/// Eight boxes, in the tree's own coordinates, and what is in them.
#[derive(Clone)]
#[repr(align(64))]
pub(super) struct Node {
    /// The smallest x, y and z of each box; infinite where a node has fewer than eight.
    pub low: [[f32; WIDTH]; 3],
    /// The largest x, y and z of each box.
    pub high: [[f32; WIDTH]; 3],
    /// What is in each box.
    pub children: [u32; WIDTH],
}

impl Node {
    const EMPTY: Self = Self {
        low: [[f32::INFINITY; WIDTH]; 3],
        high: [[f32::NEG_INFINITY; WIDTH]; 3],
        children: [0; WIDTH],
    };
}

/// What is in a box.
pub(super) enum Child {
    /// The node of this index.
    Node(usize),
    /// The faces of these indices.
    Leaf(Range<usize>),
}

impl Child {
    /// Reads the code of a child.
    #[inline(always)]
    pub fn of(code: u32) -> Self {
        if code & IS_LEAF == 0 {
            return Self::Node(code as usize);
        }
        let (start, count) = ((code & (MAX_FACES as u32 - 1)) as usize, (code >> 28 & 7) as usize + 1);
        Self::Leaf(start..start + count)
    }
}

/// The tree's own coordinates, in which the mesh lies between -1 and 1 along each axis.
#[derive(Clone, Copy)]
pub(super) struct Space {
    /// The center of the mesh, in world coordinates.
    pub center: DVec3,
    /// The tree's units per world unit, a power of two.
    pub scale: f64,
}

impl Space {
    fn around(bounds: &Aabb) -> Self {
        let (center, half) = (bounds.middle(), bounds.half_size().max_element());
        // Never subnormal, as coordinates are at most 1e152 and different ones differ by at least 5e-324.
        let scale =
            if half > 0.0 { 2.0_f64.powi(-(half.log2().floor() as i32 + 1).clamp(-600, 600)) } else { 1.0 };
        Self { center, scale }
    }

    /// Transforms a point from the world to the tree's own coordinates.
    #[inline(always)]
    pub fn point(&self, at: DVec3) -> DVec3 {
        (at - self.center) * self.scale
    }

    /// Returns a bounding box in the world of one of a node's boxes.
    pub fn bounds(&self, node: &Node, index: usize) -> Aabb {
        let corner = |of: &[[f32; WIDTH]; 3]| {
            self.center + DVec3::from([0, 1, 2].map(|axis| f64::from(of[axis][index]))) / self.scale
        };
        Aabb { low: corner(&node.low), high: corner(&node.high) }.with_slack(0.0)
    }
}

/// A face to be sorted into the tree: its box in the tree's own coordinates, rounded outward, and its index.
#[derive(Clone, Copy)]
struct Item {
    low: [f32; 3],
    high: [f32; 3],
    index: u32,
}

impl Item {
    fn middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }
}

impl Tree {
    /// Builds the tree of faces given by their corners' indices. Returns the tree and the indices of the faces in the
    /// order of its leaves.
    pub fn new(vertices: &[DVec3], faces: &[[u32; 3]]) -> (Self, Vec<u32>) {
        let space = Space::around(&Aabb::around(vertices));
        let mut items: Vec<_> = faces
            .par_iter()
            .enumerate()
            .map(|(index, face)| {
                let corners = face.map(|corner| space.point(vertices[corner as usize]));
                let Aabb { low, high } = Aabb::around(&corners);
                // The conversions are off by half an ulp, and the transformation by far less.
                Item {
                    low: low.to_array().map(|low| (low as f32).next_down()),
                    high: high.to_array().map(|high| (high as f32).next_up()),
                    index: index as u32,
                }
            })
            .collect();
        let nodes = build(&mut items, 0, 0);
        (Self { nodes, space }, items.into_iter().map(|item| item.index).collect())
    }

    /// Returns the memory that the tree takes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }
}

/// Builds the nodes over some faces, the root first. `start` is the index of the first face in the whole tree; the
/// nodes' own indices count from the root.
fn build(items: &mut [Item], start: usize, depth: usize) -> Vec<Node> {
    // The ranges of the node's boxes; the one that costs most is split until there are eight.
    let mut parts = vec![(0..items.len(), Box3::around(items))];
    while parts.len() < WIDTH {
        let cost = |(range, bounds): &(Range<usize>, Box3)| match range.len() {
            ..=LEAF => -1.0,
            count if depth < MAX_DEPTH => bounds.half_area() * count as f32,
            count => count as f32,
        };
        let worst = (0..parts.len()).max_by(|one, other| cost(&parts[*one]).total_cmp(&cost(&parts[*other])));
        let Some(worst) = worst.filter(|worst| parts[*worst].0.len() > LEAF) else { break };
        let (range, _) = parts.remove(worst);
        let (middle, [near, far]) = split(&mut items[range.clone()], depth >= MAX_DEPTH);
        let cut = range.start + middle;
        parts.insert(worst, (cut..range.end, far));
        parts.insert(worst, (range.start..cut, near));
    }
    let mut node = Node::EMPTY;
    let mut rest = items;
    let mut inner = Vec::new();
    for (index, (range, bounds)) in parts.iter().enumerate() {
        for axis in 0..3 {
            node.low[axis][index] = bounds.low[axis];
            node.high[axis][index] = bounds.high[axis];
        }
        let own;
        (own, rest) = rest.split_at_mut(range.len());
        let first = start + range.start;
        if range.len() > LEAF {
            inner.push((index, own, first));
        } else {
            node.children[index] = IS_LEAF | ((range.len() as u32 - 1) << 28) | first as u32;
        }
    }
    let total: usize = inner.iter().map(|(_, own, _)| own.len()).sum();
    let below = |(index, own, first): (usize, &mut [Item], usize)| (index, build(own, first, depth + 1));
    let subtrees: Vec<_> = if total > PARALLEL {
        inner.into_par_iter().map(below).collect()
    } else {
        inner.into_iter().map(below).collect()
    };
    let mut nodes = vec![node];
    for (index, subtree) in subtrees {
        let offset = nodes.len() as u32;
        nodes[0].children[index] = offset;
        nodes.extend(subtree.into_iter().map(|mut node| {
            for child in &mut node.children {
                // A code of 0 is that of a box that does not exist.
                *child += if *child & IS_LEAF == 0 && *child != 0 { offset } else { 0 };
            }
            node
        }));
    }
    nodes
}

/// A box in the tree's own coordinates.
#[derive(Clone, Copy)]
struct Box3 {
    low: [f32; 3],
    high: [f32; 3],
}

impl Box3 {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn around(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, |all, item| all.and(&Self { low: item.low, high: item.high }))
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|axis| smaller(self.low[axis], other.low[axis])),
            high: [0, 1, 2].map(|axis| larger(self.high[axis], other.high[axis])),
        }
    }

    fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| (self.high[axis] - self.low[axis]).max(0.0));
        x * y + y * z + z * x
    }
}

#[inline(always)]
pub(super) fn smaller(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}

#[inline(always)]
pub(super) fn larger(one: f32, other: f32) -> f32 {
    if one > other { one } else { other }
}

/// Partitions faces at the returned index, which is neither 0 nor their number: where rays meet fewest boxes, or into
/// halves. Returns the boxes of both parts, too.
fn split(items: &mut [Item], into_halves: bool) -> (usize, [Box3; 2]) {
    let middles = |item: &Item| [0, 1, 2].map(|axis| item.middle(axis));
    let Box3 { low, high } = items
        .iter()
        .fold(Box3::EMPTY, |all, item| all.and(&Box3 { low: middles(item), high: middles(item) }));
    let scale = [0, 1, 2].map(|axis| BINS as f32 / (high[axis] - low[axis]));
    let bin =
        |item: &Item, axis: usize| (((item.middle(axis) - low[axis]) * scale[axis]) as usize).min(BINS - 1);
    let mut bins = [[(0_u32, Box3::EMPTY); BINS]; 3];
    for item in items.iter() {
        let bounds = Box3 { low: item.low, high: item.high };
        for (axis, bins) in bins.iter_mut().enumerate() {
            let (count, all) = &mut bins[bin(item, axis)];
            (*count, *all) = (*count + 1, all.and(&bounds));
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let mut below = [f32::INFINITY; BINS];
        let (mut count, mut all) = (0, Box3::EMPTY);
        for (cut, (number, bounds)) in bins.iter().enumerate().take(BINS - 1) {
            (count, all) = (count + number, all.and(bounds));
            below[cut + 1] = if count == 0 { f32::INFINITY } else { count as f32 * all.half_area() };
        }
        let (mut count, mut all) = (0, Box3::EMPTY);
        for cut in (1..BINS).rev() {
            let (number, bounds) = &bins[cut];
            (count, all) = (count + number, all.and(bounds));
            let above = if count == 0 { f32::INFINITY } else { count as f32 * all.half_area() };
            if below[cut] + above < best.0 {
                best = (below[cut] + above, axis, cut);
            }
        }
    }
    let (cost, axis, cut) = best;
    if into_halves || cost == f32::INFINITY {
        // All centers are one point, or the tree is deep enough.
        let middle = items.len() / 2;
        let (near, far) = items.split_at(middle);
        return (middle, [near, far].map(Box3::around));
    }
    let mut middle = 0;
    for index in 0..items.len() {
        if bin(&items[index], axis) < cut {
            items.swap(index, middle);
            middle += 1;
        }
    }
    let around = |bins: &[(u32, Box3)]| bins.iter().fold(Box3::EMPTY, |all, (_, bounds)| all.and(bounds));
    (middle, [around(&bins[axis][..cut]), around(&bins[axis][cut..])])
}
