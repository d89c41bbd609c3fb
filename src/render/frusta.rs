//! Tests of boxes against the sub-packets of a packet: the rays of a sub-packet lie closer together than those of the
//! whole packet, and so may hit fewer objects.

use glam::DVec3;
use tabray_world::geometry::aabb::{Aabb, SLACK, larger, range, smaller};
use tabray_world::geometry::ray_packet::{PACKET_SIZE, RayPacket, split};
use tabray_world::simd::cpu::kernels;

/// The maximum number of rays of a sub-packet.
pub const PART: usize = 64;

/// The maximum number of sub-packets of a packet, which are tested together.
const PARTS: usize = PACKET_SIZE / PART;

/// A number for each sub-packet.
type Each = [f64; PARTS];

/// Bounds of the rays of each sub-packet of a packet, by axis.
pub struct Frusta {
    /// A bit for each sub-packet that has rays, the first one lowest.
    parts: u32,
    /// The least coordinates of the origins, in world units.
    low: [Each; 3],
    /// The greatest coordinates of the origins, in world units.
    high: [Each; 3],
    /// The least distance along any ray over which its coordinate rises by 1; infinite where no ray rises.
    rises: [Each; 3],
    /// The negative of the least distance along any ray over which its coordinate falls by 1; negative infinity where
    /// no ray falls.
    falls: [Each; 3],
    /// The greatest distance along any ray over which its coordinate rises by 1; NaN unless all rays rise.
    rises_at_most: [Each; 3],
    /// The negative of the greatest distance along any ray over which its coordinate falls by 1; NaN unless all rays
    /// fall.
    falls_at_most: [Each; 3],
    /// The largest magnitude of the origins' coordinates, in world units.
    reach: f64,
}

impl Frusta {
    /// The frusta of no rays.
    const NONE: Self = Self {
        parts: 0,
        low: [[0.0; PARTS]; 3],
        high: [[0.0; PARTS]; 3],
        rises: [[0.0; PARTS]; 3],
        falls: [[0.0; PARTS]; 3],
        rises_at_most: [[0.0; PARTS]; 3],
        falls_at_most: [[0.0; PARTS]; 3],
        reach: 0.0,
    };

    /// Returns a bit for each sub-packet whose region satisfies a condition.
    pub fn which(&self, matches: impl Fn(&Aabb) -> bool) -> u32 {
        let parts = 0..u32::BITS - self.parts.leading_zeros();
        parts.map(|part| u32::from(matches(&self.region(part as usize))) << part).sum()
    }

    /// Returns the region that the rays of a sub-packet may reach, usually unbounded.
    fn region(&self, part: usize) -> Aabb {
        let (mut low, mut high) = (DVec3::NEG_INFINITY, DVec3::INFINITY);
        for axis in 0..3 {
            if self.falls[axis][part] == f64::NEG_INFINITY {
                low[axis] = self.low[axis][part];
            }
            if self.rises[axis][part] == f64::INFINITY {
                high[axis] = self.high[axis][part];
            }
        }
        Aabb { low, high }
    }
}

