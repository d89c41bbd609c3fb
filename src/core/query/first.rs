//! Which of a scene's objects a ray hits first, as far as intervals tell.

use tabray_exact::interval::{Float, Fraction, Wide};
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{Enclosure, Precision};
use tabray_world::geometry::sight::Sight;

/// The certain first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// The object, by its index.
    pub object: usize,
    /// The part of the object that is hit, of which [`AnyShape::surface_hit`] tells more.
    pub part: usize,
    /// Bounds of the distance.
    pub at: Wide,
}

/// What is proven about a ray's first hit of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The object, by its index.
    pub object: usize,
    /// The part of the object that is hit first, if one is.
    pub part: usize,
    /// The proof.
    pub enclosure: Enclosure,
}

/// The objects that a ray may hit first.
#[derive(Clone, Debug, PartialEq)]
pub enum FirstHits {
    /// Certainly this object, or certainly nothing.
    Certain(Option<FirstHit>),
    /// One of several objects, or perhaps nothing.
    OneOf {
        /// The objects, in the order of their indices.
        any: Vec<Candidate>,
        /// A distance up to which something is certainly hit; infinite where perhaps nothing is.
        end: Fraction,
    },
}

impl FirstHits {
    /// Tells whether an object may be hit first, or, for `None`, whether nothing may be hit.
    pub fn may_be(&self, found: Option<usize>) -> bool {
        match (self, found) {
            (Self::Certain(first), _) => first.map(|first| first.object) == found,
            (Self::OneOf { any, .. }, Some(found)) => any.iter().any(|one| one.object == found),
            (Self::OneOf { end, .. }, None) => !end.is_finite(),
        }
    }
}

/// Proves which of some objects, given by their indices and shapes, a ray hits first. Also returns the precision of
/// the proof: 237 bits are tried where 53 leave it open. Distances are multiples of the length of the sight's
/// direction.
pub fn first_of<'s>(
    objects: impl IntoIterator<Item = (usize, &'s AnyShape)>,
    sight: &Sight,
) -> (FirstHits, Precision) {
    let shapes: Vec<_> = objects.into_iter().collect();
    let certify = |place: usize, precision| shapes[place].1.certify_part(sight, precision);
    first_among(&shapes.iter().map(|(object, _)| *object).collect::<Vec<_>>(), &certify)
}

/// Proves which of some objects a ray hits first, as [`first_of`] does. `certify` proves what the ray hits of the object
/// at a place of the list.
pub(super) fn first_among(
    objects: &[usize],
    certify: &dyn Fn(usize, Precision) -> (Enclosure, usize),
) -> (FirstHits, Precision) {
    let proven = |place: usize, precision| {
        let (enclosure, part) = certify(place, precision);
        Candidate { object: objects[place], part, enclosure }
    };
    match first(&(0..objects.len()).map(|place| proven(place, Precision::Double)).collect::<Vec<_>>()) {
        FirstHits::OneOf { any, .. } => {
            let is_open = |place: &usize| any.iter().any(|open| open.object == objects[*place]);
            let open = (0..objects.len()).filter(is_open).map(|place| proven(place, Precision::Octuple));
            (first(&open.collect::<Vec<_>>()), Precision::Octuple)
        }
        certain => (certain, Precision::Double),
    }
}

/// Proves which of some objects a ray hits first, as far as one precision tells.
pub fn first_by<'s>(
    precision: Precision,
    objects: impl IntoIterator<Item = (usize, &'s AnyShape)>,
    sight: &Sight,
) -> FirstHits {
    let certify = |(object, shape): (usize, &'s AnyShape)| {
        let (enclosure, part) = shape.certify_part(sight, precision);
        Candidate { object, part, enclosure }
    };
    first(&objects.into_iter().map(certify).collect::<Vec<_>>())
}

/// Returns a distance up to which a ray certainly hits one of some objects; infinite where none is known.
pub fn last_end<'s>(objects: impl IntoIterator<Item = (usize, &'s AnyShape)>, sight: &Sight) -> Fraction {
    let ends = objects.into_iter().map(|(_, shape)| match shape.certify(sight, Precision::Double) {
        Enclosure::Hits(at) => at.high,
        _ => Fraction::INFINITY,
    });
    ends.fold(Fraction::INFINITY, Float::min)
}

/// Returns which of the objects may be hit first, given what is proven about each.
fn first(candidates: &[Candidate]) -> FirstHits {
    // Some object is certainly hit at this distance or nearer.
    let end = candidates.iter().filter_map(|of| match of.enclosure {
        Enclosure::Hits(at) => Some(at.high),
        _ => None,
    });
    let end = end.fold(Fraction::INFINITY, Float::min);
    let is_near = |of: &&Candidate| match of.enclosure {
        Enclosure::Misses => false,
        Enclosure::Hits(Wide { low, .. }) | Enclosure::Edge(Wide { low, .. }) | Enclosure::Doubtful(low) => {
            low <= end
        }
    };
    let any: Vec<_> = candidates.iter().filter(is_near).copied().collect();
    match any[..] {
        [] => FirstHits::Certain(None),
        [Candidate { object, part, enclosure: Enclosure::Hits(at) }] => {
            FirstHits::Certain(Some(FirstHit { object, part, at }))
        }
        _ => FirstHits::OneOf { any, end },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_exact::interval::Interval;

    fn wide(low: f64, high: f64) -> Wide {
        Interval { low, high }.into()
    }

    #[test]
    fn the_first_is_certain_only_where_nothing_may_lie_before() {
        let hits = |low, high| Enclosure::Hits(wide(low, high));
        let doubtful = |from: f64| Enclosure::Doubtful(from.into());
        let (near, far, between) = (hits(1.0, 2.0), hits(3.0, 4.0), hits(1.5, 3.5));
        for (enclosures, right) in [
            (&[][..], &[None][..]),
            (&[Enclosure::Misses], &[None]),
            (&[far, Enclosure::Misses, near], &[Some(2)]),
            (&[near, far], &[Some(0)]),
            (&[near, between], &[Some(0), Some(1)]),
            (&[between, near], &[Some(0), Some(1)]),
            (&[far, between, near], &[Some(1), Some(2)]),
            (&[near, doubtful(2.5)], &[Some(0)]),
            (&[doubtful(1.5), near], &[Some(0), Some(1)]),
            (&[doubtful(1.5)], &[None, Some(0)]),
        ] {
            let numbered = (0..).zip(enclosures);
            let numbered: Vec<_> =
                numbered.map(|(object, of)| Candidate { object, part: 0, enclosure: *of }).collect();
            let found = first(&numbered);
            let may_be: Vec<_> =
                [None, Some(0), Some(1), Some(2)].into_iter().filter(|index| found.may_be(*index)).collect();
            assert_eq!(may_be, right, "{enclosures:?}");
            assert_eq!(matches!(found, FirstHits::Certain(_)), right.len() == 1, "{enclosures:?}");
        }
    }
}
