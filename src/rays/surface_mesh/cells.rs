//! The cells that a surface may cross: those of a cube that is repeatedly halved along each axis.

use super::Done;
use glam::DVec3;
use tabray_core::geometry::Aabb;
use tabray_core::parallel;

/// The size of the cube, in sizes of the body.
const ROOM: f64 = 1.07;

/// The offset of the cube's middle from the body's, in half sizes of the body. Faces and axes of bodies run along
/// planes of round numbers, where corners of cells would be neither inside nor outside.
const BESIDE: DVec3 = DVec3::new(0.011_735, 0.017_291, 0.013_377);

/// The minimum number of cells for which threads share the work.
const MANY: usize = 64;

/// A cell, or its low corner: the indices along the axes.
pub type Index = [u32; 3];

/// Returns the corner or the part of an index, of eight.
pub fn of_eight(at: Index, part: u32) -> Index {
    [at[0] + (part & 1), at[1] + (part >> 1 & 1), at[2] + (part >> 2)]
}

/// Returns indices as a point.
pub fn point(at: Index) -> DVec3 {
    DVec3::from(at.map(f64::from))
}

/// The cells.
pub struct Cells {
    low: DVec3,
    size: f64,
    halvings: u32,
    /// Their indices along the axes, sorted by their [keys](key).
    pub list: Vec<Index>,
}

/// Returns a key for a cell or a corner.
pub fn key([x, y, z]: Index) -> u64 {
    (u64::from(z) << 40) | (u64::from(y) << 20) | u64::from(x)
}

impl Cells {
    /// Makes one cell around a box.
    pub fn enclosing(bounds: &Aabb) -> Self {
        let half = bounds.half_size().max_element();
        let middle = bounds.middle() + half * BESIDE;
        let size = 2.0 * ROOM * half;
        Self { low: middle - size / 2.0, size, halvings: 0, list: vec![[0; 3]] }
    }

    /// Enlarges the cube, which has not been halved, so that the diagonal of a cell is this long after some number of
    /// halvings. Returns that number.
    pub fn fit(&mut self, diagonal: f64) -> u32 {
        let halvings = self.halvings_to(diagonal);
        let middle = self.low + self.size / 2.0;
        self.size = libm::scalbn(diagonal / 3f64.sqrt(), halvings as i32);
        self.low = middle - self.size / 2.0;
        halvings
    }

    /// Returns the number of times that the cube was halved.
    pub fn halvings(&self) -> u32 {
        self.halvings
    }

    /// Returns the number of halvings of the cube after which a cell's diagonal is at most this long.
    pub fn halvings_to(&self, diagonal: f64) -> u32 {
        let mut halvings = 0;
        while libm::scalbn(self.size, -halvings) * 3f64.sqrt() > diagonal && halvings < 64 {
            halvings += 1;
        }
        halvings as u32
    }

    /// Returns the side of a cell.
    pub fn side(&self) -> f64 {
        libm::scalbn(self.size, -(self.halvings as i32))
    }

    /// Returns the diagonal of a cell.
    pub fn diagonal(&self) -> f64 {
        3f64.sqrt() * self.side()
    }

    /// Returns the position of a corner.
    pub fn corner(&self, at: Index) -> DVec3 {
        self.low + self.side() * point(at)
    }

    /// Returns the middle of a cell.
    pub fn middle(&self, cell: Index) -> DVec3 {
        self.low + self.side() * (point(cell) + 0.5)
    }

    /// Returns the low and the high corner of a cell, given by its place in the list.
    pub fn cube(&self, cell: usize) -> [DVec3; 2] {
        let (middle, half) = (self.middle(self.list[cell]), self.side() / 2.0);
        [middle - half, middle + half]
    }

    /// Returns the places in the list of a cell and of those around it.
    pub fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        let at = self.list[cell];
        (0..27).filter_map(move |part| {
            // A cell below the first one has a number that no cell has.
            let by = [part % 3, part / 3 % 3, part / 9];
            let other = [0, 1, 2].map(|axis| (at[axis] + by[axis]).wrapping_sub(1));
            if other.contains(&u32::MAX) { None } else { self.find(other) }
        })
    }

    /// Returns the place of a cell in the list.
    pub fn find(&self, cell: Index) -> Option<usize> {
        self.list.binary_search_by_key(&key(cell), |known| key(*known)).ok()
    }

    /// Cuts each cell into eight, and keeps those that the surface may cross, as told by a function of the middle of a
    /// cell and half of its side.
    ///
    /// # Errors
    /// If these are more than `most`; the cells then stay as they are.
    pub fn halve(
        &mut self,
        may_be_crossed: &(dyn Fn(DVec3, f64) -> bool + Sync),
        most: usize,
        done: Done,
    ) -> Result<(), ()> {
        let half = self.side() / 4.0;
        let low = self.low;
        let halves = |cell: Index| (0..8).map(move |part| of_eight(cell.map(|index| 2 * index), part));
        let is_kept = |cell: &Index| may_be_crossed(low + 2.0 * half * (point(*cell) + 0.5), half);
        let mut list = parallel::map_ranges(self.list.len(), MANY, &|range| {
            done(range.len());
            self.list[range].iter().flat_map(|cell| halves(*cell)).filter(is_kept).collect()
        });
        if list.len() > most {
            return Err(());
        }
        list.sort_unstable_by_key(|cell| key(*cell));
        self.list = list;
        self.halvings += 1;
        Ok(())
    }
}
