//! The contract of each trait: every plugin keeps it, and each way to break it is found.

use crate::common::{block_with, load, registry, root};
use glam::DVec2;
use glam::DVec3;
use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use tabray::exact::scalar::{Scalar, constants, unit};
use tabray::geometry::{Aabb, Bracket, Frame, ImagePoint, MISS, Ray, RayBall, RayRange, Side};
use tabray::scene::{Args, Derived, Entity, Kind, Pparm, Refusal, Registry, Row, Table};
use tabray::shapes::{Implicit, Made};
use tabray::tools::contract::{self, Breach, Promise};
use tabray::world::certify::Equation;
use tabray::world::material::Reflectivity;
use tabray::world::number::Number;
use tabray::world::{
    AnyInterface, Background, Body, Bracketed, Camera, Certified, Crossing, Facts, Hittable, Interface,
    Light, Material, Origins, Point, Projected, Rgb, Shader, Shape, Sides,
};

#[test]
fn every_plugin_keeps_its_contract() {
    contract::assert_kept();
}

#[test]
fn what_is_in_the_entities_own_scenes_keeps_its_contract() {
    for entry in fs::read_dir(root().join("scenes/entities")).expect("a folder of scenes") {
        let breach = contract::breaches_in(&load(&entry.expect("an entry").path())).into_iter().next();
        assert!(breach.is_none(), "{}", breach.expect("one"));
    }
}

/// The shape of the template that `tabray new plugin` writes: its sides are flat to the fourth order at their centres.
struct RoundCube(f64);

impl Implicit for RoundCube {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let [x, y, z] = at.map(|coordinate| coordinate / N::constant(self.0));
        x.powi(4) + y.powi(4) + z.powi(4) - N::constant(1.0)
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::splat(-self.0), DVec3::splat(self.0)]
    }
}

const fn round_cube(name: &'static str) -> Entity {
    Entity::shape(name, "a cube with round edges", &[TABLE], |args| {
        Ok(Body::implicit(RoundCube(args.get(&RADIUS)), Frame::at(args.get(&CENTER))))
    })
}

static ROUND_CUBES: [Entity; 13] = [
    round_cube("gem"),
    round_cube("cube"),
    round_cube("stone"),
    round_cube("dice"),
    round_cube("pebble"),
    round_cube("soap"),
    round_cube("ring_box"),
    round_cube("loop"),
    round_cube("cut_gem"),
    round_cube("bead"),
    round_cube("a"),
    round_cube("zz"),
    round_cube("template"),
];

/// The rays that are tried depend on the name.
#[test]
fn a_shape_that_is_flat_to_the_fourth_order_keeps_its_contract_under_any_name() {
    for entity in &ROUND_CUBES {
        assert_eq!(breach(entity).map(|breach| breach.to_string()), None);
    }
}

static CENTER: Pparm<DVec3> = Pparm::required("center", "the point in its middle");
static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance to its surface").positive();
const TABLE: Table = &[&CENTER as &dyn Row, &RADIUS];

/// A flaw of a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flaw {
    None,
    Nan,
    NoSpan,
    Restless,
    Bracket,
    Quick,
    LongNormal,
    NoNormal,
    NoInside,
    FromOneSide,
    Proof,
    Bounds,
    LowBounds,
    Clear,
    Untouched,
    Leaning,
    Flipping,
    Inward,
    Smooth,
    Shell,
    MeetsItsStart,
    MeetsNothingAgain,
    Invisible,
    NanColour,
    NegativeColour,
}

struct Ball {
    center: DVec3,
    radius: f64,
    flaw: Flaw,
}

impl Ball {
    /// Returns the distances at which a ray meets a sphere of this radius around the center.
    fn roots(&self, ray: &Ray, radius: f64) -> [f64; 2] {
        let from = ray.origin - self.center;
        let middle = -from.dot(ray.dir);
        let closest = from + middle * ray.dir;
        let half = (radius * radius - closest.length_squared()).sqrt();
        [middle - half, middle + half]
    }

    /// Tells whether a point is on the sphere or on its shell, within an error.
    fn is_near(&self, at: DVec3, error: f64) -> bool {
        let off = at.distance(self.center) - self.radius;
        off.abs().min((off - self.radius).abs()) <= error + 1e-12
    }

    fn hit(&self, ray: &Ray, range: &RayRange) -> f64 {
        let mut roots = self.roots(ray, self.radius).to_vec();
        if range.origin_side == Some(Side::Inside) {
            // The ray starts at the near root.
            roots.remove(0);
        }
        if matches!(self.flaw, Flaw::Shell | Flaw::MeetsNothingAgain) {
            roots.extend(self.roots(ray, 2.0 * self.radius));
        }
        roots.into_iter().map(|root| range.keep(root)).fold(MISS, f64::min)
    }
}

