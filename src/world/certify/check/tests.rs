//! Tests of the second check.

use super::*;
use crate::certify::equation::Equation;
use crate::certify::{Enclosure, Precision, first_hit};
use crate::geometry::sight::Sight;
use std::sync::Arc;
use tabray_exact::formula::Formula;
use tabray_exact::formula::along::AlongLines;
use tabray_exact::interval::Fraction;

/// A surface whose proofs are about one formula, although the scene has another.
struct Surface {
    proven: Field,
    written: Field,
    /// Below 0 where the proven formula is not defined.
    domain: Option<Field>,
}

impl Surface {
    fn new(proven: &str, written: &str) -> Self {
        let (proven, written) = (field(proven), field(written));
        let domain = proven.domain([[-2.0; 3], [2.0; 3]]);
        Self { proven, written, domain }
    }
}

impl Equation for Surface {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.proven.at(at)
    }

    fn polynomial(&self) -> Option<&AlongLines> {
        Some(self.proven.along_lines())
    }

    fn field(&self) -> Option<&Field> {
        Some(&self.written)
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.domain.as_ref().map_or(N::constant(1.0), |domain| domain.at(at))
    }

    fn extent(&self) -> [DVec3; 2] {
        [DVec3::splat(-2.0), DVec3::splat(2.0)]
    }
}

fn field(text: &str) -> Field {
    let formula =
        Formula::parse_in(text, Field::VARIABLES).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
    Field::new(Arc::new(formula)).expect("its variables are x, y and z")
}

fn surface(written: &str) -> Surface {
    Surface::new(written, written)
}

fn line<F: Float>(origin: [f64; 3], dir: [f64; 3]) -> Line<Interval<F>> {
    Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) }
}

/// Returns what a search notes that clips a line rightly, and cuts it at these places.
fn trail<F: Float>(surface: &Surface, line: &Line<Interval<F>>, places: &[f64]) -> Trail {
    let mut trail = Trail { places: places.to_vec(), ..Trail::default() };
    let [low, high] = Values::<Interval<F>>::widened_extent(surface);
    trail.clip(line.clip(low, high));
    trail
}

/// Returns whether the check lets a claim about a line along z from z = -3 pass, in each precision.
fn passes(text: &str, [x, y]: [f64; 2], claimed: HitEnclosure<f64>) -> [bool; 2] {
    fn pass<F: Float>(text: &str, start: [f64; 3], claimed: HitEnclosure<F>) -> bool {
        let (surface, line) = (surface(text), line::<F>(start, [0.0, 0.0, 1.0]));
        first(&surface, &line, claimed, &trail(&surface, &line, &[])) == claimed
    }
    let finely = match claimed {
        HitEnclosure::Misses => HitEnclosure::Misses,
        HitEnclosure::Hits(at) => HitEnclosure::Hits(Interval::from_f64(at)),
        HitEnclosure::Edge(at) => HitEnclosure::Edge(Interval::from_f64(at)),
        HitEnclosure::Doubtful(from) => HitEnclosure::Doubtful(Fraction::from(from)),
    };
    let start = [x, y, -3.0];
    [pass::<f64>(text, start, claimed), pass::<Fraction>(text, start, finely)]
}

#[test]
fn what_is_true_passes() {
    let hits = |at: f64| HitEnclosure::Hits(Interval { low: at - 1e-12, high: at + 1e-12 });
    for (text, at, claimed) in [
        ("x^2 + y^2 + z^2 - 1", [0.0, 0.5], hits(3.0 - 0.75_f64.sqrt())),
        ("x^2 + y^2 + z^2 - 1", [0.9, 0.5], HitEnclosure::Misses),
        // The poles and jumps skip 0.
        ("1/z + 3", [0.1, 0.2], hits(3.0 - 1.0 / 3.0)),
        ("1/z", [0.1, 0.2], HitEnclosure::Misses),
        ("tan(z) + x", [0.0, 0.0], hits(3.0)),
        ("floor(z) + 0.5", [0.0, 0.0], HitEnclosure::Misses),
        ("if(z < 0.3, -1, 1)", [0.0, 0.0], HitEnclosure::Misses),
        ("sign(z - 0.1)*(1 + z^2)", [0.0, 0.0], HitEnclosure::Misses),
        ("atan2(z, x)", [-0.5, 0.0], HitEnclosure::Misses),
        // It would be 0 where the root is not defined.
        ("z - 1 - sqrt(x - 1)", [0.5, 0.0], HitEnclosure::Misses),
        ("z - ln(x)", [-0.5, 0.0], HitEnclosure::Misses),
        // Outside of the box.
        ("z - 2.5", [0.0, 0.0], HitEnclosure::Misses),
        ("acos(y/z) - 2", [0.0, -0.5], hits(3.0 - 0.5 / libm::cos(2.0))),
    ] {
        assert_eq!(passes(text, at, claimed), [true; 2], "{text} at {at:?}: {claimed:?}");
    }
}

