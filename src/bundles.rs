//! Which boxes the rays of a packet may come into, for each part of it: the rays of a part are nearer each other than
//! all of them, and so come near fewer objects.

use crate::bounds::{Bounds, SLACK, larger, range, smaller};
use crate::cpu::{Cpu, kernels};
use crate::packet::{Rays, WIDE};
use glam::DVec3;

/// The most rays of a part.
pub const PART: usize = 64;

/// The most parts of a packet; they are looked at together.
const PARTS: usize = WIDE / PART;

/// A number for each part.
type Each = [f64; PARTS];

/// Everywhere that the rays of each part of a packet may go, by axes.
pub struct Bundles {
    /// A bit for each part that has rays.
    parts: u32,
    /// The least and the greatest coordinates of where they start.
    low: [Each; 3],
    high: [Each; 3],
    /// What a way up to a box takes at least for each of its length, and a way down.
    up: [Each; 3],
    down: [Each; 3],
    /// What a way out of it takes at most; NaN where a ray need not ever come out.
    out_up: [Each; 3],
    out_down: [Each; 3],
    /// How far they start from the world's origin.
    reach: f64,
}

impl Bundles {
    /// Nowhere.
    const NONE: Self = Self {
        parts: 0,
        low: [[0.0; PARTS]; 3],
        high: [[0.0; PARTS]; 3],
        up: [[0.0; PARTS]; 3],
        down: [[0.0; PARTS]; 3],
        out_up: [[f64::NAN; PARTS]; 3],
        out_down: [[f64::NAN; PARTS]; 3],
        reach: 0.0,
    };

    /// Where the rays of a packet may go.
    pub fn around(cpu: Cpu, rays: Rays) -> Self {
        around(cpu, rays)
    }

    /// The parts of which a ray may come somewhere, of whose ways that is asked; a bit for each.
    pub fn that(&self, may: impl Fn(&Bounds) -> bool) -> u32 {
        let parts = 0..u32::BITS - self.parts.leading_zeros();
        parts.map(|part| u32::from(may(&self.ways(part as usize))) << part).sum()
    }

    /// Everywhere that the rays of a part may go; mostly without an end.
    fn ways(&self, part: usize) -> Bounds {
        let low = |axis: usize| {
            if self.down[axis][part] == f64::NEG_INFINITY { self.low[axis][part] } else { f64::NEG_INFINITY }
        };
        let high = |axis: usize| {
            if self.up[axis][part] == f64::INFINITY { self.high[axis][part] } else { f64::INFINITY }
        };
        Bounds { low: DVec3::new(low(0), low(1), low(2)), high: DVec3::new(high(0), high(1), high(2)) }
    }

    /// The parts of which a ray may come into each of some boxes, likewise. Never wrong where it says no.
    pub fn meet(&self, cpu: Cpu, boxes: &[(usize, Bounds)], parts: &mut [u32]) {
        meet(cpu, self, boxes, parts);
    }
}

