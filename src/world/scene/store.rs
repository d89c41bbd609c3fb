//! The entities of a scene as they were given, packed. A scene may have millions of them, and a render needs only the
//! names of most.

use crate::material::Material;
use crate::scene::entity::{Args, Entity, Setting};
use crate::scene::pparm::AttributeValue;
use crate::scene::value::Datum;
use std::mem::take;
use std::ptr;
use std::sync::Arc;

/// The number of entities that are packed into one piece of memory. A piece is no longer than its contents.
const TOGETHER: usize = 1 << 10;

/// The packed form of an attribute: its default, the count of the numbers that follow, or the index of a datum.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Default,
    Numbers(u32),
    Whole(u32),
    Datum(u32),
}

/// The entities of a scene, each with its type, its name and the values that the scene gives, by their order in the
/// text.
#[derive(Default)]
pub struct Store {
    /// The parts of the scene that constructors may know.
    pub setting: Arc<Setting>,
    types: Vec<&'static Entity>,
    /// The values that are not numbers. Consecutive entities share them.
    data: Vec<Datum>,
    blocks: Vec<Block>,
    /// The bytes of the entities that do not fill a block, and where each of them begins.
    bytes: Vec<u8>,
    starts: Vec<u32>,
}

/// The bytes of [`TOGETHER`] entities, and where each of them begins.
struct Block {
    bytes: Box<[u8]>,
    starts: Box<[u32]>,
}

impl Store {
    /// Returns the number of entities.
    pub fn count(&self) -> usize {
        self.blocks.len() * TOGETHER + self.starts.len()
    }

    /// Adds an entity with its values, or without them if they are faulty.
    pub fn add(&mut self, entity: &'static Entity, name: &str, values: Option<&[AttributeValue]>) {
        let start = self.bytes.len();
        let number = self.number(entity).unwrap_or_else(|| {
            self.types.push(entity);
            self.types.len() - 1
        });
        let mut bytes = take(&mut self.bytes);
        let mut packed = Packer::begin(&mut bytes, number, name, values.is_some());
        for (datum, is_given) in values.unwrap_or_default() {
            match datum {
                _ if !is_given => packed.default(),
                Datum::Numbers(_) | Datum::Whole(_) => packed.numbers(datum),
                datum => packed.datum(self.index(datum)),
            }
        }
        self.bytes = bytes;
        self.end(start);
    }

    /// Adds an entity that was packed before. The first entity of a type is not added in this way.
    pub fn add_packed(&mut self, packed: &[u8]) {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(packed);
        self.end(start);
    }

    /// Counts an entity of an unknown type.
    pub fn skip(&mut self) {
        self.end(self.bytes.len());
    }

    fn end(&mut self, start: usize) {
        self.starts.push(start as u32);
        if self.starts.len() == TOGETHER {
            self.blocks
                .push(Block { bytes: Box::from(&self.bytes[..]), starts: Box::from(&self.starts[..]) });
            self.bytes.clear();
            self.starts.clear();
        }
    }

    /// Returns the number of an entity type that the scene uses.
    pub fn number(&self, entity: &'static Entity) -> Option<usize> {
        self.types.iter().position(|known| ptr::eq(*known, entity))
    }

    /// Returns the index of a datum, and stores the datum unless it is among the most recent ones.
    pub fn index(&mut self, datum: &Datum) -> u32 {
        let recent = self.data.len().saturating_sub(4)..self.data.len();
        let known = recent.rev().find(|index| self.data[*index].is_same(datum));
        known.unwrap_or_else(|| {
            self.data.push(datum.clone());
            self.data.len() - 1
        }) as u32
    }

    /// Returns the datum of this index.
    pub fn datum(&self, index: u32) -> &Datum {
        &self.data[index as usize]
    }

