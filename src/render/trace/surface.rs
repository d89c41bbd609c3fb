//! The points where the rays of a packet hit one object, and the rays that continue from there.

use super::arrays::{VectorList, gather, resized};
use super::facets::Facets;
use super::light::{Colours, Reflectivities};
use super::tree::OpenRay;
use glam::DVec3;
use tabray_world::coincidence;
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::interface::{Crossing, Gloss, Interface, shininess};
use tabray_world::material::{Look, Material, Rgb};
use tabray_world::packets::shader::SurfacePoints;
use tabray_world::patch::{Patch, Window};
use tabray_world::rules;
use tabray_world::scene::model::Object;
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::View;
use tabray_world::surface_point::SurfacePoint;

/// The points where the rays of a packet hit one object.
#[derive(Default)]
pub(super) struct Surface {
    /// The object's index; of several objects, that of one of them.
    pub index: usize,
    /// The index of the object that each ray hits, where rays of several objects are shaded together; else empty.
    pub objects: Vec<u32>,
    pub points: VectorList,
    /// The unit normals with which the points are shaded, flipped to face the rays where both sides are lit.
    pub normals: VectorList,
    /// The unit normals of the surface itself, flipped likewise, where `is_bent`.
    pub geometric_normals: VectorList,
    /// Whether points may be shaded with other normals than those of the surface.
    pub is_bent: bool,
    /// The points as the object's shader sees them; empty where it sees only their positions.
    pub seen: Vec<SurfacePoint>,
    /// The side that each ray hits.
    pub sides: Vec<Side>,
    /// The path length from the viewer to each point, in world units.
    pub travelled: Vec<f64>,
    /// The cosines of the angles between the rays and the normals before they are flipped, from -1 to 1.
    pub cosines: Vec<f64>,
    /// Bounds on the errors of the points.
    pub errors: PointErrors,
    /// The reflectivities, where they are the same at all points.
    pub look: Option<Look>,
    /// The specular reflectivity at each point, where `look` is `None`.
    pub specular: VectorList,
    /// Whether the specular reflectivity is not 0 at any point.
    pub is_mirror: bool,
    /// The facets that are seen at each point, if the surface is rough and they have been drawn.
    pub facets: Vec<Facets>,
    /// The fraction of light that passes from each point to the start of its ray; empty if all does.
    pub passed: Vec<Rgb>,
    /// The fraction of what is behind each point that it covers; empty if all is covered.
    pub coverage: Vec<f64>,
    /// How rays cross the surface at each point, where that varies; else empty.
    glosses: Vec<Option<Gloss>>,
    /// The exponent of the highlight at each point, where that varies; else empty.
    pub exponents: Vec<f64>,
}

/// The surroundings of hit points, as the rays of a packet see them, where samples show patches.
#[derive(Clone, Copy)]
pub(super) struct SeenPatches<'p> {
    /// The directions of the rays.
    pub dir: View<'p>,
    /// The window through which a sample looks.
    pub window: Window,
    /// Tells whether the sample of the ray in a lane shows a patch.
    pub are_shown: &'p dyn Fn(usize) -> bool,
}

