//! What a plugin implements: [`Hittable`] shapes, [`Shader`]s and [`Light`]s.

use crate::geometry::bounds::{self, Bounds};
use crate::geometry::packet::{self, Nearest, Rays};
use crate::geometry::ray::{Bracket, Ray, Side, Span};
use crate::geometry::sight::Sight;
use crate::numeric::twofold::Twofold;
use crate::shapes::roots::Method;
use crate::simd::cpu::Cpu;
use crate::simd::soa::{View, ViewMut};
use crate::world::certify::{Enclosure, Precision};
use crate::world::coincidence;
use crate::world::facing::{self, Faced, Facing, Places};
use crate::world::landing::{self, Landing};
use crate::world::material::{Look, Material, Rgb};
use crate::world::shading::{Anchor, ProceduralShader};
use glam::DVec3;

/// A shape that rays can hit. Shapes do not change while a picture is made.
///
/// A plugin implements `distance` and `normal`, and of the others what is not as their defaults have it. The last
/// ones, which take packets, are there for every shape.
pub trait Hittable: Send + Sync {
    /// The distance from the ray's origin to its first hit of the shape within the span, or
    /// [`MISS`](crate::geometry::ray::MISS).
    fn distance(&self, ray: &Ray, within: &Span) -> f64;

    /// The unit normal of the shape at a point of it.
    fn normal(&self, at: DVec3) -> DVec3;

