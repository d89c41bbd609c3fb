//! First hits of surfaces of revolution, tori and hearts. The ray is divided into pieces in which the surface's
//! function certainly has no root, or is monotonic; in `f64` first, then in 320 bits.

use super::closed::Hit;
use super::dyadic::Dyadic;
use super::fast::Fast;
use super::formula::{Formula, Piece, Sides};
use super::number::{Jet, Number};
use super::ray::{Ray, cross, dot, minus};
use super::text::Vector;
use super::wide::Wide;
use std::cmp::Ordering;

/// A function along a ray that is 0 where the ray meets a surface.
trait Along {
    /// Evaluates the function on a piece of the ray; `None` where it is nowhere defined.
    fn at<T: Number>(&self, place: &Jet<T>, known: &Known<T>, sides: &mut Sides) -> Option<Piece<T>>;
    /// Tells whether roots in a piece of the ray belong to the part of the surface that is kept, if that is certain.
    fn kept<T: Number>(&self, place: &T, known: &Known<T>) -> Option<bool>;
    fn known(&self) -> &Known<Wide>;
}

/// The coefficients of a function along a ray.
struct Known<T>(Vec<T>);

/// What is known of the roots of a function on a part of a ray.
#[derive(Clone, Debug)]
pub struct Roots<T> {
    /// The pieces that may have roots, in their order; all before the first certain root.
    pub open: Vec<[T; 2]>,
    /// The first certain root.
    pub first: Option<T>,
}

/// The numbers of pieces that are looked at in `f64`, and in 320 bits, until a ray is given up.
const THOROUGH: [usize; 2] = [4_000, 20_000];

/// The number of pieces that may stay open.
const MAX_OPEN: usize = 24;

/// The number of jumps and poles in a piece, on all of whose sides the function is evaluated.
const MAX_SIDES: u32 = 6;

/// The bits to which a piece without a certain root is divided: roots that nearly coincide are told apart, or from none.
const ROOT_BITS: i64 = 260;

/// The bits to which a change of sign is located where the function has no slope, as at a ledge.
const LEDGE_BITS: i64 = 140;

/// `is_exact` tells that a change of sign at a ledge is located as closely as is useful.
fn roots<T: Number>(
    along: &impl Along,
    known: &Known<T>,
    [from, to]: [T; 2],
    most: usize,
    is_exact: bool,
) -> Roots<T> {
    let size = Number::abs(&from).max(&Number::abs(&to));
    let mut found = Roots { open: Vec::new(), first: None };
    let mut waiting = vec![[from, to.clone()]];
    for _ in 0..most {
        let Some([low, high]) = waiting.pop() else { return found };
        let piece = low.hull(&high);
        if along.kept(&piece, known) == Some(false) {
            continue;
        }
        let mut sides = Sides::default();
        let Some(Piece { jet, is_whole }) = along.at(&Jet::variable(piece.clone()), known, &mut sides) else {
            continue;
        };
        let value = |at: &T| {
            let there = along.at(&Jet::constant(at.clone()), known, &mut Sides::default());
            there.map_or(T::any(), |there| there.jet.value)
        };
        let inner = piece.inner();
        if is_not_zero(&jet.value)
            || (is_whole && is_not_zero(&value(&inner).add(&jet.slope.mul(&piece.sub(&inner)))))
        {
            continue;
        }
        let (is_narrow, is_steep) = (piece.is_narrow(&size, ROOT_BITS), is_not_zero(&jet.slope));
        if is_whole && (is_exact && piece.is_narrow(&size, LEDGE_BITS) || is_steep) {
            let root = match (value(&low).sign(), value(&high).sign()) {
                (Some(one), Some(other)) if one == other && one != Ordering::Equal && is_steep => continue,
                (Some(one @ (Ordering::Less | Ordering::Greater)), Some(other)) if one == other.reverse() => {
                    if is_steep {
                        Some(narrowed(along, known, piece.clone()))
                    } else {
                        Some(piece.clone())
                    }
                }
                _ => None,
            };
            match root.map(|root| (along.kept(&root, known), root)) {
                Some((Some(true), root)) => return Roots { first: Some(root), ..found },
                Some((Some(false), _)) => continue,
                Some((None, root)) => {
                    found.open.push([root.low(), root.high()]);
                    continue;
                }
                None => {}
            }
        }
        if sides.count > 0 && is_nowhere_zero(along, known, &piece) {
            continue;
        }
        // Where the function is 0 all along a piece, so it is along shorter ones.
        if is_narrow || is_whole && jet.value.sign() == Some(Ordering::Equal) {
            let is_full = found.open.len() == MAX_OPEN;
            match found.open.last_mut() {
                Some([_, end]) if !low.sub(end).sign().is_some_and(Ordering::is_gt) => *end = high,
                _ if is_full => {
                    found.open.push([low, to]);
                    return found;
                }
                _ => found.open.push([low, high]),
            }
            continue;
        }
        waiting.push([inner.clone(), high]);
        waiting.push([low, inner]);
    }
    if let Some([low, _]) = waiting.pop() {
        found.open.push([low, to]);
    }
    found
}

