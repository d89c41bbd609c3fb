//! Where a line meets a ball around the origin: the arithmetic behind spheres and ellipsoids.
//!
//! The notes' formula loses far, small and grazed balls, as `b^2 - 4ac` cancels. Here the discriminant comes from the
//! line's point closest to the centre (Haines, Günther and Akenine-Möller 2019), the root is corrected by a step of
//! Newton's method, and what rounding could decide is decided in twice the precision.

use crate::geometry::aabb::larger;
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::numeric::double_double::{DoubleDouble, exponent_to_one, times_power_of_two, two_product};
use crate::world::accuracy::{Accuracy, Bounded};
use glam::DVec3;

/// A half line from a point, in twice the precision.
#[derive(Clone, Copy, Debug)]
pub struct SphereLine {
    /// Where it starts, counted from the centre.
    pub from: [DoubleDouble; 3],
    /// Where it goes; of any length. Distances are counted in this length.
    pub dir: [DoubleDouble; 3],
}

impl SphereLine {
    /// A ray, counted from the centre.
    #[inline(always)]
    pub fn new(ray: &Ray, center: DVec3) -> Self {
        let from = |axis: usize| DoubleDouble::difference(ray.origin[axis], center[axis]);
        let dir = |axis: usize| DoubleDouble::from(ray.dir[axis]);
        Self { from: [from(0), from(1), from(2)], dir: [dir(0), dir(1), dir(2)] }
    }

    /// A ray where space around the centre is squeezed: by these factors along the axes.
    #[inline(always)]
    pub fn squeezed(ray: &Ray, center: DVec3, squeeze: &[DoubleDouble; 3]) -> Self {
        let Self { from, dir } = Self::new(ray, center);
        let scaled = |of: [DoubleDouble; 3]| [of[0] * squeeze[0], of[1] * squeeze[1], of[2] * squeeze[2]];
        Self { from: scaled(from), dir: scaled(dir) }
    }
}

/// How hits are computed, in a few words.
pub fn method<A: Bounded>() -> &'static str {
    match A::ACCURACY {
        Accuracy::Draft => "a closed form, in twice the precision where rounding could decide",
        Accuracy::Exact => {
            "a closed form and a step of Newton's method, in twice the precision where rounding could decide"
        }
        _ => "a closed form in twice the precision",
    }
}

/// How the notes compute hits, in a few words.
pub const CLASSIC_METHOD: &str = "the notes' formula";

/// The notes' distance of a ball, for a ray that starts `from` its centre.
#[inline(always)]
pub fn classic(from: DVec3, dir: DVec3, radius: f64) -> f64 {
    let a = dir.dot(dir);
    let b = 2.0 * from.dot(dir);
    let c = from.dot(from) - radius * radius;
    let discriminant = b * b - 4.0 * a * c;
    // A ray that only touches the sphere misses it.
    if discriminant <= 0.0 { MISS } else { (-b - discriminant.sqrt()) / (2.0 * a) }
}

/// The distance of the first hit of a ball: of its near side, or from inside of its far one. A line that only
/// touches it misses it, as in the notes.
#[inline(always)]
pub fn first_hit<A: Bounded>(line: &SphereLine, radius: f64) -> f64 {
    let quick = quick_hit::<A>(line, radius);
    if quick.is_nan() { in_twice_the_precision(line, radius) } else { quick }
}

/// As [`first_hit`], or NaN where rounding could decide it.
#[inline(always)]
pub fn quick_hit<A: Bounded>(line: &SphereLine, radius: f64) -> f64 {
    let (from, dir) = (high(&line.from), high(&line.dir));
    let a = dir.dot(dir);
    let toward = -from.dot(dir);
    let aside = from + (toward / a) * dir;
    let room = radius * radius - aside.dot(aside);
    let size = from.abs().element_sum() + radius;
    let outside = from.dot(from) - radius * radius;
    // Units of 2^-53 of the way from the centre: `from` is off by 1, `toward` by 5, `a` by 4, their product with the
    // direction by 3 and the sum by 1: 14, less than 32. Of a line that touches the ball, the room is then off by this.
    let aside_error = 16.0 * f64::EPSILON * size;
    let doubt = aside_error * (2.0 * radius + aside_error);
    let is_missed = room < -doubt;
    // Where the room is GRAZE times its error, the root is right to 1 / 2 GRAZE of itself, and a step of Newton's method
    // makes 1 / 8 GRAZE^2 of that.
    const GRAZE: f64 = (1 << 18) as f64;
    let is_doubtful = (A::ACCURACY == Accuracy::Strict)
        | (!is_missed & ((room <= GRAZE * doubt) | (outside.abs() <= 32.0 * f64::EPSILON * size * size)));
    let root = (a * room).sqrt();
    let is_ahead = toward > 0.0;
    let larger = if is_ahead { toward + root } else { toward - root };
    let (one, other) = (outside / larger, larger / a);
    let (near, far) = if is_ahead { (one, other) } else { (other, one) };
    let distance = if near > 0.0 { near } else { far };
    let corrected = if A::ACCURACY == Accuracy::Draft { distance } else { corrected(line, radius, distance) };
    let is_behind = distance <= 0.0;
    if is_doubtful {
        f64::NAN
    } else if is_missed | is_behind {
        MISS
    } else {
        corrected
    }
}

