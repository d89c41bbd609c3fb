//! Surfaces that are polynomials of degree 6 to 40: first hits are those that exact arithmetic finds along the ray, by Sturm's
//! theorem, which the program does not use.

use crate::common::{model, registry};
use dashu_int::ops::{Abs, Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::collections::BTreeMap;
use std::path::Path;
use tabray::exact::interval::Float;
use tabray::geometry::{MISS, Ray, RayRange, Sight};
use tabray::scene;
use tabray::world::AnyShape;
use tabray::world::certify::{Enclosure, Precision};

/// The number of binary digits after the point of a coefficient, and of a coordinate of a ray.
const DIGITS: [usize; 2] = [40, 90];

/// Half the width of the box.
const BOX: f64 = 2.0;

/// The terms of a polynomial in x, y and z by their exponents; the coefficients are to be divided by 2^40.
type Terms = BTreeMap<[u32; 3], i128>;

struct Random(Pcg64);

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.0.next_u64() % count
    }

    /// Returns a number from -1 to 1 with 20 binary digits.
    fn part(&mut self) -> f64 {
        self.below(1 << 21) as f64 / f64::from(1 << 20) - 1.0
    }

    /// Returns a polynomial of a degree, of a few terms with small coefficients.
    fn factor(&mut self, degree: u32) -> Terms {
        let mut terms = Terms::new();
        for axis in 0..3 {
            let mut exponents = [0; 3];
            exponents[axis] = degree;
            terms.insert(exponents, (1 + self.below(3) as i128) << DIGITS[0]);
        }
        for _ in 0..4 {
            let mut left = degree - 1;
            let exponents = [0; 3].map(|_: u32| {
                let of = self.below(u64::from(left) + 1) as u32;
                left -= of;
                of
            });
            terms.insert(exponents, (self.below(9) as i128 - 4) << DIGITS[0]);
        }
        let constant = -(1 + self.below(3) as i128);
        terms.insert([0; 3], constant << (DIGITS[0] - 1));
        terms
    }
}

fn text(terms: &Terms) -> String {
    let mut text = String::from("0");
    for ([x, y, z], coefficient) in terms {
        text += &format!("+({:e})*x^{x}*y^{y}*z^{z}", *coefficient as f64 / (1_i64 << DIGITS[0]) as f64);
    }
    format!("({text})")
}

/// Multiplies polynomials whose coefficients are whole numbers, or halves of them.
fn product(one: &Terms, other: &Terms) -> Terms {
    let mut terms = Terms::new();
    for (a, first) in one {
        for (b, second) in other {
            // Coefficients are halves.
            let of = first.checked_mul(second >> (DIGITS[0] - 1)).expect("coefficients of few digits") / 2;
            *terms.entry([0, 1, 2].map(|axis| a[axis] + b[axis])).or_default() += of;
        }
    }
    terms
}

type Line = Vec<IBig>;

fn times(one: &Line, other: &Line) -> Line {
    let mut product = vec![IBig::ZERO; one.len() + other.len() - 1];
    for (power, a) in one.iter().enumerate() {
        for (other_power, b) in other.iter().enumerate() {
            product[power + other_power] += a * b;
        }
    }
    product
}

/// Returns a number with [`DIGITS`], which it must not exceed.
fn fixed(of: f64) -> IBig {
    let (bits, sign) = (of.abs().to_bits(), if of < 0.0 { -1 } else { 1 });
    let digits = IBig::from((bits & ((1 << 52) - 1)) | 1 << 52) * sign;
    let shift = (bits >> 52) as i64 - 1075 + DIGITS[1] as i64;
    if of == 0.0 {
        return IBig::ZERO;
    }
    assert!(shift >= 0, "{of:e} has more digits");
    digits << shift as usize
}

/// Returns a polynomial along a ray, times a positive number.
fn along(terms: &Terms, ray: &Ray) -> Line {
    let total = |exponents: &[u32; 3]| exponents.iter().sum::<u32>();
    let degree = terms.keys().map(total).max().expect("a term");
    let mut sum = vec![IBig::ZERO; degree as usize + 1];
    for (exponents, coefficient) in terms {
        let missing = (degree - total(exponents)) as usize;
        let mut term = vec![IBig::from(*coefficient) << (DIGITS[1] * missing)];
        for axis in 0..3 {
            let place = vec![fixed(ray.origin[axis]), fixed(ray.dir[axis])];
            for _ in 0..exponents[axis] {
                term = times(&term, &place);
            }
        }
        for (power, of) in term.into_iter().enumerate() {
            sum[power] += of;
        }
    }
    sum
}

/// The polynomials of Sturm's theorem.
struct Chain(Vec<Line>);

