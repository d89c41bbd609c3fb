//! Surfaces clipped by a closed object: cut open, or capped by the faces of that object.

use super::make::{NoSolid, body_of, solid_of};
use glam::DVec3;
use std::sync::Arc;
use tabray_world::body::{Body, NamedBody, Part, Solid};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::scene::entity::{Args, Refusal};
use tabray_world::solid::{Operation, Tree};

/// The margin of a surface's box around its clip object, as a fraction of the object's size. The box contains the
/// visible part of the surface.
const MARGIN: f64 = 1.0 / 1024.0;

/// A closed object that clips a surface.
pub struct Clip {
    solid: Solid,
    bounds: Aabb,
}

fn refusal(message: String, help: &'static str) -> Refusal {
    Refusal { attribute: Some("clip"), message, help }
}

impl Clip {
    /// Makes a clip from a named object.
    ///
    /// # Errors
    /// Fails if the object is open, or has no bounds.
    pub fn of(object: &NamedBody) -> Result<Self, Refusal> {
        let Some(object) = object.get() else {
            let message = "is clipped by an object that has not been made".to_owned();
            return Err(refusal(message, "define the object before the surface that it clips"));
        };
        let solid = solid_of(object).map_err(|fault| match fault {
            NoSolid::Open(name, why) => refusal(
                format!("cannot be clipped by `{name}`, which is not a closed shape: {why}"),
                "clip by a sphere, a box, or another closed shape",
            ),
            fault => {
                let (message, help) = fault.message();
                refusal(message, help)
            }
        })?;
        let of_part = |part: usize| solid.parts[part].body.shape.facts().bounds;
        match solid.tree.bounds(&of_part) {
            Some(bounds) => Ok(Self { solid, bounds }),
            None => {
                let message = "cannot be clipped by an object without bounds".to_owned();
                Err(refusal(message, "clip by a sphere, a box, or another closed shape"))
            }
        }
    }

    /// Returns the low and the high corner, relative to `from`, of a box that contains the object, and thus the visible
    /// part of the surface.
    pub fn corners(&self, from: DVec3) -> [DVec3; 2] {
        let margin = MARGIN * 2.0 * self.bounds.half_size().max_element();
        [self.bounds.low - margin - from, self.bounds.high + margin - from]
    }

    /// Clips an entity's surface, which is cut open, or closed by the faces of the object if `is_capped`. These faces
    /// keep the material and the appearance of the object. The surface must have an equation that is negative inside.
    ///
    /// # Errors
    /// Returns the reason why the surface cannot be capped, or why the two make no solid.
    pub fn cut(self, args: &Args, mut surface: Body, is_capped: bool) -> Result<Body, Refusal> {
        if is_capped && let Some(why) = surface.shape.why_not_closed() {
            return Err(Refusal {
                attribute: Some("capped"),
                message: format!("cannot be capped: {why}"),
                help: "caps are where the formula is below 0: it must be defined there, and bounded",
            });
        }
        let warnings = std::mem::take(&mut surface.warnings);
        surface.entity = Some(args.entity.name);
        let (name, material) = (args.name.as_str().into(), args.material());
        let part = Part { name, body: Arc::new(surface), material, is_clipped: true };
        let own = Solid { parts: vec![part], tree: Tree::Part(0), is_open: false };
        let solid = Solid::combined(Operation::Intersection, [own, self.solid]);
        let body = body_of(Solid { is_open: !is_capped, ..solid }, None).map_err(|fault| {
            let (message, help) = fault.message();
            refusal(message, help)
        })?;
        let more = body.more.into_iter().map(|face| Body { keeps_look: true, ..face }).collect();
        Ok(Body { warnings, more, ..body })
    }
}
