//! Meshes for packets of rays.

use super::known::Known;
use super::memo::Memo;
use super::search::Aims;
use super::shape::Mesh;
use crate::triangle::{crossings, unit_normals};
use tabray_world::accuracy::NotClassic;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use tabray_world::geometry::ray_packet::{self, PACKET_SIZE, RayPacket, SurfaceInteraction, turned};
use tabray_world::packets::shape::PacketIntersect;
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::{LANES, Vectors};

impl<A: NotClassic> PacketIntersect for Mesh<A> {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        near.fill(MISS);
        far.fill(MISS);
        let (mesh, side, ends, drift) = (self, rays.side(0), &ends[..near.len()], rays.drift);
        if side.is_some() && !mesh.can_hit_itself {
            return;
        }
        let aims = Aims { leaving: mesh.leaving(side, rays.origin_error), drift, is_any: false };
        Memo::with(|memo| {
            mesh.search(cpu, rays, ends, aims, |lane, known, crossing| {
                let bracket = if drift.is_none() {
                    let (ray, range) = (rays.get(lane), RayRange { far: ends[lane], ..RayRange::ALL });
                    let (bracket, face) =
                        mesh.surface.bracketed::<A>(known, crossing, &ray, &range, aims.leaving);
                    if let Some(face) = face {
                        memo.note(mesh.surface.id, &ray, bracket.near, face);
                    }
                    bracket
                } else {
                    known.within(crossing)
                };
                (near[lane], far[lane]) = (bracket.near, bracket.far);
            });
        });
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let count = t_max.len();
        let mesh = &self;
        let side = rays.side(0);
        if side.is_none() || mesh.can_hit_itself {
            let aims =
                Aims { leaving: mesh.leaving(side, rays.origin_error), drift: RayError::NONE, is_any: true };
            let mut ends = [0.0; PACKET_SIZE];
            for lane in 0..count {
                ends[lane] = if blocked[lane] == 0 { t_max[lane] } else { 0.0 };
            }
            mesh.surface.search(cpu, rays, &ends[..count], aims, |first, found| {
                for lane in (first..first + LANES).filter(|lane| ends[*lane] > 0.0) {
                    let known =
                        found.get(lane - first).known(&rays.get(lane), t_max[lane], aims.leaving, true);
                    let (Known::Face { bracket, .. } | Known::Bracket(bracket)) = known;
                    (near[lane], far[lane]) = (bracket.near, bracket.far);
                }
            });
        }
        ray_packet::occluded_by_brackets(cpu, &near[..count], &far[..count], t_max, blocked, doubt)
    }

    fn refine(&self, _cpu: Cpu, rays: RayPacket, (near, far): (&[f64], &[f64]), out: &mut [f64]) {
        let mesh = &self;
        for lane in 0..out.len() {
            let leaving = mesh.leaving(rays.side(lane), rays.origin_error);
            let bracket = Bracket { near: near[lane], far: far[lane] };
            out[lane] = match bracket.near == bracket.far {
                true => bracket.near,
                false => mesh.surface.refined::<A>(&rays.get(lane), &RayRange::ALL, leaving, bracket),
            };
        }
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let SurfaceInteraction { points, normals, geometric_normals, sides, cosines, travelled } =
            interaction;
        Memo::with(|memo| {
            interact(
                cpu,
                self,
                rays,
                distances,
                memo,
                sides,
                cosines,
                travelled,
                points,
                normals,
                geometric_normals,
            );
        });
    }

    fn finds_normals_by_rays(&self) -> bool {
        true
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if ray.is_single() {
            self.bracket(Cpu::best(), ray, range).0
        } else {
            self.surface.bracket_within::<A>(Cpu::best(), ray, range)
        }
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        let (leaving, range) = (self.leaving(origin_side, 0.0), RayRange { origin_side, ..RayRange::ALL });
        match self.surface.first(Cpu::best(), ray, &range, leaving, RayError::NONE, false) {
            Known::Face { face, .. } => self.surface.plane::<A>(face).quick_crossing(ray),
            Known::Bracket(_) => f64::NAN,
        }
    }
}

