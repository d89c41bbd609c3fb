//! How closed shapes are combined to a solid: which of them a point must lie in.

use crate::geometry::aabb::Aabb;

/// A way in which solids are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// What lies in any of them.
    Union,
    /// What lies in all of them.
    Intersection,
    /// What lies in the first and in none of the others.
    Difference,
}

/// A condition on the parts that a point lies in, which are given by their indices.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// That holds everywhere or nowhere.
    Known(bool),
    /// To lie in a part.
    Part(usize),
    /// That of an operation on several of them.
    Combined(Operation, Vec<Tree>),
}

impl Tree {
    /// Tells whether the condition holds at a point, of which `inside` tells whether it lies in a part; `None` where that
    /// is open.
    pub fn holds(&self, inside: &mut dyn FnMut(usize) -> Option<bool>) -> Option<bool> {
        match self {
            Self::Known(known) => Some(*known),
            Self::Part(part) => inside(*part),
            Self::Combined(Operation::Union, of) => any(of, inside),
            Self::Combined(Operation::Intersection, of) => {
                let mut all = Some(true);
                for one in of {
                    match one.holds(inside) {
                        Some(true) => {}
                        Some(false) => return Some(false),
                        None => all = None,
                    }
                }
                all
            }
            Self::Combined(Operation::Difference, of) => {
                let Some((first, others)) = of.split_first() else { return Some(false) };
                let first = first.holds(inside);
                if first == Some(false) {
                    return first;
                }
                match any(others, inside) {
                    Some(true) => Some(false),
                    Some(false) => first,
                    None => None,
                }
            }
        }
    }

    /// Returns the same condition on parts whose indices are this much larger.
    pub fn moved(&self, by: usize) -> Self {
        match self {
            Self::Known(known) => Self::Known(*known),
            Self::Part(part) => Self::Part(part + by),
            Self::Combined(operation, of) => {
                Self::Combined(*operation, of.iter().map(|one| one.moved(by)).collect())
            }
        }
    }

    /// Returns what is left of the condition for points that lie outside of some parts.
    pub fn without(&self, is_outside: &dyn Fn(usize) -> bool) -> Self {
        let (operation, of) = match self {
            Self::Part(part) if is_outside(*part) => return Self::Known(false),
            Self::Known(_) | Self::Part(_) => return self.clone(),
            Self::Combined(operation, of) => (*operation, of),
        };
        let mut of: Vec<_> = of.iter().map(|one| one.without(is_outside)).collect();
        match operation {
            Operation::Union => of.retain(|one| *one != Self::Known(false)),
            Operation::Intersection if of.contains(&Self::Known(false)) => return Self::Known(false),
            Operation::Intersection => {}
            Operation::Difference if of.first() == Some(&Self::Known(false)) => return Self::Known(false),
            Operation::Difference => {
                let first = of.remove(0);
                of.retain(|one| *one != Self::Known(false));
                of.insert(0, first);
            }
        }
        match of.len() {
            0 => Self::Known(false),
            1 => of.remove(0),
            _ => Self::Combined(operation, of),
        }
    }

    /// Adds to `needed` the conditions on other parts, each with whether it must hold, under which the surface of a part
    /// is that of the solid. Returns whether the solid lies on the outer side of the part; `None` if the condition does
    /// not name the part.
    pub fn surface_of(&self, part: usize, needed: &mut Vec<(Self, bool)>) -> Option<bool> {
        let (operation, of) = match self {
            Self::Known(_) => return None,
            Self::Part(own) => return (*own == part).then_some(false),
            Self::Combined(operation, of) => (*operation, of),
        };
        let (index, is_outer) =
            of.iter().enumerate().find_map(|(index, one)| Some((index, one.surface_of(part, needed)?)))?;
        for (other, one) in of.iter().enumerate().filter(|(other, _)| *other != index) {
            let must_hold = match operation {
                Operation::Union => false,
                Operation::Intersection => true,
                Operation::Difference => other == 0,
            };
            needed.push((one.clone(), must_hold));
        }
        Some(is_outer != (operation == Operation::Difference && index > 0))
    }

    /// Returns a box that holds all points where the condition holds; `None` if there is no such box.
    pub fn bounds(&self, of_part: &dyn Fn(usize) -> Option<Aabb>) -> Option<Aabb> {
        match self {
            Self::Known(true) => None,
            Self::Known(false) => Some(Aabb::EMPTY),
            Self::Part(part) => of_part(*part),
            Self::Combined(Operation::Union, of) => {
                of.iter().try_fold(Aabb::EMPTY, |all, one| Some(all.and(&one.bounds(of_part)?)))
            }
            Self::Combined(Operation::Intersection, of) => {
                of.iter().fold(None, |all, one| common(all, one.bounds(of_part)))
            }
            Self::Combined(Operation::Difference, of) => of.first()?.bounds(of_part),
        }
    }

