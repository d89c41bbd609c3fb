//! What an image needs of its scene: the objects that some ray may meet, and the lights that may light what is seen.
//!
//! **Views.** Primary rays lead away from the viewer, between the edges of the image. Where they may meet a mirror in a
//! plane, the rays that it reflects lead away from the viewer's mirror image, in front of the mirror; and so on from
//! mirror to mirror. Glass does not turn rays. A curved mirror may show everything, and so may more than [`MAX_VIEWS`]
//! views: then no object is left out.
//!
//! **Lights.** A light is left out where it adds nothing to anything that a view may meet: it lies behind the object's
//! plane, it does not shine on the object's region ([`is_clear_of`](crate::world::light::Light::is_clear_of)), or the
//! product of its colour and the object's reflectivities is black.
//!
//! **Objects.** An object is left out where it is clear of all views, and of all paths from what is seen to a light that
//! is needed. What is left out is tested by no ray that could meet it, so the image stays the same to the byte. All tests
//! have margins far above the rounding errors of rays.
//!
//! Where pixels take more samples the less certain their colours are, nothing is left out: that is decided by pixels around
//! the image too, and by which lights shine on what a ray meets, even on black.
//!
//! The notes' program tests every ray against every shape, so with `--method classic` nothing is left out.

mod hull;
mod view;

use crate::geometry::aabb::Aabb;
use crate::render::plan::depth::{self, Depth};
use crate::scene::model::{Model, Object};
use crate::world::accuracy::Accuracy;
use crate::world::body::AnyLight;
use crate::world::material::{Look, Rgb};
use hull::Hull;
use rayon::prelude::*;
use view::{Seen, View};

/// The maximum number of views, of the viewer and of the mirrors together.
const MAX_VIEWS: usize = 16;

/// The number of objects from which on they are judged on all threads.
const MANY: usize = 1 << 12;

/// What an image needs.
pub(crate) struct Needs {
    /// The indices of the lights that are needed.
    pub lights: Vec<usize>,
    /// The indices of the lights that are not, each with the reason.
    pub dark: Vec<(usize, Darkness)>,
    /// The indices of the objects that are not needed.
    pub unmet: Vec<usize>,
    /// A lower bound on the distance of these objects from all rays, in world units.
    pub clearance: f64,
}

/// Why a light is not needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Darkness {
    /// What is seen reflects none of its light.
    Black,
    /// All that is seen turns away from it.
    Behind,
    /// It does not shine on what is seen.
    Aside,
    /// Each of these holds for some of what is seen.
    Mixed,
}

impl Darkness {
    /// Describes the reason.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Black => "nothing that is seen reflects its colour",
            Self::Behind => "it is behind all that is seen",
            Self::Aside => "it does not shine on anything that is seen",
            Self::Mixed => "it is behind what is seen, or does not shine on it",
        }
    }
}

impl Needs {
    /// Everything.
    pub fn all(model: &Model) -> Self {
        let lights = (0..model.lights.len()).collect();
        Self { lights, dark: Vec::new(), unmet: Vec::new(), clearance: f64::INFINITY }
    }

    /// What the image of the model's camera needs, given the objects' bounding boxes. `depth` has the mirrors that
    /// reflect nothing.
    pub fn of(model: &Model, bounds: &[Option<Aabb>], depth: Option<&Depth>) -> Self {
        if model.camera.value.adaptive.is_some() {
            return Self::all(model);
        }
        // Rays of a draft may be off by 1e-3 of their length.
        let margin = match model.camera.value.accuracy {
            Accuracy::Classic => return Self::all(model),
            Accuracy::Draft => 1e-2,
            Accuracy::Exact | Accuracy::Strict => 1e-9,
        };
        let Some(view) = View::of(&model.camera.value, margin) else { return Self::all(model) };
        let scene = Scene { model, bounds, depth };
        scene.needs(view)
    }
}

/// A scene, and what is known of it.
struct Scene<'s> {
    model: &'s Model,
    bounds: &'s [Option<Aabb>],
    depth: Option<&'s Depth>,
}

