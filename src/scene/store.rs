//! The entities of a scene as they were given, packed: a scene may have millions, and all that a render needs of most of
//! them is their names.

use crate::scene::entity::{Args, Entity, Setting};
use crate::scene::pparm::Given;
use crate::scene::value::Datum;
use crate::world::material::Material;
use std::mem::take;
use std::ptr;
use std::sync::Arc;

/// The number of entities that are packed into one piece of memory. The pieces are as long as what is in them.
const TOGETHER: usize = 1 << 10;

/// How the value of an attribute is packed: as it is by default, as numbers, or as the index of a datum.
const DEFAULT: u8 = 0;
const NUMBERS: u8 = 1;
const WHOLE: u8 = 2;
const DATUM: u8 = 3;

/// The bit of an entity's type that marks an entity with values.
const HAS_VALUES: u16 = 1 << 15;

/// The length of a name from which on it is written in four more bytes.
const LONG: usize = u8::MAX as usize;

/// The entities of a scene, each with its type, its name and the values that the scene gives, by their order in the
/// text.
#[derive(Default)]
pub struct Store {
    /// What constructors may know of the scene.
    pub setting: Arc<Setting>,
    /// The types of the entities.
    types: Vec<&'static Entity>,
    /// The values that are not numbers. Entities that follow each other share them.
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
    pub fn len(&self) -> usize {
        self.blocks.len() * TOGETHER + self.starts.len()
    }

    /// Adds an entity with its values, or without them if they are faulty.
    pub fn add(&mut self, entity: &'static Entity, name: &str, values: Option<&[Given]>) {
        let start = self.bytes.len();
        let number = self.number(entity).unwrap_or_else(|| {
            self.types.push(entity);
            self.types.len() - 1
        });
        let mut bytes = take(&mut self.bytes);
        let mut packed = Packed::begin(&mut bytes, number, name, values.is_some());
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

    /// Adds an entity that was packed before; none of its type may be the first.
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

    /// Returns the number of an entity type of which there is an entity.
    pub fn number(&self, entity: &'static Entity) -> Option<usize> {
        self.types.iter().position(|known| ptr::eq(*known, entity))
    }

    /// Returns the index of a datum, and keeps the datum if it is not one of those that were needed last.
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
    pub fn first_datum(&self, order: usize) -> Option<&Datum> {
        let mut packed = self.packed(order);
        packed.kind();
        packed.name();
        while let Some(tag) = packed.byte() {
            match tag {
                DATUM => return Some(self.datum(packed.word())),
                DEFAULT => {}
                _ => {
                    let count = packed.word();
                    for _ in 0..count {
                        packed.long();
                    }
                }
            }
        }
        None
    }

    /// Returns an entity with its values, or with defaults where those are faulty.
    ///
    /// # Panics
    /// If the entity's type is unknown.
    pub fn args(&self, order: usize) -> Args {
        let entity = self.entity(order).expect("only entities of known types are asked for");
        let mut args = Args::blank(entity, self.setting.clone());
        self.read(order, &mut args);
        args
    }

    /// Makes `args` those of another entity. What both have in common stays where it is in memory.
    pub fn read(&self, order: usize, args: &mut Args) {
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
            let tag = packed.byte().unwrap_or(DEFAULT);
            match tag {
                NUMBERS => {
                    let numbers = (0..packed.word()).map(|_| f64::from_bits(packed.long()));
                    match datum {
                        Datum::Numbers(old) => {
                            old.clear();
                            old.extend(numbers);
                        }
                        other => *other = Datum::Numbers(numbers.collect()),
                    }
                }
                WHOLE => *datum = Datum::Whole((0..packed.word()).map(|_| packed.long() as i64).collect()),
                DATUM => {
                    let new = self.datum(packed.word());
                    if !datum.is_same(new) {
                        *datum = new.clone();
                    }
                }
                _ if *is_given => *datum = attribute.default().unwrap_or(Datum::Absent),
                _ => {}
            }
            *is_given = tag != DEFAULT;
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

/// An entity that is being packed: first its values in the order of its table, then nothing more.
pub struct Packed<'b>(&'b mut Vec<u8>);

impl<'b> Packed<'b> {
    /// Begins an entity of the type of this [number](Store::number), after what was packed before.
    pub fn begin(bytes: &'b mut Vec<u8>, number: usize, name: &str, has_values: bool) -> Self {
        let kind = number as u16 | if has_values { HAS_VALUES } else { 0 };
        bytes.extend(kind.to_le_bytes());
        match name.len() {
            short @ 0..LONG => bytes.push(short as u8),
            long => {
                bytes.push(LONG as u8);
                bytes.extend((long as u32).to_le_bytes());
            }
        }
        bytes.extend_from_slice(name.as_bytes());
        Self(bytes)
    }

    /// Adds an attribute that the scene does not give.
    pub fn default(&mut self) {
        self.0.push(DEFAULT);
    }

    /// Adds an attribute of numbers.
    pub fn numbers(&mut self, numbers: &Datum) {
        match numbers {
            Datum::Numbers(numbers) => {
                self.count(NUMBERS, numbers.len());
                numbers.iter().for_each(|number| self.0.extend_from_slice(&number.to_bits().to_le_bytes()));
            }
            Datum::Whole(numbers) => {
                self.count(WHOLE, numbers.len());
                numbers.iter().for_each(|number| self.0.extend_from_slice(&number.to_le_bytes()));
            }
            _ => {}
        }
    }

    /// Adds an attribute of another type, by the index of its datum.
    pub fn datum(&mut self, index: u32) {
        self.count(DATUM, index as usize);
    }

    fn count(&mut self, tag: u8, count: usize) {
        self.0.push(tag);
        self.0.extend_from_slice(&(count as u32).to_le_bytes());
    }
}

/// The rest of the bytes of a packed entity.
struct Unpacker<'s>(&'s [u8]);

impl<'s> Unpacker<'s> {
    /// Returns the number of the entity's type, and whether the entity has values; `None` if its type is unknown.
    fn kind(&mut self) -> Option<(usize, bool)> {
        let kind = self.part().map(u16::from_le_bytes)?;
        Some(((kind & !HAS_VALUES).into(), kind & HAS_VALUES != 0))
    }

    fn name(&mut self) -> &'s str {
        let length = match self.byte() {
            Some(u8::MAX) => self.word() as usize,
            length => length.unwrap_or(0).into(),
        };
        let (name, rest) = self.0.split_at(length);
        self.0 = rest;
        std::str::from_utf8(name).unwrap_or_default()
    }

    fn byte(&mut self) -> Option<u8> {
        self.part().map(|[byte]| byte)
    }

    fn word(&mut self) -> u32 {
        self.part().map_or(0, u32::from_le_bytes)
    }

    fn long(&mut self) -> u64 {
        self.part().map_or(0, u64::from_le_bytes)
    }

    fn part<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (part, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*part)
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
    pub(crate) fn new(store: &Arc<Store>, order: usize) -> Self {
        Self { store: store.clone(), order: order as u32 }
    }

    /// Returns the entity's type.
    pub fn entity(&self) -> &'static Entity {
        self.store.entity(self.order()).expect("a model has only entities of known types")
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
    pub(crate) fn material(&self) -> Option<Arc<Material>> {
        match self.store.first_datum(self.order())? {
            Datum::Material { material, .. } => Some(material.clone()),
            _ => None,
        }
    }

    /// Returns the entity with all its values.
    pub fn args(&self) -> Args {
        self.store.args(self.order())
    }
}
