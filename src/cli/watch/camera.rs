//! The camera, as a page moves it.

use super::fields;
use super::frame::Frame;
use super::session::{Session, refusal};
use crate::serve::{self, Body};
use glam::DVec3;
use hyper::{Response, StatusCode};
use serde::{Deserialize, Serialize};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::store::Record;
use tabray_core::text::{self, short};
use tabray_lang::editor::{self, Change, Text, View};
use tabray_lang::registry::Registry;
use tabray_tools::navigation::{self, CameraPose, Movement};

/// Said before there is an image.
const NO_CAMERA: &str = "there is no camera yet";

/// The state of a camera that is about to be moved.
#[derive(Serialize)]
struct CameraState<'c> {
    /// The camera's name.
    name: &'c str,
    /// The pose of the camera, with the values that are tried out.
    stand: CameraPose,
    /// Whether its image plane stays in its place when the viewer moves.
    is_window: bool,
    /// Whether it is a `camera`, in place of which there may be a `look_at`.
    turns: bool,
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
        return refusal(NO_CAMERA);
    };
    let record = &frame.model.camera.args;
    if let Some(reason) = fixed(session.registry, &frame, record) {
        return refusal(&reason);
    }
    let (name, camera) = (record.name(), record.args());
    let mut stand = navigation::camera_pose(&camera);
    for (attribute, values) in &mut stand {
        let tried = session.trial_values.get(name, attribute);
        *values = tried.filter(|tried| tried.len() == values.len()).unwrap_or_else(|| values.clone());
    }
    let view = view(session.registry, &frame);
    let turns = view.entity(name).is_some_and(|entity| editor::look_at(&view, &entity.place).is_some());
    let state = CameraState { name, stand, is_window: navigation::is_window(&camera), turns };
    serve::content(StatusCode::OK, "application/json", text::json(&state))
}

fn view(registry: &Registry, frame: &Frame) -> View {
    editor::read(registry, &frame.name, Text::new(frame.text.clone()))
}

/// Returns why a camera cannot be moved; `None` where it can be.
fn fixed(registry: &Registry, frame: &Frame, camera: &Record) -> Option<String> {
    let (name, args) = (camera.name(), camera.args());
    let view = view(registry, frame);
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
        return refusal("the camera cannot go there");
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

/// Turns the camera into a `look_at` in the scene's file, with the same view if there is one. What is tried out of the camera is lost.
pub fn turn(session: &Session) -> Response<Body> {
    let Some(frame) = session.feed.last() else { return refusal(NO_CAMERA) };
    let (name, mut change) = (frame.model.camera.args.name(), Change::default());
    let edited = session.edit(|text| {
        let view = editor::read(session.registry, &frame.name, Text::new(text));
        let camera =
            view.entity(name).ok_or_else(|| format!("`{name}` is repeated or included: change the text"))?;
        let turned = editor::look_at(&view, &camera.place).ok_or("only a `camera` can become a `look_at`")?;
        let turned = turned.map_err(|reason| format!("the camera cannot become a `look_at`: {reason}"))?;
        change = turned.change;
        Ok(turned.applied(&view.text).as_str().to_owned())
    });
    match edited {
        Ok(()) => {
            session.trial_values.clear_of(name);
            let Change { shift, turn } = change;
            let view = match turn {
                0.0 => format!("pixels shift by up to {}", short(shift)),
                turn => {
                    format!("the view turns by {} degrees, to the middle of the image plane", short(turn))
                }
            };
            session.done(&format!(
                "turned into a look_at: {view}, and planes and triangles do not end at the image plane\n"
            ))
        }
        Err(reason) => refusal(&reason),
    }
}
