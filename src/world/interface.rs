//! Interfaces: how light continues at a surface. A material may have one.

use crate::coat::Coat;
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

    /// Tells whether any light may be neither reflected nor transmitted: [`Crossing::onward`] is `None` although less
    /// than all is reflected. `true` is always correct.
    fn absorbs(&self) -> bool {
        true
    }

    /// Returns the medium that absorbs light behind the surface, on its inside; `None` if all light passes. The medium
    /// is the same in every call.
    fn medium(&self) -> Option<Medium> {
        None
    }

    /// Returns the law by which rays [`cross`](Self::cross) the surface, for proofs. The default is always correct.
    fn law(&self) -> Law {
        Law::Unknown
    }

    /// Returns the clear coat that the interface is, over a matt body; `None` for other interfaces. It is the same in every
    /// call. The body scatters what the coat lets through, and nothing is transmitted.
    fn coat(&self) -> Option<&Coat> {
        None
    }

    /// Returns how rough the surface is: 0 if it is smooth, and at most 1. It is the same in every call. Rays cross
    /// facets of a rough surface: [`cross`](Self::cross) gets the normal of a facet.
    fn roughness(&self) -> f64 {
        0.0
    }
}

/// The law of an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Snell's law and Fresnel's equations for light that is not polarised, by the refractive index inside, relative
    /// to outside.
    Fresnel(f64),
    /// Schlick's approximation, by the fractions of light that are reflected along the normal; the rest is absorbed.
    Schlick(DVec3),
    /// Another law.
    Unknown,
}

/// A clear medium that absorbs light according to the length of the path through it (Beer's law).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// The fractions of light that are left after the length `at`.
    left: DVec3,
    /// The logarithms of the fractions of light that are left after the length `at`.
    logarithms: DVec3,
    /// A length, in world units.
    at: f64,
}

impl Medium {
    /// Makes a medium that leaves these fractions of light, more than 0 and at most 1, after the length `at`, in
    /// world units; `None` if it leaves all.
    pub fn new(left: DVec3, at: f64) -> Option<Self> {
        (left != DVec3::ONE).then(|| Self { left, logarithms: left.map(libm::log), at })
    }

    /// Returns the fractions of light that are left after the length [`at`](Self::at).
    pub fn left(&self) -> DVec3 {
        self.left
    }

    /// Returns the length after which the fractions [`left`](Self::left) are left, in world units.
    pub fn at(&self) -> f64 {
        self.at
    }

    /// Returns the fraction of light that passes along a path of this length, in world units.
    pub fn passed(&self, length: f64) -> DVec3 {
        let lengths = length / self.at;
        // On an endless path, a channel that loses any light loses all of it.
        self.logarithms.map(|left| if left == 0.0 { 1.0 } else { libm::exp(left * lengths) })
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
