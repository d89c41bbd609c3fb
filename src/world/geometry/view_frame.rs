//! The frame of a viewer: the position, the direction of view, and the up direction.

use crate::geometry::image_point::ImagePoint;
use crate::geometry::placement::radians;
use glam::DVec3;
use tabray_exact::double_double::{DoubleDouble, exponent_to_one, scaled, times_power_of_two};
use tabray_exact::scalar::{Scalar, constants, cross, dot, per_axis};

/// A viewer's position and the perpendicular directions to its right, up and forward.
#[derive(Clone, Copy, Debug)]
pub struct ViewFrame {
    given: ViewInputs,
    /// The unit vectors to the right, up and forward.
    axes: [[DoubleDouble; 3]; 3],
}

/// The numbers of the scene that define a frame, all in world coordinates.
#[derive(Clone, Copy, Debug)]
struct ViewInputs {
    position: DVec3,
    target: DVec3,
    /// An up vector, times a power of two that scales its largest component to between 1/2 and 1.
    up: DVec3,
    /// The power of two that scales the largest component of the vector to the target to between 1/2 and 1.
    scale: f64,
}

/// The minimum sine of the angle between the forward and up directions of a frame.
const MIN_SINE: f64 = 1e-6;

impl ViewFrame {
    /// Returns the frame of a viewer that looks from a position toward a target. `up` is any vector that points up in
    /// the image. Returns `None` if it is within 1e-6 radians of the line of sight, or if the line of sight has no
    /// direction.
    pub fn new(position: DVec3, target: DVec3, up: DVec3) -> Option<Self> {
        let forward = (target - position).try_normalize()?;
        // Scaling by a power of two loses no digit, and keeps squares from overflow.
        let exponent = exponent_to_one((target - position).abs().max_element());
        let given = ViewInputs { position, target, up: scaled(up), scale: times_power_of_two(1.0, exponent) };
        let is_askew = forward.cross(given.up.try_normalize()?).length() > MIN_SINE;
        is_askew.then(|| Self { given, axes: given.axes() })
    }

    /// Returns the viewer's position, in world coordinates.
    pub fn position(&self) -> DVec3 {
        self.given.position
    }

    /// Returns the distance from the viewer to the target, in world units.
    pub fn distance(&self) -> f64 {
        self.given.position.distance(self.given.target)
    }

    /// Returns the unit vectors to the right, up and forward, rounded.
    pub fn axes(&self) -> [DVec3; 3] {
        self.axes.map(|axis| DVec3::from(axis.map(|part| part.high)))
    }

    /// Returns a point's distances to the right, up and forward from the viewer, in world units.
    pub fn coordinates(&self, point: DVec3) -> DVec3 {
        DVec3::from(self.axes().map(|axis| axis.dot(point - self.given.position)))
    }

    /// Returns the unit vector forward, rounded.
    pub fn forward(&self) -> DVec3 {
        self.axes()[2].normalize()
    }

    /// Returns the unit vector forward, in any number type.
    pub fn exact_forward<N: Scalar>(&self) -> [N; 3] {
        self.given.axes()[2]
    }

    /// Returns the unit vector toward a point of an image with square pixels. `tangent` is the tangent of half the
    /// angle of view across the image. Before the vector is normalized, each component is rounded about once,
    /// regardless of cancellation.
    #[inline(always)]
    pub fn direction(&self, tangent: DoubleDouble, at: &ImagePoint) -> DVec3 {
        let ([x, y, z], [right, up]) = (self.axes, across(tangent, at));
        DVec3::from(per_axis(|axis| (z[axis] + right * x[axis] + up * y[axis]).high)).normalize()
    }

    /// Returns a vector toward a point of an image with square pixels, in any number type. `angle` is the angle of view
    /// across the image, in degrees.
    pub fn exact_direction<N: Scalar>(&self, angle: f64, at: ImagePoint<N>) -> [N; 3] {
        let ([x, y, z], tangent) = (self.given.axes::<N>(), half_tangent::<N>(angle));
        let [right, up] = at.from_middle().map(|side| tangent * side);
        per_axis(|axis| z[axis] + right * x[axis] + up * y[axis])
    }

    /// Returns the point in world space at a point of an image with square pixels. The image has this width, in world
    /// units, and the viewer in its middle. Each coordinate is rounded about once.
    #[inline(always)]
    pub fn beside(&self, width: f64, at: &ImagePoint) -> DVec3 {
        let ([x, y, _], from) = (self.axes, self.given.position);
        let [right, up] = across(DoubleDouble::from(0.5 * width), at);
        DVec3::from(per_axis(|axis| (right * x[axis] + up * y[axis] + DoubleDouble::from(from[axis])).high))
    }

    /// Computes the vector of [`beside`](Self::beside) in any number type.
    pub fn exact_beside<N: Scalar>(&self, width: f64, at: ImagePoint<N>) -> [N; 3] {
        let ([x, y, _], from) = (self.given.axes::<N>(), self.given.position);
        let [right, up] = at.from_middle().map(|side| side.scaled(0.5 * width));
        per_axis(|axis| N::constant(from[axis]) + right * x[axis] + up * y[axis])
    }
}

/// Returns a point of an image, to the right and up from its middle, in units that make half the image's width equal to
/// `half`.
#[inline(always)]
fn across(half: DoubleDouble, at: &ImagePoint) -> [DoubleDouble; 2] {
    // The quotient is the same for all points of an image.
    let pixel = half / DoubleDouble::from(at.pixels[0] as f64);
    [0, 1].map(|side| DoubleDouble::difference(2.0 * at.at[side], (at.pixels[side] - 1) as f64) * pixel)
}

/// Returns the tangent of half an angle in degrees.
pub fn half_tangent<N: Scalar>(angle: f64) -> N {
    radians::<N>(0.5 * angle).tan()
}

impl ViewInputs {
    /// Returns the unit vectors to the right, up and forward.
    fn axes<N: Scalar>(&self) -> [[N; 3]; 3] {
        let unit = |vector: [N; 3]| {
            let length = dot(vector, vector).sqrt();
            vector.map(|part| part / length)
        };
        let toward = |axis: usize| N::constant(self.target[axis]) - N::constant(self.position[axis]);
        let forward = unit(per_axis(|axis| toward(axis).scaled(self.scale)));
        let right = unit(cross(forward, constants(self.up)));
        [right, cross(right, forward), forward]
    }
}
