//! Solids: where a ray crosses the surface of several shapes that are combined.

use super::closed::Hit;
use super::first::{hit, order};
use super::number::Number;
use super::ray::Ray;
use super::text::{Operation, Shape};
use super::wide::Wide;
use std::cmp::Ordering::{self, Greater};

/// Behind a hit, the next one is searched from this fraction of its place on, as a power of two.
const BEHIND: i64 = -240;

/// The largest number of crossings of one shape.
const MAX_PLACES: usize = 1000;

/// Returns the places ahead of a ray's origin where it crosses the surface of a closed shape; `None` if it touches
/// something exactly.
pub fn crossings(shape: &Shape, ray: &Ray) -> Option<Vec<Wide>> {
    let Shape::Combined { operation, shapes, .. } = shape else { return of_one(shape, ray) };
    let (mut inside, mut all) = (Vec::new(), Vec::new());
    for (index, shape) in shapes.iter().enumerate() {
        let places = crossings(shape, ray)?;
        // A ray ends outside of every closed shape.
        inside.push(places.len() % 2 == 1);
        all.extend(places.into_iter().map(|place| (place, index)));
    }
    all.sort_by(|one, other| order(&one.0, &other.0).unwrap_or(Ordering::Equal));
    let (mut places, mut was_in) = (Vec::new(), operation.holds(&inside));
    for at_once in all.chunk_by(|one, other| order(&one.0, &other.0).is_none()) {
        for (_, index) in at_once {
            inside[*index] = !inside[*index];
        }
        let is_in = operation.holds(&inside);
        if is_in != was_in {
            places.push(at_once[0].0.clone());
        }
        was_in = is_in;
    }
    Some(places)
}

fn of_one(shape: &Shape, ray: &Ray) -> Option<Vec<Wide>> {
    let (mut places, mut start, mut gone): (Vec<Wide>, _, _) = (Vec::new(), ray.clone(), Wide::int(0));
    while places.len() < MAX_PLACES {
        let place = match hit(shape, &start) {
            Hit::Miss => return Some(places),
            Hit::Touch => return None,
            Hit::At(place) => gone.add(&place),
        };
        let high = place.ends()?.1.clone();
        let behind = high.add(&high.shifted(BEHIND));
        start = ray.from(&behind);
        gone = Wide::exact(&behind);
        places.push(place);
    }
    None
}

/// Returns the first hit of a ray.
pub fn first(shape: &Shape, ray: &Ray) -> Hit {
    match crossings(shape, ray) {
        None => Hit::Touch,
        Some(places) => match places.into_iter().next() {
            None => Hit::Miss,
            Some(place) if place.sign() == Some(Greater) => Hit::At(place),
            Some(_) => Hit::Touch,
        },
    }
}

/// Returns the shape that is no combination and that a ray crosses at a place, with the ray from a point shortly before on,
/// and the place on that.
pub fn crossed<'s>(shape: &'s Shape, ray: &Ray, at: &Wide) -> Option<(&'s Shape, Ray, Wide)> {
    if let Shape::Combined { shapes, .. } = shape {
        return shapes.iter().find_map(|shape| crossed(shape, ray, at));
    }
    let places = of_one(shape, ray)?;
    let index = places.iter().position(|place| order(place, at).is_none())?;
    let Some((_, before)) = index.checked_sub(1).and_then(|index| places[index].ends()) else {
        return Some((shape, ray.clone(), at.clone()));
    };
    let behind = before.add(&before.shifted(BEHIND));
    Some((shape, ray.from(&behind), at.sub(&Wide::exact(&behind))))
}

impl Operation {
    fn holds(self, inside: &[bool]) -> bool {
        match self {
            Self::Union => inside.contains(&true),
            Self::Intersection => !inside.contains(&false),
            Self::Difference => inside[0] && !inside[1..].contains(&true),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::text::Scene;

    #[test]
    fn places_are_narrow_where_the_slope_jumps_nearby() {
        let text = "camera eye { pixeldim 2 2 worlddim 4.652271034996277 2.434330299089727
                viewpoint 2.3238390721488225 2.280479374619721 23.21576870322686 }
            sphere ball { center 4.5 3 -4 radius 1.5 } cylinder post { base 5 1.5 -3.5 height 1 radius 1.5 }
            difference cut { objects ball post }";
        let scene = Scene::read(text, "");
        let ray = Ray::of_pixel(&scene, 1, 1);
        let Hit::At(place) = first(&scene.objects[0], &ray) else { panic!("it is hit") };
        assert!((ray.distance(&place).near() - 28.350_084_7).abs() < 1e-4);
    }
}
