//! The colours that rays return.

use super::emitted;
use super::light::{self, LightPoints};
use super::media;
use super::number::{Enclosing, Hit};
use super::scene::{Colour, EnclosedScene, Path, Place};
use super::surface::{HitPoints, is_black, tint};
use crate::plan::depth::LightRange;
use crate::plan::lamps;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{constants, dot, per_axis};
use tabray_world::geometry::sight::Line;
use tabray_world::interface::{Crossing, Interface, Medium};
use tabray_world::rules::{self, Rules};
use tabray_world::scene::model::Object;

/// How far rays are followed.
#[derive(Clone, Copy)]
pub struct Limits {
    /// The number of hits after which branches are no longer followed, but bounded.
    pub hits: usize,
    /// The number of consecutive rays, each continuing the last, after which they are bounded.
    pub depth: usize,
    /// The maximum number of places that a ray may hit first; a ray with more is bounded.
    pub places: usize,
    /// A branch that can add no more than this to a pixel's channel is bounded and not followed.
    pub negligible: f64,
    /// An open branch that can add more than this opens the whole colour, and the other branches are not followed.
    pub tolerable: f64,
}

/// A set of rays whose colours are enclosed together.
struct Ray<N> {
    path: Path<N>,
    /// The length of the lines' direction, in world units.
    length: N,
    /// The length of the path from the viewer to the lines' start, in world units.
    travelled: N,
    /// A bound on the factor by which the rays' light is multiplied.
    weight: f64,
    depth: usize,
    /// Whether samples show patches of surfaces along the rays.
    shows_patches: bool,
}

/// Rays that continue from a surface.
struct Onward<N> {
    dir: [N; 3],
    /// Whether the surface does not change the spread of the rays, so they may go on showing patches.
    keeps: bool,
    /// Whether they pass through the surface.
    through: bool,
}

/// Traces a single ray, or all rays through a footprint at once.
pub struct EnclosingTracer<'s> {
    scene: &'s EnclosedScene<'s>,
    limits: Limits,
    lights: LightPoints,
    hits: usize,
    is_spent: bool,
    is_open: bool,
}

impl<'s> EnclosingTracer<'s> {
    /// Returns a tracer of one ray from the viewer, or of all rays through a footprint.
    pub fn new(scene: &'s EnclosedScene<'s>, limits: Limits, lights: LightPoints) -> Self {
        Self { scene, limits, lights, hits: 0, is_spent: false, is_open: false }
    }

    /// Tells whether branches were not followed because of a limit.
    pub fn is_spent(&self) -> bool {
        self.is_spent
    }

    /// Tells whether any branch was only bounded by its largest magnitude.
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Tells whether light goes on from matt surfaces.
    fn bounces(&self) -> bool {
        self.scene.depth.is_some_and(|depth| !depth.scattered.is_empty())
    }

    /// Tells whether the colours are those of samples whose paths are chosen by chance. Such a sample may be brighter than
    /// all light: what bounds the light bounds their mean alone.
    fn is_by_chance(&self) -> bool {
        self.bounces() && !matches!(self.lights, LightPoints::All)
    }

    fn rules(&self) -> Rules {
        self.scene.model.camera.value.rules
    }

    /// Encloses the colours that primary rays return; `None` where they are open.
    pub fn primary<N: Enclosing>(&mut self, line: &Line<N>) -> Option<Colour<N>> {
        let length = dot(line.dir, line.dir).sqrt();
        let path = Path { line: *line, leaves: None, is_inside: false };
        let travelled = N::constant(0.0);
        self.colour(&Ray { path, length, travelled, weight: 1.0, depth: 0, shows_patches: true })
    }