    /// A box that holds all of it; nothing where there is none.
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    /// Whether no part of it lies in a region, which may be without an end. A shape without bounds may know better.
    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.bounds().is_some_and(|bounds| !bounds.overlaps(region))
    }

    /// A point and the unit normal of the plane that all of it lies in, if there is one: rays that leave it stay on their
    /// side of that.
    fn plane(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// How far from a point all of it is, at least; 0 where that is not known.
    fn clearance(&self, from: DVec3) -> f64 {
        bounds::clearance(from, self.bounds(), |region| self.is_clear_of(region))
    }

    /// Between which distances [`distance`](Self::distance) is. Where that is dear, plain arithmetic without branches
    /// says quickly which shape a ray may meet first, and the rest is computed for that one alone.
    ///
    /// Where the ray may start on the shape, that is where it [`touches`](Self::touches) the origin within the span's
    /// `origin_error`, it is a bracket without a certain end.
    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        coincidence::bracket(self, ray, within)
    }

    /// What [`distance`](Self::distance) gives, to the last bit, or NaN where it takes more than plain arithmetic
    /// without branches.
    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.distance(ray, within)
    }

    /// Whether a ray that leaves it on this side may meet it again. Where it may not, it is not asked. A plane is never
    /// met again, a ball only from inside; `true` is never wrong, as long as [`distance`](Self::distance) heeds
    /// `within.leaves`.
    fn meets_itself(&self, _leaving: Side) -> bool {
        true
    }

    /// Whether a point lies on its surface, but for an error of so many world units and for what rounding makes of the
    /// shape's own numbers. Rays that start there leave it.
    fn touches(&self, at: DVec3, error: f64) -> bool {
        coincidence::is_met_within(self, at, error)
    }

    /// How large the coordinates are that its hits are computed from, in world units: its own, not the ray's.
    fn reach(&self) -> f64 {
        self.bounds().map_or(0.0, |bounds| bounds.low.abs().max(bounds.high.abs()).max_element())
    }

    /// The distance of the hit at about this one, in twice the precision: it tells which of two surfaces that lie
    /// together is nearer. Nothing where it is not to be had;
    /// [`coincidence::distance`] gives it for shapes that have an equation.
    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<Twofold> {
        None
    }

    /// Whether both its sides are lit: then its normal is turned to the side that a ray comes from. A plane shows
    /// one side.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// How its hits are found, in a few words, for the plan of a scene.
    fn method(&self) -> String {
        "its own distance".to_owned()
    }

    /// The distance by another method of finding roots, to be compared with it; nothing where the shape is not the
    /// roots of a function along a ray, or is found in closed form.
    fn distance_by(&self, _method: Method, _ray: &Ray, _within: &Span) -> Option<f64> {
        None
    }

    /// What is certain about the first hit of a ray. A shape that says nothing of it cannot be verified;
    /// [`certify::first_hit`](crate::world::certify::first_hit) proves it for shapes that have an equation.
    fn certify(&self, _sight: &Sight, _precision: Precision) -> Enclosure {
        Enclosure::UNKNOWN
    }

    /// Compares the hits of a packet with the nearest so far, and tells whether any is in doubt. `sides` are those of
    /// this shape that the rays leave, if they do; `id` is its index in the scene and 1.
    fn meet(&self, cpu: Cpu, rays: Rays, sides: Option<&[Side]>, id: u64, nearest: Nearest) -> bool {
        packet::meet(cpu, self, rays, sides, id, nearest)
    }

    /// Marks the rays of a packet that it blocks before their ends, and those of which that is in doubt; tells
    /// whether any is.
    fn block(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        ends: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        packet::block(cpu, self, rays, sides, ends, blocked, doubt)
    }

    /// The distances of hits that are certain, each between two distances where [`meet`](Self::meet) has bracketed it;
    /// NaN where it takes more than plain arithmetic.
    fn distances(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        _brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        packet::distances(cpu, self, rays, sides, out);
    }

    /// Where the rays of a packet come to it after these distances, and its normals there.
    fn land(&self, cpu: Cpu, rays: Rays, distances: &[f64], landing: Landing) {
        let Landing { points, normals, sides, travelled } = landing;
        landing::land(cpu, self, rays, distances, sides, travelled, points, normals);
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

    /// What those three give at every point, if that is the same: then they are not asked at each. `None` is never wrong.
    fn even(&self, _material: &Material) -> Option<Look> {
        None
    }

    /// The largest that those three give anywhere, whatever the sign, from which follows how deep mirrors and glass are
    /// looked into; nothing where that is not known, or where a surface that is not even has a diffuse colour below 0.
    /// `None` is never wrong.
    fn brightest(&self, material: &Material) -> Option<Look> {
        self.even(material)
    }

    /// What [`ambient`](Self::ambient) and [`specular`](Self::specular) give at many points; tells whether any of the
    /// second is not 0.
    fn unlit(
        &self,
        cpu: Cpu,
        material: &Material,
        points: View,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool {
        packet::unlit(cpu, self, material, points, ambients, speculars)
    }

    /// What [`diffuse`](Self::diffuse) gives at many points; tells whether any is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: View, out: ViewMut) -> bool {
        packet::diffuses(cpu, self, material, points, out)
    }
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {
    fn even(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        Some(Look { ambient, diffuse, specular })
    }
}

/// A source of light.
pub trait Light: Send + Sync {
    /// Where it is, in world coordinates.
    fn location(&self) -> DVec3;

    /// The light that it sends toward a point, or nothing where it does not point there (the notes' `vischeck`).
    fn emissivity(&self, toward: DVec3) -> Option<Rgb>;

    /// What [`emissivity`](Self::emissivity) gives toward every point, if that is the same and never nothing: then it is
    /// not asked for each. `None` is never wrong.
    fn even(&self) -> Option<Rgb> {
        None
    }

    /// The largest that [`emissivity`](Self::emissivity) gives toward any point, whatever the sign; nothing where that is
    /// not known. `None` is never wrong.
    fn brightest(&self) -> Option<Rgb> {
        self.even()
    }

    /// The radius of a ball that shines; 0 for a point, whose shadows have sharp edges.
    fn size(&self) -> f64 {
        0.0
    }

    /// How it comes to many places, with what [`emissivity`](Self::emissivity) gives toward each.
    fn face(&self, cpu: Cpu, places: &Places, facing: Facing) -> Faced {
        let Facing { toward, emissivity, falloffs, ends, shines } = facing;
        facing::face(cpu, self, places, falloffs, ends, shines, toward, emissivity)
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
