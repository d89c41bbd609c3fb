//! The rays of many [trees](super::tree) that are followed together, and what they find.

use super::arrays::VectorList;
use super::ray_group::RayGroup;
use super::tree::{Budget, Ends, OpenRay, Tree};
use crate::limits::MAX_RAYS;
use crate::plan::depth::Depth;
use std::mem::swap;
use tabray_world::material::Rgb;

/// The results at the hit of a ray.
#[derive(Clone, Copy, Default)]
pub(super) struct Outcome {
    /// The light of the point itself, times the weight of the path.
    pub light: Rgb,
    /// The work that it took, in simple rays.
    pub cost: u32,
    /// The rays that continue.
    pub onward: [Option<OpenRay>; 4],
}

/// The scratch space of trees.
#[derive(Default)]
pub(super) struct TreeScratch {
    pub trees: Vec<Tree>,
    /// The limits of the primary rays' trees, by their lanes.
    pub budgets: Vec<Budget>,
    /// The lanes of the primary rays from which others continue, and the numbers of their trees by their lanes.
    pub lanes: Vec<u8>,
    pub numbers: Vec<u8>,
    /// The rays of the current wave, and what was found at their hits.
    pub wave: Vec<OpenRay>,
    pub outcomes: Vec<Outcome>,
    /// The same of the primary rays, while these are not the current wave. There may be more than are in use.
    pub primary: (Vec<OpenRay>, Vec<Outcome>),
    /// The numbers of the rays in the wave, by the objects that they leave.
    pub order: Vec<u32>,
    pub group: RayGroup,
    pub seen: VectorList,
}

impl TreeScratch {
    /// Starts the wave of these rays.
    pub fn begin_wave(&mut self) {
        self.outcomes.clear();
        self.outcomes.resize(self.wave.len(), Outcome::default());
    }

    /// Makes the primary rays the current wave, or puts them away again.
    pub fn swap_primary(&mut self) {
        swap(&mut self.wave, &mut self.primary.0);
        swap(&mut self.outcomes, &mut self.primary.1);
    }

    /// Starts the wave of this many primary rays.
    pub fn begin_primary(&mut self, len: usize) {
        self.swap_primary();
        self.wave.extend((self.wave.len()..len).map(OpenRay::primary));
        self.outcomes.resize(len.max(self.outcomes.len()), Outcome::default());
        self.outcomes[..len].iter_mut().for_each(|outcome| outcome.onward = Default::default());
    }

    /// Fills a packet with rays of the wave that leave the same object. Each may cost what is left of its tree's
    /// work, but at least half of `MAX_RAYS`.
    pub fn gather(&mut self, places: &[u32], group: &mut RayGroup) {
        let Self { trees, numbers, wave, outcomes, .. } = self;
        for place in places {
            let tree = &trees[usize::from(numbers[usize::from(wave[*place as usize].camera)])];
            outcomes[*place as usize].cost = MAX_RAYS as u32 - tree.work.min(MAX_RAYS as u32 / 2);
        }
        let rays = places.iter().map(|place| &wave[*place as usize]);
        group.open(rays, places.iter().map(|place| outcomes[*place as usize].cost));
        group.places.clear();
        group.places.extend_from_slice(places);
    }

    /// Notes what a packet of the wave's rays has found.
    pub fn note(&mut self, group: &RayGroup, seen: &VectorList) {
        for (lane, place) in group.places[..group.len].iter().enumerate() {
            let (ray, outcome) = (&self.wave[*place as usize], &mut self.outcomes[*place as usize]);
            outcome.light = ray.weight * seen.get(lane);
            outcome.cost -= group.ray_budget[lane];
        }
    }

    /// Adds what the wave has found to its trees, in the order of its rays.
    pub fn add(&mut self, depth: &Depth, ends: &Ends) {
        for (ray, outcome) in self.wave.iter().zip(&self.outcomes) {
            let number = self.numbers[usize::from(ray.camera)];
            self.trees[usize::from(number)].add(outcome, depth, ends);
        }
    }
}
