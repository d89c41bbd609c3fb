//! Another material on the back of a surface.

use std::sync::Arc;
use tabray::prelude::*;

static BACK: Pparm<Arc<Material>> = Pparm::required(
    "back",
    "the material of the side from which normals point away: the inside of a closed surface, and where the formula of an `implicit` is below 0",
);

const TABLE: Table = &[&BACK as &dyn Row];

inventory::submit! {
    Entity::shader("sides", "another material on the back of a surface", &[TABLE], |args| {
        let back = args.get(&BACK);
        Ok(ShaderFactory::new(move |_| TwoSided { back: back.clone() }))
    })
}

struct TwoSided {
    back: Arc<Material>,
}

impl TwoSided {
    /// Returns the material of the side that is hit.
    fn material<'m>(&'m self, front: &'m Material, at: &SurfacePoint) -> &'m Material {
        match at.side {
            Side::Outside => front,
            Side::Inside => &self.back,
        }
    }
}

impl Shader for TwoSided {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::NORMAL
    }

    /// Proofs take either side.
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        Some(match at.plain {
            Some(at) => constants(self.material(material, at).reflectivity(of)),
            None => hull(constants(material.reflectivity(of)), constants(self.back.reflectivity(of))),
        })
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::new(if at.side == Side::Inside { 1.0 } else { 0.0 }, 0.0)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_with(&self.back)
    }
}