impl Hittable for Ball {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        static CALLS: AtomicU32 = AtomicU32::new(0);
        let [near, _] = self.roots(ray, self.radius);
        match self.flaw {
            Flaw::Nan if near.is_nan() => near,
            Flaw::NoSpan if near > 0.0 => near,
            Flaw::NoInside => range.keep(near),
            Flaw::Restless => self.hit(ray, range) + f64::from(CALLS.fetch_add(1, Ordering::Relaxed)),
            Flaw::FromOneSide if ray.dir.x > 0.0 => MISS,
            Flaw::MeetsItsStart if range.origin_side.is_some() => range.keep(1e-9),
            Flaw::MeetsNothingAgain if range.origin_side.is_some() => MISS,
            Flaw::Invisible => MISS,
            _ => self.hit(ray, range),
        }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let out = at - self.center;
        match self.flaw {
            Flaw::LongNormal => 2.0 * out.normalize(),
            Flaw::NoNormal => DVec3::NAN,
            Flaw::Leaning => (out * DVec3::new(1.0, 3.0, 1.0)).normalize(),
            Flaw::Flipping if at.x.to_bits().count_ones().is_multiple_of(2) => -out.normalize(),
            Flaw::Inward => -out.normalize(),
            _ => out.normalize(),
        }
    }

    // Without `is_smooth`, packets do not ask for it.
    fn shading_normal(&self, _at: DVec3, normal: DVec3) -> DVec3 {
        if self.flaw == Flaw::Smooth { (normal + DVec3::Y).normalize() } else { normal }
    }

    fn facts(&self) -> Facts {
        let half_size = match self.flaw {
            Flaw::Bounds => 0.9 * self.radius,
            Flaw::LowBounds => self.radius,
            _ => 2.0 * self.radius,
        };
        let lowered = if self.flaw == Flaw::LowBounds { 0.001 * self.radius * DVec3::Y } else { DVec3::ZERO };
        let is_hit_again = matches!(self.flaw, Flaw::MeetsItsStart | Flaw::MeetsNothingAgain);
        Facts {
            can_hit_itself: if is_hit_again { Sides::BOTH } else { Sides::INSIDE },
            ..Facts::within(Aabb { low: self.center - half_size, high: self.center + half_size - lowered })
        }
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.flaw == Flaw::Clear || !self.facts().bounds.is_some_and(|bounds| bounds.overlaps(region))
    }
}

impl Bracketed for Ball {
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if range.origin_side.is_none()
            && range.origin_error > 0.0
            && self.is_near(ray.origin, range.origin_error)
        {
            return Bracket::UNKNOWN;
        }
        let distance = self.distance(ray, range);
        Bracket::exactly(if self.flaw == Flaw::Bracket { distance + 1.0 } else { distance })
    }

    fn refine(&self, ray: &Ray, leaves: Option<Side>) -> f64 {
        let distance = self.distance(ray, &RayRange { origin_side: leaves, ..RayRange::ALL });
        if self.flaw == Flaw::Quick { distance.next_up() } else { distance }
    }
}

impl Certified for Ball {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.flaw != Flaw::Untouched && self.is_near(at, error)
    }
}

impl Equation for Ball {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| (at[axis] - N::constant(self.center[axis])).powi(2);
        part(0) + part(1) + part(2) - N::constant(self.radius).powi(2)
    }

    fn inside_trim<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(if self.flaw == Flaw::Proof { -1.0 } else { 1.0 })
    }
}

/// A ball whose box is a little low.
struct Shaved(f64);

impl Implicit for Shaved {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        x.powi(2) + y.powi(2) + z.powi(2) - N::constant(self.0).powi(2)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::splat(-self.0), DVec3::new(self.0, 0.999 * self.0, self.0)]
    }
}

struct Colour(Flaw);

impl Shader for Colour {
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        _at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own = material.reflectivity(of);
        Some(constants(match (of, self.0) {
            (Reflectivity::Diffuse, Flaw::NanColour) => Rgb::NAN,
            (Reflectivity::Diffuse, Flaw::NegativeColour) => -own,
            _ => own,
        }))
    }
}

fn ball(args: &Args, flaw: Flaw) -> Result<Body, Refusal> {
    let ball = Shape::new(Ball { center: args.get(&CENTER), radius: args.get(&RADIUS), flaw }).bracketed();
    // With the other flaws, the shape differs from its equation.
    Ok(match flaw {
        Flaw::Proof | Flaw::Untouched => Body::shaded(ball.certified(), Colour(flaw)),
        _ => Body::shaded(ball, Colour(flaw)),
    })
}

