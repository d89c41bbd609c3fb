//! A textured plane: a rectangle that shows an image.

use super::{fplane, plane};
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::rectangle::{Rectangle, along_sides};

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
            let picture = Textured(Picture::new(args, rectangle)?);
            Ok(Body::shaded(fplane::shape(args)?, picture).anchored(args.get(&plane::POINT), 1.0))
        },
    )
}

/// An image on a rectangle.
pub struct Picture {
    rectangle: Rectangle,
    pub texture: Arc<Texture>,
    /// The width and height of a texel in world units where the image is tiled; `None` where it is stretched to fit.
    texel: Option<DVec2>,
    /// The numbers of the scene that these follow from: the normal and `xdir`, of any length, and the image plane's size
    /// in world units and in pixels.
    inputs: PictureInputs,
}

struct PictureInputs {
    normal: DVec3,
    xdir: DVec3,
    screen: DVec2,
    pixels: DVec2,
}

impl Picture {
    /// Makes the image of an entity whose table has the rows of [`TABLE`].
    ///
    /// # Errors
    /// Returns an error if texels are to be as large as pixels and the camera has no image plane.
    pub fn new(args: &Args, rectangle: Rectangle) -> Result<Self, Refusal> {
        let camera = &args.setting.camera;
        let pixels = DVec2::from(camera.pixels.map(|side| side as f64));
        let is_tiled = args.get(&MODE) == 1;
        let screen = match camera.camera.screen() {
            Some(screen) => screen,
            None if is_tiled => {
                return Err(Refusal {
                    attribute: Some("mode"),
                    message:
                        "has texels as large as pixels of an image plane, but the camera has no image plane"
                            .to_owned(),
                    help: "`mode 0` fits the image to the rectangle; `mode 1` needs a `camera`, with its `worlddim`",
                });
            }
            None => DVec2::ONE,
        };
        let texel = is_tiled.then_some(screen / pixels);
        let inputs =
            PictureInputs { normal: args.get(&plane::NORMAL), xdir: args.get(&fplane::XDIR), screen, pixels };
        Ok(Self { rectangle, texture: args.get(&TEXNAME), texel, inputs })
    }

    /// Returns the texel at a point of the rectangle.
    #[inline]
    pub fn colour(&self, at: DVec3) -> Rgb {
        let [column, row] = self.texel(at);
        self.texture.texel(column, row)
    }

    /// Returns the opacity of the texel at a point of the rectangle.
    fn alpha(&self, at: DVec3) -> f64 {
        let [column, row] = self.texel(at);
        self.texture.alpha(column, row)
    }

    /// Returns the column and the row of the texel at a point of the rectangle.
    #[inline]
    pub fn texel(&self, at: DVec3) -> [u32; 2] {
        let across = self.rectangle.coordinates(at);
        let size = self.texture.size();
        let texel = |side: usize| match self.texel {
            None => (across[side] / self.rectangle.dimensions[side] * f64::from(size[side])) as u32,
            Some(texel) => (across[side] / texel[side]) as u32 % size[side].max(1),
        };
        [texel(0), texel(1)]
    }

    /// Encloses the texels at the points of a box in the rectangle's plane.
    pub fn enclose<F: Precise>(&self, at: [Interval<F>; 3]) -> [Interval<F>; 3] {
        let PictureInputs { normal, xdir, screen, pixels } = self.inputs;
        let (corner, n) = (self.rectangle.corner, Interval::<F>::constant);
        let [normal, xdir] = [constants(normal), constants(xdir)];
        let across = along_sides(normal, xdir, per_axis(|axis| at[axis] - n(corner[axis])));
        let size = self.texture.size();
        let range = |side: usize| {
            let texels = match self.texel {
                None => across[side] / n(self.rectangle.dimensions[side]) * n(f64::from(size[side])),
                Some(_) => across[side] * n(pixels[side]) / n(screen[side]),
            };
            let Interval { low, high } = texels.coarse();
            // Infinite ends become the least and the greatest number.
            let exact = texels.certain_floor().map(|at| at as u32..=at as u32);
            let size = if self.texel.is_some() { size[side].max(1) } else { u32::MAX };
            exact.unwrap_or(low as u32..=high as u32).map(move |at| at % size)
        };
        self.texture.enclose(range(0), range(1))
    }
}

struct Textured(Picture);

impl Shader for Textured {
    #[inline]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.ambient * self.0.colour(at.position)
    }

    #[inline]
    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.diffuse * self.0.colour(at.position)
    }

    fn cuts_out(&self) -> bool {
        self.0.texture.cuts_out()
    }

    fn is_cut_out(&self, at: &SurfacePoint) -> bool {
        self.0.texture.is_hole(self.0.alpha(at.position))
    }

    fn covers_in_part(&self) -> bool {
        self.0.texture.covers_in_part()
    }

    fn coverage(&self, at: &SurfacePoint) -> f64 {
        self.0.alpha(at.position)
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let [column, row] = self.0.texel(at.position);
        DVec2::new(column.into(), row.into())
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let (look, texel) = (LookBounds::from(material), self.0.enclose(at.position));
        let times = |colour: [Interval<F>; 3]| per_axis(|channel| colour[channel] * texel[channel]);
        Some(LookBounds { ambient: times(look.ambient), diffuse: times(look.diffuse), ..look })
    }

    /// The material's colours are the bounds, times the brightest texel's.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let (Material { ambient, diffuse, specular, .. }, most) = (material, self.0.texture.brightest());
        let look = Look { ambient: most * *ambient, diffuse: most * *diffuse, specular: *specular };
        (diffuse.min_element() >= 0.0).then_some(look)
    }
}
