//! The notes' shading of a sphere: colours that change with the angle around its centre.

use super::rainbow;
use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("angular", "hues around the centre, independent of the material", |anchor| Box::new(Angular(anchor))).on_sphere(0)
}

struct Angular(Anchor);

impl Shader for Angular {
    /// Returns the same colours above and below the centre: the notes' test for the lower half, `coord.y < 3.0`, is
    /// always true.
    #[inline]
    fn ambient(&self, _material: &Material, at: DVec3) -> Rgb {
        let DVec3 { x, y, .. } = at - self.0.origin;
        rainbow::colour(DVec2::new(x, -y.abs()))
    }

    fn enclose<F: Precise>(&self, material: &Material, [x, y, _]: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let [x, y] = [x - Interval::constant(self.0.origin.x), y - Interval::constant(self.0.origin.y)];
        Some(LookBounds { ambient: rainbow::enclose([x, -y.abs()]), ..material.into() })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        rainbow::brightest(1.0, material)
    }
}
