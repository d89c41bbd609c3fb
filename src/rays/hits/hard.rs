//! Rays aimed at the places where methods fail: at outlines, edges, seams and corners, and beside them at ever
//! smaller distances.
//!
//! Places are found from hits alone, without knowing any shape. Between two rays with different hits, a ray passes
//! the border of two things; in a triangle of three such rays lies a corner, where three things meet.

use super::answers::AnswerFormat;
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use rayon::prelude::*;
use serde_json::json;
use std::io::{self, Write};
use tabray_core::geometry::aabb::Aabb;
use tabray_core::output;
use tabray_core::query::{Query, QueryRay};
use tabray_core::render::Renderer;

/// The target of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The outline of an object before another or before nothing: the ray touches a smooth surface there, or meets an
    /// edge.
    Outline,
    /// The line where two objects meet.
    Seam,
    /// An edge between two faces of an object.
    Edge,
    /// A point where three things meet.
    Corner,
}

impl Place {
    /// Returns the name of the place.
    pub fn name(self) -> &'static str {
        match self {
            Self::Outline => "outline",
            Self::Seam => "seam",
            Self::Edge => "edge",
            Self::Corner => "corner",
        }
    }
}

/// A ray that is hard to decide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardRay {
    /// The start.
    pub origin: DVec3,
    /// The direction, not a unit vector.
    pub dir: DVec3,
    /// The target.
    pub place: Place,
    /// Its distance from the place, as a part of the size of the scene's object; 0 for the place itself, up to
    /// rounding.
    pub offset: f64,
}

/// The number of places that are searched for at one time.
const TOGETHER: usize = 256;

/// The number of rays among which three around a corner are looked for.
const ENDS: usize = 8;

/// The number of times that a distance is halved: more than f64 has digits for.
const HALVINGS: usize = 60;

/// The offsets.
const OFFSETS: [f64; 14] =
    [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15];

/// The distance below which three rays show a corner, as a part of the size of their target.
const NEAR: f64 = 1e-12;

/// The number of rounds without any place after which the search ends.
const IN_VAIN: usize = 20;

/// The hit of a ray: the object and the face, or nothing.
type Label = Option<(usize, Option<u32>)>;

/// A point that a ray leads through, and its hit.
type End = (DVec3, Label);

/// Rays from one point to places with different hits.
struct Search {
    origin: DVec3,
    ends: Vec<End>,
    /// The size of the rays' target.
    size: f64,
}

/// Returns `count` hard rays of a scene, the same for any number of threads; fewer where hardly any place is hard.
pub fn rays(renderer: &Renderer, query: &Query, count: usize, seed: u64) -> Vec<HardRay> {
    let boxes = boxes(query);
    let mut random = Random(Pcg64::new(u128::from(seed), 0));
    let (mut rays, mut in_vain) = (Vec::new(), 0);
    while rays.len() < count && in_vain < IN_VAIN {
        let mut searches: Vec<_> = (0..TOGETHER).map(|_| random.search(&boxes)).collect();
        let found: Vec<_> = renderer.run(|| searches.par_iter_mut().map(|of| of.run(query)).collect());
        let before = rays.len();
        for (search, place) in searches.iter().zip(found) {
            if let Some(place) = place {
                rays.extend(random.beside(search, place));
            }
        }
        in_vain = if rays.len() == before { in_vain + 1 } else { 0 };
    }
    rays.truncate(count);
    rays
}

/// Returns the boxes around the objects. The box of an object without bounds is around all others, or around the
/// origin.
fn boxes(query: &Query) -> Vec<Aabb> {
    let bounds = query.model().objects.iter().map(|object| object.shape.facts().bounds);
    let finite = |bounds: &Aabb| (bounds.high - bounds.low).is_finite();
    let bounded: Vec<Aabb> = bounds.clone().flatten().filter(finite).collect();
    let all = bounded.iter().fold(Aabb::EMPTY, |all, bounds| all.and(bounds));
    let around = match bounded[..] {
        [] => Aabb { low: DVec3::splat(-10.0), high: DVec3::splat(10.0) },
        _ => Aabb { low: all.low - all.half_size(), high: all.high + all.half_size() },
    };
    bounds.map(|bounds| bounds.filter(finite).unwrap_or(around)).collect()
}

