//! Appearances of faces as given by a mesh's file.

use super::read::{Finish, Map, Opacity, Polish, Wrap};
use super::surface::Surface;
use crate::uv;
use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, per_axis};
use tabray_world::interface::{Gloss, Law};
use tabray_world::luminous::{Luminous, Triangles};
use tabray_world::material::{Look, Material, Reflectivity, Rgb};
use tabray_world::number::{Number, coarse, product};
use tabray_world::patch::Patch;
use tabray_world::shader::Shader;
use tabray_world::surface_point::{Point, ShaderInputs, SurfacePoint};

/// The materials, the images and the colours of a mesh's file.
///
/// As for [`Painted`](super::Painted), the point alone determines the face.
pub struct Finished {
    surface: Arc<Surface>,
    has_images: bool,
    bends: bool,
    cuts_out: bool,
    covers_in_part: bool,
}

/// A point of a face.
struct Spot<'s> {
    face: usize,
    finish: Option<&'s Finish>,
    corners: [DVec3; 3],
    at: DVec3,
}

impl Spot<'_> {
    /// Returns the texture coordinates at a point of the face's plane.
    fn uv(&self, [a, b, c]: [DVec2; 3], at: DVec3) -> DVec2 {
        let weights = uv::on_triangle(self.corners, at);
        a + weights.x * (b - a) + weights.y * (c - a)
    }
}

impl Finished {
    /// Makes the shader of a surface with the materials of its file.
    pub fn new(surface: Arc<Surface>) -> Self {
        let any = |is: fn(&Finish) -> bool| surface.finishes.iter().flatten().any(is);
        let has_images = any(|finish| finish.maps().next().is_some());
        let bends = any(|finish| finish.normals.is_some());
        let used = |is: fn(&Opacity) -> bool| {
            let is = |finish: &Finish| finish.opacity.as_ref().is_some_and(is);
            surface.finishes.iter().flatten().any(is)
                && surface.slots.iter().any(|slot| surface.finish(*slot).is_some_and(is))
        };
        let are_thin = surface.colours.values.iter().any(|[.., covered]| *covered < 1.0);
        let cuts_out = used(Opacity::has_holes);
        let covers_in_part = are_thin || used(Opacity::covers_in_part);
        Self { surface, has_images, bends, cuts_out, covers_in_part }
    }

    /// Returns the material of the faces of a slot, as far as it is the same at all of their points. The mesh itself has
    /// the material `own`, and `polished` returns a material with a polish.
    pub fn material(
        &self,
        slot: u16,
        own: &Material,
        polished: impl Fn(Material, &Polish) -> Material,
    ) -> Material {
        let Some(finish) = self.surface.finish(slot) else { return own.clone() };
        let Finish { shininess, transparency, highlight, .. } = *finish;
        let material = Material { shininess, transparency, highlight, ..own.clone() };
        finish.polish.iter().fold(material, polished)
    }

