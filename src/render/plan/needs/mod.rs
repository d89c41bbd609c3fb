//! The parts of a scene that its image needs: the objects that rays may hit, and the lights that may light what is
//! seen.
//!
//! **Views.** Primary rays lead away from the viewer, between the edges of the image. Where they may meet a mirror in a
//! plane, the rays that it reflects lead away from the viewer's mirror image, in front of the mirror; and so on from
//! mirror to mirror. Glass does not turn rays, unless its material has an interface. Such glass and curved mirrors may
//! show everything, and so may more than `MAX_VIEWS` views: then no object is left out.
//!
//! **Lights.** A light is left out where it adds nothing to any object that a view may show: the light lies behind
//! the object's plane, it does not shine on the object's region
//! ([`is_clear_of`](tabray_world::light::Light::is_clear_of)), or the product of its colour and the object's
//! reflectivities is black. The plan also leaves out lights that a closed object hides from all visible points.
//!
//! **Objects.** An object is left out where it is clear of all views, and of all paths from visible points to a light
//! that is needed. No ray could meet an object that is left out, so the image stays the same to the byte. All tests
//! have margins far above the rounding errors of rays.
//!
//! Where light bounces, anything may light what is seen, and nothing is left out. With adaptive sampling, too: a pixel's number of samples also depends on pixels around the image,
//! and on the lights that shine on its hits, even on black ones.
//!
//! The notes' program tests every ray against every shape, so with `--method classic` nothing is left out.

mod hull;
mod view;

use crate::plan::depth::{self, Depth};
use hull::Hull;
use tabray_world::accuracy::Accuracy;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::lamp::Lamp;
use tabray_world::material::{Look, Rgb};
use tabray_world::parallel;
use tabray_world::scene::model::{Model, Object};
use view::{View, VisibleRegion};

/// The maximum number of views, of the viewer and of the mirrors together.
const MAX_VIEWS: usize = 16;

/// The minimum number of objects that are judged on all threads.
const MANY: usize = 1 << 12;

/// What an image needs.
pub struct Needs {
    /// The indices of the lights that are needed.
    pub lights: Vec<usize>,
    /// The indices of the other lights, each with the reason.
    pub dark: Vec<(usize, UnlitReason)>,
    /// The indices of the objects that are not needed.
    pub unreached: Vec<usize>,
    /// A lower bound on the distance of these objects from all rays, in world units.
    pub clearance: f64,
}

/// Why a light is not needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnlitReason {
    /// Visible surfaces reflect none of its light.
    Black,
    /// Visible surfaces turn away from it.
    Behind,
    /// It does not shine on visible surfaces.
    Aside,
    /// Several of these reasons hold, each for a part of the visible surfaces.
    Mixed,
    /// A closed object is around either the light or the viewer.
    ShutOut,
}

impl UnlitReason {
    /// Describes the reason.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Black => "nothing that is seen reflects its colour",
            Self::Behind => "it is behind all that is seen",
            Self::Aside => "it does not shine on anything that is seen",
            Self::Mixed => "it is behind what is seen, or does not shine on it",
            Self::ShutOut => "a closed object is around either it or the viewer",
        }
    }
}

impl Needs {
    /// Returns the needs of a model when nothing is left out.
    pub fn all(model: &Model) -> Self {
        let lights = (0..model.lights.len()).collect();
        Self { lights, dark: Vec::new(), unreached: Vec::new(), clearance: f64::INFINITY }
    }

    /// Leaves out a light, if it is not left out already.
    pub(crate) fn leave_out(&mut self, light: usize, reason: UnlitReason) {
        if let Some(place) = self.lights.iter().position(|needed| *needed == light) {
            self.lights.remove(place);
            self.dark.push((light, reason));
        }
    }

    /// Finds what the image of the model's camera needs, given the objects' bounding boxes. `depth` tells which
    /// mirrors reflect nothing.
    pub fn of(model: &Model, bounds: &[Option<Aabb>], depth: Option<&Depth>) -> Self {
        if model.camera.value.adaptive.is_some() || model.camera.value.bounces != 0 {
            return Self::all(model);
        }
        // Rays of a draft may be off by 1e-3 of their length.
        let margin = match model.camera.value.accuracy {
            Accuracy::Classic => return Self::all(model),
            Accuracy::Draft => 1e-2,
            Accuracy::Exact | Accuracy::Strict => 1e-9,
        };
        let Some(view) = View::of(&model.camera.value, margin) else { return Self::all(model) };
        let scene = KnownScene { model, bounds, depth };
        scene.needs(view)
    }
}

