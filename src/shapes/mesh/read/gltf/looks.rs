//! The materials of glTF.

use super::buffers::{Buffers, data, unescaped};
use super::json::{self, Gltf, SpecularGlossiness, Transform};
use crate::mesh::read::finish::{Factor, Finish, Map, Opacity, Polish, Wrap};
use crate::mesh::read::model::{MemoryBudget, Model, Remark};
use crate::mesh::read::textures::{Textures, first_of};
use glam::{DMat2, DVec2, DVec3};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use tabray_world::interface::shininess;
use tabray_world::material::Rgb;
use tabray_world::text;
use tabray_world::texture::{CUTOFF, Texture};

/// The material extensions that are rendered, or do not change what is rendered.
const SHOWN: [&str; 7] = [
    SPECULAR_GLOSSINESS,
    CLEARCOAT,
    VOLUME,
    "KHR_materials_emissive_strength",
    "KHR_materials_transmission",
    "KHR_materials_ior",
    "KHR_materials_specular",
];

const CLEARCOAT: &str = "KHR_materials_clearcoat";
const VOLUME: &str = "KHR_materials_volume";

const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";

/// The greatest roughness of metal that is rendered by facets.
const ROUGHEST: f64 = 0.5;

/// The reflectivity of what is no metal.
const DIELECTRIC: f64 = 0.04;

/// Sets the names of the model's materials and, if wanted, their appearances.
pub fn furnish(
    model: &mut Model,
    json: &Gltf,
    buffers: &Buffers,
    folder: &Path,
    budget: &MemoryBudget,
) -> Result<(), String> {
    let name = |(index, material): (usize, &json::Material)| {
        material.name.clone().unwrap_or_else(|| format!("material {index}"))
    };
    model.materials = json.materials.iter().enumerate().map(name).collect();
    if model.slots.iter().all(|slot| *slot == 0) {
        (model.slots, model.materials) = Default::default();
    }
    if budget.wanted.materials.is_none() || model.materials.is_empty() {
        return Ok(());
    }
    let mut looks = Looks {
        json,
        buffers,
        textures: Textures::new(folder, budget),
        unseen: BTreeSet::new(),
        images: Vec::new(),
        covers_in_part: budget.wanted.covers_in_part(),
        tints: !model.attributes.colours.is_empty(),
    };
    looks.images.resize(json.images.len(), None);
    for material in &json.materials {
        let finish = looks.finish(material)?;
        model.finishes.push(Some(finish));
    }
    let Looks { textures, unseen, .. } = looks;
    if !unseen.is_empty() {
        let unseen: Vec<_> = unseen.into_iter().collect();
        model.remarks.push(Remark {
            message: format!("has materials with properties that are not shown: {}", first_of(&unseen)),
            help: "the rest of the materials is shown",
        });
    }
    textures.finish(model);
    Ok(())
}

struct Looks<'f> {
    json: &'f Gltf,
    buffers: &'f Buffers<'f>,
    textures: Textures<'f>,
    /// The names of properties that are not rendered.
    unseen: BTreeSet<String>,
    /// The images that were read, or `None` inside for those that cannot be.
    images: Vec<Option<Option<Arc<Texture>>>>,
    /// Whether surfaces may cover a part of what is behind them, and be glass, metal and plastic, as by the free rules.
    covers_in_part: bool,
    /// Whether vertices have colours.
    tints: bool,
}

