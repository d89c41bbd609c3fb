//! Interfaces: the trait for how light goes on where it meets a surface, which a material may have.

use crate::geometry::ray::Side;
use glam::DVec3;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// How light goes on at a surface: which part of it is reflected, and where the rest is transmitted to.
///
/// A material without one transmits light in a straight line, and reflects what its specular reflectivity says.
pub trait Interface: Send + Sync {
    /// Returns how a ray goes on that hits the surface on a side. `dir` is its unit direction, and `normal` the unit normal
    /// that faces it: `dir.dot(normal)` is at most 0.
    fn cross(&self, dir: DVec3, normal: DVec3, side: Side) -> Crossing;
}

/// How a ray goes on at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The fraction of the light that is reflected as by a mirror, from 0 to 1.
    pub reflected: f64,
    /// The unit direction in which the rest is transmitted; `None` where all of it is reflected.
    pub onward: Option<DVec3>,
}

/// Any [`Interface`].
#[derive(Clone)]
pub struct AnyInterface(Arc<dyn Interface>);

impl AnyInterface {
    /// Makes one of an interface.
    pub fn new(interface: impl Interface + 'static) -> Self {
        Self(Arc::new(interface))
    }
}

impl Deref for AnyInterface {
    type Target = dyn Interface;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

/// All are equal: the names of their materials tell them apart.
impl PartialEq for AnyInterface {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl fmt::Debug for AnyInterface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("AnyInterface")
    }
}
