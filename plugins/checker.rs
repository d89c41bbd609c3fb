//! Squares in u and v, of two materials in turn: on spheres, rectangles, triangles, and all other shapes with such
//! coordinates.

use std::sync::Arc;
use tabray::prelude::*;

static SQUARES: Pparm<[i64; 2]> =
    Pparm::or("squares", "how many squares there are along u and along v", [8, 8]).between(1.0, 1e6);
static ALTMATERIAL: Pparm<Arc<Material>> =
    Pparm::required("altmaterial", "the material of every other square");

const TABLE: Table = &[&SQUARES, &ALTMATERIAL];

inventory::submit! {
    Entity::shader("checker", "squares in u and v, of the material and of another one in turn", &[TABLE], |args| {
        let (squares, other) = (args.get(&SQUARES).map(|count| count as f64), args.get(&ALTMATERIAL));
        Ok(ShaderFactory::new(move |_| Checker { squares: DVec2::from(squares), other: other.clone() }))
    })
}

struct Checker {
    squares: DVec2,
    other: Arc<Material>,
}

impl Shader for Checker {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs { patch: true, ..ShaderInputs::UV }
    }

    /// Returns the colour of the square at a point, or the mean over the patch around it; without u and v, the surface's own
    /// colour.
    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let (own, other) = (constants(material.reflectivity(of)), constants(self.other.reflectivity(of)));
        let n = N::constant;
        let squares = |uv: [N; 2]| [uv[0] * n(self.squares.x), uv[1] * n(self.squares.y)];
        let Some(uv) = at.uv else { return Some(N::any(-1.0, 1.0).either(own, other)) };
        let patch = at.patch.and_then(|patch| patch.uv).map(|[low, high]| {
            let ([left, low], [right, high]) = (squares(low), squares(high));
            [[n(0.5) * (left + right), n(0.5) * (low + high)], [right - left, high - low]]
        });
        // Rounding must not begin a square beyond the last one.
        let [column, row] = squares(uv);
        let place = [column.min(n(self.squares.x - 0.5)), row.min(n(self.squares.y - 0.5))];
        Some(tiled(own, other, place, patch))
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        // Rounding must not begin a square beyond the last one.
        let square = at.uv.map(|uv| (uv * self.squares).floor().min(self.squares - 1.0));
        square.unwrap_or(DVec2::ZERO)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_with(&self.other)
    }
}
