//! The scene around an entity, for its constructor, and the refusal of values.

use crate::material::Material;
use crate::sensor::Sensor;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The scene around an entity, as far as its constructor may know it.
#[derive(Clone, Debug, Default)]
pub struct Setting {
    /// The scene's camera. Only objects and lights are certain to be constructed after it; other entities may see a
    /// default camera.
    pub camera: Sensor,
    /// The folder to which the scene's file names are relative.
    pub folder: PathBuf,
    /// The scene's materials by their names; only objects and lights are certain to see all of them.
    pub materials: Arc<BTreeMap<String, Arc<Material>>>,
    /// Whether only hits of rays are asked for, and the looks of objects do not matter.
    pub only_rays: bool,
    /// Whether [labels](crate::body::Body::labels) are drawn over the image, and not as objects.
    pub labels_apart: bool,
    /// The memory that an object may take in addition to the scene, in bytes.
    pub memory: u64,
}

/// The reason why a constructor refuses values that are valid one by one.
#[derive(Debug)]
pub struct Refusal {
    /// The attribute to mark; if `None`, the entity's name is marked.
    pub attribute: Option<&'static str>,
    /// The error, phrased to follow the entity's name: "has an `xdir` parallel to its `normal`".
    pub message: String,
    /// How to correct it.
    pub help: &'static str,
}
