//! First hits of planes, triangles, ellipsoids and quadrics: signs of integers, without any rounding.

use super::dyadic::Dyadic;
use super::number::Number;
use super::ray::{Ray, cross, dot, minus, times};
use super::text::{Sides, Vector};
use super::wide::Wide;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// The first intersection of a ray with a shape.
#[derive(Clone, Debug)]
pub enum Hit {
    Miss,
    /// An intersection at this multiple of the ray's direction.
    At(Wide),
    /// The ray touches an edge or the surface exactly, as far as can be decided: a tie between the results on either
    /// side.
    Touch,
}

/// The point of a ray at `top / bottom` times its direction; `bottom` is above 0.
struct Crossing {
    top: Dyadic,
    bottom: Dyadic,
}

/// Returns where a ray crosses a plane, or else `Miss` or `Touch`: planes are hit only ahead of the ray's origin and
/// not on the viewer's side of the image plane.
fn crossing(ray: &Ray, normal: &Vector, point: &Vector) -> Result<Crossing, Hit> {
    let bottom = dot(normal, &ray.dir);
    let top = dot(normal, &minus(point, &ray.origin));
    let (top, bottom) = match bottom.sign() {
        Equal => return Err(Hit::Miss),
        Less => (top.neg(), bottom.neg()),
        Greater => (top, bottom),
    };
    if top.sign() != Greater {
        return Err(Hit::Miss);
    }
    // Planes are not hit on the viewer's side of the image plane, where z > 1/100. Between 1/100 and its nearest f64 it
    // is a tie. A copy is a plane in another place: its z is that in the world.
    let Some([origin, dir]) = &ray.world_z else { return Ok(Crossing { top, bottom }) };
    let z = origin.mul(&bottom).add(&dir.mul(&top));
    let real = z.mul(&Dyadic::int(100)).compare(&bottom);
    let nearest = z.compare(&Dyadic::from(0.01).mul(&bottom));
    match (real == Greater, nearest == Greater) {
        (true, true) => Err(Hit::Miss),
        (false, false) => Ok(Crossing { top, bottom }),
        _ => Err(Hit::Touch),
    }
}

impl Crossing {
    fn hit(&self) -> Hit {
        Hit::At(Wide::quotient(&self.top, &self.bottom))
    }
}

pub fn plane(ray: &Ray, normal: &Vector, point: &Vector, sides: Option<&Sides>) -> Hit {
    let crossing = match crossing(ray, normal, point) {
        Ok(crossing) => crossing,
        Err(hit) => return hit,
    };
    let Some(Sides { xdir, dimensions }) = sides else { return crossing.hit() };
    // The first side is the component of xdir perpendicular to the normal, times the square of the normal's length.
    let first = minus(&times(xdir, &dot(normal, normal)), &times(normal, &dot(normal, xdir)));
    let second = cross(normal, &first);
    let from_corner = [0, 1, 2].map(|axis| {
        let origin = ray.origin[axis].sub(&point[axis]);
        origin.mul(&crossing.bottom).add(&ray.dir[axis].mul(&crossing.top))
    });
    let mut touches = false;
    for (side, dimension) in [(first, &dimensions[0]), (second, &dimensions[1])] {
        let along = dot(&side, &from_corner);
        // With sides of unit length, times the denominator: along <= dimension * |side| * bottom.
        let most = dimension.mul(&crossing.bottom).square().mul(&dot(&side, &side));
        let (low, high) = (along.sign(), along.square().compare(&most));
        if low == Less || (low == Greater && high == Greater) {
            return Hit::Miss;
        }
        touches |= low == Equal || high == Equal;
    }
    if touches { Hit::Touch } else { crossing.hit() }
}

