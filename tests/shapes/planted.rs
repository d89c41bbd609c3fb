//! Faults that are planted into one ball each, beside all plugins: each is named with its own promise, and no innocent is
//! named with it. The types come first by name and are as simple as any, so that solids and copies would be made of them.

use crate::common::registry;
use glam::{DVec2, DVec3};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use tabray::exact::Scalar;
use tabray::geometry::{Aabb, MISS, Ray, RayRange};
use tabray::render::Plan;
use tabray::scene::{self, Entity, Pparm, Registry, Row, Table};
use tabray::tools::contract::{self, Promise};
use tabray::tools::unchecked::{self, Unchecked};
use tabray::world::certify::Equation;
use tabray::world::{Body, Certified, Facts, Hittable, Shape, Sides};

static CENTER: Pparm<DVec3> = Pparm::required("center", "the point in its middle");
static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance to its surface").positive();
const TABLE: Table = &[&CENTER as &dyn Row, &RADIUS];

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Cancellation,
    Epsilon,
    LowBox,
    Inward,
    WideUv,
    Random,
    NanAtPole,
    BeforeRange,
    Seam,
    Shading,
    Memory,
    Slow,
    Open,
    Fickle,
    Off,
    None,
}

struct Ball {
    center: DVec3,
    radius: f64,
    fault: Fault,
    /// What is kept between calls.
    calls: AtomicU64,
}

impl Ball {
    /// Returns the distances at which a ray meets the ball.
    fn roots(&self, Ray { origin, dir }: &Ray) -> [f64; 2] {
        let from = origin - self.center;
        let middle = -from.dot(*dir);
        let half = if self.fault == Fault::Cancellation {
            // Three large numbers whose digits cancel.
            let square =
                origin.length_squared() - 2.0 * origin.dot(self.center) + self.center.length_squared();
            (middle * middle - (square - self.radius * self.radius)).sqrt()
        } else {
            let off = (from + middle * dir).length();
            ((self.radius - off) * (self.radius + off)).sqrt()
        };
        [middle - half, middle + half]
    }

    fn is_at_seam(&self, at: DVec3) -> bool {
        let off = at - self.center;
        off.x < 0.0 && off.z == 0.0
    }

    fn is_open_at(&self, at: DVec3) -> bool {
        self.fault == Fault::Open && at.y < self.center.y
    }
}

impl Hittable for Ball {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let mut roots = self.roots(ray).to_vec();
        if self.fault == Fault::BeforeRange && roots[0].is_finite() && roots[0] < 0.0 {
            return roots[0];
        }
        if range.origin_side.is_some() && self.fault != Fault::Epsilon {
            // The ray starts at the root that is nearer to 0.
            let start = usize::from(roots[0].abs() > roots[1].abs());
            roots.remove(start);
        }
        let first = roots
            .into_iter()
            .filter(|root| self.fault != Fault::Seam || !self.is_at_seam(ray.at(*root)))
            .filter(|root| self.fault != Fault::Epsilon || *root > 1e-3)
            .filter(|root| !self.is_open_at(ray.at(*root)))
            .map(|root| if self.fault == Fault::Off { root + 3e-4 } else { root })
            .map(|root| range.keep(root))
            .fold(MISS, f64::min);
        match self.fault {
            Fault::Random => {
                // An address that varies, or a clock.
                first + 1e-9 * (self.calls.fetch_add(1, Ordering::Relaxed) % 3) as f64
            }
            Fault::Memory => {
                // The last ray's answer serves the next one, if that begins where the last one ended.
                let last = self.calls.swap(ray.dir.x.to_bits(), Ordering::Relaxed);
                if last != 0 && last != ray.dir.x.to_bits() && first < MISS { first + 1e-6 } else { first }
            }
            // Rays along one line have the same answer, and those beside it do not.
            Fault::Fickle if ray.dir.x.to_bits().is_multiple_of(16) => MISS,
            // As a search without a bound, which most rays end soon.
            Fault::Slow if ray.dir.x > 0.9 => {
                let lost: f64 = (0..3_000_000).map(|number| libm::sin(f64::from(number % (1 << 20)))).sum();
                if lost.is_nan() { MISS } else { first }
            }
            _ => first,
        }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let out = (at - self.center).normalize();
        match self.fault {
            Fault::Inward => -out,
            Fault::NanAtPole => {
                let flat = DVec2::new(out.x, out.z);
                let ring = flat / flat.length();
                DVec3::new(ring.x * flat.length(), out.y, ring.y * flat.length())
            }
            _ => out,
        }
    }

    fn shading_normal(&self, _at: DVec3, normal: DVec3) -> DVec3 {
        if self.fault == Fault::Shading { -normal } else { normal }
    }

    fn why_not_closed(&self) -> Option<&str> {
        (self.fault == Fault::Open).then_some("it is open below")
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        let out = (at - self.center) / self.radius;
        (self.fault == Fault::WideUv).then(|| DVec2::new(libm::atan2(out.z, out.x), 0.5 + 0.5 * out.y))
    }

    fn facts(&self) -> Facts {
        let low = self.center - self.radius;
        let cut = if self.fault == Fault::LowBox { 0.001 * self.radius } else { 0.0 };
        let high = self.center + self.radius - cut * DVec3::Y;
        let is_open = self.fault == Fault::Open;
        Facts {
            can_hit_itself: if is_open { Sides::BOTH } else { Sides::INSIDE },
            is_two_sided: is_open || self.fault == Fault::Shading,
            is_smooth: self.fault == Fault::Shading,
            ..Facts::within(Aabb { low, high })
        }
    }
}

