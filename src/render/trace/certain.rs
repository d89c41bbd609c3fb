//! Pixels whose colours are proven, and take no samples.

use super::context::{PrimaryScratch, Tracer};
use crate::footprint::{PixelProver, Proof};
use crate::observer::Count;
use crate::plan::Plan;
use tabray_world::material::Rgb;
use tabray_world::sensor::Adaptive;

/// Returns the limit on the error of a pixel, where 1 is white.
fn limit(adaptive: Option<Adaptive>) -> f64 {
    adaptive.and_then(|adaptive| adaptive.error).unwrap_or(0.0)
}

/// Returns the proven bounds of a pixel's colour, if the render asks for them.
pub(super) fn proof(plan: &Plan, x: usize, y: usize) -> Option<Proof> {
    let prover = plan.prover.as_ref()?;
    let limit = limit(plan.camera.adaptive);
    Some(prover.pixel((plan.model, plan.depth.as_ref()), &plan.camera, [x, y], limit))
}

/// Tells whether a pixel takes no samples.
pub(super) fn is_certified(plan: &Plan, proof: &Proof) -> bool {
    proof.is_within(limit(plan.camera.adaptive), &plan.camera.display())
}

impl Tracer<'_, '_> {
    /// Computes the colours of pixels, given by column and row: colours that are certain within the limit are taken as
    /// proven, and the others are sampled.
    pub(super) fn certain_pixels(
        &mut self,
        pixels: &[[usize; 2]],
        adaptive: Adaptive,
        prover: &PixelProver,
        primary: &mut PrimaryScratch,
    ) {
        let (plan, camera) = (self.plan, &self.plan.camera);
        let (limit, display) = (limit(Some(adaptive)), &camera.display());
        let prove =
            |pixel: &[usize; 2]| prover.pixel((plan.model, plan.depth.as_ref()), camera, *pixel, limit);
        let proofs: Vec<Proof> = pixels.iter().map(prove).collect();
        let is_open = |index: &usize| !proofs[*index].is_within(limit, display);
        let open: Vec<usize> = (0..pixels.len()).filter(is_open).collect();
        let sampled: Vec<[usize; 2]> = open.iter().map(|index| pixels[*index]).collect();
        let mut seen: Vec<Rgb> = proofs.iter().map(|proof| proof.middle(display)).collect();
        primary.adaptive.estimates.clear();
        if !open.is_empty() {
            self.adaptive_pixels(&sampled, adaptive, primary);
            let colours = primary.colours.view(sampled.len());
            for (lane, index) in open.iter().enumerate() {
                // The samples may be off, but not the bounds.
                seen[*index] = proofs[*index].nearest(colours.get(lane));
            }
        }
        let mut colours = primary.colours.resized(pixels.len());
        for (index, (proof, colour)) in proofs.iter().zip(seen).enumerate() {
            colours.set(index, colour);
            let (error, is_certified) = (proof.error(colour, display), proof.is_within(limit, display));
            self.observer.count(Count::Bounded { error, is_certified, footprints: proof.footprints });
        }
    }
}
