//! Packets of rays, and their first hits on an object, found as a render finds them.

use tabray_core::geometry::ray::{MISS, Ray};
use tabray_core::geometry::ray_packet::{HitRecordMut, PACKET_SIZE, RayPacket};
use tabray_core::geometry::sight::Sight;
use tabray_core::render::trace;
use tabray_core::simd::cpu::Cpu;
use tabray_core::simd::soa::{LANES, Vectors};
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::sensor::Sensor;

/// Rays that are tested against one object.
pub struct Packet {
    /// The object's index.
    pub object: usize,
    len: usize,
    origin: Vectors<PACKET_SIZE>,
    dir: Vectors<PACKET_SIZE>,
    sights: Vec<Sight>,
}

impl Packet {
    /// Makes as many packets as needed for the rays through these points of an image, in pixels from the left and from
    /// the bottom.
    pub fn of(object: usize, camera: &Sensor, places: &[[f64; 2]]) -> impl Iterator<Item = Self> {
        places.chunks(PACKET_SIZE).map(move |places| {
            let (origin, dir) = (Vectors::ZERO, Vectors::ZERO);
            let sights = places.iter().map(|[x, y]| camera.sight(*x, *y)).collect();
            let mut packet = Self { object, len: places.len(), origin, dir, sights };
            for lane in 0..PACKET_SIZE {
                let [x, y] = places[lane.min(places.len() - 1)];
                let ray = camera.ray(x, y);
                packet.origin.set(lane, ray.origin);
                packet.dir.set(lane, ray.dir);
            }
            packet
        })
    }

    /// Returns the number of rays.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns the rays.
    pub fn rays(&self) -> impl Iterator<Item = Ray> {
        (0..self.len).map(|lane| self.all().get(lane))
    }

    /// Returns the rays, each with its exact form before rounding.
    pub fn sights(&self) -> impl Iterator<Item = (Ray, &Sight)> {
        self.rays().zip(&self.sights)
    }

    /// Returns all lanes, with the copies of rays that fill up the packet.
    fn all(&self) -> RayPacket<'_> {
        let count = self.len.next_multiple_of(LANES);
        RayPacket::new(self.origin.view(count), self.dir.view(count), 0.0)
    }

    /// Returns the distances at which the rays first hit the object, in world units; [`MISS`] where they do not.
    pub fn hits(&self, shape: &AnyShape, cpu: Cpu) -> [f64; PACKET_SIZE] {
        let (rays, len) = (self.all(), self.len);
        // As the tracer decides what a packet leaves open.
        let exactly = |lane: usize| trace::primary_distance(shape, rays.get(lane), &self.sights[lane]);
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let (mut hit_ids, mut doubt) = ([0; PACKET_SIZE], [0; PACKET_SIZE]);
        let nearest =
            HitRecordMut { near: &mut near, far: &mut far, hit_ids: &mut hit_ids, doubt: &mut doubt };
        if shape.closest_hits(cpu, rays, 1, nearest) {
            for lane in (0..len).filter(|lane| doubt[*lane] != 0) {
                near[lane] = exactly(lane);
                far[lane] = near[lane];
            }
        }
        let mut hits = near;
        if near[..len] != far[..len] {
            let count = rays.len();
            let brackets = (&near[..count], &far[..count]);
            shape.packets().refine(cpu, rays, brackets, &mut hits[..count]);
            for lane in 0..len {
                hits[lane] = if near[lane] == far[lane] {
                    near[lane]
                } else {
                    let found = if hits[lane].is_nan() { exactly(lane) } else { hits[lane] };
                    found.max(near[lane]).min(far[lane])
                };
            }
        }
        hits
    }
}
