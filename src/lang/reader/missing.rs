//! Missing names of a scene.

use super::fault::Place;
use super::parsed::Word;
use hashbrown::HashSet;
use std::collections::{BTreeMap, btree_map};
use std::hash::Hash;

/// The maximum number of different missing names of one sort that are kept. Further names are only counted.
const MAX_MISSING: usize = 10_000;

/// Names without an entity or type. Their number is limited, so that a scene that consists of such names takes little
/// memory.
pub struct Missing<K> {
    /// The first names, each with its first place and the number of its places.
    pub names: BTreeMap<(K, String), (Place, usize)>,
    /// The hashes of further names.
    others: HashSet<(K, u64)>,
}

impl<K> Default for Missing<K> {
    fn default() -> Self {
        Self { names: BTreeMap::new(), others: HashSet::new() }
    }
}

impl<K: Copy + Ord + Hash> Missing<K> {
    /// Adds a missing name of this sort at a place.
    pub fn add(&mut self, sort: K, Word { text, place, .. }: &Word<'_>, hash: u64) {
        let is_full = self.names.len() >= MAX_MISSING;
        match self.names.entry((sort, text.to_string())) {
            btree_map::Entry::Occupied(mut known) => known.get_mut().1 += 1,
            btree_map::Entry::Vacant(free) if !is_full => {
                free.insert((place.clone(), 1));
            }
            btree_map::Entry::Vacant(_) => {
                self.others.insert((sort, hash));
            }
        }
    }

    /// Returns the different hashes of the names that are not kept.
    pub fn others(&self) -> impl Iterator<Item = u64> {
        self.others.iter().map(|(_, hash)| *hash)
    }

    /// Tells whether no name is missing.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }
}