impl Surface {
    /// Returns the first points as the object's shader sees them.
    pub fn points(&self, count: usize) -> SurfacePoints<'_> {
        SurfacePoints { positions: self.points.view(count), seen: &self.seen }
    }

    /// Computes the shader's inputs at the points besides their positions, and lets the shader bend the normals.
    pub fn see(&mut self, Object { shape, shader, .. }: &Object, count: usize, patches: Option<SeenPatches>) {
        self.seen.clear();
        let (bends, sees) = (shader.bends(), shader.sees());
        self.is_bent = bends || shape.is_smooth();
        if sees.is_position() && !bends && patches.is_none() {
            return;
        }
        let is_two_sided = shape.is_two_sided();
        for (lane, side) in self.sides[..count].iter().enumerate() {
            let (position, normal) = (self.points.get(lane), self.normals.get(lane));
            let normal = if is_two_sided && *side == Side::Inside { -normal } else { normal };
            let mut point = SurfacePoint::seen(&**shape, sees, position, normal, *side);
            if let Some(SeenPatches { dir, window: Window { start, spread, pixel }, are_shown }) = patches
                && are_shown(lane)
            {
                let normals = if shape.is_smooth() { &self.geometric_normals } else { &self.normals };
                let width = start + spread * self.travelled[lane];
                let mut patch = Patch::seen(dir.get(lane), normals.get(lane), (width, pixel));
                point.uv.into_iter().for_each(|uv| patch.find_uv(&**shape, position, uv));
                point.patch = Some(patch);
            }
            self.seen.push(point);
        }
        if bends {
            if !shape.is_smooth() {
                self.geometric_normals.copy(self.normals.view(count));
            }
            for lane in 0..count {
                let bent = shader.normal_at(&self.seen[lane]);
                let is_turned = is_two_sided && self.sides[lane] == Side::Inside;
                self.normals.set(lane, if is_turned { -bent } else { bent });
            }
        }
    }

    /// Returns the normal of the surface itself at a point that is shaded with another normal.
    #[inline(always)]
    pub fn bent_from(&self, lane: usize) -> Option<DVec3> {
        let geometric = self.geometric_normals.get(lane);
        (self.is_bent && geometric != self.normals.get(lane)).then_some(geometric)
    }

    /// Clears `shines` where a light shines on the surface from behind: there it may shine only on the bent normals.
    /// Such points need no shadow ray: `t_max` becomes 0. Returns whether the light still shines on any point.
    pub fn hide_from_behind(&self, toward: View, shines: &mut [u64], t_max: &mut [f64]) -> bool {
        let mut any = false;
        for lane in 0..shines.len() {
            if self.bent_from(lane).is_some_and(|geometric| toward.get(lane).dot(geometric) <= 0.0) {
                (shines[lane], t_max[lane]) = (0, 0.0);
            }
            any |= shines[lane] != 0;
        }
        any
    }

    /// Computes how much of what is behind them the points cover.
    pub fn cover(&mut self, object: &Object, count: usize) {
        self.coverage.clear();
        if object.shader.covers_in_part() {
            let at = |lane: usize| seen_at(&self.points, &self.seen, lane);
            self.coverage.extend((0..count).map(|lane| object.shader.coverage_at(&at(lane))));
        }
    }

    /// Computes how rays cross the surface at the points, where that varies.
    pub fn polish(&mut self, Object { material, shader, .. }: &Object, count: usize) {
        self.glosses.clear();
        self.exponents.clear();
        if material.interface.as_ref().is_some_and(|interface| interface.varies()) {
            let at = |lane: usize| seen_at(&self.points, &self.seen, lane);
            self.glosses.extend((0..count).map(|lane| shader.gloss(&at(lane))));
            let own = material.shininess;
            let exponent = |gloss: &Option<Gloss>| gloss.map_or(own, |gloss| shininess(gloss.roughness));
            self.exponents.extend(self.glosses.iter().map(exponent));
        }
    }

    /// Returns how rays cross the surface at a point, given the interface of its material.
    pub fn interface<'s>(&'s self, lane: usize, own: &'s dyn Interface) -> &'s dyn Interface {
        self.glosses.get(lane).and_then(Option::as_ref).map_or(own, |gloss| gloss)
    }

    /// Mirrors rays that hit the points in these directions.
    pub fn mirror_rays(&self, seen: View, mirrored: &mut VectorList) {
        let mut dir = mirrored.resized(seen.len());
        for lane in 0..seen.len() {
            let normal = self.normals.get(lane);
            dir.set(lane, rules::mirrored(seen.get(lane).to_array(), normal.to_array()).into());
        }
        if self.is_bent {
            self.keep_before(seen, mirrored);
        }
    }

    /// Turns back the directions that bent normals mirror through the surface.
    pub fn keep_before(&self, seen: View, mirrored: &mut VectorList) {
        for lane in 0..seen.len() {
            let Some(normal) = self.bent_from(lane) else { continue };
            let dir = mirrored.get(lane);
            let height = dir.dot(normal);
            // A ray that is mirrored by a flat surface rises as it came.
            if height * seen.get(lane).dot(normal) > 0.0 {
                mirrored.set(lane, dir - 2.0 * height * normal);
            }
        }
    }

    /// Switches to the other sides of the points.
    pub fn flip_sides(&mut self, count: usize) {
        self.sides[..count].iter_mut().for_each(|side| *side = side.opposite());
    }

    /// Returns the unit normal with which a point is shaded, before facets are drawn.
    pub fn smooth_normal(&self, lane: usize) -> DVec3 {
        self.facets.get(lane).map_or_else(|| self.normals.get(lane), Facets::normal)
    }

    /// Returns the fraction of light that passes from a direction through the coat of a material to the body, and from
    /// there to the start of a ray that hits a point along `dir`; 1 without a coat.
    pub fn passed_by_coat(&self, material: &Material, lane: usize, dir: DVec3, from: DVec3) -> f64 {
        let Some(coat) = material.coat() else { return 1.0 };
        let normal = self.smooth_normal(lane);
        let passed = |cosine| coat.passes(cosine).unwrap_or(0.0);
        passed(from.dot(normal)) * passed(-dir.dot(normal))
    }

    /// Tells whether rays leave a point inside of a medium that absorbs light.
    pub fn is_in_medium(&self, object: &Object, lane: usize) -> bool {
        self.sides[lane] == Side::Inside && object.material.medium().is_some()
    }

    /// Returns the tint of the object of this surface at a point, as it is seen.
    pub fn tint(&self, object: &Object, lane: usize) -> Rgb {
        object.tint(&object.surface_point(self.points.get(lane), self.sides[lane]))
    }

    /// Returns how rays along `dir` cross the surface, by its interface.
    pub fn crossings(&self, interface: &dyn Interface, dir: View) -> Vec<Crossing> {
        let crossing = |lane: usize| {
            let normals = [self.normals.get(lane), self.bent_from(lane).unwrap_or(self.normals.get(lane))];
            crossing(self.interface(lane, interface), dir.get(lane), normals, self.sides[lane])
        };
        (0..dir.len()).map(crossing).collect()
    }

    /// Returns rays from the points in these directions.
    pub fn secondary_rays<'o>(&'o self, dir: &'o VectorList) -> SecondaryRays<'o> {
        let Self { index, points, sides, travelled, errors, .. } = self;
        SecondaryRays { points, dir, travelled, origin_object: *index, sides, errors }
    }

    /// Returns an open ray of a tree that continues another ray from a point.
    pub fn open_ray(&self, lane: usize, before: &OpenRay) -> OpenRay {
        OpenRay {
            origin: self.points.get(lane),
            travelled: self.travelled[lane],
            error: self.errors.of(lane),
            object: self.index as u32,
            depth: before.depth + 1,
            ..*before
        }
    }

    /// Returns the specular reflectivity at a point.
    pub fn mirror(&self, lane: usize) -> Rgb {
        self.look.map_or_else(|| self.specular.get(lane), |look| look.specular)
    }

    /// Returns the reflectivities for the light of a lamp at the points, given the diffuse ones where they differ, the
    /// highlights of lamps alone, and whether mirrors have highlights of it. `speculars` is scratch space.
    pub fn lit_by_lamp<'s>(
        &'s self,
        diffuse: &'s VectorList,
        count: usize,
        (highlight, are_mirrored): (Rgb, bool),
        speculars: &'s mut VectorList,
    ) -> Reflectivities<'s> {
        if highlight == Rgb::ZERO {
            return self.reflectivities(diffuse, count);
        }
        let own = |specular: Rgb| if are_mirrored { specular + highlight } else { highlight };
        match self.look {
            Some(look) => Reflectivities::Uniform(Look { specular: own(look.specular), ..look }),
            None => {
                speculars.resized(count);
                (0..count).for_each(|lane| speculars.set(lane, own(self.specular.get(lane))));
                Reflectivities::Each { diffuse: diffuse.view(count), specular: speculars.view(count) }
            }
        }
    }

    /// Returns the reflectivities at the points, given the diffuse ones where they differ.
    fn reflectivities<'s>(&'s self, diffuse: &'s VectorList, count: usize) -> Reflectivities<'s> {
        match self.look {
            Some(look) => Reflectivities::Uniform(look),
            None => {
                Reflectivities::Each { diffuse: diffuse.view(count), specular: self.specular.view(count) }
            }
        }
    }

    /// Returns the specular reflectivities at the points.
    pub fn mirrors(&self, count: usize) -> Colours<'_> {
        match self.look {
            Some(look) => Colours::Uniform(look.specular),
            None => Colours::Each(self.specular.view(count)),
        }
    }
}

