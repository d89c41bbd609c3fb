//! The points of a surface that the lines of a footprint hit.

use super::scene::{Colour, Place, Scene};
use crate::geometry::sight::Line;
use crate::world::certify::{gradient_over, shading_normals};
use crate::world::packets::shader::EncloseLook;
use crate::world::shader::PointBounds;
use tabray_exact::affine::Affine;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, dot};

/// The points that lines hit, and how they look there.
pub(super) struct Surface {
    pub place: Place,
    pub at: [Affine; 3],
    /// The unit normals with which the points are shaded, turned to face the lines where both sides are lit.
    pub normal: [Affine; 3],
    /// The unit normals of the surface itself, turned likewise, where the points are shaded with others.
    pub unbent: Option<[Affine; 3]>,
    pub ambient: Colour,
    pub diffuse: Colour,
    pub specular: Colour,
}

impl Surface {
    /// Returns the points at t of lines, once for each way that the normals may face; empty where these or the look are
    /// open.
    pub fn new(scene: &Scene, line: &Line<Affine>, t: Affine, place: Place) -> Vec<Self> {
        Self::facing(scene, line, t, place).unwrap_or_default()
    }

    fn facing(scene: &Scene, line: &Line<Affine>, t: Affine, place: Place) -> Option<Vec<Self>> {
        let object = &scene.model.objects[place.object];
        let at = line.at(t);
        let shape = object.shape.proven()?;
        let normal = gradient_over(shape, at, place.part);
        let length = dot(normal, normal).sqrt();
        if length.range().low <= 0.0 || !length.is_bounded() {
            return None;
        }
        let outward = normal.map(|part| part / length);
        let toward = if object.shape.is_two_sided() {
            dot(outward, line.dir).range()
        } else {
            Interval::constant(-1.0)
        };
        // What a shader bends normals to is not enclosed.
        if object.shader.bends() {
            return None;
        }
        let shaded = |own: [Affine; 3], is_turned: bool| {
            let normal = shading_normals(shape, at, place.part, own)?;
            let unbent = (normal != own).then_some(own);
            let range = |vector: [Affine; 3]| vector.map(|axis| axis.range());
            let outward = if is_turned { normal.map(|part| -part) } else { normal };
            let sees = object.shader.sees();
            let point = PointBounds::seen(shape, sees, place.part, range(at), Some(range(outward)));
            let look = EncloseLook::<f64>::look(&*object.shader, &object.material, &point)?;
            let [ambient, diffuse, specular] =
                [look.ambient, look.diffuse, look.specular].map(|colour| colour.map(Affine::from));
            Some(Self { place, at, normal, unbent, ambient, diffuse, specular })
        };
        let mut all = Vec::with_capacity(2);
        if toward.low <= 0.0 {
            all.push(shaded(outward, false)?);
        }
        if toward.high >= 0.0 {
            all.push(shaded(outward.map(|part| -part), true)?);
        }
        Some(all)
    }

    /// Returns the directions in which rays along `dir` are mirrored, as long as these; `None` where they are open.
    pub fn mirrored(&self, dir: [Affine; 3]) -> Option<[Affine; 3]> {
        let mirrored = mirrored(dir, self.normal);
        let Some(unbent) = self.unbent else { return Some(mirrored) };
        // What bent normals mirror through the surface is turned back.
        let through = (dot(mirrored, unbent) * dot(dir, unbent)).range();
        if through.low > 0.0 {
            Some(self::mirrored(mirrored, unbent))
        } else {
            (through.high <= 0.0).then_some(mirrored)
        }
    }
}

fn mirrored(dir: [Affine; 3], normal: [Affine; 3]) -> [Affine; 3] {
    let across = dot(dir, normal);
    let twice = across + across;
    [0, 1, 2].map(|axis| dir[axis] - twice * normal[axis])
}

/// Returns the fraction of light that passes through an object at points; `None` where it is open.
pub(super) fn tint(transparency: f64, diffuse: Colour) -> Option<Colour> {
    let [red, green, blue] = diffuse;
    let strongest = red.max(green).max(blue);
    let transparency = Affine::constant(transparency);
    let ratio = |channel: Affine| match channel == strongest {
        true if strongest.rest == 0.0 => Affine::constant(1.0),
        _ => (channel / strongest).min(Affine::constant(1.0)),
    };
    if strongest.range().low > 0.0 {
        Some(diffuse.map(|channel| transparency * ratio(channel)))
    } else if strongest.range().high <= 0.0 {
        Some([transparency; 3])
    } else {
        None
    }
}

/// Tells whether a colour is black, for certain.
pub(super) fn is_black(colour: &Colour) -> bool {
    colour.iter().all(|channel| channel.is_zero())
}
