//! The lines of an image as curves: outlines, creases and level lines of what is seen, and the labels of objects.
//!
//! Rays through the corners of all pixels tell between which corners a line passes, and more rays where it does. Only
//! first hits are compared, so hidden lines do not appear.

use crate::overlay::curves::curves;
use crate::overlay::regions::{BEHIND, Pixel, beside, corners, sides};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;
use tabray_core::parallel;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::world::body::Label;
use tabray_core::world::camera::Projected;
use tabray_core::world::surface_point::SurfacePoint;

mod curves;
mod regions;

/// A curve through points of the image, in pixels from its upper left corner.
pub type Curve = Vec<DVec2>;

/// The lines of an image, and its labels.
pub struct Overlay {
    /// Where another object begins, or another part of the same one, and where a surface bends sharply.
    pub outlines: Vec<Curve>,
    /// The level lines of surfaces.
    pub levels: Vec<Curve>,
    /// The labels that are not hidden.
    pub labels: Vec<Text>,
}

/// A label in the image.
#[derive(Debug)]
pub struct Text {
    /// The text.
    pub text: String,
    /// Its middle, in pixels from the upper left corner of the image.
    pub at: DVec2,
    /// The height of its digits in pixels.
    pub height: f64,
}

/// The side of a pixel, by its column, its row and its direction: 0 along a row, 1 along a column; or a part of a pixel
/// ([`regions`]).
type Key = [usize; 3];

/// How often a side of a pixel is halved toward a line, which is then known to within 1/128 of a pixel. That tells two
/// objects apart. Whether an object hides a part of itself is open until its points are as close as [`CERTAIN`] means:
/// 1/65536 of a pixel.
const HALVINGS: u32 = 6;
const MOST_HALVINGS: u32 = 16;

/// After so many halvings, the deepest of the equal parts has at least so much of a rift. A surface that is only steep
/// has the same in each, an eighth.
const STEEP: (u32, f64) = (3, 0.2);

/// How far from an outline the ends of level lines are looked for, as a part of the way to the pixel's corner: where an
/// outline bends, the straight line between its places may be outside it.
const INSET: f64 = 0.1;

/// Neighbouring corners that see points farther apart than so many pixels, or normals that differ by so much, may be on
/// either side of a line; and the same of points as close as the last halving has them, between which it passes.
const SUSPECT: Rift = Rift { gap: 3.0, turn: 0.25 };
const CERTAIN: Rift = Rift { gap: 0.05, turn: 0.15 };

/// The rows that are looked at together, and the rays that one thread traces together: few, as those near outlines take
/// longest.
const ROWS: usize = 16;
const TOGETHER: usize = 32;

struct Rift {
    /// In pixels.
    gap: f64,
    turn: f64,
}

impl Rift {
    /// Returns how deep the rift between two places is, in the unit of this one; a pixel is as wide as `pixel` there.
    fn between(&self, [one, other]: [&Option<Seen>; 2], pixel: f64) -> f64 {
        match (one, other) {
            (None, None) => 0.0,
            (Some(one), Some(other)) if one.object == other.object => {
                let gap = one.at.distance(other.at) / (self.gap * pixel);
                gap.max(one.normal.distance(other.normal) / self.turn)
            }
            _ => f64::INFINITY,
        }
    }
}

/// What is seen at a place of the image.
#[derive(Clone, Copy)]
struct Seen {
    object: usize,
    at: DVec3,
    normal: DVec3,
    level: f64,
    distance: f64,
}

/// A side of a pixel, and what is seen at both of its ends.
#[derive(Clone)]
struct Side {
    key: Key,
    ends: [DVec2; 2],
    seen: [Option<Seen>; 2],
    /// The width of a pixel at the nearer end, in world units.
    pixel: f64,
}

impl Side {
    fn seen(&self) -> [&Option<Seen>; 2] {
        self.seen.each_ref()
    }

    /// Tells whether both ends show one object, or both none.
    fn is_of_one(&self) -> bool {
        let [one, other] = self.seen.map(|seen| seen.map(|seen| seen.object));
        one == other
    }

    /// Tells whether both ends show one object, on either side of a level line.
    fn spans_levels(&self) -> bool {
        let [one, other] = self.seen.map(|seen| seen.map(|seen| seen.level));
        self.is_of_one() && one != other
    }

    /// Returns the parts before and behind a place of an outline, given this side with its ends moved toward it.
    fn parts(&self, cut: &Self) -> [Self; 2] {
        let [column, row, along] = self.key;
        let part = |end: usize, key: Key| {
            let mut part = Self { key, ..self.clone() };
            (part.ends[1 - end], part.seen[1 - end]) = (cut.ends[end], cut.seen[end]);
            part
        };
        [part(0, self.key), part(1, [column, row, along + BEHIND])]
    }

