//! Constructs the objects and the lights of a scene, which may depend on the whole scene.

use super::check::{Check, PIECE, Source, TOGETHER, place_of};
use super::fault::Fault;
use std::collections::BTreeMap;
use std::mem::take;
use std::ops::Range;
use std::ptr;
use std::sync::Arc;
use tabray_core::parallel;
use tabray_core::scene::entity::{Args, Construct, Entity, Refusal};
use tabray_core::scene::model::{Item, Object};
use tabray_core::scene::procedural;
use tabray_core::scene::store::{Record, Store};
use tabray_core::scene::value::Datum;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::body::{AnyShader, Body, Warning};
use tabray_core::world::lamp::Lamp;
use tabray_core::world::material::{Material, Rgb};
use tabray_core::world::rules::{Fading, Falloff, Rules};
use tabray_core::world::sky_light::SkyLight;

impl Check<'_, '_> {
    /// Constructs the objects and the lights. Objects that read files, and objects that others refer to, are
    /// constructed one after the other, because they share the remaining memory, and may refer to earlier ones.
    pub fn construct_waiting(&mut self, source: &Source<'_, '_>) -> Arc<Store> {
        let materials = self
            .materials
            .iter()
            .map(|(order, material)| (self.store.name(*order).to_owned(), material.clone()));
        Arc::make_mut(&mut self.setting).materials = Arc::new(materials.collect());
        self.store.setting = self.setting.clone();
        let store = Arc::new(take(&mut self.store));
        let patterns = self.names.patterns();
        self.names.forget();
        self.construct_patterns(&store, &patterns, source);
        for start in (0..store.count()).step_by(8 * TOGETHER) {
            let orders = start..store.count().min(start + 8 * TOGETHER);
            let constructed = parallel::map(orders.len().div_ceil(PIECE), |piece| {
                let start = start + piece * PIECE;
                constructed(&store, start..orders.end.min(start + PIECE), &patterns)
            });
            for (order, constructed) in constructed.into_iter().flatten() {
                let record = Record::new(&store, order);
                match constructed {
                    Ok(constructed) => self.add(record, constructed, source),
                    Err(refusal) => self.refused(&record.args(), refusal, source),
                }
            }
        }
        self.objects.shrink_to_fit();
        store
    }

    /// Constructs the objects that others refer to, by their orders.
    fn construct_patterns(
        &mut self,
        store: &Arc<Store>,
        patterns: &BTreeMap<usize, Datum>,
        source: &Source<'_, '_>,
    ) {
        let accuracy = self.setting.camera.accuracy;
        if self.names.combines && accuracy == Accuracy::Classic {
            // Solids need all hits of a ray, which the notes' formulas do not give.
            Arc::make_mut(&mut self.setting).camera.accuracy = Accuracy::Exact;
        }
        for (order, datum) in patterns {
            let Datum::Object { body, .. } = datum else { continue };
            let mut args = store.args(*order);
            args.is_pattern = true;
            if store.sound(*order).is_some()
                && !args.refers_to_nothing()
                && let Some(constructed) = self.body(args, source)
            {
                let material = constructed.material.clone().or_else(|| Record::new(store, *order).material());
                let entity = Some(store.args(*order).entity.name);
                body.set(Body { name: Some(store.name(*order).into()), entity, material, ..constructed });
            }
            self.patterns.push(Item { args: Record::new(store, *order), value: body.clone() });
        }
        if self.setting.camera.accuracy != accuracy {
            Arc::make_mut(&mut self.setting).camera.accuracy = accuracy;
        }
    }

    /// Adds an object or a light to the model.
    fn add(&mut self, record: Record, constructed: Constructed, source: &Source<'_, '_>) {
        match constructed {
            Constructed::Plain(shape, shader) => {
                let object = |material| Object { args: record.clone(), material, shape, shader };
                self.objects.extend(record.material().map(object));
            }
            Constructed::Body(body) => {
                if !body.warnings.is_empty() {
                    self.warn(&record.args(), &body.warnings, source);
                }
                self.labels.extend(body.labels.iter().map(|label| (record.order(), label.clone())));
                self.objects.extend(objects(record, *body));
            }
            Constructed::Deferred => {
                let body = self.body(record.args(), source);
                self.objects.extend(body.into_iter().flat_map(|body| objects(record.clone(), body)));
            }
            Constructed::Light(lamp) => {
                if let Some(warning) = self.unused_falloff(&lamp) {
                    self.warn(&record.args(), &[warning], source);
                }
                if lamp.emitter().is_some() && self.setting.camera.rules == Rules::Notes {
                    self.refused(&record.args(), only_free(None), source);
                }
                self.objects.extend(surface(&record, &lamp));
                self.lights.push(Item { args: record, value: lamp });
            }
        }
    }

    /// Adds the light of a background that lights surfaces.
    pub fn light_by_background(&mut self, store: &Arc<Store>, source: &Source<'_, '_>) {
        let Some((order, background)) = &self.background else { return };
        let args = store.args(*order);
        if !args.lights() {
            return;
        }
        let lamp = Lamp { light: Box::new(SkyLight::new(background.clone())), fading: Fading::NONE };
        self.lights.push(Item { args: Record::new(store, *order), value: lamp });
        if self.setting.camera.rules == Rules::Notes {
            self.refused(&args, only_free(Some("lights")), source);
        }
    }