/// A scene, with the bounds and the depth of its objects.
struct KnownScene<'s> {
    model: &'s Model,
    bounds: &'s [Option<Aabb>],
    depth: Option<&'s Depth>,
}

/// A view, and the indices of the objects that it may show. Without a view, the objects may be seen from anywhere.
type Shown<'v> = (Option<&'v View>, &'v [usize]);

impl KnownScene<'_> {
    fn needs(&self, view: View) -> Needs {
        let views = self.views(view);
        // Without views, each object may be seen from anywhere.
        let all: Vec<usize>;
        let shown: Vec<Shown> = match &views {
            Some(views) => views.iter().map(|(view, shown)| (Some(view), &shown[..])).collect(),
            None => {
                all = (0..self.model.objects.len()).collect();
                vec![(None, &all)]
            }
        };
        let mut needs =
            Needs { lights: Vec::new(), dark: Vec::new(), unreached: Vec::new(), clearance: f64::INFINITY };
        // The paths to a sky lead everywhere.
        let is_any_far = self.model.lights.iter().any(|item| item.value.is_far());
        let near_views = views.as_deref().filter(|_| !is_any_far);
        let candidates = near_views.map_or_else(Vec::new, |views| self.unseen(views));
        let mut regions: Vec<Hull> = Vec::new();
        for (index, item) in self.model.lights.iter().enumerate() {
            match self.lit(&item.value, &shown, !candidates.is_empty(), &mut regions) {
                Ok(()) => needs.lights.push(index),
                Err(reason) => needs.dark.push((index, reason)),
            }
        }
        let Some(views) = views else { return needs };
        let clearance = |index: &usize| {
            let (object, bounds) = (&self.model.objects[*index], self.bounds[*index].as_ref());
            let views = views.iter().map(|(view, _)| view.clearance(object, bounds));
            let paths = regions.iter().map(|region| view::clearance(region, object, bounds));
            // Stops at the first region that the object may meet.
            views.chain(paths).try_fold(f64::INFINITY, |least, one| (one > 0.0).then_some(least.min(one)))
        };
        let clear = parallel::map_ranges(candidates.len(), MANY, &|range| {
            candidates[range].iter().map(clearance).collect()
        });
        for (index, clearance) in candidates.into_iter().zip(clear) {
            if let Some(clearance) = clearance {
                needs.unreached.push(index);
                needs.clearance = needs.clearance.min(clearance);
            }
        }
        needs
    }

    /// Tells whether a light may light an object that a view shows, or why it does not. If `finds_paths`, adds the
    /// regions of its shadow rays to `regions`.
    fn lit(
        &self,
        light: &Lamp,
        shown: &[Shown],
        finds_paths: bool,
        regions: &mut Vec<Hull>,
    ) -> Result<(), UnlitReason> {
        let (mut is_needed, mut reason) = (false, None);
        for (view, shown) in shown {
            let mut depth: Option<f64> = None;
            for object in *shown {
                let bounds = self.bounds[*object].as_ref();
                let of = &self.model.objects[*object];
                let seen = view.map_or_else(|| VisibleRegion::of(bounds), |view| view.seen(of, bounds));
                match self.darkness(light, of, &seen, *view) {
                    None => {
                        is_needed = true;
                        match view {
                            Some(view) if finds_paths => {
                                depth = Some(view.depth(&seen).max(depth.unwrap_or(0.0)));
                            }
                            _ => break,
                        }
                    }
                    Some(own) if reason.is_none_or(|reason| reason == own) => reason = Some(own),
                    Some(_) => reason = Some(UnlitReason::Mixed),
                }
            }
            let region = |(view, depth): (&View, f64)| view.paths(depth, light.location(), light.size());
            regions.extend(view.zip(depth).map(region));
        }
        if is_needed { Ok(()) } else { Err(reason.unwrap_or(UnlitReason::Black)) }
    }

    /// Returns the indices of the objects that no view may show, in ascending order.
    fn unseen(&self, views: &[(View, Vec<usize>)]) -> Vec<usize> {
        let mut is_seen = vec![false; self.model.objects.len()];
        views.iter().flat_map(|(_, shown)| shown).for_each(|index| is_seen[*index] = true);
        (0..is_seen.len()).filter(|index| !is_seen[*index]).collect()
    }

    /// Returns the views of an image, each with the indices of the objects that it may show; `None` where anything may
    /// be seen.
    fn views(&self, first: View) -> Option<Vec<(View, Vec<usize>)>> {
        let mut views: Vec<(View, Vec<usize>)> = Vec::new();
        let mut next = vec![(first, None)];
        while let Some((view, mirror)) = next.pop() {
            if views.len() + next.len() >= MAX_VIEWS {
                return None;
            }
            let shows = |index: &usize| {
                let (object, bounds) = (&self.model.objects[*index], self.bounds[*index].as_ref());
                view.clearance(object, bounds) == 0.0
            };
            let count = self.model.objects.len();
            let shown = parallel::map_ranges(count, MANY, &|range| range.filter(shows).collect());
            // Where rays are bent, anything may be seen.
            if shown.iter().any(|index| self.model.objects[*index].material.interface.is_some()) {
                return None;
            }
            for index in shown.iter().filter(|index| mirror != Some(**index) && self.reflects(**index)) {
                let [at, normal] = self.model.objects[*index].shape.facts().plane?;
                if !normal.is_normalized() {
                    return None;
                }
                next.push((view.mirrored(at, normal), Some(*index)));
            }
            views.push((view, shown));
        }
        Some(views)
    }

    /// Tells whether rays may be reflected by an object.
    fn reflects(&self, index: usize) -> bool {
        self.depth.is_some_and(|depth| {
            let mirrored = &depth.objects[index].mirrored;
            // Without a bound on all light, no branch is cut as too faint.
            if depth.most.is_finite() { mirrored.faint != 0.0 } else { mirrored.weight != 0.0 }
        })
    }

    /// Returns why a light adds nothing to the visible part of an object; `None` where it may.
    fn darkness(
        &self,
        light: &Lamp,
        object: &Object,
        seen: &VisibleRegion,
        view: Option<&View>,
    ) -> Option<UnlitReason> {
        if self.is_black(light, object) {
            return Some(UnlitReason::Black);
        }
        let (location, size) = (light.location(), light.size());
        if let Some([at, normal]) = object.shape.facts().plane.filter(|_| !light.is_far()) {
            let height = |point| normal.dot(point - at);
            let slack = size + 1e-9 * (at.abs() + location.abs()).max_element();
            let turned = match (object.shape.is_two_sided(), view) {
                (false, _) => Some(1.0),
                // The normal is turned to where the rays come from.
                (true, Some(view))
                    if height(view.apex).abs() > 1e-9 * (at.abs() + view.apex.abs()).max_element() =>
                {
                    Some(height(view.apex).signum())
                }
                (true, _) => None,
            };
            if turned.is_some_and(|side| side * height(location) < -slack) {
                return Some(UnlitReason::Behind);
            }
        }
        light.is_clear_of(&seen.bounds.with_slack(0.0)).then_some(UnlitReason::Aside)
    }

    /// Tells whether an object reflects nothing of a light.
    fn is_black(&self, light: &Lamp, object: &Object) -> bool {
        let look: Option<Look> = object.shader.brightest(&object.material);
        let (Some(sent), Some(look)) = (light.brightest(), look) else { return false };
        let shines = match object.material.shininess {
            0.0 => Rgb::ZERO,
            _ => look.specular.abs() + object.material.highlight,
        };
        let is_matt_black = sent * look.diffuse == Rgb::ZERO && sent * shines == Rgb::ZERO;
        let is_mirrored = object.material.roughness() != 0.0 && super::lamps::is_aimed_at(light);
        if (object.material.glints() || is_mirrored) && sent != Rgb::ZERO {
            return false;
        }
        // Where rays continue, shadow rays count toward the limit of rays, so even black ones may make a difference.
        // Within 1e-154 of a point, distances are 0, and 0 divided by 0 is NaN.
        let is_plain = self.depth.is_none() && light.location().abs().max_element() > 1e-100;
        is_matt_black && (is_plain || look.diffuse == Rgb::ZERO && shines == Rgb::ZERO)
    }
}

/// Bounds how much each light changes any pixel, in levels of 255; infinite where nothing bounds it.
pub(crate) fn most_levels(model: &Model) -> Vec<f64> {
    let viewer = model.camera.value.origins();
    // No path is shorter than the distance of the nearest object.
    let clearance = |object| (depth::clearance(object, viewer.middle) - viewer.radius).max(0.0);
    let near = model.objects.iter().map(clearance).fold(f64::INFINITY, f64::min);
    let rules = model.camera.value.rules;
    depth::most_of_lights(model).into_iter().map(|most| 255.0 * rules.over_path(most, near)).collect()
}
