//! Places the labels of points so that they do not overlap.

/// A rectangle: left, top, right and bottom, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotArea {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl PlotArea {
    /// Makes a square around a point; `half` is half its side, in pixels.
    pub fn around((x, y): (f64, f64), half: f64) -> Self {
        Self { left: x - half, top: y - half, right: x + half, bottom: y + half }
    }

    fn middle(&self) -> (f64, f64) {
        (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    fn is_within(&self, other: &Self) -> bool {
        self.left >= other.left
            && self.right <= other.right
            && self.top >= other.top
            && self.bottom <= other.bottom
    }

    fn holds(&self, (x, y): (f64, f64)) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// Tells whether a line crosses the rectangle, by testing points so close together that none is missed.
    fn is_crossed(&self, ((x, y), (to_x, to_y)): Segment) -> bool {
        const STEP: f64 = 4.0;
        let steps = ((to_x - x).hypot(to_y - y) / STEP).ceil().max(1.0);
        (0..=steps as u32).any(|step| {
            let part = f64::from(step) / steps;
            self.holds((x + part * (to_x - x), y + part * (to_y - y)))
        })
    }
}

/// A line from one point to another.
pub type Segment = ((f64, f64), (f64, f64));

/// The place of a label.
#[derive(Clone, Copy, Debug)]
pub struct LabelPlace {
    /// The rectangle that the label covers.
    pub area: PlotArea,
    /// The end of a leader line from the point to the label, if the label is not right beside its point.
    pub leader: Option<(f64, f64)>,
}

/// Places labels of these sizes beside their points, the first ones best, and clear of lines; a label for which there
/// is no room gets `None`.
///
/// Labels are placed one after the other. Then a badly placed label is removed, again and again, with some of its
/// neighbours, and is placed before them; improvements are kept.
pub fn place(
    points: &[(f64, f64)],
    sizes: &[(f64, f64)],
    lines: &[Segment],
    room: PlotArea,
) -> Vec<Option<LabelPlace>> {
    const ROUNDS: usize = 100;
    /// The maximum number of labels that are placed anew at one time.
    const MAX_MOVED: usize = 8;
    let crowd = LabelLayout { points, sizes, lines, room };
    let mut best = vec![None; points.len()];
    let mut costs = vec![0.0; points.len()];
    crowd.place(0..points.len(), &mut best, &mut costs);
    for round in 0..ROUNDS {
        let mut bad: Vec<usize> = (0..points.len()).filter(|index| costs[*index] > 0.0).collect();
        if bad.is_empty() {
            break;
        }
        bad.sort_by(|a, b| costs[*b].total_cmp(&costs[*a]));
        let first = bad[round % bad.len()];
        let far = |index: &usize| {
            let label = best[*index].map_or(points[*index], |place: LabelPlace| place.area.middle());
            distance(points[first], label).min(distance(points[first], points[*index]))
        };
        let mut near: Vec<usize> = (0..points.len()).filter(|index| *index != first).collect();
        near.sort_by(|a, b| far(a).total_cmp(&far(b)));
        near.truncate(1 + round % MAX_MOVED);
        let turn = (round / MAX_MOVED) % near.len().max(1);
        near.rotate_left(turn);
        let (mut places, mut sums) = (best.clone(), costs.clone());
        near.iter().chain([&first]).for_each(|index| places[*index] = None);
        crowd.place([first].into_iter().chain(near), &mut places, &mut sums);
        if sums.iter().sum::<f64>() < costs.iter().sum() {
            (best, costs) = (places, sums);
        }
    }
    best
}

/// Returns the distance of two points, in pixels.
fn distance(from: (f64, f64), to: (f64, f64)) -> f64 {
    (to.0 - from.0).hypot(to.1 - from.1)
}

/// The greatest distance of a label from its point without a leader line, in pixels.
const MAX_WITHOUT_LEADER: f64 = 13.0;

/// The greatest distance of a label from its point, in pixels.
const MAX_DISTANCE: u32 = 250;

/// The cost of a leader line that crosses a marker or another line, and that of a label without a place, in the same
/// unit as the cost of a leader line: pixels of its length.
const CROSSING: f64 = 300.0;
const MISSING: f64 = 3000.0;

/// Points, the sizes of their labels, the lines that labels keep clear of, and the area within which they stay.
struct LabelLayout<'c> {
    points: &'c [(f64, f64)],
    sizes: &'c [(f64, f64)],
    lines: &'c [Segment],
    room: PlotArea,
}

