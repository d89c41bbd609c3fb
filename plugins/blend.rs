//! Two materials blended by a formula: marble, wood and clouds are blends by a formula of `noise`.

use std::sync::Arc;
use tabray::prelude::*;

static BY: Pparm<SurfaceField> =
    Pparm::required("by", "how much of `altmaterial` shows at each point, from 0, none, to 1, nothing else");
static ALTMATERIAL: Pparm<Arc<Material>> =
    Pparm::required("altmaterial", "the material that is blended with the surface's own");

const TABLE: Table = &[&BY, &ALTMATERIAL];

inventory::submit! {
    Entity::shader("blend", "two materials, blended by a formula", &[TABLE], |args| {
        let (by, other) = (args.get(&BY), args.get(&ALTMATERIAL));
        Ok(ShaderFactory::new(move |_| Blend { by: by.clone(), other: other.clone() }))
    })
}

struct Blend {
    by: SurfaceField,
    other: Arc<Material>,
}

impl Blend {
    /// Returns the fraction of the other material at a point; NaN counts as 0.
    fn part(&self, at: &SurfacePoint) -> f64 {
        let part = self.by.at(at.variables());
        if part > 0.0 { part.min(1.0) } else { 0.0 }
    }

    fn blend(&self, own: Rgb, other: Rgb, at: &SurfacePoint) -> Rgb {
        if own == other { own } else { between(own, other, self.part(at)) }
    }
}

impl Shader for Blend {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::of(&self.by)
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.blend(material.ambient, self.other.ambient, at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.blend(material.diffuse, self.other.diffuse, at)
    }

    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.blend(material.specular, self.other.specular, at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let n = Interval::<F>::constant;
        let part = at.value(&self.by)?.max(n(0.0)).min(n(1.0));
        let blend = |own: Rgb, other: Rgb| {
            per_axis(|channel| n(own[channel]) + part * (n(other[channel]) - n(own[channel])))
        };
        let (own, other) = (material, &*self.other);
        Some(LookBounds {
            ambient: blend(own.ambient, other.ambient),
            diffuse: blend(own.diffuse, other.diffuse),
            specular: blend(own.specular, other.specular),
        })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_with(&self.other)
    }
}