    fn colour<N: Enclosing>(&mut self, ray: &Ray<N>) -> Option<Colour<N>> {
        let black = [N::constant(0.0); 3];
        let left = match self.rules() {
            Rules::Notes => rules::path_left(ray.travelled).range(),
            Rules::Free => N::constant(0.0).range(),
        };
        if left.high < N::of(0.0) {
            return Some(black);
        }
        if ray.depth > 0 {
            let most = self.bound(ray);
            if ray.weight * most < self.limits.negligible && !self.is_by_chance() {
                return Some(up_to(most));
            }
            if ray.depth >= self.limits.depth {
                self.is_spent = true;
                return self.open(ray, most);
            }
        }
        let Some((places, is_something)) = self.scene.first(&ray.path) else {
            return self.open(ray, self.bound(ray));
        };
        let is_hopeless = places.iter().any(|(hit, place)| {
            let is_doubtful = matches!(hit, Hit::Doubtful(_));
            is_doubtful && ray.weight * self.bound_at(ray, hit, *place) > self.limits.tolerable
        });
        let is_spent = self.hits + places.len() > self.limits.hits;
        self.is_spent |= is_spent;
        if is_hopeless || is_spent || places.len() > self.limits.places || left.low < N::of(0.0) {
            let bounds = places.iter().map(|(hit, place)| self.bound_at(ray, hit, *place));
            let most = bounds.fold(self.brightest_background(), f64::max);
            return self.open(ray, most);
        }
        self.hits += places.len();
        let mut any = (!is_something).then(|| self.background(ray));
        for (hit, place) in places {
            let seen = match hit {
                Hit::Certain(t) | Hit::Perhaps(t) => self.seen(ray, t, place),
                Hit::Doubtful(_) => None,
            };
            let half = |channel: &N| 0.5 * channel.mean().width().to_f64();
            let seen = match seen {
                Some(seen) if seen.iter().all(|channel| half(channel) <= self.limits.negligible) => seen,
                Some(seen) if self.is_by_chance() => seen,
                Some(seen) => {
                    let most = self.bound_at(ray, &hit, place);
                    per_axis(|at| if half(&seen[at]) > most { within(most) } else { seen[at] })
                }
                None => self.open(ray, self.bound_at(ray, &hit, place))?,
            };
            any = Some(any.map_or(seen, |any| hull(any, seen)));
        }
        Some(any.unwrap_or(black))
    }

    /// Encloses the colours of rays that hit nothing.
    fn background<N: Enclosing>(&self, ray: &Ray<N>) -> Colour<N> {
        let Some(background) = &self.scene.model.background else { return [N::constant(0.0); 3] };
        let seen = background.value.colour_in(ray.path.line.dir.map(|along| along / ray.length));
        absorbed(seen, media::between(self.scene, &ray.path, None), None)
    }

    /// Encloses the colours of rays that hit a place at t; `None` where the colours are open.
    fn seen<N: Enclosing>(&mut self, ray: &Ray<N>, t: N, place: Place) -> Option<Colour<N>> {
        let interface = self.scene.model.objects[place.object].material.interface.as_deref();
        let mut any = None;
        let window = self.scene.window.filter(|_| ray.shows_patches);
        let window = window.map(|window| (window, ray.travelled));
        for surface in HitPoints::facing(self.scene, (&ray.path.line, ray.length), t, place, window)? {
            let shaded = match interface {
                None => self.shaded(ray, t, &surface)?,
                Some(interface) => self.divided(ray, t, &surface, interface)?,
            };
            let shaded = match surface.coverage {
                None => shaded,
                Some(covered) => self.covered(ray, t, &surface, &shaded, covered)?,
            };
            let medium = media::between(self.scene, &ray.path, Some((place.object, surface.is_inside)));
            let shaded = absorbed(shaded, medium, Some(t * ray.length));
            any = Some(any.map_or(shaded, |any| hull(any, shaded)));
        }
        any
    }

    /// Encloses the means of what covers a part of the points and of what is behind them.
    fn covered<N: Enclosing>(
        &mut self,
        ray: &Ray<N>,
        t: N,
        surface: &HitPoints<N>,
        own: &Colour<N>,
        covered: N,
    ) -> Option<Colour<N>> {
        let open = [N::constant(1.0) - covered; 3];
        let onward = Onward { dir: ray.path.line.dir, keeps: true, through: true };
        let behind = self.secondary(ray, surface, ray.travelled + t * ray.length, onward, &open)?;
        Some(per_axis(|channel| rules::transmitted(own[channel], covered, behind[channel], open[channel])))
    }

    fn shaded<N: Enclosing>(&mut self, ray: &Ray<N>, t: N, surface: &HitPoints<N>) -> Option<Colour<N>> {
        let (dir, travelled) = (ray.path.line.dir, ray.travelled + t * ray.length);
        let mut colour = self.own(ray, travelled, surface)?;
        let object = &self.scene.model.objects[surface.place.object];
        let (transparency, is_flat) = (object.material.transparency, object.is_flat_mirror());
        if transparency != 0.0 {
            let tint = tint(transparency, surface.diffuse)?;
            let kept = N::constant(1.0) - N::constant(transparency);
            let behind =
                self.secondary(ray, surface, travelled, Onward { dir, keeps: true, through: true }, &tint)?;
            colour = per_axis(|at| rules::transmitted(colour[at], kept, behind[at], tint[at]));
        }
        if !is_black(&surface.specular) {
            let onward = Onward { dir: surface.mirrored(dir)?, keeps: is_flat, through: false };
            let seen = self.secondary(ray, surface, travelled, onward, &surface.specular)?;
            colour = per_axis(|at| rules::reflected(colour[at], seen[at], surface.specular[at]));
        }
        Some(colour)
    }