    /// Returns the type of an entity, or `None` if it is unknown.
    pub fn entity(&self, order: usize) -> Option<&'static Entity> {
        self.packed(order).kind().map(|(number, _)| self.types[number])
    }

    /// Returns the type of an entity that has values.
    pub fn sound(&self, order: usize) -> Option<&'static Entity> {
        let (number, has_values) = self.packed(order).kind()?;
        has_values.then(|| self.types[number])
    }

    /// Returns the name of an entity; empty for one of an unknown type.
    pub fn name(&self, order: usize) -> &str {
        let mut packed = self.packed(order);
        packed.kind();
        packed.name()
    }

    /// Returns the first value of an entity that is neither numbers nor a default.
    pub(crate) fn first_datum(&self, order: usize) -> Option<&Datum> {
        let mut packed = self.packed(order);
        packed.kind();
        packed.name();
        loop {
            match packed.tag()? {
                Tag::Datum(index) => return Some(self.datum(index)),
                Tag::Default => {}
                Tag::Numbers(count) | Tag::Whole(count) => {
                    for _ in 0..count {
                        packed.number();
                    }
                }
            }
        }
    }

    /// Returns an entity with its values, or with defaults where its values are faulty.
    ///
    /// # Panics
    /// If the entity's type is unknown.
    pub fn args(&self, order: usize) -> Args {
        let entity = self.entity(order).expect("only entities of known types are asked for");
        let mut args = Args::blank(entity, self.setting.clone());
        self.read(order, &mut args);
        args
    }

    /// Returns an entity with its values as [`args`](Self::args) does, and reuses the memory of another one if there
    /// is one.
    pub fn args_in<'m>(&self, order: usize, memory: &'m mut Option<Args>) -> &'m Args {
        match memory {
            Some(args) => {
                self.read(order, args);
                args
            }
            None => memory.insert(self.args(order)),
        }
    }

    /// Makes `args` those of another entity. Parts that both have in common keep their memory.
    fn read(&self, order: usize, args: &mut Args) {
        let mut packed = self.packed(order);
        let Some((number, _)) = packed.kind() else { return };
        let entity = self.types[number];
        if !ptr::eq(args.entity, entity) {
            *args = Args::blank(entity, args.setting.clone());
        }
        args.order = order;
        args.name.clear();
        args.name.push_str(packed.name());
        for (attribute, datum, is_given) in args.values_mut() {
            let tag = packed.tag().unwrap_or(Tag::Default);
            match tag {
                Tag::Numbers(count) => {
                    let numbers = (0..count).map(|_| f64::from_le_bytes(packed.number()));
                    match datum {
                        Datum::Numbers(old) => {
                            old.clear();
                            old.extend(numbers);
                        }
                        other => *other = Datum::Numbers(numbers.collect()),
                    }
                }
                Tag::Whole(count) => {
                    let numbers = (0..count).map(|_| i64::from_le_bytes(packed.number()));
                    *datum = Datum::Whole(numbers.collect());
                }
                Tag::Datum(index) => {
                    let new = self.datum(index);
                    if !datum.is_same(new) {
                        *datum = new.clone();
                    }
                }
                Tag::Default if *is_given => *datum = attribute.default().unwrap_or(Datum::Absent),
                Tag::Default => {}
            }
            *is_given = tag != Tag::Default;
        }
    }

    fn packed(&self, order: usize) -> Unpacker<'_> {
        let (bytes, starts) = match self.blocks.get(order / TOGETHER) {
            Some(Block { bytes, starts }) => (&bytes[..], &starts[..]),
            None => (&self.bytes[..], &self.starts[..]),
        };
        let index = order % TOGETHER;
        let end = starts.get(index + 1).map_or(bytes.len(), |end| *end as usize);
        Unpacker(&bytes[starts[index] as usize..end])
    }
}

/// An entity that is being packed: its type, its name, and its values in the order of its table.
pub struct Packer<'b>(&'b mut Vec<u8>);

impl<'b> Packer<'b> {
    /// Begins an entity of the type of this [number](Store::number), after what was packed before.
    pub fn begin(bytes: &'b mut Vec<u8>, number: usize, name: &str, has_values: bool) -> Self {
        let mut packed = Self(bytes);
        packed.count(2 * number + usize::from(has_values));
        packed.count(name.len());
        packed.0.extend_from_slice(name.as_bytes());
        packed
    }

    /// Adds an attribute that the scene does not give.
    pub fn default(&mut self) {
        self.tag(Tag::Default);
    }

