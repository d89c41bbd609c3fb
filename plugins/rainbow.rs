//! The notes' continuously modulated shading: colours that change with the angle around a point.

use crate::geometry::Shader;
use crate::material::{Material, Rgb};
use crate::shading::{Anchor, ProceduralShader};
use glam::DVec3;
use std::f64::consts::PI;

inventory::submit! {
    ProceduralShader::new("rainbow", "colours around a point, whatever the material", |anchor| Box::new(Rainbow(anchor))).on_plane(1)
}

struct Rainbow(Anchor);

impl Shader for Rainbow {
    fn ambient(&self, _material: &Material, at: DVec3) -> Rgb {
        6.0 * around(&self.0, at)
    }
}

/// The angle of a direction around z, from 0 to 2 pi.
fn angle(toward: DVec3) -> f64 {
    let angle = libm::acos(toward.x / (toward.x * toward.x + toward.y * toward.y).sqrt());
    if toward.y < 0.0 { 2.0 * PI - angle } else { angle }
}

/// Red, green and blue from 0 to 2, each a third of a turn behind the other, twice around.
pub fn colour(angle: f64) -> Rgb {
    let channel = |third: f64| 1.0 + libm::cos(2.0 * angle + third * 2.0 * PI / 3.0);
    Rgb::new(channel(0.0), channel(1.0), channel(2.0))
}

/// The colour at a point of a surface, as seen from an anchor.
pub fn around(anchor: &Anchor, at: DVec3) -> Rgb {
    colour(angle(at - anchor.origin))
}
