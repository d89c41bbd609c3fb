//! Vectors by the dozen, an array for each coordinate, so that a processor takes several at a time.

use glam::DVec3;
use std::ops::Range;

/// Arrays are as long as a multiple of this.
pub const LANES: usize = 8;

/// Vectors, an array for each coordinate.
#[derive(Clone)]
pub struct Vectors<const N: usize> {
    /// The first coordinates, or red.
    pub x: [f64; N],
    /// The second, or green.
    pub y: [f64; N],
    /// The third, or blue.
    pub z: [f64; N],
}

impl<const N: usize> Vectors<N> {
    /// All of them 0.
    pub const ZERO: Self = Self { x: [0.0; N], y: [0.0; N], z: [0.0; N] };

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

    /// The first of them, so many.
    #[inline(always)]
    pub fn view(&self, count: usize) -> View<'_> {
        View { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Likewise, to be written.
    #[inline(always)]
    pub fn view_mut(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[..count], y: &mut self.y[..count], z: &mut self.z[..count] }
    }
}

/// Some vectors of an array.
#[derive(Clone, Copy)]
pub struct View<'v> {
    /// The first coordinates.
    pub x: &'v [f64],
    /// The second.
    pub y: &'v [f64],
    /// The third.
    pub z: &'v [f64],
}

impl View<'_> {
    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// The one of this index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// The first of them, so many.
    #[inline(always)]
    pub fn first(&self, count: usize) -> Self {
        Self { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Some of them.
    #[inline(always)]
    pub fn part(&self, Range { start, end }: Range<usize>) -> Self {
        Self { x: &self.x[start..end], y: &self.y[start..end], z: &self.z[start..end] }
    }
}

/// Some vectors of an array, to be written.
pub struct ViewMut<'v> {
    /// The first coordinates.
    pub x: &'v mut [f64],
    /// The second.
    pub y: &'v mut [f64],
    /// The third.
    pub z: &'v mut [f64],
}

impl ViewMut<'_> {
    /// Some of them.
    #[inline(always)]
    pub fn part(&mut self, Range { start, end }: Range<usize>) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[start..end], y: &mut self.y[start..end], z: &mut self.z[start..end] }
    }

    /// The first of them, so many.
    #[inline(always)]
    pub fn first(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[..count], y: &mut self.y[..count], z: &mut self.z[..count] }
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

    /// Puts some in their places from this one on.
    pub fn copy_at(&mut self, first: usize, vectors: View) {
        let end = first + vectors.len();
        self.x[first..end].copy_from_slice(vectors.x);
        self.y[first..end].copy_from_slice(vectors.y);
        self.z[first..end].copy_from_slice(vectors.z);
    }
}
