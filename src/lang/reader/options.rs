//! What the caller chooses beside the text of a scene.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::rules::Rules;

/// What the caller chooses beside the text of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions<'s> {
    /// The accuracy that overrides the scene's own.
    pub above_all: Option<Accuracy>,
    /// The rules of light that override the scene's own, and those of the accuracy.
    pub rules: Option<Rules>,
    /// The accuracy where the scene chooses none.
    pub by_default: Accuracy,
    /// Whether there is no warning of entities that share a name and are all used.
    pub may_share_names: bool,
    /// Whether there is no warning of colours that may be meant to be from 0 to 255.
    pub may_be_bright: bool,
    /// Whether the scene is for rays only, so that messages about its image are left out.
    pub only_rays: bool,
    /// The limit on the memory of the scene's textures and of its objects' files, in bytes; by default 1 GiB for the
    /// textures, and no limit for the objects, which take little more memory than their files.
    pub memory: Option<u64>,
    /// The caller's clock, for the time that making a model takes: the time since some moment.
    pub clock: Option<fn() -> Duration>,
    /// The values that are set beside the text, each as `NAME.ATTRIBUTE=VALUES` or `NUMBER=VALUE`.
    pub sets: &'s [String],
    /// What messages call the last of these values, where these are not given by options `--set` of their own.
    pub set_by: &'s [String],
    /// The texts of files that are open in an editor, by their paths: where such a file is included, they stand in place
    /// of what is stored.
    pub open: &'s [(PathBuf, Arc<str>)],
}