impl Chain {
    fn new(mut of: Line) -> Self {
        trim(&mut of);
        let mut slope: Line =
            of.iter().enumerate().skip(1).map(|(power, of)| of * IBig::from(power)).collect();
        trim(&mut slope);
        let mut chain = vec![of, slope];
        loop {
            let [.., one, other] = &chain[..] else { unreachable!() };
            let mut rest = one.clone();
            let (lead, count) = (other.last().expect("a coefficient").clone(), other.len());
            while rest.len() >= count {
                let (top, shift) = (rest.pop().expect("a coefficient"), rest.len() + 1 - count);
                let sign = if lead < IBig::ZERO { IBig::from(-1) } else { IBig::ONE };
                for (index, of) in rest.iter_mut().enumerate() {
                    *of *= (&lead).abs();
                    if index >= shift {
                        *of -= &sign * &top * &other[index - shift];
                    }
                }
            }
            trim(&mut rest);
            if rest.is_empty() {
                return Self(chain);
            }
            let content = rest.iter().fold(UBig::ZERO, |content, of| {
                let of = of.clone().unsigned_abs();
                if content.is_zero() {
                    of
                } else if of.is_zero() {
                    content
                } else {
                    content.gcd(of)
                }
            });
            let content = -IBig::from(content);
            chain.push(rest.into_iter().map(|of| of / &content).collect());
        }
    }

    /// Returns the number of different roots that are above a place, less a constant.
    fn above(&self, at: f64) -> i32 {
        let (at, mut changes, mut last) = (fixed(at), 0, 0);
        for of in &self.0 {
            let sign = sign(of, &at);
            if sign != 0 {
                changes += i32::from(last != 0 && sign != last);
                last = sign;
            }
        }
        changes
    }

    /// Returns the number of different roots from one place, which is no root, to another.
    fn between(&self, low: f64, high: f64) -> i32 {
        self.above(low) - self.above(high)
    }
}

fn trim(of: &mut Line) {
    while of.last().is_some_and(IBig::is_zero) {
        of.pop();
    }
}

/// Returns the sign at a place with [`DIGITS`].
fn sign(of: &Line, at: &IBig) -> i32 {
    let mut sum = IBig::ZERO;
    for (step, coefficient) in of.iter().rev().enumerate() {
        sum = sum * at + (coefficient << (DIGITS[1] * step));
    }
    if sum.is_zero() {
        0
    } else if sum < IBig::ZERO {
        -1
    } else {
        1
    }
}

/// Returns where a ray is in the box.
fn clipped(ray: &Ray) -> (f64, f64) {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let ends = [-BOX, BOX].map(|side| (side - ray.origin[axis]) / ray.dir[axis]);
        (from, to) = (from.max(ends[0].min(ends[1])), to.min(ends[0].max(ends[1])));
    }
    (from, to)
}

/// A surface as a scene has it, and its factors.
struct Surface {
    text: String,
    factors: Vec<(Terms, u32)>,
}

/// Returns the shape of a formula.
fn shape(text: &str) -> scene::Model {
    model(&scene_of(text))
}

