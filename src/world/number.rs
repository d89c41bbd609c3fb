//! The numbers in which lights and shaders state their rules: `f64` for pictures, and numbers that enclose others for
//! proofs.

use crate::certify::Precise;
use crate::material::Rgb;
use crate::patch::between;
use crate::shader::{EnclosedShader, Looks};
use glam::DVec3;
use std::f64::consts::PI;
use tabray_exact::affine::Affine;
use tabray_exact::interval::{Interval, Wide};
use tabray_exact::scalar::{Scalar, constants, dot, per_axis, unit};

/// A constant that is not a number of the scene itself, and that rounding changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The constant as pictures take it.
    pub rounded: f64,
    /// Encloses the constant before any rounding.
    pub enclosed: Wide,
}

impl Known {
    /// Joins a vector as pictures take it, and its enclosure.
    pub fn each(rounded: [f64; 3], enclosed: [Wide; 3]) -> [Self; 3] {
        per_axis(|axis| Self { rounded: rounded[axis], enclosed: enclosed[axis] })
    }

    /// Returns a known vector in any number.
    #[inline(always)]
    pub fn vector<N: Number>(of: &[Self; 3]) -> [N; 3] {
        per_axis(|axis| N::known(&of[axis]))
    }
}

/// The maximum number of columns or rows whose texels an enclosure examines one by one.
pub(crate) const MAX_TEXELS: usize = 8;

/// A number of a rule of light. A rule that is written once over such numbers gives colours, and bounds of them.
pub trait Number: Scalar + PartialEq + 'static {
    /// Returns a constant.
    fn known(of: &Known) -> Self;

    /// Returns π.
    fn pi() -> Self;

    /// Returns any number between two, for what a rule leaves open; of plain numbers, the second one.
    fn any(low: f64, high: f64) -> Self;

    /// Returns the number, if it encloses no others: for a rule that pictures compute in another way than proofs.
    #[inline(always)]
    fn plain(self) -> Option<f64> {
        None
    }

    /// Returns `other` if this number is negative, and otherwise `one`; bounds of both where that is open.
    #[inline(always)]
    fn either(self, one: [Self; 3], other: [Self; 3]) -> [Self; 3] {
        per_axis(|channel| self.choose(one[channel], other[channel]))
    }

    /// Returns the unit vector along a vector; where it has none, `straight`. `None` where that is open.
    fn along(vector: [Self; 3], straight: [Self; 3]) -> Option<[Self; 3]>;

    /// Returns a vector that would have the length 1 without rounding, with that length.
    #[inline(always)]
    fn lengthened(vector: [Self; 3]) -> [Self; 3] {
        vector
    }

    /// Returns 1 with the sign of the number; `None` where that is open.
    #[inline(always)]
    fn sign(self) -> Option<Self> {
        let [low, high] = self.bounds();
        let sign = if low >= 0.0 { Some(1.0) } else { (high < 0.0).then_some(-1.0) };
        sign.map(Self::constant)
    }

    /// Returns a shader of any type, to be asked in this number.
    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Self>;

    /// Returns a mean of two colours, or bounds of it; `part` is the weight of the other.
    #[inline(always)]
    fn lerp(one: [Self; 3], other: [Self; 3], part: Self) -> [Self; 3] {
        per_axis(|channel| one[channel] + part * (other[channel] - one[channel]))
    }

    /// Returns a [mean](Self::lerp) of two colours. Of plain numbers, rounding does not move a channel beyond both.
    #[inline(always)]
    fn mean(one: [Self; 3], other: [Self; 3], part: Self) -> [Self; 3] {
        Self::lerp(one, other, part)
    }

    /// Returns the angle, in radians from -π/2 to π/2, whose sine this number is.
    #[inline(always)]
    fn asin(self) -> Self {
        let one = Self::constant(1.0);
        self.atan2(((one - self) * (one + self)).sqrt())
    }

    /// Returns bounds of two numbers; of plain numbers, the second one.
    fn hull(self, other: Self) -> Self;

    /// Returns the least and the greatest whole number at most this number.
    fn floors(self) -> [f64; 2];

    /// Returns the distance to the nearest even number.
    fn off_even(self) -> Self;

    /// Returns what a function of the whole numbers at most these two returns; it is given plain numbers as they are, and
    /// drops their fractions itself. Each channel is from 0 to `most`; where there are many such numbers, that is all that
    /// is known.
    fn table(at: [Self; 2], most: impl Fn() -> f64, of: impl Fn([f64; 2]) -> Rgb) -> [Self; 3] {
        let [columns, rows] = at.map(Self::floors);
        let are_few = |[low, high]: [f64; 2]| high - low < MAX_TEXELS as f64;
        if !(are_few(columns) && are_few(rows)) {
            return [Self::any(0.0, most()); 3];
        }
        let all = |[low, high]: [f64; 2]| (0..=(high - low) as u32).map(move |step| low + f64::from(step));
        let found = all(rows).flat_map(|row| all(columns).map(move |column| [column, row]));
        found.map(|at| constants(of(at))).reduce(hull).unwrap_or([Self::any(0.0, most()); 3])
    }
}

/// Returns bounds of two vectors.
pub fn hull<N: Number>(one: [N; 3], other: [N; 3]) -> [N; 3] {
    per_axis(|axis| one[axis].hull(other[axis]))
}