impl Scene<'_> {
    fn needs(&self, view: View) -> Needs {
        let views = self.views(view);
        let everything = |index: usize| Seen::of(self.bounds[index].as_ref());
        // For each view, the objects that it may show. Where anything may be seen, it is seen from anywhere.
        let all: Vec<usize> = (0..self.model.objects.len()).collect();
        let shown: Vec<(Option<&View>, &[usize])> = match &views {
            Some(views) => views.iter().map(|(view, shown)| (Some(view), &shown[..])).collect(),
            None => vec![(None, &all)],
        };
        let mut needs =
            Needs { lights: Vec::new(), dark: Vec::new(), unmet: Vec::new(), clearance: f64::INFINITY };
        let candidates = views.as_deref().map_or_else(Vec::new, |views| self.unseen(views));
        let mut regions: Vec<Hull> = Vec::new();
        for (index, item) in self.model.lights.iter().enumerate() {
            let (light, mut reason) = (&item.value, None);
            let mut is_needed = false;
            for (view, shown) in &shown {
                let mut depth: Option<f64> = None;
                for object in *shown {
                    let bounds = self.bounds[*object].as_ref();
                    let of = &self.model.objects[*object];
                    let seen = view.map_or_else(|| everything(*object), |view| view.seen(of, bounds));
                    match self.darkness(light, of, &seen, *view) {
                        None => {
                            is_needed = true;
                            match view {
                                Some(view) if !candidates.is_empty() => {
                                    depth = Some(view.depth(&seen).max(depth.unwrap_or(0.0)));
                                }
                                _ => break,
                            }
                        }
                        Some(own) if reason.is_none_or(|reason| reason == own) => reason = Some(own),
                        Some(_) => reason = Some(Darkness::Mixed),
                    }
                }
                let region = |(view, depth): (&View, f64)| view.paths(depth, light.location(), light.size());
                regions.extend(view.zip(depth).map(region));
            }
            if is_needed {
                needs.lights.push(index);
            } else {
                needs.dark.push((index, reason.unwrap_or(Darkness::Black)));
            }
        }
        let Some(views) = views else { return needs };
        let clearance = |index: &usize| {
            let (object, bounds) = (&self.model.objects[*index], self.bounds[*index].as_ref());
            let views = views.iter().map(|(view, _)| view.clearance(object, bounds));
            let paths = regions.iter().map(|region| view::clearance(region, object, bounds));
            // Stops at the first that the object may meet.
            views.chain(paths).try_fold(f64::INFINITY, |least, one| (one > 0.0).then_some(least.min(one)))
        };
        let clear: Vec<_> = if candidates.len() < MANY {
            candidates.iter().map(clearance).collect()
        } else {
            candidates.par_iter().map(clearance).collect()
        };
        for (index, clearance) in candidates.into_iter().zip(clear) {
            if let Some(clearance) = clearance {
                needs.unmet.push(index);
                needs.clearance = needs.clearance.min(clearance);
            }
        }
        needs
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
            let shown: Vec<_> = if count < MANY {
                (0..count).filter(shows).collect()
            } else {
                (0..count).into_par_iter().filter(shows).collect()
            };
            for index in shown.iter().filter(|index| mirror != Some(**index) && self.reflects(**index)) {
                let [at, normal] = self.model.objects[*index].shape.plane()?;
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

    /// Returns why a light adds nothing to where an object is seen; `None` where it may.
    fn darkness(
        &self,
        light: &AnyLight,
        object: &Object,
        seen: &Seen,
        view: Option<&View>,
    ) -> Option<Darkness> {
        if self.is_black(light, object) {
            return Some(Darkness::Black);
        }
        let (location, size) = (light.location(), light.size());
        if let Some([at, normal]) = object.shape.plane() {
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
                return Some(Darkness::Behind);
            }
        }
        light.is_clear_of(&seen.bounds.with_slack(0.0)).then_some(Darkness::Aside)
    }

    /// Tells whether all light that an object reflects of a light is black.
    fn is_black(&self, light: &AnyLight, object: &Object) -> bool {
        let look: Option<Look> = object.shader.brightest(&object.material);
        let (Some(sent), Some(look)) = (light.brightest(), look) else { return false };
        let shines = if object.material.shininess == 0.0 { Rgb::ZERO } else { look.specular };
        let is_matt_black = sent * look.diffuse == Rgb::ZERO && sent * shines == Rgb::ZERO;
        // Where rays continue, shadow rays count toward the limit of rays, so that they may make a difference. Within
        // 1e-154 of a point, distances are 0, and 0 divided by them is no number.
        let is_plain = self.depth.is_none() && light.location().abs().max_element() > 1e-100;
        is_matt_black && (is_plain || look.diffuse == Rgb::ZERO && shines == Rgb::ZERO)
    }
}

