//! The first hit of a ray on shapes with a formula for it, in numbers of 300 bits.
//!
//! Everything is computed from the numbers of a scene's text, taken as exact, and from a ray: one of the program, whose
//! numbers are also taken as exact, or the exact ray through a point of the image plane. No intermediate result of the
//! program is used.

use super::{Hit, Truth};
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::{DVec2, DVec3};
use tabray::exact::double_double::DoubleDouble;
use tabray::geometry::Ray;

/// A number of 300 bits.
pub type Big = FBig<HalfEven, 2>;

type Vector = [Big; 3];

/// The relative distance from a tangency or an edge below which the side is undecided, relative to the numbers from
/// which it was computed: 2^-230, far above the rounding errors of some fifty operations of 300 bits.
const EDGE: f64 = 5.8e-70;

/// The ray that a truth is about.
#[derive(Clone)]
pub struct Line {
    origin: Vector,
    /// The direction; distances are in units of its length.
    dir: Vector,
}

impl From<&Ray> for Line {
    fn from(ray: &Ray) -> Self {
        Self { origin: vector(ray.origin), dir: vector(ray.dir) }
    }
}

impl Line {
    /// Makes the exact ray from a viewpoint through a pixel of the image plane, both as a scene's camera has them.
    pub fn of_pixel(viewpoint: DVec3, world: DVec2, pixels: [u32; 2], pixel: [u32; 2]) -> Self {
        let place =
            |axis: usize| big(f64::from(pixel[axis])) / big(f64::from(pixels[axis] - 1)) * big(world[axis]);
        let origin = vector(viewpoint);
        let dir = unit(&difference(&[place(0), place(1), big(0.0)], &origin));
        Self { origin, dir }
    }

    fn at(&self, t: &Big) -> Vector {
        std::array::from_fn(|axis| &self.origin[axis] + t * &self.dir[axis])
    }
}

/// A plane, or the plane of a planar shape.
#[derive(Clone, Copy)]
pub struct Plane {
    /// A normal of any length.
    pub normal: DVec3,
    /// A point of the plane.
    pub point: DVec3,
}

impl Plane {
    /// Makes the plane through a point with a normal of any length.
    pub fn new(normal: DVec3, point: DVec3) -> Self {
        Self { normal, point }
    }

    /// Returns the first hit of a ray. In front of the image plane there are no planes (the notes).
    pub fn first_hit(&self, line: &Line) -> Truth {
        self.crossing(line, &vector(self.normal)).truth()
    }

    fn crossing(&self, line: &Line, normal: &Vector) -> Crossing {
        const SCREEN: f64 = 0.01;
        let (toward, from) = (dot(normal, &line.dir), difference(&vector(self.point), &line.origin));
        if toward == Big::ZERO {
            return Crossing::Decided(Truth::Miss);
        }
        if is_tiny(&toward, &sizes(normal, &line.dir)) {
            return Crossing::Decided(Truth::Undecided);
        }
        let away = dot(normal, &from);
        if away == Big::ZERO {
            return Crossing::Decided(Truth::Miss);
        }
        if is_tiny(&away, &sizes(normal, &from)) {
            return Crossing::Decided(Truth::Undecided);
        }
        let t = away / &toward;
        if t < Big::ZERO {
            return Crossing::Decided(Truth::Miss);
        }
        let onward = &t * &line.dir[2];
        let beyond = &line.origin[2] + &onward - big(SCREEN);
        let size = magnitude(&line.origin[2]) + magnitude(&onward);
        // A hit on the image plane itself counts.
        if is_tiny(&beyond, &size) {
            return Crossing::Decided(Truth::Undecided);
        }
        if beyond > Big::ZERO {
            return Crossing::Decided(Truth::Miss);
        }
        let slope = (toward / dot(normal, normal).sqrt()).to_f64().value();
        Crossing::At(t, slope)
    }

    /// Returns the first hit on the part of the plane on which `depths` of a point are not below 0.
    fn part_hit(&self, line: &Line, normal: &Vector, depths: impl Fn(&Vector) -> Vec<(Big, Big)>) -> Truth {
        let crossing = self.crossing(line, normal);
        let Crossing::At(t, _) = &crossing else { return crossing.truth() };
        let depths = depths(&difference(&line.at(t), &vector(self.point)));
        if depths.iter().any(|(depth, size)| *depth < Big::ZERO && !is_tiny(depth, size)) {
            Truth::Miss
        } else if depths.iter().any(|(depth, size)| is_tiny(depth, size)) {
            Truth::Undecided
        } else {
            crossing.truth()
        }
    }
}

