//! Solids as objects: one for each part with a visible surface.

use super::shader::PartShader;
use super::solid_part::SolidPart;
use crate::placed::Placed;
use std::sync::Arc;
use tabray_world::any_shape::AnyShape;
use tabray_world::body::{Body, NamedBody, Part, Solid, Warning};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::placement::Placement;
use tabray_world::material::Material;
use tabray_world::scene::entity::{Args, Refusal};
use tabray_world::scene::list::List;
use tabray_world::scene::pparm::Pparm;
use tabray_world::solid::{Operation, Tree, common};

/// The maximum number of parts of a solid. Each of them may have to be compared with all others.
const MAX_PARTS: usize = 1024;

/// The maximum nesting depth of solids. The name of a part contains the names of all solids around it.
const DEEPEST: usize = 256;

/// The objects that make up a solid.
pub type Objects = List<NamedBody, 2, 256>;

/// Makes the solid of an entity that names its objects.
///
/// # Errors
/// Returns the reason why the objects make no solid.
pub fn combined(args: &Args, objects: &Pparm<Objects>, operation: Operation) -> Result<Body, Refusal> {
    let List(objects) = args.get(objects);
    let objects: Vec<_> = objects.iter().filter_map(|object| object.get().cloned()).collect();
    let solids: Result<Vec<_>, _> = objects.iter().map(solid_of).collect();
    let made = solids.and_then(|of| body_of(Solid::combined(operation, of), args.material_of_all()));
    made.map_err(|fault| {
        let (message, help) = fault.message();
        Refusal { attribute: Some("objects"), message, help }
    })
}

/// The reason why objects cannot be combined.
pub(super) enum NoSolid {
    /// The object of this name is open, for this reason.
    Open(Arc<str>, String),
    /// There are too many parts.
    TooMany,
    /// Solids are nested too deeply.
    TooDeep,
    /// No point lies in the solid.
    Empty,
}

impl NoSolid {
    /// Returns the error and its correction, for messages such as "is empty".
    pub(super) fn message(self) -> (String, &'static str) {
        match self {
            Self::Open(name, why) => (
                format!("cannot be made of `{name}`, which is not a closed shape: {why}"),
                "only closed shapes can be combined: a sphere, a box, a cylinder with its ends, a lathe that begins and ends \
                 on its axis, a mesh without holes; for a cut along a plane, use a large box",
            ),
            Self::TooMany => (
                format!("has more than {MAX_PARTS} parts"),
                "a `union` of objects that do not overlap can be left out: the objects are seen without it",
            ),
            Self::TooDeep => (
                format!("nests solids more than {DEEPEST} deep"),
                "a solid takes up to 256 objects at once: `difference rest { objects block one two three }`",
            ),
            Self::Empty => (
                "is empty: its objects do not overlap as they must".to_owned(),
                "an intersection is the space in all of its objects, a difference what is left of the first",
            ),
        }
    }
}

/// Returns a named object as a solid.
///
/// # Errors
/// Fails if the object is open.
pub(super) fn solid_of(object: &Arc<Body>) -> Result<Solid, NoSolid> {
    let name = object.name.clone().unwrap_or_default();
    if let Some(solid) = &object.solid {
        if solid.is_open {
            return Err(NoSolid::Open(name, "its `clip` cuts it open; `capped yes` closes it".to_owned()));
        }
        let named = |part: &Part| Part { name: format!("{} of {name}", part.name).into(), ..part.clone() };
        return Ok(Solid { parts: solid.parts.iter().map(named).collect(), ..(**solid).clone() });
    }
    let body = match object.boundary() {
        Some(shape) => {
            let (entity, faces) = (object.entity, object.faces.clone());
            Arc::new(Body { entity, faces, ..seen_as(object, shape) })
        }
        None => object.clone(),
    };
    if let Some(why) = body.shape.why_not_closed() {
        return Err(NoSolid::Open(name, why.to_owned()));
    }
    let material = object.material.clone().unwrap_or_default();
    let part = Part { name, body, material, is_clipped: false };
    Ok(Solid { parts: vec![part], tree: Tree::Part(0), is_open: false })
}

/// Returns the solid with each of its parts placed.
fn placed_solid(solid: &Solid, placement: Placement) -> Solid {
    let place = |part: &Part| Part {
        body: Arc::new(Placed::body(&part.body, (placement, None), &part.material)),
        ..part.clone()
    };
    Solid { parts: solid.parts.iter().map(place).collect(), ..solid.clone() }
}

