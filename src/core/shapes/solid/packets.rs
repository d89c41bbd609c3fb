//! Packets of rays that may hit a part of a solid.

use super::trimmed::{ByParts, Trimmed};
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::ray_packet::{self, Nearest, PACKET_SIZE, RayPacket};
use crate::simd::cpu::Cpu;
use crate::world::hittable::Hittable;
use crate::world::interaction::SurfaceInteraction;
use crate::world::packets::shape::{self, Packets};
use crate::world::shape::{ByPackets, Shape};

impl Trimmed {
    /// Computes brackets of first hits before `ends`, for those rays of a packet that may hit the part at all.
    fn brackets(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        ends: &[f64],
        (near, far): (&mut [f64], &mut [f64]),
    ) {
        let count = near.len();
        let (mut met, mut doubt) = ([0; PACKET_SIZE], [0; PACKET_SIZE]);
        near.copy_from_slice(&ends[..count]);
        far.copy_from_slice(&ends[..count]);
        let own = self.sides(sides);
        let (met, doubt) = (&mut met[..count], &mut doubt[..count]);
        let nearest = Nearest { near: &mut *near, far: &mut *far, met: &mut *met, doubt: &mut *doubt };
        self.own().closest_hits(cpu, rays, own.as_ref().map(|sides| &sides[..count]), 1, nearest);
        for lane in 0..count {
            let bracket = if met[lane] == 0 && doubt[lane] == 0 {
                Bracket::MISS
            } else {
                let origin_side = sides.map(|sides| sides[lane]);
                let range =
                    RayRange { near: 0.0, far: ends[lane], origin_side, origin_error: rays.origin_error };
                let is_known = met[lane] != 0 && doubt[lane] == 0 && near[lane] == far[lane];
                self.t_bounds_from(&rays.get(lane), &range, is_known.then_some(near[lane]))
            };
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }

    /// Returns sides of the solid as sides of the part.
    fn sides(&self, of: Option<&[Side]>) -> Option<[Side; PACKET_SIZE]> {
        of.map(|of| {
            let mut own = [Side::Outside; PACKET_SIZE];
            own.iter_mut().zip(of).for_each(|(own, side)| *own = self.side(*side));
            own
        })
    }
}

impl Packets for Shape<Trimmed, ByPackets, ByParts> {
    fn closest_hits(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        id: u64,
        nearest: Nearest,
    ) -> bool {
        let count = rays.len();
        if self.shape.is_whole() {
            let own = self.shape.sides(sides);
            return self.shape.own().closest_hits(
                cpu,
                rays,
                own.as_ref().map(|own| &own[..count]),
                id,
                nearest,
            );
        }
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let (near, far) = (&mut near[..count], &mut far[..count]);
        self.shape.brackets(cpu, rays, sides, nearest.far, (&mut *near, &mut *far));
        ray_packet::closest_of_brackets(cpu, near, far, id, nearest)
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let count = t_max.len();
        if self.shape.is_whole() {
            let own = self.shape.sides(sides);
            let (own, packets) = (own.as_ref().map(|own| &own[..count]), self.shape.own().packets());
            return packets.occluded(cpu, rays, own, t_max, blocked, doubt);
        }
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let (near, far) = (&mut near[..count], &mut far[..count]);
        self.shape.brackets(cpu, rays.first(count), sides, t_max, (&mut *near, &mut *far));
        ray_packet::occluded_by_brackets(cpu, near, far, t_max, blocked, doubt)
    }

    fn refine(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        if self.shape.is_whole() {
            let own = self.shape.sides(sides);
            let own = own.as_ref().map(|own| &own[..out.len()]);
            self.shape.own().packets().refine(cpu, rays, own, brackets, out);
            return;
        }
        for lane in 0..out.len() {
            out[lane] = self.refine_one(&rays.get(lane), sides.map(|sides| sides[lane]));
        }
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let own = self.shape.own().packets();
        if !self.shape.is_outer && !own.finds_normals_by_rays() {
            return own.interact(cpu, rays, distances, interaction);
        }
        shape::interact_each(cpu, &self.shape, rays, distances, interaction);
    }

    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.shape.t_bounds(ray, range)
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}
