//! Checks that plugins keep the contracts of the traits that they implement.
//!
//! The compiler checks that a plugin has the right functions, but not their results. Here every plugin that is linked
//! in is tried, with values that its table allows and with rays at the results of its constructor. A crate with
//! plugins needs one line in a test for that: [`assert_kept`].

mod cameras;
mod draw;
mod extremes;
mod looks;
mod promise;
mod rays;
mod shape;
mod surface;

pub use promise::Promise;

use draw::{Draw, SceneFolder, StandIns};
use promise::Fault;
use std::collections::BTreeMap;
use std::fmt;
use std::slice;
use std::sync::Mutex;
use tabray_core::parallel;
use tabray_core::scene::choice::{Choice, ChoiceName};
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::Model;
use tabray_core::scene::profile::Profile;
use tabray_core::scene::value::Type;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::dump;
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// The number of scenes that are drawn for an entity type.
const SCENES: usize = 24;

/// One of this many scenes is also tried at its objects' extremes.
const EXTREMES: usize = 8;

/// The number of rays that are traced at each object of a drawn scene.
const RAYS: usize = 25;

/// A promise that a plugin breaks.
#[derive(Clone, Debug)]
pub struct Breach {
    /// The plugin: "the object `sphere`".
    pub plugin: String,
    /// The file and line that register the plugin.
    pub place: String,
    /// The promise that is broken.
    pub promise: Promise,
    /// What the plugin does instead, for messages.
    pub found: String,
    /// A scene that shows the breach; empty where none is needed.
    pub scene: String,
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { plugin, place, promise, found, scene } = self;
        writeln!(f, "{place}: {plugin} breaks its contract: {promise}")?;
        writeln!(f, "  found: {found}")?;
        writeln!(f, "  fix:   {}", promise.help())?;
        if !scene.is_empty() {
            writeln!(f, "  in this scene:\n")?;
            scene.lines().try_for_each(|line| writeln!(f, "    {line}"))?;
        }
        Ok(())
    }
}

/// Panics if a plugin that is linked into this program breaks a contract. For tests.
///
/// # Panics
/// With a message for each such plugin: its file, the promise, what was found, how to fix it, and a scene that shows
/// it.
#[track_caller]
pub fn assert_kept() {
    let registry = Registry::get().unwrap_or_else(|faults| panic!("{faults}"));
    let breaches: Vec<_> = breaches(registry).iter().map(Breach::to_string).collect();
    assert!(breaches.is_empty(), "\n\n{}", breaches.join("\n"));
}

/// Returns the gravest breach of each entity type of a registry, and of each profile.
pub fn breaches(registry: &Registry) -> Vec<Breach> {
    let mut trial = Trial::new(registry);
    let takes_objects =
        |entity: &Entity| entity.attributes().any(|of| matches!(of.value_type(), Type::Name(Kind::Object)));
    let (made, plain): (Vec<_>, Vec<_>) = registry.iter().partition(|entity| takes_objects(entity));
    let of_each = |trial: &Trial, entities: &[&'static Entity]| {
        parallel::map(entities.len(), |index| trial.breach_of(entities[index]))
    };
    // What is made of others is not tried with the broken ones. A solid with a slow part would take minutes.
    let of_plain = of_each(&trial, &plain);
    let broken = plain.iter().zip(&of_plain).filter(|(_, breach)| breach.is_some());
    trial.broken = broken.map(|(entity, _)| *entity).collect();
    let mut found: Vec<_> = of_plain.into_iter().chain(of_each(&trial, &made)).flatten().collect();
    found.extend(inventory::iter::<Profile>().filter_map(of_profile));
    found.sort_by(|a, b| (&a.place, &a.plugin).cmp(&(&b.place, &b.plugin)));
    found
}

/// Returns the gravest breach of one entity type of a registry.
pub fn breach_of(registry: &Registry, entity: &'static Entity) -> Option<Breach> {
    Trial::new(registry).breach_of(entity)
}