    /// Encloses the colours of rays that an interface divides. For a rough surface, the facet of one sample is
    /// enclosed, not the mean over all facets.
    fn divided<N: Enclosing>(
        &mut self,
        ray: &Ray<N>,
        t: N,
        surface: &HitPoints<N>,
        interface: &dyn Interface,
    ) -> Option<Colour<N>> {
        let object = &self.scene.model.objects[surface.place.object];
        let (Object { material, shape, .. }, is_flat) = (object, object.is_flat_mirror());
        if !shape.is_two_sided() {
            return None;
        }
        if interface.varies() {
            // What the shader says of the interface is only bounded.
            return self.open(ray, self.bound(ray));
        }
        let (dir, travelled) = (ray.path.line.dir, ray.travelled + t * ray.length);
        let (zero, one, transparency) = (N::constant(0.0), N::constant(1.0), material.transparency);
        let mut colour = [zero; 3];
        if transparency != 1.0 {
            let own = self.own(ray, travelled, surface)?;
            colour = own.map(|own| (one - N::constant(transparency)) * own);
        }
        if material.glints() && !surface.is_inside {
            let mirror = HitPoints { ambient: [zero; 3], diffuse: [zero; 3], specular: [one; 3], ..*surface };
            let glints = self.own(ray, travelled, &mirror)?;
            colour = per_axis(|channel| colour[channel] + glints[channel]);
        }
        let unit = per_axis(|axis| dir[axis] / ray.length);
        let is_aimed = |index: &usize| lamps::is_aimed_at(&self.scene.model.lights[*index].value);
        let facet = match (interface.roughness(), self.lights) {
            (0.0, _) | (_, LightPoints::Middle) => None,
            // The light that facets mirror by aim is only bounded.
            _ if self.bounces() || self.scene.lights.iter().any(is_aimed) => {
                return self.open(ray, self.bound(ray));
            }
            (roughness, LightPoints::Of(sample)) => {
                Some(surface.with_facet(unit, roughness, sample.on_facet(ray.depth as u32))?)
            }
            (_, LightPoints::All) => return None,
        };
        let surface = facet.as_ref().unwrap_or(surface);
        let Crossing { reflected, onward } = surface.crossing(interface.law(), unit)?;
        if let Some(onward) = onward {
            let tint = tint(transparency, surface.diffuse)?;
            let through = per_axis(|channel| tint[channel] * (one - reflected[channel]));
            let dir = onward.map(|along| ray.length * along);
            let onward = Onward { dir, keeps: false, through: true };
            let behind = self.secondary(ray, surface, travelled, onward, &through)?;
            colour = per_axis(|at| rules::reflected(colour[at], behind[at], through[at]));
        }
        if !is_black(&reflected) {
            let onward = Onward { dir: surface.mirrored(dir)?, keeps: is_flat, through: false };
            let seen = self.secondary(ray, surface, travelled, onward, &reflected)?;
            colour = per_axis(|at| rules::reflected(colour[at], seen[at], reflected[at]));
        }
        Some(colour)
    }

    /// Encloses the light of points themselves, without that of continued rays.
    fn own<N: Enclosing>(&self, ray: &Ray<N>, travelled: N, surface: &HitPoints<N>) -> Option<Colour<N>> {
        let toward = per_axis(|axis| ray.path.line.dir[axis] / ray.length);
        let material = &self.scene.model.objects[surface.place.object].material;
        let (mut colour, mut diffuse) = (surface.ambient, surface.diffuse);
        if let Some(coat) = material.enclosed_coat() {
            let passed = surface.through_coat(self.scene, N::constant(1.0), -dot(toward, surface.normal))?;
            let body = coat.covers(diffuse.map(N::coarse));
            diffuse = per_axis(|channel| N::enclosing(Interval::from_f64(body[channel])) * passed);
        }
        if let Some(most) = self.scene.depth.and_then(|depth| depth.scattered.first()) {
            // The light that reaches a matt surface from others is only bounded.
            let LightRange { low, high } = *most;
            let is_coated = material.coat().is_some();
            let is_open = self.is_by_chance() || is_coated || !low.is_finite() || !high.is_finite();
            if is_open && !is_black(&surface.diffuse) {
                return None;
            }
            let any = |channel: usize| Interval { low: N::of(low[channel]), high: N::of(high[channel]) };
            if !is_open {
                colour = per_axis(|channel| {
                    colour[channel] + surface.diffuse[channel] * N::enclosing(any(channel))
                });
            }
        }
        let alone: Colour<N> = constants(material.highlight);
        let specular = per_axis(|channel| surface.specular[channel] + alone[channel]);
        let lit = HitPoints { diffuse, specular, ..*surface };
        for index in self.scene.lights {
            let seen = (*index, self.lights);
            let added = match self.scene.model.lights[*index].value.emitter() {
                None => light::contribution(self.scene, seen, &lit, toward)?,
                // Highlights of lamps that mirrors show are not enclosed.
                Some(emitter) if !emitter.has_highlights() && !is_black(&alone) => return None,
                Some(emitter) => emitted::contribution(self.scene, seen, emitter, &lit, toward)?,
            };
            colour = per_axis(|channel| colour[channel] + added[channel]);
        }
        let rules = self.rules();
        Some(per_axis(|channel| rules.after(travelled, colour[channel])))
    }

