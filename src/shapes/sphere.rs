//! Line-sphere intersection: the arithmetic behind spheres and ellipsoids.
//!
//! The course notes' formula loses far, small and grazed spheres, because `b^2 - 4ac` cancels. Here, the discriminant
//! comes from the line's point closest to the center (Haines, Günther and Akenine-Möller 2019), a Newton step corrects
//! the root, and double-double arithmetic decides cases that rounding could affect.

use glam::DVec3;
use tabray_exact::double_double::{DoubleDouble, exponent_to_one, times_power_of_two, two_product};
use tabray_exact::scalar::per_axis;
use tabray_world::accuracy::{Accuracy, AccuracyTag};
use tabray_world::geometry::aabb::{Aabb, SLACK, larger};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayError, RayRange, Side};

/// A half-line from a point, in double-double arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct SphereLine {
    /// The origin, relative to the center.
    pub from: [DoubleDouble; 3],
    /// The direction, of any length. Distances are multiples of this length.
    pub dir: [DoubleDouble; 3],
}

impl SphereLine {
    /// Returns a ray relative to the center.
    #[inline(always)]
    pub fn new(ray: &Ray, center: DVec3) -> Self {
        let from = |axis: usize| DoubleDouble::difference(ray.origin[axis], center[axis]);
        let dir = |axis: usize| DoubleDouble::from(ray.dir[axis]);
        Self { from: [from(0), from(1), from(2)], dir: [dir(0), dir(1), dir(2)] }
    }

    /// Returns a ray relative to the center, with coordinates scaled by these factors along the axes.
    #[inline(always)]
    pub fn scaled(ray: &Ray, center: DVec3, inverse_scale: &[DoubleDouble; 3]) -> Self {
        let Self { from, dir } = Self::new(ray, center);
        let scaled = |of: [DoubleDouble; 3]| {
            [of[0] * inverse_scale[0], of[1] * inverse_scale[1], of[2] * inverse_scale[2]]
        };
        Self { from: scaled(from), dir: scaled(dir) }
    }
}

/// Returns the bounding box of a sphere.
pub fn bounds(center: DVec3, radius: f64) -> Aabb {
    Aabb { low: center - radius, high: center + radius }
}

/// Returns a lower bound of the distance from a point to the surface of a sphere.
pub fn clearance(center: DVec3, radius: f64, from: DVec3) -> f64 {
    let away = (from - center).length();
    let rounding = SLACK * (from.length() + center.length() + radius);
    ((away - radius).abs() - rounding).max(0.0)
}

/// Returns a short description of the method.
pub fn method<A: AccuracyTag>() -> &'static str {
    match A::ACCURACY {
        Accuracy::Classic => "the notes' formula",
        Accuracy::Draft => "a closed form, in twice the precision where rounding could decide",
        Accuracy::Exact => {
            "a closed form and a step of Newton's method, in twice the precision where rounding could decide"
        }
        Accuracy::Strict => "a closed form in twice the precision",
    }
}

/// Returns the distance of a sphere by the course notes' formula. The ray starts at `from`, relative to the center.
#[inline(always)]
pub fn classic(from: DVec3, dir: DVec3, radius: f64) -> f64 {
    let a = dir.dot(dir);
    let b = 2.0 * from.dot(dir);
    let c = from.dot(from) - radius * radius;
    let discriminant = b * b - 4.0 * a * c;
    // A tangent ray misses the sphere.
    if discriminant <= 0.0 { MISS } else { (-b - discriminant.sqrt()) / (2.0 * a) }
}

/// Returns the distance of the first hit of a sphere: on its near side, or from inside on its far side. A tangent line
/// misses it, as in the course notes.
#[inline(always)]
pub fn first_hit<A: AccuracyTag>(line: &SphereLine, radius: f64) -> f64 {
    let quick = quick_hit::<A>(line, radius);
    if quick.is_nan() { in_double_double(line, radius) } else { quick }
}