    /// Adds an attribute of numbers.
    pub fn numbers(&mut self, numbers: &Datum) {
        match numbers {
            Datum::Numbers(numbers) => {
                self.tag(Tag::Numbers(numbers.len() as u32));
                numbers.iter().for_each(|number| self.0.extend_from_slice(&number.to_le_bytes()));
            }
            Datum::Whole(numbers) => {
                self.tag(Tag::Whole(numbers.len() as u32));
                numbers.iter().for_each(|number| self.0.extend_from_slice(&number.to_le_bytes()));
            }
            _ => {}
        }
    }

    /// Adds an attribute of another type, by the index of its datum.
    pub fn datum(&mut self, index: u32) {
        self.tag(Tag::Datum(index));
    }

    fn tag(&mut self, tag: Tag) {
        let (kind, count) = match tag {
            Tag::Default => (0, 0),
            Tag::Numbers(count) => (1, count),
            Tag::Whole(count) => (2, count),
            Tag::Datum(index) => (3, index),
        };
        self.count(4 * count as usize + kind);
    }

    /// Adds an integer in LEB128: seven bits in each byte, from the lowest on, and a bit that tells whether more
    /// follow.
    fn count(&mut self, mut count: usize) {
        while count >= 0x80 {
            self.0.push(count as u8 | 0x80);
            count >>= 7;
        }
        self.0.push(count as u8);
    }
}

/// The rest of the bytes of a packed entity.
struct Unpacker<'s>(&'s [u8]);

impl<'s> Unpacker<'s> {
    /// Returns the number of the entity's type, and whether the entity has values; `None` if its type is unknown.
    fn kind(&mut self) -> Option<(usize, bool)> {
        let kind = self.count()?;
        Some((kind / 2, kind % 2 == 1))
    }

    fn name(&mut self) -> &'s str {
        let (name, rest) =
            self.count().and_then(|length| self.0.split_at_checked(length)).unwrap_or_default();
        self.0 = rest;
        std::str::from_utf8(name).unwrap_or_default()
    }

    fn tag(&mut self) -> Option<Tag> {
        let tag = self.count()?;
        let count = (tag / 4) as u32;
        Some([Tag::Default, Tag::Numbers(count), Tag::Whole(count), Tag::Datum(count)][tag % 4])
    }

    fn count(&mut self) -> Option<usize> {
        let (mut count, mut shift) = (0, 0);
        loop {
            let (byte, rest) = self.0.split_first()?;
            self.0 = rest;
            count |= usize::from(byte & 0x7f) << shift;
            shift += 7;
            if byte & 0x80 == 0 {
                return Some(count);
            }
        }
    }

    fn number(&mut self) -> [u8; 8] {
        let (number, rest) = self.0.split_first_chunk().unwrap_or((&[0; 8], &[]));
        self.0 = rest;
        *number
    }
}

/// An entity of a model as it was given.
#[derive(Clone)]
pub struct Record {
    store: Arc<Store>,
    order: u32,
}

impl Record {
    /// Refers to the entity of a store that has this order.
    pub fn new(store: &Arc<Store>, order: usize) -> Self {
        Self { store: store.clone(), order: order as u32 }
    }

    /// Returns the entity's type.
    pub fn entity(&self) -> &'static Entity {
        self.store.entity(self.order()).expect("a model has only entities of known types")
    }

    /// Returns the types of the scene's entities, each once.
    pub(crate) fn types(&self) -> &[&'static Entity] {
        &self.store.types
    }

    /// Returns the entity's name.
    pub fn name(&self) -> &str {
        self.store.name(self.order())
    }

    /// Returns the entity's index among the scene's entities, in the order of the text, from 0.
    pub fn order(&self) -> usize {
        self.order as usize
    }

    /// Returns the material of an object.
    pub fn material(&self) -> Option<Arc<Material>> {
        match self.store.first_datum(self.order())? {
            Datum::Material { material, .. } => Some(material.clone()),
            _ => None,
        }
    }

    /// Returns the entity with all its values.
    pub fn args(&self) -> Args {
        self.store.args(self.order())
    }

    /// Returns the entity with all its values, and reuses the memory of another one of the same model.
    pub fn args_in<'m>(&self, memory: &'m mut Option<Args>) -> &'m Args {
        self.store.args_in(self.order(), memory)
    }
}
