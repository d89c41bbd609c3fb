//! Building a hierarchy, top down by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007), on all threads.
//!
//! A node's objects are split in two, then the largest part is split, until there are eight parts or each part fits
//! into a node. The result only depends on the boxes and their order, not on the number of threads: minima, maxima and
//! counts have no order, and one thread sorts each part.

use crate::geometry::aabb::Aabb;
use crate::geometry::bvh::bins::{BINS, Bin, Grid, Item, Limits, NOTHING, best_cut, binned, half_area, join};
use crate::geometry::bvh::node::{Node, WIDTH};
use crate::parallel;
use crate::simd::cpu::Cpu;
use glam::DVec3;
use std::array;
use std::mem::take;
use std::sync::Mutex;
use tabray_exact::scalar::per_axis;

/// The number of objects from which on a part is built by its own thread.
const LARGE: usize = 4096;

/// From this level on, parts are halved by the number of objects, which limits the depth of the tree.
const DEEP: usize = 40;

/// Nodes and objects, with each node's children in consecutive places. Node 0 is the root.
#[derive(Default)]
pub struct Parts {
    pub nodes: Vec<Node>,
    pub objects: Vec<u32>,
}

/// Builds the nodes of a hierarchy of objects. `bounds` returns their boxes.
pub fn build(count: usize, bounds: impl Fn(usize) -> Aabb + Sync) -> Parts {
    let mut items = parallel::filled(count, LARGE, |index| Item::new(index, &bounds(index)));
    // The data for the boxes may be as large as the items.
    drop(bounds);
    let mut parts = Parts::default();
    if !items.is_empty() {
        parts.nodes.push(Node::EMPTY);
        parts.add(ItemSet::new(&mut items), 0, 0);
    }
    parts
}

/// Some items, their joint limits, and those of twice their centers.
#[derive(Default)]
struct ItemSet<'i> {
    items: &'i mut [Item],
    limits: Limits,
    centers: Limits,
}

impl<'i> ItemSet<'i> {
    fn new(items: &'i mut [Item]) -> Self {
        let fold = |items: &[Item]| {
            items.iter().fold((NOTHING, NOTHING), |(limits, centers), item| {
                (join(&limits, &item.limits), join(&centers, &item.centers()))
            })
        };
        let both =
            |one: (Limits, Limits), other: (Limits, Limits)| (join(&one.0, &other.0), join(&one.1, &other.1));
        let (limits, centers) = if items.len() < LARGE {
            fold(items)
        } else {
            chunks(items, fold).into_iter().fold((NOTHING, NOTHING), both)
        };
        Self { items, limits, centers }
    }

    /// Splits the items in the middle of their order.
    fn halves(self) -> [Self; 2] {
        let (one, other) = self.items.split_at_mut(self.items.len() / 2);
        [Self::new(one), Self::new(other)]
    }
}

impl Parts {
    /// Makes the node with this index the root of the tree of some items.
    fn add(&mut self, part: ItemSet, index: usize, depth: usize) {
        let mut inner = divide(part, depth);
        inner.sort_by_key(|part| part.items.len() == 1);
        let mut boxes = [Aabb::EMPTY; WIDTH];
        for (bounds, part) in boxes.iter_mut().zip(&inner) {
            let [a, b, c, d, e, f] = part.limits;
            *bounds = Aabb { low: DVec3::new(a, b, c), high: DVec3::new(-d, -e, -f) };
        }
        let mut node = Node::new(&boxes[..inner.len()]);
        let first = self.nodes.len();
        (node.first_node, node.first_object) = (first as u32, self.objects.len() as u32);
        let single = inner.partition_point(|part| part.items.len() > 1);
        node.nodes = single as u8;
        for part in inner.drain(single..) {
            self.objects.push(part.items[0].index);
        }
        self.nodes.resize_with(first + single, || Node::EMPTY);
        self.nodes[index] = node;
        if inner.iter().filter(|part| part.items.len() >= LARGE).count() > 1 {
            let inner: Vec<_> = inner.into_iter().map(Mutex::new).collect();
            let built = parallel::map(inner.len(), |child| {
                let mut parts = Self { nodes: vec![Node::EMPTY], objects: Vec::new() };
                parts.add(take(&mut *inner[child].lock().expect("no thread panicked")), 0, depth + 1);
                parts
            });
            for (child, part) in built.into_iter().enumerate() {
                self.append(part, first + child);
            }
        } else {
            for (child, part) in inner.into_iter().enumerate() {
                self.add(part, first + child, depth + 1);
            }
        }
    }