fn scene_of(text: &str) -> String {
    format!(
        "camera eye {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 5 }}
        material m {{ ambient 1 1 1 }}
        implicit s {{ material m formula \"{text}\" box {0} {0} {0} {BOX} {BOX} {BOX} }}",
        -BOX
    )
}

/// What became of some rays.
#[derive(Debug, Default)]
struct Tally {
    hits: usize,
    misses: usize,
    touches: usize,
    skipped: usize,
}

/// Compares the first hits of a surface with those of Sturm's theorem.
fn judge(surface: &Surface, rays: usize, random: &mut Random, tally: &mut Tally) {
    let model = shape(&surface.text);
    let shape: &AnyShape = &model.objects[0].shape;
    for _ in 0..rays {
        let target = DVec3::new(random.part(), random.part(), random.part());
        let origin = 5.0 * DVec3::new(random.part(), random.part(), 1.0);
        let ray = Ray { origin, dir: (target - origin).normalize() };
        if ray.dir.abs().min_element() < 1e-9 {
            continue;
        }
        let (from, to) = clipped(&ray);
        if from >= to {
            continue;
        }
        let mut line = vec![IBig::ONE];
        for (factor, power) in &surface.factors {
            let factor = along(factor, &ray);
            for _ in 0..*power {
                line = times(&line, &factor);
            }
        }
        let chain = Chain::new(line.clone());
        let near = 1e-9;
        if chain.between(from - near, from + near) + chain.between(to - near, to + near) > 0 {
            tally.skipped += 1;
            continue;
        }
        let certain = shape.certify(&Sight::along(&ray), Precision::Octuple);
        let found = shape.distance(&ray, &RayRange::ALL);
        if chain.between(from, to) == 0 {
            assert_eq!(certain, Enclosure::Misses, "{ray:?} {}", surface.text);
            assert_eq!(found, MISS, "{ray:?} {}", surface.text);
            tally.misses += 1;
            continue;
        }
        // The first root, as far as neighbouring numbers allow.
        let (mut low, mut high) = (from, to);
        loop {
            let middle = 0.5 * (low + high);
            if !(low < middle && middle < high) {
                break;
            }
            if chain.between(from, middle) > 0 { high = middle } else { low = middle }
        }
        let Enclosure::Hits(at) = certain else { panic!("{certain:?} is no hit: {ray:?} {}", surface.text) };
        assert!(at.low.to_f64() <= high && low <= at.high.to_f64(), "{at:?} {low}");
        assert!((at.high - at.low).to_f64() < 1e-20, "{at:?}");
        let touches = sign(&line, &fixed(low)) == sign(&line, &fixed(high));
        tally.touches += usize::from(touches);
        let off = (found - high).abs() / (high.next_up() - high);
        assert!(off <= 4.0, "{found:e} is {off:.1} ulp from {high:e}: {ray:?} {}", surface.text);
        tally.hits += 1;
    }
}

/// Returns a surface of at least a degree: a product of factors, of which the first one has this power.
fn factored(degree: u32, power: u32, random: &mut Random) -> Surface {
    let (mut factors, mut left) = (Vec::new(), degree as i32);
    while left > 0 {
        let of = if factors.is_empty() { power } else { 1 };
        let own = 2 + random.below(3) as u32;
        let factor = random.factor(own);
        left -= (of * factor.keys().map(|exponents| exponents.iter().sum::<u32>()).max().unwrap_or(0)) as i32;
        factors.push((factor, of));
    }
    let texts: Vec<_> = factors.iter().map(|(factor, power)| format!("{}^{power}", text(factor))).collect();
    Surface { text: texts.join("*"), factors }
}

/// Returns the same surface, with its product expanded.
fn expanded(surface: Surface) -> Surface {
    let mut all = Terms::from([([0; 3], 1 << DIGITS[0])]);
    for (factor, power) in &surface.factors {
        for _ in 0..*power {
            all = product(&all, factor);
        }
    }
    Surface { text: text(&all), ..surface }
}

#[test]
fn products_are_hit_where_exact_arithmetic_says() {
    let (mut random, mut tally) = (Random(Pcg64::new(1, 7)), Tally::default());
    for (degree, rays) in [(6, 40), (9, 30), (12, 20), (18, 6), (28, 2), (37, 1)] {
        for _ in 0..3 {
            judge(&factored(degree, 1, &mut random), rays, &mut random, &mut tally);
        }
    }
    assert!(tally.hits > 100 && tally.skipped < 5, "{tally:?}");
}

#[test]
fn expanded_products_are_hit_where_exact_arithmetic_says() {
    let (mut random, mut tally) = (Random(Pcg64::new(2, 7)), Tally::default());
    for (degree, rays) in [(6, 40), (9, 30), (12, 20)] {
        for _ in 0..3 {
            let surface = expanded(factored(degree, 1, &mut random));
            judge(&surface, rays, &mut random, &mut tally);
        }
    }
    assert!(tally.hits > 60, "{tally:?}");
}

#[test]
fn squared_factors_are_hit_as_they_are_written_and_where_they_cannot_be_divided_out() {
    let (mut random, mut tally) = (Random(Pcg64::new(3, 7)), Tally::default());
    for degree in [6, 8, 10] {
        for _ in 0..2 {
            let surface = factored(degree, 2, &mut random);
            judge(&surface, 10, &mut random, &mut tally);
            judge(&expanded(surface), 10, &mut random, &mut tally);
        }
    }
    assert!(tally.hits > 40 && tally.touches > 20, "{tally:?}");
}

#[test]
fn sheets_that_are_close_are_told_apart() {
    let (mut random, mut tally) = (Random(Pcg64::new(4, 7)), Tally::default());
    for count in [2, 3, 6] {
        let first = random.factor(2);
        let sheets = (0..count).map(|index| {
            let mut sheet = first.clone();
            *sheet.entry([0; 3]).or_default() += index * 5;
            (sheet, 1)
        });
        let factors: Vec<_> = sheets.collect();
        let texts: Vec<_> = factors.iter().map(|(factor, _)| text(factor)).collect();
        let surface = Surface { text: texts.join("*"), factors };
        judge(&surface, 40, &mut random, &mut tally);
    }
    assert!(tally.hits > 40 && tally.touches == 0, "{tally:?}");
}

#[test]
fn factors_that_are_repeated_are_told() {
    for (formula, message) in [
        ("(x^2 + y^2 + z^2 - 1)^2*(x - 2y)", "a power of the factor `x^2 + y^2 + z^2 - 1`"),
        ("x^2 + 2x*y + y^2 + 0*z", "touches 0 without a change of sign"),
    ] {
        let text = scene_of(formula);
        let read = scene::read(registry(), "scene", Path::new(""), text.as_bytes(), None);
        let warnings = read.unwrap_or_else(|report| panic!("{report}")).warnings.to_string();
        assert!(warnings.contains(message), "{warnings}");
    }
}
