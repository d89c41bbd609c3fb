//! Vectors as structures of arrays: one array per coordinate, so that a processor takes several vectors at a time.

use glam::DVec3;
use std::ops::Range;

/// The number of lanes that kernels take at a time. The lengths of arrays are multiples of it.
pub use tabray_exact::f64x8::LANES;

/// Vectors as one array per coordinate.
#[derive(Clone)]
pub struct Vectors<const N: usize> {
    /// The x coordinates, or red.
    pub x: [f64; N],
    /// The y coordinates, or green.
    pub y: [f64; N],
    /// The z coordinates, or blue.
    pub z: [f64; N],
}

impl<const N: usize> Vectors<N> {
    /// Vectors that are all 0.
    pub const ZERO: Self = Self { x: [0.0; N], y: [0.0; N], z: [0.0; N] };

    /// Makes copies of one vector.
    #[inline(always)]
    pub fn of(vector: DVec3) -> Self {
        Self { x: [vector.x; N], y: [vector.y; N], z: [vector.z; N] }
    }

    /// Returns the vector at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Sets the vector at an index.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: DVec3) {
        (self.x[index], self.y[index], self.z[index]) = (vector.x, vector.y, vector.z);
    }

    /// Returns a view of the first `count` vectors.
    #[inline(always)]
    pub fn view(&self, count: usize) -> View<'_> {
        View { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Returns a mutable view of the first `count` vectors.
    #[inline(always)]
    pub fn view_mut(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[..count], y: &mut self.y[..count], z: &mut self.z[..count] }
    }
}

/// A view of consecutive vectors.
#[derive(Clone, Copy)]
pub struct View<'v> {
    /// The x coordinates.
    pub x: &'v [f64],
    /// The y coordinates.
    pub y: &'v [f64],
    /// The z coordinates.
    pub z: &'v [f64],
}

impl View<'_> {
    /// Returns the number of vectors.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Returns whether there are no vectors.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Returns the vector at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Returns a view of the first `count` vectors.
    #[inline(always)]
    pub fn first(&self, count: usize) -> Self {
        Self { x: &self.x[..count], y: &self.y[..count], z: &self.z[..count] }
    }

    /// Returns a view of the vectors in a range of indices.
    #[inline(always)]
    pub fn part(&self, Range { start, end }: Range<usize>) -> Self {
        Self { x: &self.x[start..end], y: &self.y[start..end], z: &self.z[start..end] }
    }

    /// Adds the vectors to a sum, one after the other.
    #[inline(always)]
    pub fn added_to(&self, sum: DVec3) -> DVec3 {
        let vectors = self.x.iter().zip(self.y).zip(self.z);
        vectors.fold(sum, |sum, ((x, y), z)| sum + DVec3::new(*x, *y, *z))
    }
}

/// A mutable view of consecutive vectors.
pub struct ViewMut<'v> {
    /// The x coordinates.
    pub x: &'v mut [f64],
    /// The y coordinates.
    pub y: &'v mut [f64],
    /// The z coordinates.
    pub z: &'v mut [f64],
}

impl ViewMut<'_> {
    /// Returns a mutable view of the vectors in a range of indices.
    #[inline(always)]
    pub fn part(&mut self, Range { start, end }: Range<usize>) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[start..end], y: &mut self.y[start..end], z: &mut self.z[start..end] }
    }

    /// Returns a mutable view of the first `count` vectors.
    #[inline(always)]
    pub fn first(&mut self, count: usize) -> ViewMut<'_> {
        ViewMut { x: &mut self.x[..count], y: &mut self.y[..count], z: &mut self.z[..count] }
    }

    /// Returns the vector at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Sets the vector at an index.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: DVec3) {
        (self.x[index], self.y[index], self.z[index]) = (vector.x, vector.y, vector.z);
    }

    /// Copies vectors to the indices from `first` on.
    pub fn copy_at(&mut self, first: usize, vectors: View) {
        let end = first + vectors.len();
        self.x[first..end].copy_from_slice(vectors.x);
        self.y[first..end].copy_from_slice(vectors.y);
        self.z[first..end].copy_from_slice(vectors.z);
    }
}
