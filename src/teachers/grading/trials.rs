//! Mistakes about single pixels: the scene is changed, and a change explains a pixel where the changed scene shows
//! the picture's colour.

use super::compared::{Compared, apart};
use super::mistake::Mistake;
use super::views::View;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::iter;
use std::sync::Arc;
use tabray_core::render::Renderer;
use tabray_core::render::observer::{Event, LightOutcome, RayPurpose, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::world::material::{Material, Rgb};

/// The maximum number of changed scenes.
const MAX_TRIALS: usize = 256;

/// The maximum number of lights for which trials are made one by one.
const MAX_LIGHTS: usize = 6;

/// The number of objects that are taken away, one behind the other.
const DEEPEST: usize = 3;

/// The number of levels by which a pixel may differ from a neighbour whose object is seen one pixel too far.
const BESIDE: u8 = 4;

/// A change of the scene.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Trial {
    /// This object alone, without these lights. Objects in the way of the other lights are gone.
    Alone { object: usize, dark: Vec<usize> },
    /// Without these lights.
    Dark(Vec<usize>),
    /// Without any glint.
    Dull,
    /// Without these objects.
    Without(Vec<usize>),
}

/// The scene at a pixel.
struct Seen {
    at: [usize; 2],
    object: Option<usize>,
    /// The lights that shine on the object, and those that other objects block.
    shining: Vec<usize>,
    blocked: Vec<usize>,
    /// The mistake that explains the pixel, if there is one, and its rank.
    mistake: Option<(usize, Mistake)>,
    /// The light of the pixel, and that without any glint.
    light: Rgb,
    dull: Option<Rgb>,
}

/// Changes scenes, and looks at their pixels.
struct Trials<'t, E> {
    renderer: &'t Renderer,
    compared: &'t Compared<'t>,
    make: &'t mut dyn FnMut() -> Result<Model, E>,
    view: View,
    left: usize,
}

/// Explains pixels that differ from the right image in this view.
///
/// # Errors
/// Returns the errors of `make`.
pub(super) fn explain<E>(
    renderer: &Renderer,
    compared: &Compared,
    make: &mut dyn FnMut() -> Result<Model, E>,
    view: View,
    different: Vec<[usize; 2]>,
) -> Result<Vec<([usize; 2], Mistake)>, E> {
    let seen = |at: &[usize; 2]| Seen::of(compared, view, *at);
    let mut pixels: Vec<Seen> = renderer.run(|| different.par_iter().map(seen).collect());
    let mut trials = Trials { renderer, compared, make, view, left: MAX_TRIALS };
    trials.of_light(&mut pixels)?;
    trials.of_objects(&mut pixels)?;
    pixels.iter_mut().for_each(|pixel| pixel.look_beside(compared, view));
    of_glints(compared, view, &mut pixels);
    let found = pixels
        .into_iter()
        .map(|pixel| (pixel.at, pixel.mistake.map_or(Mistake::Other, |(_, mistake)| mistake)));
    Ok(found.collect())
}

