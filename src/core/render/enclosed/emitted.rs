//! The light of what is spread out that reaches the points of a surface.

use super::light::{LightPoints, on_disc, power};
use super::number::{Endpoint, Number, ranges};
use super::panes::passed;
use super::scene::{Colour, EnclosedScene, Path};
use super::surface::{HitPoints, is_black};
use crate::geometry::sight::Line;
use crate::world::ball::Ball;
use crate::world::emitter::{Emitter, Extent};
use crate::world::panel::Panel;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{constants, dot, per_axis};

/// Encloses what a light that is spread out adds to the colour of points; `None` where it is open. `dir` is the unit vector
/// along the rays that see the points.
///
/// The mean over a panel or a ball is enclosed by what its points add; the sum of what a sky sends, or a sample, by nothing and
/// the most that there may be.
pub(super) fn shine<N: Number>(
    scene: &EnclosedScene,
    (index, seen): (usize, LightPoints),
    emitter: &dyn Emitter,
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
    let sent = N::End::sent(&**light, ranges(surface.at))?;
    let sent: Colour<N> = per_axis(|channel| N::enclosing(sent[channel]));
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
    let highlight = has_highlight.then_some(shininess);
    let lit = match (seen, emitter.extent()) {
        (LightPoints::All, Extent::Panel(panel)) => {
            from_panel(scene, &panel, (index, sent), surface, dir, highlight)
        }
        (LightPoints::All, Extent::Ball(ball)) => {
            from_ball(scene, &ball, (index, sent), surface, dir, highlight)
        }
        _ => None,
    };
    let Some(lit) = lit else { return Some(any) };
    Some(per_axis(|channel| {
        let width = |of: N| of.mean().coarse().width();
        // Near a light, its points say less than all that there may be.
        if width(lit[channel]) <= width(any[channel]) { lit[channel] } else { any[channel] }
    }))
}

/// Encloses what the points of a panel, a light of this index that sends such light, add to the colour of points; `None` where
/// it is open.
fn from_panel<N: Number>(
    scene: &EnclosedScene,
    panel: &Panel,
    (index, sent): (usize, Colour<N>),
    surface: &HitPoints<N>,
    dir: [N; 3],
    highlight: Option<f64>,
) -> Option<Colour<N>> {
    let Panel { middle, half, .. } = panel;
    let n = N::constant;
    let [x, y] = [0, 1].map(N::on_light);
    let toward =
        per_axis(|axis| n(middle[axis]) - surface.at[axis] + (x * n(half[0][axis]) + y * n(half[1][axis])));
    let square = dot(toward, toward);
    let distance = square.sqrt();
    // The rounding of its area and its direction is below what colours are compared to.
    let facing = constants::<N>(panel.facing());
    let leaving = (dot(toward, facing) / distance).abs();
    let cosine = dot(toward, surface.normal) / distance;
    let above = surface.unbent.map_or(cosine, |unbent| cosine.min(dot(toward, unbent))).range();
    let (zero, black) = (N::of(0.0), [n(0.0); 3]);
    if above.high <= zero {
        return Some(black);
    }
    let weight = n(panel.area()) * leaving / (N::enclosing(Interval::pi()) * square);
    let mut scattered = per_axis(|channel| surface.diffuse[channel] * cosine);
    if let Some(shininess) = highlight {
        let half = per_axis(|axis| toward[axis] / distance - dir[axis]);
        let strength = power(dot(half, surface.normal) / dot(half, half).sqrt(), shininess);
        scattered = per_axis(|channel| scattered[channel] + surface.specular[channel] * strength);
    }
    let path = Path { line: Line { origin: surface.at, dir: toward }, leaves: Some(surface.place) };
    let full = per_axis(|channel| scattered[channel] * sent[channel] * weight);
    let lit = passed(scene, &path, index, N::of(1.0)).lit(scene, &full, above)?;
    Some(per_axis(|channel| lit[channel].mean_over_light()))
}

/// Encloses what a ball, a light of this index that sends such light, adds to the colour of points; `None` where it is open.
///
/// What scatters evenly gets the closed form: the square of the sine of half the angle at which the ball is seen, times the
/// cosine toward its middle.
fn from_ball<N: Number>(
    scene: &EnclosedScene,
    ball: &Ball,
    (index, sent): (usize, Colour<N>),
    surface: &HitPoints<N>,
    dir: [N; 3],
    highlight: Option<f64>,
) -> Option<Colour<N>> {
    let n = N::constant;
    let radius = n(ball.radius);
    let middle = per_axis(|axis| n(ball.middle[axis]) - surface.at[axis]);
    let square = dot(middle, middle);
    let distance = square.sqrt();
    let (zero, one) = (N::of(0.0), n(1.0));
    if (distance - radius).range().low <= zero {
        return None;
    }
    // How far its middle is above the horizon.
    let rise = dot(middle, surface.normal);
    let above = surface.unbent.map_or(rise, |unbent| rise.min(dot(middle, unbent)));
    if (above + radius).range().high <= zero {
        return Some([n(0.0); 3]);
    }
    let is_whole = (above - radius).range().low > zero;
    let seen = (radius * radius) / square;
    let cosine = if is_whole { rise / distance } else { n(0.0).hull(one) };
    let mut scattered = per_axis(|channel| surface.diffuse[channel] * cosine * seen);
    let away = (one - seen).sqrt();
    let toward = on_disc(middle, radius / away);
    if let Some(shininess) = highlight {
        let length = dot(toward, toward).sqrt();
        let half = per_axis(|axis| toward[axis] / length - dir[axis]);
        let strength = power(dot(half, surface.normal) / dot(half, half).sqrt(), shininess);
        let strength = if is_whole { strength } else { n(0.0).hull(strength) };
        // The solid angle over pi.
        let covered = n(2.0) * seen / (one + away);
        scattered = per_axis(|channel| scattered[channel] + surface.specular[channel] * strength * covered);
    }
    let path = Path { line: Line { origin: surface.at, dir: toward }, leaves: Some(surface.place) };
    let full = per_axis(|channel| scattered[channel] * sent[channel]);
    // The ball touches the plane through its nearest point that faces the points.
    let nearest = (one - radius / distance).range().low;
    let passes = passed(scene, &path, index, nearest);
    let lit = passes.lit(scene, &full, Interval { low: N::of(1.0), high: N::of(1.0) })?;
    Some(per_axis(|channel| lit[channel].mean_over_light()))
}