/// See [`Made::union`](crate::Made::union).
pub(crate) fn union(of: impl IntoIterator<Item = (String, Body, Arc<Material>)>) -> Result<Body, Refusal> {
    let solids = of.into_iter().map(|(name, body, material)| {
        solid_of(&Arc::new(Body { name: Some(name.into()), material: Some(material), ..body }))
    });
    let solids: Result<Vec<_>, _> = solids.collect();
    let made = solids.and_then(|of| body_of(Solid::combined(Operation::Union, of), None));
    made.map_err(|fault| {
        let (message, help) = fault.message();
        Refusal { attribute: None, message, help }
    })
}

/// See [`Made::placed`](crate::Made::placed).
pub(crate) fn placed(
    object: &Arc<Body>,
    (placement, max_z): (Placement, Option<f64>),
    material: Option<Arc<Material>>,
) -> Body {
    if let Some(solid) = &object.solid
        && let Ok(copy) = body_of(placed_solid(solid, placement), material.clone())
    {
        return copy;
    }
    let copy = |object: &Arc<Body>| {
        let material = material.clone().or_else(|| object.material.clone()).unwrap_or_default();
        Body { material: Some(material.clone()), ..Placed::body(object, (placement, max_z), &material) }
    };
    let faces = object.faces.iter().map(|face| Arc::new(copy(face))).collect();
    Body { faces, ..copy(object) }
}

/// Makes the objects of a solid. Without a material, each part keeps its own.
///
/// # Errors
/// Returns the reason why there are none.
pub(super) fn body_of(mut solid: Solid, material: Option<Arc<Material>>) -> Result<Body, NoSolid> {
    if solid.parts.len() > MAX_PARTS {
        return Err(NoSolid::TooMany);
    }
    if solid.tree.depth() > DEEPEST {
        return Err(NoSolid::TooDeep);
    }
    if let Some(material) = material {
        solid.parts.iter_mut().for_each(|part| part.material = material.clone());
    }
    let with_faces = solid.parts.iter().find(|part| !part.body.faces.is_empty());
    let warning = with_faces.map(|part| Warning {
        attribute: "objects",
        message: format!("ignores the shininess and transparency of the faces of `{}`", part.name),
        help: "a part of a solid has one material, and the colours of its faces: make the other faces a mesh of their own"
            .to_owned(),
    });
    let mut seen = seen(&solid).into_iter();
    let first = seen.next().ok_or(NoSolid::Empty)?;
    let warnings = warning.into_iter().collect();
    Ok(Body { more: seen.collect(), solid: Some(Box::new(solid)), warnings, ..first })
}

/// Returns a body with another shape and the appearance of an object.
fn seen_as(object: &Arc<Body>, shape: impl Into<AnyShape>) -> Body {
    let own = object.clone();
    let to_object_space = move |shader| match &own.to_object_space {
        Some(to_object_space) => to_object_space(shader),
        None => shader,
    };
    Body {
        depth: object.depth,
        anchor: Some(object.anchor()),
        to_object_space: Some(Box::new(to_object_space)),
        ..Body::shaded(shape, PartShader(object.clone()))
    }
}

/// Returns the bodies of the parts whose surface may be visible.
fn seen(solid: &Solid) -> Vec<Body> {
    let parts: Arc<[Part]> = solid.parts.clone().into();
    let bounds: Arc<[Option<Aabb>]> = parts.iter().map(|part| part.body.shape.bounds()).collect();
    let whole = solid.tree.bounds(&|part| bounds[part]);
    let body = |index: usize| {
        let around = common(bounds[index], whole);
        let meets = |other: usize| match (around, bounds[other]) {
            (Some(own), Some(other)) => own.overlaps(&other),
            _ => true,
        };
        if !meets(index) {
            return None;
        }
        let tree = solid.tree.without(&|other| other != index && !meets(other));
        let (path, is_outer) = tree.path_to(index)?;
        let around = common(around, tree.bounds(&|part| bounds[part]));
        let shape = SolidPart::new(
            &parts,
            &bounds,
            (index, is_outer, solid.is_open),
            (tree, solid.tree.clone(), path),
            around,
        );
        let part = &parts[index];
        Some(Body {
            material: Some(part.material.clone()),
            ..seen_as(&part.body, AnyShape::of_packets(shape))
        })
    };
    let count = if solid.is_open { 1 } else { parts.len() };
    (0..count).filter_map(body).collect()
}
