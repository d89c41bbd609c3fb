//! Packets of rays that may hit a part of a solid.

use super::solid_part::{Known, SolidPart};
use tabray_world::coincidence::close;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::{
    BEAM, HitRecordMut, PACKET_SIZE, RayPacket, SurfaceInteraction, split,
};
use tabray_world::hittable::Hittable;
use tabray_world::packets::brackets;
use tabray_world::packets::shape::{self, PacketIntersect};
use tabray_world::simd::cpu::Cpu;

impl SolidPart {
    /// Calls a function with the rays, with the sides of the solid that they leave converted to sides of the part.
    fn with_own_sides<R>(&self, rays: RayPacket, call: impl FnOnce(RayPacket) -> R) -> R {
        let own = rays.leaving.map(|of| {
            let mut own = [Side::Outside; PACKET_SIZE];
            own.iter_mut().zip(of).for_each(|(own, side)| *own = self.side(*side));
            own
        });
        call(rays.leaving(own.as_ref().map(|own| &own[..rays.len()])))
    }

    /// Computes brackets of the first hits of up to [`BEAM`] rays, which end at `ends`. The hits of the part's shape
    /// are searched together, each between the places where its ray enters and leaves other parts.
    fn brackets_within(&self, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        let (mut ranges, mut firsts) = ([RayRange::ALL; BEAM], [Bracket::MISS; BEAM]);
        let mut within = [Bracket { near: 0.0, far: 0.0 }; BEAM];
        for (lane, end) in ends.iter().enumerate() {
            let ray = rays.get(lane);
            if *end > 0.0 {
                within[lane] = self.within_others(&ray).unwrap_or(within[lane]);
            }
            let far = if *end < MISS { end + close(&ray, *end) } else { MISS };
            ranges[lane] = self.first_range(&rays.range(lane, far), &within[lane]);
        }
        self.own().packets().t_bounds_each(rays, &ranges[..ends.len()], &mut firsts[..ends.len()]);
        for (lane, end) in ends.iter().enumerate() {
            let known = Known { within: Some(within[lane]), first: Some(firsts[lane]) };
            let bracket = self.t_bounds_from(&rays.get(lane).into(), &rays.range(lane, *end), known);
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }
}

impl PacketIntersect for SolidPart {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        let (part, count) = (self, near.len());
        if part.is_within_others() && rays.drift.is_none() {
            for lanes in split(count, BEAM) {
                let brackets = (&mut near[lanes.clone()], &mut far[lanes.clone()]);
                part.brackets_within(rays.part(lanes.clone()), &ends[lanes], brackets);
            }
            return;
        }
        part.with_own_sides(rays, |own| {
            part.own().packets().brackets(cpu, own, ends, (&mut *near, &mut *far))
        });
        if part.is_whole() {
            return;
        }
        // A certain hit has the same distance as for a single ray, to the last bit.
        let mut distances = [f64::NAN; PACKET_SIZE];
        let is_wide = |lane: usize| near[lane] < far[lane] && far[lane] < MISS;
        if rays.drift.is_none() && (0..count).any(is_wide) {
            let mut known = [MISS; PACKET_SIZE];
            for lane in 0..count {
                known[lane] = if is_wide(lane) { far[lane] } else { near[lane] };
            }
            let brackets = (&*near, &known[..count]);
            part.with_own_sides(rays.first(count), |own| {
                part.own().packets().refine(cpu, own, brackets, &mut distances[..count]);
            });
        }
        for lane in 0..count {
            let bracket = Bracket { near: near[lane], far: far[lane] };
            let range = rays.range(lane, ends[lane]);
            let first = if bracket.near == bracket.far { bracket.near } else { distances[lane] };
            let first = (!bracket.is_doubtful() && !first.is_nan()).then_some(Bracket::exactly(first));
            let bracket = if bracket.near < ends[lane] {
                let known = Known { first, within: None };
                part.t_bounds_from(&RayBall { ray: rays.get(lane), drift: rays.drift }, &range, known)
            } else {
                Bracket::MISS
            };
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }

    fn closest_hits(&self, cpu: Cpu, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        if !self.is_whole() {
            return brackets::closest_by_brackets(cpu, rays.len(), id, nearest, |ends, brackets| {
                self.brackets(cpu, rays, ends, brackets);
            });
        }
        self.with_own_sides(rays, |own| self.own().closest_hits(cpu, own, id, nearest))
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        if !self.is_whole() {
            let rays = rays.first(t_max.len());
            return brackets::occluded_by_brackets(cpu, t_max, blocked, doubt, |brackets| {
                self.brackets(cpu, rays, t_max, brackets);
            });
        }
        let own = self.own().packets();
        self.with_own_sides(rays, |rays| own.occluded(cpu, rays, t_max, blocked, doubt))
    }

    fn refine(&self, cpu: Cpu, rays: RayPacket, (near, far): (&[f64], &[f64]), out: &mut [f64]) {
        if self.is_whole() {
            let own = self.own().packets();
            return self.with_own_sides(rays, |rays| own.refine(cpu, rays, (near, far), out));
        }
        for lane in (0..out.len()).filter(|lane| near[*lane] != far[*lane]) {
            out[lane] = self.refine_one(&rays.get(lane), rays.side(lane));
        }
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let own = self.own().packets();
        if !self.is_outer && !own.finds_normals_by_rays() {
            return own.interact(cpu, rays, distances, interaction);
        }
        shape::interact_each(cpu, self, rays, distances, interaction);
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        self.t_bounds(ray, range)
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}
