//! Where the names of points go, so that none covers another.

/// A rectangle: left, top, right and bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    /// Around a point.
    pub fn around((x, y): (f64, f64), half: f64) -> Self {
        Self { left: x - half, top: y - half, right: x + half, bottom: y + half }
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

    /// Whether a line runs through it, seen at so many places that it cannot hide between them.
    fn is_crossed(&self, ((x, y), (to_x, to_y)): Line) -> bool {
        const STEP: f64 = 4.0;
        let steps = ((to_x - x).hypot(to_y - y) / STEP).ceil().max(1.0);
        (0..=steps as u32).any(|step| {
            let part = f64::from(step) / steps;
            self.holds((x + part * (to_x - x), y + part * (to_y - y)))
        })
    }
}

/// From a point to another one.
pub type Line = ((f64, f64), (f64, f64));

/// Where a label went.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// What it covers.
    pub area: Area,
    /// Where a line from its point to it ends, if it is not right beside that.
    pub leader: Option<(f64, f64)>,
}

/// Places labels of these sizes beside their points, the first ones best, and clear of lines; nothing for one that has
/// no room. Where points crowd, a line from one to its label may run across another point.
pub fn place(points: &[(f64, f64)], sizes: &[(f64, f64)], lines: &[Line], room: Area) -> Vec<Option<Place>> {
    const ATTEMPTS: usize = 10;
    let mut order: Vec<usize> = (0..points.len()).collect();
    let mut best: Vec<Option<Place>> = vec![None; points.len()];
    let count = |places: &[Option<Place>]| places.iter().flatten().count();
    for _ in 0..ATTEMPTS {
        let places = place_in_order(&order, points, sizes, lines, room, false);
        if count(&places) > count(&best) {
            best.clone_from(&places);
        }
        if count(&best) == points.len() {
            break;
        }
        // Those that found no room choose first.
        order.sort_by_key(|index| places[*index].is_some());
    }
    if count(&best) == points.len() {
        return best;
    }
    place_in_order(&(0..points.len()).collect::<Vec<_>>(), points, sizes, lines, room, true)
}

fn place_in_order(
    order: &[usize],
    points: &[(f64, f64)],
    sizes: &[(f64, f64)],
    lines: &[Line],
    room: Area,
    may_cross: bool,
) -> Vec<Option<Place>> {
    const MARKER: f64 = 8.0;
    /// As far from its point a label needs no line to it.
    const NEAR: f64 = 13.0;
    const RADII: u32 = 24;
    const TURNS: u32 = 24;
    // Right, left, up and down first.
    let mut turns: Vec<u32> = (0..TURNS).collect();
    turns.sort_by_key(|turn| (turn % (TURNS / 4) != 0, turn % (TURNS / 2) != 0));
    let ways: Vec<(f64, f64)> = turns
        .into_iter()
        .map(|turn| libm::sincos(std::f64::consts::TAU * f64::from(turn) / f64::from(TURNS)))
        .map(|(down, right)| (right, down))
        .collect();
    let markers: Vec<Area> = points.iter().map(|point| Area::around(*point, MARKER)).collect();
    let mut placed: Vec<Option<Place>> = vec![None; points.len()];
    for &index in order {
        let ((x, y), (width, height)) = (&points[index], &sizes[index]);
        let fits = |radius: f64, (right, down): (f64, f64), begins: f64, may_cross: bool| {
            let end = (x + radius * right, y + radius * down);
            // It begins, ends or has its middle there.
            let left = end.0 - begins * width;
            let top = end.1 + 0.5 * height * (down - 1.0);
            let area = Area { left, top, right: left + width, bottom: top + height };
            let leader = (radius > NEAR).then_some(end);
            let is_free = area.is_within(&room)
                && !markers.iter().any(|marker| marker.overlaps(&area))
                && !lines.iter().any(|line| area.is_crossed(*line))
                && !placed.iter().flatten().any(|other| other.area.overlaps(&area));
            // A line runs neither across another label or marker nor below a label that is there.
            let is_clear = leader.is_none_or(|end| {
                let line = ((*x, *y), end);
                // Those that it starts below are there in any case.
                let mut others = markers.iter().filter(|marker| !marker.holds(points[index]));
                (may_cross || !others.any(|marker| marker.is_crossed(line)))
                    && !placed.iter().flatten().any(|other| other.area.is_crossed(line))
            });
            let covers = placed.iter().zip(points).any(|(other, from)| {
                other.and_then(|other| other.leader).is_some_and(|to| area.is_crossed((*from, to)))
            });
            (is_free && is_clear && !covers).then_some(Place { area, leader })
        };
        let places = || {
            (0..RADII).map(|step| NEAR + 10.0 * f64::from(step)).flat_map(|radius| {
                ways.iter().flat_map(move |way| {
                    let (right, _) = *way;
                    let natural = if right.abs() < 0.1 { 0.5 } else { f64::from(right < 0.0) };
                    // Beside a steep line it can be on either side.
                    let others = if right.abs() < 0.8 && radius > NEAR { [0.0, 1.0].as_slice() } else { &[] };
                    [natural]
                        .into_iter()
                        .chain(others.iter().copied())
                        .map(move |begins| (radius, *way, begins))
                })
            })
        };
        let place =
            |may_cross: bool| places().find_map(|(radius, way, begins)| fits(radius, way, begins, may_cross));
        placed[index] = place(false).or_else(|| may_cross.then(|| place(true))?);
    }
    placed
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
        let room = Area { left: 0.0, top: 0.0, right: 500.0, bottom: 300.0 };
        let places = place(&points, &[(90.0, 14.0); 9], &[], room);
        assert!(places.iter().all(Option::is_some));
    }

    #[test]
    fn labels_of_a_crowd_cover_neither_each_other_nor_a_point() {
        let points: Vec<_> = (0..12).map(|index| (200.0 + 6.0 * f64::from(index), 150.0)).collect();
        let sizes = vec![(90.0, 14.0); points.len()];
        let room = Area { left: 0.0, top: 0.0, right: 500.0, bottom: 300.0 };
        let places: Vec<Area> = place(&points, &sizes, &[((0.0, 180.0), (500.0, 180.0))], room)
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
