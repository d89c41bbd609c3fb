//! Moves a camera around a point: orbit, pan and dolly, for every type of camera whose table gives its pose.

use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use tabray_core::scene::attribute::{Attribute, Pose};
use tabray_core::scene::entity::{Args, Construct};
use tabray_core::scene::value::Datum;
use tabray_core::world::sensor::Sensor;

/// The greatest angle in degrees by which a viewer who goes up or down looks down or up: straight up and down, no
/// side of the image would be `up`.
const MAX_ELEVATION: f64 = 89.0;

/// The number of digits to which a coordinate is rounded, counted from the first one of the viewer's distance from
/// the point: the rounding is less than a pixel of an image.
const DIGITS: i32 = 5;

/// A movement of a camera from its pose.
#[derive(Clone, Copy, Debug)]
pub struct Movement {
    /// The angles, in degrees, by which the visible scene turns: to the right, and up.
    pub orbit: [f64; 2],
    /// The numbers of pixels by which the visible scene moves: to the right, and up.
    pub pan: [f64; 2],
    /// The divisor of the distance from the point.
    pub dolly: f64,
}

/// The pose of a camera: the values of those attributes that a movement changes, by their names.
pub type CameraPose = BTreeMap<String, Vec<f64>>;

/// Lists the attributes of a camera that a movement may change, with their parts of the pose. Other entities have
/// none.
pub fn attributes(camera: &Args) -> impl Iterator<Item = (&'static dyn Attribute, Pose)> {
    let poses = camera.values().filter_map(|(attribute, _)| Some((attribute, attribute.pose()?)));
    poses.filter(|(_, pose)| *pose != Pose::Up)
}

/// Returns the pose of a camera.
pub fn camera_pose(camera: &Args) -> CameraPose {
    let values = |(attribute, _): (&'static dyn Attribute, Pose)| match camera.find(attribute.name()) {
        Some(Datum::Numbers(numbers)) => Some((attribute.name().to_owned(), numbers.clone())),
        _ => None,
    };
    attributes(camera).filter_map(values).collect()
}

/// Moves a camera from a pose around a point, and returns its new pose; `None` where its table or its constructor
/// does not allow that.
///
/// A viewer goes around the point at the same distance, and stays upright. The visible scene moves with the hand: a
/// camera with a target goes the other way. A viewer before a fixed image plane goes with the hand, as that moves the
/// scene behind the image plane.
pub fn moved(camera: &Args, from: &CameraPose, movement: &Movement, pivot: DVec3) -> Option<CameraPose> {
    let is_in_front = |camera: &Args| point(camera, Pose::Position).is_some_and(|at| at.z > 0.0);
    let mut camera = camera.clone();
    let sensor = placed(&mut camera, from)?;
    let before = is_in_front(&camera);
    let after = OrbitCamera::of(&camera, &sensor, pivot)?.moved(movement);
    placed(&mut camera, &after)?;
    // Through a fixed image plane, the viewer would look back.
    (!is_window(&camera) || is_in_front(&camera) == before).then_some(after)
}

/// Returns the sensor of a camera in a pose.
fn placed(camera: &mut Args, pose: &CameraPose) -> Option<Sensor> {
    for (attribute, datum, is_given) in camera.values_mut() {
        let Some(values) = pose.get(attribute.name()) else { continue };
        let new = Datum::Numbers(values.clone());
        if !values.iter().all(|value| value.is_finite())
            || !attribute.allows(&new)
            || attribute.beyond_squares(&new).is_some()
        {
            return None;
        }
        (*datum, *is_given) = (new, true);
    }
    let Construct::Camera(construct) = camera.entity.construct else { return None };
    Some(camera.sensor(construct(camera).ok()?, (None, None)))
}

/// A camera and the point around which it moves, its pivot.
struct OrbitCamera<'c> {
    camera: &'c Args,
    pivot: DVec3,
    position: DVec3,
    target: Option<DVec3>,
    is_parallel: bool,
    /// The unit vector in which the viewer looks.
    forward: DVec3,
    /// The unit vector around which the viewer goes to the sides.
    up: DVec3,
    /// The distance between neighbouring pixels at the distance of the point, in world units: to the right, and up.
    pixel: [DVec3; 2],
}

