//! The colours of the places that a packet's rays meet on one object.

use super::group::{Group, pick, pick_vectors};
use super::shadow::Ways;
use super::{MAX_DIST, NARROW, Tracer};
use crate::bounds::{self, Bounds};
use crate::cpu::kernels;
use crate::geometry::Side;
use crate::material::Rgb;
use crate::model::Object;
use crate::packet::{Rays, Vectors, View, ViewMut, WIDE};
use crate::watch::{Count, Event, Hit, Kind, Outcome, Purpose, Reason, Watch};
use glam::{DVec2, DVec3};

/// Places on one object, where the rays of a packet meet it.
pub(super) struct Surface<'m, const N: usize> {
    pub index: usize,
    pub object: &'m Object,
    pub points: Vectors<N>,
    /// The unit normals; turned to the rays' side where both are lit.
    pub normals: Vectors<N>,
    /// The side that each ray comes to.
    pub sides: [Side; N],
    /// How far the light has come from each.
    pub travelled: [f64; N],
}

impl<'m, W: Watch> Tracer<'m, '_, W> {
    /// The colours that rays see which all meet the object of this index, between `near` and `far`.
    pub(super) fn shade<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        near: &[f64; N],
        far: &[f64; N],
        index: usize,
    ) -> Vectors<N> {
        let (cpu, count) = (self.cpu, group.padded());
        let distances = self.settle(group, near, far, index);
        let object = &self.model.objects[index];
        let Object { material, shape, shader, .. } = object;
        let mut surface = Surface {
            index,
            object,
            points: Vectors::ZERO,
            normals: Vectors::ZERO,
            sides: [Side::Outside; N],
            travelled: group.travelled,
        };
        let travelled = &mut surface.travelled[..count];
        arrive(cpu, group.rays(), &distances, travelled, surface.points.view_mut(count));
        shape.normals(cpu, surface.points.view(count), surface.normals.view_mut(count));
        let (normals, sides) = (surface.normals.view_mut(count), &mut surface.sides[..count]);
        face(cpu, group.dir.view(count), shape.is_two_sided(), sides, normals);

        let mut colours = Vectors::ZERO;
        shader.ambients(cpu, material, surface.points.view(count), colours.view_mut(count));
        if W::SEES {
            self.watch.see(Event::Surface { normal: surface.normals.get(0), ambient: colours.get(0) });
        }
        let mut specular = Vectors::ZERO;
        shader.speculars(cpu, material, surface.points.view(count), specular.view_mut(count));
        self.illuminate(group, &surface, &specular, &mut colours);
        fade(cpu, &surface.travelled[..count], colours.view_mut(count));
        if W::SEES {
            let (point, travelled) = (surface.points.get(0), surface.travelled[0]);
            let hit = Hit { index, object, distance: distances[0], point };
            self.watch.see(Event::Shaded { hit: &hit, travelled, colour: colours.get(0) });
        }
        if material.transparency != 0.0 {
            self.look_through(group, &surface, &mut colours);
        }
        self.look_in_the_mirror(group, &surface, &specular, &mut colours);
        colours
    }

    /// Adds what is seen through glass.
    fn look_through<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        colours: &mut Vectors<N>,
    ) {
        let kept = 1.0 - surface.object.material.transparency;
        let mut lanes = [0; N];
        for (lane, place) in lanes.iter_mut().enumerate().take(group.len) {
            *place = lane as u8;
        }
        if W::SEES {
            let tint = surface.object.tint(surface.points.get(0));
            self.watch.see(Event::Begin(Purpose::Transmitted { tint, kept }));
        }
        let sides = surface.sides.map(Side::opposite);
        let dir = group.dir.clone();
        let len = group.len;
        let behind = self.onward(group, surface, &lanes[..len], &dir, &sides, Kind::Transmitted);
        for lane in 0..group.len {
            let tint = surface.object.tint(surface.points.get(lane));
            colours.set(lane, kept * colours.get(lane) + tint * behind.get(lane));
        }
    }

    /// Adds what is mirrored.
    fn look_in_the_mirror<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        specular: &Vectors<N>,
        colours: &mut Vectors<N>,
    ) {
        if !is_anything(self.cpu, specular.view(group.padded())) {
            return;
        }
        let (mut lanes, mut len) = ([0; N], 0);
        for lane in 0..group.len {
            lanes[len] = lane as u8;
            len += usize::from(specular.get(lane) != DVec3::ZERO);
        }
        if W::SEES {
            self.watch.see(Event::Begin(Purpose::Reflected { specular: specular.get(0) }));
        }
        let mut mirrored = Vectors::ZERO;
        let count = group.padded();
        let normals = surface.normals.view(count);
        mirror(self.cpu, group.dir.view(count), normals, mirrored.view_mut(count));
        let lanes = &lanes[..len];
        let seen = self.onward(group, surface, lanes, &mirrored, &surface.sides, Kind::Reflected);
        for lane in lanes {
            let lane = usize::from(*lane);
            colours.set(lane, colours.get(lane) + specular.get(lane) * seen.get(lane));
        }
    }

    /// The colours that come to some places of a surface from these directions. The rays that see them leave it on
    /// these sides.
    fn onward<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        lanes: &[u8],
        dir: &Vectors<N>,
        sides: &[Side; N],
        kind: Kind,
    ) -> Vectors<N> {
        let (mut near, mut len) = ([0; N], 0);
        for lane in lanes {
            near[len] = *lane;
            len += usize::from(surface.travelled[usize::from(*lane)] <= MAX_DIST);
        }
        let mut colours = Vectors::ZERO;
        if W::SEES && len == 0 {
            self.watch.see(Event::Dropped(Reason::TooFar));
            self.watch.see(Event::Colour(DVec3::ZERO));
        }
        self.watch.count(Count::Rays(kind, len));
        self.depth += 1;
        let size = if len > NARROW && self.is_shallow() { WIDE } else { NARROW };
        for lanes in near[..len].chunks(size) {
            if lanes.len() <= NARROW {
                self.onward_part::<N, NARROW>(group, surface, lanes, dir, sides, &mut colours);
            } else {
                self.onward_part::<N, WIDE>(group, surface, lanes, dir, sides, &mut colours);
            }
        }
        self.depth -= 1;
        colours
    }

    fn onward_part<const N: usize, const M: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        lanes: &[u8],
        dir: &Vectors<N>,
        sides: &[Side; N],
        colours: &mut Vectors<N>,
    ) {
        let mut part = Group::<M> {
            len: lanes.len(),
            origin: pick_vectors(&surface.points, lanes),
            dir: pick_vectors(dir, lanes),
            travelled: pick(&surface.travelled, lanes),
            budget: pick(&group.budget, lanes),
            camera: pick(&group.camera, lanes),
            leaves: Some(surface.index),
            sides: pick(sides, lanes),
        };
        let seen = self.trace(&mut part);
        for (index, lane) in lanes.iter().enumerate() {
            colours.set(usize::from(*lane), seen.get(index));
            group.budget[usize::from(*lane)] = part.budget[index];
        }
    }

    /// Adds what the lights do.
    fn illuminate<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        specular: &Vectors<N>,
        colours: &mut Vectors<N>,
    ) {
        if self.model.lights.is_empty() {
            return;
        }
        let (cpu, count) = (self.cpu, group.padded());
        let Object { material, shader, .. } = surface.object;
        let points = surface.points.view(count);
        let mut diffuse = Vectors::<N>::ZERO;
        shader.diffuses(cpu, material, points, diffuse.view_mut(count));
        let around = bounds::around(cpu, points);
        // What each light writes anew.
        let (mut toward, mut emissivity) = (Vectors::<N>::ZERO, Vectors::<N>::ZERO);
        let (mut distances, mut cosines, mut shines) = ([0.0; N], [0.0; N], [0; N]);
        for (index, light) in self.model.lights.iter().enumerate() {
            let light = &*light.value;
            let mut tint = Rgb::ONE;
            let places = self.places_on(index, group, surface);
            let normals = surface.normals.view(count);
            let (to, cos) = (toward.view_mut(count), &mut cosines[..count]);
            if !face_light(cpu, points, normals, places.view(count), &mut distances, cos, to) {
                if W::SEES {
                    self.watch.see(Event::Light(index, Outcome::Behind));
                }
                continue;
            }
            light.emissivities(cpu, points, emissivity.view_mut(count), &mut shines);
            if !open(cpu, &cosines[..count], &mut shines) {
                if W::SEES {
                    self.watch.see(Event::Light(index, Outcome::Aside));
                }
                continue;
            }
            let source = if light.size() == 0.0 {
                Bounds { low: light.location(), high: light.location() }
            } else {
                bounds::around(cpu, places.view(count))
            };
            let ways = Ways { region: around.and(&source), toward: &toward, distances: &distances };
            if W::SEES || self.plan.has_glass {
                let passed = self.passed(group, surface, &ways, &shines);
                for lane in 0..group.len {
                    shines[lane] &= u64::from(passed.blocker[lane] == 0);
                    emissivity.set(lane, emissivity.get(lane) * passed.tint.get(lane));
                }
                if W::SEES
                    && let Some(blocker) = (passed.blocker[0] as usize).checked_sub(1)
                {
                    self.watch.see(Event::Light(index, Outcome::Blocked(blocker)));
                    continue;
                }
                tint = passed.tint.get(0);
            } else {
                self.shadow(group, surface, &ways, &mut shines);
            }
            let lit = Lit {
                rays: Rays { origin: points, dir: toward.view(count) },
                eyes: group.origin.view(count),
                normals: surface.normals.view(count),
                distances: &distances[..count],
                cosines: &cosines[..count],
                shines: &shines[..count],
                diffuse: diffuse.view(count),
                specular: specular.view(count),
                emissivity: emissivity.view(count),
            };
            shine(cpu, &lit, material.shininess, colours.view_mut(count));
            if W::SEES {
                let mut alone = Vectors::<N>::ZERO;
                shine(cpu, &lit, material.shininess, alone.view_mut(count));
                self.watch.see(Event::Light(index, Outcome::Shines { passed: tint, colour: alone.get(0) }));
            }
        }
    }

    /// The points of a light that the places of a surface see: on the disc that a ball of its size shows to each, where
    /// the sample has it.
    fn places_on<const N: usize>(&self, index: usize, group: &Group<N>, surface: &Surface<N>) -> Vectors<N> {
        let light = &self.model.lights[index].value;
        let (middle, size) = (light.location(), light.size());
        let mut places = Vectors { x: [middle.x; N], y: [middle.y; N], z: [middle.z; N] };
        if size == 0.0 {
            return places;
        }
        for lane in 0..group.padded() {
            let Some(sample) = self.samples[usize::from(group.camera[lane])] else { continue };
            let Some(axis) = (middle - surface.points.get(lane)).try_normalize() else { continue };
            let (across, up) = axis.any_orthonormal_pair();
            let DVec2 { x, y } = sample.on_light(index);
            let (radius, angle) = (size * x.sqrt(), std::f64::consts::TAU * y);
            places.set(lane, middle + radius * (libm::cos(angle) * across + libm::sin(angle) * up));
        }
        places
    }
}