impl Equation for Ball {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let [a, b, c] = self.center.to_array().map(N::constant);
        (x - a).powi(2) + (y - b).powi(2) + (z - c).powi(2) - N::constant(self.radius).powi(2)
    }
}

impl Certified for Ball {}

macro_rules! ball {
    ($name:literal, $fault:expr $(, $with:ident)?) => {
        Entity::shape($name, "a ball", &[TABLE], |args| {
            let (center, radius) = (args.get(&CENTER), args.get(&RADIUS));
            let calls = AtomicU64::new(0);
            Ok(Body::plain(Shape::new(Ball { center, radius, fault: $fault, calls })$(.$with())?))
        })
    };
}

static PLANTED: [(Promise, &str, Entity); 13] = [
    (Promise::HitIsAccurate, " from [", ball!("a_cancellation", Fault::Cancellation)),
    (Promise::HitIsOnTheSurface, "it is hit at ", ball!("a_epsilon", Fault::Epsilon)),
    (Promise::BoundsHoldHits, "it is hit at ", ball!("a_low_box", Fault::LowBox)),
    (Promise::NormalsPointOut, "sides", ball!("a_inward", Fault::Inward)),
    (Promise::UvIsWithin, "they are [", ball!("a_wide_uv", Fault::WideUv)),
    (Promise::DistanceIsTheSameAgain, "first ", ball!("a_random", Fault::Random)),
    (Promise::NormalIsUnit, "NaN", ball!("a_nan_at_pole", Fault::NanAtPole)),
    (Promise::DistanceIsInItsSpan, "`distance` gives -", ball!("a_before_range", Fault::BeforeRange)),
    (Promise::HitIsOnTheSurface, "for rays on all sides of it", ball!("a_seam", Fault::Seam)),
    (Promise::NormalsAgree, "the shading normal is ", ball!("a_shading", Fault::Shading)),
    (Promise::DistanceIsTheSameAgain, "first ", ball!("a_memory", Fault::Memory)),
    (Promise::RayIsQuick, " sines, ", ball!("a_slow", Fault::Slow)),
    (Promise::AgreesWithItsProof, "e-4 off the surface; ", OFF),
];

static OPEN: Entity = ball!("a_dome", Fault::Open);
const OFF: Entity = ball!("a_off", Fault::Off, certified);

#[test]
fn each_planted_fault_is_named_for_what_it_is_and_no_innocent_with_it() {
    let planted = PLANTED.iter().map(|(.., entity)| entity);
    let all = Registry::of(registry().iter().chain(planted).chain([&OPEN])).expect("no name is taken");
    let mut wrong = Vec::new();
    let mut found = contract::breaches(&all);
    for (promise, text, entity) in &PLANTED {
        let plugin = format!("the object `{}`", entity.name);
        match found.iter().position(|breach| breach.plugin == plugin) {
            None => wrong.push(format!("{plugin} breaks nothing")),
            Some(index) => {
                let breach = found.remove(index);
                if breach.promise != *promise || !breach.found.contains(text) {
                    wrong.push(breach.to_string());
                }
            }
        }
    }
    wrong.extend(found.iter().map(|innocent| format!("innocent: {innocent}")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The faults that show in an image seen from afar, and the hits that differ; `None` where none is told.
static SEEN: [(Entity, Option<bool>); 6] = [
    (ball!("a_cancellation", Fault::Cancellation), Some(true)),
    (ball!("a_fickle", Fault::Fickle), Some(true)),
    (ball!("a_dome", Fault::Open), Some(false)),
    (ball!("a_ball", Fault::None), Some(false)),
    (ball!("a_sound", Fault::None, certified), None),
    (OFF, Some(true)),
];

#[test]
fn hits_that_contradict_others_or_their_equation_are_told() {
    for (entity, differ) in &SEEN {
        let all = Registry::of(registry().iter().chain([entity])).expect("no name is taken");
        let name = entity.name;
        let text = format!(
            "camera eye {{ pixeldim 80 60 worlddim 4 3 viewpoint 0 0 1e6 }}\nmaterial red {{ ambient 1 0 0 diffuse 1 0 0 }}\n\
             {name} ball {{ material red center 0 0.25 -3 radius 1 }}\nlight lamp {{ location 3 4 5 emissivity 1 1 1 }}\n"
        );
        let read = scene::reader::read(&all, "scene", Path::new(""), text.as_bytes(), None);
        let model = read.unwrap_or_else(|report| panic!("{report}")).model;
        let told = unchecked::of(&Plan::new(&model));
        let said: Vec<_> = told.iter().map(Unchecked::to_string).collect();
        assert_eq!(told.first().map(|one| one.differ > 0), *differ, "{name}: {said:?}");
        assert!(told.iter().all(|one| one.of == name && one.hits > 100), "{said:?}");
    }
}