/// Computes [`first_hit`], or NaN if rounding could affect the decision.
#[inline(always)]
pub(crate) fn quick_hit<A: AccuracyTag>(line: &SphereLine, radius: f64) -> f64 {
    let (from, dir) = (high(&line.from), high(&line.dir));
    let a = dir.dot(dir);
    let toward = -from.dot(dir);
    let aside = from + (toward / a) * dir;
    let discriminant = radius * radius - aside.dot(aside);
    let size = from.abs().element_sum() + radius;
    let outside = from.dot(from) - radius * radius;
    // In units of 2^-53 of `size`: the error of `from` is 1, of `toward` 5, of `a` 4, of their product with the
    // direction 3 and of the sum 1. Their sum, 14, is less than 32 units. For a tangent line, the error of the
    // discriminant is then `doubt`. The error of `outside` is 7 units of `size^2`: 5 for the square of `from`, 1 for
    // that of the radius and 1 for the difference. The code below uses 64.
    let aside_error = 16.0 * f64::EPSILON * size;
    let doubt = aside_error * (2.0 * radius + aside_error);
    let is_missed = discriminant < -doubt;
    // If the discriminant is GRAZE times its error, the relative error of the root is 1 / (2 GRAZE), and a Newton step
    // leaves 1 / (8 GRAZE^2). `spheres_are_found` and `ellipsoids_are_found` in `tests/shapes/arithmetic.rs` check the
    // results to 4 ulps.
    const GRAZE: f64 = (1 << 18) as f64;
    let is_doubtful = (A::ACCURACY == Accuracy::Strict)
        | (!is_missed
            & ((discriminant <= GRAZE * doubt) | (outside.abs() <= 32.0 * f64::EPSILON * size * size)));
    let root = (a * discriminant).sqrt();
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

/// Returns the distance at which a line from the inner side of a sphere hits the sphere again, or [`MISS`] if it does
/// not go inward.
///
/// The equation's other root is the start of the line. If the rounding error of the start is not small compared to the
/// discriminant, the start counts as a point of the sphere, and the far root is twice as far as the midpoint of the
/// chord.
#[inline(always)]
pub(crate) fn far_hit<A: AccuracyTag>(line: &SphereLine, radius: f64) -> f64 {
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

/// Returns the distance of the first hit of a ray that leaves the sphere to a side, or does not start on it.
#[inline(always)]
pub fn distance<A: AccuracyTag>(line: &SphereLine, radius: f64, origin_side: Option<Side>) -> f64 {
    match origin_side {
        None => first_hit::<A>(line, radius),
        Some(Side::Inside) => far_hit::<A>(line, radius),
        Some(Side::Outside) => MISS,
    }
}

/// Computes [`distance`], or NaN if rounding could affect the decision.
#[inline(always)]
pub fn refine<A: AccuracyTag>(line: &SphereLine, radius: f64, origin_side: Option<Side>) -> f64 {
    let distance = match origin_side {
        None => quick_hit::<A>(line, radius),
        Some(Side::Inside) => far_hit::<A>(line, radius),
        Some(Side::Outside) => MISS,
    };
    if distance.is_nan() { distance } else { RayRange::ALL.keep(distance) }
}

/// Returns whether a point at `from`, relative to the center, is on a sphere to within `error`, in the sphere's own
/// unit, and the rounding error of its distance from the center. That is less than 2 EPSILON of the length: half an
/// EPSILON for the coordinates, 3/4 for the sum of squares and 1/2 for the root.
#[inline(always)]
pub fn is_on_surface(from: DVec3, radius: f64, error: f64) -> bool {
    (from.length() - radius).abs() <= error + 4.0 * f64::EPSILON * radius
}

/// Returns a bracket of the first hit of a line with a direction of length `1 / sqrt(inverse)`. Its origin may be off
/// by `origin_error`, in the sphere's own unit.
///
/// `spread` is a bound of the rounding error of the direction's components relative to its length, as a multiple of
/// that of a unit vector. The bracket is wide but fast to compute in plain arithmetic, because most rays miss most
/// spheres.
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
    // Far more than the relative rounding error of the root if the discriminant exceeds `doubt`.
    const ERROR: f64 = 1.0 / (1 << 29) as f64;
    const ASIDE_ERROR: f64 = 32_768.0 * f64::EPSILON;
    // A line that starts within an error e of the sphere has one root whose distance from its origin is at most `2 r e`
    // divided by the other root. The other root is at least `sqrt(ASIDE_ERROR r size)`, and so the distance is less
    // than `ERROR size` if the size is this many e.
    const ORIGIN_ERRORS: f64 = (1_u64 << 49) as f64;
    // A line that goes inward by this fraction of the size does so by far more than its start may be off the sphere.
    const INWARD: f64 = 1.0 / (1 << 20) as f64;

    let middle = -from.dot(dir) * inverse;
    let aside = from + middle * dir;
    let discriminant = radius * radius - aside.dot(aside);
    // As in `quick_hit`, the error of `aside` is 14 units of 2^-53 of `size`, and 3 more in each component for a camera
    // ray's direction. ASIDE_ERROR is thousands of times as large, and so the error of half the chord is less than
    // ERROR if the discriminant exceeds `doubt`. `brackets_hold_the_hits_of_the_real_rays_of_a_camera` in
    // `tests/shapes/arithmetic.rs` tests this. The terms that all rays of a packet share come first.
    let size = spread * from.abs().element_sum() + (spread * radius + ORIGIN_ERRORS * origin_error);
    let error = ERROR * size * inverse.sqrt();
    let aside_error = ASIDE_ERROR * size;
    let doubt = aside_error * (radius + aside_error);
    let half = (larger(discriminant, 0.0) * inverse).sqrt();
    let (near, far) = (middle - half, middle + half);
    match origin_side {
        None => {}
        Some(Side::Outside) => return Bracket::MISS,
        Some(Side::Inside) => {
            let is_there = (discriminant > doubt) & (middle > INWARD * size * inverse.sqrt()) & (far > error);
            return Bracket {
                near: if is_there { far - error } else { 0.0 },
                far: if is_there { far + error } else { MISS },
            };
        }
    }
    let is_missed = (discriminant < -doubt) | (far < -error);
    // The hit may be from outside of the sphere, or from inside.
    let is_ahead = near > error;
    let is_inside = (near < -error) & (far > error);
    let is_there = (discriminant > doubt) & (is_ahead | is_inside);
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

/// Returns the amount to add to the `spread` for a ray with a unit direction to make [`t_bounds`] valid for all rays
/// within a drift of it.
///
/// The drift moves `aside` by `k` EPSILON of the size. If the discriminant exceeds `doubt`, which grows with the spread
/// `K`, that moves half the chord by less than `k EPSILON size / sqrt(32,768 EPSILON K)`. Half of `ERROR K size` is
/// more than that for `K = 1 + k / 8`.
#[inline(always)]
pub fn spread(from: DVec3, radius: f64, drift: RayError) -> f64 {
    if drift.is_none() {
        return 0.0;
    }
    let size = from.abs().element_sum() + radius;
    (2.0 * drift.origin / size + 3.0 * drift.dir) / (8.0 * f64::EPSILON)
}

#[inline(always)]
fn high(of: &[DoubleDouble; 3]) -> DVec3 {
    DVec3::new(of[0].high, of[1].high, of[2].high)
}

/// Corrects a distance by a Newton step from a point in double-double arithmetic. The rounding error of the point
/// matters if the sphere is large compared to its distance, or is hit at a grazing angle.
#[inline(always)]
fn corrected(line: &SphereLine, radius: f64, distance: f64) -> f64 {
    let part = |axis: usize| line.from[axis] + DoubleDouble::from(distance) * line.dir[axis];
    let at = [part(0), part(1), part(2)];
    let outside = dot(&at, &at) - square(radius);
    // The slope needs less precision.
    distance - outside.high / (2.0 * high(&at).dot(high(&line.dir)))
}

/// Computes the first hit in double-double arithmetic, relative to the line's point near its closest to the center. A
/// distant small sphere thus loses no precision.
#[inline(never)]
fn in_double_double(line: &SphereLine, radius: f64) -> f64 {
    // Scaling by powers of two keeps squares from overflow and underflow.
    let exponent = exponent_to_one(radius);
    let scaled = |part: f64| times_power_of_two(part, exponent);
    let from =
        line.from.map(|DoubleDouble { high, low }| DoubleDouble { high: scaled(high), low: scaled(low) });
    let outside_of = |at: &[DoubleDouble; 3]| dot(at, at) - square(scaled(radius));

    let a = dot(&line.dir, &line.dir);
    let middle = DoubleDouble::from((-dot(&from, &line.dir) / a).high);
    let at = per_axis(|axis| from[axis] + middle * line.dir[axis]);
    let toward = -dot(&at, &line.dir);
    let discriminant = toward * toward - a * outside_of(&at);
    if discriminant.high <= 0.0 {
        return MISS;
    }
    let half = discriminant.sqrt() / a;
    let middle = middle + toward / a;
    let (near, far) = (middle - half, middle + half);
    // The root that cancels comes from the product of both.
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