/// Returns a point as the object's shader sees it.
fn seen_at(points: &VectorList, seen: &[SurfacePoint], lane: usize) -> SurfacePoint {
    seen.get(lane).copied().unwrap_or_else(|| SurfacePoint::at(points.get(lane)))
}

/// Returns how a ray along `dir` crosses an interface, given the bent normal and that of the surface itself.
pub(super) fn crossing(
    interface: &dyn Interface,
    dir: DVec3,
    [normal, geometric]: [DVec3; 2],
    side: Side,
) -> Crossing {
    let cross = |normal| interface.cross(dir, facing(normal, dir), side);
    let crossing = cross(normal);
    // Bent normals may lead a ray back to the side from which it comes.
    let is_through = |onward: DVec3| onward.dot(geometric) * dir.dot(geometric) > 0.0;
    if normal == geometric || crossing.onward.is_none_or(is_through) { crossing } else { cross(geometric) }
}

/// Returns the unit normal that faces a direction.
pub(super) fn facing(normal: DVec3, dir: DVec3) -> DVec3 {
    if normal.dot(dir) > 0.0 { -normal } else { normal }
}

/// Rays that continue from the points where a group's rays have hit an object, in the same lanes.
pub(super) struct SecondaryRays<'o> {
    pub points: &'o VectorList,
    pub dir: &'o VectorList,
    /// The path length from the viewer to each point, in world units.
    pub travelled: &'o [f64],
    /// The index of the object that the rays leave.
    pub origin_object: usize,
    /// The side of the object that each ray leaves.
    pub sides: &'o [Side],
    /// Bounds on the errors of the points.
    pub errors: &'o PointErrors,
}