impl<'c> OrbitCamera<'c> {
    fn of(camera: &'c Args, sensor: &Sensor, pivot: DVec3) -> Option<Self> {
        let (position, target) = (point(camera, Pose::Position)?, point(camera, Pose::Target));
        let forward = (target.unwrap_or(pivot) - position).try_normalize()?;
        let depth = (pivot - position).dot(forward).abs();
        let [x, y] = sensor.pixels.map(|side| 0.5 * (side as f64 - 1.0));
        let seen = |right: f64, up: f64| sensor.ray(x + right, y + up).at(depth);
        let pixel = [seen(0.5, 0.0) - seen(-0.5, 0.0), seen(0.0, 0.5) - seen(0.0, -0.5)];
        let up = point(camera, Pose::Up).unwrap_or(pixel[1]).try_normalize()?;
        let is_parallel = attributes(camera).any(|(_, pose)| pose == Pose::Extent);
        Some(Self { camera, pivot, position, target, is_parallel, forward, up, pixel })
    }

    /// Returns the camera's pose after a movement.
    fn moved(&self, movement: &Movement) -> CameraPose {
        let hand = if self.target.is_some() { -1.0 } else { 1.0 };
        let [turn, rise] = movement.orbit.map(|degrees| hand * degrees);
        let elevation = libm::asin(self.forward.dot(self.up).clamp(-1.0, 1.0)).to_degrees();
        let most = MAX_ELEVATION.max(elevation.abs());
        let rise = elevation - (elevation - rise).clamp(-most, most);
        let right = self.forward.cross(self.up).try_normalize().unwrap_or(DVec3::X);
        let turn = DMat3::from_axis_angle(self.up, turn.to_radians())
            * DMat3::from_axis_angle(right, -rise.to_radians());
        let pan = hand * (movement.pan[0] * self.pixel[0] + movement.pan[1] * self.pixel[1]);
        let nearer = |point: DVec3| {
            if !self.is_parallel {
                return self.pivot + (point - self.pivot) / movement.dolly;
            }
            // Parallel rays show things in the same size from anywhere, but not those behind the rays' start.
            let aside = (self.pivot - self.position).reject_from_normalized(self.forward);
            point + aside * (1.0 - 1.0 / movement.dolly)
        };
        let place = |point: DVec3| self.pivot + turn * (nearer(point) - self.pivot) + pan;

        let distance = place(self.position).distance(self.pivot);
        let size = |value: f64| value / movement.dolly;
        let before = camera_pose(self.camera);
        let after = attributes(self.camera).filter_map(|(attribute, pose)| {
            let before = before.get(attribute.name())?;
            let after = match pose {
                Pose::Position => place(self.position).to_array().to_vec(),
                Pose::Target => place(self.target?).to_array().to_vec(),
                Pose::Extent => before.iter().copied().map(size).collect(),
                Pose::Up => before.clone(),
            };
            let of = |value: f64| if pose == Pose::Extent { value } else { distance };
            let rounded = before.iter().zip(after).map(|(before, after)| rounded(after, *before, of(after)));
            Some((attribute.name().to_owned(), rounded.collect()))
        });
        after.collect()
    }
}

/// Rounds a number to the last of the digits of a size. If it hardly differs from the number before, that one is
/// kept.
fn rounded(value: f64, before: f64, size: f64) -> f64 {
    let exponent = |of: f64| libm::log10(of.abs()).floor() as i32;
    if !size.is_normal() || !value.is_normal() {
        return value;
    }
    let last = exponent(size) + 1 - DIGITS;
    if (value - before).abs() < 0.5 * libm::exp10(f64::from(last)) {
        return before;
    }
    match usize::try_from(exponent(value) - last) {
        Ok(digits) => format!("{value:.digits$e}").parse().unwrap_or(value),
        Err(_) => 0.0,
    }
}

/// Returns the distance in world units at which a camera has something to look at where it sees nothing: that of its
/// target or, without one, of the world's origin.
pub fn reach(camera: &Args) -> f64 {
    let at = |pose: Pose| point(camera, pose).unwrap_or_default();
    let distance = at(Pose::Position).distance(at(Pose::Target));
    if distance > 0.0 { distance } else { 1.0 }
}

/// Tells whether a camera has an image plane that stays in its place when the viewer moves.
pub fn is_window(camera: &Args) -> bool {
    point(camera, Pose::Position).is_some() && point(camera, Pose::Target).is_none()
}

