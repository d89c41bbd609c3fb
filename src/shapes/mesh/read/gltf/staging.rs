//! The cameras of a glTF file, and its lights by the extension KHR_lights_punctual.

use super::json::{Gltf, LightKind, Node};
use crate::mesh::read::staging::{Lamp, Staging, Viewer};
use glam::{DMat4, DVec3};
use tabray_world::material::Rgb;

/// Adds the camera and the light of a node, if it has any. Both look along the node's -z. What the file lacks, or gives
/// as no number, is left out.
pub fn add(staging: &mut Staging, json: &Gltf, node: &Node, placement: DMat4) {
    let position = placement.transform_point3(DVec3::ZERO);
    let Some(forward) = placement.transform_vector3(DVec3::NEG_Z).try_normalize() else { return };
    let lens = node.camera.and_then(|camera| json.cameras.get(camera)?.perspective.as_ref());
    if let Some(lens) = lens
        && staging.viewer.is_none()
    {
        let viewer = Viewer {
            position,
            forward,
            up: placement.transform_vector3(DVec3::Y),
            tangent: libm::tan(0.5 * lens.yfov),
            aspect: lens.aspect_ratio.filter(|aspect| (0.01..=100.0).contains(aspect)),
        };
        let is_sound = position.is_finite() && viewer.up.is_finite() && viewer.tangent > 0.0;
        staging.viewer = is_sound.then_some(viewer);
    }
    let light = node.extensions.light.as_ref().and_then(|at| json.extensions.lights.lights.get(at.light));
    if let Some(light) = light {
        let is_sun = light.kind == LightKind::Directional;
        let edge = light.spot.as_ref().map_or(45.0, |spot| spot.outer_cone_angle.to_degrees());
        let lamp = Lamp {
            position: (!is_sun).then_some(position),
            forward: (light.kind != LightKind::Point).then_some(forward),
            edge: (light.kind == LightKind::Spot).then_some(edge),
            light: light.intensity * Rgb::from(light.color),
        };
        if position.is_finite() && lamp.light.is_finite() && lamp.light.min_element() >= 0.0 {
            staging.lamps.push(lamp);
        }
    }
}
