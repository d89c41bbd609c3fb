//! Rays, and what a plugin implements: [`Hittable`] shapes, [`Shader`]s and [`Light`]s.

use crate::certify::Enclosure;
use crate::material::{Material, Rgb};
use crate::shading::{Anchor, ProceduralShader};
use glam::DVec3;

/// A half line.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts, in world coordinates.
    pub origin: DVec3,
    /// Where it goes, a unit vector.
    pub dir: DVec3,
}

impl Ray {
    /// The point at this distance from the origin.
    #[inline(always)]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.dir
    }
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The one that its normal points to.
    Outside,
    /// The other one.
    Inside,
}

impl Side {
    /// The side of a surface with this normal from which something comes that moves along `dir`.
    #[inline(always)]
    pub fn seen_along(dir: DVec3, normal: DVec3) -> Self {
        if dir.dot(normal) < 0.0 { Self::Outside } else { Self::Inside }
    }

    /// The other side.
    #[inline(always)]
    pub fn opposite(self) -> Self {
        match self {
            Self::Outside => Self::Inside,
            Self::Inside => Self::Outside,
        }
    }
}

/// Distances along a ray, both ends excluded.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Hits must lie farther.
    pub near: f64,
    /// Hits must lie nearer.
    pub far: f64,
    /// The side of the shape's own surface that the ray starts on and leaves, if it does: where it starts is no hit,
    /// however rounding has it. Only shapes that are not convex are asked then.
    pub leaves: Option<Side>,
}

/// The distance of a ray that hits nothing.
pub const MISS: f64 = f64::INFINITY;

impl Span {
    /// All of a ray but its origin.
    pub const RAY: Span = Span { near: 0.0, far: f64::INFINITY, leaves: None };

    /// The distance itself if it lies in the span, else [`MISS`]; so is a NaN.
    #[inline(always)]
    pub fn keep(&self, distance: f64) -> f64 {
        if self.near < distance && distance < self.far { distance } else { MISS }
    }
}

/// A shape that rays can hit. Shapes do not change while a picture is made.
pub trait Hittable: Send + Sync {
    /// The distance from the ray's origin to its first hit of the shape within the span, or [`MISS`].
    fn distance(&self, ray: &Ray, within: &Span) -> f64;

    /// The unit normal of the shape at a point of it.
    fn normal(&self, at: DVec3) -> DVec3;

    /// Whether no ray that leaves it can meet it again. Then it is not asked.
    fn is_convex(&self) -> bool {
        true
    }

    /// Whether both its sides are lit: then its normal is turned to the side that a ray comes from. A plane shows
    /// one side.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// What is certain about the first hit of a ray from afar. A shape that says nothing of it cannot be verified;
    /// [`certify::first_hit`](crate::certify::first_hit) proves it for shapes that have an equation.
    fn certify(&self, _ray: &Ray) -> Enclosure {
        Enclosure::Doubtful(0.0)
    }
}

/// How a surface answers light where its material alone does not say.
///
/// The defaults are the notes' `material_getamb`, `material_getdiff` and `material_getspec`.
pub trait Shader: Send + Sync {
    /// The reflectivity for light from nowhere in particular.
    fn ambient(&self, material: &Material, _at: DVec3) -> Rgb {
        material.ambient
    }

    /// The reflectivity for light from the scene's lights, scattered evenly.
    fn diffuse(&self, material: &Material, _at: DVec3) -> Rgb {
        material.diffuse
    }

    /// The reflectivity of the surface as a mirror.
    fn specular(&self, material: &Material, _at: DVec3) -> Rgb {
        material.specular
    }
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {}

/// A source of light.
pub trait Light: Send + Sync {
    /// Where it is, in world coordinates.
    fn location(&self) -> DVec3;

    /// The light that it sends toward a point, or nothing where it does not point there (the notes' `vischeck`).
    fn emissivity(&self, toward: DVec3) -> Option<Rgb>;

    /// The radius of a ball that shines; 0 for a point, whose shadows have sharp edges.
    fn size(&self) -> f64 {
        0.0
    }
}

/// What the constructor of an object makes: its shape and its shader.
pub struct Body {
    /// Where it is.
    pub shape: Box<dyn Hittable>,
    /// What it looks like.
    pub shader: Box<dyn Shader>,
}

impl Body {
    /// An object that looks like its material.
    pub fn plain(shape: impl Hittable + 'static) -> Self {
        Self::shaded(shape, Plain)
    }

    /// An object with a look of its own.
    pub fn shaded(shape: impl Hittable + 'static, shader: impl Shader + 'static) -> Self {
        Self { shape: Box::new(shape), shader: Box::new(shader) }
    }

    /// An object that looks as a procedural shader has it.
    pub fn procedural(shape: impl Hittable + 'static, shader: &ProceduralShader, anchor: Anchor) -> Self {
        Self { shape: Box::new(shape), shader: (shader.make)(anchor) }
    }
}
