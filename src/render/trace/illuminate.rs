//! What the lights of a scene do at the places of a surface.

use super::arrays::{Vectors, room};
use super::context::Tracer;
use super::group::Group;
use super::light::{self, Colours, Lit, Looks};
use super::scratch::Lighting;
use super::shadow::Ways;
use super::surface::Surface;
use crate::geometry::bounds::{self, Bounds};
use crate::render::watch::{Event, Outcome, Watch};
use crate::scene::model::Object;
use crate::world::facing::{Facing, Places};
use crate::world::material::Rgb;
use crate::world::packets::light::PacketLight;
use glam::DVec2;

impl<W: Watch> Tracer<'_, '_, W> {
    /// Adds what the lights do.
    pub(super) fn illuminate(&mut self, group: &mut Group, surface: &Surface, colours: &mut Vectors) {
        if self.model.lights.is_empty() {
            return;
        }
        let mut lighting = self.rooms.lighting.take().unwrap_or_default();
        let (cpu, count) = (self.cpu, group.padded());
        let Object { material, shader, .. } = &self.model.objects[surface.index];
        let points = surface.points.view(count);
        let is_matt = match surface.look {
            Some(look) => look.diffuse != Rgb::ZERO,
            None => shader.diffuses(cpu, material, points, lighting.diffuse.room(count)),
        };
        let scatters = is_matt || material.shininess != 0.0 && surface.is_mirror;
        let budget = group.budget[0];
        // Where nothing is scattered lights make no difference. Whoever looks on is told of them all the same.
        if scatters || W::SEES {
            let around = bounds::around(cpu, points);
            for index in 0..self.model.lights.len() {
                self.shine(index, group, surface, &around, &mut lighting, colours);
            }
            if scatters {
                self.miss_shadows(group, surface);
            }
        }
        if !scatters {
            // And the ray costs what it does where nobody looks.
            group.budget[0] = budget;
        }
        self.rooms.lighting = Some(lighting);
    }

    /// Adds what one light does.
    fn shine(
        &mut self,
        index: usize,
        group: &mut Group,
        surface: &Surface,
        around: &Bounds,
        lighting: &mut Lighting,
        colours: &mut Vectors,
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let light = &*self.model.lights[index].value;
        let material = &self.model.objects[surface.index].material;
        let Lighting { diffuse, lights, toward, falloffs, ends, emissivity, shines, blocked, shadows } =
            lighting;
        let (points, normals) = (surface.points.view(count), surface.normals.view(count));
        let is_point = light.size() == 0.0;
        let source = if is_point {
            Bounds { low: light.location(), high: light.location() }
        } else {
            self.places(light, index, group, surface, lights);
            bounds::around(cpu, lights.view(count))
        };
        let lights = (!is_point).then(|| lights.view(count));
        let (ends, shines, blocked) = (room(ends, count), room(shines, count), room(blocked, count));
        let facing = Facing {
            toward: toward.room(count),
            emissivity: emissivity.room(count),
            falloffs: room(falloffs, count),
            ends,
            shines,
        };
        let faced = light.face(cpu, &Places { points, normals, lights, slack: self.slack() }, facing);
        if !faced.any_shines {
            if W::SEES {
                self.watch
                    .see(Event::Light(index, if faced.any_faces { Outcome::Aside } else { Outcome::Behind }));
            }
            return;
        }
        let ways = Ways { from: *around, to: source, toward };
        let (mut sent, mut tint) = (light.even(), Rgb::ONE);
        if W::SEES || self.plan.has_glass {
            if let Some(sent) = sent.take() {
                emissivity.fill(count, sent);
            }
            let (blocker, passed) = self.pass(group, surface, &ways, ends, shines, emissivity);
            if W::SEES
                && let Some(blocker) = blocker
            {
                self.watch.see(Event::Light(index, Outcome::Blocked(blocker)));
                return;
            }
            tint = passed;
            blocked.fill(0);
        } else {
            self.shadow(group, surface, &ways, ends, shadows, blocked);
        }
        let lit = Lit {
            toward: toward.view(count),
            seen: group.dir.view(count),
            normals,
            falloffs: &falloffs[..count],
            shines,
            blocked,
            emissivity: sent.map_or(Colours::Each(emissivity.view(count)), Colours::Even),
            looks: match surface.look {
                Some(look) => Looks::Even(look),
                None => Looks::Each { diffuse: diffuse.view(count), specular: surface.specular.view(count) },
            },
        };
        light::shine(cpu, &lit, material.shininess, colours.room(count));
        if W::SEES {
            let mut alone = Vectors::default();
            alone.fill(count, Rgb::ZERO);
            light::shine(cpu, &lit, material.shininess, alone.room(count));
            self.watch.see(Event::Light(index, Outcome::Shines { passed: tint, colour: alone.get(0) }));
        }
    }

    /// The points of a light that the places of a surface see: on the disc that a ball of its size shows to each, where
    /// the sample has it.
    fn places(
        &self,
        light: &dyn PacketLight,
        index: usize,
        group: &Group,
        surface: &Surface,
        places: &mut Vectors,
    ) {
        let (middle, size) = (light.location(), light.size());
        places.fill(group.padded(), middle);
        for lane in 0..group.padded() {
            let camera = group.camera.get(lane).map(|camera| usize::from(*camera));
            let Some(sample) = camera.and_then(|camera| self.rooms.samples.get(camera)) else { continue };
            let Some(axis) = (middle - surface.points.get(lane)).try_normalize() else { continue };
            let (across, up) = axis.any_orthonormal_pair();
            let DVec2 { x, y } = sample.on_light(index);
            let (radius, angle) = (size * x.sqrt(), std::f64::consts::TAU * y);
            places.set(lane, middle + radius * (libm::cos(angle) * across + libm::sin(angle) * up));
        }
    }
}