    /// Encloses the colours of rays that continue from a surface. Their light is multiplied by `factor`.
    fn secondary<N: Enclosing>(
        &mut self,
        ray: &Ray<N>,
        surface: &HitPoints<N>,
        travelled: N,
        Onward { dir, keeps, through }: Onward<N>,
        factor: &Colour<N>,
    ) -> Option<Colour<N>> {
        let (line, is_inside) = (Line { origin: surface.at, dir }, surface.is_inside != through);
        let path = Path { line, leaves: Some(surface.place), is_inside };
        let most = factor.iter().fold(0.0_f64, |most, channel| most.max(channel.coarse().magnitude()));
        // Rays continue with directions as long as those from which they come.
        let (length, weight, depth) = (ray.length, ray.weight * most, ray.depth + 1);
        let shows_patches = ray.shows_patches && keeps;
        self.colour(&Ray { path, length, travelled, weight, depth, shows_patches })
    }

    /// Returns all colours up to a magnitude, where nothing else is known about the rays' colours; `None` where that
    /// is beyond the tolerable.
    fn open<N: Enclosing>(&mut self, ray: &Ray<N>, most: f64) -> Option<Colour<N>> {
        self.is_open = true;
        if self.is_by_chance() {
            return None;
        }
        (ray.weight * most <= self.limits.tolerable).then(|| up_to(most))
    }

    /// Bounds the magnitude of the rays' colours.
    fn bound<N: Enclosing>(&self, ray: &Ray<N>) -> f64 {
        let most = match (ray.path.leaves, self.scene.depth) {
            (Some(place), Some(depth)) => depth.beyond(Some(place.object)),
            _ => self.scene.bounds.most,
        };
        self.over_path(ray, 0.0, most)
    }

    /// Bounds the magnitude of the colours of rays with this first hit.
    fn bound_at<N: Enclosing>(&self, ray: &Ray<N>, hit: &Hit<N>, place: Place) -> f64 {
        let most = self.scene.depth.map_or(self.scene.bounds.most, |depth| depth.objects[place.object].hit);
        self.over_path(ray, Interval::point(hit.low()).coarse().low, most)
    }

    /// Bounds the magnitude of light where rays hit nothing before t. `most` is a bound on the light, as
    /// [`Rules::over_path`] takes it.
    fn over_path<N: Enclosing>(&self, ray: &Ray<N>, t: f64, most: f64) -> f64 {
        if most == 0.0 {
            return self.brightest_background();
        }
        if self.rules() == Rules::Free {
            return most.max(self.brightest_background());
        }
        let path = Interval::point(t) * ray.length.coarse() + ray.travelled.coarse();
        let bound = (Interval::point(most) / Interval { low: path.low.max(0.0), high: path.high }).high;
        if bound.is_nan() { f64::INFINITY } else { bound.max(self.brightest_background()) }
    }

    /// Bounds the light of the background.
    fn brightest_background(&self) -> f64 {
        let background = self.scene.model.background.as_ref();
        background.map_or(0.0, |background| background.value.brightest().max_element())
    }
}

/// Encloses colours after a path of this length through a medium, in world units; `None` is endless.
fn absorbed<N: Enclosing>(colour: Colour<N>, medium: Option<Medium>, length: Option<N>) -> Colour<N> {
    let Some(medium) = medium else { return colour };
    let passed = media::passed(&medium, length);
    per_axis(|channel| colour[channel] * passed[channel])
}

/// Encloses all colours up to a magnitude.
fn up_to<N: Enclosing>(most: f64) -> Colour<N> {
    [within(most); 3]
}

fn within<N: Enclosing>(most: f64) -> N {
    N::enclosing(Interval { low: N::of(-most), high: N::of(most) })
}

fn hull<N: Enclosing>(one: Colour<N>, other: Colour<N>) -> Colour<N> {
    per_axis(|channel| one[channel].hull(other[channel]))
}
