//! How much of a light comes through glass.

use super::arrays::{Vectors, list, pick, room};
use super::context::Tracer;
use super::group::Group;
use super::scratch::Passage;
use super::shadow::Ways;
use super::surface::Surface;
use crate::geometry::ray::{Ray, Side};
use crate::render::watch::{Count, Event, Kind, Purpose, Watch};
use crate::world::material::Rgb;

impl<W: Watch> Tracer<'_, '_, W> {
    /// Takes from the light that shines on some places what does not come through, in a scene with glass. Tells what
    /// becomes of the first one's: the opaque object that it ends at, and the part of it that came through.
    pub(super) fn pass(
        &mut self,
        group: &mut Group,
        surface: &Surface,
        ways: &Ways,
        ends: &[f64],
        shines: &mut [u64],
        emissivity: &mut Vectors,
    ) -> (Option<usize>, Rgb) {
        let mut passage = self.rooms.passages.pop().unwrap_or_default();
        let mut lanes = Vec::new();
        let lanes = list(&shines[..group.len], &mut lanes);
        let Passage { group: part, ends: far, tint, blocker, .. } = &mut *passage;
        part.go_on(group, &surface.onward(ways.toward), lanes);
        let count = part.padded();
        pick(far, ends, lanes, count);
        tint.fill(count, Rgb::ONE);
        room(blocker, count).fill(0);
        self.walk(&mut passage);
        for (index, lane) in lanes.iter().enumerate() {
            let lane = usize::from(*lane);
            shines[lane] = u64::from(passage.blocker[index] == 0);
            emissivity.set(lane, emissivity.get(lane) * passage.tint.get(index));
        }
        group.pay(&passage.group, lanes);
        let first = ((passage.blocker[0] as usize).checked_sub(1), passage.tint.get(0));
        self.rooms.passages.push(passage);
        first
    }

    /// Goes on toward a light, through glass.
    fn walk(&mut self, passage: &mut Passage) {
        let Passage { group, ends, tint, blocker, found, parts, .. } = passage;
        self.watch.count(Count::Rays(Kind::Shadow, group.len));
        if W::SEES {
            self.watch.see(Event::Begin(Purpose::Shadow { distance: ends[0] }));
        }
        self.closest(group, Some(ends), found);
        parts.begin(&found.met[..group.len]);
        while let Some((id, lanes)) = parts.next() {
            let Some(index) = (id as usize).checked_sub(1) else { continue };
            if self.model.objects[index].material.transparency == 0.0 {
                lanes.iter().for_each(|lane| blocker[usize::from(*lane)] = id);
                continue;
            }
            let mut onward = self.rooms.passages.pop().unwrap_or_default();
            for lanes in lanes.chunks(self.most()) {
                onward.group.pick(group, lanes);
                let count = onward.group.padded();
                pick(&mut onward.near, &found.near, lanes, count);
                pick(&mut onward.far, &found.far, lanes, count);
                pick(&mut onward.ends, ends, lanes, count);
                onward.tint.pick(tint, lanes, count);
                room(&mut onward.blocker, count).fill(0);
                self.pane(index, &mut onward);
                tint.put(&onward.tint, lanes);
                for (lane, id) in lanes.iter().zip(&onward.blocker) {
                    blocker[usize::from(*lane)] = *id;
                }
                group.pay(&onward.group, lanes);
            }
            self.rooms.passages.push(onward);
        }
    }

    /// Goes through one object of glass, and on from there.
    fn pane(&mut self, index: usize, passage: &mut Passage) {
        let Passage { group, ends, tint, near, far, distances, .. } = passage;
        self.settle(group, (near, far), index, distances);
        let object = &self.model.objects[index];
        let count = group.padded();
        let (sides, cosines) = (room(&mut group.sides, count), room(&mut group.cosines, count));
        for lane in 0..count {
            let ray = Ray { origin: group.origin.get(lane), dir: group.dir.get(lane) };
            let point = ray.at(distances[lane]);
            let normal = object.shape.normal(point);
            sides[lane] = Side::seen_along(ray.dir, normal).opposite();
            cosines[lane] = ray.dir.dot(normal);
            group.travelled[lane] += distances[lane];
            group.origin.set(lane, point);
            tint.set(lane, tint.get(lane) * object.tint(point));
            ends[lane] -= distances[lane];
        }
        group.errors = self.errors(&*object.shape, &group.travelled[..count], &group.cosines[..count]);
        group.leaves = Some(index);
        self.depth += 1;
        self.walk(passage);
        self.depth -= 1;
    }
}
