//! Mistakes about a picture as a whole: it is flipped or shifted, or its levels are those of another curve.

use super::compared::{Compared, apart, levels};
use glam::DVec3;
use glam::Vec3Swizzles;
use rayon::prelude::*;
use std::iter;
use tabray_core::geometry::sight::Sight;
use tabray_core::render::Renderer;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::world::display::Transfer;
use tabray_core::world::material::Rgb;

/// How levels follow from light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Curve {
    /// The scene's own curve.
    #[default]
    Right,
    /// The curve of sRGB, applied once more.
    Encoded,
    /// The inverse curve of sRGB, applied once more.
    Decoded,
    /// To the power of 1 / 2.2.
    Brightened,
    /// To the power of 2.2.
    Darkened,
    /// Red and blue exchanged.
    Swapped,
}

/// A change of a picture as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct View {
    /// Whether the columns, and whether the rows, are reversed.
    pub flipped: [bool; 2],
    /// The shift to the right and up, in halves of a pixel.
    pub shift: [i32; 2],
    /// The curve of its levels.
    pub curve: Curve,
}

/// The largest shift that is tried, in pixels.
const FARTHEST: i32 = 3;

/// The number of pixels in the first test of a view.
const TRIED: usize = 4096;

impl Curve {
    const OTHERS: [Self; 5] = [Self::Encoded, Self::Decoded, Self::Brightened, Self::Darkened, Self::Swapped];

    fn apply(self, shown: DVec3) -> DVec3 {
        match self {
            Self::Right => shown,
            Self::Encoded => shown.map(|channel| Transfer::Srgb.encode(channel)),
            Self::Decoded => shown.map(|channel| Transfer::Srgb.decode(channel)),
            Self::Brightened => shown.map(|channel| libm::pow(channel, 1.0 / 2.2)),
            Self::Darkened => shown.map(|channel| libm::pow(channel, 2.2)),
            Self::Swapped => shown.zyx(),
        }
    }
}

impl View {
    /// Returns the views that are tried, except the right one.
    fn others(is_sampled: bool) -> impl Iterator<Item = Self> {
        let flips = [[true, false], [false, true], [true, true]];
        let flips = flips.into_iter().map(|flipped| Self { flipped, ..Self::default() });
        let curves = Curve::OTHERS.into_iter().map(|curve| Self { curve, ..Self::default() });
        // Shifts by halves must be rendered, which only works with one sample.
        let halves = move |part: &i32| part % 2 == 0 || (!is_sampled && part.abs() == 1);
        let steps = move || (-2 * FARTHEST..=2 * FARTHEST).filter(halves);
        let shifts = steps().flat_map(move |right| steps().map(move |up| [right, up]));
        let shifts = shifts.filter(|shift| *shift != [0, 0]).map(|shift| Self { shift, ..Self::default() });
        flips.chain(curves).chain(shifts)
    }

    /// Returns the view that explains most of the pixels that differ, if it explains more than half of them and few
    /// others speak against it; else the right one.
    pub(super) fn best(renderer: &Renderer, compared: &Compared, different: &[[usize; 2]]) -> Self {
        if different.is_empty() {
            return Self::default();
        }
        let is_same = |at: &[usize; 2]| apart(compared.theirs(*at), compared.right(*at)) <= 1;
        let same: Vec<_> = compared.places().filter(is_same).collect();
        // Beyond the edge of the image, nothing is known.
        let matches = |view: Self, places: &[[usize; 2]], if_beyond: bool| {
            let step = places.len().div_ceil(TRIED).max(1);
            let tried: Vec<_> = places.iter().step_by(step).collect();
            let is_seen = |at: &&&[usize; 2]| {
                let bytes = view.bytes(compared, ***at);
                bytes.map_or(if_beyond, |bytes| apart(bytes, compared.theirs(***at)) <= 1)
            };
            let seen = tried.iter().filter(is_seen).count();
            seen as f64 / tried.len().max(1) as f64
        };
        let gain = |view: Self| {
            let explained = matches(view, different, false) * different.len() as f64;
            let against =
                if same.is_empty() { 0.0 } else { (1.0 - matches(view, &same, true)) * same.len() as f64 };
            explained - against
        };
        let views: Vec<_> = Self::others(compared.plan.camera.samples > 1).collect();
        let gains: Vec<f64> = renderer.run(|| views.par_iter().map(|view| gain(*view)).collect());
        let none = (Self::default(), 0.5 * different.len() as f64);
        iter::zip(views, gains).fold(none, |best, other| if other.1 > best.1 { other } else { best }).0
    }

