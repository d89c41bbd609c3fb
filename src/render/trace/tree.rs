//! The trees of rays under the free rules: each is followed heaviest branch first, until its rest cannot be seen.
//!
//! A pixel's colour is the sum of the light that the points on its rays' paths send by themselves, each times the
//! weight of its path. The rays that are yet to be followed are *open*. Their weights and the light in the scene
//! ([`LightRange`]) bound what they can still add, and so the colour. A tree ends when these bounds, as the image
//! shows them, are less than [`ENDED`] of a level apart, or when it has used up its budget; the middle of the bounds
//! stands for the rest. If a tree that costs too much is open by more than a level, the light found so far is shown,
//! and the pixel is counted. A pixel with several samples shows the mean of their middles, and is counted if its
//! bounds are more than a level apart.
//!
//! The trees of a packet of primary rays grow together, in rounds, so rays are still traced in packets: in each
//! wave, every tree gives its heaviest open ray, and those at least half as heavy. The rules of a tree look at the
//! tree alone, and the results of a wave are added in the order in which its rays were given, so no colour depends
//! on the packet.
//!
//! Under the notes' rules, branches end as the [depth](crate::plan::depth) describes. There each branch has
//! an allowance of its own, fixed by its path, and is followed as soon as it is met, so the course's pictures do not
//! change.

use super::scatter::CountedLight;
use super::wave::Outcome;
use crate::limits::{MAX_TREE, MIN_PART, of_pixel};
use crate::observer::{DropReason, RayKind};
use crate::plan::depth::{Depth, LightRange};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::mem::take;
use tabray_world::display::Display;
use tabray_world::geometry::ray::Side;
use tabray_world::material::Rgb;
use tabray_world::sensor::Sensor;

/// The distance of the bounds of a colour, in levels of a byte, below which its tree ends.
const ENDED: f64 = 1.0 / 16.0;

/// The distance of the bounds of a colour, in levels, up to which their middle stands for it where the tree costs too
/// much.
pub(super) const SHOWN: f64 = 1.0;

/// A lower limit on the slope of the display curve below white: that of sRGB is 0.44 there, a linear one is steeper.
const FLATTEST: f64 = 0.4;

/// Open rays with at least this part of the heaviest one's weight are followed in the same wave.
const TOGETHER: f64 = 0.5;

/// A ray that is yet to be followed.
#[derive(Clone, Copy)]
pub(super) struct OpenRay {
    /// The uncertainty of the light that it can still add: the largest of the channels.
    pub width: f64,
    /// The factor of its light.
    pub weight: Rgb,
    pub origin: DVec3,
    pub dir: DVec3,
    /// The path length from the viewer to the origin, in world units.
    pub travelled: f64,
    /// A bound on the error of the origin, in world units.
    pub error: f64,
    /// The index of the object that it leaves.
    pub object: u32,
    /// The side of it that it leaves.
    pub side: Side,
    pub kind: RayKind,
    /// The lane of its primary ray.
    pub camera: u8,
    /// The number of rays before it on its path.
    pub depth: u32,
    /// Whether its sample shows patches of surfaces: nothing on its path has spread or gathered rays.
    pub shows_patches: bool,
    /// The number of matt surfaces on its path that it has left.
    pub bounces: u32,
    /// The light that counts where it ends.
    pub counted: CountedLight,
    /// The density of its direction, per unit of solid angle, if lamps are also met by aim from where it starts;
    /// infinite otherwise.
    pub density: f64,
    /// The index of the object where its direction was chosen, from where it has come unbent, and the distance from there
    /// to its origin, in world units.
    pub chosen: u32,
    pub since: f64,
    /// The part of the sample that it shows past all objects, where the image has alpha; otherwise only that of a primary
    /// ray is not 0.
    pub clear: f64,
}

impl OpenRay {
    /// Returns the range of light that it can add.
    fn range(&self, depth: &Depth) -> LightRange {
        let side = usize::from(self.side == Side::Inside);
        let range = match (self.kind, self.counted) {
            (RayKind::Scattered, _) => depth.scattered[self.bounces as usize - 1],
            (_, CountedLight::All) if self.density == f64::INFINITY => {
                depth.ranges[self.object as usize][side]
            }
            (_, _) => depth.ranges[self.object as usize][side].down_to_black(),
        };
        // A background that it shows past all objects does not count.
        let LightRange { low, high } = if self.clear == 0.0 { range } else { range.down_to_black() };
        let [one, other] = [low, high].map(|light| times(self.weight, light));
        LightRange { low: one.min(other), high: one.max(other) }
    }
}