    /// Constructs the body of an object within the remaining memory, and reports a refusal or warnings.
    fn body(&mut self, mut args: Args, source: &Source<'_, '_>) -> Option<Body> {
        let Construct::Object(construct) = args.entity.construct else { return None };
        args.setting = self.setting.clone();
        for file in args.files() {
            self.report.add_file(self.setting.folder.join(file));
        }
        let body = procedural::body(&args, construct)
            .map_err(|refusal| self.refused(&args, refusal, source))
            .ok()?;
        self.warn(&args, &body.warnings, source);
        body.files.iter().for_each(|file| self.report.add_file(file.clone()));
        if body.bytes > 0 {
            let setting = Arc::make_mut(&mut self.setting);
            setting.memory = setting.memory.saturating_sub(body.bytes);
            self.texture_memory = self.texture_memory.min(setting.memory);
        }
        Some(body)
    }

    /// Returns a warning if a lamp has a falloff without effect.
    fn unused_falloff(&self, lamp: &Lamp) -> Option<Warning> {
        let is_used = lamp.fading.falloff == Falloff::None || self.setting.camera.rules == Rules::Free;
        (!is_used).then(|| Warning {
            attribute: "falloff",
            message: "has a `falloff`, which the notes' rules of light do not know".to_owned(),
            help: "under the notes' rules, its light is divided by the distance; `rules free` in the camera changes \
                   that"
                .to_owned(),
        })
    }

    /// Reports warnings about an object or a light.
    fn warn(&mut self, args: &Args, warnings: &[Warning], source: &Source<'_, '_>) {
        for Warning { attribute, message, help } in warnings {
            let parsed = source.entity(self.registry, args.order, &self.places.get(args.order));
            let place = parsed.and_then(|parsed| place_of(args.entity, &parsed, Some(attribute)));
            let message = format!("{} `{}` {message}", args.entity.name, args.name);
            self.report.add(Fault::warning(place, message).help(help));
        }
    }

    fn refused(&mut self, args: &Args, refusal: Refusal, source: &Source<'_, '_>) {
        let parsed = source.entity(self.registry, args.order, &self.places.get(args.order));
        self.refuse(parsed.as_deref(), args, refusal);
    }
}

/// Returns the visible object of a light, if it has one.
fn surface(record: &Record, lamp: &Lamp) -> Option<Object> {
    let Body { shape, shader, .. } = Body::plain(lamp.shape()?);
    let ambient = Rgb::from(lamp.sends(lamp.location().to_array()));
    let material = Arc::new(Material { ambient, ..Material::default() });
    Some(Object { args: record.clone(), material, shape, shader })
}

/// Returns the reason why the notes' rules refuse a light.
fn only_free(attribute: Option<&'static str>) -> Refusal {
    Refusal {
        attribute,
        message: "is a light that the notes' rules of light do not know".to_owned(),
        help: "give the camera `rules free`, and do not render with `--method classic`, which always means the notes' rules",
    }
}

/// Returns the visible objects of a body, with their own materials or with the material of the record.
fn objects(record: Record, mut body: Body) -> impl Iterator<Item = Object> {
    let more = take(&mut body.more);
    let mut seen: Vec<_> = take(&mut body.faces).into_iter().filter_map(Arc::into_inner).collect();
    if seen.is_empty() {
        seen.push(body);
    }
    seen.into_iter().chain(more).filter_map(move |body| {
        let material = body.material.clone().or_else(|| record.material())?;
        // Rays continue inside of refracting objects.
        let boundary = material.interface.as_ref().and_then(|_| body.boundary());
        let Body { shape, shader, .. } = body;
        Some(Object { args: record.clone(), material, shape: boundary.unwrap_or(shape), shader })
    })
}

/// The result of the constructor of an object or a light.
enum Constructed {
    /// A shape and a shader alone.
    Plain(AnyShape, AnyShader),
    /// An object with warnings, further objects or its own material.
    Body(Box<Body>),
    Light(Lamp),
    /// An object that reads files. It is constructed later, one at a time.
    Deferred,
}

/// Constructs the objects and lights among some entities, except for `patterns`, the objects that others refer to, and
/// except for entities that refer to faulty ones.
fn constructed(
    store: &Store,
    orders: Range<usize>,
    patterns: &BTreeMap<usize, Datum>,
) -> Vec<(usize, Result<Constructed, Refusal>)> {
    // Growing the list would leave holes in memory between the shapes.
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

/// Returns the result for a body. Most objects take a fraction of its memory.
fn of(body: Body) -> Constructed {
    let is_all = body.warnings.is_empty() && body.more.is_empty() && body.material.is_none();
    let is_all = is_all && body.boundary.is_none() && body.faces.is_empty() && body.labels.is_empty();
    if is_all { Constructed::Plain(body.shape, body.shader) } else { Constructed::Body(Box::new(body)) }
}