impl<E> Trials<'_, E> {
    /// Looks at pixels of the changed scene, by their indices. `each` gets the index, the value that was passed with
    /// it, the light and the object.
    fn run<T: Copy + Sync>(
        &mut self,
        trial: &Trial,
        pixels: &[Seen],
        asked: &[(usize, T)],
        mut each: impl FnMut(usize, T, Rgb, Option<usize>),
    ) -> Result<(), E> {
        let Some(left) = self.left.checked_sub(1) else { return Ok(()) };
        self.left = left;
        let mut model = (self.make)()?;
        let kept = trial.change(&mut model);
        let (plan, view) = (Plan::new(&model), self.view);
        let look = |(index, _): &(usize, T)| {
            let at = pixels[*index].at;
            let object = view.sight(&plan, at).and_then(|sight| trace::first_hit(&plan, &sight));
            (view.light(&plan, at), object.map(|hit| kept[hit.index]))
        };
        let found: Vec<_> = self.renderer.run(|| asked.par_iter().map(look).collect());
        for ((index, what), (light, object)) in iter::zip(asked, found) {
            if let Some(light) = light {
                each(*index, *what, light, object);
            }
        }
        Ok(())
    }

    /// Tells whether a pixel of the picture shows this light.
    fn shows(compared: &Compared, view: View, at: [usize; 2], light: Rgb) -> bool {
        apart(view.shown(compared, light), compared.theirs(at)) <= 1
    }

    /// Tries lights that shine where they should not, or do not where they should, and missing glints.
    fn of_light(&mut self, pixels: &mut [Seen]) -> Result<(), E> {
        let mut asked: BTreeMap<Trial, Vec<(usize, usize)>> = BTreeMap::new();
        for (index, pixel) in pixels.iter().enumerate() {
            for (rank, (trial, _)) in pixel.candidates().into_iter().enumerate() {
                asked.entry(trial).or_default().push((index, rank));
            }
        }
        let (compared, view) = (self.compared, self.view);
        for (trial, asked) in asked {
            let mut matches = Vec::new();
            self.run(&trial, pixels, &asked, |index, rank, light, _| matches.push((index, rank, light)))?;
            for (index, rank, light) in matches {
                let pixel = &mut pixels[index];
                if trial == Trial::Dull {
                    pixel.dull = Some(light);
                }
                let is_better = pixel.mistake.as_ref().is_none_or(|(other, _)| rank < *other);
                if is_better && Self::shows(compared, view, pixel.at, light) {
                    pixel.mistake =
                        pixel.candidates().into_iter().nth(rank).map(|(_, mistake)| (rank, mistake));
                }
            }
        }
        Ok(())
    }

    /// Takes away the objects that are seen, and those behind them.
    fn of_objects(&mut self, pixels: &mut [Seen]) -> Result<(), E> {
        let (compared, view) = (self.compared, self.view);
        let mut gone: Vec<(usize, Vec<usize>)> = Vec::new();
        for (index, pixel) in pixels.iter().enumerate() {
            if let (None, Some(object)) = (&pixel.mistake, pixel.object) {
                gone.push((index, vec![object]));
            }
        }
        for _ in 0..DEEPEST {
            let mut asked: BTreeMap<Vec<usize>, Vec<(usize, ())>> = BTreeMap::new();
            for (index, objects) in gone.drain(..) {
                asked.entry(objects).or_default().push((index, ()));
            }
            for (objects, asked) in asked {
                let mut looks = Vec::new();
                let trial = Trial::Without(objects.clone());
                self.run(&trial, pixels, &asked, |index, (), light, object| {
                    looks.push((index, light, object))
                })?;
                for (index, light, object) in looks {
                    let pixel = &mut pixels[index];
                    if Self::shows(compared, view, pixel.at, light) {
                        pixel.mistake = Some((0, Mistake::Object { shown: object, right: pixel.object }));
                    } else if let Some(object) = object {
                        let mut objects = objects.clone();
                        objects.push(object);
                        objects.sort_unstable();
                        gone.push((index, objects));
                    }
                }
            }
        }
        Ok(())
    }
}

impl Trial {
    /// Changes a scene, and returns the former indices of its objects.
    fn change(&self, model: &mut Model) -> Vec<usize> {
        let all = model.objects.len();
        let keep = |model: &mut Model, is_kept: &dyn Fn(usize) -> bool| -> Vec<usize> {
            let mut index = 0..;
            model.objects.retain(|_| index.next().is_some_and(is_kept));
            (0..all).filter(|index| is_kept(*index)).collect()
        };
        let darken = |model: &mut Model, lights: &[usize]| {
            let mut index = 0..;
            model.lights.retain(|_| index.next().is_some_and(|index: usize| !lights.contains(&index)));
        };
        match self {
            Self::Alone { object, dark } => {
                darken(model, dark);
                keep(model, &|index| index == *object)
            }
            Self::Without(objects) => keep(model, &|index| !objects.contains(&index)),
            Self::Dark(lights) => {
                darken(model, lights);
                (0..all).collect()
            }
            Self::Dull => {
                for object in &mut model.objects {
                    object.material =
                        Arc::new(Material { shininess: 0.0, ..Material::clone(&object.material) });
                }
                (0..all).collect()
            }
        }
    }
}

impl Seen {
    fn of(compared: &Compared, view: View, at: [usize; 2]) -> Self {
        let mut listener = Listener::default();
        let sight = view.sight(compared.plan, at);
        if let Some(sight) = &sight {
            trace::observe_colour(compared.plan, sight, None, &mut listener);
        }
        let Listener { object, shining, blocked, .. } = listener;
        let light = view.light(compared.plan, at).unwrap_or_default();
        Self { at, object: object.flatten(), shining, blocked, mistake: None, light, dull: None }
    }