    fn place(&self) -> (Key, DVec2) {
        (self.key, 0.5 * (self.ends[0] + self.ends[1]))
    }
}

impl Overlay {
    /// Finds the lines of a part of an image. `proceed` is called before each of its rows, in order, and may stop the
    /// search.
    ///
    /// # Errors
    /// If `proceed` stops it.
    pub fn of<E>(
        plan: &Plan,
        columns: Range<usize>,
        rows: Range<usize>,
        mut proceed: impl FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        let looks = Looks { plan, numbers: plan.model.numbers() };
        let corner = |column: usize, row: usize| DVec2::new(column as f64, row as f64);
        let across = |row: usize| (columns.start..=columns.end).map(move |column| corner(column, row));
        let (mut outlines, mut levels) = (BTreeMap::new(), BTreeMap::new());
        let mut last = looks.at(&across(rows.start).collect::<Vec<_>>());
        for first in rows.clone().step_by(ROWS) {
            let band = first..rows.end.min(first + ROWS);
            band.clone().try_for_each(|_| proceed())?;
            let places: Vec<_> = band.clone().flat_map(|row| across(row + 1)).collect();
            let mut seen = last.clone();
            seen.extend(looks.at(&places));
            let (mut suspects, mut spans) = (Vec::new(), Vec::new());
            let width = columns.len() + 1;
            for (index, one) in seen.iter().enumerate() {
                let (column, row) = (columns.start + index % width, first + index / width);
                let next = [(column < columns.end).then_some(index + 1), Some(index + width)];
                for (along, next) in next.into_iter().enumerate() {
                    // A band's last row is the first of the next one.
                    let is_again = along == 0 && row == first && first > rows.start;
                    let Some(other) = next.filter(|_| !is_again).and_then(|next| seen.get(next)) else {
                        continue;
                    };
                    let key = [column, row, along];
                    let ends = corners(key);
                    let nearest = [one, other]
                        .into_iter()
                        .flatten()
                        .map(|seen| seen.distance)
                        .fold(f64::INFINITY, f64::min);
                    if nearest == f64::INFINITY {
                        continue;
                    }
                    let pixel = looks.width(ends, nearest);
                    let side = Side { key, ends, seen: [*one, *other], pixel };
                    if SUSPECT.between(side.seen(), pixel) >= 1.0 {
                        suspects.push(side);
                    } else if side.spans_levels() {
                        spans.push(side);
                    }
                }
            }
            last = seen.split_off(seen.len() - width);
            let cuts = looks.outlines(&suspects);
            let whole = suspects.into_iter().flat_map(|side| match cuts.get(&side.key) {
                Some(cut) => side.parts(cut).to_vec(),
                None => vec![side],
            });
            spans.extend(whole.filter(Side::spans_levels));
            outlines.extend(cuts);
            levels.extend(looks.levels(spans));
        }
        let lines = beside(outlines.keys().chain(levels.keys()));
        let pixels: Vec<_> = lines.into_iter().map(|at| Pixel::new(at, &outlines)).collect();
        let along = pixels.iter().flat_map(|pixel| &pixel.along_outlines);
        let along = looks.again(along.filter(|side| side.spans_levels()).cloned().collect());
        levels.extend(looks.levels(along));
        let regions = pixels.into_iter().flat_map(|pixel| pixel.regions);
        let places: BTreeMap<_, _> = outlines.values().map(Side::place).collect();
        let around = beside(places.keys()).into_iter().map(|at| sides(at).to_vec());
        Ok(Self {
            outlines: curves(&places, around),
            levels: curves(&levels, regions),
            labels: looks.labels(),
        })
    }
}

/// A scene, as places of the image show it.
struct Looks<'p> {
    plan: &'p Plan<'p>,
    numbers: Vec<usize>,
}