/// The entity types of a registry, and what was found of them.
struct Trial<'r> {
    registry: &'r Registry,
    scenes: SceneFolder,
    /// The entity types that are known to break the contract before those that are made of them are tried.
    broken: Vec<&'static Entity>,
    /// By the entity types' names.
    found: Mutex<BTreeMap<&'static str, Option<Breach>>>,
}

impl<'r> Trial<'r> {
    fn new(registry: &'r Registry) -> Self {
        Self { registry, scenes: SceneFolder::new(), broken: Vec::new(), found: Mutex::default() }
    }

    /// Returns the gravest breach of an entity type that is its own: not of the types that its scenes refer to.
    fn breach_of(&self, entity: &'static Entity) -> Option<Breach> {
        let known = |found: &Mutex<BTreeMap<_, _>>| found.lock().ok()?.get(entity.name).cloned();
        if let Some(known) = known(&self.found) {
            return known;
        }
        let mut shunned = self.broken.clone();
        let breach = loop {
            let stand_ins = StandIns::new(self.registry, &self.scenes, &shunned);
            let Some(breach) = of_entity(self.registry, entity, &self.scenes, &stand_ins) else { break None };
            let culprits = stand_ins.in_scene(&breach.scene).filter(|other| self.breach_of(other).is_some());
            let before = shunned.len();
            shunned.extend(culprits);
            if shunned.len() == before {
                break Some(breach);
            }
        };
        if let Ok(mut found) = self.found.lock() {
            found.insert(entity.name, breach.clone());
        }
        breach
    }
}

/// Returns the gravest breach of each object and light of a scene, and of its camera.
pub fn breaches_in(model: &Model) -> Vec<Breach> {
    let mut draw = Draw::new("scene");
    let mut found = Vec::new();
    for object in &model.objects {
        let tried = extremes::try_objects(slice::from_ref(object));
        found.extend(tried.err().map(|fault| (object.args.entity(), fault)));
        found.extend(
            rays::try_object(object, &mut draw, RAYS).gravest.map(|fault| (object.args.entity(), fault)),
        );
    }
    for light in &model.lights {
        found.extend(looks::light(&*light.value, &mut draw).err().map(|fault| (light.args.entity(), fault)));
    }
    if let Some(background) = &model.background {
        let fault = looks::background(&*background.value, &mut draw).err();
        found.extend(fault.map(|fault| (background.args.entity(), fault)));
    }
    let camera = &model.camera;
    found.extend(cameras::camera(&camera.value).err().map(|fault| (camera.args.entity(), fault)));
    found
        .into_iter()
        .map(|(entity, fault)| breach(entity, fault, dump::scene(model, Syntax::Notes)))
        .collect()
}

fn breach(entity: &Entity, Fault { promise, found }: Fault, scene: String) -> Breach {
    Breach {
        plugin: format!("the {} `{}`", entity.kind(), entity.name),
        place: entity.place(),
        promise,
        found,
        scene,
    }
}

