//! What the searches for the hits of rays cost beyond plain rays.

use super::context::Tracer;
use crate::geometry::ray::Side;
use crate::geometry::ray_packet::RayPacket;
use crate::render::limits::MAX_RAYS;
use crate::render::observer::TraceObserver;

/// The number of rays of a pixel from which on searches are charged: they are made again to be counted.
const UNCOUNTED: u32 = 16;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Charges some of a packet's rays for the searches in shapes where these may take as long as many plain rays.
    ///
    /// All such shapes of the scene count, those too that lie behind a ray's hit or are not needed for the image, so
    /// that the charge depends on the ray alone.
    pub(super) fn charge_searches(
        &self,
        rays: RayPacket,
        left: Option<(usize, &[Side])>,
        lanes: impl Iterator<Item = usize>,
        ray_budget: &mut [u32],
    ) {
        if self.plan.costly.is_empty() {
            return;
        }
        for lane in lanes {
            for index in &self.plan.costly {
                if ray_budget[lane] == 0 || ray_budget[lane] > MAX_RAYS as u32 - UNCOUNTED {
                    break;
                }
                let side = left.filter(|(object, _)| object == index).map(|(_, sides)| sides[lane]);
                let shape = &self.model.objects[*index].shape;
                ray_budget[lane] = ray_budget[lane].saturating_sub(shape.search_cost(&rays.get(lane), side));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::observer::DynObserver;
    use crate::render::plan::Plan;
    use crate::render::ray_stats::RayStats;
    use crate::render::renderer::Renderer;
    use crate::render::trace::{self, Scratch};
    use crate::scene::reader;
    use crate::scene::registry::Registry;
    use crate::simd::cpu::Cpu;
    use crate::world::material::Rgb;
    use std::path::Path;

    const SCENE: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }
        material glass { ambient 1 1 1 diffuse 3 3 3 specular 0.6 transparency 0.6 }
        light lamp { location 1 7 2 emissivity 20 20 20 }";

    /// Bends ever more often toward its lower end, so that hits there take many pieces.
    const WILD: &str = "revsurf wild { material glass profile \"0.3 + abs(cos(sqrt(0.4 / y)))\" \
        direction 0 1 0.3 base 4 1 -2 height 3 }";

    /// Is cut into thousands of slabs.
    const LONG: &str = "revsurf long { material glass profile \"cos(sin(y) + 1e-8 - exp(y))\" \
        direction 0 1 0.3 base 4 -2 -2 height 7.88 }";

    /// Renders all pixels in packets and one by one, where every step is reported; returns how many rays were cast in
    /// packets, and how many pixels were cut off.
    fn rays(surface: &str) -> (usize, u64) {
        let registry = Registry::get().expect("sound types");
        let text = format!("{SCENE}\n{surface}");
        let Ok(loaded) = reader::read(registry, "scene", Path::new(""), text.as_bytes(), None) else {
            panic!("a sound scene");
        };
        let plan = Plan::new(&loaded.model);
        let pixels: Vec<_> = (0..6).flat_map(|row| (0..8).map(move |column| [column, row])).collect();
        let (mut scratch, mut stats) = (Scratch::default(), RayStats::default());
        let renderer = Renderer::new(1).expect("a thread");
        let together: Vec<Rgb> = renderer.run(|| {
            let mut tracer = Tracer::new(&plan, Cpu::best(), &mut scratch, &mut stats);
            let seen = tracer.pixels(&pixels);
            (0..pixels.len()).map(|lane| seen.get(lane)).collect()
        });
        let alone: Vec<Rgb> = renderer.run(|| {
            let sights = pixels.iter().map(|[x, y]| plan.camera.sight(*x as f64, *y as f64));
            sights
                .map(|sight| trace::traced(&plan, &sight, None, None, &mut DynObserver::<true>(&mut ())).0)
                .collect()
        });
        assert_eq!(together, alone, "{surface}");
        (stats.all_rays() as usize, stats.cuts.pixels)
    }

    #[test]
    fn rays_whose_hits_take_long_to_find_count_as_many() {
        let (wild, cut) = rays(WILD);
        assert!(wild < 10_000 && cut == 2, "{wild} rays, {cut} pixels");
        let (long, cut) = rays(LONG);
        assert!(long < 20_000 && cut == 6, "{long} rays, {cut} pixels");
    }
}
