//! What a file says beside its mesh: from where it is seen, and by which lights. A mesh has none of these, but a scene
//! that shows the mesh can begin with them.

use glam::DVec3;
use tabray_world::material::Rgb;

/// The viewer and the lights of a file, in its coordinates.
#[derive(Debug, Default, PartialEq)]
pub struct Staging {
    /// The first viewer with a perspective.
    pub viewer: Option<Viewer>,
    /// The lights, in the order of the file.
    pub lamps: Vec<Lamp>,
}

/// A viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewer {
    /// The point from which the mesh is seen.
    pub position: DVec3,
    /// The direction of the middle of the image, a unit vector.
    pub forward: DVec3,
    /// A direction that points up in the image.
    pub up: DVec3,
    /// The tangent of half the angle of view across the height of the image.
    pub tangent: f64,
    /// The width of the image divided by its height, if the file gives it.
    pub aspect: Option<f64>,
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Its position; `None` for one that is infinitely far away.
    pub position: Option<DVec3>,
    /// The direction in which it shines, a unit vector; `None` for all directions.
    pub forward: Option<DVec3>,
    /// The angle between the axis and the edge of its beam, in degrees, if it has one.
    pub edge: Option<f64>,
    /// Its colour times its intensity, in candela, or in lux for one that is infinitely far away.
    pub light: Rgb,
}
