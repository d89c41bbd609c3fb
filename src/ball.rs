//! Where a line meets a ball around the origin: the arithmetic behind spheres and ellipsoids.
//!
//! The notes' formula loses far, small and grazed balls, as `b^2 - 4ac` cancels. Here the discriminant comes from the
//! line's point closest to the centre (Haines, Günther and Akenine-Möller 2019), the root is corrected by a step of
//! Newton's method from a point that is rounded once, and what rounding could decide is decided in twice the
//! precision.

use crate::accuracy::Accuracy;
use crate::geometry::MISS;
use crate::twofold::{Twofold, two_product, two_sum};
use glam::DVec3;

/// A half line from a point, in twice the precision.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it starts, counted from the centre.
    pub from: [Twofold; 3],
    /// Where it goes; of any length. Distances are counted in this length.
    pub dir: [Twofold; 3],
}

/// The distance of the first hit of a ball: of its near side, or from inside of its far one. A line that only
/// touches it misses it, as in the notes.
///
/// `from` and `dir` are what `line` is when it is rounded. Most lines need no more, and miss.
#[inline(always)]
pub fn first_hit(from: DVec3, dir: DVec3, line: impl Fn() -> Line, radius: f64, accuracy: Accuracy) -> f64 {
    if accuracy == Accuracy::Strict {
        return in_twice_the_precision(&line(), radius);
    }
    let a = dir.dot(dir);
    let toward = -from.dot(dir);
    let aside = from + (toward / a) * dir;
    let room = radius * radius - aside.dot(aside);
    let size = from.abs().element_sum() + radius;
    let outside = from.dot(from) - radius * radius;
    // A few units in the last place of what the differences came from.
    let doubt = 32.0 * f64::EPSILON * radius * size;
    if room < -doubt {
        return MISS;
    }
    if room <= doubt || outside.abs() <= 32.0 * f64::EPSILON * size * size {
        return in_twice_the_precision(&line(), radius);
    }
    let root = (a * room).sqrt();
    let (near, far) = if toward > 0.0 {
        (outside / (toward + root), (toward + root) / a)
    } else {
        ((toward - root) / a, outside / (toward - root))
    };
    let distance = if near > 0.0 { near } else { far };
    if distance <= 0.0 || accuracy == Accuracy::Draft {
        return if distance > 0.0 { distance } else { MISS };
    }
    // The error of the point's own rounding matters where the ball is large for its distance or met aslant.
    if radius * radius <= distance * root {
        corrected(&line(), radius, distance)
    } else {
        corrected_in_twice_the_precision(&line(), radius, distance)
    }
}

#[inline(always)]
fn high(of: &[Twofold; 3]) -> DVec3 {
    DVec3::new(of[0].high, of[1].high, of[2].high)
}

/// A step of Newton's method, from a point rounded once.
#[inline(always)]
fn corrected(line: &Line, radius: f64, distance: f64) -> f64 {
    let part = |axis: usize| {
        let (from, dir) = (line.from[axis], line.dir[axis]);
        let (product, product_low) = two_product(distance, dir.high);
        let (sum, sum_low) = two_sum(from.high, product);
        sum + (product_low + sum_low + from.low + distance * dir.low)
    };
    let at = DVec3::new(part(0), part(1), part(2));
    distance - (at.dot(at) - radius * radius) / (2.0 * at.dot(high(&line.dir)))
}

/// A step of Newton's method, from a point in twice the precision.
fn corrected_in_twice_the_precision(line: &Line, radius: f64, distance: f64) -> f64 {
    let part = |axis: usize| line.from[axis] + Twofold::from(distance) * line.dir[axis];
    let at = [part(0), part(1), part(2)];
    let outside = dot(&at, &at) - square(radius);
    distance - outside.high / (2.0 * dot(&at, &line.dir).high)
}

/// All of it in twice the precision.
fn in_twice_the_precision(line: &Line, radius: f64) -> f64 {
    let a = dot(&line.dir, &line.dir);
    let toward = -dot(&line.from, &line.dir);
    let outside = dot(&line.from, &line.from) - square(radius);
    let discriminant = toward * toward - a * outside;
    if discriminant.high <= 0.0 {
        return MISS;
    }
    let root = discriminant.sqrt();
    let (near, far) = if toward.high > 0.0 {
        (outside / (toward + root), (toward + root) / a)
    } else {
        ((toward - root) / a, outside / (toward - root))
    };
    if near.high > 0.0 {
        near.high
    } else if far.high > 0.0 {
        far.high
    } else {
        MISS
    }
}

fn square(value: f64) -> Twofold {
    let (high, low) = two_product(value, value);
    Twofold { high, low }
}

fn dot(a: &[Twofold; 3], b: &[Twofold; 3]) -> Twofold {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
