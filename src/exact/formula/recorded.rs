//! Formulas of plugins: functions of a point, generic over its number, recorded once and then interpreted.
//!
//! A generic function is compiled for each number. Called with numbers that [record](Recorder) what is done with them, it
//! leaves its operations, which run as those of a scene's formula do, with the same results.

use super::Formula;
use super::program::{NAMED_REGISTERS, Program, Value, Values};
use super::step::{Function, Step, StepKey};
use super::variables::SPACE;
use crate::scalar::Scalar;
use crate::spline::Spline;
use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

thread_local! {
    static RECORDING: RefCell<Recording> = RefCell::default();
}

/// The operations so far.
#[derive(Default)]
struct Recording {
    list: Vec<Value>,
    /// The places of the operations in this list.
    known: HashMap<(StepKey, [usize; 3]), usize>,
    spline: Option<Arc<Spline>>,
}

/// A number that stands for the result of a recorded operation.
#[derive(Clone, Copy, Debug)]
pub struct Recorder(usize);

impl Recorder {
    /// Records an operation, unless it was recorded before.
    fn new<const COUNT: usize>(step: Step, of: [Self; COUNT]) -> Self {
        let mut operands = [0; 3];
        operands.iter_mut().zip(of).for_each(|(operand, Self(place))| *operand = place);
        let value = Value { step, operands };
        RECORDING.with_borrow_mut(|recording| {
            let Recording { list, known, .. } = recording;
            Self(*known.entry(value.key()).or_insert_with(|| {
                list.push(value);
                list.len() - 1
            }))
        })
    }

    fn call<const COUNT: usize>(function: Function, of: [Self; COUNT]) -> Self {
        Self::new(Step::Call(function), of)
    }

    /// Returns a number of which nothing is known, in place of what a formula of a scene cannot express.
    fn unknown() -> Self {
        Self::constant(f64::NAN)
    }
}

/// A recorded function of a point.
#[derive(Debug)]
pub struct Recorded(Formula);

impl Recorded {
    /// Records a function. One that is too long is unknown everywhere.
    pub fn of(function: impl FnOnce([Recorder; 3]) -> Recorder) -> Self {
        let (values, spline) = values(function);
        let mut program = Program::of(&values, SPACE.len());
        if program.registers > NAMED_REGISTERS {
            program = Program::new(&[Step::Number(f64::NAN)], SPACE.len());
        }
        let formula = Formula::new(String::new(), SPACE, vec![Step::Number(f64::NAN)]);
        Self(Formula { program, spline, is_plain: false, ..formula })
    }

    /// Evaluates the function.
    pub fn at<N: Scalar>(&self, at: [N; 3]) -> N {
        let program = &self.0.program;
        let mut registers = Vec::with_capacity(program.registers);
        registers.extend(at);
        registers.resize(program.registers, at[0]);
        self.0.run(program, &mut registers)
    }
}

/// Returns the values that a function computes, and the spline that it uses.
pub(super) fn values(function: impl FnOnce([Recorder; 3]) -> Recorder) -> (Values, Option<Arc<Spline>>) {
    let outer = RECORDING.take();
    let at = [0, 1, 2].map(|axis| Recorder::new(Step::Variable(axis), []));
    let Recorder(result) = function(at);
    let Recording { list, spline, .. } = RECORDING.replace(outer);
    (Values { list, result }, spline)
}

/// Implements an operator by the operation of the same name.
macro_rules! operators {
    ($($Operator:ident $function:ident,)*) => {
        $(
            impl $Operator for Recorder {
                type Output = Self;

                fn $function(self, other: Self) -> Self {
                    Self::new(Step::$Operator, [self, other])
                }
            }
        )*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div,);

impl Neg for Recorder {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(Step::Neg, [self])
    }
}

/// Implements functions of a number, and of more of them, by calls of a formula's functions.
macro_rules! calls {
    ($($function:ident($($more:ident),*) $Function:ident,)*) => {
        $(
            fn $function(self $(, $more: Self)*) -> Self {
                Self::call(Function::$Function, [self $(, $more)*])
            }
        )*
    };
}

/// The bounds are infinite: a function that asks for them takes the way that it takes where nothing is known.
impl Scalar for Recorder {
    fn constant(value: f64) -> Self {
        Self::new(Step::Number(value), [])
    }

    fn about(value: f64, error: f64) -> Self {
        if error == 0.0 { Self::constant(value) } else { Self::unknown() }
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }

    calls! {
        sin() Sin, cos() Cos, tan() Tan, exp() Exp, ln() Ln, sqrt() Sqrt, abs() Abs, floor() Floor, step() Heaviside,
        atan2(x) Atan2, min(other) Min, max(other) Max, pow(exponent) Pow, choose(one, other) If,
    }

    fn powi(self, exponent: i32) -> Self {
        Self::new(Step::Powi(exponent), [self])
    }

    fn scaled(self, factor: f64) -> Self {
        Self::new(Step::Scale(factor), [self])
    }

    fn shifted(self, by: f64) -> Self {
        Self::new(Step::Shift(by), [self])
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        let is_only = RECORDING.with_borrow_mut(|recording| {
            let known = recording.spline.get_or_insert_with(|| Arc::new(spline.clone()));
            **known == *spline
        });
        if is_only && order == 0 { Self::new(Step::Spline, [self]) } else { Self::unknown() }
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        if orders == [0; 3] { Self::call(Function::Noise, at) } else { Self::unknown() }
    }

    fn d_step(self) -> Self {
        Self::unknown()
    }

    fn d_floor(self) -> Self {
        Self::unknown()
    }

    fn is_zero(self) -> bool {
        RECORDING.with_borrow(|recording| recording.list[self.0].step == Step::Number(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::interval::{Interval, Wide};
    use proptest::prelude::*;

    /// A function that uses each operation.
    fn function<N: Scalar>([x, y, z]: [N; 3]) -> N {
        let n = N::constant;
        let (sin, cos) = (x * y).sin_cos();
        let root = (x.powi(2) + y.shifted(0.5).powi(2) + n(1.0)).sqrt();
        let waves = sin * x + cos * z.sin() + z.cos() - (y * n(0.1)).tan() + x.atan2(root);
        let steps = (x - y).choose(root.ln(), (-z).exp()) + y.floor() * z.step();
        let powers = root.pow(n(1.5)) + z.abs() + x.min(y).max(z.scaled(0.7)) / root;
        waves + steps - powers + N::noise([x, y, z], [0; 3]) + N::about(0.25, 0.0) * n(-0.0)
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn a_recorded_function_has_the_bits_of_its_own(at in prop::array::uniform3(-3.0..3.0), width in 0.0..0.1) {
            let recorded = Recorded::of(function);
            prop_assert_eq!(recorded.at::<f64>(at).to_bits(), function::<f64>(at).to_bits());
            let boxes = at.map(|low| Interval { low, high: low + width });
            prop_assert_eq!(recorded.at(boxes), function(boxes));
            let slopes = boxes.map(|value| Dual { value, slope: Interval::constant(0.5) });
            prop_assert_eq!(recorded.at(slopes), function(slopes));
            let wide = boxes.map(Wide::from);
            prop_assert_eq!(recorded.at(wide), function(wide));
            let ramp = Recorded::of(|[x, ..]| x.ramp(3));
            prop_assert_eq!(ramp.at(boxes), boxes[0].ramp(3));
        }
    }

    #[test]
    fn splines_are_recorded() {
        let [one, other] = [1.0, 2.0].map(|end| Spline::new(&[[0.0, 0.5], [1.0, end], [2.0, 0.0]]));
        let recorded = Recorded::of(|[_, y, z]| y.spline(&one, 0) + z.spline(&one, 0));
        assert_eq!(recorded.at([0.0, 0.3, 0.7]), 0.3.spline(&one, 0) + 0.7.spline(&one, 0));
        let two = Recorded::of(|[_, y, _]| y.spline(&one, 0) + y.spline(&other, 0));
        assert!(two.at::<Interval>([Interval::constant(0.3); 3]).has_zero());
    }

    #[test]
    fn what_is_equal_is_recorded_once_and_what_is_too_long_is_unknown() {
        let recorded = Recorded::of(|[x, y, _]| x * y + (x * y).powi(2) + Recorder::constant(0.0) * y);
        // A product, its square, their sum, 0, its product and the last sum.
        assert_eq!(recorded.0.program.instructions.len(), 6);
        assert_eq!(recorded.at([2.0, 3.0, 0.0]), 42.0);
        let long = Recorded::of(|[x, ..]| {
            let all: Vec<_> = (0..400).map(|index| x * Recorder::constant(f64::from(index))).collect();
            all.iter().chain(&all).fold(x, |sum, one| sum + one.sin())
        });
        assert!(long.at([1.0; 3]).is_nan());
    }
}