/// The distance at which a line from the inner side of a ball's wall meets the wall again; [`MISS`] where it does not go
/// inward.
///
/// The equation's other root is where it starts. Where what rounding makes of the start is not small beside the way into
/// the ball, the start is taken for a point of the wall, whose far root is twice as far as the middle.
#[inline(always)]
pub fn far_hit<A: Bounded>(line: &SphereLine, radius: f64) -> f64 {
    let (from, dir) = (high(&line.from), high(&line.dir));
    let a = dir.dot(dir);
    let toward = -from.dot(dir);
    let outside = a * (from.dot(from) - radius * radius);
    let is_deep = outside.abs() <= 0.25 * toward * toward;
    let half = if is_deep { toward * toward - outside } else { 0.0 }.sqrt();
    let distance = (toward + if is_deep { half } else { toward }) / a;
    let does_correct = is_deep & (A::ACCURACY != Accuracy::Draft);
    let distance = if does_correct { corrected(line, radius, distance) } else { distance };
    if toward > 0.0 { distance } else { MISS }
}

/// The distance along a ray that leaves the ball on a side, or does not start on it.
#[inline(always)]
pub fn distance<A: Bounded>(line: &SphereLine, radius: f64, origin_side: Option<Side>) -> f64 {
    match origin_side {
        None => first_hit::<A>(line, radius),
        Some(Side::Inside) => far_hit::<A>(line, radius),
        Some(Side::Outside) => MISS,
    }
}

/// As [`distance`], or NaN where rounding could decide it.
#[inline(always)]
pub fn refine<A: Bounded>(line: &SphereLine, radius: f64, origin_side: Option<Side>) -> f64 {
    let distance = match origin_side {
        None => quick_hit::<A>(line, radius),
        Some(Side::Inside) => far_hit::<A>(line, radius),
        Some(Side::Outside) => MISS,
    };
    if distance.is_nan() { distance } else { RayRange::ALL.keep(distance) }
}

/// Whether a point so far from the centre lies on a ball's wall, but for an error in the ball's own units and for what
/// rounding makes of both distances from the centre.
#[inline(always)]
pub fn touches(from: DVec3, radius: f64, error: f64) -> bool {
    (from.length() - radius).abs() <= error + 4.0 * f64::EPSILON * radius
}

