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

impl Checker {
    /// Returns the colour of the square at a point, or the mean over the patch around it; without u and v, the
    /// surface's own colour.
    #[inline]
    fn colour(&self, own: Rgb, other: Rgb, at: &SurfacePoint) -> Rgb {
        if let Some([low, high]) = at.patch.and_then(|patch| patch.uv) {
            let (low, high) = (low * self.squares, high * self.squares);
            return between(own, other, odd_part(0.5 * (low + high), high - low));
        }
        if is_odd(self.tile(at)) { other } else { own }
    }
}

impl Shader for Checker {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs { patch: true, ..ShaderInputs::UV }
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.ambient, self.other.ambient, at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.diffuse, self.other.diffuse, at)
    }

    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.specular, self.other.specular, at)
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        // Rounding must not begin a square beyond the last one.
        let square = at.uv.map(|uv| (uv * self.squares).floor().min(self.squares - 1.0));
        square.unwrap_or(DVec2::ZERO)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let square = |axis: usize| {
            let count = self.squares[axis];
            let square = (at.uv?[axis] * Interval::constant(count)).certain_floor()?;
            Some(square.min(count - 1.0))
        };
        let [own, other] = [LookBounds::from(material), LookBounds::from(&*self.other)];
        // As of a point, the last square has no end.
        Some(match (square(0), square(1), at.patch.and_then(|patch| patch.uv)) {
            (Some(column), Some(row), None) if !is_odd(DVec2::new(column, row)) => own,
            (Some(_), Some(_), None) => other,
            (.., None) => own.hull(&other),
            (.., Some([low, high])) => {
                let squares = |uv: [Interval; 2], axis: usize| {
                    Interval::<F>::from_f64(uv[axis] * Interval::constant(self.squares[axis]))
                };
                let half = Interval::constant(0.5);
                let middle = [0, 1].map(|axis| half * (squares(low, axis) + squares(high, axis)));
                let widths = [0, 1].map(|axis| squares(high, axis) - squares(low, axis));
                own.mean(&other, odd_part_bounds(middle, widths))
            }
        })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_with(&self.other)
    }
}
