//! Bounding boxes: no box cuts off what it is to contain, whatever rounding did to its numbers.

use crate::common::model;
use glam::DVec3;
use std::slice;
use tabray::exact::Scalar;
use tabray::geometry::{Aabb, Frame, Ray, RayRange};
use tabray::query::{Query, QueryRay, Verdict};
use tabray::shapes::{Implicit, Made};
use tabray::world::certify::{Enclosure, Precision};
use tabray::world::{AnyShape, Body, Facts, Hittable, Sides};

/// The extremes of a torus lie in the sides of its box, whose numbers are sums that are rounded.
#[test]
fn rays_straight_on_meet_the_extremes_of_tori_their_copies_and_unions() {
    let mut wrong = Vec::new();
    for (index, tube) in [0.075, 0.1, 0.21, 0.3].into_iter().enumerate() {
        for step in 0..5 {
            let radius = 0.87 + 0.05 * f64::from(step) + 0.01 * index as f64;
            let ring = format!("torus ring {{ material m center 0 0 0 radius {radius} tube {tube} }}");
            let inner = 0.5 * tube;
            for (more, scale) in [
                (String::new(), 1.0),
                ("place copy { object ring scale 3 3 3 }".to_owned(), 3.0),
                (
                    format!(
                        "sphere bead {{ material m center {radius} 0 0 radius {inner} }}
                         union whole {{ objects ring bead }}"
                    ),
                    1.0,
                ),
            ] {
                let text = format!(
                    "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 angle 40 }} material m {{ }}\n{ring}\n{more}"
                );
                let model = model(&text);
                let query = Query::new(&model);
                for axis in [DVec3::X, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Z] {
                    let ray = QueryRay::new(8.0 * axis, -axis).expect("a ray");
                    let first = 8.0 - scale * (radius + tube);
                    let answers =
                        [query.traced(slice::from_ref(&ray)), query.proven(slice::from_ref(&ray), false)];
                    for answer in answers.iter().flatten() {
                        if answer.verdict != Verdict::Hit || (answer.t - first).abs() > 1e-12 {
                            wrong.push(format!("{answer:?}, not at {first}:\n{text}"));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong, such as {}", wrong.len(), wrong[0]);
}

/// A ball whose box its author computes in the world's coordinates.
struct Far {
    center: DVec3,
    radius: f64,
}

impl Hittable for Far {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let off = ray.origin - self.center;
        let along = -off.dot(ray.dir);
        let square = self.radius * self.radius - (off + along * ray.dir).length_squared();
        let half = square.sqrt();
        let near = range.keep(along - half);
        if range.origin_side.is_some() {
            range.keep(along + half)
        } else {
            near.min(range.keep(along + half))
        }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (at - self.center).normalize()
    }

    fn facts(&self) -> Facts {
        let bounds = Aabb { low: self.center - self.radius, high: self.center + self.radius };
        Facts { can_hit_itself: Sides::INSIDE, ..Facts::within(bounds) }
    }
}

#[test]
fn a_box_is_widened_by_the_rounding_of_the_shapes_place() {
    for far in [0.0, 3.3, 1e6 / 3.0, -1e9 / 7.0] {
        let (center, radius) = (DVec3::new(far, 0.1, -far), 0.7);
        let shape = AnyShape::from(Far { center, radius });
        let Aabb { low, high } = shape.bounds().expect("a box");
        let Some(given) = shape.facts().bounds else { panic!("a box") };
        let rounding = 8.0 * f64::EPSILON * (far.abs() + 1.0);
        assert!((given.low - low).min_element() > rounding && (high - given.high).min_element() > rounding);
        assert!(!shape.is_clear_of(&Aabb { low: given.high + rounding, high: given.high + 1.0 }));
    }
}

/// A plane through a box, which ends exactly at its sides or is only to be contained in it.
struct Floor(bool);

impl Implicit for Floor {
    fn value<N: Scalar>(&self, [_, y, _]: [N; 3]) -> N {
        y
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::NEG_ONE, DVec3::ONE]
    }

    fn is_box_exact(&self) -> bool {
        self.0
    }
}

/// What a scene's own box cuts off is not seen: such a box is meant as it is written.
#[test]
fn an_exact_box_cuts_where_it_is_written() {
    let beyond = 1.0_f64.next_up();
    for is_exact in [true, false] {
        let body = Body::implicit(Floor(is_exact), Frame::at(DVec3::ZERO));
        let is_hit = |x: f64| {
            let ray = QueryRay::new(DVec3::new(x, 4.0, 0.0), DVec3::NEG_Y).expect("a ray");
            let sight = ray.sight();
            match body.shape.certify(sight, Precision::Octuple) {
                Enclosure::Hits(_) => Some(true),
                Enclosure::Misses => Some(false),
                _ => None,
            }
        };
        assert_eq!(is_hit(1.0_f64.next_down()), Some(true));
        assert_eq!(is_hit(beyond), Some(!is_exact));
        assert_eq!(is_hit(1.0 + 1e-9), Some(false));
    }
}
