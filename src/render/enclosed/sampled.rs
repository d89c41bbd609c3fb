//! The points that samples choose on extended lights.

use super::light::on_disc;
use super::number::Enclosing;
use super::panes::Ends;
use super::scene::Colour;
use super::surface::HitPoints;
use glam::{DVec2, DVec3};
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{constants, cross, dot, per_axis, unit};
use tabray_world::background::EnclosedBackground;
use tabray_world::ball::Ball;
use tabray_world::directions::{by_cosine, from_square, in_cone};
use tabray_world::emitter::Extent;
use tabray_world::panel::Panel;
use tabray_world::sky_map::SkyMap;

/// Points of a light, as points of a surface see them.
pub(super) struct Points<N: Enclosing> {
    /// The vectors toward them.
    pub toward: [N; 3],
    /// Whether they are infinitely far away.
    pub are_far: bool,
    /// The light of a sample, in the unit of an [`Emitter`](tabray_world::emitter::Emitter)'s samples, for a radiance
    /// of 1 or for the radiance of the sky.
    pub light: Colour<N>,
}

impl<N: Enclosing> Points<N> {
    fn even(toward: [N; 3], light: N) -> Self {
        Self { toward, are_far: false, light: [light; 3] }
    }
}

/// Encloses the points that two numbers from 0 to 1 choose, as points of a surface see them. `None` where they are
/// open, and `Some(None)` where the sample has no point.
pub(super) fn chosen<N: Enclosing>(
    extent: &Extent,
    surface: &HitPoints<N>,
    numbers: DVec2,
) -> Option<Option<Points<N>>> {
    match extent {
        Extent::Panel(panel) => on_panel(panel, surface.at, numbers),
        Extent::Ball(ball) => on_ball(ball, surface.at, numbers).map(Some),
        Extent::Cone { axis, height } => {
            let toward = in_cone(constants(*axis), N::constant(*height), numbers)?;
            let Round { light: [_, light], .. } = Round::seen(extent, surface.at)?;
            Some(Some(Points { are_far: true, ..Points::even(toward, light) }))
        }
        Extent::Sky { background, map } => in_sky((*background, *map), surface.normal, numbers),
        Extent::Unknown => None,
    }
}

/// Encloses the points of a panel at two coordinates, from -1 to 1, as these points see them.
pub(super) fn at_place<N: Enclosing>(panel: &Panel, at: [N; 3], place: [N; 2]) -> Points<N> {
    let (n, [x, y]) = (N::constant, place);
    let Panel { middle, half, .. } = panel;
    let toward = per_axis(|axis| n(middle[axis]) - at[axis] + (x * n(half[0][axis]) + y * n(half[1][axis])));
    let square = dot(toward, toward);
    // The rounding of its area and its direction is less than the tolerance with which colours are compared.
    let leaving = (dot(toward, constants(panel.facing())) / square.sqrt()).abs();
    Points::even(toward, n(panel.area()) * leaving / (N::pi() * square))
}

/// Encloses the point of a panel that [`Panel::sample`] chooses for two numbers from 0 to 1.
fn on_panel<N: Enclosing>(panel: &Panel, at: [N; 3], numbers: DVec2) -> Option<Option<Points<N>>> {
    let n = N::constant;
    let between = per_axis(|axis| n(panel.middle[axis]) - at[axis]);
    let distance = dot(between, between).sqrt().coarse();
    let (far, slack) = (panel.far(), 1e-12 * panel.far());
    if distance.low > far + slack {
        let place = if panel.is_round { from_square(numbers) } else { [numbers.x, numbers.y].map(centred) };
        return Some(Some(at_place(panel, at, place)));
    }
    if distance.high >= far - slack {
        return None;
    }
    let (toward, solid_angle) = on_rectangle(between, panel.half, numbers)?;
    if panel.is_round {
        let off = per_axis(|axis| toward[axis] - between[axis]);
        let half = constants(panel.half[0]);
        let beside = (dot(off, off) - dot(half, half)).coarse();
        if beside.low > 0.0 {
            return Some(None);
        }
        if beside.high > 0.0 {
            return None;
        }
    }
    Some(Some(Points::even(toward, solid_angle / N::pi())))
}