/// A search looks beyond the box by more than its rounding.
#[test]
fn a_root_right_beyond_the_box_contradicts_no_miss() {
    let (surface, line) = (surface("z - 2 - 1e-12"), line::<f64>([0.1, 0.2, -3.0], [0.0, 0.0, 1.0]));
    let trail = trail(&surface, &line, &[1.5, 5.0 + 1.8e-12]);
    assert_eq!(first(&surface, &line, HitEnclosure::Misses, &trail), HitEnclosure::Misses);
}

/// Outside of a part in the middle, Steiner's surface is the axes alone, and the formula touches 0 there. The place of the
/// touch is no multiple of a power of two.
#[test]
fn a_touch_between_two_numbers_is_a_hit() {
    let steiner = surface("x^2*y^2 + y^2*z^2 + z^2*x^2 - 2*x*y*z");
    let sight = Sight::exactly(DVec3::new(3.0, 2.5, 4.5), DVec3::new(-9.0, -2.0, -13.5));
    let found = first_hit(&steiner, &sight, Precision::Octuple);
    let Enclosure::Hits(at) = found else { panic!("{found:?}") };
    assert!((at * Interval::constant(3.0) - Interval::constant(1.0)).has_zero(), "{at:?}");
}

#[test]
fn what_is_false_is_open() {
    let hits = |low: f64, high: f64| HitEnclosure::Hits(Interval { low, high });
    for (text, at, claimed) in [
        // A plane that is left out.
        ("z", [0.1, 0.2], HitEnclosure::Misses),
        ("(z - 0.3)^3*exp(x)", [0.1, 0.2], HitEnclosure::Misses),
        ("1/z + 0.8", [0.1, 0.2], HitEnclosure::Misses),
        ("acos(y/z) - 2", [0.0, 0.5], HitEnclosure::Misses),
        // A later root in place of the first.
        ("z*(z - 1)", [0.1, 0.2], hits(3.9999, 4.0001)),
        // No root.
        ("z", [0.1, 0.2], hits(2.9, 2.99)),
        ("1 + z^2 + x", [0.1, 0.2], hits(2.9, 3.1)),
        // A pole, and where nothing is defined.
        ("z/y + 0.1", [-0.5, 0.0], hits(2.9, 3.1)),
        ("sqrt(x) + z", [-0.5, 0.0], hits(2.9, 3.1)),
    ] {
        assert_eq!(passes(text, at, claimed), [false; 2], "{text} at {at:?}: {claimed:?}");
    }
}

#[test]
fn a_thin_layer_is_seen_at_the_ends_of_pieces() {
    let (surface, line) = (surface("(z - 0.7)*(z - 0.7001)"), line::<f64>([0.0, 0.0, -3.0], [0.0, 0.0, 1.0]));
    let checked =
        |places: &[f64]| first(&surface, &line, HitEnclosure::Misses, &trail(&surface, &line, places));
    assert_eq!(checked(&[1.5, 3.0]), HitEnclosure::Misses);
    assert_eq!(checked(&[1.5, 3.700_05]), HitEnclosure::Doubtful(0.0));
}

#[test]
fn a_fault_in_a_list_of_hits_ends_it() {
    let (surface, line) = (surface("z*(z - 1)"), line::<f64>([0.1, 0.2, -3.0], [0.0, 0.0, 1.0]));
    let hit = |at: f64| HitEnclosure::Hits(Interval { low: at - 1e-9, high: at + 1e-9 });
    let (one, two) = (hit(3.0), hit(4.0));
    let all = |claimed| all(&surface, &line, claimed, &trail(&surface, &line, &[]));
    assert_eq!(all(vec![one, two]), [one, two]);
    assert!(matches!(all(vec![one])[..], [HitEnclosure::Hits(_), HitEnclosure::Doubtful(_)]));
    assert!(matches!(all(vec![two])[..], [HitEnclosure::Doubtful(_)]));
    assert!(matches!(all(vec![one, hit(3.5)])[..], [_, HitEnclosure::Doubtful(_)]));
}