/// Tells whether the function is not 0 on any of the sides of its jumps and poles in a piece.
fn is_nowhere_zero<T: Number>(along: &impl Along, known: &Known<T>, piece: &T) -> bool {
    let mut chosen = 0_u32;
    loop {
        let mut sides = Sides { count: 0, chosen: Some(chosen) };
        let side = along.at(&Jet::variable(piece.clone()), known, &mut sides);
        if sides.count > MAX_SIDES || side.is_some_and(|side| !is_not_zero(&side.jet.value)) {
            return false;
        }
        // On one side of a jump, there may be further ones: next is the other side of the last one that has one.
        let Some(last) = (0..sides.count).rev().find(|jump| chosen >> jump & 1 == 0) else { return true };
        chosen = chosen & ((1 << last) - 1) | 1 << last;
    }
}

fn is_not_zero<T: Number>(of: &T) -> bool {
    matches!(of.sign(), Some(Ordering::Less | Ordering::Greater))
}

/// Returns the only root of a piece on which the function is monotonic, by Newton's method with bounds.
fn narrowed<T: Number>(along: &impl Along, known: &Known<T>, mut piece: T) -> T {
    /// How often a piece is cut where the method does not halve it, as where slopes differ at an edge of the shape.
    const CUTS: usize = 64;
    /// The number of steps after which a root is known well enough. Near 0, digits have no end.
    const STEPS: usize = 400;
    let mut cuts = 0;
    for _ in 0..STEPS {
        let at = |of: Jet<T>| {
            let there = along.at(&of, known, &mut Sides::default());
            there.map_or(Jet { value: T::any(), slope: T::any() }, |there| there.jet)
        };
        let slope = at(Jet::variable(piece.clone())).slope;
        let inner = piece.inner();
        let value = at(Jet::constant(inner.clone())).value;
        let Some(next) = inner.sub(&value.div(&slope)).meet(&piece) else { return piece };
        let has_shrunk = next.is_half(&piece);
        piece = next;
        if has_shrunk {
            continue;
        }
        let inner = piece.inner();
        let value = at(Jet::constant(inner.clone())).value;
        piece = match (value.sign(), slope.sign()) {
            _ if cuts == CUTS => return piece,
            (Some(Ordering::Less), Some(Ordering::Greater))
            | (Some(Ordering::Greater), Some(Ordering::Less)) => piece.max(&inner),
            (Some(Ordering::Less), Some(Ordering::Less))
            | (Some(Ordering::Greater), Some(Ordering::Greater)) => piece.min(&inner),
            _ => return piece,
        };
        cuts += 1;
    }
    piece
}

