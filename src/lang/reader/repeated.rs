//! Warnings about names shared by several entities.

use super::fault::{Fault, Place};
use super::names::{Names, RepeatedClaims, Scope, scope};
use super::report::Report;
use std::collections::BTreeMap;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::store::Store;
use tabray_core::text;

/// The maximum number of faults of one sort that are listed separately.
const MAX_LISTED: usize = 8;

impl Names {
    /// Warns of names shared by several entities: once for each name, or once for all if there are many. `place`
    /// returns the place of an entity's name, given the entity's order. If entities `may_share` a name, there is no
    /// warning if all of them are used.
    pub fn report_repeated(
        &self,
        store: &Store,
        place: impl Fn(usize) -> Place,
        may_share: bool,
        report: &mut Report<'_>,
    ) {
        let [left_out, mut shared] = self.repeated(store);
        if may_share {
            shared.clear();
        }
        let is_placed = place(0).is_some();
        for Repeated { what, text, orders, others, more } in few(left_out, is_placed) {
            let message = match (others, orders.len()) {
                (0, 2) => format!("{what} `{text}` is defined twice"),
                (0, count) => format!("{what} `{text}` is defined {count} times"),
                _ => {
                    format!("{what} `{text}` and {} are defined more than once", text::count(others, "other"))
                }
            };
            let label = match more {
                0 => "ignored".to_owned(),
                1 => "ignored, as is 1 more".to_owned(),
                _ => format!("ignored, as are {more} more"),
            };
            report.add(
                Fault::warning(place(orders[1]), message)
                    .label(label)
                    .also(place(orders[0]), "this one is used")
                    .help("only the first definition of a name is used: rename the others"),
            );
        }
        for Repeated { what, text, orders, others, more } in few(shared, is_placed) {
            let message = match (others, orders.len()) {
                (0, 2) => format!("two {what}s have the name `{text}`"),
                (0, count) => format!("{count} {what}s have the name `{text}`"),
                _ => format!(
                    "several entities have the name `{text}`, and {} too",
                    text::count(others, "other name")
                ),
            };
            let label = if more == 0 { String::new() } else { format!("and {more} more") };
            report.add(
                Fault::warning(place(orders[1]), message)
                    .label(label)
                    .also(place(orders[0]), "the first one")
                    .help("all of them are used, but messages and dumps cannot tell them apart"),
            );
        }
    }

    /// Returns the names shared by several entities: first the names where only the first entity is used, then those
    /// where all are used.
    fn repeated<'s>(&self, store: &'s Store) -> [Vec<Repeated<'s>>; 2] {
        let (mut left_out, mut shared) = (Vec::new(), Vec::new());
        for (first, RepeatedClaims { again, .. }) in &self.again {
            let (text, Some(entity)) = (store.name(*first), store.entity(*first)) else { continue };
            let kind = entity.kind();
            let mut scopes: BTreeMap<Scope, Vec<usize>> = BTreeMap::new();
            let mut firsts = Vec::new();
            for (scope, order) in [(scope(entity), *first)].iter().chain(again) {
                let orders = scopes.entry(*scope).or_default();
                orders.push(*order);
                firsts.extend((orders.len() == 1).then_some(*order));
            }
            for (scope, orders) in scopes.into_iter().filter(|(_, orders)| orders.len() > 1) {
                let what = if scope.is_empty() { kind.to_string() } else { scope.to_owned() };
                let all = if kind == Kind::Light { &mut shared } else { &mut left_out };
                all.push(Repeated::new(what, text, orders));
            }
            if firsts.len() > 1 {
                shared.push(Repeated::new(kind.to_string(), text, firsts));
            }
        }
        [left_out, shared]
    }
}

/// Entities that share a name.
struct Repeated<'n> {
    what: String,
    text: &'n str,
    orders: Vec<usize>,
    /// The number of other names that this represents.
    others: usize,
    /// The number of places that this represents, beside the first two.
    more: usize,
}

impl<'n> Repeated<'n> {
    fn new(what: String, text: &'n str, orders: Vec<usize>) -> Self {
        let more = orders.len() - 2;
        Self { what, text, orders, others: 0, more }
    }
}

/// Returns repeated names. If there are more than [`MAX_LISTED`], the first name represents all.
fn few(mut all: Vec<Repeated<'_>>, is_placed: bool) -> Vec<Repeated<'_>> {
    // Entities without places are sorted by name.
    all.sort_unstable_by_key(|repeated| (is_placed.then_some(repeated.orders[1]), repeated.text));
    if all.len() > MAX_LISTED {
        let later: usize = all.iter().map(|repeated| repeated.orders.len() - 1).sum();
        let others = all.len() - 1;
        all.truncate(1);
        all.iter_mut().for_each(|first| (first.others, first.more) = (others, later - 1));
    }
    all
}
