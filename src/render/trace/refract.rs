//! The rays that continue where a material has an interface: each hit has a reflected and a transmitted one.

use super::arrays::{VectorList, resized};
use super::context::Tracer;
use super::light;
use super::ray_group::RayGroup;
use super::scratch::ShadingScratch;
use crate::geometry::ray::Side;
use crate::render::limits::MAX_DIST;
use crate::render::observer::{Event, Purpose, RayKind, TraceObserver};
use crate::render::plan::depth::{Branch, STEPS, step};
use crate::world::interface::{Crossing, Interface};
use crate::world::material::Rgb;
use glam::DVec3;

/// Returns the unit normal that faces a direction.
fn facing(normal: DVec3, dir: DVec3) -> DVec3 {
    if normal.dot(dir) > 0.0 { -normal } else { normal }
}

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Adds transmitted and reflected light, in the fractions that an interface decides.
    ///
    /// How deep reflected rays are followed depends on the fraction, rounded up to a power of two, so that it does not
    /// depend on the other rays of the packet.
    pub(super) fn add_split(
        &mut self,
        interface: &dyn Interface,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let (count, surface) = (group.padded(), &mut shading.surface);
        let (object, branches) = (&self.model.objects[surface.index], self.plan.onward(surface.index));
        let kept = 1.0 - object.material.transparency;
        let crossings: Vec<Crossing> = (0..count)
            .map(|lane| {
                let (dir, side) = (group.dir.get(lane), surface.sides[lane]);
                let cross = |normal| interface.cross(dir, facing(normal, dir), side);
                let crossing = cross(surface.normals.get(lane));
                if !surface.is_bent {
                    return crossing;
                }
                // Bent normals may lead a ray back to the side from which it comes.
                let unbent = surface.unbent.get(lane);
                let is_through = |onward: DVec3| onward.dot(unbent) * dir.dot(unbent) > 0.0;
                if crossing.onward.is_none_or(is_through) { crossing } else { cross(unbent) }
            })
            .collect();
        let tints: Vec<Rgb> = (0..group.len)
            .map(|lane| {
                let point = object.surface_point(surface.points.get(lane), surface.sides[lane]);
                object.tint(&point) * (1.0 - crossings[lane].reflected)
            })
            .collect();
        (0..group.len).for_each(|lane| colours.set(lane, kept * colours.get(lane)));

        if W::SEES && crossings[0].onward.is_some() {
            self.observer.see(Event::Begin(Purpose::Transmitted { tint: tints[0], kept }));
        }
        let flip = |sides: &mut [Side]| sides.iter_mut().for_each(|side| *side = side.opposite());
        flip(&mut surface.sides[..count]);
        let mut dir = shading.dir.resized(count);
        for lane in 0..count {
            dir.set(lane, crossings[lane].onward.unwrap_or(DVec3::NEG_Z));
        }
        let is_through = |crossing: &Crossing| crossing.onward.is_some();
        self.go(group, shading, RayKind::Transmitted, branches.through, &crossings, is_through);
        flip(&mut shading.surface.sides[..count]);
        for lane in 0..group.len {
            colours.set(lane, colours.get(lane) + tints[lane] * shading.behind.get(lane));
        }

        for number in 0..=STEPS {
            let is_its = |crossing: &Crossing| crossing.reflected > 0.0 && step(crossing.reflected) == number;
            if !crossings[..group.len].iter().any(is_its) {
                continue;
            }
            if W::SEES {
                let specular = Rgb::splat(crossings[0].reflected);
                self.observer.see(Event::Begin(Purpose::Reflected { specular }));
            }
            let surface = &mut shading.surface;
            let mut dir = shading.dir.resized(count);
            for lane in 0..count {
                let (seen, normal) = (group.dir.get(lane), surface.normals.get(lane));
                dir.set(lane, seen - 2.0 * seen.dot(normal) * normal);
            }
            if surface.is_bent {
                surface.keep_before(group.dir.view(count), &mut shading.dir);
            }
            self.go(
                group,
                shading,
                RayKind::Reflected,
                branches.mirrored.reduced(number),
                &crossings,
                is_its,
            );
            for lane in (0..group.len).filter(|lane| is_its(&crossings[*lane])) {
                let seen = crossings[lane].reflected * shading.behind.get(lane);
                colours.set(lane, colours.get(lane) + seen);
            }
        }
    }

    /// Computes the light that returns along the rays whose crossings are chosen.
    fn go(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        kind: RayKind,
        branch: Branch,
        crossings: &[Crossing],
        is_its: impl Fn(&Crossing) -> bool,
    ) {
        let count = group.padded();
        let (travelled, goes) = (&shading.surface.travelled[..count], resized(&mut shading.goes, count));
        light::reach(self.cpu, travelled, MAX_DIST, goes);
        for (goes, crossing) in goes.iter_mut().zip(crossings) {
            *goes &= u64::from(is_its(crossing));
        }
        group.leave_out(self.cpu, &branch, travelled, goes);
        self.end_bounces(goes);
        self.onward(group, shading, kind, branch);
    }
}