/// Returns the products of the numbers of two vectors.
#[inline(always)]
pub fn product<N: Number>(one: [N; 3], other: [N; 3]) -> [N; 3] {
    per_axis(|axis| one[axis] * other[axis])
}

/// Returns bounds of a number in `f64`.
pub fn coarse<N: Number>(of: N) -> Interval {
    let [low, high] = of.bounds();
    Interval { low, high }
}

/// Returns a vector of plain numbers, if these are plain.
#[inline(always)]
pub fn plain<N: Number>([x, y, z]: [N; 3]) -> Option<DVec3> {
    Some(DVec3::new(x.plain()?, y.plain()?, z.plain()?))
}

impl Number for f64 {
    #[inline(always)]
    fn known(of: &Known) -> Self {
        of.rounded
    }

    #[inline(always)]
    fn pi() -> Self {
        PI
    }

    #[inline(always)]
    fn any(_low: f64, high: f64) -> Self {
        high
    }

    #[inline(always)]
    fn plain(self) -> Option<f64> {
        Some(self)
    }

    #[inline(always)]
    fn either(self, one: [Self; 3], other: [Self; 3]) -> [Self; 3] {
        if self < 0.0 { other } else { one }
    }

    #[inline(always)]
    fn along(vector: [Self; 3], straight: [Self; 3]) -> Option<[Self; 3]> {
        Some(DVec3::from(vector).try_normalize().map_or(straight, |unit| unit.to_array()))
    }

    #[inline(always)]
    fn lengthened(vector: [Self; 3]) -> [Self; 3] {
        unit(vector)
    }

    /// Adding 0 turns -0 into 0, which enclosing numbers do not tell from it.
    #[inline(always)]
    fn sign(self) -> Option<Self> {
        Some((self + 0.0).signum())
    }

    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Self> {
        of
    }

    /// Subtracts no nearly equal numbers.
    #[inline(always)]
    fn lerp(one: [Self; 3], other: [Self; 3], part: Self) -> [Self; 3] {
        DVec3::from(one).lerp(other.into(), part).to_array()
    }

    #[inline(always)]
    fn mean(one: [Self; 3], other: [Self; 3], part: Self) -> [Self; 3] {
        between(one.into(), other.into(), part).to_array()
    }

    #[inline(always)]
    fn asin(self) -> Self {
        libm::asin(self.clamp(-1.0, 1.0))
    }

    #[inline(always)]
    fn hull(self, other: Self) -> Self {
        other
    }

    #[inline(always)]
    fn floors(self) -> [f64; 2] {
        [self.floor(); 2]
    }

    #[inline(always)]
    fn off_even(self) -> Self {
        // The remainder by 2. `rem_euclid` calls `fmod`, which took a third of the picture of a tiled plane.
        let rest = self - 2.0 * (0.5 * self).floor();
        1.0 - (rest - 1.0).abs()
    }

    #[inline(always)]
    fn table(at: [Self; 2], _most: impl Fn() -> f64, of: impl Fn([f64; 2]) -> Rgb) -> [Self; 3] {
        constants(of(at))
    }
}

impl<F: Precise> Number for Interval<F> {
    fn known(of: &Known) -> Self {
        F::narrow(of.enclosed)
    }

    fn pi() -> Self {
        Interval::pi()
    }

    fn any(low: f64, high: f64) -> Self {
        Self { low: F::of(low), high: F::of(high) }
    }

    fn along(vector: [Self; 3], _straight: [Self; 3]) -> Option<[Self; 3]> {
        let length = dot(vector, vector).sqrt();
        let is_known = length.is_bounded() && length.low > F::of(0.0);
        is_known.then(|| per_axis(|axis| vector[axis] / length))
    }

    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Self> {
        F::looks(of)
    }

    fn hull(self, other: Self) -> Self {
        Interval::hull(self, other)
    }

    fn floors(self) -> [f64; 2] {
        [self.low, self.high].map(|end| end.floor().to_f64())
    }

    fn off_even(self) -> Self {
        let n = Self::constant;
        // Any whole number of periods may be left out: the rest is from 0 to 2, or a little beyond.
        let periods = (0.5 * self.coarse().middle()).floor();
        let rest = self - n(2.0 * periods);
        let folded = (n(1.0) - (rest - n(1.0)).abs()).abs();
        // The two folds hold only from -1 to 3.
        if rest.low >= F::of(-1.0) && rest.high <= F::of(3.0) { folded } else { Self::any(0.0, 1.0) }
    }
}

impl Number for Affine {
    fn known(of: &Known) -> Self {
        Interval::known(of).into()
    }

    fn pi() -> Self {
        Interval::pi().into()
    }

    fn any(low: f64, high: f64) -> Self {
        Interval { low, high }.into()
    }

    fn along(vector: [Self; 3], _straight: [Self; 3]) -> Option<[Self; 3]> {
        let length = dot(vector, vector).sqrt();
        let is_known = length.is_bounded() && length.range().low > 0.0;
        is_known.then(|| per_axis(|axis| vector[axis] / length))
    }

    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Self> {
        of
    }

    fn hull(self, other: Self) -> Self {
        Affine::hull(self, other)
    }

    fn floors(self) -> [f64; 2] {
        self.range().floors()
    }

    fn off_even(self) -> Self {
        self.range().off_even().into()
    }
}