fn refuse<T>(_args: &Args) -> Result<T, Refusal> {
    Err(Refusal { attribute: None, message: "will not be".to_owned(), help: "nothing helps" })
}

/// A light whose colour is not finite at its own position.
struct Lamp;

impl Light for Lamp {
    fn location(&self) -> DVec3 {
        DVec3::ONE
    }

    fn sent<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        unit(toward.map(|along| along - N::constant(1.0))).map(|along| N::constant(1.0) + along)
    }
}

static COUNTED: Derived = Derived(|_| {
    static LINES: AtomicU32 = AtomicU32::new(0);
    format!("line {}\n", LINES.fetch_add(1, Ordering::Relaxed))
});
const COUNTS: Table = &[&COUNTED as &dyn Row];

#[track_caller]
const fn shape(name: &'static str, construct: fn(&Args) -> Result<Body, Refusal>) -> Entity {
    Entity::shape(name, "a ball", &[TABLE], construct)
}

static SOUND: Entity = shape("sound", |args| ball(args, Flaw::None));

static BROKEN: [(Promise, Entity); 34] = [
    (Promise::DistanceIsInItsSpan, shape("nan", |args| ball(args, Flaw::Nan))),
    (Promise::DistanceIsInItsSpan, shape("no_span", |args| ball(args, Flaw::NoSpan))),
    (Promise::DistanceIsTheSameAgain, shape("restless", |args| ball(args, Flaw::Restless))),
    (Promise::PacketsAgree, shape("bracket", |args| ball(args, Flaw::Bracket))),
    (Promise::PacketsAgree, shape("quick", |args| ball(args, Flaw::Quick))),
    (Promise::NormalIsUnit, shape("long_normal", |args| ball(args, Flaw::LongNormal))),
    (Promise::NormalIsUnit, shape("no_normal", |args| ball(args, Flaw::NoNormal))),
    (Promise::HitIsOnTheSurface, shape("no_inside", |args| ball(args, Flaw::NoInside))),
    (Promise::HitIsOnTheSurface, shape("from_one_side", |args| ball(args, Flaw::FromOneSide))),
    (Promise::AgreesWithItsProof, shape("proof", |args| ball(args, Flaw::Proof))),
    (Promise::BoundsHoldHits, shape("bounds", |args| ball(args, Flaw::Bounds))),
    (Promise::BoundsHoldHits, shape("low_bounds", |args| ball(args, Flaw::LowBounds))),
    (
        Promise::BoundsHoldHits,
        Entity::shape("shaved", "a ball that its box cuts", &[TABLE], |args| {
            Ok(Body::implicit(Shaved(args.get(&RADIUS)), Frame::at(args.get(&CENTER))))
        }),
    ),
    (Promise::BoundsHoldHits, shape("clear", |args| ball(args, Flaw::Clear))),
    (Promise::HitIsTouched, shape("untouched", |args| ball(args, Flaw::Untouched))),
    (Promise::NormalIsUpright, shape("leaning", |args| ball(args, Flaw::Leaning))),
    (Promise::NormalsAgree, shape("flipping", |args| ball(args, Flaw::Flipping))),
    (Promise::NormalsPointOut, shape("inward", |args| ball(args, Flaw::Inward))),
    (Promise::PacketsAgree, shape("smooth", |args| ball(args, Flaw::Smooth))),
    (Promise::IsNotMetAgain, shape("shell", |args| ball(args, Flaw::Shell))),
    (Promise::StartIsNoHit, shape("meets_its_start", |args| ball(args, Flaw::MeetsItsStart))),
    (Promise::StartIsNoHit, shape("meets_nothing_again", |args| ball(args, Flaw::MeetsNothingAgain))),
    (Promise::IsMet, shape("invisible", |args| ball(args, Flaw::Invisible))),
    (Promise::ReflectivityIsSound, shape("nan_colour", |args| ball(args, Flaw::NanColour))),
    (Promise::ReflectivityIsSound, shape("negative_colour", |args| ball(args, Flaw::NegativeColour))),
    (Promise::TakesWhatItsTableAllows, shape("refuses", refuse)),
    (Promise::DumpLoadsAgain, Entity::light("counts", "a lamp", &[COUNTS], |_| Ok(Box::new(Lamp)))),
    (Promise::LightIsFinite, Entity::light("lamp", "a lamp", &[], |_| Ok(Box::new(Lamp)))),
    (Promise::CameraLooks, Entity::camera("blind", "a camera", &[], |_| Ok(Arc::new(Eye(EyeFlaw::Blind))))),
    (Promise::CameraKnows, Entity::camera("astray", "a camera", &[], |_| Ok(Arc::new(Eye(EyeFlaw::Astray))))),
    (
        Promise::CameraKnows,
        Entity::camera("crossed", "a camera", &[], |_| Ok(Arc::new(Eye(EyeFlaw::Crossed)))),
    ),
    (
        Promise::LightGoesOn,
        Entity::material("amplifier", "a material", &[], |_| {
            let interface = Some(AnyInterface::new(Amplifier));
            Ok(Material { transparency: 1.0, interface, ..Material::default() })
        }),
    ),
    (Promise::BackgroundIsSound, Entity::background("glare", "a background", &[], |_| Ok(Box::new(Glare)))),
    (
        Promise::ReflectivityIsSound,
        Entity::material("wax", "a material", &[], |_| {
            Ok(Material { shininess: f64::NAN, ..Material::default() })
        }),
    ),
];

