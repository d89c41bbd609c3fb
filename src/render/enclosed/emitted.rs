//! The light of extended sources that reaches the points of a surface.

use super::light::{LightPoints, power};
use super::number::Enclosing;
use super::panes::{Ends, Passes, passed};
use super::round::Round;
use super::scene::{Colour, EnclosedScene, Path};
use super::surface::{HitPoints, is_black};
use glam::DVec2;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{dot, per_axis, unit};
use tabray_world::emitter::{EmitterPoint, EnclosedEmitter, Extent};
use tabray_world::geometry::sight::Line;

/// Encloses the contribution of an extended light to the colour of points; `None` where it is open. `dir` is the unit
/// vector along the rays that see the points.
///
/// A sample is enclosed by the contribution of its point, and the mean over a panel, a ball or a cone by the
/// contributions of all points. Where these are open, and for the mean over a sky, the light lies between nothing and
/// its greatest possible value.
pub(super) fn contribution<N: Enclosing>(
    scene: &EnclosedScene,
    (index, seen): (usize, LightPoints),
    emitter: &dyn EnclosedEmitter,
    surface: &HitPoints<N>,
    dir: [N; 3],
) -> Option<Colour<N>> {
    let light = &scene.model.lights[index].value;
    let shininess = scene.model.objects[surface.place.object].material.shininess;
    let has_highlight = shininess != 0.0 && emitter.has_highlights() && !is_black(&surface.specular);
    if is_black(&surface.diffuse) && !has_highlight {
        return Some([N::constant(0.0); 3]);
    }
    if !scene.bounds.passes_fractions {
        return None;
    }
    let sent = N::sent(&**light, surface.at);
    // Without highlights, the mean of all samples is no more than the radiance.
    let most = match (seen, has_highlight) {
        (LightPoints::All, false) => per_axis(|channel| sent[channel].range().coarse().magnitude()),
        _ => light.brightest()?.abs().to_array(),
    };
    let any = per_axis(|channel| {
        let reflected = match has_highlight {
            true => {
                surface.diffuse[channel].coarse().magnitude() + surface.specular[channel].coarse().magnitude()
            }
            false => surface.diffuse[channel].coarse().magnitude(),
        };
        let most = (Interval::point(reflected) * Interval::point(most[channel])).high;
        let is_positive = [surface.diffuse[channel], surface.specular[channel], sent[channel]]
            .iter()
            .all(|factor| factor.coarse().low >= 0.0);
        let low = if is_positive { 0.0 } else { -most };
        N::enclosing(Interval::from_f64(Interval { low, high: most }))
    });
    let of = Shining { scene, index, surface, dir, shininess: has_highlight.then_some(shininess) };
    let lit = match seen {
        LightPoints::All => match emitter.extent() {
            Extent::Panel(panel) => {
                let between = per_axis(|axis| N::constant(panel.middle[axis]) - surface.at[axis]);
                let (toward, solid_angle) = panel.by_area(between, [0, 1].map(N::on_light));
                let light = sent.map(|sent| solid_angle / N::pi() * sent);
                let lit = of.at(&EmitterPoint { toward, is_far: false, light });
                lit.map(|lit| lit.map(N::mean_over_light))
            }
            extent => Round::seen(&extent, surface.at).and_then(|round| of.round(&round, &sent)),
        },
        LightPoints::Middle => of.sampled(emitter, DVec2::splat(0.5)),
        LightPoints::Of(sample) => of.sampled(emitter, sample.on_light(index)),
    };
    let Some(lit) = lit else { return Some(any) };
    Some(per_axis(|channel| {
        let width = |of: N| of.mean().coarse().width();
        // Near a light, the enclosure by its points may be wider than the general bound.
        if width(lit[channel]) <= width(any[channel]) { lit[channel] } else { any[channel] }
    }))
}

/// A light of this index, and the points of a surface on which it shines, seen along `dir`.
struct Shining<'s, N: Enclosing> {
    scene: &'s EnclosedScene<'s>,
    index: usize,
    surface: &'s HitPoints<N>,
    dir: [N; 3],
    /// The shininess of the surface, if it shows highlights of the light.
    shininess: Option<f64>,
}