    fn spot(&self, at: DVec3) -> Spot<'_> {
        let face = self.surface.face_at(at);
        Spot { face, finish: self.finish(face), corners: self.surface.corners(face), at }
    }

    /// Returns the material of a face in the file.
    fn finish(&self, face: usize) -> Option<&Finish> {
        self.surface.finish(*self.surface.slots.get(face)?)
    }

    /// Returns the position of a spot in an image, and the extent of a patch there, both in texels.
    fn place(&self, spot: &Spot, map: &Map, patch: Option<Patch>) -> Option<[DVec2; 2]> {
        let corners = self.surface.uv.at(spot.face)?.map(|[u, v]| DVec2::new(u.into(), v.into()));
        let middle = spot.uv(corners, spot.at);
        let reach = |side: DVec3| (spot.uv(corners, spot.at + side) - middle).abs();
        let extent = patch.map_or(DVec2::ZERO, |patch| reach(patch.sides[0]) + reach(patch.sides[1]));
        let [place, extent] = map.place(middle, extent);
        place.is_finite().then_some([place, extent])
    }

    /// Returns the colour of an image at a spot, or white without an image.
    fn light(&self, spot: &Spot, map: Option<&Map>, patch: Option<Patch>) -> Rgb {
        let Some(map) = map else { return Rgb::ONE };
        let Some([place, extent]) = self.place(spot, map, patch) else { return Rgb::ONE };
        if extent.max_element() > 1.0 {
            let [mut low, mut high] = [place - 0.5 * extent, place + 0.5 * extent];
            let size = DVec2::from(map.texture.size().map(f64::from));
            for axis in (0..2).filter(|axis| map.wrap[*axis] != Wrap::Repeat) {
                (low[axis], high[axis]) = (low[axis].max(0.0), high[axis].min(size[axis]));
            }
            return map.texture.mean_between(low, high);
        }
        map.blended(place, |column, row| map.texture.texel(column, row))
    }

    /// Returns the colour of the image of a finish at a spot, or white without an image. Where a part is covered, it is
    /// that of the point, not the mean over a patch.
    fn light_by_alpha(&self, spot: &Spot, finish: &Finish, patch: Option<Patch>) -> Rgb {
        let Some(map) = &finish.colours else { return Rgb::ONE };
        let covers_in_part = finish.opacity.as_ref().is_some_and(Opacity::covers_in_part);
        if !covers_in_part || !map.texture.has_alpha() {
            return self.light(spot, Some(map), patch);
        }
        self.place(spot, map, None)
            .map_or(Rgb::ONE, |[place, _]| map.texture.by_alpha(|texel| map.blended(place, texel)))
    }

    /// Returns the corner colours of a face, blended at a spot, or white if it has none.
    fn tint(&self, spot: &Spot) -> Rgb {
        let Some(colours) = self.surface.colours.at(spot.face) else { return Rgb::ONE };
        self.blended(spot, colours.map(|[red, green, blue, _]| [red, green, blue]))
    }

    /// Returns the fraction that the corner colours of a face cover at a spot.
    fn covered_by_corners(&self, spot: &Spot) -> f64 {
        let Some(colours) = self.surface.colours.at(spot.face) else { return 1.0 };
        self.blended(spot, colours.map(|[.., covered]| [covered; 3])).x
    }

    /// Blends values at the corners of a face.
    fn blended(&self, spot: &Spot, values: [[f32; 3]; 3]) -> DVec3 {
        let [a, b, c] = values.map(|value| DVec3::from(value.map(f64::from)));
        let weights = uv::on_triangle(spot.corners, spot.at).clamp(DVec2::ZERO, DVec2::ONE);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        (a + weights.x * (b - a) + weights.y * (c - a)).clamp(low, high)
    }

    fn colour(&self, spot: &Spot, finish: &Finish, patch: Option<Patch>) -> Rgb {
        finish.colour * self.light_by_alpha(spot, finish, patch) * self.tint(spot)
    }

    /// Bounds the channels of all corner colours.
    fn brightest_tint(&self) -> Rgb {
        let colours = &self.surface.colours.values;
        let most = colours.iter().flatten().fold(0.0_f32, |most, channel| most.max(*channel));
        if colours.is_empty() { Rgb::ONE } else { Rgb::splat(most.max(1.0).into()) }
    }

    /// Bounds the appearances of all faces. The mesh itself has the material `own`.
    fn most(&self, own: &Material) -> Look {
        let tint = self.brightest_tint();
        let plain = Look {
            ambient: own.ambient.abs() * tint,
            diffuse: own.diffuse.abs() * tint,
            specular: own.specular.abs(),
        };
        let brightest = |map: Option<&Map>| map.map_or(1.0, |map| map.texture.brightest().max(1.0));
        self.surface.finishes.iter().flatten().fold(plain, |most, finish| {
            let colour = finish.colour * brightest(finish.colours.as_ref()) * tint;
            let emission = finish.emission * brightest(finish.emissions.as_ref());
            let [little, much] = finish.mirrored_range();
            Look {
                ambient: most.ambient.max(own.ambient.abs() * colour + emission),
                diffuse: most.diffuse.max(colour * (1.0 - little)),
                specular: most.specular.max(colour * much + finish.specular),
            }
        })
    }

    /// Returns a reflectivity at a point.
    fn shown(&self, of: Reflectivity, material: &Material, at: &SurfacePoint) -> Rgb {
        let spot = self.spot(at.position);
        let colour = |finish: &Finish| self.colour(&spot, finish, at.patch);
        let mirrored = |finish: &Finish| finish.mirrored(|map| Some(self.place(&spot, map, None)?[0]));
        match (of, spot.finish) {
            (Reflectivity::Specular, None) => material.specular,
            (_, None) => material.reflectivity(of) * self.tint(&spot),
            (Reflectivity::Ambient, Some(finish)) => {
                let emission = finish.emission * self.light(&spot, finish.emissions.as_ref(), at.patch);
                material.ambient * colour(finish) + emission
            }
            (Reflectivity::Diffuse, Some(finish)) => colour(finish) * (1.0 - mirrored(finish)),
            (Reflectivity::Specular, Some(finish)) => {
                let part = mirrored(finish);
                let mirrored = if part == 0.0 { Rgb::ZERO } else { colour(finish) };
                mirrored * part + finish.specular
            }
        }
    }

    /// Encloses the colours of an image for these bounds of barycentric weights on a face.
    fn enclosed<N: Number>(&self, face: usize, weights: [Interval; 2], map: Option<&Map>) -> [N; 3] {
        let white = [N::constant(1.0); 3];
        let (Some(map), Some(corners)) = (map, self.surface.uv.at(face)) else { return white };
        let n = Interval::<f64>::constant;
        let texels = |axis: usize| {
            let at = [0, 1].map(|axis| {
                let [a, b, c] = corners.map(|uv| n(uv[axis].into()));
                a + weights[0] * (b - a) + weights[1] * (c - a)
            });
            let size = map.texture.size()[axis];
            let [along_u, along_v] = [map.matrix.x_axis[axis], map.matrix.y_axis[axis]];
            let at = at[0] * n(along_u) + at[1] * n(along_v) + n(map.offset[axis]);
            let Interval { low, high } = at * n(size.into()) - n(0.5);
            // Blended colours lie between those of the surrounding texels.
            let (low, high) = (low.floor() as i64, (high.floor() as i64).saturating_add(1));
            (low..=high).map(move |at| map.wrap[axis].texel(at, size))
        };
        map.texture.enclose(texels(0), texels(1))
    }
}

