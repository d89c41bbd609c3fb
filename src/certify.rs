//! What is certain about a ray's first hit, proven with outward-rounded intervals, apart from the way in which
//! pictures are made.

use crate::dual::Dual;
use crate::geometry::Ray;
use crate::interval::Interval;
use crate::number::Number;
use crate::twofold::Twofold;

/// What is certain about the first hit of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enclosure {
    /// There is none.
    Misses,
    /// There is one, at one of these distances; the number of twice the precision is the nearest of its kind to it, or
    /// next to that.
    Hits(Interval, Twofold),
    /// There may be one, not nearer than this.
    Doubtful(f64),
}

/// A shape as the solutions of an equation, of which a part is kept.
pub trait Equation {
    /// 0 on the surface, and of different signs on its two sides.
    fn value<N: Number>(&self, at: [N; 3]) -> N;

    /// Above 0 where the surface is kept, below 0 where it is cut off.
    fn kept(&self, _at: [Interval; 3]) -> Interval {
        Interval::constant(1.0)
    }
}

/// How far rays are followed. No hit of a scene made of round numbers lies where this is halved.
const FAR: f64 = 1_234_567_891.0;

/// What is left of 0 by rounding outward from it.
const NOTHING: f64 = 1e-300;

/// The pieces of a ray that are looked at before it is given up.
const PIECES: usize = 2000;

/// The first hit of a ray, by halving it until each piece has no hit for certain, or one.
pub fn first_hit(shape: &impl Equation, ray: &Ray) -> Enclosure {
    let line = OnRay { shape, ray };
    let mut waiting = vec![(0.0, FAR)];
    for _ in 0..PIECES {
        let Some((low, high)) = waiting.pop() else { return Enclosure::Misses };
        match line.judge(low, high) {
            Judgement::Free => {}
            Judgement::Root(root) => {
                let kept = shape.kept(line.at(root));
                if kept.low > 0.0 {
                    return Enclosure::Hits(root, line.refined(root));
                }
                if kept.high >= 0.0 {
                    return Enclosure::Doubtful(low);
                }
            }
            Judgement::Open => {
                let middle = low + 0.5 * (high - low);
                if high - low <= 8.0 * f64::EPSILON * high {
                    // What is cut off there in any case is no hit.
                    if shape.kept(line.at(Interval { low, high })).high >= 0.0 {
                        return Enclosure::Doubtful(low);
                    }
                } else {
                    waiting.extend([(middle, high), (low, middle)]);
                }
            }
        }
    }
    Enclosure::Doubtful(waiting.last().map_or(0.0, |(low, _)| *low))
}

struct OnRay<'r, S> {
    shape: &'r S,
    ray: &'r Ray,
}

/// What is certain of a piece of a ray.
enum Judgement {
    /// The equation has no solution there.
    Free,
    /// It has one, at one of these distances.
    Root(Interval),
    /// Neither.
    Open,
}

impl<S: Equation> OnRay<'_, S> {
    fn at<N: Number>(&self, distance: N) -> [N; 3] {
        let Ray { origin, dir } = self.ray;
        let start = origin.to_array().map(N::constant);
        // Where it starts, nothing is rounded.
        if distance.is_zero() {
            return start;
        }
        [0, 1, 2].map(|axis| start[axis] + distance * N::constant(dir[axis]))
    }

    fn value<N: Number>(&self, distance: N) -> N {
        self.shape.value(self.at(distance))
    }

    fn judge(&self, low: f64, high: f64) -> Judgement {
        let piece = Interval { low, high };
        let Dual { value, slope } = self.value(Dual::variable(piece));
        // A ray that runs in a plane, or starts on it, does not meet it.
        if !value.has_zero() || value.magnitude() < NOTHING {
            return Judgement::Free;
        }
        let middle = low + 0.5 * (high - low);
        let around = Interval { low: (low - middle).next_down(), high: (high - middle).next_up() };
        let at_middle = self.value(Dual::variable(Interval::constant(middle)));
        if !(at_middle.value + slope * around).has_zero() {
            return Judgement::Free;
        }
        let bend = self.value(Dual::variable_twice(piece)).second();
        let by_bend = at_middle.slope + bend * around;
        if !(at_middle.value + by_bend * around).has_zero() {
            return Judgement::Free;
        }
        if slope.has_zero() && by_bend.has_zero() {
            return Judgement::Open;
        }
        // It rises or falls all the way.
        let sign = |at: f64| self.value(Interval::constant(at));
        let (first, last) = (sign(low), sign(high));
        match (first.has_zero(), last.has_zero()) {
            (false, false) if (first.low > 0.0) == (last.low > 0.0) => Judgement::Free,
            (true, false) if low == 0.0 && first.magnitude() < NOTHING => Judgement::Free,
            (false, false) => Judgement::Root(self.root(low, high, first.low > 0.0)),
            _ => Judgement::Open,
        }
    }

    /// A few units in the last place around the root of a piece with one, that certainly hold it.
    fn root(&self, low: f64, high: f64, falls: bool) -> Interval {
        let is_before = |at: f64| {
            let value = self.value(Interval::constant(at));
            (value.low > 0.0 && falls) || (value.high < 0.0 && !falls)
        };
        let is_behind = |at: f64| {
            let value = self.value(Interval::constant(at));
            (value.high < 0.0 && falls) || (value.low > 0.0 && !falls)
        };
        // Halving, until rounding hides the sign: then toward either side of what it hides.
        let unknown = halve(low, high, |at| {
            if is_before(at) {
                Step::Up
            } else if is_behind(at) {
                Step::Down
            } else {
                Step::Stop
            }
        });
        let before =
            halve(unknown.low, unknown.middle(), |at| if is_before(at) { Step::Up } else { Step::Down });
        let behind =
            halve(unknown.middle(), unknown.high, |at| if is_behind(at) { Step::Down } else { Step::Up });
        Interval { low: before.low, high: behind.high }
    }

    /// The root that an interval holds, by Newton's method in twice the precision.
    fn refined(&self, root: Interval) -> Twofold {
        const MOST: usize = 100;
        let (mut low, mut high) = (Twofold::from(root.low), Twofold::from(root.high));
        let begins_inside = self.value(low).is_negative();
        let mut at = Twofold::from(root.middle());
        for _ in 0..MOST {
            let Dual { value, slope } = self.value(Dual::variable(at));
            if value.is_negative() == begins_inside {
                low = at;
            } else {
                high = at;
            }
            let step = at - value / slope;
            let next = if low < step && step < high { step } else { (low + high) * Twofold::from(0.5) };
            let moved = (next - at).high.abs();
            at = next;
            if moved <= 1e-31 * root.high {
                break;
            }
        }
        at
    }
}

/// Where to look next for what halving looks for.
enum Step {
    Up,
    Down,
    Stop,
}

/// Halves an interval until it cannot be halved any more, or is told to stop.
fn halve(mut low: f64, mut high: f64, step: impl Fn(f64) -> Step) -> Interval {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return Interval { low, high };
        }
        match step(middle) {
            Step::Up => low = middle,
            Step::Down => high = middle,
            Step::Stop => return Interval { low, high },
        }
    }
}
