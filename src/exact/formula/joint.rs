//! Formulas that are evaluated together.

use super::field::{PatchField, SOME_REGISTERS};
use super::program::{MAX_REGISTERS, Program, Values};
use super::variables::PATCH;
use crate::scalar::{Scalar, per_axis};

/// The coordinates of a surface as formulas in u and v. What they have in common is computed once.
#[derive(Clone, Debug)]
pub struct PointField {
    each: [PatchField; 3],
    /// The operations of all of them, and the registers of their values, if there are enough registers.
    all: Option<(Program, [u8; 3])>,
}

impl PointField {
    /// Joins the formulas of x, y and z.
    pub fn new(each: [PatchField; 3]) -> Self {
        let is_plain = each.iter().all(|field| field.quick().spline.is_none());
        let (list, results) =
            Values::joined(per_axis(|axis| each[axis].quick().program.values(PATCH.len())), PATCH.len());
        let (program, registers) = Program::keeping(&list, PATCH.len(), results);
        let fits = is_plain && program.registers <= MAX_REGISTERS;
        Self { each, all: fits.then_some((program, registers)) }
    }

    /// Returns the formulas of x, y and z.
    pub fn each(&self) -> &[PatchField; 3] {
        &self.each
    }

    /// Evaluates the formulas at u and v.
    pub fn at<N: Scalar>(&self, uv: [N; 2]) -> [N; 3] {
        let Some((program, results)) = &self.all else { return per_axis(|axis| self.each[axis].at(uv)) };
        let with = |registers: &mut [N]| {
            registers[..PATCH.len()].copy_from_slice(&uv);
            self.each[0].quick().run(program, registers);
            per_axis(|axis| registers[usize::from(results[axis])])
        };
        match program.registers <= SOME_REGISTERS {
            true => with(&mut [uv[0]; SOME_REGISTERS]),
            false => with(&mut [uv[0]; MAX_REGISTERS]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Formula;
    use crate::gradient::Gradient;
    use crate::interval::Interval;
    use proptest::prelude::*;
    use std::sync::Arc;

    fn fields(texts: [&str; 3]) -> PointField {
        PointField::new(texts.map(|text| {
            let formula = Formula::parse_in(text, PATCH).expect("a formula");
            PatchField::new(Arc::new(formula)).expect("its variables are u and v")
        }))
    }

    #[test]
    fn what_coordinates_have_in_common_is_computed_once() {
        let joint = fields(["cos(u)/(2 - sin(v))", "sin(u)/(2 - sin(v))", "u"]);
        let (program, _) = joint.all.as_ref().expect("few registers");
        assert_eq!(program.instructions.len(), 7, "{program:?}");
        let pairs = program.instructions.windows(2).filter(|pair| pair[0].is_of_one_angle_with(&pair[1]));
        assert_eq!(pairs.count(), 1);
    }

    proptest! {
        #[test]
        fn joint_values_have_the_bits_of_single_ones(u in -9.0..9.0_f64, v in -9.0..9.0_f64, width in 0.0..1.0_f64) {
            for texts in [
                ["u", "v", "u"],
                ["0", "u*v", "sqrt(abs(u*v - 1)) + sin(u)"],
                ["cos(v)^2 cos(2u)/(3 - sin(3u))", "cos(v)^2 sin(2u)/(3 - sin(3u)) - sin(v)", "floor(u) + atan2(u, v)"],
            ] {
                let joint = fields(texts);
                let uv = [u, v].map(|at| Gradient::<Interval, 2>::point([Interval { low: at, high: at + width }; 2])[0]);
                let bits = |of: Gradient<Interval, 2>| {
                    [of.value, of.slopes[0], of.slopes[1]].map(|part| [part.low.to_bits(), part.high.to_bits()])
                };
                prop_assert_eq!(
                    joint.at(uv).map(bits),
                    per_axis(|axis| bits(joint.each()[axis].at(uv)))
                );
                let plain = per_axis(|axis| joint.each()[axis].at([u, v]).to_bits());
                prop_assert_eq!(joint.at([u, v]).map(f64::to_bits), plain);
            }
        }
    }
}
