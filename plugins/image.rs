//! An image on a surface, by its u and v.

use std::sync::Arc;
use tabray::prelude::*;

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

    /// Returns where a point lies among the texels, each of width 1; without u and v, in a corner.
    fn place(&self, at: &SurfacePoint) -> DVec2 {
        at.uv.unwrap_or_default() * self.size()
    }

    /// Returns the texel of a column and a row among those of all repetitions. Beyond an edge, it is the one at the
    /// edge.
    fn texel(&self, at: DVec2) -> Rgb {
        self.texture.texel(self.wrapped(at.x, 0), self.wrapped(at.y, 1))
    }

    /// Returns the column or the row in the texture of a column or row among those of all repetitions.
    fn wrapped(&self, at: f64, axis: usize) -> u32 {
        let size = u64::from(self.texture.size()[axis].max(1));
        (at.clamp(0.0, (self.size()[axis] - 1.0).max(0.0)) as u64 % size) as u32
    }

    /// Returns the opacity at a point.
    fn alpha(&self, at: &SurfacePoint) -> f64 {
        self.blend(self.place(at), |column, row| DVec3::splat(self.texture.alpha(column, row))).x
    }

    fn colour(&self, at: &SurfacePoint) -> Rgb {
        if self.texture.covers_in_part() {
            // The colour of the point, not a mean over a patch.
            return self.texture.by_alpha(|texel| self.blend(self.place(at), texel));
        }
        if let Some([low, high]) = at.patch.and_then(|patch| patch.uv) {
            let size = self.size();
            let (low, high) = (low * size, high * size);
            if !self.smooth || (high - low).max_element() > 1.0 {
                return self.mean(low, high);
            }
        }
        self.blend(self.place(at), |column, row| self.texture.texel(column, row))
    }

    /// Returns what `of` returns for the texel at a place or, if colours are interpolated, a blend of four texels.
    fn blend(&self, place: DVec2, of: impl Fn(u32, u32) -> DVec3) -> DVec3 {
        let of = |at: DVec2| of(self.wrapped(at.x, 0), self.wrapped(at.y, 1));
        if !self.smooth {
            return of(place.floor());
        }
        let (corner, part) = ((place - 0.5).floor(), (place - 0.5).fract_gl());
        let row = |y: f64| of(corner + DVec2::new(0.0, y)).lerp(of(corner + DVec2::new(1.0, y)), part.x);
        row(0.0).lerp(row(1.0), part.y)
    }

    /// Returns the mean of a rectangle, given by its corners among the texels of all repetitions.
    fn mean(&self, low: DVec2, high: DVec2) -> Rgb {
        let whole = self.size();
        self.texture.mean_repeated(low.clamp(DVec2::ZERO, whole), high.clamp(DVec2::ZERO, whole))
    }

    /// Encloses the mean between such u and v; `None` where a blend may be shown.
    fn enclosed_mean<N: Number>(&self, uv: [[N; 2]; 2]) -> Option<[N; 3]> {
        let size = self.size();
        let place = |along: N, axis: usize| {
            let size = N::constant(size[axis]);
            (along * size).max(N::constant(0.0)).min(size)
        };
        let [low, high] = uv.map(|[u, v]| [place(u, 0), place(v, 1)]);
        // Near by, interpolated texels are shown as they are.
        let is_far = !self.smooth || (0..2).any(|axis| (high[axis] - low[axis]).bounds()[0] > 1.0);
        if is_far { self.texture.enclose_mean_repeated([low, high]) } else { None }
    }

    /// Encloses the colours at points with such u and v; anything where they are not known.
    fn enclosed<N: Number>(&self, uv: Option<[N; 2]>) -> [N; 3] {
        let any = || [N::any(0.0, self.texture.brightest()); 3];
        let Some([u, v]) = uv else { return any() };
        let size = self.size();
        let place = [u * N::constant(size.x), v * N::constant(size.y)];
        if self.smooth {
            return self.texture.enclose_blended(place, |at| self.texel(at)).unwrap_or_else(any);
        }
        N::table(place, || self.texture.brightest(), |[x, y]| self.texel(DVec2::new(x, y)))
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
        let mean = || at.patch.and_then(|patch| self.enclosed_mean(patch.uv?));
        let texel = match at.plain {
            Some(at) => constants(self.colour(at)),
            None => mean().unwrap_or_else(|| self.enclosed(at.uv)),
        };
        Some(product(own, texel))
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
        self.place(at).floor().min(self.size() - 1.0)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(Rgb::splat(self.texture.brightest()))
    }
}