/// Bounds on the errors of computed hit points, in world units.
#[derive(Default)]
pub(super) struct PointErrors {
    /// The bound of each point; empty where the points count as exact.
    each: Vec<f64>,
    /// The largest bound.
    pub most: f64,
}

impl PointErrors {
    /// Becomes the errors of exact points.
    pub fn clear(&mut self) {
        self.each.clear();
        self.most = 0.0;
    }

    /// Becomes the errors of points at these path lengths from the viewer, in world units, which rays have hit at angles
    /// with these cosines. `reach` is the largest magnitude of the coordinates that they are computed from.
    pub fn bound(&mut self, cpu: Cpu, travelled: &[f64], reach: f64, cosines: &[f64]) {
        let each = resized(&mut self.each, cosines.len());
        self.most = coincidence::errors_after(cpu, travelled, reach, cosines, each);
    }

    /// Becomes these errors, the last of them repeated to make `count`.
    pub fn fill(&mut self, count: usize, errors: impl Iterator<Item = f64>) {
        self.clear();
        self.each.extend(errors);
        self.most = self.each.iter().copied().fold(0.0, f64::max);
        self.each.resize(count, self.each.last().copied().unwrap_or_default());
    }

    /// Becomes the errors of some lanes, the last of them repeated to make `count`.
    pub fn gather(&mut self, from: &Self, lanes: &[u8], count: usize) {
        gather(&mut self.each, &from.each, lanes, count);
        self.most = from.most;
    }

    /// Returns a bound on the error of one point.
    pub fn of(&self, lane: usize) -> f64 {
        self.each.get(lane).copied().unwrap_or_default()
    }

    /// Returns rays from the first points, with the bounds of their errors.
    #[inline(always)]
    pub fn rays<'r>(&'r self, origin: View<'r>, dir: View<'r>) -> RayPacket<'r> {
        let errors = if self.each.is_empty() { &[] } else { &self.each[..origin.len()] };
        RayPacket::new(origin, dir, self.most).with_errors(errors)
    }
}