impl Looks<'_> {
    /// Maps a place to the camera's pixels: right and up from the centre of the lower left one.
    fn camera_place(&self, at: DVec2) -> DVec2 {
        DVec2::new(at.x - 0.5, self.plan.camera.pixels[1] as f64 - 0.5 - at.y)
    }

    /// Returns what is seen at places.
    fn at(&self, places: &[DVec2]) -> Vec<Option<Seen>> {
        let parts: Vec<_> = places.chunks(TOGETHER).collect();
        let looked = |part: usize| {
            let at = parts[part].iter().map(|at| self.camera_place(*at));
            let sights: Vec<_> = at.map(|at| self.plan.camera.sight(at.x, at.y)).collect();
            let hits = trace::first_hits(self.plan, &sights, true).into_iter();
            let seen = hits.map(|hit| {
                let hit = hit?;
                let normal = hit.object.shape.normal(hit.point);
                Some(Seen {
                    object: self.numbers[hit.index],
                    at: hit.point,
                    normal: hit.object.shape.shading_normal(hit.point, normal),
                    level: hit.object.shader.level(&SurfacePoint::at(hit.point)),
                    distance: hit.distance,
                })
            });
            seen.collect::<Vec<_>>()
        };
        parallel::map(parts.len(), looked).concat()
    }

    /// Returns the distance of two rays at a distance from the viewer, in world units.
    fn width(&self, ends: [DVec2; 2], distance: f64) -> f64 {
        let [one, other] = ends.map(|at| {
            let at = self.camera_place(at);
            self.plan.camera.ray(at.x, at.y).at(distance)
        });
        one.distance(other)
    }

    /// Finds the places of outlines on sides that one may pass, as sides whose ends are on either side of it.
    fn outlines(&self, suspects: &[Side]) -> BTreeMap<Key, Side> {
        let depth = |side: &Side| SUSPECT.between(side.seen(), side.pixel);
        let (mut sides, mut found) = (suspects.to_vec(), BTreeMap::new());
        for count in 1..=MOST_HALVINGS {
            self.halve(&mut sides, |side, middle| {
                let [one, other] = side.seen();
                let depth = |ends| SUSPECT.between(ends, side.pixel);
                depth([one, middle]) >= depth([middle, other])
            });
            if count == STEEP.0 {
                let parts = sides.into_iter().zip(suspects);
                let deep = parts.filter(|(part, whole)| depth(part) >= STEEP.1 * depth(whole));
                sides = deep.map(|(part, _)| part).collect();
            }
            if count == HALVINGS || count == MOST_HALVINGS {
                sides.retain(|side| CERTAIN.between(side.seen(), side.pixel) >= 1.0);
                let is_open = |side: &Side| side.is_of_one() && count < MOST_HALVINGS;
                let (open, sure) = sides.into_iter().partition(is_open);
                sides = open;
                found.extend(Vec::into_iter(sure).map(|side| (side.key, side)));
            }
        }
        found
    }

    /// Finds the places of level lines on sides that span them.
    fn levels(&self, mut sides: Vec<Side>) -> Vec<(Key, DVec2)> {
        let level = |seen: &Option<Seen>| seen.map(|seen| (seen.object, seen.level));
        for _ in 0..HALVINGS {
            self.halve(&mut sides, |side, middle| level(middle) != level(side.seen()[0]));
        }
        sides.iter().map(Side::place).collect()
    }

    /// Looks at the ends of lines again, and leaves out those that do not span levels.
    fn again(&self, mut sides: Vec<Side>) -> Vec<Side> {
        let seen = self.at(&sides.iter().flat_map(|side| side.ends).collect::<Vec<_>>());
        for (side, seen) in sides.iter_mut().zip(seen.chunks(2)) {
            side.seen = [seen[0], seen[1]];
        }
        sides.retain(Side::spans_levels);
        sides
    }

    /// Halves sides. `is_first` tells whether the line is in the first half, given what the middle shows.
    fn halve(&self, sides: &mut [Side], is_first: impl Fn(&Side, &Option<Seen>) -> bool) {
        let middles: Vec<_> = sides.iter().map(|side| side.place().1).collect();
        for ((side, middle), seen) in sides.iter_mut().zip(&middles).zip(self.at(&middles)) {
            let end = usize::from(is_first(side, &seen));
            (side.ends[end], side.seen[end]) = (*middle, seen);
        }
    }

    /// Returns the labels whose middle nothing hides but their own object.
    fn labels(&self) -> Vec<Text> {
        let model = self.plan.model;
        let project = |at: DVec3| match self.plan.camera.project(at) {
            Projected::At(at) => {
                Some(DVec2::new(at.x + 0.5, model.camera.value.pixels[1] as f64 - 0.5 - at.y))
            }
            _ => None,
        };
        let label = |(order, label): &(usize, Label)| {
            let at = project(label.at)?;
            let height = project(label.at + 0.5 * label.up)?.distance(project(label.at - 0.5 * label.up)?);
            let seen = self.at(&[at])[0];
            let place = self.camera_place(at);
            let is_hidden = seen.is_some_and(|seen| {
                let own = model.objects.iter().position(|object| object.args.order() == *order);
                let away = self.plan.camera.ray(place.x, place.y).origin.distance(label.at);
                own.map(|own| self.numbers[own]) != Some(seen.object) && seen.distance < away
            });
            (!is_hidden).then(|| Text { text: label.text.clone(), at, height })
        };
        model.labels.iter().filter_map(label).collect()
    }
}
