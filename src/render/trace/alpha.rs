//! What rays show past all objects, for images that are transparent there: the fraction of a pixel that is *clear*. Its
//! alpha is the rest.
//!
//! A primary ray that hits nothing is clear, and so is what a partly covering surface leaves of it uncovered. Glass and
//! mirrors are objects, and what they show of the background belongs to them. The light of a pixel is that of its objects
//! alone: it lacks the background where it is clear, as it does where alpha is premultiplied.

use super::arrays::VectorList;
use super::context::Tracer;
use super::ray_group::RayGroup;
use super::tree::OpenRay;
use tabray_world::material::Rgb;
use tabray_world::rules::Rules;
use tabray_world::simd::soa::View;

impl Tracer<'_, '_> {
    /// Notes how clear the rays of some lanes are, which hit nothing, and takes the background out of their colours as far
    /// as they are. Rays whose budget is used up end at a distance of 0, and count as opaque.
    pub(super) fn show_through(
        &mut self,
        group: &RayGroup,
        far: &[f64],
        lanes: &[u8],
        colours: &mut VectorList,
    ) {
        for lane in lanes.iter().map(|lane| usize::from(*lane)) {
            let (clear, weight) = match &self.scratch.trees {
                _ if self.depth == 0 => (1.0, Rgb::ONE),
                Some(trees) if self.plan.camera.rules == Rules::Free => {
                    let OpenRay { clear, weight, .. } = trees.wave.rays[group.places[lane] as usize];
                    (clear, weight)
                }
                // Rays that continue under the notes' rules come from objects that cover all.
                _ => return,
            };
            if clear == 0.0 || far[lane] == 0.0 {
                continue;
            }
            // What a medium absorbs of the background shows the medium.
            let passed = self.passed(group, lane, f64::INFINITY, None).unwrap_or(Rgb::ONE);
            let (clear, all) = (clear * passed.min_element(), weight * passed);
            let kept = |channel: usize| if all[channel] == 0.0 { 0.0 } else { 1.0 - clear / all[channel] };
            colours.set(lane, Rgb::new(kept(0), kept(1), kept(2)) * colours.get(lane));
            let primary = group.camera.get(lane).map_or(lane, |lane| usize::from(*lane));
            self.scratch.clear[primary] += clear;
        }
    }

    /// Returns the clear fractions of the current primary rays as colours, one for each of the first `len`; none where
    /// images have no alpha.
    pub(super) fn clear(&self, len: usize) -> View<'_> {
        let clear = &self.scratch.clear[..len.min(self.scratch.clear.len())];
        View { x: clear, y: clear, z: clear }
    }
}