/// Between which distances the first hit is, of a line whose direction has the length `1 / sqrt(inverse)` and whose
/// origin may be off by an error, in the ball's own units.
///
/// `spread` is by how much the direction's components may be further off, against its length, than those of a unit
/// vector: 1 for one. It is wide, and plain arithmetic tells it quickly: most rays miss most balls.
#[inline(always)]
pub fn t_bounds(
    from: DVec3,
    dir: DVec3,
    inverse: f64,
    spread: f64,
    radius: f64,
    origin_side: Option<Side>,
    origin_error: f64,
) -> Bracket {
    // Far more than rounding makes of the root where there is room enough.
    const ERROR: f64 = 1.0 / (1 << 29) as f64;
    const ROOM: f64 = 32_768.0 * f64::EPSILON;
    // A line that starts within an error e of the wall has one root no farther from its origin than `2 r e` divided by
    // the other, which is at least `sqrt(ROOM r size)`: less than `ERROR size` where the size is so many e.
    const ORIGIN_ERRORS: f64 = (1_u64 << 49) as f64;
    // A line that goes so far inward, as a part of the size, does so by far more than it may start off the wall.
    const INWARD: f64 = 1.0 / (1 << 20) as f64;

    let middle = -from.dot(dir) * inverse;
    let aside = from + middle * dir;
    let room = radius * radius - aside.dot(aside);
    // Of what `aside` is off by: 14 units of 2^-53 of the way from the centre, as in `quick_hit`, and 3 in each
    // component for a camera's direction. ROOM is thousands of times as much, so that the half chord is off by less
    // than ERROR where there is that room.
    // The sum of what all rays of a packet have in common comes first.
    let size = spread * from.abs().element_sum() + (spread * radius + ORIGIN_ERRORS * origin_error);
    let error = ERROR * size * inverse.sqrt();
    let room_error = ROOM * size;
    let doubt = room_error * (radius + room_error);
    let half = (larger(room, 0.0) * inverse).sqrt();
    let (near, far) = (middle - half, middle + half);
    match origin_side {
        None => {}
        Some(Side::Outside) => return Bracket::MISS,
        Some(Side::Inside) => {
            let is_there = (room > doubt) & (middle > INWARD * size * inverse.sqrt()) & (far > error);
            return Bracket {
                near: if is_there { far - error } else { 0.0 },
                far: if is_there { far + error } else { MISS },
            };
        }
    }
    let is_missed = (room < -doubt) | (far < -error);
    // From outside of it, or from inside.
    let is_ahead = near > error;
    let is_inside = (near < -error) & (far > error);
    let is_there = (room > doubt) & (is_ahead | is_inside);
    let distance = if is_ahead { near } else { far };
    Bracket {
        near: if is_missed {
            MISS
        } else if is_there {
            distance - error
        } else {
            0.0
        },
        far: if is_there & !is_missed { distance + error } else { MISS },
    }
}

#[inline(always)]
fn high(of: &[DoubleDouble; 3]) -> DVec3 {
    DVec3::new(of[0].high, of[1].high, of[2].high)
}

/// A step of Newton's method, from a point in twice the precision: the error of the point's own rounding matters
/// where the ball is large for its distance or met aslant.
#[inline(always)]
fn corrected(line: &SphereLine, radius: f64, distance: f64) -> f64 {
    let part = |axis: usize| line.from[axis] + DoubleDouble::from(distance) * line.dir[axis];
    let at = [part(0), part(1), part(2)];
    let outside = dot(&at, &at) - square(radius);
    // How steeply it comes there need not be as exact.
    distance - outside.high / (2.0 * high(&at).dot(high(&line.dir)))
}

/// All of it in twice the precision, counted from a point of the line near its closest to the centre: a ball that is
/// small for its distance loses nothing to that.
#[inline(never)]
fn in_twice_the_precision(line: &SphereLine, radius: f64) -> f64 {
    // By powers of two, so that no square is too large or too small.
    let exponent = exponent_to_one(radius);
    let scaled = |part: f64| times_power_of_two(part, exponent);
    let from =
        line.from.map(|DoubleDouble { high, low }| DoubleDouble { high: scaled(high), low: scaled(low) });
    let outside_of = |at: &[DoubleDouble; 3]| dot(at, at) - square(scaled(radius));

    let a = dot(&line.dir, &line.dir);
    let middle = DoubleDouble::from((-dot(&from, &line.dir) / a).high);
    let at = [0, 1, 2].map(|axis| from[axis] + middle * line.dir[axis]);
    let toward = -dot(&at, &line.dir);
    let discriminant = toward * toward - a * outside_of(&at);
    if discriminant.high <= 0.0 {
        return MISS;
    }
    let half = discriminant.sqrt() / a;
    let middle = middle + toward / a;
    let (near, far) = (middle - half, middle + half);
    // Of the two, the one that cancels comes from the product of both.
    let product = outside_of(&from) / a;
    let (near, far) = if middle.high > 0.0 { (product / far, far) } else { (near, product / near) };
    let hit = if near.high > 0.0 { near.high } else { far.high };
    if hit > 0.0 { times_power_of_two(hit, -exponent) } else { MISS }
}

#[inline(always)]
fn square(value: f64) -> DoubleDouble {
    let (high, low) = two_product(value, value);
    DoubleDouble { high, low }
}

#[inline(always)]
fn dot(a: &[DoubleDouble; 3], b: &[DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
