//! The surfaces at some places of an image, and the lights that reach them.

use glam::DVec3;
use tabray_core::render::observer::{Event, LightOutcome, RayPurpose, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::world::material::Rgb;
use tabray_core::world::rules::Rules;

/// The maximum number of object tests of a survey, which tests each object for each ray.
const MAX_TESTS: usize = 1 << 23;

/// The effect of a light at the places that are looked at.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// Its least distance from a place that it lights, in world units.
    pub near: f64,
    /// The most light that it adds to any channel of the image.
    pub most: f64,
    /// That light without any division by lengths.
    pub free: f64,
    /// The number of places that it lights.
    pub shines: usize,
    /// The number of places that objects hide from it.
    pub blocked: usize,
    /// The number of places that face away from it.
    pub behind: usize,
    /// The number of places beside its beam.
    pub aside: usize,
}

/// The surfaces at some places of an image, without mirrors and glass.
pub struct Survey<'p> {
    pub plan: &'p Plan<'p>,
    /// The number of places that show an object.
    pub hits: usize,
    /// The least distance of an object.
    pub near: f64,
    /// The most light that objects show by `ambient`.
    pub ambient: f64,
    /// The most light of each channel of a place.
    pub seen: Vec<f64>,
    pub lamps: Vec<Lamp>,
    /// Whether the current ray comes from the viewer.
    is_primary: bool,
    /// Whether a shadow ray is on its way.
    in_shadow: bool,
    current: Hit,
}

/// The hit of a ray from the viewer.
#[derive(Default)]
struct Hit {
    point: DVec3,
    distance: f64,
    ambient: f64,
    /// For each light that shines on the point: its index, the light that it adds before a division by the length of
    /// the path, and its distance.
    lit: Vec<(usize, f64, f64)>,
}

impl<'p> Survey<'p> {
    /// Looks at these pixels of a plan for any ray, by column and row from the bottom.
    pub fn of(plan: &'p Plan<'p>, places: &[[usize; 2]]) -> Self {
        let lamp =
            Lamp { near: f64::INFINITY, most: 0.0, free: 0.0, shines: 0, blocked: 0, behind: 0, aside: 0 };
        let mut survey = Self {
            plan,
            hits: 0,
            near: f64::INFINITY,
            ambient: 0.0,
            seen: Vec::new(),
            lamps: vec![lamp; plan.model.lights.len()],
            is_primary: true,
            in_shadow: false,
            current: Hit::default(),
        };
        let tests = plan.model.objects.len() * (1 + plan.model.lights.len());
        let step = (places.len() * tests).div_ceil(MAX_TESTS).max(1);
        let sights = places.iter().step_by(step).map(|[x, y]| plan.camera.sight(*x as f64, *y as f64));
        let colours = trace::observe_colours(plan, sights, &mut survey);
        survey.seen = colours.into_iter().map(Rgb::max_element).collect();
        survey
    }

    /// Returns the lights, the brightest first, by their indices.
    pub fn brightest(&self) -> Vec<usize> {
        let mut all: Vec<_> = (0..self.lamps.len()).collect();
        all.sort_by(|one, other| self.lamps[*other].most.total_cmp(&self.lamps[*one].most));
        all
    }

    /// Returns the name of a light, in quotes.
    pub fn name(&self, light: usize) -> String {
        format!("`{}`", self.plan.model.lights[light].args.name())
    }
}

impl TraceObserver for Survey<'_> {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::Begin(RayPurpose::Shadow { .. }) => self.in_shadow = true,
            Event::Begin(purpose) => self.is_primary = purpose == RayPurpose::Primary,
            Event::Light(..) if !self.is_primary => self.in_shadow = false,
            _ if !self.is_primary => {}
            Event::FirstHit(Some(hit)) if !self.in_shadow => {
                self.current = Hit { point: hit.point, distance: hit.distance, ..Hit::default() };
            }
            Event::Surface { ambient, .. } => self.current.ambient = ambient.max_element(),
            Event::Light(light, outcome) => {
                self.in_shadow = false;
                let lamp = &mut self.lamps[light];
                match outcome {
                    LightOutcome::Behind => lamp.behind += 1,
                    LightOutcome::Aside => lamp.aside += 1,
                    LightOutcome::Blocked(_) => lamp.blocked += 1,
                    LightOutcome::Shines { colour, .. } => {
                        let lamp = &self.plan.model.lights[light].value;
                        let away = lamp.location().distance(self.current.point);
                        let distance = if lamp.is_far() { f64::INFINITY } else { away };
                        let lamp = &mut self.lamps[light];
                        (lamp.shines, lamp.near) = (lamp.shines + 1, lamp.near.min(distance));
                        self.current.lit.push((light, colour.max_element(), distance));
                    }
                }
            }
            Event::Shaded { .. } => {
                let Hit { distance, ambient, lit, .. } = std::mem::take(&mut self.current);
                let is_notes = self.plan.camera.rules == Rules::Notes;
                let path = if is_notes { distance } else { 1.0 };
                self.hits += 1;
                self.near = self.near.min(distance);
                self.ambient = self.ambient.max(ambient / path);
                for (light, colour, away) in lit {
                    let lamp = &mut self.lamps[light];
                    lamp.most = lamp.most.max(colour / path);
                    lamp.free = lamp.free.max(if is_notes { colour * away } else { colour });
                }
            }
            _ => {}
        }
    }
}
