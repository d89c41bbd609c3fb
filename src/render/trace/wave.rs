//! The rays of many [trees](super::tree) that are followed together, and what they find.

use super::arrays::VectorList;
use super::ray_group::RayGroup;
use super::tree::{Budget, Ends, OpenRay, Tree};
use crate::limits::MAX_RAYS;
use crate::plan::depth::Depth;
use std::mem::swap;
use std::ops::Range;
use tabray_world::material::Rgb;

/// The results at the hit of a ray.
#[derive(Clone, Default)]
pub(super) struct Outcome {
    /// The light of the point itself, times the weight of the path.
    pub light: Rgb,
    /// The work that it took, in simple rays.
    pub cost: u32,
    /// The places of the rays that continue, among those of the wave.
    pub onward: Range<usize>,
}

/// Rays that are followed together, and what was found at their hits.
#[derive(Default)]
pub(super) struct Wave {
    pub rays: Vec<OpenRay>,
    /// For each ray; there may be more than are in use.
    pub outcomes: Vec<Outcome>,
    /// The rays that continue from all hits.
    pub onward: Vec<OpenRay>,
}

impl Wave {
    /// Starts with the outcomes of this many rays.
    pub fn begin(&mut self, len: usize) {
        self.onward.clear();
        self.outcomes.resize(len.max(self.outcomes.len()), Outcome::default());
        self.outcomes[..len].fill(Outcome::default());
    }

    /// Adds what was found at the hit of a ray to its tree.
    pub fn add(&self, place: usize, tree: &mut Tree, depth: &Depth, ends: &Ends) {
        let outcome = &self.outcomes[place];
        tree.add(outcome, &self.onward[outcome.onward.clone()], depth, ends);
    }
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
    pub wave: Wave,
    /// The primary rays, while these are not the current wave. There may be more than are in use.
    pub primary: Wave,
    /// The numbers of the rays in the wave, by the objects that they leave.
    pub order: Vec<u32>,
    pub group: RayGroup,
    pub seen: VectorList,
}

impl TreeScratch {
    /// Makes the primary rays the current wave, or puts them away again.
    pub fn swap_primary(&mut self) {
        swap(&mut self.wave, &mut self.primary);
    }

    /// Starts the wave of this many primary rays.
    pub fn begin_primary(&mut self, len: usize) {
        self.swap_primary();
        let Wave { rays, .. } = &mut self.wave;
        rays.extend((rays.len()..len).map(OpenRay::primary));
        self.wave.begin(len);
    }

    /// Fills a packet with rays of the wave that leave the same object. Each may cost what is left of its tree's
    /// work, but at least half of `MAX_RAYS`.
    pub fn gather(&mut self, places: &[u32], group: &mut RayGroup) {
        let Self { trees, numbers, wave: Wave { rays, outcomes, .. }, .. } = self;
        for place in places {
            let tree = &trees[usize::from(numbers[usize::from(rays[*place as usize].camera)])];
            outcomes[*place as usize].cost = MAX_RAYS as u32 - tree.work.min(MAX_RAYS as u32 / 2);
        }
        let open = places.iter().map(|place| &rays[*place as usize]);
        group.open(open, places.iter().map(|place| outcomes[*place as usize].cost));
        group.places.clear();
        group.places.extend_from_slice(places);
    }

    /// Notes what a packet of the wave's rays has found.
    pub fn note(&mut self, group: &RayGroup, seen: &VectorList) {
        let Wave { rays, outcomes, .. } = &mut self.wave;
        for (lane, place) in group.places[..group.len].iter().enumerate() {
            let (ray, outcome) = (&rays[*place as usize], &mut outcomes[*place as usize]);
            outcome.light = ray.weight * seen.get(lane);
            outcome.cost -= group.ray_budget[lane];
        }
    }

    /// Adds what the wave has found to its trees, in the order of its rays.
    pub fn add(&mut self, depth: &Depth, ends: &Ends) {
        for (place, ray) in self.wave.rays.iter().enumerate() {
            let number = self.numbers[usize::from(ray.camera)];
            self.wave.add(place, &mut self.trees[usize::from(number)], depth, ends);
        }
    }
}