#[test]
fn what_is_clipped_away_is_open() {
    // A plane of which nothing is seen at the places that are drawn.
    let surface = surface("(z - 0.7)*(z - 0.7001)");
    for [x, y] in [[0.1, 0.2], [-1.9, 1.9]] {
        let line = line::<f64>([x, y, -3.0], [0.0, 0.0, 1.0]);
        let checked = |clipped| {
            let trail = Trail { clipped, ..Trail::default() };
            first(&surface, &line, HitEnclosure::Misses, &trail)
        };
        // The box is a little wider than it is given.
        assert_eq!(checked(Some([1.0 - 1e-6, 5.0 + 1e-6])), HitEnclosure::Misses);
        for inward in [None, Some([1.0 + 1e-9, 5.1]), Some([0.9, 5.0 - 1e-9]), Some([2.0, 2.0])] {
            assert_eq!(checked(inward), HitEnclosure::Doubtful(0.0), "{inward:?}");
        }
    }
    let beside = line::<f64>([2.1, 0.2, -3.0], [0.0, 0.0, 1.0]);
    let trail = trail(&surface, &beside, &[]);
    assert_eq!(
        (trail.clipped, first(&surface, &beside, HitEnclosure::Misses, &trail)),
        (None, HitEnclosure::Misses)
    );
}

/// What is searched has another sign than the formula, or another domain, although no hit tells.
#[test]
fn what_is_simplified_away_is_open() {
    for (proven, written) in [
        ("x^2 + y^2 + z^2 + 1", "-1 - x^2 - y^2 - z^2"),
        ("z + 9", "(z + 9)*(min(z^2, 1) - 2)"),
        ("9 + sqrt(z - 0.5)", "9 + sqrt(z + 2.5)"),
        ("9 + sqrt(z + x)", "9 + sqrt((z + x)^2)"),
    ] {
        let surface = Surface::new(proven, written);
        let open = (0..400).filter(|ray| {
            let at = |by: usize| (ray * by % 401) as f64 / 201.0 - 1.0;
            let line = line::<f64>([at(31), at(53), -3.0], [0.1 * at(7), 0.1 * at(5), 1.0]);
            first(&surface, &line, HitEnclosure::Misses, &trail(&surface, &line, &[]))
                == HitEnclosure::Doubtful(0.0)
        });
        let open = open.count();
        assert!(open >= 10, "{proven} for {written}: {open}");
    }
}

/// Proofs about another formula than that of the scene become open, where the two differ along a ray.
#[test]
fn planted_faults_become_open() {
    let mut counts = [0; 3];
    for (proven, written) in [
        ("x^2 + y^2 + z^2 - 1", "x^2 + y^2 + z^2 - 1.5"),
        ("y - 0.5*x", "y + 0.5*x"),
        ("acos(y/z) - 2", "acos(y/z) - 1.8"),
        ("sin(3*x) + z", "sin(3*x) + z - 0.01"),
    ] {
        let surface = Surface::new(proven, written);
        for ray in 0..200 {
            let part = |by: usize| (ray * by % 211) as f64 / 105.0 - 1.0;
            let origin = DVec3::new(4.0 * part(31), 4.0 * part(53), 5.0);
            let sight = Sight::exactly(origin, DVec3::new(part(71), part(87), part(101)) - origin);
            let right = first_hit(&Surface::new(written, written), &sight, Precision::Double);
            match (first_hit(&surface, &sight, Precision::Double), right) {
                (Enclosure::Doubtful(_), _) => counts[0] += 1,
                (Enclosure::Hits(one), Enclosure::Hits(other))
                    if one.low <= other.high && other.low <= one.high =>
                {
                    counts[1] += 1;
                }
                (Enclosure::Misses, Enclosure::Misses) => counts[1] += 1,
                (_, Enclosure::Doubtful(_)) => {}
                (one, other) => {
                    counts[2] += 1;
                    println!("{proven} and {written}: {one:?} {other:?}");
                }
            }
        }
    }
    let [open, same, wrong] = counts;
    // Only a layer thinner than the distance of the places that are looked at stays unseen.
    assert!(open > 200 && same > 50 && 50 * wrong <= open, "{counts:?}");
}
