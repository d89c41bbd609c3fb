//! An image on a surface, by its u and v.

use std::sync::Arc;
use tabray::prelude::*;
use tabray::world::repeated::blended;

static TEXTURE: Pparm<Arc<Texture>> = Pparm::required("texture", "the texture, defined earlier in the scene");
static REPEAT: Pparm<[i64; 2]> =
    Pparm::or("repeat", "how often the image repeats along u and along v", [1, 1]).between(1.0, 1e6);
static SMOOTH: Pparm<bool> =
    Pparm::or("smooth", "whether colours are interpolated between the centres of texels", false);

const TABLE: Table = &[&TEXTURE, &REPEAT, &SMOOTH];

inventory::submit! {
    Entity::shader("image", "an image on a surface, by its u and v", &[TABLE], |args| {
        let (texture, smooth) = (args.get(&TEXTURE), args.get(&SMOOTH));
        let repeat = DVec2::from(args.get(&REPEAT).map(|count| count as f64));
        Ok(ShaderFactory::new(move |_| Image { texture: texture.clone(), repeat, smooth }))
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

    /// Returns where such u and v lie among the texels of all repetitions, each of width 1.
    fn place<N: Number>(&self, [u, v]: [N; 2]) -> [N; 2] {
        let size = self.size();
        [u * N::constant(size.x), v * N::constant(size.y)]
    }

    /// Returns u and v of a point in plain numbers; without them, those of a corner.
    fn uv(at: &SurfacePoint) -> [f64; 2] {
        at.uv.unwrap_or_default().to_array()
    }

    /// Returns what `of` returns for the texel at such u and v or, if colours are interpolated, a blend of four texels;
    /// `None` where it is open.
    fn blend<N: Number>(&self, uv: [N; 2], of: impl Fn(u32, u32) -> DVec3) -> Option<[N; 3]> {
        let ([width, height], all) = (self.texture.size(), self.size());
        // Beyond an edge, the texel is that of the edge.
        let texel = |at: f64, all: f64, count: u32| {
            (at.clamp(0.0, (all - 1.0).max(0.0)) as u64 % u64::from(count.max(1))) as u32
        };
        let of = |at: DVec2| of(texel(at.x, all.x, width), texel(at.y, all.y, height));
        match self.smooth {
            true => blended(self.place(uv), of),
            false => Some(N::table(self.place(uv), || self.texture.brightest(), |at| of(at.into()))),
        }
    }

    /// Returns the same of a point in plain numbers.
    fn blend_at(&self, at: &SurfacePoint, of: impl Fn(u32, u32) -> DVec3) -> DVec3 {
        self.blend(Self::uv(at), of).map_or(DVec3::ZERO, DVec3::from)
    }

    /// Returns the opacity at a point.
    fn alpha(&self, at: &SurfacePoint) -> f64 {
        self.blend_at(at, |column, row| DVec3::splat(self.texture.alpha(column, row))).x
    }

    /// Returns the colour at a point, or the mean over the patch around it; `None` where it is open.
    fn colour<N: Number>(&self, at: &Point<N>) -> Option<[N; 3]> {
        if self.texture.covers_in_part() {
            // The colour of the point, not a mean over a patch.
            return at.plain.map(|at| constants(self.texture.by_alpha(|texel| self.blend_at(at, texel))));
        }
        if let Some(corners) = at.patch.as_ref().and_then(|patch| patch.uv) {
            let [low, high] = corners.map(|uv| self.place(uv));
            let is_within_a_texel =
                |axis: usize| Some((N::constant(1.0) - (high[axis] - low[axis])).sign()? == N::constant(1.0));
            // Near by, interpolated texels are shown as they are.
            if !(self.smooth && is_within_a_texel(0)? && is_within_a_texel(1)?) {
                let size = self.size();
                let clamped = |of: [N; 2]| {
                    [0, 1].map(|axis| of[axis].max(N::constant(0.0)).min(N::constant(size[axis])))
                };
                return self.texture.mean_repeated([clamped(low), clamped(high)]);
            }
        }
        let uv = at.uv.or(at.plain.map(|at| Self::uv(at).map(N::constant)))?;
        self.blend(uv, |column, row| self.texture.texel(column, row))
    }
}

impl Shader for Image {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs { patch: true, ..ShaderInputs::UV }
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
        let most = || [N::any(0.0, self.texture.brightest()); 3];
        Some(product(own, self.colour(at).unwrap_or_else(most)))
    }

    fn cuts_out(&self) -> bool {
        self.texture.cuts_out()
    }

    fn is_cut_out(&self, at: &SurfacePoint) -> bool {
        self.texture.is_hole(self.alpha(at))
    }

    fn covers_in_part(&self) -> bool {
        self.texture.covers_in_part()
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        at.plain.map_or_else(|| N::any(0.0, 1.0), |at| N::constant(self.alpha(at)))
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::from(self.place(Self::uv(at))).floor().min(self.size() - 1.0)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(Rgb::splat(self.texture.brightest()))
    }
}
