//! The attributes that all entities of a kind have besides those of their tables.

use crate::accuracy::Accuracy;
use crate::body::ShaderFactory;
use crate::display::{Tone, Transfer};
use crate::material::Material;
use crate::rules::{Falloff, Rules};
use crate::sample::Sampler;
use crate::scene::pparm::{Pparm, Row, Table};
use std::sync::Arc;

/// The attributes that every object has besides its own.
pub(super) static MATERIAL: Pparm<Arc<Material>> =
    Pparm::required("material", "the material, defined earlier in the scene");

pub(super) const OBJECT: Table = &[&MATERIAL];

/// The material of an object that is made of others, used instead of [`MATERIAL`].
pub(super) static MATERIAL_OF_ALL: Pparm<Option<Arc<Material>>> =
    Pparm::or("material", "the material of the whole object; without it, each part keeps its own", None);

pub(super) const OF_OBJECTS: Table = &[&MATERIAL_OF_ALL];

/// An object whose own table has a `shader` does not have this one.
pub(super) static SHADER: Pparm<Option<ShaderFactory>> = Pparm::or(
    "shader",
    "the shader that gives the look, defined earlier in the scene, or a type of shader",
    None,
);

/// The size of the image, which every camera has.
pub(super) static PIXELDIM: Pparm<[i64; 2]> =
    Pparm::required("pixeldim", "the width and height of the image")
        .alias(&["pixel_dim"])
        .each(&["width", "height"])
        .unit("pixels")
        .between(1.0, 100_000.0)
        .dumped("pixel_dim", " \n");

pub(super) static SAMPLES: Pparm<i64> =
    Pparm::or("samples", "the number of samples per pixel, to smooth edges", 1)
        .between(1.0, Sampler::MAX_SAMPLES as f64)
        .not_dumped();

pub(super) static ACCURACY: Pparm<Accuracy> =
    Pparm::or("accuracy", "how exactly hits are computed", Accuracy::Exact).not_dumped();

/// The rules of light; if they are not given, those of the type of camera.
pub(super) static RULES: Pparm<Option<Rules>> = Pparm::or(
    "rules",
    "the rules of light; by default `notes` for `camera`, and `free` for the others",
    None,
)
.not_dumped();

/// How light becomes bytes under the free rules; the notes' have no choice.
pub(super) static EXPOSURE: Pparm<f64> =
    Pparm::or("exposure", "how often the light is doubled, under the free rules", 0.0)
        .unit("stops")
        .between(-32.0, 32.0)
        .not_dumped();

pub(super) static TONE: Pparm<Tone> =
    Pparm::or("tone", "how light above white is shown, under the free rules", Tone::Clip).not_dumped();

pub(super) static TRANSFER: Pparm<Transfer> =
    Pparm::or("transfer", "how light is encoded in bytes, under the free rules", Transfer::Srgb).not_dumped();

/// Along each path, one direction is drawn for each bounce.
pub(super) static BOUNCES: Pparm<i64> = Pparm::or(
    "bounces",
    "by how many surfaces light goes on to matt ones, under the free rules; it takes many samples",
    0,
)
.between(0.0, 64.0)
.not_dumped();

/// Whether image files have alpha.
pub(super) static ALPHA: Pparm<bool> =
    Pparm::or("alpha", "whether image files are transparent where they show no object", false).not_dumped();

/// The attributes that every camera has before and after its own.
pub(super) const FILM: [Table; 2] =
    [&[&PIXELDIM], &[&SAMPLES, &ACCURACY, &RULES, &EXPOSURE, &TONE, &TRANSFER, &BOUNCES, &ALPHA]];

/// How the light of a lamp weakens, and the distance at which it is as bright as its emissivity.
pub(super) static FALLOFF: Pparm<Falloff> =
    Pparm::or("falloff", "under the free rules, how the light weakens with the distance", Falloff::None)
        .not_dumped();

pub(super) static AT: Pparm<f64> =
    Pparm::or("at", "the distance at which a light with a `falloff` is as bright as its emissivity", 1.0)
        .unit("world units")
        .must("above 0", |at| *at > 0.0)
        .not_dumped();

/// Whether a background lights surfaces.
pub(super) static LIGHTS: Pparm<bool> =
    Pparm::or("lights", "whether its light falls on surfaces, under the free rules", false).not_dumped();

/// The attribute that every background has after its own.
pub(super) const BACKGROUND: Table = &[&LIGHTS as &dyn Row];

/// The attributes that every light has after its own.
pub(super) const LIGHT: Table = &[&FALLOFF, &AT];