/// Returns the vector that gives this part of a camera's pose.
fn point(camera: &Args, wanted: Pose) -> Option<DVec3> {
    let (_, datum) = camera.values().find(|(attribute, _)| attribute.pose() == Some(wanted))?;
    match datum {
        Datum::Numbers(numbers) => Some(DVec3::from_slice(numbers.get(..3)?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use tabray_core::scene::kind::Kind;
    use tabray_core::world::camera::Projected;
    use tabray_lang::reader;
    use tabray_lang::registry::Registry;

    /// Returns the camera of each type, as in the scene of its type.
    fn cameras() -> Vec<Args> {
        let registry = Registry::get().expect("plugins");
        let of_kind = registry.iter().filter(|entity| entity.kind() == Kind::Camera);
        let scene = |name: &str| {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/entities");
            let text = std::fs::read(folder.join(format!("{name}.ray"))).expect("a scene of the type");
            let read = reader::read(registry, name, &folder, &text, None).expect("a valid scene");
            read.model.camera.args.args()
        };
        of_kind.map(|entity| scene(entity.name)).collect()
    }

    const STILL: Movement = Movement { orbit: [0.0; 2], pan: [0.0; 2], dolly: 1.0 };

    /// A point that the camera sees, behind its image plane if it has one.
    fn seen(camera: &Args) -> DVec3 {
        let sensor = placed(&mut camera.clone(), &camera_pose(camera)).expect("as it was");
        let [x, y] = sensor.pixels.map(|side| 0.45 * side as f64);
        sensor.ray(x, y).at(if is_window(camera) { 2.0 } else { 0.7 } * reach(camera))
    }

    /// Returns the image position of a point for a camera in a pose; `None` where the camera does not tell it.
    fn place(camera: &Args, pose: &CameraPose, point: DVec3) -> Option<[f64; 2]> {
        match placed(&mut camera.clone(), pose).expect("it may stand there").project(point) {
            Projected::At(place) => Some(place.into()),
            Projected::Nowhere => panic!("the point is lost"),
            Projected::Unknown => None,
        }
    }

    fn near(one: [f64; 2], other: [f64; 2], most: f64) -> bool {
        one.iter().zip(other).all(|(one, other)| (one - other).abs() < most)
    }

    #[test]
    fn every_camera_moves_and_a_movement_by_nothing_changes_nothing() {
        for camera in cameras() {
            let before = camera_pose(&camera);
            let pivot = seen(&camera);
            assert_eq!(
                moved(&camera, &before, &STILL, pivot),
                Some(before.clone()),
                "{}",
                camera.entity.name
            );
            for movement in [
                Movement { orbit: [5.0, 2.0], ..STILL },
                Movement { pan: [3.0, 2.0], ..STILL },
                Movement { dolly: 1.1, ..STILL },
            ] {
                let after = moved(&camera, &before, &movement, pivot);
                assert!(after.is_some_and(|after| after != before), "{} {movement:?}", camera.entity.name);
            }
        }
    }

    #[test]
    fn the_point_stays_where_it_is_seen_and_a_pan_takes_it_along() {
        for camera in cameras() {
            let (before, pivot) = (camera_pose(&camera), seen(&camera));
            let Some(at) = place(&camera, &before, pivot) else { continue };
            let after = |movement| {
                let pose = moved(&camera, &before, &movement, pivot).expect("it may go there");
                place(&camera, &pose, pivot).expect("it says where")
            };
            let nearer = after(Movement { dolly: 1.5, ..STILL });
            assert!(near(nearer, at, 0.1), "{}: {at:?} {nearer:?}", camera.entity.name);
            let panned = after(Movement { pan: [2.0, 1.0], ..STILL });
            if is_window(&camera) {
                assert!(panned[0] > at[0] && panned[1] > at[1], "{at:?} {panned:?}");
                continue;
            }
            let around_it = after(Movement { orbit: [20.0, 10.0], ..STILL });
            assert!(near(around_it, at, 0.1), "{}: {at:?} {around_it:?}", camera.entity.name);
            // Far from the middle, the pixels of a fisheye are less far apart.
            assert!(
                near(panned, [at[0] + 2.0, at[1] + 1.0], 0.5),
                "{}: {at:?} {panned:?}",
                camera.entity.name
            );
        }
    }

    #[test]
    fn nobody_goes_over_the_top_or_behind_the_image_plane() {
        for camera in cameras() {
            let (before, pivot) = (camera_pose(&camera), seen(&camera));
            let over = moved(&camera, &before, &Movement { orbit: [0.0, -400.0], ..STILL }, pivot);
            let behind = moved(&camera, &before, &Movement { orbit: [170.0, 0.0], ..STILL }, pivot);
            if is_window(&camera) {
                assert_eq!(behind, None);
            } else {
                assert!(over.is_some() && behind.is_some(), "{}", camera.entity.name);
            }
        }
    }

    #[test]
    fn numbers_have_few_digits_and_stay_where_they_are_as_good() {
        assert_eq!(rounded(1.234_567_89, 7.0, 12.0), 1.235);
        assert_eq!(rounded(1.234_567_89, 1.234_5, 12.0), 1.234_5);
        assert_eq!(rounded(123_456_789.0, 0.0, 3e7), 123_457_000.0);
        assert_eq!(rounded(4e-9, 7.0, 12.0), 0.0);
        assert_eq!(rounded(0.1 + 0.2, 7.0, 1.0), 0.3);
    }
}
