//! The colours of the places that a packet's rays meet on one object.

use super::group::{Group, pick, pick_vectors};
use super::light::{self, Lit};
use super::shadow::Ways;
use super::{MAX_DIST, NARROW, Tracer};
use crate::bounds::{self, Bounds};
use crate::geometry::Side;
use crate::material::Rgb;
use crate::model::Object;
use crate::packet::{Rays, Vectors, WIDE};
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
        light::arrive(cpu, group.rays(), &distances, travelled, surface.points.view_mut(count));
        shape.normals(cpu, surface.points.view(count), surface.normals.view_mut(count));
        let (normals, sides) = (surface.normals.view_mut(count), &mut surface.sides[..count]);
        light::face(cpu, group.dir.view(count), shape.is_two_sided(), sides, normals);

        let mut colours = Vectors::ZERO;
        shader.ambients(cpu, material, surface.points.view(count), colours.view_mut(count));
        if W::SEES {
            self.watch.see(Event::Surface { normal: surface.normals.get(0), ambient: colours.get(0) });
        }
        let mut specular = Vectors::ZERO;
        shader.speculars(cpu, material, surface.points.view(count), specular.view_mut(count));
        self.illuminate(group, &surface, &specular, &mut colours);
        light::fade(cpu, &surface.travelled[..count], colours.view_mut(count));
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
        if !light::is_anything(self.cpu, specular.view(group.padded())) {
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
        light::mirror(self.cpu, group.dir.view(count), normals, mirrored.view_mut(count));
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
            if !light::face_light(cpu, points, normals, places.view(count), &mut distances, cos, to) {
                if W::SEES {
                    self.watch.see(Event::Light(index, Outcome::Behind));
                }
                continue;
            }
            light.emissivities(cpu, points, emissivity.view_mut(count), &mut shines);
            if !light::open(cpu, &cosines[..count], &mut shines) {
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
            light::shine(cpu, &lit, material.shininess, colours.view_mut(count));
            if W::SEES {
                let mut alone = Vectors::<N>::ZERO;
                light::shine(cpu, &lit, material.shininess, alone.view_mut(count));
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
