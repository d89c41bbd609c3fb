//! A textured plane: a rectangle that shows an image.

use super::{fplane, plane};
use crate::prelude::*;
use crate::shapes::rectangle::Rectangle;
use std::sync::Arc;

static TEXNAME: Pparm<Arc<Texture>> = Pparm::required("texname", "the texture, defined earlier in the scene");
static MODE: Pparm<i64> = Pparm::required(
    "mode",
    "0 stretches the texture to fit, 1 tiles it with one texel per pixel of the image plane",
)
.must("0 or 1", |mode| (0..=1).contains(mode))
.dumped("mode", "\n");

/// The rows of a rectangle with a texture, after those of an fplane.
pub const TABLE: Table = &[&TEXNAME, &MODE];

inventory::submit! {
    Entity::shape(
        "texplane",
        "a rectangle covered with a texture",
        &[plane::TABLE, fplane::TABLE, fplane::ROTATION, TABLE],
        |args| {
            let rectangle = fplane::rectangle(args)?;
            Ok(Body::shaded(fplane::shape(args)?, Textured(Picture::new(args, rectangle))))
        },
    )
}

/// An image on a rectangle.
pub struct Picture {
    rectangle: Rectangle,
    texture: Arc<Texture>,
    /// The width and height of a texel in world units where the image is tiled; `None` where it is stretched to fit.
    texel: Option<DVec2>,
}

impl Picture {
    /// Makes the image of an entity whose table has the rows of [`TABLE`].
    pub fn new(args: &Args, rectangle: Rectangle) -> Self {
        let camera = &args.setting.camera;
        let pixel = camera.screen / DVec2::from(camera.pixels.map(|side| side as f64));
        let texel = (args.get(&MODE) == 1).then_some(pixel);
        Self { rectangle, texture: args.get(&TEXNAME), texel }
    }

    /// Returns the texel at a point of the rectangle, each channel from 0 to 1.
    #[inline]
    pub fn colour(&self, at: DVec3) -> Rgb {
        let across = self.rectangle.coordinates(at);
        let size = self.texture.size();
        let texel = |side: usize| match self.texel {
            None => (across[side] / self.rectangle.dimensions[side] * f64::from(size[side])) as u32,
            Some(texel) => (across[side] / texel[side]) as u32 % size[side].max(1),
        };
        self.texture.texel(texel(0), texel(1))
    }
}

struct Textured(Picture);

impl Shader for Textured {
    #[inline]
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        material.ambient * self.0.colour(at)
    }

    #[inline]
    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        material.diffuse * self.0.colour(at)
    }

    /// The material's colours are the bounds, since texels lie between 0 and 1.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}
