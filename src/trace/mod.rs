//! The colours that rays see: first hits, light, shadows, mirrors and glass (the notes' `ray_trace`).
//!
//! Rays go in packets. What a packet meets first is found for all its rays at once (`search`); those that meet the same
//! object go on together, as a smaller packet, and so do their shadows (`shadow`), what they see through glass and in
//! mirrors (`shade`). One ray is a packet of one. A ray's colour does not depend on which others go with it.

mod group;
mod light;
mod search;
mod shade;
mod shadow;

use crate::cpu::Cpu;
use crate::geometry::Ray;
use crate::material::Rgb;
use crate::model::Model;
use crate::packet::{Vectors, WIDE};
use crate::plan::Plan;
use crate::sample::Sample;
use crate::watch::{Count, Event, Hit, Kind, Purpose, Watch};
use group::{Group, Parts};
use search::Found;

/// Light that has travelled farther than this is black.
pub(crate) const MAX_DIST: f64 = 20.0;

/// The rays that one camera ray may cost. Mirrors that nearly touch would otherwise reflect each other for ever;
/// what lies beyond is black.
pub(crate) const MAX_RAYS: usize = 20_000;

/// The rays of a packet where there are few.
const NARROW: usize = 8;

/// From so many reflections on, packets are narrow: a deep hall of mirrors would fill the memory with wide ones.
const DEEP: usize = 24;

/// The colour of a pixel, before it is clamped to what a picture can show: `x` counts from the left and `y`
/// from the bottom.
pub fn pixel(model: &Model, x: usize, y: usize) -> Rgb {
    watch_pixel(model, x, y, &mut ())
}

/// As [`pixel`], and `watch` sees how it comes about.
pub fn watch_pixel(model: &Model, x: usize, y: usize, watch: &mut impl Watch) -> Rgb {
    let camera = &model.camera.value;
    let colours = camera.rays(x, y).map(|(ray, sample)| watch_colour(model, &ray, sample, watch));
    colours.sum::<Rgb>() / f64::from(camera.samples)
}

/// The colour that a ray sees, before it is clamped. Lights with a size are met where `sample` says, or in
/// their middle.
pub fn colour(model: &Model, ray: &Ray, sample: Option<Sample>) -> Rgb {
    watch_colour(model, ray, sample, &mut ())
}

/// As [`colour`], and `watch` sees how it comes about.
pub fn watch_colour(model: &Model, ray: &Ray, sample: Option<Sample>, watch: &mut impl Watch) -> Rgb {
    let mut tracer = Tracer::new(model, Cpu::best(), watch);
    tracer.samples[0] = sample;
    tracer.colours(&mut Group::<NARROW>::primary(ray)).get(0)
}

/// What a ray from the viewer meets first.
pub fn first_hit<'m>(model: &'m Model, ray: &Ray) -> Option<Hit<'m>> {
    let mut nobody = ();
    let mut tracer = Tracer::new(model, Cpu::best(), &mut nobody);
    let mut group = Group::<NARROW>::primary(ray);
    let found = tracer.closest(&mut group, None);
    let object = (found.met[0] as usize).checked_sub(1)?;
    let distance = tracer.settle(&group, &found.near, &found.far, object)[0];
    Some(Hit { index: object, object: &model.objects[object], distance, point: ray.at(distance) })
}

/// Traces packets of rays through a model.
pub(crate) struct Tracer<'m, 'w, W> {
    model: &'m Model,
    plan: &'m Plan,
    cpu: Cpu,
    /// Those of the camera rays under way.
    samples: [Option<Sample>; WIDE],
    /// How many mirrors and panes of glass the present packet has behind it.
    depth: usize,
    /// Room for the way through a tree.
    ahead: Vec<usize>,
    watch: &'w mut W,
}

impl<'m, 'w, W: Watch> Tracer<'m, 'w, W> {
    pub(crate) fn new(model: &'m Model, cpu: Cpu, watch: &'w mut W) -> Self {
        let plan = model.plan();
        Self { model, plan, cpu, samples: [None; WIDE], depth: 0, ahead: Vec::new(), watch }
    }

