//! What is traced, with what, and for whom.

use super::arrays::NARROW;
use super::scratch::Scratch;
use super::surface::Errors;
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::scene::model::Model;
use crate::simd::cpu::Cpu;
use crate::world::accuracy::Accuracy;
use crate::world::coincidence;
use crate::world::hittable::Hittable;

/// From so many reflections on, packets are narrow: a deep hall of mirrors would fill the memory with wide ones.
const DEEP: usize = 24;

/// Traces packets of rays through a model, as planned.
pub(crate) struct Tracer<'m, 'w, W> {
    pub(super) model: &'m Model,
    pub(super) plan: &'m Plan<'m>,
    pub(super) cpu: Cpu,
    /// How far along an axis the viewer is from the world's origin, in world units.
    pub(super) viewer: f64,
    /// How many mirrors and panes of glass the present packet has behind it.
    pub(super) depth: usize,
    pub(super) scratch: &'w mut Scratch,
    pub(super) observer: &'w mut W,
}

impl<'m, 'w, W: TraceObserver> Tracer<'m, 'w, W> {
    pub(crate) fn new(plan: &'m Plan, cpu: Cpu, scratch: &'w mut Scratch, watch: &'w mut W) -> Self {
        Self { model: plan.model, plan, cpu, viewer: 0.0, depth: 0, scratch, observer: watch }
    }

    /// How many rows of pixels the picture has.
    pub(crate) fn height(&self) -> usize {
        self.plan.camera.pixels[1]
    }

    /// Whether the notes' own methods are asked for.
    pub(super) fn is_classic(&self) -> bool {
        self.plan.camera.accuracy == Accuracy::Classic
    }

    /// The most rays of a packet that goes on from the present one.
    pub(super) fn most(&self) -> usize {
        if self.depth < DEEP { PACKET_SIZE } else { NARROW }
    }

    /// The errors of places where rays have come to a shape.
    pub(super) fn errors(&self, shape: &dyn Hittable, travelled: &[f64], cosines: &[f64]) -> Errors {
        if self.is_classic() {
            return Errors::NONE;
        }
        let reach = shape.reach() + self.viewer;
        Errors { reach: Some(reach), most: coincidence::most_error(self.cpu, travelled, reach, cosines) }
    }
}
