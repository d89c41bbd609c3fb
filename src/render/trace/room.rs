//! Room for packets: arrays that are as long as the longest packet so far, and are kept from one to the next, so that a
//! packet costs what its rays cost.

use super::NARROW;
use super::group::{Group, Parts};
use super::illuminate::Lighting;
use super::passage::Passage;
use super::search::Found;
use super::shade::Shading;
use crate::geometry::packet::WIDE;
use crate::simd::soa::{View, ViewMut};
use crate::world::sample::Sample;
use glam::DVec3;

/// All that the packets of one thread need, one after the other.
#[derive(Default)]
pub(crate) struct Rooms {
    pub(super) primary: Option<Box<Primary>>,
    /// The x and y of the places of the picture that the camera rays under way look through, in pixels.
    pub(super) places: [Vec<f64>; 2],
    /// Of the camera rays under way, where pixels have more than one.
    pub(super) samples: Vec<Sample>,
    /// For packets that wait for those which have gone on from them, the foremost one last.
    #[expect(clippy::vec_box, reason = "they come and go, and are large")]
    pub(super) levels: Vec<Box<Level>>,
    #[expect(clippy::vec_box, reason = "likewise")]
    pub(super) passages: Vec<Box<Passage>>,
    /// For what is over before any go on.
    pub(super) lighting: Option<Box<Lighting>>,
    pub(super) doubt: Vec<u64>,
    /// For each object that is listed with its bounds.
    pub(super) parts: Vec<u32>,
    /// For the way through a tree.
    pub(super) ahead: Vec<usize>,
    pub(super) inverse: Vectors,
    /// How much light each camera ray under way lacks at most, as it has cost as many rays as it may.
    pub(super) missing: Vec<f64>,
    /// Whether any lacks some.
    pub(super) any_missing: bool,
}

/// Rays from the viewer.
#[derive(Default)]
pub(super) struct Primary {
    pub group: Group,
    pub seen: Vectors,
    /// Of pixels.
    pub colours: Vectors,
}

/// The rays of a packet that meet the same object, while they are followed.
#[derive(Default)]
pub(super) struct Level {
    pub found: Found,
    pub parts: Parts,
    pub part: Group,
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    pub shading: Shading,
    pub seen: Vectors,
}

/// Room for so many elements. What is in them is left from before.
#[inline(always)]
pub(super) fn room<T: Copy + Default>(array: &mut Vec<T>, count: usize) -> &mut [T] {
    if array.len() < count {
        // All but narrow packets have room for the widest one, which `pick` makes use of.
        array.resize(if count > NARROW { count.max(WIDE) } else { count }, T::default());
    }
    &mut array[..count]
}

/// Lists the lanes that are not 0.
pub(super) fn list<'l>(of: &[u64], lanes: &'l mut Vec<u8>) -> &'l [u8] {
    let (lanes, mut len) = (room(lanes, of.len()), 0);
    for (lane, is_one) in of.iter().enumerate() {
        lanes[len] = lane as u8;
        len += usize::from(*is_one != 0);
    }
    &lanes[..len]
}

/// Puts some elements of an array into another one, the last of them repeated to make so many; none of one that is
/// empty. Lanes rise.
pub(super) fn pick<T: Copy + Default>(to: &mut Vec<T>, from: &[T], lanes: &[u8], count: usize) {
    if from.is_empty() {
        to.clear();
        return;
    }
    let to = room(to, count);
    let Some(last) = lanes.last().map(|last| usize::from(*last)) else { return };
    let (picked, rest) = to.split_at_mut(lanes.len());
    if are_first(lanes) {
        picked.copy_from_slice(&from[..=last]);
    } else if let Some(from) = from.first_chunk::<WIDE>() {
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