/// A ray as `s = start + 2^power * place`: places are relative to one of its points near a shape, in steps of about a
/// world unit.
struct Local {
    start: Dyadic,
    power: i64,
    /// The ray's point at place 0, relative to the shape's own point.
    from: Vector,
    /// The change of that point per unit of place.
    dir: Vector,
}

impl Local {
    /// Starts near the point of the ray that is closest to `middle`. Coordinates are relative to `own`, the shape's own
    /// point.
    fn new(ray: &Ray, middle: &Vector, own: &Vector) -> Self {
        let closest = dot(&minus(middle, &ray.origin), &ray.dir);
        let square = dot(&ray.dir, &ray.dir);
        let start = closest.divided(&square, 53, false);
        let power = -((square.size() - 1) / 2);
        let from = minus(&ray.origin, own);
        let from = [0, 1, 2].map(|axis| from[axis].add(&ray.dir[axis].mul(&start)));
        let dir = [0, 1, 2].map(|axis| ray.dir[axis].shifted(power));
        Self { start, power, from, dir }
    }

    /// Returns what is known of the places ahead of the ray's origin at which the function is 0, up to at least `reach`
    /// world units from the point at place 0.
    /// At most so many pieces are looked at in `f64`, and in 320 bits for each piece that is then open.
    fn roots(&self, along: &impl Along, reach: f64, [most, most_wide]: [usize; 2]) -> Roots<Wide> {
        // A step is from half a world unit to two world units long.
        let reach = 4.0 * reach;
        let begin = self.start.neg().shifted(-self.power);
        let end = Dyadic::from(reach);
        let from = if begin.compare(&end.neg()).is_gt() { begin } else { end.neg() };
        if from.compare(&end).is_ge() {
            return Roots { open: Vec::new(), first: None };
        }
        // The search runs in `f64` first if `f64` represents the start of the range exactly.
        let known = along.known();
        let ends = [&from, &end];
        let fast = ends.map(Fast::exact);
        let mut found = Roots { open: vec![ends.map(Wide::point)], first: None };
        if fast[0].is_point() && fast[0].low.is_finite() {
            let of_fast = Known(known.0.iter().map(Fast::of).collect());
            let Roots { open, first } = roots(along, &of_fast, fast, most, false);
            found.open = open.iter().map(|piece| piece.each_ref().map(Fast::to_wide)).collect();
            found.first = first.map(|root| narrowed(along, known, root.to_wide()));
        }
        let mut open = Vec::new();
        for piece in found.open {
            if most_wide == 0 {
                open.push(piece);
                continue;
            }
            let inner = roots(along, known, piece, most_wide, true);
            open.extend(inner.open);
            if inner.first.is_some() {
                found.first = inner.first;
                break;
            }
        }
        found.open = open;
        found
    }

    /// Returns a place of the ray, given as one of this part of it.
    fn place(&self, at: &Wide) -> Wide {
        let step = Wide::point(&Dyadic::int(1).shifted(self.power));
        Wide::point(&self.start).add(&at.mul(&step))
    }

    fn first_hit(&self, along: &impl Along, reach: f64) -> Hit {
        match self.roots(along, reach, THOROUGH) {
            Roots { open, .. } if !open.is_empty() => Hit::Touch,
            Roots { first: Some(root), .. } => Hit::At(self.place(&root)),
            _ => Hit::Miss,
        }
    }
}

/// A surface of revolution. The heights of the ray's points are `h0 + h1 s`, and their squared distances from the axis
/// `q0 + q1 s + q2 s^2`.
struct OnRevolved<'s> {
    profile: &'s Formula,
    known: Known<Wide>,
}

const HEIGHT: usize = 5;

impl OnRevolved<'_> {
    fn height<T: Number>(place: &Jet<T>, known: &Known<T>) -> Jet<T> {
        let constant = |of: usize| Jet::constant(known.0[of].clone());
        constant(0).add(&constant(1).mul(place))
    }
}

