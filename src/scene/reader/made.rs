//! Constructs objects and lights, some at a time.

use crate::scene::entity::{Args, Construct, Entity, Refusal};
use crate::scene::procedural;
use crate::scene::store::Store;
use crate::scene::value::Datum;
use crate::world::any_shape::AnyShape;
use crate::world::body::{AnyLight, AnyShader, Body};
use std::collections::BTreeMap;
use std::ops::Range;
use std::ptr;

/// What the constructor of an object or a light makes.
pub enum Made {
    /// The shape and the shader of an object that is seen as it is.
    Seen(AnyShape, AnyShader),
    /// An object of which there is more to say.
    Body(Box<Body>),
    Light(AnyLight),
    /// An object that reads files, which is not constructed here.
    ByFile,
}

/// Constructs the objects and lights among some entities, except for `patterns`, the objects that others refer to, and
/// for those that refer to faulty ones.
pub fn made(
    store: &Store,
    orders: Range<usize>,
    patterns: &BTreeMap<usize, Datum>,
) -> Vec<(usize, Result<Made, Refusal>)> {
    // Where it has to grow, it leaves holes in memory between the shapes.
    let (mut made, mut memory) = (Vec::with_capacity(orders.len()), None);
    let mut last: Option<(&Entity, bool)> = None;
    for order in orders {
        let Some(entity) = store.sound(order) else { continue };
        let known = last.filter(|(last, _)| ptr::eq(*last, entity));
        let (_, reads_files) = *last.insert(known.unwrap_or_else(|| (entity, entity.reads_files())));
        let construct: &dyn Fn(&Args) -> Result<Made, Refusal> = match entity.construct {
            Construct::Object(_) if reads_files => &|_| Ok(Made::ByFile),
            Construct::Object(construct) => &move |args| procedural::body(args, construct).map(of),
            Construct::Light(construct) => &move |args| construct(args).map(Made::Light),
            _ => continue,
        };
        let args = store.args_in(order, &mut memory);
        if !patterns.contains_key(&order) && !args.refers_to_nothing() {
            made.push((order, construct(args)));
        }
    }
    made
}

/// Returns what is made of a body. Most objects take a fraction of its memory.
fn of(body: Body) -> Made {
    let is_all = body.warnings.is_empty() && body.more.is_empty() && body.material.is_none();
    if is_all { Made::Seen(body.shape, body.shader) } else { Made::Body(Box::new(body)) }
}
