//! A textured plane: a rectangle that shows an image.

use super::{fplane, plane};
use std::sync::Arc;
use tabray::exact::interval::Wide;
use tabray::prelude::*;
use tabray::shapes::rectangle::{Rectangle, known_sides};

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
    sides: [[Known; 3]; 2],
    pub texture: Arc<Texture>,
    /// The width and height of a texel in world units where the image is tiled; `None` where it is stretched to fit.
    texel: Option<[Known; 2]>,
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
        let n = Wide::constant;
        let texel = [0, 1].map(|side| Known {
            rounded: screen[side] / pixels[side],
            enclosed: n(screen[side]) / n(pixels[side]),
        });
        let sides = known_sides(args.get(&plane::NORMAL), args.get(&fplane::XDIR), rectangle.sides);
        Ok(Self { rectangle, sides, texture: args.get(&TEXNAME), texel: is_tiled.then_some(texel) })
    }

    /// Returns the texel at a point of the rectangle.
    #[inline(always)]
    pub fn colour<N: Number>(&self, at: [N; 3]) -> [N; 3] {
        let size = self.texture.size();
        let texel = |place: [f64; 2]| {
            let [column, row] = self.wrapped(place, size);
            self.texture.texel(column, row)
        };
        N::table(self.place(at, size), || self.texture.brightest(), texel)
    }

    /// Returns the opacity of the texel at a point of the rectangle.
    fn alpha(&self, at: DVec3) -> f64 {
        let [column, row] = self.texel(at);
        self.texture.alpha(column, row)
    }

    /// Returns the column and the row of the texel at a point of the rectangle.
    fn texel(&self, at: DVec3) -> [u32; 2] {
        let size = self.texture.size();
        self.wrapped(self.place(at.to_array(), size), size)
    }

    /// Returns where a point of the rectangle lies among the texels, each of width 1.
    #[inline(always)]
    fn place<N: Number>(&self, at: [N; 3], size: [u32; 2]) -> [N; 2] {
        let (from, n) = (per_axis(|axis| at[axis] - N::constant(self.rectangle.corner[axis])), N::constant);
        let along = |side: usize| {
            let across = dot(Known::vector(&self.sides[side]), from);
            match &self.texel {
                None => across / n(self.rectangle.dimensions[side]) * n(size[side].into()),
                Some(texel) => across / N::known(&texel[side]),
            }
        };
        [along(0), along(1)]
    }

    /// Returns the column or the row of the texture at such a place.
    #[inline(always)]
    fn wrapped(&self, place: [f64; 2], size: [u32; 2]) -> [u32; 2] {
        let texel = |side: usize| match self.texel {
            None => place[side] as u32,
            Some(_) => place[side] as u32 % size[side].max(1),
        };
        [texel(0), texel(1)]
    }
}

struct Textured(Picture);

impl Shader for Textured {
    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own = constants(material.reflectivity(of));
        Some(match of {
            Reflectivity::Specular => own,
            _ => product(own, self.0.colour(at.position)),
        })
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

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        at.plain.map_or_else(|| N::any(0.0, 1.0), |at| N::constant(self.0.alpha(at.position)))
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let [column, row] = self.0.texel(at.position);
        DVec2::new(column.into(), row.into())
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(Rgb::splat(self.0.texture.brightest()))
    }
}
