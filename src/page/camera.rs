//! The camera, as a page moves it.

use super::{Shown, fields};
use crate::navigation::{self, CameraPose, Movement};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_core::scene::store::Record;
use tabray_core::text;
use tabray_editor::{self as editor, LookAt, View};
use tabray_lang::registry::Registry;

/// The state of a camera that is about to be moved.
#[derive(Serialize)]
pub struct CameraState<'c> {
    name: &'c str,
    /// The pose of the camera.
    pub stand: CameraPose,
    /// Whether its image plane stays in its place when the viewer moves.
    is_window: bool,
    /// Whether it is a `camera`, which may be replaced by a `look_at`.
    turns: bool,
}

/// A movement of the camera, as a page sends it.
#[derive(Deserialize)]
pub struct MoveRequest {
    /// The pose of the camera before the movement.
    pub stand: CameraPose,
    /// The point around which it goes, in world coordinates.
    around: [f64; 3],
    /// The angles of the orbit, as in [`Movement`].
    orbit: [f64; 2],
    pan: [f64; 2],
    dolly: f64,
}

impl MoveRequest {
    /// Returns the pose of a model's camera after the movement; `None` where it cannot go there.
    pub fn moved(&self, model: &Model) -> Option<CameraPose> {
        let movement = Movement { orbit: self.orbit, pan: self.pan, dolly: self.dolly };
        let camera = model.camera.args.args();
        (self.dolly > 0.0)
            .then(|| navigation::moved(&camera, &self.stand, &movement, DVec3::from(self.around)))?
    }
}

/// Returns the point that a pixel shows, in world coordinates. Where it shows none, returns a point at the distance
/// at which the camera looks.
pub fn point(model: &Model, [x, y]: [usize; 2]) -> [f64; 3] {
    let sensor = &model.camera.value;
    let hit = trace::first_hit(&Plan::new(model), &sensor.sight(x as f64, y as f64));
    let far = || sensor.ray(x as f64, y as f64).at(navigation::reach(&model.camera.args.args()));
    hit.map_or_else(far, |hit| hit.point).to_array()
}

/// Returns the pose of the camera.
///
/// # Errors
/// Returns why the camera cannot be moved.
pub fn state<'s>(registry: &Registry, shown: Shown<'s>) -> Result<CameraState<'s>, String> {
    let record = &shown.model.camera.args;
    let (name, camera, view) = (record.name(), record.args(), shown.view(registry));
    if let Some(reason) = fixed(&view, record) {
        return Err(reason);
    }
    let turns = view.entity(name).is_some_and(|entity| editor::look_at(&view, &entity.place).is_some());
    let stand = navigation::camera_pose(&camera);
    Ok(CameraState { name, stand, is_window: navigation::is_window(&camera), turns })
}

/// Turns the camera of this name into a `look_at`.
///
/// # Errors
/// Returns why it cannot become one.
pub fn turned(view: &View, name: &str) -> Result<LookAt, String> {
    let camera = view.entity(name).ok_or_else(|| elsewhere(name))?;
    let turned = editor::look_at(view, &camera.place).ok_or("only a `camera` can become a `look_at`")?;
    turned.map_err(|reason| format!("the camera cannot become a `look_at`: {reason}"))
}

fn elsewhere(name: &str) -> String {
    format!("`{name}` is repeated or included: change the text")
}

/// Returns why a camera cannot be moved; `None` where it can be.
fn fixed(view: &View, camera: &Record) -> Option<String> {
    let (name, args) = (camera.name(), camera.args());
    let mut moves = navigation::attributes(&args).map(|(attribute, _)| attribute).peekable();
    if moves.peek().is_none() {
        return Some(format!(
            "{} does not say where it stands: change the text",
            text::with_article(args.entity.name)
        ));
    }
    if view.entity(name).is_none() {
        return Some(elsewhere(name));
    }
    let reason = |attribute| Some((attribute, fields::fixed(view, name, attribute)?));
    moves.find_map(reason).map(|(attribute, reason)| {
        format!("the camera cannot be moved by its `{}`: {reason}", attribute.name())
    })
}