    /// Returns changes of light that may explain the pixel, with the mistake of each, the likeliest first.
    fn candidates(&self) -> Vec<(Trial, Mistake)> {
        let Some(on) = self.object else { return Vec::new() };
        let mut all = Vec::new();
        let alone = |dark| Trial::Alone { object: on, dark };
        if !self.blocked.is_empty() {
            all.push((alone(Vec::new()), Mistake::ShadowMissing { lights: self.blocked.clone(), on }));
        }
        if (2..=MAX_LIGHTS).contains(&self.blocked.len()) {
            for light in &self.blocked {
                let dark = self.blocked.iter().copied().filter(|other| other != light).collect();
                all.push((alone(dark), Mistake::ShadowMissing { lights: vec![*light], on }));
            }
        }
        if self.shining.len() <= MAX_LIGHTS {
            for light in &self.shining {
                all.push((Trial::Dark(vec![*light]), Mistake::ShadowTooMuch { lights: vec![*light], on }));
            }
        }
        if self.shining.len() > 1 {
            all.push((
                Trial::Dark(self.shining.clone()),
                Mistake::ShadowTooMuch { lights: self.shining.clone(), on },
            ));
        }
        if !self.shining.is_empty() {
            all.push((Trial::Dull, Mistake::GlintMissing { on }));
        }
        all
    }

    /// Compares the pixel with those beside it that show other objects.
    fn look_beside(&mut self, compared: &Compared, view: View) {
        if self.mistake.is_some() || view != View::default() {
            return;
        }
        let [x, y] = self.at;
        let around = [-1, 0, 1].into_iter().flat_map(|up| [-1, 0, 1].map(|right| (right, up)));
        for (right, up) in around {
            let (Some(x), Some(y)) = (x.checked_add_signed(right), y.checked_add_signed(up)) else {
                continue;
            };
            if x >= compared.size[0] || y >= compared.size[1] {
                continue;
            }
            let shown = compared.object([x, y]);
            if shown != self.object && apart(compared.right([x, y]), compared.theirs(self.at)) <= BESIDE {
                self.mistake = Some((0, Mistake::Object { shown, right: self.object }));
                return;
            }
        }
    }
}

/// Explains pixels by more or less of a glint, and then those beside them, where the scene has hardly any.
fn of_glints(compared: &Compared, view: View, pixels: &mut [Seen]) {
    let mut known: BTreeSet<usize> = BTreeSet::new();
    for is_beside in [false, true] {
        for pixel in pixels.iter_mut().filter(|pixel| pixel.mistake.is_none()) {
            let (Some(on), Some(dull)) = (pixel.object, pixel.dull) else { continue };
            let [with, without] = [pixel.light, dull].map(|light| view.shown(compared, light));
            let glint = match is_beside {
                false if apart(with, without) > 0 => pixel.light - dull,
                true if known.contains(&on) => compared.plan.model.objects[on].material.specular,
                _ => continue,
            };
            if is_glint(compared, view, pixel.at, dull, glint) {
                pixel.mistake = Some((0, Mistake::GlintOther { on }));
            }
        }
        let glint = |pixel: &Seen| match pixel.mistake {
            Some((_, Mistake::GlintOther { on } | Mistake::GlintMissing { on })) => Some(on),
            _ => None,
        };
        known.extend(pixels.iter().filter_map(glint));
    }
}

/// Tells whether the picture shows light and any amount of a glint.
fn is_glint(compared: &Compared, view: View, at: [usize; 2], dull: Rgb, glint: Rgb) -> bool {
    let theirs = compared.theirs(at);
    let shown = |amount: f64| view.shown(compared, dull + amount * glint);
    let sum = |bytes: [u8; 3]| bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>();
    if glint.max_element() <= 0.0 || sum(theirs) < sum(shown(0.0)) {
        return false;
    }
    // More of a glint is brighter.
    let (mut less, mut more) = (0.0, 1e3);
    for _ in 0..40 {
        let middle = 0.5 * (less + more);
        if sum(shown(middle)) < sum(theirs) { less = middle } else { more = middle }
    }
    apart(shown(more), theirs) <= 1
}

/// Notes the first object and the lights on it.
#[derive(Default)]
struct Listener {
    object: Option<Option<usize>>,
    shining: Vec<usize>,
    blocked: Vec<usize>,
    /// Whether the first surface is shaded.
    is_over: bool,
}

impl TraceObserver for Listener {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::Begin(RayPurpose::Reflected { .. } | RayPurpose::Transmitted { .. })
            | Event::Shaded { .. } => {
                self.is_over = true;
            }
            Event::FirstHit(hit) if self.object.is_none() => self.object = Some(hit.map(|hit| hit.index)),
            Event::Light(light, LightOutcome::Blocked(_)) if !self.is_over => self.blocked.push(light),
            Event::Light(light, LightOutcome::Shines { .. }) if !self.is_over => self.shining.push(light),
            _ => {}
        }
    }
}
