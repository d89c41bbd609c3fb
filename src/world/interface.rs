//! Interfaces: how light continues at a surface. A material may have one.

use crate::geometry::ray::Side;
use crate::number::{Known, Number};
use glam::DVec3;
use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;
use tabray_exact::interval::{Interval, Wide};
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};

/// How light continues at a surface: which fraction is reflected, and in which direction the rest is transmitted.
///
/// A material without an interface transmits light in a straight line, and reflects the fraction given by its specular
/// reflectivity.
pub trait Interface: Send + Sync {
    /// Returns how a ray continues that hits the surface on a side. `dir` is its unit direction, and `normal` the unit
    /// normal that faces it: `dir.dot(normal)` is at most 0. The default follows the [`law`](Self::law).
    fn cross(&self, dir: DVec3, normal: DVec3, side: Side) -> Crossing {
        let crossing = self.law().cross(dir.to_array(), normal.to_array(), side == Side::Inside);
        let absorbed = Crossing { reflected: [0.0; 3], onward: None };
        let Crossing { reflected, onward } = crossing.unwrap_or(absorbed);
        Crossing { reflected: reflected.into(), onward: onward.map(DVec3::from) }
    }

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

    /// Returns the law by which rays [`cross`](Self::cross) the surface. An interface of another law says how they cross,
    /// and is not proven.
    fn law(&self) -> Law {
        Law::Unknown
    }

    /// Tells whether the interface is a coat over a matt body. The body scatters what the coat lets through, and nothing
    /// is transmitted. The answer is the same in every call.
    fn is_coat(&self) -> bool {
        false
    }

    /// Returns the fraction of light, from 0 to 1, that passes through a [coat](Self::is_coat) at an angle to the normal,
    /// given its cosine; `None` where it is open, which it is not in plain numbers.
    fn passed<N: Number>(&self, _cosine: N) -> Option<N>
    where
        Self: Sized,
    {
        Some(N::constant(1.0))
    }

    /// Returns the diffuse reflectivity of a body of this colour under a [coat](Self::is_coat), for light that has passed
    /// through it and before it passes again.
    fn body<N: Number>(&self, colour: [N; 3]) -> [N; 3]
    where
        Self: Sized,
    {
        colour
    }

    /// Returns how rough the surface is: 0 if it is smooth, and at most 1. It is the same in every call. Rays cross
    /// facets of a rough surface: [`cross`](Self::cross) gets the normal of a facet.
    fn roughness(&self) -> f64 {
        0.0
    }

    /// Tells whether the surface's shader may say at each point how rays cross it, by its
    /// [gloss](crate::shader::Shader::gloss), with at most this roughness. Nothing is proven of that. The answer is the same in
    /// every call.
    fn varies(&self) -> bool {
        false
    }
}

/// How rays cross a surface at one of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// The law by which they cross it.
    pub law: Law,
    /// How rough the surface is there, from 0 to 1.
    pub roughness: f64,
}

impl Interface for Gloss {
    fn law(&self) -> Law {
        self.law
    }

    fn roughness(&self) -> f64 {
        self.roughness
    }
}

/// Returns the exponent of highlights that are about as wide as the facets of a rough surface scatter, for lamps without
/// a size, which facets never meet; 0 for surfaces that are nearly smooth.
pub fn shininess(roughness: f64) -> f64 {
    let width = roughness * roughness;
    if roughness > 0.1 { (2.0 / (width * width) - 2.0).max(1.0) } else { 0.0 }
}

/// The law of an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Snell's law and Fresnel's equations for light that is not polarised, by the refractive index inside, relative
    /// to outside.
    Fresnel(f64),
    /// Schlick's approximation; what is not reflected is absorbed, or left to the body.
    Schlick {
        /// The fractions of light that are reflected along the normal.
        colour: DVec3,
        /// The fraction that is reflected at grazing angles.
        grazing: f64,
    },
    /// Another law.
    Unknown,
}

impl Law {
    /// Returns the law of a surface that is metal of a colour in this fraction, by area.
    pub fn metal(colour: DVec3, part: f64) -> Self {
        Self::Schlick { colour: part * colour.clamp(DVec3::ZERO, DVec3::ONE), grazing: part }
    }

