//! Measures certified pixels: how many there are, whether samples contradict them, and what they cost.

use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::{SCRAMBLE, Sampler};
use tabray_core::world::sensor::Adaptive;
use tabray_tools::sampling::traced::{self, Image};

/// The number of independent images whose mean gives the true colours, and the number of samples per pixel of each.
const IMAGES: u32 = 8;
const SAMPLES: u32 = 512;

/// The number of standard errors of the mean of [`IMAGES`] colours beyond which a difference contradicts a proof: of
/// normally distributed numbers, one in a million is farther off.
const IMPOSSIBLE: f64 = 16.0;

/// The shown colour of a pixel, as samples estimate it, and the standard error of each channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sampled {
    colour: Rgb,
    error: Rgb,
}

/// The results for a limit. Errors are in levels of 1/255.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The fraction of pixels that are certified.
    pub certified: f64,
    /// The greatest difference of a certified pixel from the samples.
    pub worst: f64,
    /// The number of pixels that differ from the samples by more than the proven bound and the error of the samples.
    pub contradicted: usize,
    /// The mean and the greatest bound of the other pixels.
    pub open: [f64; 2],
    /// The CPU time, in seconds.
    pub seconds: f64,
    /// The CPU time of the same render without proofs, in seconds.
    pub without: f64,
    /// The mean number of footprints per pixel.
    pub footprints: f64,
}

/// Renders the colours of a model by 4096 samples per pixel, in rows from the bottom.
pub fn truth(threads: &Renderer, model: &mut Model) -> Vec<Sampled> {
    let camera = &mut model.camera.value;
    (camera.samples, camera.adaptive, camera.certain) = (SAMPLES, None, false);
    camera.sampler = Sampler::Sobol;
    let mut plan = Plan::new(model);
    let (mut sums, mut squares) = (Vec::new(), Vec::new());
    for image in 1..=IMAGES {
        plan.camera.scramble = SCRAMBLE ^ image.wrapping_mul(0x9e37_79b9);
        let colours = traced::image(threads, &plan).colours;
        sums.resize(colours.len(), Rgb::ZERO);
        squares.resize(colours.len(), Rgb::ZERO);
        for ((sum, square), colour) in sums.iter_mut().zip(&mut squares).zip(colours) {
            *sum += colour;
            *square += colour * colour;
        }
    }
    let (images, display) = (f64::from(IMAGES), plan.camera.display());
    let sampled = |(sum, square): (&Rgb, &Rgb)| {
        let mean = *sum / images;
        let variance = (*square / images - mean * mean).max(Rgb::ZERO) / (images - 1.0);
        let (error, colour) = (variance.map(f64::sqrt), display.shown(mean));
        let [low, high] = display.shown_within([mean - error, mean + error]);
        Sampled { colour, error: (high - colour).max(colour - low) }
    };
    sums.iter().zip(&squares).map(sampled).collect()
}

/// Measures a limit, where 1 is white, against the colours that [`truth`] returns.
pub fn measure(threads: &Renderer, model: &mut Model, limit: f64, truth: &[Sampled]) -> Outcome {
    let adaptive = Some(Adaptive { most: 4096, error: Some(limit) });
    let camera = &mut model.camera.value;
    (camera.samples, camera.adaptive, camera.certain) = (4, adaptive, true);
    let Image { colours: certain, bounds, seconds, .. } = traced::image(threads, &Plan::new(model));
    model.camera.value.certain = false;
    let without = traced::image(threads, &Plan::new(model)).seconds;
    let (mut worst, mut contradicted, mut open) = (0.0_f64, 0, Vec::new());
    let display = model.camera.value.display();
    for ((colour, bound), truth) in certain.iter().zip(&bounds).zip(truth) {
        let off = (display.shown(*colour) - truth.colour).abs();
        if bound.is_certified {
            worst = worst.max(off.max_element());
        } else {
            open.push(255.0 * bound.error);
        }
        contradicted += usize::from((off - IMPOSSIBLE * truth.error).max_element() > bound.error);
    }
    let count = bounds.len() as f64;
    let mean = if open.is_empty() { 0.0 } else { open.iter().sum::<f64>() / open.len() as f64 };
    Outcome {
        certified: 1.0 - open.len() as f64 / count,
        worst: 255.0 * worst,
        contradicted,
        open: [mean, open.iter().copied().fold(0.0, f64::max)],
        seconds,
        without,
        footprints: bounds.iter().map(|bound| f64::from(bound.footprints)).sum::<f64>() / count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use tabray_lang::reader;
    use tabray_lang::registry::Registry;
    use tabray_tools::threads::renderer_with;

    /// A floor, a wall with a mirror, spheres, a cone and a torus, a pane of glass, two lights, one of them with a
    /// size.
    const SCENE: &str = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 8 }
        material paper { ambient 0.4 0.4 0.3 diffuse 3 3 3 }
        material shiny { ambient 0.1 0.2 0.3 diffuse 2 1 1 specular 0.4 shininess 30 }
        material glass { ambient 0.1 0.1 0.1 diffuse 1 2 3 transparency 0.6 }
        light lamp { location 2 8 4 emissivity 9 8 7 }
        light ball { location 7 6 3 emissivity 4 5 6 size 0.3 }
        plane floor { material paper normal 0 1 0 point 0 0 0 }
        plane back { material shiny normal 0 0 1 point 0 0 -7 }
        sphere one { material paper center 2 1.5 -3 radius 1.2 }
        sphere two { material shiny center 5 1 -4 radius 1 }
        torus ring { material paper center 6 4 -4 direction 0.3 1 0.5 radius 0.9 tube 0.3 }
        fplane pane { material glass normal 0 0 1 point 4.5 0.5 -1 xdir 1 0 0 dimensions 2 2 }";

    #[test]
    fn certified_pixels_are_not_contradicted_by_samples() {
        let registry = Registry::get().expect("sound types");
        let mut model = match reader::read(registry, "scene", Path::new(""), SCENE.as_bytes(), None) {
            Ok(loaded) => loaded.model,
            Err(report) => panic!("{report}"),
        };
        let renderer = renderer_with(0).expect("threads");
        let truth = truth(&renderer, &mut model);
        let outcome = measure(&renderer, &mut model, 2.0 / 255.0, &truth);
        assert_eq!(outcome.contradicted, 0, "{outcome:?}");
        assert!(outcome.certified > 0.5, "{outcome:?}");
        assert!(outcome.worst < 2.5, "{outcome:?}");
    }
}
