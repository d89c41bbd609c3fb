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

impl Shader for Blend {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::of(&self.by)
    }

    /// A formula without a value counts as 0.
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let [own, other] = [material.reflectivity(of), self.other.reflectivity(of)];
        if own == other {
            return Some(constants(own));
        }
        let part = N::constant(0.0).max(at.value(&self.by)?).min(N::constant(1.0));
        Some(N::mean(constants(own), constants(other), part))
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_with(&self.other)
    }
}
