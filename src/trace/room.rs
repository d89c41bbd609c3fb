//! Room for packets: arrays that are as long as the longest packet so far, and are kept from one to the next, so that a
//! packet costs what its rays cost.

use crate::packet::{View, ViewMut};
use glam::DVec3;

/// Room for so many elements. What is in them is left from before.
#[inline(always)]
pub(super) fn room<T: Copy + Default>(array: &mut Vec<T>, count: usize) -> &mut [T] {
    if array.len() < count {
        array.resize(count, T::default());
    }
    &mut array[..count]
}

/// Puts some elements of an array into another one, the last of them repeated to make so many. Lanes rise.
pub(super) fn pick<T: Copy + Default>(to: &mut Vec<T>, from: &[T], lanes: &[u8], count: usize) {
    let to = room(to, count);
    let Some(last) = lanes.last().map(|last| usize::from(*last)) else { return };
    let (picked, rest) = to.split_at_mut(lanes.len());
    if are_first(lanes) {
        picked.copy_from_slice(&from[..=last]);
    } else {
        for (to, lane) in picked.iter_mut().zip(lanes) {
            *to = from[usize::from(*lane)];
        }
    }
    rest.fill(from[last]);
}

/// Whether lanes, which rise, are those from the first one on.
fn are_first(lanes: &[u8]) -> bool {
    lanes.last().is_none_or(|last| usize::from(*last) + 1 == lanes.len())
}

/// Vectors, as many as there is room for.
#[derive(Default)]
pub(super) struct Vectors {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

impl Vectors {
    /// The first of them, so many.
    #[inline(always)]
    pub fn view(&self, count: usize) -> View<'_> {
        View { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Room for so many. What is there is left from before.
    #[inline(always)]
    pub fn room(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut { x: room(&mut self.x, count), y: room(&mut self.y, count), z: room(&mut self.z, count) }
    }

    /// The one of this index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Puts one in its place.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: DVec3) {
        (self.x[index], self.y[index], self.z[index]) = (vector.x, vector.y, vector.z);
    }

    /// Makes so many of them the same.
    pub fn fill(&mut self, count: usize, vector: DVec3) {
        let ViewMut { x, y, z } = self.room(count);
        x.fill(vector.x);
        y.fill(vector.y);
        z.fill(vector.z);
    }

    /// Takes these.
    pub fn copy(&mut self, from: View) {
        self.room(from.len()).put(0, from);
    }

    /// Takes some of others, the last of them repeated to make so many.
    pub fn pick(&mut self, from: &Self, lanes: &[u8], count: usize) {
        pick(&mut self.x, &from.x, lanes, count);
        pick(&mut self.y, &from.y, lanes, count);
        pick(&mut self.z, &from.z, lanes, count);
    }

    /// Puts the first ones of others in these places.
    pub fn put(&mut self, from: &Self, lanes: &[u8]) {
        if are_first(lanes) {
            self.copy(from.view(lanes.len()));
            return;
        }
        for (index, lane) in lanes.iter().enumerate() {
            self.set(usize::from(*lane), from.get(index));
        }
    }
}