impl Along for OnRevolved<'_> {
    // At a step of the profile, the surface is a ledge.
    fn at<T: Number>(&self, place: &Jet<T>, known: &Known<T>, _: &mut Sides) -> Option<Piece<T>> {
        let constant = |of: usize| Jet::constant(known.0[of].clone());
        let zero = Jet::constant(T::int(0));
        // Beyond the ends of the surface the profile may be anything.
        let height = Self::height(place, known).max(&zero).min(&constant(HEIGHT));
        let around = constant(2).add(&constant(3).mul(place)).add(&constant(4).mul(&place.square()));
        Some(Piece::whole(around.sub(&self.profile.squared_at(&height))))
    }

    fn kept<T: Number>(&self, place: &T, known: &Known<T>) -> Option<bool> {
        let height = Self::height(&Jet::constant(place.clone()), known).value;
        let above = height.sign();
        let below = known.0[HEIGHT].sub(&height).sign();
        if above == Some(Ordering::Less) || below == Some(Ordering::Less) {
            return Some(false);
        }
        let within = height.max(&T::int(0)).min(&known.0[HEIGHT]);
        let radius = self.profile.sign_at(&within).sign();
        if radius == Some(Ordering::Less) {
            return Some(false);
        }
        (above.is_some() && below.is_some() && radius.is_some()).then_some(true)
    }

    fn known(&self) -> &Known<Wide> {
        &self.known
    }
}

/// Returns the first hit of a surface of revolution; `widest` is an upper bound of its radius.
pub fn revolved(
    ray: &Ray,
    (profile, widest): (&Formula, f64),
    axis: &Vector,
    base: &Vector,
    height: &Dyadic,
) -> Hit {
    let square = dot(axis, axis);
    let length = Wide::root_of(&square);
    let part = height.to_f64(true) / square.to_f64(false).sqrt();
    let middle = [0, 1, 2].map(|of| base[of].add(&axis[of].mul(&Dyadic::from(0.5 * part))));
    let local = Local::new(ray, &middle, base);
    let (one, other) = (cross(&local.from, axis), cross(&local.dir, axis));
    let over = |of: Dyadic, by: &Wide| Wide::exact(&of).div(by);
    let whole = Wide::exact(&square);
    let known = vec![
        over(dot(&local.from, axis), &length),
        over(dot(&local.dir, axis), &length),
        over(dot(&one, &one), &whole),
        over(dot(&one, &other).shifted(1), &whole),
        over(dot(&other, &other), &whole),
        Wide::exact(height),
    ];
    let reach = (0.6 * height.to_f64(true)).hypot(widest) * 1.01;
    local.first_hit(&OnRevolved { profile, known: Known(known) }, reach)
}

/// A formula of three variables, each `c0 + c1 s + c2 s^2` along the ray.
struct OnFormula<'s> {
    formula: &'s Formula,
    kept: &'s [Formula],
    known: Known<Wide>,
}

impl OnFormula<'_> {
    fn variables<T: Number>(place: &Jet<T>, known: &Known<T>) -> [Jet<T>; 3] {
        [0, 3, 6].map(|of| {
            let constant = |power: usize| Jet::constant(known.0[of + power].clone());
            constant(0).add(&constant(1).mul(place)).add(&constant(2).mul(&place.square()))
        })
    }
}

impl Along for OnFormula<'_> {
    fn at<T: Number>(&self, place: &Jet<T>, known: &Known<T>, sides: &mut Sides) -> Option<Piece<T>> {
        self.formula.on(Self::variables(place, known).each_ref(), sides)
    }

    fn kept<T: Number>(&self, place: &T, known: &Known<T>) -> Option<bool> {
        let variables = Self::variables(&Jet::constant(place.clone()), known);
        let signs = self.kept.iter().map(|kept| kept.of(variables.each_ref()).value.sign());
        let mut all = Some(true);
        for sign in signs {
            match sign {
                Some(Ordering::Less) => return Some(false),
                Some(_) => {}
                None => all = None,
            }
        }
        all
    }

    fn known(&self) -> &Known<Wide> {
        &self.known
    }
}

