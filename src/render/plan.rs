//! What a scene needs, decided once before any ray is traced, so that rendering can leave out everything else.

pub mod depth;
pub(crate) mod glow;
pub(crate) mod lamps;
pub mod needs;
mod same_look;
mod shut_out;

use depth::{ContinuationBounds, Depth};
use glow::Glow;
use needs::{Needs, UnlitReason};
use same_look::SameLook;
pub(crate) use shut_out::ShutOut;
use shut_out::{Objects, shut_out};

use crate::features::Features;
use crate::footprint::PixelProver;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::parallel;
use tabray_world::scene::model::{Model, Object};
use tabray_world::sensor::{Adaptive, Sensor};

/// The minimum number of bounded objects for which a BVH is faster than a list.
pub(crate) const TREE: usize = 24;

/// The minimum number of objects for which bounds are computed on all threads.
const MANY: usize = 1 << 14;

/// A model, with the decisions that depend on its objects and lights. Rays are traced through a plan.
pub struct Plan<'m> {
    /// The scene.
    pub model: &'m Model,
    /// The camera, initially the model's own, but with alpha switched off: few images have a place for it. Four things may
    /// be changed afterwards: a fixed number of samples, the sampler, alpha, and, in a plan for any ray, the size of the
    /// image. The plan depends on everything else.
    pub camera: Sensor,
    /// The indices of the objects without bounds.
    pub unbounded: Vec<usize>,
    /// The indices and bounding boxes of the objects with bounds, unless they are in `tree`.
    pub(crate) bounded: Vec<(usize, Aabb)>,
    /// The objects with bounds, if there are at least `TREE`.
    pub tree: Option<Bvh>,
    /// The objects that look the same, where there are many and no ray continues.
    pub(crate) same_look: Option<SameLook>,
    /// Whether any object that is needed is transparent, so that shadows may be partial.
    pub(crate) has_glass: bool,
    /// Whether any object absorbs light inside.
    pub(crate) has_media: bool,
    /// The objects that are small in the image, where the number of a pixel's samples depends on them.
    pub(crate) features: Option<Features>,
    /// The prover of pixels' colours, where that is wanted.
    pub(crate) prover: Option<PixelProver>,
    /// How deep rays are followed; `None` where no object reflects or transmits rays.
    pub depth: Option<Depth>,
    /// The objects whose hits may take long to find, where rays continue.
    pub(crate) costly: Option<CostlyObjects>,
    /// The maximum number of reflections and transmissions on a path.
    pub max_depth: usize,
    /// The lights that are sampled, and what is left out.
    pub needs: Needs,
    /// For each object, the index of the light whose visible shape it is, if facets of rough surfaces aim at that light;
    /// empty where they aim at none.
    pub(crate) lamps: Vec<Option<usize>>,
    /// What objects emit, where it lights others.
    pub(crate) glow: Option<Glow>,
    /// The ways by which rays meet what they both aim at and meet by chance.
    pub(crate) ways: Ways,
    /// The lights that a closed object hides from all visible points.
    pub(crate) shut_out: Vec<ShutOut>,
}

/// The ways by which rays meet lamps and objects that emit, where they may aim at them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ways {
    /// By both, each weighted by its density.
    Both,
    /// By aim alone.
    Aim,
    /// By chance alone.
    Chance,
}

/// Objects whose hits may take long to find.
pub(crate) struct CostlyObjects {
    /// The objects, by their indices in the scene.
    pub tree: Bvh,
    /// Their number, at least 1.
    pub count: u32,
}

impl CostlyObjects {
    fn of(objects: &[Object]) -> Option<Self> {
        let costly = objects.iter().enumerate().filter(|(_, object)| object.shape.facts().may_be_costly);
        let boxed = |(index, object): (usize, &Object)| Some((index as u32, object.shape.bounds()?));
        let (indices, boxes): (Vec<_>, Vec<_>) = costly.filter_map(boxed).unzip();
        let mut tree = Bvh::new(&boxes);
        tree.rename(|object| indices[object as usize]);
        (!indices.is_empty()).then_some(Self { tree, count: indices.len() as u32 })
    }
}