    /// Returns the bytes of the picture at a pixel in this view; `None` beyond the edge of the image.
    pub(super) fn bytes(&self, compared: &Compared, at: [usize; 2]) -> Option<[u8; 3]> {
        if self.curve == Curve::Right
            && self.shift.iter().all(|part| part % 2 == 0)
            && let [Some(x), Some(y)] = [0, 1].map(|axis| self.whole(compared, at, axis))
        {
            return Some(compared.right([x, y]));
        }
        self.light(compared.plan, at).map(|light| self.shown(compared, light))
    }

    /// Returns the column or the row of the right image that is seen at a pixel, where shifts are whole pixels.
    fn whole(&self, compared: &Compared, at: [usize; 2], axis: usize) -> Option<usize> {
        let size = compared.size[axis];
        let own = if self.flipped[axis] { size - 1 - at[axis] } else { at[axis] };
        own.checked_add_signed(-(self.shift[axis] / 2) as isize).filter(|own| *own < size)
    }

    /// Returns the position of a pixel's centre in the right image, in pixels; `None` beyond its edge.
    fn place(&self, plan: &Plan, at: [usize; 2]) -> Option<[f64; 2]> {
        let size = plan.camera.pixels;
        let place = [0, 1].map(|axis| {
            let own = if self.flipped[axis] { size[axis] - 1 - at[axis] } else { at[axis] };
            own as f64 - 0.5 * f64::from(self.shift[axis])
        });
        let is_there = |axis: usize| (-0.5..size[axis] as f64).contains(&place[axis]);
        (is_there(0) && is_there(1)).then_some(place)
    }

    /// Returns the line of sight through a pixel's centre; `None` beyond the edge of the image.
    pub(super) fn sight(&self, plan: &Plan, at: [usize; 2]) -> Option<Sight> {
        self.place(plan, at).map(|[x, y]| plan.camera.sight(x, y))
    }

    /// Returns the light of a plan of the scene that is seen at a pixel; `None` beyond the edge of the image.
    pub(super) fn light(&self, plan: &Plan, at: [usize; 2]) -> Option<Rgb> {
        let [x, y] = self.place(plan, at)?;
        Some(match self.shift.iter().all(|part| part % 2 == 0) {
            true => trace::pixel(plan, x as usize, y as usize),
            false => trace::colour(plan, &plan.camera.sight(x, y), None),
        })
    }

    /// Returns the bytes with which the picture shows light in this view.
    pub(super) fn shown(&self, compared: &Compared, light: Rgb) -> [u8; 3] {
        match self.curve {
            Curve::Right => compared.display.bytes(light),
            curve => levels(curve.apply(compared.display.shown(light))),
        }
    }

    /// Returns the kind of mistake.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self { flipped: [false, false], shift: [0, 0], curve: Curve::Swapped } => "channels",
            Self { flipped: [false, false], shift: [0, 0], .. } => "gamma",
            Self { flipped: [false, false], .. } => "shifted",
            _ => "flipped",
        }
    }

    /// Describes the view, in words that complete "the picture".
    pub(super) fn words(&self) -> String {
        let pixels = |part: i32| match part.abs() {
            1 => "half a pixel".to_owned(),
            2 => "1 pixel".to_owned(),
            halves => format!("{} pixels", halves / 2),
        };
        let [right, up] = self.shift;
        let sides = [
            (right, if right > 0 { "to the right" } else { "to the left" }),
            (up, if up > 0 { "up" } else { "down" }),
        ];
        let sides = sides.iter().filter(|(part, _)| *part != 0);
        let shifts: Vec<_> = sides.map(|(part, side)| format!("{} {side}", pixels(*part))).collect();
        match (self.flipped, self.curve) {
            ([true, true], _) => "is rotated by 180 degrees".to_owned(),
            ([true, false], _) => "is flipped, left to right".to_owned(),
            ([false, true], _) => "is flipped, top to bottom".to_owned(),
            (_, Curve::Right) => format!("is shifted by {}", shifts.join(" and ")),
            (_, Curve::Encoded) => "has the curve of sRGB once too often".to_owned(),
            (_, Curve::Decoded) => "lacks the curve of sRGB, or has it undone".to_owned(),
            (_, Curve::Brightened) => "is brightened by a gamma of 2.2".to_owned(),
            (_, Curve::Darkened) => "is darkened by a gamma of 2.2".to_owned(),
            (_, Curve::Swapped) => "has red and blue exchanged".to_owned(),
        }
    }
}