/// Places that a light shines on.
struct Lit<'l> {
    /// From each place to the light.
    rays: Rays<'l>,
    /// Where each is seen from.
    eyes: View<'l>,
    normals: View<'l>,
    /// To the light.
    distances: &'l [f64],
    /// Of the angles between the normals and the directions of the light.
    cosines: &'l [f64],
    /// 0 where no light comes.
    shines: &'l [u64],
    diffuse: View<'l>,
    specular: View<'l>,
    emissivity: View<'l>,
}

kernels! {
    /// Where rays come after these distances, and how far their light has then travelled.
    fn arrive(rays: Rays, distances: &[f64], travelled: &mut [f64]) => points {
        let count = travelled.len();
        let (rays, distances, mut points) = (rays.first(count), &distances[..count], points.first(count));
        for lane in 0..count {
            points.set(lane, rays.get(lane).at(distances[lane]));
            travelled[lane] += distances[lane];
        }
    }

    /// The sides that rays come to, and the normals turned there if both sides are lit.
    fn face(dir: View, is_two_sided: bool, sides: &mut [Side]) => normals {
        let count = sides.len();
        let (dir, mut normals) = (dir.first(count), normals.first(count));
        for lane in 0..count {
            let normal = normals.get(lane);
            let side = Side::seen_along(dir.get(lane), normal);
            sides[lane] = side;
            normals.set(lane, if is_two_sided & (side == Side::Inside) { -normal } else { normal });
        }
    }

    /// The directions and distances from places to a light, and the cosines of the angles there. Tells whether any
    /// place faces the light.
    fn face_light(
        points: View, normals: View, places: View, distances: &mut [f64], cosines: &mut [f64]
    ) => toward -> bool {
        let count = cosines.len();
        let (points, normals, places) = (points.first(count), normals.first(count), places.first(count));
        let (mut toward, distances) = (toward.first(count), &mut distances[..count]);
        let mut any = 0;
        for lane in 0..count {
            let between = places.get(lane) - points.get(lane);
            let distance = between.length();
            let dir = between * (1.0 / distance);
            toward.set(lane, dir);
            distances[lane] = distance;
            // A light on the surface itself makes it NaN, and is behind.
            cosines[lane] = dir.dot(normals.get(lane));
            any |= u64::from(cosines[lane] > 0.0);
        }
        any != 0
    }

    /// Adds the light that comes to places, where it does.
    fn shine(lit: &Lit, shininess: f64) => colours {
        let colours = colours.first(lit.shines.len());
        let whole = shininess as u32;
        if shininess == 0.0 {
            shine_all(lit, None::<fn(f64) -> f64>, colours);
        } else if f64::from(whole) == shininess && whole <= MOST_MULTIPLIED {
            shine_all(lit, Some(|cos| whole_power(cos, whole)), colours);
        } else {
            shine_all(lit, Some(|cos| libm::pow(cos, shininess)), colours);
        }
    }

    /// Leaves the light where it comes from before the surface. Tells whether there is any.
    fn open(cosines: &[f64], shines: &mut [u64]) -> bool {
        let (count, mut any) = (cosines.len(), 0);
        let shines = &mut shines[..count];
        for lane in 0..count {
            shines[lane] &= u64::from(cosines[lane] > 0.0);
            any |= shines[lane];
        }
        any != 0
    }

    /// Whether any vector is not 0.
    fn is_anything(vectors: View) -> bool {
        let (count, mut any) = (vectors.len(), 0);
        let vectors = vectors.first(count);
        for lane in 0..count {
            let vector = vectors.get(lane);
            any |= u64::from((vector.x != 0.0) | (vector.y != 0.0) | (vector.z != 0.0));
        }
        any != 0
    }

    /// Divides colours by how far their light has travelled.
    fn fade(travelled: &[f64]) => colours {
        let count = travelled.len();
        let mut colours = colours.first(count);
        for lane in 0..count {
            colours.set(lane, colours.get(lane) * (1.0 / travelled[lane]));
        }
    }

    /// Directions, mirrored.
    fn mirror(dir: View, normals: View) => out {
        let count = dir.len();
        let (normals, mut out) = (normals.first(count), out.first(count));
        for lane in 0..count {
            let (dir, normal) = (dir.get(lane), normals.get(lane));
            out.set(lane, dir - 2.0 * dir.dot(normal) * normal);
        }
    }
}