kernels! {
    fn around(rays: Rays) -> Bundles {
        let (mut bundles, count) = (Bundles::NONE, rays.len());
        let (mut least, mut greatest) = ([[0.0; PARTS]; 3], [[0.0; PARTS]; 3]);
        for (part, start) in (0..count).step_by(PART).enumerate() {
            let some = rays.part(start..count.min(start + PART));
            let (origin, dir) = (some.origin, some.dir);
            for (axis, (from, to)) in [(origin.x, dir.x), (origin.y, dir.y), (origin.z, dir.z)].into_iter().enumerate() {
                (bundles.low[axis][part], bundles.high[axis][part]) = range(from);
                (least[axis][part], greatest[axis][part]) = range(to);
            }
            bundles.parts |= 1 << part;
        }
        for axis in 0..3 {
            for part in 0..PARTS {
                let (least, greatest) = (least[axis][part], greatest[axis][part]);
                let (down, up) = (1.0 / least, 1.0 / greatest);
                // No box is ever reached by a way that leads away from it.
                bundles.up[axis][part] = if greatest > 0.0 { smaller(up, f64::MAX) } else { f64::INFINITY };
                bundles.down[axis][part] = if least < 0.0 { larger(down, f64::MIN) } else { f64::NEG_INFINITY };
                bundles.out_up[axis][part] = if greatest < 0.0 { up } else { f64::NAN };
                bundles.out_down[axis][part] = if least > 0.0 { down } else { f64::NAN };
            }
            for part in 0..PARTS {
                let farthest = larger(bundles.low[axis][part].abs(), bundles.high[axis][part].abs());
                bundles.reach = larger(farthest, bundles.reach);
            }
        }
        bundles
    }

    fn meet(bundles: &Bundles, boxes: &[(usize, Bounds)], parts: &mut [u32]) {
        for ((_, bounds), parts) in boxes.iter().zip(parts) {
            let bounds = bounds.with_slack(bundles.reach);
            let (mut enters, mut leaves) = ([0.0; PARTS], [f64::INFINITY; PARTS]);
            for axis in 0..3 {
                let (low, high) = (bounds.low[axis], bounds.high[axis]);
                for part in 0..PARTS {
                    // How far the way is to the box's near and far walls, from where it is shortest and longest.
                    let (up, down) = (low - bundles.high[axis][part], high - bundles.low[axis][part]);
                    enters[part] = larger(up * bundles.up[axis][part], enters[part]);
                    enters[part] = larger(down * bundles.down[axis][part], enters[part]);
                    leaves[part] = smaller(down * bundles.out_down[axis][part], leaves[part]);
                    leaves[part] = smaller(up * bundles.out_up[axis][part], leaves[part]);
                }
            }
            *parts = 0;
            for part in 0..PARTS {
                let may = (enters[part] <= leaves[part] * (1.0 + SLACK)) & (enters[part] < f64::INFINITY);
                *parts |= u32::from(may) << part;
            }
            *parts &= bundles.parts;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::{STEP, Vectors};
    use proptest::prelude::*;

    /// A number as those in scenes are, 0 among them.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), Just(-0.0), -10.0..10.0, -1e6..1e6]
    }

    fn vector() -> impl Strategy<Value = DVec3> {
        (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    /// Rays from places to others, copies of the last one behind them.
    fn rays(ways: &[(DVec3, DVec3)]) -> (Vectors<WIDE>, Vectors<WIDE>, usize) {
        let (mut origins, mut dirs) = (Vectors::ZERO, Vectors::ZERO);
        let count = ways.len().next_multiple_of(STEP);
        for lane in 0..count {
            let (from, to) = ways[lane.min(ways.len() - 1)];
            origins.set(lane, from);
            dirs.set(lane, (to - from).try_normalize().unwrap_or(DVec3::X));
        }
        (origins, dirs, count)
    }

    proptest! {
        #[test]
        fn a_part_one_of_whose_rays_comes_into_a_box_is_told(
            ways in prop::collection::vec((vector(), vector()), 1..WIDE),
            chosen in any::<prop::sample::Index>(),
            size in (0.0..1.0, 0.0..1.0, 0.0..1.0),
        ) {
            let chosen = chosen.index(ways.len());
            let (from, to) = ways[chosen];
            prop_assume!((to - from).try_normalize().is_some());
            let half = 0.5 * DVec3::from(size);
            let bounds = Bounds { low: to - half, high: to + half };
            let (origins, dirs, count) = rays(&ways);
            for cpu in Cpu::all() {
                let bundles = Bundles::around(cpu, Rays { origin: origins.view(count), dir: dirs.view(count) });
                let (part, mut met) = (1 << (chosen / PART), [0]);
                bundles.meet(cpu, &[(0, bounds)], &mut met);
                prop_assert!(met[0] & part != 0, "{} to {}, {}", from, to, cpu);
                let reached = bundles.that(|ways| ways.with_slack(1e6).overlaps(&bounds));
                prop_assert!(reached & part != 0, "{} to {} on its ways, {}", from, to, cpu);
            }
        }
    }

    #[test]
    fn parts_that_go_elsewhere_are_left_out() {
        // The first part goes up, the second one down, and there are no others.
        let ways: Vec<_> = (0..2 * PART)
            .map(|lane| {
                let from = DVec3::new(0.01 * lane as f64, 0.0, 0.0);
                (from, from + if lane < PART { DVec3::Y } else { DVec3::NEG_Y } + 0.001 * from)
            })
            .collect();
        let (origins, dirs, count) = rays(&ways);
        for cpu in Cpu::all() {
            let bundles = Bundles::around(cpu, Rays { origin: origins.view(count), dir: dirs.view(count) });
            let at = |x: f64, y: f64| Bounds {
                low: DVec3::new(x, y, -1.0),
                high: DVec3::new(x + 2.0, y + 1.0, 1.0),
            };
            let (boxes, mut met) = ([at(0.0, 5.0), at(0.0, -5.0), at(0.0, -0.5), at(9.0, 5.0)], [9; 4]);
            bundles.meet(cpu, &boxes.map(|bounds| (0, bounds)), &mut met);
            assert_eq!(met, [0b01, 0b10, 0b11, 0]);
            assert_eq!(bundles.that(|ways| ways.high.y == f64::INFINITY), 0b01);
            assert_eq!(bundles.that(|ways| ways.high.y > -0.5), 0b11);
        }
    }
}