    /// Appends a tree, with the node of this index as its root.
    fn append(&mut self, mut part: Self, root: usize) {
        // The root moves to its place, and the other nodes are added after the existing ones.
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
fn divide(whole: ItemSet, depth: usize) -> Vec<ItemSet> {
    let mut parts = Vec::with_capacity(WIDTH);
    parts.push(whole);
    // While there is room, the largest part that is too large for a node is split.
    while parts.len() < WIDTH {
        let size = |part: &ItemSet| match part.items.len() {
            len if len <= WIDTH => -1.0,
            len if depth >= DEEP => len as f64,
            _ => half_area(part.limits),
        };
        let Some(largest) = largest(&parts, size) else { break };
        let [one, other] = split(take(&mut parts[largest]), depth);
        parts[largest] = one;
        parts.insert(largest + 1, other);
    }
    // If there is room for all items of a part, each becomes a child.
    loop {
        let room = WIDTH - parts.len();
        let size = |part: &ItemSet| match part.items.len() {
            len if len > 1 && len - 1 <= room => half_area(part.limits),
            _ => -1.0,
        };
        let Some(largest) = largest(&parts, size) else { break };
        let part = parts.remove(largest);
        let single = part.items.chunks_exact_mut(1);
        parts.extend(single.map(|items| ItemSet {
            limits: items[0].limits,
            centers: items[0].centers(),
            items,
        }));
    }
    parts
}

/// Returns the index of the largest part, the first of equal ones. Parts with a negative size are ignored.
fn largest(parts: &[ItemSet], size: impl Fn(&ItemSet) -> f64) -> Option<usize> {
    let sizes = parts.iter().map(size).enumerate().filter(|(_, size)| *size >= 0.0);
    let largest = sizes.reduce(|one, other| if other.1 > one.1 { other } else { one });
    largest.map(|(index, _)| index)
}

/// Applies a function to each chunk of many items, on all threads.
fn chunks<T: Send>(items: &[Item], work: impl Fn(&[Item]) -> T + Sync) -> Vec<T> {
    let chunks: Vec<_> = items.chunks(LARGE).collect();
    parallel::map(chunks.len(), |chunk| work(chunks[chunk]))
}

/// Splits the items of a part in two.
fn split(part: ItemSet, depth: usize) -> [ItemSet; 2] {
    let size = per_axis(|axis| -part.centers[axis + 3] - part.centers[axis]);
    let axis = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
    let (low, scale) = (part.centers[axis], BINS as f64 * (1.0 - 1e-9) / size[axis]);
    if depth >= DEEP || !(size[axis] > 0.0 && scale < f64::INFINITY && half_area(part.limits) < f64::INFINITY)
    {
        // No split is known to be better than another.
        return part.halves();
    }
    let grid = Grid { axis, low, scale };
    let bins = if part.items.len() < LARGE {
        binned(Cpu::best(), part.items, grid)
    } else {
        let add = |one: [Bin; BINS], other: [Bin; BINS]| array::from_fn(|bin| one[bin].and(&other[bin]));
        chunks(part.items, |items| binned(Cpu::best(), items, grid)).into_iter().fold([Bin::EMPTY; BINS], add)
    };
    let Some((cut, [near, far])) = best_cut(Cpu::best(), &bins) else { return part.halves() };
    let middle = partition(part.items, |item| grid.place(item) < cut as f64);
    let (before, after) = part.items.split_at_mut(middle);
    [(before, near), (after, far)].map(|(items, Bin { limits, centers, .. })| ItemSet {
        items,
        limits,
        centers,
    })
}

/// The number of items in a block of [`partition`].
const BLOCK: usize = 64;

/// Moves the items that satisfy a condition before the others, and returns their number.
///
/// The items on the wrong side are listed a block at a time, without branches, because no processor predicts an item's
/// side (Edelkamp and Weiss, "BlockQuicksort", 2016).
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let (mut start, mut end) = (0, items.len());
    // The places of such items, from the start and from the end, and the ranges of the lists that are still to be
    // swapped.
    let [mut low, mut high] = [[0_u8; BLOCK]; 2];
    let [mut lows, mut highs] = [0..0, 0..0];
    while end - start >= 2 * BLOCK {
        if lows.is_empty() {
            lows = 0..0;
            for (place, item) in items[start..start + BLOCK].iter().enumerate() {
                low[lows.end] = place as u8;
                lows.end += usize::from(!is_first(item));
            }
        }
        if highs.is_empty() {
            highs = 0..0;
            for (place, item) in items[end - BLOCK..end].iter().rev().enumerate() {
                high[highs.end] = place as u8;
                highs.end += usize::from(is_first(item));
            }
        }
        let count = lows.len().min(highs.len());
        for pair in 0..count {
            let (one, other) = (low[lows.start + pair], high[highs.start + pair]);
            items.swap(start + usize::from(one), end - 1 - usize::from(other));
        }
        (lows.start, highs.start) = (lows.start + count, highs.start + count);
        start += if lows.is_empty() { BLOCK } else { 0 };
        end -= if highs.is_empty() { BLOCK } else { 0 };
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of nodes on the longest path down from a node.
    fn levels(nodes: &[Node], index: usize) -> usize {
        let node = &nodes[index];
        let below = (0..node.nodes.into()).map(|child| levels(nodes, node.first_node as usize + child)).max();
        1 + below.unwrap_or(0)
    }

    #[test]
    fn a_tree_is_not_deep_however_boxes_lie() {
        const COUNT: usize = 100_000;
        let cube = |middle: f64, size: f64| Aabb {
            low: DVec3::splat(middle - size),
            high: DVec3::splat(middle + size),
        };
        let growing = |index: usize, octaves: f64| (octaves * (index as f64 / COUNT as f64 - 0.5)).exp2();
        let all: [(&str, &(dyn Fn(usize) -> Aabb + Sync)); 6] = [
            ("equal", &|_| cube(1.0, 0.0)),
            ("around one point", &|index| cube(1.0, index as f64)),
            ("around one point, growing exponentially", &|index| cube(0.0, growing(index, 600.0))),
            ("in a row, growing exponentially", &|index| cube(growing(index, 600.0), growing(index, 600.0))),
            ("in a row, growing by all that a number can", &|index| cube(growing(index, 2000.0), 0.0)),
            ("endless", &|index| cube(index as f64, f64::INFINITY)),
        ];
        for (name, bounds) in all {
            let Parts { nodes, mut objects } = build(COUNT, bounds);
            objects.sort_unstable();
            assert!(objects.into_iter().eq(0..COUNT as u32), "{name}");
            let levels = levels(&nodes, 0);
            // Each level from `DEEP` on divides by eight, and 8^6 is more than the number of boxes.
            assert!(levels <= DEEP + 6, "{name}: {levels} levels");
        }
    }
}
