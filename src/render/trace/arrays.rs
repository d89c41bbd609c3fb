//! Arrays that are as long as the longest packet so far, and are kept from one to the next, so that a packet costs what
//! its rays cost.

use crate::geometry::ray_packet::PACKET_SIZE;
use crate::simd::soa::{View, ViewMut};
use glam::DVec3;

/// The rays of a packet where there are few.
pub(super) const NARROW: usize = 8;

/// Room for so many elements. What is in them is left from before.
#[inline(always)]
pub(super) fn resized<T: Copy + Default>(array: &mut Vec<T>, count: usize) -> &mut [T] {
    if array.len() < count {
        // All but narrow packets have room for the widest one, which `pick` makes use of.
        array.resize(if count > NARROW { count.max(PACKET_SIZE) } else { count }, T::default());
    }
    &mut array[..count]
}

/// Lists the lanes that are not 0.
pub(super) fn compact<'l>(of: &[u64], lanes: &'l mut Vec<u8>) -> &'l [u8] {
    let (lanes, mut len) = (resized(lanes, of.len()), 0);
    for (lane, is_one) in of.iter().enumerate() {
        lanes[len] = lane as u8;
        len += usize::from(*is_one != 0);
    }
    &lanes[..len]
}

/// Puts some elements of an array into another one, the last of them repeated to make so many; none of one that is
/// empty. Lanes rise.
pub(super) fn gather<T: Copy + Default>(to: &mut Vec<T>, from: &[T], lanes: &[u8], count: usize) {
    if from.is_empty() {
        to.clear();
        return;
    }
    let to = resized(to, count);
    let Some(last) = lanes.last().map(|last| usize::from(*last)) else { return };
    let (picked, rest) = to.split_at_mut(lanes.len());
    if are_first(lanes) {
        picked.copy_from_slice(&from[..=last]);
    } else if let Some(from) = from.first_chunk::<PACKET_SIZE>() {
        // No lane is beyond its end, and the compiler knows.
        for (to, lane) in picked.iter_mut().zip(lanes) {
            *to = from[usize::from(*lane)];
        }
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
pub(super) struct VectorList {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

impl VectorList {
    /// The first of them, so many.
    #[inline(always)]
    pub fn view(&self, count: usize) -> View<'_> {
        View { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Room for so many. What is there is left from before.
    #[inline(always)]
    pub fn resized(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut {
            x: resized(&mut self.x, count),
            y: resized(&mut self.y, count),
            z: resized(&mut self.z, count),
        }
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
        let ViewMut { x, y, z } = self.resized(count);
        x.fill(vector.x);
        y.fill(vector.y);
        z.fill(vector.z);
    }

    /// Takes these.
    pub fn copy(&mut self, from: View) {
        self.resized(from.len()).copy_at(0, from);
    }

    /// Takes some of others, the last of them repeated to make so many.
    pub fn gather(&mut self, from: &Self, lanes: &[u8], count: usize) {
        gather(&mut self.x, &from.x, lanes, count);
        gather(&mut self.y, &from.y, lanes, count);
        gather(&mut self.z, &from.z, lanes, count);
    }

    /// Puts the first ones of others in these places.
    pub fn scatter(&mut self, from: &Self, lanes: &[u8]) {
        if are_first(lanes) {
            self.copy(from.view(lanes.len()));
            return;
        }
        for (index, lane) in lanes.iter().enumerate() {
            self.set(usize::from(*lane), from.get(index));
        }
    }
}
