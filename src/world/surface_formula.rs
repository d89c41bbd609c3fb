//! The properties of points that formulas of a surface read.

use crate::number::Number;
use crate::surface_point::{Point, ShaderInputs, SurfacePoint};
use std::ops::Range;
use tabray_exact::formula::field::SurfaceField;
use tabray_exact::interval::Interval;

/// The number of variables, in the order of [`SURFACE`](tabray_exact::formula::variables::SURFACE).
const COUNT: usize = SurfaceField::VARIABLES.len();

const UV: Range<usize> = 3..5;
const NORMAL: Range<usize> = 5..8;
const CURVATURE: Range<usize> = 8..COUNT;

impl ShaderInputs {
    /// Returns the properties of a point that a formula of a surface reads.
    pub fn of(formula: &SurfaceField) -> Self {
        let reads = |mut variables: Range<usize>| variables.any(|variable| formula.uses(variable));
        Self { uv: reads(UV), normal: reads(NORMAL), curvature: reads(CURVATURE), ..Self::POSITION }
    }
}

impl SurfacePoint {
    /// Returns the variables of formulas at the point; 0 for those that it does not have, or its shader does not see.
    pub fn variables(&self) -> [f64; COUNT] {
        let ([x, y, z], [nx, ny, nz]) = (self.position.to_array(), self.normal.to_array());
        let [u, v] = self.uv.unwrap_or_default().to_array();
        let [gradient, mean, gauss] = self.curvature.map_or([0.0; 3], |of| [of.gradient, of.mean, of.gauss]);
        [x, y, z, u, v, nx, ny, nz, gradient, mean, gauss]
    }
}

impl<N: Number> Point<'_, N> {
    /// Returns a formula at the point, or bounds of it; `None` where a variable that it reads is not known.
    pub fn value(&self, formula: &SurfaceField) -> Option<N> {
        if let Some(at) = self.plain {
            return Some(N::constant(formula.at(at.variables())));
        }
        let sees = ShaderInputs::of(formula);
        if sees.curvature || !formula.is_enclosed() {
            return None;
        }
        let zero = N::constant(0.0);
        let [nx, ny, nz] = if sees.normal { self.normal? } else { [zero; 3] };
        let [u, v] = if sees.uv { self.uv? } else { [zero; 2] };
        let [x, y, z] = self.position;
        Some(formula.at([x, y, z, u, v, nx, ny, nz, zero, zero, zero]))
    }
}

/// Bounds a formula on every surface.
pub fn range(formula: &SurfaceField) -> Interval {
    let mut all = [Interval::whole(); COUNT];
    all[NORMAL].fill(Interval { low: -1.0, high: 1.0 });
    if formula.is_enclosed() { formula.at(all) } else { Interval::whole() }
}