impl<A: NotClassic> Mesh<A> {
    /// Searches for the first hits of a packet's rays before their ends. Calls a function for each ray with an end
    /// beyond 0, with its lane, the result and, if that is a face, the distance of its plane.
    #[inline(always)]
    fn search(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        ends: &[f64],
        aims: Aims,
        mut each: impl FnMut(usize, Known, f64),
    ) {
        self.surface.search(cpu, rays, ends, aims, |first, found| {
            let eight = first..first + LANES;
            let (mut known, mut some) = ([Known::Bracket(Bracket::MISS); LANES], None);
            for lane in 0..LANES {
                let (ray, end) = (rays.get(first + lane), ends[first + lane]);
                known[lane] = found.get(lane).known(&ray, end, aims.leaving, false);
                some = some.or(known[lane].face());
            }
            let mut distances = [f64::NAN; LANES];
            if let Some(some) = some {
                let mut faces = [some; LANES];
                for lane in 0..LANES {
                    faces[lane] = known[lane].face().unwrap_or(some);
                }
                cross(cpu, self, &faces, rays.part(eight.clone()), &mut distances);
            }
            for lane in eight.filter(|lane| ends[*lane] > 0.0) {
                each(lane, known[lane - first], distances[lane - first]);
            }
        });
    }
}

/// Tells whether a ray of a packet equals the previous one. Packets are padded with copies of the last ray.
#[inline(always)]
fn is_copy(rays: &RayPacket, lane: usize) -> bool {
    lane > 0 && {
        let (one, other) = (rays.get(lane), rays.get(lane - 1));
        one.dir == other.dir && one.origin == other.origin
    }
}

kernels! {
    /// Computes the distances of the planes of eight faces, each along its own ray, or NaN if `f64` arithmetic is not
    /// enough.
    fn cross[A: NotClassic](mesh: &Mesh<A>, faces: &[usize; LANES], rays: RayPacket, distances: &mut [f64; LANES]) {
        crossings::<A>(&mesh.surface.corners_of(faces), rays, distances);
    }

    /// Computes the hit points, normals and sides at these distances, in world units.
    fn interact[A: NotClassic](
        mesh: &Mesh<A>, rays: RayPacket, distances: &[f64], memo: &mut Memo, sides: &mut [Side],
        cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals, geometric_normals {
        let (is_two_sided, is_smooth, surface) = (mesh.is_two_sided(), mesh.surface.is_smooth(), &mesh.surface);
        let mut known = ([usize::MAX; LANES], Vectors::ZERO);
        for first in (0..travelled.len()).step_by(LANES) {
            let mut faces = [usize::MAX; LANES];
            for lane in first..first + LANES {
                let (ray, distance) = (rays.get(lane), distances[lane]);
                faces[lane - first] = if is_copy(&rays, lane) && distance == distances[lane - 1] && lane > first {
                    faces[lane - first - 1]
                } else {
                    memo.face(surface.id, &ray, distance).unwrap_or_else(|| surface.face_along(&ray, distance))
                };
            }
            // Neighbouring rays often hit the same faces, and normals need many digits.
            if known.0 != faces {
                known = (faces, unit_normals(&surface.corners_of(&faces)));
            }
            for lane in first..first + LANES {
                let (ray, place) = (rays.get(lane), lane - first);
                let point = ray.at(distances[lane]);
                let turn;
                (sides[lane], cosines[lane], turn) = turned(ray.dir, known.1.get(place), is_two_sided);
                points.set(lane, point);
                normals.set(lane, surface.smoothed(faces[place], point, turn));
                if is_smooth {
                    geometric_normals.set(lane, turn);
                }
                travelled[lane] += distances[lane];
            }
        }
    }
}