struct Random(Pcg64);

impl Random {
    /// Returns a number from -1 to 1.
    fn part(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns a point of the ball of radius 1.
    fn in_ball(&mut self) -> DVec3 {
        loop {
            let at = DVec3::new(self.part(), self.part(), self.part());
            if (1e-3..=1.0).contains(&at.length()) {
                return at;
            }
        }
    }

    /// Begins a search at an object.
    fn search(&mut self, boxes: &[Aabb]) -> Search {
        let bounds = &boxes[(self.0.next_u64() % boxes.len() as u64) as usize];
        let (middle, half) = (bounds.middle(), bounds.half_size());
        let size = half.length();
        let origin = middle + (1.5 + 2.0 * self.part().abs()) * size * self.in_ball().normalize();
        // Three of many rays show corners, and two rays show lines.
        let count = if self.part() < 0.0 { 2 } else { ENDS };
        let ends = (0..count).map(|_| (middle + 1.3 * half * self.in_ball(), None)).collect();
        Search { origin, ends, size }
    }

    /// Returns the ray to a place that was found, and rays beside it.
    fn beside(&mut self, search: &Search, place: Place) -> Vec<HardRay> {
        let Search { origin, ends, size } = search;
        let at = ends[0].0;
        let ahead = (at - *origin).normalize();
        let aside = self.in_ball();
        let aside = (aside - aside.dot(ahead) * ahead).normalize_or_zero();
        let offsets = OFFSETS.map(|offset| offset.copysign(self.part()));
        let ray = |offset: f64| {
            let dir = at + offset * size * aside - *origin;
            HardRay { origin: *origin, dir, place, offset }
        };
        [0.0].into_iter().chain(offsets).map(ray).collect()
    }
}

impl Search {
    /// Draws the ends of the rays together, until they are one place up to rounding; `None` where all have the same
    /// hit.
    fn run(&mut self, query: &Query) -> Option<Place> {
        let points: Vec<_> = self.ends.iter().map(|(at, _)| *at).collect();
        let labels = self.labels(query, &points);
        self.ends.iter_mut().zip(labels).for_each(|(end, label)| end.1 = label);
        let mut different: Vec<End> = Vec::new();
        for end in &self.ends {
            if different.len() < 3 && different.iter().all(|other| other.1 != end.1) {
                different.push(*end);
            }
        }
        if different.len() == 3 {
            self.ends = different.clone();
            if self.corner(query) {
                return Some(Place::Corner);
            }
        }
        different.truncate(2);
        let [inner, outer] = different[..] else { return None };
        self.ends = self.border(query, inner, outer, 0.0).to_vec();
        Some(self.between(query))
    }

    /// Returns the hits of the rays through some points.
    fn labels(&self, query: &Query, points: &[DVec3]) -> Vec<Label> {
        let ray = |at: &DVec3| QueryRay::new(self.origin, *at - self.origin);
        let rays: Option<Vec<_>> = points.iter().map(ray).collect();
        let Some(rays) = rays else { return vec![None; points.len()] };
        let label = |(ray, answer): (&QueryRay, _)| {
            let surface = query.surroundings(ray, &answer)?;
            Some((answer.object?, surface.face))
        };
        rays.iter().zip(query.traced(&rays)).map(label).collect()
    }