impl Looks<'_> {
    fn finish(&mut self, material: &json::Material) -> Result<Finish, String> {
        let json::Pbr {
            base_color_factor: [red, green, blue, alpha],
            base_color_texture,
            metallic_factor,
            roughness_factor,
            metallic_roughness_texture,
        } = &material.pbr_metallic_roughness;
        let mut hide = |is_hidden: bool, what: &str| {
            if is_hidden {
                self.unseen.insert(what.to_owned());
            }
        };
        hide(material.occlusion_texture.is_some(), "occlusionTexture");
        let extension = |name: &str, number: &str| material.extensions.get(name)?.get(number)?.as_f64();
        for name in material.extensions.keys().filter(|name| !SHOWN.contains(&&name[..])) {
            hide(true, &text::abridged(name));
        }
        let shown = material.extensions.iter().filter(|(name, _)| SHOWN.contains(&&name[..]));
        for (name, extension) in shown.filter(|(name, _)| name[..] != *SPECULAR_GLOSSINESS) {
            let keys = extension.as_object().into_iter().flat_map(|extension| extension.keys());
            // Light passes through the triangles, however thick the file says that they are.
            for key in keys.filter(|key| key.ends_with("Texture") && *key != "thicknessTexture") {
                hide(true, &text::abridged(&format!("{key} of {name}")));
            }
        }
        let colour =
            |red: f64, green: f64, blue: f64| Rgb::new(red, green, blue).clamp(Rgb::ZERO, Rgb::splat(1e6));
        let strength = extension("KHR_materials_emissive_strength", "emissiveStrength").unwrap_or(1.0);
        let [r, g, b] = material.emissive_factor.map(|channel| channel * strength);
        let passed = extension("KHR_materials_transmission", "transmissionFactor").unwrap_or(0.0);
        let mut finish = Finish {
            colour: colour(*red, *green, *blue),
            emission: colour(r, g, b),
            transparency: passed.clamp(0.0, 1.0),
            colours: self.map(base_color_texture.as_ref())?,
            emissions: self.map(material.emissive_texture.as_ref())?,
            ..Finish::default()
        };
        let normals = self.map(material.normal_texture.as_ref())?;
        let slopes = material.normal_texture.as_ref().and_then(|normals| normals.scale).unwrap_or(1.0);
        finish.normals = normals.map(|map| (map, slopes));
        self.set_opacity(&mut finish, material, *alpha);
        let map = self.map(metallic_roughness_texture.as_ref())?;
        let factor = |factor: f64, channel: usize| match &map {
            Some(map) => Factor::of_image(factor, map.clone(), channel),
            None => factor.into(),
        };
        (finish.metal, finish.roughness) = (factor(*metallic_factor, 2), factor(*roughness_factor, 1));
        finish.polish = self.polish(material, &finish);
        finish.shininess = match finish.polish {
            Some(Polish::Metal { roughness, .. }) => shininess(roughness),
            // So that such materials do not differ. Each point has its own.
            Some(Polish::Metallic) => shininess(1.0),
            _ => 0.0,
        };
        if let Some(other) = material.extensions.get(SPECULAR_GLOSSINESS) {
            let other = SpecularGlossiness::deserialize(other)
                .map_err(|error| format!("one of its materials is not glTF: {error}"))?;
            finish.polish = None;
            self.by_specular_glossiness(&mut finish, &other)?;
            self.set_opacity(&mut finish, material, other.diffuse_factor[3]);
        }
        Ok(finish)
    }

    /// Returns what a material is besides its colours: glass with an inside, metal, or a coat. Thin glass is a pane that
    /// light passes unbent.
    fn polish(&mut self, material: &json::Material, finish: &Finish) -> Option<Polish> {
        if !self.covers_in_part {
            let names =
                [VOLUME, CLEARCOAT].into_iter().filter(|name| material.extensions.contains_key(*name));
            self.unseen.extend(names.map(str::to_owned));
            return None;
        }
        let number = |name: &str, number: &str| material.extensions.get(name)?.get(number)?.as_f64();
        let index = number("KHR_materials_ior", "ior").filter(|index| *index >= 1.0).unwrap_or(1.5).min(4.0);
        let ([metal, _], [_, roughness]) = (finish.metal.range(), finish.roughness.range());
        if finish.transparency > 0.0
            && number(VOLUME, "thicknessFactor").is_some_and(|thickness| thickness > 0.0)
        {
            let colour = material.extensions.get(VOLUME).and_then(|volume| volume.get("attenuationColor"));
            let channel = |at: usize| colour.and_then(|colour| colour.get(at)?.as_f64()).unwrap_or(1.0);
            let left = Rgb::new(channel(0), channel(1), channel(2)).clamp(Rgb::splat(1e-6), Rgb::ONE);
            let at = number(VOLUME, "attenuationDistance").filter(|at| *at > 0.0);
            let left = if at.is_some() { left } else { Rgb::ONE };
            let varies = finish.roughness.varies();
            return Some(Polish::Glass { index, roughness, varies, left, at: at.unwrap_or(1.0) });
        }
        let varies = finish.metal.varies() || finish.roughness.varies();
        // Very rough metal is rendered as scattering, so that any lamp lights it.
        if metal >= 0.5
            && !varies
            && roughness <= ROUGHEST
            && finish.colours.is_none()
            && !self.tints
            && finish.transparency == 0.0
        {
            let colour = finish.colour.clamp(Rgb::ZERO, Rgb::ONE);
            return Some(Polish::Metal { colour, roughness });
        }
        let coat = number(CLEARCOAT, "clearcoatFactor").unwrap_or(0.0);
        if coat >= 0.5 && metal < 0.5 && finish.transparency == 0.0 {
            let roughness = number(CLEARCOAT, "clearcoatRoughnessFactor").unwrap_or(0.0).clamp(0.0, 1.0);
            return Some(Polish::Coat { index: 1.5, roughness });
        }
        if coat > 0.0 {
            self.unseen.insert(CLEARCOAT.to_owned());
        }
        let [_, most] = finish.metal.range();
        (varies && most > 0.0 && finish.transparency == 0.0).then_some(Polish::Metallic)
    }

    /// Sets how opaque a material is, by the alpha of its images times this factor.
    fn set_opacity(&mut self, finish: &mut Finish, material: &json::Material, factor: f64) {
        let map = finish.colours.clone().filter(|map| map.texture.has_alpha());
        finish.opacity = match material.alpha_mode.as_deref() {
            Some("MASK") => Opacity::new(map, 1.0, Some(material.alpha_cutoff.unwrap_or(CUTOFF) / factor)),
            Some("BLEND") if self.covers_in_part => Opacity::new(map, factor, None),
            Some("BLEND") => {
                // The notes' rules know no coverage, but glass.
                finish.transparency = 1.0 - factor.clamp(0.0, 1.0) * (1.0 - finish.transparency);
                Opacity::new(map, 1.0, Some(CUTOFF))
            }
            _ => None,
        };
    }

    /// Sets what a material of the extension says instead: where its specular colour is brighter than that of what is no
    /// metal, it is a metal of this colour.
    fn by_specular_glossiness(
        &mut self,
        finish: &mut Finish,
        material: &SpecularGlossiness,
    ) -> Result<(), String> {
        let [red, green, blue, _] = material.diffuse_factor;
        let specular = DVec3::from(material.specular_factor).clamp(DVec3::ZERO, DVec3::ONE);
        let brightness = specular.max_element();
        let metal = ((brightness - DIELECTRIC) / (1.0 - DIELECTRIC)).max(0.0);
        let diffuse = DVec3::new(red, green, blue).clamp(DVec3::ZERO, DVec3::splat(1e6));
        finish.colours = self.map(material.diffuse_texture.as_ref())?;
        // With an image of both, the factors say little about either.
        let (metal, colour) = match &material.specular_glossiness_texture {
            Some(_) => {
                self.unseen.insert("specularGlossinessTexture".to_owned());
                (0.0, diffuse)
            }
            None => (metal, diffuse.lerp(specular, metal)),
        };
        finish.colour = colour;
        (finish.metal, finish.roughness) = (metal.into(), (1.0 - material.glossiness_factor).into());
        Ok(())
    }

    /// Returns an image as a material uses it, or `None` if it is missing or cannot be read.
    fn map(&mut self, info: Option<&json::TextureInfo>) -> Result<Option<Map>, String> {
        let Some(info) = info else { return Ok(None) };
        let missing = |what: &str, index: usize| format!("there is no {what} {index}");
        let texture = self.json.textures.get(info.index).ok_or_else(|| missing("texture", info.index))?;
        let other = || texture.extensions.values().find_map(|extension| extension.get("source")?.as_u64());
        let Some(source) = texture.source.or_else(|| other().and_then(|source| usize::try_from(source).ok()))
        else {
            self.unseen.insert("textures without an image".to_owned());
            return Ok(None);
        };
        let plain = Transform::default();
        let Transform { offset, scale, rotation, tex_coord } =
            info.extensions.transform.as_ref().unwrap_or(&plain);
        if tex_coord.unwrap_or(info.tex_coord) != 0 {
            self.unseen.insert("images by TEXCOORD_1".to_owned());
            return Ok(None);
        }
        let sampler = texture.sampler.and_then(|index| self.json.samplers.get(index));
        let wrap = |wrap: Option<u32>| match wrap {
            Some(CLAMP) => Wrap::Clamp,
            Some(MIRROR) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let wrap = sampler.map_or([Wrap::Repeat; 2], |sampler| [sampler.wrap_s, sampler.wrap_t].map(wrap));
        let is_sharp = sampler.and_then(|sampler| sampler.mag_filter) == Some(NEAREST);
        let image = self.json.images.get(source).ok_or_else(|| missing("image", source))?;
        let texture = match &self.images[source] {
            Some(known) => known.clone(),
            None => {
                let texture = self.texture(image, source)?;
                self.images[source] = Some(texture.clone());
                texture
            }
        };
        let (scale, offset) = (DVec2::from(scale.unwrap_or([1.0; 2])), DVec2::from(*offset));
        // Texture coordinates turn counterclockwise as seen. In glTF, v grows downward.
        let (sin, cos) = libm::sincos(*rotation);
        let matrix = DMat2::from_cols(scale.x * DVec2::new(cos, sin), scale.y * DVec2::new(-sin, cos));
        let offset = DVec2::new(offset.x + sin * scale.y, 1.0 - cos * scale.y - offset.y);
        Ok(texture.map(|texture| Map { texture, matrix, offset, wrap, is_sharp }))
    }

    fn texture(&mut self, image: &json::Image, index: usize) -> Result<Option<Arc<Texture>>, String> {
        let place = format!("image {index}");
        let name = image.name.as_deref().unwrap_or(&place);
        Ok(match (&image.uri, image.buffer_view) {
            (Some(uri), _) => match data(uri) {
                Some(bytes) => self.textures.within(&bytes?, name, &place),
                None => self.textures.named(&unescaped(uri), &place),
            },
            (None, Some(view)) => self.textures.within(self.buffers.view(view, 0)?, name, &place),
            (None, None) => None,
        })
    }
}

/// Of OpenGL's numbers, those of wrap modes other than repetition, and of the filter that shows texels as squares.
const CLAMP: u32 = 33071;
const MIRROR: u32 = 33648;
const NEAREST: u32 = 9728;
