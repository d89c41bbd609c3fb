//! Bumps: normals bent like the normals of a surface that is raised by a formula. The surface itself stays smooth.

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
    fn bent<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        let slope = |axis: usize| {
            let along =
                |other| Dual { value: at.position[other], slope: N::constant(f64::from(other == axis)) };
            self.0.at(per_axis(along)).slope
        };
        let gradient = per_axis(slope);
        let rise = dot(gradient, normal);
        let bent = per_axis(|axis| normal[axis] - (gradient[axis] - rise * normal[axis]));
        if at.plain.is_some() || self.0.is_enclosed() { N::along(bent, normal) } else { None }
    }
}
