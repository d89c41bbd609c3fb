//! The camera, as a page moves it.

use super::fields;
use super::frame::Frame;
use super::session::Session;
use crate::serve::{self, Body};
use glam::DVec3;
use hyper::{Response, StatusCode};
use serde::{Deserialize, Serialize};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::store::Record;
use tabray_core::text;
use tabray_lang::editor::{self, Text};
use tabray_lang::registry::Registry;
use tabray_tools::navigation::{self, CameraPose, Movement};

/// The state of a camera that is about to be moved.
#[derive(Serialize)]
struct CameraState<'c> {
    /// The camera's name.
    name: &'c str,
    /// The pose of the camera, with the values that are tried out.
    stand: CameraPose,
    /// Whether its image plane stays in its place when the viewer moves.
    is_window: bool,
}

/// A movement of the camera, as a page sends it.
#[derive(Deserialize)]
struct MoveRequest {
    /// The pose of the camera before the movement.
    stand: CameraPose,
    /// The point around which it goes, in world coordinates.
    around: [f64; 3],
    /// The angles of the orbit, as in [`Movement`].
    orbit: [f64; 2],
    pan: [f64; 2],
    dolly: f64,
}

/// Returns the point that a pixel shows, in world coordinates; where it shows none, one that is as far away as the camera
/// looks.
pub fn point(frame: &Frame, [x, y]: [usize; 2]) -> [f64; 3] {
    let sensor = &frame.model.camera.value;
    let hit = trace::first_hit(&Plan::new(&frame.model), &sensor.sight(x as f64, y as f64));
    let far = || sensor.ray(x as f64, y as f64).at(navigation::reach(&frame.model.camera.args.args()));
    hit.map_or_else(far, |hit| hit.point).to_array()
}

/// Tells where the camera stands, or why it cannot be moved.
pub fn state(session: &Session) -> Response<Body> {
    let Some(frame) = session.feed.last() else {
        return serve::text(StatusCode::CONFLICT, "there is no camera yet\n");
    };
    let record = &frame.model.camera.args;
    if let Some(reason) = fixed(session.registry, &frame, record) {
        return serve::text(StatusCode::CONFLICT, &format!("{reason}\n"));
    }
    let (name, camera) = (record.name(), record.args());
    let mut stand = navigation::camera_pose(&camera);
    for (attribute, values) in &mut stand {
        let tried = session.trial_values.get(name, attribute);
        *values = tried.filter(|tried| tried.len() == values.len()).unwrap_or_else(|| values.clone());
    }
    let state = CameraState { name, stand, is_window: navigation::is_window(&camera) };
    serve::content(StatusCode::OK, "application/json", text::json(&state))
}

/// Returns why a camera cannot be moved; `None` where it can be.
fn fixed(registry: &Registry, frame: &Frame, camera: &Record) -> Option<String> {
    let (name, args) = (camera.name(), camera.args());
    let view = editor::read(registry, &frame.name, Text::new(frame.text.clone()));
    let mut moves = navigation::attributes(&args).map(|(attribute, _)| attribute).peekable();
    if moves.peek().is_none() {
        return Some(format!(
            "{} does not say where it stands: change the text",
            text::with_article(args.entity.name)
        ));
    }
    if view.entity(name).is_none() {
        return Some(format!("`{name}` is repeated or included: change the text"));
    }
    let reason = |attribute| Some((attribute, fields::fixed(&view, name, attribute)?));
    moves.find_map(reason).map(|(attribute, reason)| {
        format!("the camera cannot be moved by its `{}`: {reason}", attribute.name())
    })
}

/// Moves the camera: its new values are tried out.
pub fn move_by(session: &Session, body: &[u8]) -> Response<Body> {
    let (Ok(wanted), Some(frame)) = (serde_json::from_slice::<MoveRequest>(body), session.feed.last()) else {
        return serve::text(StatusCode::BAD_REQUEST, "this is not a movement of the camera\n");
    };
    let MoveRequest { stand, around, orbit, pan, dolly } = wanted;
    let (record, around) = (&frame.model.camera.args, DVec3::from(around));
    let movement = Movement { orbit, pan, dolly };
    let after = (dolly > 0.0).then(|| navigation::moved(&record.args(), &stand, &movement, around)).flatten();
    let Some(after) = after else {
        return serve::text(StatusCode::CONFLICT, "the camera cannot go there\n");
    };
    for (attribute, values) in &after {
        if stand.get(attribute) != Some(values)
            || session.trial_values.get(record.name(), attribute).is_some()
        {
            session.trial_values.put(record.name(), attribute, values);
        }
    }
    session.done("moved\n")
}
