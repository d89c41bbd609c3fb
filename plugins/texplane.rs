//! A textured plane: a rectangle that shows a picture.

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

/// What shows a texture on a rectangle takes, after what an fplane takes.
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

/// A picture on a rectangle.
pub struct Picture {
    rectangle: Rectangle,
    texture: Arc<Texture>,
    /// The width and height of a texel where the picture is tiled; the picture is stretched to fit if there is none.
    texel: Option<DVec2>,
}

impl Picture {
    /// The picture of an entity whose table has [`TABLE`]'s rows.
    pub fn new(args: &Args, rectangle: Rectangle) -> Self {
        let camera = &args.setting.camera;
        let pixel = camera.screen / DVec2::from(camera.pixels.map(|side| side as f64));
        let texel = (args.get(&MODE) == 1).then_some(pixel);
        Self { rectangle, texture: args.get(&TEXNAME), texel }
    }

    /// The texel at a point of the rectangle, each channel from 0 to below 1.
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
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        material.ambient * self.0.colour(at)
    }

    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        material.diffuse * self.0.colour(at)
    }

    /// No texel is above 1, nor below 0.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}
