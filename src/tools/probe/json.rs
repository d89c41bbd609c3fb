//! The explanation of a pixel for programs: its rays as a list, with all digits.

use serde::Serialize;
use tabray_core::render::observer::{DropReason, Event, Hit, LightOutcome, RayPurpose, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;

/// A pixel and its rays.
#[derive(Serialize)]
pub struct PixelExplained<'m> {
    /// The column from the left and the row from the bottom, from 0.
    pixel: [usize; 2],
    /// The width and the height of the image in pixels.
    size: [usize; 2],
    /// The number of samples of the pixel. The rays are those of the one at its centre.
    samples: u32,
    rays: Vec<RayExplained<'m>>,
    /// The light of all samples, and the shown colour, from 0 to 1.
    light: [f64; 3],
    shown: [f64; 3],
    bytes: [u8; 3],
}

/// A ray. Values that it does not have are left out.
#[derive(Serialize)]
struct RayExplained<'m> {
    /// `primary`, `reflected`, `transmitted` or `shadow`.
    kind: &'static str,
    /// The number of the ray that led to this one, under the notes' rules. Under the free ones, rays are not nested.
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<usize>,
    /// The factor by which its colour is multiplied.
    #[serde(skip_serializing_if = "Option::is_none")]
    times: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    origin: Option<[f64; 3]>,
    /// The unit vector along the ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f64; 3]>,
    /// The reason why the ray is not followed.
    #[serde(skip_serializing_if = "Option::is_none")]
    dropped: Option<&'static str>,
    /// Its first hit: the name and the index of the object.
    #[serde(skip_serializing_if = "Option::is_none")]
    object: Option<&'m str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<usize>,
    /// The distance of the hit in world units.
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    point: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    normal: Option<[f64; 3]>,
    /// The contributions of the lights.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lights: Vec<LightExplained<'m>>,
    /// The surface's own colour, without transmitted and reflected light.
    #[serde(skip_serializing_if = "Option::is_none")]
    surface: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    colour: Option<[f64; 3]>,
}

/// The contribution of a light to a surface.
#[derive(Serialize)]
struct LightExplained<'m> {
    light: &'m str,
    /// `behind`, `aside`, `blocked` or `shines`.
    outcome: &'static str,
    /// The object in its way.
    #[serde(skip_serializing_if = "Option::is_none")]
    blocked_by: Option<&'m str>,
    /// The part of the light that arrives, and its contribution.
    #[serde(skip_serializing_if = "Option::is_none")]
    passed: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    adds: Option<[f64; 3]>,
}

/// Explains a pixel as [`pixel`](super::pixel) does.
pub fn explained<'m>(plan: &Plan<'m>, x: usize, y: usize) -> PixelExplained<'m> {
    let camera = &plan.camera;
    let mut listener = Listener { model: plan.model, rays: Vec::new(), open: Vec::new(), shadow: None };
    let of_centre = trace::observe_colour(plan, &camera.sight(x as f64, y as f64), None, &mut listener);
    let light = if camera.is_single() { of_centre } else { trace::pixel(plan, x, y) };
    let display = camera.display();
    PixelExplained {
        pixel: [x, y],
        size: camera.pixels,
        samples: camera.samples,
        rays: listener.rays,
        light: display.full_range(light).to_array(),
        shown: display.shown(light).to_array(),
        bytes: display.bytes(light),
    }
}

struct Listener<'m> {
    model: &'m Model,
    rays: Vec<RayExplained<'m>>,
    /// The rays that are not finished, by their numbers.
    open: Vec<usize>,
    /// The shadow ray under way, by its number.
    shadow: Option<usize>,
}

impl<'m> Listener<'m> {
    fn begin(&mut self, purpose: RayPurpose) {
        let (kind, times) = match purpose {
            RayPurpose::Primary => ("primary", None),
            RayPurpose::Transmitted { tint, .. } => ("transmitted", Some(tint)),
            RayPurpose::Reflected { specular } => ("reflected", Some(specular)),
            RayPurpose::Scattered { diffuse } => ("scattered", Some(diffuse)),
            RayPurpose::Shadow { .. } => ("shadow", None),
        };
        let number = self.rays.len();
        self.rays.push(RayExplained {
            kind,
            from: self.open.last().copied(),
            times: times.map(|times: Rgb| times.to_array()),
            origin: None,
            direction: None,
            dropped: None,
            object: None,
            number: None,
            distance: None,
            point: None,
            normal: None,
            lights: Vec::new(),
            surface: None,
            colour: None,
        });
        match kind {
            "shadow" => self.shadow = Some(number),
            _ => self.open.push(number),
        }
    }

    /// Returns the ray under way.
    fn ray(&mut self) -> Option<&mut RayExplained<'m>> {
        let number = self.shadow.or(self.open.last().copied())?;
        self.rays.get_mut(number)
    }

    fn light(&self, index: usize, outcome: LightOutcome) -> LightExplained<'m> {
        let model = self.model;
        let (outcome, blocked_by, shines) = match outcome {
            LightOutcome::Behind => ("behind", None, None),
            LightOutcome::Aside => ("aside", None, None),
            LightOutcome::Blocked(object) => ("blocked", Some(model.objects[object].args.name()), None),
            LightOutcome::Shines { passed, colour } => ("shines", None, Some([passed, colour])),
        };
        let [passed, adds] = [0, 1].map(|of| shines.map(|shines| shines[of].to_array()));
        LightExplained { light: model.lights[index].args.name(), outcome, blocked_by, passed, adds }
    }
}

impl TraceObserver for Listener<'_> {
    fn sees_events(&self) -> bool {
        true
    }

    fn see(&mut self, event: Event) {
        match event {
            Event::Begin(purpose) => return self.begin(purpose),
            Event::Light(index, outcome) => {
                self.shadow = None;
                let light = self.light(index, outcome);
                if let Some(ray) = self.ray() {
                    ray.lights.push(light);
                }
                return;
            }
            _ => {}
        }
        let name = match event {
            Event::FirstHit(Some(hit)) => Some(self.model.objects[hit.index].args.name()),
            _ => None,
        };
        let Some(ray) = self.ray() else { return };
        match event {
            Event::Search(of) => {
                (ray.origin, ray.direction) = (Some(of.origin.to_array()), Some(of.dir.to_array()));
            }
            Event::Dropped(reason) => {
                ray.dropped = Some(match reason {
                    DropReason::TooFar => "too far",
                    DropReason::TooFaint => "too faint",
                    DropReason::TooMany => "too many",
                });
            }
            Event::FirstHit(Some(Hit { index, distance, point, .. })) => {
                (ray.object, ray.number) = (name, Some(*index));
                (ray.distance, ray.point) = (Some(*distance), Some(point.to_array()));
            }
            Event::Surface { normal, .. } => ray.normal = Some(normal.to_array()),
            Event::Shaded { colour, .. } => ray.surface = Some(colour.to_array()),
            Event::Colour(colour) => {
                ray.colour = Some(colour.to_array());
                self.open.pop();
            }
            _ => {}
        }
    }
}
