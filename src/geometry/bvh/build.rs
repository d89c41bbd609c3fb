//! Building a hierarchy, top down by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007), on all threads.
//!
//! A node's objects are split in two, then the largest part is split, until there are eight parts or all parts fit into
//! a node each. The result depends on the boxes and their order alone, not on the number of threads: minima, maxima and
//! counts have no order, and each part is sorted by one thread.

use crate::geometry::aabb::Aabb;
use crate::geometry::bvh::node::{Node, WIDTH, finite};
use glam::DVec3;
use rayon::prelude::*;
use std::mem::take;

/// The number of bins along an axis; a set of objects is split between two bins.
const BINS: usize = 16;

/// The number of objects from which on a part is built by a thread of its own.
const LARGE: usize = 4096;

/// The number of levels from which on parts are halved by number, so that no scene makes the tree too deep.
const DEEP: usize = 40;

/// An object: its box, and its index.
struct Item {
    bounds: Aabb,
    index: u32,
}

impl Item {
    /// Returns twice the center of the box.
    fn center(&self) -> DVec3 {
        self.bounds.low + self.bounds.high
    }
}

/// Nodes and objects, each node's children in a row. Node 0 is the root.
#[derive(Default)]
pub struct Parts {
    pub nodes: Vec<Node>,
    pub objects: Vec<u32>,
}

/// Builds the nodes of a hierarchy of objects with these boxes.
pub fn build(boxes: &[Aabb]) -> Parts {
    let item = |(index, bounds)| Item { bounds: finite(bounds), index: index as u32 };
    let mut items: Vec<_> = if boxes.len() < LARGE {
        boxes.iter().enumerate().map(item).collect()
    } else {
        boxes.par_iter().enumerate().map(item).collect()
    };
    let mut parts = Parts::default();
    if !items.is_empty() {
        parts.nodes.push(Node::EMPTY);
        let bounds = around(&items);
        parts.add(&mut items, bounds, 0, 0);
    }
    parts
}

/// Returns the bounding box of some items.
fn around(items: &[Item]) -> Aabb {
    let fold = |items: &[Item]| items.iter().fold(Aabb::EMPTY, |all, item| all.and(&item.bounds));
    if items.len() < LARGE {
        fold(items)
    } else {
        items.par_chunks(LARGE).map(fold).reduce(|| Aabb::EMPTY, |one, other| one.and(&other))
    }
}

/// Some items, and their bounding box.
struct Part<'i> {
    items: &'i mut [Item],
    bounds: Aabb,
}

impl Parts {
    /// Makes the node of this index the root of the tree of some items.
    fn add(&mut self, items: &mut [Item], bounds: Aabb, index: usize, depth: usize) {
        let parts = divide(Part { items, bounds }, depth);
        let boxes: Vec<_> = parts.iter().map(|part| part.bounds).collect();
        let mut node = Node::new(&boxes);
        node.first_node = self.nodes.len() as u32;
        node.first_object = self.objects.len() as u32;
        let mut inner = Vec::with_capacity(parts.len());
        for (child, part) in parts.into_iter().enumerate() {
            if let [item] = part.items {
                self.objects.push(item.index);
            } else {
                node.nodes |= 1 << child;
                self.nodes.push(Node::EMPTY);
                inner.push(part);
            }
        }
        let first = node.first_node as usize;
        self.nodes[index] = node;
        if inner.iter().filter(|part| part.items.len() >= LARGE).count() > 1 {
            let built = inner.into_par_iter().map(|part| {
                let mut parts = Self { nodes: vec![Node::EMPTY], objects: Vec::new() };
                parts.add(part.items, part.bounds, 0, depth + 1);
                parts
            });
            for (child, part) in built.collect::<Vec<_>>().into_iter().enumerate() {
                self.append(part, first + child);
            }
        } else {
            for (child, part) in inner.into_iter().enumerate() {
                self.add(part.items, part.bounds, first + child, depth + 1);
            }
        }
    }

    /// Appends a tree, with its root as the node of this index.
    fn append(&mut self, mut part: Self, root: usize) {
        // The root moves to its place, and the others follow the nodes that there are.
        let (nodes, objects) = (self.nodes.len() as u32 - 1, self.objects.len() as u32);
        for node in &mut part.nodes {
            node.first_node += nodes;
            node.first_object += objects;
        }
        let mut others = part.nodes.drain(..);
        if let Some(node) = others.next() {
            self.nodes[root] = node;
        }
        self.nodes.extend(others);
        self.objects.append(&mut part.objects);
    }
}

