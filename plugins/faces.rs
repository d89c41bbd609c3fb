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

    fn colour(&self, at: &SurfacePoint) -> Rgb {
        self.colours[Self::face(at) as usize % self.colours.len()]
    }

    fn most(&self) -> Rgb {
        self.colours.iter().fold(Rgb::ZERO, |most, colour| most.max(*colour))
    }
}

impl Shader for Faces {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::FACE
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.ambient * self.colour(at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.diffuse * self.colour(at)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::new(Self::face(at).into(), 0.0)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let look = LookBounds::from(material);
        let times = |own: [Interval<F>; 3]| {
            let of = |colour: &Rgb| per_axis(|channel| own[channel] * Interval::constant(colour[channel]));
            let hull = |one: [Interval<F>; 3], other: [Interval<F>; 3]| {
                per_axis(|channel| one[channel].hull(other[channel]))
            };
            match at.face {
                Some(face) => Some(of(&self.colours[face as usize % self.colours.len()])),
                None => self.colours.iter().map(of).reduce(hull),
            }
        };
        Some(LookBounds { ambient: times(look.ambient)?, diffuse: times(look.diffuse)?, ..look })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        let is_sound = diffuse.min_element() >= 0.0;
        is_sound.then(|| Look { ambient: ambient * self.most(), diffuse: diffuse * self.most(), specular })
    }
}
