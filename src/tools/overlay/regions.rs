//! The regions into which outlines divide pixels. Level lines are joined within each.

use super::{INSET, Key, Side};
use glam::DVec2;
use std::collections::{BTreeMap, BTreeSet};

/// Added to the direction of a side for its part behind a place of an outline. The part before it has the side's key.
pub(super) const BEHIND: usize = 2;

/// Added to the number of a pixel's region for the line between its two places of an outline.
const ALONG_OUTLINE: usize = 4;

/// A pixel, as outlines divide it.
pub(super) struct Pixel {
    /// What surrounds each region: sides of the pixel, their parts, and lines along outlines.
    pub regions: Vec<Vec<Key>>,
    /// The lines along outlines. Their ends are moved inward, and show what is seen beside the outline.
    pub along_outlines: Vec<Side>,
}

impl Pixel {
    /// Divides a pixel, given by its column and its row, where outlines pass its sides.
    pub fn new(at: [usize; 2], outlines: &BTreeMap<Key, Side>) -> Self {
        let (mut regions, mut ends) = (vec![Vec::new()], Vec::new());
        for (index, key) in sides(at).into_iter().enumerate() {
            let Some(cut) = outlines.get(&key) else {
                regions.last_mut().expect("a region").push(key);
                continue;
            };
            let behind = [key[0], key[1], key[2] + BEHIND];
            // The first two sides are passed from their first corner to the other one.
            let [before, after] = if index < 2 { [(key, 0), (behind, 1)] } else { [(behind, 1), (key, 0)] };
            regions.last_mut().expect("a region").push(before.0);
            regions.push(vec![after.0]);
            ends.push([before.1, after.1].map(|end| (cut, end)));
        }
        if !ends.is_empty() {
            let first = regions.remove(0);
            regions.last_mut().expect("a region").extend(first);
        }
        let mut along_outlines = Vec::new();
        for (index, region) in regions.iter_mut().enumerate().filter(|_| ends.len() > 1) {
            let key = [at[0], at[1], ALONG_OUTLINE + index];
            let between = [ends[index][1], ends[(index + 1) % ends.len()][0]];
            let inward = |(cut, end): (&Side, usize)| cut.ends[end].lerp(corners(cut.key)[end], INSET);
            along_outlines.push(Side {
                key,
                ends: between.map(inward),
                seen: between.map(|(cut, end)| cut.seen[end]),
                pixel: between[0].0.pixel,
            });
            region.push(key);
        }
        Self { regions, along_outlines }
    }
}

/// Returns the pixels beside sides or parts of them, by their columns and rows.
pub(super) fn beside<'k>(keys: impl Iterator<Item = &'k Key>) -> BTreeSet<[usize; 2]> {
    keys.flat_map(|&[column, row, along]| {
        let before = if along % 2 == 0 {
            row.checked_sub(1).map(|row| [column, row])
        } else {
            column.checked_sub(1).map(|column| [column, row])
        };
        before.into_iter().chain([[column, row]])
    })
    .collect()
}

/// Returns the sides of a pixel in the order in which they surround it.
pub(super) fn sides([column, row]: [usize; 2]) -> [Key; 4] {
    [[column, row, 0], [column + 1, row, 1], [column, row + 1, 0], [column, row, 1]]
}

/// Returns both ends of a side.
pub(super) fn corners([column, row, along]: Key) -> [DVec2; 2] {
    [[column, row], [column + 1 - along, row + along]].map(|at| DVec2::from(at.map(|place| place as f64)))
}
