//! Bumps: normals bent as those of a surface that is raised by a formula. The surface itself stays smooth.

use tabray::prelude::*;

static HEIGHT: Pparm<Field> =
    Pparm::required("height", "how far the surface seems to be raised at each point, in world units");
static SHADER: Pparm<Option<ShaderFactory>> =
    Pparm::or("shader", "the shader that gives the colours, in place of the material", None);

const TABLE: Table = &[&HEIGHT, &SHADER];

inventory::submit! {
    Entity::shader("bumps", "bumps and waves, by a formula of their height", &[TABLE], |args| {
        let (height, colours) = (args.get(&HEIGHT), args.get(&SHADER).unwrap_or_default());
        Ok(ShaderFactory::new(move |anchor| Bent { bend: Bumps(height.clone()), colours: colours.on(anchor) }))
    })
}

/// Bumps of this height.
struct Bumps(Field);

impl Bend for Bumps {
    const SEES: ShaderInputs = ShaderInputs::POSITION;

    /// Leans the normal against the slope of the height along the surface.
    fn bent(&self, at: &SurfacePoint, normal: DVec3) -> DVec3 {
        let slope = |axis: usize| {
            let along =
                |other| Dual { value: at.position[other], slope: if other == axis { 1.0 } else { 0.0 } };
            self.0.at(per_axis(along)).slope
        };
        let gradient = DVec3::from(per_axis(slope));
        let bent = normal - (gradient - gradient.dot(normal) * normal);
        if bent.is_finite() { bent.try_normalize().unwrap_or(normal) } else { normal }
    }
}
