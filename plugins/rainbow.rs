//! The notes' continuously modulated shading: colours that change with the angle around a point.

use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("rainbow", "hues around a point, independent of the material", |anchor| Box::new(Rainbow(anchor))).on_plane(1)
}

struct Rainbow(Anchor);

impl Shader for Rainbow {
    #[inline]
    fn ambient(&self, _material: &Material, at: DVec3) -> Rgb {
        6.0 * around(&self.0, at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        Some(LookBounds { ambient: enclosed_around(&self.0, at), ..material.into() })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        brightest(6.0, material)
    }
}

/// Returns red, green and blue from 0 to 2 for a direction of the angle t: `1 + cos(2 t + k/3)` for channel k, with k/3
/// in turns. The angle itself is not computed, which avoids the rounding of `acos` and arguments outside of its domain.
#[inline]
pub fn colour(toward: DVec2) -> Rgb {
    // At the point itself there is no direction, and all channels are equal.
    let DVec2 { x, y } = (toward / toward.abs().max_element()).try_normalize().unwrap_or(DVec2::ZERO);
    let (cos, sin) = (x * x - y * y, 2.0 * x * y);
    let half_root_3 = 0.5 * 3.0_f64.sqrt();
    Rgb::new(1.0 + cos, 1.0 - 0.5 * cos - half_root_3 * sin, 1.0 - 0.5 * cos + half_root_3 * sin)
}

/// Bounds the reflectivities of a shader whose ambient colours are `times` those of [`colour`], and whose other colours
/// are the material's.
pub fn brightest(times: f64, material: &Material) -> Option<Look> {
    let Material { diffuse, specular, .. } = *material;
    let is_sound = diffuse.min_element() >= 0.0;
    // The largest colour is 2, up to a few ulps; 1e-6 is far more than those.
    is_sound.then_some(Look { ambient: Rgb::splat(2.000001 * times), diffuse, specular })
}

/// Returns the colour at a point, by its direction from an anchor in x and y.
#[inline]
pub fn around(anchor: &Anchor, at: DVec3) -> Rgb {
    colour((at - anchor.origin).truncate())
}

/// Encloses [`colour`].
pub fn enclose<F: Precise>([x, y]: [Interval<F>; 2]) -> [Interval<F>; 3] {
    let n = Interval::<F>::constant;
    let square = x.powi(2) + y.powi(2);
    let part = |of: Interval<F>| (of / square).max(n(-1.0)).min(n(1.0));
    let (cos, sin) = (part(x.powi(2) - y.powi(2)), part(n(2.0) * x * y));
    let (half, half_root_3) = (n(0.5), n(0.5) * n(3.0).sqrt());
    [n(1.0) + cos, n(1.0) - half * cos - half_root_3 * sin, n(1.0) - half * cos + half_root_3 * sin]
}

/// Encloses six times the colour of [`around`].
pub fn enclosed_around<F: Precise>(anchor: &Anchor, [x, y, _]: [Interval<F>; 3]) -> [Interval<F>; 3] {
    let colour = enclose([x - Interval::constant(anchor.origin.x), y - Interval::constant(anchor.origin.y)]);
    per_axis(|channel| Interval::constant(6.0) * colour[channel])
}
