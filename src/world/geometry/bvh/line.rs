//! Searches of a hierarchy along a line with interval coefficients, for proofs. They share no arithmetic with the
//! search that renders images.

use crate::geometry::bvh::beam::{HIGH, LOW};
use crate::geometry::bvh::node::{Node, WIDTH};
use crate::geometry::bvh::tree::Bvh;
use crate::geometry::sight::Line;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;

/// A line prepared for tests against boxes, axis by axis.
struct Slabs {
    axes: [Axis; 3],
}

/// A line along one axis.
enum Axis {
    /// The line rises, or falls if `is_mirrored`, which negates its coordinates. Bounds of its start, and of the t per
    /// unit, which is positive.
    Rises { is_mirrored: bool, origin: Interval, inverse: Interval },
    /// The line stays at its start.
    Level(Interval),
    /// The line may rise or fall.
    Unknown,
}

/// Returns a lower bound of the exact number, given that number rounded to nearest.
#[inline(always)]
fn down(rounded: f64) -> f64 {
    rounded - (rounded.abs() * f64::EPSILON + f64::MIN_POSITIVE)
}

/// Returns an upper bound of the exact number, given that number rounded to nearest.
#[inline(always)]
fn up(rounded: f64) -> f64 {
    rounded + (rounded.abs() * f64::EPSILON + f64::MIN_POSITIVE)
}

impl Axis {
    fn of(origin: Interval, dir: Interval) -> Self {
        if dir.low == 0.0 && dir.high == 0.0 {
            return Self::Level(origin);
        }
        let (origin, dir, is_mirrored) =
            if dir.high < 0.0 { (-origin, -dir, true) } else { (origin, dir, false) };
        let inverse = Interval::constant(1.0) / dir;
        // The inverse of a tiny component may be infinite.
        match dir.low > 0.0 && inverse.low > 0.0 && inverse.high < f64::INFINITY {
            true => Self::Rises { is_mirrored, origin, inverse },
            false => Self::Unknown,
        }
    }
}

impl Slabs {
    /// Returns lower bounds of the t, from 0 on, at which the line enters the boxes of a node's children. They are
    /// infinite for boxes that the line certainly misses or enters after `end`.
    #[inline(always)]
    fn entered(&self, node: &Node, end: f64) -> [f64; WIDTH] {
        let (mut enters, mut leaves) = ([0.0; WIDTH], [end; WIDTH]);
        for (axis, known) in self.axes.iter().enumerate() {
            let (lows, highs) = (node.planes_of(axis, LOW), node.planes_of(axis, HIGH));
            match known {
                Axis::Unknown => {}
                Axis::Level(origin) => {
                    for child in 0..WIDTH {
                        let is_out = origin.high < lows[child] || origin.low > highs[child];
                        leaves[child] = if is_out { -1.0 } else { leaves[child] };
                    }
                }
                Axis::Rises { is_mirrored, origin, inverse } => {
                    for child in 0..WIDTH {
                        let (low, high) = if *is_mirrored {
                            (-highs[child], -lows[child])
                        } else {
                            (lows[child], highs[child])
                        };
                        let (before, behind) = (down(low - origin.high), up(high - origin.low));
                        let enter = down(before * if before > 0.0 { inverse.low } else { inverse.high });
                        let leave = up(behind * if behind > 0.0 { inverse.high } else { inverse.low });
                        // The comparisons are false for NaN.
                        enters[child] = if enter > enters[child] { enter } else { enters[child] };
                        leaves[child] = if leave < leaves[child] { leave } else { leaves[child] };
                    }
                }
            }
        }
        for child in 0..WIDTH {
            enters[child] = if enters[child] <= leaves[child] { enters[child] } else { f64::INFINITY };
        }
        enters
    }
}

impl Bvh {
    /// Visits the objects whose boxes a line may enter, from t = 0 on, roughly nearest first. `visit` takes an object,
    /// and returns the t beyond which objects no longer matter. It is behind `dyn` to compile the search only once.
    pub fn along(&self, line: &Line<Interval>, visit: &mut dyn FnMut(usize) -> f64) {
        let axes = [0, 1, 2].map(|axis| Axis::of(line.origin[axis], line.dir[axis]));
        let (slabs, mut end, mut ahead) = (Slabs { axes }, f64::INFINITY, Vec::with_capacity(64));
        if !self.nodes.is_empty() {
            ahead.push((0.0, true, 0));
        }
        while let Some((enters, is_node, index)) = ahead.pop() {
            if enters > end {
                continue;
            }
            if !is_node {
                end = visit(self.object(index));
                continue;
            }
            let (node, start) = (&self.nodes[index as usize], ahead.len());
            let entered = slabs.entered(node, end);
            for child in (0..node.len()).filter(|child| entered[*child] < f64::INFINITY) {
                let (is_node, index) = node.child(child as u32);
                ahead.push((entered[child], is_node, index));
            }
            ahead[start..].sort_unstable_by(|one, other| other.0.total_cmp(&one.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::aabb::Aabb;
    use glam::DVec3;
    use proptest::prelude::*;

    fn line(origin: [f64; 3], dir: [f64; 3], error: f64) -> Line<Interval> {
        let around = |at: f64| Interval { low: at - error, high: at + error };
        Line { origin: origin.map(around), dir: dir.map(around) }
    }

    proptest! {
        /// All boxes that [`Line::clip`] with intervals does not exclude are visited.
        #[test]
        fn no_box_that_a_line_may_enter_is_left_out(
            places in prop::collection::vec((-9..9, -9..9, -9..9, 0..3), 1..60),
            origin in prop::array::uniform3(-12..12),
            dir in prop::array::uniform3(-4..5),
            error in prop::sample::select(vec![0.0, 1e-12, 0.1, 2.0]),
            least in prop::sample::select(vec![1.0, 1e-300, 1e150]),
        ) {
            let box_at = |(x, y, z, size): &(i32, i32, i32, i32)| {
                let low = DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z));
                Aabb { low, high: low + f64::from(*size) }
            };
            let boxes: Vec<_> = places.iter().map(box_at).collect();
            let line = line(origin.map(f64::from), dir.map(|part| least * f64::from(part)), error);
            let mut visited = Vec::new();
            Bvh::new(&boxes).along(&line, &mut |object| {
                visited.push(object);
                f64::INFINITY
            });
            for (object, bounds) in boxes.iter().enumerate() {
                let is_entered = line.clip(bounds.low, bounds.high).is_some();
                prop_assert!(!is_entered || visited.contains(&object), "{bounds:?}");
            }
        }
    }

    #[test]
    fn nothing_is_visited_that_lies_beyond_the_end_or_beside() {
        let at = |z: f64| Aabb { low: DVec3::new(-0.5, -0.5, z), high: DVec3::new(0.5, 0.5, z + 0.5) };
        let boxes: Vec<_> = (0..100).map(|z| at(f64::from(z))).collect();
        let tree = Bvh::new(&boxes);
        for (dir, first) in [(1.0, 40), (-1.0, 39)] {
            let mut visited = Vec::new();
            tree.along(&line([0.0, 0.0, 39.75], [0.0, 0.0, dir], 0.0), &mut |object| {
                visited.push(object);
                2.5
            });
            assert!(visited.contains(&first) && visited.len() <= 6, "{visited:?}");
        }
        tree.along(&line([2.0, 0.0, -9.0], [0.0, 0.0, 1.0], 0.0), &mut |object| {
            panic!("{object} lies beside")
        });
    }
}
