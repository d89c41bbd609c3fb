//! Items in bins along an axis, and the cheapest cut between two bins by the surface area heuristic.

use crate::geometry::aabb::{Aabb, smaller};
use crate::geometry::bvh::node::finite;
use crate::simd::cpu::kernels;
use tabray_exact::scalar::per_axis;

/// The number of bins along an axis. A set of objects is split between two bins.
pub const BINS: usize = 16;

/// The low corner of a box, and the negative of the high corner. With this sign, a minimum joins two boxes.
pub type Limits = [f64; 6];

/// The limits of an empty box.
pub const NOTHING: Limits = [f64::INFINITY; 6];

/// Returns the joint limits of two boxes.
#[inline(always)]
pub fn join(one: &Limits, other: &Limits) -> Limits {
    let mut both = *one;
    for side in 0..6 {
        both[side] = smaller(one[side], other[side]);
    }
    both
}

/// Returns half the surface area of a box, in square world units, or infinity if it is NaN.
#[inline(always)]
pub fn half_area([a, b, c, d, e, f]: Limits) -> f64 {
    let (x, y, z) = (-d - a, -e - b, -f - c);
    let area = x * y + y * z + z * x;
    if area.is_nan() { f64::INFINITY } else { area }
}

/// An object for a tree.
#[derive(Clone, Default)]
pub struct Item {
    /// The limits of its box, in world units.
    pub limits: Limits,
    /// Its index among the objects.
    pub index: u32,
}

impl Item {
    /// Makes the item of the object with this index, with finite limits.
    pub fn new(index: usize, bounds: &Aabb) -> Self {
        let Aabb { low, high } = finite(bounds);
        Self { limits: [low.x, low.y, low.z, -high.x, -high.y, -high.z], index: index as u32 }
    }

    /// Returns twice the center of the box along an axis.
    #[inline(always)]
    pub fn center(&self, axis: usize) -> f64 {
        self.limits[axis] - self.limits[axis + 3]
    }

    /// Returns twice the center of the box as limits.
    #[inline(always)]
    pub fn centers(&self) -> Limits {
        let [x, y, z] = per_axis(|axis| self.center(axis));
        [x, y, z, -x, -y, -z]
    }
}

/// The items with centers in a bin.
#[derive(Clone, Copy)]
pub struct Bin {
    /// The number of items.
    pub count: u32,
    /// The joint limits of their boxes, in world units.
    pub limits: Limits,
    /// The limits of twice their centers, in world units.
    pub centers: Limits,
}

impl Bin {
    /// An empty bin.
    pub const EMPTY: Self = Self { count: 0, limits: NOTHING, centers: NOTHING };

    /// Returns the items of two bins.
    #[inline(always)]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            limits: join(&self.limits, &other.limits),
            centers: join(&self.centers, &other.centers),
        }
    }
}

/// The bins along an axis.
#[derive(Clone, Copy)]
pub struct Grid {
    /// The axis: 0, 1 or 2.
    pub axis: usize,
    /// The start of the first bin, in twice the coordinates.
    pub low: f64,
    /// The number of bins per unit of twice the coordinates.
    pub scale: f64,
}

impl Grid {
    /// Returns the bin of an item's center.
    #[inline(always)]
    fn bin(self, item: &Item) -> usize {
        (self.place(item) as u8).min(BINS as u8 - 1) as usize
    }

    /// Returns the position of an item's center, in bins.
    #[inline(always)]
    pub fn place(self, item: &Item) -> f64 {
        (item.center(self.axis) - self.low) * self.scale
    }
}

kernels! {
    /// Puts items into bins.
    pub fn binned(items: &[Item], grid: Grid) -> [Bin; BINS] {
        let mut bins = [Bin::EMPTY; BINS];
        for item in items {
            let bin = &mut bins[grid.bin(item)];
            bin.count += 1;
            bin.limits = join(&bin.limits, &item.limits);
            bin.centers = join(&bin.centers, &item.centers());
        }
        bins
    }

    /// Returns the cheapest cut between two bins, with the objects on each side of it, or `None` if no cost is finite.
    pub fn best_cut(bins: &[Bin; BINS]) -> Option<(usize, [Bin; 2])> {
        // The probability that a ray enters a box is proportional to its surface area.
        let cost = |(count, limits): (u32, Limits)| f64::from(count) * half_area(limits);
        let both = |(count, limits): (u32, Limits), bin: &Bin| (count + bin.count, join(&limits, &bin.limits));
        let (mut above, mut costs) = ((0, NOTHING), [f64::INFINITY; BINS]);
        for cut in (1..BINS).rev() {
            above = both(above, &bins[cut]);
            if above.0 > 0 {
                costs[cut] = cost(above);
            }
        }
        let (mut below, mut best) = ((0, NOTHING), (f64::INFINITY, 0));
        for cut in 1..BINS {
            below = both(below, &bins[cut - 1]);
            let cost = if below.0 > 0 { cost(below) + costs[cut] } else { f64::INFINITY };
            if cost < best.0 {
                best = (cost, cut);
            }
        }
        let (least, cut) = best;
        let side = |bins: &[Bin]| bins.iter().fold(Bin::EMPTY, |all, bin| all.and(bin));
        (least < f64::INFINITY).then(|| (cut, [side(&bins[..cut]), side(&bins[cut..])]))
    }
}
