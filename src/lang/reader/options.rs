//! The caller's choices for reading a scene.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::rules::Rules;

/// The caller's choices for reading a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions<'s> {
    /// The accuracy that overrides the scene's own.
    pub above_all: Option<Accuracy>,
    /// The rules of light that override those of the scene and of the accuracy.
    pub rules: Option<Rules>,
    /// The accuracy if the scene chooses none.
    pub by_default: Accuracy,
    /// Whether entities that share a name and are all used are allowed without a warning.
    pub may_share_names: bool,
    /// Whether colours that may be meant as 0 to 255 are allowed without a warning.
    pub may_be_bright: bool,
    /// Whether the scene is only for rays. Messages about its image are then omitted.
    pub only_rays: bool,
    /// Whether labels are drawn over the image, and not as objects.
    pub labels_apart: bool,
    /// The limit for the memory of the scene's textures and of its objects' files, in bytes. The default is 1 GiB for
    /// the textures, and no limit for the objects, which take little more memory than their files.
    pub memory: Option<u64>,
    /// The caller's clock for measuring the time for making a model. It returns the time since some moment.
    pub clock: Option<fn() -> Duration>,
    /// The values set beside the text, each as `NAME.ATTRIBUTE=VALUES` or `NUMBER=VALUE`.
    pub sets: &'s [String],
    /// The names in messages of the last of these values, for values that do not come from an option `--set` of their
    /// own.
    pub set_by: &'s [String],
    /// The texts of files that are open in an editor, by their paths. For an included file, they replace the stored
    /// contents.
    pub open: &'s [(PathBuf, Arc<str>)],
}
