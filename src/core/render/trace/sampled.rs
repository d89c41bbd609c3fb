//! Pixels with several samples, where nothing bounds the light that rays may return.
//!
//! A pixel is then off by an unknown amount as soon as one of its samples uses up its ray budget, whatever the others
//! return. So those after it get a small part of the budget, and the pixel costs about as much as one of a single
//! sample; where the number of samples depends on the pixel, it takes only the first number. What a sample may cost
//! depends on those before it, which are traced first.

use super::context::Tracer;
use super::scratch::{PrimaryScratch, Scratch};
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::limits::MAX_RAYS;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::render::tiles::TILE;
use crate::world::material::Rgb;

/// The number of rays that a sample may cost in a pixel that is off by an unknown amount.
pub(super) const REST: u32 = MAX_RAYS as u32 / 100;

/// Tells whether nothing bounds the light that rays may return.
pub(super) fn is_unbounded(plan: &Plan) -> bool {
    plan.depth.as_ref().is_some_and(|depth| !depth.most.is_finite())
}

/// The number of pixels that are traced together in measurements where one sample is traced after the other: so few that
/// many samples do not take too long, and so many that a packet of them takes hardly longer than a part of a larger one.
const SINGLY: usize = 64;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Returns how many pixels' rays are traced together: those of a packet, or of tiles where pixels differ in their
    /// numbers of samples. Where one sample is traced after the other, it is a part of a packet that takes hardly longer.
    pub(crate) fn pixels_together(&self) -> usize {
        let camera = &self.plan.camera;
        match camera.adaptive {
            Some(_) => self.tiles_together() * TILE * TILE,
            None if is_unbounded(self.plan) => SINGLY,
            None => (PACKET_SIZE / camera.samples as usize).max(1),
        }
    }

    /// Computes the colours of pixels sample by sample.
    pub(super) fn one_by_one(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) {
        let camera = &self.plan.camera;
        let PrimaryScratch { group, seen, colours, .. } = primary;
        let mut colours = colours.resized(pixels.len());
        for (pixels, first) in pixels.chunks(PACKET_SIZE).zip((0..).step_by(PACKET_SIZE)) {
            let len = pixels.len();
            let mut sums = vec![(Rgb::ZERO, 0.0); len];
            for index in 0..camera.samples {
                let Scratch { places: [x, y], samples: drawn, .. } = &mut *self.scratch;
                camera.scatter_each(self.cpu, pixels, index, drawn, [&mut x[..len], &mut y[..len]]);
                self.look(group, len);
                for (budget, (_, missing)) in group.ray_budget.iter_mut().zip(&sums) {
                    *budget = if *missing == f64::INFINITY { REST } else { *budget };
                }
                self.colours(group, seen);
                for (lane, (sum, missing)) in sums.iter_mut().enumerate() {
                    *sum += seen.get(lane);
                    *missing += self.missing(lane);
                }
            }
            for (lane, (sum, missing)) in sums.into_iter().enumerate() {
                colours.set(first + lane, sum / f64::from(camera.samples));
                self.cut(missing / f64::from(camera.samples));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::ray_stats::RayStats;
    use crate::render::renderer::Renderer;
    use crate::render::trace;
    use crate::scene::model::Model;
    use crate::scene::reader;
    use crate::scene::registry::Registry;
    use crate::simd::cpu::Cpu;
    use crate::world::film::Adaptive;
    use std::path::Path;

    /// Panes that pass on more light than they receive.
    const SCENE: &[u8] = b"camera eye { pixeldim 5 4 worlddim 8 6 viewpoint 4 3 6 samples 5 }
        material g { ambient 0.5 0.6 0.7 diffuse 1 1 1 specular 0.9 transparency 0.9 }
        plane p0 { material g normal 0 0 1 point 0 0 -1 }
        plane p1 { material g normal 0.01 0 1 point 0 0 -1.5 }
        plane p2 { material g normal 0 0 1 point 0 0 -2 }
        plane p3 { material g normal 0 0 1 point 0 0 -2.5 }
        plane p4 { material g normal 0 0 1 point 0 0 -3 }";

    fn loaded() -> Model {
        let registry = Registry::get().expect("sound types");
        match reader::read(registry, "scene", Path::new(""), SCENE, None) {
            Ok(loaded) => loaded.model,
            Err(report) => panic!("{report}"),
        }
    }

    /// Renders all pixels in one packet, with what that took, and checks that their number is that of those cut short.
    fn together(plan: &Plan) -> (Vec<Rgb>, u64) {
        let (mut scratch, mut stats) = (Scratch::default(), RayStats::default());
        let colours = Renderer::new(1).expect("a thread").run(|| {
            let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut stats);
            let seen = tracer.pixels(&pixels());
            (0..20).map(|lane| seen.get(lane)).collect()
        });
        assert_eq!(stats.flaws.cuts.pixels, 20);
        (colours, stats.all_rays())
    }

    /// Renders one pixel after the other.
    fn alone(plan: &Plan) -> Vec<Rgb> {
        let renderer = Renderer::new(1).expect("a thread");
        renderer.run(|| pixels().iter().map(|[x, y]| trace::pixel(plan, *x, *y)).collect())
    }

    fn pixels() -> Vec<[usize; 2]> {
        (0..4).flat_map(|row| (0..5).map(move |column| [column, row])).collect()
    }

    #[test]
    fn a_pixel_off_by_an_unknown_amount_costs_as_one_of_a_single_sample() {
        let model = loaded();
        let plan = Plan::new(&model);
        assert!(is_unbounded(&plan));
        let (colours, rays) = together(&plan);
        // Five samples of 20 pixels would cost 2,000,000. The first sample may be one that does not meet the limit.
        assert!((400_000..500_000).contains(&rays), "{rays} rays");
        assert_eq!(colours, alone(&plan));
    }

    #[test]
    fn a_pixel_off_by_an_unknown_amount_takes_no_more_samples_than_the_first() {
        let mut model = loaded();
        model.camera.value.samples = 4;
        let fixed = Plan::new(&model).camera;
        model.camera.value.adaptive = Some(Adaptive { most: 64, error: Some(1e-9) });
        let mut plan = Plan::new(&model);
        let (colours, rays) = together(&plan);
        // One sample of each of 42 pixels, in the image and around it, may cost 20,000 rays.
        assert!((400_000..900_000).contains(&rays), "{rays} rays");
        assert_eq!(colours, alone(&plan));
        plan.camera = fixed;
        assert_eq!(colours, alone(&plan));
    }
}