/// Returns the gravest breach in the scenes that are drawn for an entity type.
fn of_entity(
    registry: &Registry,
    entity: &'static Entity,
    scenes: &SceneFolder,
    stand_ins: &StandIns,
) -> Option<Breach> {
    let mut draw = Draw::new(entity.name);
    let (mut gravest, mut refused, mut models, mut hits): (Option<Breach>, _, _, _) = (None, None, 0, 0);
    let mut seen = String::new();
    for index in 0..SCENES {
        let text = draw.scene(registry, entity, stand_ins);
        let accuracy = if index % 4 == 3 { Accuracy::Strict } else { Accuracy::Exact };
        let model = match reader::read(registry, "scene", scenes.folder(), text.as_bytes(), Some(accuracy)) {
            Ok(loaded) => loaded.model,
            Err(report) => {
                refused.get_or_insert_with(|| (report.to_string(), text));
                continue;
            }
        };
        models += 1;
        let tried = match entity.kind() {
            Kind::Camera => cameras::camera(&model.camera.value),
            Kind::Material => {
                model.materials.iter().try_for_each(|item| looks::material(&item.value, &mut draw))
            }
            Kind::Texture => Ok(()),
            Kind::Shader => model.shaders.iter().try_for_each(|item| looks::paint(&item.value, &mut draw)),
            Kind::Light => model.lights.iter().try_for_each(|item| looks::light(&*item.value, &mut draw)),
            Kind::Background => {
                model.background.iter().try_for_each(|item| looks::background(&*item.value, &mut draw))
            }
            Kind::Object => model.objects.iter().try_for_each(|object| {
                let outcome = rays::try_object(object, &mut draw, RAYS);
                hits += outcome.hits;
                outcome.gravest.map_or(Ok(()), Err)
            }),
        };
        let syntax = if index % 2 == 0 { Syntax::Notes } else { Syntax::Toml };
        if let Err(fault) = looks::dump(registry, scenes.folder(), &model, syntax).and(tried) {
            let ends = fault.promise == Promise::RayIsQuick;
            if gravest.as_ref().is_none_or(|breach| fault.promise < breach.promise) {
                gravest = Some(breach(entity, fault, text.clone()));
            }
            // More scenes would take long.
            if ends {
                break;
            }
        }
        if entity.kind() == Kind::Object && index % EXTREMES == 0 {
            // An object may have no inside, or there may be no copies.
            let extra = extremes::VARIANTS[index / EXTREMES % extremes::VARIANTS.len()];
            let with_copy = format!("{text}{extra}\n");
            let read = |text: &str| {
                reader::read(registry, "scene", scenes.folder(), text.as_bytes(), Some(accuracy))
            };
            let (text, objects) = match read(&with_copy) {
                Ok(loaded) => (with_copy, loaded.model.objects),
                Err(_) => (text.clone(), model.objects),
            };
            if let Err(fault) = extremes::try_objects(&objects)
                && gravest.as_ref().is_none_or(|breach| fault.promise < breach.promise)
            {
                gravest = Some(breach(entity, fault, text));
            }
        }
        seen = text;
    }
    let other =
        |promise: Promise, found: &str, scene: String| Some(breach(entity, promise.fault(found), scene));
    match refused {
        Some((report, text)) if models == 0 => {
            other(Promise::TakesWhatItsTableAllows, report.trim_end(), text)
        }
        _ if entity.kind() == Kind::Object && hits == 0 && gravest.is_none() => {
            other(Promise::IsMet, "none of thousands of rays hits it", seen)
        }
        _ => gravest,
    }
}

fn of_profile(profile: &'static Profile) -> Option<Breach> {
    of_choice("profile", profile.option(), looks::profile(profile))
}

