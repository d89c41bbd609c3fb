//! Surfaces that give light by themselves: the points that rays aim at.

use crate::ball::Ball;
use crate::panel::Panel;
use glam::{DMat3, DVec2, DVec3};

/// The points of a surface that emits the same light everywhere, as samples choose them.
#[derive(Clone, Debug, PartialEq)]
pub enum Luminous {
    /// A rectangle or a disc.
    Panel(Panel),
    /// A sphere.
    Ball(Ball),
    /// Triangles.
    Triangles(Triangles),
}

/// A point of a surface, as it is seen from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimedPoint {
    /// The unit vector toward it.
    pub toward: DVec3,
    /// The distance to it, in world units.
    pub distance: f64,
    /// The density with which it was chosen, per unit of solid angle.
    pub density: f64,
}

impl Luminous {
    /// Returns the area of the surface, in square world units.
    pub fn area(&self) -> f64 {
        match self {
            Self::Panel(panel) => panel.area(),
            Self::Ball(ball) => 4.0 * std::f64::consts::PI * ball.radius * ball.radius,
            Self::Triangles(triangles) => triangles.area(),
        }
    }

    /// Chooses a point as seen from a place with a unit normal, by two numbers from 0 to 1. `None` where the numbers
    /// stand for no point, and where no point can be aimed at from this place.
    pub fn sample(&self, at: DVec3, normal: DVec3, numbers: DVec2) -> Option<AimedPoint> {
        match self {
            Self::Panel(panel) => {
                let (toward, inverse) = panel.sample(at.to_array(), numbers)?;
                let toward = DVec3::from(toward);
                (inverse > 0.0).then_some(())?;
                Some(AimedPoint {
                    toward: toward.try_normalize()?,
                    distance: toward.length(),
                    density: 1.0 / inverse,
                })
            }
            Self::Ball(ball) => {
                let density = ball.density(at)?;
                let (toward, distance, _) = ball.sample(at.to_array(), normal.to_array(), numbers)?;
                Some(AimedPoint { toward: toward.into(), distance, density })
            }
            Self::Triangles(triangles) => triangles.sample(at, numbers),
        }
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point that is seen
    /// from a place along a unit vector, at a distance in world units, and where the surface has this unit normal;
    /// `None` where no point can be aimed at from this place.
    pub fn density(&self, at: DVec3, toward: DVec3, distance: f64, normal: DVec3) -> Option<f64> {
        match self {
            Self::Panel(panel) => panel.density(at, toward, distance),
            Self::Ball(ball) => ball.density(at),
            Self::Triangles(triangles) => density(triangles.area(), toward, distance, normal),
        }
    }

    /// Returns the surface after a linear map and a shift of its points; `None` where it is none of these any more.
    pub fn mapped(&self, linear: DMat3, shift: DVec3) -> Option<Self> {
        let are_alike = |one: f64, other: f64| (one - other).abs() <= 1e-12 * (one + other);
        match self {
            Self::Panel(Panel { middle, half, is_round }) => {
                let (middle, half) = (linear * *middle + shift, half.map(|half| linear * half));
                let [length, width] = half.map(DVec3::length);
                let is_square = half[0].dot(half[1]).abs() <= 1e-12 * length * width;
                if is_square && (!is_round || are_alike(length, width)) {
                    return Some(Self::Panel(Panel { middle, half, is_round: *is_round }));
                }
                let corner = |x: f64, y: f64| middle + x * half[0] + y * half[1];
                let [a, b, c, d] =
                    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                (!is_round).then(|| Self::Triangles(Triangles::new([[a, b, c], [a, c, d]])))
            }
            Self::Ball(Ball { middle, radius }) => {
                let scales = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length);
                let is_ball = are_alike(scales[0], scales[1]) && are_alike(scales[0], scales[2]);
                let ball = Ball { middle: linear * *middle + shift, radius: radius * scales[0] };
                is_ball.then_some(Self::Ball(ball))
            }
            Self::Triangles(Triangles { corners, .. }) => {
                let mapped = corners.iter().map(|corners| corners.map(|at| linear * at + shift));
                Some(Self::Triangles(Triangles::new(mapped)))
            }
        }
    }
}

/// Triangles, whose points are chosen by their areas.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    /// The corners of each.
    corners: Vec<[DVec3; 3]>,
    /// The sum of the areas up to each, that of the triangle included, in square world units.
    areas: Vec<f64>,
}