/// Powers up to this one are multiplied out.
const MOST_MULTIPLIED: u32 = 1 << 16;

/// A power by repeated squaring: for many numbers at a time, which a general power is not.
#[inline(always)]
fn whole_power(of: f64, power: u32) -> f64 {
    let (mut product, mut square, mut left) = (1.0, of, power);
    while left > 0 {
        product = if left & 1 == 1 { product * square } else { product };
        square *= square;
        left >>= 1;
    }
    product
}

#[inline(always)]
fn shine_all(lit: &Lit, glint: Option<impl Fn(f64) -> f64>, colours: ViewMut) {
    let (count, mut colours) = (lit.shines.len(), colours);
    let (rays, eyes, normals) = (lit.rays.first(count), lit.eyes.first(count), lit.normals.first(count));
    let (diffuse, specular) = (lit.diffuse.first(count), lit.specular.first(count));
    let emissivity = lit.emissivity.first(count);
    let (distances, cosines, shines) = (&lit.distances[..count], &lit.cosines[..count], &lit.shines[..count]);
    for lane in 0..count {
        let light = emissivity.get(lane);
        let mut colour = diffuse.get(lane) * light * (cosines[lane] / distances[lane]);
        if let Some(glint) = &glint {
            let to_eye = (eyes.get(lane) - rays.origin.get(lane)).normalize();
            let half = (to_eye + rays.dir.get(lane)).normalize();
            colour += light * specular.get(lane) * glint(half.dot(normals.get(lane)));
        }
        let before = colours.get(lane);
        colours.set(lane, if shines[lane] != 0 { before + colour } else { before });
    }
}
