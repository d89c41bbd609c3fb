//! Joins places of lines to curves.

use super::{Curve, Key};
use glam::DVec2;
use std::collections::BTreeMap;

/// The farthest that a curve may pass from the places that it joins, in pixels.
const TOLERANCE: f64 = 0.02;

/// A place, and the places beside it on its curves.
struct Node {
    at: DVec2,
    links: Vec<Key>,
    is_end: bool,
}

/// The third number of the key of a region's middle; the first counts regions.
const MIDDLE: usize = usize::MAX;

/// Joins places around regions: two by a line, and more of them by lines that meet in their middle.
pub(super) fn curves(
    places: &BTreeMap<Key, DVec2>,
    regions: impl IntoIterator<Item = Vec<Key>>,
) -> Vec<Curve> {
    let mut nodes: BTreeMap<Key, Node> =
        places.iter().map(|(key, at)| (*key, Node { at: *at, links: Vec::new(), is_end: false })).collect();
    let link = |nodes: &mut BTreeMap<Key, Node>, [one, other]: [Key; 2]| {
        for (from, to) in [(one, other), (other, one)] {
            nodes.entry(from).and_modify(|node| node.links.push(to));
        }
    };
    for (count, around) in regions.into_iter().enumerate() {
        let on: Vec<_> = around.into_iter().filter(|key| places.contains_key(key)).collect();
        match on[..] {
            [] | [_] => {}
            [one, other] => link(&mut nodes, [one, other]),
            _ => {
                let at = on.iter().map(|key| places[key]).sum::<DVec2>() / on.len() as f64;
                let middle = [count, 0, MIDDLE];
                nodes.insert(middle, Node { at, links: Vec::new(), is_end: true });
                on.into_iter().for_each(|key| link(&mut nodes, [key, middle]));
            }
        }
    }
    nodes.values_mut().for_each(|node| node.is_end |= node.links.len() != 2);
    // Curves with ends first, then the closed ones.
    let ends: Vec<_> = nodes.iter().filter(|(_, node)| node.is_end).map(|(key, _)| *key).collect();
    let all: Vec<_> = nodes.keys().copied().collect();
    let mut curves = Vec::new();
    for start in ends.into_iter().chain(all) {
        while !nodes[&start].links.is_empty() {
            curves.push(simplified(&walk(&mut nodes, start)));
        }
    }
    curves
}

/// Follows a curve from a place to its end, or around, and removes it.
fn walk(nodes: &mut BTreeMap<Key, Node>, start: Key) -> Curve {
    let (mut key, mut curve) = (start, vec![nodes[&start].at]);
    while let Some(next) = nodes.get_mut(&key).and_then(|node| node.links.pop()) {
        let Some(node) = nodes.get_mut(&next) else { break };
        if let Some(back) = node.links.iter().position(|link| *link == key) {
            node.links.swap_remove(back);
        }
        curve.push(node.at);
        if node.is_end {
            break;
        }
        key = next;
    }
    curve
}

/// Leaves out points that are so close to the line between others that nobody sees it (Ramer, Douglas and Peucker).
fn simplified(curve: &[DVec2]) -> Curve {
    let mut kept = vec![false; curve.len()];
    let mut parts = vec![[0, curve.len() - 1]];
    while let Some([first, last]) = parts.pop() {
        (kept[first], kept[last]) = (true, true);
        let (from, along) = (curve[first], curve[last] - curve[first]);
        let off = |at: DVec2| {
            let part = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            // Where both ends are the same, no part of the way counts.
            (at - from - if part.is_nan() { DVec2::ZERO } else { part * along }).length()
        };
        let farthest = (first + 1..last).max_by(|one, other| off(curve[*one]).total_cmp(&off(curve[*other])));
        if let Some(farthest) = farthest.filter(|farthest| off(curve[*farthest]) > TOLERANCE) {
            parts.extend([[first, farthest], [farthest, last]]);
        }
    }
    curve.iter().zip(kept).filter_map(|(at, is_kept)| is_kept.then_some(*at)).collect()
}