impl Shader for Finished {
    fn sees(&self) -> ShaderInputs {
        let inputs = if self.bends { ShaderInputs::NORMAL } else { ShaderInputs::POSITION };
        ShaderInputs { patch: self.has_images, ..inputs }
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        if let Some(at) = at.plain {
            return Some(constants(self.shown(of, material, at)));
        }
        if self.bends {
            return None;
        }
        let n = N::constant;
        let coarse = at.position.map(coarse);
        let face = self.surface.face_at(DVec3::from(coarse.map(Interval::middle)));
        if !self.surface.is_alone(coarse, |other| other == face) {
            let (most, own) = (self.most(material).reflectivity(of), material.reflectivity(of));
            // The mesh's own ambient and specular reflectivities may be negative.
            return Some(per_axis(|channel| {
                let own = own[channel] * self.brightest_tint()[channel];
                n(0.0).hull(n(most[channel])).hull(n(own))
            }));
        }
        let weights = uv::bounds_on_triangle(self.surface.corners(face), coarse);
        let tint = match self.surface.colours.at(face) {
            None => [n(1.0); 3],
            Some(colours) => per_axis(|channel| {
                let [a, b, c] = colours.map(|colour| n(colour[channel].into()));
                let [second, third] = weights.map(|weight| N::any(weight.low, weight.high));
                a + second * (b - a) + third * (c - a)
            }),
        };
        let own = constants(material.reflectivity(of));
        let Some(finish) = self.finish(face) else {
            return Some(if of == Reflectivity::Specular { own } else { product(own, tint) });
        };
        let light = |map: &Option<Map>| self.enclosed::<N>(face, weights, map.as_ref());
        let colour = product(product(constants(finish.colour), light(&finish.colours)), tint);
        let between = |low: f64, high: f64| if low == high { n(low) } else { N::any(low, high) };
        let [little, much] = finish.mirrored_range();
        let (times, more) = match of {
            Reflectivity::Ambient => (own, product(constants(finish.emission), light(&finish.emissions))),
            Reflectivity::Diffuse => ([between(1.0 - much, 1.0 - little); 3], [n(0.0); 3]),
            Reflectivity::Specular => ([between(little, much); 3], constants(finish.specular)),
        };
        Some(per_axis(|channel| colour[channel] * times[channel] + more[channel]))
    }

    fn emission(&self, at: &SurfacePoint) -> Rgb {
        let spot = self.spot(at.position);
        let given =
            |finish: &Finish| finish.emission * self.light(&spot, finish.emissions.as_ref(), at.patch);
        spot.finish.map_or(Rgb::ZERO, given)
    }

    fn glowing(&self) -> Vec<(Luminous, Rgb)> {
        let mut parts: Vec<(Rgb, Vec<[DVec3; 3]>)> = Vec::new();
        for face in 0..if self.cuts_out || self.covers_in_part { 0 } else { self.surface.face_count() } {
            let even = self.finish(face).filter(|finish| finish.emissions.is_none());
            let Some(light) = even.map(|finish| finish.emission).filter(|light| *light != Rgb::ZERO) else {
                continue;
            };
            let corners = self.surface.corners(face);
            match parts.iter_mut().find(|(known, _)| *known == light) {
                Some((_, faces)) => faces.push(corners),
                None => parts.push((light, vec![corners])),
            }
        }
        let luminous = |faces: Vec<[DVec3; 3]>| Luminous::Triangles(Triangles::new(faces));
        parts.into_iter().map(|(light, faces)| (luminous(faces), light)).collect()
    }