impl Triangles {
    /// Takes triangles by their corners, in world coordinates.
    pub fn new(corners: impl IntoIterator<Item = [DVec3; 3]>) -> Self {
        let corners: Vec<_> = corners.into_iter().collect();
        let area = |[a, b, c]: &[DVec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
        let areas = corners.iter().scan(0.0, |sum, corners| {
            *sum += area(corners);
            Some(*sum)
        });
        Self { areas: areas.collect(), corners }
    }

    fn area(&self) -> f64 {
        self.areas.last().copied().unwrap_or(0.0)
    }

    fn sample(&self, at: DVec3, numbers: DVec2) -> Option<AimedPoint> {
        let (index, part) = chosen(&self.areas, numbers.x)?;
        let [a, b, c] = self.corners[index];
        let root = part.sqrt();
        let toward = (1.0 - root) * a + root * (1.0 - numbers.y) * b + root * numbers.y * c - at;
        let (normal, distance) = ((b - a).cross(c - a).try_normalize()?, toward.length());
        let toward = toward.try_normalize()?;
        Some(AimedPoint { toward, distance, density: density(self.area(), toward, distance, normal)? })
    }
}

/// Chooses an entry of a list of sums by a number from 0 to 1, in proportion to what it adds. Also returns the number's
/// place within the entry, from 0 to 1.
pub fn chosen(sums: &[f64], number: f64) -> Option<(usize, f64)> {
    let at = number * sums.last()?;
    let index = sums.partition_point(|sum| *sum <= at).min(sums.len() - 1);
    let before = if index == 0 { 0.0 } else { sums[index - 1] };
    let own = sums[index] - before;
    (own > 0.0).then(|| (index, ((at - before) / own).clamp(0.0, 1.0)))
}

/// Returns the density, per unit of solid angle, of a point that is chosen evenly by area.
fn density(area: f64, toward: DVec3, distance: f64, normal: DVec3) -> Option<f64> {
    let cosine = toward.dot(normal).abs();
    let density = distance * distance / (area * cosine);
    (density > 0.0 && density.is_finite()).then_some(density)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of a function over the points that are chosen is its integral over what is seen, as the chosen
    /// directions cover each solid angle by its density.
    #[test]
    fn points_are_chosen_with_their_density() {
        let panel =
            Panel { middle: DVec3::new(0.5, 1.0, -3.0), half: [DVec3::X, 0.5 * DVec3::Y], is_round: false };
        let turned = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(0.2);
        let stretched = DMat3::from_diagonal(DVec3::new(1.5, 0.7, 1.0)) * turned;
        let ball = Ball { middle: DVec3::new(-1.0, 0.3, -2.0), radius: 0.8 };
        let all = [
            Luminous::Panel(panel),
            Luminous::Panel(panel).mapped(turned, DVec3::Z).expect("a panel"),
            Luminous::Panel(panel).mapped(stretched, DVec3::NEG_Z).expect("triangles"),
            Luminous::Ball(ball),
            Luminous::Ball(ball).mapped(2.0 * turned, DVec3::new(0.0, 0.0, -4.0)).expect("a ball"),
        ];
        assert!(matches!(all, [Luminous::Panel(_), Luminous::Panel(_), Luminous::Triangles(_), ..]));
        let count = 300;
        for luminous in all {
            // The solid angle in a part of all directions, by chosen points and by a grid of directions.
            let (mut chosen, mut area) = (0.0, 0.0);
            for index in 0..count * count {
                let part = |part: u32| (f64::from(part) + 0.5) / f64::from(count);
                let numbers = DVec2::new(part(index % count), part(index / count));
                let Some(AimedPoint { toward, distance, density }) =
                    luminous.sample(DVec3::ZERO, DVec3::NEG_Z, numbers)
                else {
                    continue;
                };
                chosen += 1.0 / density;
                area += distance * distance / density;
                let normal = match &luminous {
                    Luminous::Triangles(triangles) => {
                        let [a, b, c] = triangles.corners[0];
                        (b - a).cross(c - a).normalize()
                    }
                    _ => DVec3::Z,
                };
                let again = luminous.density(DVec3::ZERO, toward, distance, normal).expect("a density");
                assert!((again / density - 1.0).abs() < 1e-9, "{luminous:?}: {again} and {density}");
            }
            let count = f64::from(count * count);
            let (solid_angle, area) = (chosen / count, area / count);
            // What is seen of a surface has less than its area, and covers its area over the square of the distance.
            assert!(area > 0.0 && area <= luminous.area() * (1.0 + 1e-3), "{luminous:?}: {area}");
            let grid = grid(&luminous);
            assert!((solid_angle / grid - 1.0).abs() < 2e-2, "{luminous:?}: {solid_angle} and {grid}");
        }
    }

    /// Returns the solid angle that a surface covers as seen from the origin, by a grid of directions.
    fn grid(luminous: &Luminous) -> f64 {
        let count = 1000;
        let is_seen = |dir: DVec3| match luminous {
            Luminous::Ball(Ball { middle, radius }) => {
                middle.dot(dir) > 0.0 && middle.cross(dir).length() < *radius
            }
            Luminous::Panel(Panel { middle, half, .. }) => {
                let normal = half[0].cross(half[1]);
                let at = middle.dot(normal) / dir.dot(normal) * dir;
                let along = |half: &DVec3| (at - middle).dot(*half).abs() <= half.length_squared();
                at.dot(dir) > 0.0 && half.iter().all(along)
            }
            Luminous::Triangles(Triangles { corners, .. }) => corners.iter().any(|[a, b, c]| {
                let side = |one: &DVec3, other: &DVec3| one.cross(*other).dot(dir);
                let sides = [side(a, b), side(b, c), side(c, a)];
                (a + b + c).dot(dir) > 0.0
                    && (sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0))
            }),
        };
        let mut seen = 0.0;
        for index in 0..count * count {
            let part = |part: u32| (f64::from(part) + 0.5) / f64::from(count);
            let (height, turn) =
                (2.0 * part(index % count) - 1.0, 2.0 * std::f64::consts::PI * part(index / count));
            let across = (1.0 - height * height).sqrt();
            seen += f64::from(is_seen(DVec3::new(across * turn.cos(), height, across * turn.sin())));
        }
        4.0 * std::f64::consts::PI * seen / f64::from(count * count)
    }
}
