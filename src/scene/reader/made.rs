//! Constructs objects and lights, some at a time.

use crate::scene::entity::{Args, Construct, Refusal};
use crate::scene::store::Store;
use crate::world::body::{AnyLight, Body};
use std::ops::Range;

/// What the constructor of an object or a light makes.
pub enum Made {
    Object(Body),
    Light(AnyLight),
}

/// Constructs the objects and lights among some entities.
pub fn made(store: &Store, orders: Range<usize>) -> Vec<(usize, Result<Made, Refusal>)> {
    // Where it has to grow, it leaves holes in memory between the shapes.
    let (mut made, mut memory) = (Vec::with_capacity(orders.len()), None);
    for order in orders {
        let construct: &dyn Fn(&Args) -> Result<Made, Refusal> =
            match store.sound(order).map(|entity| entity.construct) {
                Some(Construct::Object(construct)) => &move |args| construct(args).map(Made::Object),
                Some(Construct::Light(construct)) => &move |args| construct(args).map(Made::Light),
                _ => continue,
            };
        made.push((order, construct(store.args_in(order, &mut memory))));
    }
    made
}
