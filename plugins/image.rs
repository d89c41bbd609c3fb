//! An image on a surface, by its u and v.

use crate::prelude::*;
use std::sync::Arc;

static TEXTURE: Pparm<Arc<Texture>> = Pparm::required("texture", "the texture, defined earlier in the scene");
static REPEAT: Pparm<[i64; 2]> =
    Pparm::or("repeat", "how often the image stands side by side along u and along v", [1, 1])
        .between(1.0, 1e6);
static SMOOTH: Pparm<bool> =
    Pparm::or("smooth", "whether colours between the middles of four texels blend into each other", false);

const TABLE: Table = &[&TEXTURE, &REPEAT, &SMOOTH];

inventory::submit! {
    Entity::shader("image", "an image on a surface, by its u and v", &[TABLE], |args| {
        let (texture, smooth) = (args.get(&TEXTURE), args.get(&SMOOTH));
        let repeat = DVec2::from(args.get(&REPEAT).map(|count| count as f64));
        Ok(Paint::new(move |_| Image { texture: texture.clone(), repeat, smooth }))
    })
}

struct Image {
    texture: Arc<Texture>,
    repeat: DVec2,
    smooth: bool,
}

impl Image {
    /// Returns the numbers of texels along u and v, those of all repetitions.
    fn size(&self) -> DVec2 {
        self.repeat * DVec2::from(self.texture.size().map(f64::from))
    }

    /// Returns where a point lies among the texels, each of width 1; without u and v, in a corner.
    fn place(&self, at: &SurfacePoint) -> DVec2 {
        at.uv.unwrap_or_default() * self.size()
    }

    /// Returns the texel of a column and a row among those of all repetitions. Beyond an edge, it is that at the edge.
    fn texel(&self, at: DVec2) -> Rgb {
        let (at, size) = (at.clamp(DVec2::ZERO, (self.size() - 1.0).max(DVec2::ZERO)), self.texture.size());
        self.texture.texel(at.x as u32 % size[0].max(1), at.y as u32 % size[1].max(1))
    }

    fn colour(&self, at: &SurfacePoint) -> Rgb {
        let place = self.place(at);
        if !self.smooth {
            return self.texel(place.floor());
        }
        let (corner, part) = ((place - 0.5).floor(), (place - 0.5).fract_gl());
        let row = |y: f64| {
            self.texel(corner + DVec2::new(0.0, y)).lerp(self.texel(corner + DVec2::new(1.0, y)), part.x)
        };
        row(0.0).lerp(row(1.0), part.y)
    }
}

impl Shader for Image {
    fn sees(&self) -> Sees {
        Sees::UV
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.ambient * self.colour(at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.diffuse * self.colour(at)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.place(at).floor().min(self.size() - 1.0)
    }

    /// The texel is not known, but its colours are, from 0 to 1.
    fn enclose<F: Precise>(&self, material: &Material, _at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let (look, any) = (LookBounds::from(material), Interval::constant(0.0).hull(Interval::constant(1.0)));
        let times = |colour: [Interval<F>; 3]| per_axis(|channel| colour[channel] * any);
        Some(LookBounds { ambient: times(look.ambient), diffuse: times(look.diffuse), ..look })
    }

    /// The material's colours are the bounds, since texels lie between 0 and 1.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}