/// What is known of the crossing of a line and a plane.
enum Crossing {
    Decided(Truth),
    /// The distance, and the slope.
    At(Big, f64),
}

impl Crossing {
    fn truth(self) -> Truth {
        match self {
            Self::Decided(truth) => truth,
            Self::At(t, slope) => hit(&t, slope),
        }
    }
}

/// Returns the first hit on a rectangle of these dimensions.
pub fn rectangle(plane: &Plane, xdir: DVec3, dimensions: DVec2, line: &Line) -> Truth {
    let normal = vector(plane.normal);
    let y = cross(&normal, &vector(xdir));
    let sides = [unit(&cross(&y, &normal)), unit(&y)];
    plane.part_hit(line, &normal, |at| {
        let depth = |side: usize| {
            let (along, whole) = (dot(&sides[side], at), big(dimensions[side]));
            let size = sizes(&sides[side], at) + &whole;
            [(along.clone(), size.clone()), (whole - along, size)]
        };
        [depth(0), depth(1)].concat()
    })
}

/// Returns the first hit on a triangle.
pub fn triangle(corners: [DVec3; 3], line: &Line) -> Truth {
    let plane = Plane::new(DVec3::ZERO, corners[0]);
    let corners = corners.map(vector);
    let start = corners[0].clone();
    let [a, b, c] = corners.map(|corner| difference(&corner, &start));
    let normal = cross(&b, &c);
    plane.part_hit(line, &normal, |at| {
        let depth = |from: &Vector, to: &Vector| {
            let inward = cross(&normal, &difference(to, from));
            let from_edge = difference(at, from);
            (dot(&inward, &from_edge), sizes(&inward, &from_edge))
        };
        vec![depth(&a, &b), depth(&b, &c), depth(&c, &a)]
    })
}

/// Returns the first hit beyond `near` on a sphere stretched along the axes. Rays that start inside hit the far wall.
pub fn ellipsoid(center: DVec3, radius: f64, scale: DVec3, line: &Line, near: f64) -> Truth {
    let scale = vector(scale);
    let squeezed = |of: &Vector| -> Vector { std::array::from_fn(|axis| &of[axis] / &scale[axis]) };
    let (origin, dir) = (squeezed(&difference(&line.origin, &vector(center))), squeezed(&line.dir));
    let radius = big(radius);
    let [a, b] = [dot(&dir, &dir), dot(&origin, &dir)];
    let c = dot(&origin, &origin) - &radius * &radius;
    let size = dot(&origin, &origin);
    let Roots::Two(roots) = roots(&a, &b, &c, &size) else { return Truth::Miss };
    let Some(roots) = roots else { return Truth::Undecided };
    for t in roots {
        if t > big(near) {
            let slope = big(2.0) * (&a * &t + &b);
            return hit(&t, slope.to_f64().value());
        }
    }
    Truth::Miss
}

/// Returns the first hit beyond `near` on a sphere.
pub fn sphere(center: DVec3, radius: f64, line: &Line, near: f64) -> Truth {
    ellipsoid(center, radius, DVec3::ONE, line, near)
}

/// The part in a box of the quadric Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J, relative to a center.
pub struct Quadric {
    /// The coefficients A to J.
    pub coefficients: [f64; 10],
    /// The origin of x, y and z.
    pub center: DVec3,
    /// The corners of the box.
    pub corners: [DVec3; 2],
}

