//! Interfaces: how light continues at a surface. A material may have one.

use crate::geometry::ray::Side;
use glam::DVec3;
use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// How light continues at a surface: which fraction is reflected, and in which direction the rest is transmitted.
///
/// A material without an interface transmits light in a straight line, and reflects the fraction given by its specular
/// reflectivity.
pub trait Interface: Send + Sync {
    /// Returns how a ray continues that hits the surface on a side. `dir` is its unit direction, and `normal` the unit
    /// normal that faces it: `dir.dot(normal)` is at most 0.
    fn cross(&self, dir: DVec3, normal: DVec3, side: Side) -> Crossing;

    /// Tells whether any light may be neither reflected nor transmitted: [`Crossing::onward`] is `None` although less than
    /// all is reflected. `true` is always correct.
    fn absorbs(&self) -> bool {
        true
    }
}

/// How a ray continues at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The fraction of the light that is reflected as by a mirror, from 0 to 1, in red, green and blue.
    pub reflected: DVec3,
    /// The unit direction in which the rest is transmitted; `None` if it is absorbed.
    pub onward: Option<DVec3>,
}

/// Any [`Interface`].
#[derive(Clone)]
pub struct AnyInterface(Arc<dyn Comparable>);

/// An interface that can be compared with any other.
trait Comparable: Interface {
    fn as_any(&self) -> &dyn Any;
    fn is(&self, other: &dyn Any) -> bool;
    fn as_interface(&self) -> &(dyn Interface + 'static);
}

impl<I: Interface + PartialEq + 'static> Comparable for I {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn is(&self, other: &dyn Any) -> bool {
        other.downcast_ref() == Some(self)
    }

    fn as_interface(&self) -> &(dyn Interface + 'static) {
        self
    }
}

impl AnyInterface {
    /// Wraps an interface.
    pub fn new(interface: impl Interface + PartialEq + 'static) -> Self {
        Self(Arc::new(interface))
    }
}

impl Deref for AnyInterface {
    type Target = dyn Interface;

    fn deref(&self) -> &Self::Target {
        self.0.as_interface()
    }
}

impl PartialEq for AnyInterface {
    fn eq(&self, other: &Self) -> bool {
        self.0.is(other.0.as_any())
    }
}

impl fmt::Debug for AnyInterface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("AnyInterface")
    }
}
