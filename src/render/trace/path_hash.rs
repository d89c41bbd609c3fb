//! Hashes of primary rays' paths, which tell the rays of a pixel apart.

use super::light::{Colours, LitPoints, Reflectivities};
use glam::DVec2;
use std::mem::take;
use tabray_world::material::Rgb;
use tabray_world::packets::shader::{PacketShader, SurfacePoints};
use tabray_world::simd::cpu::Cpu;

/// For each current primary ray, a hash of the objects, tiles and lights on its path: through mirrors and glass, in
/// the order in which they are met, or under the free rules in any. It does not depend on the other rays of the packet.
#[derive(Default)]
pub(super) struct PathHashes {
    /// Whether anything is recorded.
    pub is_on: bool,
    /// Whether the hits on a path come in no fixed order.
    pub is_mixed: bool,
    /// The hashes.
    pub marks: Vec<u64>,
    /// The distances of the first hits in world units, infinite for rays that hit nothing.
    pub distances: Vec<f64>,
    /// The tiles at the points of the current packet.
    tiles: Vec<u64>,
}

impl PathHashes {
    /// Starts the trails of new primary rays.
    #[inline]
    pub fn begin(&mut self, len: usize) {
        self.marks.clear();
        self.marks.resize(len, 0);
        self.distances.clear();
        self.distances.resize(len, f64::INFINITY);
    }

    /// Records that descendants of the primary rays in these lanes hit the object of this index; the tiles or texels at
    /// these points, if it has any; and the distances, if they are the primary rays themselves.
    #[inline]
    pub fn meet(
        &mut self,
        cpu: Cpu,
        camera: &[u8],
        object: usize,
        distances: Option<&[f64]>,
        shader: Option<(&dyn PacketShader, SurfacePoints)>,
    ) {
        camera.iter().for_each(|lane| self.add(*lane, 2 * object as u64 + 1));
        if let Some((shader, points)) = shader {
            let mut tiles = take(&mut self.tiles);
            tiles.resize(points.positions.len(), 0);
            shader.tiles(cpu, points, &mut tiles);
            camera.iter().zip(&tiles).for_each(|(lane, tile)| self.add(*lane, *tile));
            self.tiles = tiles;
        }
        for (lane, distance) in camera.iter().zip(distances.into_iter().flatten()) {
            self.distances[usize::from(*lane)] = *distance;
        }
    }

    /// Records on which of these points the light of this index shines. Only points that reflect any of it count: the
    /// others may not have been tested. `has_tints` tells that the light's colours differ only by the glass on the
    /// way.
    #[inline]
    pub fn see_light(
        &mut self,
        camera: &[u8],
        light: usize,
        lit: &LitPoints,
        is_shiny: bool,
        has_tints: bool,
    ) {
        for (lane, primary) in camera.iter().enumerate() {
            let reflects = match lit.looks {
                Reflectivities::Uniform(_) => true,
                Reflectivities::Each { diffuse, specular } => {
                    diffuse.get(lane) != Rgb::ZERO || is_shiny && specular.get(lane) != Rgb::ZERO
                }
            };
            if reflects && lit.shines[lane] != 0 && lit.blocked[lane] != 1 {
                self.add(*primary, 2 * light as u64 + 2);
                if let Colours::Each(sent) = lit.emissivity
                    && has_tints
                {
                    sent.get(lane)
                        .to_array()
                        .iter()
                        .for_each(|channel| self.add(*primary, channel.to_bits()));
                }
            }
        }
    }

    /// Records the facet of a rough surface that a descendant of a primary ray hits. No two facets are alike.
    pub fn see_facet(&mut self, camera: u8, draw: DVec2) {
        self.add(camera, draw.x.to_bits() ^ draw.y.to_bits().rotate_left(32));
    }

    #[inline]
    fn add(&mut self, lane: u8, what: u64) {
        let mark = &mut self.marks[usize::from(lane)];
        if self.is_mixed {
            let what = what.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            *mark = mark.wrapping_add((what ^ what >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9));
            return;
        }
        *mark = (mark.rotate_left(23) ^ what).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}