    fn bends(&self) -> bool {
        self.bends
    }

    /// Applies the normal map along the directions of the texture coordinates on the face.
    fn bend<N: Number>(&self, at: &Point<N>, _normal: [N; 3]) -> Option<[N; 3]> {
        let at = at.plain?;
        let spot = self.spot(at.position);
        let Some((map, strength)) = spot.finish.and_then(|finish| finish.normals.as_ref()) else {
            return Some(constants(at.normal));
        };
        let along = self.surface.uv.at(spot.face).and_then(|uv| along(spot.corners, uv));
        let (Some([along_u, along_v]), Some([place, _])) = (along, self.place(&spot, map, None)) else {
            return Some(constants(at.normal));
        };
        let DVec3 { x, y, z } =
            2.0 * map.blended(place, |column, row| map.texture.numbers(column, row)) - 1.0;
        let upright = |along: DVec3| (along - along.dot(at.normal) * at.normal).normalize_or_zero();
        let bent = *strength * (x * upright(along_u) + y * upright(along_v)) + z.max(0.0) * at.normal;
        Some(constants(bent.try_normalize().unwrap_or(at.normal)))
    }

    fn cuts_out(&self) -> bool {
        self.cuts_out
    }

    fn is_cut_out(&self, at: &SurfacePoint) -> bool {
        let spot = self.spot(at.position);
        let opacity = spot.finish.and_then(|finish| finish.opacity.as_ref());
        opacity.is_some_and(|opacity| opacity.is_hole(|map| Some(self.place(&spot, map, None)?[0])))
    }

    fn covers_in_part(&self) -> bool {
        self.covers_in_part
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        if let Some(at) = at.plain {
            let spot = self.spot(at.position);
            let opacity = spot.finish.and_then(|finish| finish.opacity.as_ref());
            let covered =
                opacity.map_or(1.0, |opacity| opacity.coverage(|map| Some(self.place(&spot, map, None)?[0])));
            return N::constant(covered * self.covered_by_corners(&spot));
        }
        let range = |finish: Option<&Finish>| {
            finish.and_then(|finish| finish.opacity.as_ref()).map_or([1.0; 2], Opacity::range)
        };
        let coarse = at.position.map(coarse);
        let face = self.surface.face_at(DVec3::from(coarse.map(Interval::middle)));
        let is_known =
            self.surface.colours.is_empty() && self.surface.is_alone(coarse, |other| other == face);
        let [low, high] = if is_known { range(self.finish(face)) } else { [0.0, 1.0] };
        N::any(low, high)
    }

    fn gloss(&self, at: &SurfacePoint) -> Option<Gloss> {
        let spot = self.spot(at.position);
        let finish = spot.finish?;
        let place = |map: &Map| Some(self.place(&spot, map, None)?[0]);
        let law = match finish.polish? {
            Polish::Glass { index, .. } => Law::Fresnel(index),
            Polish::Metallic => Law::metal(self.colour(&spot, finish, at.patch), finish.metal.at(place)),
            Polish::Metal { .. } | Polish::Coat { .. } => return None,
        };
        Some(Gloss { law, roughness: finish.roughness.at(place) })
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let spot = self.spot(at.position);
        let slot = self.surface.slots.get(spot.face).copied().unwrap_or(0);
        let map = spot.finish.and_then(|finish| finish.colours.as_ref());
        let place =
            map.and_then(|map| self.place(&spot, map, None)).map_or(DVec2::ZERO, |[place, _]| place.floor());
        // Multiples of 2^32, which no image reaches, tell materials apart.
        place + DVec2::new(f64::from(slot) * 4_294_967_296.0, 0.0)
    }

    /// Returns bounds of the appearances of all faces, unless the mesh's own diffuse colour is negative.
    fn brightest(&self, material: &Material) -> Option<Look> {
        (material.diffuse.min_element() >= 0.0).then(|| self.most(material))
    }
}

/// Returns the directions on a face in which u grows at constant v, and v at constant u.
fn along([a, b, c]: [DVec3; 3], uv: [[f32; 2]; 3]) -> Option<[DVec3; 2]> {
    let [from, to, other] = uv.map(|[u, v]| DVec2::new(u.into(), v.into()));
    let (one, two) = (to - from, other - from);
    let turn = one.perp_dot(two);
    let (first, second) = (b - a, c - a);
    let along_u = (first * two.y - second * one.y) * turn.signum();
    let along_v = (second * one.x - first * two.x) * turn.signum();
    (turn != 0.0).then_some(())?;
    Some([along_u.try_normalize()?, along_v.try_normalize()?])
}