/// Encloses the vectors to the points of a rectangle that two numbers choose by solid angle, and the solid angle,
/// with the names of [`Panel::sample`]'s source. `between` leads to its middle.
fn on_rectangle<N: Enclosing>(between: [N; 3], half: [DVec3; 2], numbers: DVec2) -> Option<([N; 3], N)> {
    let (n, one, zero) = (N::constant, N::constant(1.0), N::of(0.0));
    let half: [[N; 3]; 2] = half.map(constants);
    let [x_axis, y_axis] = half.map(unit);
    let facing = cross(x_axis, y_axis);
    let height = dot(between, facing);
    let sign = match height.range() {
        range if range.low > zero => n(-1.0),
        range if range.high < zero => one,
        _ => return None,
    };
    let z_axis = facing.map(|along| sign * along);
    let plane = sign * height;
    let sides = [0, 1].map(|side| {
        let (size, place) = (dot(half[side], half[side]).sqrt(), dot(between, [x_axis, y_axis][side]));
        [place - size, place + size]
    });
    let [[left, right], [low, high]] = sides;
    let inward = |side: N| side / (plane * plane + side * side).sqrt();
    let [b0, n1, b1, n3] = [-inward(low), inward(right), inward(high), -inward(left)];
    // The arc cosine of minus the product.
    let angle = |a: N, b: N| {
        let cosine = -a * b;
        ((one - cosine) * (one + cosine)).sqrt().atan2(cosine)
    };
    let [g0, g1, g2, g3] = [angle(b0, n1), angle(n1, b1), angle(b1, n3), angle(n3, b0)];
    let k = n(2.0) * N::pi() - g2 - g3;
    let solid_angle = g0 + g1 - k;
    let (sin, cos) = (n(numbers.x) * solid_angle + k).sin_cos();
    let rise = cos * b0 - b1;
    let sign = match rise.range() {
        range if range.low > zero => one,
        range if range.high < zero => n(-1.0),
        _ => return None,
    };
    let u = sign * sin / (rise * rise + b0 * b0 * sin * sin).sqrt();
    let rest = one - u * u;
    if rest.coarse().low <= 1e-12 {
        return None;
    }
    let x = (-(u * plane) / rest.sqrt()).max(left).min(right);
    let square = x * x + plane * plane;
    let up = |y: N| y / (square + y * y).sqrt();
    let [from, to] = [up(low), up(high)];
    let part = from + n(numbers.y) * (to - from);
    let rest = one - part * part;
    if rest.coarse().low <= 1e-12 {
        return None;
    }
    let y = (part * square.sqrt() / rest.sqrt()).max(low).min(high);
    Some((per_axis(|axis| x * x_axis[axis] + y * y_axis[axis] + plane * z_axis[axis]), solid_angle))
}

/// A light that looks round: a ball from outside, or a cone of directions.
pub(super) struct Round<N: Enclosing> {
    /// The vectors to its middle.
    pub middle: [N; 3],
    pub distance: N,
    /// The radius around its middle.
    pub radius: N,
    /// The cosine of its angular radius.
    cosine: N,
    /// The ends of lines to the disc around its middle that looks the same.
    pub ends: Ends<N::End>,
    /// At a radiance of 1, the light on a surface that faces the whole light, and the sum of the light of all
    /// samples, in the unit of an [`Emitter`](tabray_world::emitter::Emitter)'s samples.
    pub light: [N; 2],
}