impl OpenRay {
    /// Returns a placeholder for a primary ray of the first wave: only its lane matters.
    pub fn primary(camera: usize) -> Self {
        Self {
            width: f64::INFINITY,
            weight: Rgb::ONE,
            origin: DVec3::ZERO,
            dir: DVec3::NEG_Z,
            travelled: 0.0,
            error: 0.0,
            object: 0,
            side: Side::Outside,
            kind: RayKind::Primary,
            camera: camera as u8,
            depth: 0,
            shows_patches: true,
            bounces: 0,
            counted: CountedLight::All,
            density: f64::INFINITY,
            chosen: 0,
            since: 0.0,
            clear: 1.0,
        }
    }
}

/// Multiplies a weight by an amount of light, which may be infinite.
fn times(weight: Rgb, light: Rgb) -> Rgb {
    let gain = |channel: usize| if weight[channel] == 0.0 { 0.0 } else { weight[channel] * light[channel] };
    Rgb::new(gain(0), gain(1), gain(2))
}

/// Orders by uncertainty, and rays of the same uncertainty by weight.
impl Ord for OpenRay {
    fn cmp(&self, other: &Self) -> Ordering {
        let weight = |ray: &Self| ray.weight.abs().max_element();
        self.width.total_cmp(&other.width).then(weight(self).total_cmp(&weight(other)))
    }
}

impl PartialOrd for OpenRay {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for OpenRay {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for OpenRay {}

/// The tree of one primary ray.
#[derive(Default)]
pub(super) struct Tree {
    /// The sum of the light found so far.
    found: Rgb,
    open: BinaryHeap<OpenRay>,
    /// The range of light that bounded open rays, and rays too faint to be kept, can add.
    left: LightRange,
    /// The part of the sample that is clear as far as open rays may show.
    clear: f64,
    /// The number of open rays that nothing bounds.
    unbounded: u32,
    /// The number of rays that were followed, and the work that they took.
    rays: u32,
    pub work: u32,
    budget: Budget,
}

/// How a tree has ended.
pub(super) struct End {
    pub colour: Rgb,
    /// The distance of the colour's bounds, in levels: 0 for a known colour, infinite without bounds.
    pub apart: f64,
}

/// The limits of a tree.
#[derive(Clone, Copy, Default)]
pub(super) struct Budget {
    /// The number of rays that may be followed.
    pub rays: u32,
    /// The work, in simple rays, shadow rays included.
    pub work: u32,
}

/// The conditions under which the trees of a camera's rays end.
pub(super) struct Ends {
    display: Display,
    /// Whether a pixel is the mean of several samples.
    is_averaged: bool,
    /// The limits of the tree of one sample.
    pub budget: Budget,
    /// The light up to which a ray is not kept: so little that all such rays of a tree together make no difference.
    faint: f64,
}

impl Ends {
    pub fn of(camera: &Sensor) -> Self {
        let (display, parts) = (camera.display(), camera.samples.min(MIN_PART));
        let [rays, work] = of_pixel(camera.bounces).map(|most| most / parts);
        Self {
            is_averaged: !camera.is_single(),
            budget: Budget { rays, work },
            faint: ENDED / (16.0 * f64::from(MAX_TREE) * 255.0 * display.steepest()),
            display,
        }
    }

    /// Returns the distance of two colours, in levels of a byte, as an image shows them: the largest of the channels.
    /// Where samples are averaged, light above white counts, too, with the least slope below white.
    fn levels_apart(&self, [low, high]: [Rgb; 2]) -> f64 {
        let [least, most] = self.display.shown_within([low, high]);
        let above_white =
            if self.is_averaged { FLATTEST * self.display.gain() * (high - low) } else { Rgb::ZERO };
        255.0 * (most - least).max(above_white).max_element()
    }

    /// Tells whether the bounds of a colour are less than [`ENDED`] apart.
    fn are_met(&self, [low, high]: [Rgb; 2]) -> bool {
        let gain = self.display.gain();
        // The shown colours take long to compute. They cannot be near enough unless the light is, or is clipped.
        let may_be = |channel: usize| {
            let apart = 255.0 * FLATTEST * gain * (high[channel] - low[channel]);
            apart < ENDED || gain * low[channel] >= 1.0
        };
        (0..3).all(may_be) && (self.are_known([low, high]) || self.levels_apart([low, high]) < ENDED)
    }

