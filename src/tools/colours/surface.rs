//! A point of a surface that a ray hits, in intervals.

use super::scene::{Colour, Number, Place, Scene};
use tabray_core::geometry::sight::Line;
use tabray_core::world::certify::gradient;
use tabray_core::world::shader::PointBounds;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, dot, per_axis};

/// A point that a ray hits, and how it looks there.
pub(super) struct Surface<F> {
    pub place: Place,
    pub at: [Interval<F>; 3],
    /// The unit normal with which the point is shaded, turned to face the ray where both sides are lit.
    pub normal: [Interval<F>; 3],
    /// The unit normal of the surface itself, turned likewise, where the point is shaded with another.
    pub unbent: Option<[Interval<F>; 3]>,
    pub ambient: Colour<F>,
    pub diffuse: Colour<F>,
    pub specular: Colour<F>,
}

impl<F: Number> Surface<F> {
    /// Returns the point at t of a line; `None` where its normal or its look are open.
    pub fn new(scene: &Scene, line: &Line<Interval<F>>, t: Interval<F>, place: Place) -> Option<Self> {
        let object = &scene.objects[place.object];
        // What a shader bends normals to is not enclosed.
        if object.shader.bends() {
            return None;
        }
        let at = line.at(t);
        let proven = object.shape.proven()?;
        let shape = F::proofs(proven);
        let normal = gradient(shape, at, place.part);
        let length = dot(normal, normal).sqrt();
        if length.has_zero() || !length.is_bounded() {
            return None;
        }
        let normal = per_axis(|axis| normal[axis] / length);
        let zero = F::of(0.0);
        let toward =
            if object.shape.is_two_sided() { dot(normal, line.dir) } else { Interval::constant(-1.0) };
        let is_turned = toward.low > zero;
        if !is_turned && toward.high >= zero {
            return None;
        }
        let turned = |normal: [Interval<F>; 3]| {
            if is_turned { per_axis(|axis| -normal[axis]) } else { normal }
        };
        let normal = turned(normal);
        // What is mirrored is mirrored by the shading normal, too.
        let own = normal;
        let normal = shape.shading_normal(at, place.part, own)?;
        let unbent = (normal != own).then_some(own);
        let point = PointBounds::seen(proven, object.shader.sees(), place.part, at, Some(turned(normal)));
        let look = F::look(object, &point)?;
        let [ambient, diffuse, specular] = [look.ambient, look.diffuse, look.specular];
        Some(Self { place, at, normal, unbent, ambient, diffuse, specular })
    }

    /// Returns the direction in which a ray along `dir` is mirrored, as long as that; `None` where it is open.
    pub fn mirrored(&self, dir: [Interval<F>; 3]) -> Option<[Interval<F>; 3]> {
        let mirrored = mirrored(dir, self.normal);
        let Some(unbent) = self.unbent else { return Some(mirrored) };
        // What a bent normal mirrors through the surface is turned back.
        let through = dot(mirrored, unbent) * dot(dir, unbent);
        if through.low > F::of(0.0) {
            Some(self::mirrored(mirrored, unbent))
        } else {
            (through.high <= F::of(0.0)).then_some(mirrored)
        }
    }
}

fn mirrored<F: Float>(dir: [Interval<F>; 3], normal: [Interval<F>; 3]) -> [Interval<F>; 3] {
    let across = dot(dir, normal);
    let twice = across + across;
    per_axis(|axis| dir[axis] - twice * normal[axis])
}

/// Returns the fraction of light that passes through an object at a point; `None` where it is open.
pub(super) fn tint<F: Number>(transparency: f64, diffuse: Colour<F>) -> Option<Colour<F>> {
    let [red, green, blue] = diffuse;
    let strongest = red.max(green).max(blue);
    let transparency = Interval::constant(transparency);
    if strongest.low > F::of(0.0) {
        Some(per_axis(|channel| transparency * ratio(diffuse[channel], strongest)))
    } else if strongest.high <= F::of(0.0) {
        Some([transparency; 3])
    } else {
        None
    }
}

/// Divides a channel by the strongest one, which it is no greater than.
fn ratio<F: Float>(channel: Interval<F>, strongest: Interval<F>) -> Interval<F> {
    let one = Interval::constant(1.0);
    if channel == strongest && channel.low == channel.high { one } else { (channel / strongest).min(one) }
}

/// Tells whether a colour is black, for certain.
pub(super) fn is_black<F: Float>(colour: &Colour<F>) -> bool {
    colour.iter().all(|channel| channel.is_zero())
}
