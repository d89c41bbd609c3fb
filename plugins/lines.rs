//! Lines on a surface: where a formula is 0, or at its multiples of a number.

use std::sync::Arc;
use tabray::prelude::*;

static FORMULA: Pparm<Field> = Pparm::required("formula", "the formula, which is 0 on the lines");
static SPACING: Pparm<Option<f64>> =
    Pparm::or("spacing", "for level lines: these lie where the formula is a multiple of this number", None)
        .must("above 0", |spacing: &Option<f64>| spacing.is_none_or(|spacing| spacing > 0.0));
static WIDTH: Pparm<f64> = Pparm::or("width", "the width of the lines", 0.02)
    .unit("world units")
    .must("0 or more", |width| *width >= 0.0);
static PIXELS: Pparm<f64> = Pparm::or(
    "pixels",
    "the least width of the lines, where samples show patches of a surface: under the free rules, and not in mirrors",
    0.0,
)
.unit("pixels")
.between(0.0, 1e3);
static ALTMATERIAL: Pparm<Arc<Material>> = Pparm::required("altmaterial", "the material of the lines");
static SHADER: Pparm<Option<ShaderFactory>> =
    Pparm::or("shader", "the shader of the surface between the lines, in place of the material", None);

const TABLE: Table = &[&FORMULA, &SPACING, &WIDTH, &PIXELS, &ALTMATERIAL, &SHADER];

inventory::submit! {
    Entity::shader("lines", "lines where a formula is 0, or a multiple of a number", &[TABLE], |args| {
        let (formula, line) = (args.get(&FORMULA), args.get(&ALTMATERIAL));
        let (spacing, width, pixels) = (args.get(&SPACING), args.get(&WIDTH), args.get(&PIXELS));
        let base = args.get(&SHADER).unwrap_or_default();
        Ok(ShaderFactory::new(move |anchor| Lines {
            formula: formula.clone(),
            spacing,
            half: 0.5 * width,
            pixels,
            line: line.clone(),
            base: base.on(anchor),
        }))
    })
}

struct Lines {
    formula: Field,
    spacing: Option<f64>,
    /// Half of the width, in world units.
    half: f64,
    pixels: f64,
    line: Arc<Material>,
    base: AnyShader,
}

impl Lines {
    /// Returns the distance in the formula's value from the nearest line, and the formula's slope along the surface.
    fn along(&self, at: &SurfacePoint) -> (f64, DVec3) {
        let [x, y, z] = DVec3::AXES.map(|axis| {
            let place = |own: usize| Dual { value: at.position[own], slope: axis[own] };
            self.formula.at([place(0), place(1), place(2)])
        });
        let value = self.spacing.map_or(x.value, |spacing| x.value - spacing * (x.value / spacing).round());
        let slope = DVec3::new(x.slope, y.slope, z.slope);
        (value.abs(), slope - slope.dot(at.normal) * at.normal)
    }

    /// Returns the coverage of a point by lines, from 0 to 1. For a patch, the coverage is the mean by the formula's
    /// value and slope.
    fn part(&self, at: &SurfacePoint) -> f64 {
        let (value, slope) = self.along(at);
        let size = slope.length();
        let (off, apart) = (value / size, self.spacing.map_or(f64::INFINITY, |spacing| spacing / size));
        let patch = at.patch.map(|patch| [patch.extent(slope / size), patch.pixel]);
        let Some([extent, pixel]) = patch.filter(|[extent, _]| *extent > 0.0) else {
            // A NaN counts as a line: the formula is 0 all over the surface.
            return if off > self.half { 0.0 } else { 1.0 };
        };
        let half = self.half.max(0.5 * self.pixels * pixel * extent);
        if extent + 2.0 * half >= apart {
            return (2.0 * half / apart).min(1.0);
        }
        let covered = |off: f64| (off + 0.5 * extent).min(half) - (off - 0.5 * extent).max(-half);
        let all = covered(off).max(0.0) + covered(apart - off).max(0.0);
        (all / extent).clamp(0.0, 1.0)
    }

    /// Tells whether all points in a box are on lines, or between them; `None` where that is open. A patch is at most as wide
    /// as the box that contains it.
    fn is_line<N: Number>(&self, at: &Point<N>) -> Option<bool> {
        let n = N::constant;
        let slopes = per_axis(|axis| {
            let place =
                |own: usize| Dual { value: at.position[own], slope: n(f64::from(u8::from(own == axis))) };
            self.formula.at([place(0), place(1), place(2)])
        });
        let (value, slope) = (slopes[0].value, slopes.map(|along| along.slope));
        let value = match self.spacing {
            Some(spacing) => {
                let [nearest, last] = (value / n(spacing) + n(0.5)).floors();
                (nearest == last).then(|| value - n(spacing) * n(nearest))?
            }
            None => value,
        }
        .abs();
        let size = match at.normal {
            Some(normal) => {
                let up = dot(slope, normal);
                let along = per_axis(|axis| slope[axis] - up * normal[axis]);
                dot(along, along).sqrt()
            }
            None => dot(slope, slope).sqrt().hull(n(0.0)),
        };
        let wide = at.position.iter().fold(n(0.0), |all, side| {
            let [low, high] = side.bounds();
            all + n(high) - n(low)
        });
        let (off, reach) = (value - size * n(self.half), size * wide);
        if (off - reach).bounds()[0] > 0.0 {
            return Some(false);
        }
        ((off + reach).bounds()[1] < 0.0 && self.spacing.is_none()).then_some(true)
    }
}

impl Shader for Lines {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs { patch: true, ..ShaderInputs::NORMAL }.and(self.base.sees())
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let (base, line) =
            (N::looks(&*self.base).reflects(of, material, at)?, constants(self.line.reflectivity(of)));
        if base == line {
            return Some(base);
        }
        if let Some(at) = at.plain {
            return Some(N::mean(base, line, N::constant(self.part(at))));
        }
        Some(match self.is_line(at).filter(|_| self.pixels == 0.0) {
            Some(true) => line,
            Some(false) => base,
            None => hull(base, line),
        })
    }

    fn covers_in_part(&self) -> bool {
        self.base.covers_in_part()
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        let covered = N::looks(&*self.base).covers(at);
        let part = at.plain.map_or_else(|| N::any(0.0, 1.0), |at| N::constant(self.part(at)));
        covered + part * (N::constant(1.0) - covered)
    }

    fn level(&self, at: &SurfacePoint) -> f64 {
        let value = self.formula.at(at.position.to_array());
        let own = self.spacing.map_or(f64::from(u8::from(value > 0.0)), |spacing| (value / spacing).floor());
        // Further lines are told apart from these.
        own + 1e6 * self.base.level(at)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let is_line = self.part(&SurfacePoint { patch: None, ..*at });
        2.0 * self.base.tile(at) + DVec2::new(is_line, 0.0)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let (own, line) = (self.base.brightest(material)?, material.brightest_with(&self.line)?);
        let [ambient, diffuse] = [own.ambient.max(line.ambient), own.diffuse.max(line.diffuse)];
        Some(Look { ambient, diffuse, specular: own.specular.max(line.specular) })
    }
}