    /// Tells, without computing shown colours, that the bounds of a colour are less than [`ENDED`] apart, where that is
    /// plain.
    fn are_known(&self, [low, high]: [Rgb; 2]) -> bool {
        let above_white = 255.0 * FLATTEST * self.display.gain() * (high - low).max_element();
        (!self.is_averaged || above_white < ENDED) && self.display.are_within([low, high], ENDED / 255.0)
    }
}

impl Tree {
    /// Starts with nothing found.
    pub fn begin(&mut self, budget: Budget) {
        self.open.clear();
        *self = Self { budget, open: take(&mut self.open), ..Self::default() };
    }

    /// Adds what was found at the hit of one of its rays, and the rays that continue from there.
    pub fn add(&mut self, outcome: &Outcome, onward: &[OpenRay], depth: &Depth, ends: &Ends) {
        self.found += outcome.light;
        self.work += outcome.cost;
        onward.iter().for_each(|ray| self.push(*ray, depth, ends));
    }

    /// Adds an open ray. One that is too faint is not followed.
    fn push(&mut self, mut ray: OpenRay, depth: &Depth, ends: &Ends) {
        let LightRange { low, high } = ray.range(depth);
        ray.width = (high - low).max_element().max(ray.clear);
        if !ray.width.is_finite() {
            ray.width = f64::INFINITY;
            self.unbounded += 1;
        } else {
            self.left.low += low;
            self.left.high += high;
            if ray.width <= ends.faint {
                return;
            }
        }
        self.clear += ray.clear;
        self.open.push(ray);
    }

    /// Takes the rays that are followed next, unless the tree has ended.
    pub fn next(&mut self, ends: &Ends, depth: &Depth, wave: &mut Vec<OpenRay>) {
        let is_met = |bounds| ends.are_met(bounds) && 255.0 * self.clear < ENDED;
        if self.is_over() || self.bounds().is_some_and(is_met) {
            return;
        }
        let Some(heaviest) = self.open.peek().map(|ray| ray.width) else { return };
        // Unbounded rays are all equally heavy.
        let most = if heaviest == f64::INFINITY { 1 } else { usize::MAX };
        let first = wave.len();
        while wave.len() - first < most
            && let Some(ray) = self.pop(TOGETHER * heaviest, depth)
        {
            wave.push(ray);
        }
        self.rays += (wave.len() - first) as u32;
    }

    /// Tells whether the budget is used up.
    fn is_over(&self) -> bool {
        self.rays >= self.budget.rays || self.work >= self.budget.work
    }

    /// Tells how the tree has ended.
    pub fn end(&self, ends: &Ends) -> End {
        let End { colour, apart } = self.end_of_colour(ends);
        // What is clear is a channel of its own.
        let clear = 255.0 * self.clear;
        End { colour, apart: if clear <= SHOWN { apart } else { apart.max(clear) } }
    }

    fn end_of_colour(&self, ends: &Ends) -> End {
        let Some(bounds) = self.bounds() else { return End { colour: self.found, apart: f64::INFINITY } };
        if bounds[0] == bounds[1] {
            return End { colour: bounds[0], apart: 0.0 };
        }
        let middle = ends.display.middle(bounds);
        if ends.are_known(bounds) {
            return End { colour: middle, apart: 0.0 };
        }
        match ends.levels_apart(bounds) {
            apart if apart <= SHOWN => End { colour: middle, apart: 0.0 },
            // The pixel's other samples may be known better.
            apart if ends.is_averaged => End { colour: middle, apart },
            apart => End { colour: self.found, apart },
        }
    }

    /// Returns why open rays are left, if there are any.
    pub fn drops(&self) -> Option<DropReason> {
        let is_over = self.is_over();
        (!self.open.is_empty()).then_some(if is_over { DropReason::TooMany } else { DropReason::TooFaint })
    }

    /// Takes the heaviest open ray, if it is at least this heavy.
    fn pop(&mut self, least: f64, depth: &Depth) -> Option<OpenRay> {
        if self.open.peek()?.width < least {
            return None;
        }
        let ray = self.open.pop()?;
        self.clear -= ray.clear;
        if ray.width == f64::INFINITY {
            self.unbounded -= 1;
        } else {
            let LightRange { low, high } = ray.range(depth);
            self.left.low -= low;
            self.left.high -= high;
        }
        Some(ray)
    }

    /// Returns the bounds of the colour, if there are any.
    fn bounds(&self) -> Option<[Rgb; 2]> {
        let LightRange { low, high } = self.left;
        // Sums and differences may have crossed by rounding.
        (self.unbounded == 0).then(|| [self.found + low, self.found + high.max(low)])
    }
}
