//! A colour for each face of a box, a prism or a mesh.

use tabray::prelude::*;

static COLOURS: Pparm<List<Rgb, 1, 256>> = Pparm::required(
    "colours",
    "the factors of the ambient and diffuse colours of each face; after the last colour, the first follows again",
)
.alias(&["colors"])
.must("0 or more in each channel", |colours: &List<Rgb, 1, 256>| {
    colours.0.iter().all(|colour| colour.min_element() >= 0.0)
});

const TABLE: Table = &[&COLOURS as &dyn Row];

inventory::submit! {
    Entity::shader("faces", "a colour for each face of a box, a prism or a mesh", &[TABLE], |args| {
        let List(colours) = args.get(&COLOURS);
        Ok(ShaderFactory::new(move |_| Faces { colours: colours.clone() }))
    })
}

struct Faces {
    colours: Vec<Rgb>,
}

impl Faces {
    fn face(at: &SurfacePoint) -> u32 {
        at.face.unwrap_or(0)
    }

    fn most(&self) -> Rgb {
        self.colours.iter().fold(Rgb::ZERO, |most, colour| most.max(*colour))
    }
}

impl Shader for Faces {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::FACE
    }

    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own: [N; 3] = constants(material.reflectivity(of));
        if of == Reflectivity::Specular {
            return Some(own);
        }
        let coloured = |colour: &Rgb| product(own, constants(*colour));
        match at.face {
            None if at.plain.is_none() => self.colours.iter().map(coloured).reduce(hull),
            face => Some(coloured(&self.colours[face.unwrap_or(0) as usize % self.colours.len()])),
        }
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::new(Self::face(at).into(), 0.0)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(self.most())
    }
}