kernels! {
    /// Bounds the rays of a packet. `is_from_one` tells that all rays start at one point.
    pub fn around(rays: RayPacket, is_from_one: bool) -> Frusta {
        let (mut frusta, count) = (Frusta::NONE, rays.len());
        let (mut least, mut greatest) = ([[0.0; PARTS]; 3], [[0.0; PARTS]; 3]);
        for (part, lanes) in split(count, PART).enumerate() {
            let RayPacket { origin, dir, .. } = rays.part(lanes);
            let (from, to) = ([origin.x, origin.y, origin.z], [dir.x, dir.y, dir.z]);
            for axis in 0..3 {
                let (from, to) = (if is_from_one { &from[axis][..1] } else { from[axis] }, to[axis]);
                (frusta.low[axis][part], frusta.high[axis][part]) = range(from);
                (least[axis][part], greatest[axis][part]) = range(to);
            }
            frusta.parts |= 1 << part;
        }
        for axis in 0..3 {
            for part in 0..PARTS {
                let (least, greatest) = (least[axis][part], greatest[axis][part]);
                let (down, up) = (1.0 / least, 1.0 / greatest);
                // Infinity stands for a direction that no ray takes, so a reciprocal that overflows is clamped.
                frusta.rises[axis][part] = if greatest > 0.0 { smaller(up, f64::MAX) } else { f64::INFINITY };
                frusta.falls[axis][part] = if least < 0.0 { larger(down, f64::MIN) } else { f64::NEG_INFINITY };
                frusta.rises_at_most[axis][part] = if least > 0.0 { down } else { f64::NAN };
                frusta.falls_at_most[axis][part] = if greatest < 0.0 { up } else { f64::NAN };
            }
            for part in 0..PARTS {
                let farthest = larger(frusta.low[axis][part].abs(), frusta.high[axis][part].abs());
                frusta.reach = larger(farthest, frusta.reach);
            }
        }
        frusta
    }

    /// Tests boxes against the sub-packets. Sets in `parts`, for each box, a bit for each sub-packet with a ray that
    /// may enter the box. Where a bit is 0, no ray of the sub-packet enters the box.
    pub fn meet(frusta: &Frusta, boxes: &[(usize, Aabb)], parts: &mut [u32]) {
        for index in 0..boxes.len() {
            let (bounds, parts) = (boxes[index].1.with_slack(frusta.reach), &mut parts[index]);
            let (mut enters, mut leaves) = ([0.0; PARTS], [f64::INFINITY; PARTS]);
            for axis in 0..3 {
                let (low, high) = (bounds.low[axis], bounds.high[axis]);
                for part in 0..PARTS {
                    // From the origins to the box's slab along the axis: the least rise to its low plane, and the
                    // greatest rise to its high plane.
                    let (up, down) = (low - frusta.high[axis][part], high - frusta.low[axis][part]);
                    enters[part] = larger(up * frusta.rises[axis][part], enters[part]);
                    enters[part] = larger(down * frusta.falls[axis][part], enters[part]);
                    leaves[part] = smaller(down * frusta.rises_at_most[axis][part], leaves[part]);
                    leaves[part] = smaller(up * frusta.falls_at_most[axis][part], leaves[part]);
                }
            }
            *parts = 0;
            for part in 0..PARTS {
                // `SLACK` covers the rounding of the distances; `a_part_one_of_whose_rays_comes_into_a_box_is_told`
                // below tests this.
                let may = (enters[part] <= leaves[part] * (1.0 + SLACK)) & (enters[part] < f64::INFINITY);
                *parts |= u32::from(may) << part;
            }
            *parts &= frusta.parts;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use tabray_world::simd::cpu::Cpu;
    use tabray_world::simd::soa::{LANES, Vectors};

    /// Generates coordinates like those of scenes, 0 among them.
    fn number() -> impl Strategy<Value = f64> {
        // `prop_oneof` would seed a generator of random numbers for each alternative, which takes far longer.
        (0..4, -1.0..1.0).prop_map(|(kind, part)| match kind {
            0 => 0.0,
            1 => -0.0,
            2 => 10.0 * part,
            _ => 1e6 * part,
        })
    }

    fn vector() -> impl Strategy<Value = DVec3> {
        (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    /// Makes rays from points to others, padded with copies of the last ray.
    fn rays(ways: &[(DVec3, DVec3)]) -> (Vectors<PACKET_SIZE>, Vectors<PACKET_SIZE>, usize) {
        let (mut origins, mut dirs) = (Vectors::ZERO, Vectors::ZERO);
        let count = ways.len().next_multiple_of(LANES);
        for lane in 0..count {
            let (from, to) = ways[lane.min(ways.len() - 1)];
            origins.set(lane, from);
            dirs.set(lane, (to - from).try_normalize().unwrap_or(DVec3::X));
        }
        (origins, dirs, count)
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn a_part_one_of_whose_rays_comes_into_a_box_is_told(
            ways in prop::collection::vec((vector(), vector()), 1..PACKET_SIZE),
            chosen in any::<prop::sample::Index>(),
            size in (0.0..1.0, 0.0..1.0, 0.0..1.0),
        ) {
            let chosen = chosen.index(ways.len());
            let (from, to) = ways[chosen];
            prop_assume!((to - from).try_normalize().is_some());
            let half = 0.5 * DVec3::from(size);
            let bounds = Aabb { low: to - half, high: to + half };
            let (origins, dirs, count) = rays(&ways);
            for cpu in Cpu::all() {
                let frusta =
                    around(cpu, RayPacket::new(origins.view(count), dirs.view(count), 0.0), false);
                let (part, mut met) = (1 << (chosen / PART), [0]);
                meet(cpu, &frusta, &[(0, bounds)], &mut met);
                prop_assert!(met[0] & part != 0, "{} to {}, {}", from, to, cpu);
                let reached = frusta.which(|region| region.with_slack(1e6).overlaps(&bounds));
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
            let frusta = around(cpu, RayPacket::new(origins.view(count), dirs.view(count), 0.0), false);
            let at = |x: f64, y: f64| Aabb {
                low: DVec3::new(x, y, -1.0),
                high: DVec3::new(x + 2.0, y + 1.0, 1.0),
            };
            let (boxes, mut met) = ([at(0.0, 5.0), at(0.0, -5.0), at(0.0, -0.5), at(9.0, 5.0)], [9; 4]);
            meet(cpu, &frusta, &boxes.map(|bounds| (0, bounds)), &mut met);
            assert_eq!(met, [0b01, 0b10, 0b11, 0]);
            assert_eq!(frusta.which(|region| region.high.y == f64::INFINITY), 0b01);
            assert_eq!(frusta.which(|region| region.high.y > -0.5), 0b11);
        }
    }
}
