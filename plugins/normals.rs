//! Normals bent by an image, a normal map: red is the component along u, green the component along v, and blue the
//! component along the normal.

use std::sync::Arc;
use tabray::prelude::*;
use tabray::world::repeated::{blended, repeated};

static TEXTURE: Pparm<Arc<Texture>> = Pparm::required(
    "texture",
    "the normal map, defined earlier in the scene: of each part of a normal, 0 stands for -1, and the greatest number for 1",
);
static REPEAT: Pparm<[i64; 2]> =
    Pparm::or("repeat", "how often the image repeats along u and along v", [1, 1]).between(1.0, 1e6);
static STRENGTH: Pparm<f64> = Pparm::or(
    "strength",
    "the factor of the slopes: 0 is flat, and a negative one turns hills into hollows",
    1.0,
)
.between(-100.0, 100.0);
static SHADER: Pparm<Option<ShaderFactory>> =
    Pparm::or("shader", "the shader that gives the colours, in place of the material", None);

const TABLE: Table = &[&TEXTURE, &REPEAT, &STRENGTH, &SHADER];

inventory::submit! {
    Entity::shader("normals", "bumps by an image of their normals", &[TABLE], |args| {
        let (texture, strength) = (args.get(&TEXTURE), args.get(&STRENGTH));
        let repeat = DVec2::from(args.get(&REPEAT).map(|count| count as f64));
        let colours = args.get(&SHADER).unwrap_or_default();
        let normals = move || Normals { texture: texture.clone(), repeat, strength };
        Ok(ShaderFactory::new(move |anchor| Bent { bend: normals(), colours: colours.on(anchor) }))
    })
    .known_as(&["normal_map", "normalmap"])
}

struct Normals {
    texture: Arc<Texture>,
    repeat: DVec2,
    strength: f64,
}

impl Normals {
    /// Returns the components of the normal at u and v, blended from the four nearest texels.
    fn parts<N: Number>(&self, uv: [N; 2]) -> Option<[N; 3]> {
        let (n, [width, height]) = (N::constant, self.texture.size());
        let place = [0, 1].map(|axis| {
            let along = uv[axis] * n(self.repeat[axis]);
            along.plain().map_or(along, |along| n(along - along.floor())) * n([width, height][axis].into())
        });
        let texel = |at: DVec2| self.texture.numbers(repeated(at.x, width), repeated(at.y, height));
        let numbers = blended(place, texel)?;
        Some(numbers.map(|part| n(2.0) * part - n(1.0)))
    }
}

impl Bend for Normals {
    const SEES: ShaderInputs = ShaderInputs { tangents: true, ..ShaderInputs::UV };

    /// Where there are no u and v, the normal is straight.
    fn bent<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        let (Some(uv), Some([along_u, along_v])) = (at.uv, at.tangents) else {
            return at.plain.map(|_| normal);
        };
        let [x, y, z] = self.parts(uv)?;
        let (strength, z) = (N::constant(self.strength), z.max(N::constant(0.0)));
        let slope = |axis: usize| strength * (x * along_u[axis] + y * along_v[axis]);
        N::along(per_axis(|axis| slope(axis) + z * normal[axis]), normal)
    }
}
