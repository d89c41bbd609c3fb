//! A textured plane: a rectangle that shows a picture.

use super::fplane::{self, FinitePlane};
use super::plane;
use crate::prelude::*;
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
            let picture = Arc::new(Picture::new(args)?);
            Ok(Body::shaded(Rectangle(picture.clone()), Textured(picture)))
        },
    )
}

/// A rectangle and the picture on it.
pub struct Picture {
    pub rectangle: FinitePlane,
    texture: Arc<Texture>,
    /// The width and height of a texel where the picture is tiled; the picture is stretched to fit if there is none.
    texel: Option<DVec2>,
}

impl Picture {
    /// The picture of an entity whose table has the rows of an fplane's and of [`TABLE`].
    pub fn new(args: &Args) -> Result<Self, Refusal> {
        let camera = &args.setting.camera;
        let pixel = camera.screen / DVec2::from(camera.pixels.map(|side| side as f64));
        let texel = (args.get(&MODE) == 1).then_some(pixel);
        Ok(Self { rectangle: FinitePlane::new(args)?, texture: args.get(&TEXNAME), texel })
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

struct Rectangle(Arc<Picture>);

impl Hittable for Rectangle {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.0.rectangle.distance(ray, within)
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        self.0.rectangle.bracket(ray, within)
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.0.rectangle.quick_distance(ray, within)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.0.rectangle.bounds()
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.0.rectangle.is_clear_of(region)
    }

    fn meets_itself(&self, leaving: Side) -> bool {
        self.0.rectangle.meets_itself(leaving)
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.0.rectangle.touches(at, error)
    }

    fn reach(&self) -> f64 {
        self.0.rectangle.reach()
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        self.0.rectangle.fine_distance(ray, distance)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.0.rectangle.normal(at)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        self.0.rectangle.plane()
    }

    fn method(&self) -> String {
        self.0.rectangle.method()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.0.rectangle.certify(sight, precision)
    }
}

struct Textured(Arc<Picture>);

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