fn of_choice(what: &str, choice: ChoiceName, outcome: Result<(), Fault>) -> Option<Breach> {
    let Fault { promise, found } = outcome.err()?;
    let (plugin, place) = (format!("the {what} `{}`", choice.name), tabray_core::text::place(choice.place));
    Some(Breach { plugin, place, promise, found, scene: String::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use tabray_core::world::body::ShaderFactory;
    use tabray_core::world::light::Light;
    use tabray_core::world::material::{Look, Material, Reflectivity, Rgb};
    use tabray_core::world::number::Number;
    use tabray_core::world::shader::{Anchor, Plain, Shader};
    use tabray_core::world::surface_point::{Point, ShaderInputs};
    use tabray_exact::scalar::{constants, per_axis, unit};

    static SOUND: Profile = Profile::new("sound", "a cone", "4 - y");
    static UNBOUNDED: Profile = Profile::new("unbounded", "a horn", "1 / y");
    static EMPTY: Profile = Profile::new("empty", "nothing", "-1");
    static STEEP: Profile = Profile::new("steep", "a column", "1").slope("1 / (y - 2)");

    struct Spokes(Anchor);

    impl Shader for Spokes {
        fn reflectivity<N: Number>(
            &self,
            of: Reflectivity,
            material: &Material,
            at: &Point<N>,
        ) -> Option<[N; 3]> {
            let from = per_axis(|axis| at.position[axis] - N::constant(self.0.origin[axis]));
            Some(match of {
                Reflectivity::Ambient => unit(from).map(|along| N::constant(1.0) + along),
                _ => constants(material.reflectivity(of)),
            })
        }
    }

    struct Uneven;

    impl Shader for Uneven {
        fn reflectivity<N: Number>(
            &self,
            of: Reflectivity,
            material: &Material,
            at: &Point<N>,
        ) -> Option<[N; 3]> {
            Some(match of {
                Reflectivity::Ambient => [at.position[0].abs(); 3],
                _ => constants(material.reflectivity(of)),
            })
        }

        fn uniform(&self, material: &Material) -> Option<Look> {
            Plain.uniform(material)
        }
    }

    impl Light for Uneven {
        fn location(&self) -> DVec3 {
            DVec3::ZERO
        }

        fn sent<N: Number>(&self, [_, y, _]: [N; 3]) -> [N; 3] {
            y.either(constants(Rgb::ZERO), constants(Rgb::ONE))
        }

        fn uniform(&self) -> Option<Rgb> {
            Some(Rgb::ONE)
        }
    }

    fn breach(paint: &ShaderFactory) -> Fault {
        looks::paint(paint, &mut Draw::new("a shader")).expect_err("a breach")
    }

    #[test]
    fn a_profile_that_is_not_finite_or_empty_is_found() {
        assert!(of_profile(&SOUND).is_none());
        for (profile, found) in [
            (&UNBOUNDED, "it is one that is unbounded near y = 0.0"),
            (&EMPTY, "it is one that is nowhere above 0"),
            (&STEEP, "its slope is inf at y = 2"),
        ] {
            let breach = of_profile(profile).expect("a breach");
            assert!(
                breach.promise == Promise::ProfileIsFinite && breach.found.starts_with(found),
                "{breach}"
            );
            assert!(breach.to_string().starts_with("src/tools/contract/mod.rs:"), "{breach}");
        }
    }

    #[test]
    fn a_procedural_shader_without_a_colour_at_its_own_origin_is_found() {
        let breach = breach(&ShaderFactory::new(Spokes));
        assert_eq!(breach.promise, Promise::ReflectivityIsSound);
        assert_eq!(breach.found, "`ambient` is [NaN, NaN, NaN] at [4, 3, -2.5]");
    }

    #[test]
    fn a_shader_that_says_it_is_even_and_is_not_is_found() {
        let breach = breach(&ShaderFactory::new(|_| Uneven));
        assert_eq!(breach.promise, Promise::PacketsAgree);
        assert!(breach.found.starts_with("`uniform` is ["), "{}", breach.found);
    }

    struct Leaning;

    impl Shader for Leaning {
        fn sees(&self) -> ShaderInputs {
            ShaderInputs::NORMAL
        }

        fn bends(&self) -> bool {
            true
        }

        fn bend<N: Number>(&self, _at: &Point<N>, [x, y, z]: [N; 3]) -> Option<[N; 3]> {
            Some([x + N::constant(1.0), y, z])
        }
    }

    #[test]
    fn a_shader_whose_normals_have_another_length_is_found() {
        let breach = breach(&ShaderFactory::new(|_| Leaning));
        assert_eq!(breach.promise, Promise::NormalIsUnit);
        assert!(breach.found.starts_with("`bend` is ["), "{}", breach.found);
    }

    #[test]
    fn a_light_that_says_it_is_even_and_is_not_is_found() {
        let fault = looks::light(&Uneven, &mut Draw::new("uneven")).expect_err("a fault");
        assert_eq!(fault.promise, Promise::PacketsAgree);
        assert_eq!(fault.found, "`uniform` is [1, 1, 1], and toward [0, 0, 0] it emits [0, 0, 0]");
    }
}