    /// Returns how rays along unit vectors continue at a surface with unit normals that face them, on its inside or its
    /// outside; `None` where that is open.
    pub fn cross<N: Number>(self, dir: [N; 3], normal: [N; 3], is_inside: bool) -> Option<Crossing<[N; 3]>> {
        let (n, one) = (N::constant, N::constant(1.0));
        let cosine = (-dot(dir, normal)).max(n(0.0)).min(one);
        match self {
            Self::Schlick { colour, grazing } => {
                let part = (one - cosine).powi(5);
                let (colour, grazing): ([N; 3], N) = (constants(colour), n(grazing));
                let reflected = per_axis(|channel| colour[channel] + (grazing - colour[channel]) * part);
                Some(Crossing { reflected, onward: None })
            }
            Self::Fresnel(1.0) => Some(Crossing { reflected: [n(0.0); 3], onward: Some(dir) }),
            Self::Fresnel(index) => {
                let (from, to) = if is_inside { (n(index), one) } else { (one, n(index)) };
                let ratio = from / to;
                let below = one - ratio * ratio * (one - cosine.powi(2));
                let [least, most] = below.bounds();
                if most <= 0.0 {
                    return Some(Crossing { reflected: [one; 3], onward: None });
                }
                if least <= 0.0 {
                    return None;
                }
                let root = below.sqrt();
                let across = (from * cosine - to * root) / (from * cosine + to * root);
                let along = (to * cosine - from * root) / (to * cosine + from * root);
                let reflected = n(0.5) * (across.powi(2) + along.powi(2));
                let bend = ratio * cosine - root;
                let onward = N::lengthened(per_axis(|axis| ratio * dir[axis] + bend * normal[axis]));
                Some(Crossing { reflected: [reflected; 3], onward: Some(onward) })
            }
            Self::Unknown => None,
        }
    }
}

/// A clear medium that absorbs light according to the length of the path through it (Beer's law).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// The fractions of light that are left after the length `at`.
    left: DVec3,
    /// The logarithms of the fractions of light that are left after the length `at`.
    logarithms: [Known; 3],
    /// A length, in world units.
    at: f64,
}

impl Medium {
    /// Makes a medium that leaves these fractions of light, more than 0 and at most 1, after the length `at`, in
    /// world units; `None` if it leaves all.
    pub fn new(left: DVec3, at: f64) -> Option<Self> {
        let enclosed: [Wide; 3] = constants(left);
        let logarithms = Known::each(left.map(libm::log).to_array(), enclosed.map(Scalar::ln));
        (left != DVec3::ONE).then_some(Self { left, logarithms, at })
    }

    /// Returns the fractions of light that pass along a path of this length, in world units.
    pub fn passed<N: Number>(&self, length: N) -> [N; 3] {
        let (one, lengths) = (N::constant(1.0), length / N::constant(self.at));
        per_axis(|channel| match self.left[channel] {
            // On an endless path, a channel that loses any light loses all of it.
            1.0 => one,
            _ => (N::known(&self.logarithms[channel]) * lengths).exp().min(one).max(N::constant(0.0)),
        })
    }
}

/// How a ray continues at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<C = DVec3> {
    /// The fraction of the light that is reflected as by a mirror, from 0 to 1, in red, green and blue.
    pub reflected: C,
    /// The unit direction in which the rest is transmitted; `None` if it is absorbed.
    pub onward: Option<C>,
}

/// A coat of any type, asked in one number. Every [`Interface`] is one.
pub trait Coat<N> {
    /// Calls [`Interface::passed`].
    fn passes(&self, cosine: N) -> Option<N>;

    /// Calls [`Interface::body`].
    fn covers(&self, colour: [N; 3]) -> [N; 3];
}

impl<I: Interface, N: Number> Coat<N> for I {
    fn passes(&self, cosine: N) -> Option<N> {
        self.passed(cosine)
    }

    fn covers(&self, colour: [N; 3]) -> [N; 3] {
        self.body(colour)
    }
}

/// Any [`Interface`].
#[derive(Clone)]
pub struct AnyInterface(Arc<dyn Comparable>);

/// An interface that can be compared with any other, as a coat in any of these numbers.
trait Comparable: Interface + Coat<f64> + Coat<Interval> {
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

    /// Returns the coat over a matt body that the interface is, in plain numbers and in intervals, if it is one.
    pub fn coat(&self) -> Option<(&dyn Coat<f64>, &dyn Coat<Interval>)> {
        self.is_coat().then_some((&*self.0, &*self.0))
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