/// Bounds how much each light changes any pixel, in levels of 255; infinite where nothing bounds it.
pub(crate) fn most_levels(model: &Model) -> Vec<f64> {
    let viewer = model.camera.value.viewpoint;
    // No path is shorter than the distance of the nearest object.
    let near =
        model.objects.iter().map(|object| depth::clearance(object, viewer)).fold(f64::INFINITY, f64::min);
    (0..model.lights.len()).map(|light| 255.0 * depth::most_of_light(model, light) / near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::observer::{Event, Outcome, TraceObserver};
    use crate::render::plan::Plan;
    use crate::render::trace;
    use crate::scene::reader;
    use crate::scene::registry::Registry;
    use std::collections::BTreeSet;
    use std::path::Path;

    /// The objects that rays meet, and the lights that shine.
    #[derive(Default)]
    struct Met(BTreeSet<usize>, BTreeSet<usize>);

    impl TraceObserver for Met {
        const SEES: bool = true;

        fn see(&mut self, event: Event) {
            match event {
                Event::Met(Some(hit)) => drop(self.0.insert(hit.index)),
                Event::Light(_, Outcome::Blocked(index)) => drop(self.0.insert(index)),
                Event::Light(light, Outcome::Shines { colour, .. }) if colour != Rgb::ZERO => {
                    self.1.insert(light);
                }
                _ => {}
            }
        }
    }

    fn model(text: &str) -> Model {
        let registry = Registry::get().expect("sound types");
        let read = reader::read(registry, "scene", Path::new(""), text.as_bytes(), None);
        read.unwrap_or_else(|report| panic!("{report}\n{text}")).model
    }

    /// Checks that no ray meets what is left out, and returns the numbers of objects and lights that are.
    fn left_out(text: &str) -> [usize; 2] {
        let model = model(text);
        let [whole, plan] = [Plan::new(&model), Plan::for_picture(&model)];
        let mut met = Met::default();
        let [width, height] = model.camera.value.pixels;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let all = trace::observe_pixel(&whole, x, y, &mut met);
            let colour = trace::pixel(&plan, x, y);
            assert_eq!(
                colour.to_array().map(f64::to_bits),
                all.to_array().map(f64::to_bits),
                "{x} {y}\n{text}"
            );
        }
        let Needs { unmet, dark, .. } = &plan.needs;
        let wrong: Vec<_> = unmet.iter().filter(|index| met.0.contains(index)).collect();
        assert!(wrong.is_empty(), "objects {wrong:?} are met\n{text}");
        let wrong: Vec<_> = dark.iter().filter(|(index, _)| met.1.contains(index)).collect();
        assert!(wrong.is_empty(), "lights {wrong:?} shine\n{text}");
        [unmet.len(), dark.len()]
    }

    const CAMERA: &str = "camera eye { pixeldim 12 9 worlddim 8 6 viewpoint 4 3 7 }
        material matt { ambient 1 1 1 diffuse 2 2 2 } material mirror { specular 0.5 }
        material glass { diffuse 1 2 1 transparency 0.5 }";
    const FLOOR: &str = "plane floor { material matt normal 0 1 0 point 0 0 0 }";
    const LAMP: &str = "light lamp { location 4 9 2 emissivity 5 5 5 }";

    #[test]
    fn what_lies_behind_the_viewer_is_left_out_unless_it_is_mirrored_or_casts_a_shadow() {
        let behind = "sphere behind { material matt center 4 3 30 radius 1 }";
        assert_eq!(left_out(&format!("{CAMERA} {FLOOR} {LAMP} {behind}")), [1, 0]);
        let wall = "plane wall { material mirror normal 0 0 1 point 0 0 -4 }";
        assert_eq!(left_out(&format!("{CAMERA} {wall} {behind}")), [0, 0]);
        let turned = "plane wall { material mirror normal 1 0 1 point 0 0 -9 }";
        assert_eq!(left_out(&format!("{CAMERA} {turned} {behind}")), [1, 0], "it shows what is to the right");
        let ball = "sphere ball { material mirror center 4 3 -4 radius 1 }";
        assert_eq!(left_out(&format!("{CAMERA} {ball} {behind}")), [0, 0]);
        let lamp = "light lamp { location 4 3 40 emissivity 5 5 5 }";
        assert_eq!(left_out(&format!("{CAMERA} {FLOOR} {lamp} {behind}")), [0, 0]);
        assert_eq!(
            left_out(&format!(
                "{CAMERA} {FLOOR} {behind} plane back {{ material matt normal 0 0 -1 point 0 0 50 }}"
            )),
            [2, 0]
        );
    }

    #[test]
    fn lights_that_reach_nothing_are_left_out() {
        let scene = |light: &str| left_out(&format!("{CAMERA} {FLOOR} {LAMP} light other {{ {light} }}"))[1];
        assert_eq!(scene("location 4 -1 2 emissivity 5 5 5"), 1, "below the floor");
        assert_eq!(scene("location 4 1 2 emissivity 5 5 5"), 0);
        assert_eq!(scene("location 4 1 2 emissivity 0 0 0"), 1);
        assert_eq!(scene("location 4 -1 2 emissivity 5 5 5 size 1.5"), 0, "a part of it is above");
        let ball = format!("{CAMERA} sphere ball {{ material matt center 4 3 -4 radius 1 }}");
        let spot = |point: &str| {
            left_out(&format!(
                "{ball} spotlight s {{ location 4 9 -4 emissivity 5 5 5 point {point} theta 5 }}"
            ))[1]
        };
        assert_eq!([spot("4 3 -4"), spot("9 3 -4")], [0, 1]);
        let projector = |location: &str, point: &str| {
            left_out(&format!(
                "{ball} texture t {{ filename scenes/textures/bricks.png }}
                projector p {{ location {location} emissivity 5 5 5 normal 0 1 0 point {point} xdir 1 0 0 dimensions 1 1 texname t mode 0 }}"
            ))[1]
        };
        assert_eq!(projector("4 9 -4", "3.5 7 -3.5"), 0, "onto the ball");
        assert_eq!(projector("4 9 -4", "8 7 -3.5"), 1, "beside it");
        assert_eq!(projector("4 9 -4", "3.5 1 -3.5"), 1, "the ball lies before the rectangle");
        assert_eq!(
            projector("4 9 -4", "3.5 11 -4.5"),
            0,
            "a path to the light may end in the rectangle behind it"
        );
    }

    /// Makes scenes with objects and lights all around the viewer; some of the planes are mirrors.
    fn scene(state: &mut u64) -> String {
        let mut random = || {
            *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (*state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut text = CAMERA.to_owned();
        let mirrors = random() < 0.5;
        for index in 0..14 {
            let mut from = |low: f64, high: f64| low + (high - low) * random();
            let [x, y, z] = [from(-30.0, 38.0), from(-30.0, 36.0), from(-30.0, 40.0)];
            let [a, b, c] = [from(-1.0, 1.0), from(-1.0, 1.0), from(-1.0, 1.0)];
            let (size, kind) = (from(0.2, 6.0), from(0.0, 1.0));
            let matt = ["matt", "glass", "matt"][(3.0 * from(0.0, 1.0)) as usize];
            let flat = if mirrors && from(0.0, 1.0) < 0.3 { "mirror" } else { matt };
            text += &if kind < 0.5 {
                format!("sphere o{index} {{ material {matt} center {x} {y} {z} radius {size} }}\n")
            } else if kind < 0.8 {
                format!(
                    "fplane o{index} {{ material {flat} normal {a} {b} {c} point {x} {y} {z} xdir {b} {c} {a} dimensions {size} 5 }}\n"
                )
            } else if kind < 0.9 {
                format!("plane o{index} {{ material {flat} normal {a} {b} {c} point {x} {y} {z} }}\n")
            } else {
                String::new()
            };
        }
        for index in 0..3 {
            let mut from = |low: f64, high: f64| low + (high - low) * random();
            let [x, y, z] = [from(-9.0, 17.0), from(-9.0, 15.0), from(-19.0, 17.0)];
            let kind = from(0.0, 1.0);
            text += &if kind < 0.5 {
                format!("light l{index} {{ location {x} {y} {z} emissivity 5 4 3 }}\n")
            } else if kind < 0.7 {
                format!("light l{index} {{ location {x} {y} {z} emissivity 5 4 3 size 2 }}\n")
            } else {
                format!(
                    "spotlight l{index} {{ location {x} {y} {z} emissivity 5 4 3 point 4 3 0 theta {} }}\n",
                    from(1.0, 40.0)
                )
            };
        }
        text
    }

    #[test]
    fn no_projector_shines_that_is_left_out_of_scenes_made_at_random() {
        let (mut state, mut sum) = (7_u64, 0);
        for _ in 0..200 {
            let mut from = |low: f64, high: f64| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let mut place = |size: f64| [0; 3].map(|_| from(-size, size));
            let ([x, y, z], [a, b, c], [d, e, f], [g, h, i]) =
                (place(6.0), place(1.0), place(3.0), place(2.0));
            let left_out = left_out(&format!(
                "{CAMERA} sphere ball {{ material matt center 4 3 -4 radius 1 }}
                fplane leaf {{ material matt normal {b} {c} 1 point {} 2 -3 xdir 1 {a} 0 dimensions 2 1 }}
                texture t {{ filename scenes/textures/bricks.png }}
                projector p {{ location {x} {y} {z} emissivity 5 4 3 normal {a} {b} {c} point {} {} {}
                    xdir {b} {c} {a} dimensions {} {} texname t mode 0 }}",
                3.0 + g,
                x + d,
                y + e,
                z + f,
                2.5 + h,
                2.5 + i
            ));
            sum += left_out[1];
        }
        assert!((20..180).contains(&sum), "{sum} of 200 projectors");
    }

    #[test]
    fn no_ray_meets_what_is_left_out_of_scenes_made_at_random() {
        let (mut state, mut sum) = (18, [0; 2]);
        for _ in 0..300 {
            let left_out = left_out(&scene(&mut state));
            sum = [sum[0] + left_out[0], sum[1] + left_out[1]];
        }
        assert!(sum[0] > 300 && sum[1] > 30, "{sum:?} of 300 scenes");
    }
}