    /// The colours of some pixels, up to [`WIDE`] rays of which are traced together. `colour` is told of each pixel.
    pub(crate) fn pixels(&mut self, pixels: &[[usize; 2]], mut colour: impl FnMut([usize; 2], Rgb)) {
        let camera = &self.model.camera.value;
        let (mut x, mut y) = ([0.0; WIDE], [0.0; WIDE]);
        if camera.samples == 1 {
            for pixels in pixels.chunks(WIDE) {
                for (lane, [column, row]) in pixels.iter().enumerate() {
                    (x[lane], y[lane]) = (*column as f64, *row as f64);
                }
                let mut group = Group::<WIDE>::through(self.cpu, camera, &mut x, &mut y, pixels.len());
                let colours = self.colours(&mut group);
                for (lane, pixel) in pixels.iter().enumerate() {
                    colour(*pixel, colours.get(lane));
                }
            }
            return;
        }
        let mut rays = pixels.iter().flat_map(|&[x, y]| camera.places(x, y));
        let mut pixels = pixels.iter();
        let (mut sum, mut seen) = (Rgb::ZERO, 0);
        loop {
            let mut len = 0;
            for (place, sample) in rays.by_ref().take(WIDE) {
                (x[len], y[len], self.samples[len]) = (place.x, place.y, sample);
                len += 1;
            }
            if len == 0 {
                return;
            }
            let colours = self.colours(&mut Group::<WIDE>::through(self.cpu, camera, &mut x, &mut y, len));
            for lane in 0..len {
                sum += colours.get(lane);
                seen += 1;
                if seen == camera.samples
                    && let Some(pixel) = pixels.next()
                {
                    colour(*pixel, sum / f64::from(camera.samples));
                    (sum, seen) = (Rgb::ZERO, 0);
                }
            }
        }
    }

    /// The colours that rays from the viewer see.
    fn colours<const N: usize>(&mut self, group: &mut Group<N>) -> Vectors<N> {
        self.watch.count(Count::Rays(Kind::Primary, group.len));
        if W::SEES {
            self.watch.see(Event::Begin(Purpose::Primary));
        }
        self.trace(group)
    }

    /// Whether wide packets may go on.
    fn is_shallow(&self) -> bool {
        self.depth < DEEP
    }

    /// The light that comes back along the rays of a packet.
    fn trace<const N: usize>(&mut self, group: &mut Group<N>) -> Vectors<N> {
        let found = self.closest(group, None);
        if found.met[0] != 0 && found.met[..group.len].iter().all(|met| *met == found.met[0]) {
            let colours = self.shade(group, &found.near, &found.far, found.met[0] as usize - 1);
            if W::SEES {
                self.watch.see(Event::Colour(colours.get(0)));
            }
            return colours;
        }
        let mut colours = Vectors::ZERO;
        let mut parts = Parts::new(&found.met[..group.len]);
        while let Some((id, lanes)) = parts.next() {
            if id == 0 {
                continue;
            }
            let object = id as usize - 1;
            if lanes.len() <= NARROW {
                self.shade_part::<N, NARROW>(group, &found, lanes, object, &mut colours);
            } else {
                self.shade_part::<N, N>(group, &found, lanes, object, &mut colours);
            }
        }
        if W::SEES {
            self.watch.see(Event::Colour(colours.get(0)));
        }
        colours
    }

    /// The colours of those rays of a packet that meet the same object, as a packet of their own.
    fn shade_part<const N: usize, const M: usize>(
        &mut self,
        group: &mut Group<N>,
        found: &Found<N>,
        lanes: &[u8],
        object: usize,
        colours: &mut Vectors<N>,
    ) {
        let mut part = group.pick::<M>(lanes);
        let (near, far) = (group::pick(&found.near, lanes), group::pick(&found.far, lanes));
        let seen = self.shade(&mut part, &near, &far, object);
        for (index, lane) in lanes.iter().enumerate() {
            colours.set(usize::from(*lane), seen.get(index));
            group.budget[usize::from(*lane)] = part.budget[index];
        }
    }
}
