//! The tracer: its plan, its scratch space and its observer.

use super::arrays::NARROW;
use super::scratch::Scratch;
use super::surface::Errors;
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::render::tiles::TOGETHER;
use crate::scene::model::Model;
use crate::simd::cpu::Cpu;
use crate::world::accuracy::Accuracy;
use crate::world::coincidence;
use crate::world::display::Display;
use crate::world::hittable::Hittable;

/// The number of reflections and transmissions after which packets are narrow: with wide packets, facing mirrors would
/// use too much memory.
const DEEP: usize = 24;

/// Traces packets of rays through a plan.
pub struct Tracer<'m, 'w, W> {
    pub(super) model: &'m Model,
    pub(super) plan: &'m Plan<'m>,
    pub(super) cpu: Cpu,
    /// The largest magnitude of the viewer's coordinates, in world units.
    pub(super) viewer: f64,
    /// The number of reflections and transmissions on the path of the current packet.
    pub(super) depth: usize,
    pub(super) scratch: &'w mut Scratch,
    pub(super) observer: &'w mut W,
}

impl<'m, 'w, W: TraceObserver> Tracer<'m, 'w, W> {
    /// Makes a tracer of a plan, which reports to an observer.
    pub fn new(plan: &'m Plan, cpu: Cpu, scratch: &'w mut Scratch, observer: &'w mut W) -> Self {
        Self { model: plan.model, plan, cpu, viewer: 0.0, depth: 0, scratch, observer }
    }

    /// Returns how many tiles are best traced together.
    pub fn tiles_together(&self) -> usize {
        if self.plan.camera.adaptive.is_some() && self.plan.prover.is_none() { TOGETHER } else { 1 }
    }

    /// Returns the height of the image in pixels.
    pub(crate) fn height(&self) -> usize {
        self.plan.camera.pixels[1]
    }

    /// Returns how the image shows light.
    pub(crate) fn display(&self) -> Display {
        self.plan.camera.display()
    }

    /// Tells whether the scene is traced by the notes' own methods.
    pub(super) fn is_classic(&self) -> bool {
        self.plan.camera.accuracy == Accuracy::Classic
    }

    /// Returns the maximum number of rays of a packet that continues from the current one.
    pub(super) fn max_packet(&self) -> usize {
        if self.depth < DEEP { PACKET_SIZE } else { NARROW }
    }

    /// Returns the errors of the points where rays have hit a shape.
    pub(super) fn errors(&self, shape: &dyn Hittable, travelled: &[f64], cosines: &[f64]) -> Errors {
        if self.is_classic() {
            return Errors::NONE;
        }
        let reach = shape.facts().max_coordinate + self.viewer;
        Errors { reach: Some(reach), most: coincidence::most_error(self.cpu, travelled, reach, cosines) }
    }
}
