//! Constructs objects and lights, some at a time.

use crate::scene::entity::{Args, Construct, Entity, Refusal};
use crate::scene::procedural;
use crate::scene::store::Store;
use crate::scene::value::Datum;
use crate::world::body::{AnyLight, Body};
use std::collections::BTreeMap;
use std::ops::Range;

/// What the constructor of an object or a light makes.
pub enum Made {
    Object(Body),
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
    for order in orders {
        let reads_files = store.sound(order).is_some_and(Entity::reads_files);
        let construct: &dyn Fn(&Args) -> Result<Made, Refusal> =
            match store.sound(order).map(|entity| entity.construct) {
                Some(Construct::Object(_)) if reads_files => &|_| Ok(Made::ByFile),
                Some(Construct::Object(construct)) => {
                    &move |args| procedural::body(args, construct).map(Made::Object)
                }
                Some(Construct::Light(construct)) => &move |args| construct(args).map(Made::Light),
                _ => continue,
            };
        let args = store.args_in(order, &mut memory);
        if !patterns.contains_key(&order) && !args.refers_to_nothing() {
            made.push((order, construct(args)));
        }
    }
    made
}
