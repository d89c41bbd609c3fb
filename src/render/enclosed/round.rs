//! Lights that look round.

use super::light::on_disc;
use super::number::Enclosing;
use super::panes::Ends;
use tabray_exact::interval::Float;
use tabray_exact::scalar::{constants, dot, per_axis};
use tabray_world::emitter::Extent;

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