/// Divides items into at most eight parts, one for each child of a node.
fn divide(whole: Part, depth: usize) -> Vec<Part> {
    let mut parts = Vec::with_capacity(WIDTH);
    parts.push(whole);
    // While there is room, the largest part is split that does not fit into a node.
    while parts.len() < WIDTH {
        let size = |part: &Part| match part.items.len() {
            len if len <= WIDTH => -1.0,
            len if depth >= DEEP => len as f64,
            _ => area(part),
        };
        let Some(largest) = largest(&parts, size) else { break };
        let part = &mut parts[largest];
        let (one, other) = split(take(&mut part.items), &part.bounds, depth);
        *part = one;
        parts.insert(largest + 1, other);
    }
    // Where there is room for all items of a part, each is a child.
    loop {
        let room = WIDTH - parts.len();
        let size = |part: &Part| match part.items.len() {
            len if len > 1 && len - 1 <= room => area(part),
            _ => -1.0,
        };
        let Some(largest) = largest(&parts, size) else { break };
        let part = parts.remove(largest);
        let single = part.items.chunks_exact_mut(1).map(|items| Part { bounds: items[0].bounds, items });
        parts.splice(largest..largest, single.collect::<Vec<_>>());
    }
    parts
}

/// Returns half the surface area of a part, infinite where it has no finite number.
fn area(part: &Part) -> f64 {
    let area = part.bounds.half_area();
    if area.is_nan() { f64::INFINITY } else { area }
}

/// Returns the index of the largest part, the first of equal ones. Parts of negative size are left out.
fn largest(parts: &[Part], size: impl Fn(&Part) -> f64) -> Option<usize> {
    let sizes = parts.iter().map(size).enumerate().filter(|(_, size)| *size >= 0.0);
    let largest = sizes.reduce(|one, other| if other.1 > one.1 { other } else { one });
    largest.map(|(index, _)| index)
}

/// The items whose centers lie in a bin: their number and bounding box.
type Bin = (u32, Aabb);

/// Splits items in two parts.
fn split<'i>(items: &'i mut [Item], bounds: &Aabb, depth: usize) -> (Part<'i>, Part<'i>) {
    let is_large = items.len() >= LARGE;
    let centers = |items: &[Item]| {
        let mut all = Aabb::EMPTY;
        for item in items {
            let center = item.center();
            all = all.and(&Aabb { low: center, high: center });
        }
        all
    };
    let centers = if is_large {
        items.par_chunks(LARGE).map(centers).reduce(|| Aabb::EMPTY, |one, other| one.and(&other))
    } else {
        centers(items)
    };
    let size = centers.high - centers.low;
    let axis = size.max_position();
    let halves = |items: &'i mut [Item]| {
        let (one, other) = items.split_at_mut(items.len() / 2);
        let bounds = [around(one), around(other)];
        (Part { items: one, bounds: bounds[0] }, Part { items: other, bounds: bounds[1] })
    };
    if depth >= DEEP || !(size[axis] > 0.0) || !bounds.half_area().is_finite() {
        // No split is better than another.
        return halves(items);
    }
    let (low, scale) = (centers.low[axis], BINS as f64 * (1.0 - 1e-9) / size[axis]);
    let bin = |item: &Item| ((item.center()[axis] - low) * scale) as usize;
    let count = |items: &[Item]| {
        let mut bins = [(0, Aabb::EMPTY); BINS];
        for item in items {
            let bin = &mut bins[bin(item).min(BINS - 1)];
            *bin = (bin.0 + 1, bin.1.and(&item.bounds));
        }
        bins
    };
    let join = |one: &Bin, other: &Bin| (one.0 + other.0, one.1.and(&other.1));
    let bins: [Bin; BINS] = if is_large {
        let none = || [(0, Aabb::EMPTY); BINS];
        let join =
            |one: [Bin; BINS], other: [Bin; BINS]| std::array::from_fn(|bin| join(&one[bin], &other[bin]));
        items.par_chunks(LARGE).map(count).reduce(none, join)
    } else {
        count(items)
    };
    // The parts above each cut, from the last cut to the first.
    let mut above = [(0, Aabb::EMPTY); BINS];
    above[BINS - 1] = bins[BINS - 1];
    for cut in (1..BINS - 1).rev() {
        above[cut] = join(&bins[cut], &above[cut + 1]);
    }
    // The probability that a ray enters a box is proportional to its surface area.
    let cost = |part: &Bin| f64::from(part.0) * part.1.half_area();
    let (mut below, mut best) = ((0, Aabb::EMPTY), (f64::INFINITY, 0, Aabb::EMPTY));
    for cut in 1..BINS {
        below = join(&below, &bins[cut - 1]);
        if below.0 > 0 && above[cut].0 > 0 {
            let cost = cost(&below) + cost(&above[cut]);
            if cost < best.0 {
                best = (cost, cut, below.1);
            }
        }
    }
    let (least, cut, below) = best;
    if least == f64::INFINITY {
        return halves(items);
    }
    let middle = partition(items, |item| bin(item) < cut);
    let (one, other) = items.split_at_mut(middle);
    (Part { items: one, bounds: below }, Part { items: other, bounds: above[cut].1 })
}

/// Moves the items that satisfy a condition before the others, and returns their number.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let (mut start, mut end) = (0, items.len());
    loop {
        while start < end && is_first(&items[start]) {
            start += 1;
        }
        while start < end && !is_first(&items[end - 1]) {
            end -= 1;
        }
        if start == end {
            return start;
        }
        items.swap(start, end - 1);
    }
}