/// A camera with a flaw, which looks along -z.
#[derive(Debug)]
struct Eye(EyeFlaw);

#[derive(Debug, PartialEq)]
enum EyeFlaw {
    /// Its rays have no direction.
    Blind,
    /// Its rays do not start where it says.
    Astray,
    /// It shows things elsewhere than it says.
    Crossed,
}

impl Camera for Eye {
    fn ray(&self, at: &ImagePoint, _lens: DVec2) -> Ray {
        let [x, y] = at.from_middle();
        let dir = if self.0 == EyeFlaw::Blind { DVec3::NAN } else { DVec3::new(x, y, -1.0).normalize() };
        Ray { origin: DVec3::ZERO, dir }
    }

    fn origins(&self, _pixels: [usize; 2]) -> Origins {
        Origins::at(if self.0 == EyeFlaw::Astray { DVec3::X } else { DVec3::ZERO })
    }

    fn project(&self, point: DVec3, _pixels: [usize; 2]) -> Projected {
        if self.0 == EyeFlaw::Crossed { Projected::At(-9.0 * point.truncate()) } else { Projected::Unknown }
    }
}

/// Reflects more than it receives.
#[derive(PartialEq)]
struct Amplifier;

impl Interface for Amplifier {
    fn cross(&self, dir: DVec3, _normal: DVec3, _side: Side) -> Crossing {
        Crossing { reflected: DVec3::splat(1.5), onward: Some(dir) }
    }
}

/// Is brighter straight up than it says.
struct Glare;

impl Background for Glare {
    fn colour<N: Number>(&self, [_, y, _]: [N; 3]) -> [N; 3] {
        [N::constant(1.0) + y; 3]
    }

    fn brightest(&self) -> Rgb {
        Rgb::splat(1.9)
    }
}

/// Returns the gravest breach of an entity type, in a registry with the program's own types of other kinds.
fn breach(entity: &'static Entity) -> Option<Breach> {
    let others =
        registry().iter().filter(|other| other.kind() != entity.kind() && other.kind() < Kind::Object);
    let registry = Registry::of(others.chain([entity])).expect("no name is taken");
    contract::breach_of(&registry, entity)
}

#[test]
fn a_sound_shape_is_found_sound() {
    assert_eq!(breach(&SOUND).map(|breach| breach.to_string()), None);
}

#[test]
fn every_broken_promise_is_found_for_what_it_is() {
    for (promise, entity) in &BROKEN {
        let Some(breach) = breach(entity) else { panic!("{entity:?} breaks nothing") };
        assert_eq!(breach.promise, *promise, "{breach}");
        let told = breach.to_string();
        assert!(
            told.starts_with(&format!("{}: the {} `{}`", entity.place(), entity.kind(), entity.name)),
            "{told}"
        );
        assert!(told.contains(promise.help()) && told.contains(&format!("\n    {} ", entity.name)), "{told}");
    }
}

#[test]
fn the_docs_tell_each_promise_and_its_cure() {
    let table = fs::read_to_string(root().join("docs/data/promises.csv")).expect("the table");
    let cell = |text: &str| match text.contains([',', '"']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    };
    for promise in Promise::ALL {
        let row = format!("\n{},{}\n", cell(&promise.to_string()), cell(promise.help()));
        assert!(table.contains(&row), "docs/data/promises.csv lacks {row}");
    }
}

#[test]
fn a_breach_is_told_as_the_docs_show_it() {
    let (_, broken) = &BROKEN[5];
    let told =
        breach(broken).expect("a breach").to_string().replace(&broken.place(), "plugins/long_normal.rs:20");
    let page = fs::read_to_string(root().join("docs/plugins.md")).expect("the page");
    assert_eq!(block_with(&page, "breaks its contract"), told);
}