impl Quadric {
    /// Returns the first hit of a ray beyond `near`.
    pub fn first_hit(&self, line: &Line, near: f64) -> Truth {
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(big);
        // Returns a vector multiplied by twice the symmetric matrix of the quadratic terms.
        let two = big(2.0);
        let turned = |[x, y, z]: &Vector| -> Vector {
            [
                &two * &a * x + &d * y + &e * z,
                &d * x + &two * &b * y + &f * z,
                &e * x + &f * y + &two * &c * z,
            ]
        };
        let linear = [g.clone(), h.clone(), i.clone()];
        let from = difference(&line.origin, &vector(self.center));
        let across = turned(&line.dir);
        let quadratic = dot(&line.dir, &across) / &two;
        let half = (dot(&from, &across) + dot(&linear, &line.dir)) / &two;
        let constant = dot(&from, &turned(&from)) / &two + dot(&linear, &from) - j;
        if quadratic == Big::ZERO {
            if half == Big::ZERO {
                return Truth::Miss;
            }
            let t = -constant / (&two * &half);
            return self.first_kept(line, &from, [t], near, |_| half.to_f64().value());
        }
        match roots(&quadratic, &half, &constant, &magnitude(&constant)) {
            Roots::None => Truth::Miss,
            Roots::Two(None) => Truth::Undecided,
            Roots::Two(Some(roots)) => self
                .first_kept(line, &from, roots, near, |t| (&two * (&quadratic * t + &half)).to_f64().value()),
        }
    }

    fn first_kept<const N: usize>(
        &self,
        line: &Line,
        from: &Vector,
        roots: [Big; N],
        near: f64,
        slope: impl Fn(&Big) -> f64,
    ) -> Truth {
        for t in roots.into_iter().filter(|t| *t > big(near)) {
            let onward: Vector = std::array::from_fn(|axis| &t * &line.dir[axis]);
            let at = add(from, &onward);
            let (mut is_in, mut is_near) = (true, false);
            for axis in 0..3 {
                let size = magnitude(&from[axis]) + magnitude(&onward[axis]);
                let [low, high] = self.corners.map(|corner| big(corner[axis]));
                for depth in [&at[axis] - low, high - &at[axis]] {
                    let is_tie = is_tiny(&depth, &size);
                    is_near |= is_tie;
                    is_in &= depth >= Big::ZERO || is_tie;
                }
            }
            match (is_in, is_near) {
                (false, _) => {}
                (true, false) => return hit(&t, slope(&t)),
                (true, true) => return Truth::Undecided,
            }
        }
        Truth::Miss
    }
}

/// The real roots of a quadratic equation.
enum Roots {
    None,
    /// The lesser root first; `None` if their existence is undecided.
    Two(Option<[Big; 2]>),
}

/// Returns the roots of `a t^2 + 2 b t + c`; `size` is the magnitude of the terms of `c`.
fn roots(a: &Big, b: &Big, c: &Big, size: &Big) -> Roots {
    let (square, product) = (b * b, a * c);
    let discriminant = &square - &product;
    if is_tiny(&discriminant, &(square + magnitude(&product) + magnitude(a) * size)) {
        return Roots::Two(None);
    }
    if discriminant < Big::ZERO {
        return Roots::None;
    }
    let root = discriminant.sqrt();
    // 300 bits are enough for the cancellation here, at distances below 1e15.
    let [one, other] = [(-b - &root) / a, (root - b) / a];
    Roots::Two(Some(if one < other { [one, other] } else { [other, one] }))
}

fn hit(t: &Big, slope: f64) -> Truth {
    let high = t.to_f64().value();
    let low = (t - big(high)).to_f64().value();
    Truth::Hit(Hit { t: DoubleDouble { high, low }, slope })
}

/// Converts a number to 300 bits, exactly.
pub fn big(number: f64) -> Big {
    Big::try_from(number).expect("a finite number").with_precision(300).value()
}

fn is_tiny(value: &Big, size: &Big) -> bool {
    magnitude(value) <= size * big(EDGE)
}

fn magnitude(value: &Big) -> Big {
    if *value < Big::ZERO { -value } else { value.clone() }
}

fn vector(vector: DVec3) -> Vector {
    vector.to_array().map(big)
}

fn difference(to: &Vector, from: &Vector) -> Vector {
    std::array::from_fn(|axis| &to[axis] - &from[axis])
}

fn add(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|axis| &a[axis] + &b[axis])
}

fn dot(a: &Vector, b: &Vector) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Returns the sum of the magnitudes of a product's terms.
fn sizes(a: &Vector, b: &Vector) -> Big {
    magnitude(&(&a[0] * &b[0])) + magnitude(&(&a[1] * &b[1])) + magnitude(&(&a[2] * &b[2]))
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(one, other)| &a[one] * &b[other] - &a[other] * &b[one])
}

fn unit(of: &Vector) -> Vector {
    let length = dot(of, of).sqrt();
    std::array::from_fn(|axis| &of[axis] / &length)
}