impl<N: Enclosing> Round<N> {
    /// Returns a light as points see it; `None` where they may not see it round.
    pub fn seen(extent: &Extent, at: [N; 3]) -> Option<Self> {
        let (n, one) = (N::constant, N::constant(1.0));
        match extent {
            Extent::Ball(ball) => {
                let radius = n(ball.radius);
                let middle = per_axis(|axis| n(ball.middle[axis]) - at[axis]);
                let distance = dot(middle, middle).sqrt();
                if (distance - radius).range().low <= N::of(0.0) {
                    return None;
                }
                let sine = radius / distance;
                let (square, cosine) = (sine * sine, ((one - sine) * (one + sine)).sqrt());
                // A plane that faces the points touches the ball at the first of these.
                let ends = Ends { first: (one - sine).range().low, last: N::of(1.0) };
                let light = [square, n(2.0) * square / (one + cosine)];
                Some(Self { middle, distance, radius, cosine, ends, light })
            }
            Extent::Cone { axis, height } => {
                let height = n(*height);
                let radius = (height * (n(2.0) - height)).sqrt();
                let (cosine, light) = (one - height, [one, n(2.0) / (n(2.0) - height)]);
                let ends = Ends::at(N::End::INFINITY);
                Some(Self { middle: constants(*axis), distance: one, radius, cosine, ends, light })
            }
            _ => None,
        }
    }

    /// Returns the vectors to the disc around its middle that looks the same.
    pub fn disc(&self) -> [N; 3] {
        on_disc(self.middle, self.radius / self.cosine)
    }
}

/// Encloses the point of a ball that [`Ball::sample`] chooses for two numbers from 0 to 1, as points outside of it
/// see it.
fn on_ball<N: Enclosing>(ball: &Ball, at: [N; 3], numbers: DVec2) -> Option<Points<N>> {
    let (half, radius) = (N::constant(0.5), N::constant(ball.radius));
    let Round { middle, distance, light: [_, light], .. } = Round::seen(&Extent::Ball(*ball), at)?;
    let dir = in_cone(per_axis(|axis| middle[axis] / distance), half * light, numbers)?;
    let along = dot(middle, dir);
    let aside = cross(middle, dir);
    let half_chord = (radius * radius - dot(aside, aside)).sqrt();
    let distance = (distance - radius) * (distance + radius) / (along + half_chord);
    Some(Points::even(per_axis(|axis| distance * dir[axis]), light))
}

/// Encloses the direction that a sample of [`SkyLight`](tabray_world::sky_light::SkyLight) chooses for two numbers
/// from 0 to 1, and its light.
fn in_sky<N: Enclosing>(
    (background, map): (&dyn EnclosedBackground, Option<&SkyMap>),
    normal: [N; 3],
    numbers: DVec2,
) -> Option<Option<Points<N>>> {
    let n = N::constant;
    let DVec2 { x, y } = numbers;
    let toward = match map {
        None => by_cosine(normal, numbers)?,
        Some(_) if (0.25..0.75).contains(&x) => by_cosine(normal, DVec2::new(2.0 * (x - 0.25), y))?,
        Some(map) => constants(map.direction(DVec2::new(if x < 0.25 { 2.0 * x } else { 2.0 * x - 1.0 }, y))),
    };
    let cosine = dot(toward, normal);
    let range = cosine.range();
    if range.high <= N::of(0.0) {
        return Some(None);
    }
    if range.low <= N::of(0.0) {
        return None;
    }
    let density = match map {
        None => cosine,
        Some(map) => {
            let half_pi = n(0.5) * N::pi();
            let density = map.density_within(per_axis(|axis| toward[axis].coarse()));
            n(0.5) * cosine + half_pi * N::enclosing(Interval::from_f64(density))
        }
    };
    let colour = background.colours_toward(per_axis(|axis| toward[axis].coarse()));
    let light = per_axis(|channel| N::enclosing(Interval::from_f64(colour[channel])) / density);
    Some(Some(Points { toward, are_far: true, light }))
}

/// Maps a number from 0 to 1 to one from -1 to 1.
fn centred<N: Enclosing>(number: f64) -> N {
    N::constant(2.0) * N::constant(number) - N::constant(1.0)
}
