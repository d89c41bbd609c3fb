//! The light that reaches a point of a surface, in intervals.

use super::scene::{Colour, Number, Path, Place, Scene, coarse};
use super::surface::{Surface, is_black, tint};
use glam::DVec2;
use tabray_core::geometry::sight::Line;
use tabray_core::world::certify::HitEnclosure;
use tabray_core::world::packets::light::PacketLight;
use tabray_core::world::shader::PointBounds;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, dot, per_axis};

/// The number of panes on a shadow ray after which what passes is open.
const MAX_PANES: usize = 100;

/// Encloses what a light adds to the colour of a point. `draw` chooses the point of a light with a size that is seen, and
/// `dir` is the unit vector along the ray that sees the point. `None` where it is open.
pub(super) fn shine<F: Number>(
    scene: &Scene,
    light: &(dyn PacketLight + 'static),
    draw: Option<DVec2>,
    surface: &Surface<F>,
    dir: [Interval<F>; 3],
) -> Option<Colour<F>> {
    let n = Interval::<F>::constant;
    let (zero, black) = (F::of(0.0), [n(0.0); 3]);
    let shininess = scene.objects[surface.place.object].material.shininess;
    let has_glint = shininess != 0.0 && !is_black(&surface.specular);
    if is_black(&surface.diffuse) && !has_glint {
        return Some(black);
    }
    let toward = toward(light, draw, surface.at)?;
    let distance = dot(toward, toward).sqrt();
    let cosine = dot(toward, surface.normal) / distance;
    // Light from behind the surface may face the shading normal only.
    let above = surface.unbent.map_or(cosine, |unbent| cosine.min(dot(toward, unbent)));
    if above.high <= zero {
        return Some(black);
    }
    let sent = F::sent(light, surface.at)?;
    if is_black(&sent) {
        return Some(black);
    }
    let mut scattered = per_axis(|channel| surface.diffuse[channel] * cosine / distance);
    if has_glint {
        let half = per_axis(|axis| toward[axis] / distance - dir[axis]);
        let half_cosine = dot(half, surface.normal) / dot(half, half).sqrt();
        if half_cosine.high > zero {
            let strength = power(half_cosine, shininess);
            scattered = per_axis(|channel| scattered[channel] + surface.specular[channel] * strength);
        }
    }
    let path = Path { line: Line { origin: surface.at, dir: toward }, leaves: Some(surface.place) };
    let passed = passed(scene, &path);
    if passed.is_none() && !scene.passes_fractions {
        return None;
    }
    let full = per_axis(|channel| scattered[channel] * sent[channel]);
    Some(per_axis(|channel| {
        let lit = match passed {
            Some(passed) => passed[channel] * full[channel],
            None => full[channel].hull(black[channel]),
        };
        if above.low > zero { lit } else { lit.hull(black[channel]) }
    }))
}

/// Encloses the vector from a point to the point of a light that it sees: the light's own, or one on the disc around it that
/// faces the point. `None` where it is open.
fn toward<F: Number>(
    light: &(dyn PacketLight + 'static),
    draw: Option<DVec2>,
    at: [Interval<F>; 3],
) -> Option<[Interval<F>; 3]> {
    let n = Interval::<F>::constant;
    let (location, size) = (light.location(), light.size());
    let toward = per_axis(|axis| n(location[axis]) - at[axis]);
    let Some(draw) = draw.filter(|_| size != 0.0) else { return Some(toward) };
    let length = dot(toward, toward).sqrt();
    let [x, y, z] = per_axis(|axis| toward[axis] / length);
    let sign = if z.low >= F::of(0.0) {
        n(1.0)
    } else if z.high < F::of(0.0) {
        n(-1.0)
    } else {
        return None;
    };
    // The two vectors perpendicular to a unit vector that `glam` chooses.
    let a = n(-1.0) / (sign + z);
    let b = x * y * a;
    let across = [n(1.0) + sign * x * x * a, sign * b, -sign * x];
    let up = [b, sign + y * y * a, -y];
    let (sin, cos) = (n(2.0) * Interval::pi() * n(draw.y)).sin_cos();
    let radius = n(size) * n(draw.x).sqrt();
    Some(per_axis(|axis| toward[axis] + radius * (cos * across[axis] + sin * up[axis])))
}

/// Encloses the power of a cosine above 0; 0 below.
fn power<F: Float>(cosine: Interval<F>, shininess: f64) -> Interval<F> {
    let n = Interval::<F>::constant;
    let cosine = cosine.max(n(0.0)).min(n(1.0));
    let whole = shininess as i32;
    if f64::from(whole) == shininess && (1..=64).contains(&whole) {
        return cosine.powi(whole);
    }
    let power = cosine.pow(n(shininess));
    if shininess > 0.0 { power.max(n(0.0)).min(n(1.0)) } else { power }
}

/// Encloses the fraction of light that passes along a line from t = 0 to t = 1; `None` where it is open.
fn passed<F: Number>(scene: &Scene, path: &Path<F>) -> Option<Colour<F>> {
    let (one, black) = (F::of(1.0), [Interval::constant(0.0); 3]);
    let coarse = coarse(&path.line);
    let is_glass = |index: &usize| scene.objects[*index].material.transparency != 0.0;
    let mut panes = Panes { at: Vec::new(), passed: [Interval::constant(1.0); 3] };
    for index in (0..scene.objects.len()).filter(is_glass) {
        panes.add(scene, path, index)?;
    }
    panes.at.sort_by(|one, other| one.low.partial_cmp(&other.low).expect("no NaN"));
    // Of panes in one place, one stands for all: that is not decided here.
    if panes.at.windows(2).any(|pair| pair[1].low <= pair[0].high) {
        return None;
    }
    let is_at_pane =
        |at: &Interval<F>| panes.at.iter().any(|pane| pane.low <= at.high && at.low <= pane.high);
    let mut open = Vec::new();
    for index in (0..scene.objects.len()).filter(|index| !is_glass(index)) {
        match scene.hit(path, &coarse, index).0 {
            HitEnclosure::Misses => {}
            HitEnclosure::Hits(at) if at.high < one && !is_at_pane(&at) => return Some(black),
            HitEnclosure::Hits(Interval { low, .. })
            | HitEnclosure::Edge(Interval { low, .. })
            | HitEnclosure::Doubtful(low) => open.extend((low < one).then_some(index)),
        }
    }
    open.iter().for_each(|index| scene.note_open(*index));
    open.is_empty().then_some(panes.passed)
}

/// The panes of glass on a line.
struct Panes<F> {
    /// Where they are.
    at: Vec<Interval<F>>,
    /// The fraction of light that passes.
    passed: Colour<F>,
}

impl<F: Number> Panes<F> {
    /// Adds each wall of a transparent object that a line passes through before t = 1; `None` where that is open.
    fn add(&mut self, scene: &Scene, path: &Path<F>, object: usize) -> Option<()> {
        let one = F::of(1.0);
        let (mut onward, mut start) = (*path, Interval::constant(0.0));
        for _ in 0..MAX_PANES {
            let (found, part) = scene.hit(&onward, &coarse(&onward.line), object);
            let at = match found {
                HitEnclosure::Misses => return Some(()),
                HitEnclosure::Hits(at) => start + at,
                HitEnclosure::Edge(Interval { low, .. }) | HitEnclosure::Doubtful(low) => {
                    let is_beyond = (start + Interval::point(low)).low >= one;
                    if !is_beyond {
                        scene.note_open(object);
                    }
                    return is_beyond.then_some(());
                }
            };
            if at.low >= one {
                return Some(());
            }
            if at.high >= one {
                return None;
            }
            let point = path.line.at(at);
            let pane = &scene.objects[object];
            let seen = PointBounds::seen(pane.shape.proven()?, pane.shader.sees(), part, point, None);
            let look = F::look(pane, &seen)?;
            let tint = tint(pane.material.transparency, look.diffuse)?;
            self.passed = per_axis(|channel| self.passed[channel] * tint[channel]);
            self.at.push(at);
            start = at;
            let leaves = Some(Place { object, part });
            onward = Path { line: Line { origin: point, dir: path.line.dir }, leaves };
        }
        None
    }
}