pub fn triangle(ray: &Ray, corners: &[Vector; 3]) -> Hit {
    let [a, b, c] = corners;
    let normal = cross(&minus(b, a), &minus(c, a));
    let crossing = match crossing(ray, &normal, a) {
        Ok(crossing) => crossing,
        Err(hit) => return hit,
    };
    let side = |from: &Vector, to: &Vector| {
        dot(&cross(&minus(from, &ray.origin), &minus(to, &ray.origin)), &ray.dir).sign()
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    if sides.contains(&Less) && sides.contains(&Greater) {
        Hit::Miss
    } else if sides.contains(&Equal) {
        Hit::Touch
    } else {
        crossing.hit()
    }
}

/// A face that a ray meets, ahead of its origin.
struct FaceHit {
    face: usize,
    crossing: Crossing,
    /// Whether the ray passes through the inside of the face, not through an edge or a corner.
    is_inner: bool,
    /// Whether the ray comes from the face's outside.
    is_outside: bool,
}

/// Returns the faces that a ray meets first, at one distance; `None` if the ray touches a face in whose plane it lies.
fn met(ray: &Ray, faces: &[[Vector; 3]]) -> Option<Vec<FaceHit>> {
    let mut nearest: Vec<FaceHit> = Vec::new();
    for (face, [a, b, c]) in faces.iter().enumerate() {
        let from = [a, b, c].map(|corner| minus(corner, &ray.origin));
        let side = |one: usize, other: usize| dot(&cross(&from[one], &from[other]), &ray.dir).sign();
        let sides = [side(0, 1), side(1, 2), side(2, 0)];
        if sides.contains(&Less) && sides.contains(&Greater) {
            continue;
        }
        let normal = cross(&minus(b, a), &minus(c, a));
        let (bottom, top) = (dot(&normal, &ray.dir), dot(&normal, &from[0]));
        let (top, bottom, is_outside) = match bottom.sign() {
            // A line that meets no corner of a face that has an area passes none of its edges in its plane.
            Equal if top.is_zero() => return None,
            Equal => continue,
            Less => (top.neg(), bottom.neg(), true),
            Greater => (top, bottom, false),
        };
        if top.sign() != Greater {
            continue;
        }
        let order = nearest
            .first()
            .map_or(Less, |first| top.mul(&first.crossing.bottom).compare(&first.crossing.top.mul(&bottom)));
        if order == Greater {
            continue;
        }
        if order == Less {
            nearest.clear();
        }
        let is_inner = !sides.contains(&Equal);
        nearest.push(FaceHit { face, crossing: Crossing { top, bottom }, is_inner, is_outside });
    }
    Some(nearest)
}

/// Returns the first hit of a mesh, whose faces share their edges. Where the ray meets an edge or a corner, it hits the
/// mesh if it passes from one side to the other there, and touches it if it does not.
pub fn mesh(ray: &Ray, faces: &[[Vector; 3]]) -> Hit {
    let Some(nearest) = met(ray, faces) else { return Hit::Touch };
    let Some(first) = nearest.first() else { return Hit::Miss };
    let passes = nearest.len() > 1 && nearest.iter().all(|met| met.is_outside == first.is_outside);
    if passes || nearest.iter().any(|met| met.is_inner) { first.crossing.hit() } else { Hit::Touch }
}

/// Returns the index of a face of a mesh that a ray hits first.
pub fn face(ray: &Ray, faces: &[[Vector; 3]]) -> Option<usize> {
    met(ray, faces)?.first().map(|met| met.face)
}

/// Returns the sign of `p + q * sqrt(square)`.
fn sign_with_root(p: &Dyadic, q: &Dyadic, square: &Dyadic) -> Ordering {
    let by_root = if square.is_zero() { Equal } else { q.sign() };
    match (p.sign(), by_root) {
        (one, two) if one == two || two == Equal => one,
        (Equal, two) => two,
        (one, two) => match p.square().compare(&q.square().mul(square)) {
            Greater => one,
            Less => two,
            Equal => Equal,
        },
    }
}

/// Returns the first root of `a s^2 + 2 b s + c` that is ahead of the ray's origin and between the two bounds on each
/// axis.
fn quadratic(ray: &Ray, [a, b, c]: [Dyadic; 3], bounds: Option<(&Vector, &Vector, &Vector)>) -> Hit {
    if a.is_zero() {
        if b.is_zero() {
            return if c.is_zero() { Hit::Touch } else { Hit::Miss };
        }
        // There is one root, -c / 2b, here written as (-c + 0 * root) / 2b.
        let [b, c] = if b.sign() == Less { [b.neg(), c.neg()] } else { [b, c] };
        let root = Root { p: c.neg(), q: Dyadic::zero(), square: Dyadic::zero(), a: b.shifted(1) };
        return match root.kept(ray, bounds) {
            Equal => Hit::Touch,
            Greater => Hit::At(root.place(&Dyadic::zero())),
            Less => Hit::Miss,
        };
    }
    let [a, b, c] = if a.sign() == Less { [a.neg(), b.neg(), c.neg()] } else { [a, b, c] };
    let square = b.square().sub(&a.mul(&c));
    match square.sign() {
        Less => return Hit::Miss,
        Equal => return Hit::Touch,
        Greater => {}
    }
    for q in [-1, 1] {
        let root = Root { p: b.neg(), q: Dyadic::int(q), square: square.clone(), a: a.clone() };
        match root.kept(ray, bounds) {
            Greater => return Hit::At(root.place(&c)),
            Equal => return Hit::Touch,
            Less => {}
        }
    }
    Hit::Miss
}

/// The root `(p + q sqrt(square)) / a`, where a is above 0.
struct Root {
    p: Dyadic,
    q: Dyadic,
    square: Dyadic,
    a: Dyadic,
}

impl Root {
    /// Compares the root with the bounds: `Greater` if it is ahead of the ray's origin and inside all bounds, `Equal`
    /// if it is exactly on one of them, `Less` otherwise.
    fn kept(&self, ray: &Ray, bounds: Option<(&Vector, &Vector, &Vector)>) -> Ordering {
        let mut worst = sign_with_root(&self.p, &self.q, &self.square);
        let Some((center, low, high)) = bounds else { return worst };
        for axis in 0..3 {
            let (origin, dir) = (ray.origin[axis].sub(&center[axis]), &ray.dir[axis]);
            for (bound, is_low) in [(&low[axis], true), (&high[axis], false)] {
                // (origin - bound) a + dir (p + q root)
                let p = origin.sub(bound).mul(&self.a).add(&dir.mul(&self.p));
                let sign = sign_with_root(&p, &dir.mul(&self.q), &self.square);
                worst = worst.min(if is_low { sign } else { sign.reverse() });
            }
        }
        worst
    }

    /// Returns the root's value. Where a difference would cancel, it follows from the product of the two roots.
    fn place(&self, c: &Dyadic) -> Wide {
        if self.q.is_zero() {
            return Wide::quotient(&self.p, &self.a);
        }
        let root = Wide::root_of(&self.square);
        let part = Wide::exact(&self.q).mul(&root);
        let together = self.p.sign() != self.q.sign().reverse();
        if together {
            Wide::exact(&self.p).add(&part).div(&Wide::exact(&self.a))
        } else {
            Wide::exact(c).div(&Wide::exact(&self.p).sub(&part))
        }
    }
}

pub fn ball(ray: &Ray, center: &Vector, radius: &Dyadic, scale: &Vector) -> Hit {
    let [x, y, z] = scale;
    // The ray in the space in which the ellipsoid is a sphere, with all coordinates multiplied by all three scales.
    let others = [y.mul(z), x.mul(z), x.mul(y)];
    let from = minus(&ray.origin, center);
    let from = [0, 1, 2].map(|axis| from[axis].mul(&others[axis]));
    let dir = [0, 1, 2].map(|axis| ray.dir[axis].mul(&others[axis]));
    let all = x.mul(&others[0]).mul(radius);
    quadratic(ray, [dot(&dir, &dir), dot(&from, &dir), dot(&from, &from).sub(&all.square())], None)
}

pub fn quadric(ray: &Ray, k: &[Dyadic], center: &Vector, low: &Vector, high: &Vector) -> Hit {
    let from = minus(&ray.origin, center);
    // Twice the symmetric bilinear form of the quadratic terms.
    let twice = |a: &Vector, b: &Vector| {
        let mut sum = Dyadic::zero();
        for axis in 0..3 {
            sum = sum.add(&k[axis].mul(&a[axis]).mul(&b[axis]).shifted(1));
        }
        for (of, (i, j)) in [(3, (0, 1)), (4, (0, 2)), (5, (1, 2))] {
            sum = sum.add(&k[of].mul(&a[i].mul(&b[j]).add(&a[j].mul(&b[i]))));
        }
        sum
    };
    let linear = [k[6].clone(), k[7].clone(), k[8].clone()];
    let a = twice(&ray.dir, &ray.dir).shifted(-1);
    let b = twice(&from, &ray.dir).add(&dot(&linear, &ray.dir)).shifted(-1);
    let c = twice(&from, &from).shifted(-1).add(&dot(&linear, &from)).sub(&k[9]);
    quadratic(ray, [a, b, c], Some((center, low, high)))
}
