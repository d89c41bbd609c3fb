//! The light that reaches the points of a surface.

use super::scene::{Colour, Path, Place, Scene};
use super::surface::{Surface, is_black, tint};
use crate::geometry::sight::Line;
use crate::world::certify::FootprintHit;
use crate::world::packets::light::{EncloseLight, PacketLight};
use crate::world::packets::shader::EncloseLook;
use crate::world::shader::PointBounds;
use tabray_exact::affine::Affine;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, cross, dot};

/// The variables that stand for the point of a light with a size: two coordinates in a disc of radius 1.
const ON_LIGHT: [usize; 2] = [2, 3];

/// The number of panes on a shadow ray after which what passes is open.
const MAX_PANES: usize = 8;

/// Encloses what a light adds to the colour of the points, the mean over the light where it has a size. `dir` is the unit
/// vector along the rays that see the points.
pub(super) fn shine(
    scene: &Scene,
    light: &(dyn PacketLight + 'static),
    surface: &Surface,
    dir: [Affine; 3],
) -> Colour {
    let black = [Affine::constant(0.0); 3];
    let shininess = scene.model.objects[surface.place.object].material.shininess;
    let has_glint = shininess != 0.0 && !is_black(&surface.specular);
    if is_black(&surface.diffuse) && !has_glint {
        return black;
    }
    let toward = toward(light, surface.at);
    let distance = dot(toward, toward).sqrt();
    let cosine = dot(toward, surface.normal) / distance;
    // Light from behind the surface may face the shading normals only.
    let above = surface.unbent.map_or(cosine, |unbent| cosine.min(dot(toward, unbent)));
    if above.range().high <= 0.0 {
        return black;
    }
    let Some(sent) = EncloseLight::<f64>::sent(light, surface.at.map(|axis| axis.range())) else {
        return [Affine::WHOLE; 3];
    };
    let sent = sent.map(Affine::from);
    if is_black(&sent) {
        return black;
    }
    let mut scattered = surface.diffuse.map(|channel| channel * cosine / distance);
    if has_glint {
        let half = [0, 1, 2].map(|axis| toward[axis] / distance - dir[axis]);
        let half_cosine = dot(half, surface.normal) / dot(half, half).sqrt();
        if half_cosine.range().high > 0.0 {
            let strength = power(half_cosine, shininess);
            scattered = [0, 1, 2].map(|channel| scattered[channel] + surface.specular[channel] * strength);
        }
    }
    let path = Path { line: Line { origin: surface.at, dir: toward }, leaves: Some(surface.place) };
    let passes = passed(scene, &path);
    [0, 1, 2].map(|channel| {
        let full = scattered[channel] * sent[channel];
        let lit = match &passes {
            Passes::Nothing => black[channel],
            Passes::All => full,
            Passes::Part(fraction) => full * fraction[channel],
            Passes::Open if scene.passes_fractions => full.hull(black[channel]),
            Passes::Open => Affine::WHOLE,
        };
        let lit = if above.range().low > 0.0 { lit } else { lit.hull(black[channel]) };
        // From here on it is the mean over the light.
        ON_LIGHT.iter().fold(lit, |lit, index| lit.without(*index))
    })
}

/// Encloses the vectors from points to a light: to its own point, or to all of the disc around it that faces the points.
///
/// The mean over the disc does not depend on how it is turned, so any two vectors do that are perpendicular to the line of
/// sight.
fn toward(light: &(dyn PacketLight + 'static), at: [Affine; 3]) -> [Affine; 3] {
    let (location, size) = (light.location(), light.size());
    let toward = [0, 1, 2].map(|axis| Affine::constant(location[axis]) - at[axis]);
    if size == 0.0 {
        return toward;
    }
    let unit = |vector: [Affine; 3]| {
        let length = dot(vector, vector).sqrt();
        vector.map(|part| part / length)
    };
    // The axis that the line of sight is the farthest from.
    let magnitude = |axis: &usize| toward[*axis].centre.abs();
    let farthest = (0..3).min_by(|one, other| magnitude(one).total_cmp(&magnitude(other))).unwrap_or(0);
    let mut axis = [Affine::constant(0.0); 3];
    axis[farthest] = Affine::constant(1.0);
    let sight = unit(toward);
    let across = unit(cross(sight, axis));
    let up = cross(sight, across);
    let [u, v] = ON_LIGHT.map(|index| Affine::variable(index, 0.0, size));
    [0, 1, 2].map(|axis| toward[axis] + (u * across[axis] + v * up[axis]))
}

/// Encloses the power of a cosine above 0; 0 below.
fn power(cosine: Affine, shininess: f64) -> Affine {
    let cosine = cosine.max(Affine::constant(0.0)).min(Affine::constant(1.0));
    let whole = shininess as i32;
    if f64::from(whole) == shininess && (1..=1000).contains(&whole) {
        return cosine.powi(whole);
    }
    cosine.pow(Affine::constant(shininess))
}

/// The fraction of a light that reaches points.
enum Passes {
    /// All of it.
    All,
    /// This fraction.
    Part(Colour),
    Nothing,
    /// An unknown fraction: anything from nothing to all, if tints are fractions.
    Open,
}

/// Tells how much light passes along lines from t = 0 to t = 1.
fn passed(scene: &Scene, path: &Path) -> Passes {
    let is_glass = |object: usize| scene.model.objects[object].material.transparency != 0.0;
    let mut panes = Panes { at: Vec::new(), passed: None };
    let (mut is_open, mut is_blocked) = (false, false);
    for object in (0..scene.model.objects.len()).filter(|object| is_glass(*object)) {
        if let Err(low) = panes.add(scene, path, object) {
            panes.at.push(Interval { low, high: scene.leaves(path, object) });
            is_open = true;
        }
    }
    scene.hits(
        path,
        |object| !is_glass(object),
        |hit, _| {
            match hit {
                FootprintHit::Hits(at) if at.range().high < 1.0 && !panes.are_at(at) => is_blocked = true,
                hit => is_open |= hit.low() < 1.0,
            }
            !is_blocked
        },
    );
    match panes.passed {
        _ if is_blocked => Passes::Nothing,
        _ if is_open => Passes::Open,
        None => Passes::All,
        Some(fraction) => Passes::Part(fraction),
    }
}

/// The panes of glass on lines.
struct Panes {
    /// Where they are or may be.
    at: Vec<Interval>,
    /// The fraction of light that passes, if there is any pane.
    passed: Option<Colour>,
}

impl Panes {
    /// Tells whether any pane may be at a t.
    fn are_at(&self, t: Affine) -> bool {
        let t = t.range();
        self.at.iter().any(|pane| pane.low <= t.high && t.low <= pane.high)
    }

    /// Adds each wall of a transparent object that the lines pass through before t = 1.
    ///
    /// # Errors
    /// The t before which all are added, where it is open which follow.
    fn add(&mut self, scene: &Scene, path: &Path, object: usize) -> Result<(), f64> {
        let one = Affine::constant(1.0);
        let (mut onward, mut start) = (*path, Affine::constant(0.0));
        for _ in 0..MAX_PANES {
            let mut all = Vec::new();
            scene.hits(
                &onward,
                |index| index == object,
                |hit, place| {
                    let low = match hit {
                        FootprintHit::Hits(at) | FootprintHit::Perhaps(at) => (start + at).range().low,
                        FootprintHit::Doubtful(low) => start.range().low + low,
                    };
                    if low < 1.0 {
                        all.push((low, hit, place));
                    }
                    true
                },
            );
            let (at, place) = match all[..] {
                [] => return Ok(()),
                [(_, FootprintHit::Hits(at), place)] => (start + at, place),
                _ => return Err(all.iter().fold(f64::INFINITY, |nearest, (low, ..)| nearest.min(*low))),
            };
            // Of panes in one place, one stands for all: that is not decided here.
            if at.range().high >= 1.0 || self.are_at(at) {
                return Err(at.range().low);
            }
            let point = path.line.at(at);
            let tint = pane_tint(scene, place, point).ok_or(at.range().low)?;
            let before = self.passed.unwrap_or([one; 3]);
            self.passed = Some([0, 1, 2].map(|channel| before[channel] * tint[channel]));
            self.at.push(at.range());
            start = at;
            onward = Path { line: Line { origin: point, dir: path.line.dir }, leaves: Some(place) };
        }
        Err(start.range().low)
    }
}

/// Encloses the fraction of light that passes through a place at points; `None` where it is open.
fn pane_tint(scene: &Scene, place: Place, at: [Affine; 3]) -> Option<Colour> {
    let pane = &scene.model.objects[place.object];
    let (proven, position) = (pane.shape.proven()?, at.map(|axis| axis.range()));
    let seen = PointBounds::seen(proven, pane.shader.sees(), place.part, position, None);
    let look = EncloseLook::<f64>::look(&*pane.shader, &pane.material, &seen)?;
    tint(pane.material.transparency, look.diffuse.map(Affine::from))
}
