//! The camera, as a page moves it.

use super::session::{Session, refusal};
use crate::camera::{self, MoveRequest};
use hyper::{Response, StatusCode};
use tabray_core::text::{self, short};
use tabray_editor::{self as editor, Change, Text};
use tabray_serve::{self as serve, Body};

/// Said before there is an image.
const NO_CAMERA: &str = "there is no camera yet";

/// Tells where the camera stands, or why it cannot be moved.
pub fn state(session: &Session) -> Response<Body> {
    let Some(frame) = session.feed.last() else {
        return refusal(NO_CAMERA);
    };
    let mut state = match camera::state(session.registry, frame.shown()) {
        Ok(state) => state,
        Err(reason) => return refusal(&reason),
    };
    // The values that are tried out stand in place of those of the text.
    for (attribute, values) in &mut state.stand {
        let tried = session.trial_values.get(frame.model.camera.args.name(), attribute);
        *values = tried.filter(|tried| tried.len() == values.len()).unwrap_or_else(|| values.clone());
    }
    serve::content(StatusCode::OK, "application/json", text::json(&state))
}

/// Moves the camera: its new values are tried out.
pub fn move_by(session: &Session, body: &[u8]) -> Response<Body> {
    let (Ok(wanted), Some(frame)) = (serde_json::from_slice::<MoveRequest>(body), session.feed.last()) else {
        return serve::text(StatusCode::BAD_REQUEST, "this is not a movement of the camera\n");
    };
    let record = &frame.model.camera.args;
    let Some(after) = wanted.moved(&frame.model) else {
        return refusal("the camera cannot go there");
    };
    for (attribute, values) in &after {
        if wanted.stand.get(attribute) != Some(values)
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
        let turned = camera::turned(&view, name)?;
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