/// Returns the first hit of a shape by its formulas, as the scene's text has them.
pub fn by_formula(
    ray: &Ray,
    at: (&Vector, &Vector, f64),
    axis: Option<&Vector>,
    formula: &Formula,
    kept: &[Formula],
) -> Hit {
    match formula_roots(ray, at, axis, (formula, kept), THOROUGH) {
        Roots { open, .. } if !open.is_empty() => Hit::Touch,
        Roots { first: Some(place), .. } => Hit::At(place),
        _ => Hit::Miss,
    }
}

/// Returns what is known of the places at which a ray meets a shape by its formulas.
pub fn formula_roots(
    ray: &Ray,
    (own, middle, reach): (&Vector, &Vector, f64),
    axis: Option<&Vector>,
    (formula, kept): (&Formula, &[Formula]),
    most: [usize; 2],
) -> Roots<Wide> {
    let at = [0, 1, 2].map(|of| own[of].add(&middle[of]));
    let local = Local::new(ray, &at, own);
    let (from, dir) = (&local.from, &local.dir);
    let zero = || Wide::exact(&Dyadic::zero());
    let known = match axis {
        None => (0..3).flat_map(|of| [Wide::exact(&from[of]), Wide::exact(&dir[of]), zero()]).collect(),
        Some(axis) => {
            let square = dot(axis, axis);
            let (length, whole) = (Wide::root_of(&square), Wide::exact(&square));
            let (one, other) = (cross(from, axis), cross(dir, axis));
            let over = |of: Dyadic, by: &Wide| Wide::exact(&of).div(by);
            vec![
                over(dot(&one, &one), &whole),
                over(dot(&one, &other).shifted(1), &whole),
                over(dot(&other, &other), &whole),
                over(dot(from, axis), &length),
                over(dot(dir, axis), &length),
                zero(),
                zero(),
                zero(),
                zero(),
            ]
        }
    };
    let found = local.roots(&OnFormula { formula, kept, known: Known(known) }, reach, most);
    Roots {
        open: found.open.iter().map(|piece| piece.each_ref().map(|end| local.place(end))).collect(),
        first: found.first.map(|root| local.place(&root)),
    }
}

/// A polynomial, and for some shapes a second one, which is negative where the surface is cut off.
struct OnPolynomial {
    known: Known<Wide>,
    degree: usize,
}

impl OnPolynomial {
    fn new(polynomial: Polynomial, kept: Option<Polynomial>) -> Self {
        let degree = polynomial.0.len() - 1;
        let all = polynomial.0.iter().chain(kept.iter().flat_map(|kept| &kept.0));
        Self { known: Known(all.map(Wide::exact).collect()), degree }
    }
}

fn horner<T: Number>(coefficients: &[T], at: &T) -> T {
    let (last, others) = coefficients.split_last().expect("a coefficient");
    others.iter().rev().fold(last.clone(), |sum, next| sum.mul(at).add(next))
}

/// Returns the coefficients of the polynomial `p(x + to)`.
fn moved<T: Number>(coefficients: &[T], to: &T) -> Vec<T> {
    let mut all = coefficients.to_vec();
    for first in 0..all.len() {
        for of in (first..all.len() - 1).rev() {
            all[of] = all[of].add(&all[of + 1].mul(to));
        }
    }
    all
}

impl Along for OnPolynomial {
    fn at<T: Number>(&self, place: &Jet<T>, known: &Known<T>, _: &mut Sides) -> Option<Piece<T>> {
        // The polynomial is expanded about a point of the piece, so that its bounds are narrow there.
        let inner = place.value.inner();
        let from = place.value.sub(&inner);
        let all = moved(&known.0[..=self.degree], &inner);
        let slopes: Vec<T> = (1..all.len()).map(|of| all[of].mul(&T::int(of as i64))).collect();
        let (value, slope) = (horner(&all, &from), horner(&slopes, &from).mul(&place.slope));
        Some(Piece::whole(Jet { value, slope }))
    }