    /// Follows the border of the first thing from the second thing to the third. Tells whether that leads to one
    /// place.
    fn corner(&mut self, query: &Query) -> bool {
        let [inner, b, c] = self.ends[..] else { return false };
        let [mut one, mut other] = [b, c].map(|outer| self.border(query, inner, outer, 0.0)[1]);
        for _ in 0..HALVINGS {
            let (middle, gap) = (0.5 * (one.0 + other.0), (one.0 - other.0).length());
            if one.1 == other.1 || middle == one.0 || middle == other.0 {
                break;
            }
            // The border is near, but may bulge.
            let ahead = gap * (middle - inner.0).normalize();
            let tried = [middle - 2.0 * ahead, middle, middle + ahead, middle + 4.0 * ahead];
            let labels = self.labels(query, &tried);
            let mut ends = tried.into_iter().zip(labels);
            let near = ends.next().filter(|end| end.1 == inner.1 && 2.0 * gap < (middle - inner.0).length());
            let Some(outside) = ends.find(|end| end.1 != inner.1) else { return false };
            let [_, at] = self.border(query, near.unwrap_or(inner), outside, 0.05 * gap);
            if at.1 == one.1 { one = at } else { other = at }
        }
        self.ends = vec![one, other];
        one.1 != other.1 && (one.0 - other.0).length() < NEAR * self.size
    }

    /// Halves the distance between two rays with different hits, until it is at most `width` world units or cannot be
    /// halved.
    fn border(&self, query: &Query, inner: End, outer: End, width: f64) -> [End; 2] {
        let [mut inner, mut outer] = [inner, outer];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inner.0 + outer.0);
            if middle == inner.0 || middle == outer.0 || (outer.0 - inner.0).length() <= width {
                break;
            }
            let label = self.labels(query, &[middle])[0];
            // A third thing in between is another border.
            if label == inner.1 { inner = (middle, label) } else { outer = (middle, label) }
        }
        [inner, outer]
    }

    /// Returns the kind of the place between two rays.
    fn between(&self, query: &Query) -> Place {
        let ray = |at: DVec3| QueryRay::new(self.origin, at - self.origin);
        let rays: Vec<_> = self.ends.iter().filter_map(|(at, _)| ray(*at)).collect();
        let answers = query.traced(&rays);
        let [one, other] = &answers[..] else { return Place::Outline };
        let (Some(first), Some(second)) = (one.object, other.object) else { return Place::Outline };
        // One side of an outline is farther away than the other.
        match (one.distance - other.distance).abs() > 1e-6 * self.size {
            true => Place::Outline,
            false if first == second => Place::Edge,
            false => Place::Seam,
        }
    }
}

/// Writes rays, as [`RayReader`](super::rays::RayReader) reads them.
///
/// # Errors
/// Returns the errors of `out`.
pub fn write(format: AnswerFormat, rays: &[HardRay], out: &mut dyn Write) -> io::Result<()> {
    match format {
        AnswerFormat::JsonLines => {
            for HardRay { origin, dir, place, offset } in rays {
                let (origin, direction, place) = (origin.to_array(), dir.to_array(), place.name());
                let ray =
                    json!({ "origin": origin, "direction": direction, "place": place, "offset": offset });
                writeln!(out, "{ray}")?;
            }
        }
        AnswerFormat::Csv => {
            writeln!(out, "ox,oy,oz,dx,dy,dz,place,offset")?;
            for HardRay { origin, dir, place, offset } in rays {
                let [[ox, oy, oz], [dx, dy, dz]] = [origin.to_array(), dir.to_array()];
                writeln!(out, "{ox},{oy},{oz},{dx},{dy},{dz},{},{offset:e}", place.name())?;
            }
        }
        AnswerFormat::Npy => {
            output::npy::begin("'<f8'", &format!("({}, 6)", rays.len()), out)?;
            for HardRay { origin, dir, .. } in rays {
                let numbers = [origin.to_array(), dir.to_array()];
                for number in numbers.as_flattened() {
                    out.write_all(&number.to_le_bytes())?;
                }
            }
        }
    }
    Ok(())
}