impl LabelLayout<'_> {
    /// Places labels beside those already placed, one after the other, and sets the cost of each.
    fn place(
        &self,
        order: impl Iterator<Item = usize>,
        placed: &mut [Option<LabelPlace>],
        costs: &mut [f64],
    ) {
        const MARKER: f64 = 8.0;
        let Self { points, sizes, lines, room } = *self;
        let markers: Vec<PlotArea> = points.iter().map(|point| PlotArea::around(*point, MARKER)).collect();
        for index in order {
            let point = points[index];
            let there =
                || placed.iter().zip(points).filter_map(|(place, from)| Some((place.as_ref()?, *from)));
            let leaders = || there().filter_map(|(place, from)| Some((from, place.leader?)));
            let is_free = |place: &LabelPlace| {
                place.area.is_within(&room)
                    && !markers.iter().any(|marker| marker.overlaps(&place.area))
                    && !lines.iter().any(|line| place.area.is_crossed(*line))
                    && !there().any(|(other, _)| other.area.overlaps(&place.area))
                    && !leaders().any(|leader| place.area.is_crossed(leader))
                    && !there()
                        .any(|(other, _)| place.leader.is_some_and(|end| other.area.is_crossed((point, end))))
            };
            let cost = |place: &LabelPlace| {
                let Some(end) = place.leader else { return 0.0 };
                // The markers at which the leader line starts do not count.
                let others = markers.iter().filter(|marker| !marker.holds(point));
                let crossed = others.filter(|marker| marker.is_crossed((point, end))).count()
                    + leaders().filter(|leader| do_cross(*leader, (point, end))).count();
                distance(point, end) + CROSSING * crossed as f64
            };
            let free = around(point, sizes[index]).filter(is_free).map(|place| (cost(&place), place));
            let best = free.min_by(|a, b| a.0.total_cmp(&b.0));
            costs[index] = best.map_or(MISSING, |(cost, _)| cost);
            placed[index] = best.map(|(_, place)| place);
        }
    }
}

/// Returns the places for a label of this size around its point, the best first.
fn around(point: (f64, f64), (width, height): (f64, f64)) -> impl Iterator<Item = LabelPlace> {
    const STEP: u32 = 10;
    const TURNS: u32 = 24;
    // Right, left, below and above come first.
    let mut turns: Vec<u32> = (0..TURNS).collect();
    turns.sort_by_key(|turn| (turn % (TURNS / 4) != 0, turn % (TURNS / 2) != 0));
    (0..MAX_DISTANCE / STEP).map(|step| MAX_WITHOUT_LEADER + f64::from(step * STEP)).flat_map(move |radius| {
        turns.clone().into_iter().flat_map(move |turn| {
            let (down, right) = libm::sincos(std::f64::consts::TAU * f64::from(turn) / f64::from(TURNS));
            let natural = if right.abs() < 0.1 { 0.5 } else { f64::from(right < 0.0) };
            // At a steep leader line the label can be on either side.
            let others =
                if right.abs() < 0.8 && radius > MAX_WITHOUT_LEADER { [0.0, 1.0].as_slice() } else { &[] };
            let end = (point.0 + radius * right, point.1 + radius * down);
            let top = end.1 + 0.5 * height * (down - 1.0);
            // The label begins, ends or has its middle at the end of the line.
            [natural].into_iter().chain(others.iter().copied()).map(move |begins| {
                let left = end.0 - begins * width;
                let area = PlotArea { left, top, right: left + width, bottom: top + height };
                LabelPlace { area, leader: (radius > MAX_WITHOUT_LEADER).then_some(end) }
            })
        })
    })
}

/// Tells whether two lines cross.
fn do_cross((a, b): Segment, (c, d): Segment) -> bool {
    let turn = |a: (f64, f64), b: (f64, f64), c: (f64, f64)| {
        ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).total_cmp(&0.0)
    };
    turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_between_others_has_its_label() {
        let points = [
            (250.0, 150.0),
            (234.0, 150.0),
            (266.0, 150.0),
            (250.0, 134.0),
            (250.0, 166.0),
            (238.0, 138.0),
            (262.0, 138.0),
            (238.0, 162.0),
            (262.0, 162.0),
        ];
        let room = PlotArea { left: 0.0, top: 0.0, right: 500.0, bottom: 300.0 };
        let places = place(&points, &[(90.0, 14.0); 9], &[], room);
        assert!(places.iter().all(Option::is_some));
    }

    #[test]
    fn labels_of_a_crowd_cover_neither_each_other_nor_a_point() {
        let points: Vec<_> = (0..12).map(|index| (200.0 + 6.0 * f64::from(index), 150.0)).collect();
        let sizes = vec![(90.0, 14.0); points.len()];
        let room = PlotArea { left: 0.0, top: 0.0, right: 500.0, bottom: 300.0 };
        let places: Vec<PlotArea> = place(&points, &sizes, &[((0.0, 180.0), (500.0, 180.0))], room)
            .into_iter()
            .map(|place| place.expect("room").area)
            .collect();
        for (index, area) in places.iter().enumerate() {
            assert!(area.is_within(&room) && !(area.top..=area.bottom).contains(&180.0));
            assert!(!places[..index].iter().any(|other| other.overlaps(area)));
            assert!(!points.iter().any(|point| area.holds(*point)));
        }
    }
}