impl<'m> Plan<'m> {
    /// Makes the plan for a model, through which any ray may be traced.
    pub fn new(model: &'m Model) -> Self {
        Self::with(model, |_, _| Needs::all(model))
    }

    /// Makes the plan for the image of a model's camera, with any number of samples. It leaves out the objects and
    /// lights that cannot change a byte of the image. Only rays through the image's pixels may be traced through it.
    pub fn for_picture(model: &'m Model) -> Self {
        Self::with(model, |bounds, depth| Needs::of(model, bounds, depth))
    }

    fn with(model: &'m Model, needs: impl FnOnce(&[Option<Aabb>], Option<&Depth>) -> Needs) -> Self {
        let objects = &model.objects;
        let bounds = parallel::filled(objects.len(), MANY, |index| objects[index].shape.culling_bounds());
        let depth = Depth::new(model);
        let mut needs = needs(&bounds, depth.as_ref());
        let mut unreached = needs.unreached.iter().peekable();
        let met = (0..objects.len()).filter(|index| unreached.next_if_eq(&index).is_none());
        let (boxed, unbounded): (Vec<_>, Vec<_>) = met.partition(|index| bounds[*index].is_some());
        let box_of = move |index: usize| bounds[index].unwrap_or(Aabb::EMPTY);
        let (tree, bounded): (_, Vec<_>) = if boxed.len() >= TREE {
            let of = &boxed;
            let mut tree = Bvh::of(of.len(), move |place| box_of(of[place]));
            tree.rename(|place| boxed[place as usize] as u32);
            (Some(tree), Vec::new())
        } else {
            (None, boxed.iter().map(|index| (*index, box_of(*index))).collect())
        };
        let searched = Objects { unbounded: &unbounded, bounded: &bounded, tree: tree.as_ref() };
        let shut_out = shut_out(model, &searched);
        for ShutOut { light, .. } in &shut_out {
            needs.leave_out(*light, UnlitReason::ShutOut);
        }
        let camera = Sensor { alpha: false, ..model.camera.value.clone() };
        let features = camera.adaptive.map(|_| Features::new(&camera, objects));
        let prover = camera.certain.then(|| PixelProver::new(model));
        let mut unreached = needs.unreached.iter().peekable();
        let mut met = objects.iter().enumerate().filter(|(index, _)| unreached.next_if_eq(&index).is_none());
        let has_glass = met.any(|(_, object)| !object.is_opaque());
        let has_media = objects.iter().any(|object| object.material.medium().is_some());
        let costly = depth.as_ref().and_then(|_| CostlyObjects::of(objects));
        let (max_depth, lamps) = (usize::MAX, lamps::of(model, &needs.lights));
        let is_simple = tree.is_some() && depth.is_none() && !has_glass && !has_media;
        let same_look = if is_simple { SameLook::of(model) } else { None };
        Self {
            model,
            camera,
            unbounded,
            bounded,
            tree,
            same_look,
            has_glass,
            has_media,
            features,
            prover,
            depth,
            costly,
            max_depth,
            needs,
            lamps,
            glow: Glow::of(model),
            ways: Ways::Both,
            shut_out,
        }
    }

    /// Lets pixels take different numbers of samples, or makes all take the same. The plan must be one for any ray.
    pub fn set_adaptive(&mut self, adaptive: Option<Adaptive>) {
        self.camera.adaptive = adaptive;
        if adaptive.is_some() && self.features.is_none() {
            self.features = Some(Features::new(&self.camera, &self.model.objects));
        }
    }

    /// Lets rays meet what they may aim at by some ways only: each has the same mean, with other noise.
    #[doc(hidden)]
    pub fn meeting_by(self, ways: Ways) -> Self {
        Self { ways, ..self }
    }

    /// Returns how rays continue from the object of this index.
    pub(crate) fn continuation(&self, index: usize) -> ContinuationBounds {
        match &self.depth {
            Some(depth) => depth.objects[index],
            // Without reflecting or transmitting objects, no ray continues.
            None => ContinuationBounds::NONE,
        }
    }
}