impl<N: Enclosing> Shining<'_, N> {
    /// Encloses the light that a sample adds, given the two numbers that choose its points; `None` where it is open.
    fn sampled(&self, emitter: &dyn EnclosedEmitter, numbers: DVec2) -> Option<Colour<N>> {
        self.at(&N::chooses(emitter).choose(self.surface.at, self.surface.normal, numbers)?)
    }

    /// Encloses the contribution of points of the light; `None` where it is open.
    fn at(&self, points: &EmitterPoint<N>) -> Option<Colour<N>> {
        let EmitterPoint { toward, is_far, light } = points;
        if is_black(light) {
            return Some([N::constant(0.0); 3]);
        }
        let rise = dot(*toward, self.surface.normal);
        // Light from behind the surface may face only the shading normals.
        let geometric_normal = self.surface.geometric_normal;
        let above = geometric_normal
            .map_or(rise, |geometric_normal| rise.min(dot(*toward, geometric_normal)))
            .range();
        if above.high <= N::of(0.0) {
            return Some([N::constant(0.0); 3]);
        }
        let cosine = rise / dot(*toward, *toward).sqrt();
        let received = self.surface.through_coat(self.scene, cosine, cosine)?;
        let mut scattered = per_axis(|channel| self.surface.diffuse[channel] * received);
        if let Some(strength) = self.highlight(*toward) {
            scattered = per_axis(|channel| scattered[channel] + self.surface.specular[channel] * strength);
        }
        let full = per_axis(|channel| scattered[channel] * light[channel]);
        let end = if *is_far { N::End::INFINITY } else { N::of(1.0) };
        self.passes(*toward, Ends::at(end)).lit(self.scene, &full, above)
    }

    /// Encloses the contribution of all points of a light that looks round and sends this light; `None` where it is
    /// open.
    fn round(&self, round: &Round<N>, sent: &Colour<N>) -> Option<Colour<N>> {
        let (n, surface) = (N::constant, self.surface);
        // How far its middle is above the horizon.
        let rise = dot(round.middle, surface.normal);
        let above = surface
            .geometric_normal
            .map_or(rise, |geometric_normal| rise.min(dot(round.middle, geometric_normal)));
        if (above + round.radius).range().high <= N::of(0.0) {
            return Some([n(0.0); 3]);
        }
        let is_whole = (above - round.radius).range().low > N::of(0.0);
        let part = |of: N| if is_whole { of } else { of.hull(n(0.0)) };
        // The part above the horizon adds no more than the whole light adds to a surface that faces it.
        let cosine = if is_whole { rise / round.distance } else { part(n(1.0)) };
        let [facing, all] = round.light;
        let toward = round.disc();
        let received = surface.through_coat(self.scene, cosine, dot(unit(toward), surface.normal))?;
        let mut scattered = per_axis(|channel| surface.diffuse[channel] * received * facing);
        if let Some(strength) = self.highlight(toward) {
            let strength = part(strength) * all;
            scattered = per_axis(|channel| scattered[channel] + surface.specular[channel] * strength);
        }
        let full = per_axis(|channel| scattered[channel] * sent[channel]);
        let certain = Interval::point(N::of(1.0));
        let lit = self.passes(toward, round.ends).lit(self.scene, &full, certain)?;
        Some(lit.map(N::mean_over_light))
    }

    /// Encloses the strength of highlights of points of the light, if there are any.
    fn highlight(&self, toward: [N; 3]) -> Option<N> {
        let toward = unit(toward);
        let half = per_axis(|axis| toward[axis] - self.dir[axis]);
        self.shininess
            .map(|shininess| power(dot(half, self.surface.normal) / dot(half, half).sqrt(), shininess))
    }

    fn passes(&self, toward: [N; 3], ends: Ends<N::End>) -> Passes<N> {
        let (origin, leaves) = (self.surface.at, Some(self.surface.place));
        let path = Path { line: Line { origin, dir: toward }, leaves, is_inside: self.surface.is_inside };
        passed(self.scene, &path, self.index, ends)
    }
}
