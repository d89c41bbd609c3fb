//! Constructs objects and lights, some at a time.

use std::collections::BTreeMap;
use std::ops::Range;
use std::ptr;
use tabray_core::scene::entity::{Args, Construct, Entity, Refusal};
use tabray_core::scene::procedural;
use tabray_core::scene::store::Store;
use tabray_core::scene::value::Datum;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::body::{AnyShader, Body};
use tabray_core::world::lamp::Lamp;

/// The result of the constructor of an object or a light.
pub enum Constructed {
    /// The shape and the shader of an object of which there is no more to say.
    Plain(AnyShape, AnyShader),
    /// An object with warnings, further objects or a material of its own.
    Body(Box<Body>),
    Light(Lamp),
    /// An object that reads files: it is constructed later, one at a time.
    Deferred,
}

/// Constructs the objects and lights among some entities, except for `patterns`, the objects that others refer to, and
/// for those that refer to faulty ones.
pub fn constructed(
    store: &Store,
    orders: Range<usize>,
    patterns: &BTreeMap<usize, Datum>,
) -> Vec<(usize, Result<Constructed, Refusal>)> {
    // Where it has to grow, it leaves holes in memory between the shapes.
    let (mut constructed, mut memory) = (Vec::with_capacity(orders.len()), None);
    let mut last: Option<(&Entity, bool)> = None;
    for order in orders {
        let Some(entity) = store.sound(order) else { continue };
        let known = last.filter(|(last, _)| ptr::eq(*last, entity));
        let (_, reads_files) = *last.insert(known.unwrap_or_else(|| (entity, entity.reads_files())));
        let construct: &dyn Fn(&Args) -> Result<Constructed, Refusal> = match entity.construct {
            Construct::Object(_) if reads_files => &|_| Ok(Constructed::Deferred),
            Construct::Object(construct) => &move |args| procedural::body(args, construct).map(of),
            Construct::Light(construct) => &move |args| Ok(Constructed::Light(args.lamp(construct(args)?))),
            _ => continue,
        };
        let args = store.args_in(order, &mut memory);
        if !patterns.contains_key(&order) && !args.refers_to_nothing() {
            constructed.push((order, construct(args)));
        }
    }
    constructed
}

/// Returns what is made of a body. Most objects take a fraction of its memory.
fn of(body: Body) -> Constructed {
    let is_all = body.warnings.is_empty() && body.more.is_empty() && body.material.is_none();
    if is_all { Constructed::Plain(body.shape, body.shader) } else { Constructed::Body(Box::new(body)) }
}