    fn kept<T: Number>(&self, place: &T, known: &Known<T>) -> Option<bool> {
        let rest = &known.0[self.degree + 1..];
        if rest.is_empty() {
            return Some(true);
        }
        horner(rest, place).sign().map(|sign| sign != Ordering::Less)
    }

    fn known(&self) -> &Known<Wide> {
        &self.known
    }
}

/// The coefficients of a polynomial, the lowest first.
#[derive(Clone)]
struct Polynomial(Vec<Dyadic>);

impl Polynomial {
    fn constant(of: Dyadic) -> Self {
        Self(vec![of])
    }

    fn add(&self, other: &Self) -> Self {
        let of = |all: &Self, at: usize| all.0.get(at).cloned().unwrap_or_else(Dyadic::zero);
        Self((0..self.0.len().max(other.0.len())).map(|at| of(self, at).add(&of(other, at))).collect())
    }

    fn mul(&self, other: &Self) -> Self {
        let mut product = vec![Dyadic::zero(); self.0.len() + other.0.len() - 1];
        for (i, one) in self.0.iter().enumerate() {
            for (j, two) in other.0.iter().enumerate() {
                product[i + j] = product[i + j].add(&one.mul(two));
            }
        }
        Self(product)
    }

    fn times(&self, by: &Dyadic) -> Self {
        self.mul(&Self::constant(by.clone()))
    }

    fn square(&self) -> Self {
        self.mul(self)
    }
}

pub fn torus(ray: &Ray, center: &Vector, axis: &Vector, radius: &Dyadic, tube: &Dyadic) -> Hit {
    let local = Local::new(ray, center, center);
    let (p, d) = (&local.from, &local.dir);
    let square = dot(axis, axis);
    // The squared length of the ray's points, and their heights times the length of the axis.
    let point = Polynomial(vec![dot(p, p), dot(p, d).shifted(1), dot(d, d)]);
    let height = Polynomial(vec![dot(p, axis), dot(d, axis)]);
    // |p|^2 + R^2 - r^2 = 2 R * (the distance from the axis), with both sides squared.
    let left = point.add(&Polynomial::constant(radius.square().sub(&tube.square())));
    let around = point.times(&square).add(&height.square().times(&Dyadic::int(-1)));
    let right = around.times(&radius.square().shifted(2));
    let all = left.square().times(&square).add(&right.times(&Dyadic::int(-1)));
    let kept = radius.compare(tube).is_lt().then_some(left);
    local.first_hit(&OnPolynomial::new(all, kept), radius.to_f64(true) + tube.to_f64(true))
}

pub fn heart(ray: &Ray, center: &Vector, size: &Dyadic) -> Hit {
    let local = Local::new(ray, center, center);
    let [x, y, z] = [0, 1, 2].map(|axis| Polynomial(vec![local.from[axis].clone(), local.dir[axis].clone()]));
    let [x2, y2, z2] = [x.square(), y.square(), z.square()];
    // (x^2 + y^2 + 9/4 z^2 - 1)^3 = (x^2 + 9/80 z^2) y^3, with both sides multiplied by 80 and size^6.
    let ball = x2.add(&y2).add(&z2.times(&Dyadic::from(2.25)));
    let ball = ball.add(&Polynomial::constant(size.square().neg()));
    let right = x2.times(&Dyadic::int(80)).add(&z2.times(&Dyadic::int(9)));
    let right = right.mul(&y2).mul(&y).times(&size.neg());
    let all = ball.square().mul(&ball).times(&Dyadic::int(80)).add(&right);
    local.first_hit(&OnPolynomial::new(all, None), 1.5 * size.to_f64(true))
}
