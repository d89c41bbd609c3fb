//! Arrays that are as long as the longest packet so far and are reused from one packet to the next, so that a packet
//! costs only what its rays cost.

use glam::DVec3;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::simd::soa::{View, ViewMut};

/// The maximum number of rays of a narrow packet.
pub(super) const NARROW: usize = 8;

/// Returns the first `count` elements of an array, which grows if it is shorter. Old elements keep their values.
#[inline(always)]
pub(super) fn resized<T: Copy + Default>(array: &mut Vec<T>, count: usize) -> &mut [T] {
    if array.len() < count {
        // All but narrow packets have room for the widest one, on which `gather` relies.
        array.resize(if count > NARROW { count.max(PACKET_SIZE) } else { count }, T::default());
    }
    &mut array[..count]
}

/// Lists the lanes whose mask is not 0.
pub(super) fn compact<'l>(of: &[u64], lanes: &'l mut Vec<u8>) -> &'l [u8] {
    let (lanes, mut len) = (resized(lanes, of.len()), 0);
    for (lane, is_one) in of.iter().enumerate() {
        lanes[len] = lane as u8;
        len += usize::from(*is_one != 0);
    }
    &lanes[..len]
}

/// Gathers the elements of some lanes, in ascending order, into another array. The last element is repeated to make
/// `count`. From an empty array, nothing is gathered.
pub(super) fn gather<T: Copy + Default>(to: &mut Vec<T>, from: &[T], lanes: &[u8], count: usize) {
    if from.is_empty() {
        to.clear();
        return;
    }
    let to = resized(to, count);
    let Some(last) = lanes.last().map(|last| usize::from(*last)) else { return };
    let (gathered, rest) = to.split_at_mut(lanes.len());
    if are_first(lanes) {
        gathered.copy_from_slice(&from[..=last]);
    } else if let Some(from) = from.first_chunk::<PACKET_SIZE>() {
        // The compiler sees that no lane is out of bounds.
        for (to, lane) in gathered.iter_mut().zip(lanes) {
            *to = from[usize::from(*lane)];
        }
    } else {
        for (to, lane) in gathered.iter_mut().zip(lanes) {
            *to = from[usize::from(*lane)];
        }
    }
    rest.fill(from[last]);
}

/// Tells whether lanes, in ascending order, are the first ones without gaps.
fn are_first(lanes: &[u8]) -> bool {
    lanes.last().is_none_or(|last| usize::from(*last) + 1 == lanes.len())
}

/// A list of vectors that grows on demand, as an array for each coordinate.
#[derive(Default)]
pub(super) struct VectorList {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// The number of first vectors that are known to be the same, bit by bit: most packets start at the viewpoint.
    same: usize,
}

impl VectorList {
    /// Returns the first `count` vectors.
    #[inline(always)]
    pub fn view(&self, count: usize) -> View<'_> {
        View { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Returns the first `count` vectors for writing; the list grows if it is shorter. Old vectors keep their values.
    #[inline(always)]
    pub fn resized(&mut self, count: usize) -> ViewMut<'_> {
        self.same = 0;
        ViewMut {
            x: resized(&mut self.x, count),
            y: resized(&mut self.y, count),
            z: resized(&mut self.z, count),
        }
    }

    /// Returns the vector of this index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Sets the vector of this index.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: DVec3) {
        self.same = 0;
        (self.x[index], self.y[index], self.z[index]) = (vector.x, vector.y, vector.z);
    }

    /// Sets the first `count` vectors to the same value.
    pub fn fill(&mut self, count: usize, vector: DVec3) {
        let bits = |vector: DVec3| vector.to_array().map(f64::to_bits);
        if 0 < count && count <= self.same && bits(self.get(0)) == bits(vector) {
            return;
        }
        let ViewMut { x, y, z } = self.resized(count);
        x.fill(vector.x);
        y.fill(vector.y);
        z.fill(vector.z);
        self.same = count;
    }

    /// Copies vectors to the start of the list.
    pub fn copy(&mut self, from: View) {
        self.resized(from.len()).copy_at(0, from);
    }

    /// Gathers the vectors of some lanes of another list. The last vector is repeated to make `count`.
    pub fn gather(&mut self, from: &Self, lanes: &[u8], count: usize) {
        self.same = 0;
        gather(&mut self.x, &from.x, lanes, count);
        gather(&mut self.y, &from.y, lanes, count);
        gather(&mut self.z, &from.z, lanes, count);
    }

    /// Scatters the first vectors of another list to these lanes.
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