    /// Returns the part to whose surface a point belongs that lies in some parts on the one side of it, and in others on
    /// the other side; `None` if it does not lie on the solid's surface. Of several surfaces through the point, it is
    /// the first one that is the solid's by itself.
    pub fn owner(&self, one: &[bool], other: &[bool]) -> Option<usize> {
        let holds = |inside: &[bool]| self.holds(&mut |part| Some(inside[part]));
        if holds(one) == holds(other) {
            return None;
        }
        let crossed = || (0..one.len()).filter(|part| one[*part] != other[*part]);
        let decides = |part: &usize| {
            [one, other].into_iter().any(|side| {
                let mut without = side.to_vec();
                without[*part] = !side[*part];
                holds(&without) != holds(side)
            })
        };
        crossed().find(decides).or_else(|| crossed().next())
    }
}

fn any(of: &[Tree], inside: &mut dyn FnMut(usize) -> Option<bool>) -> Option<bool> {
    let mut any = Some(false);
    for one in of {
        match one.holds(inside) {
            Some(false) => {}
            Some(true) => return Some(true),
            None => any = None,
        }
    }
    any
}

/// Returns what two boxes have in common; `None` stands for all of space.
pub fn common(one: Option<Aabb>, other: Option<Aabb>) -> Option<Aabb> {
    let (Some(one), Some(other)) = (one, other) else { return one.or(other) };
    Some(Aabb { low: one.low.max(other.low), high: one.high.min(other.high) })
}

#[cfg(test)]
mod tests {
    use super::Operation::{Difference, Intersection, Union};
    use super::*;

    fn parts(operation: Operation, of: &[usize]) -> Tree {
        Tree::Combined(operation, of.iter().copied().map(Tree::Part).collect())
    }

    #[test]
    fn what_is_open_matters_only_where_it_decides() {
        let [none, yes, no] = [None, Some(true), Some(false)];
        for (operation, of, holds) in [
            (Union, [none, yes], yes),
            (Union, [none, no], none),
            (Intersection, [none, no], no),
            (Intersection, [none, yes], none),
            (Difference, [none, yes], no),
            (Difference, [no, none], no),
            (Difference, [yes, none], none),
            (Difference, [yes, no], yes),
        ] {
            assert_eq!(parts(operation, &[0, 1]).holds(&mut |part| of[part]), holds, "{operation:?} {of:?}");
        }
    }

    #[test]
    fn a_surface_is_the_solids_where_the_other_parts_allow_it() {
        let tree = Tree::Combined(Difference, vec![parts(Union, &[0, 1]), parts(Difference, &[2, 3])]);
        for part in 0..4 {
            let mut needed = Vec::new();
            let is_outer = tree.surface_of(part, &mut needed).expect("the part is there");
            assert_eq!(is_outer, part == 2, "{part}");
            for bits in 0..16_usize {
                let inside: Vec<_> = (0..4).map(|part| bits >> part & 1 == 1).collect();
                let mut beyond = inside.clone();
                beyond[part] = !inside[part];
                let holds = |inside: &[bool]| tree.holds(&mut |part| Some(inside[part]));
                let is_seen =
                    needed.iter().all(|(one, must)| one.holds(&mut |part| Some(inside[part])) == Some(*must));
                assert_eq!(is_seen, holds(&inside) != holds(&beyond), "{part} {bits:b}");
                assert_eq!(tree.owner(&inside, &beyond).is_some(), is_seen, "{part} {bits:b}");
            }
        }
    }

    #[test]
    fn surfaces_that_coincide_are_those_of_one_part() {
        let (out, within) = (vec![false; 2], vec![true; 2]);
        assert_eq!(parts(Union, &[0, 1]).owner(&out, &within), Some(0));
        assert_eq!(parts(Intersection, &[0, 1]).owner(&out, &within), Some(0));
        assert_eq!(parts(Difference, &[0, 1]).owner(&out, &within), None);
        let (left, right) = (vec![true, false], vec![false, true]);
        assert_eq!(parts(Union, &[0, 1]).owner(&left, &right), None);
        assert_eq!(parts(Intersection, &[0, 1]).owner(&left, &right), None);
        assert_eq!(parts(Difference, &[0, 1]).owner(&left, &right), Some(0));
    }

    #[test]
    fn parts_far_away_are_left_out() {
        let tree = Tree::Combined(Difference, vec![parts(Union, &[0, 1]), Tree::Part(2)]);
        assert_eq!(tree.without(&|part| part == 2), parts(Union, &[0, 1]));
        assert_eq!(tree.without(&|part| part > 0), Tree::Part(0));
        assert_eq!(tree.without(&|part| part < 2), Tree::Known(false));
    }
}
